//! Uniform cubic B-splines over [0, 1]: twice continuously differentiable, and always inside
//! the convex hull of their coefficients, which turns bounds on coefficients into bounds on
//! the curve.

use kurbo::{Point, Vec2};

/// Weights of the four coefficients around `t` in a span, and of their first and second
/// derivatives by `t`.
fn basis(t: f64) -> ([f64; 4], [f64; 4], [f64; 4]) {
    let (t2, t3, m) = (t * t, t * t * t, 1.0 - t);
    (
        [
            m * m * m / 6.0,
            (3.0 * t3 - 6.0 * t2 + 4.0) / 6.0,
            (-3.0 * t3 + 3.0 * t2 + 3.0 * t + 1.0) / 6.0,
            t3 / 6.0,
        ],
        [-m * m / 2.0, (3.0 * t2 - 4.0 * t) / 2.0, (-3.0 * t2 + 2.0 * t + 1.0) / 2.0, t2 / 2.0],
        [m, 3.0 * t - 2.0, 1.0 - 3.0 * t, t],
    )
}

/// Span and place in it of `u` in [0, 1]; clamped, so the ends extrapolate the end spans.
fn locate(u: f64, spans: usize) -> (usize, f64) {
    let scaled = u * spans as f64;
    let span = (scaled.max(0.0) as usize).min(spans - 1);
    (span, scaled - span as f64)
}

/// A plane curve.
#[derive(Clone, Debug)]
pub struct Curve {
    coefficients: Vec<Point>,
}

/// A curve's position, and its first and second derivatives by `u`.
#[derive(Clone, Copy, Debug)]
pub struct CurveJet {
    /// Position.
    pub p: Point,
    /// First derivative.
    pub d: Vec2,
    /// Second derivative.
    pub dd: Vec2,
}

impl Curve {
    /// A curve that starts at the first and ends at the last of evenly spaced points and
    /// passes smoothly near the others. At least two points.
    pub fn near(points: &[Point]) -> Self {
        debug_assert!(points.len() > 1);
        let n = points.len();
        let mut coefficients = Vec::with_capacity(n + 2);
        coefficients.push(points[0] + (points[0] - points[1]));
        coefficients.extend_from_slice(points);
        coefficients.push(points[n - 1] + (points[n - 1] - points[n - 2]));
        Curve { coefficients }
    }

    /// Position and derivatives; straight on beyond the ends.
    pub fn jet(&self, u: f64) -> CurveJet {
        let spans = self.coefficients.len() - 3;
        let clamped = u.clamp(0.0, 1.0);
        let (span, t) = locate(clamped, spans);
        let (b, d, dd) = basis(t);
        let c = &self.coefficients[span..span + 4];
        let sum = |w: [f64; 4]| {
            w[0] * c[0].to_vec2() + w[1] * c[1].to_vec2() + w[2] * c[2].to_vec2() + w[3] * c[3].to_vec2()
        };
        let scale = spans as f64;
        let jet = CurveJet { p: sum(b).to_point(), d: scale * sum(d), dd: scale * scale * sum(dd) };
        if u == clamped {
            jet
        } else {
            CurveJet { p: jet.p + (u - clamped) * jet.d, d: jet.d, dd: Vec2::ZERO }
        }
    }
}

/// A function of `u`.
#[derive(Clone, Debug)]
pub struct Profile {
    coefficients: Vec<f64>,
}

impl Profile {
    /// The same value everywhere.
    pub fn constant(value: f64) -> Self {
        Profile { coefficients: vec![value; 4] }
    }

    /// A smooth function nowhere above the bounds, which hold on equal bins of [0, 1]: each
    /// coefficient is the least bound on the bins that it has any weight in.
    pub fn below(bounds: &[f64], spans: usize) -> Self {
        Profile::envelope(bounds, spans, f64::INFINITY, f64::min)
    }

    /// A smooth function that follows the bounds from below, closer than [`Profile::below`],
    /// and nowhere above them at the middles of the bins:
    /// each coefficient starts from the bounds around its own place, and where the curve
    /// then lies above a bound, the coefficients there are lowered.
    pub fn under(bounds: &[f64], spans: usize) -> Self {
        const PASSES: usize = 3;
        let bins = bounds.len();
        let place = |j: usize| (j as f64 - 1.0) / spans as f64 * bins as f64;
        let around = |j: usize, reach: f64| {
            let reach = reach * bins as f64 / spans as f64;
            let from = ((place(j) - reach).max(0.0) as usize).min(bins - 1);
            let to = ((place(j) + reach).ceil().max(0.0) as usize).clamp(from + 1, bins);
            from..to
        };
        let least = |values: &[f64]| values.iter().copied().fold(f64::INFINITY, f64::min);
        let mut profile =
            Profile { coefficients: (0..spans + 3).map(|j| least(&bounds[around(j, 0.6)])).collect() };
        for pass in 0..PASSES {
            // The curve is smooth on the scale of a bin, so its middle tells.
            let over: Vec<f64> = (0..bins)
                .map(|i| bounds[i] / profile.value((i as f64 + 0.5) / bins as f64).max(f64::MIN_POSITIVE))
                .collect();
            if pass + 1 == PASSES {
                let all = least(&over).min(1.0);
                return profile.scaled(all);
            }
            for (j, c) in profile.coefficients.iter_mut().enumerate() {
                *c *= least(&over[around(j, 1.0)]).min(1.0);
            }
        }
        profile
    }

    /// A smooth function nowhere below the bounds.
    pub fn above(bounds: &[f64], spans: usize) -> Self {
        Profile::envelope(bounds, spans, f64::NEG_INFINITY, f64::max)
    }

    fn envelope(bounds: &[f64], spans: usize, start: f64, pick: fn(f64, f64) -> f64) -> Self {
        let bins = bounds.len();
        let coefficients = (0..spans + 3).map(|j| {
            let first = (j.saturating_sub(3) * bins) / spans;
            let last = ((j + 1) * bins).div_ceil(spans).min(bins);
            bounds[first.min(bins - 1)..last].iter().copied().fold(start, pick)
        });
        Profile { coefficients: coefficients.collect() }
    }

    /// Applies a function to every coefficient of this and the same one of another profile.
    #[must_use]
    pub fn zip(&self, other: &Profile, f: impl Fn(f64, f64) -> f64) -> Self {
        Profile {
            coefficients: self.coefficients.iter().zip(&other.coefficients).map(|(&a, &b)| f(a, b)).collect(),
        }
    }

    /// The profile multiplied by a number.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Profile { coefficients: self.coefficients.iter().map(|c| c * factor).collect() }
    }

    /// Value; constant beyond the ends.
    pub fn value(&self, u: f64) -> f64 {
        let (span, t) = locate(u.clamp(0.0, 1.0), self.coefficients.len() - 3);
        let m = 1.0 - t;
        let c = &self.coefficients[span..span + 4];
        // De Boor's algorithm, uniform: three rounds of linear interpolation.
        let (a, b) = ((m * c[0] + (2.0 + t) * c[1]) / 3.0, ((1.0 + m) * c[1] + (1.0 + t) * c[2]) / 3.0);
        let d = ((2.0 + m) * c[2] + t * c[3]) / 3.0;
        let (e, f) = ((m * a + (1.0 + t) * b) / 2.0, ((1.0 + m) * b + t * d) / 2.0);
        m * e + t * f
    }

    /// Value and derivative by `u`; constant beyond the ends.
    pub fn jet(&self, u: f64) -> (f64, f64) {
        let spans = self.coefficients.len() - 3;
        let clamped = u.clamp(0.0, 1.0);
        let (span, t) = locate(clamped, spans);
        let (b, d, _) = basis(t);
        let c = &self.coefficients[span..span + 4];
        let dot = |w: [f64; 4]| w[0] * c[0] + w[1] * c[1] + w[2] * c[2] + w[3] * c[3];
        (dot(b), if u == clamped { dot(d) * spans as f64 } else { 0.0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn profiles_keep_their_bounds(bounds in prop::collection::vec(0.1..10.0f64, 20..120), spans in 1usize..16) {
            let (below, above) = (Profile::below(&bounds, spans), Profile::above(&bounds, spans));
            let under = Profile::under(&bounds, spans);
            for i in 0..=1000 {
                let u = f64::from(i) / 1000.0;
                let bin = ((u * bounds.len() as f64) as usize).min(bounds.len() - 1);
                prop_assert!(below.jet(u).0 <= bounds[bin] + 1e-9);
                let middle = (bin as f64 + 0.5) / bounds.len() as f64;
                prop_assert!((under.value(u) - under.jet(u).0).abs() < 1e-9);
                prop_assert!(under.jet(middle).0 <= bounds[bin] + 1e-9);
                prop_assert!(above.jet(u).0 >= bounds[bin] - 1e-9);
            }
        }
    }

    #[test]
    fn curves_keep_their_ends_and_derivatives() {
        let points = [(0.0, 0.0), (1.0, 0.0), (2.0, 1.0), (3.0, 3.0)].map(Point::from);
        let curve = Curve::near(&points);
        assert!(curve.jet(0.0).p.distance(points[0]) < 1e-12);
        assert!(curve.jet(1.0).p.distance(points[3]) < 1e-12);
        for u in [0.1, 0.4, 0.77] {
            let (a, b, jet) = (curve.jet(u - 1e-6), curve.jet(u + 1e-6), curve.jet(u));
            assert!(((b.p - a.p) / 2e-6 - jet.d).hypot() < 1e-6);
            assert!(((b.d - a.d) / 2e-6 - jet.dd).hypot() < 1e-4);
        }
    }
}
