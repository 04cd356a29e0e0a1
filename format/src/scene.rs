//! Plain data: what a drawing asks for, in user units of the root, with nothing left to look up.

use crate::artwork::Part;
use crate::error::{Error, Position};
use crate::json;
use crate::style::FillRule;
use kurbo::{Affine, BezPath, Point, Rect};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Which unannotated objects to use, by id: closed shapes become containers, open paths
/// guides. Of annotated objects it restricts containers to those selected, if any are.
#[derive(Clone, Debug, Default)]
pub struct Selection {
    /// Ids of the selected objects.
    pub ids: Vec<String>,
}

/// Everything a generator may ask of a drawing.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// The root's view box, or its size where it has none.
    #[serde(with = "json::rect")]
    #[schemars(with = "[f64; 4]")]
    pub view: Rect,
    /// CSS pixels per user unit of the root: 1 in a px drawing, 3.78 in a mm drawing.
    pub px_per_unit: f64,
    /// Regions to fill.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub containers: Vec<Container>,
    /// Directions of flow.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub guides: Vec<Guide>,
    /// Kept clear and copied into the result.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub fixed: Vec<Fixed>,
    /// Open paths that an element must lie along.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub fixed_spines: Vec<Guide>,
    /// Base stems.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub stems: Vec<Guide>,
    /// Where growth starts.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub seeds: Vec<Seed>,
    /// Templates.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub elements: Vec<Element>,
    /// Display lists, in drawing order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub forms: Vec<Form>,
    /// Fixed points of tack transformations.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub tacks: Vec<Seed>,
    /// Example arrangements, in drawing order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub references: Vec<Reference>,
    /// Paths that stop growth.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub boundaries: Vec<Guide>,
    /// Strokes that paint a growth area.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sprays: Vec<Stroke>,
    /// Rule sets that the drawing carries.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rules: Vec<RuleSet>,
    /// What was read with a doubt, each a sentence with its position.
    #[serde(skip)]
    pub warnings: Vec<String>,
}

/// Where an object stands in the drawing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Source {
    /// Its id; an object without one gets `node:` and its place among its siblings, from the
    /// root down.
    pub id: String,
    /// Its Inkscape label, else its id.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub label: String,
    /// Where its tag starts.
    #[serde(skip)]
    pub at: Position,
}

impl Source {
    /// An error at this object.
    pub fn error(&self, code: &'static str, sentence: impl AsRef<str>, remedy: impl AsRef<str>) -> Error {
        Error::new(code, sentence, remedy).at(self.at)
    }
}

/// A path and which inside of it is meant.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Outline {
    /// In user units of the root.
    #[serde(with = "json::path")]
    #[schemars(with = "String")]
    pub path: BezPath,
    /// As drawn.
    #[serde(default)]
    pub rule: FillRule,
}

/// A region to fill: the union of its outlines.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Container {
    /// The object.
    pub source: Source,
    /// One for a shape, several for a group or text.
    pub outlines: Vec<Outline>,
    /// The painted fill as written, if there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fill: Option<String>,
    /// Parameters this container sets for itself: `rinceau:spacing="8"` and so on.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub overrides: BTreeMap<String, String>,
}

/// A directed path.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Guide {
    /// The object.
    pub source: Source,
    /// False for a path without a role that was only selected: what it is for is then up to
    /// the generator.
    #[serde(skip, default = "json::yes")]
    pub marked: bool,
    /// In user units of the root; may have several subpaths.
    #[serde(with = "json::path")]
    #[schemars(with = "String")]
    pub path: BezPath,
}

/// A stroked path.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stroke {
    /// The object.
    pub source: Source,
    /// In user units of the root.
    #[serde(with = "json::path")]
    #[schemars(with = "String")]
    pub path: BezPath,
    /// Stroke width in user units of the root.
    pub width: f64,
    /// Parameters of its own, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub overrides: BTreeMap<String, String>,
}

/// Drawn artwork that is kept clear and copied into the result.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fixed {
    /// The object.
    pub source: Source,
    /// Its shapes in drawing order.
    pub parts: Vec<Part>,
}

/// A rule set.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RuleSet {
    /// Its name, or that of its file.
    pub name: String,
    /// Its text.
    pub text: String,
}

/// A point-like object: the middle of its bounding box.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Seed {
    /// The object.
    pub source: Source,
    /// In user units of the root.
    #[serde(with = "json::point")]
    #[schemars(with = "[f64; 2]")]
    pub at: Point,
}

/// A template as drawn, in user units of the root.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Template {
    /// Its shapes in drawing order.
    pub parts: Vec<Part>,
    /// From base to tip, if a spine is drawn. Never of zero length.
    #[serde(default, with = "json::spine", skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<[[f64; 2]; 2]>")]
    pub spine: Option<(Point, Point)>,
}

/// A named template.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Element {
    /// The object.
    pub source: Source,
    /// `rinceau:kind`: leaf, flower, bud, stem ...
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub kind: String,
    /// `rinceau:symbol`, else the id.
    pub symbol: String,
    /// `rinceau:set`: families it belongs to.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sets: Vec<String>,
    /// The artwork.
    pub template: Template,
}

/// A display list of primitives and clones: a recursive form.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Form {
    /// The group.
    pub source: Source,
    /// True if it is to be drawn for its own sake: it was selected, or nothing was and no other
    /// form has a clone of it.
    #[serde(skip)]
    pub is_root: bool,
    /// In paint order.
    pub items: Vec<FormItem>,
    /// Parameters this form sets for itself: `rinceau:depth="8"` and so on.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub overrides: BTreeMap<String, String>,
}

/// An entry of a display list.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FormItem {
    /// What is drawn.
    Primitive(Primitive),
    /// Where a form goes on.
    Clone(Replication),
}

/// A drawn part of a motif.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Primitive {
    /// As drawn.
    pub part: Part,
    /// When it is drawn.
    #[serde(default, skip_serializing_if = "When::is_as_form")]
    pub when: When,
    /// How a clone refers to the object itself; `None` if it has no id. Parts of one object have
    /// the same.
    #[serde(skip)]
    pub live: Option<Live>,
}

/// In which generations a primitive is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum When {
    /// As the whole form.
    #[default]
    AsForm,
    /// Only in the last.
    Last,
    /// In all but the last.
    Inner,
}

impl When {
    fn is_as_form(&self) -> bool {
        *self == When::AsForm
    }
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
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Replication {
    /// The clone.
    pub source: Source,
    /// Index of the form it repeats.
    pub form: usize,
    /// From the place where that form is drawn to where it goes, in user units of the root.
    #[serde(with = "json::affine")]
    #[schemars(with = "[f64; 6]")]
    pub transform: Affine,
}

/// An example arrangement.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Reference {
    /// The group.
    pub source: Source,
    /// Its objects in drawing order.
    pub examples: Vec<Example>,
    /// Pairs of ids: edges of the connectivity to be flipped.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub flips: Vec<(String, String)>,
}

/// An object of an example arrangement.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Example {
    /// The object.
    pub source: Source,
    /// What it is one of: named, the source of a clone, or the first of the same shape.
    pub symbol: String,
    /// Its shapes in drawing order, in user units of the root.
    pub parts: Vec<Part>,
}
