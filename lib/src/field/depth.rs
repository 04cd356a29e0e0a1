//! How far places are from the edge of a region.

use crate::field::near::NearMap;
use crate::geom::distance::{covered, passed, squared_distances};
use crate::geom::region::Region;
use kurbo::Point;

/// Distances to the edge of a region, on a grid: most places are far from it, and nothing has to be looked up
/// exactly there.
pub(super) struct Depth {
    origin: Point,
    cell: f64,
    columns: usize,
    rows: usize,
    inside: Vec<bool>,
    /// From the middle of each cell to the nearest cell that the edge passes, in units.
    distance: Vec<f32>,
}

impl Depth {
    /// The distances of a region whose lines are `spacing` apart.
    pub fn new(region: &Region, spacing: f64) -> Self {
        const MOST_CELLS: f64 = 2e6;
        let bounds = region.bounds();
        let cell = (spacing / 3.0).max((bounds.area() / MOST_CELLS).sqrt()).max(f64::MIN_POSITIVE);
        let count = |side: f64| ((side / cell) as usize + 1).min(MOST_CELLS as usize);
        let (columns, rows) = (count(bounds.width()), count(bounds.height()));
        let origin = bounds.origin();
        let passed = passed(region.contours(), origin, cell, columns, rows);
        let distance =
            squared_distances(&passed, columns).into_iter().map(|squared| (squared.sqrt() * cell) as f32);
        let inside = covered(region.contours(), origin, cell, columns, rows);
        Depth { origin, cell, columns, rows, inside, distance: distance.collect() }
    }

    fn index(&self, p: Point) -> Option<usize> {
        let (x, y) = ((p.x - self.origin.x) / self.cell, (p.y - self.origin.y) / self.cell);
        let known = x >= 0.0 && y >= 0.0 && (x as usize) < self.columns && (y as usize) < self.rows;
        known.then(|| y as usize * self.columns + x as usize)
    }

    /// Whether a place is inside, if it is sure to be at least this far from the edge.
    pub fn surely_inside(&self, p: Point, far: f64) -> Option<bool> {
        let i = self.index(p)?;
        self.is_surely_far(i, far).then(|| self.inside[i])
    }

    /// Whether all of a cell is sure to be at least this far from the edge.
    fn is_surely_far(&self, i: usize, far: f64) -> bool {
        // A side may cut a corner between two of its samples; both ends are up to half a diagonal from the
        // middles of their cells.
        f64::from(self.distance[i]) > far + 2.5 * self.cell
    }

    /// A map of what is nearer than a `radius`, where only places that are surely inside and `far` from the edge
    /// are clear.
    pub fn near_map(&self, far: f64, radius: f64) -> NearMap {
        let clear: Vec<bool> =
            (0..self.inside.len()).map(|i| self.inside[i] && self.is_surely_far(i, far)).collect();
        NearMap::new(self.origin, self.cell, &clear, self.columns, radius)
    }

    /// Distance to the edge, to within two cells.
    pub fn distance(&self, p: Point) -> f64 {
        self.index(p).map_or(0.0, |i| f64::from(self.distance[i]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Rng;

    #[test]
    fn what_is_sure_is_true() {
        let star: Vec<Point> = (0..24)
            .map(|k| {
                let (angle, radius) =
                    (f64::from(k) / 24.0 * std::f64::consts::TAU, if k % 2 == 0 { 50.0 } else { 31.0 });
                Point::new(radius * angle.cos(), radius * angle.sin())
            })
            .collect();
        let hole = [(-9.0, -7.0), (8.0, -6.0), (3.0, 9.0)].map(Point::from).to_vec();
        let region = Region::new(vec![star, hole]).unwrap();
        let depth = Depth::new(&region, 6.0);
        let (mut rng, mut sure) = (Rng::new(1), 0);
        for _ in 0..20_000 {
            let p = Point::new(rng.between(-60.0, 60.0), rng.between(-60.0, 60.0));
            let Some(inside) = depth.surely_inside(p, 2.0) else { continue };
            sure += 1;
            assert_eq!(inside, region.contains(p), "{p:?}");
            assert!(region.distance(p, 100.0) > 2.0, "{p:?}");
            assert!((region.distance(p, 100.0) - depth.distance(p)).abs() < 4.0, "{p:?}");
        }
        assert!(sure > 4_000, "{sure}");
    }
}
