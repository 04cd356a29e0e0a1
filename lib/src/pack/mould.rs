//! Outlines give way, so that gaps become channels of one width (ours; evener gaps than bending gives are
//! what FLOWPAK leaves open in its section 6).
//!
//! Bending moves an element as a whole: where three of them meet, or where two part, gaps stay wider
//! than elsewhere, and too narrow for a filler with gaps of its own. Here the outline of every piece grows
//! into the space beside it, sample by sample, by no more than its share of what is there beyond the gap,
//! and as smoothly as its stage allows: a wide stage before gaps are filled, so that few fillers are
//! needed, then closer ones, which reach the corners. What is drawn in an element moves with its outline
//! (`geom::warp`).
//!
//! All pieces move at once, each within its share, so that neither their order nor the number of threads
//! matters. What comes of it is checked exactly, outline by outline, as in `place`; pieces that
//! come too near move less far, or stay as they were (`settle`).

use super::fill::Filler;
use super::params::Sizes;
use super::place::Placement;
use super::prepare::{Field, Prepared};
use super::settle;
use super::template::Template;
use crate::geom::boolean::{Contour, signed_area};
use crate::geom::near::PointTable;
use crate::geom::warp::{Ties, Warp};
use kurbo::{Point, Vec2};
use rayon::prelude::*;

/// One go at moulding. Lengths in spacings.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stage {
    /// How far a push is felt: what is moulded is no sharper.
    radius: f64,
    /// The farthest push.
    most: f64,
    iterations: usize,
}

/// Before gaps are filled, and after that, into the corners.
pub(super) struct Stages {
    pub wide: [Stage; 1],
    pub close: [Stage; 2],
}

/// Where the widest gaps are for fillers.
pub(super) const BETWEEN: Stages =
    Stages { wide: [stage(0.15, 0.14, 6)], close: [stage(0.065, 0.065, 4), stage(0.03, 0.025, 3)] };
/// Where there will be none: outlines have to go farther.
pub(super) const ALONE: Stages =
    Stages { wide: [stage(0.25, 0.25, 8)], close: [stage(0.12, 0.1, 5), stage(0.05, 0.05, 5)] };

const fn stage(radius: f64, most: f64, iterations: usize) -> Stage {
    Stage { radius, most, iterations }
}

/// Where gaps are to become shapes themselves, they stay as wide as they are.
fn is_moulded(field: &Field) -> bool {
    let params = &field.params;
    params.mould > 0.0 && params.iterations > 0 && !params.has_shapes()
}

/// How near the samples of other pieces lie, in spacings.
const OTHERS: f64 = 0.025;
/// The farthest push in one iteration, in spacings, and as a share of the farthest of all.
const STEP: (f64, f64) = (0.03, 0.5);
/// A sample that may move no farther than this, in spacings, will not: what is beside it only grows.
const CLOSED: f64 = 3e-3;

/// Moulds elements and pebbles. False if the time ran out first.
pub(super) fn mould(
    prepared: &Prepared,
    templates: &[Template],
    placement: &mut Placement,
    fillers: &mut [Filler],
    stages: &[Stage],
    mut go_on: impl FnMut(f64) -> bool,
) -> bool {
    if !prepared.fields.iter().any(is_moulded) {
        return true;
    }
    let pieces = Pieces::new(prepared, placement);
    // Between stages, outlines are moved corner by corner; only what comes of all is bent anew and checked.
    let fine = |field: usize, outlines: &[Contour]| {
        let step = CORNERS * prepared.fields[field].sizes.spacing;
        let contours: Vec<Contour> = outlines.iter().map(|contour| divided(contour, step)).collect();
        let held = contours.iter().map(|contour| vec![Held::default(); contour.len()]).collect();
        Moving { field, gives_way: true, contours, held, warps: Vec::new() }
    };
    let of_elements = placement.placed.par_iter().map(|placed| fine(placed.field, &placed.outlines));
    let of_fillers = fillers
        .par_iter()
        .map(|filler| Moving { gives_way: filler.motif.gives_way(), ..fine(filler.field, &filler.outlines) });
    let mut all: Vec<Moving> = of_elements.chain(of_fillers).collect();
    let cell = prepared.fields.iter().map(|field| field.sizes.safe_gap()).fold(0.0, f64::max);
    let mut others =
        Others { table: PointTable::new(prepared.bounds, cell, std::iter::empty()), gives_way: Vec::new() };
    let mut complete = true;
    for (k, &stage) in stages.iter().enumerate() {
        let skin = |moving: &Moving| Skin::new(moving, &prepared.fields[moving.field], stage);
        let mut skins: Vec<Skin> = all.par_iter().map(skin).collect();
        for iteration in 0..stage.iterations {
            let done = iteration as f64 / stage.iterations as f64;
            complete = complete && go_on((k as f64 + done) / stages.len() as f64);
            if complete {
                pieces.grow(&mut skins, &mut others, stage);
            }
        }
        all.par_iter_mut().zip(skins).for_each(|(moving, skin)| moving.go(skin));
    }
    settle::settle(prepared, templates, placement, fillers, &all);
    complete
}

/// Corners of an outline are this near to each other when it is moved, in spacings.
const CORNERS: f64 = 0.03;

/// What keeps a part of an outline where it is, in all that follows: what is beside it only grows.
#[derive(Clone, Copy, Debug, Default)]
struct Held {
    /// It has no room left, nor has what moves along with it.
    closed: bool,
    /// It has a notch of its own before it: it is not pushed, but may move along.
    still: bool,
}

impl Held {
    fn both(self, other: Held) -> Held {
        Held { closed: self.closed && other.closed, still: self.still && other.still }
    }
}

/// A piece on its way.
pub(super) struct Moving {
    pub field: usize,
    gives_way: bool,
    contours: Vec<Contour>,
    /// For each corner.
    held: Vec<Vec<Held>>,
    /// In the order of the stages.
    pub warps: Vec<Warp>,
}

impl Moving {
    /// Moves as a skin has grown.
    fn go(&mut self, skin: Skin) {
        self.held = self.contours.iter().map(|contour| vec![Held::default(); contour.len()]).collect();
        let mut start = 0;
        for (held, &n) in self.held.iter_mut().zip(&skin.counts) {
            for k in 0..n {
                let (one, next) = (start + k, start + (k + 1) % n);
                let end = if k + 1 == n { held.len() } else { skin.from[next] as usize };
                let both = skin.held[one].both(skin.held[next]);
                let len = held.len();
                (skin.from[one] as usize + 1..=end).for_each(|corner| held[corner % len] = both);
            }
            start += n;
        }
        if !skin.is_pushed() {
            return;
        }
        let warp = Warp::new(&skin.before, &skin.pushes, skin.radius, skin.step);
        self.contours.iter_mut().flatten().for_each(|p| *p = warp.point(*p));
        self.warps.push(warp);
    }
}

/// The samples of a piece's outlines.
struct Skin {
    field: usize,
    /// Before, and as they are pushed.
    before: Vec<Point>,
    now: Vec<Point>,
    /// The samples beside each in its contour, so that its inside lies on the left from one to the other.
    beside: Vec<[u32; 2]>,
    /// The samples that others look at.
    seen: Vec<u32>,
    pushes: Vec<Vec2>,
    held: Vec<Held>,
    /// How many samples each contour has, and the corner at or before each sample.
    counts: Vec<usize>,
    from: Vec<u32>,
    /// Whether any sample may be pushed, and those that may move then.
    gives_way: bool,
    moved: Vec<u32>,
    ties: Ties,
    radius: f64,
    step: f64,
}

impl Skin {
    fn new(moving: &Moving, field: &Field, stage: Stage) -> Self {
        /// Samples in a radius, and how far apart they are at most, in spacings.
        const SAMPLES: f64 = 3.0;
        const FARTHEST: f64 = 0.0425;
        let radius = stage.radius * field.sizes.spacing;
        let step = (radius / SAMPLES).min(FARTHEST * field.sizes.spacing);
        let others = OTHERS * field.sizes.spacing;
        let moves = moving.gives_way && is_moulded(field);
        let is_pushed = |held: Held| moves && !held.closed && !held.still;
        // What no push can reach is there for others alone.
        let steps: Vec<Vec<f64>> = moving
            .contours
            .iter()
            .zip(&moving.held)
            .map(|(contour, held)| {
                let near = near_sides(contour, |k| is_pushed(of_side(held, k)), 2.0 * radius);
                near.into_iter().map(|near| if near { step } else { step.max(others) }).collect()
            })
            .collect();
        let mut samples = Samples::with_room(&moving.contours, &steps);
        let (mut counts, mut held) = (Vec::new(), Vec::with_capacity(samples.points.capacity()));
        let mut beside = Vec::with_capacity(held.capacity());
        for ((contour, steps), corners_held) in moving.contours.iter().zip(&steps).zip(&moving.held) {
            let start = samples.points.len();
            samples.add(contour, steps, others);
            let n = samples.points.len() - start;
            counts.push(n);
            held.extend(samples.from[start..].iter().map(|&k| of_side(corners_held, k as usize)));
            let on = if signed_area(contour) < 0.0 { n - 1 } else { 1 };
            beside.extend((0..n).map(|i| [(i + n - on) % n, (i + on) % n].map(|i| (start + i) as u32)));
        }
        let Samples { points: before, seen, from } = samples;
        let is_pushed: Vec<bool> = held.iter().map(|&held| is_pushed(held)).collect();
        let ties = Ties::new(&before, &is_pushed, radius, step);
        let moved = ties.moved().map(|i| i as u32).collect::<Vec<_>>();
        let pushes = vec![Vec2::ZERO; before.len()];
        let now = before.clone();
        Skin {
            field: moving.field,
            before,
            now,
            beside,
            seen,
            pushes,
            held,
            counts,
            from,
            gives_way: moves && !moved.is_empty(),
            moved,
            ties,
            radius,
            step,
        }
    }

    fn is_pushed(&self) -> bool {
        self.pushes.iter().any(|push| push.hypot2() > 0.0)
    }

    /// Outward normal at a sample.
    fn normal(&self, i: usize) -> Vec2 {
        let [a, b] = self.beside[i];
        let along = self.now[b as usize] - self.now[a as usize];
        let normal = Vec2::new(along.y, -along.x);
        normal / normal.hypot().max(f64::MIN_POSITIVE)
    }

    /// One more iteration, where each sample may move by so much.
    fn grow(&mut self, allowed: &Allowances, most: f64, closed: f64) {
        for &i in &allowed.free {
            let i = i as usize;
            // No more than any sample near by may move, since those move along.
            let by = self.ties.least(&allowed.to_others, i).min(allowed.to_itself[i]).max(0.0);
            let push = self.pushes[i] + by * self.normal(i);
            self.pushes[i] = push * (most / push.hypot().max(most));
        }
        for &i in &allowed.asked {
            let i = i as usize;
            self.held[i].still |= allowed.to_itself[i] <= closed;
            self.held[i].closed = allowed.to_others[i] <= closed;
        }
        for &i in &self.moved {
            let i = i as usize;
            self.now[i] = self.before[i] + self.ties.push(&self.pushes, i);
        }
    }
}

/// What pieces see of each other.
struct Others {
    /// Samples with the numbers of their pieces.
    table: PointTable<u32>,
    gives_way: Vec<bool>,
}

impl Others {
    fn see(&mut self, skins: &[Skin]) {
        let all = skins.iter().zip(0..);
        self.table.fill(all.flat_map(|(skin, i)| skin.seen.iter().map(move |&k| (skin.now[k as usize], i))));
        self.gives_way.clear();
        self.gives_way.extend(skins.iter().map(|skin| skin.gives_way));
    }
}

/// How far the samples of a piece may move.
struct Allowances {
    /// Samples that may be pushed at all.
    free: Vec<u32>,
    /// Those whose room is known: they may be, or something near them.
    asked: Vec<u32>,
    /// For all samples, nothing where it is not known.
    to_others: Vec<f64>,
    /// Across a notch of its own. Its walls may move along with what is beside them.
    to_itself: Vec<f64>,
}

/// What pieces keep between them. Fillers are numbered after elements.
pub(super) struct Pieces<'a> {
    pub prepared: &'a Prepared,
    /// Half stroke widths, and the widest.
    pub strokes: &'a [f64],
    widest: f64,
    pub elements: usize,
}

impl<'a> Pieces<'a> {
    pub fn new(prepared: &'a Prepared, placement: &'a Placement) -> Self {
        let (strokes, widest) = (placement.strokes(), placement.widest_stroke());
        Pieces { prepared, strokes, widest, elements: placement.placed.len() }
    }

    /// The gap between the outlines of two pieces.
    pub fn gap(&self, sizes: &Sizes, one: usize, other: usize) -> f64 {
        let both_elements = one < self.elements && other < self.elements;
        let gap = if both_elements { sizes.gap } else { sizes.filler_gap };
        sizes.safe(gap) + self.strokes[one] + self.strokes[other]
    }

    /// The most that [`Pieces::gap`] can be for a piece.
    pub fn widest_gap(&self, sizes: &Sizes, one: usize) -> f64 {
        sizes.safe(sizes.gap.max(sizes.filler_gap)) + self.strokes[one] + self.widest
    }

    /// One iteration.
    fn grow(&self, skins: &mut [Skin], others: &mut Others, stage: Stage) {
        let fields = &self.prepared.fields;
        others.see(skins);
        let others = &*others;
        // Each looks only at the last state of others, so any number of threads gives the same.
        let grow = |(own, skin): (usize, &mut Skin)| {
            let field = &fields[skin.field];
            let spacing = field.sizes.spacing;
            let limit = STEP.0.min(STEP.1 * stage.most) * spacing;
            let allowed = self.allowances(own, skin, others, limit);
            skin.grow(&allowed, field.params.mould * stage.most * spacing, CLOSED * spacing);
        };
        skins.par_iter_mut().enumerate().filter(|(_, skin)| skin.gives_way).for_each(grow);
    }

    /// How far each sample of a piece may move, `limit` at most.
    fn allowances(&self, own: usize, skin: &Skin, others: &Others, limit: f64) -> Allowances {
        /// Cosine of the widest angle between a normal and what it faces.
        const FACING: f64 = 0.5;
        let field = &self.prepared.fields[skin.field];
        let sizes = &field.sizes;
        // Nearest samples are up to half a step beside the nearest points.
        let beside = (skin.step.max(OTHERS * sizes.spacing) / 2.0).powi(2);
        let reach = self.widest_gap(sizes, own) + 2.0 * limit + skin.step;
        let margin = self.strokes[own] + sizes.tolerance();
        // A sample with no room left holds those near it; who has none but such beside it need not ask.
        let (ties, held, n) = (&skin.ties, &skin.held, skin.now.len());
        let mut is_free = vec![false; n];
        for &i in &skin.moved {
            let Held { closed, still } = held[i as usize];
            is_free[i as usize] = !closed && !still && !ties.any(i as usize, |j| held[j].closed);
        }
        let is_asked = |&i: &u32| !held[i as usize].closed && ties.any(i as usize, |j| is_free[j]);
        let asked: Vec<u32> = skin.moved.iter().copied().filter(is_asked).collect();
        let free: Vec<u32> = asked.iter().copied().filter(|&i| is_free[i as usize]).collect();
        let places = asked.iter().map(|&i| skin.now[i as usize]);
        let near_edge = !field.region.holds_circle(places, limit + margin);
        let (mut all_to_others, mut all_to_itself) = (vec![0.0; n], vec![0.0; n]);
        for &i in &asked {
            let i = i as usize;
            let p = skin.now[i];
            let (mut to_others, mut to_itself) = (limit, limit);
            let normal = skin.normal(i);
            others.table.near(p, reach).for_each(|(q, other)| {
                let squared = q.distance_squared(p);
                if squared >= reach * reach {
                    return;
                }
                let apart = || (squared - beside).max(0.0).sqrt() - sizes.tolerance();
                if other as usize != own {
                    let share = if others.gives_way[other as usize] { 0.5 } else { 1.0 };
                    to_others = to_others.min(share * (apart() - self.gap(sizes, own, other as usize)));
                } else if (q - p).dot(normal) > FACING * squared.sqrt() {
                    to_itself = to_itself.min(0.5 * (apart() - sizes.gap));
                }
            });
            if near_edge {
                let inside = field.region.contains(p);
                let room = if inside { field.region.distance(p, limit + margin) - margin } else { 0.0 };
                to_others = to_others.min(room);
            }
            (all_to_others[i], all_to_itself[i]) = (to_others, to_itself);
        }
        Allowances { free, asked, to_others: all_to_others, to_itself: all_to_itself }
    }
}

/// A contour with more corners: none farther from the next than `step`.
fn divided(contour: &Contour, step: f64) -> Contour {
    let next = contour.iter().cycle().skip(1);
    let pieces = |(&p, &next): (&Point, &Point)| {
        let count = (p.distance(next) / step).ceil().clamp(1.0, 1e4);
        (0..count as usize).map(move |k| p.lerp(next, k as f64 / count))
    };
    contour.iter().zip(next).flat_map(pieces).collect()
}

/// The angle between two directions, exact enough for small ones; larger ones are large.
fn turn(a: Vec2, b: Vec2) -> f64 {
    let lengths = (a.hypot2() * b.hypot2()).sqrt().max(f64::MIN_POSITIVE);
    let sine = a.cross(b).abs() / lengths;
    if a.dot(b) > 0.0 { sine } else { std::f64::consts::PI - sine }
}

/// What holds the side of a contour from a corner to the next.
fn of_side(corners: &[Held], k: usize) -> Held {
    corners[k].both(corners[(k + 1) % corners.len()])
}

/// Which sides of a contour lie less than `reach` along it from one that counts, by the number of its first corner.
fn near_sides(contour: &Contour, counts: impl Fn(usize) -> bool, reach: f64) -> Vec<bool> {
    let n = contour.len();
    let mut near: Vec<bool> = (0..n).map(counts).collect();
    if !near.contains(&true) || !near.contains(&false) {
        return near;
    }
    let counts = near.clone();
    let mut walk = |sides: &mut dyn Iterator<Item = usize>| {
        let mut walked = f64::INFINITY;
        for k in sides {
            near[k] |= walked < reach;
            walked = if counts[k] { 0.0 } else { walked + contour[k].distance(contour[(k + 1) % n]) };
        }
    };
    // Twice around, for what begins before the first corner.
    walk(&mut (0..n).chain(0..n));
    walk(&mut (0..n).chain(0..n).rev());
    near
}

/// Points on closed contours.
struct Samples {
    points: Vec<Point>,
    /// The points that are enough for others.
    seen: Vec<u32>,
    /// The corner of its contour at or before each.
    from: Vec<u32>,
}

impl Samples {
    /// None yet, and room for what will be added.
    fn with_room(contours: &[Contour], steps: &[Vec<f64>]) -> Self {
        let sides = |contour: &Contour, steps: &[f64]| -> f64 {
            let sides = contour.windows(2).zip(steps);
            sides.map(|(side, step)| side[0].distance(side[1]) / step).sum()
        };
        let count: f64 = contours.iter().zip(steps).map(|(contour, steps)| sides(contour, steps)).sum();
        // Some more for sharp turns.
        let room = (1.2 * count).min(1e6) as usize + 16;
        Samples {
            points: Vec::with_capacity(room),
            seen: Vec::with_capacity(room),
            from: Vec::with_capacity(room),
        }
    }

    /// Adds points no farther apart than the steps of their sides, and wherever a contour has turned by a third of
    /// a right angle since the last. Others see one about every `seen`.
    fn add(&mut self, contour: &Contour, steps: &[f64], seen: f64) {
        const TURN: f64 = 0.5;
        let n = contour.len();
        let mut unseen = f64::INFINITY;
        let mut add = |p: Point, is_corner: bool, i: usize| {
            unseen += steps[i];
            if is_corner || unseen + steps[i] > seen {
                self.seen.push(self.points.len() as u32);
                unseen = 0.0;
            }
            self.points.push(p);
            self.from.push(i as u32);
        };
        let (mut walked, mut turned) = (f64::INFINITY, 0.0);
        for i in 0..n {
            let (last, p, next) = (contour[(i + n - 1) % n], contour[i], contour[(i + 1) % n]);
            let (a, b) = (p - last, next - p);
            turned += turn(a, b);
            if turned >= TURN || walked >= steps[i] {
                add(p, turned >= TURN, i);
                (walked, turned) = (0.0, 0.0);
            }
            let length = b.hypot();
            let pieces = (length / steps[i]).floor().min(1e4);
            for k in 1..pieces as usize {
                add(p.lerp(next, k as f64 / pieces), false, i);
            }
            walked = if pieces > 1.0 { length / pieces } else { walked + length };
        }
    }
}
