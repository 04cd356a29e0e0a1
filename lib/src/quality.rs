//! How evenly an ornament fills its shapes: the measures of RepulsionPak and FLOWPAK's kin, on a
//! raster.
//!
//! Let C be the containers, E what is drawn (with the holes that are cut out of it), and r a radius. SCP(r) is the share of C from which
//! a disc of radius r fits between the pieces. Gaps that are channels of one width give a
//! straight line down to zero; how near SCP comes to that line is `evenness`.

use crate::geom::boolean::{Contour, area, is_outer, signed_area, simplified, stroked};
use crate::geom::distance::{cover, squared_distances};
use crate::geom::flatten::flatten;
use crate::shapes::Shapes;
use kurbo::{Point, Rect};
use rinceau_format::{Artwork, Error, FillRule, Part, Scene};
use std::collections::BTreeMap;

/// Cells of the raster, about.
const CELLS: f64 = 4e5;

/// A raster of what is inside, and of what is drawn there.
pub struct Raster {
    /// Side of a cell.
    pub cell: f64,
    columns: usize,
    inside: Vec<bool>,
    ink: Vec<bool>,
}

/// Measures an artwork by name:
/// `coverage`, share of the containers that is drawn on;
/// `mean_gap`, twice the mean distance in the gaps: half their width, if they are channels;
/// `largest_gap`, radius of the largest empty disc over `mean_gap` (1 is perfect);
/// `gap_cv`, coefficient of variation of gap widths along their middle;
/// `boundary`, share of the outline that has something drawn within `mean_gap`;
/// `evenness`, 1 for gaps of one width everywhere, less for any other.
///
/// Errors: a container that cannot be read; there is nothing to measure in.
pub fn measure(scene: &Scene, artwork: &Artwork) -> Result<BTreeMap<String, f64>, Error> {
    Ok(raster_of(scene, artwork)?.1.measure())
}

/// Discs that fill the gaps of an artwork, the largest first: middle and radius.
///
/// Errors: as [`measure`].
pub fn gap_discs(scene: &Scene, artwork: &Artwork) -> Result<Vec<(Point, f64)>, Error> {
    let (origin, raster) = raster_of(scene, artwork)?;
    let middle = |i: usize| {
        let at = |i: usize| (i as f64 + 0.5) * raster.cell;
        Point::new(origin.x + at(i % raster.columns), origin.y + at(i / raster.columns))
    };
    Ok(raster.discs().into_iter().map(|(i, radius)| (middle(i), radius)).collect())
}

/// The raster of an artwork, and its corner.
fn raster_of(scene: &Scene, artwork: &Artwork) -> Result<(Point, Raster), Error> {
    let shapes = Shapes::new(scene, &[])?;
    let cell = (shapes.bounds.area() / CELLS).sqrt().max(f64::MIN_POSITIVE);
    // The cells around it are outside, so that its edge is known as one.
    let bounds = shapes.bounds.inflate(cell, cell);
    let mut raster = Raster::new(bounds, cell);
    for index in 0..shapes.containers.len() {
        if let Some(region) = shapes.free(index, 0.0, 0.0) {
            raster.add_inside(bounds.origin(), region.contours());
        }
    }
    let drawn = artwork.groups.iter().filter(|group| !group.hidden && group.name != "fixed");
    for part in drawn.flat_map(|group| &group.items).flat_map(|item| artwork.shapes(item)) {
        raster.add_ink(bounds.origin(), &area_of(&part, cell));
    }
    Ok((bounds.origin(), raster))
}

/// What a part covers, as simple contours, with the small holes in it.
fn area_of(part: &Part, cell: f64) -> Vec<Contour> {
    let scale = part.transform.determinant().abs().sqrt();
    let subpaths = flatten(&(part.transform * part.path.clone()), 0.2 * cell);
    let mut contours = Vec::new();
    if part.style.is_filled() {
        contours.extend(subpaths.iter().map(|subpath| subpath.points.clone()));
        contours = simplified(&contours, part.style.fill_rule() == FillRule::EvenOdd);
    }
    let width = part.style.stroke_width().unwrap_or(0.0) * scale;
    for subpath in &subpaths {
        contours.extend(stroked(&subpath.points, subpath.closed, width));
    }
    if width > 0.0 {
        contours = simplified(&contours, false);
    }
    // Veins and eyes that are cut out of a leaf belong to it; what a stem winds around does not.
    const OWN: f64 = 0.5;
    let ink = area(&contours);
    contours.retain(|contour| is_outer(contour) || signed_area(contour).abs() > OWN * ink);
    contours
}

impl Raster {
    /// An empty raster.
    pub fn new(bounds: Rect, cell: f64) -> Self {
        let count = |side: f64| (side / cell).ceil() as usize + 1;
        let (columns, rows) = (count(bounds.width()), count(bounds.height()));
        Raster { cell, columns, inside: vec![false; columns * rows], ink: vec![false; columns * rows] }
    }

    fn add_inside(&mut self, origin: Point, contours: &[Contour]) {
        cover(contours, origin, self.cell, self.columns, &mut self.inside);
    }

    fn add_ink(&mut self, origin: Point, contours: &[Contour]) {
        cover(contours, origin, self.cell, self.columns, &mut self.ink);
    }

    /// Distance to what is drawn or outside, of every cell in a gap.
    fn gaps(&self) -> (Vec<f64>, Vec<f64>) {
        let taken: Vec<bool> =
            self.inside.iter().zip(&self.ink).map(|(&inside, &ink)| ink || !inside).collect();
        let squared = squared_distances(&taken, self.columns);
        // Half a cell lies between the middle of the nearest taken cell and its edge.
        let distance = |i: usize| (squared[i].sqrt() - 0.5).max(0.0) * self.cell;
        let in_gap: Vec<usize> = (0..taken.len()).filter(|&i| !taken[i]).collect();
        let all = in_gap.iter().map(|&i| distance(i)).collect();
        // The middle of a gap: nowhere near it is farther from its sides.
        let around = |i: usize| [i.wrapping_sub(1), i + 1, i.wrapping_sub(self.columns), i + self.columns];
        let is_middle = |&&i: &&usize| {
            around(i).into_iter().all(|j| squared.get(j).is_none_or(|&other| other <= squared[i]))
        };
        let middle = in_gap.iter().filter(is_middle).map(|&i| distance(i)).collect();
        (all, middle)
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

    /// Share of the cells along the outline that are no farther than this from what is drawn.
    fn bordered(&self, reach: f64) -> f64 {
        let outside = |i: usize| self.inside.get(i).is_none_or(|inside| !inside);
        let on_outline = |&i: &usize| {
            let around = [i.wrapping_sub(1), i + 1, i.wrapping_sub(self.columns), i + self.columns];
            self.inside[i] && around.into_iter().any(outside)
        };
        let outline: Vec<usize> = (0..self.inside.len()).filter(on_outline).collect();
        let squared = squared_distances(&self.ink, self.columns);
        let near = outline.iter().filter(|&&i| (squared[i].sqrt() - 0.5) * self.cell <= reach).count();
        near as f64 / (outline.len() as f64).max(1.0)
    }

    /// The measures.
    pub fn measure(&self) -> BTreeMap<String, f64> {
        let inside = self.inside.iter().filter(|&&inside| inside).count() as f64;
        let (distances, middles) = self.gaps();
        let mean = |values: &[f64]| values.iter().sum::<f64>() / (values.len() as f64).max(1.0);
        let empty = distances.len() as f64 / inside.max(1.0);
        let half_width = 2.0 * mean(&distances);
        let largest = distances.iter().copied().fold(0.0, f64::max);
        let middle = mean(&middles);
        let spread = mean(&middles.iter().map(|d| (d - middle) * (d - middle)).collect::<Vec<_>>()).sqrt();
        let share = |x: f64, y: f64| if y > 0.0 { x / y } else { 0.0 };
        BTreeMap::from([
            ("coverage".to_owned(), 1.0 - empty),
            ("mean_gap".to_owned(), half_width),
            ("largest_gap".to_owned(), share(largest, half_width)),
            ("gap_cv".to_owned(), share(spread, middle)),
            ("boundary".to_owned(), self.bordered(half_width)),
            ("evenness".to_owned(), evenness(&distances, half_width, largest)),
        ])
    }
}

/// 1 less the area between SCP and the line of channels of one width, over that line's area.
fn evenness(distances: &[f64], half_width: f64, largest: f64) -> f64 {
    const STEPS: usize = 400;
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
        for row in 0..20 {
            for column in 0..20 {
                let at = |i: i32| f64::from(i) * (a + g) + g / 2.0;
                raster.add_ink(Point::ORIGIN, &[square(at(column), at(row), a)]);
            }
        }
        let (distances, _) = raster.gaps();
        let inside = raster.inside.iter().filter(|&&inside| inside).count() as f64;
        for (r, expected) in [(0.0, 0.4898), (1.0, 0.3837), (2.0, 0.2697), (3.0, 0.1476)] {
            let scp = distances.iter().filter(|&&d| d >= r).count() as f64 / inside;
            // The border of the lattice is a wall too: half a gap wide, it takes a little more.
            assert!((scp - expected).abs() < 0.03, "{r}: {scp} {expected}");
        }
        assert!((raster.measure()["coverage"] - 400.0 / 784.0).abs() < 1e-3);
    }

    #[test]
    fn strips_are_perfectly_even() {
        let mut raster = Raster::new(Rect::new(0.0, 0.0, 400.0, 400.0), 0.5);
        raster.add_inside(Point::ORIGIN, &[square(0.0, 0.0, 400.0)]);
        for k in 0..10 {
            let x = f64::from(k) * 40.0;
            raster.add_ink(
                Point::ORIGIN,
                &[[(x, 0.0), (x + 20.0, 0.0), (x + 20.0, 400.0), (x, 400.0)].map(Point::from).to_vec()],
            );
        }
        let measures = raster.measure();
        assert!(measures["evenness"] > 0.94 && measures["gap_cv"] < 0.1, "{measures:?}");
        assert!((measures["largest_gap"] - 1.0).abs() < 0.1);
    }
}
