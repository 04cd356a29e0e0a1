//! The words of a grammar.

use crate::error::{Error, Position};

/// A word and where it stands.
#[derive(Clone, Copy, Debug)]
pub(super) struct Word<'t> {
    pub text: &'t str,
    pub start: usize,
    /// Line, from 0, to tell where a statement ends that has no other end.
    line: usize,
}

/// The text of a grammar word by word.
pub(super) struct Words<'t> {
    text: &'t str,
    words: Vec<Word<'t>>,
    next: usize,
}

impl<'t> Words<'t> {
    pub fn new(text: &'t str) -> Result<Self, Error> {
        let mut words = Vec::new();
        let (mut at, mut line) = (0, 0);
        let bytes = text.as_bytes();
        while at < bytes.len() {
            let rest = &text[at..];
            let c = rest.chars().next().unwrap_or(' ');
            let length = if c.is_whitespace() {
                c.len_utf8()
            } else if c == '#' || rest.starts_with("//") {
                rest.find('\n').unwrap_or(rest.len())
            } else if rest.starts_with("/*") {
                let end = rest.find("*/").map(|end| end + 2);
                end.ok_or_else(|| error_at(text, at, "A comment does not end", "Close it with */"))?
            } else {
                let is_word = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
                let is_number = |c: char| c.is_ascii_digit() || c == '.';
                let length = if is_number(c) {
                    number_length(rest)
                } else if is_word(c) {
                    rest.find(|c: char| !is_word(c)).unwrap_or(rest.len())
                } else if c == '"' {
                    rest[1..].find('"').map_or(rest.len(), |end| end + 2)
                } else {
                    c.len_utf8()
                };
                words.push(Word { text: &rest[..length], start: at, line });
                length
            };
            line += rest[..length].matches('\n').count();
            at += length;
        }
        Ok(Words { text, words, next: 0 })
    }

    /// Of no text.
    pub fn empty() -> Self {
        Words { text: "", words: Vec::new(), next: 0 }
    }

    pub fn peek(&self) -> Option<&'t str> {
        self.words.get(self.next).map(|word| word.text)
    }

    pub fn next(&mut self) -> Option<Word<'t>> {
        self.next += 1;
        self.words.get(self.next - 1).copied()
    }

    /// Takes the next word if it is this one.
    pub fn take(&mut self, text: &str) -> bool {
        let is_it = self.peek() == Some(text);
        self.next += usize::from(is_it);
        is_it
    }

    pub fn expect(&mut self, text: &str) -> Result<(), Error> {
        if self.take(text) { Ok(()) } else { Err(self.unexpected(&format!("Here should be '{text}'"))) }
    }

    /// A name.
    pub fn name(&mut self) -> Result<Word<'t>, Error> {
        match self.peek() {
            Some(text) if text.starts_with(|c: char| c.is_alphabetic() || c == '_') => {
                self.next().ok_or_else(|| self.unexpected("Here should be a name"))
            }
            _ => Err(self.unexpected("Here should be the name of a shape")),
        }
    }

    /// A number with its sign, if there is one here.
    pub fn number(&mut self) -> Option<f64> {
        let sign = match self.peek()? {
            "-" => -1.0,
            "+" => 1.0,
            _ => 0.0,
        };
        let at = self.next + usize::from(sign != 0.0);
        let number: f64 = self.words.get(at)?.text.parse().ok().filter(|number: &f64| number.is_finite())?;
        self.next = at + 1;
        Some(if sign < 0.0 { -number } else { number })
    }

    /// Passes over a bracketed list, or else the rest of the line.
    pub fn skip(&mut self) {
        let (mut depth, mut line) = (0usize, self.words.get(self.next).map(|word| word.line));
        while let Some(word) = self.words.get(self.next) {
            match word.text {
                "[" | "{" | "(" => depth += 1,
                "]" | "}" | ")" if depth > 0 => depth -= 1,
                "]" | "}" | ")" => return,
                _ if depth == 0 && Some(word.line) != line => return,
                _ => {}
            }
            self.next += 1;
            line = Some(word.line);
        }
    }

    /// An error at the next word.
    pub fn unexpected(&self, sentence: &str) -> Error {
        let start = self.words.get(self.next).map_or(self.text.len(), |word| word.start);
        self.error_at(start, sentence)
    }

    /// An error at a byte of the text.
    pub fn error_at(&self, start: usize, sentence: &str) -> Error {
        let remedy =
            "Only shapes of squares, circles, triangles, paths, loops and copies of shapes can become forms";
        error_at(self.text, start, sentence, remedy)
    }
}

fn error_at(text: &str, start: usize, sentence: &str, remedy: &str) -> Error {
    Error::new("broken-cfdg", sentence, remedy).at(Position::of(text, start))
}

fn number_length(text: &str) -> usize {
    let digits =
        |from: usize| text[from..].find(|c: char| !c.is_ascii_digit()).map_or(text.len(), |n| from + n);
    let mut end = digits(0);
    if text[end..].starts_with('.') && !text[end..].starts_with("..") {
        end = digits(end + 1);
    }
    if text[end..].starts_with(['e', 'E']) {
        let sign = usize::from(text[end + 1..].starts_with(['+', '-']));
        let exponent = digits(end + 1 + sign);
        if exponent > end + 1 + sign {
            end = exponent;
        }
    }
    end.max(1)
}
