//! Polylines by arc length.

use kurbo::{Point, Vec2};

/// Length of an open polyline.
pub fn length(points: &[Point]) -> f64 {
    points.windows(2).map(|pair| pair[0].distance(pair[1])).sum()
}

/// Points at equal steps of arc length, both ends included: `n + 1` points, `n >= 1`.
/// A polyline of one point is repeated.
pub fn resample(points: &[Point], n: usize) -> Vec<Point> {
    let (Some(&first), Some(&last)) = (points.first(), points.last()) else { return Vec::new() };
    let step = length(points) / n as f64;
    let mut out = Vec::with_capacity(n + 1);
    out.push(first);
    let (mut walked, mut i) = (0.0, 0);
    for k in 1..n {
        let target = step * k as f64;
        while i + 2 < points.len() && walked + points[i].distance(points[i + 1]) < target {
            walked += points[i].distance(points[i + 1]);
            i += 1;
        }
        let piece = points.get(i + 1).map_or(0.0, |next| points[i].distance(*next));
        let t = if piece > 0.0 { ((target - walked) / piece).clamp(0.0, 1.0) } else { 0.0 };
        out.push(points.get(i + 1).map_or(points[i], |next| points[i].lerp(*next, t)));
    }
    out.push(last);
    out
}

/// The part of a polyline between two arc lengths.
pub fn between(points: &[Point], from: f64, to: f64) -> Vec<Point> {
    let mut out: Vec<Point> = Vec::new();
    let mut walked = 0.0;
    for pair in points.windows(2) {
        let piece = pair[0].distance(pair[1]);
        if piece > 0.0 && walked + piece >= from && walked <= to {
            let (a, b) = (((from - walked) / piece).max(0.0), ((to - walked) / piece).min(1.0));
            if out.is_empty() {
                out.push(pair[0].lerp(pair[1], a));
            }
            out.push(pair[0].lerp(pair[1], b));
        }
        walked += piece;
    }
    out
}

/// Unit tangents by central differences; zero where points coincide.
pub fn tangents(points: &[Point], closed: bool) -> Vec<Vec2> {
    let n = points.len();
    (0..n)
        .map(|i| {
            let before = if i > 0 {
                points[i - 1]
            } else if closed {
                points[n - 1]
            } else {
                points[0]
            };
            let after = if i + 1 < n {
                points[i + 1]
            } else if closed {
                points[0]
            } else {
                points[n - 1]
            };
            let v = after - before;
            if v.hypot() > 0.0 { v.normalize() } else { Vec2::ZERO }
        })
        .collect()
}

/// A unit vector turned a quarter: the side called left here, `v > 0` of an element.
pub fn left_of(tangent: Vec2) -> Vec2 {
    Vec2::new(-tangent.y, tangent.x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn resampling_is_even_and_keeps_the_ends() {
        let points = [(0.0, 0.0), (3.0, 0.0), (3.0, 1.0)].map(Point::from);
        let even = resample(&points, 4);
        assert_eq!(even, [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (3.0, 0.0), (3.0, 1.0)].map(Point::from));
        assert_eq!(resample(&points[..1], 2).len(), 3);
    }

    #[test]
    fn a_part_has_the_length_asked_for() {
        let points = [(0.0, 0.0), (3.0, 0.0), (3.0, 4.0)].map(Point::from);
        assert!((length(&between(&points, 1.0, 5.0)) - 4.0).abs() < 1e-12);
    }
}
