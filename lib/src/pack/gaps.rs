//! The gaps of a composition: where they are widest, and how much room there is at a place.

use super::prepare::Field;
use crate::geom::boolean::{Contour, touches};
use crate::geom::distance::{cover, covered, passed, squared_distances};
use crate::geom::near::{PointGrid, SegmentGrid, foot, point_segment};
use crate::geom::polyline;
use crate::geom::region::Region;
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
    estimates: Vec<f64>,
    emptiness: (f64, f64),
}

impl<'a> Gaps<'a> {
    /// The gaps between elements of these silhouettes, for things with a radius of up to `largest` that
    /// keep `gap` from them. Places are looked for on a grid of this `step`, and then moved to the middle.
    pub fn new(
        field: &Field,
        region: &'a Region,
        silhouettes: &[Contour],
        (largest, gap, step): (f64, f64, f64),
    ) -> Self {
        let bounds = region.bounds();
        let step = step.max((bounds.area() / MOST_CELLS).sqrt());
        // The cells around it are outside, so that its edge is known as one.
        let bounds = bounds.inflate(2.0 * step, 2.0 * step);
        let gap = field.sizes.safe(gap);
        let (columns, rows) = ((bounds.width() / step) as usize + 1, (bounds.height() / step) as usize + 1);
        let around = bounds.inflate(field.sizes.spacing, field.sizes.spacing);
        let near: Vec<Contour> =
            silhouettes.iter().filter(|contour| touches(contour, around)).cloned().collect();
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
        let (to_elements, to_outside) = rayon::join(
            || squared_distances(&self.elements, columns),
            || squared_distances(&outside, columns),
        );
        // Half a cell lies between the middle of a covered cell and its edge.
        let distance = |squared: f64| (squared.sqrt() - 0.5) * step;
        let (mut count, mut sum) = (0.0, 0.0);
        self.estimates = (0..self.elements.len())
            .map(|i| {
                let (to_elements, to_outside) = (distance(to_elements[i]), distance(to_outside[i]));
                if in_region[i] && !self.elements[i] {
                    count += 1.0;
                    sum += to_elements.min(to_outside + edge);
                }
                (to_elements - gap).min(to_outside)
            })
            .collect();
        // A slit may be so narrow that no cell has its middle in it.
        let mut edge_or_outside = passed(region.contours(), self.origin, step, columns, rows);
        edge_or_outside.iter_mut().zip(outside).for_each(|(passed, outside)| *passed |= outside);
        let far = (self.reach / step + 2.0).powi(2);
        self.inner =
            squared_distances(&edge_or_outside, columns).into_iter().map(|squared| squared > far).collect();
        let length = |contour: &Contour| polyline::length(&closed(contour));
        let strip = edge * region.contours().iter().map(length).sum::<f64>();
        self.emptiness = (step * step * count + strip, step * step * sum + strip * edge / 2.0);
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
            let most = free + std::f64::consts::SQRT_2 * self.step;
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
        // A cell has room only if its middle has, but for the way from there to its corners.
        let to_corner = self.step * std::f64::consts::FRAC_1_SQRT_2;
        let free = |at: Point| self.clearance(inked, at);
        let quarters = |i: usize| {
            let middle = self.middle(i);
            let is_roomy =
                self.estimates[i] + 2.0 * to_corner > smallest && free(middle) + to_corner > smallest;
            let ways = if is_roomy { &[(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)][..] } else { &[] };
            ways.iter().filter_map(move |&(x, y)| {
                let at = middle + self.step / 4.0 * Vec2::new(x, y);
                let most = free(at) + self.fineness();
                (most > smallest).then(|| Place::new(at, most))
            })
        };
        let places: Vec<Place> = (0..self.estimates.len()).into_par_iter().flat_map_iter(quarters).collect();
        places.into()
    }

    /// Half a diagonal of a quarter of a cell.
    pub fn fineness(&self) -> f64 {
        self.step * std::f64::consts::FRAC_1_SQRT_2 / 2.0
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
        let blocked = |blockers: &[Option<Blocker>], at: Point, best: f64| {
            blockers
                .iter()
                .flatten()
                .any(|&(p, q, owner)| point_segment(at, p, q) - inked.stroke(owner) - self.gap <= best)
        };
        for _ in 0..rounds {
            let moved = WAYS.into_iter().any(|ways| {
                let before = best;
                for (x, y) in ways {
                    let next = at + step * Vec2::new(x, y);
                    if blocked(&blockers, next, best) {
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
