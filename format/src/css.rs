//! Style sheets and declarations: split here, selectors read by simplecss.
//!
//! simplecss finds the position of an error by counting from the top, once for every
//! declaration, which is quadratic in the length of a sheet. So it only ever sees one
//! selector or one declaration. Matching is metered: a selector with many combinators takes
//! time beyond any bound on a deep drawing.

use crate::xml::PlainAttribute;
use roxmltree::Node;
use simplecss::{AttributeOperator, Declaration, PseudoClass, Selector};
use std::cell::Cell;
use std::collections::HashMap;
use std::rc::Rc;

/// Steps that matching may take over a whole drawing (about a second). An Illustrator drawing
/// of 100,000 objects takes one step an object and attribute.
const STEPS: usize = 30_000_000;
/// A selector with more parts is left out: matching recurses once per part.
const LONGEST_SELECTOR: usize = 64;
/// A declaration with a longer value is left out, as one that is not understood.
const LONGEST_VALUE: usize = 4096;

struct Rule<'a> {
    selector: Selector<'a>,
    declarations: Rc<[Declaration<'a>]>,
}

/// The rules of a drawing's style sheets, weakest first.
pub(crate) struct Sheet<'a> {
    rules: Vec<Rule<'a>>,
    /// Rules for one class or one tag name and nothing else (nearly all that editors write),
    /// by that class, with a dot before it, or that name.
    simple: HashMap<String, Vec<usize>>,
    /// All other rules; each has to be tried on each object.
    general: Vec<usize>,
    steps: Cell<usize>,
}

impl<'a> Sheet<'a> {
    pub fn new(sheets: &[&'a str]) -> Self {
        let mut rules = Vec::new();
        for text in sheets {
            add_rules(text, &mut rules);
        }
        // Stable: of two equally specific rules the later one wins.
        rules.sort_by_cached_key(|rule| rule.selector.specificity());
        let (mut simple, mut general) = (HashMap::new(), Vec::new());
        for (i, rule) in rules.iter().enumerate() {
            match simple_key(&rule.selector.to_string()) {
                Some(key) => simple.entry(key).or_insert_with(Vec::new).push(i),
                None => general.push(i),
            }
        }
        Sheet { rules, simple, general, steps: Cell::new(STEPS) }
    }

    /// True once matching has used up its steps; what was matched then is incomplete.
    pub fn is_exhausted(&self) -> bool {
        self.steps.get() == 0
    }

    /// The declarations for a node, weakest first.
    pub fn matching(&self, node: Node<'a, '_>) -> Vec<Declaration<'a>> {
        let rules = self.matching_rules(node).into_iter();
        rules.flat_map(|i| self.rules[i].declarations.iter().copied()).collect()
    }

    /// All declarations for a node, if some of them are for its id.
    pub fn matching_by_id(&self, node: Node<'a, '_>) -> Vec<Declaration<'a>> {
        let rules = self.matching_rules(node);
        // The first of the three numbers counts ids.
        let is_by_id = |i: &usize| self.rules[*i].selector.specificity()[0] > 0;
        if !rules.iter().any(is_by_id) {
            return Vec::new();
        }
        rules.into_iter().flat_map(|i| self.rules[i].declarations.iter().copied()).collect()
    }

    /// True if some rule declares a property.
    pub fn declares(&self, property: &str) -> bool {
        self.rules.iter().any(|rule| rule.declarations.iter().any(|d| d.name == property))
    }

    fn matching_rules(&self, node: Node<'a, '_>) -> Vec<usize> {
        if self.rules.is_empty() {
            return Vec::new();
        }
        let classes = node.plain("class").unwrap_or("").split_ascii_whitespace();
        let keys = classes.map(|class| format!(".{class}")).chain([node.tag_name().name().to_owned()]);
        let mut found: Vec<usize> = Vec::new();
        for rules in keys.filter_map(|key| self.simple.get(&key)) {
            spend(&self.steps, rules.len());
            found.extend(rules);
        }
        let element = CssNode { node, steps: &self.steps };
        for &i in &self.general {
            spend(&self.steps, 1);
            if self.is_exhausted() {
                break;
            }
            if self.rules[i].selector.matches(&element) {
                found.push(i);
            }
        }
        found.sort_unstable();
        found.dedup();
        found
    }
}

/// The key of a selector (as simplecss prints it) that is one class or one tag name.
fn simple_key(selector: &str) -> Option<String> {
    let is_plain = |text: &str| !text.is_empty() && !text.contains(['\'', '[', ' ', ':', '*', '>', '+']);
    let class = selector.strip_prefix("*[class~='").and_then(|rest| rest.strip_suffix("']"));
    match class {
        Some(class) => is_plain(class).then(|| format!(".{class}")),
        None => is_plain(selector).then(|| selector.to_owned()),
    }
}

fn spend(steps: &Cell<usize>, cost: usize) {
    steps.set(steps.get().saturating_sub(cost));
}

fn add_rules<'a>(text: &'a str, rules: &mut Vec<Rule<'a>>) {
    let mut rest = text;
    while let Some(open) = top_level(rest, b"{;") {
        let (prelude, after) = (&rest[..open], &rest[open + 1..]);
        let is_at_rule = without_comments(prelude).starts_with('@');
        if rest.as_bytes()[open] == b';' {
            // `@import ...;`, which is never followed. A stray `;` belongs to the selector.
            rest = after;
            continue;
        }
        let close = block_end(after);
        let block = &after[..close];
        rest = after.get(close + 1..).unwrap_or("");
        if is_at_rule {
            continue;
        }
        let declarations: Rc<[Declaration]> = declarations(block).collect();
        for selector in pieces(prelude, b',').filter_map(|text| Selector::parse(without_comments(text))) {
            let parts = selector.to_string().matches([' ', '>', '+']).count();
            if parts < LONGEST_SELECTOR && !declarations.is_empty() {
                rules.push(Rule { selector, declarations: declarations.clone() });
            }
        }
    }
}

/// The declarations of a block or a `style` attribute; one that is broken does not hide the
/// others.
pub(crate) fn declarations(text: &str) -> impl Iterator<Item = Declaration<'_>> {
    pieces(text, b';')
        .filter(|piece| piece.len() <= LONGEST_VALUE && piece.contains(':'))
        .filter_map(|piece| simplecss::DeclarationTokenizer::from(piece).next())
}

/// The text between separators that stand outside strings, brackets and comments.
fn pieces(text: &str, separator: u8) -> impl Iterator<Item = &str> {
    let mut rest = Some(text);
    std::iter::from_fn(move || {
        let text = rest?;
        let end = top_level(text, &[separator]);
        rest = end.map(|end| &text[end + 1..]);
        Some(&text[..end.unwrap_or(text.len())])
    })
}

/// Where one of the (ASCII) `stops` first stands outside strings, brackets and comments.
fn top_level(text: &str, stops: &[u8]) -> Option<usize> {
    let bytes = text.as_bytes();
    let (mut at, mut brackets) = (0, 0_usize);
    while at < bytes.len() {
        match bytes[at] {
            b'/' if bytes[at..].starts_with(b"/*") => {
                at = text[at + 2..].find("*/").map_or(bytes.len(), |end| at + end + 4);
                continue;
            }
            quote @ (b'"' | b'\'') => at = string_end(bytes, at + 1, quote),
            b'\\' => at += 1,
            b if brackets == 0 && stops.contains(&b) => return Some(at),
            b'(' | b'[' => brackets += 1,
            b')' | b']' => brackets = brackets.saturating_sub(1),
            _ => {}
        }
        at += 1;
    }
    None
}

/// The closing quote, or the end of the line, which ends a string that was never closed.
fn string_end(bytes: &[u8], from: usize, quote: u8) -> usize {
    let mut at = from;
    while at < bytes.len() && bytes[at] != quote && bytes[at] != b'\n' {
        at += if bytes[at] == b'\\' { 2 } else { 1 };
    }
    at
}

/// The `}` that closes a block, or the end of the text.
fn block_end(text: &str) -> usize {
    let (mut from, mut depth) = (0, 0_usize);
    while let Some(at) = top_level(&text[from..], b"{}").map(|at| from + at) {
        match text.as_bytes()[at] {
            b'{' => depth += 1,
            _ if depth == 0 => return at,
            _ => depth -= 1,
        }
        from = at + 1;
    }
    text.len()
}

fn without_comments(text: &str) -> &str {
    let mut rest = text.trim_start();
    while let Some(comment) = rest.strip_prefix("/*") {
        rest = comment.split_once("*/").map_or("", |(_, after)| after.trim_start());
    }
    rest
}

/// A node as simplecss wants to see it. Every look costs steps, and none are left for a
/// selector that has used them up: its loops then end at once.
struct CssNode<'s, 'a, 'i> {
    node: Node<'a, 'i>,
    steps: &'s Cell<usize>,
}

impl CssNode<'_, '_, '_> {
    fn left(&self, cost: usize) -> bool {
        spend(self.steps, cost);
        self.steps.get() > 0
    }
}

impl simplecss::Element for CssNode<'_, '_, '_> {
    fn parent_element(&self) -> Option<Self> {
        let parent = self.node.parent_element().filter(|_| self.left(1))?;
        Some(CssNode { node: parent, steps: self.steps })
    }

    fn prev_sibling_element(&self) -> Option<Self> {
        let mut siblings = self.node.prev_siblings().skip(1).take_while(|_| self.left(1));
        let node = siblings.find(Node::is_element)?;
        Some(CssNode { node, steps: self.steps })
    }

    fn has_local_name(&self, name: &str) -> bool {
        self.left(1) && self.node.tag_name().name() == name
    }

    fn attribute_matches(&self, local_name: &str, operator: AttributeOperator) -> bool {
        let value = self.node.attribute(local_name);
        let cost = 1 + self.node.attributes().len() / 8 + value.map_or(0, str::len) / 32;
        self.left(cost) && value.is_some_and(|value| operator.matches(value))
    }

    fn pseudo_class_matches(&self, class: PseudoClass) -> bool {
        matches!(class, PseudoClass::FirstChild) && self.prev_sibling_element().is_none()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Vec<(&str, &str)> {
        declarations(text).map(|d| (d.name, d.value)).collect()
    }

    #[test]
    fn declarations_survive_a_broken_neighbour() {
        assert_eq!(read("fill:red;;stroke:;x;opacity:.5"), [("fill", "red"), ("opacity", ".5")]);
        assert_eq!(
            read("a:url(data:x;y);font-family:'a;b'"),
            [("a", "url(data:x;y)"), ("font-family", "'a;b'")]
        );
        assert_eq!(read("/* ; */ a:b /* : */ ;c:d !important"), [("a", "b"), ("c", "d")]);
    }

    #[test]
    fn sheets_are_split_into_rules() {
        let text = "@import 'x;}';@media print{.a{fill:red}} /*.b{*/ .c , .d>g{fill:blue} e{ } .f{fill:'}';stroke:lime";
        let sheet = Sheet::new(&[text]);
        let printed: Vec<String> = sheet.rules.iter().map(|rule| rule.selector.to_string()).collect();
        assert_eq!(printed, ["*[class~='c']", "*[class~='f']", "*[class~='d'] > g"]);
        assert_eq!(sheet.rules[1].declarations.len(), 2);
    }

    #[test]
    fn broken_sheets_end() {
        for text in
            ["{", "}", "a{", "a{b", "@", "@x", "/*", "a,,b{c:d}", "'", "\\", "é{é:é}", "a[é='", "(;{}"]
        {
            let _ = Sheet::new(&[text]);
            let _ = declarations(text).count();
        }
    }
}
