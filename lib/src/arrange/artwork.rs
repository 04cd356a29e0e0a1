//! Elements in their places to an artwork.

use super::example::Analysis;
use super::grow::{Arrangement, Object};
use super::params::Params;
use crate::geom::boolean;
use crate::geom::flatten::flatten;
use crate::geom::region::Region;
use crate::rng::Rng;
use crate::shapes::Shapes;
use kurbo::{Affine, BezPath, Point, Vec2};
use rinceau_format::{Error, Example, Group, Item, Part, Reference, Scene, Style, Symbol, rgb};
use std::collections::BTreeMap;

/// A container: all of it, and what of it is free.
pub(super) struct Outline {
    whole: Region,
    free: Region,
}

impl Outline {
    /// `None` if nothing is free.
    pub fn new(shapes: &Shapes, index: usize, gap: f64) -> Option<Self> {
        let whole = Region::new(shapes.containers[index].clone())?;
        Some(Outline { whole, free: shapes.free(index, gap, gap)? })
    }

    /// Where the middles of elements may be.
    pub fn middles(&self, edge: &str, example: &Analysis) -> Region {
        if edge != "over" {
            return self.free.clone();
        }
        let half = example.elements.iter().map(|element| 0.5 * element.bounds.size().max_side());
        let reach = half.fold(0.0, f64::max);
        Region::new(boolean::offset(self.free.contours(), reach)).unwrap_or_else(|| self.free.clone())
    }

    /// True if an element with these points on its outline is drawn.
    fn shows(&self, edge: &str, at: Point, hull: &[Point], radius: f64) -> bool {
        let is_inside = self.free.contains(at);
        // Most are well inside.
        if is_inside && self.free.distance(at, 1.01 * radius) > radius {
            return true;
        }
        // What crosses the outline of the shape must still keep clear of what is fixed.
        let keeps_clear = || hull.iter().all(|&p| self.free.contains(p) || !self.whole.contains(p));
        match edge {
            "inside" => is_inside && hull.iter().all(|&p| self.free.contains(p)),
            "middle" => is_inside && keeps_clear(),
            _ => (is_inside || hull.iter().any(|&p| self.free.contains(p))) && keeps_clear(),
        }
    }
}

/// Sublayers of one run, filled shape by shape.
pub(super) struct Drawing {
    elements: Group,
    fixed: Group,
    connectivity: Group,
    symbols: Vec<Symbol>,
}

impl Drawing {
    pub fn new(scene: &Scene) -> Self {
        let named = |name: &str, hidden| Group { name: name.into(), hidden, ..Group::default() };
        let mut fixed = named("fixed", false);
        fixed.items =
            scene.fixed.iter().map(|fixed| Item::new(fixed.source.id.clone(), fixed.parts.clone())).collect();
        Drawing {
            elements: named("elements", false),
            fixed,
            connectivity: named("connectivity", true),
            symbols: Vec::new(),
        }
    }

    pub fn count(&self) -> usize {
        self.elements.items.len()
    }

    /// The sublayers that hold something, and what their clones repeat.
    pub fn into_parts(self) -> (Vec<Group>, Vec<Symbol>) {
        let mut groups = vec![self.elements, self.fixed, self.connectivity];
        groups.retain(|group| !group.items.is_empty());
        (groups, self.symbols)
    }

    /// Draws an arrangement.
    ///
    /// Errors: clones are to vary in tone.
    pub fn add(
        &mut self,
        arrangement: &Arrangement,
        (example, reference): (&Analysis, &Reference),
        outline: Option<&Outline>,
        (params, rng): (&Params, &mut Rng),
    ) -> Result<(), Error> {
        let has_clones = params.output == "clones";
        if has_clones && params.vary_tone > 0.0 {
            return Err(reference.source.error(
                "paths-only",
                "Clones have the tones of their symbol",
                "Choose copies as result, or let tones be",
            ));
        }
        let drawn: Vec<&Example> =
            example.elements.iter().map(|element| &reference.examples[element.index]).collect();
        let hulls: Vec<Vec<Vec2>> = drawn
            .iter()
            .zip(&example.elements)
            .map(|(one, element)| hull(one, element.at, example.mean))
            .collect();
        let mut symbols: BTreeMap<usize, usize> = BTreeMap::new();
        let mut placed: Vec<(f64, Item)> = Vec::new();
        let order = order(params, example);
        for (number, &index) in arrangement.grown.iter().enumerate() {
            let object = &arrangement.objects[index as usize];
            let Some((copy, turn)) = object.copy else { continue };
            // Drawn from the same numbers whatever else is left out.
            let mut own = rng.fork();
            let pose = pose(object, turn, example.elements[copy].at, params, &mut own);
            if let Some(outline) = outline {
                let points: Vec<Point> =
                    hulls[copy].iter().map(|&v| pose * (example.elements[copy].at + v)).collect();
                let radius = points.iter().map(|p| p.distance(object.at)).fold(0.0, f64::max);
                if !outline.shows(&params.edge, object.at, &points, radius) {
                    continue;
                }
            }
            let of = drawn[copy].source.id.clone();
            let item = if has_clones {
                let symbol = *symbols.entry(copy).or_insert_with(|| {
                    let name = format!("{of}{}", self.symbols.len() + 1);
                    self.symbols.push(Symbol::new(name, drawn[copy].parts.clone()));
                    self.symbols.len() - 1
                });
                Item::cloned(of, symbol, pose)
            } else {
                let tone = params.vary_tone * own.between(-1.0, 1.0);
                Item::new(of, drawn[copy].parts.iter().map(|part| copied(part, pose, tone)).collect())
            };
            let key = order.map_or(number as f64, |way| way.dot(object.at.to_vec2()));
            placed.push((key, item));
        }
        placed.sort_by(|a, b| a.0.total_cmp(&b.0));
        self.elements.items.extend(placed.into_iter().map(|(_, item)| item));
        self.connectivity.items.extend(connectivity(arrangement, example.mean));
        Ok(())
    }
}

/// Points on the outline of an element, from its middle.
fn hull(one: &Example, at: Point, mean: f64) -> Vec<Vec2> {
    /// So true are chords, in mean edges; what is between points may bulge by as much again.
    const TOLERANCE: f64 = 0.002;
    const MOST: usize = 200;
    let lines =
        one.parts.iter().flat_map(|part| flatten(&(part.transform * part.path.clone()), TOLERANCE * mean));
    let points: Vec<Point> = lines.flat_map(|line| line.points).collect();
    // Evenly many, and those that lie farthest out in eight directions.
    let step = points.len().div_ceil(MOST).max(1);
    let mut hull: Vec<Vec2> = points.iter().step_by(step).map(|&p| p - at).collect();
    for way in [(1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (-1.0, 1.0)].map(|(x, y)| Vec2::new(x, y)) {
        let along = |p: &&Point| way.dot(**p - at);
        hull.extend(points.iter().max_by(|a, b| along(a).total_cmp(&along(b))).map(|&p| p - at));
        hull.extend(points.iter().min_by(|a, b| along(a).total_cmp(&along(b))).map(|&p| p - at));
    }
    for v in &mut hull {
        *v *= 1.0 + 3.0 * TOLERANCE * mean / v.hypot().max(TOLERANCE * mean);
    }
    hull
}

/// From an element of the example to a place, with its own variations.
fn pose(object: &Object, turn: Vec2, from: Point, params: &Params, rng: &mut Rng) -> Affine {
    let size = 1.0 + params.vary_size * rng.between(-1.0, 1.0);
    let angle = params.vary_turn.to_radians() * rng.between(-1.0, 1.0);
    let turned = Affine::new([turn.x, turn.y, -turn.y, turn.x, 0.0, 0.0]);
    let varied = Affine::new([
        size * libm::cos(angle),
        size * libm::sin(angle),
        -size * libm::sin(angle),
        size * libm::cos(angle),
        0.0,
        0.0,
    ]);
    Affine::translate(object.at.to_vec2()) * turned * varied * Affine::translate(-from.to_vec2())
}

/// Which way elements that lie over others lie: the direction in which the example was drawn.
fn order(params: &Params, example: &Analysis) -> Option<Vec2> {
    match params.order.as_str() {
        "rows" => Some(Vec2::new(1e-3, 1.0)),
        "growth" => None,
        _ => {
            let n = example.elements.len() as f64;
            let middle = example.elements.iter().fold(Vec2::ZERO, |sum, one| sum + one.at.to_vec2()) / n;
            let way = example.elements.iter().enumerate().fold(Vec2::ZERO, |sum, (i, one)| {
                sum + (i as f64 - 0.5 * (n - 1.0)) * (one.at.to_vec2() - middle)
            });
            (way.hypot() > 0.0).then(|| way / way.hypot())
        }
    }
}

fn copied(part: &Part, pose: Affine, tone: f64) -> Part {
    let mut style = part.style.clone();
    if tone != 0.0 {
        for name in ["fill", "stroke"] {
            let paint = style.get(name).or((name == "fill").then_some("#000000")).and_then(rgb);
            if let Some(colour) = paint {
                let [r, g, b] = colour.map(|c| toned(c, tone));
                style.set(name, &format!("#{r:02x}{g:02x}{b:02x}"));
            }
        }
    }
    Part { path: part.path.clone(), transform: pose * part.transform, style }
}

/// A share of the way to white, or to black.
fn toned(channel: u8, tone: f64) -> u8 {
    let (channel, end) = (f64::from(channel), if tone > 0.0 { 255.0 } else { 0.0 });
    (channel + tone.abs() * (end - channel)).round() as u8
}

/// The edges between elements, as lines.
fn connectivity(arrangement: &Arrangement, mean: f64) -> Vec<Item> {
    let mut style = Style::filled("none");
    style.set("stroke", "#ff0000");
    style.set("stroke-width", &format!("{:.4}", 0.02 * mean));
    let mut items = Vec::new();
    for &index in &arrangement.grown {
        let object = &arrangement.objects[index as usize];
        let mut path = BezPath::new();
        for &other in &object.edges {
            let to = &arrangement.objects[other as usize];
            if to.copy.is_some() && other > index {
                path.move_to(object.at);
                path.line_to(to.at);
            }
        }
        if !path.is_empty() {
            let part = Part { path, transform: Affine::IDENTITY, style: style.clone() };
            items.push(Item::new("edge", vec![part]));
        }
    }
    items
}
