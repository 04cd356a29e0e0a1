//! The content of a layer made again, with what an artist did to the old one.

use super::plan::Plan;
use super::{Change, Content, Edits, Made, parsed, wrapped};
use crate::document::Document;
use crate::document::edit::{splice, start_tag_end, tag_name};
use crate::error::Error;
use crate::vocabulary::XLINK;
use crate::write::attribute;
use crate::write::record::{Entries, Entry, MOST_REMEMBERED, paints_of, record_decimals, write_entries};
use crate::xml::PlainAttribute;
use roxmltree::Node;
use std::collections::{BTreeSet, HashSet};
use std::ops::Range;

/// Puts the changes to an old layer into the content of the new one. A piece is told again by where it
/// stands; what was painted keeps its number.
///
/// Errors: more pieces than a layer remembers; a piece that comes out of an entity.
pub(in crate::document) fn merged(
    document: &Document,
    edits: &Edits,
    (content, svg_prefix, decimals): (&str, &str, usize),
) -> Result<String, Error> {
    let text = wrapped(svg_prefix, edits.content.id, content);
    let xml = parsed(document, &text)?;
    let new = Content::of(xml.root_element());
    if new.groups.is_empty() {
        return Err(Error::new(
            "too-many-pieces",
            format!("The layer would have more than {MOST_REMEMBERED} pieces, and those that were changed by hand could not be kept"),
            "Make fewer pieces, or delete the layer first",
        )
        .at(document.position(edits.content.layer)));
    }
    let plan = Plan::new(&edits.content, &edits.edits, &new);
    let layer = edits.content.layer;
    let mut merge = Merge {
        document,
        layer,
        edits,
        new: &new,
        text: &text,
        head: text.len() - content.len() - "</root>".len(),
        gone: gone(edits),
        splices: Vec::new(),
    };
    merge.tags();
    merge.pieces(&plan)?;
    merge.foreign()?;
    merge.symbols(&xml)?;
    merge.record(&plan, svg_prefix, record_decimals(decimals));
    Ok(splice(content, merge.splices))
}

struct Merge<'m, 'a, 'i> {
    document: &'m Document,
    layer: Node<'a, 'i>,
    edits: &'m Edits<'a, 'i>,
    new: &'m Content<'m, 'm>,
    /// The new content in its wrapper.
    text: &'m str,
    /// Length of the wrapper's start tag.
    head: usize,
    /// Sublayers that were deleted.
    gone: Vec<&'m str>,
    /// Of the content.
    splices: Vec<(Range<usize>, String)>,
}

/// Names of the sublayers that were deleted, with all their pieces; none of an emptied layer.
fn gone<'m>(edits: &'m Edits) -> Vec<&'m str> {
    let old = &edits.content;
    let has_pieces = |index: usize| old.pieces.keys().any(|&(group, _)| group == index);
    let groups = old.groups.iter().enumerate().filter(|_| !edits.edits.is_empty());
    groups.filter(|(i, made)| made.node.is_none() && !has_pieces(*i)).map(|(_, made)| made.name).collect()
}

impl Merge<'_, '_, '_> {
    /// Replaces a range of the wrapped content.
    fn put(&mut self, range: Range<usize>, text: String) {
        self.splices.push((range.start - self.head..range.end - self.head, text));
    }

    /// Adds something at the end of a sublayer, or of the layer.
    fn append(&mut self, name: Option<&str>, text: &str) {
        let made = name.and_then(|name| self.new.groups.iter().find(|made| made.name == name));
        let at =
            match made.and_then(|made| made.node).filter(|_| !name.is_some_and(|name| self.is_gone(name))) {
                Some(node) => {
                    let range = node.range();
                    let element = &self.text[range.clone()];
                    range.start + self.line_start(element, element.rfind("</").unwrap_or(element.len()))
                }
                None => {
                    let end = self.text.len() - "</root>".len();
                    self.line_start(self.text, end)
                }
            };
        let newline = self.document.newline();
        self.put(at..at, format!("{newline}{text}"));
    }

    /// The place before a line break, if there is one right before.
    fn line_start(&self, text: &str, at: usize) -> usize {
        let newline = self.document.newline();
        if text[..at].ends_with(newline) { at - newline.len() } else { at }
    }

    /// True if the sublayer of a name was deleted.
    fn is_gone(&self, name: &str) -> bool {
        self.gone.contains(&name)
    }

    /// Sublayers keep the tags that they were given, and those that were deleted stay so.
    fn tags(&mut self) {
        for made in &self.new.groups {
            let Some(node) = made.node else { continue };
            let range = node.range();
            if self.is_gone(made.name) {
                let start = self.line_start(self.text, range.start);
                self.put(start..range.end, String::new());
                continue;
            }
            let old = self.edits.content.groups.iter().find(|old| old.name == made.name);
            let Some(old) = old.filter(|old| Made::has_new_tag(old)).and_then(|old| old.node) else {
                continue;
            };
            let element = &self.document.text[old.range()];
            let mut tag = element[..start_tag_end(element).0].to_owned();
            let new_tag = &self.text[range.start..range.start + start_tag_end(&self.text[range.clone()]).0];
            if new_tag.contains(" xmlns:xlink=") && old.lookup_namespace_uri(Some("xlink")) != Some(XLINK) {
                attribute(&mut tag, "xmlns:xlink", XLINK);
            }
            let end = range.start + start_tag_end(&self.text[range.clone()]).0;
            self.put(range.start..end, tag);
        }
    }

    fn pieces(&mut self, plan: &Plan) -> Result<(), Error> {
        for (i, &(group, number, _)) in plan.pieces.iter().enumerate() {
            let made = &self.new.groups[group];
            let Some(&(node, _)) = self.new.pieces.get(&(group, number)) else { continue };
            if self.is_gone(made.name) {
                continue;
            }
            let edit = plan.edit_of[i].map(|e| &self.edits.edits[e]);
            match edit.map(|edit| (edit.change, edit.node)) {
                Some((Change::Painted, Some(old))) => self.paint(node, old),
                Some((Change::Held, Some(old))) => {
                    let object = self.verbatim(old, Some(made.name))?;
                    self.put(node.range(), object);
                    continue;
                }
                Some(_) => {
                    let range = node.range();
                    let start = self.line_start(self.text, range.start);
                    self.put(start..range.end, String::new());
                    continue;
                }
                None => {}
            }
            if let Some(id) = node.plain_node("id").filter(|_| plan.numbers[i] != number) {
                let new = format!("{}-{}-{}", self.new.id, made.name, plan.numbers[i]);
                self.put(id.range_value(), new);
            }
        }
        for (e, edit) in self.edits.edits.iter().enumerate() {
            let name = self.edits.content.groups[edit.group].name;
            let is_open = plan.piece_of[e].is_none() || self.is_gone(name);
            if let (Change::Held, Some(node), true) = (edit.change, edit.node, is_open) {
                let object = self.verbatim(node, Some(name).filter(|name| !self.is_gone(name)))?;
                self.append(Some(name), &object);
            }
        }
        Ok(())
    }

    /// Paints a new piece like an old one, shape by shape; of an old one with fewer shapes the last
    /// counts for the rest.
    fn paint(&mut self, node: Node, old: Node) {
        let shapes = |piece: Node| -> Vec<(Range<usize>, String)> {
            let leaves =
                piece.descendants().filter(|node| node.is_element() && node.tag_name().name() != "g");
            leaves.map(|node| (node.range(), paints_of(node).join(";"))).collect()
        };
        let mut pairs = Vec::new();
        let (new, from) = (shapes(node), shapes(old));
        if let Some(last) = from.last() {
            let paint = |i: usize| from.get(i).unwrap_or(last).1.clone();
            pairs.extend(new.into_iter().enumerate().map(|(i, (range, _))| (range, paint(i))));
        }
        if node.tag_name().name() == "g" && old.tag_name().name() == "g" {
            pairs.push((node.range(), paints_of(old).join(";")));
        }
        for (range, css) in pairs {
            let tag = &self.text[range.clone()];
            let tag = &tag[..start_tag_end(tag).0];
            let mut style = String::new();
            if !css.is_empty() {
                style = format!(" style=\"{css}\"");
            }
            match tag.find(" style=\"") {
                Some(at) => {
                    let value = at + " style=\"".len();
                    let end = tag[value..].find('"').map_or(tag.len(), |end| value + end + 1);
                    self.put(range.start + at..range.start + end, style);
                }
                None => {
                    let at = range.start + tag.len();
                    self.put(at..at, style);
                }
            }
        }
    }

    /// An object as it stands in the drawing, in groups that move it as those around it do, to be put
    /// into its sublayer.
    fn verbatim(&self, node: Node, group: Option<&str>) -> Result<String, Error> {
        let made = group.and_then(|name| self.new.groups.iter().find(|made| made.name == name));
        let sublayer = made.and_then(|made| made.node).map_or("", |node| &self.text[node.range()]);
        let sublayer = &sublayer[..start_tag_end(sublayer).0];
        self.document.check_verbatim(node)?;
        let mut object = self.document.text[node.range()].to_owned();
        let end = object.find(|c: char| c.is_whitespace() || c == '>' || c == '/').unwrap_or(object.len());
        let tag_end = start_tag_end(&object).0;
        let mut declared = String::new();
        for namespace in node.namespaces().filter(|ns| ns.name() != Some("xml")) {
            let name = namespace.name().map_or("xmlns".to_owned(), |name| format!("xmlns:{name}"));
            let is_known = self.layer.lookup_namespace_uri(namespace.name()) == Some(namespace.uri());
            let is_known = is_known || sublayer.contains(&format!(" {name}=\"{}\"", namespace.uri()));
            let is_used = namespace.name().is_none_or(|prefix| object.contains(&format!("{prefix}:")));
            if !is_known && is_used && !object[..tag_end].contains(&format!(" {name}=")) {
                attribute(&mut declared, &name, namespace.uri());
            }
        }
        object.insert_str(end, &declared);
        let is_sublayer = |node: &Node| self.edits.content.groups.iter().any(|made| made.node == Some(*node));
        let around =
            node.ancestors().skip(1).take_while(|around| *around != self.layer && !is_sublayer(around));
        for around in around {
            let Some(transform) = around.plain("transform") else { continue };
            let name = tag_name(&self.document.text[around.range()]);
            let mut open = format!("<{name}");
            attribute(&mut open, "transform", transform);
            object = format!("{open}>{object}</{name}>");
        }
        Ok(object)
    }

    /// What no generator made stays, at the end of where it was.
    fn foreign(&mut self) -> Result<(), Error> {
        for foreign in &self.edits.content.foreign {
            let name = foreign.group.map(|group| self.edits.content.groups[group].name);
            let object = self.verbatim(foreign.node, name)?;
            self.append(name, &object);
        }
        Ok(())
    }

    /// Definitions that pieces which stay refer to, and that the new content lacks.
    fn symbols(&mut self, xml: &roxmltree::Document) -> Result<(), Error> {
        let known: HashSet<&str> = xml.descendants().filter_map(|node| node.plain("id")).collect();
        let referred = |node: Node| -> Vec<String> {
            let href = |node: Node| {
                node.attribute((XLINK, "href")).or_else(|| node.plain("href")).map(str::to_owned)
            };
            let hrefs = node.descendants().filter_map(href);
            hrefs.filter_map(|href| href.strip_prefix('#').map(str::to_owned)).collect()
        };
        let stays = self.edits.edits.iter().filter(|edit| edit.change == Change::Held);
        let stays =
            stays.filter_map(|edit| edit.node).chain(self.edits.content.foreign.iter().map(|one| one.node));
        let mut wanted: Vec<String> = stays.flat_map(referred).collect();
        let mut missing: BTreeSet<usize> = BTreeSet::new();
        let own = format!("{}-symbols", self.edits.content.id);
        let symbols = self.layer.children().find(|node| node.plain("id") == Some(&own));
        let children = || symbols.into_iter().flat_map(|symbols| symbols.children().filter(Node::is_element));
        while let Some(id) = wanted.pop() {
            let found = children().find(|node| node.plain("id") == Some(&id));
            let Some(node) = found.filter(|_| !known.contains(id.as_str())) else { continue };
            if missing.insert(node.range().start) {
                wanted.extend(referred(node));
            }
        }
        if missing.is_empty() {
            return Ok(());
        }
        let mut text = String::new();
        for start in missing {
            let found = children().find(|node| node.range().start == start);
            text += &found.map_or(Ok(String::new()), |node| self.verbatim(node, None))?;
        }
        let newline = self.document.newline();
        let defs = xml.descendants().find(|node| node.plain("id") == Some(&own)).map(|node| node.range());
        match defs {
            Some(range) => {
                let at = range.start + self.text[range.clone()].rfind("</").unwrap_or(0);
                self.put(at..at, format!("{text}{newline}"));
            }
            None => {
                let tag = &self.document.text[symbols.map_or(0..0, |symbols| symbols.range())];
                let name = tag_name(tag);
                let mut open = format!("{newline}<{name}");
                attribute(&mut open, "id", &own);
                self.put(self.head..self.head, format!("{open}>{text}</{name}>"));
            }
        }
        Ok(())
    }

    /// The record of the result: how pieces were made, not how they are.
    fn record(&mut self, plan: &Plan, svg_prefix: &str, decimals: usize) {
        let mut groups: Vec<(&str, &str, Entries)> =
            self.new.groups.iter().map(|made| (made.name, made.style, Vec::new())).collect();
        let mut note = |name: &'_ str, number: usize, entry: Entry| {
            let Some(group) = groups.iter_mut().find(|group| group.0 == name) else { return };
            if group.2.len() < number {
                group.2.resize(number, None);
            }
            group.2[number - 1] = Some(entry);
        };
        for (i, &(group, _, entry)) in plan.pieces.iter().enumerate() {
            note(self.new.groups[group].name, plan.numbers[i], entry);
        }
        for (e, edit) in self.edits.edits.iter().enumerate() {
            if plan.piece_of[e].is_none() && edit.change != Change::Painted {
                note(self.edits.content.groups[edit.group].name, edit.number, plan.map.moved(&edit.made));
            }
        }
        let mut text = String::new();
        for (name, style, entries) in &groups {
            if !entries.is_empty() {
                text.push_str(self.document.newline());
                write_entries(&mut text, svg_prefix, (name, style), (entries, decimals));
            }
        }
        let root = self.new.layer;
        let records: Vec<Range<usize>> =
            root.children().filter(super::is_record).map(|node| node.range()).collect();
        for (i, range) in records.into_iter().enumerate() {
            let start = self.line_start(self.text, range.start);
            self.put(start..range.end, if i == 0 { std::mem::take(&mut text) } else { String::new() });
        }
    }
}
