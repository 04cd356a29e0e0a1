//! Branching and filling (checklist M-007 to M-014, M-020 to M-028, M-042).
//!
//! Every place on a stem where a branch could leave, to either side, is tried with the longest
//! branch of its level, then with shorter ones, until one touches nothing. The longest of all
//! places goes first; then all that it is in the way of are tried again. So large curls settle
//! first and small ones between them, as in the largest-empty-circle methods, and branches
//! alternate because a curl leaves no room for another beside it.
//!
//! `--places equal` is the article's rule instead: N places at equal intervals, alternate
//! sides, in order.
//!
//! Departures, all where the papers' rule makes stubs or seams. A child starts as wide as its
//! parent is there (M-016), but never wider than a share of its own length. The last of the
//! article's N places is the very tip, where nothing can fork; the N places lie between the
//! ends here.

mod place;

use super::cells::{Cells, Owner};
use super::clip_art::{Choices, Library, PlacedArt};
use super::params::{Params, Sizes, of_level};
use super::particle::{Charge, Form, Law, Node, follow, unit};
use super::plait::{self, Crossing};
use super::stem::{Stem, Taper};
use crate::geom::segment::point_segment;
use crate::rng::Rng;
use kurbo::{Point, Rect, Vec2};
use std::collections::BinaryHeap;

/// A curl ends where its width times its curvature is more than this.
const TIGHT: f64 = 1.3;
/// Each try is this much shorter than the one before.
const SHORTER: f64 = 0.87;
/// A branch is at least this many times longer than it is wide.
const SLENDER: f64 = 13.0;
/// And at most so many times.
const LONGEST_WIDTHS: f64 = 75.0;
/// Both sides of a stem, in the order they are tried.
const SIDES: [f64; 2] = [1.0, -1.0];
/// Forks of one stem are at least this many widths apart on one side.
const FORK_WIDTHS: f64 = 3.0;

/// A plant while it grows in one container.
pub(super) struct Plant<'a> {
    pub params: &'a Params,
    pub sizes: &'a Sizes,
    library: &'a Library,
    pub cells: Cells,
    /// Width of what repeats sideways.
    pub period: Option<f64>,
    forms: Vec<Form>,
    charge: &'a Charge,
    pub stems: Vec<Stem>,
    /// The box around what each stem claims.
    boxes: Vec<Rect>,
    pub arts: Vec<PlacedArt>,
    /// Where branches cross.
    pub crossings: Vec<Crossing>,
    /// Where clip art is attached to each stem: the arc length there, and its size.
    attached: Vec<Vec<(f64, f64)>>,
    /// The stretches of each stem in whose stroke a branch still lies that has left it.
    shared: Vec<Vec<(f64, f64)>>,
    /// From which arc length on each stem is clear of its parent's stroke.
    partings: Vec<f64>,
    /// How many stems have had their branches.
    grown: usize,
    forks: Choices,
    tips: Choices,
    rng: Rng,
    noise: Vec<(Vec2, f64)>,
    /// [`place::LEAN`] as unit vectors.
    leans: [Vec2; 4],
}

/// A place where a branch may leave.
#[derive(Clone, Copy, Debug)]
struct Site {
    parent: usize,
    /// The parent there.
    start: Node,
    s: f64,
    side: f64,
}

/// Twice the index of a site, one more for its other side, and the length to try there next, the longest first.
#[derive(Clone, Copy, Debug)]
struct Offer {
    length: f64,
    site: usize,
}

impl PartialEq for Offer {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Offer {}

impl PartialOrd for Offer {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Offer {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.length.total_cmp(&other.length).then(other.site.cmp(&self.site))
    }
}

impl<'a> Plant<'a> {
    /// An empty container.
    pub fn new(
        (params, sizes): (&'a Params, &'a Sizes),
        (library, charge): (&'a Library, &'a Charge),
        (forks, tips): (Choices, Choices),
        cells: Cells,
        mut rng: Rng,
    ) -> Self {
        let euler = params.integrator == "euler";
        let form = |level: usize| {
            let alpha = of_level(&params.alpha, level).unwrap_or(0.5);
            Form::new(charge, alpha, of_level(&params.turns, level).unwrap_or(1.0), euler)
        };
        // A few plane waves of about the size of a curl make a gentle, endless noise.
        const WAVES: usize = 6;
        let scale = 0.15 * sizes.length.iter().copied().fold(0.0, f64::max);
        let noise = (0..WAVES)
            .map(|_| {
                let wave = unit(rng.between(0.0, std::f64::consts::TAU)) / (scale * rng.between(0.6, 1.6));
                (wave, rng.between(0.0, std::f64::consts::TAU))
            })
            .collect();
        Plant {
            params,
            sizes,
            library,
            period: cells.span().map(|(_, width)| width),
            cells,
            forms: (0..params.levels).map(form).collect(),
            charge,
            stems: Vec::new(),
            boxes: Vec::new(),
            arts: Vec::new(),
            crossings: Vec::new(),
            attached: Vec::new(),
            shared: Vec::new(),
            partings: Vec::new(),
            grown: 0,
            forks,
            tips,
            rng,
            noise,
            leans: place::LEAN.map(unit),
        }
    }

    /// Adds a stem that is known to fit.
    pub fn add(&mut self, mut stem: Stem) -> usize {
        let index = self.stems.len();
        self.attached.push(Vec::new());
        self.shared.push(Vec::new());
        let parting = self.parting(&stem);
        self.partings.push(parting);
        if let Some((parent, s)) = stem.parent {
            self.shared[parent].push((s, s + parting));
        }
        // A curl ends where it gets tighter than it is wide.
        let tight = stem.nodes.iter().find(|node| node.curvature.abs() * stem.width(node.s) > TIGHT);
        stem.end = tight.map_or(stem.length(), |node| node.s).max(0.5 * stem.length());
        let gap = self.sizes.gap;
        // Discs may be as far apart as they are large: `apart` makes up for it.
        let width = stem.width(0.5 * stem.end);
        for disc in discs(&stem, self.cells.size().max(0.4 * width)) {
            self.cells.claim(index, disc.at, disc.radius, disc.apart, disc.s);
        }
        for disc in discs(&stem, self.cells.size().max(0.4 * width + 0.6 * gap)) {
            self.cells.claim_gap(index, disc.at, disc.radius + gap, disc.apart, disc.s);
        }
        let first = Rect::from_points(stem.nodes[0].p, stem.nodes[0].p);
        let claimed = width.max(stem.taper.start) + gap + 2.0 * self.cells.size();
        self.boxes
            .push(stem.nodes.iter().fold(first, |all, node| all.union_pt(node.p)).inflate(claimed, claimed));
        self.stems.push(stem);
        index
    }

    /// Adds a main stem, and what grows at its tip.
    pub fn add_main(&mut self, stem: Stem) {
        let index = self.add(stem);
        self.place_tip(index);
    }

    /// Lets all levels grow from the stems there are, `go_on` willing. False if it was not.
    pub fn branch(&mut self, most: usize, go_on: impl FnMut(f64) -> bool) -> bool {
        let finished = if self.params.places == "equal" {
            self.branch_in_order(most, go_on)
        } else {
            self.branch_by_length(most, go_on)
        };
        self.grown = self.stems.len();
        finished
    }

    /// The longest first, wherever there is room.
    fn branch_by_length(&mut self, most: usize, mut go_on: impl FnMut(f64) -> bool) -> bool {
        let (mut heap, mut sites) = (BinaryHeap::new(), Vec::new());
        // Stems from before have had their turn.
        for parent in self.grown..self.stems.len() {
            self.offer(parent, &mut heap, &mut sites);
        }
        let mut forks: Vec<Vec<(f64, f64)>> = vec![Vec::new(); self.stems.len()];
        let mut popped = 0;
        while let Some(offer) = heap.pop() {
            const ASK_EVERY: usize = 64;
            popped += 1;
            if popped % ASK_EVERY == 0 && !go_on(self.stems.len() as f64 / most as f64) {
                return false;
            }
            let mut site: Site = sites[offer.site / 2];
            site.side = SIDES[offer.site % 2];
            let stem = &self.stems[site.parent];
            let limit = of_level(&self.params.branches, stem.level).unwrap_or(0.0) as usize;
            let apart = FORK_WIDTHS * (stem.width(site.s) + self.sizes.gap);
            let taken = &forks[site.parent];
            let close = |&(s, side): &(f64, f64)| {
                (s - site.s).abs() < if side == site.side { 2.0 * apart } else { 0.5 * apart }
            };
            if taken.len() >= limit || taken.iter().any(close) || self.is_occupied(site.parent, site.s) {
                continue;
            }
            // What a look rules out needs no turn of its own.
            let length = self.not_ruled_out(&site, offer.length);
            if length < self.shortest() {
                continue;
            }
            if length < offer.length {
                heap.push(Offer { length, ..offer });
                continue;
            }
            match self.fitting(&site, length, length * SHORTER * 1.01) {
                Some((branch, crossings)) => {
                    forks[site.parent].push((site.s, site.side));
                    self.crossings = crossings;
                    let index = self.grow(branch, &site);
                    forks.push(Vec::new());
                    if self.stems.len() >= most {
                        return false;
                    }
                    self.offer(index, &mut heap, &mut sites);
                }
                None => heap.push(Offer { length: length * SHORTER, ..offer }),
            }
        }
        true
    }

    /// Places on a stem, with the longest that may leave there.
    fn offer(&self, parent: usize, heap: &mut BinaryHeap<Offer>, sites: &mut Vec<Site>) {
        let stem = &self.stems[parent];
        if stem.level + 1 >= self.params.levels {
            return;
        }
        let length = stem.end;
        let step = (1.4 * stem.taper.start + self.sizes.gap).max(length / 32.0);
        // Not at the very start, where the parent is still near, nor under the tip's flower.
        let mut s = match stem.parent {
            Some(_) => (0.06 * length).max(2.0 * step).max(self.partings[parent]),
            None => 0.6 * step,
        };
        while s < 0.96 * length {
            // What is taken stays so: most places are ruled out at once, while the stem is at hand.
            if !self.is_occupied(parent, s) {
                let (site, longest) = (2 * sites.len(), self.longest(parent, s));
                let start = Site { parent, start: stem.at(s), s, side: SIDES[0] };
                for (i, side) in SIDES.into_iter().enumerate() {
                    let length = self.not_ruled_out(&Site { side, ..start }, longest);
                    if length >= self.shortest() {
                        heap.push(Offer { length, site: site + i });
                    }
                }
                sites.push(start);
            }
            s += step;
        }
    }

    /// The arc length from which on a branch is clear of its parent's stroke. What left it before
    /// would start in that stroke as well.
    fn parting(&self, branch: &Stem) -> f64 {
        let Some((index, at)) = branch.parent else { return 0.0 };
        let parent = &self.stems[index];
        let is_in_parent = |node: &&Node| {
            let clear = 0.5 * (parent.width(at) + branch.width(node.s)) + 0.5 * self.sizes.gap;
            // A branch is not farther along its parent than along itself.
            let reach = node.s + clear;
            let first = parent.nodes.partition_point(|other| other.s < at - reach).saturating_sub(1);
            let near = parent.nodes[first..].windows(2).take_while(|pair| pair[0].s <= at + reach);
            near.into_iter().any(|pair| point_segment(node.p, pair[0].p, pair[1].p) < clear)
        };
        branch.nodes.iter().find(|node| !is_in_parent(node)).map_or(branch.length(), |node| node.s)
    }

    /// The longest branch that the rules allow.
    fn longest(&self, parent: usize, s: f64) -> f64 {
        let stem = &self.stems[parent];
        let own = self.sizes.length[(stem.level + 1).min(self.sizes.length.len() - 1)];
        // A main stem that was drawn short may still carry long branches.
        let natural = self.params.rule == "natural" && stem.parent.is_some();
        // What is still to come of the parent is what nature leaves for a branch.
        let of_parent = if natural { (stem.length() - 0.6 * s).max(0.0) } else { f64::INFINITY };
        // Nor longer than its width can carry: a hair that runs through the whole shape.
        own.min(of_parent).min(LONGEST_WIDTHS * stem.width(s))
    }

    /// The article's places: N per stem at equal intervals, sides in turn, level by level.
    fn branch_in_order(&mut self, most: usize, mut go_on: impl FnMut(f64) -> bool) -> bool {
        let mut parent = self.grown;
        while parent < self.stems.len() {
            if !go_on(parent as f64 / self.stems.len() as f64) {
                return false;
            }
            let (level, length) = (self.stems[parent].level, self.stems[parent].end);
            let count = of_level(&self.params.branches, level).unwrap_or(0.0) as usize;
            let parting = self.partings[parent];
            // The first branch leaves on the inside of its parent's curl.
            let first = self.stems[parent].side;
            for i in 0..if level + 1 < self.params.levels { count } else { 0 } {
                let s = (i + 1) as f64 / (count + 1) as f64 * length;
                let side = if i % 2 == 0 { first } else { -first };
                let site = Site { parent, start: self.stems[parent].at(s), s, side };
                if s < parting || self.is_occupied(parent, s) {
                    continue;
                }
                let longest = self.longest(parent, s);
                if let Some((branch, crossings)) = self.fitting(&site, longest, self.shortest()) {
                    self.crossings = crossings;
                    self.grow(branch, &site);
                    if self.stems.len() >= most {
                        return false;
                    }
                }
            }
            parent += 1;
        }
        true
    }

    /// Nothing shorter grows: a twig as thin as the gap is as thin as anything should be.
    fn shortest(&self) -> f64 {
        5.2 * self.sizes.width
    }

    /// The longest branch at a site that touches nothing, `longest` at most and `shortest` at
    /// least.
    fn fitting(&self, site: &Site, longest: f64, shortest: f64) -> Option<(Stem, Vec<Crossing>)> {
        let parent = &self.stems[site.parent];
        let level = parent.level + 1;
        let width = parent.width(site.s);
        let mut length = longest;
        while length >= shortest {
            let taper = self.taper(width.min(length / SLENDER));
            if let Some((nodes, met)) = self.curve(site, level, length, &taper) {
                let stem = Stem::new(level, Some((site.parent, site.s)), site.side, nodes, taper);
                if let Some(crossings) =
                    self.crossings(&stem, &met).filter(|_| self.parts_from_parent(&stem, length))
                {
                    return Some((stem, crossings));
                }
            }
            length *= SHORTER;
        }
        None
    }

    /// True unless a branch runs beside its parent like a second pipe.
    fn parts_from_parent(&self, branch: &Stem, length: f64) -> bool {
        const SHARE: f64 = 0.36;
        const APART: f64 = 0.1;
        // Nor may it meet its own copies in what repeats.
        if self.period.is_some_and(|period| branch.span() + self.sizes.gap >= period) {
            return false;
        }
        let Some((index, s)) = branch.parent else { return true };
        let parent = &self.stems[index];
        let near: Vec<&Node> = parent.nodes.iter().filter(|node| (node.s - s).abs() < length).collect();
        let at = branch.at(SHARE * length).p;
        if near.iter().any(|node| node.p.distance(at) < APART * length) {
            return false;
        }
        // Nor comes back to it, once it has left.
        let half = 0.5 * parent.width(s);
        let (clear, out) = (half + 0.5 * branch.taper.start + self.sizes.gap, half + 2.0 * self.cells.size());
        let (mut is_out_from, mut has_left) = (None, false);
        for (i, node) in branch.nodes.iter().enumerate().take_while(|(_, node)| node.s < 1.2 * SHARE * length)
        {
            let to_parent = near.windows(2).map(|pair| point_segment(node.p, pair[0].p, pair[1].p));
            let apart = to_parent.fold(f64::INFINITY, f64::min);
            if has_left && apart <= clear {
                return false;
            }
            has_left |= apart > clear;
            is_out_from = is_out_from.or((apart > out).then_some(i));
        }
        // Nor lies in its stroke again, where forks are allowed to: what starts as a tight curl would leave
        // on the other side.
        let forks = branch.nodes.partition_point(|node| node.s < self.fork_reach(parent.width(s), length));
        let is_in_parent = |node: &Node| {
            let owner = self.cells.owner(node.p);
            owner.is_body() && owner.stem() == Some(index)
        };
        let way = &branch.nodes[is_out_from.unwrap_or(forks).min(forks)..forks];
        !way.iter().any(is_in_parent)
    }

    /// How a stem of this width gets thinner.
    pub fn taper(&self, start: f64) -> Taper {
        let tip = if self.params.taper == 0.0 { start } else { start * self.params.tip_width };
        Taper { start, tip, power: self.params.taper.max(1e-3) }
    }

    /// The same for a main stem that was drawn, or goes through a band.
    pub fn main_taper(&self) -> Taper {
        let taper = self.taper(self.sizes.width);
        // Where copies join, the end of one is the start of the next.
        if self.params.repeat { Taper { tip: taper.start, ..taper } } else { taper }
    }

    /// A branch of some length from a place, if it touches nothing.
    fn curve(&self, site: &Site, level: usize, length: f64, taper: &Taper) -> Option<(Vec<Node>, Vec<Met>)> {
        let fork = self.fork(site, length);
        if self.params.field == "constant" {
            // All curves of a level are similar: look first, build then.
            let form = &self.forms[level];
            let pose = Pose::new(&site.start, length, site.side);
            let total = form.length() * length;
            let nodes = form.nodes.iter().map(|node| pose.node(node));
            let met = self.way(nodes, total, taper, Some(fork))?;
            return Some((form.nodes.iter().map(|node| pose.node(node)).collect(), met));
        }
        let law = Law::new(
            self.charge,
            of_level(&self.params.alpha, level).unwrap_or(0.5),
            of_level(&self.params.turns, level).unwrap_or(1.0) * std::f64::consts::TAU,
        );
        let nodes = follow(&law, site.start, length, site.side, |p| self.strength(p));
        let met = self.way(nodes.iter().copied(), length, taper, Some(fork))?;
        Some((nodes, met))
    }

    /// The longest length, `length` at most, that a look does not rule out.
    fn not_ruled_out(&self, site: &Site, mut length: f64) -> f64 {
        if self.params.field != "constant" {
            return length;
        }
        let parent = &self.stems[site.parent];
        let (form, fork) = (&self.forms[parent.level + 1], self.fork(site, length));
        let shortest = self.shortest();
        while length >= shortest
            && self.hits_something(form, &Pose::new(&site.start, length, site.side), fork)
        {
            length *= SHORTER;
        }
        length
    }

    /// Where a branch of some length leaves its parent.
    fn fork(&self, site: &Site, length: f64) -> Fork {
        let width = self.stems[site.parent].width(site.s);
        Fork { stem: site.parent, s: site.s, reach: self.fork_reach(width, length) }
    }

    /// How far from its fork a branch of some length may touch its parent, which is so wide there.
    fn fork_reach(&self, width: f64, length: f64) -> f64 {
        (5.0 * (width + self.sizes.gap)).max(0.3 * length)
    }

    /// A look at a few places on the centre line, from the far side: most of what does not fit
    /// shows there.
    fn hits_something(&self, form: &Form, pose: &Pose, fork: Fork) -> bool {
        const LOOKS: usize = 14;
        let n = form.nodes.len();
        (1..LOOKS).rev().any(|k| {
            let node = &form.nodes[k * n / LOOKS];
            let at = pose.point(node.p);
            if self.cells.is_free(at) {
                return false;
            }
            // Who else it is does not matter, and takes longer to know.
            if !self.params.plait && self.period.is_none() && !self.boxes[fork.stem].contains(at) {
                return true;
            }
            let owner = self.cells.owner(at);
            owner.stem() != Some(fork.stem) && !(self.params.plait && owner != Owner::CLOSED)
        })
    }

    /// The same look for a curl that leaves no stem: true if any of it is taken.
    pub fn is_taken(&self, form: &Form, pose: &Pose) -> bool {
        let step = (form.nodes.len() / 14).max(1);
        form.nodes.iter().rev().step_by(step).any(|node| !self.cells.is_free(pose.point(node.p)))
    }

    /// B at a place, as a multiple of the constant field.
    fn strength(&self, at: Point) -> f64 {
        if self.params.field == "noise" {
            let sum: f64 =
                self.noise.iter().map(|(wave, phase)| libm::sin(wave.dot(at.to_vec2()) + phase)).sum();
            return 1.0 + 0.22 * sum;
        }
        // Stronger near walls, so that what comes near turns away (M-039).
        const BETA: f64 = 1.2;
        let reach = 3.0 * self.sizes.width;
        let near = |r: f64| !self.cells.is_inside(at, r);
        let distance = (1..=4).map(|k| f64::from(k) * reach / 2.0).find(|&r| near(r)).unwrap_or(4.0 * reach);
        1.0 + BETA * libm::exp(-distance / reach)
    }

    /// What a curve with a width meets: nothing but its parent near the fork, or in plait-work
    /// stems that it crosses steeply. `None` if it touches anything else.
    pub fn way(
        &self,
        nodes: impl Iterator<Item = Node>,
        length: f64,
        taper: &Taper,
        fork: Option<Fork>,
    ) -> Option<Vec<Met>> {
        let size = self.cells.size();
        let mut way = Way { left: fork.is_none(), before: 0.0, met: Vec::new(), crossing: false };
        let mut last: Option<Node> = None;
        for node in nodes {
            let half = taper.at(node.s / length) / 2.0;
            let step = size.max(half);
            if last.is_some_and(|last| node.s < last.s + 0.9 * step) && node.s < length {
                continue;
            }
            let from = last.unwrap_or(node);
            let pieces = ((node.s - from.s) / (1.3 * step)).ceil().max(1.0);
            for k in 1..=pieces as usize {
                let node = from.between(&node, k as f64 / pieces);
                if !self.goes_on(&mut way, &node, half, length, fork) {
                    return None;
                }
            }
            // A curl ends where it gets tighter than it is wide.
            if node.s > 0.5 * length && node.curvature.abs() * 2.0 * half > TIGHT {
                break;
            }
            last = Some(node);
        }
        (way.left && !way.crossing).then_some(way.met)
    }

    /// True if a curve may come to a place.
    #[inline]
    fn goes_on(&self, way: &mut Way, node: &Node, half: f64, length: f64, fork: Option<Fork>) -> bool {
        let (mut at_parent, mut at_other) = (false, None);
        let left = way.left;
        // Farther along the other stem is another winding of it.
        let nearby = 4.0 * (half + self.sizes.width + self.sizes.gap);
        let was_at = way.met.last().filter(|_| way.crossing).map(|met| met.place);
        let free = self.cells.allows(node.p, half, node.s - way.before, |owner, place| {
            if let Some(fork) = fork.filter(|fork| !left && owner.stem() == Some(fork.stem)) {
                at_parent = true;
                return (place - fork.s).abs() <= fork.reach && node.s <= fork.reach;
            }
            let other = owner.stem().filter(|_| self.params.plait && left);
            let same = other.is_some()
                && at_other.is_none_or(|(stem, at): (usize, f64)| {
                    Some(stem) == other && (at - place).abs() < nearby
                })
                && was_at.is_none_or(|at| (at - place).abs() < nearby);
            at_other = at_other.or(other.map(|stem| (stem, place)));
            same
        });
        if !free {
            return false;
        }
        way.left |= !at_parent;
        way.before = node.s;
        let was_crossing = std::mem::replace(&mut way.crossing, at_other.is_some());
        let Some((stem, place)) = at_other else {
            // It has to come out on the other side.
            return !was_crossing || way.met.last().is_none_or(|met| met.before * met.after < 0.0);
        };
        let last = way.met.last_mut().filter(|_| was_crossing);
        if !self.is_crossed(stem, place, node, (node.s, length), last.as_deref()) {
            return false;
        }
        let side = plait::side(&self.stems[stem], place, node.p);
        match last {
            Some(last) => (last.s, last.place, last.after) = (node.s, place, side),
            None => way.met.push(Met { stem, s: node.s, place, before: side, after: side }),
        }
        true
    }

    /// True if no branch may leave a stem at a place: another crosses it there, or has left and is
    /// not clear of it yet, or the base of a leaf lies within it.
    fn is_occupied(&self, stem: usize, s: f64) -> bool {
        let near = self.stems[stem].width(s) + self.sizes.gap;
        let at_base = |&(at, size): &(f64, f64)| (at - s).abs() < 0.4 * size + near;
        let is_shared = |&(from, to): &(f64, f64)| (from..to).contains(&s);
        self.is_near_crossing(stem, s)
            || self.attached[stem].iter().any(at_base)
            || self.shared[stem].iter().any(is_shared)
    }

    /// True if a place on a stem is too near a crossing for anything to grow there.
    fn is_near_crossing(&self, stem: usize, s: f64) -> bool {
        let apart = 3.0 * (self.stems[stem].width(s) + 2.0 * self.sizes.gap + self.sizes.width);
        self.crossings
            .iter()
            .flat_map(|crossing| crossing.at)
            .any(|(own, at)| own == stem && (at - s).abs() < apart)
    }

    /// True if a place on another stem may be crossed there: steeply, away from its ends and
    /// from one's own tip.
    fn is_crossed(
        &self,
        stem: usize,
        place: f64,
        node: &Node,
        (s, length): (f64, f64),
        last: Option<&Met>,
    ) -> bool {
        const FROM_ENDS: f64 = 0.06;
        let other = &self.stems[stem];
        let tangent = other.at(place).along;
        let (share, own) = (place / other.end.max(f64::MIN_POSITIVE), s / length);
        node.along.cross(tangent).abs() > plait::LEAST_SINE
            && share > FROM_ENDS
            && share < 1.0 - 2.0 * FROM_ENDS
            && own < 0.8
            && last.is_none_or(|last| last.stem == stem)
    }

    /// All crossings, those of a new branch included. `None` if over and under cannot alternate
    /// then, or where it does not cross cleanly.
    fn crossings(&self, branch: &Stem, met: &[Met]) -> Option<Vec<Crossing>> {
        /// More would hide the branch.
        const MOST: usize = 4;
        if met.is_empty() {
            return Some(self.crossings.clone());
        }
        let index = self.stems.len();
        let mut crossings = self.crossings.clone();
        for met in met {
            let other = &self.stems[met.stem];
            let (s, place) = plait::meet(branch, met.s, other, met.place)?;
            let gap = plait::GAP * self.sizes.gap;
            if !plait::is_clean((branch, s), (other, place), gap)
                || !plait::is_clean((other, place), (branch, s), gap)
            {
                return None;
            }
            // The gaps of two crossings must not run into each other, nor into a fork.
            let apart = 3.0 * (other.width(place) + branch.width(s) + 2.0 * self.sizes.gap);
            let close = |stem: usize, at: f64| {
                crossings
                    .iter()
                    .flat_map(|crossing| crossing.at)
                    .any(|(own, s)| own == stem && (s - at).abs() < apart)
            };
            let forks = self.stems.iter().filter_map(|stem| stem.parent);
            let near_fork = |(parent, s): (usize, f64)| parent == met.stem && (s - place).abs() < apart;
            let holds = |&(at, _): &(f64, f64)| (at - place).abs() < apart;
            if self.attached[met.stem].iter().any(holds)
                || close(met.stem, place)
                || close(index, s)
                || forks.into_iter().any(near_fork)
                || s < apart
            {
                return None;
            }
            crossings.push(Crossing { at: [(index, s), (met.stem, place)] });
        }
        (met.len() <= MOST && plait::alternate(&crossings).is_some()).then_some(crossings)
    }

    /// A branch in its place, and what grows at its fork and its tip.
    fn grow(&mut self, branch: Stem, site: &Site) -> usize {
        let index = self.add(branch);
        self.place_tip(index);
        self.place_fork(site, index);
        index
    }

    /// The form of a level.
    pub fn form(&self, level: usize) -> &Form {
        &self.forms[level]
    }
}

/// What is known of a curve up to some place.
struct Way {
    /// True once it has left its parent.
    left: bool,
    /// Arc length of the place before.
    before: f64,
    /// The stems that it crosses.
    met: Vec<Met>,
    /// True while it is over another stem.
    crossing: bool,
}

/// Another stem on a curve's way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Met {
    stem: usize,
    /// Arc lengths on the curve and on the other.
    s: f64,
    place: f64,
    /// On which side of the other the curve came, and left.
    before: f64,
    after: f64,
}

/// Where a branch leaves its parent: near there it may touch it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fork {
    pub stem: usize,
    pub s: f64,
    pub reach: f64,
}

/// From a form to its place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pose {
    start: Point,
    along: Vec2,
    length: f64,
    side: f64,
}

impl Pose {
    /// Starts at a node and turns to a side.
    pub fn new(start: &Node, length: f64, side: f64) -> Self {
        Pose { start: start.p, along: start.along, length, side }
    }

    fn turned(&self, v: Vec2) -> Vec2 {
        let v = Vec2::new(v.x, self.side * v.y);
        Vec2::new(self.along.x * v.x - self.along.y * v.y, self.along.y * v.x + self.along.x * v.y)
    }

    /// A point of a form in its place.
    fn point(&self, p: Point) -> Point {
        self.start + self.length * self.turned(p.to_vec2())
    }

    /// A node of a form in its place.
    pub fn node(&self, node: &Node) -> Node {
        Node {
            s: node.s * self.length,
            p: self.point(node.p),
            along: self.turned(node.along),
            curvature: self.side * node.curvature / self.length,
        }
    }
}

/// A disc under a stem.
struct Disc {
    at: Point,
    radius: f64,
    apart: f64,
    s: f64,
}

/// Discs that cover a stem, about `apart` from each other.
fn discs(stem: &Stem, apart: f64) -> Vec<Disc> {
    let mut discs = Vec::new();
    let mut before = 0.0;
    for pair in stem.nodes.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        if a.s >= stem.end {
            break;
        }
        let count = ((b.s - a.s) / apart).ceil().max(1.0);
        for k in 0..count as usize {
            let t = k as f64 / count;
            let s = a.s + t * (b.s - a.s);
            // Nodes are closer than needed where the stem curls up.
            if s - before >= 0.75 * apart || s == 0.0 {
                let radius = stem.width(s) / 2.0;
                discs.push(Disc { at: a.p.lerp(b.p, t), radius, apart: (s - before).max(apart), s });
                before = s;
            }
        }
    }
    let tip = stem.at(stem.end);
    discs.push(Disc { at: tip.p, radius: stem.width(stem.end) / 2.0, apart, s: stem.end });
    discs
}
