//! Fillers in the gaps that no element could take (FLOWPAK 6, checklist F-083): in the largest
//! empty circles, largest first, each with a gap around it.

use super::gaps::{Gaps, Place};
use super::motif::{Form, Motif, Pocket};
use super::place::Placement;
use super::prepare::{Field, Prepared};
use super::template::Template;
use crate::field::DirectionField;
use crate::geom::boolean::{Contour, signed_area};
use crate::geom::flatten::flatten;
use kurbo::{Affine, BezPath, Point, Vec2};

/// Radii in spacings: smaller reads as dust, larger as an element of another family.
const SMALLEST: f64 = 0.05;
const LARGEST: f64 = 0.21;

/// A filler in its place.
#[derive(Clone, Debug)]
pub(super) struct Filler {
    pub field: usize,
    pub motif: Motif,
    form: Form,
    pub area: f64,
}

impl Filler {
    /// Its outlines, if it is not an element.
    pub fn path(&self) -> BezPath {
        self.form.paths().flatten().collect()
    }

    /// From (u, v) of its template to its place.
    pub fn transform(&self) -> Affine {
        self.form.transform
    }
}

/// Fills the gaps of every container that asks for it. False if the time ran out first.
pub(super) fn fill(
    prepared: &Prepared,
    placement: &mut Placement,
    templates: &[Template],
    motifs: &[Vec<Motif>],
    flows: &[Option<DirectionField>],
    mut go_on: impl FnMut(f64) -> bool,
) -> (Vec<Filler>, bool) {
    let mut fillers = Vec::new();
    for (index, field) in prepared.fields.iter().enumerate().filter(|(i, _)| !motifs[*i].is_empty()) {
        let done = index as f64 / prepared.fields.len() as f64;
        let kinds = Kinds { templates, motifs: &motifs[index], flow: flows[index].as_ref() };
        if !fill_field((index, field), &kinds, placement, &mut fillers, || go_on(done)) {
            return (fillers, false);
        }
    }
    (fillers, true)
}

/// What may go into the gaps of a container.
struct Kinds<'a> {
    templates: &'a [Template],
    motifs: &'a [Motif],
    flow: Option<&'a DirectionField>,
}

fn fill_field(
    (index, field): (usize, &Field),
    kinds: &Kinds,
    placement: &mut Placement,
    fillers: &mut Vec<Filler>,
    mut go_on: impl FnMut() -> bool,
) -> bool {
    let spacing = field.sizes.spacing;
    let (smallest, largest) = (SMALLEST * spacing, LARGEST * spacing);
    // Strokes reach beyond the outlines that distances are measured to.
    let own = kinds.motifs.iter().map(|motif| motif.widest_stroke(largest, kinds.templates));
    let stroke = own.fold(placement.widest_stroke(), f64::max);
    let mut gaps = Gaps::new(field, &placement.silhouettes, largest, field.sizes.filler_gap + stroke);
    let mut heap = gaps.middles(smallest);
    const ASK_EVERY: usize = 256;
    let mut popped = 0;
    while let Some(place) = heap.pop() {
        popped += 1;
        if popped % ASK_EVERY == 0 && !go_on() {
            return false;
        }
        // The middle may be up to a diagonal of a cell away.
        if gaps.clearance(placement.outlines(), place.at()) < smallest - gaps.step {
            continue;
        }
        let (centre, radius) = gaps.centred(placement.outlines(), place.at());
        if radius < smallest {
            continue;
        }
        if radius < place.clearance() && heap.peek().is_some_and(|next| radius < next.clearance()) {
            // The estimate was too good, or a filler placed since then took some of the room.
            heap.push(Place::new(centre, radius));
            continue;
        }
        let radius = radius.min(largest);
        let (filler, outlines) = best(index, field, kinds, placement, &gaps, (centre, radius));
        for outline in &outlines {
            placement.add_outline(outline, filler.motif.stroke(filler.transform(), kinds.templates));
            if filler.motif != Motif::Dot {
                gaps.add(outline);
            }
        }
        if filler.motif == Motif::Dot {
            gaps.add_disc(centre, radius);
        }
        // What is left of a long gap begins beside the new filler.
        let beside = radius + field.sizes.filler_gap + stroke + smallest;
        for k in 0..8 {
            let angle = f64::from(k) * std::f64::consts::FRAC_PI_4;
            let at = centre + beside * Vec2::new(libm::cos(angle), libm::sin(angle));
            let free = gaps.clearance(placement.outlines(), at);
            if free > smallest - gaps.step {
                heap.push(Place::new(at, free.max(0.0) + gaps.step));
            }
        }
        fillers.push(filler);
    }
    true
}

/// The largest filler for a gap, and its outlines.
fn best(
    index: usize,
    field: &Field,
    kinds: &Kinds,
    placement: &Placement,
    gaps: &Gaps,
    (centre, radius): (Point, f64),
) -> (Filler, Vec<Contour>) {
    let pocket = pocket(kinds, placement, gaps, (centre, radius));
    let in_place = |motif: Motif, form: Form| {
        let outlines: Vec<Contour> = form
            .paths()
            .flat_map(|path| flatten(&path, field.sizes.tolerance()))
            .map(|subpath| subpath.points)
            .collect();
        let area = outlines.iter().map(|outline| signed_area(outline).abs()).sum();
        (Filler { field: index, motif, form, area }, outlines)
    };
    let largest = |motif: Motif| {
        let mut forms = motif.forms(&pocket, kinds.templates);
        // The last always goes.
        let last = forms.pop().map(|form| in_place(motif, form));
        let mut tried = forms.into_iter().map(|form| in_place(motif, form));
        let goes = |(filler, outlines): &(Filler, Vec<Contour>)| {
            let stroke = motif.stroke(filler.transform(), kinds.templates);
            placement.filler_goes(outlines, stroke, field)
        };
        tried.find(goes).or(last)
    };
    let all = kinds.motifs.iter().filter_map(|&motif| largest(motif));
    let best = all.reduce(|best, other| if other.0.area > best.0.area { other } else { best });
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
    if kinds.motifs == [Motif::Dot] {
        return pocket;
    }
    let reach = |along: Vec2| {
        let mut walked = radius;
        while walked < FARTHEST * radius {
            let free = gaps.clearance(placement.outlines(), centre + walked * along);
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
