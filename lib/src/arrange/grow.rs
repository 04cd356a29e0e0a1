//! Growth from seeds (Ijiri et al. 2008, sections 5.1 and 5.4; checklist E-020 to E-036).
//!
//! Departures. Where every ring is smaller than what surrounds a seed, the paper ignores the
//! element; here the seed's own symbol is given up first, and then its farthest neighbours, so that
//! no hole stays. A seed of lower priority that has to wait comes again when the seed it waits for
//! has had its turn.

mod close;
mod mend;

use super::example::Analysis;
use super::ground::Ground;
use super::ring::{Around, Match, Turn, Weights, best, rotated, sort_around};
use crate::geom::near::PointGrid;
use crate::rng::Rng;
use kurbo::{Point, Rect, Vec2};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Nearer than this share of the shortest edge, two objects are one (E-032).
const SHORT: f64 = 0.5;
/// An angle less than this share of the example's is too narrow (E-033).
const NARROW: f64 = 0.5;
/// Seeds of higher priority count within so many mean edges (E-023).
const NEIGHBOURHOOD: f64 = 5.0;

/// An element or a seed.
#[derive(Clone, Debug)]
pub(super) struct Object {
    pub at: Point,
    pub symbol: Option<usize>,
    /// Which element of the example it is a copy of, and how it is turned; seeds are of none.
    pub copy: Option<(usize, Vec2)>,
    pub edges: Vec<u32>,
    /// Where its neighbours should stand around it.
    pub ring: Vec<Link>,
    /// A seed that came to nothing.
    pub is_gone: bool,
    /// A seed that will have its turn.
    grows: bool,
    /// How often it has let others go first.
    waited: u32,
}

impl Object {
    /// True if its ring is all of its neighbours, and nothing else.
    pub fn is_whole(&self) -> bool {
        self.ring.len() == self.edges.len() && self.ring.iter().all(|link| self.edges.contains(&link.to))
    }
}

/// Where a neighbour should stand.
#[derive(Clone, Copy, Debug)]
pub(super) struct Link {
    pub to: u32,
    pub offset: Vec2,
    /// The element that the example has there.
    pub element: u32,
}

/// What the growth goes by.
pub(super) struct Rules {
    pub weights: Weights,
    pub mode: Mode,
    /// Rank of each symbol, 0 first.
    pub ranks: Vec<usize>,
    /// Elements at most.
    pub most: usize,
}

/// How the example is turned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mode {
    Fixed,
    Rotate,
    Flow,
}

/// A distance that can be sorted.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Distance(f64);

impl Eq for Distance {}

impl PartialOrd for Distance {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Distance {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}

fn empty_grid(ground: &Ground, example: &Analysis) -> PointGrid {
    let margin = if ground.repeats { NEIGHBOURHOOD * example.mean } else { 0.0 };
    PointGrid::new(ground.bounds.inflate(margin, margin), example.mean)
}

/// A growing arrangement.
pub(super) struct Arrangement<'a> {
    example: &'a Analysis,
    ground: &'a Ground,
    rules: &'a Rules,
    pub objects: Vec<Object>,
    /// First elements: they stay where they are.
    pub starts: Vec<u32>,
    /// Objects that are elements, in the order in which they grew.
    pub grown: Vec<u32>,
    /// How often each element of the example was copied, and what chance adds to that.
    uses: Vec<f64>,
    grid: PointGrid,
    heap: BinaryHeap<Reverse<(Distance, u32)>>,
}

impl<'a> Arrangement<'a> {
    pub fn new(example: &'a Analysis, ground: &'a Ground, rules: &'a Rules, rng: &mut Rng) -> Self {
        let uses = example.elements.iter().map(|_| rng.unit()).collect();
        let grid = empty_grid(ground, example);
        Arrangement {
            example,
            ground,
            rules,
            objects: Vec::new(),
            starts: Vec::new(),
            grown: Vec::new(),
            uses,
            grid,
            heap: BinaryHeap::new(),
        }
    }

    /// Adds a seed that growth starts from.
    pub fn start(&mut self, at: Point) {
        let seed = self.add(at, None);
        self.starts.push(seed);
        self.objects[seed as usize].grows = true;
        self.heap.push(Reverse((Distance(0.0), seed)));
    }

    /// Takes elements out again, sorted ones.
    pub fn take_out(&mut self, gone: &[u32]) {
        for &i in gone {
            self.objects[i as usize].is_gone = true;
            self.detach(i);
        }
        self.grown.retain(|i| gone.binary_search(i).is_err());
    }

    /// The middle of the room around a place: as far from everything as steps from there lead.
    pub fn midst(&self, from: Point, reach: f64) -> Point {
        const STEPS: usize = 12;
        let mut at = from;
        for _ in 0..STEPS {
            let wide = 1.5 * reach;
            let Some(near) = self.nearest(u32::MAX, at, wide) else { break };
            let p = self.at(near, at);
            let next =
                at + (0.3 * (wide - p.distance(at)) / p.distance(at).max(f64::MIN_POSITIVE)) * (at - p);
            if !self.ground.allows(next) || self.ground.divides(at, next) {
                break;
            }
            at = next;
        }
        // Steps may lead back.
        if self.is_empty_at(at, reach) { at } else { from }
    }

    /// A seed where there is room left, joined to what stands around it.
    pub fn start_amid(&mut self, at: Point) {
        /// Elements nearer than so many mean edges are around.
        const AROUND: f64 = 2.0;
        let reach = AROUND * self.example.mean;
        let mut around: Vec<(Distance, u32, Point)> = Vec::new();
        self.grid.visit(at, reach, |p, other| {
            let distance = p.distance(at);
            if distance < reach && !self.objects[other as usize].is_gone {
                around.push((Distance(distance), other, p));
            }
            true
        });
        if around.is_empty() {
            return self.start(at);
        }
        around.sort_unstable_by_key(|&(distance, other, _)| (distance, other));
        let new = self.sow(at, None);
        for (_, other, p) in around {
            let is_free = !self.ground.divides(at, p) && !self.collides((new, other), at, p);
            if is_free {
                self.connect(new, other);
            }
        }
    }

    /// True if nothing is near a place.
    pub fn is_empty_at(&self, at: Point, reach: f64) -> bool {
        !self.grid.any_within(at, reach, |_, other| !self.objects[other as usize].is_gone)
    }

    /// Where an object is, or its image is, near a place.
    fn at(&self, object: u32, near: Point) -> Point {
        self.ground.near(self.objects[object as usize].at, near)
    }

    fn enter(&mut self, at: Point, object: u32) {
        let reach = NEIGHBOURHOOD * self.example.mean;
        self.ground.each_image(at, Rect::ZERO.inflate(reach, reach), |image| self.grid.insert(image, object));
    }

    fn add(&mut self, at: Point, symbol: Option<usize>) -> u32 {
        let at = self.ground.within(at);
        let index = self.objects.len() as u32;
        self.objects.push(Object {
            at,
            symbol,
            copy: None,
            edges: Vec::new(),
            ring: Vec::new(),
            is_gone: false,
            grows: false,
            waited: 0,
        });
        self.enter(at, index);
        index
    }

    /// The grid anew, after objects moved.
    pub fn moved(&mut self) {
        self.grid.clear();
        for i in 0..self.objects.len() {
            if !self.objects[i].is_gone {
                self.objects[i].at = self.ground.within(self.objects[i].at);
                self.enter(self.objects[i].at, i as u32);
            }
        }
    }

    /// Lets up to `steps` seeds grow, the nearest to the start first (E-021). False if there are no
    /// more.
    pub fn grow(&mut self, steps: usize) -> bool {
        for _ in 0..steps {
            if self.grown.len() >= self.rules.most {
                return false;
            }
            let Some(Reverse((Distance(distance), seed))) = self.heap.pop() else { return false };
            let object = &self.objects[seed as usize];
            if object.is_gone || object.copy.is_some() {
                continue;
            }
            // Whoever waited this often waits for somebody who will not come.
            const PATIENCE: u32 = 100;
            let waits = object.waited < PATIENCE;
            if let Some(later) = self.more_important(seed).filter(|_| waits) {
                self.objects[seed as usize].waited += 1;
                // Behind the one that it waits for.
                let behind = distance.max(later) * (1.0 + 1e-9) + 1e-9;
                self.heap.push(Reverse((Distance(behind), seed)));
                continue;
            }
            self.grow_at(seed);
        }
        true
    }

    fn distance(&self, at: Point) -> f64 {
        let starts = self.starts.iter().map(|&start| self.at(start, at).distance(at));
        starts.fold(f64::INFINITY, f64::min)
    }

    fn rank(&self, symbol: Option<usize>) -> usize {
        symbol.map_or(usize::MAX, |symbol| self.rules.ranks[symbol])
    }

    /// How far from the start the farthest seed of higher priority nearby is (E-023).
    fn more_important(&self, seed: u32) -> Option<f64> {
        let object = &self.objects[seed as usize];
        let own = self.rank(object.symbol);
        if own == 0 || self.rules.ranks.iter().all(|&rank| rank == 0) {
            return None;
        }
        let reach = NEIGHBOURHOOD * self.example.mean;
        let mut farthest: Option<f64> = None;
        self.grid.visit(object.at, reach, |at, other| {
            let it = &self.objects[other as usize];
            if !it.is_gone
                && it.copy.is_none()
                && it.grows
                && self.rank(it.symbol) < own
                && at.distance(object.at) < reach
            {
                let distance = self.distance(at);
                farthest = Some(farthest.map_or(distance, |most| most.max(distance)));
            }
            true
        });
        farthest
    }

    /// Replaces a seed by the element that fits best, and puts seeds around it.
    fn grow_at(&mut self, seed: u32) {
        let Some((around, found)) = self.fitting(seed) else {
            self.objects[seed as usize].is_gone = true;
            self.detach(seed);
            return;
        };
        let element = &self.example.elements[found.element];
        {
            let object = &mut self.objects[seed as usize];
            object.copy = Some((found.element, found.turn));
            object.symbol = Some(element.symbol);
        }
        self.grown.push(seed);
        self.uses[found.element] += 1.0;
        let m = element.ring.len();
        let offset = |i: usize| rotated(element.ring[(found.shift + i) % m].offset, found.turn);
        // The ring counter-clockwise: neighbours there are, then new ones.
        let mut members: Vec<Option<u32>> = around.iter().map(|&other| Some(other)).collect();
        let origin = self.objects[seed as usize].at;
        members.resize(m, None);
        for i in around.len()..m {
            let symbol = element.ring[(found.shift + i) % m].symbol;
            members[i] = self.place(seed, offset(i), (&members, i, &offset), symbol);
        }
        // There are many rings: none has room for more.
        self.objects[seed as usize].ring.reserve_exact(members.iter().flatten().count());
        for (i, member) in members.iter().enumerate() {
            if let Some(other) = *member {
                self.connect(seed, other);
                let of = element.ring[(found.shift + i) % m].element as u32;
                let link = Link { to: other, offset: offset(i), element: of };
                self.objects[seed as usize].ring.push(link);
            }
        }
        for i in 0..m {
            let j = (i + 1) % m;
            if let (Some(a), Some(b)) = (members[i], members[j])
                && (i >= around.len() || j >= around.len())
                && a != b
            {
                self.close((seed, origin), (a, b), (offset(j) - offset(i)).hypot());
            }
        }
    }

    /// Neighbours of a seed counter-clockwise, and the element of the example that suits them best.
    fn fitting(&self, seed: u32) -> Option<(Vec<u32>, Match)> {
        let object = &self.objects[seed as usize];
        let mut neighbours: Vec<(u32, Around)> = Vec::with_capacity(8);
        for &other in &object.edges {
            let it = &self.objects[other as usize];
            let around = Around {
                offset: self.at(other, object.at) - object.at,
                symbol: it.symbol,
                copy_of: it.copy.map(|copy| copy.0),
            };
            neighbours.push((other, around));
        }
        let turn = match self.rules.mode {
            Mode::Rotate if neighbours.is_empty() => Turn::By(Vec2::new(1.0, 0.0)),
            Mode::Rotate => Turn::Free,
            Mode::Fixed => Turn::By(Vec2::new(1.0, 0.0)),
            Mode::Flow => {
                let turns = object.edges.iter().filter_map(|&other| self.objects[other as usize].copy);
                let mean = turns.fold(Vec2::ZERO, |sum, (_, turn)| sum + turn);
                let towards = (mean.hypot() > 1e-9).then_some(mean);
                let flow = self.ground.direction(object.at, towards);
                // Where the flow has no direction, as the neighbours are.
                Turn::By(flow.or(towards.map(|way| way / way.hypot())).unwrap_or(Vec2::new(1.0, 0.0)))
            }
        };
        let rules = (turn, self.rules.weights);
        let mut symbol = object.symbol;
        loop {
            let are_linked =
                |a: &(u32, Around), b: &(u32, Around)| self.objects[a.0 as usize].edges.contains(&b.0);
            sort_around(&mut neighbours, |(_, around)| around.offset, are_linked);
            let around: Vec<Around> = neighbours.iter().map(|(_, around)| *around).collect();
            if let Some(found) = best(self.example, &around, symbol, (rules, &self.uses)) {
                return Some((neighbours.into_iter().map(|(other, _)| other).collect(), found));
            }
            if symbol.take().is_some() {
                continue;
            }
            let far = |i: &usize| Distance(neighbours[*i].1.offset.hypot());
            let farthest = (0..neighbours.len()).max_by_key(far)?;
            neighbours.remove(farthest);
        }
    }

    /// A new neighbour in its place: a seed, or what is there already; `None` where nothing may be.
    fn place(
        &mut self,
        seed: u32,
        offset: Vec2,
        (members, i, offset_of): (&[Option<u32>], usize, &dyn Fn(usize) -> Vec2),
        symbol: usize,
    ) -> Option<u32> {
        let from = self.objects[seed as usize].at;
        let at = from + offset;
        if let Some(near) = self.nearest(seed, at, SHORT * self.example.least) {
            let to = self.at(near, at);
            let is_linked = self.objects[seed as usize].edges.contains(&near);
            return (!members.contains(&Some(near)) && (is_linked || !self.collides((seed, near), from, to)))
                .then_some(near);
        }
        if self.ground.divides(from, at) {
            return None;
        }
        if self.is_crowded(seed, at, symbol) {
            return None;
        }
        let m = members.len();
        for (j, is_before) in [((i + m - 1) % m, true), ((i + 1) % m, false)] {
            let Some(other) = members[j] else { continue };
            let beside = self.at(other, from) - from;
            let between = |a: Vec2, b: Vec2| libm::atan2(a.cross(b), a.dot(b));
            let (actual, original) = match is_before {
                true => (between(beside, offset), between(offset_of(j), offset)),
                false => (between(offset, beside), between(offset, offset_of(j))),
            };
            let original = if original < 0.0 { original + std::f64::consts::TAU } else { original };
            if m > 1 && actual < NARROW * original.min(std::f64::consts::PI) {
                return None;
            }
        }
        if self.collides((seed, seed), from, at) {
            return None;
        }
        Some(self.sow(at, Some(symbol)))
    }

    /// A seed. Outside the ground it never grows, but it stands for a neighbour: without it rings at
    /// the outline would have holes, and neighbours would be taken for each other.
    fn sow(&mut self, at: Point, symbol: Option<usize>) -> u32 {
        let new = self.add(at, symbol);
        if self.ground.allows(at) {
            self.objects[new as usize].grows = true;
            let distance = self.distance(at);
            self.heap.push(Reverse((Distance(distance), new)));
        }
        new
    }

    /// True if something is nearer to a new seed than the example's elements of these symbols are to
    /// each other.
    fn is_crowded(&self, seed: u32, at: Point, symbol: usize) -> bool {
        const CROWDED: f64 = 0.8;
        let mut found = false;
        self.grid.visit(at, self.example.reach, |p, other| {
            let it = &self.objects[other as usize];
            let apart = it.symbol.map_or(self.example.least, |own| self.example.apart(symbol, own));
            found = other != seed && !it.is_gone && p.distance(at) < CROWDED * apart;
            !found
        });
        found
    }

    fn connect(&mut self, a: u32, b: u32) {
        if a != b && !self.objects[a as usize].edges.contains(&b) {
            self.objects[a as usize].edges.push(b);
            self.objects[b as usize].edges.push(a);
        }
    }

    fn detach(&mut self, object: u32) {
        for other in std::mem::take(&mut self.objects[object as usize].edges) {
            self.objects[other as usize].edges.retain(|&edge| edge != object);
        }
    }
}
