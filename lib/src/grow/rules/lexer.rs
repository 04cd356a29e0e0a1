//! Words of a rule file, with the places where they stand.

use rinceau_format::{Error, Position};

/// What a word is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Name,
    Number,
    Text,
    /// A run of one or two dollars.
    Dollar,
    /// `%element` and the like.
    Block,
    Sign,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Token<'t> {
    pub kind: Kind,
    pub text: &'t str,
    /// Byte of the file where it starts.
    pub at: usize,
}

impl Token<'_> {
    pub fn is(&self, text: &str) -> bool {
        self.text == text && self.kind != Kind::Text
    }

    pub fn end(&self) -> usize {
        self.at + self.text.len()
    }
}

/// A rule file: what it is called, and where its text starts in the drawing if it is part of one.
#[derive(Clone, Debug)]
pub struct RuleText {
    /// The name of the file, or of the pattern.
    pub name: String,
    /// Its text.
    pub text: String,
}

impl RuleText {
    /// An error at a byte of the text.
    pub fn error(&self, at: usize, sentence: impl AsRef<str>, remedy: impl AsRef<str>) -> Error {
        let Position { line, column } = Position::of(&self.text, at.min(self.text.len()));
        Error::new(
            "bad-rules",
            format!("The rules '{}', {line}:{column}: {}", self.name, sentence.as_ref()),
            remedy,
        )
    }
}

/// Signs of more than one character, longest first.
const SIGNS: &[&str] = &[
    "-->", "<<=", ">>=", "->", "++", "--", "+=", "-=", "*=", "/=", "%=", "==", "!=", "<=", ">=", "&&", "||",
    "::", "=>", "..",
];

/// The words of a text.
///
/// Errors: a comment or a text without an end, a sign that means nothing.
pub(super) fn tokens<'t>(source: &RuleText, text: &'t str) -> Result<Vec<Token<'t>>, Error> {
    let bytes = text.as_bytes();
    let mut tokens: Vec<Token> = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        let rest = &text[at..];
        let c = rest.chars().next().unwrap_or(' ');
        if c.is_whitespace() || c == '\u{feff}' {
            at += c.len_utf8();
            continue;
        }
        if rest.starts_with("//") {
            at += rest.find('\n').unwrap_or(rest.len());
            continue;
        }
        if let Some(comment) = rest.strip_prefix("/*") {
            let Some(end) = comment.find("*/") else {
                return Err(source.error(at, "the comment has no end", "Close it with */"));
            };
            at += end + 4;
            continue;
        }
        let (kind, length) = word(source, rest, at, tokens.last())?;
        tokens.push(Token { kind, text: &rest[..length], at });
        at += length;
    }
    Ok(tokens)
}

fn word(source: &RuleText, rest: &str, at: usize, last: Option<&Token>) -> Result<(Kind, usize), Error> {
    let c = rest.chars().next().unwrap_or(' ');
    let run = |is_part: &dyn Fn(char) -> bool| rest.find(|c| !is_part(c)).unwrap_or(rest.len());
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    if c.is_alphabetic() || c == '_' {
        return Ok((Kind::Name, run(&is_word)));
    }
    let digit_follows = rest[c.len_utf8()..].starts_with(|c: char| c.is_ascii_digit());
    if c.is_ascii_digit() || c == '.' && digit_follows && !last.is_some_and(|last| last.is(")")) {
        return Ok((Kind::Number, number(rest)));
    }
    if c == '`' {
        let end = rest[1..].find('`').ok_or_else(|| {
            source.error(at, "the text has no end", "Close it with another of these quotes")
        })?;
        return Ok((Kind::Text, end + 2));
    }
    if c == '"' || c == '\'' {
        let mut escaped = false;
        for (i, other) in rest.char_indices().skip(1) {
            match other {
                '\n' => break,
                _ if escaped => escaped = false,
                '\\' => escaped = true,
                _ if other == c => return Ok((Kind::Text, i + 1)),
                _ => {}
            }
        }
        return Err(source.error(at, "the text has no end", "Close it with a quote on the same line"));
    }
    if c == '$' {
        return Ok((Kind::Dollar, if rest.starts_with("$$") { 2 } else { 1 }));
    }
    let after = rest[c.len_utf8()..].chars().next().unwrap_or(' ');
    if c == '%' && after.is_alphabetic() {
        let length = 1 + rest[1..].find(|c: char| !c.is_alphabetic()).unwrap_or(rest.len() - 1);
        let known = ["element", "source", "rule", "look", "endelement", "endsource", "endrule", "endlook"];
        if known.contains(&&rest[1..length]) {
            return Ok((Kind::Block, length));
        }
    }
    if let Some(sign) = SIGNS.iter().find(|sign| rest.starts_with(**sign)) {
        return Ok((Kind::Sign, sign.len()));
    }
    // The tilde of the paper's printed listing is a small one.
    if c.is_ascii_punctuation() || matches!(c, '\u{2dc}' | '\u{223c}') {
        return Ok((Kind::Sign, c.len_utf8()));
    }
    Err(source.error(at, format!("'{c}' means nothing here"), "Remove it"))
}

/// How long the number at the start is. A dot before a name is no part of it.
fn number(rest: &str) -> usize {
    let bytes = rest.as_bytes();
    let digits = |from: usize| from + bytes[from..].iter().take_while(|b| b.is_ascii_digit()).count();
    let mut end = digits(0);
    let is_range = rest[end..].starts_with("..");
    if bytes.get(end) == Some(&b'.') && !is_range && !bytes.get(end + 1).is_some_and(u8::is_ascii_alphabetic)
    {
        end = digits(end + 1);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        if bytes.get(end + 1 + sign).is_some_and(u8::is_ascii_digit) {
            end = digits(end + 1 + sign);
        }
    }
    end
}
