//! One error type: a sentence, where it happened, and what to do about it.

use std::cell::RefCell;
use std::fmt;

/// A place in the drawing's text, counted as editors count: from 1, columns in characters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Position {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
}

impl Position {
    /// The position of byte `offset` of `text`.
    pub fn of(text: &str, offset: usize) -> Self {
        advance(Position { line: 1, column: 1 }, &text.as_bytes()[..offset.min(text.len())])
    }
}

/// Positions of many places of one text: a table of where every stretch of the text starts, as far
/// as anyone has asked. Counting from the top for each object is quadratic.
pub(crate) struct Positions<'t> {
    text: &'t [u8],
    starts: RefCell<Vec<Position>>,
}

impl<'t> Positions<'t> {
    /// Bytes between two entries of the table.
    const STRIDE: usize = 512;

    pub fn new(text: &'t str) -> Self {
        Positions { text: text.as_bytes(), starts: RefCell::new(vec![Position { line: 1, column: 1 }]) }
    }

    /// The position of byte `offset`.
    pub fn at(&self, offset: usize) -> Position {
        let offset = offset.min(self.text.len());
        let stretch = |i: usize| &self.text[i * Self::STRIDE..offset.min((i + 1) * Self::STRIDE)];
        let wanted = offset / Self::STRIDE;
        let mut starts = self.starts.borrow_mut();
        for i in starts.len() - 1..wanted {
            let next = advance(starts[i], stretch(i));
            starts.push(next);
        }
        advance(starts[wanted], stretch(wanted))
    }
}

/// Where a reader stands who started at `from` and read `bytes`.
fn advance(from: Position, bytes: &[u8]) -> Position {
    // A continuation byte (0b10xxxxxx) does not start a character.
    let characters = |bytes: &[u8]| bytes.iter().filter(|&&b| b & 0xC0 != 0x80).count();
    match memchr::memrchr(b'\n', bytes) {
        None => Position { line: from.line, column: from.column + characters(bytes) },
        Some(last) => {
            let lines = memchr::memchr_iter(b'\n', bytes).count();
            Position { line: from.line + lines, column: 1 + characters(&bytes[last + 1..]) }
        }
    }
}

impl fmt::Display for Position {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.line, self.column)
    }
}

/// Why a drawing cannot be used. `Display` is the whole message a person reads:
/// `12:7: The container 'body' is open. Close the path … [open-container]`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    code: &'static str,
    at: Option<Position>,
    sentence: String,
    remedy: String,
}

impl Error {
    /// A new error. `sentence` says what is wrong, `remedy` what to do; both without a final
    /// full stop. Control and bidirectional characters in them are escaped.
    pub fn new(code: &'static str, sentence: impl AsRef<str>, remedy: impl AsRef<str>) -> Self {
        Error { code, at: None, sentence: printable(sentence.as_ref()), remedy: printable(remedy.as_ref()) }
    }

    /// The same error at a position.
    #[must_use]
    pub fn at(mut self, at: Position) -> Self {
        self.at = Some(at);
        self
    }

    /// The reason code, stable across versions, such as `open-container`.
    pub fn code(&self) -> &'static str {
        self.code
    }

    /// What is wrong, without a full stop.
    pub fn sentence(&self) -> &str {
        &self.sentence
    }

    /// What to do, without a full stop.
    pub fn remedy(&self) -> &str {
        &self.remedy
    }

    /// Where in the drawing, if it is anywhere.
    pub fn position(&self) -> Option<Position> {
        self.at
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(at) = self.at {
            write!(f, "{at}: ")?;
        }
        write!(f, "{}. {}. [{}]", self.sentence, self.remedy, self.code)
    }
}

impl std::error::Error for Error {}

/// True for what a terminal or a dialog could be fooled by: C0 and C1 controls and the bidirectional
/// overrides.
pub fn is_deceptive(c: char) -> bool {
    let bidirectional =
        matches!(c, '\u{200E}' | '\u{200F}' | '\u{202A}'..='\u{202E}' | '\u{2066}'..='\u{2069}');
    c.is_control() || bidirectional
}

/// Escapes what is [deceptive](is_deceptive). Long text is cut, so that a message stays a sentence.
pub fn printable(text: &str) -> String {
    const LONGEST: usize = 600;
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        if out.len() > LONGEST {
            out.push('…');
            break;
        }
        if is_deceptive(c) {
            out.extend(c.escape_unicode());
        } else {
            out.push(c);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_count_lines_and_characters() {
        let text = "ab\ncé<x";
        assert_eq!(Position::of(text, 0), Position { line: 1, column: 1 });
        assert_eq!(Position::of(text, text.find('<').unwrap()), Position { line: 2, column: 3 });
    }

    #[test]
    fn the_table_agrees_with_counting() {
        let text = "<g>é\n".repeat(3000) + &"ü".repeat(9000);
        let table = Positions::new(&text);
        for offset in (0..=text.len()).step_by(997).chain([0, 511, 512, 1024, text.len()]) {
            assert_eq!(table.at(offset), Position::of(&text, offset));
        }
    }

    #[test]
    fn messages_escape_controls() {
        let error = Error::new("x", "bad\u{1b}[31m \u{202e} name", "do");
        assert_eq!(error.to_string(), "bad\\u{1b}[31m \\u{202e} name. do. [x]");
    }
}
