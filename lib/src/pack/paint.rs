//! Tones of built-in elements: no two equal neighbours.

use super::place::Placed;
use kurbo::Point;

/// A tone for every element: about half main, a third second, the rest accent, each the one
/// that is rarest among its neighbours.
pub(super) fn assign(placed: &[Placed], reach: f64) -> Vec<usize> {
    const SHARES: [f64; 3] = [0.46, 0.34, 0.2];
    let centres: Vec<Point> = placed.iter().map(|placed| placed.centre).collect();
    let bounds = centres.iter().fold(None, |bounds: Option<kurbo::Rect>, &p| {
        Some(bounds.map_or(kurbo::Rect::from_points(p, p), |b| b.union_pt(p)))
    });
    let Some(bounds) = bounds else { return Vec::new() };
    let mut grid = crate::geom::near::PointGrid::new(bounds, reach);
    let mut assigned: Vec<usize> = Vec::new();
    let mut counts = [0.0; 3];
    for (i, &centre) in centres.iter().enumerate() {
        let mut near = [0.0; 3];
        grid.visit(centre, reach, |p, other| {
            let distance = p.distance(centre);
            if distance < reach {
                near[assigned[other as usize]] += 1.0 - distance / reach;
            }
            true
        });
        let want = |tone: usize| {
            near[tone] / SHARES[tone] + 3.0 * (counts[tone] / (i as f64 + 1.0) - SHARES[tone]) / SHARES[tone]
        };
        let best = (0..3).min_by(|&a, &b| want(a).total_cmp(&want(b))).unwrap_or(0);
        counts[best] += 1.0;
        assigned.push(best);
        grid.insert(centre, i as u32);
    }
    assigned
}
