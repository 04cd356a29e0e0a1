//! Marking objects with roles, and clearing the marks.

use super::Document;
use super::edit::{splice, start_tag_end, tag_name};
use crate::css::declarations;
use crate::error::Error;
use crate::look::{self, ARROW, appearance};
use crate::read::{Resolver, unknown_id};
use crate::vocabulary::{NAMESPACE, OWN_STYLE, Role};
use crate::write::{attribute, escaped};
use crate::xml::PlainAttribute;
use roxmltree::Node;
use simplecss::Declaration;
use std::ops::Range;

impl Document {
    /// Gives the objects a role: attribute, class, and the colours of the papers' diagrams. Their own
    /// style is kept beside (`rinceau:own-style`), and `None` brings it back.
    ///
    /// Errors: an id that no object or two objects have, or that comes out of an entity.
    pub fn with_role(&self, ids: &[String], role: Option<Role>) -> Result<Document, Error> {
        let text = self.parse(|xml| {
            let resolver = Resolver::new(xml, &self.limits)?;
            let mut nodes: Vec<Node> = Vec::new();
            for id in ids {
                let node = resolver.by_reference(id)?.ok_or_else(|| unknown_id(id))?;
                if !nodes.contains(&node) {
                    nodes.push(node);
                }
            }
            let mut edits = Vec::new();
            self.check_verbatim(xml.root_element())?;
            let prefix = if role.is_some() { self.declare(xml, &mut edits) } else { String::new() };
            for &node in &nodes {
                let now = node.plain("style").unwrap_or("");
                let kept = node.attribute((NAMESPACE, OWN_STYLE));
                let marked = node.attribute((NAMESPACE, "role")).and_then(Role::from_name);
                let own = match (kept, marked) {
                    (Some(own), Some(role)) => unmarked_style(now, own, role),
                    _ => now.to_owned(),
                };
                let look = match role {
                    Some(role) => {
                        let style = marked_style(&own, role);
                        let own = (own != style).then_some(own);
                        Some(Look { style, own })
                    }
                    None => kept.map(|_| Look { style: own, own: None }),
                };
                self.put_role(node, role, &prefix, look, &mut edits)?;
            }
            // A mark without a style kept beside it leaves its arrow head on when it is cleared.
            nodes.retain(|node| role.is_some() || node.has_attribute((NAMESPACE, OWN_STYLE)));
            let has_arrow = resolver.by_id(ARROW, None)?.is_some();
            if role == Some(Role::Guide) && !has_arrow {
                edits.extend(self.arrow(xml));
            } else if role != Some(Role::Guide) && has_arrow {
                edits.extend(self.arrow_unused(xml, &nodes));
            }
            Ok(splice(&self.text, edits))
        })?;
        Document::with_limits(crate::encoding::encode(&text, self.encoding), self.limits.clone())
    }

    /// The prefix of our namespace at the root, declared there if it is not.
    pub(super) fn declare(
        &self,
        xml: &roxmltree::Document,
        edits: &mut Vec<(Range<usize>, String)>,
    ) -> String {
        let root = xml.root_element();
        if let Some(namespace) =
            root.namespaces().find(|namespace| namespace.uri() == NAMESPACE && namespace.name().is_some())
        {
            return namespace.name().unwrap_or("rinceau").to_owned();
        }
        let mut prefix = "rinceau".to_owned();
        while root.namespaces().any(|namespace| namespace.name() == Some(&prefix)) {
            prefix.push('_');
        }
        let range = root.range();
        let name_end = range.start
            + self.text[range.start..].find(|c: char| c.is_whitespace() || c == '>' || c == '/').unwrap_or(4);
        let mut declaration = String::new();
        attribute(&mut declaration, &format!("xmlns:{prefix}"), NAMESPACE);
        edits.push((name_end..name_end, declaration));
        prefix
    }

    /// Edits that set or clear the role of an object, and its look if there is one.
    pub(super) fn put_role(
        &self,
        node: Node,
        role: Option<Role>,
        prefix: &str,
        look: Option<Look>,
        edits: &mut Vec<(Range<usize>, String)>,
    ) -> Result<(), Error> {
        self.check_verbatim(node)?;
        if role.is_some() && node.lookup_namespace_uri(Some(prefix)).is_some_and(|uri| uri != NAMESPACE) {
            return Err(self.prefix_taken(node, prefix));
        }
        let range = node.range();
        let mut fresh = String::new();
        let mut put =
            |own: Option<roxmltree::Attribute>, name: &str, value: Option<String>| match (own, value) {
                (Some(own), Some(value)) => {
                    edits.push((own.range_value(), escaped(&value).replace('\'', "&#39;")))
                }
                (Some(own), None) => {
                    let start = self.text[..own.range().start].trim_end().len();
                    edits.push((start..own.range().end, String::new()));
                }
                (None, Some(value)) => attribute(&mut fresh, name, &value),
                (None, None) => {}
            };
        let find = |namespace: Option<&str>, name: &str| {
            node.attributes().find(|a| a.namespace() == namespace && a.name() == name)
        };
        put(
            find(Some(NAMESPACE), "role"),
            &format!("{prefix}:role"),
            role.map(|role| role.name().to_owned()),
        );
        let others: Vec<&str> = node
            .plain("class")
            .unwrap_or("")
            .split_whitespace()
            .filter(|token| Role::from_class(token).is_none())
            .collect();
        let class =
            others.into_iter().map(str::to_owned).chain(role.map(Role::class)).collect::<Vec<_>>().join(" ");
        put(find(None, "class"), "class", Some(class).filter(|class| !class.is_empty()));
        if let Some(Look { style, own }) = look {
            put(find(None, "style"), "style", Some(style).filter(|style| !style.is_empty()));
            put(find(Some(NAMESPACE), OWN_STYLE), &format!("{prefix}:{OWN_STYLE}"), own);
        }
        if !fresh.is_empty() {
            let (tag_end, _) = start_tag_end(&self.text[range.clone()]);
            edits.push((range.start + tag_end..range.start + tag_end, fresh));
        }
        Ok(())
    }

    /// An arrow head in `<defs>` of its own at the end of the drawing, so that the places of
    /// objects without an id stay what they are in recipes.
    fn arrow(&self, xml: &roxmltree::Document) -> Option<(Range<usize>, String)> {
        let root = xml.root_element();
        let range = root.range();
        let element = &self.text[range.clone()];
        let (_, closes) = start_tag_end(element);
        let p = tag_name(element).strip_suffix("svg").unwrap_or("");
        let at = range.start + element.rfind("</").unwrap_or(element.len());
        let newline = self.newline();
        let marker = format!("{newline}{}", look::arrow(p));
        (!closes).then_some((at..at, marker))
    }

    /// Takes the arrow head out again, if it stands as we put it there and nothing but these objects has
    /// it.
    fn arrow_unused(&self, xml: &roxmltree::Document, nodes: &[Node]) -> Option<(Range<usize>, String)> {
        let root = xml.root_element();
        let p = tag_name(&self.text[root.range()]).strip_suffix("svg").unwrap_or("");
        let marker = format!("{}{}", self.newline(), look::arrow(p));
        let reference = format!("#{ARROW}");
        let is_used = root.descendants().filter(|node| !nodes.contains(node)).any(|node| {
            node.attributes().any(|a| a.value().contains(&reference))
                || node.is_text() && node.text().is_some_and(|text| text.contains(&reference))
        });
        let at = self.text.find(&marker).filter(|_| !is_used)?;
        Some((at..at + marker.len(), String::new()))
    }
}

/// What a mark does to the look of an object.
pub(super) struct Look {
    style: String,
    /// The style that it hides, if it hides any.
    own: Option<String>,
}

/// The style that an object has without its mark of a role: its own, with what was changed since then.
fn unmarked_style(now: &str, own: &str, role: Role) -> String {
    let is_marks = |d: &Declaration| {
        appearance(role).contains(&(d.name, d.value)) || d.name == "marker-end" && d.value.contains(ARROW)
    };
    let before: Vec<Declaration> = declarations(own).collect();
    let mut after: Vec<Declaration> = declarations(now).filter(|d| !is_marks(d)).collect();
    // What the mark hid, and nothing was put in place of.
    let hidden = before.iter().filter(|hidden| !after.iter().any(|d| d.name == hidden.name));
    let hidden: Vec<Declaration> = hidden.copied().collect();
    after.extend(hidden);
    let sorted = |list: &[Declaration]| {
        let mut all: Vec<String> = list.iter().map(declared).collect();
        all.sort_unstable();
        all
    };
    match sorted(&after) == sorted(&before) {
        true => own.to_owned(),
        false => after.iter().map(declared).collect::<Vec<_>>().join(";"),
    }
}

/// The object's style with the mark's colours in place of its own. The arrow head goes with
/// the mark that it belongs to.
fn marked_style(style: &str, role: Role) -> String {
    let colours = appearance(role);
    let mut out: Vec<String> = declarations(style)
        .filter(|d| {
            !colours.iter().any(|(name, _)| *name == d.name)
                && !(d.name == "marker-end" && (role == Role::Guide || d.value.contains(ARROW)))
        })
        .map(|d| declared(&d))
        .collect();
    out.extend(colours.iter().map(|(name, value)| format!("{name}:{value}")));
    if role == Role::Guide {
        out.push(format!("marker-end:url(#{ARROW})"));
    }
    out.join(";")
}

fn declared(d: &Declaration) -> String {
    format!("{}:{}{}", d.name, d.value, if d.important { " !important" } else { "" })
}
