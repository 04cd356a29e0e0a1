//! A grammar to forms.

mod adjust;
mod forms;
mod path;

use super::syntax::{Word, Words};
use crate::error::Error;
use crate::scene::Scene;
use adjust::Adjust;
use path::Painted;
use std::collections::HashMap;

/// Steps of loops, and pieces of a grammar, at most.
const MOST_PIECES: usize = 20_000;
/// Loops in loops at most.
const DEEPEST: usize = 50;
/// A longer text is no grammar that anybody wrote.
const LONGEST: usize = 4 << 20;

/// What a piece of a shape is.
enum Piece<'t> {
    Shape(Word<'t>),
    Loop(usize, Adjust, Vec<(Piece<'t>, Adjust)>),
}

impl Scene {
    /// Forms of a grammar of Context Free, each beside the other, and what of it they cannot say.
    ///
    /// Errors: a grammar with chance, parameters or conditions, or one that cannot be read; with its place.
    pub fn from_cfdg(text: &str) -> Result<(Self, Vec<String>), Error> {
        if text.len() > LONGEST {
            let sentence = format!("The grammar is larger than {} MiB", LONGEST >> 20);
            return Err(Error::new("too-large", sentence, "Take out what is not needed"));
        }
        let mut grammar = Grammar { words: Words::new(text)?, ..Grammar::new() };
        grammar.all()?;
        grammar.scene()
    }
}

/// A grammar while it is read.
struct Grammar<'t> {
    words: Words<'t>,
    start: Option<(Word<'t>, Adjust)>,
    shapes: Vec<(Word<'t>, Vec<(Piece<'t>, Adjust)>)>,
    paths: HashMap<&'t str, Vec<Painted>>,
    /// True for a grammar of version 2, which `rule` and braces around adjustments tell.
    is_old: bool,
    pieces: usize,
    notes: Vec<String>,
}

impl<'t> Grammar<'t> {
    fn new() -> Self {
        Grammar {
            words: Words::empty(),
            start: None,
            shapes: Vec::new(),
            paths: HashMap::new(),
            is_old: false,
            pieces: 0,
            notes: Vec::new(),
        }
    }

    fn note(&mut self, note: &str) {
        if !self.notes.iter().any(|known| known == note) {
            self.notes.push(note.to_owned());
        }
    }

    fn all(&mut self) -> Result<(), Error> {
        while let Some(word) = self.words.peek() {
            match word {
                "startshape" => {
                    self.words.next();
                    let name = self.words.name()?;
                    let adjust = self.adjust_if_any()?;
                    self.start = Some((name, adjust));
                }
                "shape" | "rule" => {
                    self.is_old |= word == "rule";
                    self.words.next();
                    let name = self.words.name()?;
                    if self.words.peek() == Some("(") {
                        return Err(self.words.unexpected("A shape has parameters, which a form has not"));
                    }
                    if self.shapes.iter().any(|(known, _)| known.text == name.text)
                        || self.words.number().is_some()
                    {
                        let sentence = format!(
                            "'{}' has several rules: which one is taken is chance, and a form has none",
                            name.text
                        );
                        return Err(self.words.error_at(name.start, &sentence));
                    }
                    let content = self.block(0)?;
                    self.shapes.push((name, content));
                }
                "path" => {
                    self.words.next();
                    let name = self.words.name()?;
                    let painted = self.path()?;
                    self.paths.insert(name.text, painted);
                }
                "import" | "include" => {
                    return Err(self
                        .words
                        .unexpected("A grammar that takes in other files is not followed there"));
                }
                word if word.starts_with("CF::")
                    || matches!(word, "background" | "tile" | "size" | "time") =>
                {
                    self.note("Settings of the grammar (background, tiling and the like) are left out");
                    self.words.next();
                    self.words.take("=");
                    self.words.skip();
                }
                _ => return Err(self.words.unexpected(&format!("'{word}' begins nothing that a form has"))),
            }
        }
        Ok(())
    }

    /// The pieces between braces.
    fn block(&mut self, depth: usize) -> Result<Vec<(Piece<'t>, Adjust)>, Error> {
        self.words.expect("{")?;
        let mut pieces = Vec::new();
        while !self.words.take("}") {
            self.pieces += 1;
            if self.pieces > MOST_PIECES || depth > DEEPEST {
                return Err(self.words.unexpected("The grammar has too many pieces"));
            }
            pieces.push(self.item(depth)?);
        }
        Ok(pieces)
    }

    /// A shape, or a loop.
    fn item(&mut self, depth: usize) -> Result<(Piece<'t>, Adjust), Error> {
        if depth > DEEPEST {
            return Err(self.words.unexpected("The grammar has too many pieces"));
        }
        let is_loop = self.words.take("loop");
        let Some(count) = self.words.number() else {
            if is_loop {
                return Err(self.words.unexpected("A loop goes round a number of times"));
            }
            return self.piece();
        };
        if !is_loop {
            self.words.expect("*")?;
        }
        if !(0.0..=f64::MAX).contains(&count) || count.fract() != 0.0 {
            return Err(self.words.unexpected("A loop goes round a whole number of times"));
        }
        if count > MOST_PIECES as f64 {
            return Err(self.words.unexpected(&format!("A loop goes round {MOST_PIECES} times at most")));
        }
        let each = self.adjust()?;
        let inside = match self.words.peek() {
            Some("{") => self.block(depth + 1)?,
            _ => vec![self.item(depth + 1)?],
        };
        Ok((Piece::Loop(count as usize, each, inside), Adjust::NONE))
    }

    /// A shape with its adjustment.
    fn piece(&mut self) -> Result<(Piece<'t>, Adjust), Error> {
        if let Some(word @ ("if" | "else" | "switch" | "finally" | "transform" | "clone" | "let")) =
            self.words.peek()
        {
            return Err(self.words.unexpected(&format!("'{word}' is nothing that a form has")));
        }
        let name = self.words.name()?;
        if self.words.peek() == Some("(") {
            return Err(self.words.unexpected("A shape has parameters, which a form has not"));
        }
        let adjust = self.adjust()?;
        Ok((Piece::Shape(name), adjust))
    }
}
