//! The paper's C-like rule bodies to rhai (000 4.2, Appendix A and Table 1; checklist W-076 to
//! W-080). What comes out is one line; for every piece of it is known where it comes from, so that
//! errors name the place that the author knows.

mod expression;

use super::lexer::{Kind, RuleText, Token};
use rinceau_format::Error;

/// A body in rhai.
#[derive(Clone, Debug, Default)]
pub(super) struct Script {
    pub text: String,
    /// Bytes of `text` and of the rule file, in order.
    map: Vec<Mapped>,
}

/// A piece of a script: where it starts, where it comes from, and whether it is taken over as it
/// stands.
#[derive(Clone, Copy, Debug)]
struct Mapped {
    mine: usize,
    theirs: usize,
    is_verbatim: bool,
}

impl Script {
    /// Text taken over as it stands.
    pub fn verbatim(text: &str, at: usize) -> Self {
        let lines = std::iter::once(0).chain(text.match_indices('\n').map(|(i, _)| i + 1));
        Script {
            text: text.to_owned(),
            map: lines.map(|line| Mapped { mine: line, theirs: at + line, is_verbatim: true }).collect(),
        }
    }

    /// Where a line and column of the script, from 1, come from.
    pub fn origin(&self, line: usize, column: usize) -> usize {
        let start = match line {
            0 | 1 => 0,
            _ => self.text.match_indices('\n').nth(line - 2).map_or(0, |(i, _)| i + 1),
        };
        let line = &self.text[start..];
        let at = start + line.char_indices().nth(column.saturating_sub(1)).map_or(0, |(i, _)| i);
        let known = self.map.partition_point(|piece| piece.mine <= at);
        let Some(&Mapped { mine, theirs, is_verbatim }) = known.checked_sub(1).and_then(|i| self.map.get(i))
        else {
            return 0;
        };
        // Within a line that was taken over, on the same column.
        if is_verbatim { theirs + at - mine } else { theirs }
    }

    /// Adds another script.
    pub fn append(&mut self, other: &Script) {
        let before = self.text.len();
        self.text.push_str(&other.text);
        self.text.push('\n');
        self.map.extend(other.map.iter().map(|piece| Mapped { mine: before + piece.mine, ..*piece }));
    }

    fn put(&mut self, text: &str, from: usize) {
        self.map.push(Mapped { mine: self.text.len(), theirs: from, is_verbatim: false });
        self.text.push_str(text);
        self.text.push(' ');
    }
}

/// Types that a declaration may start with, beside the names of element types.
const TYPES: &[&str] = &["int", "double", "float", "bool", "long", "Point", "Direction", "auto"];
/// Blocks and brackets inside each other at most.
const DEEPEST: usize = 60;

/// Reads statements.
pub(super) struct Translator<'s, 't> {
    pub source: &'s RuleText,
    pub tokens: &'s [Token<'t>],
    pub next: usize,
    /// Names of element types.
    pub kinds: &'s [String],
    /// Static children of the rule.
    pub statics: usize,
    pub out: Script,
    pub depth: usize,
    /// Functions may be declared: outside of rules.
    pub is_global: bool,
}

impl<'t> Translator<'_, 't> {
    fn peek(&self) -> Option<Token<'t>> {
        self.tokens.get(self.next).copied()
    }

    fn at(&self) -> usize {
        let last = self.tokens.get(self.next.saturating_sub(1)).map_or(0, Token::end);
        self.peek().map_or(last, |token| token.at)
    }

    fn is(&self, text: &str) -> bool {
        self.peek().is_some_and(|token| token.is(text))
    }

    fn is_at(&self, ahead: usize, text: &str) -> bool {
        self.tokens.get(self.next + ahead).is_some_and(|token| token.is(text))
    }

    fn take(&mut self) -> Option<Token<'t>> {
        let token = self.peek();
        self.next += 1;
        token
    }

    fn put(&mut self, text: &str) {
        let from = self.at();
        self.out.put(text, from);
    }

    fn error(&self, sentence: &str, remedy: &str) -> Error {
        self.source.error(self.at(), sentence, remedy)
    }

    fn expect(&mut self, text: &str) -> Result<(), Error> {
        if self.is(text) {
            self.next += 1;
            return Ok(());
        }
        let found = self.peek().map_or("the end".to_owned(), |token| format!("'{}'", token.text));
        Err(self.error(&format!("'{text}' is missing before {found}"), "Add it"))
    }

    fn deeper(&mut self) -> Result<(), Error> {
        self.depth += 1;
        match self.depth > DEEPEST {
            true => Err(self.error(
                &format!("brackets are nested more than {DEEPEST} deep"),
                "Split the expression, or the rule",
            )),
            false => Ok(()),
        }
    }

    fn is_type(&self, token: Token) -> bool {
        token.kind == Kind::Name
            && (TYPES.contains(&token.text) || self.kinds.iter().any(|kind| kind == token.text))
    }

    /// All statements there are.
    pub fn statements(&mut self) -> Result<(), Error> {
        while self.next < self.tokens.len() {
            self.statement()?;
        }
        Ok(())
    }

    fn block(&mut self) -> Result<(), Error> {
        self.put("{");
        if self.is("{") {
            self.next += 1;
            while !self.is("}") {
                if self.peek().is_none() {
                    return Err(self.error("the block has no end", "Close it with }"));
                }
                self.statement()?;
            }
            self.next += 1;
        } else {
            self.statement()?;
        }
        self.put("}");
        Ok(())
    }

    fn statement(&mut self) -> Result<(), Error> {
        self.deeper()?;
        let Some(token) = self.peek() else { return Err(self.error("a statement is missing", "Add one")) };
        match token.text {
            _ if token.kind == Kind::Text => self.simple()?,
            ";" => self.next += 1,
            "{" => self.block()?,
            "if" => self.conditional()?,
            "while" => {
                self.put("while");
                self.next += 1;
                self.condition()?;
                self.block()?;
            }
            "for" => self.counted()?,
            "return" => {
                self.put("return");
                self.next += 1;
                if !self.is(";") {
                    self.expression()?;
                }
                self.expect(";")?;
                self.put(";");
            }
            "break" | "continue" => {
                self.put(token.text);
                self.next += 1;
                self.expect(";")?;
                self.put(";");
            }
            "const" | "static" => {
                self.next += 1;
                self.statement()?;
            }
            _ if self.is_declaration(token) => self.declaration()?,
            _ => self.simple()?,
        }
        self.depth -= 1;
        Ok(())
    }

    fn is_declaration(&self, token: Token) -> bool {
        let Some(after) = self.tokens.get(self.next + 1) else { return false };
        self.is_type(token) && (after.kind == Kind::Name || after.is("*"))
    }

    fn condition(&mut self) -> Result<(), Error> {
        self.expect("(")?;
        self.put("(");
        self.expression()?;
        self.put(")");
        self.expect(")")
    }

    fn conditional(&mut self) -> Result<(), Error> {
        self.put("if");
        self.next += 1;
        self.condition()?;
        self.block()?;
        if self.is("else") {
            self.put("else");
            self.next += 1;
            if self.is("if") {
                self.deeper()?;
                self.conditional()?;
                self.depth -= 1;
            } else {
                self.block()?;
            }
        }
        Ok(())
    }

    /// `for (a; b; c) d`: the step stands before the test, but for the first time, so that
    /// `continue` does not pass it by.
    fn counted(&mut self) -> Result<(), Error> {
        self.next += 1;
        self.expect("(")?;
        self.put("{");
        let first = self.depth;
        match self.peek() {
            Some(token) if self.is_declaration(token) => self.declaration()?,
            _ if self.is(";") => self.next += 1,
            _ => self.simple()?,
        }
        let flag = format!("again_{first}");
        self.put(&format!("let {flag} = false; loop {{ if {flag} {{"));
        let test = self.next;
        self.skip_to(";")?;
        let step = self.next;
        self.skip_to(")")?;
        let body = self.next;
        self.next = step;
        if !self.is(")") {
            self.assignment()?;
        }
        self.put(&format!("; }} {flag} = true;"));
        self.next = test;
        if !self.is(";") {
            self.put("if !(");
            self.expression()?;
            self.put(") { break; }");
        }
        self.next = body;
        self.block()?;
        self.put("} }");
        Ok(())
    }

    /// Past the next sign of this kind outside of brackets.
    fn skip_to(&mut self, sign: &str) -> Result<(), Error> {
        let mut open = 0_usize;
        while let Some(token) = self.take() {
            if open == 0 && token.is(sign) {
                return Ok(());
            }
            match token.text {
                "(" | "[" => open += 1,
                ")" | "]" => open = open.saturating_sub(1),
                _ => {}
            }
        }
        Err(self.error(&format!("'{sign}' is missing"), "Write for (start; test; step)"))
    }

    /// `double a = 1, b;`, `leaf *x = new leaf;` or a function.
    fn declaration(&mut self) -> Result<(), Error> {
        let Some(kind) = self.take() else { return Ok(()) };
        loop {
            if self.is("*") {
                self.next += 1;
            }
            let Some(name) = self.take().filter(|token| token.kind == Kind::Name) else {
                self.next -= 1;
                return Err(self.error("a name is missing", "Write a type and a name"));
            };
            if self.is("(") && self.is_global {
                return self.function(name);
            }
            self.out.put(&format!("let {} =", name.text), name.at);
            if self.is("=") {
                self.next += 1;
                // A direction where a point is wanted is the point that it leads to.
                let converted = match kind.text {
                    "Point" => "to_point(",
                    "int" | "long" => "to_whole(",
                    "double" | "float" => "to_number(",
                    _ => "(",
                };
                self.put(converted);
                self.expression()?;
                self.put(")");
            } else {
                self.put(match kind.text {
                    "int" | "long" => "0",
                    "double" | "float" => "0.0",
                    "bool" => "false",
                    _ => "()",
                });
            }
            self.put(";");
            if self.is(",") {
                self.next += 1;
                continue;
            }
            return self.expect(";");
        }
    }

    fn function(&mut self, name: Token) -> Result<(), Error> {
        self.next += 1;
        let mut parameters = Vec::new();
        while !self.is(")") {
            let mut last = None;
            while !self.is(",") && !self.is(")") {
                last = self.take();
                if last.is_none() {
                    return Err(self.error("the parameters have no end", "Close them with )"));
                }
            }
            parameters.extend(last.map(|token| token.text));
            if self.is(",") {
                self.next += 1;
            }
        }
        self.next += 1;
        self.out.put(&format!("fn {}({})", name.text, parameters.join(", ")), name.at);
        self.block()
    }

    fn simple(&mut self) -> Result<(), Error> {
        self.assignment()?;
        self.expect(";")?;
        self.put(";");
        Ok(())
    }

    /// An expression that may set something.
    fn assignment(&mut self) -> Result<(), Error> {
        if let Some(sign) = self.peek().filter(|token| token.is("++") || token.is("--")) {
            self.next += 1;
            self.unary()?;
            self.out.put(if sign.is("++") { "+= 1" } else { "-= 1" }, sign.at);
            return Ok(());
        }
        let start = self.out.text.len();
        let kept = self.out.map.len();
        let first = self.next;
        self.postfix()?;
        if let Some(sign) = self.peek().filter(|token| token.is("++") || token.is("--")) {
            self.next += 1;
            self.out.put(if sign.is("++") { "+= 1" } else { "-= 1" }, sign.at);
            return Ok(());
        }
        let sets = ["=", "+=", "-=", "*=", "/=", "%="];
        if let Some(sign) = self.peek().filter(|token| sets.iter().any(|sign| token.is(sign))) {
            self.next += 1;
            self.out.put(sign.text, sign.at);
            return self.expression();
        }
        // No assignment after all: an expression from its start.
        self.out.text.truncate(start);
        self.out.map.truncate(kept);
        self.next = first;
        self.expression()
    }
}
