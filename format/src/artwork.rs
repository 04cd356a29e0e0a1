//! Plain data: what a generator made, in drawing order.

use crate::json;
use crate::style::Style;
use kurbo::{Affine, BezPath};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

/// One painted shape.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Part {
    /// In its own coordinates.
    #[serde(with = "json::path")]
    #[schemars(with = "String")]
    pub path: BezPath,
    /// From its own coordinates to user units of the root.
    #[serde(default, with = "json::affine", skip_serializing_if = "json::is_identity")]
    #[schemars(with = "[f64; 6]")]
    pub transform: Affine,
    /// Its paint; widths are in its own coordinates.
    #[serde(with = "json::style")]
    #[schemars(with = "BTreeMap<String, String>")]
    pub style: Style,
}

/// One placed copy of a template: exactly one SVG element in the result.
#[derive(Clone, Debug)]
pub struct Item {
    /// Id of the template, or the name of its kind where no template was drawn.
    pub of: String,
    /// Its shapes in drawing order; none for a clone.
    pub parts: Vec<Part>,
    /// A clone of a symbol instead, and its pose: from the symbol's coordinates to user units
    /// of the root.
    pub clone: Option<(usize, Affine)>,
}

impl Item {
    /// A piece with shapes of its own.
    pub fn new(of: impl Into<String>, parts: Vec<Part>) -> Self {
        Item { of: of.into(), parts, clone: None }
    }

    /// A clone of a symbol of the artwork.
    pub fn cloned(of: impl Into<String>, symbol: usize, pose: Affine) -> Self {
        Item { of: of.into(), parts: Vec::new(), clone: Some((symbol, pose)) }
    }
}

/// What clones repeat: edit it once, and every clone follows.
#[derive(Clone, Debug)]
pub struct Symbol {
    /// Name, unique in the artwork.
    pub name: String,
    /// What it draws, in drawing order.
    pub items: Vec<SymbolItem>,
}

impl Symbol {
    /// A symbol of shapes.
    pub fn new(name: String, parts: Vec<Part>) -> Self {
        Symbol { name, items: parts.into_iter().map(SymbolItem::Part).collect() }
    }

    /// Its own shapes, without those of other symbols and of the drawing.
    pub fn parts(&self) -> impl Iterator<Item = &Part> {
        self.items.iter().filter_map(|item| match item {
            SymbolItem::Part(part) => Some(part),
            SymbolItem::Symbol(..) | SymbolItem::Object(..) => None,
        })
    }
}

/// Something that a symbol draws.
#[derive(Clone, Debug)]
pub enum SymbolItem {
    /// A shape of its own.
    Part(Part),
    /// Another symbol, and from that one's coordinates to this one's.
    Symbol(usize, Affine),
    /// An object of the drawing: its id, from its parent's coordinates to the symbol's, and the
    /// style that it inherits.
    Object(String, Affine, String),
}

/// Pieces that are made while they are written, because there may be more than memory should
/// hold.
pub trait Stream: fmt::Debug + Send + Sync {
    /// Gives every piece in drawing order. The same pieces every time.
    fn each(&self, pieces: &mut dyn Pieces);
}

/// Takes the pieces of a [`Stream`].
pub trait Pieces {
    /// A piece begins: what it is a copy of, its transform, and its style as CSS.
    fn begin(&mut self, of: &str, transform: Affine, style: &str);
    /// A path of the piece, and the map that its points go through.
    fn add(&mut self, path: &BezPath, pose: Affine);
}

/// A sublayer of the result.
#[derive(Clone, Debug, Default)]
pub struct Group {
    /// Name, such as `elements`.
    pub name: String,
    /// Hidden in the editor until asked for.
    pub hidden: bool,
    /// Its items in drawing order.
    pub items: Vec<Item>,
    /// What follows the items.
    pub stream: Option<Arc<dyn Stream>>,
}

/// A step of an exploration: what was made of which form.
#[derive(Clone, Debug)]
pub struct Step {
    /// References to the form and to those that it repeats; the form first.
    pub forms: Vec<String>,
    /// Says whether two forms are the same.
    pub digest: String,
    /// A small picture, in a square of 100 by 100.
    pub picture: Vec<Part>,
}

/// What a generator made.
#[derive(Clone, Debug, Default)]
pub struct Artwork {
    /// What its clones repeat.
    pub symbols: Vec<Symbol>,
    /// Sublayers in drawing order.
    pub groups: Vec<Group>,
    /// False if the time limit or a named limit cut the work short.
    pub complete: bool,
    /// What the artist should know, each a sentence.
    pub warnings: Vec<String>,
    /// Counts and measures for the report, by name.
    pub counts: BTreeMap<String, f64>,
    /// What is to be kept of an exploration.
    pub steps: Vec<Step>,
    /// Decimals of coordinates; see [`crate::decimals_for`].
    pub decimals: usize,
}

impl Artwork {
    /// An item's shapes, a clone's in its pose.
    pub fn shapes(&self, item: &Item) -> Vec<Part> {
        let posed = |(symbol, pose): (usize, Affine)| {
            let parts = self.symbols[symbol].parts();
            parts.map(|part| Part { transform: pose * part.transform, ..part.clone() }).collect()
        };
        item.clone.map_or_else(|| item.parts.clone(), posed)
    }

    /// The sublayer of this name, if the generator made one.
    pub fn group(&self, name: &str) -> Option<&Group> {
        self.groups.iter().find(|group| group.name == name)
    }
}
