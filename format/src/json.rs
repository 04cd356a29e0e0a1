//! The JSON form of a scene: everything that the format knows of a drawing, and nothing else of it.
//!
//! Paths are SVG path data, points `[x, y]`, transforms the six numbers of `matrix()`, paint an object of
//! CSS properties. Numbers are exact: the same scene comes back. `scene.schema.json` beside this crate is
//! made from the types.

use crate::error::{Error, Position};
use crate::limits::Limits;
use crate::read::set_roots;
use crate::scene::{FormItem, Scene, Source};
use crate::shape;
use crate::style::Style;
use kurbo::{Affine, BezPath, PathEl, Point, Rect};
use schemars::JsonSchema;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::collections::{BTreeMap, HashSet};
use std::fmt::Write;

/// The version of the JSON form.
const VERSION: u32 = 1;

/// A scene in JSON.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "Rinceau scene")]
struct File<S> {
    /// Version of the form.
    rinceau: u32,
    scene: S,
}

impl Scene {
    /// The scene as JSON. Warnings, positions in the text of the drawing, and where gradients and clones
    /// come from belong to the drawing and are not in it.
    pub fn to_json(&self) -> String {
        let mut scene = self.clone();
        each_source(&mut scene, |source| {
            if source.label == source.id {
                source.label.clear();
            }
        });
        let mut json = serde_json::to_string_pretty(&File { rinceau: VERSION, scene }).unwrap_or_default();
        json.push('\n');
        json
    }

    /// A scene from JSON.
    ///
    /// Errors: what [`Scene::to_json`] does not write, with line and column; numbers beyond the limits.
    pub fn from_json(text: &str) -> Result<Self, Error> {
        let remedy = "Compare it with scene.schema.json, or make it again with 'rinceau convert'";
        let limits = Limits::default();
        if text.len() > limits.bytes {
            return Err(Error::new(
                "too-large",
                format!("The scene is larger than {} MiB", limits.bytes >> 20),
                "Move what is needed into a smaller one",
            ));
        }
        let file: File<Scene> = serde_json::from_str(text).map_err(|error| {
            let at = Position { line: error.line().max(1), column: error.column().max(1) };
            let full = error.to_string();
            let what = full.split(" at line ").next().unwrap_or(&full);
            Error::new("broken-json", format!("This is no scene: {what}"), remedy).at(at)
        })?;
        let wrong = |sentence: String| Err(Error::new("broken-json", sentence, remedy));
        if file.rinceau != VERSION {
            return wrong(format!("The scene is of version {}, not of {VERSION}", file.rinceau));
        }
        let mut scene = file.scene;
        each_source(&mut scene, |source| {
            if source.label.is_empty() {
                source.label.clone_from(&source.id);
            }
        });
        let symbols = scene.elements.iter_mut().map(|one| (&mut one.symbol, &one.source));
        let examples = scene.references.iter_mut().flat_map(|one| &mut one.examples);
        for (symbol, source) in symbols.chain(examples.map(|one| (&mut one.symbol, &one.source))) {
            *symbol = Some(symbol.trim()).filter(|name| !name.is_empty()).unwrap_or(&source.id).to_owned();
        }
        if let Some(what) = fault(&scene, &limits).or_else(|| hollow(&mut scene)) {
            return wrong(what);
        }
        set_roots(&mut scene.forms);
        Ok(scene)
    }

    /// The JSON Schema of [`Scene::to_json`].
    pub fn json_schema() -> String {
        let schema = schemars::schema_for!(File<Scene>);
        let mut json = serde_json::to_string_pretty(&schema).unwrap_or_default();
        json.push('\n');
        json
    }
}

/// Visits what every object of a scene is called.
pub(crate) fn each_source(scene: &mut Scene, mut visit: impl FnMut(&mut Source)) {
    scene.containers.iter_mut().for_each(|one| visit(&mut one.source));
    for list in [&mut scene.guides, &mut scene.fixed_spines, &mut scene.stems, &mut scene.boundaries] {
        list.iter_mut().for_each(|one| visit(&mut one.source));
    }
    scene.fixed.iter_mut().for_each(|one| visit(&mut one.source));
    scene.seeds.iter_mut().chain(&mut scene.tacks).for_each(|one| visit(&mut one.source));
    scene.elements.iter_mut().for_each(|one| visit(&mut one.source));
    scene.sprays.iter_mut().for_each(|one| visit(&mut one.source));
    for form in &mut scene.forms {
        visit(&mut form.source);
        for item in &mut form.items {
            if let FormItem::Clone(clone) = item {
                visit(&mut clone.source);
            }
        }
    }
    for reference in &mut scene.references {
        visit(&mut reference.source);
        reference.examples.iter_mut().for_each(|one| visit(&mut one.source));
    }
}

/// An object without a name of its own, or with nothing in it where no drawing has that, in words.
fn hollow(scene: &mut Scene) -> Option<String> {
    let mut is_named = true;
    let (mut ids, mut twice) = (HashSet::new(), None);
    each_source(scene, |source| {
        is_named &= !source.id.trim().is_empty();
        if !ids.insert(source.id.clone()) && twice.is_none() {
            twice = Some(source.id.clone());
        }
    });
    if !is_named {
        return Some("An object of it has no id".to_owned());
    }
    if let Some(id) = twice {
        return Some(format!("Two objects of it have the id '{id}'"));
    }
    let elements = scene.elements.iter().map(|one| (&one.source, one.template.parts.is_empty()));
    let examples = scene.references.iter().flat_map(|one| &one.examples);
    let examples = examples.map(|one| (&one.source, one.parts.is_empty()));
    let mut all = elements.chain(examples);
    let (source, _) = all.find(|(_, is_empty)| *is_empty)?;
    Some(format!("'{}' has nothing in it", source.id))
}

/// What of a scene no drawing could have said, in words.
fn fault(scene: &Scene, limits: &Limits) -> Option<String> {
    let is_far = |p: Point| !(p.x.abs() <= limits.coordinate && p.y.abs() <= limits.coordinate);
    if !(scene.view.is_finite() && scene.view.width() > 0.0 && scene.view.height() > 0.0)
        || is_far(scene.view.origin())
        || is_far(Point::new(scene.view.x1, scene.view.y1))
        || !(scene.px_per_unit > 0.0 && scene.px_per_unit <= limits.coordinate)
    {
        return Some("Its page has no size that a drawing could have".to_owned());
    }
    let guides = scene.guides.iter().chain(&scene.fixed_spines).chain(&scene.stems).chain(&scene.boundaries);
    let mut paths: Vec<(&Source, Rect)> = guides.map(|one| (&one.source, one.path.control_box())).collect();
    paths.extend(scene.sprays.iter().map(|one| (&one.source, one.path.control_box())));
    for container in &scene.containers {
        let boxes = container.outlines.iter().map(|outline| outline.path.control_box());
        paths.extend(boxes.map(|bounds| (&container.source, bounds)));
    }
    let points = scene.seeds.iter().chain(&scene.tacks);
    paths.extend(points.map(|one| (&one.source, Rect::from_points(one.at, one.at))));
    let fixed = scene.fixed.iter().flat_map(|one| one.parts.iter().map(move |part| (&one.source, part)));
    let elements =
        scene.elements.iter().flat_map(|one| one.template.parts.iter().map(move |part| (&one.source, part)));
    let examples = scene.references.iter().flat_map(|one| &one.examples);
    let examples = examples.flat_map(|one| one.parts.iter().map(move |part| (&one.source, part)));
    let primitives = scene.forms.iter().flat_map(|form| {
        form.items.iter().filter_map(move |item| match item {
            FormItem::Primitive(primitive) => Some((&form.source, &primitive.part)),
            FormItem::Clone(_) => None,
        })
    });
    for (source, part) in fixed.chain(elements).chain(examples).chain(primitives) {
        paths.push((source, part.transform.transform_rect_bbox(part.path.control_box())));
    }
    for (source, bounds) in paths {
        if is_far(bounds.origin()) || is_far(Point::new(bounds.x1, bounds.y1)) {
            return Some(format!("'{}' has a coordinate beyond 1e9", source.id));
        }
    }
    if let Some(spray) = scene.sprays.iter().find(|spray| !(0.0..=limits.coordinate).contains(&spray.width)) {
        return Some(format!("The spray '{}' has no width that a stroke could have", spray.source.id));
    }
    let short = scene.elements.iter().find(|element| {
        element
            .template
            .spine
            .is_some_and(|(base, tip)| !(base.distance(tip) > 0.0 && !is_far(base) && !is_far(tip)))
    });
    if let Some(element) = short {
        return Some(format!("The spine of '{}' has no length", element.source.id));
    }
    let is_name = |name: &String| {
        name.starts_with(|c: char| c.is_ascii_lowercase())
            && name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-')
    };
    let overrides = scene.containers.iter().map(|one| (&one.source, &one.overrides));
    let overrides = overrides.chain(scene.sprays.iter().map(|one| (&one.source, &one.overrides)));
    let overrides = overrides.chain(scene.forms.iter().map(|one| (&one.source, &one.overrides)));
    for (source, overrides) in overrides {
        if let Some(name) = overrides.keys().find(|name| !is_name(name) || *name == "role") {
            return Some(format!("'{}' sets '{name}', which is no parameter's name", source.id));
        }
    }
    let is_word = |word: &String| !word.is_empty() && !word.contains(char::is_whitespace);
    if let Some(element) = scene.elements.iter().find(|one| !one.sets.iter().all(is_word)) {
        return Some(format!("'{}' is in a set whose name is not one word", element.source.id));
    }
    let is_id = |id: &String| is_word(id) && !id.contains([',', ';']);
    if let Some(reference) =
        scene.references.iter().find(|one| !one.flips.iter().all(|(a, b)| is_id(a) && is_id(b)))
    {
        return Some(format!(
            "'{}' flips an edge between objects that no id could name",
            reference.source.id
        ));
    }
    for clone in scene.forms.iter().flat_map(|form| &form.items).filter_map(|item| match item {
        FormItem::Clone(clone) => Some(clone),
        FormItem::Primitive(_) => None,
    }) {
        let t = clone.transform;
        if clone.form >= scene.forms.len() {
            return Some(format!(
                "The clone '{}' is of form {}, which there is not",
                clone.source.id, clone.form
            ));
        }
        if !(t.is_finite() && t.inverse().is_finite()) {
            return Some(format!(
                "The clone '{}' is scaled to nothing, or beyond all measure",
                clone.source.id
            ));
        }
    }
    None
}

/// Path data with every digit.
pub(crate) fn exact_path_data(path: &BezPath) -> String {
    let mut out = String::new();
    let mut put = |letter: char, points: &[Point]| {
        out.push(letter);
        for (i, p) in points.iter().enumerate() {
            let _ = write!(out, "{}{},{}", if i > 0 { " " } else { "" }, p.x, p.y);
        }
    };
    for el in path.elements() {
        match *el {
            PathEl::MoveTo(p) => put('M', &[p]),
            PathEl::LineTo(p) => put('L', &[p]),
            PathEl::QuadTo(a, p) => put('Q', &[a, p]),
            PathEl::CurveTo(a, b, p) => put('C', &[a, b, p]),
            PathEl::ClosePath => put('Z', &[]),
        }
    }
    out
}

pub(crate) fn yes() -> bool {
    true
}

pub(crate) fn is_identity(transform: &Affine) -> bool {
    *transform == Affine::IDENTITY
}

pub(crate) mod path {
    use super::*;

    pub fn serialize<S: Serializer>(path: &BezPath, to: S) -> Result<S::Ok, S::Error> {
        exact_path_data(path).serialize(to)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<BezPath, D::Error> {
        let data = String::deserialize(from)?;
        let path = shape::path(&data).map_err(D::Error::custom)?;
        if path.is_finite() { Ok(path) } else { Err(D::Error::custom("its path is beyond all measure")) }
    }
}

pub(crate) mod point {
    use super::*;

    pub fn serialize<S: Serializer>(p: &Point, to: S) -> Result<S::Ok, S::Error> {
        [p.x, p.y].serialize(to)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Point, D::Error> {
        <[f64; 2]>::deserialize(from).map(|[x, y]| Point::new(x, y))
    }
}

pub(crate) mod spine {
    use super::*;

    pub fn serialize<S: Serializer>(spine: &Option<(Point, Point)>, to: S) -> Result<S::Ok, S::Error> {
        spine.map(|(base, tip)| [[base.x, base.y], [tip.x, tip.y]]).serialize(to)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Option<(Point, Point)>, D::Error> {
        let spine = Option::<[[f64; 2]; 2]>::deserialize(from)?;
        Ok(spine.map(|[base, tip]| (Point::new(base[0], base[1]), Point::new(tip[0], tip[1]))))
    }
}

pub(crate) mod rect {
    use super::*;

    pub fn serialize<S: Serializer>(rect: &Rect, to: S) -> Result<S::Ok, S::Error> {
        [rect.x0, rect.y0, rect.width(), rect.height()].serialize(to)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Rect, D::Error> {
        <[f64; 4]>::deserialize(from).map(|[x, y, width, height]| Rect::new(x, y, x + width, y + height))
    }
}

pub(crate) mod affine {
    use super::*;

    pub fn serialize<S: Serializer>(transform: &Affine, to: S) -> Result<S::Ok, S::Error> {
        transform.as_coeffs().serialize(to)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Affine, D::Error> {
        <[f64; 6]>::deserialize(from).map(Affine::new)
    }
}

pub(crate) mod style {
    use super::*;

    pub fn serialize<S: Serializer>(style: &Style, to: S) -> Result<S::Ok, S::Error> {
        style.properties().collect::<BTreeMap<_, _>>().serialize(to)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Style, D::Error> {
        let properties = BTreeMap::deserialize(from)?;
        Style::from_properties(&properties).map_err(D::Error::custom)
    }
}
