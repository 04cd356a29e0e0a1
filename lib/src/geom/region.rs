//! A region to fill: simple contours with fast questions about inside and distance.

use crate::geom::boolean::{self, Contour};
use crate::geom::polyline;
use crate::geom::segment::SegmentGrid;
use kurbo::{Point, Rect, Vec2};

/// An area bounded by simple contours: outer ones and holes.
#[derive(Clone, Debug)]
pub struct Region {
    contours: Vec<Contour>,
    bounds: Rect,
    edges: SegmentGrid,
    /// Crossings of the contours with horizontal lines, for the inside test: per band of
    /// height `band`, the edges that touch it.
    bands: Vec<Vec<(Point, Point)>>,
    band: f64,
}

impl Region {
    /// A region from simple contours (see [`boolean::simplified`]); `None` if they are empty.
    pub fn new(contours: Vec<Contour>) -> Option<Self> {
        let mut points = contours.iter().flatten();
        let first = *points.next()?;
        let bounds = points.fold(Rect::from_points(first, first), |bounds, &p| bounds.union_pt(p));
        let count: usize = contours.iter().map(Vec::len).sum();
        // About one edge per cell along the boundary.
        let cell = (bounds.width().max(bounds.height()) / (count as f64).sqrt().clamp(8.0, 512.0))
            .max(f64::MIN_POSITIVE);
        let mut edges = SegmentGrid::new(bounds, cell);
        let rows = (count / 2).clamp(1, 1024);
        let band = (bounds.height() / rows as f64).max(f64::MIN_POSITIVE);
        let mut bands = vec![Vec::new(); rows];
        for contour in &contours {
            edges.insert_contour(contour, 0);
            let mut previous = contour[contour.len() - 1];
            for &p in contour {
                let row = |y: f64| (((y - bounds.y0) / band) as usize).min(rows - 1);
                for touched in &mut bands[row(previous.y.min(p.y))..=row(previous.y.max(p.y))] {
                    touched.push((previous, p));
                }
                previous = p;
            }
        }
        Some(Region { contours, bounds, edges, bands, band })
    }

    /// The contours.
    pub fn contours(&self) -> &[Contour] {
        &self.contours
    }

    /// The bounding box.
    pub fn bounds(&self) -> Rect {
        self.bounds
    }

    /// The area.
    pub fn area(&self) -> f64 {
        boolean::area(&self.contours)
    }

    /// True inside (even-odd).
    pub fn contains(&self, p: Point) -> bool {
        if !self.bounds.contains(p) {
            return false;
        }
        let row = (((p.y - self.bounds.y0) / self.band) as usize).min(self.bands.len() - 1);
        let mut inside = false;
        for &(a, b) in &self.bands[row] {
            if (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) {
                inside = !inside;
            }
        }
        inside
    }

    /// Distance to the boundary, `reach` at most.
    pub fn distance(&self, p: Point, reach: f64) -> f64 {
        self.edges.distance(p, reach)
    }

    /// True if the circle around all of these points, and `margin` around it, lies inside: a quick test, which
    /// may say no where the points themselves are deep enough.
    pub fn holds_circle(&self, points: impl Iterator<Item = Point> + Clone, margin: f64) -> bool {
        let Some(middle) = polyline::bounds(points.clone()).map(|bounds| bounds.center()) else {
            return true;
        };
        let radius = points.map(|p| p.distance(middle)).fold(0.0, f64::max) + margin;
        self.contains(middle) && self.distance(middle, radius) >= radius
    }

    /// How far a ray runs before it meets the boundary, `reach` at most.
    pub fn ray(&self, at: Point, along: Vec2, reach: f64) -> f64 {
        self.edges.ray(at, along, reach)
    }

    /// The largest circle in it, to a hundredth of its size: middle and radius.
    pub fn largest_circle(&self) -> (Point, f64) {
        const STEPS: i32 = 40;
        let reach = self.bounds.size().max_side();
        let room = |at: Point| if self.contains(at) { self.distance(at, reach) } else { 0.0 };
        let mut best = (self.bounds.center(), room(self.bounds.center()));
        let mut around = self.bounds;
        // On a grid, and on a finer one about the best of it.
        for _ in 0..3 {
            for (i, j) in (0..STEPS).flat_map(|i| (0..STEPS).map(move |j| (i, j))) {
                let share = |k: i32| (f64::from(k) + 0.5) / f64::from(STEPS);
                let at = around.origin() + Vec2::new(share(i) * around.width(), share(j) * around.height());
                let here = room(at);
                if here > best.1 {
                    best = (at, here);
                }
            }
            let side = 3.0 / f64::from(STEPS);
            around = Rect::from_center_size(best.0, (side * around.width(), side * around.height()));
        }
        best
    }

    /// The boundary's edges.
    pub fn edges(&self) -> &SegmentGrid {
        &self.edges
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_circle_touches_the_outline() {
        let triangle = [(0.0, 0.0), (30.0, 0.0), (0.0, 40.0)].map(Point::from).to_vec();
        let (centre, radius) = Region::new(vec![triangle]).unwrap().largest_circle();
        let is_there = centre.distance(Point::new(10.0, 10.0)) < 0.2;
        assert!((radius - 10.0).abs() < 0.1 && is_there, "{centre} {radius}");
    }

    #[test]
    fn inside_distance_and_ray_know_holes() {
        let square = |x: f64, side: f64| {
            [(x, x), (x + side, x), (x + side, x + side), (x, x + side)].map(Point::from).to_vec()
        };
        let region = Region::new(vec![square(0.0, 10.0), square(4.0, 2.0)]).unwrap();
        assert!(region.contains(Point::new(2.0, 5.0)));
        assert!(!region.contains(Point::new(5.0, 5.0)));
        assert!(!region.contains(Point::new(11.0, 5.0)));
        assert!((region.distance(Point::new(3.0, 5.0), 100.0) - 1.0).abs() < 1e-12);
        assert!((region.ray(Point::new(1.0, 5.0), Vec2::new(1.0, 0.0), 100.0) - 3.0).abs() < 1e-12);
    }
}
