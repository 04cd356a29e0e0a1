//! Polylines by arc length.

use kurbo::{Point, Rect, Vec2};

/// The box around points; `None` if there are none.
pub fn bounds(mut points: impl Iterator<Item = Point>) -> Option<Rect> {
    let first = points.next()?;
    Some(points.fold(Rect::from_points(first, first), |bounds, p| bounds.union_pt(p)))
}

/// Length of an open polyline.
pub fn length(points: &[Point]) -> f64 {
    points.windows(2).map(|pair| pair[0].distance(pair[1])).sum()
}

/// Arc length from the start to each point.
pub fn lengths(points: &[Point]) -> Vec<f64> {
    let (mut lengths, mut walked) = (Vec::with_capacity(points.len()), 0.0);
    let mut previous = points.first();
    for p in points {
        walked += previous.map_or(0.0, |previous| p.distance(*previous));
        lengths.push(walked);
        previous = Some(p);
    }
    lengths
}

/// Points at equal steps of arc length, both ends included: `n + 1` points, `n >= 1`.
/// A polyline of one point is repeated.
pub fn resample(points: &[Point], n: usize) -> Vec<Point> {
    let (Some(&first), Some(&last)) = (points.first(), points.last()) else { return Vec::new() };
    let lengths = lengths(points);
    let mut out = resample_between(points, &lengths, 0.0, lengths[points.len() - 1], n);
    (out[0], out[n]) = (first, last);
    out
}

/// Points at equal steps of arc length between two arc lengths: `n + 1` points, `n >= 1`. `lengths` are those of
/// the points.
pub fn resample_between(points: &[Point], lengths: &[f64], from: f64, to: f64, n: usize) -> Vec<Point> {
    let step = (to - from) / n as f64;
    let mut i = lengths.partition_point(|&length| length <= from).saturating_sub(1);
    (0..=n)
        .map(|k| {
            let target = from + step * k as f64;
            while i + 2 < points.len() && lengths[i + 1] < target {
                i += 1;
            }
            let Some(&next) = points.get(i + 1) else { return points[i] };
            let piece = lengths[i + 1] - lengths[i];
            let t = if piece > 0.0 { ((target - lengths[i]) / piece).clamp(0.0, 1.0) } else { 0.0 };
            points[i].lerp(next, t)
        })
        .collect()
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

/// Maximal runs of `true`, one flag for each point.
pub fn runs(flags: &[bool]) -> Vec<std::ops::Range<usize>> {
    let mut runs = Vec::new();
    let mut start = None;
    for (i, &flag) in flags.iter().chain(&[false]).enumerate() {
        match (start, flag) {
            (None, true) => start = Some(i),
            (Some(first), false) => {
                runs.push(first..i);
                start = None;
            }
            _ => {}
        }
    }
    runs
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

/// A closed polyline with as few corners as leave it within `tolerance` (Ramer, Douglas, Peucker).
pub fn simplified_closed(points: &[Point], tolerance: f64) -> Vec<Point> {
    let Some(&first) = points.first() else { return Vec::new() };
    // Cut where it is sure to have a corner: at the first point and the one farthest from it.
    let far = |i: &usize| points[*i].distance_squared(first);
    let middle = (0..points.len()).max_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or(0);
    let ring: Vec<Point> = points.iter().chain([&first]).copied().collect();
    let mut keep = vec![false; points.len()];
    let mut todo = vec![(0, middle), (middle, points.len())];
    while let Some((from, to)) = todo.pop() {
        keep[from] = true;
        let (a, b) = (ring[from], ring[to]);
        let chord = b - a;
        let off = |p: Point| match chord.hypot2() {
            0.0 => p.distance(a),
            length => {
                let t = ((p - a).dot(chord) / length).clamp(0.0, 1.0);
                p.distance(a + t * chord)
            }
        };
        let worst = (from + 1..to).map(|i| (off(ring[i]), i)).max_by(|x, y| x.0.total_cmp(&y.0));
        if let Some((distance, i)) = worst.filter(|worst| worst.0 > tolerance) {
            debug_assert!(distance.is_finite());
            todo.extend([(from, i), (i, to)]);
        }
    }
    points.iter().zip(keep).filter(|(_, keep)| *keep).map(|(p, _)| *p).collect()
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

    #[test]
    fn closed_lines_keep_their_corners_alone() {
        let ring: Vec<Point> = (0..400)
            .map(|i| {
                let (side, t) = (i / 100, f64::from(i % 100) / 10.0);
                match side {
                    0 => Point::new(t, 0.0),
                    1 => Point::new(10.0, t),
                    2 => Point::new(10.0 - t, 10.0),
                    _ => Point::new(0.0, 10.0 - t),
                }
            })
            .collect();
        assert_eq!(simplified_closed(&ring, 1e-9).len(), 4);
        let circle: Vec<Point> =
            (0..1000).map(|i| (10.0 * Vec2::from_angle(f64::from(i) * 0.006_283_185_3)).to_point()).collect();
        let few = simplified_closed(&circle, 0.01);
        assert!((60..200).contains(&few.len()), "{}", few.len());
        assert!(simplified_closed(&[], 1.0).is_empty());
    }
}
