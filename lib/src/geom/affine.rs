//! Tack transformations: an object is held by up to two tacks and dragged by one more point.
//!
//! Christopher Carlson, Robert Woodbury: *Hands-On Exploration of Recursive Forms*, 1990,
//! "Affine transformations" (checklist ). Of all maps that would do, each is the
//! one that changes least: no tack moves, one turns and scales, two shear and strain.

use kurbo::{Affine, Point, Vec2};

/// Moves `p` to `q`: what no tack allows.
pub fn drag(p: Point, q: Point) -> Affine {
    Affine::translate(q - p)
}

/// Turns and scales about a tack so that `p` goes to `q`.
///
/// `None` if `p` or `q` is nearer to the tack than `tolerance`: the one says nothing about how to
/// turn, the other would scale to nothing.
pub fn drag_about(tack: Point, p: Point, q: Point, tolerance: f64) -> Option<Affine> {
    let (v, w) = (p - tack, q - tack);
    if v.hypot() <= tolerance || w.hypot() <= tolerance {
        return None;
    }
    // w / v as complex numbers.
    let (a, b) = (w.dot(v) / v.hypot2(), v.cross(w) / v.hypot2());
    let Vec2 { x, y } = tack.to_vec2();
    Some(Affine::new([a, b, -b, a, x - (a * x - b * y), y - (b * x + a * y)]))
}

/// Shears along and strains across the line through two tacks so that `p` goes to `q`.
///
/// `None` if the tacks are one, or `p` or `q` is nearer to their line than `tolerance`.
pub fn drag_across(tacks: (Point, Point), p: Point, q: Point, tolerance: f64) -> Option<Affine> {
    let n = normal(tacks, tolerance)?;
    let height = n.dot(p - tacks.0);
    if height.abs() <= tolerance || n.dot(q - tacks.0).abs() <= tolerance {
        return None;
    }
    Some(along(tacks.0, n, (q - p) / height))
}

/// The four similarities that keep a pair of tacks, as a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeepsTacks {
    /// Nothing moves.
    Identity,
    /// The mirror is the line through them.
    Mirror,
    /// The mirror stands between them; they change places.
    MirrorAcross,
    /// A half-turn about their middle; they change places.
    HalfTurn,
}

impl KeepsTacks {
    /// All four: the ways to lay a clone on a segment.
    pub const ALL: [KeepsTacks; 4] =
        [KeepsTacks::Identity, KeepsTacks::Mirror, KeepsTacks::MirrorAcross, KeepsTacks::HalfTurn];

    /// The transformation. `None` if the tacks are nearer to each other than `tolerance`.
    pub fn about(self, tacks: (Point, Point), tolerance: f64) -> Option<Affine> {
        let n = normal(tacks, tolerance)?;
        let middle = tacks.0.midpoint(tacks.1);
        Some(match self {
            KeepsTacks::Identity => Affine::IDENTITY,
            KeepsTacks::Mirror => along(tacks.0, n, -2.0 * n),
            KeepsTacks::MirrorAcross => {
                let axis = n.turn_90();
                along(middle, axis, -2.0 * axis)
            }
            KeepsTacks::HalfTurn => {
                let Vec2 { x, y } = tacks.0.to_vec2() + tacks.1.to_vec2();
                Affine::new([-1.0, 0.0, 0.0, -1.0, x, y])
            }
        })
    }
}

/// The unit normal of the line through two tacks.
fn normal((a, b): (Point, Point), tolerance: f64) -> Option<Vec2> {
    let axis = b - a;
    (axis.hypot() > tolerance).then(|| axis.turn_90() / axis.hypot())
}

/// Moves every point by `w` times its height over the line through `origin` with normal `n`.
fn along(origin: Point, n: Vec2, w: Vec2) -> Affine {
    let offset = n.dot(origin.to_vec2());
    Affine::new([1.0 + w.x * n.x, w.y * n.x, w.x * n.y, 1.0 + w.y * n.y, -offset * w.x, -offset * w.y])
}

#[cfg(test)]
mod tests {
    use super::*;

    const NEAR: f64 = 1e-9;

    fn is_near(a: Point, b: Point) -> bool {
        a.distance(b) < 1e-9
    }

    /// Points that are no lattice.
    fn points(seed: u64) -> [Point; 5] {
        let mut rng = crate::rng::Rng::new(seed);
        std::array::from_fn(|_| Point::new(rng.between(-9.0, 9.0), rng.between(-9.0, 9.0)))
    }

    #[test]
    fn a_dragged_point_goes_where_it_is_dragged_and_tacks_stay() {
        for seed in 0..1000 {
            let [a, b, p, q, _] = points(seed);
            assert!(is_near(drag(p, q) * p, q));
            let turned = drag_about(a, p, q, NEAR).unwrap();
            assert!(is_near(turned * p, q) && is_near(turned * a, a));
            let [m, n, o, k, ..] = turned.as_coeffs();
            assert!((m - k).abs() < NEAR && (n + o).abs() < NEAR, "one tack reflects nothing");
            let strained = drag_across((a, b), p, q, NEAR).unwrap();
            assert!(is_near(strained * p, q) && is_near(strained * a, a) && is_near(strained * b, b));
            assert!(is_near(strained * a.lerp(b, 2.7), a.lerp(b, 2.7)), "the whole line stays");
        }
    }

    #[test]
    fn dragging_along_the_axis_shears_and_across_it_strains() {
        let tacks = (Point::new(1.0, 1.0), Point::new(5.0, 1.0));
        let shear = drag_across(tacks, Point::new(2.0, 3.0), Point::new(4.0, 3.0), NEAR).unwrap();
        assert!((shear.determinant() - 1.0).abs() < NEAR);
        assert_eq!(shear * Point::new(0.0, 2.0), Point::new(1.0, 2.0));
        let strain = drag_across(tacks, Point::new(2.0, 3.0), Point::new(2.0, 2.0), NEAR).unwrap();
        assert!(is_near(strain * Point::new(7.0, -3.0), Point::new(7.0, -1.0)));
        // Reflection is a strain.
        let mirror = drag_across(tacks, Point::new(2.0, 3.0), Point::new(2.0, -1.0), NEAR).unwrap();
        let same = KeepsTacks::Mirror.about(tacks, NEAR).unwrap();
        assert!(is_near(mirror * Point::new(7.0, 9.0), same * Point::new(7.0, 9.0)));
    }

    #[test]
    fn four_operations_keep_a_pair_of_tacks_and_are_a_group() {
        for seed in 0..100 {
            let [a, b, p, ..] = points(seed);
            let all = KeepsTacks::ALL.map(|operation| operation.about((a, b), NEAR).unwrap());
            for (i, &f) in all.iter().enumerate() {
                let pair = (f * a, f * b);
                let swaps = i >= 2;
                let (to_a, to_b) = if swaps { (b, a) } else { (a, b) };
                assert!(is_near(pair.0, to_a) && is_near(pair.1, to_b));
                assert!((f.determinant() - [1.0, -1.0, -1.0, 1.0][i]).abs() < NEAR);
                assert!(is_near(f * f * p, p), "each undoes itself");
                for &g in &all {
                    assert!(all.iter().any(|&h| is_near(f * g * p, h * p) && is_near(f * g * a, h * a)));
                }
            }
        }
    }

    #[test]
    fn a_drag_that_says_nothing_is_none() {
        let (a, b) = (Point::ORIGIN, Point::new(1.0, 0.0));
        assert!(drag_about(a, a, b, NEAR).is_none() && drag_about(a, b, a, NEAR).is_none());
        assert!(drag_across((a, b), Point::new(5.0, 0.0), Point::new(5.0, 1.0), NEAR).is_none());
        assert!(drag_across((a, a), Point::new(5.0, 1.0), Point::new(5.0, 2.0), NEAR).is_none());
        assert!(KeepsTacks::HalfTurn.about((a, a), NEAR).is_none());
    }
}
