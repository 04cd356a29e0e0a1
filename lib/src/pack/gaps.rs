//! The gaps of a composition: where they are widest, and how much room there is at a place.

use super::prepare::Field;
use crate::geom::boolean::{Contour, touches};
use crate::geom::distance::{Distances, Line, cover, covered, passed};
use crate::geom::near::PointGrid;
use crate::geom::polyline;
use crate::geom::region::Region;
use crate::geom::segment::{SegmentGrid, foot, point_segment};
use crate::shapes::closed;
use kurbo::{Point, Vec2};
use rayon::prelude::*;
use std::collections::BinaryHeap;

/// Cells of a container at most: a grid for more would be coarser.
const MOST_CELLS: f64 = 4e6;

/// A place with its clearance, ordered by that, then by place.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Place(u64, u64, u64);

impl Place {
    /// `clearance` is not negative.
    pub fn new(at: Point, clearance: f64) -> Self {
        // Non-negative floats order as their bits do.
        Place(clearance.to_bits(), at.y.to_bits(), at.x.to_bits())
    }

    pub fn at(&self) -> Point {
        Point::new(f64::from_bits(self.2), f64::from_bits(self.1))
    }

    pub fn clearance(&self) -> f64 {
        f64::from_bits(self.0)
    }
}

/// Outlines with half stroke widths by owner, and the widest of them.
#[derive(Clone, Copy)]
pub(super) struct Inked<'a> {
    pub outlines: &'a SegmentGrid,
    pub strokes: &'a [f64],
    pub widest: f64,
}

impl Inked<'_> {
    /// Half the stroke width of an owner. There need be none where nothing is stroked.
    fn stroke(&self, owner: u32) -> f64 {
        if self.widest > 0.0 { self.strokes[owner as usize] } else { 0.0 }
    }
}

/// A side of an outline, and its owner.
type Blocker = (Point, Point, u32);

/// What room there may be near a place.
#[derive(Clone, Copy)]
pub(super) struct Room {
    /// The clearance is no more than this.
    pub most: f64,
    /// What is nearest to the place, and to another beside it.
    blockers: [Option<Blocker>; 2],
}

/// What is covered in one container: elements by cells, dots by their circles. A distance to
/// an outline is the same from inside, so this has to be known beside it.
pub(super) struct Gaps<'a> {
    region: &'a Region,
    /// Side of a cell.
    pub step: f64,
    /// Clearances are known up to this.
    reach: f64,
    /// Distance kept from elements.
    gap: f64,
    origin: Point,
    columns: usize,
    elements: Vec<bool>,
    /// True for cells that are sure to lie in the region, farther from its edge than any
    /// distance asked for.
    inner: Vec<bool>,
    dots: PointGrid,
    radii: Vec<f64>,
    /// Clearance of each cell's middle, about.
    estimates: Vec<f32>,
    emptiness: (f64, f64),
}

impl<'a> Gaps<'a> {
    /// The gaps between elements of these silhouettes, for things with a radius of up to `largest` that
    /// keep `gap` from them. Places are looked for on a grid of this `step`, and then moved to the middle.
    pub fn new(
        field: &Field,
        region: &'a Region,
        silhouettes: &[&Contour],
        (largest, gap, step): (f64, f64, f64),
    ) -> Self {
        let bounds = region.bounds();
        let step = step.max((bounds.area() / MOST_CELLS).sqrt());
        // The cells around it are outside, so that its edge is known as one.
        let bounds = bounds.inflate(2.0 * step, 2.0 * step);
        let gap = field.sizes.safe(gap);
        let (columns, rows) = ((bounds.width() / step) as usize + 1, (bounds.height() / step) as usize + 1);
        let around = bounds.inflate(field.sizes.spacing, field.sizes.spacing);
        let near: Vec<&Contour> =
            silhouettes.iter().copied().filter(|contour| touches(contour, around)).collect();
        let mut gaps = Gaps {
            region,
            step,
            reach: largest + gap,
            gap,
            origin: bounds.origin(),
            columns,
            elements: covered(&near, bounds.origin(), step, columns, rows),
            inner: Vec::new(),
            dots: PointGrid::new(bounds, 2.0 * largest),
            radii: Vec::new(),
            estimates: Vec::new(),
            emptiness: (0.0, 0.0),
        };
        gaps.estimate(field.sizes.nook_edge);
        gaps
    }

    /// The room around every cell's middle, from distance transforms, what is far inside the region, and how
    /// empty it is, with a strip of `edge` around it.
    fn estimate(&mut self, edge: f64) {
        let (columns, step, gap, region) = (self.columns, self.step, self.gap, self.region);
        let rows = self.elements.len() / columns;
        let in_region = covered(region.contours(), self.origin, step, columns, rows);
        let outside: Vec<bool> = in_region.iter().map(|inside| !inside).collect();
        // A slit may be so narrow that no cell has its middle in it.
        let mut edge_or_outside = passed(region.contours(), self.origin, step, columns, rows);
        edge_or_outside.iter_mut().zip(&outside).for_each(|(passed, outside)| *passed |= outside);
        let to = [&self.elements, &outside, &edge_or_outside].map(|marked| Distances::new(marked, columns));
        // Half a cell lies between the middle of a covered cell and its edge.
        let distance = |squared: f64| (squared.sqrt() - 0.5) * step;
        let far = (self.reach / step + 2.0).powi(2);
        let fill = |lines: &mut [Line; 3], (row, (estimates, inner)): (usize, (&mut [f32], &mut [bool]))| {
            let [to_elements, to_outside, to_edge] = lines;
            let rows = [to[0].row(row, to_elements), to[1].row(row, to_outside), to[2].row(row, to_edge)];
            let (mut count, mut sum) = (0.0, 0.0);
            for x in 0..columns {
                let i = row * columns + x;
                let (to_elements, to_outside) = (distance(rows[0][x]), distance(rows[1][x]));
                if in_region[i] && !self.elements[i] {
                    count += 1.0;
                    sum += to_elements.min(to_outside + edge);
                }
                estimates[x] = (to_elements - gap).min(to_outside) as f32;
                inner[x] = rows[2][x] > far;
            }
            (count, sum)
        };
        let mut estimates = vec![0.0; self.elements.len()];
        let mut inner = vec![false; self.elements.len()];
        let rows = estimates.par_chunks_exact_mut(columns).zip(inner.par_chunks_exact_mut(columns));
        let sums: Vec<(f64, f64)> = rows.enumerate().map_init(Default::default, fill).collect();
        let (count, sum) = sums.iter().fold((0.0, 0.0), |all, one| (all.0 + one.0, all.1 + one.1));
        (self.estimates, self.inner) = (estimates, inner);
        let length = |contour: &Contour| polyline::length(&closed(contour));
        let strip = edge * region.contours().iter().map(length).sum::<f64>();
        self.emptiness = (step * step * count + strip, step * step * sum + strip * edge / 2.0);
    }

    /// Where they are.
    pub fn region(&self) -> &Region {
        self.region
    }

    /// Area of the gaps in the region and in the strip around it that nooks keep free, and the integral of the
    /// distances to what is beside them.
    pub fn emptiness(&self) -> (f64, f64) {
        self.emptiness
    }

    /// The middles of the gaps where there is room for more than `smallest`, with an estimate of their
    /// clearance that is never too small.
    pub fn middles(&self, smallest: f64) -> BinaryHeap<Place> {
        let mut heap = BinaryHeap::new();
        for (i, &free) in self.estimates.iter().enumerate() {
            // Half a diagonal lies between a sample and its cell's middle, at both ends.
            let most = f64::from(free) + std::f64::consts::SQRT_2 * self.step;
            if most <= smallest || self.elements[i] {
                continue;
            }
            let neighbours = [i.wrapping_sub(1), i + 1, i.wrapping_sub(self.columns), i + self.columns];
            if neighbours.into_iter().all(|j| self.estimates.get(j).is_none_or(|&other| other <= free)) {
                heap.push(Place::new(self.middle(i), most));
            }
        }
        heap
    }

    /// Every place with room for more than `smallest` is nearer than [`Gaps::fineness`] to one of these, whose
    /// clearances are no less than those of the places near them.
    pub fn places(&self, inked: Inked, smallest: f64) -> BinaryHeap<Place> {
        const WAYS: [(f64, f64); 4] = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)];
        let to_corner = self.step * std::f64::consts::FRAC_1_SQRT_2;
        let quarters = |i: usize| {
            let middle = self.middle(i);
            // An estimate may be as much too small as it is to a corner.
            let is_roomy = f64::from(self.estimates[i]) + 2.0 * to_corner > smallest;
            let near = if is_roomy { self.room_near(inked, (middle, to_corner), smallest) } else { None };
            let ways = if near.is_some() { &WAYS[..] } else { &[] };
            ways.iter().filter_map(move |&(x, y)| {
                let at = middle + self.step / 4.0 * Vec2::new(x, y);
                let blockers = near?.blockers;
                if self.blocked(inked, &blockers, at, smallest - self.fineness()) {
                    return None;
                }
                Some(Place::new(at, self.room_near(inked, (at, self.fineness()), smallest)?.most))
            })
        };
        let places: Vec<Place> = (0..self.estimates.len()).into_par_iter().flat_map_iter(quarters).collect();
        places.into()
    }

    /// Half a diagonal of a quarter of a cell.
    pub fn fineness(&self) -> f64 {
        self.step * std::f64::consts::FRAC_1_SQRT_2 / 2.0
    }

    /// The room in a disc; nothing if there is certainly no place in it with more than `least`.
    pub fn room_near(&self, inked: Inked, (at, radius): (Point, f64), least: f64) -> Option<Room> {
        let (free, blocker) = self.clearance_and_blocker(inked, at);
        let most = free + radius;
        if most <= least {
            return None;
        }
        // In a channel, what lies on the other side of it shows that there is none.
        let Some(one) = blocker.filter(|_| free <= least) else {
            return Some(Room { most, blockers: [blocker, None] });
        };
        let kept = |(p, q, owner): Blocker| (foot(at, p, q), least + self.gap + inked.stroke(owner));
        let (foot, _) = kept(one);
        let away = (at - foot) / at.distance(foot).max(f64::MIN_POSITIVE);
        let (_, other) = self.clearance_and_blocker(inked, at + radius * away);
        let is_kept = other.is_some_and(|other| is_covered((at, radius), [kept(one), kept(other)]));
        (!is_kept).then_some(Room { most, blockers: [blocker, other] })
    }

    /// True if these leave no more than this `clearance` at a place.
    fn blocked(&self, inked: Inked, blockers: &[Option<Blocker>], at: Point, clearance: f64) -> bool {
        let leaves =
            |&(p, q, owner): &Blocker| point_segment(at, p, q) - inked.stroke(owner) - self.gap <= clearance;
        blockers.iter().flatten().any(leaves)
    }

    /// Free radius at a place: to the outlines less the gap, to the boundary in full. Negative
    /// outside and in what is covered.
    pub fn clearance(&self, inked: Inked, at: Point) -> f64 {
        self.clearance_and_blocker(inked, at).0
    }

    /// The same, and the segment of an outline that is nearest, if any is near.
    fn clearance_and_blocker(&self, inked: Inked, at: Point) -> (f64, Option<Blocker>) {
        if self.covers(at) {
            return (-self.reach, None);
        }
        let (to_elements, blocker) =
            inked.outlines.nearest_stroke(at, self.reach, (inked.strokes, inked.widest));
        let free = to_elements - self.gap;
        if self.cell(at).is_some_and(|cell| self.inner[cell]) {
            return (free, blocker);
        }
        if !self.region.contains(at) {
            return (-self.reach, blocker);
        }
        (free.min(self.region.distance(at, self.reach)), blocker)
    }

    /// Climbs to the middle of a gap in so many rounds, and tells the clearance there; less far if there is
    /// certainly no middle near with more than `least`.
    pub fn centred(&self, inked: Inked, mut at: Point, (least, rounds): (f64, usize)) -> (Point, f64) {
        // Four ways alone would not see a ridge that runs between them.
        const WAYS: [[(f64, f64); 4]; 2] = [
            [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)],
            [(0.7, 0.7), (-0.7, -0.7), (0.7, -0.7), (-0.7, 0.7)],
        ];
        let mut step = self.step / 2.0;
        let (mut best, blocker) = self.clearance_and_blocker(inked, at);
        // What stood in the way before mostly does so again: no need to look for what is nearest.
        let mut blockers = [blocker, None, None, None];
        let mut oldest = 1;
        for _ in 0..rounds {
            let moved = WAYS.into_iter().any(|ways| {
                let before = best;
                for (x, y) in ways {
                    let next = at + step * Vec2::new(x, y);
                    if self.blocked(inked, &blockers, next, best) {
                        continue;
                    }
                    let (free, blocker) = self.clearance_and_blocker(inked, next);
                    if free > best {
                        (at, best) = (next, free);
                    }
                    if blocker.is_some() {
                        blockers[oldest] = blocker;
                        oldest = (oldest + 1) % blockers.len();
                    }
                }
                best > before
            });
            let moved = moved || {
                // Nor do these see one that runs between them and is sharp: it leads away from both its sides.
                let next = at + step * self.away(inked, &blockers, at, best + step);
                let (free, blocker) = self.clearance_and_blocker(inked, next);
                let better = free > best;
                if better {
                    (at, best) = (next, free);
                    blockers[oldest] = blocker.or(blockers[oldest]);
                    oldest = (oldest + 1) % blockers.len();
                }
                better
            };
            if !moved {
                // The middle is no farther away than that.
                if best + step < least {
                    break;
                }
                step /= 2.0;
            }
        }
        (at, best)
    }

    /// The way from what leaves no more than this `clearance`, of all that blocked the climb; zero if it lies all
    /// around.
    fn away(&self, inked: Inked, blockers: &[Option<Blocker>], at: Point, clearance: f64) -> Vec2 {
        let from = |&(p, q, owner): &Blocker| {
            let away = at - foot(at, p, q);
            let distance = away.hypot();
            (distance - inked.stroke(owner) - self.gap <= clearance && distance > 0.0)
                .then(|| away / distance)
        };
        let sum: Vec2 = blockers.iter().flatten().filter_map(from).fold(Vec2::ZERO, |sum, way| sum + way);
        if sum == Vec2::ZERO { sum } else { sum.normalize() }
    }

    /// True for what is covered. Nearer to an outline than a cell is wide the answer may be
    /// that of its other side, but nothing goes so near to one.
    fn covers(&self, at: Point) -> bool {
        let largest = self.reach - self.gap;
        self.cell(at).is_none_or(|cell| self.elements[cell])
            || self.dots.any_within(at, largest, |centre, dot| centre.distance(at) < self.radii[dot as usize])
    }

    /// Covers a disc.
    pub fn add_disc(&mut self, centre: Point, radius: f64) {
        self.dots.insert(centre, self.radii.len() as u32);
        self.radii.push(radius);
    }

    /// Covers what a contour encloses.
    pub fn add(&mut self, contour: &Contour) {
        cover(std::slice::from_ref(contour), self.origin, self.step, self.columns, &mut self.elements);
    }

    fn cell(&self, at: Point) -> Option<usize> {
        let (x, y) = ((at.x - self.origin.x) / self.step, (at.y - self.origin.y) / self.step);
        let rows = self.elements.len() / self.columns;
        let inside_grid = x >= 0.0 && y >= 0.0 && (x as usize) < self.columns && (y as usize) < rows;
        inside_grid.then(|| y as usize * self.columns + x as usize)
    }

    fn middle(&self, cell: usize) -> Point {
        self.origin
            + Vec2::new((cell % self.columns) as f64 + 0.5, (cell / self.columns) as f64 + 0.5) * self.step
    }
}

/// True if a disc lies wholly in two others.
fn is_covered((centre, radius): (Point, f64), others: [(Point, f64); 2]) -> bool {
    let is_in = |at: Point, (centre, radius): (Point, f64)| at.distance(centre) <= radius;
    let [one, other] = others;
    let to_one = one.0 - centre;
    let apart = to_one.hypot();
    if apart + radius <= one.1 {
        return true;
    }
    // What the first leaves of the disc is a lens between two arcs, the inner one bent outwards: it lies in
    // the other if the outer arc does, that is, if its ends do and its farthest place.
    let along = (one.1 * one.1 - apart * apart - radius * radius) / (2.0 * apart);
    if apart == 0.0 || along.abs() >= radius {
        return other.0.distance(centre) + radius <= other.1;
    }
    let x = to_one / apart;
    let beside = (radius * radius - along * along).sqrt();
    let ends = [beside, -beside].map(|beside| centre - along * x + beside * Vec2::new(-x.y, x.x));
    let farthest = centre + radius * (centre - other.0).normalize();
    ends.into_iter().all(|end| is_in(end, other)) && (is_in(farthest, one) || is_in(farthest, other))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_disc_is_covered_if_all_its_places_are(
            one in (-2.0..2.0f64, -2.0..2.0f64, 0.1..3.0f64),
            other in (-2.0..2.0f64, -2.0..2.0f64, 0.1..3.0f64),
        ) {
            let others = [one, other].map(|(x, y, radius)| (Point::new(x, y), radius));
            let is_in = |at: Point| others.iter().any(|(centre, radius)| at.distance(*centre) <= *radius);
            let ring = |radius: f64| (0..60).map(move |k| {
                let angle = f64::from(k) / 60.0 * 2.0 * std::f64::consts::PI;
                (radius * Vec2::new(libm::cos(angle), libm::sin(angle))).to_point()
            });
            let mut places = (0..=20).flat_map(|k| ring(f64::from(k) / 20.0));
            let seems_covered = places.all(is_in);
            let covers = is_covered((Point::ZERO, 1.0), others);
            prop_assert!(seems_covered || !covers);
            // Between the places there may be a little more, but not much.
            let larger = others.map(|(centre, radius)| (centre, radius + 0.1));
            prop_assert!(!seems_covered || is_covered((Point::ZERO, 1.0), larger));
        }
    }
}
