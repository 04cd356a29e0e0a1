//! Centripetal Catmull-Rom splines (Catmull and Rom 1974; Yuksel, Schaefer, Keyser 2011): smooth
//! curves through points, without cusps or loops within a segment.

use kurbo::{CubicBez, Point, Vec2};

/// The cubics through points, one between each two. Equal neighbours count once; fewer than two
/// points give none.
pub fn through(points: &[Point], closed: bool) -> Vec<CubicBez> {
    let mut points = points.to_vec();
    points.dedup();
    if closed && points.len() > 2 && points.first() == points.last() {
        points.pop();
    }
    let n = points.len();
    if n < 2 {
        return Vec::new();
    }
    let at = |i: isize| -> Point {
        let last = n as isize - 1;
        if closed && n > 2 {
            points[i.rem_euclid(n as isize) as usize]
        } else if i < 0 {
            // Beyond the ends the curve goes on as it bends: a mirrored point.
            points[0] + (points[0] - points[1])
        } else if i > last {
            points[n - 1] + (points[n - 1] - points[n - 2])
        } else {
            points[i as usize]
        }
    };
    let pieces = if closed && n > 2 { n } else { n - 1 };
    (0..pieces as isize).map(|i| piece(at(i - 1), at(i), at(i + 1), at(i + 2))).collect()
}

/// The cubic from `b` to `c`.
fn piece(a: Point, b: Point, c: Point, d: Point) -> CubicBez {
    let knot = |p: Point, q: Point| p.distance(q).sqrt().max(f64::MIN_POSITIVE);
    let (t0, t1, t2) = (knot(a, b), knot(b, c), knot(c, d));
    let tangent = |before: Vec2, after: Vec2, t0: f64, t1: f64| {
        // The derivative of the parabola through three points, by the middle one.
        let mean: Vec2 = before / t0 * (t1 / (t0 + t1)) + after / t1 * (t0 / (t0 + t1));
        mean
    };
    let start = t1 * tangent(b - a, c - b, t0, t1);
    let end = t1 * tangent(c - b, d - c, t1, t2);
    CubicBez::new(b, b + start / 3.0, c - end / 3.0, c)
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::{ParamCurve, ParamCurveDeriv};

    #[test]
    fn pieces_meet_smoothly_at_the_points() {
        let points = [(0.0, 0.0), (10.0, 4.0), (12.0, 30.0), (40.0, 31.0)].map(Point::from);
        let pieces = through(&points, false);
        assert_eq!(pieces.len(), 3);
        for (i, pair) in pieces.windows(2).enumerate() {
            assert_eq!(pair[0].p3, points[i + 1]);
            let (a, b) = (pair[0].deriv().eval(1.0).to_vec2(), pair[1].deriv().eval(0.0).to_vec2());
            assert!(a.normalize().cross(b.normalize()).abs() < 1e-12 && a.dot(b) > 0.0);
        }
        assert_eq!(through(&points, true).len(), 4);
        assert!(through(&points[..1], false).is_empty());
    }

    #[test]
    fn points_on_a_line_give_the_line() {
        let points = [(0.0, 0.0), (1.0, 0.0), (10.0, 0.0)].map(Point::from);
        for piece in through(&points, false) {
            assert!(piece.eval(0.3).y.abs() < 1e-12 && piece.p1.x >= piece.p0.x && piece.p2.x <= piece.p3.x);
        }
    }
}
