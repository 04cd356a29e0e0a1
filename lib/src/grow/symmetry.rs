//! Symmetric growth (checklist W-009, W-011, W-020 to W-023; method notes 12): what is placed is
//! placed with all its images at once, so that growth sees them and a tile has no seam.
//!
//! The wallpaper groups are given by their general positions in fractions of the lattice, as the
//! International Tables for Crystallography, volume A, list them.

use crate::geom::boolean::{self, Contour};
use kurbo::{Affine, Point, Rect, Vec2};
use rinceau_format::Error;
use std::f64::consts::TAU;

/// Images at most: each element is entered as often.
pub const MOST_IMAGES: usize = 4000;

/// How an ornament repeats.
#[derive(Clone, Copy, Debug)]
pub(super) enum Extent {
    /// Within its shape.
    Panel,
    /// To the left and to the right.
    Band,
    /// All over the plane.
    Plane,
}

/// The symmetries of a run.
#[derive(Clone, Debug)]
pub(super) struct Symmetry {
    pub extent: Extent,
    /// Without translations; the first changes nothing.
    cosets: Vec<Affine>,
    /// Lattice of translations: none, one or two.
    lattice: Vec<Vec2>,
    /// What the artist should know.
    pub note: Option<String>,
}

/// A general position: images of (x, y) as `a x + b y + c, d x + e y + f`.
type Position = [f64; 6];

const I: Position = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
/// Half-turn.
const R2: Position = [-1.0, 0.0, 0.0, 0.0, -1.0, 0.0];
/// Mirrors of x and of y.
const MX: Position = [-1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
const MY: Position = [1.0, 0.0, 0.0, 0.0, -1.0, 0.0];
/// Quarter turns.
const R4: Position = [0.0, -1.0, 0.0, 1.0, 0.0, 0.0];
const R4B: Position = [0.0, 1.0, 0.0, -1.0, 0.0, 0.0];
/// Mirrors of the diagonals.
const D1: Position = [0.0, 1.0, 0.0, 1.0, 0.0, 0.0];
const D2: Position = [0.0, -1.0, 0.0, -1.0, 0.0, 0.0];
/// Thirds of a turn, on axes of 120 degrees.
const R3: Position = [0.0, -1.0, 0.0, 1.0, -1.0, 0.0];
const R3B: Position = [-1.0, 1.0, 0.0, -1.0, 0.0, 0.0];
/// Sixths.
const R6: Position = [0.0, 1.0, 0.0, -1.0, 1.0, 0.0];
const R6B: Position = [1.0, -1.0, 0.0, 1.0, 0.0, 0.0];
/// The mirrors of p3m1, and those of p31m.
const H1: [Position; 3] =
    [[0.0, -1.0, 0.0, -1.0, 0.0, 0.0], [-1.0, 1.0, 0.0, 0.0, 1.0, 0.0], [1.0, 0.0, 0.0, 1.0, -1.0, 0.0]];
const H2: [Position; 3] =
    [[0.0, 1.0, 0.0, 1.0, 0.0, 0.0], [1.0, -1.0, 0.0, 0.0, -1.0, 0.0], [-1.0, 0.0, 0.0, -1.0, 1.0, 0.0]];

fn shifted(p: Position, x: f64, y: f64) -> Position {
    [p[0], p[1], p[2] + x, p[3], p[4], p[5] + y]
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Lattice {
    Rectangle,
    Square,
    Hexagon,
}

fn wallpaper(name: &str) -> Option<(Lattice, Vec<Position>)> {
    use Lattice::{Hexagon, Rectangle, Square};
    let half = 0.5;
    let centred = |ops: &[Position]| -> Vec<Position> {
        ops.iter().flat_map(|&op| [op, shifted(op, half, half)]).collect()
    };
    Some(match name {
        "p1" => (Rectangle, vec![I]),
        "p2" => (Rectangle, vec![I, R2]),
        "pm" => (Rectangle, vec![I, MX]),
        "pg" => (Rectangle, vec![I, shifted(MX, 0.0, half)]),
        "cm" => (Rectangle, centred(&[I, MX])),
        "pmm" => (Rectangle, vec![I, R2, MX, MY]),
        "pmg" => (Rectangle, vec![I, R2, shifted(MX, half, 0.0), shifted(MY, half, 0.0)]),
        "pgg" => (Rectangle, vec![I, R2, shifted(MX, half, half), shifted(MY, half, half)]),
        "cmm" => (Rectangle, centred(&[I, R2, MX, MY])),
        "p4" => (Square, vec![I, R2, R4, R4B]),
        "p4m" => (Square, vec![I, R2, R4, R4B, MX, MY, D1, D2]),
        "p4g" => {
            let mirrors = [MX, MY, D1, D2].map(|op| shifted(op, half, half));
            (Square, [vec![I, R2, R4, R4B], mirrors.to_vec()].concat())
        }
        "p3" => (Hexagon, vec![I, R3, R3B]),
        "p3m1" => (Hexagon, [vec![I, R3, R3B], H1.to_vec()].concat()),
        "p31m" => (Hexagon, [vec![I, R3, R3B], H2.to_vec()].concat()),
        "p6" => (Hexagon, vec![I, R3, R3B, R2, R6, R6B]),
        "p6m" => (Hexagon, [vec![I, R3, R3B, R2, R6, R6B], H1.to_vec(), H2.to_vec()].concat()),
        _ => return None,
    })
}

/// Friezes in fractions of the period and of the height, about the middle.
fn frieze(name: &str) -> Option<Vec<Position>> {
    let half = 0.5;
    Some(match name {
        "p111" => vec![I],
        "p1a1" => vec![I, shifted(MY, half, 0.0)],
        "p1m1" => vec![I, MY],
        "pm11" => vec![I, MX],
        "p112" => vec![I, R2],
        "pma2" => vec![I, R2, shifted(MX, half, 0.0), shifted(MY, half, 0.0)],
        "pmm2" => vec![I, R2, MX, MY],
        _ => return None,
    })
}

fn rosette(name: &str) -> Option<Vec<Affine>> {
    if name == "mirror" {
        return Some(vec![Affine::IDENTITY, Affine::scale_non_uniform(-1.0, 1.0)]);
    }
    let (is_mirrored, count) = match (name.strip_prefix('c'), name.strip_prefix('d')) {
        (Some(count), _) => (false, count.parse::<usize>().ok()?),
        (_, Some(count)) => (true, count.parse::<usize>().ok()?),
        _ => return None,
    };
    // Starting upright, so that a mirror stands on the middle of the shape.
    let turns = (0..count).map(|k| Affine::rotate(TAU * k as f64 / count as f64));
    let mirror = Affine::scale_non_uniform(-1.0, 1.0);
    Some(turns.flat_map(|turn| if is_mirrored { vec![turn, turn * mirror] } else { vec![turn] }).collect())
}

impl Symmetry {
    /// The symmetry of this name in a box, which a band or wallpaper fills so many times over.
    pub fn new(name: &str, bounds: Rect, repeats: usize) -> Self {
        let to_center = Affine::translate(bounds.center().to_vec2());
        let about = |map: Affine| to_center * map * to_center.inverse();
        let period = bounds.width() / repeats.max(1) as f64;
        let fraction = |a: Vec2, b: Vec2, op: Position| {
            let basis = Affine::new([a.x, a.y, b.x, b.y, 0.0, 0.0]);
            let op = Affine::new([op[0], op[3], op[1], op[4], op[2], op[5]]);
            about(basis * op * basis.inverse())
        };
        if let Some(ops) = frieze(name) {
            let (a, b) = (Vec2::new(period, 0.0), Vec2::new(0.0, bounds.height()));
            let cosets = ops.into_iter().map(|op| fraction(a, b, op)).collect();
            return Symmetry { extent: Extent::Band, cosets, lattice: vec![a], note: None };
        }
        if let Some((kind, ops)) = wallpaper(name) {
            let rows = (bounds.height() / period).round().max(1.0);
            let (a, b, tall) = match kind {
                Lattice::Rectangle => {
                    let tall = bounds.height() / rows;
                    (Vec2::new(period, 0.0), Vec2::new(0.0, tall), tall)
                }
                Lattice::Square => (Vec2::new(period, 0.0), Vec2::new(0.0, period), period),
                Lattice::Hexagon => {
                    let tall = period * 0.75_f64.sqrt();
                    (Vec2::new(period, 0.0), Vec2::new(-0.5 * period, tall), 2.0 * tall)
                }
            };
            let fits = bounds.height() / tall;
            let whole = fits.round().max(1.0);
            let note = ((fits - whole).abs() > 1e-3).then(|| {
                format!(
                    "The wallpaper {name} repeats upright after {:.4} times the width of the shape: to tile without a seam, make the shape {:.4} times as tall as it is wide",
                    tall / bounds.width(),
                    whole * tall / bounds.width()
                )
            });
            let cosets = ops.into_iter().map(|op| fraction(a, b, op)).collect();
            return Symmetry { extent: Extent::Plane, cosets, lattice: vec![a, b], note };
        }
        let cosets =
            rosette(name).map_or(vec![Affine::IDENTITY], |maps| maps.into_iter().map(about).collect());
        Symmetry { extent: Extent::Panel, cosets, lattice: Vec::new(), note: None }
    }

    /// A mirror along the diagonal of a square, from its upper left corner.
    pub fn diagonal(square: Rect) -> Self {
        let to_center = Affine::translate(square.center().to_vec2());
        let mirror = to_center * Affine::new([0.0, 1.0, 1.0, 0.0, 0.0, 0.0]) * to_center.inverse();
        let cosets = vec![Affine::IDENTITY, mirror];
        Symmetry { extent: Extent::Panel, cosets, lattice: Vec::new(), note: None }
    }

    /// The symmetries that are no translations; the first changes nothing.
    pub fn cosets(&self) -> &[Affine] {
        &self.cosets
    }

    /// A shape with the symmetries that are no translations: what of it all images share.
    pub fn shared(&self, shape: &[Contour]) -> Vec<Contour> {
        let mut shared = shape.to_vec();
        for &coset in &self.cosets[1..] {
            let moved: Vec<Contour> =
                shape.iter().map(|contour| contour.iter().map(|&p| coset * p).collect()).collect();
            shared = boolean::intersection(&shared, &boolean::simplified(&moved, true));
        }
        shared
    }

    /// The maps that bring something in the box, or near it, into the box or near it; the identity
    /// first.
    ///
    /// Errors: there are too many.
    pub fn images(&self, bounds: Rect) -> Result<Vec<Affine>, Error> {
        let around = bounds.inflate(0.25 * bounds.width(), 0.25 * bounds.height());
        let mut images = Vec::new();
        let reach = |v: Vec2| {
            // So many steps of a lattice vector cross the box and what is around it.
            let size = around.size().to_vec2().hypot();
            (2.0 * size / v.hypot().max(1e-9)).ceil().min(1e4) as i64
        };
        let (n, m) = match self.lattice[..] {
            [] => (0, 0),
            [a] => (reach(a), 0),
            [a, b, ..] => (reach(a), reach(b)),
        };
        if self.cosets.len() as i64 * (2 * n + 1) * (2 * m + 1) > 100 * MOST_IMAGES as i64 {
            return Err(too_many());
        }
        for &coset in &self.cosets {
            for (i, j) in (-n..=n).flat_map(|i| (-m..=m).map(move |j| (i, j))) {
                let by = self.lattice.first().map_or(Vec2::ZERO, |&a| i as f64 * a)
                    + self.lattice.get(1).map_or(Vec2::ZERO, |&b| j as f64 * b);
                let image = Affine::translate(by) * coset;
                let moved = image.transform_rect_bbox(around);
                if self.lattice.is_empty() || moved.overlaps(around) {
                    images.push(image);
                }
            }
        }
        let is_identity = |image: &Affine| {
            let far = *image * Point::new(1.0, 0.0) - Point::new(1.0, 0.0);
            image.translation().hypot() < 1e-9 * around.width()
                && far.hypot() < 1e-9 * around.width()
                && image.determinant() > 0.0
        };
        images.retain(|image| !is_identity(image));
        images.insert(0, Affine::IDENTITY);
        if images.len() > MOST_IMAGES { Err(too_many()) } else { Ok(images) }
    }
}

fn too_many() -> Error {
    Error::new(
        "too-many-images",
        format!("The symmetry has more than {MOST_IMAGES} images in the shape"),
        "Let it repeat less often",
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grow::params::SYMMETRIES;

    fn is_near(a: Affine, b: Affine) -> bool {
        a.as_coeffs().iter().zip(b.as_coeffs()).all(|(a, b)| (a - b).abs() < 1e-6)
    }

    /// The product of any two cosets is a coset, but for a translation of the lattice.
    #[test]
    fn every_symmetry_is_a_group() {
        let bounds = Rect::new(3.0, 4.0, 63.0, 64.0);
        for (name, _) in SYMMETRIES {
            let symmetry = Symmetry::new(name, bounds, 1);
            let is_lattice = |v: Vec2| match symmetry.lattice[..] {
                [] => v.hypot() < 1e-6,
                [a] => (v.x / a.x - (v.x / a.x).round()).abs() < 1e-6 && v.y.abs() < 1e-6,
                [a, b, ..] => {
                    let det = a.cross(b);
                    let (s, t) = (v.cross(b) / det, a.cross(v) / det);
                    (s - s.round()).abs() < 1e-6 && (t - t.round()).abs() < 1e-6
                }
            };
            for &a in &symmetry.cosets {
                for &b in &symmetry.cosets {
                    let product = a * b;
                    let is_known = symmetry.cosets.iter().any(|&c| {
                        let linear = |m: Affine| {
                            Affine::new([
                                m.as_coeffs()[0],
                                m.as_coeffs()[1],
                                m.as_coeffs()[2],
                                m.as_coeffs()[3],
                                0.0,
                                0.0,
                            ])
                        };
                        is_near(linear(product), linear(c))
                            && is_lattice(product.translation() - c.translation())
                    });
                    assert!(is_known, "{name}");
                }
            }
        }
    }

    #[test]
    fn groups_have_as_many_cosets_as_they_should() {
        let bounds = Rect::new(0.0, 0.0, 60.0, 60.0);
        for (name, count) in [
            ("none", 1),
            ("d6", 12),
            ("c5", 5),
            ("p6m", 12),
            ("p4g", 8),
            ("cmm", 8),
            ("pma2", 4),
            ("p31m", 6),
        ] {
            assert_eq!(Symmetry::new(name, bounds, 1).cosets.len(), count, "{name}");
        }
    }
}
