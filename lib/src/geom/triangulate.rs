//! Delaunay triangulation; the only door to `spade`.

use kurbo::Point;
use spade::{DelaunayTriangulation, HasPosition, Point2, Triangulation};

/// A point that knows its index.
struct Indexed {
    at: Point2<f64>,
    index: usize,
}

impl HasPosition for Indexed {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.at
    }
}

/// The triangles of a Delaunay triangulation, each counter-clockwise in a frame with y upwards.
/// Points must be finite and differ from each other; of equal ones only one is in it. None if all
/// lie on a line.
pub fn delaunay(points: &[Point]) -> Vec<[usize; 3]> {
    let mut triangulation = DelaunayTriangulation::<Indexed>::new();
    for (index, p) in points.iter().enumerate() {
        // Refused are only numbers beyond all measure.
        let _ = triangulation.insert(Indexed { at: Point2::new(p.x, p.y), index });
    }
    let corners = |face: spade::handles::FaceHandle<'_, spade::handles::InnerTag, _, _, _, _>| {
        face.vertices().map(|vertex: spade::handles::VertexHandle<'_, Indexed, _, _, _>| vertex.data().index)
    };
    let mut triangles: Vec<[usize; 3]> = triangulation.inner_faces().map(corners).collect();
    // Whatever the order inside, the same points give the same list.
    for triangle in &mut triangles {
        let least = (0..3).min_by_key(|&i| triangle[i]).unwrap_or(0);
        triangle.rotate_left(least);
    }
    triangles.sort_unstable();
    triangles
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_is_two_triangles_and_a_line_none() {
        let square = [(0.0, 0.0), (1.0, 0.0), (1.1, 1.0), (0.0, 1.0)].map(Point::from);
        let triangles = delaunay(&square);
        assert_eq!(triangles, [[0, 1, 3], [1, 2, 3]]);
        let line: Vec<Point> = (0..9).map(|i| Point::new(f64::from(i), 2.0 * f64::from(i))).collect();
        assert!(delaunay(&line).is_empty());
        assert!(delaunay(&[Point::ORIGIN]).is_empty() && delaunay(&[]).is_empty());
    }
}
