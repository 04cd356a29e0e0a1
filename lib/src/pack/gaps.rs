//! The gaps of a composition: where they are widest, and how much room there is at a place.

use super::prepare::Field;
use crate::geom::boolean::Contour;
use crate::geom::distance::{cover, covered, squared_distances};
use crate::geom::near::{PointGrid, SegmentGrid};
use kurbo::{Point, Rect, Vec2};
use std::collections::BinaryHeap;

/// Places are looked at on a grid this fine, in spacings, and then moved to the middle.
pub(super) const STEP: f64 = 1.0 / 13.0;

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

/// What is covered in one container: elements by cells, dots by their circles. A distance to
/// an outline is the same from inside, so this has to be known beside it.
pub(super) struct Gaps<'a> {
    field: &'a Field,
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
}

impl<'a> Gaps<'a> {
    /// The gaps between elements of these silhouettes, for things with a radius of up to `largest` that
    /// keep `gap` from them.
    pub fn new(field: &'a Field, silhouettes: &[Contour], largest: f64, gap: f64) -> Self {
        let bounds = field.region.bounds();
        let step = STEP * field.sizes.spacing;
        let gap = field.sizes.safe(gap);
        let (columns, rows) = ((bounds.width() / step) as usize + 1, (bounds.height() / step) as usize + 1);
        let around = bounds.inflate(field.sizes.spacing, field.sizes.spacing);
        let near: Vec<Contour> =
            silhouettes.iter().filter(|contour| touches(contour, around)).cloned().collect();
        let mut gaps = Gaps {
            field,
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
        };
        gaps.estimate(&near);
        gaps
    }

    /// The room around every cell's middle, from the distance transform of all outlines, and what is far
    /// inside the region.
    fn estimate(&mut self, silhouettes: &[Contour]) {
        let (columns, step) = (self.columns, self.step);
        let distances = |contours: &[Contour]| {
            let mut marked = vec![false; self.elements.len()];
            contours.iter().for_each(|contour| self.mark(contour, &mut marked));
            squared_distances(&marked, columns)
        };
        let region = &self.field.region;
        let (to_elements, to_boundary) =
            rayon::join(|| distances(silhouettes), || distances(region.contours()));
        let far = (self.reach / step + 2.0).powi(2);
        let rows = self.elements.len() / columns;
        let in_region = covered(region.contours(), self.origin, step, columns, rows);
        let gap = self.gap;
        let estimate = |i: usize| (to_elements[i].sqrt() * step - gap).min(to_boundary[i].sqrt() * step);
        self.estimates = (0..self.elements.len()).map(estimate).collect();
        self.inner = in_region.into_iter().zip(&to_boundary).map(|(inside, &d)| inside && d > far).collect();
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

    /// Free radius at a place: to the outlines less the gap, to the boundary in full. Negative
    /// outside and in what is covered.
    pub fn clearance(&self, outlines: &SegmentGrid, at: Point) -> f64 {
        if self.covers(at) {
            return -self.reach;
        }
        let to_elements = outlines.distance(at, self.reach) - self.gap;
        if self.cell(at).is_some_and(|cell| self.inner[cell]) {
            return to_elements;
        }
        if !self.field.region.contains(at) {
            return -self.reach;
        }
        to_elements.min(self.field.region.distance(at, self.reach))
    }

    /// Climbs to the middle of a gap, and tells the clearance there.
    pub fn centred(&self, outlines: &SegmentGrid, mut at: Point) -> (Point, f64) {
        const HALVINGS: usize = 4;
        let mut step = self.step;
        let mut best = self.clearance(outlines, at);
        for _ in 0..HALVINGS {
            for (x, y) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)] {
                let next = at + step * Vec2::new(x, y);
                let free = self.clearance(outlines, next);
                if free > best {
                    (at, best) = (next, free);
                }
            }
            step /= 2.0;
        }
        (at, best)
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

    /// Marks the cells that a contour passes.
    fn mark(&self, contour: &[Point], marked: &mut [bool]) {
        let Some(&last) = contour.last() else { return };
        let mut previous = last;
        for &p in contour {
            let pieces = (previous.distance(p) / (0.5 * self.step)).ceil().clamp(1.0, 1e4);
            for k in 0..pieces as usize {
                let at = previous.lerp(p, k as f64 / pieces);
                if let Some(cell) = self.cell(at) {
                    marked[cell] = true;
                }
            }
            previous = p;
        }
    }
}

/// True if a contour's bounding box reaches into a box.
fn touches(contour: &Contour, bounds: Rect) -> bool {
    contour.first().is_some_and(|&first| {
        let own = contour.iter().fold(Rect::from_points(first, first), |own, &p| own.union_pt(p));
        own.overlaps(bounds)
    })
}
