//! Looks: how a rule file says that its elements are drawn.

use super::Reader;
use crate::grow::rules::lexer::Token;
use rinceau_format::Error;

/// How elements of a type are drawn (checklist W-064, W-084 to W-086).
#[derive(Clone, Debug, PartialEq)]
pub struct Look {
    /// Byte of the rule file where it stands.
    pub at: usize,
    /// Index of the type.
    pub kind: usize,
    /// The artwork: a name, `outline`, `fill` or `none`.
    pub art: String,
    /// Full width along lines, in units of the rules; 0 for the width of the artwork itself.
    pub width: f64,
    /// How much larger than its proxy something round is drawn.
    pub size: f64,
    /// Tone of the palette, 1 to 3, or 0 for colours by number.
    pub tone: usize,
    /// The field that numbers colours, such as `order`.
    pub by: String,
    /// The field that multiplies widths.
    pub thick: String,
    /// True if lines that continue each other are one.
    pub join: bool,
}

impl Look {
    /// The look of a type of which nothing is said but where: its outline.
    pub fn plain(at: usize, kind: usize) -> Self {
        Look {
            at,
            kind,
            art: "outline".into(),
            width: 0.0,
            size: 1.0,
            tone: 1,
            by: String::new(),
            thick: String::new(),
            join: false,
        }
    }
}

impl Reader<'_, '_> {
    pub(super) fn look(&mut self) -> Result<(), Error> {
        let at = self.at();
        let kind = self.kind("the type that is drawn")?;
        self.accept(":");
        let mut look = Look::plain(at, kind);
        loop {
            let word = self.name("art, width, size, tone, by, thick or join")?;
            match word.text {
                "join" => look.join = true,
                "art" => {
                    let name = self.name("the name of an artwork")?;
                    look.art = self.dashed(name);
                }
                "thick" => look.thick = self.name("the name of a field")?.text.to_owned(),
                "by" => {
                    look.by = self.name("the name of a field")?.text.to_owned();
                    look.tone = 0;
                }
                "width" | "size" | "tone" => {
                    let number = self.number(word.text)?;
                    match word.text {
                        "width" => look.width = number,
                        "size" => look.size = number,
                        _ if [1.0, 2.0, 3.0].contains(&number) => look.tone = number as usize,
                        _ => {
                            self.next -= 1;
                            return Err(self.error("a tone is 1, 2 or 3", "Write one of them"));
                        }
                    }
                }
                other => {
                    self.next -= 1;
                    return Err(self.error(
                        format!("a look has no '{other}'"),
                        "Use art, width, size, tone, by, thick or join",
                    ));
                }
            }
            if !self.accept(",") {
                self.accept(";");
                break;
            }
        }
        let name = &self.names[kind];
        if self.file.looks.iter().any(|other| other.kind == kind) {
            return Err(self.source.error(at, format!("'{name}' has two looks"), "Keep one"));
        }
        self.look_fields.push((at, kind, [look.by.clone(), look.thick.clone()]));
        self.file.looks.push(look);
        Ok(())
    }

    pub(super) fn number(&mut self, what: &str) -> Result<f64, Error> {
        let number = self.peek().and_then(|token| token.text.parse::<f64>().ok());
        let Some(number) = number.filter(|number| (0.0..=1e6).contains(number)) else {
            return Err(self.error(format!("'{what}' needs a number"), "Write one after it"));
        };
        self.next += 1;
        Ok(number)
    }

    /// A name with dashes in it, as artworks have.
    pub(super) fn dashed(&mut self, first: Token) -> String {
        let mut end = first.end();
        while self.is("-") && self.at() == end {
            let Some(part) = self.tokens.get(self.next + 1).filter(|part| part.at == end + 1) else { break };
            end = part.end();
            self.next += 2;
        }
        self.source.text[first.at..end].to_owned()
    }
}
