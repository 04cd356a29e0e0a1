//! Outlines give way, so that gaps become channels of one width (ours; evener gaps than bending gives are
//! what FLOWPAK leaves open in its section 6).
//!
//! Bending moves an element as a whole: where three of them meet, or where two part, gaps stay wider
//! than elsewhere, and too narrow for a filler with gaps of its own. Here the outline of every piece grows
//! into the space beside it, sample by sample, by no more than its share of what is there beyond the gap,
//! and as smoothly as its stage allows: a wide stage before gaps are filled, so that few fillers are
//! needed, then closer ones, which reach the corners. What is drawn in an element moves with its outline
//! (`geom::warp`).
//!
//! All pieces move at once, each within its share, so that neither their order nor the number of threads
//! matters. What comes of it is checked exactly, outline by outline, as in `place`; pieces that
//! come too near move less far, or stay as they were (`settle`).

use super::fill::Filler;
use super::params::Sizes;
use super::place::Placement;
use super::prepare::{Field, Prepared};
use super::settle;
use super::skin::{Allowances, Held, Moving, OTHERS, Skin};
use super::template::Template;
use crate::geom::boolean::Contour;
use crate::geom::near::PointTable;
use rayon::prelude::*;

/// One go at moulding. Lengths in spacings.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stage {
    /// How far a push is felt: what is moulded is no sharper.
    radius: f64,
    /// The farthest push.
    most: f64,
    iterations: usize,
}

/// Before gaps are filled, and after that, into the corners.
pub(super) struct Stages {
    pub wide: [Stage; 1],
    pub close: [Stage; 2],
}

/// Where the widest gaps are for fillers.
pub(super) const BETWEEN: Stages =
    Stages { wide: [stage(0.15, 0.14, 6)], close: [stage(0.065, 0.065, 4), stage(0.03, 0.025, 3)] };
/// Where there will be none: outlines have to go farther.
pub(super) const ALONE: Stages =
    Stages { wide: [stage(0.25, 0.25, 8)], close: [stage(0.12, 0.1, 5), stage(0.05, 0.05, 5)] };

const fn stage(radius: f64, most: f64, iterations: usize) -> Stage {
    Stage { radius, most, iterations }
}

/// Where gaps are to become shapes themselves, they stay as wide as they are.
fn is_moulded(field: &Field) -> bool {
    let params = &field.params;
    params.mould > 0.0 && params.iterations > 0 && !params.has_shapes()
}

/// The farthest push in one iteration, in spacings, and as a share of the farthest of all.
const STEP: (f64, f64) = (0.03, 0.5);
/// A sample that may move no farther than this, in spacings, will not: what is beside it only grows.
const CLOSED: f64 = 3e-3;

/// Moulds elements and pebbles. False if the time ran out first.
pub(super) fn mould(
    prepared: &Prepared,
    templates: &[Template],
    placement: &mut Placement,
    fillers: &mut [Filler],
    stages: &[Stage],
    mut go_on: impl FnMut(f64) -> bool,
) -> bool {
    if !prepared.fields.iter().any(is_moulded) {
        return true;
    }
    let pieces = Pieces::new(prepared, placement);
    // Between stages, outlines are moved corner by corner; only what comes of all is bent anew and checked.
    let moving = |index: usize, outlines: &[Contour], gives_way: bool| {
        let field = &prepared.fields[index];
        Moving::new(index, outlines, gives_way && is_moulded(field), field.sizes.spacing)
    };
    let of_elements = placement.placed.par_iter().map(|placed| moving(placed.field, &placed.outlines, true));
    let of_fillers =
        fillers.par_iter().map(|filler| moving(filler.field, &filler.outlines, filler.motif.gives_way()));
    let mut all: Vec<Moving> = of_elements.chain(of_fillers).collect();
    let cell = prepared.fields.iter().map(|field| field.sizes.safe_gap()).fold(0.0, f64::max);
    let mut others =
        Others { table: PointTable::new(prepared.bounds, cell, std::iter::empty()), gives_way: Vec::new() };
    let mut complete = true;
    for (k, &stage) in stages.iter().enumerate() {
        let skin = |moving: &Moving| {
            let spacing = prepared.fields[moving.field].sizes.spacing;
            Skin::new(moving, spacing, stage.radius * spacing)
        };
        let mut skins: Vec<Skin> = all.par_iter().map(skin).collect();
        for iteration in 0..stage.iterations {
            let done = iteration as f64 / stage.iterations as f64;
            complete = complete && go_on((k as f64 + done) / stages.len() as f64);
            if complete {
                pieces.grow(&mut skins, &mut others, stage);
            }
        }
        all.par_iter_mut().zip(skins).for_each(|(moving, skin)| moving.go(skin));
    }
    settle::settle(prepared, templates, placement, fillers, &all);
    complete
}

/// What pieces see of each other.
struct Others {
    /// Samples with the numbers of their pieces.
    table: PointTable<u32>,
    gives_way: Vec<bool>,
}

impl Others {
    fn see(&mut self, skins: &[Skin]) {
        let all = skins.iter().zip(0..);
        self.table.fill(all.flat_map(|(skin, i)| skin.seen.iter().map(move |&k| (skin.now[k as usize], i))));
        self.gives_way.clear();
        self.gives_way.extend(skins.iter().map(|skin| skin.gives_way));
    }
}

/// What pieces keep between them. Fillers are numbered after elements.
pub(super) struct Pieces<'a> {
    pub prepared: &'a Prepared,
    /// Half stroke widths, and the widest.
    pub strokes: &'a [f64],
    widest: f64,
    pub elements: usize,
}

impl<'a> Pieces<'a> {
    pub fn new(prepared: &'a Prepared, placement: &'a Placement) -> Self {
        let (strokes, widest) = (placement.strokes(), placement.widest_stroke());
        Pieces { prepared, strokes, widest, elements: placement.placed.len() }
    }

    /// The gap between the outlines of two pieces.
    pub fn gap(&self, sizes: &Sizes, one: usize, other: usize) -> f64 {
        let both_elements = one < self.elements && other < self.elements;
        let gap = if both_elements { sizes.gap } else { sizes.filler_gap };
        sizes.safe(gap) + self.strokes[one] + self.strokes[other]
    }

    /// The most that [`Pieces::gap`] can be for a piece.
    pub fn widest_gap(&self, sizes: &Sizes, one: usize) -> f64 {
        sizes.safe(sizes.gap.max(sizes.filler_gap)) + self.strokes[one] + self.widest
    }

    /// One iteration.
    fn grow(&self, skins: &mut [Skin], others: &mut Others, stage: Stage) {
        let fields = &self.prepared.fields;
        others.see(skins);
        let others = &*others;
        // Each looks only at the last state of others, so any number of threads gives the same.
        let grow = |(own, skin): (usize, &mut Skin)| {
            let field = &fields[skin.field];
            let spacing = field.sizes.spacing;
            let limit = STEP.0.min(STEP.1 * stage.most) * spacing;
            let allowed = self.allowances(own, skin, others, limit);
            skin.grow(&allowed, field.params.mould * stage.most * spacing, CLOSED * spacing);
        };
        skins.par_iter_mut().enumerate().filter(|(_, skin)| skin.gives_way).for_each(grow);
    }

    /// How far each sample of a piece may move, `limit` at most.
    fn allowances(&self, own: usize, skin: &Skin, others: &Others, limit: f64) -> Allowances {
        /// Cosine of the widest angle between a normal and what it faces.
        const FACING: f64 = 0.5;
        let field = &self.prepared.fields[skin.field];
        let sizes = &field.sizes;
        // Nearest samples are up to half a step beside the nearest points.
        let beside = (skin.step.max(OTHERS * sizes.spacing) / 2.0).powi(2);
        let reach = self.widest_gap(sizes, own) + 2.0 * limit + skin.step;
        let margin = self.strokes[own] + sizes.tolerance();
        // A sample with no room left holds those near it; who has none but such beside it need not ask.
        let (ties, held, n) = (&skin.ties, &skin.held, skin.now.len());
        let mut is_free = vec![false; n];
        for &i in &skin.moved {
            let Held { closed, still } = held[i as usize];
            is_free[i as usize] = !closed && !still && !ties.any(i as usize, |j| held[j].closed);
        }
        let is_asked = |&i: &u32| !held[i as usize].closed && ties.any(i as usize, |j| is_free[j]);
        let asked: Vec<u32> = skin.moved.iter().copied().filter(is_asked).collect();
        let free: Vec<u32> = asked.iter().copied().filter(|&i| is_free[i as usize]).collect();
        let places = asked.iter().map(|&i| skin.now[i as usize]);
        let near_edge = !field.region.holds_circle(places, limit + margin);
        let (mut all_to_others, mut all_to_itself) = (vec![0.0; n], vec![0.0; n]);
        for &i in &asked {
            let i = i as usize;
            let p = skin.now[i];
            let (mut to_others, mut to_itself) = (limit, limit);
            let normal = skin.normal(i);
            others.table.near(p, reach).for_each(|(q, other)| {
                let squared = q.distance_squared(p);
                if squared >= reach * reach {
                    return;
                }
                let apart = || (squared - beside).max(0.0).sqrt() - sizes.tolerance();
                if other as usize != own {
                    let share = if others.gives_way[other as usize] { 0.5 } else { 1.0 };
                    to_others = to_others.min(share * (apart() - self.gap(sizes, own, other as usize)));
                } else if (q - p).dot(normal) > FACING * squared.sqrt() {
                    to_itself = to_itself.min(0.5 * (apart() - sizes.gap));
                }
            });
            if near_edge {
                let inside = field.region.contains(p);
                let room = if inside { field.region.distance(p, limit + margin) - margin } else { 0.0 };
                to_others = to_others.min(room);
            }
            (all_to_others[i], all_to_itself[i]) = (to_others, to_itself);
        }
        Allowances { free, asked, to_others: all_to_others, to_itself: all_to_itself }
    }
}
