//! Places where lines may start, in the order in which they are tried.

use kurbo::Point;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// A queue of places by distance, ties in random order. Only those whose distance is among the least are kept
/// sorted; most are of no use any more when their turn comes.
pub(super) struct Seeds {
    /// Drawers in a unit of distance.
    per_unit: f64,
    /// What is tried next: all of the drawers up to `open`.
    next: BinaryHeap<Seed>,
    open: usize,
    /// All others, by distance.
    drawers: Vec<Vec<Seed>>,
    /// Where each lies, also those that have been taken.
    places: Vec<Point>,
    len: usize,
}

/// Nearest first, then by a random number, then the one that came first.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Seed(Reverse<(u64, u32)>);

impl Seeds {
    /// An empty queue of distances that matter in steps of `step`.
    pub fn new(step: f64) -> Self {
        Seeds {
            per_unit: 1.0 / step,
            next: BinaryHeap::new(),
            open: 0,
            drawers: Vec::new(),
            places: Vec::new(),
            len: 0,
        }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Adds a place; `tie` is a random number.
    pub fn push(&mut self, at: Point, distance: f64, tie: u64) {
        const MOST_DRAWERS: usize = 4096;
        let distance = distance.max(0.0) as f32;
        // Non-negative floats order as their bits do.
        let key = u64::from(distance.to_bits()) << 32 | tie >> 32;
        let seed = Seed(Reverse((key, self.places.len() as u32)));
        self.places.push(at);
        self.len += 1;
        let drawer = ((f64::from(distance) * self.per_unit) as usize).min(MOST_DRAWERS - 1);
        if drawer <= self.open {
            return self.next.push(seed);
        }
        if drawer >= self.drawers.len() {
            self.drawers.resize_with(drawer + 1, Vec::new);
        }
        self.drawers[drawer].push(seed);
    }

    /// Takes the next place out that is of use still. Once it is not, it never is again.
    pub fn pop(&mut self, is_of_use: impl Fn(Point) -> bool) -> Option<Point> {
        loop {
            while let Some(Seed(Reverse((_, index)))) = self.next.pop() {
                self.len -= 1;
                let at = self.places[index as usize];
                if is_of_use(at) {
                    return Some(at);
                }
            }
            let drawers = self.drawers.get_mut(self.open + 1..)?;
            self.open += 1 + drawers.iter().position(|drawer| !drawer.is_empty())?;
            let mut drawer = std::mem::take(&mut self.drawers[self.open]);
            let before = drawer.len();
            drawer.retain(|&Seed(Reverse((_, index)))| is_of_use(self.places[index as usize]));
            self.len -= before - drawer.len();
            self.next = drawer.into();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Rng;

    #[test]
    fn the_nearest_comes_first() {
        let (mut rng, mut seeds, mut waiting) = (Rng::new(1), Seeds::new(0.7), Vec::new());
        for round in 0..400 {
            for _ in 0..round % 7 {
                let distance = f64::from(rng.between(0.0, 30.0) as f32);
                seeds.push(Point::new(distance, 0.0), distance, rng.bits());
                waiting.push(distance);
            }
            waiting.sort_by(|a, b| b.total_cmp(a));
            for _ in 0..round % 5 {
                assert_eq!(seeds.pop(|_| true).map(|p| p.x), waiting.pop());
            }
            assert_eq!(seeds.len(), waiting.len());
        }
        waiting.retain(|&distance| distance > 20.0);
        while let Some(p) = seeds.pop(|p| p.x > 20.0) {
            assert_eq!(Some(p.x), waiting.pop());
        }
        assert_eq!((seeds.len(), waiting.len()), (0, 0));
    }
}
