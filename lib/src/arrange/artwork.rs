//! Elements in their places to an artwork.

use super::example::Analysis;
use super::ground::Ground;
use super::grow::{Arrangement, Link};
use super::params::Params;
use super::relax;
use crate::geom::boolean;
use crate::geom::region::Region;
use crate::rng::Rng;
use crate::shapes::Shapes;
use kurbo::{Affine, BezPath, Point, Rect, Vec2};
use rinceau_format::{
    Error, Example, Group, Item, Part, Pieces, Reference, Scene, Stream, Style, Symbol, rgb,
};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A container: all of it, and what of it is free.
pub(super) struct Outline {
    whole: Region,
    free: Region,
    /// What repeats, if it does.
    pub tile: Option<Rect>,
}

impl Outline {
    /// `None` if nothing is free.
    pub fn new(shapes: &Shapes, index: usize, gap: f64) -> Option<Self> {
        let whole = Region::new(shapes.containers[index].clone())?;
        // What lies on the outline is inside, as far as anyone can see.
        let edge = if gap == 0.0 { -1.02 * shapes.tolerance } else { gap };
        Some(Outline { whole, free: shapes.free(index, gap, edge)?, tile: None })
    }

    /// The box around a container, which repeats to all sides. `None` if nothing is free.
    pub fn tile(shapes: &Shapes, index: usize, gap: f64) -> Option<Self> {
        let tile = shapes.frame(index);
        let (width, height) = (tile.width(), tile.height());
        let Rect { x0, y0, x1, y1 } = tile.inflate(2.0 * width, 2.0 * height);
        let around =
            vec![vec![Point::new(x0, y0), Point::new(x1, y0), Point::new(x1, y1), Point::new(x0, y1)]];
        let free = shapes.free_in(&around, gap, 0.0)?;
        (width > 0.0 && height > 0.0).then_some(Outline {
            whole: Region::new(around)?,
            free,
            tile: Some(tile),
        })
    }

    /// Where the middles of elements may be.
    pub fn middles(&self, edge: &str, example: &Analysis) -> Region {
        if edge != "over" || self.tile.is_some() {
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

/// An element that is to be drawn: by what it lies over others, and of which it is a copy.
struct Placed {
    order: f64,
    copy: usize,
    pose: Affine,
    tone: f64,
}

/// Sublayers of one run, filled shape by shape.
pub(super) struct Drawing {
    elements: Group,
    fixed: Group,
    connectivity: Edges,
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
            connectivity: Edges::default(),
            symbols: Vec::new(),
        }
    }

    pub fn count(&self) -> usize {
        self.elements.items.len()
    }

    /// The sublayers that hold something, and what their clones repeat.
    pub fn into_parts(self) -> (Vec<Group>, Vec<Symbol>) {
        let mut groups = vec![self.elements, self.fixed];
        groups.retain(|group| !group.items.is_empty());
        if !self.connectivity.pieces.is_empty() {
            let stream: Arc<dyn Stream> = Arc::new(self.connectivity);
            let name = "connectivity".to_owned();
            groups.push(Group { name, hidden: true, stream: Some(stream), ..Group::default() });
        }
        (groups, self.symbols)
    }

    /// Draws an arrangement.
    ///
    /// Errors: clones are to vary in tone.
    pub fn add(
        &mut self,
        arrangement: Arrangement,
        (example, reference, ground): (&Analysis, &Reference, &Ground),
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
        let mut symbols: BTreeMap<usize, usize> = BTreeMap::new();
        let mut placed: Vec<Placed> = Vec::with_capacity(arrangement.grown.len());
        let order = order(&arrangement, example, ground, params);
        for (number, &index) in arrangement.grown.iter().enumerate() {
            let object = &arrangement.objects[index as usize];
            let Some((copy, turn)) = object.copy else { continue };
            // Drawn from the same numbers whatever else is left out.
            let mut own = rng.fork();
            let varied = varied(turn, params, &mut own);
            let tone = params.vary_tone * own.between(-1.0, 1.0);
            let element = &example.elements[copy];
            let points = || element.extent.points.iter().map(|v| varied * v.to_point()).map(Point::to_vec2);
            let radius = points().map(|v| v.hypot()).fold(0.0, f64::max);
            let bounds = points().map(|v| Rect::from_points(v.to_point(), v.to_point()));
            let bounds = bounds.reduce(|all, one| all.union(one)).unwrap_or_default();
            let mut images = Vec::new();
            ground.each_image(object.at, bounds, |at| images.push(at));
            for at in images {
                let hull: Vec<Point> = points().map(|v| at + v).collect();
                if outline.is_some_and(|outline| !outline.shows(&params.edge, at, &hull, radius))
                    || params.edge == "inside" && ground.is_cut(&hull)
                {
                    continue;
                }
                let pose =
                    Affine::translate(at.to_vec2()) * varied * Affine::translate(-element.at.to_vec2());
                if has_clones {
                    symbols.entry(copy).or_insert_with(|| {
                        let Example { source, parts, .. } = &reference.examples[element.index];
                        let name = format!("{}{}", source.id, self.symbols.len() + 1);
                        self.symbols.push(Symbol::new(name, parts.clone()));
                        self.symbols.len() - 1
                    });
                }
                placed.push(Placed { order: order[number], copy, pose, tone });
            }
        }
        placed.sort_by(|a, b| a.order.total_cmp(&b.order));
        self.connectivity.add(&arrangement, ground, example.mean);
        // There may be many, and their items take as much room again.
        drop((arrangement, order));
        self.elements.items.reserve_exact(placed.len());
        for Placed { copy, pose, tone, .. } in placed {
            let Example { source, parts, .. } = &reference.examples[example.elements[copy].index];
            let of = source.id.clone();
            self.elements.items.push(match symbols.get(&copy) {
                Some(&symbol) => Item::cloned(of, symbol, pose),
                None => Item::new(of, parts.iter().map(|part| copied(part, pose, tone)).collect()),
            });
        }
        Ok(())
    }
}

/// How an element of the example is turned, with its own variations.
fn varied(turn: Vec2, params: &Params, rng: &mut Rng) -> Affine {
    let size = 1.0 + params.vary_size * rng.between(-1.0, 1.0);
    let angle = params.vary_turn.to_radians() * rng.between(-1.0, 1.0);
    let turned = |v: Vec2| Affine::new([v.x, v.y, -v.y, v.x, 0.0, 0.0]);
    turned(turn) * turned(size * Vec2::new(libm::cos(angle), libm::sin(angle)))
}

/// Numbers by which elements lie over others, the least at the bottom.
fn order(arrangement: &Arrangement, example: &Analysis, ground: &Ground, params: &Params) -> Vec<f64> {
    let along = |way: Vec2| -> Vec<f64> {
        let place = |&i: &u32| way.dot(arrangement.objects[i as usize].at.to_vec2());
        arrangement.grown.iter().map(place).collect()
    };
    match params.order.as_str() {
        "rows" => along(Vec2::new(1e-3, 1.0)),
        "growth" => (0..arrangement.grown.len()).map(|i| i as f64).collect(),
        // The direction in which the example was drawn, if it is the same everywhere.
        _ if params.mode == "fixed" && !ground.repeats => along(drawn_along(example)),
        _ => as_neighbours(arrangement),
    }
}

fn drawn_along(example: &Analysis) -> Vec2 {
    let n = example.elements.len() as f64;
    let middle = example.elements.iter().fold(Vec2::ZERO, |sum, one| sum + one.at.to_vec2()) / n;
    example
        .elements
        .iter()
        .enumerate()
        .fold(Vec2::ZERO, |sum, (i, one)| sum + (i as f64 - 0.5 * (n - 1.0)) * (one.at.to_vec2() - middle))
}

/// Each element over those neighbours that it lies over in the example, and under the others: heights
/// that differ by one from neighbour to neighbour, as nearly as all of them can. So the overlap follows
/// a flow around any bend.
fn as_neighbours(arrangement: &Arrangement) -> Vec<f64> {
    let terms = arrangement.grown.iter().flat_map(|&i| {
        let object = &arrangement.objects[i as usize];
        let drawn = |link: &&Link| arrangement.objects[link.to as usize].copy.is_some();
        let links = object.ring.iter().filter(drawn).filter_map(move |link| Some((link, object.copy?.0)));
        links.flat_map(move |(link, copy)| {
            let above = if link.element as usize > copy { 1.0 } else { -1.0 };
            [(i, link.to, Vec2::new(above, 0.0)), (link.to, i, Vec2::new(-above, 0.0))]
        })
    });
    let mut fixed: Vec<bool> = vec![false; arrangement.objects.len()];
    arrangement.starts.iter().for_each(|&start| fixed[start as usize] = true);
    let heights = relax::solved(terms, &fixed, (relax::STEPS, 1e-3));
    arrangement.grown.iter().map(|&i| heights[i as usize].x).collect()
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

/// The edges between elements, as lines: for each element those to younger ones. There may be several
/// hundred thousand, so they are made as they are written.
#[derive(Debug, Default)]
struct Edges {
    /// An element's place, then those of its neighbours.
    points: Vec<Point>,
    /// Where each element's points end, and its style.
    pieces: Vec<(u32, u32)>,
    styles: Vec<String>,
}

impl Edges {
    fn add(&mut self, arrangement: &Arrangement, ground: &Ground, mean: f64) {
        let mut style = Style::filled("none");
        style.set("stroke", "#ff0000");
        style.set("stroke-width", &format!("{:.4}", 0.02 * mean));
        self.styles.push(style.css());
        for &index in &arrangement.grown {
            let object = &arrangement.objects[index as usize];
            let first = self.points.len();
            self.points.push(object.at);
            for &other in &object.edges {
                let to = &arrangement.objects[other as usize];
                if to.copy.is_some() && other > index {
                    self.points.push(ground.near(to.at, object.at));
                }
            }
            match self.points.len() - first {
                1 => self.points.truncate(first),
                _ => self.pieces.push((self.points.len() as u32, self.styles.len() as u32 - 1)),
            }
        }
    }
}

impl Stream for Edges {
    fn each(&self, pieces: &mut dyn Pieces) {
        let mut start = 0;
        for &(end, style) in &self.pieces {
            let [from, others @ ..] = &self.points[start..end as usize] else { break };
            let mut path = BezPath::new();
            for &to in others {
                path.move_to(*from);
                path.line_to(to);
            }
            pieces.begin("edge", Affine::IDENTITY, &self.styles[style as usize]);
            pieces.add(&path, Affine::IDENTITY);
            start = end as usize;
        }
    }
}
