//! The map of an exploration: a layer of small pictures, each with a copy of the form that made
//! it, its parameters, and the step that it came from (Carlson and Woodbury 1990, "Conclusion";
//! checklist R-053). A step can be run again where it lies, or taken out and changed.

use super::Document;
use super::edit::{splice, start_tag_end};
use super::layers::{free_id, label_of};
use crate::artwork::Step;
use crate::error::Error;
use crate::read::{Resolver, inherited_style, parent_transform, unknown_id};
use crate::recipe::Recipe;
use crate::vocabulary::{INKSCAPE, NAMESPACE, Role, SVG, XLINK};
use crate::write::{attribute, escaped, matrix, write_part_at};
use crate::xml::PlainAttribute;
use kurbo::{Affine, Rect, Vec2};
use roxmltree::{Attribute, Node};
use std::collections::HashSet;
use std::fmt::Write;
use std::ops::Range;

/// Pictures along the height of the page.
const ROWS: f64 = 5.0;
/// Space between pictures, in sides of a picture.
const GAP: f64 = 0.3;
/// Pictures are made in a square of this side.
pub(crate) const PICTURE: f64 = 100.0;

/// What the map knows of a step.
struct Known {
    number: usize,
    form: String,
    digest: String,
    params: String,
    column: usize,
    row: usize,
}

impl Document {
    /// Adds steps to the map of the exploration, but for those whose form is what it was.
    ///
    /// Errors: a form that comes out of an entity, or has parts that two objects have the id of.
    pub fn with_steps(&self, fresh: &[Step], recipe: &Recipe) -> Result<Document, Error> {
        if fresh.is_empty() {
            return Ok(self.clone());
        }
        let text = self.parse(|xml| {
            let resolver = Resolver::new(xml, &self.limits)?;
            let params = serde_json::Value::Object(recipe.params.clone()).to_string();
            let mut steps = known_steps(xml);
            let mut out = String::new();
            for step in fresh {
                let mut forms = Vec::new();
                for id in &step.forms {
                    forms.push(resolver.by_reference(id)?.ok_or_else(|| unknown_id(id))?);
                }
                let Some(&root) = forms.first() else { continue };
                let parent = parent_of(&resolver, root, &steps);
                if parent.is_some_and(|parent| parent.digest == step.digest && parent.params == params) {
                    continue;
                }
                let number = steps.iter().map(|step| step.number).max().unwrap_or(0) + 1;
                let (column, row) = cell(parent, &steps);
                let known = Known {
                    number,
                    form: resolver.reference(root),
                    digest: step.digest.clone(),
                    params: params.clone(),
                    column,
                    row,
                };
                self.write_step(&resolver, step, &forms, (&known, parent), &mut out)?;
                steps.push(known);
            }
            if out.is_empty() {
                return Ok(self.text.to_string());
            }
            Ok(splice(&self.text, vec![self.onto_map(xml, out)]))
        })?;
        Document::with_limits(crate::encoding::encode(&text, self.encoding), self.limits.clone())
    }

    fn write_step<'a, 'i>(
        &self,
        resolver: &Resolver<'a, 'i>,
        step: &Step,
        forms: &[Node<'a, 'i>],
        (known, parent): (&Known, Option<&Known>),
        out: &mut String,
    ) -> Result<(), Error> {
        let root = resolver.xml.root_element();
        let number = known.number;
        let id = free_id(resolver.xml, &format!("step-{number}"));
        let (prefix, newline) = (self.prefix_of(root), self.newline());
        let _ = write!(out, "{newline}<{prefix}g");
        declare(out, root);
        attribute(out, "id", &id);
        attribute(out, "inkscape:label", &format!("{number}: {}", label_of(forms[0])));
        attribute(out, "rinceau:step", &number.to_string());
        if let Some(parent) = parent {
            attribute(out, "rinceau:parent", &parent.number.to_string());
        }
        attribute(out, "rinceau:form", &known.form);
        attribute(out, "rinceau:digest", &step.digest);
        attribute(out, "rinceau:cell", &format!("{} {}", known.column, known.row));
        attribute(out, "rinceau:params", &known.params);
        let _ = write!(out, ">{newline}<{prefix}defs>");
        self.copies(resolver, forms, &|old| format!("{id}-{old}"), None, out)?;
        let _ = write!(out, "</{prefix}defs>");
        let cell = (known.column, known.row);
        draw_card(out, prefix, resolver.view, cell, parent);
        let _ = write!(out, "{newline}<{prefix}g");
        attribute(out, "transform", &matrix(place(resolver.view, cell), 6));
        out.push('>');
        step.picture.iter().for_each(|part| write_part_at(out, part, prefix));
        let _ = write!(out, "</{prefix}g>{newline}</{prefix}g>");
        Ok(())
    }

    /// The drawing with the form of a step once more as an object, to be changed.
    ///
    /// Errors: an id that no step has.
    pub fn with_resumed(&self, id: &str) -> Result<Document, Error> {
        let text = self.parse(|xml| {
            let resolver = Resolver::new(xml, &self.limits)?;
            let node = resolver.by_reference(id)?.ok_or_else(|| unknown_id(id))?;
            let step = node.ancestors().find(|node| node.attribute((NAMESPACE, "step")).is_some());
            let forms: Vec<Node> = step.iter().flat_map(|step| forms_of_step(*step)).collect();
            let (Some(step), Some(&root)) = (step, forms.first()) else {
                return Err(Error::new(
                    "no-step",
                    format!("'{}' is no step of an exploration", resolver.reference(node)),
                    "Select one of the pictures in the layer of explored forms",
                )
                .at(self.position(node)));
            };
            let own = format!("{}-", step.plain("id").unwrap_or(""));
            let number = step.attribute((NAMESPACE, "step")).unwrap_or("0");
            let name = format!("form-of-step-{number}");
            let fresh = free_id(xml, &name);
            let rename = |old: &str| format!("{fresh}-{}", old.strip_prefix(&own).unwrap_or(old));
            let prefix = self.prefix_of(xml.root_element());
            let newline = self.newline();
            let mut out = format!("{newline}<{prefix}g");
            declare(&mut out, xml.root_element());
            attribute(&mut out, "id", &fresh);
            attribute(&mut out, "inkscape:label", &format!("Form of step {number}"));
            out.push('>');
            self.copies(&resolver, &forms, &rename, Some((root, number)), &mut out)?;
            let _ = write!(out, "{newline}</{prefix}g>");
            Ok(splice(&self.text, vec![self.at_end(xml, out)]))
        })?;
        Document::with_limits(crate::encoding::encode(&text, self.encoding), self.limits.clone())
    }

    /// Copies of forms where they stand, with other ids; the root among them may be told which
    /// step it comes from.
    fn copies<'a, 'i>(
        &self,
        resolver: &Resolver<'a, 'i>,
        forms: &[Node<'a, 'i>],
        rename: &dyn Fn(&str) -> String,
        root: Option<(Node, &str)>,
        out: &mut String,
    ) -> Result<(), Error> {
        let prefix = self.prefix_of(resolver.xml.root_element());
        let nodes = || forms.iter().flat_map(|form| form.descendants());
        let ids: HashSet<&str> = nodes().filter_map(|node| node.plain("id")).collect();
        for &form in forms {
            for node in form.descendants().filter(Node::is_element) {
                self.check_verbatim(node)?;
            }
            let mut edits = Vec::new();
            for node in form.descendants().filter(Node::is_element) {
                // Rules for its id do not apply to a copy, which has another.
                let ruled = resolver.cascade.rules_by_id(node);
                let is_styled = node.plain("style").is_some();
                for attribute in node.attributes() {
                    let value = renamed(&attribute, &ids, rename);
                    let rules = if attribute.name() == "style" { ruled.as_str() } else { "" };
                    if value.is_some() || !rules.is_empty() {
                        let value = format!("{rules}{}", value.as_deref().unwrap_or(attribute.value()));
                        edits.push((attribute.range_value(), escaped(&value).replace('\'', "&#39;")));
                    }
                }
                if !ruled.is_empty() && !is_styled {
                    let range = node.range();
                    let end = range.start + start_tag_end(&self.text[range]).0;
                    let mut fresh = String::new();
                    attribute(&mut fresh, "style", &ruled);
                    edits.push((end..end, fresh));
                }
            }
            let range = form.range();
            let (tag_end, _) = start_tag_end(&self.text[range.clone()]);
            let mut extra = String::new();
            let tag = &self.text[range.start..range.start + tag_end];
            for namespace in form.namespaces().filter(|ns| ns.name() != Some("xml")) {
                let name = namespace.name().map_or("xmlns".to_owned(), |name| format!("xmlns:{name}"));
                if !has_attribute(tag, &name) {
                    attribute(&mut extra, &name, namespace.uri());
                }
            }
            let ours = form.lookup_prefix(NAMESPACE);
            let mut note = |name: &str, value: &str| {
                attribute(&mut extra, &format!("{}:{name}", ours.unwrap_or("rinceau")), value);
            };
            if form.attribute((NAMESPACE, "role")).is_none() {
                note("role", Role::Form.name());
            }
            if let Some((_, step)) = root.filter(|(node, _)| *node == form) {
                match form.attributes().find(|a| a.namespace() == Some(NAMESPACE) && a.name() == "parent") {
                    Some(old) => edits.push((old.range_value(), step.to_owned())),
                    None => note("parent", step),
                }
            }
            edits.push((range.start + tag_end..range.start + tag_end, extra));
            let moved = |range: Range<usize>, by: usize| range.start - by..range.end - by;
            let edits = edits.into_iter().map(|(r, text)| (moved(r, range.start), text)).collect();
            let _ = write!(out, "<{prefix}g");
            attribute(out, "transform", &matrix(parent_transform(resolver, form), 9));
            attribute(out, "style", &inherited_style(resolver, form).css());
            out.push('>');
            out.push_str(&splice(&self.text[range], edits));
            let _ = write!(out, "</{prefix}g>");
        }
        Ok(())
    }

    /// The edit that puts a step into the map, or the map with it into the drawing.
    fn onto_map(&self, xml: &roxmltree::Document, step: String) -> (Range<usize>, String) {
        let map = xml.descendants().find(|node| node.attribute((NAMESPACE, "history")).is_some());
        let map = map.filter(|map| self.check_verbatim(*map).is_ok());
        if let Some(map) = map {
            let element = &self.text[map.range()];
            if let Some(close) = element.rfind("</").filter(|_| !start_tag_end(element).1) {
                let at = map.range().start + close;
                return (at..at, format!("{}{}", step.trim_start(), self.newline()));
            }
        }
        let (prefix, newline) = (self.prefix_of(xml.root_element()), self.newline());
        let mut out = format!("{newline}<{prefix}g");
        declare(&mut out, xml.root_element());
        attribute(&mut out, "id", &free_id(xml, "explored-forms"));
        attribute(&mut out, "inkscape:groupmode", "layer");
        attribute(&mut out, "inkscape:label", "Explored forms");
        attribute(&mut out, "rinceau:history", "recurse");
        let _ = write!(out, ">{step}{newline}</{prefix}g>");
        self.at_end(xml, out)
    }

    /// The edit that adds something at the end of the root.
    fn at_end(&self, xml: &roxmltree::Document, text: String) -> (Range<usize>, String) {
        let range = xml.root_element().range();
        let element = &self.text[range.clone()];
        let at = range.start + element.rfind("</").unwrap_or(element.len());
        (at..at, text)
    }
}

/// What the steps of the map say of themselves; those that cannot be read are passed over.
fn known_steps(xml: &roxmltree::Document) -> Vec<Known> {
    let known = |node: Node| {
        let get = |name: &str| node.attribute((NAMESPACE, name));
        let number: usize = get("step")?.trim().parse().ok()?;
        let mut cell = get("cell").unwrap_or("").split_whitespace().filter_map(|text| text.parse().ok());
        let text = |name| get(name).unwrap_or("").to_owned();
        // Beyond this nobody looks, and sums would overflow.
        let mut side = || cell.next().filter(|&side: &usize| side < 1_000_000).unwrap_or(0);
        let (column, row) = (side(), side());
        let (form, digest, params) = (text("form"), text("digest"), text("params"));
        Some(Known { number: number.min(1_000_000_000), form, digest, params, column, row })
    };
    xml.descendants().filter_map(known).collect()
}

/// The step that a form comes from: the one it lies in, else the last of the same form, else the
/// one that it was taken out of.
fn parent_of<'a>(resolver: &Resolver, root: Node, steps: &'a [Known]) -> Option<&'a Known> {
    let by_number = |text: Option<&str>| {
        let number: usize = text?.trim().parse().ok()?;
        steps.iter().find(|step| step.number == number)
    };
    let own = root.ancestors().find_map(|node| node.attribute((NAMESPACE, "step")));
    let id = resolver.reference(root);
    by_number(own)
        .or_else(|| steps.iter().filter(|step| step.form == id).max_by_key(|step| step.number))
        .or_else(|| by_number(root.attribute((NAMESPACE, "parent"))))
}

/// A place right of the parent's, in its row if that is free, else in a new row.
fn cell(parent: Option<&Known>, steps: &[Known]) -> (usize, usize) {
    let new_row = steps.iter().map(|step| step.row + 1).max().unwrap_or(0);
    let Some(parent) = parent else { return (0, new_row) };
    let column = parent.column + 1;
    let is_taken = steps.iter().any(|step| step.row == parent.row && step.column >= column);
    (column, if is_taken { new_row } else { parent.row })
}

/// From the square of a picture to its place beside the page.
fn place(view: Rect, (column, row): (usize, usize)) -> Affine {
    let side = view.height() / (ROWS * (1.0 + GAP));
    let step = side * (1.0 + GAP);
    let corner = Vec2::new(view.x1 + step * (0.5 + column as f64), view.y0 + step * row as f64 + 0.05 * side);
    Affine::translate(corner) * Affine::scale(side / PICTURE)
}

/// A frame for the picture, and a line to the parent's.
fn draw_card(out: &mut String, prefix: &str, view: Rect, at: (usize, usize), parent: Option<&Known>) {
    let style = "fill:none;stroke:#999999;stroke-width:1";
    let mut path = |d: &str| {
        let _ = write!(out, "<{prefix}path");
        attribute(out, "transform", &matrix(place(view, at), 6));
        attribute(out, "d", d);
        attribute(out, "style", style);
        out.push_str("/>");
    };
    path("M-4,-4H104V104H-4Z");
    if let Some(parent) = parent {
        let step = PICTURE * (1.0 + GAP);
        let back = (parent.column as f64 - at.0 as f64) * step + 104.0;
        let up = (parent.row as f64 - at.1 as f64) * step + 50.0;
        path(&format!("M-4,50H-16L{:.1},{up:.1}H{back:.1}", back + 10.0));
    }
}

/// The form groups in a step's definitions, the root first.
pub(crate) fn forms_of_step<'a, 'i>(step: Node<'a, 'i>) -> Vec<Node<'a, 'i>> {
    let defs = step.children().find(|node| node.tag_name().name() == "defs");
    let wrappers = defs.into_iter().flat_map(|defs| defs.children().filter(Node::is_element));
    wrappers.filter_map(|wrapper| wrapper.first_element_child()).collect()
}

/// An attribute's value with new names in it, if it has one of the old.
fn renamed(attribute: &Attribute, ids: &HashSet<&str>, rename: &dyn Fn(&str) -> String) -> Option<String> {
    let value = attribute.value();
    let new = |old: &str| ids.contains(old).then(|| rename(old));
    match (attribute.namespace(), attribute.name()) {
        (None, "id") | (Some(NAMESPACE), "of") => new(value.trim()),
        (None | Some(XLINK), "href") => Some(format!("#{}", new(value.trim().strip_prefix('#')?)?)),
        _ if value.contains("url(") => {
            let mut out = String::new();
            let mut rest = value;
            while let Some(at) = rest.find("url(#") {
                let (before, after) = rest.split_at(at + 5);
                out.push_str(before);
                let end = after.find(')').unwrap_or(after.len());
                out.push_str(&new(&after[..end]).unwrap_or_else(|| after[..end].to_owned()));
                rest = &after[end..];
            }
            out.push_str(rest);
            (out != value).then_some(out)
        }
        _ => None,
    }
}

/// True if a start tag has an attribute of this name as it is written.
fn has_attribute(tag: &str, name: &str) -> bool {
    tag.match_indices(name).any(|(at, _)| {
        tag[..at].ends_with(char::is_whitespace) && tag[at + name.len()..].trim_start().starts_with('=')
    })
}

/// The namespaces that a step uses.
fn declare(out: &mut String, root: Node) {
    if root.tag_name().namespace() == Some(SVG) {
        attribute(out, "xmlns:xlink", XLINK);
    }
    attribute(out, "xmlns:rinceau", NAMESPACE);
    attribute(out, "xmlns:inkscape", INKSCAPE);
}
