//! Bézier paths to polylines, with a tolerance and a limit.

use kurbo::{BezPath, Line, ParamCurve, ParamCurveDeriv, PathEl, PathSeg, Point};

/// Chords of one curve at most: a curve that wants more is far beyond the drawing.
const MOST_CHORDS: usize = 256;

/// A flattened subpath.
#[derive(Clone, Debug)]
pub struct Subpath {
    /// Without the repeated first point, if it is closed.
    pub points: Vec<Point>,
    /// Closed by a command, or because its ends meet.
    pub closed: bool,
    /// Closed by a command.
    pub has_close: bool,
}

/// Flattens a path: chords lie within `tolerance` of the curves. Subpaths of a single point
/// are left out.
pub fn flatten(path: &BezPath, tolerance: f64) -> Vec<Subpath> {
    let mut subpaths = Vec::new();
    let mut current: Vec<Point> = Vec::new();
    for el in path.elements() {
        let at = current.last().copied().unwrap_or_default();
        match *el {
            PathEl::MoveTo(p) => {
                finish(&mut subpaths, &mut current, false, tolerance);
                current.push(p);
            }
            PathEl::LineTo(p) => current.push(p),
            PathEl::QuadTo(a, p) => chords(kurbo::QuadBez::new(at, a, p).into(), tolerance, &mut current),
            PathEl::CurveTo(a, b, p) => {
                chords(kurbo::CubicBez::new(at, a, b, p).into(), tolerance, &mut current)
            }
            PathEl::ClosePath => {
                let start = current.first().copied();
                finish(&mut subpaths, &mut current, true, tolerance);
                current.extend(start);
            }
        }
    }
    finish(&mut subpaths, &mut current, false, tolerance);
    subpaths
}

fn finish(subpaths: &mut Vec<Subpath>, current: &mut Vec<Point>, has_close: bool, tolerance: f64) {
    let mut points = std::mem::take(current);
    points.dedup();
    if points.len() > 1 {
        let (first, last) = (points[0], points[points.len() - 1]);
        // Ends this close are one point that rounding has split.
        let meet = first.distance(last) <= tolerance * 1e-2;
        if meet {
            points.pop();
        }
        let closed = has_close || (meet && points.len() > 2);
        subpaths.push(Subpath { points, closed, has_close });
    }
}

/// Appends the chords of a curve, without its start.
fn chords(segment: PathSeg, tolerance: f64, out: &mut Vec<Point>) {
    let cubic = segment.to_cubic();
    // Wang's bound: the second derivative over the square root of eight tolerances.
    let second = (cubic.p2.to_vec2() - 2.0 * cubic.p1.to_vec2() + cubic.p0.to_vec2())
        .hypot()
        .max((cubic.p3.to_vec2() - 2.0 * cubic.p2.to_vec2() + cubic.p1.to_vec2()).hypot());
    let wanted = (0.75 * second / tolerance).sqrt().ceil();
    let n = if wanted.is_finite() { (wanted as usize).clamp(1, MOST_CHORDS) } else { MOST_CHORDS };
    for i in 1..n {
        out.push(cubic.eval(i as f64 / n as f64));
    }
    out.push(cubic.p3);
}

/// Unit tangent at the start of a segment, from the first control point that differs.
pub fn start_tangent(segment: PathSeg) -> kurbo::Vec2 {
    let cubic = segment.to_cubic();
    let deriv = cubic.deriv().eval(0.0).to_vec2();
    let line = Line::new(cubic.p0, cubic.p3);
    let v = [deriv, cubic.p2 - cubic.p0, line.p1 - line.p0].into_iter().find(|v| v.hypot() > 0.0);
    v.map_or(kurbo::Vec2::ZERO, |v| v.normalize())
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::Shape;

    #[test]
    fn chords_stay_within_tolerance() {
        let circle = kurbo::Circle::new((0.0, 0.0), 10.0).to_path(1e-6);
        let flat = flatten(&circle, 0.01);
        assert_eq!(flat.len(), 1);
        assert!(flat[0].closed);
        for pair in flat[0].points.windows(2) {
            assert!((pair[0].midpoint(pair[1]).to_vec2().hypot() - 10.0).abs() < 0.011);
        }
    }

    #[test]
    fn huge_curves_are_bounded() {
        let path = BezPath::from_svg("M0,0C1e9,1e9 -1e9,1e9 5,5M1,1").unwrap();
        assert!(flatten(&path, 1e-9)[0].points.len() <= MOST_CHORDS + 1);
    }
}
