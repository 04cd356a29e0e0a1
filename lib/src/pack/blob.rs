//! The room around each streamline (FLOWPAK 4.4, checklist F-041 to F-043).
//!
//! Departure: the paper computes an approximate Voronoi diagram on a grid and measures it
//! along the normals of the streamline. Here the measure is computed directly, in closed
//! form. The bisector of a station p and a sample q of another line, moved towards p by half
//! the gap g, is met by the normal n of p at
//!
//! `t = |w| (|w| - g) / (2 n·w)`, with `w = q - p`,
//!
//! so a rib is the least of these over the samples near by that are ahead of it. Points of
//! two elements that respect it lie on either side of a strip as wide as the gap. No polygon
//! is built, and the cost is linear in stations times neighbours.

use super::prepare::Field;
use super::template::{BINS, Template};
use crate::field::{BOUNDARY_BONUS, DirectionField, LineKind, Streamline};
use crate::geom::bend::Bend;
use crate::geom::near::PointGrid;
use crate::geom::polyline::{self, left_of};
use crate::geom::spline::{Curve, Profile};
use kurbo::{Point, Vec2};
use rayon::prelude::*;

/// Ribs are this many spacings long at most: more would make an element wider than any line
/// spacing asks for.
const LONGEST_RIB: f64 = 1.1;

/// Ends keep this many gaps from what is ahead of them. At one gap exactly, the room beside
/// an end would shrink to nothing on the inner side of the slightest bend.
pub(super) const END_GAP: f64 = 1.4;

/// A streamline with the room around it.
#[derive(Clone, Debug)]
pub(super) struct Blob {
    pub field: usize,
    pub kind: LineKind,
    /// The line, extended to the ends of its room, at equal steps.
    pub points: Vec<Point>,
    pub length: f64,
    /// Room on the side v > 0 and v < 0 in each bin.
    pub room: [Vec<f64>; 2],
}

/// A smooth curve along a line, and how it bends.
#[derive(Clone, Debug)]
pub(super) struct Spine {
    pub curve: Curve,
    /// Smooth bounds of the curvature to the left and the right.
    bounds: [Profile; 2],
    /// Their largest values in each bin.
    pub curvature: [Vec<f64>; 2],
}

impl Spine {
    /// Knots are about 0.4 spacings apart: closer ones would copy the jitter of the tracing,
    /// wider ones would cut its bends.
    pub fn new(points: &[Point], spacing: f64) -> Self {
        let length = polyline::length(points);
        let spans = ((length / (0.4 * spacing)).ceil() as usize).clamp(4, 400);
        let curve = Curve::near(&polyline::resample(points, spans));
        let mut curvature = [vec![0.0; BINS], vec![0.0; BINS]];
        for (i, station) in stations(&curve).iter().enumerate() {
            for bin in [i.saturating_sub(1), i.min(BINS - 1)] {
                curvature[0][bin] = f64::max(curvature[0][bin], station.curvature);
                curvature[1][bin] = f64::max(curvature[1][bin], -station.curvature);
            }
        }
        let spans = ((length / (0.8 * spacing)).ceil() as usize).clamp(3, 40);
        let bounds = [Profile::above(&curvature[0], spans), Profile::above(&curvature[1], spans)];
        // What the smooth bounds are in each bin, which is what widths have to reckon with.
        for (bins, bound) in curvature.iter_mut().zip(&bounds) {
            let nodes: Vec<f64> = (0..=BINS).map(|i| bound.value(i as f64 / BINS as f64)).collect();
            for (k, pair) in bins.iter_mut().zip(nodes.windows(2)) {
                *k = pair[0].max(pair[1]);
            }
        }
        Spine { curve, bounds, curvature }
    }

    /// The strip around the spine for a template of these widths.
    pub fn bend(self, width: [Profile; 2], template: &Template) -> Bend {
        // Over a fifth of its half width an element's one side turns into its other.
        const BLEND: f64 = 0.2;
        Bend {
            spine: self.curve,
            width: width.into(),
            curvature: self.bounds.into(),
            blend: BLEND * template.half_width,
            warps: Vec::new(),
        }
    }
}

/// A place on a spine.
struct Station {
    p: Point,
    normal: Vec2,
    /// Positive where the line bends to its left.
    curvature: f64,
}

fn stations(curve: &Curve) -> Vec<Station> {
    (0..=BINS)
        .map(|i| {
            let jet = curve.jet(i as f64 / BINS as f64);
            let speed = jet.d.hypot().max(f64::MIN_POSITIVE);
            Station {
                p: jet.p,
                normal: left_of(jet.d / speed),
                curvature: jet.d.cross(jet.dd) / (speed * speed * speed),
            }
        })
        .collect()
}

/// Room around every line of one container.
pub(super) fn blobs(index: usize, field: &Field, flow: &DirectionField, lines: Vec<Streamline>) -> Vec<Blob> {
    let spacing = field.sizes.spacing;
    let mut grid = PointGrid::new(field.region.bounds(), spacing);
    for (owner, line) in lines.iter().enumerate() {
        line.points.iter().for_each(|&p| grid.insert(p, owner as u32));
    }
    let extended: Vec<(Vec<Point>, LineKind)> = lines
        .into_iter()
        .enumerate()
        .map(|(owner, line)| {
            let points = match line.kind {
                LineKind::Free => extend(line.points, owner as u32, field, flow, &grid),
                LineKind::Boundary | LineKind::Fixed => line.points,
            };
            (points, line.kind)
        })
        .collect();
    let samples = Samples::new(field, &extended);
    extended
        .par_iter()
        .enumerate()
        .map(|(owner, (points, kind))| {
            let length = polyline::length(points);
            let curve = Spine::new(points, spacing).curve;
            let ribs: Vec<[f64; 2]> = stations(&curve)
                .iter()
                .enumerate()
                .map(|(i, station)| {
                    let along = i as f64 / BINS as f64 * length;
                    samples.ribs(station, along, owner as u32, *kind, field)
                })
                .collect();
            let room =
                [0, 1].map(|side| ribs.windows(2).map(|pair| pair[0][side].min(pair[1][side])).collect());
            Blob { field: index, kind: *kind, points: points.clone(), length, room }
        })
        .collect()
}

/// Follows the field beyond both ends, until another line is as near as the own end (F-042).
fn extend(
    mut points: Vec<Point>,
    owner: u32,
    field: &Field,
    flow: &DirectionField,
    grid: &PointGrid,
) -> Vec<Point> {
    let (spacing, gap) = (field.sizes.spacing, field.sizes.gap);
    let step = spacing / 16.0;
    for _ in 0..2 {
        points.reverse();
        let n = points.len();
        let mut direction = (points[n - 1] - points[n - 2]).normalize();
        let (mut at, mut walked) = (points[n - 1], 0.0);
        while walked < 1.2 * spacing {
            direction =
                flow.direction(at, direction).filter(|next| next.dot(direction) > 0.98).unwrap_or(direction);
            let next = at + step * direction;
            walked += step;
            let reach = walked + END_GAP * gap;
            if !field.region.contains(next) || grid.any_within(next, reach, |_, other| other != owner) {
                break;
            }
            points.push(next);
            at = next;
        }
    }
    points
}

/// Samples of all lines, each with how far along its line it lies.
struct Samples {
    grid: PointGrid,
    /// Owner and distance along it, and the owner's bonus of room, by sample.
    of: Vec<(u32, f64, f64)>,
}

impl Samples {
    fn new(field: &Field, lines: &[(Vec<Point>, LineKind)]) -> Self {
        let spacing = field.sizes.spacing;
        let mut samples = Samples { grid: PointGrid::new(field.region.bounds(), spacing), of: Vec::new() };
        for (owner, (points, kind)) in lines.iter().enumerate() {
            let length = polyline::length(points);
            let steps = (length / (spacing / 10.0)).ceil().max(2.0) as usize;
            for (i, p) in polyline::resample(points, steps).into_iter().enumerate() {
                samples.grid.insert(p, samples.of.len() as u32);
                samples.of.push((owner as u32, i as f64 / steps as f64 * length, bonus(*kind, spacing)));
            }
        }
        samples
    }

    /// How far the room reaches on the left and the right of a station.
    fn ribs(&self, station: &Station, along: f64, owner: u32, kind: LineKind, field: &Field) -> [f64; 2] {
        let spacing = field.sizes.spacing;
        let longest = LONGEST_RIB * spacing;
        let own_bonus = bonus(kind, spacing);
        let mut ribs = [longest, longest];
        self.grid.visit(station.p, 2.0 * longest + field.sizes.gap, |q, sample| {
            let (other, other_along, other_bonus) = self.of[sample as usize];
            // The own line counts where it comes back, not where it runs on.
            if other == owner && (other_along - along).abs() < std::f64::consts::PI * spacing {
                return true;
            }
            let gap = field.sizes.gap + other_bonus - own_bonus;
            let w = q - station.p;
            let distance = w.hypot();
            for (side, normal) in [station.normal, -station.normal].into_iter().enumerate() {
                let towards = normal.dot(w);
                if towards > 0.0 {
                    ribs[side] = ribs[side].min((distance * (distance - gap) / (2.0 * towards)).max(0.0));
                }
            }
            true
        });
        let start = 1e-3 * spacing;
        for (side, normal) in [station.normal, -station.normal].into_iter().enumerate() {
            if kind == LineKind::Boundary && side == 1 {
                ribs[side] = 0.0;
            } else {
                let from = if kind == LineKind::Boundary { start } else { 0.0 };
                ribs[side] = field.region.ray(station.p + from * normal, normal, ribs[side]);
            }
        }
        ribs
    }
}

/// Lines on the boundary carry half elements, which get more than half the spacing.
fn bonus(kind: LineKind, spacing: f64) -> f64 {
    if kind == LineKind::Boundary { BOUNDARY_BONUS * spacing } else { 0.0 }
}
