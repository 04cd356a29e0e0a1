//! What a curve with a width meets on its way: its parent near the fork, and in plait-work the stems that it
//! crosses.

use super::super::particle::Node;
use super::super::plait::{self, Crossing};
use super::super::stem::{Stem, Taper};
use super::{Plant, TIGHT};

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
pub(in super::super) struct Met {
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
pub(in super::super) struct Fork {
    pub stem: usize,
    pub s: f64,
    pub reach: f64,
}

impl Plant<'_> {
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
    pub(super) fn is_occupied(&self, stem: usize, s: f64) -> bool {
        let near = self.stems[stem].width(s) + self.sizes.gap;
        let at_base = |&(at, size): &(f64, f64)| (at - s).abs() < 0.4 * size + near;
        let is_shared = |&(from, to): &(f64, f64)| (from..to).contains(&s);
        self.is_near_crossing(stem, s)
            || self.attached[stem].iter().any(at_base)
            || self.shared[stem].iter().any(is_shared)
    }

    /// True if a place on a stem is too near a crossing for anything to grow there.
    pub(super) fn is_near_crossing(&self, stem: usize, s: f64) -> bool {
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
    pub(super) fn crossings(&self, branch: &Stem, met: &[Met]) -> Option<Vec<Crossing>> {
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
}
