//! Streamlines of one container (FLOWPAK 4.3): along its boundary, from its guides, and
//! evenly in between.

use super::blob::END_GAP;
use super::prepare::Field;
use crate::field::{BOUNDARY_BONUS, DirectionField, LineKind, Streamline, StreamlineParams, Tracer};
use crate::geom::boolean::{self, Contour};
use crate::geom::polyline::{self, left_of};
use crate::rng::Rng;
use kurbo::{Point, Vec2};

/// Integration steps of one container at most; a million is some ten thousand elements.
pub(super) const MOST_STEPS: usize = 20_000_000;

/// Traces a container. `half_elements`: something can lie along the boundary. The flag is
/// false if the time ran out first.
pub(super) fn trace(
    field: &Field,
    flow: &DirectionField,
    half_elements: bool,
    rng: &mut Rng,
    mut go_on: impl FnMut(f64) -> bool,
) -> (Vec<Streamline>, bool) {
    let sizes = &field.sizes;
    let params = StreamlineParams {
        spacing: sizes.spacing,
        min_length: sizes.min_length,
        max_length: sizes.max_length,
        end_gap: END_GAP * sizes.gap,
    };
    let mut tracer = Tracer::new(&field.region, flow, params, rng.fork(), MOST_STEPS);
    for spine in &field.fixed_spines {
        tracer.add(spine, LineKind::Fixed);
    }
    // Just inside the boundary, so that a smoothed line does not leave the region.
    let inset = 0.012 * sizes.spacing;
    for contour in boolean::offset(field.region.contours(), -inset) {
        boundary(field, flow, &contour, half_elements && field.params.border, &mut tracer);
    }
    for guide in field.guides.iter().filter(|_| field.guided) {
        let n = (polyline::length(guide) / (sizes.spacing / 4.0)).ceil().clamp(1.0, 1e5) as usize;
        for p in polyline::resample(guide, n) {
            tracer.seed(p, 0.0);
        }
    }
    let finished = tracer.run(&mut go_on) && {
        // What is left is too short for s_min. Shorter lines there beat bald spots.
        const SHORTER: f64 = 0.62;
        tracer.shorten(SHORTER);
        sow_rest(field, &mut tracer);
        tracer.run(&mut go_on)
    };
    (tracer.into_lines(), finished)
}

/// Seeds all over the region, a third of a spacing apart; those far from the boundary first.
fn sow_rest(field: &Field, tracer: &mut Tracer) {
    let bounds = field.region.bounds();
    let step = field.sizes.spacing / 3.0;
    let reach = 4.0 * field.sizes.spacing;
    let (columns, rows) = ((bounds.width() / step) as usize, (bounds.height() / step) as usize);
    for row in 0..=rows {
        for column in 0..=columns {
            let p = bounds.origin() + Vec2::new(column as f64 + 0.5, row as f64 + 0.5) * step;
            if field.region.contains(p) {
                tracer.seed(p, reach - field.region.distance(p, reach));
            }
        }
    }
}

/// Lines along the boundary where the flow runs along it and there is room for a half element
/// and more; seeds half a spacing inside elsewhere, or in the middle of what is thin.
///
/// Departure from 4.3: the paper starts lines on the boundary and lets them follow the field,
/// where they drift off it (erratum Q-8). Lines on the boundary are taken from it exactly, and
/// lines that carry full elements start where such an element's middle can be.
fn boundary(
    field: &Field,
    flow: &DirectionField,
    contour: &Contour,
    half_elements: bool,
    tracer: &mut Tracer,
) {
    let spacing = field.sizes.spacing;
    let step = spacing / 8.0;
    let closed: Vec<Point> = contour.iter().chain(contour.first()).copied().collect();
    let n = (polyline::length(&closed) / step).ceil().clamp(8.0, 1e6) as usize;
    let mut points = polyline::resample(&closed, n);
    points.pop();
    // The region on the left.
    let tangents = polyline::tangents(&points, true);
    let inside =
        points.iter().zip(&tangents).filter(|&(&p, &t)| field.region.contains(p + step * left_of(t))).count();
    if 2 * inside < points.len() {
        points.reverse();
    }
    let tangents = polyline::tangents(&points, true);
    let reach = (2.0 + BOUNDARY_BONUS) * spacing;
    let usable: Vec<bool> = (0..n)
        .map(|i| {
            let (p, tangent) = (points[i], tangents[i]);
            let inward = left_of(tangent);
            let room = field.region.ray(p + 1e-3 * step * inward, inward, reach);
            let thick = room >= (1.5 + BOUNDARY_BONUS) * spacing;
            if !(half_elements && thick) {
                // Where it is thin the roomiest place comes first, so that a line into a tip
                // starts in the middle of its root and not beside its point.
                let middle = (room / 2.0).min(spacing / 2.0);
                tracer.seed(p + middle * inward, spacing / 2.0 - middle);
            }
            half_elements && thick && is_aligned(flow, p, tangent) && !is_corner(&points, i)
        })
        .collect();
    // Start at a gap, so that a run over the first point is not cut there.
    let start = usable.iter().position(|&usable| !usable).unwrap_or(0);
    let rotated: Vec<bool> = (0..n).map(|i| usable[(start + i) % n]).collect();
    for run in polyline::runs(&rotated) {
        let line: Vec<Point> = run.map(|i| points[(start + i) % n]).collect();
        tracer.add(&line, LineKind::Boundary);
    }
}

/// True if the flow runs within 30 degrees of the boundary.
fn is_aligned(flow: &DirectionField, p: Point, tangent: Vec2) -> bool {
    const COS_30: f64 = 0.866;
    flow.direction(p, tangent).is_some_and(|direction| direction.dot(tangent) > COS_30)
}

/// True if the boundary turns by more than 40 degrees within a third of a spacing (the points
/// are an eighth of one apart).
fn is_corner(points: &[Point], i: usize) -> bool {
    const COS_40: f64 = 0.766;
    const ARM: usize = 2;
    let n = points.len();
    let (before, at, after) = (points[(i + n - ARM) % n], points[i], points[(i + ARM) % n]);
    let (a, b) = (at - before, after - at);
    a.dot(b) < COS_40 * a.hypot() * b.hypot()
}
