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

mod order;
mod place;
mod way;

use super::cells::{Cells, Owner};
use super::clip_art::{Choices, Library, PlacedArt};
use super::params::{Params, Sizes, of_level};
use super::particle::{Charge, Form, Law, Node, follow, unit};
use super::plait::Crossing;
use super::stem::{Stem, Taper};
use crate::geom::segment::point_segment;
use crate::rng::Rng;
use kurbo::{Point, Rect, Vec2};
pub(super) use way::{Fork, Met};

/// A curl ends where its width times its curvature is more than this.
const TIGHT: f64 = 1.3;
/// Each try is this much shorter than the one before.
const SHORTER: f64 = 0.87;
/// A branch is at least this many times longer than it is wide.
const SLENDER: f64 = 13.0;
/// Both sides of a stem, in the order they are tried.
const SIDES: [f64; 2] = [1.0, -1.0];

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
