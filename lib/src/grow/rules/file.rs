//! Rule files, in the paper's spelling and in the plain one (000 4.2, Appendix A; checklist W-067 to
//! W-080).

mod look;

pub use look::Look;

use super::lexer::{Kind, RuleText, Token, tokens};
use super::translate::{Script, Translator};
use crate::grow::piece;
use rinceau_format::Error;

/// Element types, rules and children at most.
const MOST: usize = 200;
/// Bytes of a rule file at most.
const LONGEST: usize = 1 << 18;

/// What a rule file says.
#[derive(Clone, Debug)]
pub(super) struct RuleFile {
    pub kinds: Vec<KindSource>,
    pub globals: Script,
    pub rules: Vec<RuleSource>,
    pub looks: Vec<Look>,
    /// Circles smaller than this are never worth trying.
    pub smallest: f64,
    /// How much farther than usual elements may be from a circle.
    pub reach: f64,
}

/// An element type.
#[derive(Clone, Debug)]
pub(super) struct KindSource {
    pub name: String,
    pub proxies: Vec<piece::Kind>,
    /// Name, and the default as a number; whole ones are kept whole.
    pub fields: Vec<(String, Field)>,
    pub overlaps: bool,
}

#[derive(Clone, Copy, Debug)]
pub(super) enum Field {
    Whole(i64),
    Number(f64),
    Switch(bool),
}

/// A growth rule.
#[derive(Clone, Debug)]
pub(super) struct RuleSource {
    pub parent: usize,
    /// Types of the static children, and their names in the body.
    pub statics: Vec<(usize, Option<String>)>,
    pub body: Script,
    pub at: usize,
}

struct Reader<'s, 't> {
    source: &'s RuleText,
    tokens: &'s [Token<'t>],
    next: usize,
    file: RuleFile,
    names: Vec<String>,
    /// Fields that looks name: where, and of which type.
    look_fields: Vec<(usize, usize, [String; 2])>,
}

/// Reads a rule file.
///
/// Errors: what is not understood, with its line and column.
pub(super) fn read(source: &RuleText) -> Result<RuleFile, Error> {
    if source.text.len() > LONGEST {
        return Err(source.error(0, format!("the file is larger than {} KiB", LONGEST >> 10), "Shorten it"));
    }
    let words = tokens(source, &source.text)?;
    let file = RuleFile {
        kinds: Vec::new(),
        globals: Script::default(),
        rules: Vec::new(),
        looks: Vec::new(),
        smallest: 0.0,
        reach: 1.0,
    };
    let mut reader =
        Reader { source, tokens: &words, next: 0, file, names: Vec::new(), look_fields: Vec::new() };
    reader.declare();
    while let Some(token) = reader.peek() {
        reader.item(token)?;
    }
    reader.check()?;
    Ok(reader.file)
}

impl<'t> Reader<'_, 't> {
    fn peek(&self) -> Option<Token<'t>> {
        self.tokens.get(self.next).copied()
    }

    fn at(&self) -> usize {
        self.peek().map_or(self.source.text.len(), |token| token.at)
    }

    /// Where a type seems to be declared first.
    fn at_of(&self, name: &str) -> usize {
        let pair = self.tokens.windows(2).find(|pair| pair[0].text.ends_with("element") && pair[1].is(name));
        pair.map_or(0, |pair| pair[1].at)
    }

    fn is(&self, text: &str) -> bool {
        self.peek().is_some_and(|token| token.is(text))
    }

    fn accept(&mut self, text: &str) -> bool {
        let is = self.is(text);
        self.next += usize::from(is);
        is
    }

    fn error(&self, sentence: impl AsRef<str>, remedy: impl AsRef<str>) -> Error {
        self.source.error(self.at(), sentence, remedy)
    }

    fn expect(&mut self, text: &str) -> Result<(), Error> {
        if self.accept(text) {
            return Ok(());
        }
        let found = self.peek().map_or("the end".to_owned(), |token| format!("'{}'", token.text));
        Err(self.error(format!("'{text}' is missing before {found}"), "Add it"))
    }

    fn name(&mut self, what: &str) -> Result<Token<'t>, Error> {
        match self.peek().filter(|token| token.kind == Kind::Name) {
            Some(token) => {
                self.next += 1;
                Ok(token)
            }
            None => Err(self.error(format!("{what} is missing"), "Write its name")),
        }
    }

    /// The names of all element types, so that rules may come before them.
    fn declare(&mut self) {
        let mut depth = 0_i32;
        let mut is_block = false;
        for pair in self.tokens.windows(2) {
            match pair[0].text {
                "{" => depth += 1,
                "}" => depth -= 1,
                _ if pair[0].kind == Kind::Block => is_block = !pair[0].text.starts_with("%end"),
                _ => {}
            }
            let starts = pair[0].is("%element") || depth == 0 && !is_block && pair[0].is("element");
            if starts && pair[1].kind == Kind::Name {
                self.names.push(pair[1].text.to_owned());
            }
        }
    }

    fn item(&mut self, token: Token<'t>) -> Result<(), Error> {
        if self.file.kinds.len().max(self.file.rules.len()) > MOST {
            return Err(self.error(format!("there are more than {MOST} element types or rules"), "Use fewer"));
        }
        self.next += 1;
        match token.text {
            "%element" => self.element("%endelement"),
            "element" => self.element(""),
            "%source" => self.globals(),
            "%rule" => self.rule(true),
            "rule" => self.rule(false),
            "%look" => {
                while !self.accept("%endlook") {
                    self.look()?;
                }
                Ok(())
            }
            "look" => self.look(),
            "smallest" => {
                self.file.smallest = self.number("smallest")?;
                Ok(())
            }
            "reach" => {
                self.file.reach = self.number("reach")?;
                Ok(())
            }
            "let" | "const" => self.copied(token, ";"),
            "fn" => self.copied(token, "}"),
            "art" | "width" | "size" | "tone" | "by" | "thick" | "join" => {
                self.next -= 1;
                Err(self.error(format!("a comma is missing before '{}'", token.text), "Add it"))
            }
            _ => {
                self.next -= 1;
                Err(self.error(
                    format!("'{}' means nothing here", token.text),
                    "Write an element, a rule, a look, smallest, reach, let or fn",
                ))
            }
        }
    }

    fn element(&mut self, end: &str) -> Result<(), Error> {
        let at = self.at();
        let name = self.name("the name of an element type")?;
        if self.file.kinds.iter().any(|kind| kind.name == name.text) {
            return Err(self.source.error(
                at,
                format!("the element type '{}' is declared twice", name.text),
                "Give one of them another name",
            ));
        }
        let mut kind = KindSource {
            name: name.text.to_owned(),
            proxies: Vec::new(),
            fields: Vec::new(),
            overlaps: false,
        };
        let is_block = !end.is_empty();
        if !is_block {
            self.expect(":")?;
        }
        loop {
            if is_block && self.accept(end) {
                break;
            }
            let word = self.name(if is_block { end } else { "a proxy or a field" })?;
            if let Some(proxy) = piece::Kind::from_name(word.text) {
                kind.proxies.push(proxy);
            } else if word.is("overlaps") && !self.is("=") {
                kind.overlaps = true;
            } else {
                self.field(word, is_block, &mut kind)?;
            }
            if is_block {
                self.accept(",");
                self.accept(";");
            } else if !self.accept(",") {
                self.accept(";");
                break;
            }
        }
        if kind.proxies.is_empty() {
            return Err(self.source.error(
                at,
                format!("the element type '{}' has no proxy", kind.name),
                "Give it a point, circle, arc, bezier, linesegment or polygon",
            ));
        }
        self.file.kinds.push(kind);
        Ok(())
    }

    /// `int order;`, or `order = 0`.
    fn field(&mut self, word: Token, is_typed: bool, kind: &mut KindSource) -> Result<(), Error> {
        let (name, mut value) = if is_typed {
            let name = self.name("the name of a field")?;
            let value = match word.text {
                "int" | "long" => Field::Whole(0),
                "double" | "float" => Field::Number(0.0),
                "bool" => Field::Switch(false),
                other => {
                    self.next -= 2;
                    return Err(self.error(
                        format!("'{other}' is neither a proxy nor the type of a field"),
                        "Use point, circle, arc, bezier, linesegment, polygon, or int, double, bool and a name",
                    ));
                }
            };
            (name, value)
        } else {
            (word, Field::Whole(0))
        };
        if self.accept("=") {
            let is_negative = self.accept("-");
            let text = self.peek().map_or("", |token| token.text);
            let given = match text {
                "true" | "false" => Some(Field::Switch(text == "true")),
                text => {
                    let whole =
                        text.parse::<i64>().ok().map(|n| Field::Whole(if is_negative { -n } else { n }));
                    let number = text
                        .parse::<f64>()
                        .ok()
                        .filter(|n| n.is_finite())
                        .map(|n| if is_negative { -n } else { n });
                    whole.or(number.map(Field::Number))
                }
            };
            let Some(given) = given else {
                return Err(self.error("a field starts with a number, true or false", "Write one"));
            };
            self.next += 1;
            value = given;
        }
        if kind.fields.iter().any(|(known, _)| known == name.text) {
            let sentence = format!("the field '{}' is declared twice", name.text);
            return Err(self.source.error(name.at, sentence, "Give one of them another name"));
        }
        kind.fields.push((name.text.to_owned(), value));
        Ok(())
    }

    fn kind(&mut self, what: &str) -> Result<usize, Error> {
        let name = self.name(what)?;
        self.names.iter().position(|known| known == name.text).ok_or_else(|| {
            let sentence = format!("no element type is called '{}'", name.text);
            let remedy = match &self.names[..] {
                [] => "Declare it before, or look for a word that is not spelled right".to_owned(),
                names => format!("Declare it, or use one of {}", names.join(", ")),
            };
            self.source.error(name.at, sentence, remedy)
        })
    }

    fn translator<'s>(
        &'s self,
        tokens: &'s [Token<'t>],
        statics: usize,
        is_global: bool,
    ) -> Translator<'s, 't> {
        Translator {
            source: self.source,
            tokens,
            next: 0,
            kinds: &self.names,
            statics,
            out: Script::default(),
            depth: 0,
            is_global,
        }
    }

    fn globals(&mut self) -> Result<(), Error> {
        let start = self.next;
        while !self.is("%endsource") {
            if self.peek().is_none() {
                return Err(self.error("'%endsource' is missing", "Add it"));
            }
            self.next += 1;
        }
        let mut translator = self.translator(&self.tokens[start..self.next], 0, true);
        translator.statements()?;
        let script = translator.out;
        self.file.globals.append(&script);
        self.next += 1;
        Ok(())
    }

    /// A declaration of rhai, up to the sign that ends it.
    fn copied(&mut self, first: Token, end: &str) -> Result<(), Error> {
        let mut open = 0_i32;
        while let Some(token) = self.peek() {
            self.next += 1;
            match token.text {
                "{" | "(" | "[" => open += 1,
                "}" | ")" | "]" => open -= 1,
                _ => {}
            }
            if open <= 0 && token.is(end) {
                let text = &self.source.text[first.at..token.end()];
                self.file.globals.append(&Script::verbatim(text, first.at));
                return Ok(());
            }
        }
        Err(self.source.error(first.at, format!("'{}' has no end", first.text), format!("End it with {end}")))
    }

    fn rule(&mut self, is_printed: bool) -> Result<(), Error> {
        let at = self.at();
        let parent = self.kind("the type that grows")?;
        if !self.accept("-->") {
            self.expect("->")?;
        }
        let mut statics = Vec::new();
        while !self.is("{") && !self.is("*") {
            let kind = self.kind("the type of a child")?;
            let name = match self.peek() {
                Some(token) if !is_printed && token.kind == Kind::Name => {
                    self.next += 1;
                    Some(token.text.to_owned())
                }
                _ => None,
            };
            statics.push((kind, name));
            self.accept(",");
        }
        // Dynamic children are declared for the sake of the preprocessor alone.
        while self.accept("*") {
            self.name("the name of a dynamic child")?;
            self.kind("the type of a dynamic child")?;
        }
        let open = self.next;
        self.expect("{")?;
        let mut depth = 1_usize;
        while depth > 0 {
            match self.peek() {
                Some(token) if token.is("{") => depth += 1,
                Some(token) if token.is("}") => depth -= 1,
                Some(token) if token.kind == Kind::Block => {
                    return Err(self.error("the body of the rule has no end", "Close it with }"));
                }
                Some(_) => {}
                None => return Err(self.error("the body of the rule has no end", "Close it with }")),
            }
            self.next += 1;
        }
        let (first, last) = (open + 1, self.next - 1);
        let body = if is_printed {
            let mut translator = self.translator(&self.tokens[first..last], statics.len(), false);
            translator.statements()?;
            let out = translator.out;
            self.expect("%endrule")?;
            out
        } else {
            let from = self.tokens[open].end();
            Script::verbatim(&self.source.text[from..self.tokens[last].at], from)
        };
        self.file.rules.push(RuleSource { parent, statics, body, at });
        Ok(())
    }

    fn check(&self) -> Result<(), Error> {
        // What goes before a declaration may have taken it in, as a statement without its end does.
        let declared =
            self.file.kinds.iter().map(|kind| Some(kind.name.as_str())).chain(std::iter::repeat(None));
        if let Some((name, _)) =
            self.names.iter().zip(declared).find(|(name, kind)| Some(name.as_str()) != *kind)
        {
            return Err(self.source.error(
                self.at_of(name),
                format!("the element type '{name}' is not declared where it seems to be"),
                "End what goes before it, with ; or }",
            ));
        }
        for (at, kind, fields) in &self.look_fields {
            let kind = &self.file.kinds[*kind];
            let is_missing =
                |name: &&String| !name.is_empty() && !kind.fields.iter().any(|(field, _)| field == *name);
            if let Some(name) = fields.iter().find(is_missing) {
                return Err(self.source.error(
                    *at,
                    format!("the element type '{}' has no field '{name}'", kind.name),
                    "Declare it, or leave it out of the look",
                ));
            }
        }
        let seed = self.file.kinds.iter().find(|kind| kind.name == "seed");
        if seed.is_none_or(|seed| seed.proxies != [piece::Kind::Point]) {
            return Err(self.source.error(
                0,
                "there is no element type 'seed' with a single point",
                "Declare it: growth starts there (element seed: point)",
            ));
        }
        if self.file.rules.is_empty() {
            return Err(self.source.error(self.source.text.len(), "there is no rule", "Add one"));
        }
        Ok(())
    }
}
