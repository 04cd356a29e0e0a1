//! A region to fill: simple contours with fast questions about inside and distance.

use crate::geom::boolean::{self, Contour};
use crate::geom::near::SegmentGrid;
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

    /// How far a ray runs before it meets the boundary, `reach` at most.
    pub fn ray(&self, at: Point, along: Vec2, reach: f64) -> f64 {
        self.edges.ray(at, along, reach)
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
