//! Where an outline crosses itself.

use crate::geom::boolean::Contour;
use crate::geom::flatten::flatten;
use crate::geom::segment::{SegmentGrid, crosses};
use kurbo::{BezPath, Point, Rect};

/// Places where a closed contour properly crosses itself, `most` of them at most.
pub fn self_crossings(contour: &Contour, most: usize) -> Vec<Point> {
    let mut found = Vec::new();
    let Some(&first) = contour.first() else { return found };
    let bounds = contour.iter().fold(Rect::from_points(first, first), |bounds, &p| bounds.union_pt(p));
    let cell = bounds.width().max(bounds.height()) / (contour.len() as f64).sqrt().max(4.0);
    let mut grid = SegmentGrid::new(bounds, cell);
    grid.insert_contour(contour, 0);
    let mut previous = contour[contour.len() - 1];
    for &p in contour {
        grid.visit(previous, p, 0.0, |a, b, _| {
            if crosses(previous, p, a, b) {
                found.push(a.midpoint(b));
            }
            found.len() < most
        });
        if found.len() >= most {
            break;
        }
        previous = p;
    }
    found
}

/// True if a subpath crosses itself.
pub fn any_crossing(paths: &[BezPath], tolerance: f64) -> bool {
    let mut subpaths = paths.iter().flat_map(|path| flatten(path, tolerance));
    subpaths.any(|subpath| subpath.closed && !self_crossings(&subpath.points, 1).is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bow_tie_crosses_and_a_square_does_not() {
        let contour = |points: [(f64, f64); 4]| points.map(Point::from).to_vec();
        assert!(!self_crossings(&contour([(0.0, 0.0), (9.0, 9.0), (9.0, 0.0), (0.0, 9.0)]), 1).is_empty());
        assert!(self_crossings(&contour([(0.0, 0.0), (9.0, 0.0), (9.0, 9.0), (0.0, 9.0)]), 1).is_empty());
        assert!(self_crossings(&Vec::new(), 1).is_empty());
    }
}
