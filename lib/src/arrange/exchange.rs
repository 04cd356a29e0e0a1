//! Elements that change places where alike ones came nearer to each other than the example has them.
//! Rings know the nearest neighbours alone, and where growth closes they take what is left; this is ours.

use super::example::Analysis;
use super::ground::Ground;
use super::grow::Arrangement;
use super::part;
use crate::geom::near::PointTable;

/// Nearer than this share of the least distance that two symbols have in the example is too near.
const NEAR: f64 = 0.9;
/// Elements change places with others that are no farther than so many mean edges.
const FAR: f64 = 3.5;
/// How often all are looked at.
const ROUNDS: usize = 3;

/// An element nearby, and how far it is.
#[derive(Clone, Copy)]
struct Near {
    other: u32,
    distance: f64,
}

struct Exchange<'a> {
    example: &'a Analysis,
    /// The symbol of each object, if it is an element.
    symbols: Vec<Option<usize>>,
    /// What is near enough to each object to be too near, and where that starts.
    near: Vec<Near>,
    starts: Vec<usize>,
}

impl<'a> Exchange<'a> {
    fn new(arrangement: &Arrangement, example: &'a Analysis, table: &PointTable<u32>) -> Self {
        let symbol = |copy: Option<(usize, _)>| copy.map(|(copy, _)| example.elements[copy].symbol);
        let symbols: Vec<Option<usize>> =
            arrangement.objects.iter().map(|object| symbol(object.copy)).collect();
        let (mut near, mut starts) = (Vec::with_capacity(8 * symbols.len()), vec![0]);
        let reach = NEAR * example.spread_reach;
        for (i, object) in arrangement.objects.iter().enumerate() {
            if symbols[i].is_some() && !object.is_gone {
                let around = table.near(object.at, reach).filter(|&(_, other)| other as usize != i);
                let around = around.map(|(at, other)| Near { other, distance: at.distance(object.at) });
                near.extend(around.filter(|near| near.distance < reach));
            }
            starts.push(near.len());
        }
        Exchange { example, symbols, near, starts }
    }

    /// How much too near an element would be to others if it were of this symbol, and one of the others of
    /// another than it is.
    fn crowding(&self, index: u32, symbol: usize, (changed, other): (u32, usize)) -> f64 {
        let around = &self.near[self.starts[index as usize]..self.starts[index as usize + 1]];
        let mut sum = 0.0;
        for near in around {
            let there = if near.other == changed { Some(other) } else { self.symbols[near.other as usize] };
            let Some(there) = there else { continue };
            let enough = NEAR * self.example.spread(symbol, there);
            if near.distance < enough {
                sum += (1.0 - near.distance / enough).powi(2);
            }
        }
        sum
    }
}

/// Lets elements change places with others nearby, of equal rank, wherever all of them are farther from
/// their like then. How many of each symbol there are stays as it is.
pub(super) fn exchange(
    arrangement: &mut Arrangement,
    fixed: &[bool],
    (example, ranks): (&Analysis, &[usize]),
    ground: &Ground,
) {
    /// Less than this is not worth it.
    const GAIN: f64 = 0.002;
    if example.symbols.len() < 2 {
        return;
    }
    let far = FAR * example.mean;
    let table = part::table(arrangement, ground, far.max(example.spread_reach));
    let mut all = Exchange::new(arrangement, example, &table);
    for _ in 0..ROUNDS {
        let mut has_changed = false;
        for &index in &arrangement.grown {
            let at = arrangement.objects[index as usize].at;
            let Some(own) = all.symbols[index as usize].filter(|_| !fixed[index as usize]) else { continue };
            let before = all.crowding(index, own, (index, own));
            if before < GAIN {
                continue;
            }
            let copy = |i: u32| arrangement.objects[i as usize].copy.map(|copy| copy.0);
            let repeats = |i: u32, other: u32| {
                let mut neighbours = arrangement.objects[i as usize].edges.iter();
                neighbours.any(|&near| near != other && copy(near) == copy(other))
            };
            let mut best: Option<(f64, u32, usize)> = None;
            for (place, other) in table.near(at, far) {
                let Some(symbol) = all.symbols[other as usize].filter(|_| !fixed[other as usize]) else {
                    continue;
                };
                if symbol == own || ranks[symbol] != ranks[own] || place.distance(at) > far {
                    continue;
                }
                // It has to be better off itself.
                let own_gain = before - all.crowding(index, symbol, (other, own));
                if own_gain < GAIN {
                    continue;
                }
                let gain = own_gain + all.crowding(other, symbol, (other, symbol))
                    - all.crowding(other, own, (index, symbol));
                let is_better = gain > best.map_or(GAIN, |best| best.0);
                if is_better && !repeats(index, other) && !repeats(other, index) {
                    best = Some((gain, other, symbol));
                }
            }
            let Some((_, other, symbol)) = best else { continue };
            (all.symbols[index as usize], all.symbols[other as usize]) = (Some(symbol), Some(own));
            let copies = [(index, copy(other), symbol), (other, copy(index), own)];
            for (i, copy, symbol) in copies {
                let object = &mut arrangement.objects[i as usize];
                object.copy = copy.zip(object.copy).map(|(copy, (_, turn))| (copy, turn));
                object.symbol = Some(symbol);
            }
            has_changed = true;
        }
        if !has_changed {
            break;
        }
    }
}
