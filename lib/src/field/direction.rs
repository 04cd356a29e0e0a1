//! A direction field from guides (Palacios and Zhang 2007, *Rotational symmetry field design
//! on surfaces*; FLOWPAK 4.3, checklist F-030).
//!
//! A direction θ is kept as `z = exp(2 i θ)`: both senses of a line give the same z, so
//! directions add and interpolate like vectors. FLOWPAK does not state the N of its N-RoSy
//! field (erratum Q-6); N = 2 lets two guides drawn in opposite senses on two sides of a
//! shape agree, where N = 1 would put a seam of singularities between them.
//!
//! On the cells inside the region z minimizes `Σ |z_a - z_b|² + Σ w |z_a - guide_a|²`, with
//! no link across the boundary: the flow of one leg does not feel the other's. It is solved
//! coarse to fine by successive over-relaxation, which at the sizes of a preview is several
//! times faster than a factorization.

use crate::geom::region::Region;
use kurbo::{Point, Rect, Vec2};

/// Weight of a guide's direction against the smoothness of one link: practically exact.
const GUIDE_WEIGHT: f64 = 100.0;
/// Over-relaxation; 1 is Gauss and Seidel, 2 does not converge.
const OVER_RELAXATION: f64 = 1.7;
/// Sweeps at most on each level, and the change of z that counts as none.
const SWEEPS: usize = 120;
const STILL: f64 = 2e-4;
/// Cells along the longer side at most.
const MOST_CELLS: f64 = 512.0;

/// Directions on a grid over a region.
#[derive(Clone, Debug)]
pub struct DirectionField {
    level: Level,
    origin: Point,
    cell: f64,
    /// The middle of the first cell, and cells in a unit of length.
    first: Point,
    per_unit: f64,
    patches: Vec<Patch>,
    /// Patches of a row.
    columns: i32,
}

/// The directions between the middles of four cells that turn little against each other, all in one sense:
/// `v = [0] + [1] x + ([2] + [3] x) y`. That is within a fraction of a degree of what is bilinear in z, and no
/// root has to be taken for it. Not a number where they turn more.
type Patch = [Vec2; 4];

#[derive(Clone, Debug)]
struct Level {
    columns: usize,
    rows: usize,
    z: Vec<Vec2>,
    /// Sum of guide directions and of weights; zero weight is a free cell.
    guide: Vec<(Vec2, f64)>,
    inside: Vec<bool>,
}

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
            patches: level.patches(),
            columns: level.columns as i32 - 1,
            level,
            origin: bounds.origin(),
            cell,
            first: bounds.origin() + Vec2::new(0.5, 0.5) * cell,
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
        if !(x >= 0.0 && y >= 0.0 && column < self.columns) {
            return None;
        }
        let (x, y) = (x - f64::from(column), y - f64::from(row));
        let i = row as usize * self.columns as usize + column as usize;
        let patch = self.patches.get(i)?;
        let mut v = patch[0] + x * patch[1] + y * (patch[2] + x * patch[3]);
        if v.x.is_nan() {
            v = self.turning(row as usize, column as usize, x, y)?;
        }
        Some(v * 1f64.copysign(v.dot(towards)))
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
                    let middle = Vec2::new(column as f64 + 1.0, row as f64 + 1.0);
                    found.push((self.origin + self.cell * middle, index));
                }
            }
        }
        found
    }
}

/// The part of a segment inside a box (Liang and Barsky).
fn clipped(a: Point, b: Point, bounds: Rect) -> Option<(Point, Point)> {
    let d = b - a;
    let (mut from, mut to) = (0.0f64, 1.0f64);
    for (speed, low, high) in
        [(d.x, bounds.x0 - a.x, bounds.x1 - a.x), (d.y, bounds.y0 - a.y, bounds.y1 - a.y)]
    {
        if speed == 0.0 {
            if low > 0.0 || high < 0.0 {
                return None;
            }
        } else {
            let (enter, leave) = if speed > 0.0 { (low, high) } else { (high, low) };
            from = from.max(enter / speed);
            to = to.min(leave / speed);
        }
    }
    (from < to).then(|| (a + from * d, a + to * d))
}

/// exp(2 i θ) of a unit vector.
fn doubled(direction: Vec2) -> Vec2 {
    Vec2::new(direction.x * direction.x - direction.y * direction.y, 2.0 * direction.x * direction.y)
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

impl Level {
    fn new(region: &Region, bounds: Rect, cell: f64) -> Self {
        let columns = (bounds.width() / cell).ceil() as usize;
        let rows = (bounds.height() / cell).ceil() as usize;
        let mut inside = Vec::with_capacity(columns * rows);
        for row in 0..rows {
            for column in 0..columns {
                let centre = bounds.origin() + Vec2::new(column as f64 + 0.5, row as f64 + 0.5) * cell;
                inside.push(region.contains(centre));
            }
        }
        Level {
            columns,
            rows,
            z: vec![Vec2::ZERO; columns * rows],
            guide: vec![(Vec2::ZERO, 0.0); columns * rows],
            inside,
        }
    }

    /// Adds a guide's directions to the cells it passes. True if it passed any inside.
    fn constrain(&mut self, guide: &[Point], origin: Point, cell: f64) -> bool {
        let mut any = false;
        for pair in guide.windows(2) {
            let size = Vec2::new(self.columns as f64, self.rows as f64) * cell;
            let Some((start, end)) =
                clipped(pair[0], pair[1], Rect::from_origin_size(origin, size.to_size()))
            else {
                continue;
            };
            let along = end - start;
            let length = along.hypot();
            if length == 0.0 {
                continue;
            }
            let z = doubled(along / length);
            let steps = ((length / cell * 2.0).ceil() as usize).clamp(1, 4 * (self.columns + self.rows));
            for k in 0..steps {
                let p = start + along * ((k as f64 + 0.5) / steps as f64);
                let (x, y) = ((p.x - origin.x) / cell, (p.y - origin.y) / cell);
                if !(x >= 0.0 && y >= 0.0) || x as usize >= self.columns || y as usize >= self.rows {
                    continue;
                }
                if let Some(i) = self.inside_near(x as usize, y as usize) {
                    any = true;
                    let weight = length / steps as f64 / cell;
                    self.guide[i].0 += weight * z;
                    self.guide[i].1 += weight;
                }
            }
        }
        any
    }

    /// The cell at a place, or a neighbour that is inside: a guide drawn on the boundary
    /// itself passes as many cells outside as inside.
    fn inside_near(&self, column: usize, row: usize) -> Option<usize> {
        let cells = [(0i64, 0i64), (1, 0), (-1, 0), (0, 1), (0, -1)];
        cells.into_iter().find_map(|(dx, dy)| {
            let (c, r) = (usize::try_from(column as i64 + dx).ok()?, usize::try_from(row as i64 + dy).ok()?);
            let i = r * self.columns + c;
            (c < self.columns && r < self.rows && self.inside[i]).then_some(i)
        })
    }

    /// The level with half the resolution.
    fn coarser(&self) -> Level {
        let (columns, rows) = (self.columns.div_ceil(2), self.rows.div_ceil(2));
        let mut coarse = Level {
            columns,
            rows,
            z: vec![Vec2::ZERO; columns * rows],
            guide: vec![(Vec2::ZERO, 0.0); columns * rows],
            inside: vec![false; columns * rows],
        };
        for row in 0..self.rows {
            for column in 0..self.columns {
                let (i, j) = (row * self.columns + column, row / 2 * columns + column / 2);
                coarse.inside[j] |= self.inside[i];
                coarse.guide[j].0 += self.guide[i].0;
                coarse.guide[j].1 += self.guide[i].1;
            }
        }
        coarse
    }

    fn solve(&mut self) {
        const COARSEST: usize = 8;
        if self.columns.min(self.rows) > COARSEST {
            let mut coarse = self.coarser();
            coarse.solve();
            for row in 0..self.rows {
                for column in 0..self.columns {
                    self.z[row * self.columns + column] = coarse.z[row / 2 * coarse.columns + column / 2];
                }
            }
        }
        for _ in 0..SWEEPS {
            if self.sweep() < STILL {
                break;
            }
        }
    }

    /// One pass of over-relaxation; returns the largest change.
    fn sweep(&mut self) -> f64 {
        let mut largest = 0.0f64;
        for row in 0..self.rows {
            for column in 0..self.columns {
                let i = row * self.columns + column;
                if !self.inside[i] {
                    continue;
                }
                let (mut sum, mut weight) = (Vec2::ZERO, 0.0);
                let mut link = |j: usize| {
                    if self.inside[j] {
                        sum += self.z[j];
                        weight += 1.0;
                    }
                };
                if column > 0 {
                    link(i - 1)
                }
                if column + 1 < self.columns {
                    link(i + 1)
                }
                if row > 0 {
                    link(i - self.columns)
                }
                if row + 1 < self.rows {
                    link(i + self.columns)
                }
                let (guide, guide_weight) = self.guide[i];
                if guide_weight > 0.0 {
                    // Guides that contradict each other in one cell cancel, and the cell
                    // then follows its neighbours.
                    let mean = guide / guide_weight;
                    sum += GUIDE_WEIGHT * mean;
                    weight += GUIDE_WEIGHT * mean.hypot();
                }
                if weight > 0.0 {
                    let change = OVER_RELAXATION * (sum / weight - self.z[i]);
                    self.z[i] += change;
                    largest = largest.max(change.hypot2());
                }
            }
        }
        largest.sqrt()
    }

    /// What lies between the middles of each four cells.
    fn patches(&self) -> Vec<Patch> {
        let directions: Vec<Option<Vec2>> = self.z.iter().map(|&z| halved(z)).collect();
        let columns = self.columns;
        let patch = |i: usize| {
            let corners = [i, i + 1, i + columns, i + columns + 1];
            even(corners.map(|i| directions[i])).unwrap_or([Vec2::new(f64::NAN, f64::NAN); 4])
        };
        (0..self.rows - 1)
            .flat_map(|row| (0..columns - 1).map(move |column| row * columns + column))
            .map(patch)
            .collect()
    }

    /// Normalizes, and carries directions two rings beyond the boundary.
    fn extrapolate(&mut self) {
        for z in &mut self.z {
            let length = z.hypot();
            if length > 0.0 {
                // The magnitude only says how far a guide is; near a singularity it must
                // stay small, which it does relative to its neighbours after this root.
                *z /= length.max(1e-6);
            }
        }
        for _ in 0..2 {
            let known = self.inside.clone();
            for row in 0..self.rows {
                for column in 0..self.columns {
                    let i = row * self.columns + column;
                    if known[i] {
                        continue;
                    }
                    let mut sum = Vec2::ZERO;
                    for (r, c) in [(-1i64, 0i64), (1, 0), (0, -1), (0, 1), (-1, -1), (-1, 1), (1, -1), (1, 1)]
                    {
                        let (r, c) = (row as i64 + r, column as i64 + c);
                        if r >= 0 && c >= 0 && (r as usize) < self.rows && (c as usize) < self.columns {
                            let j = r as usize * self.columns + c as usize;
                            if known[j] {
                                sum += self.z[j];
                            }
                        }
                    }
                    if sum.hypot() > 0.0 {
                        self.z[i] = sum / sum.hypot();
                        self.inside[i] = true;
                    }
                }
            }
        }
    }
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
            let (row, column) = (i / field.columns as usize, i % field.columns as usize);
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
