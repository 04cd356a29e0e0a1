//! Plain data: what a drawing asks for, in user units of the root, with nothing left to look up.

use crate::artwork::Part;
use crate::error::{Error, Position};
use crate::style::FillRule;
use kurbo::{Affine, BezPath, Point, Rect};
use std::collections::BTreeMap;

/// Which unannotated objects to use, by id: closed shapes become containers, open paths
/// guides. Of annotated objects it restricts containers to those selected, if any are.
#[derive(Clone, Debug, Default)]
pub struct Selection {
    /// Ids of the selected objects.
    pub ids: Vec<String>,
}

/// Everything a generator may ask of a drawing.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// The root's view box, or its size where it has none.
    pub view: Rect,
    /// CSS pixels per user unit of the root: 1 in a px drawing, 3.78 in a mm drawing.
    pub px_per_unit: f64,
    /// Regions to fill.
    pub containers: Vec<Container>,
    /// Directions of flow.
    pub guides: Vec<Guide>,
    /// Kept clear and copied into the result.
    pub fixed: Vec<Fixed>,
    /// Open paths that an element must lie along.
    pub fixed_spines: Vec<Guide>,
    /// Base stems.
    pub stems: Vec<Guide>,
    /// Where growth starts.
    pub seeds: Vec<Seed>,
    /// Templates.
    pub elements: Vec<Element>,
    /// Display lists, in drawing order.
    pub forms: Vec<Form>,
    /// Fixed points of tack transformations.
    pub tacks: Vec<Seed>,
    /// Example arrangements, in drawing order.
    pub references: Vec<Reference>,
    /// Paths that stop growth.
    pub boundaries: Vec<Guide>,
    /// Strokes that paint a growth area.
    pub sprays: Vec<Stroke>,
    /// Rule sets that the drawing carries.
    pub rules: Vec<RuleSet>,
    /// What was read with a doubt, each a sentence with its position.
    pub warnings: Vec<String>,
}

/// Where an object stands in the drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct Source {
    /// Its id; an object without one gets `node:` and its place among its siblings, from the
    /// root down.
    pub id: String,
    /// Its Inkscape label, else its id.
    pub label: String,
    /// Where its tag starts.
    pub at: Position,
}

impl Source {
    /// An error at this object.
    pub fn error(&self, code: &'static str, sentence: impl AsRef<str>, remedy: impl AsRef<str>) -> Error {
        Error::new(code, sentence, remedy).at(self.at)
    }
}

/// A path and which inside of it is meant.
#[derive(Clone, Debug)]
pub struct Outline {
    /// In user units of the root.
    pub path: BezPath,
    /// As drawn.
    pub rule: FillRule,
}

/// A region to fill: the union of its outlines.
#[derive(Clone, Debug)]
pub struct Container {
    /// The object.
    pub source: Source,
    /// One for a shape, several for a group or text.
    pub outlines: Vec<Outline>,
    /// The painted fill as written, if there is one.
    pub fill: Option<String>,
    /// Parameters this container sets for itself: `rinceau:spacing="8"` and so on.
    pub overrides: BTreeMap<String, String>,
}

/// A directed path.
#[derive(Clone, Debug)]
pub struct Guide {
    /// The object.
    pub source: Source,
    /// False for a path without a role that was only selected: what it is for is then up to
    /// the generator.
    pub marked: bool,
    /// In user units of the root; may have several subpaths.
    pub path: BezPath,
}

/// A stroked path.
#[derive(Clone, Debug)]
pub struct Stroke {
    /// The object.
    pub source: Source,
    /// In user units of the root.
    pub path: BezPath,
    /// Stroke width in user units of the root.
    pub width: f64,
    /// Parameters of its own, by name.
    pub overrides: BTreeMap<String, String>,
}

/// Drawn artwork that is kept clear and copied into the result.
#[derive(Clone, Debug)]
pub struct Fixed {
    /// The object.
    pub source: Source,
    /// Its shapes in drawing order.
    pub parts: Vec<Part>,
}

/// A rule set.
#[derive(Clone, Debug)]
pub struct RuleSet {
    /// Its name, or that of its file.
    pub name: String,
    /// Its text.
    pub text: String,
}

/// A point-like object: the middle of its bounding box.
#[derive(Clone, Debug)]
pub struct Seed {
    /// The object.
    pub source: Source,
    /// In user units of the root.
    pub at: Point,
}

/// A template as drawn, in user units of the root.
#[derive(Clone, Debug)]
pub struct Template {
    /// Its shapes in drawing order.
    pub parts: Vec<Part>,
    /// From base to tip, if a spine is drawn. Never of zero length.
    pub spine: Option<(Point, Point)>,
}

/// A named template.
#[derive(Clone, Debug)]
pub struct Element {
    /// The object.
    pub source: Source,
    /// `rinceau:kind`: leaf, flower, bud, stem ...
    pub kind: String,
    /// `rinceau:symbol`, else the id.
    pub symbol: String,
    /// `rinceau:set`: families it belongs to.
    pub sets: Vec<String>,
    /// The artwork.
    pub template: Template,
}

/// A display list of primitives and clones: a recursive form.
#[derive(Clone, Debug)]
pub struct Form {
    /// The group.
    pub source: Source,
    /// True if it is to be drawn for its own sake: it was selected, or nothing was and no other
    /// form has a clone of it.
    pub is_root: bool,
    /// In paint order.
    pub items: Vec<FormItem>,
    /// Parameters this form sets for itself: `rinceau:depth="8"` and so on.
    pub overrides: BTreeMap<String, String>,
}

/// An entry of a display list.
#[derive(Clone, Debug)]
pub enum FormItem {
    /// What is drawn.
    Primitive(Primitive),
    /// Where a form goes on.
    Clone(Replication),
}

/// A drawn part of a motif.
#[derive(Clone, Debug)]
pub struct Primitive {
    /// As drawn.
    pub part: Part,
    /// When it is drawn.
    pub when: When,
    /// How a clone refers to the object itself; `None` if it has no id. Parts of one object have
    /// the same.
    pub live: Option<Live>,
}

/// In which generations a primitive is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum When {
    /// As the whole form.
    #[default]
    AsForm,
    /// Only in the last.
    Last,
    /// In all but the last.
    Inner,
}

/// What a clone of a drawn object needs.
#[derive(Clone, Debug, PartialEq)]
pub struct Live {
    /// Its id.
    pub id: String,
    /// From its parent's coordinates to user units of the root.
    pub frame: Affine,
    /// What it inherits, as CSS.
    pub inherited: String,
}

/// A clone inside a form.
#[derive(Clone, Debug)]
pub struct Replication {
    /// The clone.
    pub source: Source,
    /// Index of the form it repeats.
    pub form: usize,
    /// From the place where that form is drawn to where it goes, in user units of the root.
    pub transform: Affine,
}

/// An example arrangement.
#[derive(Clone, Debug)]
pub struct Reference {
    /// The group.
    pub source: Source,
    /// Its objects in drawing order.
    pub examples: Vec<Example>,
    /// Pairs of ids: edges of the connectivity to be flipped.
    pub flips: Vec<(String, String)>,
}

/// An object of an example arrangement.
#[derive(Clone, Debug)]
pub struct Example {
    /// The object.
    pub source: Source,
    /// What it is one of: named, the source of a clone, or the first of the same shape.
    pub symbol: String,
    /// Its shapes in drawing order, in user units of the root.
    pub parts: Vec<Part>,
}
