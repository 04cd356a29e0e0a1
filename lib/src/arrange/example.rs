//! The example: which of its elements are neighbours, and how each one's neighbours stand around
//! it (Ijiri et al. 2008, section 4; checklist E-002 to E-009).

use super::extent::Extent;
use super::ring::difference;
use crate::geom::triangulate::delaunay;
use kurbo::{Point, Rect, Shape, Vec2};
use rinceau_format::{Error, Reference};
use std::collections::{BTreeMap, BTreeSet};

/// Triangles with a wider angle are skewed (E-006).
const SKEWED: f64 = 2.0 * std::f64::consts::FRAC_PI_3;
/// Elements that are farther from each other than this share of their sizes are not too near.
const ROOM: f64 = 1.12;
/// The least distance of two symbols is meant if so many pairs would be nearer to each other by chance.
const BY_CHANCE: f64 = 4.0;
/// An element is missing where it is by this much emptier than anywhere in the example, and nothing is
/// nearer than this share of the least distance between two symbols.
const HOLLOW: f64 = 1.2;
const NEAREST: f64 = 0.9;
/// Elements of an example at most: each place is compared with all of them.
pub(super) const MOST_EXAMPLES: usize = 2000;
/// The rings of so many are compared with each other.
const MOST_COMPARED: usize = 200;

/// A neighbour in a ring.
#[derive(Clone, Copy, Debug)]
pub(super) struct Neighbour {
    /// From the element in the middle.
    pub offset: Vec2,
    /// Which element it is.
    pub element: usize,
    /// Index of its symbol.
    pub symbol: usize,
}

/// An element of the example.
#[derive(Clone, Debug)]
pub(super) struct Element {
    /// Its place in the reference.
    pub index: usize,
    pub at: Point,
    pub bounds: Rect,
    pub extent: Extent,
    pub symbol: usize,
    /// Its neighbours counter-clockwise; empty on the border, where some are missing.
    pub ring: Vec<Neighbour>,
}

/// The example, analysed.
#[derive(Clone, Debug)]
pub(super) struct Analysis {
    pub elements: Vec<Element>,
    /// Names of the symbols.
    pub symbols: Vec<String>,
    /// Mean and least length of edges.
    pub mean: f64,
    pub least: f64,
    /// Where nothing is nearer than this, an element is missing.
    pub hollow: f64,
    /// Least distance between two of each pair of symbols, no more than keeps them from touching, and
    /// the largest of these.
    apart: Vec<f64>,
    pub reach: f64,
    /// Least distance where it is not by chance, and the largest.
    spread: Vec<f64>,
    pub spread_reach: f64,
    /// How deep two of each pair of symbols lie in each other at most.
    depths: Vec<f64>,
    /// The least room between any two elements; 0 if some touch.
    pub room: f64,
    /// How much the rings of two elements differ.
    differences: Vec<f32>,
    /// Edges of the connectivity, each with the lesser index first.
    pub edges: Vec<(usize, usize)>,
}

/// The elements of an example and the triangles between them.
pub(super) struct Connectivity {
    pub elements: Vec<Element>,
    symbols: Vec<String>,
    triangles: Vec<[usize; 3]>,
}

impl Connectivity {
    /// Finds the neighbours (E-004 to E-006, E-009).
    ///
    /// Errors: too many elements.
    pub fn new(reference: &Reference, warnings: &mut Vec<String>) -> Result<Self, Error> {
        let source = &reference.source;
        if reference.examples.len() > MOST_EXAMPLES {
            return Err(source.error(
                "example-too-large",
                format!("The example '{}' has more than {MOST_EXAMPLES} elements", source.id),
                "A few dozen are enough: take the others out of its group",
            ));
        }
        let mut symbols: Vec<String> = Vec::new();
        let mut elements: Vec<Element> = Vec::new();
        let none = Extent::default();
        for (index, example) in reference.examples.iter().enumerate() {
            let boxes = example.parts.iter().map(|part| (part.transform * part.path.clone()).bounding_box());
            let Some(bounds) = boxes.reduce(|a, b| a.union(b)) else { continue };
            let at = bounds.center();
            if elements.iter().any(|other| other.at.distance(at) < 1e-6 * bounds.size().max_side().max(1e-9))
            {
                warnings.push(format!(
                    "{}: '{}' lies in the same place as another element of the example and is left out",
                    example.source.at, example.source.id
                ));
                continue;
            }
            let symbol = symbols.iter().position(|name| *name == example.symbol).unwrap_or_else(|| {
                symbols.push(example.symbol.clone());
                symbols.len() - 1
            });
            elements.push(Element { index, at, bounds, extent: none.clone(), symbol, ring: Vec::new() });
        }
        let points: Vec<Point> = elements.iter().map(|element| element.at).collect();
        let mut triangles = delaunay(&points);
        settle(&mut triangles, &points);
        triangles.retain(|&[a, b, c]| !is_skewed(points[a], points[b], points[c]));
        for (a, b) in &reference.flips {
            let index =
                |id: &String| elements.iter().position(|one| reference.examples[one.index].source.id == *id);
            let flipped = index(a).zip(index(b)).is_some_and(|edge| flip(&mut triangles, edge));
            if !flipped {
                warnings.push(format!(
                    "{}: '{a}' and '{b}' share no edge with triangles on both sides, so it cannot be flipped",
                    source.at
                ));
            }
        }
        Ok(Connectivity { elements, symbols, triangles })
    }

    /// Edges, each with the lesser index first, and how many triangles they have.
    pub fn edges(&self) -> BTreeMap<(usize, usize), usize> {
        let mut edges = BTreeMap::new();
        for side in self.triangles.iter().flat_map(|t| sides(*t)) {
            *edges.entry(sorted(side)).or_insert(0) += 1;
        }
        edges
    }
}

impl Analysis {
    /// Finds how the neighbours of each element stand around it.
    ///
    /// Errors: too many elements, or none that has neighbours all around.
    pub fn new(reference: &Reference, warnings: &mut Vec<String>) -> Result<Self, Error> {
        let source = &reference.source;
        let connectivity = Connectivity::new(reference, warnings)?;
        let edges: BTreeSet<(usize, usize)> = connectivity.edges().into_keys().collect();
        let Connectivity { mut elements, symbols, triangles } = connectivity;
        let points: Vec<Point> = elements.iter().map(|element| element.at).collect();
        for index in inner(&triangles, |index| elements[index].symbol) {
            let centre = points[index];
            let around = edges.iter().filter_map(|&(a, b)| match index {
                i if i == a => Some(b),
                i if i == b => Some(a),
                _ => None,
            });
            let mut ring: Vec<Neighbour> = around
                .map(|other| Neighbour {
                    offset: points[other] - centre,
                    element: other,
                    symbol: elements[other].symbol,
                })
                .collect();
            ring.sort_by(|a, b| angle(a.offset).total_cmp(&angle(b.offset)));
            elements[index].ring = ring;
        }
        if elements.iter().all(|element| element.ring.is_empty()) {
            return Err(source.error(
                "no-inner-element",
                format!("No element of the example '{}' has neighbours all around it", source.id),
                "Draw more of them: about three rows of three, so that at least one lies in the middle",
            ));
        }
        let lengths = edges.iter().map(|&(a, b)| points[a].distance(points[b]));
        let mean = lengths.clone().sum::<f64>() / edges.len() as f64;
        let least = lengths.fold(f64::INFINITY, f64::min);
        for element in &mut elements {
            element.extent = Extent::new(&reference.examples[element.index], element.at, mean);
        }
        let Spaces { apart, spread, depths, room } = spaces(&elements, symbols.len(), mean);
        let spread_reach = spread.iter().copied().fold(mean, f64::max);
        let reach = apart.iter().copied().fold(mean, f64::max);
        let widest = triangles.iter().map(|t| circumradius(t.map(|i| points[i]))).fold(0.0, f64::max);
        let nearest = apart.iter().copied().fold(f64::INFINITY, f64::min);
        let hollow = f64::max(HOLLOW * widest, NEAREST * nearest);
        let edges = edges.into_iter().collect();
        let differences = Vec::new();
        let mut analysis = Analysis {
            elements,
            symbols,
            mean,
            least,
            hollow,
            apart,
            reach,
            spread,
            spread_reach,
            depths,
            room,
            differences,
            edges,
        };
        analysis.compare();
        Ok(analysis)
    }

    /// The same with all its distances stretched, not its elements.
    pub fn stretched(&self, (x, y): (f64, f64)) -> Self {
        let mut stretched = self.clone();
        for neighbour in stretched.elements.iter_mut().flat_map(|element| &mut element.ring) {
            neighbour.offset = Vec2::new(x * neighbour.offset.x, y * neighbour.offset.y);
        }
        let both = (x * y).sqrt();
        stretched.mean *= both;
        stretched.least *= both.min(1.0);
        stretched.hollow *= both;
        let distances = stretched.apart.iter_mut().chain(&mut stretched.spread);
        distances.for_each(|distance| *distance *= both.min(1.0));
        stretched
    }

    /// Compares the rings of all elements with each other.
    fn compare(&mut self) {
        let n = self.elements.len();
        if n > MOST_COMPARED {
            return;
        }
        let mut differences = vec![0.0; n * n];
        for i in 0..n {
            for j in 0..i {
                let (a, b) = (&self.elements[i].ring, &self.elements[j].ring);
                let difference = difference(a, b, self.mean) as f32;
                differences[i * n + j] = difference;
                differences[j * n + i] = difference;
            }
        }
        self.differences = differences;
    }

    /// How much the rings of two elements differ, in mean edges and symbols; 0 where one is not known.
    pub fn difference(&self, a: usize, b: usize) -> f64 {
        f64::from(self.differences.get(a * self.elements.len() + b).copied().unwrap_or(0.0))
    }

    /// How deep two elements of these symbols lie in each other at most.
    pub fn deep(&self, a: usize, b: usize) -> f64 {
        self.depths[a * self.symbols.len() + b]
    }

    /// Least distance between two symbols in the example, no more than keeps them from touching.
    pub fn apart(&self, a: usize, b: usize) -> f64 {
        self.apart[a * self.symbols.len() + b]
    }

    /// Least distance between two symbols in the example, where it is not by chance.
    pub fn spread(&self, a: usize, b: usize) -> f64 {
        self.spread[a * self.symbols.len() + b]
    }

    /// Middles of elements farther from each other than this do not touch.
    pub fn widest(&self) -> f64 {
        2.0 * self.elements.iter().map(|element| element.extent.radius()).fold(0.0, f64::max)
    }

    /// Elements of the example with a whole ring.
    pub fn inner(&self) -> impl Iterator<Item = usize> {
        (0..self.elements.len()).filter(|&i| !self.elements[i].ring.is_empty())
    }
}

/// Distances of each pair of symbols.
struct Spaces {
    apart: Vec<f64>,
    spread: Vec<f64>,
    depths: Vec<f64>,
    /// The least room between any two elements; 0 if some touch.
    room: f64,
}

/// How near to each other two of one pair of symbols come.
#[derive(Clone, Copy)]
struct Nearest {
    pairs: f64,
    /// The least distance, and the same but no more than keeps them from touching.
    least: f64,
    apart: f64,
    /// Within this distance the largest of them touch.
    touching: f64,
    depth: f64,
}

/// Least distances between symbols, and how deep they lie in each other.
fn spaces(elements: &[Element], n: usize, mean: f64) -> Spaces {
    let none = Nearest { pairs: 0.0, least: f64::INFINITY, apart: f64::INFINITY, touching: 0.0, depth: 0.0 };
    let mut all = vec![none; n * n];
    let mut room = mean;
    let straight = Vec2::new(1.0, 0.0);
    for (i, a) in elements.iter().enumerate() {
        for b in &elements[..i] {
            let size = 0.5 * (a.bounds.size().max_side() + b.bounds.size().max_side());
            let distance = a.at.distance(b.at);
            let deep = a.extent.depth(straight, (&b.extent, straight), b.at - a.at, -mean);
            let deep = deep.map_or(-mean, |deep| deep.0);
            room = room.min(-deep);
            let both = [a.symbol * n + b.symbol, b.symbol * n + a.symbol];
            for &pair in &both[..if a.symbol == b.symbol { 1 } else { 2 }] {
                let Nearest { pairs, least, apart, touching, depth } = &mut all[pair];
                *pairs += 1.0;
                *least = least.min(distance);
                // Rare ones may be far from each other in the example without meaning it.
                *apart = apart.min(distance).min(ROOM * size);
                *touching = touching.max(size);
                *depth = depth.max(deep);
            }
        }
    }
    let middles = elements.iter().map(|element| Rect::from_points(element.at, element.at));
    let area = middles.reduce(|all, one| all.union(one)).map_or(0.0, |all| all.area());
    let apart = |of: &Nearest| if of.pairs > 0.0 { of.apart } else { 0.0 };
    let spread = |of: &Nearest| {
        let ring = std::f64::consts::PI * (of.least.powi(2) - of.touching.powi(2));
        let is_meant = of.pairs > 0.0 && of.pairs * ring > BY_CHANCE * area;
        apart(of).max(if is_meant { of.least } else { 0.0 })
    };
    Spaces {
        apart: all.iter().map(apart).collect(),
        spread: all.iter().map(spread).collect(),
        depths: all.iter().map(|of| of.depth).collect(),
        room: room.max(0.0),
    }
}

pub(super) fn angle(v: Vec2) -> f64 {
    libm::atan2(v.y, v.x)
}

fn sides([a, b, c]: [usize; 3]) -> [(usize, usize); 3] {
    [(a, b), (b, c), (c, a)]
}

fn sorted((a, b): (usize, usize)) -> (usize, usize) {
    (a.min(b), a.max(b))
}

/// The radius of the circle through three points: of a triangle of neighbours, how empty it is there.
fn circumradius([a, b, c]: [Point; 3]) -> f64 {
    let area = (b - a).cross(c - a).abs();
    0.5 * a.distance(b) * b.distance(c) * c.distance(a) / area.max(f64::MIN_POSITIVE)
}

fn is_skewed(a: Point, b: Point, c: Point) -> bool {
    let wide = |p: Point, q: Point, r: Point| {
        let (u, v) = (q - p, r - p);
        libm::atan2(u.cross(v).abs(), u.dot(v)) > SKEWED + 1e-9
    };
    wide(a, b, c) || wide(b, c, a) || wide(c, a, b)
}

/// Where four elements lie on a circle, as in bricks and grids, either diagonal would do, and rounding
/// chooses now this one and now that. The more level one is taken everywhere, of two alike the one
/// that falls to the right: what an artist would flip edges for (E-009).
fn settle(triangles: &mut [[usize; 3]], points: &[Point]) {
    /// Angles opposite the edge add up to half a turn on a circle; drawn by hand, nearly.
    const NEARLY: f64 = 0.06;
    const PASSES: usize = 4;
    let angle_at = |o: usize, a: usize, b: usize| {
        let (u, v) = (points[a] - points[o], points[b] - points[o]);
        libm::atan2(u.cross(v).abs(), u.dot(v))
    };
    // Steepness, and which way it falls.
    let rank = |a: usize, b: usize| {
        let way = points[b] - points[a];
        let steep = (way.y.abs() / way.hypot() * 20.0).round();
        (steep, way.x * way.y < 0.0)
    };
    for _ in 0..PASSES {
        let mut edges: BTreeMap<(usize, usize), Vec<usize>> = BTreeMap::new();
        for (i, triangle) in triangles.iter().enumerate() {
            sides(*triangle).into_iter().for_each(|side| edges.entry(sorted(side)).or_default().push(i));
        }
        let mut touched = vec![false; triangles.len()];
        let mut flipped = false;
        for (&(a, b), of) in edges.iter().filter(|(_, of)| of.len() == 2) {
            let apex = |i: usize| triangles[of[i]].into_iter().find(|&v| v != a && v != b);
            let (Some(c), Some(d)) = (apex(0), apex(1)) else { continue };
            let around = angle_at(c, a, b) + angle_at(d, a, b);
            let is_round = (around - std::f64::consts::PI).abs() < NEARLY;
            if of.iter().any(|&i| touched[i]) || !is_round || rank(c, d) >= rank(a, b) {
                continue;
            }
            (triangles[of[0]], triangles[of[1]]) = ([a, c, d], [b, c, d]);
            of.iter().for_each(|&i| touched[i] = true);
            flipped = true;
        }
        if !flipped {
            break;
        }
    }
}

/// Replaces the common edge of two triangles by the other diagonal. False if there are no two.
fn flip(triangles: &mut [[usize; 3]], edge: (usize, usize)) -> bool {
    let has = |t: &[usize; 3]| sides(*t).into_iter().any(|side| sorted(side) == sorted(edge));
    let found: Vec<usize> = (0..triangles.len()).filter(|&i| has(&triangles[i])).collect();
    let [i, j] = found[..] else { return false };
    let apex = |t: [usize; 3]| t.into_iter().find(|&v| v != edge.0 && v != edge.1);
    let (Some(c), Some(d)) = (apex(triangles[i]), apex(triangles[j])) else { return false };
    triangles[i] = [edge.0, c, d];
    triangles[j] = [edge.1, c, d];
    true
}

/// Elements whose triangles go all around them: every one of their edges has two (E-008).
///
/// In rows that are set off against each other the triangulation bridges the notches at their ends,
/// and an element behind such a bridge lacks a neighbour that nobody would miss. So those opposite
/// an edge of the border are left out too, unless a symbol would be lost with them.
fn inner(triangles: &[[usize; 3]], symbol: impl Fn(usize) -> usize) -> Vec<usize> {
    let mut count: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    for side in triangles.iter().flat_map(|t| sides(*t)) {
        *count.entry(sorted(side)).or_default() += 1;
    }
    let all: BTreeSet<usize> = triangles.iter().flatten().copied().collect();
    let border: BTreeSet<usize> =
        count.iter().filter(|(_, count)| **count < 2).flat_map(|(&(a, b), _)| [a, b]).collect();
    let inner: BTreeSet<usize> = all.difference(&border).copied().collect();
    let opposite = triangles.iter().flat_map(|&[a, b, c]| [((a, b), c), ((b, c), a), ((c, a), b)]);
    let behind: BTreeSet<usize> =
        opposite.filter(|(side, _)| count[&sorted(*side)] < 2).map(|(_, apex)| apex).collect();
    let deep: BTreeSet<usize> = inner.difference(&behind).copied().collect();
    let symbols = |set: &BTreeSet<usize>| set.iter().map(|&i| symbol(i)).collect::<BTreeSet<usize>>();
    if symbols(&deep) == symbols(&inner) { deep } else { inner }.into_iter().collect()
}
