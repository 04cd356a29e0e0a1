//! Which place branches next: the longest branch anywhere (ours), or the article's places in turn
//! (checklist M-007, M-009, M-012).

use super::super::params::of_level;
use super::{Plant, SHORTER, SIDES, Site};
use std::collections::BinaryHeap;

/// A branch is at most this many times longer than it is wide.
const LONGEST_WIDTHS: f64 = 75.0;
/// Forks of one stem are at least this many widths apart on one side.
const FORK_WIDTHS: f64 = 3.0;

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

impl Plant<'_> {
    /// The longest first, wherever there is room.
    pub(super) fn branch_by_length(&mut self, most: usize, mut go_on: impl FnMut(f64) -> bool) -> bool {
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
    pub(super) fn branch_in_order(&mut self, most: usize, mut go_on: impl FnMut(f64) -> bool) -> bool {
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
}
