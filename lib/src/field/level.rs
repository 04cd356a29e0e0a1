//! The grid on which a direction field is solved, coarse to fine.
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

/// One resolution.
#[derive(Clone, Debug)]
pub(super) struct Level {
    pub columns: usize,
    pub rows: usize,
    /// exp(2 i θ), of a length that tells how even the field is around.
    pub z: Vec<Vec2>,
    /// Sum of guide directions and of weights; zero weight is a free cell.
    guide: Vec<(Vec2, f64)>,
    pub inside: Vec<bool>,
}

impl Level {
    pub fn new(region: &Region, bounds: Rect, cell: f64) -> Self {
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
    pub fn constrain(&mut self, guide: &[Point], origin: Point, cell: f64) -> bool {
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

    pub fn solve(&mut self) {
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

    /// Normalizes, and carries directions two rings beyond the boundary.
    pub fn extrapolate(&mut self) {
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
