//! Relaxation (Ijiri et al. 2008, section 5.5; checklist E-040 to E-043): every ring comes as near
//! to its shape in the example as all of them can at once.
//!
//! The sum of (x_j - x_i - r_ij)² over all rings is least where a sparse, symmetric and positive
//! definite system holds, once some objects are fixed and taken out of it; that gives what the
//! paper's Lagrange multipliers give. It is solved for the moves from where things are, by
//! conjugate gradients: where all rings fit already, as in a regular pattern, nothing moves at all.
//! A ring is turned as its element is; the paper does not say so, but without it relaxation would
//! turn elements back (erratum Q-5).

use super::example::Analysis;
use super::grow::Object;
use crate::geom::near::PointGrid;
use kurbo::{Rect, Vec2};

/// Steps at most: in the end, and on the way, where later ones will come to it again.
pub(super) const STEPS: usize = 100;
pub(super) const FEW_STEPS: usize = 16;
/// The share of the first error that is left in the end.
const LEFT: f64 = 1e-4;

/// The terms of the sum: from, to, and how far the two are from where they should be.
fn terms(objects: &[Object]) -> Vec<(u32, u32, Vec2)> {
    let mut terms = Vec::with_capacity(6 * objects.len());
    for (i, object) in objects.iter().enumerate().filter(|(_, object)| !object.is_gone) {
        // Elements that lost or gained an edge, and seeds, keep the shape that they have.
        let is_whole = object.copy.is_some()
            && object.ring.len() == object.edges.len()
            && object.ring.iter().all(|(other, _)| object.edges.contains(other));
        if is_whole {
            terms.extend(
                object.ring.iter().map(|&(j, r)| (i as u32, j, r - (objects[j as usize].at - object.at))),
            );
        } else {
            terms.extend(object.edges.iter().map(|&j| (i as u32, j, Vec2::ZERO)));
        }
    }
    terms
}

/// Root of the mean square by which rings differ from the example's.
pub(super) fn residual(objects: &[Object]) -> f64 {
    let rings = objects.iter().filter(|object| object.copy.is_some() && !object.is_gone);
    let (mut sum, mut count) = (0.0, 0.0);
    for object in rings {
        for &(j, r) in &object.ring {
            sum += (r - (objects[j as usize].at - object.at)).hypot2();
            count += 1.0;
        }
    }
    if count > 0.0 { (sum / count).sqrt() } else { 0.0 }
}

/// Moves objects; `fixed` ones stay.
pub(super) fn relax(objects: &mut [Object], fixed: &[bool], steps: usize) {
    let n = objects.len();
    let terms = terms(objects);
    let mut degree = vec![0.0_f64; n];
    let mut force = vec![Vec2::ZERO; n];
    for &(i, j, error) in &terms {
        for (at, sign) in [(i, -1.0), (j, 1.0)] {
            degree[at as usize] += 1.0;
            if !fixed[at as usize] {
                force[at as usize] += sign * error;
            }
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
    let end = rz * LEFT * LEFT;
    let mut product = vec![Vec2::ZERO; n];
    for _ in 0..steps {
        if rz <= end || rz == 0.0 {
            break;
        }
        product.iter_mut().for_each(|v| *v = Vec2::ZERO);
        for &(i, j, _) in &terms {
            let (i, j) = (i as usize, j as usize);
            let apart = p[j] - p[i];
            product[j] += apart;
            product[i] -= apart;
        }
        for (v, fixed) in product.iter_mut().zip(fixed) {
            if *fixed {
                *v = Vec2::ZERO;
            }
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
    for (object, by) in objects.iter_mut().zip(moves) {
        object.at += by;
    }
}

/// Nearer than this share of the least distance that two symbols have in the example, elements move
/// apart; and nearer than that, one of them goes.
const NEAR: f64 = 0.9;
const TOO_NEAR: f64 = 0.7;
/// Rounds of moving apart.
const ROUNDS: usize = 24;

/// Moves elements apart that came nearer to each other than any of their symbols are in the example,
/// and takes out the younger of those that still are. Relaxation looks at neighbours alone; this is
/// ours.
pub(super) fn part(
    objects: &mut [Object],
    grown: &mut Vec<u32>,
    fixed: &[bool],
    example: &Analysis,
    bounds: Rect,
) {
    let apart = |a: &Object, b: &Object| match (a.symbol, b.symbol) {
        (Some(a), Some(b)) => example.apart(a, b),
        _ => 0.0,
    };
    for round in 0..=ROUNDS {
        let mut grid = PointGrid::new(bounds, example.mean);
        grown.iter().for_each(|&i| grid.insert(objects[i as usize].at, i));
        let mut moves: Vec<(u32, Vec2)> = Vec::new();
        let mut gone: Vec<u32> = Vec::new();
        for &i in grown.iter() {
            let own = &objects[i as usize];
            let mut by = Vec2::ZERO;
            let mut is_crowded = false;
            grid.visit(own.at, example.reach, |at, j| {
                let other = &objects[j as usize];
                let distance = own.at.distance(at);
                let least = apart(own, other);
                if j != i && distance < NEAR * least {
                    // Half each, or all of it away from one that stays.
                    let share = if fixed[j as usize] { 1.0 } else { 0.5 };
                    let way = if distance > 0.0 { (own.at - at) / distance } else { Vec2::new(1.0, 0.0) };
                    by += share * (NEAR * least - distance) * way;
                    is_crowded |= distance < TOO_NEAR * least && j < i && !gone.contains(&j);
                }
                true
            });
            if round == ROUNDS && is_crowded && !fixed[i as usize] {
                gone.push(i);
            } else if by != Vec2::ZERO && !fixed[i as usize] && round < ROUNDS {
                moves.push((i, by));
            }
        }
        if round == ROUNDS || moves.is_empty() {
            grown.retain(|i| !gone.contains(i));
            return;
        }
        moves.into_iter().for_each(|(i, by)| objects[i as usize].at += by);
    }
}
