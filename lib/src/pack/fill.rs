//! Fillers in the gaps that no element could take (FLOWPAK 6, checklist F-083): in the largest
//! empty circles, largest first, each with a gap around it.

use super::gaps::{Gaps, Inked, Place};
use super::insert::Ground;
use super::motif::{Form, Motif, Pocket};
use super::place::Placement;
use super::prepare::Field;
use super::template::Template;
use crate::field::DirectionField;
use crate::geom::boolean::{Contour, signed_area};
use crate::geom::flatten::flatten;
use crate::geom::polyline;
use crate::geom::region::Region;
use crate::geom::warp::Warp;
use crate::shapes::closed;
use kurbo::{Affine, BezPath, Point, Vec2};

/// Rounds in which the middle of a gap is found.
const ROUNDS: usize = 16;
/// The largest radius, in spacings: larger reads as an element of another family.
const LARGEST: f64 = 0.21;

/// What room a filler needs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Room {
    /// The least radius, in spacings.
    smallest: f64,
    /// How fine the gaps are seen, in spacings.
    step: f64,
    /// True in nooks: where a gap is wider than others and nothing else fits, a speck may come nearer than
    /// other fillers do.
    nooks: bool,
}

/// Smaller ones read as dust where there is room for others.
pub(super) const GAPS: Room = Room { smallest: 0.05, step: 1.0 / 13.0, nooks: false };
pub(super) const NOOKS: Room = Room { smallest: 0.013, step: 1.0 / 24.0, nooks: true };

/// The widest gap that stays as it is, over the mean of all as the grid sees it, which is a little more than it is.
/// In channels of one width, three pieces that meet leave 1.15.
const WIDEST: f64 = 1.13;

impl Room {
    /// Where fillers may be, and the gap around them.
    fn of(self, field: &Field) -> (&Region, f64) {
        match self.nooks {
            true => (&field.nooks, field.sizes.nook_gap),
            false => (&field.region, field.sizes.filler_gap),
        }
    }

    /// The least radius, where gaps are channels of twice this `mean` width.
    fn smallest(self, field: &Field, mean: f64) -> f64 {
        let sizes = &field.sizes;
        let least = self.smallest * sizes.spacing;
        if self.nooks { least.max(WIDEST * mean - sizes.safe(sizes.nook_gap)) } else { least }
    }
}

/// All that is placed, with its strokes.
fn inked(placement: &Placement) -> Inked<'_> {
    Inked { outlines: placement.outlines(), strokes: placement.strokes(), widest: placement.widest_stroke() }
}

/// A filler in its place.
#[derive(Clone, Debug)]
pub(super) struct Filler {
    pub field: usize,
    pub motif: Motif,
    form: Form,
    pub area: f64,
    /// Half its stroke width.
    pub stroke: f64,
    /// What keeps apart from neighbours.
    pub outlines: Vec<Contour>,
    /// How it is moulded, and into what.
    pub warps: Vec<Warp>,
    pub moulded: Option<BezPath>,
}

impl Filler {
    /// Its outlines before it is moulded.
    pub fn plain(&self) -> BezPath {
        self.form.paths().flatten().collect()
    }

    /// Its outlines, if it is not an element.
    pub fn path(&self) -> BezPath {
        self.moulded.clone().unwrap_or_else(|| self.plain())
    }

    /// From (u, v) of its template to its place.
    pub fn transform(&self) -> Affine {
        self.form.transform
    }
}

/// Fills the gaps of every container that asks for it. False if the time ran out first.
pub(super) fn fill(
    ground: &Ground,
    motifs: &[Vec<Motif>],
    placement: &mut Placement,
    fillers: &mut Vec<Filler>,
    room: Room,
    mut go_on: impl FnMut(f64) -> bool,
) -> bool {
    let &Ground { prepared, templates, flows, .. } = ground;
    let kinds = |index: usize| Kinds { templates, motifs: &motifs[index], flow: flows[index].as_ref() };
    let mut covered = placement.silhouettes();
    covered.extend(fillers.iter().flat_map(|filler| &filler.outlines));
    let mut all: Vec<(usize, Gaps)> = Vec::new();
    for (index, field) in prepared.fields.iter().enumerate().filter(|(i, _)| !motifs[*i].is_empty()) {
        if !go_on(0.5 * index as f64 / prepared.fields.len() as f64) {
            return false;
        }
        let (region, gap) = room.of(field);
        let sizes = (
            LARGEST * field.sizes.spacing,
            gap + kinds(index).stroke(field),
            room.step * field.sizes.spacing,
        );
        all.push((index, Gaps::new(field, region, &covered, sizes)));
    }
    // Strokes take a part of the gaps that outlines leave.
    let mean = if room.nooks { mean_gap(&all) - mean_stroke(placement, fillers, &all) } else { 0.0 };
    for (done, (index, gaps)) in all.into_iter().enumerate() {
        let field = &prepared.fields[index];
        let done = 0.5 + 0.5 * done as f64 / prepared.fields.len() as f64;
        let smallest = room.smallest(field, mean);
        if !fill_field((index, field), &kinds(index), placement, fillers, (room, gaps, smallest), || {
            go_on(done)
        }) {
            return false;
        }
    }
    true
}

/// Twice the mean distance in gaps to what is beside them: half their width, if they are channels.
fn mean_gap(all: &[(usize, Gaps)]) -> f64 {
    let all = all.iter().map(|(_, gaps)| gaps.emptiness());
    let (area, sum) = all.fold((0.0, 0.0), |all, one| (all.0 + one.0, all.1 + one.1));
    2.0 * sum / f64::max(area, f64::MIN_POSITIVE)
}

/// Half the mean stroke width along all outlines, those of regions too, which have none.
fn mean_stroke(placement: &Placement, fillers: &[Filler], all: &[(usize, Gaps)]) -> f64 {
    if placement.widest_stroke() == 0.0 {
        return 0.0;
    }
    let length = |contours: &[Contour]| -> f64 {
        contours.iter().map(|contour| polyline::length(&closed(contour))).sum()
    };
    let outlines = placement.placed.iter().map(|placed| &placed.outlines);
    let outlines = outlines.chain(fillers.iter().map(|filler| &filler.outlines));
    let mut total: f64 = all.iter().map(|(_, gaps)| length(gaps.region().contours())).sum();
    let mut sum = 0.0;
    for (length, stroke) in outlines.map(|outlines| length(outlines)).zip(placement.strokes()) {
        sum += length * stroke;
        total += length;
    }
    sum / total.max(f64::MIN_POSITIVE)
}

/// What may go into the gaps of a container.
struct Kinds<'a> {
    templates: &'a [Template],
    motifs: &'a [Motif],
    flow: Option<&'a DirectionField>,
}

impl Kinds<'_> {
    /// Half of the widest stroke that a filler can have, beyond its outline.
    fn stroke(&self, field: &Field) -> f64 {
        let largest = LARGEST * field.sizes.spacing;
        self.motifs.iter().map(|motif| motif.widest_stroke(largest, self.templates)).fold(0.0, f64::max)
    }
}

fn fill_field(
    (index, field): (usize, &Field),
    kinds: &Kinds,
    placement: &mut Placement,
    fillers: &mut Vec<Filler>,
    (room, mut gaps, smallest): (Room, Gaps, f64),
    mut go_on: impl FnMut() -> bool,
) -> bool {
    let largest = LARGEST * field.sizes.spacing;
    let mut heap = gaps.places(inked(placement), smallest);
    const ASK_EVERY: usize = 256;
    let mut popped = 0;
    while let Some(place) = heap.pop() {
        popped += 1;
        if popped % ASK_EVERY == 0 && !go_on() {
            return false;
        }
        // What was placed since then may have taken the room.
        let near = (place.at(), gaps.fineness());
        let Some(left) = gaps.room_near(inked(placement), near, smallest) else { continue };
        let (centre, radius) = gaps.centred(inked(placement), place.at(), (smallest, ROUNDS));
        if radius < smallest {
            continue;
        }
        // Whether the place itself has room when the middle is taken shows only then.
        if centre.distance(place.at()) > gaps.fineness() {
            heap.push(Place::new(place.at(), left.most.min(radius.next_down()).max(0.0)));
        }
        if radius < place.clearance() && heap.peek().is_some_and(|next| radius < next.clearance()) {
            // The estimate was too good, or a filler placed since then took some of the room.
            heap.push(Place::new(centre, radius));
            continue;
        }
        let radius = radius.min(largest);
        let filler = best((index, field), room, kinds, placement, &gaps, (centre, radius));
        placement.add_filler(&filler.outlines, filler.stroke);
        if filler.motif.is_round() {
            gaps.add_disc(centre, radius);
        } else {
            filler.outlines.iter().for_each(|outline| gaps.add(outline));
        }
        fillers.push(filler);
    }
    true
}

/// The largest filler for a gap.
fn best(
    (index, field): (usize, &Field),
    room: Room,
    kinds: &Kinds,
    placement: &Placement,
    gaps: &Gaps,
    (centre, radius): (Point, f64),
) -> Filler {
    let (region, gap) = room.of(field);
    let pocket = pocket(kinds, placement, gaps, (centre, radius));
    let in_place = |motif: Motif, form: Form| {
        let outlines: Vec<Contour> = form
            .paths()
            .flat_map(|path| flatten(&path, field.sizes.tolerance()))
            .map(|subpath| subpath.points)
            .collect();
        let area = outlines.iter().map(|outline| signed_area(outline).abs()).sum();
        let stroke = motif.stroke(form.transform, kinds.templates);
        Filler { field: index, motif, form, area, stroke, outlines, warps: Vec::new(), moulded: None }
    };
    let largest = |motif: Motif| {
        let mut forms = motif.forms(&pocket, kinds.templates);
        // The last always goes.
        let last = forms.pop().map(|form| in_place(motif, form));
        let mut tried = forms.into_iter().map(|form| in_place(motif, form));
        let goes =
            |filler: &Filler| placement.filler_goes(&filler.outlines, filler.stroke, (field, region, gap));
        tried.find(goes).or(last)
    };
    let all = kinds.motifs.iter().filter_map(|&motif| largest(motif));
    let best = all.reduce(|best, other| if other.area > best.area { other } else { best });
    best.unwrap_or_else(|| in_place(Motif::Dot, Motif::Dot.forms(&pocket, kinds.templates).swap_remove(0)))
}

/// How far a gap runs from its middle, and which way: where it is longest, along the flow if that is about
/// as long.
fn pocket(kinds: &Kinds, placement: &Placement, gaps: &Gaps, (centre, radius): (Point, f64)) -> Pocket {
    const WAYS: usize = 12;
    /// Longer is of no use.
    const FARTHEST: f64 = 3.5;
    let x = Vec2::new(1.0, 0.0);
    let flow = kinds.flow.and_then(|flow| flow.direction(centre, x)).unwrap_or(x);
    let mut pocket = Pocket { centre, radius, along: flow, reach: [radius; 2] };
    if kinds.motifs.iter().all(|motif| motif.is_round()) {
        return pocket;
    }
    let reach = |along: Vec2| {
        let mut walked = radius;
        while walked < FARTHEST * radius {
            let free = gaps.clearance(inked(placement), centre + walked * along);
            if free < 0.15 * radius {
                break;
            }
            walked += free;
        }
        walked.min(FARTHEST * radius)
    };
    let way = |k: usize| {
        let angle = k as f64 / WAYS as f64 * 2.0 * std::f64::consts::PI;
        let (sin, cos) = (libm::sin(angle), libm::cos(angle));
        (Vec2::new(flow.x * cos - flow.y * sin, flow.x * sin + flow.y * cos), cos)
    };
    let reaches: Vec<f64> = (0..WAYS).map(|k| reach(way(k).0)).collect();
    let mut most = 0.0;
    for k in 0..WAYS {
        let (along, cos) = way(k);
        let back = reaches[(k + WAYS / 2) % WAYS];
        let score = (reaches[k] + 0.5 * back) * (0.8 + 0.2 * cos.abs());
        if score > most {
            most = score;
            pocket = Pocket { along, reach: [reaches[k], back], ..pocket };
        }
    }
    pocket
}
