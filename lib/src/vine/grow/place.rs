//! Clip art in its place (checklist M-023 to M-028): at tips, at forks, and along stems where
//! there is room.
//!
//! Departure: the article lays clip art along the branch; here it leans away from the stem, or
//! it would cover it.

use super::super::cells::Owner;
use super::super::clip_art::{PlacedArt, pick};
use super::super::particle::{Node, unit};
use super::{Plant, Site};
use crate::geom::polyline::left_of;
use kurbo::{Affine, Point, Vec2};

/// Angles between a stem and what grows beside it, in the order they are tried.
pub(super) const LEAN: [f64; 4] = [0.8, 1.1, 0.55, 1.35];

/// A place beside a stem where clip art may grow.
#[derive(Clone, Copy, Debug)]
struct Beside {
    stem: usize,
    node: Node,
    width: f64,
    side: f64,
}

impl Plant<'_> {
    /// Size of clip art on a stem.
    fn art_size(&self, level: usize) -> f64 {
        // Each level's is smaller (M-025).
        self.sizes.art * libm::pow(0.87, level.saturating_sub(1) as f64)
    }

    /// What sits at the end of a curl: as large as there is room inside it.
    pub(super) fn place_tip(&mut self, stem: usize) {
        let level = self.stems[stem].level;
        let mut rng = self.rng.fork();
        let Some(art) = pick(&self.tips[level], &mut rng) else { return };
        let full = self.stems[stem].end;
        // A flower much smaller than its fellows is dust; a bare curl is better.
        let smallest = 0.48 * self.art_size(level);
        let largest = self.art_size(level).min(0.34 * full);
        let central = self.library.arts[art].central;
        let twist = rng.between(-0.4, 0.4);
        // What others cross must stay.
        let crossings = self.crossings.iter().flat_map(|crossing| crossing.at);
        let crossed =
            crossings.filter(|at| at.0 == stem).map(|at| at.1).fold(0.0, f64::max) + 2.0 * self.sizes.width;
        let mut size = largest;
        while size > smallest {
            // Where a bud does not fit, its stem may be shorter (M-036).
            let ends: &[f64] = match (level, central) {
                // A main stem ends where it was drawn to end.
                (0, _) => &[1.0],
                (_, true) => &[1.0, 0.96],
                (_, false) => &[1.0, 0.95, 0.88, 0.8, 0.72],
            };
            for share in ends {
                let end = share * full;
                if end < crossed {
                    continue;
                }
                let tip = self.stems[stem].at(end);
                let turn = if central { twist } else { 0.0 };
                let pose = posed(tip.p, rotated(tip.along, turn), size, self.stems[stem].side > 0.0);
                // Under a flower lies the end of its own stem, and nothing else of it.
                let radius = if central { self.library.arts[art].radius * size } else { 0.0 };
                let width = self.stems[stem].width(end) + self.sizes.gap + 2.0 * self.cells.size();
                let own = self.own_end(stem, end, tip.p, radius) - 2.0 * width;
                let may = |at: Point, owner: Owner, place: f64| {
                    owner.stem() == Some(stem)
                        && place >= own
                        && (central || at.distance(tip.p) < 1.5 * width || place > end)
                };
                if self.library.arts[art].fits(pose, size, &self.cells, may) {
                    // The centre of a flower hides the end; its petals may have gaps.
                    self.stems[stem].end =
                        self.own_end(stem, end, tip.p, 0.4 * radius).min(end).max(crossed.min(end));
                    self.place(art, pose, size);
                    self.attached[stem].push((end, size));
                    return;
                }
            }
            size *= 0.85;
        }
    }

    /// From where on a stem stays within a radius of a place near its end.
    fn own_end(&self, stem: usize, end: f64, at: Point, radius: f64) -> f64 {
        if radius == 0.0 {
            return end;
        }
        let stem = &self.stems[stem];
        let outside = |node: &&Node| node.s <= end && node.p.distance(at) > radius;
        let mut from = stem.nodes.iter().rev().find(outside).map_or(0.0, |node| node.s);
        // Nodes may be far apart: halve the way to the next, which is inside.
        let next = stem.nodes.iter().find(|node| node.s > from).map_or(end, |node| node.s.min(end));
        let mut to = next;
        for _ in 0..8 {
            let middle = f64::midpoint(from, to);
            if stem.at(middle).p.distance(at) > radius {
                from = middle;
            } else {
                to = middle;
            }
        }
        // The second winding from within is too near, however long the first is.
        from.max(end - 7.0 * radius)
    }

    /// What grows at a fork: on the side that the branch does not take (M-024).
    pub(super) fn place_fork(&mut self, site: &Site, branch: usize) {
        let level = self.stems[branch].level;
        let mut rng = self.rng.fork();
        let Some(art) = pick(&self.forks[level], &mut rng) else { return };
        let size = self.art_size(level).min(0.4 * self.stems[branch].length());
        let beside = self.beside(site.parent, site.s, -site.side);
        self.place_beside(&beside, art, (size, 0.5), Some(branch));
    }

    /// Leaves in the room that is left along the stems, the largest first.
    pub fn place_leaves(&mut self, mut go_on: impl FnMut(f64) -> bool) -> bool {
        let wanted = self.params.leaves;
        if wanted <= 0.0 {
            return true;
        }
        const SCALES: [f64; 5] = [1.0, 0.8, 0.64, 0.5, 0.4];
        let mut sites: Vec<Beside> = Vec::new();
        let mut forks: Vec<Vec<(f64, f64)>> = vec![Vec::new(); self.stems.len()];
        for stem in &self.stems {
            if let Some((parent, s)) = stem.parent {
                forks[parent].push((s, stem.side));
            }
        }
        for (index, stem) in self.stems.iter().enumerate() {
            let step = (0.7 * self.art_size(stem.level)).max(2.0 * self.sizes.gap) / wanted;
            let count = (stem.end / step).ceil().max(1.0);
            for i in 0..count as usize {
                let s = (i as f64 + 0.6) / count * stem.end;
                if s > stem.end || self.is_near_crossing(index, s) {
                    continue;
                }
                // Where a branch leaves, its edge and a leaf's base would lie over each other.
                let near = 1.5 * (stem.width(s) + self.sizes.gap);
                let forks =
                    |side: f64| forks[index].iter().any(|&(at, own)| own == side && (at - s).abs() < near);
                let mut site = self.beside(index, s, 1.0);
                for side in super::SIDES {
                    if !forks(side) {
                        site.side = side;
                        sites.push(site);
                    }
                }
            }
        }
        // Places near each other one after the other, as memory likes it.
        let tile = 40.0 * self.sizes.width;
        let key = |site: &Beside| ((site.node.p.y / tile) as i64, (site.node.p.x / tile) as i64);
        sites.sort_by_key(key);
        let mut last = vec![None; self.stems.len()];
        // Large ones everywhere before any small one.
        for (round, scale) in SCALES.into_iter().enumerate() {
            if !go_on(round as f64 / SCALES.len() as f64) {
                return false;
            }
            let mut left = Vec::with_capacity(sites.len());
            for site in sites {
                let level = self.stems[site.stem].level;
                let size = self.art_size(level);
                // Where not even the smallest has room, no other has.
                if !self.may_hold(&site, SCALES[SCALES.len() - 1] * size) {
                    continue;
                }
                let art = self.pick_other(level, last[site.stem]);
                if art.is_some_and(|art| self.place_beside(&site, art, (scale * size, 0.999), None)) {
                    last[site.stem] = art;
                } else {
                    left.push(site);
                }
            }
            sites = left;
        }
        true
    }

    /// Clip art for a fork, not the same twice in a row if there is another.
    fn pick_other(&mut self, level: usize, last: Option<usize>) -> Option<usize> {
        const TRIES: usize = 3;
        let picks = (0..TRIES).map(|_| pick(&self.forks[level], &mut self.rng));
        let picks: Vec<Option<usize>> = picks.collect();
        picks.iter().copied().find(|&art| art != last).unwrap_or(picks[0])
    }

    fn beside(&self, stem: usize, s: f64, side: f64) -> Beside {
        let parent = &self.stems[stem];
        Beside { stem, node: parent.at(s), width: parent.width(s), side }
    }

    /// True if the middle and the end of something of this size beside a stem are free, some way it may
    /// lean.
    fn may_hold(&self, site: &Beside, size: f64) -> bool {
        let edge = site.node.p + site.side * 0.5 * site.width * left_of(site.node.along);
        self.leans.into_iter().any(|lean| {
            let along = leant(site.node.along, lean, site.side);
            [0.75, 1.0].into_iter().all(|share| self.cells.is_free(edge + share * size * along))
        })
    }

    /// Places clip art beside a stem, as large as fits down to a share of `size`.
    fn place_beside(
        &mut self,
        &Beside { stem, node, width, side }: &Beside,
        art: usize,
        (size, least): (f64, f64),
        branch: Option<usize>,
    ) -> bool {
        let near = width + self.sizes.gap + 2.0 * self.cells.size();
        let mut scale = 1.0;
        while scale >= least {
            let size = size * scale;
            // From within the stem, so that no light falls between.
            let attached = node.p + side * (0.5 * width - 0.06 * size).max(0.0) * left_of(node.along);
            let (back, central) = (self.library.arts[art].back, self.library.arts[art].central);
            let base = 0.5 * width + 0.26 * size;
            for lean in self.leans {
                // A look along its middle first.
                const LOOKS: [f64; 3] = [1.05, 0.75, 0.45];
                let along = leant(node.along, lean, side);
                // A flower sits beside the stem, not on it.
                let origin = if central { attached + 0.96 * back * size * along } else { attached };
                let taken = |&share: &f64| !self.cells.is_free(attached + share * size * along);
                if LOOKS.iter().any(taken) {
                    continue;
                }
                let pose = posed(origin, along, size, side < 0.0);
                let may = |at: Point, owner: Owner, place: f64| {
                    let distance = at.distance(attached);
                    let own = owner.stem() == Some(stem) && (place - node.s).abs() < 0.5 * size + 2.0 * near;
                    let sibling = branch.is_some() && owner.stem() == branch;
                    (own && (distance < base || !owner.is_body()) && distance < 3.0 * near)
                        || (sibling && !owner.is_body() && distance < near)
                };
                if self.library.arts[art].fits(pose, size, &self.cells, may) {
                    self.place(art, pose, size);
                    self.attached[stem].push((node.s, size));
                    return true;
                }
            }
            scale *= 0.85;
        }
        false
    }

    fn place(&mut self, art: usize, pose: Affine, size: f64) {
        self.library.arts[art].close(pose, size, &mut self.cells, self.sizes.gap);
        self.arts.push(PlacedArt { art, pose, size });
    }
}

/// Clip art of a size at a place, growing along a direction; `mirrored` swaps its sides.
fn posed(at: Point, along: Vec2, size: f64, mirrored: bool) -> Affine {
    let y = if mirrored { -1.0 } else { 1.0 };
    Affine::new([along.x, along.y, -y * along.y, y * along.x, at.x, at.y]) * Affine::scale(size)
}

fn rotated(v: Vec2, angle: f64) -> Vec2 {
    leant(v, unit(angle), 1.0)
}

/// Turned as far as a unit vector is from the x axis, to a side.
fn leant(v: Vec2, turn: Vec2, side: f64) -> Vec2 {
    let turn = Vec2::new(turn.x, side * turn.y);
    Vec2::new(turn.x * v.x - turn.y * v.y, turn.y * v.x + turn.x * v.y)
}
