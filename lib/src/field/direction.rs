//! A direction field from guides (Palacios and Zhang 2007, *Rotational symmetry field design
//! on surfaces*; FLOWPAK 4.3, checklist F-030).
//!
//! A direction θ is kept as `z = exp(2 i θ)`: both senses of a line give the same z, so
//! directions add and interpolate like vectors. FLOWPAK does not state the N of its N-RoSy
//! field (erratum Q-6); N = 2 lets two guides drawn in opposite senses on two sides of a
//! shape agree, where N = 1 would put a seam of singularities between them.

use crate::field::level::Level;
use crate::geom::region::Region;
use kurbo::{Point, Vec2};

/// Cells along the longer side at most.
const MOST_CELLS: f64 = 512.0;

/// Directions on a grid over a region.
#[derive(Clone, Debug)]
pub struct DirectionField {
    level: Level,
    /// One patch fewer than cells in each row and column.
    patches: Vec<Patch>,
    /// The middle of the first cell.
    first: Point,
    cell: f64,
    /// Cells in a unit of length.
    per_unit: f64,
}

/// The directions between the middles of four cells that turn little against each other, all in one sense:
/// `v = [0] + [1] x + ([2] + [3] x) y`. That is within a fraction of a degree of what is bilinear in z, and no
/// root has to be taken for it. Not a number where they turn more.
type Patch = [Vec2; 4];

impl DirectionField {
    /// The field of a region. `guides` are polylines; parts outside the region are ignored.
    /// `None` if no guide has any length inside it.
    pub fn new(region: &Region, guides: &[Vec<Point>], cell: f64) -> Option<Self> {
        let bounds = region.bounds();
        let cell = cell.max(bounds.width().max(bounds.height()) / MOST_CELLS);
        // One ring of cells outside, so that interpolation near the boundary has neighbours.
        let bounds = bounds.inflate(1.5 * cell, 1.5 * cell);
        let mut level = Level::new(region, bounds, cell);
        let mut any = false;
        for guide in guides {
            any |= level.constrain(guide, bounds.origin(), cell);
        }
        if !any {
            return None;
        }
        level.solve();
        level.extrapolate();
        Some(DirectionField {
            patches: patches(&level),
            level,
            first: bounds.origin() + Vec2::new(0.5, 0.5) * cell,
            cell,
            per_unit: 1.0 / cell,
        })
    }

    /// The unit direction at a place, in the sense nearer to `towards`. `None` off the field
    /// or at a singularity.
    pub fn direction(&self, at: Point, towards: Vec2) -> Option<Vec2> {
        self.velocity(at, towards).map(|v| v / v.hypot())
    }

    /// As [`direction`](Self::direction), a little shorter where the directions around differ. What moves at this
    /// velocity runs along the same lines.
    #[inline]
    pub fn velocity(&self, at: Point, towards: Vec2) -> Option<Vec2> {
        let (x, y) = ((at.x - self.first.x) * self.per_unit, (at.y - self.first.y) * self.per_unit);
        // Signed and short: such casts cost least.
        let (column, row) = (x as i32, y as i32);
        if !(x >= 0.0 && y >= 0.0 && column < self.columns()) {
            return None;
        }
        let (x, y) = (x - f64::from(column), y - f64::from(row));
        let i = row as usize * self.columns() as usize + column as usize;
        let patch = self.patches.get(i)?;
        let mut v = patch[0] + x * patch[1] + y * (patch[2] + x * patch[3]);
        if v.x.is_nan() {
            v = self.turning(row as usize, column as usize, x, y)?;
        }
        Some(v * 1f64.copysign(v.dot(towards)))
    }

    /// Patches of a row.
    fn columns(&self) -> i32 {
        self.level.columns as i32 - 1
    }

    /// Bilinear in z, never in θ.
    #[cold]
    fn turning(&self, row: usize, column: usize, x: f64, y: f64) -> Option<Vec2> {
        let i = row * self.level.columns + column;
        let (z, below) = (&self.level.z, i + self.level.columns);
        halved((1.0 - y) * ((1.0 - x) * z[i] + x * z[i + 1]) + y * ((1.0 - x) * z[below] + x * z[below + 1]))
    }

    /// Where the field has no direction, with the index: how often a direction turns around on a way around the
    /// place, 1/2 or -1/2 for the simple ones.
    pub fn singularities(&self) -> Vec<(Point, f64)> {
        let (columns, z) = (self.level.columns, &self.level.z);
        let mut found = Vec::new();
        for row in 0..self.level.rows - 1 {
            for column in 0..columns - 1 {
                let i = row * columns + column;
                let around = [i, i + 1, i + columns + 1, i + columns];
                if !around.iter().all(|&j| self.level.inside[j]) {
                    continue;
                }
                let turned: f64 = (0..4)
                    .map(|k| {
                        let (a, b) = (z[around[k]], z[around[(k + 1) % 4]]);
                        libm::atan2(a.cross(b), a.dot(b))
                    })
                    .sum();
                // z turns twice as fast as the direction that it stands for.
                let index = (turned / std::f64::consts::TAU).round() / 2.0;
                if index != 0.0 {
                    let middle = Vec2::new(column as f64 + 0.5, row as f64 + 0.5);
                    found.push((self.first + self.cell * middle, index));
                }
            }
        }
        found
    }
}

/// What lies between the middles of each four cells.
fn patches(level: &Level) -> Vec<Patch> {
    let directions: Vec<Option<Vec2>> = level.z.iter().map(|&z| halved(z)).collect();
    let columns = level.columns;
    let patch = |i: usize| {
        let corners = [i, i + 1, i + columns, i + columns + 1];
        even(corners.map(|i| directions[i])).unwrap_or([Vec2::new(f64::NAN, f64::NAN); 4])
    };
    (0..level.rows - 1)
        .flat_map(|row| (0..columns - 1).map(move |column| row * columns + column))
        .map(patch)
        .collect()
}

/// The patch of four corners that turn little.
fn even(corners: [Option<Vec2>; 4]) -> Option<Patch> {
    // Fifteen degrees.
    const LITTLE: f64 = 0.966;
    let first = corners[0]?;
    let mut v = [first; 4];
    for (v, corner) in v.iter_mut().zip(corners) {
        let corner = corner?;
        *v = if corner.dot(first) < 0.0 { -corner } else { corner };
    }
    let turn_little = v.iter().all(|a| v.iter().all(|b| a.dot(*b) > LITTLE));
    turn_little.then(|| [v[0], v[1] - v[0], v[2] - v[0], v[3] - v[2] - (v[1] - v[0])])
}

/// The unit direction of `exp(2 i θ)`, of any length. `None` if that has none to speak of.
fn halved(z: Vec2) -> Option<Vec2> {
    let length = z.hypot();
    // Near a singularity the field has no direction worth following.
    const SINGULAR: f64 = 0.05;
    if length < SINGULAR {
        return None;
    }
    // The half angle by square roots: cos θ = sqrt((1 + cos 2θ) / 2).
    let (c, s) = (z.x / length, z.y / length);
    Some(if c >= 0.0 {
        let x = ((1.0 + c) / 2.0).sqrt();
        Vec2::new(x, s / (2.0 * x))
    } else {
        let y = ((1.0 - c) / 2.0).sqrt();
        Vec2::new(s / (2.0 * y), y)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> Region {
        Region::new(vec![[(0.0, 0.0), (100.0, 0.0), (100.0, 100.0), (0.0, 100.0)].map(Point::from).to_vec()])
            .unwrap()
    }

    #[test]
    fn opposite_guides_agree() {
        let guides = [
            vec![Point::new(0.0, 10.0), Point::new(100.0, 10.0)],
            vec![Point::new(100.0, 90.0), Point::new(0.0, 90.0)],
        ];
        let field = DirectionField::new(&square(), &guides, 2.0).unwrap();
        for y in [5.0, 30.0, 50.0, 95.0] {
            let d = field.direction(Point::new(50.0, y), Vec2::new(1.0, 0.0)).unwrap();
            assert!(d.x > 0.999, "{d:?}");
        }
    }

    #[test]
    fn directions_turn_evenly_between_guides() {
        let guides = [
            vec![Point::new(10.0, 0.0), Point::new(10.0, 100.0)],
            vec![Point::new(90.0, 50.0 - 40.0), Point::new(90.0 + 8.0, 50.0 - 40.0 + 8.0)],
        ];
        let field = DirectionField::new(&square(), &guides, 2.0).unwrap();
        assert!(field.direction(Point::new(12.0, 50.0), Vec2::new(0.0, 1.0)).unwrap().y > 0.99);
    }

    #[test]
    fn patches_agree_with_what_is_bilinear_in_z() {
        let guides = [
            vec![Point::new(10.0, 5.0), Point::new(40.0, 90.0)],
            vec![Point::new(95.0, 20.0), Point::new(50.0, 10.0)],
        ];
        let field = DirectionField::new(&square(), &guides, 4.0).unwrap();
        let mut even = 0;
        for (i, patch) in field.patches.iter().enumerate() {
            let (row, column) = (i / field.columns() as usize, i % field.columns() as usize);
            for (x, y) in [(0.0, 0.0), (0.3, 0.1), (0.5, 0.5), (0.8, 0.6), (1.0, 1.0)] {
                let Some(z) = field.turning(row, column, x, y) else { continue };
                let at = field.first + Vec2::new(column as f64 + x, row as f64 + y) * field.cell;
                let Some(direction) = field.direction(at - Vec2::new(1e-9, 1e-9), z) else { continue };
                even += usize::from(!patch[0].x.is_nan());
                assert!(direction.cross(z).abs() < 0.2f64.to_radians(), "{at:?} {direction:?} {z:?}");
            }
        }
        assert!(even > field.patches.len(), "{even}");
    }

    #[test]
    fn a_guide_far_longer_than_the_region_counts() {
        let guide = vec![Point::new(-1e8, -1e8), Point::new(1e8, 1e8)];
        let field = DirectionField::new(&square(), &[guide], 2.0).unwrap();
        let d = field.direction(Point::new(50.0, 50.0), Vec2::new(1.0, 0.0)).unwrap();
        assert!((d.x - d.y).abs() < 1e-3, "{d:?}");
    }

    #[test]
    fn singularities_are_found() {
        // Around a circle the flow turns once: one singularity of index 1, or two of 1/2.
        let circle: Vec<Point> = (0..=64)
            .map(|k| {
                let angle = f64::from(k) / 64.0 * std::f64::consts::TAU;
                Point::new(50.0 + 30.0 * angle.cos(), 50.0 + 30.0 * angle.sin())
            })
            .collect();
        let field = DirectionField::new(&square(), &[circle], 2.0).unwrap();
        let found = field.singularities();
        let inside = found.iter().filter(|(at, _)| at.distance(Point::new(50.0, 50.0)) < 25.0);
        assert_eq!(inside.map(|(_, index)| index).sum::<f64>(), 1.0, "{found:?}");
        let straight = vec![Point::new(0.0, 50.0), Point::new(100.0, 50.0)];
        assert_eq!(DirectionField::new(&square(), &[straight], 2.0).unwrap().singularities(), []);
    }

    #[test]
    fn a_guide_outside_gives_no_field() {
        assert!(
            DirectionField::new(&square(), &[vec![Point::new(200.0, 0.0), Point::new(300.0, 0.0)]], 2.0)
                .is_none()
        );
    }
}
