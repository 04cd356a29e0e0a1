//! Union, difference and offset of polygons: the only door to i_overlay.
//!
//! Points go in and come out as f64; nobody else sees its integer grid.

use super::polyline;
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::simplify::SimplifyShape;
use i_overlay::float::single::SingleFloatOverlay;
use i_overlay::mesh::float::outline::offset::OutlineOffset;
use i_overlay::mesh::float::stroke::offset::StrokeOffset;
use i_overlay::mesh::float::style::{LineCap, LineJoin, OutlineStyle, StrokeStyle};
use kurbo::{Point, Rect};

/// A closed polygon without its repeated first point.
pub type Contour = Vec<Point>;

type Raw = Vec<Vec<Vec<[f64; 2]>>>;

/// The area that contours enclose under a fill rule, as simple contours: outer ones and
/// holes, none crossing another, so that even-odd and nonzero agree on them.
pub fn simplified(contours: &[Contour], even_odd: bool) -> Vec<Contour> {
    let rule = if even_odd { FillRule::EvenOdd } else { FillRule::NonZero };
    out(raw(contours).simplify_shape_as::<i64>(rule))
}

/// The union of two areas of simple contours.
pub fn union(a: &[Contour], b: &[Contour]) -> Vec<Contour> {
    overlay(a, b, OverlayRule::Union)
}

/// The first area without the second.
pub fn difference(a: &[Contour], b: &[Contour]) -> Vec<Contour> {
    overlay(a, b, OverlayRule::Difference)
}

/// What two areas share.
pub fn intersection(a: &[Contour], b: &[Contour]) -> Vec<Contour> {
    overlay(a, b, OverlayRule::Intersect)
}

/// An area grown by `distance` with round corners (shrunk if it is negative).
pub fn offset(contours: &[Contour], distance: f64) -> Vec<Contour> {
    if distance == 0.0 || contours.is_empty() {
        return contours.to_vec();
    }
    // Chords of the round corners; the sagitta at this step is 0.5 % of the distance.
    const CORNER_STEP: f64 = 0.2;
    let style = OutlineStyle::new(distance).line_join(LineJoin::Round(CORNER_STEP));
    let shapes = raw(contours).simplify_shape_as::<i64>(FillRule::EvenOdd);
    out(shapes.outline_as::<i64>(&style))
}

/// The area that a round pen of this width covers along a polyline.
pub fn stroked(points: &[Point], closed: bool, width: f64) -> Vec<Contour> {
    if width <= 0.0 || points.is_empty() {
        return Vec::new();
    }
    // As fine as the round corners of `offset`.
    const CORNER_STEP: f64 = 0.2;
    let style = StrokeStyle::new(width)
        .line_join(LineJoin::Round(CORNER_STEP))
        .start_cap(LineCap::Round(CORNER_STEP))
        .end_cap(LineCap::Round(CORNER_STEP));
    let path: Vec<[f64; 2]> = points.iter().map(|p| [p.x, p.y]).collect();
    out(path.stroke_as::<i64>(style, closed))
}

/// Signed area (positive one way round, negative the other).
pub fn signed_area(contour: &[Point]) -> f64 {
    let Some(&origin) = contour.last() else { return 0.0 };
    // About a point of the contour itself: far from the origin the products would cancel.
    let mut previous = kurbo::Vec2::ZERO;
    let mut twice = 0.0;
    for &p in contour {
        let p = p - origin;
        twice += previous.cross(p);
        previous = p;
    }
    twice / 2.0
}

/// True for an outer contour among the results of this module, false for a hole.
pub fn is_outer(contour: &Contour) -> bool {
    signed_area(contour) > 0.0
}

/// Results of this module by connected part, the smallest first: an outer contour with its holes.
pub fn parts(contours: impl IntoIterator<Item = Contour>) -> Vec<Vec<Contour>> {
    let (outer, holes): (Vec<Contour>, Vec<Contour>) = contours.into_iter().partition(is_outer);
    let mut parts: Vec<Vec<Contour>> = outer.into_iter().map(|contour| vec![contour]).collect();
    // From the smallest on, so that a hole goes to the innermost.
    parts.sort_by(|a, b| signed_area(&a[0]).total_cmp(&signed_area(&b[0])));
    for hole in holes {
        if let Some(part) = parts.iter_mut().find(|part| encloses(&part[0], hole[0])) {
            part.push(hole);
        }
    }
    parts
}

/// True if a contour winds around a place (even-odd).
pub fn encloses(contour: &Contour, at: Point) -> bool {
    let crosses = |&(p, q): &(&Point, &Point)| {
        (p.y > at.y) != (q.y > at.y) && at.x < p.x + (at.y - p.y) / (q.y - p.y) * (q.x - p.x)
    };
    contour.last().into_iter().chain(contour).zip(contour).filter(crosses).count() % 2 == 1
}

/// True if a contour's bounding box reaches into a box.
pub fn touches(contour: &Contour, bounds: Rect) -> bool {
    polyline::bounds(contour.iter().copied()).is_some_and(|own| own.overlaps(bounds))
}

/// Area of simple contours: outer ones and holes run opposite ways.
pub fn area(contours: &[Contour]) -> f64 {
    contours.iter().map(|contour| signed_area(contour)).sum::<f64>().abs()
}

fn overlay(a: &[Contour], b: &[Contour], rule: OverlayRule) -> Vec<Contour> {
    let (a, b) = (raw(a), raw(b));
    out(a.overlay_as::<i64>(&b, rule, FillRule::EvenOdd))
}

fn raw(contours: &[Contour]) -> Vec<Vec<[f64; 2]>> {
    contours.iter().map(|contour| contour.iter().map(|p| [p.x, p.y]).collect()).collect()
}

fn out(shapes: Raw) -> Vec<Contour> {
    shapes
        .into_iter()
        .flatten()
        .map(|contour| contour.into_iter().map(|[x, y]| Point::new(x, y)).collect())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: f64, y: f64, side: f64) -> Contour {
        [(x, y), (x + side, y), (x + side, y + side), (x, y + side)].map(Point::from).to_vec()
    }

    #[test]
    fn areas_add_up() {
        let (a, b) = ([square(0.0, 0.0, 10.0)], [square(5.0, 5.0, 10.0)]);
        assert!((area(&union(&a, &b)) - 175.0).abs() < 1e-6);
        assert!((area(&difference(&a, &b)) - 75.0).abs() < 1e-6);
        assert!((area(&intersection(&a, &b)) - 25.0).abs() < 1e-6);
        let ring = [square(0.0, 0.0, 10.0), square(2.0, 2.0, 6.0)];
        assert!((area(&simplified(&ring, true)) - 64.0).abs() < 1e-6);
        assert!((area(&simplified(&ring, false)) - 100.0).abs() < 1e-6);
    }

    #[test]
    fn outer_contours_and_holes_are_told_apart() {
        let ring = simplified(&[square(0.0, 0.0, 10.0), square(2.0, 2.0, 6.0)], true);
        let outer: Vec<f64> = ring.iter().filter(|c| is_outer(c)).map(|c| signed_area(c)).collect();
        assert_eq!(outer.len(), 1);
        assert!((outer[0] - 100.0).abs() < 1e-6);
    }

    #[test]
    fn offsets_grow_and_shrink() {
        let square = [square(0.0, 0.0, 10.0)];
        assert!((area(&offset(&square, 1.0)) - (100.0 + 40.0 + std::f64::consts::PI)).abs() < 0.05);
        assert!((area(&offset(&square, -1.0)) - 64.0).abs() < 1e-6);
        assert!(offset(&square, -6.0).is_empty());
    }
}
