//! Placed elements to an artwork with its sublayers and counts.

use super::fill::Filler;
use super::finish::Finish;
use super::motif::Motif;
use super::negative::Shape;
use super::paint;
use super::place::Placed;
use super::prepare::{Field, Prepared};
use super::template::Template;
use crate::field::LineKind;
use crate::geom::polyline;
use crate::palette::palette;
use kurbo::{Affine, BezPath, Point};
use rayon::prelude::*;
use rinceau_format::{Artwork, Group, Item, Part, Scene, Style};
use std::collections::BTreeMap;

/// What one run has made.
pub(super) struct Made<'a> {
    pub prepared: &'a Prepared,
    pub templates: &'a [Template],
    pub placed: &'a [Placed],
    pub fillers: &'a [Filler],
    pub negative: &'a [Shape],
    pub streamlines: usize,
    /// Of the marks of wear.
    pub seed: u64,
}

impl Made<'_> {
    /// The three tones of a container's field.
    fn palette(&self, field: usize, scene: &Scene) -> [&'static str; 3] {
        let field = &self.prepared.fields[field];
        palette(&field.params.palette, scene.containers[field.container].fill.as_deref())
    }

    /// How the pieces of a container are finished.
    fn finish(&self, field: usize) -> Finish {
        let Field { params, sizes, .. } = &self.prepared.fields[field];
        Finish {
            rounding: sizes.rounding,
            distress: params.distress,
            seed: self.seed,
            spacing: sizes.spacing,
            tolerance: sizes.tolerance(),
        }
    }

    /// A warning if a fixed spine got no element.
    fn bare_spines(&self) -> Option<String> {
        let drawn: usize = self.prepared.fields.iter().map(|field| field.fixed_spines.len()).sum();
        let carried = self.placed.iter().filter(|placed| placed.kind == LineKind::Fixed).count();
        (carried < drawn).then(|| {
            let bare = drawn - carried;
            format!("{bare} of {drawn} fixed spines carry no element: there is no room beside them, or they run outside the container")
        })
    }

    /// Counts for the report.
    fn counts(&self) -> BTreeMap<String, f64> {
        let mut counts = BTreeMap::new();
        // Each is drawn once, or twice with its mirror image.
        let times = |field: usize| if self.prepared.fields[field].mirror.is_some() { 2.0 } else { 1.0 };
        for placed in self.placed {
            let count =
                counts.entry(format!("elements.{}", self.templates[placed.template].id)).or_insert(0.0);
            *count += times(placed.field);
        }
        let dots: f64 = self.fillers.iter().map(|filler| times(filler.field) * filler.area).sum();
        let ink: f64 = self.placed.iter().map(|placed| times(placed.field) * placed.area).sum();
        let count =
            |fields: &mut dyn Iterator<Item = usize>| fields.map(times).fold(0.0, |all, one| all + one);
        counts.insert("elements".into(), count(&mut self.placed.iter().map(|placed| placed.field)));
        counts.insert("fillers".into(), count(&mut self.fillers.iter().map(|filler| filler.field)));
        counts.insert("negative".into(), count(&mut self.negative.iter().map(|shape| shape.field)));
        counts.insert("streamlines".into(), self.streamlines as f64);
        let shapes: f64 = self.negative.iter().map(|shape| times(shape.field) * shape.area()).sum();
        counts.insert("coverage".into(), (ink + dots + shapes) / self.prepared.area.max(f64::MIN_POSITIVE));
        counts
    }
}

/// The result: elements, fillers, copies of fixed elements, and the final spines, hidden. Incomplete if the time
/// ran out before all were finished.
pub(super) fn artwork(made: &Made, scene: &Scene, mut go_on: impl FnMut(f64) -> bool) -> Artwork {
    let prepared = made.prepared;
    let decimals = rinceau_format::decimals_for(prepared.input_size);
    let spacing = prepared.fields.iter().map(|field| field.sizes.spacing).fold(0.0, f64::max);
    let tones = paint::assign(made.placed, 2.6 * spacing);
    let mirror = |field: usize| prepared.fields[field].mirror;
    // Bent finely only now, when it is known what stays, and on all cores.
    let drawn = |(index, (placed, tone)): (usize, (&Placed, usize))| {
        let field = &prepared.fields[placed.field];
        let template = &made.templates[placed.template];
        let palette = made.palette(placed.field, scene);
        // The accent is for the shapes of the gaps, where there are some.
        let tone = if field.params.has_shapes() && tone == 2 { index % 2 } else { tone };
        let paths = placed.paths(template, &field.sizes);
        let part = |((_, style), path): (&(BezPath, Style), BezPath)| {
            let style = if template.builtin {
                painted(style, palette[tone])
            } else {
                style.scaled(placed.scale, decimals)
            };
            Part { path, transform: Affine::IDENTITY, style }
        };
        let parts = template.parts.iter().zip(paths).map(part).collect();
        (placed.field, Item::new(template.id.clone(), parts))
    };
    let filler = |filler: &Filler| (filler.field, filler_item(filler, made, scene, decimals));
    let shape = |shape: &Shape| {
        let style = Style::filled(made.palette(shape.field, scene)[2]);
        let part = Part { path: shape.path(), transform: Affine::IDENTITY, style };
        (shape.field, Item::new("gap", vec![part]))
    };
    let elements = made.placed.par_iter().zip(tones).enumerate().map(drawn);
    let fillers = made.fillers.par_iter().map(filler);
    let mut items: Vec<(usize, Item)> =
        elements.chain(fillers).chain(made.negative.par_iter().map(shape)).collect();
    let complete = finished(&mut items, made, &mut go_on);
    let mut items = items.into_iter();
    let mut group = |name: &str, count: usize| {
        let mut group = Group { name: name.into(), ..Group::default() };
        items.by_ref().take(count).for_each(|(field, item)| push(&mut group, item, mirror(field)));
        group
    };
    let elements = group("elements", made.placed.len());
    let fillers = group("fillers", made.fillers.len());
    let negative = group("negative", made.negative.len());
    let mut spines = Group { name: "spines".into(), hidden: true, ..Group::default() };
    for placed in made.placed {
        push(&mut spines, spine_item(&placed.spine), mirror(placed.field));
    }
    let fixed = Group {
        name: "fixed".into(),
        items: scene
            .fixed
            .iter()
            .map(|fixed| Item::new(fixed.source.id.clone(), fixed.parts.clone()))
            .collect(),
        ..Group::default()
    };
    let mut groups = vec![elements, fillers, negative];
    groups.extend([fixed, spines]);
    groups.retain(|group| !group.items.is_empty());
    let mut warnings = scene.warnings.clone();
    warnings.extend(prepared.warnings.iter().cloned());
    warnings.extend(made.bare_spines());
    Artwork { groups, complete, warnings, counts: made.counts(), decimals, ..Artwork::default() }
}

/// Finishes items of containers. False if the time ran out first: the rest stay as they are.
fn finished(items: &mut [(usize, Item)], made: &Made, go_on: &mut dyn FnMut(f64) -> bool) -> bool {
    /// Between two looks at the clock.
    const AT_ONCE: usize = 32;
    let finishes: Vec<Finish> = (0..made.prepared.fields.len()).map(|field| made.finish(field)).collect();
    if finishes.iter().all(Finish::is_plain) {
        return true;
    }
    let all = items.len().div_ceil(AT_ONCE) as f64;
    for (index, items) in items.chunks_mut(AT_ONCE).enumerate() {
        if !go_on(index as f64 / all) {
            return false;
        }
        items.par_iter_mut().for_each(|(field, item)| {
            let parts = std::mem::take(&mut item.parts).into_iter();
            item.parts = parts.filter_map(|part| finishes[*field].part(part)).collect();
        });
    }
    true
}

/// A filler, in the accent if it is built in, so that the smallest shapes are seen as one family.
fn filler_item(filler: &Filler, made: &Made, scene: &Scene, decimals: usize) -> Item {
    let tone = made.palette(filler.field, scene)[2];
    let parts: Vec<Part> = match filler.motif {
        Motif::Element(template) => {
            let template = &made.templates[template];
            let transform = filler.transform();
            let scale = (transform.determinant().abs() / template.length).sqrt();
            let part = |(path, style): &(BezPath, Style)| {
                let style =
                    if template.builtin { painted(style, tone) } else { style.scaled(scale, decimals) };
                Part { path: transform * path.clone(), transform: Affine::IDENTITY, style }
            };
            template.parts.iter().map(part).collect()
        }
        _ => vec![Part { path: filler.path(), transform: Affine::IDENTITY, style: Style::filled(tone) }],
    };
    Item::new(filler.motif.name(made.templates).to_owned(), parts)
}

/// Adds an item, and its mirror image if there is one.
fn push(group: &mut Group, item: Item, mirror: Option<Affine>) {
    if item.parts.is_empty() {
        return;
    }
    let image = mirror.map(|mirror| {
        let parts = item.parts.iter().map(|part| Part { path: mirror * part.path.clone(), ..part.clone() });
        Item::new(item.of.clone(), parts.collect())
    });
    group.items.push(item);
    group.items.extend(image);
}

/// A built-in part in a palette's tone. Its holes are holes, so one tone is enough.
fn painted(style: &Style, tone: &str) -> Style {
    let mut style = style.clone();
    style.set("fill", tone);
    style
}

/// A spine as a line that can be edited and marked as fixed spine.
fn spine_item(points: &[Point]) -> Item {
    let mut path = BezPath::new();
    path.move_to(points[0]);
    points[1..].iter().for_each(|&p| path.line_to(p));
    let mut style = Style::filled("none");
    style.set("stroke", "#ff0000");
    style.set("stroke-width", &format!("{:.4}", polyline::length(points) / 200.0));
    Item::new("spine", vec![Part { path, transform: Affine::IDENTITY, style }])
}
