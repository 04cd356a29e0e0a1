//! Entities of the document type declaration, and what referring to one costs.
//!
//! The declaration is cut exactly as the parser cuts it: an entity that one of the two sees
//! and the other does not would be a way around the limits.

use super::{after, over};
use crate::error::Error;
use crate::limits::Limits;
use std::collections::HashMap;

/// What one reference to an entity costs once everything in it is expanded.
#[derive(Clone, Copy)]
pub(super) struct Cost {
    pub bytes: usize,
    pub tags: usize,
    /// Signs of equality beside tags: an unfinished tag leaves its attributes to the next.
    pub attributes: usize,
}

/// The declared entities.
#[derive(Default)]
pub(super) struct Entities<'a> {
    costs: HashMap<&'a str, Cost>,
}

impl Entities<'_> {
    pub fn cost(&self, name: &str) -> Option<Cost> {
        self.costs.get(name).copied()
    }
}

/// Reads a document type declaration that starts at `start`; returns where it ends.
///
/// Errors on more entities than the limit.
pub(super) fn read<'a>(text: &'a str, start: usize, limits: &Limits) -> Result<(Entities<'a>, usize), Error> {
    let mut declared = HashMap::new();
    let mut order = Vec::new();
    let mut at = subset_start(text, start);
    let is_inside = |at: usize| at > 0 && text.as_bytes()[at - 1] == b'[';
    let mut inside = is_inside(at);
    while inside && at < text.len() {
        let rest = &text[at..];
        if rest.starts_with("<!--") {
            at = after(text, at + 4, "-->");
        } else if rest.starts_with("<?") {
            at = after(text, at + 2, "?>");
        } else if rest.starts_with("<!ENTITY") {
            let (name, value, end) = entity(text, at + 8);
            if let Some(value) = value {
                // Of two declarations the first counts.
                declared.entry(name).or_insert(value);
                order.push(name);
            }
            at = end;
        } else if rest.starts_with("<!") {
            at = after(text, at + 2, ">");
        } else if rest.starts_with(']') {
            inside = false;
            at = after(text, at, ">");
        } else {
            at += rest.chars().next().map_or(1, char::len_utf8);
        }
        if order.len() > limits.entities {
            let sentence = format!("The drawing declares more than {} entities", limits.entities);
            return Err(over(text, "entity-expansion", start, sentence));
        }
    }
    let mut entities = Entities::default();
    for name in order {
        let cost = cost_of(declared[name], &entities, &declared, limits);
        entities.costs.entry(name).or_insert(cost);
    }
    Ok((entities, at))
}

/// The place after the `[` of the internal subset, or after the `>` if there is none.
fn subset_start(text: &str, start: usize) -> usize {
    let bytes = text.as_bytes();
    let mut at = start + "<!DOCTYPE".len();
    while at < bytes.len() {
        match bytes[at] {
            quote @ (b'"' | b'\'') => at = quote_end(bytes, at + 1, quote),
            b'[' | b'>' => return at + 1,
            _ => {}
        }
        at += 1;
    }
    bytes.len()
}

fn quote_end(bytes: &[u8], from: usize, quote: u8) -> usize {
    bytes.get(from..).and_then(|rest| rest.iter().position(|&b| b == quote)).map_or(bytes.len(), |i| from + i)
}

/// Name, value (if it is a literal one) and end of `<!ENTITY`. A parameter entity counts as
/// a general one, because it does for the parser.
fn entity(text: &str, at: usize) -> (&str, Option<&str>, usize) {
    let bytes = text.as_bytes();
    let body = text[at..].trim_start();
    let body = body.strip_prefix('%').map_or(body, str::trim_start);
    let is_end = |c: char| c.is_ascii_whitespace() || matches!(c, '>' | '"' | '\'' | '<' | '&' | ';');
    let name = &body[..body.find(is_end).unwrap_or(body.len())];
    let mut i = text.len() - body.len() + name.len();
    let is_external = body[name.len()..].trim_start().starts_with(['S', 'P']);
    let mut value = None;
    while i < bytes.len() && bytes[i] != b'>' {
        if let quote @ (b'"' | b'\'') = bytes[i] {
            let end = quote_end(bytes, i + 1, quote);
            value = value.or(text.get(i + 1..end));
            i = end;
        }
        i += 1;
    }
    (name, value.filter(|_| !is_external), (i + 1).min(bytes.len()))
}

/// A value may name only entities declared before it for its cost to count; one declared
/// later is a cycle or a forward reference, which costs as much as the limit.
fn cost_of(value: &str, entities: &Entities, declared: &HashMap<&str, &str>, limits: &Limits) -> Cost {
    let tags = value.matches('<').count();
    if !is_balanced(value) {
        return Cost { bytes: limits.expansion + 1, tags, attributes: 0 };
    }
    let attributes = if tags > 0 { value.matches('=').count() } else { 0 };
    let mut cost = Cost { bytes: value.len(), tags, attributes };
    for (at, _) in value.match_indices('&') {
        let Some((name, _)) = reference_at(value, at) else { continue };
        let inner = match entities.cost(name) {
            Some(inner) => inner,
            None if declared.contains_key(name) => Cost { bytes: limits.expansion, tags: 0, attributes: 0 },
            None => continue,
        };
        cost.bytes = cost.bytes.saturating_add(inner.bytes);
        cost.tags = cost.tags.saturating_add(inner.tags);
        cost.attributes = cost.attributes.saturating_add(inner.attributes);
    }
    cost
}

/// True if every tag that a value opens it also closes. Otherwise one reference nests the
/// next, beyond any limit of depth.
fn is_balanced(value: &str) -> bool {
    let count = |what: &str| value.matches(what).count();
    let (opened, closed) = (count("<") - count("</") - count("<!") - count("<?"), count("</") + count("/>"));
    opened == closed
}

/// True for the references that stand for one character, which every XML text may use.
pub(super) fn is_predefined(name: &str) -> bool {
    name.starts_with('#') || matches!(name, "lt" | "gt" | "amp" | "apos" | "quot")
}

/// Name and end of the reference whose `&` stands at `at`.
pub(super) fn reference_at(text: &str, at: usize) -> Option<(&str, usize)> {
    const LONGEST_NAME: usize = 256;
    let name_start = at + 1;
    let rest = text.as_bytes().get(name_start..)?;
    let length = rest.iter().take(LONGEST_NAME).position(|&b| b == b';')?;
    Some((text.get(name_start..name_start + length)?, name_start + length + 1))
}
