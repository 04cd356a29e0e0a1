//! What is known of places without a closer look.

use crate::geom::polyline::runs;
use kurbo::{Point, Vec2};
use std::ops::Range;

/// Bits in a word.
const WORD: usize = u64::BITS as usize;
/// Cells of the map along one cell of the depths it starts from.
const FINER: usize = 3;
/// Parts of a cell that have a stamp of their own, along each side.
const PARTS: u32 = 4;

/// Some bits for each small cell, so that one look is enough in most places.
pub(super) struct NearMap {
    origin: Point,
    per_unit: f64,
    columns: u32,
    rows: u32,
    /// Words of a row.
    words: usize,
    bits: Vec<Word>,
    /// Cells that a stamp reaches on each side of its middle.
    reach: usize,
    /// The cells around a point, row by row, for each part of a cell that it may be in.
    stamps: Vec<Stamp>,
}

/// Of one cell after another: it is not clear from the start, something may be near, a point is near for sure.
#[derive(Clone, Copy)]
struct Word {
    edge: u64,
    maybe: u64,
    surely: u64,
}

/// A row of cells around a point: those with a place within the radius, those that lie within it.
#[derive(Clone, Copy)]
struct Stamp {
    some: u32,
    all: u32,
}

/// Whether anything is near.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Near {
    /// Nothing.
    No,
    /// A point may be nearer than the radius, and nothing else is.
    MaybePoint,
    /// Anything may be.
    Maybe,
    /// A point is nearer than the radius.
    Yes,
}

impl NearMap {
    /// A map in which nothing is near in the cells that are `clear`, row by row from `origin`, each of a side of
    /// `cell`, and anything may be elsewhere.
    pub fn new(origin: Point, cell: f64, clear: &[bool], columns: usize, radius: f64) -> Self {
        let cell = cell / FINER as f64;
        // A stamp's row is kept in 32 bits.
        let reach = ((radius / cell).ceil() as usize + 1).min(15);
        // Points this far outside are of interest still, and their stamps have to lie in the map.
        let margin = 2 * reach;
        let columns = columns.max(1);
        let rows = FINER * clear.len().div_ceil(columns) + 2 * margin;
        let width = FINER * columns + 2 * margin;
        // One word more, so that a stamp may always write two.
        let words = width.div_ceil(WORD) + 1;
        let mut map = NearMap {
            origin: origin - Vec2::new(margin as f64, margin as f64) * cell,
            per_unit: 1.0 / cell,
            columns: width as u32,
            rows: rows as u32,
            words,
            bits: vec![Word { edge: u64::MAX, maybe: u64::MAX, surely: 0 }; words * rows],
            reach,
            stamps: stamps(radius / cell, reach),
        };
        for (row, clear) in clear.chunks(columns).enumerate() {
            let first = (margin + FINER * row) * words;
            let line = &mut map.bits[first..first + words];
            for run in runs(clear) {
                clear_bits(line, margin + FINER * run.start..margin + FINER * run.end);
            }
            for copy in 1..FINER {
                map.bits.copy_within(first..first + words, first + copy * words);
            }
        }
        map
    }

    /// A place in parts of cells, from the corner of the map. Signed and short: such casts cost least.
    fn parts(&self, at: Point) -> (i32, i32) {
        let parts = self.per_unit * f64::from(PARTS);
        (((at.x - self.origin.x) * parts) as i32, ((at.y - self.origin.y) * parts) as i32)
    }

    /// What is known of a place.
    #[inline]
    pub fn look(&self, at: Point) -> Near {
        let (x, y) = self.parts(at);
        // Whatever is below 0 is far too large as well.
        let (column, row) = (x as u32 / PARTS, y as u32 / PARTS);
        if column >= self.columns || row >= self.rows {
            return Near::Maybe;
        }
        let (column, row) = (column as usize, row as usize);
        let Word { edge, maybe, surely } = self.bits[row * self.words + column / WORD];
        let bit = column % WORD;
        let is_set = |word: u64| word >> bit & 1 != 0;
        match (is_set(maybe), is_set(surely), is_set(edge)) {
            (false, ..) => Near::No,
            (_, true, _) => Near::Yes,
            (_, _, false) => Near::MaybePoint,
            _ => Near::Maybe,
        }
    }

    /// Puts a point in.
    pub fn insert(&mut self, at: Point) {
        self.stamp(at, |word, some, all| {
            word.maybe |= some;
            word.surely |= all;
        });
    }

    /// Puts a point in that may be taken out again, or not be meant everywhere.
    pub fn suspect(&mut self, at: Point) {
        self.stamp(at, |word, some, _| word.maybe |= some);
    }

    /// Changes the words around a point.
    fn stamp(&mut self, at: Point, mut change: impl FnMut(&mut Word, u64, u64)) {
        let (x, y) = self.parts(at);
        let (column, row) = (x as u32 / PARTS, y as u32 / PARTS);
        let reach = self.reach as u32;
        // Only what lies outside by more than the radius is that near to the edge of the map.
        let inner = |at: u32, count: u32| (reach..count - reach).contains(&at);
        if !inner(column, self.columns) || !inner(row, self.rows) {
            return;
        }
        let (column, row, reach) = (column as usize, row as usize, self.reach);
        let side = 2 * reach + 1;
        let first = (y as u32 % PARTS * PARTS + x as u32 % PARTS) as usize * side;
        let left = column - reach;
        let (word, shift) = (left / WORD, left % WORD);
        let lines = self.bits[(row - reach) * self.words..].chunks_exact_mut(self.words);
        for (&Stamp { some, all }, line) in self.stamps[first..first + side].iter().zip(lines) {
            let (some, all) = (u128::from(some) << shift, u128::from(all) << shift);
            change(&mut line[word], some as u64, all as u64);
            change(&mut line[word + 1], (some >> WORD) as u64, (all >> WORD) as u64);
        }
    }
}

/// Says of cells that nothing is near.
fn clear_bits(line: &mut [Word], bits: Range<usize>) {
    let (first, last) = (bits.start / WORD, bits.end / WORD);
    for (i, word) in line.iter_mut().enumerate().take(last + 1).skip(first) {
        // Those below a bit.
        let below = |bit: usize| (1u64 << (bit % WORD)) - 1;
        let from = if i == first { below(bits.start) } else { 0 };
        let to = if i == last { !below(bits.end) } else { 0 };
        word.edge &= from | to;
        word.maybe = word.edge;
    }
}

/// The stamps of a radius in cells, part by part.
fn stamps(radius: f64, reach: usize) -> Vec<Stamp> {
    // How far the part of a cell is from the cell `apart` cells on, at least and at most.
    let between = |part: u32, apart: i32| {
        let (low, high) = (f64::from(part) / f64::from(PARTS), f64::from(part + 1) / f64::from(PARTS));
        let cell = f64::from(apart);
        ((cell - high).max(low - cell - 1.0).max(0.0), (cell + 1.0 - low).max(high - cell))
    };
    let reach = reach as i32;
    let mut stamps = Vec::new();
    for part in 0..PARTS * PARTS {
        for dy in -reach..=reach {
            let y = between(part / PARTS, dy);
            let mut stamp = Stamp { some: 0, all: 0 };
            for dx in -reach..=reach {
                let x = between(part % PARTS, dx);
                let within = |x: f64, y: f64| u32::from(x * x + y * y < radius * radius) << (dx + reach);
                stamp.some |= within(x.0, y.0);
                stamp.all |= within(x.1, y.1);
            }
            stamps.push(stamp);
        }
    }
    stamps
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Rng;

    #[test]
    fn what_is_sure_is_true() {
        let (radius, mut rng) = (4.0, Rng::new(1));
        let mut map = NearMap::new(Point::new(-50.0, 20.0), 1.6, &[true; 60 * 50], 60, radius);
        let mut place = || Point::new(rng.between(-60.0, 56.0), rng.between(10.0, 110.0));
        let points: Vec<Point> = (0..40).map(|_| place()).collect();
        points.iter().for_each(|&p| map.insert(p));
        let mut count = [0; 4];
        for _ in 0..20_000 {
            let at = place();
            let nearest = points.iter().map(|p| p.distance(at)).fold(f64::INFINITY, f64::min);
            let inside = (-50.0..46.0).contains(&at.x) && (20.0..100.0).contains(&at.y);
            let near = map.look(at);
            count[near as usize] += 1;
            match near {
                Near::No => assert!(inside && nearest >= radius, "{at:?} {nearest}"),
                Near::Yes => assert!(nearest < radius, "{at:?} {nearest}"),
                // A cell and a part of one are what it does not know.
                Near::MaybePoint | Near::Maybe => {
                    assert_eq!(near == Near::MaybePoint, inside);
                    let unsure = 1.6 / FINER as f64 * 1.25 * std::f64::consts::SQRT_2;
                    assert!(!inside || (nearest - radius).abs() <= unsure, "{at:?} {nearest}");
                }
            }
        }
        assert!(count.iter().all(|&n| n > 500), "{count:?}");
    }
}
