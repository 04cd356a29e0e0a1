//! Expressions, and the paper's dollar signs (Table 1).

use super::{Mapped, Translator};
use crate::grow::rules::lexer::{Kind, Token};
use rinceau_format::Error;
use std::fmt::Write;

impl<'t> Translator<'_, 't> {
    /// `a ? b : c` and all that binds closer.
    pub(super) fn expression(&mut self) -> Result<(), Error> {
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

    pub(super) fn unary(&mut self) -> Result<(), Error> {
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

    pub(super) fn postfix(&mut self) -> Result<(), Error> {
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
