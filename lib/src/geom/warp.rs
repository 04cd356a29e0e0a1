//! Smooth warps of the plane near an outline.

use crate::geom::near::PointTable;
use crate::geom::polyline::bounds;
use kurbo::{Point, Vec2};

/// Moves a closed outline by pushes given at samples of it, and what lies beside it along with it: at any place
/// the mean of the pushes near by, weighted by distance, fading to nothing at the radius. Twice
/// continuously differentiable, so that smooth outlines stay smooth.
#[derive(Clone, Debug)]
pub struct Warp {
    samples: PointTable,
    pushes: Vec<Vec2>,
    radius: f64,
    fade: f64,
}

/// What pushes weigh together against nothing, as a share of the weights on an outline.
const FADE: f64 = 0.25;

/// Weight of a push at a squared distance, in radii.
fn weight(squared: f64) -> f64 {
    let rest = (1.0 - squared).max(0.0);
    rest * rest * rest
}

/// The weight of nothing for samples `step` apart.
fn fade(radius: f64, step: f64) -> f64 {
    // The weights along a straight line sum up to 32/35 of the radius in steps.
    FADE * 32.0 / 35.0 * radius / step
}

/// Samples with their numbers.
fn table(samples: &[Point], radius: f64) -> PointTable {
    let numbered: Vec<(Point, u32)> = samples.iter().zip(0..).map(|(&p, i)| (p, i)).collect();
    PointTable::new(bounds(samples.iter().copied()).unwrap_or_default(), radius, &numbered)
}

impl Warp {
    /// Pushes at samples of an outline that are about `step` apart.
    pub fn new(samples: &[Point], pushes: Vec<Vec2>, radius: f64, step: f64) -> Self {
        Warp { samples: table(samples, radius), pushes, radius, fade: fade(radius, step) }
    }

    /// The same with pushes that are shorter.
    pub fn scaled(&self, share: f64) -> Self {
        Warp { pushes: self.pushes.iter().map(|&push| share * push).collect(), ..self.clone() }
    }

    /// How far a push is felt.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Where a point goes.
    pub fn point(&self, p: Point) -> Point {
        let (mut sum, mut total) = (Vec2::ZERO, self.fade);
        for (sample, i) in self.samples.near(p, self.radius) {
            let w = weight((p - sample).hypot2() / (self.radius * self.radius));
            sum += w * self.pushes[i as usize];
            total += w;
        }
        p + sum / total
    }

    /// Where a point goes, and directions at it with it.
    pub fn jet(&self, p: Point, directions: [&mut Vec2; 2]) -> Point {
        let squared_radius = self.radius * self.radius;
        let (mut sum, mut total) = (Vec2::ZERO, self.fade);
        let (mut sum_by, mut total_by) = ([Vec2::ZERO; 2], [0.0; 2]);
        for (sample, i) in self.samples.near(p, self.radius) {
            let from = p - sample;
            let rest = 1.0 - from.hypot2() / squared_radius;
            if rest <= 0.0 {
                continue;
            }
            let push = self.pushes[i as usize];
            let w = rest * rest * rest;
            sum += w * push;
            total += w;
            for (k, direction) in directions.iter().enumerate() {
                let by = -6.0 * rest * rest * from.dot(**direction) / squared_radius;
                sum_by[k] += by * push;
                total_by[k] += by;
            }
        }
        for (k, direction) in directions.into_iter().enumerate() {
            *direction += sum_by[k] / total - sum * (total_by[k] / (total * total));
        }
        p + sum / total
    }
}

/// Which samples of an outline move with each other, and how much: as [`Warp`] moves them.
pub struct Ties {
    /// Samples near each one, itself too, with their weights.
    near: Vec<Vec<(u32, f64)>>,
}

impl Ties {
    /// Between samples that are about `step` apart.
    pub fn new(samples: &[Point], radius: f64, step: f64) -> Self {
        let table = table(samples, radius);
        let near = samples.iter().map(|&p| {
            let weights =
                table.near(p, radius).map(|(q, i)| (i, weight((p - q).hypot2() / (radius * radius))));
            let mut weights: Vec<(u32, f64)> = weights.filter(|(_, w)| *w > 0.0).collect();
            let total = fade(radius, step) + weights.iter().map(|(_, w)| w).sum::<f64>();
            weights.iter_mut().for_each(|(_, w)| *w /= total);
            weights
        });
        Ties { near: near.collect() }
    }

    /// The least of the values near a sample.
    pub fn least(&self, values: &[f64], i: usize) -> f64 {
        self.near[i].iter().map(|&(j, _)| values[j as usize]).fold(f64::INFINITY, f64::min)
    }

    /// True if any of the samples near one is so.
    pub fn any(&self, is_so: &[bool], i: usize) -> bool {
        self.near[i].iter().any(|&(j, _)| is_so[j as usize])
    }

    /// How far a sample moves.
    pub fn push(&self, pushes: &[Vec2], i: usize) -> Vec2 {
        self.near[i].iter().fold(Vec2::ZERO, |sum, &(j, w)| sum + w * pushes[j as usize])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A circle of radius 10, with pushes outwards, some more than others.
    fn circle() -> (Vec<Point>, Vec<Vec2>) {
        let angle = |i: usize| i as f64 / 90.0 * 2.0 * std::f64::consts::PI;
        let out = |i: usize| Vec2::new(libm::cos(angle(i)), libm::sin(angle(i)));
        let push = |i: usize| (0.4 + 0.4 * libm::cos(3.0 * angle(i))) * out(i);
        ((0..90).map(|i| (10.0 * out(i)).to_point()).collect(), (0..90).map(push).collect())
    }

    proptest! {
        #[test]
        fn directions_go_with_points(x in -14.0..14.0f64, y in -14.0..14.0f64) {
            let (samples, pushes) = circle();
            let warp = Warp::new(&samples, pushes, 3.0, 0.7);
            let (at, h) = (Point::new(x, y), 1e-6);
            let (mut du, mut dv) = (Vec2::new(1.0, 0.0), Vec2::new(0.0, 1.0));
            prop_assert!(warp.jet(at, [&mut du, &mut dv]).distance(warp.point(at)) < 1e-12);
            let slope = |d: Vec2| (warp.point(at + h * d) - warp.point(at - h * d)) / (2.0 * h);
            prop_assert!((slope(Vec2::new(1.0, 0.0)) - du).hypot() < 1e-5);
            prop_assert!((slope(Vec2::new(0.0, 1.0)) - dv).hypot() < 1e-5);
            prop_assert!(du.cross(dv) > 0.1, "{} {}", du, dv);
        }
    }

    #[test]
    fn samples_move_as_their_ties_say() {
        let (samples, pushes) = circle();
        let (ties, warp) = (Ties::new(&samples, 3.0, 0.7), Warp::new(&samples, pushes.clone(), 3.0, 0.7));
        for (i, &p) in samples.iter().enumerate() {
            let moved = warp.point(p) - p;
            assert!((moved - ties.push(&pushes, i)).hypot() < 1e-12);
            let near: Vec<f64> = pushes.iter().map(|push| push.hypot()).collect();
            let far: Vec<f64> = near.iter().map(|length| -length).collect();
            assert!(moved.hypot() <= -ties.least(&far, i), "no farther than the farthest near by");
        }
    }
}
