//! Plain data: what a generator made, in drawing order.

use crate::style::Style;
use kurbo::{Affine, BezPath};
use std::collections::BTreeMap;

/// One painted shape.
#[derive(Clone, Debug)]
pub struct Part {
    /// In its own coordinates.
    pub path: BezPath,
    /// From its own coordinates to user units of the root.
    pub transform: Affine,
    /// Its paint; widths are in its own coordinates.
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

/// Shapes that clones repeat: edit them once, and every clone follows.
#[derive(Clone, Debug)]
pub struct Symbol {
    /// Name, unique in the artwork.
    pub name: String,
    /// Its shapes in drawing order.
    pub parts: Vec<Part>,
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
    /// Decimals of coordinates; see [`crate::decimals_for`].
    pub decimals: usize,
}

impl Artwork {
    /// An item's shapes, a clone's in its pose.
    pub fn shapes(&self, item: &Item) -> Vec<Part> {
        let posed = |(symbol, pose): (usize, Affine)| {
            let parts = self.symbols[symbol].parts.iter();
            parts.map(|part| Part { transform: pose * part.transform, ..part.clone() }).collect()
        };
        item.clone.map_or_else(|| item.parts.clone(), posed)
    }

    /// The sublayer of this name, if the generator made one.
    pub fn group(&self, name: &str) -> Option<&Group> {
        self.groups.iter().find(|group| group.name == name)
    }
}
