//! Relaxation (Ijiri et al. 2008, section 5.5; checklist E-040 to E-043): every ring comes as near
//! to its shape in the example as all of them can at once.
//!
//! The sum of (x_j - x_i - r_ij)² over all rings is least where a sparse, symmetric and positive
//! definite system holds, once some objects are fixed and taken out of it; that gives what the
//! paper's Lagrange multipliers give. It is solved for the moves from where things are, by
//! conjugate gradients: where all rings fit already, as in a regular pattern, nothing moves at all.
//! A ring is turned as its element is; the paper does not say so, but without it relaxation would
//! turn elements back (erratum Q-5).

use super::ground::Ground;
use super::grow::{Link, Object};
use kurbo::Vec2;

/// Steps at most: in the end, and on the way, where later ones will come to it again.
pub(super) const STEPS: usize = 100;
pub(super) const FEW_STEPS: usize = 16;
/// The share of the first error that is left in the end.
const LEFT: f64 = 1e-4;

/// A term of the sum: from, to, and how far the two are from where they should be.
pub(super) type Term = (u32, u32, Vec2);

/// Terms of one object; of two neighbours each has one of the other.
fn terms<'a>(objects: &'a [Object], ground: &'a Ground, i: usize) -> impl Iterator<Item = Term> + 'a {
    let object = &objects[i];
    // Elements that lost or gained an edge, and seeds, keep the shape that they have.
    let is_whole = object.copy.is_some() && object.is_whole();
    let (ring, edges): (&[Link], &[u32]) = if is_whole { (&object.ring, &[]) } else { (&[], &object.edges) };
    let apart = |link: &Link| ground.near(objects[link.to as usize].at, object.at) - object.at;
    let ring = ring.iter().map(move |link| (i as u32, link.to, link.offset - apart(link)));
    ring.chain(edges.iter().map(move |&j| (i as u32, j, Vec2::ZERO)))
}

/// Squared errors of the ring of an object, and how many neighbours are still there.
pub(super) fn ring_error(objects: &[Object], object: &Object, ground: &Ground) -> (f64, f64) {
    let apart = |link: &Link| ground.near(objects[link.to as usize].at, object.at) - object.at;
    let links = object.ring.iter().filter(|link| !objects[link.to as usize].is_gone);
    links.fold((0.0, 0.0), |(sum, count), link| (sum + (link.offset - apart(link)).hypot2(), count + 1.0))
}

/// Root of the mean square by which rings differ from the example's.
pub(super) fn residual(objects: &[Object], ground: &Ground) -> f64 {
    let rings = objects.iter().filter(|object| object.copy.is_some() && !object.is_gone);
    let (sum, count) = rings
        .map(|object| ring_error(objects, object, ground))
        .fold((0.0, 0.0), |a, b| (a.0 + b.0, a.1 + b.1));
    if count > 0.0 { (sum / count).sqrt() } else { 0.0 }
}

/// Moves objects; `fixed` ones stay. `near` is how near to the least is near enough, in user units.
pub(super) fn relax(objects: &mut [Object], ground: &Ground, fixed: &[bool], (steps, near): (usize, f64)) {
    // Those in which something may move.
    let counts = |i: &usize| {
        let object = &objects[*i];
        let is_held = fixed[*i] && object.edges.iter().all(|&j| fixed[j as usize]);
        !(object.is_gone || is_held)
    };
    let all = (0..objects.len()).filter(counts).flat_map(|i| terms(objects, ground, i));
    let moves = solved(all, fixed, (steps, near));
    for (object, by) in objects.iter_mut().zip(moves) {
        object.at += by;
    }
}

/// Moves that make the sum of all terms least, as far as `steps` go; `near` is near enough. To every term
/// there is one the other way round.
pub(super) fn solved(
    terms: impl Iterator<Item = Term>,
    fixed: &[bool],
    (steps, near): (usize, f64),
) -> Vec<Vec2> {
    // Only what may move is part of the system.
    const FIXED: u32 = u32::MAX;
    let mut number = vec![FIXED; fixed.len()];
    let free: Vec<u32> = (0..fixed.len() as u32).filter(|&i| !fixed[i as usize]).collect();
    free.iter().enumerate().for_each(|(i, &of)| number[of as usize] = i as u32);
    let n = free.len();
    let mut degree = vec![0.0_f64; n];
    let mut force = vec![Vec2::ZERO; n];
    // Both ends free, and one of them.
    let (mut pairs, mut held) = (Vec::with_capacity(3 * n), vec![0.0_f64; n]);
    for (i, j, error) in terms {
        let (i, j) = (number[i as usize], number[j as usize]);
        for (at, sign) in [(i, -1.0), (j, 1.0)] {
            if at != FIXED {
                degree[at as usize] += 1.0;
                force[at as usize] += sign * error;
            }
        }
        match (i, j) {
            (FIXED, FIXED) => {}
            (FIXED, at) | (at, FIXED) => held[at as usize] += 1.0,
            // The one the other way round is like it.
            (i, j) if i < j => pairs.push((i, j)),
            _ => {}
        }
    }
    let scaled = |r: &[Vec2]| -> Vec<Vec2> {
        r.iter().zip(&degree).map(|(r, d)| if *d > 0.0 { *r / *d } else { Vec2::ZERO }).collect()
    };
    let dot = |a: &[Vec2], b: &[Vec2]| -> f64 { a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum() };
    let mut moves = vec![Vec2::ZERO; n];
    let mut z = scaled(&force);
    let mut p = z.clone();
    let mut rz = dot(&force, &z);
    let end = (rz * LEFT * LEFT).max(near * near * n as f64);
    let mut product = vec![Vec2::ZERO; n];
    for _ in 0..steps {
        if rz <= end || rz == 0.0 {
            break;
        }
        for ((v, p), held) in product.iter_mut().zip(&p).zip(&held) {
            *v = *held * *p;
        }
        for &(i, j) in &pairs {
            let (i, j) = (i as usize, j as usize);
            let apart = 2.0 * (p[j] - p[i]);
            product[j] += apart;
            product[i] -= apart;
        }
        let step = rz / dot(&p, &product).max(f64::MIN_POSITIVE);
        for i in 0..n {
            moves[i] += step * p[i];
            force[i] -= step * product[i];
        }
        z = scaled(&force);
        let next = dot(&force, &z);
        let turn = next / rz;
        rz = next;
        for i in 0..n {
            p[i] = z[i] + turn * p[i];
        }
    }
    let mut all = vec![Vec2::ZERO; fixed.len()];
    free.iter().zip(moves).for_each(|(&i, by)| all[i as usize] = by);
    all
}
