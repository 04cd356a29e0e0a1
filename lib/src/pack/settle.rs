//! What moulding ends in: outlines bent anew, and checked exactly against each other, as in `place`.

use super::choose::Pose;
use super::fill::Filler;
use super::mould::Pieces;
use super::params::Sizes;
use super::place::{FINER, Placement, bent_and_checked, is_inside, sides, silhouette};
use super::prepare::Prepared;
use super::skin::Moving;
use super::template::Template;
use crate::geom::bend::{Bend, warped};
use crate::geom::boolean::{Contour, area};
use crate::geom::crossing::self_crossings;
use crate::geom::flatten::flatten;
use crate::geom::segment::{SegmentGrid, segment_segment};
use crate::geom::warp::Warp;
use kurbo::{BezPath, ParamCurve, Point};
use rayon::prelude::*;

/// A piece as it is moulded.
struct Moulded {
    warps: Vec<Warp>,
    /// Outer subpaths, and as polygons.
    outer: Vec<BezPath>,
    outlines: Vec<Contour>,
}

/// How far pieces go, in shares of their pushes, if they do not go farther.
const SHARES: [f64; 3] = [1.0, 0.6, 0.3];

/// Moulds all pieces as far as they keep apart: two that do not both go less far, until all do. In the end
/// they may stay as they were.
pub(super) fn settle(
    prepared: &Prepared,
    templates: &[Template],
    placement: &mut Placement,
    fillers: &mut [Filler],
    all: &[Moving],
) {
    // Out of time, or nowhere to go.
    if all.iter().all(|moving| moving.warps.is_empty()) {
        return;
    }
    let mut outlines = placement.take_outlines();
    let elements = placement.placed.len();
    let moulded = |i: usize, share: f64| {
        let sizes = &prepared.fields[all[i].field].sizes;
        let warps = all[i].warps.iter().map(|warp| warp.scaled(share));
        match placement.placed.get(i) {
            Some(placed) => {
                let mut bend = placed.bend.clone();
                bend.warps.extend(warps);
                of_element(&templates[placed.template], placed.pose, bend, sizes)
            }
            None => of_filler(&fillers[i - elements], warps.collect(), sizes),
        }
    };
    let before = |i: usize| match placement.placed.get(i) {
        Some(placed) => &placed.outlines,
        None => &fillers[i - elements].outlines,
    };
    let pieces = Pieces::new(prepared, placement);
    // Which share each piece has reached; beyond the last it stays.
    let mut level: Vec<usize> =
        all.iter().map(|moving| if moving.warps.is_empty() { SHARES.len() } else { 0 }).collect();
    let mut settled: Vec<Option<Moulded>> = all.iter().map(|_| None).collect();
    let mut changed: Vec<usize> = (0..all.len()).filter(|&i| level[i] < SHARES.len()).collect();
    for i in (0..all.len()).filter(|&i| level[i] == SHARES.len()) {
        before(i).iter().for_each(|contour| outlines.insert_contour(contour, i as u32));
    }
    loop {
        let again: Vec<(usize, Option<Moulded>)> = changed
            .par_iter()
            .map(|&i| {
                let shares = SHARES.iter().enumerate().skip(level[i]);
                let mut first = shares.filter_map(|(k, &share)| Some((k, moulded(i, share)?)));
                first.next().map_or((SHARES.len(), None), |(k, moulded)| (k, Some(moulded)))
            })
            .collect();
        for (&i, (reached, moulded)) in changed.iter().zip(again) {
            let last = settled[i].take().into_iter().flat_map(|last| last.outlines);
            last.for_each(|contour| outlines.remove_contour(&contour, i as u32));
            (level[i], settled[i]) = (reached, moulded);
            let contours = settled[i].as_ref().map_or(before(i), |moulded| &moulded.outlines);
            contours.iter().for_each(|contour| outlines.insert_contour(contour, i as u32));
        }
        let blamed = |&i: &usize| {
            let contours = settled[i].as_ref().map_or(before(i), |moulded| &moulded.outlines);
            pieces.too_near(i, all[i].field, contours, &outlines)
        };
        let mut lowered: Vec<usize> = changed.par_iter().flat_map_iter(blamed).collect();
        lowered.retain(|&i| level[i] < SHARES.len());
        lowered.sort_unstable();
        lowered.dedup();
        if lowered.is_empty() {
            break;
        }
        lowered.iter().for_each(|&i| level[i] += 1);
        changed = lowered;
    }
    let of_fillers = settled.split_off(elements);
    placement.placed.par_iter_mut().zip(settled).for_each(|(placed, moulded)| {
        let Some(Moulded { warps, outer, outlines }) = moulded else { return };
        placed.silhouette = silhouette(&outlines);
        placed.area = area(&placed.silhouette);
        (placed.bend.warps, placed.outer, placed.outlines) = (warps, outer, outlines);
    });
    for (filler, moulded) in fillers.iter_mut().zip(of_fillers) {
        let Some(Moulded { warps, outer, outlines }) = moulded else { continue };
        filler.area = area(&outlines);
        (filler.warps, filler.moulded, filler.outlines) = (warps, outer.into_iter().next(), outlines);
    }
    placement.give_outlines(outlines);
}

/// Chords of moulded outlines are this much nearer to the truth, and the gaps that are checked this many
/// tolerances narrower: before, pieces may have kept the gap to a hair.
const CLOSER: f64 = 0.5;
const NARROWER: f64 = 0.5;

/// An element with its new outlines. `None` if it is turned over somewhere.
fn of_element(template: &Template, pose: Pose, bend: Bend, sizes: &Sizes) -> Option<Moulded> {
    let places = template.parts.iter().flat_map(|(path, _)| path.segments()).flat_map(|segment| {
        // Outlines, where pushes are, are looked at more closely below.
        (0..2).map(move |k| segment.eval(f64::from(k) / 2.0))
    });
    let posed =
        |p: Point| Point::new(if pose.along { 1.0 - p.x } else { p.x }, if pose.across { -p.y } else { p.y });
    if !bend.keeps_sense(places.map(posed)) {
        return None;
    }
    let (outer, keeps_sense) = bent_and_checked(&template.outer, pose, &bend, FINER * sizes.tolerance());
    if !keeps_sense {
        return None;
    }
    let outlines: Vec<Contour> = outer
        .iter()
        .flat_map(|path| flatten(path, CLOSER * sizes.tolerance()))
        .map(|subpath| subpath.points)
        .collect();
    let is_simple =
        template.crosses_itself || outlines.iter().all(|outline| self_crossings(outline, 1).is_empty());
    is_simple.then_some(Moulded { warps: bend.warps, outer, outlines })
}

/// A pebble with its new outline.
fn of_filler(filler: &Filler, warps: Vec<Warp>, sizes: &Sizes) -> Option<Moulded> {
    let warps: Vec<Warp> = filler.warps.iter().cloned().chain(warps).collect();
    let path = warped(&filler.plain(), &warps, FINER * sizes.tolerance())?;
    let outlines: Vec<Contour> =
        flatten(&path, CLOSER * sizes.tolerance()).into_iter().map(|subpath| subpath.points).collect();
    let is_simple = outlines.iter().all(|outline| self_crossings(outline, 1).is_empty());
    is_simple.then_some(Moulded { warps, outer: vec![path], outlines })
}

impl Pieces<'_> {
    /// The pieces that are nearer than their gap to a piece with these outlines, and that piece itself if
    /// there are any, or if it leaves its region.
    fn too_near(&self, own: usize, field: usize, contours: &[Contour], all: &SegmentGrid) -> Vec<usize> {
        let field = &self.prepared.fields[field];
        let sizes = &field.sizes;
        let margin = self.strokes[own] + (sizes.tolerance() - sizes.edge).max(0.0);
        let narrower = NARROWER * sizes.tolerance();
        let widest = self.widest_gap(sizes, own);
        let mut blamed = Vec::new();
        if !contours.iter().all(|contour| is_inside(contour, margin, &field.region)) {
            blamed.push(own);
        }
        for (p, q) in contours.iter().flat_map(sides) {
            all.visit(p, q, widest, |a, b, other| {
                let other = other as usize;
                let is_known = other == own || blamed.last() == Some(&other);
                if !is_known && segment_segment(p, q, a, b) < self.gap(sizes, own, other) - narrower {
                    blamed.extend([own, other]);
                }
                true
            });
        }
        blamed
    }
}
