//! The outline of a piece while it is moulded: its samples, how far they are pushed, and what holds them.

use crate::geom::boolean::{Contour, signed_area};
use crate::geom::warp::{Ties, Warp};
use kurbo::{Point, Vec2};

/// How near the samples of other pieces lie, in spacings.
pub(super) const OTHERS: f64 = 0.025;
/// Corners of an outline are this near to each other when it is moved, in spacings.
const CORNERS: f64 = 0.03;

/// What keeps a part of an outline where it is, in all that follows: what is beside it only grows.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Held {
    /// It has no room left, nor has what moves along with it.
    pub closed: bool,
    /// It has a notch of its own before it: it is not pushed, but may move along.
    pub still: bool,
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
    /// A piece with these outlines.
    pub fn new(field: usize, outlines: &[Contour], gives_way: bool, spacing: f64) -> Self {
        let step = CORNERS * spacing;
        let contours: Vec<Contour> = outlines.iter().map(|contour| divided(contour, step)).collect();
        let held = contours.iter().map(|contour| vec![Held::default(); contour.len()]).collect();
        Moving { field, gives_way, contours, held, warps: Vec::new() }
    }

    /// Moves as a skin has grown.
    pub fn go(&mut self, skin: Skin) {
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
pub(super) struct Skin {
    pub field: usize,
    /// Before, and as they are pushed.
    before: Vec<Point>,
    pub now: Vec<Point>,
    /// The samples beside each in its contour, so that its inside lies on the left from one to the other.
    beside: Vec<[u32; 2]>,
    /// The samples that others look at.
    pub seen: Vec<u32>,
    pushes: Vec<Vec2>,
    pub held: Vec<Held>,
    /// How many samples each contour has, and the corner at or before each sample.
    counts: Vec<usize>,
    from: Vec<u32>,
    /// Whether any sample may be pushed, and those that may move then.
    pub gives_way: bool,
    pub moved: Vec<u32>,
    pub ties: Ties,
    radius: f64,
    pub step: f64,
}

impl Skin {
    /// Samples for pushes that are felt up to a `radius`.
    pub fn new(moving: &Moving, spacing: f64, radius: f64) -> Self {
        /// Samples in a radius, and how far apart they are at most, in spacings.
        const SAMPLES: f64 = 3.0;
        const FARTHEST: f64 = 0.0425;
        let step = (radius / SAMPLES).min(FARTHEST * spacing);
        let others = OTHERS * spacing;
        let is_pushed = |held: Held| moving.gives_way && !held.closed && !held.still;
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
            gives_way: moving.gives_way && !moved.is_empty(),
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
    pub fn normal(&self, i: usize) -> Vec2 {
        let [a, b] = self.beside[i];
        let along = self.now[b as usize] - self.now[a as usize];
        let normal = Vec2::new(along.y, -along.x);
        normal / normal.hypot().max(f64::MIN_POSITIVE)
    }

    /// One more iteration, where each sample may move by so much.
    pub fn grow(&mut self, allowed: &Allowances, most: f64, closed: f64) {
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

/// How far the samples of a piece may move.
pub(super) struct Allowances {
    /// Samples that may be pushed at all.
    pub free: Vec<u32>,
    /// Those whose room is known: they may be, or something near them.
    pub asked: Vec<u32>,
    /// For all samples, nothing where it is not known.
    pub to_others: Vec<f64>,
    /// Across a notch of its own. Its walls may move along with what is beside them.
    pub to_itself: Vec<f64>,
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
