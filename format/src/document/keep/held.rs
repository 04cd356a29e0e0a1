//! What a generator has to keep clear of when it makes a layer again: the pieces of the old one that
//! stay where an artist put them.

use super::{Change, Content, Edits, parsed, wrapped};
use crate::artwork::Artwork;
use crate::document::Document;
use crate::document::edit::{splice, start_tag_end, tag_name};
use crate::error::Error;
use crate::scene::{Scene, Selection};
use crate::shape::subpaths;
use crate::vocabulary::NAMESPACE;
use crate::write::{self, Sink, attribute};
use crate::xml::PlainAttribute;
use kurbo::{BezPath, Point, Rect, Shape};
use roxmltree::Node;
use std::collections::HashSet;
use std::fmt::Write;

/// A drawing to make a layer of again.
#[derive(Clone, Debug)]
pub struct Held {
    /// The drawing without the layer, in which pieces of it that stay stand as fixed objects.
    pub document: Document,
    /// Their ids.
    pub ids: Vec<String>,
}

impl Held {
    /// What a selection asks for around the pieces. Their holes are filled: what can be seen through a leaf is
    /// no room for others.
    ///
    /// Errors: as [`Document::scene`].
    pub fn scene(&self, selection: &Selection) -> Result<Scene, Error> {
        let mut scene = self.document.scene(selection)?;
        let held = scene.fixed.iter_mut().filter(|fixed| self.ids.contains(&fixed.source.id));
        for part in held.flat_map(|fixed| &mut fixed.parts) {
            // Subpaths that all run the same way round wind around nothing of each other.
            let one_way = |one: BezPath| if one.area() < 0.0 { one.reverse_subpaths() } else { one };
            part.path = subpaths(&part.path).into_iter().flat_map(one_way).collect();
            part.style.set("fill-rule", "nonzero");
        }
        Ok(scene)
    }

    /// Takes the copies of the pieces out of an artwork, as which fixed objects come: the layer has them.
    pub fn take_out_of(&self, artwork: &mut Artwork) {
        for group in &mut artwork.groups {
            group.items.retain(|item| !self.ids.contains(&item.of));
        }
        artwork.groups.retain(|group| !group.items.is_empty() || group.stream.is_some());
    }
}

impl Document {
    /// The drawing as the generator that makes a layer of these sources again has to read it, if an
    /// artist moved or locked pieces of that layer.
    ///
    /// Errors: as [`Document::with_layer`] of what there is.
    pub fn held(&self, generator: &str, sources: &[String]) -> Result<Option<Held>, Error> {
        self.parse(|xml| {
            let Some(layer) = self.layer_of(xml, generator, sources)? else { return Ok(None) };
            self.check_verbatim(layer)?;
            let edits = Edits::of(layer);
            let (mut ids, mut objects) = (Vec::new(), String::new());
            for node in edits.obstacles() {
                let Some(id) = node.plain("id") else { continue };
                let Some(object) = self.as_fixed(node, layer) else { continue };
                objects.push_str(&object);
                ids.push(id.to_owned());
            }
            if ids.is_empty() {
                return Ok(None);
            }
            let range = layer.range();
            let element = &self.text[range.clone()];
            let (tag_end, _) = start_tag_end(element);
            let name = tag_name(element);
            let result =
                layer.attributes().find(|a| a.namespace() == Some(NAMESPACE) && a.name() == "result");
            let tag_range = range.start..range.start + tag_end;
            let mut tag = self.text[tag_range.clone()].to_owned();
            if let Some(result) = result {
                let own = result.range();
                tag.replace_range(own.start - tag_range.start..own.end - tag_range.start, "");
            }
            // What pieces are clones of.
            let defs = layer.children().filter(|node| node.tag_name().name() == "defs");
            defs.for_each(|node| objects.insert_str(0, &self.text[node.range()]));
            let mut new = format!("{tag}>{objects}</{name}>");
            // What follows stays on its line.
            let lines = |text: &str| text.matches('\n').count();
            let missing = lines(element).saturating_sub(lines(&new));
            let _ = write!(new, "{}", "\n".repeat(missing));
            let document = self.with_text(splice(&self.text, vec![(range, new)]));
            Ok(Some(Held { document, ids }))
        })
    }

    /// True if the layer that a generator makes of these sources again was made of the same pieces, whatever
    /// an artist did to them since.
    ///
    /// Errors: as [`Document::with_layer`].
    pub fn is_made_of(&self, artwork: &Artwork, generator: &str, sources: &[String]) -> Result<bool, Error> {
        self.parse(|xml| {
            let Some(layer) = self.layer_of(xml, generator, sources)? else { return Ok(false) };
            let id = layer.plain("id").unwrap_or("");
            self.within_layer(xml, layer, id, |target| {
                let mut sink = Sink::default();
                write::content(&mut sink, artwork, target);
                let text = wrapped(target.svg_prefix, id, &sink.text);
                let xml = parsed(self, &text)?;
                let old = Content::of(layer);
                let known: HashSet<(&str, u32)> =
                    old.made().map(|(group, _, entry)| (old.groups[group].name, entry.shape)).collect();
                let new = Content::of(xml.root_element());
                let all = new
                    .made()
                    .all(|(group, _, entry)| known.contains(&(new.groups[group].name, entry.shape)));
                Ok(all && new.made().next().is_some())
            })
        })
    }

    /// An object of a layer as a fixed object, in the groups that move it.
    fn as_fixed(&self, node: Node, layer: Node) -> Option<String> {
        let prefix = node.lookup_prefix(NAMESPACE)?;
        let text = &self.text[node.range()];
        let name_end = text.find(|c: char| c.is_whitespace() || c == '>' || c == '/')?;
        let mut role = String::new();
        attribute(&mut role, &format!("{prefix}:role"), "fixed");
        let mut object = splice(text, vec![(name_end..name_end, role)]);
        for around in node.ancestors().skip(1).take_while(|around| *around != layer) {
            let tag = &self.text[around.range()];
            let name = tag_name(tag);
            let mut open = format!("<{name}");
            if let Some(transform) = around.plain("transform") {
                attribute(&mut open, "transform", transform);
            }
            for namespace in around.namespaces().filter(|ns| ns.name() != Some("xml")) {
                let is_new = around
                    .parent()
                    .is_some_and(|p| p.lookup_namespace_uri(namespace.name()) != Some(namespace.uri()));
                if is_new {
                    let name = namespace.name().map_or("xmlns".to_owned(), |name| format!("xmlns:{name}"));
                    attribute(&mut open, &name, namespace.uri());
                }
            }
            object = format!("{open}>{object}</{name}>");
        }
        Some(object)
    }
}

impl<'a, 'i> Edits<'a, 'i> {
    /// Objects that new pieces have to keep clear of: pieces that stay and groups of them, but none that is
    /// hidden, and none that spans the ornament, as a vine's stems do.
    fn obstacles(&self) -> Vec<Node<'a, 'i>> {
        let content = &self.content;
        let entries = content.groups.iter().flat_map(|made| made.entries.iter().flatten());
        let mut whole: Option<Rect> = None;
        for entry in entries {
            let own = Rect::from_center_size(entry.at, (entry.reach, entry.reach));
            whole = Some(whole.map_or(own, |whole| whole.union(own)));
        }
        let span = whole
            .map_or(0.0, |whole| Point::new(whole.x0, whole.y0).distance(Point::new(whole.x1, whole.y1)));
        let is_shown = |group: usize| !content.groups[group].style.contains("display:none");
        let held = self.edits.iter().filter(|edit| {
            const LARGE: f64 = 0.25;
            edit.change == Change::Held && is_shown(edit.group) && edit.made.reach < LARGE * span
        });
        let held = held.filter_map(|edit| edit.node);
        let groups = content
            .foreign
            .iter()
            .filter(|foreign| foreign.has_pieces && foreign.group.is_some_and(is_shown));
        held.chain(groups.map(|foreign| foreign.node)).collect()
    }
}
