//! Keeping apart what the example keeps apart. Relaxation looks at neighbours alone; this is ours.

use super::example::Analysis;
use super::ground::Ground;
use super::grow::{Arrangement, Object};
use crate::geom::near::PointTable;
use kurbo::{Rect, Vec2};

/// Nearer than this share of the least distance that two symbols have in the example, elements move
/// apart; and nearer than that, one of them goes.
const NEAR: f64 = 0.9;
const TOO_NEAR: f64 = 0.7;
/// By less than this share of a mean edge nobody moves: nobody would see it, and it would go on for long.
const SLACK: f64 = 0.003;
/// Elements deeper in each other than the example's, by more than this share of a mean edge, collide.
const DEEP: f64 = 0.01;
/// Rounds of moving apart: what is crowded in the midst of many comes out of it slowly.
const ROUNDS: usize = 120;

/// How two elements stand to each other.
struct Pair {
    /// How far the first has to go, and which way.
    away: Vec2,
    /// True if one of them has to go if that does not help.
    is_bad: bool,
}

fn pair(own: &Object, other: &Object, between: Vec2, example: &Analysis) -> Option<Pair> {
    let ((a, turn), (b, other_turn)) = (own.copy?, other.copy?);
    let (a, b) = (&example.elements[a], &example.elements[b]);
    let mut away = Vec2::ZERO;
    let mut is_bad = false;
    let allowed = allowed(example, a.symbol, b.symbol);
    let enough = allowed + DEEP * example.mean;
    if let Some((depth, out)) = a.extent.depth(turn, (&b.extent, other_turn), between, enough) {
        (away, is_bad) = ((depth - allowed) * out, allowed <= 0.0 && depth > DEEP * example.mean);
    }
    let (distance, least) = (between.hypot(), example.apart(a.symbol, b.symbol));
    if distance < NEAR * least - SLACK * example.mean && away == Vec2::ZERO {
        let way = if distance > 0.0 { -between / distance } else { Vec2::new(1.0, 0.0) };
        away = (NEAR * least - distance) * way;
        is_bad = distance < TOO_NEAR * least;
    }
    (away != Vec2::ZERO).then_some(Pair { away, is_bad })
}

/// How deep two symbols may lie in each other: as deep as in the example and a little more, as scales and
/// feathers do; where nothing touches in the example, below 0: some of its least room stays between them.
fn allowed(example: &Analysis, a: usize, b: usize) -> f64 {
    const MORE: f64 = 1.4;
    const KEPT: f64 = 0.7;
    match example.deep(a, b) {
        deep if deep > DEEP * example.mean => MORE * deep,
        _ => -KEPT * example.room,
    }
}

/// Where the elements are, and those of their images that something is nearer to than `reach`.
pub(super) fn table(arrangement: &Arrangement, ground: &Ground, reach: f64) -> PointTable<u32> {
    let margin = if ground.repeats { 1.3 * reach } else { 0.0 };
    let mut points = Vec::with_capacity(arrangement.grown.len());
    for &i in &arrangement.grown {
        let around = Rect::ZERO.inflate(margin, margin);
        ground.each_image(arrangement.objects[i as usize].at, around, |image| points.push((image, i)));
    }
    PointTable::new(ground.bounds.inflate(margin, margin), 0.5 * reach, points.iter().copied())
}

/// Moves elements apart that came nearer to each other than any of their symbols are in the example,
/// and takes out the younger of those that still are.
pub(super) fn part(arrangement: &mut Arrangement, fixed: &[bool], example: &Analysis, ground: &Ground) {
    let reach = example.reach.max(example.widest() + example.room);
    // What stands as it stood with all others need not be looked at again.
    let mut has_moved = vec![true; arrangement.objects.len()];
    let mut table = table(arrangement, ground, reach);
    // Those to be looked at, in the order in which they grew; and how far things went since the table
    // was made.
    let (mut todo, mut drift): (Vec<u32>, f64) = (arrangement.grown.clone(), 0.0);
    // True if two are too near that both have to stay where they are.
    let mut is_stuck = false;
    let mut round = 0;
    loop {
        const STALE: f64 = 0.1;
        if drift > STALE * reach {
            table = self::table(arrangement, ground, reach);
            drift = 0.0;
        }
        let mut moves: Vec<(u32, Vec2)> = Vec::new();
        let mut gone: Vec<u32> = Vec::new();
        for &i in &todo {
            let own = &arrangement.objects[i as usize];
            let mut by = Vec2::ZERO;
            let mut goes = false;
            for (entered, j) in table.near(own.at, reach + drift) {
                let is_far = entered.distance_squared(own.at) > (reach + drift).powi(2);
                if is_far || j == i || !(has_moved[i as usize] || has_moved[j as usize]) {
                    continue;
                }
                let other = &arrangement.objects[j as usize];
                let at = ground.near(other.at, own.at);
                // Another image of it.
                if at.distance(entered) > 1.01 * drift + 1e-9 * reach {
                    continue;
                }
                if let Some(pair) = pair(own, other, at - own.at, example) {
                    // Half each, or all of it away from one that stays.
                    by += if fixed[j as usize] { 1.0 } else { 0.5 } * pair.away;
                    let stays = match (fixed[i as usize], fixed[j as usize]) {
                        (false, true) => true,
                        (true, false) => false,
                        _ => j < i,
                    };
                    goes |= pair.is_bad && stays && !gone.contains(&j);
                    is_stuck |= pair.is_bad && fixed[i as usize] && fixed[j as usize];
                }
            }
            if round == ROUNDS && goes {
                gone.push(i);
            } else if by != Vec2::ZERO && !fixed[i as usize] && round < ROUNDS {
                moves.push((i, by));
            }
        }
        if round == ROUNDS {
            gone.sort_unstable();
            arrangement.take_out(&gone);
            return;
        }
        if moves.is_empty() && !is_stuck {
            return;
        }
        round = if moves.is_empty() { ROUNDS } else { round + 1 };
        let is_last = round == ROUNDS;
        has_moved.fill(is_last);
        let mut farthest = 0.0;
        for &(i, by) in &moves {
            has_moved[i as usize] = true;
            farthest = f64::max(farthest, by.hypot());
            let at = &mut arrangement.objects[i as usize].at;
            *at = ground.within(*at + by);
        }
        drift += farthest;
        let mut is_near = has_moved.clone();
        for &(i, _) in &moves {
            let near = table.near(arrangement.objects[i as usize].at, reach + drift);
            near.for_each(|(_, j)| is_near[j as usize] = true);
        }
        todo = arrangement.grown.iter().copied().filter(|&i| is_near[i as usize]).collect();
    }
}

/// Pairs of elements that lie deeper in each other than the example's do.
pub(super) fn collisions(arrangement: &Arrangement, example: &Analysis, ground: &Ground) -> usize {
    let reach = example.widest();
    let table = table(arrangement, ground, reach);
    let mut found = 0;
    for &i in &arrangement.grown {
        let own = &arrangement.objects[i as usize];
        for (at, j) in table.near(own.at, reach) {
            if j >= i || at.distance_squared(own.at) > reach * reach {
                continue;
            }
            let other = &arrangement.objects[j as usize];
            if let (Some((a, turn)), Some((b, other_turn))) = (own.copy, other.copy) {
                let (a, b) = (&example.elements[a], &example.elements[b]);
                // What moves apart may stop a little before it is.
                let enough = allowed(example, a.symbol, b.symbol).max(0.0) + 2.0 * DEEP * example.mean;
                let depth = a.extent.depth(turn, (&b.extent, other_turn), at - own.at, enough);
                found += usize::from(depth.is_some());
            }
        }
    }
    found
}
