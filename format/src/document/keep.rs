//! What an artist did to the pieces of a result layer, so that it stays done when the layer is made
//! again: found by comparing the pieces with the layer's record of how they were made.

mod held;
mod merge;
mod near;
mod plan;

use super::Document;
use crate::error::Error;
use crate::vocabulary::{INKSCAPE, NAMESPACE, SODIPODI};
use crate::write::record::{Entries, Entry, digests, paint_of, read_entries, wrapper};
use crate::xml::PlainAttribute;
use roxmltree::{Node, ParsingOptions};
use std::collections::HashMap;

pub use held::Held;
pub(super) use merge::merged;

/// What was done to one piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Change {
    /// It was deleted, or taken out of the layer.
    Gone,
    /// It was moved, reshaped or locked: it stays as it is.
    Held,
    /// It was painted otherwise: what takes its place is painted like it.
    Painted,
}

/// A piece that was changed.
struct Edit<'a, 'i> {
    group: usize,
    number: usize,
    made: Entry,
    change: Change,
    /// None if it is gone.
    node: Option<Node<'a, 'i>>,
}

/// A sublayer as it was made, and as it is.
struct Made<'a, 'i> {
    name: &'a str,
    style: &'a str,
    entries: Entries,
    /// None if it was deleted.
    node: Option<Node<'a, 'i>>,
}

/// Something in a layer that no generator made.
struct Foreign<'a, 'i> {
    /// The sublayer that it stands in.
    group: Option<usize>,
    node: Node<'a, 'i>,
    /// True if pieces were grouped in it.
    has_pieces: bool,
}

/// What stands in a layer.
struct Content<'a, 'i> {
    layer: Node<'a, 'i>,
    id: &'a str,
    groups: Vec<Made<'a, 'i>>,
    /// Pieces by sublayer and number, and whether a group around each was moved.
    pieces: HashMap<(usize, usize), (Node<'a, 'i>, bool)>,
    foreign: Vec<Foreign<'a, 'i>>,
}

impl<'a, 'i> Content<'a, 'i> {
    fn of(layer: Node<'a, 'i>) -> Self {
        let mut groups = Vec::new();
        for node in layer.children().filter(is_record) {
            let Some(name) = node.attribute((NAMESPACE, "group")) else { continue };
            let entries = read_entries(node.attribute((NAMESPACE, "pieces")).unwrap_or(""));
            let style = node.attribute((NAMESPACE, "style")).unwrap_or("");
            groups.push(Made { name, style, entries, node: None });
        }
        let id = layer.plain("id").unwrap_or("");
        let mut content = Content { layer, id, groups, pieces: HashMap::new(), foreign: Vec::new() };
        content.look(layer, None, false);
        // A record of another layer, or a damaged one, is none: by it most pieces would be the artist's own,
        // and stay under the new ones.
        let strays = content.foreign.iter().filter(|foreign| content.is_numbered(foreign.node)).count();
        if strays > content.pieces.len() {
            content = Content { layer, id, groups: Vec::new(), pieces: HashMap::new(), foreign: Vec::new() };
            content.look(layer, None, false);
        }
        content
    }

    /// True for an object that is called like a piece.
    fn is_numbered(&self, node: Node<'a, 'i>) -> bool {
        let is_number = |number: &str| number.parse::<usize>().is_ok();
        let named = self.own(node).rsplit_once('-').filter(|(_, number)| is_number(number));
        named.is_some_and(|(name, _)| self.groups.iter().any(|made| made.name == name))
    }

    /// Finds pieces, and what is none, below a node of the layer.
    fn look(&mut self, parent: Node<'a, 'i>, group: Option<usize>, is_moved: bool) {
        for node in parent.children().filter(Node::is_element) {
            let own = self.own(node);
            let index_of = |made: &Made| made.name == own;
            if let Some(piece) = self.piece(own) {
                self.pieces.insert(piece, (node, is_moved));
            } else if let (None, Some(index)) = (group, self.groups.iter().position(index_of)) {
                self.groups[index].node = Some(node);
                self.look(node, Some(index), false);
            } else if let Some(index) = group.filter(|&index| is_chunk(own, self.groups[index].name)) {
                self.look(node, Some(index), node.plain("transform").is_some());
            } else if !self.is_ours(node, own, group.is_none()) {
                let has_pieces = node.descendants().any(|node| self.piece(self.own(node)).is_some());
                self.foreign.push(Foreign { group, node, has_pieces });
            }
        }
    }

    /// An id behind the layer's and a dash; empty for an id that starts otherwise.
    fn own(&self, node: Node<'a, 'i>) -> &'a str {
        let own = |id: &'a str| id.strip_prefix(self.id)?.strip_prefix('-');
        node.plain("id").and_then(own).unwrap_or("")
    }

    /// The sublayer and number of a piece by the end of its id.
    fn piece(&self, own: &str) -> Option<(usize, usize)> {
        let (name, number) = own.rsplit_once('-')?;
        let number: usize = number.parse().ok()?;
        let index = self.groups.iter().position(|made| made.name == name)?;
        let entry = self.groups[index].entries.get(number.checked_sub(1)?)?;
        entry.is_some().then_some((index, number))
    }

    /// True for what belongs to a layer and is no piece. Without a record, marks and ids say so; a whole
    /// sublayer is told by its id.
    fn is_ours(&self, node: Node, own: &str, is_sublayer: bool) -> bool {
        let is_old = self.groups.is_empty() && (!own.is_empty() || node.has_attribute((NAMESPACE, "of")));
        is_record(&node) || is_old || is_sublayer && !own.is_empty()
    }

    /// Every piece that was made: sublayer, number, and how.
    fn made(&self) -> impl Iterator<Item = (usize, usize, Entry)> + '_ {
        let numbered = |(group, made): (usize, &'_ Made)| {
            let entries = made.entries.clone().into_iter().enumerate();
            entries.filter_map(move |(i, entry)| Some((group, i + 1, entry?)))
        };
        self.groups.iter().enumerate().flat_map(numbered)
    }
}

/// All that an artist did to a layer.
pub(super) struct Edits<'a, 'i> {
    content: Content<'a, 'i>,
    edits: Vec<Edit<'a, 'i>>,
}

impl<'a, 'i> Edits<'a, 'i> {
    /// Looks at a layer.
    pub fn of(layer: Node<'a, 'i>) -> Self {
        let content = Content::of(layer);
        let is_elsewhere =
            || layer.document().descendants().any(|node| content.piece(content.own(node)).is_some());
        // An emptied layer is to be made anew.
        let is_emptied = content.pieces.is_empty() && !is_elsewhere();
        let edits = if is_emptied { Vec::new() } else { compared(&content) };
        Edits { content, edits }
    }

    /// True if the layer can be made anew as if nobody had touched it.
    pub fn is_empty(&self) -> bool {
        let content = &self.content;
        self.edits.is_empty() && content.foreign.is_empty() && !content.groups.iter().any(Made::has_new_tag)
    }
}

/// Compares pieces with how they were made.
fn compared<'a, 'i>(content: &Content<'a, 'i>) -> Vec<Edit<'a, 'i>> {
    struct State {
        is_moved: bool,
        is_locked: bool,
        is_painted: bool,
    }
    let state = |&(node, is_moved): &(Node, bool), made: &Entry| {
        let (shape, paint) = digests(node);
        State {
            is_moved: is_moved || shape != made.shape,
            is_locked: node.attribute((SODIPODI, "insensitive")) == Some("true"),
            is_painted: paint != made.paint,
        }
    };
    let all = content.made().map(|(group, number, made)| {
        let found = content.pieces.get(&(group, number));
        let edit = Edit { group, number, made, change: Change::Gone, node: found.map(|found| found.0) };
        (edit, found.map(|found| state(found, &made)))
    });
    let all: Vec<_> = all.collect();
    // Where most of a sublayer were moved, it was the ornament that was, not its pieces.
    let count = |group: usize, is_moved: bool| {
        let present =
            all.iter().filter(|(edit, _)| edit.group == group).filter_map(|(_, state)| state.as_ref());
        present.filter(|state| state.is_moved || !is_moved).count()
    };
    let counts = (0..content.groups.len()).map(|group| (count(group, true), count(group, false)));
    let is_whole: Vec<bool> = counts.map(|(moved, present)| moved > 1 && 2 * moved > present).collect();
    let changed = all.into_iter().filter_map(|(edit, state)| {
        let change = match state {
            None => Change::Gone,
            Some(state) if state.is_locked || state.is_moved && !is_whole[edit.group] => Change::Held,
            Some(state) if state.is_painted => Change::Painted,
            Some(_) => return None,
        };
        Some(Edit { change, ..edit })
    });
    changed.collect()
}

impl Made<'_, '_> {
    /// True if the sublayer was locked, moved, shown, hidden, renamed.
    fn has_new_tag(&self) -> bool {
        let Some(node) = self.node else { return false };
        let paint = |css: &str| paint_of(css.split(';').map(str::to_owned).collect());
        node.attribute((SODIPODI, "insensitive")).is_some()
            || node.plain("transform").is_some()
            || node.attribute((INKSCAPE, "label")) != Some(self.name)
            || paint(node.plain("style").unwrap_or("")) != paint(self.style)
    }
}

/// The content of a layer, in a root that stands for the layer, to be parsed by itself.
fn wrapped(svg_prefix: &str, id: &str, content: &str) -> String {
    format!("{}{content}</root>", wrapper(svg_prefix, id))
}

fn parsed<'t>(document: &Document, wrapped: &'t str) -> Result<roxmltree::Document<'t>, Error> {
    let options = ParsingOptions { nodes_limit: u32::MAX, ..ParsingOptions::default() };
    roxmltree::Document::parse_with_options(wrapped, options).map_err(|error| document.xml_error(&error))
}

fn is_record(node: &Node) -> bool {
    node.has_attribute((NAMESPACE, "pieces"))
}

/// True for the id of one of the groups that keep siblings few.
fn is_chunk(own: &str, group: &str) -> bool {
    let number = own.strip_prefix(group).and_then(|rest| rest.strip_prefix("-g"));
    number.is_some_and(|number| !number.is_empty() && number.bytes().all(|b| b.is_ascii_digit()))
}
