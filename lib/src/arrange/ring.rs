//! How well an element of the example fits a place: its ring against the neighbours there (Ijiri et
//! al. 2008, sections 5.2 and 5.3; checklist E-024 to E-029).
//!
//! Formula (2) is lost in the stored text. From what is said of it, it is read as: over all pairs
//! of a matching, w1 times the distance of the pair's offsets, plus w2 where their symbols differ,
//! plus w3 where the neighbour is a copy of the very element that is tried. Distances count in mean
//! edge lengths of the example, so that the weights mean the same at any size of drawing.

use super::example::{Analysis, Neighbour, angle};
use kurbo::Vec2;

/// A neighbour of a place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Around {
    pub offset: Vec2,
    /// Its symbol; a seed may have none.
    pub symbol: Option<usize>,
    /// Which element of the example it is a copy of; seeds are of none.
    pub copy_of: Option<usize>,
}

/// What counts in a comparison.
#[derive(Clone, Copy, Debug)]
pub(super) struct Weights {
    pub place: f64,
    pub symbol: f64,
    pub repeat: f64,
    /// Of the neighbours' own rings.
    pub rings: f64,
}

/// How the rings of the example may be turned.
#[derive(Clone, Copy, Debug)]
pub(super) enum Turn {
    /// By this, as a unit vector.
    By(Vec2),
    /// As fits best.
    Free,
}

/// An element of the example in a place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Match {
    pub element: usize,
    /// The first neighbour goes with this one of the ring, the next with the next, and so on.
    pub shift: usize,
    pub turn: Vec2,
    pub error: f64,
}

/// Sorts neighbours counter-clockwise, beginning at the boundary of what has grown (E-025): behind a
/// gap whose two sides are no neighbours of each other, the widest of them.
pub(super) fn sort_around<T: Copy>(
    around: &mut [T],
    offset: impl Fn(&T) -> Vec2,
    are_linked: impl Fn(&T, &T) -> bool,
) {
    let mut sorted: Vec<(f64, T)> = around.iter().map(|one| (angle(offset(one)), *one)).collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let n = sorted.len();
    let gap = |i: usize| {
        let (before, own) = (&sorted[(i + n - 1) % n], &sorted[i]);
        let gap = own.0 - before.0;
        let gap = if gap < 0.0 || (i == 0 && n == 1) { gap + std::f64::consts::TAU } else { gap };
        if are_linked(&before.1, &own.1) { gap } else { gap + std::f64::consts::TAU }
    };
    let first = (0..n).fold((0, -1.0), |best, i| if gap(i) > best.1 { (i, gap(i)) } else { best }).0;
    for (i, place) in around.iter_mut().enumerate() {
        *place = sorted[(first + i) % n].1;
    }
}

pub(super) fn rotated(v: Vec2, turn: Vec2) -> Vec2 {
    Vec2::new(v.x * turn.x - v.y * turn.y, v.x * turn.y + v.y * turn.x)
}

/// Of elements that fit alike the one that was used least is taken: each use more than the least counts
/// like this share of a mean edge, up to so many. Ours; without it a few elements do all the work.
const EVEN_USE: f64 = 0.004;
const MOST_UNEVEN: f64 = 25.0;

/// The element of the example that fits best, of all or of one symbol. `None` if every ring is
/// smaller than what is around already (E-026).
pub(super) fn best(
    example: &Analysis,
    around: &[Around],
    symbol: Option<usize>,
    ((turn, weights), uses): ((Turn, Weights), &[f64]),
) -> Option<Match> {
    let mut best: Option<Match> = None;
    let least_used = example.inner().map(|i| uses[i]).fold(f64::INFINITY, f64::min);
    for element in example.inner() {
        let candidate = &example.elements[element];
        if symbol.is_some_and(|symbol| symbol != candidate.symbol) || candidate.ring.len() < around.len() {
            continue;
        }
        let repeats = around.iter().filter(|other| other.copy_of == Some(element)).count() as f64;
        let base = weights.repeat * repeats + EVEN_USE * (uses[element] - least_used).min(MOST_UNEVEN);
        for shift in 0..candidate.ring.len() {
            let most = best.map_or(f64::INFINITY, |best| best.error);
            if base >= most {
                break;
            }
            let turn = match turn {
                Turn::By(turn) => turn,
                Turn::Free => best_turn(&candidate.ring, around, shift),
            };
            let mut error = base;
            for (i, other) in around.iter().enumerate() {
                let own = &candidate.ring[(shift + i) % candidate.ring.len()];
                error += weights.place * (rotated(own.offset, turn) - other.offset).hypot() / example.mean;
                error += weights.symbol * f64::from(other.symbol.is_some_and(|symbol| symbol != own.symbol));
                // What stands two steps away, as far as it is known: a neighbour that is a copy of another
                // element than the example has there brings that one's ring along (E-060).
                if let Some(copy) = other.copy_of {
                    error += weights.rings * example.difference(copy, own.element);
                }
                if error >= most {
                    break;
                }
            }
            if error < most {
                best = Some(Match { element, shift, turn, error });
            }
        }
    }
    best
}

/// How much two rings differ: the least mean, over all ways to pair them in order, of distances in
/// mean edges and of symbols that are not the same. 0 if one of them is not whole.
pub(super) fn difference(a: &[Neighbour], b: &[Neighbour], mean: f64) -> f64 {
    let (few, many) = if a.len() <= b.len() { (a, b) } else { (b, a) };
    if few.is_empty() {
        return 0.0;
    }
    let missing = (many.len() - few.len()) as f64;
    let shifted = |shift: usize| {
        let pairs = few.iter().enumerate().map(|(i, p)| (p, &many[(shift + i) % many.len()]));
        let apart = pairs
            .map(|(p, q)| (p.offset - q.offset).hypot() / mean + f64::from(u8::from(p.symbol != q.symbol)));
        (apart.sum::<f64>() + missing) / many.len() as f64
    };
    (0..many.len()).map(shifted).fold(f64::INFINITY, f64::min)
}

/// The rotation that lays a ring on its pairs with the least squares (Müller et al. 2005, in two
/// dimensions, about the element itself).
fn best_turn(ring: &[Neighbour], around: &[Around], shift: usize) -> Vec2 {
    let pairs =
        around.iter().enumerate().map(|(i, other)| (ring[(shift + i) % ring.len()].offset, other.offset));
    let sum = pairs.fold(Vec2::ZERO, |sum, (p, q)| sum + Vec2::new(p.dot(q), p.cross(q)));
    if sum.hypot() > 0.0 { sum / sum.hypot() } else { Vec2::new(1.0, 0.0) }
}
