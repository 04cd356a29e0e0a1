//! Where an outline crosses itself.

use crate::geom::boolean::Contour;
use crate::geom::flatten::flatten;
use crate::geom::segment::{SegmentGrid, crosses};
use kurbo::{BezPath, Point, Rect, Vec2};

/// Places where a closed contour properly crosses itself, `most` of them at most.
pub fn self_crossings(contour: &Contour, most: usize) -> Vec<Point> {
    /// With more sides, many of them may pass near one place, where a grid has all in one cell.
    const MANY: usize = 1000;
    let mut found = Vec::new();
    let Some(&first) = contour.first() else { return found };
    let bounds = contour.iter().fold(Rect::from_points(first, first), |bounds, &p| bounds.union_pt(p));
    if contour.len() > MANY {
        // A little larger, for what crosses on its far edges.
        let side = bounds.width().max(bounds.height()) * (1.0 + 1e-9);
        let sides: Vec<(Point, Point)> = (0..contour.len())
            .map(|i| (contour[(i + contour.len() - 1) % contour.len()], contour[i]))
            .collect();
        let all: Vec<u32> = (0..sides.len() as u32).collect();
        in_quarters(&sides, &all, (bounds.origin(), side, 0), &mut |at| {
            found.push(at);
            found.len() < most
        });
        return found;
    }
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

/// Visits the crossings of those of the sides that pass through a square, by quartering it until few are
/// left together. False if `visit` said so.
fn in_quarters(
    sides: &[(Point, Point)],
    here: &[u32],
    (origin, side, depth): (Point, f64, u32),
    visit: &mut dyn FnMut(Point) -> bool,
) -> bool {
    const FEW: usize = 24;
    // A square of this depth is smaller than what anyone sees; what meets there in one point may be much.
    const DEEPEST: u32 = 20;
    const MOST_TOGETHER: usize = 500;
    if here.len() <= FEW || depth == DEEPEST {
        let here = &here[..here.len().min(MOST_TOGETHER)];
        for (k, &i) in here.iter().enumerate() {
            let (a, b) = sides[i as usize];
            for &j in &here[..k] {
                let (p, q) = sides[j as usize];
                if crosses(a, b, p, q) {
                    let (along, other) = (b - a, q - p);
                    let at = a + along * ((p - a).cross(other) / along.cross(other));
                    // Each in one square only.
                    let from = at - origin;
                    let is_here = (0.0..side).contains(&from.x) && (0.0..side).contains(&from.y);
                    if is_here && !visit(at) {
                        return false;
                    }
                }
            }
        }
        return true;
    }
    let half = 0.5 * side;
    (0..4).all(|quarter| {
        let corner = origin + Vec2::new(f64::from(quarter % 2) * half, f64::from(quarter / 2) * half);
        let square = Rect::from_origin_size(corner, (half, half)).inflate(1e-9 * half, 1e-9 * half);
        let within: Vec<u32> = here.iter().copied().filter(|&i| passes(sides[i as usize], square)).collect();
        in_quarters(sides, &within, (corner, half, depth + 1), visit)
    })
}

/// True if a segment passes through a box.
fn passes((a, b): (Point, Point), square: Rect) -> bool {
    if a.x.max(b.x) < square.x0
        || a.x.min(b.x) > square.x1
        || a.y.max(b.y) < square.y0
        || a.y.min(b.y) > square.y1
    {
        return false;
    }
    // All four corners on one side of its line?
    let along = b - a;
    let side = |x: f64, y: f64| along.cross(Point::new(x, y) - a);
    let corners = [
        side(square.x0, square.y0),
        side(square.x1, square.y0),
        side(square.x1, square.y1),
        side(square.x0, square.y1),
    ];
    !(corners.iter().all(|&s| s > 0.0) || corners.iter().all(|&s| s < 0.0))
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

    /// A star of many thin rays, all of which pass near its middle.
    fn star(rays: usize) -> Contour {
        let at = |k: usize| {
            let (s, c) = (std::f64::consts::TAU * k as f64 / (2 * rays) as f64).sin_cos();
            let radius = if k.is_multiple_of(2) { 480.0 } else { 2.0 };
            Point::new(500.0 + radius * c, 500.0 + radius * s)
        };
        (0..2 * rays).map(at).collect()
    }

    #[test]
    fn one_crossing_among_many_sides_is_found() {
        let mut star = star(3000);
        assert!(self_crossings(&star, 9).is_empty());
        // One ray bends over its neighbour.
        star.swap(2000, 2002);
        let found = self_crossings(&star, 9);
        assert!(!found.is_empty() && found.len() < 9, "{found:?}");
        assert!(
            found.iter().all(|at| (at.distance(Point::new(500.0, 500.0)) - 240.0).abs() < 241.0),
            "{found:?}"
        );
    }

    #[test]
    fn a_line_wound_many_times_crosses_itself_everywhere() {
        // A pentagram drawn a thousand times, a little smaller each time.
        let at = |k: usize| {
            let (s, c) = (std::f64::consts::TAU * 2.0 * k as f64 / 5.0).sin_cos();
            let radius = 100.0 - 0.01 * k as f64;
            Point::new(radius * c, radius * s)
        };
        assert_eq!(self_crossings(&(0..5000).map(at).collect(), 64).len(), 64);
    }
}
