//! Evenly spaced streamlines (Jobard and Lefer 1997, with FLOWPAK's seeds and stops, 4.3,
//! checklist F-032 to F-038).
//!
//! Departures: a line is first traced as far as it goes and then cut into equal pieces, where
//! the papers stop it at its longest length; what would remain at its end, too short to use,
//! is shared out instead. Seeds wait in a queue by distance from the boundary and the guides,
//! with a random number drawn once for ties: the same order as sorting after each insertion.
//! What is too near to a line or to the boundary is told by a map of bits in most places, and
//! looked up exactly where that is not sure.

use crate::field::depth::Depth;
use crate::field::direction::DirectionField;
use crate::field::near::{Near, NearMap};
use crate::field::seeds::Seeds;
use crate::geom::near::PointGrid;
use crate::geom::polyline::{self, left_of};
use crate::geom::region::Region;
use crate::rng::Rng;
use kurbo::{Point, Vec2};

/// Distances of the tracing, in user units.
#[derive(Clone, Debug)]
pub struct StreamlineParams {
    /// Distance between lines (the papers' d_gap).
    pub spacing: f64,
    /// Shortest line that is kept (s_min).
    pub min_length: f64,
    /// Longest piece of a line (s_max).
    pub max_length: f64,
    /// Distance left between two pieces of one line.
    pub end_gap: f64,
}

/// Where a line comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineKind {
    /// Traced in the field.
    Free,
    /// Runs along the region's boundary, the region on its left.
    Boundary,
    /// Drawn by the artist; never cut.
    Fixed,
}

impl StreamlineParams {
    /// A line stops this near to another: d_stop = 0.8 d_gap (FLOWPAK 4.3).
    fn stop(&self) -> f64 {
        0.8 * self.spacing
    }

    /// Step of the integration: fine enough that the stop test sees every approach.
    fn step(&self) -> f64 {
        self.spacing / 6.0
    }

    /// A line that turns faster than this radius has met a singularity.
    fn tightest(&self) -> f64 {
        0.35 * self.spacing
    }
}

/// How much more room than half the spacing a line on the boundary gets, in spacings.
pub const BOUNDARY_BONUS: f64 = 0.2;

/// A free line this near to the boundary, in spacings, would carry a sliver; where it should run into a tip, it
/// is extended there later.
const BOUNDARY: f64 = 0.3;

/// A traced line, evenly sampled.
#[derive(Clone, Debug)]
pub struct Streamline {
    /// At steps of about a sixth of the spacing.
    pub points: Vec<Point>,
    /// Where it comes from.
    pub kind: LineKind,
}

/// The lines of one region while they are traced.
pub struct Tracer<'a> {
    region: &'a Region,
    field: &'a DirectionField,
    params: StreamlineParams,
    depth: Depth,
    /// Every second point of the lines: they are found all the same.
    taken: PointGrid,
    /// What is known without looking at them.
    near: NearMap,
    lines: Vec<Streamline>,
    seeds: Seeds,
    rng: Rng,
    steps_left: usize,
}

impl<'a> Tracer<'a> {
    /// A tracer with no lines yet. `most_steps` bounds the work.
    pub fn new(
        region: &'a Region,
        field: &'a DirectionField,
        params: StreamlineParams,
        rng: Rng,
        most_steps: usize,
    ) -> Self {
        let taken = PointGrid::new(region.bounds(), params.stop());
        let depth = Depth::new(region, params.spacing);
        let seeds = Seeds::new(params.spacing / 4.0);
        let near = depth.near_map(BOUNDARY * params.spacing, params.stop());
        Tracer {
            region,
            field,
            depth,
            near,
            params,
            taken,
            lines: Vec::new(),
            seeds,
            rng,
            steps_left: most_steps,
        }
    }

    /// Adds a place where a line may start; `distance` is that from boundary and guides.
    pub fn seed(&mut self, at: Point, distance: f64) {
        self.seeds.push(at, distance, self.rng.bits());
    }

    /// Adds a line that is already known, cut into pieces, as far as it keeps clear of the others. One that
    /// somebody drew goes in whole, however near it is to another: both then share the room between them.
    pub fn add(&mut self, points: &[Point], kind: LineKind) {
        if kind == LineKind::Fixed {
            return self.keep(points, kind);
        }
        let stop = self.params.stop();
        let clear: Vec<bool> = points.iter().map(|&p| !self.taken.any_within(p, stop, |_, _| true)).collect();
        for run in polyline::runs(&clear) {
            self.keep(&points[run], kind);
        }
    }

    /// Traces from every seed, and from both sides of every line, until none is left.
    /// `go_on` is asked now and then.
    pub fn run(&mut self, mut go_on: impl FnMut(f64) -> bool) -> bool {
        const ASK_EVERY: usize = 64;
        let mut count = 0;
        while let Some(at) = self.seeds.pop(|at| self.near.look(at) != Near::Yes) {
            count += 1;
            if count % ASK_EVERY == 0 && !go_on(count as f64 / (count + self.seeds.len()) as f64) {
                return false;
            }
            if self.steps_left == 0 {
                return false;
            }
            if let Some(points) = self.trace(at) {
                self.keep(&points, LineKind::Free);
            }
        }
        true
    }

    /// Allows lines of a share of the shortest length from now on.
    pub fn shorten(&mut self, share: f64) {
        self.params.min_length *= share;
    }

    /// The lines so far.
    pub fn into_lines(self) -> Vec<Streamline> {
        self.lines
    }

    /// True if a place is inside and no other line is near.
    fn free(&self, p: Point) -> bool {
        let inside = match self.near.look(p) {
            Near::No => return true,
            Near::Yes => return false,
            Near::MaybePoint => true,
            Near::Maybe => {
                let edge = BOUNDARY * self.params.spacing;
                self.depth
                    .surely_inside(p, edge)
                    .unwrap_or_else(|| self.region.contains(p) && self.region.distance(p, edge) >= edge)
            }
        };
        inside && !self.taken.any_within(p, self.params.stop(), |_, _| true)
    }

    /// Grows a line at both ends in turn (erratum Q-7) until both have stopped.
    fn trace(&mut self, seed: Point) -> Option<Vec<Point>> {
        if !self.free(seed) {
            return None;
        }
        let along = self.field.direction(seed, Vec2::new(1.0, 0.0))?;
        let stop = self.params.stop();
        let skip = (2.0 * stop / self.params.step()) as usize;
        // Points of the other end that are passed over are no farther from it than this.
        let far = stop + (skip + 1) as f64 * self.params.step();
        let mut ends = [vec![seed], vec![seed]];
        let mut directions = [Some(along), Some(-along)];
        // A line longer than this goes round and round.
        let most = (400.0 * self.params.spacing / self.params.step()) as usize;
        while directions.iter().any(Option::is_some)
            && ends[0].len() + ends[1].len() < most
            && self.steps_left > 0
        {
            for side in 0..2 {
                let Some(direction) = directions[side] else { continue };
                self.steps_left = self.steps_left.saturating_sub(1);
                let at = ends[side][ends[side].len() - 1];
                directions[side] = self
                    .step(at, direction)
                    .filter(|&(next, _)| {
                        let other = ends[1 - side][ends[1 - side].len() - 1];
                        let clear =
                            self.near.look(next) == Near::No && next.distance_squared(other) > far * far;
                        clear || self.free(next) && !self.meets_itself(next, &ends, side, skip)
                    })
                    .map(|(next, direction)| {
                        ends[side].push(next);
                        // What lies behind is in the way from now on; every second point is found all the same.
                        let behind = ends[side].len().checked_sub(skip).filter(|i| i % 2 == 0);
                        if let Some(&behind) = behind.and_then(|i| ends[side].get(i)) {
                            self.near.suspect(behind);
                        }
                        direction
                    });
            }
        }
        let [forward, mut line] = ends;
        line.reverse();
        line.extend_from_slice(&forward[1..]);
        (polyline::length(&line) >= self.params.min_length).then_some(line)
    }

    /// One step of the classical Runge-Kutta method. `None` at a singularity.
    fn step(&self, at: Point, direction: Vec2) -> Option<(Point, Vec2)> {
        let h = self.params.step();
        let k1 = self.field.velocity(at, direction)?;
        let k2 = self.field.velocity(at + h / 2.0 * k1, direction)?;
        let k3 = self.field.velocity(at + h / 2.0 * k2, direction)?;
        let k4 = self.field.velocity(at + h * k3, direction)?;
        let mean = (k1 + 2.0 * k2 + 2.0 * k3 + k4) / 6.0;
        let turn = direction.cross(mean).abs();
        if mean.dot(direction) <= 0.0 || turn > h / self.params.tightest() {
            return None;
        }
        Some((at + h * mean, mean / mean.hypot2().sqrt()))
    }

    /// True if a line comes back to itself: the samples at its own end are passed over.
    fn meets_itself(&self, next: Point, ends: &[Vec<Point>; 2], side: usize, skip: usize) -> bool {
        let stop = self.params.stop();
        let step = self.params.step();
        // A line is no shorter than the way across it: what is far takes as many points to come near.
        let any_near = |points: &[Point]| {
            let mut i = 0;
            while let Some(p) = points.get(i) {
                let squared = p.distance_squared(next);
                if squared < stop * stop {
                    return true;
                }
                i += (((squared.sqrt() - stop) / (step * (1.0 + 1e-9))) as usize).max(1);
            }
            false
        };
        let (own, other) = (&ends[side], &ends[1 - side]);
        any_near(&own[..own.len().saturating_sub(skip)])
            || any_near(&other[skip.saturating_sub(own.len()).min(other.len())..])
    }

    /// Cuts a line into pieces of about equal length, keeps them, and sows both its sides.
    fn keep(&mut self, points: &[Point], kind: LineKind) {
        let lengths = polyline::lengths(points);
        let length = lengths.last().copied().unwrap_or(0.0);
        if length < self.params.min_length && kind != LineKind::Fixed {
            return;
        }
        // Pieces between s_min and s_max, on average nearer to s_max.
        const MEAN: f64 = 0.78;
        let wanted = (MEAN * self.params.max_length).max(self.params.min_length);
        let most = (length / self.params.min_length).floor().max(1.0);
        let pieces =
            if kind == LineKind::Fixed { 1 } else { (length / wanted).round().clamp(1.0, most) as usize };
        // Cuts move by up to a sixth of a piece, so that those of neighbours do not line up.
        const JITTER: f64 = 1.0 / 6.0;
        let mut cuts = vec![0.0];
        for i in 1..pieces {
            cuts.push((i as f64 + self.rng.between(-JITTER, JITTER)) / pieces as f64 * length);
        }
        cuts.push(length);
        for pair in cuts.windows(2) {
            let half = self.params.end_gap / 2.0;
            let from = if pair[0] > 0.0 { pair[0] + half } else { 0.0 };
            let to = if pair[1] < length { pair[1] - half } else { length };
            // A gap as long as the piece leaves nothing of it.
            if to - from < self.params.step() {
                continue;
            }
            let steps = ((to - from) / self.params.step()).ceil().max(2.0) as usize;
            let points = polyline::resample_between(points, &lengths, from, to, steps);
            let owner = self.lines.len() as u32;
            for &p in points.iter().step_by(2).chain(points.last()) {
                self.taken.insert(p, owner);
                self.near.insert(p);
            }
            self.sow(&points, kind);
            self.lines.push(Streamline { points, kind });
        }
    }

    /// Seeds at one spacing on both sides of a line (F-036).
    fn sow(&mut self, points: &[Point], kind: LineKind) {
        // The half elements of the boundary are a little thicker than half a full one.
        let spacing =
            self.params.spacing * if kind == LineKind::Boundary { 1.0 + BOUNDARY_BONUS } else { 1.0 };
        // Places half a spacing apart are as good as any between.
        for i in (0..points.len()).step_by(3) {
            let along = points[(i + 1).min(points.len() - 1)] - points[i.saturating_sub(1)];
            if along == Vec2::ZERO {
                continue;
            }
            for side in [spacing, -spacing] {
                let at = points[i] + side * left_of(along.normalize());
                if self.free(at) {
                    self.seed(at, self.depth.distance(at));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_evenly_spaced_and_inside() {
        let region = Region::new(vec![
            [(0.0, 0.0), (300.0, 0.0), (300.0, 200.0), (0.0, 200.0)].map(Point::from).to_vec(),
        ])
        .unwrap();
        let guides = [vec![Point::new(10.0, 190.0), Point::new(150.0, 20.0), Point::new(290.0, 190.0)]];
        let field = DirectionField::new(&region, &guides, 4.0).unwrap();
        let params = StreamlineParams { spacing: 20.0, min_length: 30.0, max_length: 90.0, end_gap: 2.0 };
        let mut tracer = Tracer::new(&region, &field, params.clone(), Rng::new(1), 1_000_000);
        for i in 0..30 {
            tracer.seed(Point::new(10.0 * f64::from(i), 100.0), 0.0);
        }
        assert!(tracer.run(|_| true));
        let lines = tracer.into_lines();
        assert!(lines.len() > 20, "{}", lines.len());
        for (i, line) in lines.iter().enumerate() {
            assert!(line.points.iter().all(|&p| region.contains(p)));
            assert!(polyline::length(&line.points) <= 1.4 * params.max_length);
            for other in &lines[..i] {
                for p in &line.points[2..line.points.len() - 2] {
                    let nearest = other.points.iter().map(|q| q.distance(*p)).fold(f64::INFINITY, f64::min);
                    // Pieces of one line touch at their ends; others keep d_stop.
                    assert!(nearest >= 0.2 * params.spacing * 0.5, "{nearest}");
                }
            }
        }
    }
}
