//! Plait-work: branches that cross others, over and under in turn (checklist M-041).
//!
//! A branch may cross another where they meet at more than 45 degrees and it comes out on the
//! other side. Along every stem the crossings alternate, over and under; a branch for which
//! that cannot be is not let across. Where a stem goes under, it is cut: a true gap, parallel
//! to the stem above.

use super::stem::Stem;
use crate::geom::polyline::left_of;

/// Two stems that cross.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crossing {
    /// Index of each stem and the arc length there.
    pub at: [(usize, f64); 2],
}

/// Sine of the least angle at which stems may cross.
pub(super) const LEAST_SINE: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Room between the stems at a crossing, in gaps.
pub(super) const GAP: f64 = 0.8;

/// Which of the two is above at each crossing, so that every stem goes over and under in turn.
/// `None` if there is no such way.
pub(super) fn alternate(crossings: &[Crossing]) -> Option<Vec<usize>> {
    // Neighbours along a stem want opposite states of that stem.
    let mut along: Vec<(usize, f64, usize, usize)> = Vec::new();
    for (i, crossing) in crossings.iter().enumerate() {
        for strand in 0..2 {
            let (stem, s) = crossing.at[strand];
            along.push((stem, s, i, strand));
        }
    }
    along.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut links: Vec<Vec<(usize, bool)>> = vec![Vec::new(); crossings.len()];
    for pair in along.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        if a.0 == b.0 {
            // The same strand above at both means that the upper index differs or not.
            let same = a.3 != b.3;
            links[a.2].push((b.2, same));
            links[b.2].push((a.2, same));
        }
    }
    let mut upper: Vec<Option<usize>> = vec![None; crossings.len()];
    for start in 0..crossings.len() {
        if upper[start].is_some() {
            continue;
        }
        upper[start] = Some(0);
        let mut open = vec![start];
        while let Some(i) = open.pop() {
            for &(j, same) in &links[i] {
                let wanted = upper[i].map(|upper| if same { upper } else { 1 - upper });
                match upper[j] {
                    None => {
                        upper[j] = wanted;
                        open.push(j);
                    }
                    known if known != wanted => return None,
                    _ => {}
                }
            }
        }
    }
    upper.into_iter().collect()
}

/// Cuts the lower stem at every crossing, `gap` from the upper one.
pub(super) fn cut(stems: &mut [Stem], crossings: &[Crossing], gap: f64) {
    let Some(upper) = alternate(crossings) else { return };
    for (crossing, upper) in crossings.iter().zip(upper) {
        let ((over, s_over), (under, s_under)) = (crossing.at[upper], crossing.at[1 - upper]);
        let cut = Cut::under((&stems[under], s_under), (&stems[over], s_over), gap);
        stems[under].cuts.push(cut);
    }
    for stem in stems {
        stem.cuts.sort_by(|a, b| a.from.total_cmp(&b.from));
    }
}

/// A gap in a stem, between two arc lengths on its centre line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cut {
    pub from: f64,
    pub to: f64,
    /// How much farther along the cut runs per unit to the left.
    pub skew: f64,
}

impl Cut {
    /// The cut of a stem at a place where it goes under another.
    fn under((below, s_below): (&Stem, f64), (above, s_above): (&Stem, f64), gap: f64) -> Self {
        let (across, along) = (above.at(s_above), below.at(s_below));
        let sine = along.along.cross(across.along);
        let slant = sine.abs().max(0.1);
        // The ends of the cut are straight; where the stems bend they need that much more room.
        let reach = below.width(s_below) / (2.0 * slant);
        let bow = reach * reach / 2.0 * (across.curvature.abs() + along.curvature.abs());
        let half = (above.width(s_above) / 2.0 + gap + bow) / slant;
        let skew = along.along.dot(across.along) / if sine == 0.0 { 1.0 } else { sine };
        Cut { from: s_below - half, to: s_below + half, skew }
    }
}

/// True if a stem that is cut to go under another keeps clear of it, whatever both do near the
/// crossing, and nothing of the cut runs off the stem.
pub(super) fn is_clean(below: (&Stem, f64), above: (&Stem, f64), gap: f64) -> bool {
    const SAMPLES: i32 = 12;
    /// Share of the gap that bends may take.
    const KEPT: f64 = 0.4;
    let cut = Cut::under(below, above, gap);
    let ((below, _), (above, s_above)) = (below, above);
    let (w, h) = (below.width(cut.from), above.width(s_above));
    // Beyond the cut for some widths; the other stem is longer there, to be compared with.
    let reach = cut.to - cut.from + 2.0 * (w + h);
    let line: Vec<_> = (-2 * SAMPLES..=2 * SAMPLES)
        .map(|k| s_above + f64::from(k) / f64::from(SAMPLES) * reach)
        .filter(|s| (0.0..=above.end).contains(s))
        .map(|s| (above.at(s).p, above.width(s) / 2.0))
        .collect();
    let clear = |at: kurbo::Point| {
        line.windows(2).all(|pair| {
            let half = pair[0].1.max(pair[1].1);
            crate::geom::segment::point_segment(at, pair[0].0, pair[1].0) > half + KEPT * gap
        })
    };
    [(cut.from, -1.0), (cut.to, 1.0)].into_iter().all(|(end, way)| {
        [-1.0, 0.0, 1.0].into_iter().all(|side| {
            let end = end + side * cut.skew * below.width(end) / 2.0;
            end > 0.0
                && end < below.end
                && (0..=SAMPLES).all(|k| {
                    let s = end + way * f64::from(k) / f64::from(SAMPLES) * reach;
                    let node = below.at(s.clamp(0.0, below.end));
                    clear(node.p + side * below.width(s) / 2.0 * left_of(node.along))
                })
        })
    })
}

/// Where two stems cross, near the places given.
pub(super) fn meet(a: &Stem, near_a: f64, b: &Stem, near_b: f64) -> Option<(f64, f64)> {
    // Newton's method on the distance along both tangents; they cross steeply, so it converges
    // at once.
    let (mut s, mut t) = (near_a, near_b);
    for _ in 0..12 {
        let (p, q) = (a.at(s), b.at(t));
        let apart = q.p - p.p;
        let sine = p.along.cross(q.along);
        if sine.abs() < 0.3 {
            return None;
        }
        let (ds, dt) = (apart.cross(q.along) / sine, apart.cross(p.along) / sine);
        s = (s + ds).clamp(0.0, a.length());
        t = (t + dt).clamp(0.0, b.length());
        if ds.abs() + dt.abs() < 1e-7 * a.length() {
            break;
        }
    }
    (a.at(s).p.distance(b.at(t).p) < 1e-3 * a.width(s).max(1e-9)).then_some((s, t))
}

/// On which side of a stem a place lies.
pub(super) fn side(stem: &Stem, s: f64, at: kurbo::Point) -> f64 {
    let node = stem.at(s);
    (at - node.p).dot(left_of(node.along))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_net_alternates_and_an_odd_ring_cannot() {
        // Three level stems cross three upright ones: over and under like a basket.
        let net: Vec<Crossing> =
            (0..9).map(|i| Crossing { at: [(i / 3, (i % 3) as f64), (3 + i % 3, (i / 3) as f64)] }).collect();
        let upper = alternate(&net).unwrap();
        for row in 0..3 {
            for column in 0..2 {
                assert_ne!(upper[3 * row + column], upper[3 * row + column + 1]);
                assert_ne!(upper[3 * column + row], upper[3 * (column + 1) + row]);
            }
        }
        // Two crossings next to each other on both stems, met in opposite roles.
        let twist = [Crossing { at: [(0, 0.0), (1, 0.0)] }, Crossing { at: [(0, 1.0), (1, 1.0)] }];
        assert_ne!(alternate(&twist).unwrap()[0], alternate(&twist).unwrap()[1]);
        // A third that crosses one of them once between the two, and ends there.
        let odd = [
            Crossing { at: [(0, 0.0), (1, 0.0)] },
            Crossing { at: [(0, 1.0), (1, 2.0)] },
            Crossing { at: [(1, 1.0), (2, 0.0)] },
        ];
        assert!(alternate(&odd).is_none());
    }
}
