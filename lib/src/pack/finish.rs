//! Finishes of what is drawn: rounded corners, and a worn look (FLOWPAK 5, Figure 13, checklist F-071 and
//! F-073).
//!
//! Both only take away, so whatever held of an outline before (the gaps, the region) holds after.

use crate::geom::boolean::{Contour, area, difference, is_outer, offset, signed_area, simplified};
use crate::geom::flatten::flatten;
use crate::geom::polyline::simplified_closed;
use kurbo::{BezPath, Point, Rect};
use rinceau_format::{FillRule, Part};

/// How pieces are finished.
#[derive(Clone, Copy, Debug)]
pub(super) struct Finish {
    /// Radius of corners.
    pub rounding: f64,
    /// 0 for whole, 1 for worn away by about half.
    pub distress: f64,
    pub seed: u64,
    /// Element width, which the marks of wear are a share of.
    pub spacing: f64,
    pub tolerance: f64,
}

/// Size of the marks of wear, in element widths; and of the cells that they are cut out by.
const MARK: f64 = 0.22;
const CELL: f64 = 0.045;
/// Crumbs smaller than this, in squares of the element width, are swept away.
const CRUMB: f64 = 2e-3;

impl Finish {
    /// True if it leaves everything as it is.
    pub fn is_plain(&self) -> bool {
        self.rounding <= 0.0 && self.distress <= 0.0
    }

    /// A filled part, finished. `None` if nothing is left of it. Parts without a fill stay as they are.
    pub fn part(&self, part: Part) -> Option<Part> {
        if self.is_plain() || !part.style.is_filled() {
            return Some(part);
        }
        let flat = flatten(&(part.transform * part.path.clone()), 0.5 * self.tolerance);
        let contours: Vec<Contour> = flat.into_iter().map(|subpath| subpath.points).collect();
        let mut contours = simplified(&contours, part.style.fill_rule() == FillRule::EvenOdd);
        if self.rounding > 0.0 {
            // Offsets cost more than the number of points.
            let lighter = contours.iter().map(|contour| simplified_closed(contour, 0.25 * self.tolerance));
            contours = rounded(lighter.filter(|contour| contour.len() > 2).collect(), self.rounding);
        }
        if self.distress > 0.0 {
            contours = difference(&contours, &self.marks(&contours));
            let least = CRUMB * self.spacing * self.spacing;
            contours.retain(|contour| !is_outer(contour) || signed_area(contour).abs() >= least);
        }
        if contours.is_empty() || area(&contours) <= 0.0 {
            return None;
        }
        let mut path = BezPath::new();
        for contour in &contours {
            let contour = simplified_closed(contour, 0.5 * self.tolerance);
            path.move_to(contour[0]);
            contour[1..].iter().for_each(|&p| path.line_to(p));
            path.close_path();
        }
        let mut style = part.style;
        // Holes run against what they are in, so that either rule sees them.
        style.set("fill-rule", "nonzero");
        Some(Part { path, transform: kurbo::Affine::IDENTITY, style })
    }

    /// What is worn away around some contours: where a smooth noise is above a height.
    fn marks(&self, contours: &[Contour]) -> Vec<Contour> {
        // The noise is nearly normal about a half, with a deviation of a seventh.
        let height = 0.82 - 0.3 * self.distress;
        let points = || contours.iter().flatten();
        let Some(&first) = points().next() else { return Vec::new() };
        let bounds = points().fold(Rect::from_points(first, first), |bounds, &p| bounds.union_pt(p));
        let cell = CELL * self.spacing;
        // The same lattice for all parts, so that a mark goes on from one into the next.
        let (x0, y0) = ((bounds.x0 / cell).floor() as i64, (bounds.y0 / cell).floor() as i64);
        let (x1, y1) = ((bounds.x1 / cell).ceil() as i64, (bounds.y1 / cell).ceil() as i64);
        let columns = (x1 - x0 + 1) as usize;
        let above: Vec<f64> = (y0..=y1)
            .flat_map(|y| (x0..=x1).map(move |x| (x, y)))
            .map(|(x, y)| self.noise(x as f64 * CELL / MARK, y as f64 * CELL / MARK) - height)
            .collect();
        let mut pieces = Vec::new();
        for row in 0..(y1 - y0) as usize {
            for column in 0..columns - 1 {
                let corner = |dx: usize, dy: usize| {
                    let at = Point::new((x0 + (column + dx) as i64) as f64, (y0 + (row + dy) as i64) as f64);
                    (Point::new(at.x * cell, at.y * cell), above[(row + dy) * columns + column + dx])
                };
                let corners = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
                pieces.extend(part_above(&corners));
            }
        }
        simplified(&pieces, false)
    }

    /// Smooth noise from 0 to 1: two octaves of values on a lattice.
    fn noise(&self, x: f64, y: f64) -> f64 {
        0.65 * self.octave(x, y, 0) + 0.35 * self.octave(2.3 * x, 2.3 * y, 1)
    }

    fn octave(&self, x: f64, y: f64, octave: u64) -> f64 {
        let (i, j) = (x.floor(), y.floor());
        let value = |di: i64, dj: i64| hash(self.seed ^ octave, i as i64 + di, j as i64 + dj);
        let smooth = |t: f64| t * t * (3.0 - 2.0 * t);
        let (u, v) = (smooth(x - i), smooth(y - j));
        let mix = |a: f64, b: f64, t: f64| a + t * (b - a);
        mix(mix(value(0, 0), value(1, 0), u), mix(value(0, 1), value(1, 1), u), v)
    }
}

/// Contours with round corners. What is thin gets a smaller radius, or it would be lost.
fn rounded(contours: Vec<Contour>, radius: f64) -> Vec<Contour> {
    const MOST_LOST: f64 = 0.04;
    const HALVINGS: i32 = 4;
    let before = area(&contours);
    let radii = (0..HALVINGS).map(|k| radius * 0.5f64.powi(k));
    let mut tried = radii.map(|radius| offset(&offset(&contours, -radius), radius));
    tried.find(|rounded| area(rounded) >= (1.0 - MOST_LOST) * before).unwrap_or(contours)
}

/// A number in [0, 1) for a place on the lattice (the finalizer of SplitMix64).
fn hash(seed: u64, x: i64, y: i64) -> f64 {
    let mut z = seed
        .wrapping_add((x as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15))
        .wrapping_add((y as u64).wrapping_mul(0xC2B2_AE3D_27D4_EB4F));
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^= z >> 31;
    (z >> 11) as f64 / (1u64 << 53) as f64
}

/// The part of a cell where a value, known at the corners, is above 0.
fn part_above(corners: &[(Point, f64); 4]) -> Option<Contour> {
    let mut contour = Vec::new();
    for k in 0..4 {
        let ((p, a), (q, b)) = (corners[k], corners[(k + 1) % 4]);
        if a > 0.0 {
            contour.push(p);
        }
        if (a > 0.0) != (b > 0.0) {
            contour.push(p.lerp(q, a / (a - b)));
        }
    }
    (contour.len() > 2).then_some(contour)
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::{Affine, Shape};
    use rinceau_format::Style;

    fn finished(rounding: f64, distress: f64, seed: u64) -> Part {
        let path = Rect::new(0.0, 0.0, 300.0, 200.0).to_path(1e-3);
        let part = Part { path, transform: Affine::IDENTITY, style: Style::filled("black") };
        let finish = Finish { rounding, distress, seed, spacing: 40.0, tolerance: 0.05 };
        finish.part(part).unwrap()
    }

    fn ink(part: &Part) -> f64 {
        let flat: Vec<Contour> = flatten(&part.path, 0.01).into_iter().map(|s| s.points).collect();
        area(&simplified(&flat, false))
    }

    #[test]
    fn corners_are_rounded_and_nothing_else() {
        let part = finished(10.0, 0.0, 1);
        let lost = 4.0 * (1.0 - std::f64::consts::FRAC_PI_4) * 100.0;
        assert!((ink(&part) - (60_000.0 - lost)).abs() < 20.0, "{}", ink(&part));
    }

    #[test]
    fn wear_takes_away_more_the_more_there_is_and_the_same_for_a_seed() {
        let shares: Vec<f64> = [0.2, 0.6, 1.0].map(|d| ink(&finished(0.0, d, 3)) / 60_000.0).into();
        assert!(shares[0] > shares[1] && shares[1] > shares[2], "{shares:?}");
        assert!(shares[0] > 0.9 && shares[2] > 0.35 && shares[2] < 0.75, "{shares:?}");
        assert_eq!(finished(0.0, 0.6, 3).path, finished(0.0, 0.6, 3).path);
        assert_ne!(finished(0.0, 0.6, 3).path, finished(0.0, 0.6, 4).path);
    }
}
