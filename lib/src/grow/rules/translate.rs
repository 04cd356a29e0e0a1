//! The paper's C-like rule bodies to rhai (000 4.2, Appendix A and Table 1; checklist W-076 to
//! W-080). What comes out is one line; for every piece of it is known where it comes from, so that
//! errors name the place that the author knows.

use super::lexer::{Kind, RuleText, Token};
use rinceau_format::Error;
use std::fmt::Write;

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

    /// `a ? b : c` and all that binds closer.
    fn expression(&mut self) -> Result<(), Error> {
        self.deeper()?;
        let (start, kept) = (self.out.text.len(), self.out.map.len());
        self.binary(0)?;
        if self.is("?") {
            self.next += 1;
            let test = self.out.text.split_off(start);
            let places = self.out.map.split_off(kept);
            let before = "(if ";
            self.out.text.push_str(before);
            self.out
                .map
                .extend(places.into_iter().map(|piece| Mapped { mine: piece.mine + before.len(), ..piece }));
            self.out.text.push_str(&test);
            self.put("{");
            self.expression()?;
            self.expect(":")?;
            self.put("} else {");
            self.expression()?;
            self.put("})");
        }
        self.depth -= 1;
        Ok(())
    }

    fn binary(&mut self, level: usize) -> Result<(), Error> {
        const LEVELS: &[&[&str]] =
            &[&["||"], &["&&"], &["==", "!="], &["<", ">", "<=", ">="], &["+", "-"], &["*", "/", "%"]];
        let Some(signs) = LEVELS.get(level) else { return self.unary() };
        self.put("(");
        self.binary(level + 1)?;
        while let Some(sign) = self.peek().filter(|token| signs.iter().any(|sign| token.is(sign))) {
            self.next += 1;
            self.out.put(sign.text, sign.at);
            self.binary(level + 1)?;
        }
        self.put(")");
        Ok(())
    }

    fn unary(&mut self) -> Result<(), Error> {
        self.deeper()?;
        let Some(token) = self.peek() else { return Err(self.error("a value is missing", "Add one")) };
        match token.text {
            _ if token.kind == Kind::Text => self.postfix()?,
            "-" | "!" | "+" => {
                self.put(token.text);
                self.next += 1;
                self.unary()?;
            }
            // The distance between two points whose difference follows.
            "~" | "\u{2dc}" | "\u{223c}" => {
                self.put("length(");
                self.next += 1;
                self.unary()?;
                self.put(")");
            }
            "*" | "&" => {
                // Elements are referred to, never copied.
                self.next += 1;
                self.unary()?;
            }
            "(" if self.is_at(2, ")")
                && self.tokens.get(self.next + 1).is_some_and(|token| self.is_type(*token)) =>
            {
                let kind = self.tokens[self.next + 1].text;
                self.next += 3;
                self.put(match kind {
                    "int" | "long" => "to_whole(",
                    "double" | "float" => "to_number(",
                    "Point" => "to_point(",
                    _ => "(",
                });
                self.unary()?;
                self.put(")");
            }
            _ => self.postfix()?,
        }
        self.depth -= 1;
        Ok(())
    }

    fn postfix(&mut self) -> Result<(), Error> {
        let (start, kept) = (self.out.text.len(), self.out.map.len());
        let mut is_plain = self.primary()?;
        loop {
            if self.is(".") || self.is("->") {
                self.out.text.truncate(self.out.text.trim_end().len());
                self.next += 1;
                let Some(name) = self.take().filter(|token| token.kind == Kind::Name) else {
                    self.next -= 1;
                    return Err(self.error("a name is missing after the dot", "Write the name of a field"));
                };
                self.out.put(&format!(".{}", name.text), name.at);
                is_plain = true;
            } else if self.is("(") {
                self.out.text.truncate(self.out.text.trim_end().len());
                self.arguments()?;
                is_plain = false;
            } else if self.is("[") {
                self.out.text.truncate(self.out.text.trim_end().len());
                self.next += 1;
                if self.is("]") {
                    return Err(self.error("an index is missing", "Write a number between the brackets"));
                }
                self.put("[");
                self.expression()?;
                self.expect("]")?;
                self.put("]");
                is_plain = true;
            } else {
                break;
            }
        }
        // Counting inside of an expression: its value is the one before.
        let counts = self.peek().filter(|token| token.is("++") || token.is("--"));
        let is_inside = self.tokens.get(self.next + 1).is_none_or(|after| !after.is(";"))
            || kept > 0 && self.out.text[..start].trim_end().ends_with(['=', '(', ',', '[']);
        if let Some(sign) = counts.filter(|_| is_plain && is_inside) {
            self.next += 1;
            let place = self.out.text.split_off(start);
            if place.contains("{ let before") {
                return Err(self.source.error(
                    sign.at,
                    "counting inside of what is counted",
                    "Count before, in a statement of its own",
                ));
            }
            self.out.map.truncate(kept);
            let by = if sign.is("++") { "+=" } else { "-=" };
            let mut text = String::new();
            let _ = write!(text, "{{ let before = {place}; {place} {by} 1; before }}");
            self.out.put(&text, sign.at);
        }
        Ok(())
    }

    fn arguments(&mut self) -> Result<(), Error> {
        self.put("(");
        self.next += 1;
        while !self.is(")") {
            self.expression()?;
            if self.is(",") {
                self.put(",");
                self.next += 1;
            } else if !self.is(")") {
                return Err(self.error("the arguments have no end", "Close them with )"));
            }
        }
        self.put(")");
        self.next += 1;
        Ok(())
    }

    /// A value; true if it could be set.
    fn primary(&mut self) -> Result<bool, Error> {
        let Some(token) = self.peek() else { return Err(self.error("a value is missing", "Add one")) };
        match token.kind {
            Kind::Number => {
                let text = match token.text {
                    text if text.starts_with('.') => format!("0{text}"),
                    text if text.ends_with('.') => format!("{text}0"),
                    text => text.to_owned(),
                };
                self.put(&text);
                self.next += 1;
                if self
                    .peek()
                    .is_some_and(|suffix| suffix.at == token.end() && matches!(suffix.text, "f" | "F" | "L"))
                {
                    self.next += 1;
                }
                Ok(false)
            }
            Kind::Text => {
                self.put(token.text);
                self.next += 1;
                Ok(false)
            }
            Kind::Dollar => self.dollar(token).map(|()| false),
            Kind::Name if token.text == "new" => {
                self.next += 1;
                let Some(kind) = self.take().filter(|token| self.kinds.iter().any(|kind| kind == token.text))
                else {
                    self.next -= 1;
                    return Err(self.error(
                        "no element type follows 'new'",
                        format!("Use one of {}", self.kinds.join(", ")).as_str(),
                    ));
                };
                self.out.put(&format!("new_element(\"{}\")", kind.text), kind.at);
                if self.is("(") && self.is_at(1, ")") {
                    self.next += 2;
                }
                Ok(false)
            }
            Kind::Name => {
                self.put(token.text);
                self.next += 1;
                Ok(true)
            }
            _ if token.is("(") => {
                self.put("(");
                self.next += 1;
                self.expression()?;
                self.expect(")")?;
                self.put(")");
                Ok(false)
            }
            _ => Err(self.error(&format!("a value is missing before '{}'", token.text), "Add one")),
        }
    }

    /// The tokens of Table 1.
    fn dollar(&mut self, token: Token) -> Result<(), Error> {
        self.next += 1;
        let follows = self.peek().filter(|after| after.at == token.end());
        let is_element = token.text == "$$";
        let name = match follows {
            Some(after) if after.kind == Kind::Number => {
                self.next += 1;
                let place: usize = after.text.parse().unwrap_or(usize::MAX);
                if place >= self.statics {
                    self.next -= 1;
                    return Err(self.error(
                        &format!("the rule has no child number {place}"),
                        "Children are counted from 0, in the order of the rule's first line",
                    ));
                }
                if is_element { format!("child_{place}") } else { format!("proxy_{place}") }
            }
            Some(after) if after.text == "goal" => {
                self.next += 1;
                "goal".to_owned()
            }
            Some(after) if after.kind == Kind::Name => {
                self.next += 1;
                if is_element { after.text.to_owned() } else { format!("{}.proxy(0)", after.text) }
            }
            _ if is_element => "parent".to_owned(),
            _ => "proxy_of_parent".to_owned(),
        };
        // `$(k)`, `$j(k)`, `$var(k)`: another proxy of the same.
        if !is_element && name != "goal" && self.is("(") {
            let element = match name.as_str() {
                "proxy_of_parent" => "parent".to_owned(),
                name => match name.strip_suffix(".proxy(0)") {
                    Some(variable) => variable.to_owned(),
                    None => name.replacen("proxy_", "child_", 1),
                },
            };
            self.out.put(&format!("{element}.proxy"), token.at);
            self.out.text.truncate(self.out.text.trim_end().len());
            return self.arguments();
        }
        self.out.put(&name, token.at);
        Ok(())
    }
}
