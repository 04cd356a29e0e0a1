//! Bends artwork along a spine: skeletal strokes (Hsu, Lee, Wiseman 1993) that never fold.
//!
//! A point of the artwork is (u, v): u runs from 0 to 1 along the spine, v is the signed
//! distance from it. It goes to `S(u) + w' n(u)`, where `w = v s(u, v)` is v scaled by the
//! width profile of its side, and w' is w pulled in where the spine bends:
//!
//! `w' = w / sqrt(1 + (k w)^2)`, with k(u) at least the spine's curvature on the inner side
//! and 0 on the outer one.
//!
//! The plain map `S + w n` has the Jacobian `1 - k w` and folds where `w > 1/k`. This one has
//! `(1 - k w') dw'/dw`, and since `k w' < 1` and `dw'/dw = (1 + (k w)^2)^(-3/2) > 0` it is
//! positive everywhere: locally injective for any curvature and any width. It differs from
//! the plain map only by a term of third order, uses nothing but a square root (the same bits
//! on every machine), and is twice differentiable, so smooth outlines stay smooth. (The
//! exponential clamp in the project's notes has a second-order term and needs `exp`.)

use crate::geom::polyline::left_of;
use crate::geom::spline::{Curve, Profile};
use crate::geom::warp::Warp;
use kurbo::{BezPath, CubicBez, ParamCurve, ParamCurveDeriv, PathEl, PathSeg, Point, Vec2};
use std::cell::Cell;

/// How often one curve of the artwork is halved at most: 64 pieces bend any curve that a
/// person draws; more would be noise in the template.
const MOST_HALVINGS: usize = 6;

/// A bent strip around a spine.
#[derive(Clone, Debug)]
pub struct Bend {
    /// The spine, u from 0 to 1.
    pub spine: Curve,
    /// Scale of v > 0 and of v < 0.
    pub width: (Profile, Profile),
    /// Curvature to respect on the side v > 0 and on the side v < 0, not negative.
    pub curvature: (Profile, Profile),
    /// Over which |v| the scale of one side turns into the other's, so that outlines that
    /// cross the spine stay smooth.
    pub blend: f64,
    /// Warps of what is bent, in this order.
    pub warps: Vec<Warp>,
}

/// A mapped point and its derivatives by u and v.
#[derive(Clone, Copy, Debug)]
struct Mapped {
    p: Point,
    du: Vec2,
    dv: Vec2,
}

impl Bend {
    /// Where (u, v) goes.
    pub fn point(&self, u: f64, v: f64) -> Point {
        self.map(Point::new(u, v)).p
    }

    /// How far from the spine (u, v) goes, signed.
    pub fn reach(&self, u: f64, v: f64) -> f64 {
        let (a, b) = (self.width.0.value(u), self.width.1.value(u));
        let root = (v * v + self.blend * self.blend).sqrt().max(f64::MIN_POSITIVE);
        let w = v * (f64::midpoint(a, b) + (a - b) / 2.0 * v / root);
        let k = if w > 0.0 { self.curvature.0.value(u) } else { self.curvature.1.value(u) };
        w / (1.0 + k * k * w * w).sqrt()
    }

    fn map(&self, at: Point) -> Mapped {
        self.unwarped(at).warped(&self.warps)
    }

    fn unwarped(&self, at: Point) -> Mapped {
        let (u, v) = (at.x, at.y);
        let jet = self.spine.jet(u);
        let speed = jet.d.hypot().max(f64::MIN_POSITIVE);
        let tangent = jet.d / speed;
        let normal = left_of(tangent);
        // n'(u) = -(turn rate) t
        let normal_du = -(tangent.cross(jet.dd) / speed) * tangent;

        let ((a, a_du), (b, b_du)) = (self.width.0.jet(u), self.width.1.jet(u));
        let (mean, half) = (f64::midpoint(a, b), (a - b) / 2.0);
        let root = (v * v + self.blend * self.blend).sqrt().max(f64::MIN_POSITIVE);
        let side = v / root;
        let scale = mean + half * side;
        let w = v * scale;
        let w_dv = scale + v * half * self.blend * self.blend / (root * root * root);
        let w_du = v * (f64::midpoint(a_du, b_du) + (a_du - b_du) / 2.0 * side);

        let (k, k_du) = if w > 0.0 { self.curvature.0.jet(u) } else { self.curvature.1.jet(u) };
        let q = 1.0 / (1.0 + k * k * w * w).sqrt();
        let q3 = q * q * q;
        let pulled = w * q;
        Mapped {
            p: jet.p + pulled * normal,
            du: jet.d + (q3 * w_du - k * w * w * w * q3 * k_du) * normal + pulled * normal_du,
            dv: q3 * w_dv * normal,
        }
    }

    /// Bends a path in (u, v). Curves stay Béziers: each is split until a cubic with the
    /// mapped ends and end derivatives lies within `tolerance` of the mapped curve, so joins
    /// that were smooth stay smooth. Appends to `out`. False if warps turn it over where it was looked at.
    pub fn path(&self, path: &BezPath, tolerance: f64, out: &mut BezPath) -> bool {
        map_path(path, |at| self.unwarped(at), &self.warps, tolerance, out)
    }

    /// True if the map turns nothing over at any of these places in (u, v). It never does without warps.
    pub fn keeps_sense(&self, mut places: impl Iterator<Item = Point>) -> bool {
        places.all(|at| {
            let mapped = self.map(at);
            mapped.du.cross(mapped.dv) > 0.0
        })
    }
}

/// A path that only warps move. `None` if they turn it over where it was looked at.
pub fn warped(path: &BezPath, warps: &[Warp], tolerance: f64) -> Option<BezPath> {
    let map = |at| Mapped { p: at, du: Vec2::new(1.0, 0.0), dv: Vec2::new(0.0, 1.0) };
    let mut out = BezPath::new();
    map_path(path, map, warps, tolerance, &mut out).then_some(out)
}

impl Mapped {
    fn warped(mut self, warps: &[Warp]) -> Self {
        for warp in warps {
            self.p = warp.jet(self.p, [&mut self.du, &mut self.dv]);
        }
        self
    }
}

/// Maps a path, and warps it. False if it is turned over where it was looked at.
fn map_path(
    path: &BezPath,
    map: impl Fn(Point) -> Mapped,
    warps: &[Warp],
    tolerance: f64,
    out: &mut BezPath,
) -> bool {
    let mut start = Point::ZERO;
    let mut at = Point::ZERO;
    let keeps_sense = Cell::new(true);
    let place = |at: Point| warps.iter().fold(map(at).p, |p, warp| warp.point(p));
    let curve = |cubic: CubicBez, out: &mut BezPath| {
        let keeps = map_curve(cubic, (&map, &place), warps, tolerance, out);
        keeps_sense.set(keeps_sense.get() && keeps);
    };
    for el in path.elements() {
        match *el {
            PathEl::MoveTo(p) => {
                (start, at) = (p, p);
                out.move_to(place(p));
            }
            PathEl::LineTo(p) => {
                curve(PathSeg::Line(kurbo::Line::new(at, p)).to_cubic(), out);
                at = p;
            }
            PathEl::QuadTo(a, p) => {
                curve(PathSeg::Quad(kurbo::QuadBez::new(at, a, p)).to_cubic(), out);
                at = p;
            }
            PathEl::CurveTo(a, b, p) => {
                curve(CubicBez::new(at, a, b, p), out);
                at = p;
            }
            PathEl::ClosePath => {
                if at != start {
                    curve(PathSeg::Line(kurbo::Line::new(at, start)).to_cubic(), out);
                }
                at = start;
                out.close_path();
            }
        }
    }
    keeps_sense.get()
}

fn map_curve(
    source: CubicBez,
    (map, place): (&impl Fn(Point) -> Mapped, &impl Fn(Point) -> Point),
    warps: &[Warp],
    tolerance: f64,
    out: &mut BezPath,
) -> bool {
    let deriv = source.deriv();
    let mut keeps_sense = true;
    let mut end = |t: f64| {
        let (at, d) = (source.eval(t), deriv.eval(t));
        let mapped = map(at).warped(warps);
        keeps_sense &= warps.is_empty() || mapped.du.cross(mapped.dv) > 0.0;
        (mapped.p, d.x * mapped.du + d.y * mapped.dv)
    };
    let mut pieces = vec![(0.0, end(0.0), 1.0, end(1.0), 0)];
    while let Some((t0, e0, t1, e1, halvings)) = pieces.pop() {
        let h = (t1 - t0) / 3.0;
        let cubic = CubicBez::new(e0.0, e0.0 + h * e0.1, e1.0 - h * e1.1, e1.0);
        let near = |s: f64| place(source.eval(t0 + s * (t1 - t0))).distance(cubic.eval(s)) <= tolerance;
        // Nothing that a warp does lies unseen within a piece that is shorter than some radii.
        let is_within = |radii: f64| {
            let (middle, length) = (cubic.p0.midpoint(cubic.p3), cubic.p0.distance(cubic.p3));
            warps.iter().all(|warp| length < radii * warp.radius() || !warp.reaches(middle, length / 2.0))
        };
        let middle = f64::midpoint(t0, t1);
        let m = end(middle);
        let is_true = || {
            let seen = || if is_within(1.25) { &[0.2, 0.8][..] } else { &[0.15, 0.85, 0.32, 0.68] };
            m.0.distance(cubic.eval(0.5)) <= tolerance && is_within(2.5) && seen().iter().all(|&s| near(s))
        };
        if halvings == MOST_HALVINGS || is_true() {
            out.curve_to(cubic.p1, cubic.p2, cubic.p3);
        } else {
            pieces.push((middle, m, t1, e1, halvings + 1));
            pieces.push((t0, e0, middle, m, halvings + 1));
        }
    }
    keeps_sense
}

/// The width before pulling in that ends at `limit` after it; `limit` times `most` at most.
/// `k` is the curvature on that side.
pub fn width_before(limit: f64, k: f64, most: f64) -> f64 {
    let x = k * limit;
    let squared = 1.0 - x * x;
    if x >= 1.0 || squared * most * most <= 1.0 { limit * most } else { limit / squared.sqrt() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn bend(points: &[(f64, f64)], left: f64, right: f64, k: (f64, f64)) -> Bend {
        let points: Vec<Point> = points.iter().map(|&p| p.into()).collect();
        Bend {
            spine: Curve::near(&points),
            width: (Profile::below(&[left, left * 1.3, left * 0.8, left], 3), Profile::constant(right)),
            curvature: (Profile::above(&[k.0, k.0 * 0.5], 2), Profile::constant(k.1)),
            blend: 2.0,
            warps: Vec::new(),
        }
    }

    proptest! {
        #[test]
        fn the_derivatives_are_the_derivatives(u in 0.05..0.95f64, v in -20.0..20.0f64, k in 0.0..0.2f64) {
            let bend = bend(&[(0.0, 0.0), (30.0, 5.0), (60.0, 20.0), (80.0, 50.0)], 1.4, 0.7, (k, k / 2.0));
            let (h, at) = (1e-6, bend.map(Point::new(u, v)));
            let du = (bend.point(u + h, v) - bend.point(u - h, v)) / (2.0 * h);
            let dv = (bend.point(u, v + h) - bend.point(u, v - h)) / (2.0 * h);
            prop_assert!((bend.point(u, v).distance(bend.spine.jet(u).p) - bend.reach(u, v).abs()).abs() < 1e-9);
            prop_assert!((du - at.du).hypot() < 1e-3 * (1.0 + du.hypot()), "{du:?} {:?}", at.du);
            prop_assert!((dv - at.dv).hypot() < 1e-4 * (1.0 + dv.hypot()));
        }

        #[test]
        fn nothing_folds_in_a_tight_turn(v in -40.0..40.0f64, u in 0.0..1.0f64) {
            // A half circle of radius 10, artwork up to four radii wide.
            let points: Vec<(f64, f64)> = (0..=16).map(|i| {
                let a = f64::from(i) / 16.0 * std::f64::consts::PI;
                (10.0 * libm::cos(a), 10.0 * libm::sin(a))
            }).collect();
            let bend = bend(&points, 1.0, 1.0, (0.11, 0.0));
            let at = bend.map(Point::new(u, v));
            prop_assert!(at.du.cross(at.dv) > 0.0);
        }
    }

    #[test]
    fn a_straight_spine_changes_nothing() {
        let straight = Bend {
            spine: Curve::near(&[Point::ZERO, Point::new(50.0, 0.0), Point::new(100.0, 0.0)]),
            width: (Profile::constant(1.0), Profile::constant(1.0)),
            curvature: (Profile::constant(0.0), Profile::constant(0.0)),
            blend: 1.0,
            warps: Vec::new(),
        };
        let mut out = BezPath::new();
        straight.path(&BezPath::from_svg("M0,0C0.2,10 0.8,10 1,0Z").unwrap(), 1e-3, &mut out);
        assert_eq!(out.elements().len(), 4, "one curve stays one curve: {out:?}");
    }

    #[test]
    fn widths_before_and_after_pulling_agree() {
        let before = width_before(3.0, 0.2, 10.0);
        assert!((before / (1.0 + (0.2f64 * before).powi(2)).sqrt() - 3.0).abs() < 1e-12);
        assert_eq!(width_before(5.0, 0.2, 4.0), 20.0);
    }
}
