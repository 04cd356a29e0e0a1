//! Whether what is drawn lies in the panel.

use crate::geom::region::Region;
use crate::geom::segment::segment_segment;
use kurbo::{BezPath, ParamCurve, PathEl, PathSeg, Point};

/// True if a path, drawn so far to its sides, lies in a region. Curves are looked at closely only where
/// the outline is near.
pub(super) fn is_inside(path: &BezPath, half: f64, region: &Region) -> bool {
    const FLATNESS: f64 = 2e-3;
    let meets = |a: Point, b: Point, reach: f64| {
        let mut is_met = false;
        region.edges().visit(a, b, reach, |p, q, _| {
            is_met = segment_segment(a, b, p, q) <= reach;
            !is_met
        });
        is_met
    };
    let starts = path.elements().iter().filter_map(|element| match element {
        PathEl::MoveTo(p) => Some(*p),
        _ => None,
    });
    if !starts.clone().all(|p| region.contains(p)) {
        return false;
    }
    path.segments().all(|segment| {
        let (a, b) = (segment.start(), segment.end());
        if !meets(a, b, half + spread(&segment)) {
            return true;
        }
        let (mut is_clear, mut last) = (true, a);
        kurbo::flatten(BezPath::from_path_segments([segment].into_iter()), FLATNESS, |element| {
            if let PathEl::LineTo(p) = element {
                is_clear &= !meets(last, p, half);
                last = p;
            }
        });
        is_clear
    })
}

/// How far a curve leaves its chord, at most.
fn spread(segment: &PathSeg) -> f64 {
    let (a, b) = (segment.start(), segment.end());
    let away = |p: Point| segment_segment(a, b, p, p);
    match segment {
        PathSeg::Line(_) => 0.0,
        PathSeg::Quad(quad) => away(quad.p1),
        PathSeg::Cubic(cubic) => away(cubic.p1).max(away(cubic.p2)),
    }
}
