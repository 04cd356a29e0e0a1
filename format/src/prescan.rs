//! A linear look over the text before the XML parser sees it, so that nesting, attribute
//! floods and entity bombs are refused by a sentence instead of by running out of memory.
//!
//! This is not a parser: on malformed text it may miscount, and the parser then reports the
//! malformed place. It never recurses and never allocates more than the entity table.

use crate::error::{Error, Position};
use crate::limits::Limits;
use std::collections::BTreeMap;

/// Refuses text that exceeds the limits.
pub(crate) fn prescan(text: &str, limits: &Limits) -> Result<(), Error> {
    let mut scan = Scan {
        text,
        bytes: text.as_bytes(),
        limits,
        nodes: 0,
        depth: 0,
        expansion: 0,
        entities: BTreeMap::new(),
    };
    scan.run()
}

/// What one reference to a general entity costs once everything in it is expanded.
#[derive(Clone, Copy)]
struct Cost {
    bytes: usize,
    tags: usize,
}

struct Scan<'a> {
    text: &'a str,
    bytes: &'a [u8],
    limits: &'a Limits,
    nodes: usize,
    depth: usize,
    expansion: usize,
    entities: BTreeMap<&'a str, Cost>,
}

impl<'a> Scan<'a> {
    fn run(&mut self) -> Result<(), Error> {
        let mut at = 0;
        while at < self.bytes.len() {
            match self.bytes[at] {
                b'<' => {
                    self.nodes += 1;
                    if self.nodes > self.limits.nodes {
                        return Err(self.over(
                            "too-many-nodes",
                            at,
                            format!("The drawing has more than {} objects", self.limits.nodes),
                        ));
                    }
                    at = self.markup(at)?;
                }
                b'&' => at = self.reference(at)?,
                _ => at += 1,
            }
        }
        Ok(())
    }

    fn markup(&mut self, at: usize) -> Result<usize, Error> {
        let rest = &self.bytes[at..];
        if rest.starts_with(b"<!--") {
            Ok(self.after(at + 4, "-->"))
        } else if rest.starts_with(b"<![CDATA[") {
            Ok(self.after(at + 9, "]]>"))
        } else if rest.starts_with(b"<?") {
            Ok(self.after(at + 2, "?>"))
        } else if rest.starts_with(b"<!DOCTYPE") {
            self.doctype(at + 9)
        } else if rest.starts_with(b"</") {
            self.depth = self.depth.saturating_sub(1);
            Ok(self.after(at + 2, ">"))
        } else {
            self.start_tag(at)
        }
    }

    fn start_tag(&mut self, start: usize) -> Result<usize, Error> {
        let (mut attributes, mut namespaces) = (0, 0);
        let mut at = start + 1;
        while at < self.bytes.len() {
            match self.bytes[at] {
                quote @ (b'"' | b'\'') => {
                    at += 1;
                    while at < self.bytes.len() && self.bytes[at] != quote {
                        at = if self.bytes[at] == b'&' { self.reference(at)? } else { at + 1 };
                    }
                    at += 1;
                }
                b'=' => {
                    let name_is_namespace = self.text[start..at]
                        .trim_end()
                        .rsplit(|c: char| c.is_whitespace() || c == '"' || c == '\'')
                        .next()
                        .is_some_and(|name| name == "xmlns" || name.starts_with("xmlns:"));
                    if name_is_namespace {
                        namespaces += 1
                    } else {
                        attributes += 1
                    }
                    at += 1;
                }
                b'>' => {
                    if self.bytes[at - 1] != b'/' {
                        self.depth += 1;
                    }
                    break;
                }
                _ => at += 1,
            }
        }
        if attributes > self.limits.attributes || namespaces > self.limits.namespaces {
            let what = format!(
                "An object has more than {} attributes or {} namespace declarations",
                self.limits.attributes, self.limits.namespaces
            );
            return Err(self.over("too-many-attributes", start, what));
        }
        if self.depth > self.limits.depth {
            return Err(self.over(
                "too-deep",
                start,
                format!("Objects are nested more than {} deep", self.limits.depth),
            ));
        }
        Ok(at + 1)
    }

    /// Adds up what a reference will expand to; predefined and numeric ones cost nothing.
    fn reference(&mut self, at: usize) -> Result<usize, Error> {
        let Some((name, end)) = reference_at(self.text, at) else { return Ok(at + 1) };
        if let Some(&cost) = self.entities.get(name) {
            self.expansion = self.expansion.saturating_add(cost.bytes);
            self.nodes = self.nodes.saturating_add(cost.tags);
            if self.expansion > self.limits.expansion
                || self.nodes > self.limits.nodes
                || self.depth + cost.tags > self.limits.depth
            {
                return Err(self.over(
                    "entity-expansion",
                    at,
                    format!(
                        "Entities such as '&{name};' expand to more than {} KiB",
                        self.limits.expansion >> 10
                    ),
                ));
            }
        }
        Ok(end)
    }

    /// Reads the internal subset: entity values are costed in order of declaration. A value
    /// may name only entities declared before it for its cost to count; one declared later
    /// is a cycle or a forward reference, which costs as much as the limit.
    fn doctype(&mut self, mut at: usize) -> Result<usize, Error> {
        let mut inside = false;
        let mut declared: Vec<(&'a str, &'a str)> = Vec::new();
        while at < self.bytes.len() {
            let rest = &self.bytes[at..];
            if rest.starts_with(b"<!--") {
                at = self.after(at + 4, "-->");
            } else if rest.starts_with(b"<?") {
                at = self.after(at + 2, "?>");
            } else if inside && rest.starts_with(b"<!ENTITY") {
                let (name, value, end) = self.entity(at + 8);
                if let Some(value) = value {
                    declared.push((name, value));
                }
                at = end;
            } else {
                match self.bytes[at] {
                    quote @ (b'"' | b'\'') => at = self.after(at + 1, if quote == b'"' { "\"" } else { "'" }),
                    b'[' => {
                        inside = true;
                        at += 1;
                    }
                    b']' => {
                        inside = false;
                        at += 1;
                    }
                    b'>' if !inside => {
                        at += 1;
                        break;
                    }
                    _ => at += 1,
                }
            }
        }
        for (name, value) in &declared {
            let cost = self.cost_of(value, &declared);
            self.entities.entry(name).or_insert(cost);
        }
        Ok(at)
    }

    fn cost_of(&self, value: &str, declared: &[(&'a str, &'a str)]) -> Cost {
        let mut cost = Cost { bytes: value.len(), tags: value.matches('<').count() };
        for (at, _) in value.match_indices('&') {
            let Some((name, _)) = reference_at(value, at) else { continue };
            let inner = match self.entities.get(name) {
                Some(&inner) => inner,
                None if declared.iter().any(|(other, _)| *other == name) => {
                    Cost { bytes: self.limits.expansion, tags: 0 }
                }
                None => continue,
            };
            cost.bytes = cost.bytes.saturating_add(inner.bytes);
            cost.tags = cost.tags.saturating_add(inner.tags);
        }
        cost
    }

    /// Name, value (if it is a general entity with a literal value) and end of `<!ENTITY`.
    fn entity(&self, at: usize) -> (&'a str, Option<&'a str>, usize) {
        let body = &self.text[at..];
        let trimmed = body.trim_start();
        let name = trimmed.split(|c: char| c.is_whitespace() || c == '>').next().unwrap_or("");
        let mut i = at + (body.len() - trimmed.len()) + name.len();
        let mut value = None;
        while i < self.bytes.len() && self.bytes[i] != b'>' {
            if let quote @ (b'"' | b'\'') = self.bytes[i] {
                let end = self.bytes[i + 1..]
                    .iter()
                    .position(|&b| b == quote)
                    .map_or(self.bytes.len(), |n| i + 1 + n);
                value = value.or(self.text.get(i + 1..end));
                i = end;
            }
            i += 1;
        }
        (name, if name == "%" { None } else { value }, (i + 1).min(self.bytes.len()))
    }

    fn after(&self, from: usize, end: &str) -> usize {
        let from = from.min(self.bytes.len());
        find(&self.bytes[from..], end.as_bytes()).map_or(self.bytes.len(), |i| from + i + end.len())
    }

    fn over(&self, code: &'static str, at: usize, sentence: String) -> Error {
        Error::new(code, sentence, "Copy what is to be filled into a new drawing")
            .at(Position::of(self.text, at))
    }
}

fn reference_at(text: &str, at: usize) -> Option<(&str, usize)> {
    const LONGEST_NAME: usize = 256;
    let name_start = at + 1;
    let rest = text.as_bytes().get(name_start..)?;
    let length = rest.iter().take(LONGEST_NAME).position(|&b| b == b';')?;
    Some((text.get(name_start..name_start + length)?, name_start + length + 1))
}

fn find(haystack: &[u8], needle: &[u8]) -> Option<usize> {
    let first = needle[0];
    let mut from = 0;
    while let Some(i) = haystack[from..].iter().position(|&b| b == first) {
        if haystack[from + i..].starts_with(needle) {
            return Some(from + i);
        }
        from += i + 1;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn code(text: &str, limits: &Limits) -> Option<&'static str> {
        prescan(text, limits).err().map(|error| error.code())
    }

    #[test]
    fn limits_hold_exactly_at_the_edge() {
        let limits = Limits { depth: 5, nodes: 20, attributes: 3, namespaces: 2, ..Limits::default() };
        let nested = |n: usize| "<g>".repeat(n) + &"</g>".repeat(n);
        assert_eq!(code(&nested(4), &limits), None);
        assert_eq!(code(&nested(5), &limits), None);
        assert_eq!(code(&nested(6), &limits), Some("too-deep"));
        assert_eq!(code(&"<g/>".repeat(20), &limits), None);
        assert_eq!(code(&"<g/>".repeat(21), &limits), Some("too-many-nodes"));
        assert_eq!(code("<g a='1' b='2' c='=>' xmlns='x' xmlns:y = 'z'/>", &limits), None);
        assert_eq!(code("<g a='1' b='2' c='3' d='4'/>", &limits), Some("too-many-attributes"));
        assert_eq!(code("<g xmlns:a='1' xmlns:b='2' xmlns='3'/>", &limits), Some("too-many-attributes"));
    }

    #[test]
    fn entity_bombs_are_refused_and_old_inkscape_files_are_not() {
        let limits = Limits::default();
        let old = r#"<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" "x.dtd" [<!ENTITY ns_svg "http://www.w3.org/2000/svg">]><svg xmlns="&ns_svg;"/>"#;
        assert_eq!(code(old, &limits), None);
        let mut bomb = String::from("<!DOCTYPE s [<!ENTITY a0 \"aaaaaaaaaaaaaaaa\">");
        for i in 1..12 {
            bomb += &format!("<!ENTITY a{i} \"{}\">", format!("&a{};", i - 1).repeat(10));
        }
        assert_eq!(code(&(bomb + "]><s>&a11;</s>"), &limits), Some("entity-expansion"));
        let cycle = "<!DOCTYPE s [<!ENTITY a '&b;&b;'><!ENTITY b '&a;'>]><s>&a;</s>";
        assert_eq!(code(cycle, &limits), Some("entity-expansion"));
        let quadratic =
            format!("<!DOCTYPE s [<!ENTITY a '{}'>]><s x='{}'/>", "x".repeat(10_000), "&a;".repeat(200));
        assert_eq!(code(&quadratic, &limits), Some("entity-expansion"));
    }

    #[test]
    fn malformed_text_ends() {
        for text in
            ["<", "<!--", "<![CDATA[", "<!DOCTYPE [", "<!DOCTYPE x [<!ENTITY", "<a b='", "&", "<é='&", "</"]
        {
            let _ = prescan(text, &Limits::default());
        }
    }
}
