//! Smooth warps of the plane near an outline.

use crate::geom::near::PointTable;
use crate::geom::polyline::bounds;
use kurbo::{Point, Vec2};
use std::sync::Arc;

/// Moves a closed outline by pushes given at samples of it, and what lies beside it along with it: at any place
/// the mean of the pushes near by, weighted by distance, fading to nothing at the radius. Twice
/// continuously differentiable, so that smooth outlines stay smooth.
#[derive(Clone, Debug)]
pub struct Warp {
    /// The samples that are felt where any push is, with their pushes.
    samples: Arc<PointTable<Vec2>>,
    /// How much of the pushes is done.
    share: f64,
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

/// Points in cells of a size.
fn table<T: Copy + Default>(points: impl Iterator<Item = (Point, T)> + Clone, size: f64) -> PointTable<T> {
    PointTable::new(bounds(points.clone().map(|(p, _)| p)).unwrap_or_default(), size, points)
}

impl Warp {
    /// Pushes at samples of an outline that are about `step` apart.
    pub fn new(samples: &[Point], pushes: &[Vec2], radius: f64, step: f64) -> Self {
        // What lies farther than twice the radius from any push weighs nothing where one is felt.
        let all = samples.iter().copied().zip(pushes.iter().copied());
        let pushed = table(all.clone().filter(|(_, push)| *push != Vec2::ZERO), 2.0 * radius);
        let is_near = |(at, push): &(Point, Vec2)| {
            *push != Vec2::ZERO
                || pushed
                    .near(*at, 2.0 * radius)
                    .any(|(p, _)| p.distance_squared(*at) < 4.0 * radius * radius)
        };
        let near: Vec<(Point, Vec2)> = all.filter(is_near).collect();
        Warp {
            samples: Arc::new(table(near.iter().copied(), radius)),
            share: 1.0,
            radius,
            fade: fade(radius, step),
        }
    }

    /// The same with pushes that are shorter.
    pub fn scaled(&self, share: f64) -> Self {
        Warp { share: share * self.share, ..self.clone() }
    }

    /// True if a push may be felt within `distance` of a place.
    pub fn reaches(&self, p: Point, distance: f64) -> bool {
        let reach = self.radius + distance;
        let is_felt =
            |(sample, push): (Point, Vec2)| push != Vec2::ZERO && (sample - p).hypot2() < reach * reach;
        self.samples.near(p, reach).any(is_felt)
    }

    /// How far a push is felt.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Where a point goes.
    pub fn point(&self, p: Point) -> Point {
        let (mut sum, mut total) = (Vec2::ZERO, self.fade);
        let squared_radius = self.radius * self.radius;
        self.samples.near(p, self.radius).for_each(|(sample, push)| {
            let squared = (p - sample).hypot2();
            if squared < squared_radius {
                let w = weight(squared / squared_radius);
                sum += w * push;
                total += w;
            }
        });
        p + self.share * sum / total
    }

    /// Where a point goes, and directions at it with it.
    pub fn jet(&self, p: Point, directions: [&mut Vec2; 2]) -> Point {
        let squared_radius = self.radius * self.radius;
        let (mut sum, mut total) = (Vec2::ZERO, self.fade);
        // How both change with p, by x and y.
        let (mut sum_by, mut total_by) = ([Vec2::ZERO; 2], Vec2::ZERO);
        self.samples.near(p, self.radius).for_each(|(sample, push)| {
            let from = p - sample;
            let rest = 1.0 - from.hypot2() / squared_radius;
            if rest > 0.0 {
                let w = rest * rest * rest;
                sum += w * push;
                total += w;
                let by = (-6.0 * rest * rest / squared_radius) * from;
                sum_by[0] += by.x * push;
                sum_by[1] += by.y * push;
                total_by += by;
            }
        });
        if sum_by != [Vec2::ZERO; 2] {
            for direction in directions {
                let sum_by = direction.x * sum_by[0] + direction.y * sum_by[1];
                let total_by = total_by.dot(*direction);
                *direction += self.share * (sum_by / total - sum * (total_by / (total * total)));
            }
        }
        p + self.share * sum / total
    }
}

/// Which samples of an outline move with each other, and how much: as [`Warp`] moves them.
pub struct Ties {
    /// Where each sample's row begins.
    starts: Vec<u32>,
    /// Samples near each one, itself too, with their weights. There are many, and single precision will do.
    near: Vec<(u32, f32)>,
}

impl Ties {
    /// Between samples that are about `step` apart, for those that may be pushed and what is near them.
    pub fn new(samples: &[Point], is_pushed: &[bool], radius: f64, step: f64) -> Self {
        if !is_pushed.contains(&true) {
            return Ties { starts: vec![0; samples.len() + 1], near: Vec::new() };
        }
        let all = table(samples.iter().copied().zip(0u32..), radius);
        let pushed = samples.iter().zip(is_pushed).filter(|(_, is_pushed)| **is_pushed);
        let pushed = table(pushed.map(|(&p, _)| (p, ())), radius);
        let (squared_radius, fade) = (radius * radius, fade(radius, step));
        let room = 8 * is_pushed.iter().filter(|pushed| **pushed).count();
        let mut ties = Ties { starts: Vec::with_capacity(samples.len() + 1), near: Vec::with_capacity(room) };
        ties.starts.push(0);
        let mut row: Vec<(u32, f64)> = Vec::new();
        for (&p, &is_pushed) in samples.iter().zip(is_pushed) {
            if is_pushed || pushed.near(p, radius).any(|(q, _)| (p - q).hypot2() < squared_radius) {
                row.clear();
                let squared = all.near(p, radius).map(|(q, j)| (j, (p - q).hypot2()));
                let near = squared.filter(|(_, squared)| *squared < squared_radius);
                row.extend(near.map(|(j, squared)| (j, weight(squared / squared_radius))));
                let total = fade + row.iter().map(|(_, w)| w).sum::<f64>();
                ties.near.extend(row.iter().map(|&(j, w)| (j, (w / total) as f32)));
            }
            ties.starts.push(ties.near.len() as u32);
        }
        ties
    }

    /// Samples near one, with their weights; none if it is not moved.
    fn row(&self, i: usize) -> &[(u32, f32)] {
        &self.near[self.starts[i] as usize..self.starts[i + 1] as usize]
    }

    /// The samples that may move.
    pub fn moved(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.starts.len() - 1).filter(|&i| !self.row(i).is_empty())
    }

    /// The least of the values near a sample.
    pub fn least(&self, values: &[f64], i: usize) -> f64 {
        self.row(i).iter().map(|&(j, _)| values[j as usize]).fold(f64::INFINITY, f64::min)
    }

    /// True if any of the samples near one is so.
    pub fn any(&self, i: usize, is_so: impl Fn(usize) -> bool) -> bool {
        self.row(i).iter().any(|&(j, _)| is_so(j as usize))
    }

    /// How far a sample moves.
    pub fn push(&self, pushes: &[Vec2], i: usize) -> Vec2 {
        self.row(i).iter().fold(Vec2::ZERO, |sum, &(j, w)| sum + f64::from(w) * pushes[j as usize])
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
            let warp = Warp::new(&samples, &pushes, 3.0, 0.7);
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
        let (ties, warp) =
            (Ties::new(&samples, &[true; 90], 3.0, 0.7), Warp::new(&samples, &pushes, 3.0, 0.7));
        for (i, &p) in samples.iter().enumerate() {
            let moved = warp.point(p) - p;
            assert!((moved - ties.push(&pushes, i)).hypot() < 1e-7);
            let near: Vec<f64> = pushes.iter().map(|push| push.hypot()).collect();
            let far: Vec<f64> = near.iter().map(|length| -length).collect();
            assert!(moved.hypot() <= -ties.least(&far, i), "no farther than the farthest near by");
        }
    }
}
