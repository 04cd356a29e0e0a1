//! A linear look over the text before the XML parser sees it, so that nesting, attribute
//! floods and entity bombs are refused by a sentence instead of by running out of memory.
//!
//! This is not a parser: on malformed text it may miscount, and the parser then reports the
//! malformed place. It never recurses and never allocates more than the entity table and one
//! number for each open element.

mod doctype;

use crate::error::{Error, Position};
use crate::limits::Limits;
use doctype::Entities;
use memchr::{memchr_iter, memchr2};

/// Comparisons of names that the parser may make because of long lists of attributes or
/// namespaces (about half a second). It compares each with each.
const COMPARISONS: usize = 200_000_000;
/// An element with fewer attributes is not held against the drawing.
const FEW_ATTRIBUTES: usize = 64;
/// The parser reserves room for this many `<` and `=` before it looks at any of them: so
/// many times the limit of nodes are room enough.
const SIGNS_PER_NODE: [(u8, usize); 2] = [(b'<', 4), (b'=', 16)];
/// Bytes that are scanned before their signs are counted.
const STRETCH: usize = 1 << 14;
/// A reference to an entity is looked up by comparing names, so an empty one has a price too.
const LEAST_COST: usize = 16;

/// Refuses text that exceeds the limits.
pub(crate) fn prescan(text: &str, limits: &Limits) -> Result<(), Error> {
    let mut scan = Scan {
        text,
        bytes: text.as_bytes(),
        limits,
        nodes: 0,
        counted: 0,
        signs: [0; SIGNS_PER_NODE.len()],
        scopes: Vec::new(),
        expansion: 0,
        comparisons: 0,
        entity_attributes: 0,
        entities: Entities::default(),
    };
    scan.run()
}

fn too_many_nodes(limits: &Limits) -> String {
    format!("The drawing has more than {} objects", limits.nodes)
}

fn over(text: &str, code: &'static str, at: usize, sentence: impl AsRef<str>) -> Error {
    Error::new(code, sentence, "Copy what is to be filled into a new drawing").at(Position::of(text, at))
}

struct Scan<'a> {
    text: &'a str,
    bytes: &'a [u8],
    limits: &'a Limits,
    nodes: usize,
    /// How far the signs that the parser reserves room for are counted, and how many there are.
    counted: usize,
    signs: [usize; SIGNS_PER_NODE.len()],
    /// For each open element, the namespace declarations in scope.
    scopes: Vec<usize>,
    expansion: usize,
    comparisons: usize,
    entity_attributes: usize,
    entities: Entities<'a>,
}

impl Scan<'_> {
    fn run(&mut self) -> Result<(), Error> {
        let mut at = 0;
        while let Some(skipped) = memchr2(b'<', b'&', &self.bytes[at..]) {
            at += skipped;
            // While the text is still in the processor's cache.
            if at - self.counted >= STRETCH {
                self.count_signs(at)?;
            }
            if self.bytes[at] == b'&' {
                at = self.reference(at)?;
                continue;
            }
            self.nodes += 1;
            if self.nodes > self.limits.nodes {
                return Err(over(self.text, "too-many-nodes", at, too_many_nodes(self.limits)));
            }
            at = self.markup(at)?;
        }
        self.count_signs(self.bytes.len())
    }

    /// Counts the signs up to a place.
    fn count_signs(&mut self, to: usize) -> Result<(), Error> {
        let stretch = &self.bytes[self.counted..to];
        self.counted = to;
        for ((sign, most), count) in SIGNS_PER_NODE.iter().zip(&mut self.signs) {
            *count += memchr_iter(*sign, stretch).count();
            if *count > self.limits.nodes.saturating_mul(*most) {
                return Err(over(self.text, "too-many-nodes", 0, too_many_nodes(self.limits)));
            }
        }
        Ok(())
    }

    fn markup(&mut self, at: usize) -> Result<usize, Error> {
        let rest = &self.bytes[at..];
        if rest.starts_with(b"<!--") {
            Ok(after(self.text, at + 4, "-->"))
        } else if rest.starts_with(b"<![CDATA[") {
            Ok(after(self.text, at + 9, "]]>"))
        } else if rest.starts_with(b"<?") {
            Ok(after(self.text, at + 2, "?>"))
        } else if rest.starts_with(b"<!DOCTYPE") {
            let (entities, end) = doctype::read(self.text, at, self.limits)?;
            self.entities = entities;
            Ok(end)
        } else if rest.starts_with(b"</") {
            self.scopes.pop();
            Ok(after(self.text, at + 2, ">"))
        } else {
            self.start_tag(at)
        }
    }

    fn start_tag(&mut self, start: usize) -> Result<usize, Error> {
        let (mut attributes, mut namespaces) = (0, 0);
        let mut name_start = start + 1;
        let mut at = start + 1;
        while at < self.bytes.len() {
            match self.bytes[at] {
                quote @ (b'"' | b'\'') => {
                    at = self.value_end(at + 1, quote)?;
                    name_start = at + 1;
                }
                b' ' | b'\t' | b'\r' | b'\n' if self.bytes.get(at + 1).is_some_and(|&b| is_name(b)) => {
                    name_start = at + 1;
                }
                b'=' => {
                    let name = self.bytes[name_start.min(at)..at].trim_ascii_end();
                    let is_namespace = name == b"xmlns" || name.starts_with(b"xmlns:");
                    if is_namespace {
                        namespaces += 1
                    } else {
                        attributes += 1
                    }
                    if attributes > self.limits.attributes || namespaces > self.limits.namespaces {
                        return Err(self.too_many_attributes(start));
                    }
                    name_start = at + 1;
                }
                b'>' => break,
                _ => {}
            }
            at += 1;
        }
        let scope = self.scopes.last().copied().unwrap_or(0) + namespaces;
        self.compare(start, attributes, namespaces, scope)?;
        if self.bytes.get(at.saturating_sub(1)) != Some(&b'/') {
            self.scopes.push(scope);
        }
        if self.scopes.len() > self.limits.depth {
            let sentence = format!("Objects are nested more than {} deep", self.limits.depth);
            return Err(over(self.text, "too-deep", start, sentence));
        }
        Ok((at + 1).min(self.bytes.len()))
    }

    /// The closing quote of an attribute value.
    fn value_end(&mut self, from: usize, quote: u8) -> Result<usize, Error> {
        let mut at = from;
        while let Some(skipped) = memchr2(quote, b'&', &self.bytes[at..]) {
            at += skipped;
            if self.bytes[at] == quote {
                return Ok(at);
            }
            at = self.reference(at)?;
        }
        Ok(self.bytes.len())
    }

    /// Counts what the parser will compare for a tag.
    fn compare(&mut self, at: usize, attributes: usize, own: usize, scope: usize) -> Result<(), Error> {
        if attributes > FEW_ATTRIBUTES {
            self.comparisons += attributes * attributes;
        }
        if own > 0 {
            self.comparisons += scope * own;
        }
        if scope > 4 * self.limits.namespaces || self.comparisons > COMPARISONS {
            return Err(self.too_many_attributes(at));
        }
        Ok(())
    }

    fn too_many_attributes(&self, at: usize) -> Error {
        let sentence = format!(
            "Objects have more than {} attributes or {} namespace declarations",
            self.limits.attributes, self.limits.namespaces
        );
        over(self.text, "too-many-attributes", at, sentence)
    }

    /// Adds up what a reference will expand to; predefined and numeric ones cost nothing.
    fn reference(&mut self, at: usize) -> Result<usize, Error> {
        let Some((name, end)) = doctype::reference_at(self.text, at) else { return Ok(at + 1) };
        if doctype::is_predefined(name) {
            return Ok(end);
        }
        // What is not in the table must not be left to the parser, which might know it.
        let Some(cost) = self.entities.cost(name) else {
            return Err(Error::new(
                "unknown-entity",
                format!("The drawing uses an entity '&{name};' that it does not declare"),
                "Open it in Inkscape and save it again as SVG",
            )
            .at(Position::of(self.text, at)));
        };
        self.expansion = self.expansion.saturating_add(cost.bytes.max(LEAST_COST));
        self.nodes = self.nodes.saturating_add(cost.tags);
        self.entity_attributes = self.entity_attributes.saturating_add(cost.attributes);
        if self.expansion > self.limits.expansion
            || self.nodes > self.limits.nodes
            || self.scopes.len().saturating_add(cost.tags) > self.limits.depth
            || self.entity_attributes > self.limits.attributes
        {
            let kib = self.limits.expansion >> 10;
            let sentence = format!("Entities such as '&{name};' expand to more than {kib} KiB");
            return Err(over(self.text, "entity-expansion", at, sentence));
        }
        Ok(end)
    }
}

/// True for a byte that can start a name; for finding where one starts this is enough.
fn is_name(byte: u8) -> bool {
    !byte.is_ascii_whitespace() && byte != b'='
}

/// The place after the next `end`, or the end of the text.
fn after(text: &str, from: usize, end: &str) -> usize {
    let rest = text.get(from..).unwrap_or("");
    rest.find(end).map_or(text.len(), |i| from + i + end.len())
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

    #[test]
    fn what_is_in_a_declaration_cannot_hide_an_entity() {
        let hidden = "<!DOCTYPE s [<!ELEMENT x '><!ENTITY a \"aaaa\"><!ELEMENT y '>]><s>&a;</s>";
        assert_eq!(code(hidden, &Limits::default()), None);
        let limits = Limits { expansion: 15, ..Limits::default() };
        assert_eq!(code(hidden, &limits), Some("entity-expansion"));
        assert_eq!(code("<s>&nbsp;</s>", &limits), Some("unknown-entity"));
        assert_eq!(code("<s>&lt;&#x41;&#65;</s>", &limits), None);
    }

    #[test]
    fn the_number_of_entities_is_limited() {
        let limits = Limits { entities: 3, ..Limits::default() };
        let with = |n: usize| {
            let declared: String = (0..n).map(|i| format!("<!ENTITY e{i} ''>")).collect();
            code(&format!("<!DOCTYPE s [{declared}]><s/>"), &limits)
        };
        assert_eq!((with(2), with(3), with(4)), (None, None, Some("entity-expansion")));
    }

    #[test]
    fn namespaces_in_scope_are_bounded() {
        let level: String = (0..200).map(|i| format!(" xmlns:a{i}='u'")).collect();
        let nested = format!("<g{level}>").repeat(900);
        assert_eq!(code(&nested, &Limits::default()), Some("too-many-attributes"));
    }
}
