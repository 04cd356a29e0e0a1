//! Fillers in the gaps that no element could take (FLOWPAK 6, checklist F-083): the largest
//! empty circles, largest first, each with the same gap around it as an element.

use super::place::Placement;
use super::prepare::{Field, Prepared};
use crate::geom::boolean::Contour;
use crate::geom::distance::{covered, squared_distances};
use crate::geom::flatten::flatten;
use crate::geom::near::PointGrid;
use kurbo::{BezPath, Circle, Point, Rect, Shape, Vec2};
use std::collections::BinaryHeap;

/// Places are looked at on a grid this fine, in spacings, and then moved to the middle.
const STEP: f64 = 1.0 / 13.0;
/// Radii in spacings: smaller reads as dust, larger as an element of another family.
const SMALLEST: f64 = 0.09;
const LARGEST: f64 = 0.21;

/// A filler in its place.
#[derive(Clone, Debug)]
pub(super) struct Filler {
    pub field: usize,
    pub centre: Point,
    pub radius: f64,
}

impl Filler {
    /// Its outline.
    pub fn path(&self) -> BezPath {
        // Four cubics; the error of a quarter circle is 0.03 % of the radius.
        Circle::new(self.centre, self.radius).to_path(1e-3 * self.radius)
    }
}

/// A place with its clearance, ordered by that, then by place.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Place(u64, u64, u64);

impl Place {
    fn new(at: Point, clearance: f64) -> Self {
        // Clearances are not negative, and non-negative floats order as their bits do.
        Place(clearance.to_bits(), at.y.to_bits(), at.x.to_bits())
    }

    fn at(&self) -> Point {
        Point::new(f64::from_bits(self.2), f64::from_bits(self.1))
    }
}

/// What is covered in one container: elements by cells, dots by their circles. A distance to
/// an outline is the same from inside, so this has to be known beside it.
struct Cover {
    origin: Point,
    step: f64,
    columns: usize,
    rows: usize,
    elements: Vec<bool>,
    /// True for cells that are sure to lie in the region, farther from its edge than any
    /// distance asked for.
    inner: Vec<bool>,
    dots: PointGrid,
    radii: Vec<f64>,
}

impl Cover {
    fn new(field: &Field, silhouettes: &[Contour]) -> Self {
        let bounds = field.region.bounds();
        let step = STEP * field.sizes.spacing;
        let (columns, rows) = ((bounds.width() / step) as usize + 1, (bounds.height() / step) as usize + 1);
        let dots = PointGrid::new(bounds, 2.0 * LARGEST * field.sizes.spacing);
        let elements = covered(silhouettes, bounds.origin(), step, columns, rows);
        Cover {
            origin: bounds.origin(),
            step,
            columns,
            rows,
            elements,
            inner: Vec::new(),
            dots,
            radii: Vec::new(),
        }
    }

    /// True for what is covered. Nearer to an outline than a cell is wide the answer may be
    /// that of its other side, but no dot goes so near to one.
    fn contains(&self, at: Point) -> bool {
        let largest = LARGEST * self.step / STEP;
        self.cell(at).is_none_or(|cell| self.elements[cell])
            || self.dots.any_within(at, largest, |centre, dot| centre.distance(at) < self.radii[dot as usize])
    }

    fn cell(&self, at: Point) -> Option<usize> {
        let (x, y) = ((at.x - self.origin.x) / self.step, (at.y - self.origin.y) / self.step);
        let inside_grid = x >= 0.0 && y >= 0.0 && (x as usize) < self.columns && (y as usize) < self.rows;
        inside_grid.then(|| y as usize * self.columns + x as usize)
    }

    fn is_inner(&self, at: Point) -> bool {
        self.cell(at).is_some_and(|cell| self.inner[cell])
    }

    fn middle(&self, cell: usize) -> Point {
        self.origin
            + Vec2::new((cell % self.columns) as f64 + 0.5, (cell / self.columns) as f64 + 0.5) * self.step
    }

    fn add(&mut self, dot: &Filler) {
        self.dots.insert(dot.centre, self.radii.len() as u32);
        self.radii.push(dot.radius);
    }
}

/// Fills the gaps of every container that asks for it. False if the time ran out first.
pub(super) fn fill(
    prepared: &Prepared,
    placement: &mut Placement,
    mut go_on: impl FnMut(f64) -> bool,
) -> (Vec<Filler>, bool) {
    let mut fillers = Vec::new();
    let wanted = |field: &Field| field.params.fillers == "dots";
    for (index, field) in prepared.fields.iter().enumerate().filter(|(_, field)| wanted(field)) {
        let done = index as f64 / prepared.fields.len() as f64;
        if !fill_field(index, field, placement, &mut fillers, || go_on(done)) {
            return (fillers, false);
        }
    }
    (fillers, true)
}

fn fill_field(
    index: usize,
    field: &Field,
    placement: &mut Placement,
    fillers: &mut Vec<Filler>,
    mut go_on: impl FnMut() -> bool,
) -> bool {
    let spacing = field.sizes.spacing;
    let (smallest, largest) = (SMALLEST * spacing, LARGEST * spacing);
    // A dot may move this far to the middle of its gap.
    let step = STEP * spacing;
    let reach = largest + field.sizes.safe_gap();
    let reach_box = field.region.bounds().inflate(spacing, spacing);
    let near: Vec<Contour> =
        placement.silhouettes.iter().filter(|contour| touches(contour, reach_box)).cloned().collect();
    let mut cover = Cover::new(field, &near);
    let clearance = |placement: &Placement, cover: &Cover, at: Point| {
        if cover.contains(at) { -reach } else { clearance(field, placement, cover, at, reach) }
    };
    let mut heap = candidates(field, &near, &mut cover, smallest, reach);
    const ASK_EVERY: usize = 256;
    let mut popped = 0;
    while let Some(place) = heap.pop() {
        popped += 1;
        if popped % ASK_EVERY == 0 && !go_on() {
            return false;
        }
        // The middle may be up to a diagonal of a cell away.
        if clearance(placement, &cover, place.at()) < smallest - step {
            continue;
        }
        let (centre, radius) = centred(place.at(), step, |at| clearance(placement, &cover, at));
        if radius < smallest {
            continue;
        }
        if radius.to_bits() < place.0 && heap.peek().is_some_and(|next| radius.to_bits() < next.0) {
            // The estimate was too good, or a filler placed since then took some of the room.
            heap.push(Place::new(centre, radius));
            continue;
        }
        let filler = Filler { field: index, centre, radius: radius.min(largest) };
        placement.add_outline(&flatten(&filler.path(), field.sizes.tolerance())[0].points);
        cover.add(&filler);
        // What is left of a long gap begins beside the new dot.
        let beside = filler.radius + field.sizes.gap + smallest;
        for k in 0..8 {
            let angle = f64::from(k) * std::f64::consts::FRAC_PI_4;
            let at = centre + beside * Vec2::new(libm::cos(angle), libm::sin(angle));
            let free = clearance(placement, &cover, at);
            if free > smallest - step {
                heap.push(Place::new(at, free.max(0.0) + step));
            }
        }
        fillers.push(filler);
    }
    true
}

/// The middles of the gaps between the elements, with an estimate of their clearance that is
/// never too small, from the distance transform of all outlines.
/// Notes what is far inside the region.
fn candidates(
    field: &Field,
    silhouettes: &[Contour],
    cover: &mut Cover,
    smallest: f64,
    reach: f64,
) -> BinaryHeap<Place> {
    let (columns, step) = (cover.columns, cover.step);
    let distances = |contours: &[Contour]| {
        let mut marked = vec![false; cover.elements.len()];
        contours.iter().for_each(|contour| mark(contour, cover, &mut marked));
        squared_distances(&marked, columns)
    };
    let (to_elements, to_boundary) =
        rayon::join(|| distances(silhouettes), || distances(field.region.contours()));
    let far = (reach / step + 2.0).powi(2);
    let in_region = covered(field.region.contours(), cover.origin, step, columns, cover.rows);
    cover.inner = in_region.into_iter().zip(&to_boundary).map(|(inside, &d)| inside && d > far).collect();
    let inset = (field.sizes.gap - field.sizes.edge).max(0.0);
    let estimate =
        |i: usize| (to_elements[i].sqrt() * step - field.sizes.gap).min(to_boundary[i].sqrt() * step - inset);
    let estimates: Vec<f64> = (0..cover.elements.len()).map(estimate).collect();
    let mut heap = BinaryHeap::new();
    for (i, &free) in estimates.iter().enumerate() {
        // Half a diagonal lies between a sample and its cell's middle, at both ends.
        let most = free + std::f64::consts::SQRT_2 * step;
        if most <= smallest || cover.elements[i] {
            continue;
        }
        let neighbours = [i.wrapping_sub(1), i + 1, i.wrapping_sub(columns), i + columns];
        if neighbours.into_iter().all(|j| estimates.get(j).is_none_or(|&other| other <= free)) {
            heap.push(Place::new(cover.middle(i), most));
        }
    }
    heap
}

/// True if a contour's bounding box reaches into a box.
fn touches(contour: &Contour, bounds: Rect) -> bool {
    contour.first().is_some_and(|&first| {
        let own = contour.iter().fold(Rect::from_points(first, first), |own, &p| own.union_pt(p));
        own.overlaps(bounds)
    })
}

/// Marks the cells that a contour passes.
fn mark(contour: &[Point], cover: &Cover, marked: &mut [bool]) {
    let Some(&last) = contour.last() else { return };
    let mut previous = last;
    for &p in contour {
        let pieces = (previous.distance(p) / (0.5 * cover.step)).ceil().clamp(1.0, 1e4);
        for k in 0..pieces as usize {
            let at = previous.lerp(p, k as f64 / pieces);
            let (x, y) = ((at.x - cover.origin.x) / cover.step, (at.y - cover.origin.y) / cover.step);
            if x >= 0.0
                && y >= 0.0
                && (x as usize) < cover.columns
                && let Some(cell) = marked.get_mut(y as usize * cover.columns + x as usize)
            {
                *cell = true;
            }
        }
        previous = p;
    }
}

/// Free radius of a dot at a place: to the elements less the gap, to the boundary in full.
/// Negative outside.
fn clearance(field: &Field, placement: &Placement, cover: &Cover, at: Point, reach: f64) -> f64 {
    let to_elements = placement.distance(at, reach) - field.sizes.safe_gap();
    if cover.is_inner(at) {
        return to_elements;
    }
    if !field.region.contains(at) {
        return -reach;
    }
    // The outline of the shape wants the same distance as an element does.
    let inset = (field.sizes.gap - field.sizes.edge).max(0.0);
    to_elements.min(field.region.distance(at, reach) - inset)
}

/// Climbs to the middle of a gap.
fn centred(mut at: Point, mut step: f64, clearance: impl Fn(Point) -> f64) -> (Point, f64) {
    const HALVINGS: usize = 4;
    let mut best = clearance(at);
    for _ in 0..HALVINGS {
        for (x, y) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)] {
            let next = at + step * Vec2::new(x, y);
            let free = clearance(next);
            if free > best {
                (at, best) = (next, free);
            }
        }
        step /= 2.0;
    }
    (at, best)
}
