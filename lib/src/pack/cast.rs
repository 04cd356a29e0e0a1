//! Casting: an element for every room, with an eye on its neighbours and on the arrows.

use super::blob::Blob;
use super::choose::{self, Trial};
use super::params::Params;
use super::prepare::{Field, Prepared};
use super::refine::Body;
use super::template::{self, Template};
use crate::geom::near::PointGrid;
use crate::geom::segment::point_segment;
use crate::rng::Rng;
use kurbo::Point;
use rayon::prelude::*;

/// Chooses for every blob, in order. Blobs that no element fits get none. False if the time
/// ran out first.
pub(super) fn cast(
    prepared: &Prepared,
    templates: &[Template],
    usable: &[Vec<usize>],
    blobs: &[Blob],
    rng: &mut Rng,
    mut go_on: impl FnMut(f64) -> bool,
) -> (Vec<Body>, bool) {
    let spacing = prepared.fields.iter().map(|field| field.sizes.spacing).fold(f64::INFINITY, f64::min);
    let mut neighbours = Neighbours::new(prepared, spacing);
    let mut bodies = Vec::new();
    // Trials need no neighbours and are made on all cores, some blobs ahead.
    const AHEAD: usize = 256;
    for (index, blobs_ahead) in blobs.chunks(AHEAD).enumerate() {
        if !go_on((index * AHEAD) as f64 / blobs.len() as f64) {
            return (bodies, false);
        }
        let trials = |blob: &Blob| trials(templates, &usable[blob.field], blob, &prepared.fields[blob.field]);
        let tried: Vec<Vec<Trial>> = blobs_ahead.par_iter().map(trials).collect();
        let mut chosen = Vec::with_capacity(tried.len());
        for (blob, tried) in blobs_ahead.iter().zip(tried) {
            if let Some(trial) = best(&tried, templates, blob, &prepared.fields[blob.field], &neighbours, rng)
            {
                neighbours.add(blob, trial.pose.template);
                chosen.push((blob, trial));
            }
        }
        let body = |(blob, trial): (&Blob, Trial)| body(blob, trial, templates, &prepared.fields[blob.field]);
        let made: Vec<Option<Body>> = chosen.into_par_iter().map(body).collect();
        bodies.extend(made.into_iter().flatten());
    }
    (bodies, true)
}

/// The element for one more blob, as [`cast`] chooses it. `None` if none fits.
pub(super) fn chosen(
    blob: &Blob,
    templates: &[Template],
    usable: &[usize],
    field: &Field,
    neighbours: &Neighbours,
    rng: &mut Rng,
) -> Option<Body> {
    let trial = best(&trials(templates, usable, blob, field), templates, blob, field, neighbours, rng)?;
    body(blob, trial, templates, field)
}

/// A chosen element in the best part of its blob.
fn body(blob: &Blob, trial: Trial, templates: &[Template], field: &Field) -> Option<Body> {
    let template = &templates[trial.pose.template];
    let part = choose::trimmed(template, trial, blob, field.sizes.min_length, &field.params);
    Body::new(blob, trial.pose, part, template, field)
}

/// Every pose that a blob has room for.
fn trials(templates: &[Template], usable: &[usize], blob: &Blob, field: &Field) -> Vec<Trial> {
    choose::poses(templates, usable, blob)
        .into_iter()
        .filter_map(|pose| choose::trial(&templates[pose.template], pose, blob, (0.0, 1.0), &field.params))
        .collect()
}

/// The best trial for a blob.
fn best(
    tried: &[Trial],
    templates: &[Template],
    blob: &Blob,
    field: &Field,
    neighbours: &Neighbours,
    rng: &mut Rng,
) -> Option<Trial> {
    let bin = blob.length / template::BINS as f64;
    let room: f64 = blob.room.iter().flatten().sum::<f64>() * bin;
    let reversed = field.guided && field.params.sense == "arrow" && runs_against(blob, &field.guides);
    let mut best: Option<(f64, Trial)> = None;
    for &trial in tried {
        let against = field.guided && field.params.sense == "arrow" && trial.pose.along != reversed;
        let repeats = neighbours.repeats(blob, trial.pose.template);
        let template = &templates[trial.pose.template];
        // Radius of its largest blank disc, in spacings.
        let scale = blob.length / template.length * libm::exp(trial.distortion);
        let blank = scale * template.half_width * template.blank / field.sizes.spacing;
        let score = score(&trial, room, (repeats, against, blank), &field.params)
            + rng.between(0.0, 0.06 * field.params.variety);
        if best.as_ref().is_none_or(|(other, _)| score > *other) {
            best = Some((score, trial));
        }
    }
    best.map(|(_, trial)| trial)
}

/// True if a line runs against the arrows of the nearest guide.
fn runs_against(blob: &Blob, guides: &[Vec<Point>]) -> bool {
    let middle = blob.points[blob.points.len() / 2];
    let along = blob.points[blob.points.len() - 1] - blob.points[0];
    let segments = guides.iter().flat_map(|guide| guide.windows(2));
    let nearest = segments.min_by(|a, b| {
        let distance = |s: &[Point]| point_segment(middle, s[0], s[1]);
        distance(a).total_cmp(&distance(b))
    });
    nearest.is_some_and(|segment| (segment[1] - segment[0]).dot(along) < 0.0)
}

/// Where which template already is.
pub(super) struct Neighbours {
    grid: PointGrid,
    reach: f64,
}

impl Neighbours {
    pub fn new(prepared: &Prepared, spacing: f64) -> Self {
        Neighbours { grid: PointGrid::new(prepared.bounds, 2.0 * spacing), reach: 1.6 * spacing }
    }

    pub fn add(&mut self, blob: &Blob, template: usize) {
        Self::marks(blob).for_each(|p| self.grid.insert(p, template as u32));
    }

    /// 1 for an equal element beside most of a blob, 0 for none.
    fn repeats(&self, blob: &Blob, template: usize) -> f64 {
        let beside = Self::marks(blob)
            .filter(|&p| self.grid.any_within(p, self.reach, |_, other| other == template as u32))
            .count();
        beside as f64 / Self::marks(blob).count() as f64
    }

    /// A few places along a blob.
    fn marks(blob: &Blob) -> impl Iterator<Item = Point> + '_ {
        let n = blob.points.len();
        (0..5).map(move |i| blob.points[i * (n - 1) / 4])
    }
}

/// How much of a trial's praise stays after its distortion, its neighbours, the arrows and its largest blank disc.
fn score(trial: &Trial, room: f64, (repeats, against, blank): (f64, bool, f64), params: &Params) -> f64 {
    // Weights of the four against the share of the room that is filled.
    const DISTORTION: f64 = 0.12;
    const REPEATS: f64 = 0.3;
    const AGAINST: f64 = 0.25;
    const BLANK: f64 = 1.0;
    // So large, in spacings, a blank disc is a rest for the eye. A larger one among elements with veins is a hole
    // in the pattern; among elements that are all blank it is the same for all.
    const REST: f64 = 0.25;
    trial.area / room.max(f64::MIN_POSITIVE)
        - DISTORTION * trial.distortion.abs()
        - REPEATS * params.variety * repeats
        - if against { AGAINST } else { 0.0 }
        - BLANK * (blank - REST).max(0.0)
}
