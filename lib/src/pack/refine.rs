//! Iterative refinement (FLOWPAK 4.6, checklist F-050 to F-063).
//!
//! Every element moves towards the middle of the space beside it, grows into it and takes the
//! space ahead of its ends, by at most g_limit in one iteration.
//!
//! Departures. The paper visits elements one by one, smallest first, and names an
//! order-independent refinement as future work (section 6); here all move at once, each by no
//! more than its share of the space between it and a neighbour, so that no two collide, the
//! order does not matter, and small elements still gain more: the share of each is the
//! other's part of their common area. The paper finds a shifted streamline by Dijkstra's
//! algorithm on 12,800 nodes (`shift`, for comparison); the new line here is the old one moved by a smooth offset that
//! centres it in its space, which costs a hundred steps and keeps the flow, since it moves by
//! little and smoothly. The rotations of 4.6 are among those offsets. An element is described
//! by its envelope in both, so the whole iteration is linear in the number of elements.

use super::blob::{Blob, Spine};
use super::choose::{self, Fit, Pose};
use super::prepare::{Field, Prepared};
use super::shift;
use super::template::{BINS, Side, Template};
use crate::field::{DirectionField, LineKind};
use crate::geom::boolean::Contour;
use crate::geom::near::PointTable;
use crate::geom::polyline::{self, left_of};
use kurbo::Point;
use rayon::prelude::*;
use std::ops::Range;

/// Growth tolerance α: a new element may have this share of the old one's area (4.6).
const TOLERANCE: f64 = 0.95;
/// Every so many bins an outline is sampled; the samples are then about as close as the gap
/// to the next element.
const STRIDE: usize = 2;
/// An element that gained less than this share of its area rests for some iterations.
const LITTLE: f64 = 8e-3;
const REST: usize = 3;

/// Iterations in which mirrored elements are tried, and what they must gain.
const RETHINK: [usize; 3] = [2, 5, 9];
const RETHINK_GAIN: f64 = 1.05;

/// An element while it is refined: its own piece of line, the room it may use, and its fit.
#[derive(Clone, Debug)]
pub(super) struct Body {
    pub blob: Blob,
    pub fit: Fit,
    best_area: f64,
    shape: Shape,
    /// Iterations in a row that changed next to nothing.
    still: usize,
}

/// The envelope in place.
#[derive(Clone, Debug)]
struct Shape {
    /// Reach of the envelope beside the line in each bin, after bending.
    reach: [Vec<f64>; 2],
    /// Its outline at the middle of every second bin.
    sides: [Vec<Point>; 2],
    /// Both ends of the line.
    tips: [Point; 2],
}

impl Body {
    /// An element in a part of a blob. `None` if it does not fit there.
    pub fn new(
        blob: &Blob,
        pose: Pose,
        part: (f64, f64),
        template: &Template,
        field: &Field,
    ) -> Option<Self> {
        let points = polyline::between(&blob.points, part.0 * blob.length, part.1 * blob.length);
        let room = [0, 1]
            .map(|side| (0..BINS).map(|i| blob.room[side][choose::blob_bin(i, part.0, part.1)]).collect());
        let own = Blob { length: polyline::length(&points), points, room, ..*blob };
        let spine = Spine::new(&own.points, field.sizes.spacing);
        let fit = choose::fit(template, pose, &own, (0.0, 1.0), &spine.curvature, &field.params)?;
        Some(Body { shape: shape(spine, &fit, template), best_area: fit.area, blob: own, fit, still: 0 })
    }

    /// The outline of its envelope.
    pub fn outline(&self) -> Contour {
        let [left, right] = &self.shape.sides;
        let [start, end] = self.shape.tips;
        let there = std::iter::once(start).chain(left.iter().copied()).chain([end]);
        there.chain(right.iter().rev().copied()).collect()
    }
}

/// Refines all bodies together in some of the iterations. `go_on` is asked once in each; false ends early.
pub(super) fn refine(
    bodies: &mut [Body],
    templates: &[Template],
    flows: &[Option<DirectionField>],
    prepared: &Prepared,
    iterations: Range<usize>,
    mut go_on: impl FnMut(f64) -> bool,
) -> bool {
    let fields = &prepared.fields;
    for iteration in iterations.clone() {
        if !go_on(iteration as f64 / iterations.end as f64) {
            return false;
        }
        let neighbourhood = Neighbourhood::new(bodies, prepared);
        // Each looks only at the last composition, so any number of threads gives the same.
        let next: Vec<Option<Body>> = bodies
            .par_iter()
            .enumerate()
            .map(|(i, body)| {
                let field = &fields[body.blob.field];
                let rests = body.still > 0 && (iteration + i) % REST != 0;
                if rests || iteration >= field.params.iterations {
                    return None;
                }
                let flow = flows[body.blob.field].as_ref();
                let blob = moved(i, body, &neighbourhood, templates, prepared, flow);
                refitted(body, blob, templates, field, RETHINK.contains(&iteration))
            })
            .collect();
        // What all gain together is never less than nothing: if it were, only those that gain go on. Each moves
        // within its own share of the space, so it does not matter who else moves.
        let gain = |(body, next): (&Body, &Option<Body>)| {
            next.as_ref().map_or(0.0, |next| next.fit.area - body.fit.area)
        };
        let loses = bodies.iter().zip(&next).map(gain).sum::<f64>() < 0.0;
        for (body, next) in bodies.iter_mut().zip(next) {
            match next.filter(|next| !loses || next.fit.area >= body.fit.area) {
                Some(next) => *body = next,
                None => body.still += 1,
            }
        }
    }
    true
}

/// The fit of a moved blob, if it keeps the growth tolerance.
fn refitted(body: &Body, blob: Blob, templates: &[Template], field: &Field, rethink: bool) -> Option<Body> {
    let spine = Spine::new(&blob.points, field.sizes.spacing);
    let template = &templates[body.fit.pose.template];
    let fit_as = |pose| choose::fit(template, pose, &blob, (0.0, 1.0), &spine.curvature, &field.params);
    let mut best = fit_as(body.fit.pose)?;
    if rethink && blob.kind != LineKind::Boundary && template.side == Side::Full {
        // The same element mirrored (F-063); which way it points was chosen before.
        let mirrored = Pose { across: !body.fit.pose.across, ..body.fit.pose };
        best = fit_as(mirrored).filter(|fit| fit.area > RETHINK_GAIN * best.area).unwrap_or(best);
    }
    if best.area < TOLERANCE * body.best_area {
        return None;
    }
    let shape = shape(spine, &best, template);
    let still = if best.area > (1.0 + LITTLE) * body.fit.area { 0 } else { body.still + 1 };
    Some(Body { best_area: body.best_area.max(best.area), blob, fit: best, shape, still })
}

/// Bends the envelope of a fit.
fn shape(spine: Spine, fit: &Fit, template: &Template) -> Shape {
    let bend = spine.bend(fit.width.clone(), template);
    let middle = |i: usize| (i as f64 + 0.5) / BINS as f64;
    let extent = |side: usize, i: usize| {
        let extent = choose::extent(template, fit.pose, side, i);
        if side == 0 { extent } else { -extent }
    };
    let reach = [0, 1].map(|side| (0..BINS).map(|i| bend.reach(middle(i), extent(side, i)).abs()).collect());
    let sides = [0, 1]
        .map(|side| (0..BINS).step_by(STRIDE).map(|i| bend.point(middle(i), extent(side, i))).collect());
    Shape { reach, sides, tips: [bend.spine.jet(0.0).p, bend.spine.jet(1.0).p] }
}

/// Envelopes of all bodies, to ask how far the next one is.
struct Neighbourhood {
    outlines: PointTable<u32>,
    areas: Vec<f64>,
    reach: f64,
}

impl Neighbourhood {
    fn new(bodies: &[Body], prepared: &Prepared) -> Self {
        let largest = |f: fn(&Field) -> f64| prepared.fields.iter().map(f).fold(0.0, f64::max);
        let reach = largest(|field| field.sizes.gap) + 0.5 * largest(|field| field.sizes.spacing);
        let samples = bodies.iter().zip(0..).flat_map(|(body, i)| {
            let outline = body.shape.sides.iter().flatten().chain(&body.shape.tips);
            outline.map(move |&p| (p, i))
        });
        let outlines = PointTable::new(prepared.bounds, reach / 3.0, samples);
        Neighbourhood { outlines, areas: bodies.iter().map(|body| body.fit.area).collect(), reach }
    }

    /// How far a point of body `own` may move: its share of the space to the next body, and
    /// all of that to the boundary. Negative where the gap is not kept.
    fn allowance(&self, own: usize, at: Point, field: &Field, near_edge: bool) -> f64 {
        let gap = field.sizes.safe_gap();
        let (mut nearest, mut whose) = (self.reach * self.reach, None);
        for (p, other) in self.outlines.near(at, self.reach) {
            let distance = p.distance_squared(at);
            if distance < nearest && other as usize != own {
                (nearest, whose) = (distance, Some(other as usize));
            }
        }
        nearest = nearest.sqrt();
        let share = whose.map_or(1.0, |other| {
            let part = self.areas[other] / (self.areas[own] + self.areas[other]).max(f64::MIN_POSITIVE);
            part.clamp(0.3, 0.7)
        });
        // The nearest point of an outline lies between two of its samples, which are about a
        // gap apart: up to half a gap from one of them.
        const BETWEEN: f64 = 0.2;
        if whose.is_some() {
            nearest = (nearest * nearest - BETWEEN * gap * gap).max(0.0).sqrt();
        }
        let to_bodies = (nearest - gap) * share;
        if !near_edge {
            return to_bodies;
        }
        let to_boundary = field.region.distance(at, self.reach);
        to_bodies.min(if field.region.contains(at) { to_boundary } else { -to_boundary })
    }
}

/// The body's line and room after one iteration's move.
fn moved(
    index: usize,
    body: &Body,
    neighbourhood: &Neighbourhood,
    templates: &[Template],
    prepared: &Prepared,
    flow: Option<&DirectionField>,
) -> Blob {
    let (field, input_size) = (&prepared.fields[body.blob.field], prepared.input_size);
    // g_limit = 0.005 input_size (4.6), and never more than a step of the line spacing.
    let limit = (0.005 * input_size).min(0.12 * field.sizes.spacing);
    let on_boundary = body.blob.kind == LineKind::Boundary;
    let outline = body.shape.sides.iter().flatten().chain(&body.shape.tips).copied();
    let near_edge = !field.region.holds_circle(outline, neighbourhood.reach);
    let allowance = |at: Point| neighbourhood.allowance(index, at, field, near_edge).min(limit);
    let mut room = [0, 1].map(|side| {
        if on_boundary && side == 1 {
            return vec![0.0; BINS];
        }
        // A bin between two that are asked takes the lesser answer.
        let asked: Vec<f64> = body.shape.sides[side].iter().map(|&p| allowance(p)).collect();
        let between = |i: usize| asked[i / STRIDE].min(asked[i.div_ceil(STRIDE).min(asked.len() - 1)]);
        (0..BINS).map(|i| (body.shape.reach[side][i] + between(i)).max(0.0)).collect()
    });
    let mut points = polyline::resample(&body.blob.points, BINS);
    if body.blob.kind == LineKind::Free {
        let template = &templates[body.fit.pose.template];
        let offsets = offsets(&room, template, body.fit.pose, limit);
        let tangents = polyline::tangents(&points, false);
        if field.params.moves_by_paths() {
            let widths = [0, 1].map(|side| room[side].iter().copied().fold(0.0, f64::max));
            let ends = [offsets[0], offsets[BINS - 1]];
            points = polyline::resample(&shift::path(&points, ends, widths, limit, flow), BINS);
        } else {
            for (i, p) in points.iter_mut().enumerate() {
                *p += offsets[i.min(BINS - 1)] * left_of(tangents[i]);
            }
        }
        for (i, offset) in offsets.iter().enumerate() {
            room[0][i] = (room[0][i] - offset).max(0.0);
            room[1][i] = (room[1][i] + offset).max(0.0);
        }
        for end in 0..2 {
            extend(&mut points, end, allowance(body.shape.tips[end]), field);
        }
    }
    Blob { length: polyline::length(&points), points, room, ..body.blob }
}

/// Lengthens (or shortens) a line at its end 0 or 1.
fn extend(points: &mut [Point], end: usize, by: f64, field: &Field) {
    // A line may outgrow s_max by this much where nothing else can use the space.
    const OUTGROW: f64 = 1.15;
    let length = polyline::length(points);
    let by = by.min(OUTGROW * field.sizes.max_length - length).max(-0.05 * length);
    let n = points.len();
    let (tip, before) =
        if end == 0 { (points[0], points[n / 12]) } else { (points[n - 1], points[n - 1 - n / 12]) };
    let along = (tip - before).normalize();
    // The move fades over a quarter of the line, so that its samples stay even.
    let reach = n / 4;
    for k in 0..reach {
        let weight = 1.0 - k as f64 / reach as f64;
        let i = if end == 0 { k } else { n - 1 - k };
        points[i] += weight * by * along;
    }
}

/// How far each bin's part of the line moves to its left, to share the room between both
/// sides as the template does: a shift and a turn, each within the limit.
fn offsets(room: &[Vec<f64>; 2], template: &Template, pose: Pose, limit: f64) -> Vec<f64> {
    let widest = |side: usize| (0..BINS).map(|i| choose::extent(template, pose, side, i)).fold(0.0, f64::max);
    let (left, right) = (widest(0), widest(1));
    let wanted: Vec<f64> = (0..BINS)
        .map(|i| ((room[0][i] * right - room[1][i] * left) / (left + right)).clamp(-limit, limit))
        .collect();
    // The line that fits them best: a shift and a turn. Anything finer would copy the
    // neighbours' outlines into the spine, and the flow would wobble.
    let n = BINS as f64;
    let mean = wanted.iter().sum::<f64>() / n;
    let at = |i: usize| (i as f64 + 0.5) / n - 0.5;
    // The sum of squares of evenly spaced places in [-1/2, 1/2] is n / 12.
    let slope = wanted.iter().enumerate().map(|(i, offset)| at(i) * offset).sum::<f64>() * 12.0 / n;
    (0..BINS).map(|i| mean + slope * at(i)).collect()
}
