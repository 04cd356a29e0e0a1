//! Small elements in the gaps that the first ones leave.
//!
//! The paper names small extra elements in large gaps as future work (section 6, checklist F-083). Here
//! they are part of refinement: once the first elements have grown into the space between them, a line
//! along the flow is laid through the middle of every gap that has room for a small one, the widest gap
//! first, and what it carries is refined with all the others from then on. Once more at the end, where an element
//! found no place in the end.

use super::blob::{Blob, Spine};
use super::cast::{Neighbours, chosen};
use super::gaps::{Gaps, Inked, Place};
use super::params::Sizes;
use super::prepare::{Field, Prepared};
use super::refine::Body;
use super::template::{BINS, Template};
use crate::field::{DirectionField, LineKind};
use crate::geom::boolean::Contour;
use crate::geom::polyline::{self, left_of};
use crate::geom::segment::SegmentGrid;
use crate::rng::Rng;
use kurbo::{Point, Vec2};

/// Half widths of small elements, in spacings: narrower ones would be threads beside the others.
const NARROWEST: f64 = 0.13;
/// The least length, in spacings, and in half widths of the gap.
const SHORTEST: f64 = 0.6;
const SLENDER: f64 = 1.4;
/// The farthest that a line runs from the middle of its gap, in half widths of the gap.
const FARTHEST: f64 = 6.0;

/// Rounds in which the middle of a gap is found.
const ROUNDS: usize = 4;
/// How fine the gaps are seen, in spacings.
const STEP: f64 = 1.0 / 13.0;

/// What small elements are chosen from, and where they go.
pub(super) struct Ground<'a> {
    pub prepared: &'a Prepared,
    pub templates: &'a [Template],
    /// Templates of each container, and its flow.
    pub usable: &'a [Vec<usize>],
    pub flows: &'a [Option<DirectionField>],
}

/// Small elements between others, whose outlines are `silhouettes` with half a `stroke` around them, in every container that is refined. False if
/// the time ran out first.
pub(super) fn insert(
    &Ground { prepared, templates, usable, flows }: &Ground,
    bodies: &[Body],
    (silhouettes, stroke): (&[&Contour], f64),
    rng: &mut Rng,
    mut go_on: impl FnMut(f64) -> bool,
) -> (Vec<Body>, bool) {
    let spacing = prepared.fields.iter().map(|field| field.sizes.spacing).fold(f64::INFINITY, f64::min);
    let mut outlines = SegmentGrid::new(prepared.bounds, spacing / 6.0);
    for (owner, silhouette) in silhouettes.iter().enumerate() {
        outlines.insert_contour(silhouette, owner as u32);
    }
    let mut neighbours = Neighbours::new(prepared, spacing);
    bodies.iter().for_each(|body| neighbours.add(&body.blob, body.fit.pose.template));
    let mut inserted = Vec::new();
    for (index, field) in prepared.fields.iter().enumerate() {
        let Some(flow) = &flows[index] else { continue };
        if field.params.iterations == 0 {
            continue;
        }
        let spacing = field.sizes.spacing;
        let sizes = (spacing, field.sizes.gap + stroke, STEP * spacing);
        let mut gaps = Gaps::new(field, &field.region, silhouettes, sizes);
        let mut heap = gaps.middles(NARROWEST * field.sizes.spacing);
        const ASK_EVERY: usize = 64;
        let mut popped = 0;
        while let Some(place) = heap.pop() {
            popped += 1;
            if popped % ASK_EVERY == 0 && !go_on(index as f64 / prepared.fields.len() as f64) {
                return (inserted, false);
            }
            let Some((centre, radius)) = settled(&place, &gaps, &outlines, &mut heap, &field.sizes) else {
                continue;
            };
            let Some(blob) = blob(index, field, flow, (&gaps, &outlines), (centre, radius)) else { continue };
            let Some(body) = chosen(&blob, templates, &usable[index], field, &neighbours, rng) else {
                continue;
            };
            neighbours.add(&blob, body.fit.pose.template);
            let outline = body.outline();
            outlines.insert_contour(&outline, u32::MAX);
            gaps.add(&outline);
            inserted.push(body);
        }
    }
    (inserted, true)
}

/// Outlines without strokes: those count with the gap.
fn plain(outlines: &SegmentGrid) -> Inked<'_> {
    Inked { outlines, strokes: &[], widest: 0.0 }
}

/// The middle of a gap and its clearance, if it is wide enough and the widest left; goes back to the heap
/// if it is not.
fn settled(
    place: &Place,
    gaps: &Gaps,
    outlines: &SegmentGrid,
    heap: &mut std::collections::BinaryHeap<Place>,
    sizes: &Sizes,
) -> Option<(Point, f64)> {
    let (centre, radius) = gaps.centred(plain(outlines), place.at(), (0.0, ROUNDS));
    if radius < NARROWEST * sizes.spacing {
        return None;
    }
    if radius < place.clearance() && heap.peek().is_some_and(|next| radius < next.clearance()) {
        heap.push(Place::new(centre, radius));
        return None;
    }
    Some((centre, radius))
}

/// A line along the flow through the middle of a gap, with the room beside it. `None` if it is too short.
fn blob(
    index: usize,
    field: &Field,
    flow: &DirectionField,
    (gaps, outlines): (&Gaps, &SegmentGrid),
    (centre, radius): (Point, f64),
) -> Option<Blob> {
    let spacing = field.sizes.spacing;
    let step = spacing / 24.0;
    let clearance = |at: Point| gaps.clearance(plain(outlines), at);
    // A tip needs no width, but the line should not slip through a crack into the next gap.
    let least = 0.25 * radius;
    let first = flow.direction(centre, Vec2::new(1.0, 0.0))?;
    let mut points = vec![centre];
    for along in [first, -first] {
        points.reverse();
        let (mut at, mut direction, mut walked) = (centre, along, 0.0);
        while walked < FARTHEST * radius {
            let next = at + step * direction;
            if clearance(next) < least {
                break;
            }
            // Uneven flow is left to the field; a small element does not bend sharply.
            direction =
                flow.direction(next, direction).filter(|d| d.dot(direction) > 0.97).unwrap_or(direction);
            (at, walked) = (next, walked + step);
            points.push(at);
        }
    }
    let length = polyline::length(&points);
    if length < (SHORTEST * spacing).max(SLENDER * radius) {
        return None;
    }
    let curve = Spine::new(&points, spacing).curve;
    let ribs: Vec<[f64; 2]> = (0..=BINS)
        .map(|i| {
            let jet = curve.jet(i as f64 / BINS as f64);
            let normal = left_of(jet.d / jet.d.hypot().max(f64::MIN_POSITIVE));
            [normal, -normal].map(|side| walk(jet.p, side, 1.5 * radius + step, clearance))
        })
        .collect();
    let room = [0, 1].map(|side| ribs.windows(2).map(|pair| pair[0][side].min(pair[1][side])).collect());
    Some(Blob { field: index, kind: LineKind::Free, points, length, room })
}

/// How far one can walk before there is no clearance left.
fn walk(from: Point, along: Vec2, most: f64, clearance: impl Fn(Point) -> f64) -> f64 {
    // Each step is as long as is sure to be free.
    const STEPS: usize = 12;
    let mut walked = 0.0;
    for _ in 0..STEPS {
        let free = clearance(from + walked * along);
        if free <= 0.02 * most {
            break;
        }
        walked += free;
        if walked >= most {
            return most;
        }
    }
    walked
}
