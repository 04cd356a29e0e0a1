//! How evenly an ornament fills its shapes: the measures of RepulsionPak and FLOWPAK's kin, on a
//! raster.
//!
//! Let C be the containers, E what is drawn (with the holes that are cut out of it), and r a radius. SCP(r) is the share of C from which
//! a disc of radius r fits between the pieces. Gaps that are channels of one width give a
//! straight line down to zero; how near SCP comes to that line is `evenness`.

use crate::geom::boolean::{Contour, area, is_outer, signed_area, simplified};
use crate::geom::distance::{cover, nearest_marked, runs, squared_distances};
use crate::geom::segment::SegmentGrid;
use crate::ink::area_of;
use crate::shapes::Shapes;
use kurbo::{Point, Rect, Vec2};
use rinceau_format::{Artwork, Error, Part, Scene};
use std::collections::BTreeMap;

/// Cells of the raster, about, and at most.
const CELLS: f64 = 4e5;
const MOST_CELLS: f64 = 6.4e6;
/// Half a gap is at least this many cells wide, if that does not take too many.
const FINE: f64 = 7.0;

/// A raster of what is inside, and of what is drawn there.
pub struct Raster {
    /// Side of a cell.
    pub cell: f64,
    columns: usize,
    /// The containers.
    whole: Vec<bool>,
    /// What is not fixed in them.
    inside: Vec<bool>,
    ink: Vec<bool>,
    /// Which piece each cell of ink belongs to.
    owner: Vec<u32>,
    pieces: u32,
    /// How often a piece covers a cell of another.
    doubled: usize,
    /// The outlines of all that, from the corner of the raster.
    outlines: Vec<Contour>,
}

/// Distances to what is drawn or outside.
struct Widths {
    /// The cells in gaps, and their distances.
    cells: Vec<usize>,
    all: Vec<f64>,
    /// Distances in the middle of gaps.
    middle: Vec<f64>,
}

/// Measures an artwork by name:
/// `coverage`, share of the containers that is drawn on;
/// `mean_gap`, twice the mean distance in the gaps: half their width, if they are channels;
/// `largest_gap`, radius of the largest empty disc over `mean_gap` (1 is perfect); no disc crosses the outline of a
/// container;
/// `gap_cv`, coefficient of variation of gap widths, where two different pieces, or a piece and
/// the outline, are equally near;
/// `boundary`, share of the containers' outline that has something drawn or fixed within a gap of it (twice
/// `mean_gap`);
/// `overlap` and `spill`, area drawn on twice and outside of the containers, over their area;
/// `grown_overlap`, OF at half the mean gap: what overlaps if every piece grows by half of `mean_gap` (0
/// unless gaps are narrower than half the mean);
/// `evenness`, 1 for gaps of one width everywhere, less for any other.
///
/// Errors: a container that cannot be read; there is nothing to measure in.
pub fn measure(scene: &Scene, artwork: &Artwork) -> Result<BTreeMap<String, f64>, Error> {
    let (_, raster) = raster_of(scene, artwork, CELLS)?;
    let finer = (FINE * raster.cell / half_width(&raster.gaps().all).max(f64::MIN_POSITIVE)).powi(2);
    let cells = (finer * CELLS).clamp(CELLS, MOST_CELLS);
    Ok(if cells > CELLS { raster_of(scene, artwork, cells)?.1.measure() } else { raster.measure() })
}

/// Discs that fill the gaps of an artwork, the largest first: middle and radius.
///
/// Errors: as [`measure`].
pub fn gap_discs(scene: &Scene, artwork: &Artwork) -> Result<Vec<(Point, f64)>, Error> {
    let (origin, raster) = raster_of(scene, artwork, CELLS)?;
    let middle = |i: usize| {
        let at = |i: usize| (i as f64 + 0.5) * raster.cell;
        Point::new(origin.x + at(i % raster.columns), origin.y + at(i / raster.columns))
    };
    Ok(raster.discs().into_iter().map(|(i, radius)| (middle(i), radius)).collect())
}

/// The raster of an artwork in about so many cells, and its corner.
fn raster_of(scene: &Scene, artwork: &Artwork, cells: f64) -> Result<(Point, Raster), Error> {
    let shapes = Shapes::new(scene, &[])?;
    let cell = (shapes.bounds.area() / cells).sqrt().max(f64::MIN_POSITIVE);
    // The cells around it are outside, so that its edge is known as one.
    let bounds = shapes.bounds.inflate(cell, cell);
    let mut raster = Raster::new(bounds, cell);
    for index in 0..shapes.containers.len() {
        if let Some(region) = shapes.free(index, 0.0, 0.0) {
            raster.add_inside(bounds.origin(), region.contours());
        }
        cover(&shapes.containers[index], bounds.origin(), cell, raster.columns, &mut raster.whole);
    }
    for fixed in &scene.fixed {
        raster.add_fixed(bounds.origin(), &filled(&fixed.parts, cell));
    }
    let drawn = artwork.groups.iter().filter(|group| !group.hidden && group.name != "fixed");
    for item in drawn.flat_map(|group| &group.items) {
        raster.add_piece(bounds.origin(), &filled(&artwork.shapes(item), cell));
    }
    Ok((bounds.origin(), raster))
}

/// What a piece covers, with the small holes in it.
fn filled(parts: &[Part], cell: f64) -> Vec<Contour> {
    let all: Vec<Contour> = parts.iter().flat_map(|part| area_of(part, 0.2 * cell)).collect();
    let mut contours = simplified(&all, false);
    // Veins and eyes that are cut out of a leaf belong to it; what a stem winds around does not: it is larger
    // than the stem itself.
    const OWN: f64 = 1.0;
    let ink = area(&contours);
    contours.retain(|contour| is_outer(contour) || signed_area(contour).abs() > OWN * ink);
    // An island in such a hole lies in what is covered now.
    simplified(&contours, false)
}

impl Raster {
    /// An empty raster.
    pub fn new(bounds: Rect, cell: f64) -> Self {
        let count = |side: f64| (side / cell).ceil() as usize + 1;
        let (columns, rows) = (count(bounds.width()), count(bounds.height()));
        let cells = columns * rows;
        Raster {
            cell,
            columns,
            whole: vec![false; cells],
            inside: vec![false; cells],
            ink: vec![false; cells],
            owner: vec![0; cells],
            pieces: 0,
            doubled: 0,
            outlines: Vec::new(),
        }
    }

    fn add_inside(&mut self, origin: Point, contours: &[Contour]) {
        self.add_outlines(origin, contours);
        cover(contours, origin, self.cell, self.columns, &mut self.inside);
    }

    /// Takes out what is fixed, with the small holes in it.
    fn add_fixed(&mut self, origin: Point, contours: &[Contour]) {
        self.add_outlines(origin, contours);
        runs(contours, origin, self.cell, (self.columns, self.inside.len()), |run| {
            self.inside[run].fill(false)
        });
    }

    /// Adds a piece of ink.
    fn add_piece(&mut self, origin: Point, contours: &[Contour]) {
        self.add_outlines(origin, contours);
        self.pieces += 1;
        runs(contours, origin, self.cell, (self.columns, self.ink.len()), |run| {
            self.doubled += self.owner[run.clone()].iter().filter(|&&owner| owner != 0).count();
            self.ink[run.clone()].fill(true);
            self.owner[run].fill(self.pieces);
        });
    }

    fn add_outlines(&mut self, origin: Point, contours: &[Contour]) {
        let moved = |contour: &Contour| contour.iter().map(|&p| p - origin.to_vec2()).collect();
        self.outlines.extend(contours.iter().map(moved));
    }

    /// The radius of the largest empty disc, exact where cells say that it may be: those are off by a part of
    /// their size.
    fn largest(&self, widths: &Widths) -> f64 {
        let most = widths.all.iter().copied().fold(0.0, f64::max);
        let rows = self.ink.len() / self.columns;
        let size = |count: usize| count as f64 * self.cell;
        let bounds = Rect::new(0.0, 0.0, size(self.columns), size(rows));
        let mut edges = SegmentGrid::new(bounds, most.max(self.cell));
        self.outlines.iter().for_each(|outline| edges.insert_contour(outline, 0));
        let free = |at: Point| edges.distance(at, most + 4.0 * self.cell);
        let climbed = |i: usize| {
            let middle = |i: usize| (i as f64 + 0.5) * self.cell;
            let mut at = Point::new(middle(i % self.columns), middle(i / self.columns));
            let (mut best, mut step) = (free(at), self.cell / 2.0);
            while step > self.cell / 32.0 {
                let ways = [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)];
                let places = ways.map(|(x, y)| at + step * Vec2::new(x, y));
                let widest = places.into_iter().max_by(|&a, &b| free(a).total_cmp(&free(b)));
                match widest.filter(|&next| free(next) > best) {
                    Some(next) => (at, best) = (next, free(next)),
                    None => step /= 2.0,
                }
            }
            best
        };
        let may_be = widths.cells.iter().zip(&widths.all).filter(|(_, d)| **d >= most - self.cell);
        may_be.map(|(&i, _)| climbed(i)).fold(0.0, f64::max)
    }

    /// Distance to what is drawn or outside, of every cell in a gap.
    fn gaps(&self) -> Widths {
        let taken: Vec<bool> =
            self.inside.iter().zip(&self.ink).map(|(&inside, &ink)| ink || !inside).collect();
        let (squared, nearest) = nearest_marked(&taken, self.columns);
        // Half a cell lies between the middle of the nearest taken cell and its edge.
        let distance = |i: usize| (squared[i].sqrt() - 0.5).max(0.0) * self.cell;
        let in_gap: Vec<usize> = (0..taken.len()).filter(|&i| !taken[i]).collect();
        let all = in_gap.iter().map(|&i| distance(i)).collect();
        // The middle of a gap: where the nearest piece changes. What lies between two parts of one piece,
        // a notch of a leaf or the turns of a spiral, is no gap between pieces.
        let owner = |i: usize| if self.ink[nearest[i]] { self.owner[nearest[i]] } else { 0 };
        let is_middle = |&&i: &&usize| {
            [i + 1, i + self.columns]
                .into_iter()
                .any(|j| taken.get(j) == Some(&false) && owner(i) != owner(j))
        };
        let middle = in_gap.iter().filter(is_middle).map(|&i| distance(i)).collect();
        Widths { cells: in_gap, all, middle }
    }

    /// Cells and radii of discs in the gaps, the largest first, none with its middle deep in another.
    fn discs(&self) -> Vec<(usize, f64)> {
        /// A disc keeps the middles of smaller ones out of this share of its radius.
        const DEEP: f64 = 0.8;
        let taken: Vec<bool> =
            self.inside.iter().zip(&self.ink).map(|(&inside, &ink)| ink || !inside).collect();
        let squared = squared_distances(&taken, self.columns);
        let mut cells: Vec<usize> = (0..taken.len()).filter(|&i| squared[i] > 4.0).collect();
        cells.sort_by(|&a, &b| squared[b].total_cmp(&squared[a]).then(a.cmp(&b)));
        let mut is_covered = vec![false; taken.len()];
        let mut discs = Vec::new();
        for i in cells {
            if is_covered[i] {
                continue;
            }
            let radius = squared[i].sqrt() - 0.5;
            // A cell less, since cells are covered by halves: no disc reaches over what it lies between.
            discs.push((i, (radius - 1.0) * self.cell));
            let reach = DEEP * radius;
            let (x, y) = ((i % self.columns) as f64, (i / self.columns) as f64);
            let rows = taken.len() / self.columns;
            let range =
                |at: f64, most: usize| (at - reach).max(0.0) as usize..=((at + reach) as usize).min(most - 1);
            for row in range(y, rows) {
                for column in range(x, self.columns) {
                    if (column as f64 - x).hypot(row as f64 - y) <= reach {
                        is_covered[row * self.columns + column] = true;
                    }
                }
            }
        }
        discs
    }

    /// Share of the cells along the outline that are no farther than this from what is drawn or fixed.
    fn bordered(&self, reach: f64) -> f64 {
        let outside = |i: usize| self.whole.get(i).is_none_or(|whole| !whole);
        let on_outline = |&i: &usize| {
            let around = [i.wrapping_sub(1), i + 1, i.wrapping_sub(self.columns), i + self.columns];
            self.whole[i] && around.into_iter().any(outside)
        };
        let outline: Vec<usize> = (0..self.whole.len()).filter(on_outline).collect();
        let is_drawn = |i: usize| self.ink[i] || self.whole[i] && !self.inside[i];
        let drawn: Vec<bool> = (0..self.whole.len()).map(is_drawn).collect();
        let squared = squared_distances(&drawn, self.columns);
        let near = outline.iter().filter(|&&i| (squared[i].sqrt() - 0.5) * self.cell <= reach).count();
        near as f64 / (outline.len() as f64).max(1.0)
    }

    /// Cells drawn on outside of the containers.
    fn spilt(&self) -> usize {
        self.ink.iter().zip(&self.whole).filter(|&(&ink, &whole)| ink && !whole).count()
    }

    /// OF(r): how much pieces that all grow by `r` overlap in the containers, over the area of these.
    fn overlap_of_grown(&self, r: f64) -> f64 {
        let rows = self.ink.len() / self.columns;
        // Columns and rows of every piece, from and to.
        let mut boxes = vec![[usize::MAX, 0, usize::MAX, 0]; self.pieces as usize + 1];
        for (i, &owner) in self.owner.iter().enumerate().filter(|(i, _)| self.ink[*i]) {
            let (x, y) = (i % self.columns, i / self.columns);
            let [x0, x1, y0, y1] = &mut boxes[owner as usize];
            (*x0, *x1, *y0, *y1) = ((*x0).min(x), (*x1).max(x), (*y0).min(y), (*y1).max(y));
        }
        let reach = (r / self.cell).ceil() as usize + 1;
        let mut covered = vec![0u32; self.ink.len()];
        for (piece, [x0, x1, y0, y1]) in boxes.into_iter().enumerate().filter(|(_, b)| b[0] <= b[1]) {
            let (x0, y0) = (x0.saturating_sub(reach), y0.saturating_sub(reach));
            let (x1, y1) = ((x1 + reach).min(self.columns - 1), (y1 + reach).min(rows - 1));
            let cells = || (y0..=y1).flat_map(|y| (x0..=x1).map(move |x| y * self.columns + x));
            let own: Vec<bool> = cells().map(|i| self.ink[i] && self.owner[i] == piece as u32).collect();
            let squared = squared_distances(&own, x1 - x0 + 1);
            for (i, squared) in cells().zip(squared) {
                covered[i] += u32::from((squared.sqrt() - 0.5) * self.cell < r);
            }
        }
        let more = |i: usize| if self.inside[i] { f64::from(covered[i].saturating_sub(1)) } else { 0.0 };
        let inside = self.inside.iter().filter(|&&inside| inside).count();
        (0..covered.len()).map(more).sum::<f64>() / (inside as f64).max(1.0)
    }

    /// The measures.
    pub fn measure(&self) -> BTreeMap<String, f64> {
        let inside = self.inside.iter().filter(|&&inside| inside).count() as f64;
        let widths = self.gaps();
        let (distances, middles) = (&widths.all, &widths.middle);
        let mean = |values: &[f64]| values.iter().sum::<f64>() / (values.len() as f64).max(1.0);
        let empty = distances.len() as f64 / inside.max(1.0);
        let half_width = half_width(distances);
        let largest = self.largest(&widths);
        let middle = mean(middles);
        let spread = mean(&middles.iter().map(|d| (d - middle) * (d - middle)).collect::<Vec<_>>()).sqrt();
        let share = |x: f64, y: f64| if y > 0.0 { x / y } else { 0.0 };
        BTreeMap::from([
            ("coverage".to_owned(), 1.0 - empty),
            ("mean_gap".to_owned(), half_width),
            ("largest_gap".to_owned(), share(largest, half_width)),
            ("gap_cv".to_owned(), share(spread, middle)),
            ("boundary".to_owned(), self.bordered(2.0 * half_width)),
            ("overlap".to_owned(), self.doubled as f64 / inside.max(1.0)),
            ("spill".to_owned(), self.spilt() as f64 / inside.max(1.0)),
            ("grown_overlap".to_owned(), self.overlap_of_grown(0.5 * half_width)),
            ("evenness".to_owned(), evenness(distances, half_width)),
        ])
    }
}

/// Twice the mean distance in gaps.
fn half_width(distances: &[f64]) -> f64 {
    2.0 * distances.iter().sum::<f64>() / (distances.len() as f64).max(1.0)
}

/// 1 less the area between SCP and the line of channels of one width, over that line's area.
fn evenness(distances: &[f64], half_width: f64) -> f64 {
    const STEPS: usize = 400;
    let largest = distances.iter().copied().fold(0.0, f64::max);
    if half_width <= 0.0 {
        return 1.0;
    }
    let mut sorted = distances.to_vec();
    sorted.sort_by(f64::total_cmp);
    let step = largest / STEPS as f64;
    let off: f64 = (0..STEPS)
        .map(|k| {
            let r = (k as f64 + 0.5) * step;
            let scp = 1.0 - sorted.partition_point(|&d| d < r) as f64 / sorted.len() as f64;
            (scp - (1.0 - r / half_width).max(0.0)).abs() * step
        })
        .sum();
    1.0 - off / (half_width / 2.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: f64, y: f64, side: f64) -> Contour {
        [(x, y), (x + side, y), (x + side, y + side), (x, y + side)].map(Point::from).to_vec()
    }

    #[test]
    fn squares_on_a_lattice_measure_as_their_formula_says() {
        // Squares of side 20 at a pitch of 28: SCP(r) = 1 - (a^2 + 4ar + pi r^2) / (a + g)^2.
        let (a, g) = (20.0, 8.0);
        let mut raster = Raster::new(Rect::new(0.0, 0.0, 560.0, 560.0), 0.25);
        raster.add_inside(Point::ORIGIN, &[square(0.0, 0.0, 560.0)]);
        raster.whole = raster.inside.clone();
        for row in 0..20 {
            for column in 0..20 {
                let at = |i: i32| f64::from(i) * (a + g) + g / 2.0;
                raster.add_piece(Point::ORIGIN, &[square(at(column), at(row), a)]);
            }
        }
        let distances = raster.gaps().all;
        let inside = raster.inside.iter().filter(|&&inside| inside).count() as f64;
        for (r, expected) in [(0.0, 0.4898), (1.0, 0.3837), (2.0, 0.2697), (3.0, 0.1476)] {
            let scp = distances.iter().filter(|&&d| d >= r).count() as f64 / inside;
            // The border of the lattice is a wall too: half a gap wide, it takes a little more.
            assert!((scp - expected).abs() < 0.03, "{r}: {scp} {expected}");
        }
        let measures = raster.measure();
        assert!((measures["coverage"] - 400.0 / 784.0).abs() < 1e-3);
        assert_eq!((measures["overlap"], measures["spill"]), (0.0, 0.0));
        // OF is flat until squares meet at r = g / 2; beyond, the strips of 2r - g between two of them count
        // (and a little at the corners).
        assert_eq!(raster.overlap_of_grown(3.7), 0.0);
        let expected = 2.0 * (a + 2.0) * 2.0 / 784.0;
        assert!((raster.overlap_of_grown(5.0) - expected).abs() < 0.02, "{}", raster.overlap_of_grown(5.0));
    }

    #[test]
    fn overlap_and_spill_are_seen() {
        let mut raster = Raster::new(Rect::new(0.0, 0.0, 200.0, 200.0), 0.5);
        raster.add_inside(Point::ORIGIN, &[square(20.0, 20.0, 160.0)]);
        cover(&[square(20.0, 20.0, 160.0)], Point::ORIGIN, 0.5, raster.columns, &mut raster.whole);
        raster.add_piece(Point::ORIGIN, &[square(10.0, 50.0, 40.0)]);
        raster.add_piece(Point::ORIGIN, &[square(40.0, 50.0, 40.0)]);
        let measures = raster.measure();
        assert!((measures["overlap"] - 400.0 / 25_600.0).abs() < 1e-3, "{measures:?}");
        assert!((measures["spill"] - 400.0 / 25_600.0).abs() < 1e-3, "{measures:?}");
    }

    #[test]
    fn strips_are_perfectly_even() {
        let mut raster = Raster::new(Rect::new(0.0, 0.0, 400.0, 400.0), 0.5);
        raster.add_inside(Point::ORIGIN, &[square(0.0, 0.0, 400.0)]);
        for k in 0..10 {
            let x = f64::from(k) * 40.0;
            let strip = [(x, 0.0), (x + 20.0, 0.0), (x + 20.0, 400.0), (x, 400.0)].map(Point::from).to_vec();
            raster.add_piece(Point::ORIGIN, &[strip]);
        }
        let measures = raster.measure();
        // At both ends of a strip the gap narrows into the corners.
        assert!(measures["evenness"] > 0.94 && measures["gap_cv"] < 0.16, "{measures:?}");
        assert!((measures["largest_gap"] - 1.0).abs() < 0.1);
    }
}
