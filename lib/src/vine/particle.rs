//! Curves that a charged particle draws in a magnetic field (Xu and Mould 2009; checklist M-003
//! to M-006, M-035 to M-040).
//!
//! A particle of charge q moving at constant speed in a field B turns at the rate q B. With the
//! charge `q(t) = (T - t)^(-alpha)` and a constant field the heading is, exactly,
//!
//! `theta(t) = theta0 + s B [T^(1-alpha) - (T-t)^(1-alpha)] / (1-alpha)`, and for alpha = 1
//! `theta0 + s B ln(T / (T-t))`.
//!
//! Since speed is 1, t is arc length and the curvature is `B (T - t)^(-alpha)`: all curves with
//! the same alpha and the same total turning are similar, so each is computed once, of length 1
//! (a [`Form`]), and then only turned, scaled and moved. The artist sets the turning; B follows.
//!
//! Departure: the article integrates by forward Euler steps, which multiply the speed by
//! `sqrt(1 + q^2)` at each step and draw another, longer curve. That is `--integrator euler`.

use kurbo::{Point, Vec2};
use rinceau_format::Error;
use std::f64::consts::{FRAC_PI_2, TAU};

/// A curl ends when this share of its length is left: for alpha of 1 and more it would turn
/// for ever.
const END: f64 = 0.006;
/// Nodes are at most this far apart, in lengths of the curve, and in radians.
const STEP: f64 = 1.0 / 60.0;
const STEP_ANGLE: f64 = 0.16;
/// Samples of a charge without a closed form.
const SAMPLES: usize = 512;

/// How the charge changes along the way, from x = 0 to 1.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Charge {
    /// `(1 - x)^(-alpha)`.
    Power,
    Constant,
    /// Two and a half waves.
    Sine,
    /// Two and a half triangular waves.
    Triangle,
    /// Numbers of the artist's own, evenly spaced, with straight lines between.
    Points(Vec<f64>),
}

impl Charge {
    /// Errors on what is neither a name nor numbers.
    pub fn from_param(text: &str) -> Result<Self, Error> {
        Ok(match text.trim() {
            "power" => Charge::Power,
            "constant" => Charge::Constant,
            "sine" => Charge::Sine,
            "triangle" => Charge::Triangle,
            numbers => {
                let points: Option<Vec<f64>> =
                    numbers.split_whitespace().map(|word| word.parse().ok()).collect();
                let usable = |p: &Vec<f64>| {
                    (2..=64).contains(&p.len())
                        && p.iter().all(|q| q.is_finite() && q.abs() <= 1e6)
                        && p.iter().any(|&q| q != 0.0)
                };
                let Some(points) = points.filter(usable) else {
                    return Err(Error::new(
                        "bad-charge",
                        format!("charge cannot be '{numbers}'"),
                        "Give power, constant, sine, triangle, or 2 to 64 numbers with spaces between, such as '1 -1 2'",
                    ));
                };
                Charge::Points(points)
            }
        })
    }

    /// Charge at x, up to a factor; `alpha` is that of a power.
    fn at(&self, x: f64, alpha: f64) -> f64 {
        const WAVES: f64 = 2.5;
        match self {
            Charge::Power => libm::pow(1.0 - x, -alpha),
            Charge::Constant => 1.0,
            Charge::Sine => libm::sin(TAU * WAVES * x),
            Charge::Triangle => {
                let phase = (WAVES * x + 0.25).fract();
                1.0 - 4.0 * (phase - 0.5).abs()
            }
            Charge::Points(points) => {
                let place = x * (points.len() - 1) as f64;
                let i = (place as usize).min(points.len() - 2);
                points[i] + (place - i as f64) * (points[i + 1] - points[i])
            }
        }
    }
}

/// A node of a curve.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    /// Arc length from the start.
    pub s: f64,
    pub p: Point,
    /// Unit tangent.
    pub along: Vec2,
    /// Signed curvature: positive turns from x towards y.
    pub curvature: f64,
}

/// A curve of nominal length 1 that starts at the origin along x and turns towards y.
#[derive(Clone, Debug)]
pub(super) struct Form {
    pub nodes: Vec<Node>,
}

impl Node {
    /// Between two nodes, on a straight line.
    pub fn between(&self, to: &Node, t: f64) -> Node {
        if t == 1.0 {
            return *to;
        }
        let mix = |a: f64, b: f64| a + t * (b - a);
        Node {
            s: mix(self.s, to.s),
            p: self.p.lerp(to.p, t),
            along: self.along.lerp(to.along, t),
            curvature: mix(self.curvature, to.curvature),
        }
    }
}

impl Form {
    /// The curve of a level.
    pub fn new(charge: &Charge, alpha: f64, turns: f64, euler: bool) -> Self {
        let law = Law::new(charge, alpha, turns * TAU);
        let mut nodes = if euler { law.euler() } else { law.exact() };
        nodes.truncate(before_itself(&nodes));
        Form { nodes }
    }

    /// Arc length in all.
    pub fn length(&self) -> f64 {
        self.nodes.last().map_or(0.0, |node| node.s)
    }
}

/// How many nodes there are before a curve comes back to itself.
fn before_itself(nodes: &[Node]) -> usize {
    /// About as near as the narrowest gap of two windings, in lengths of the curve.
    const NEAR: f64 = 0.025;
    /// Farther back than this counts as another winding.
    const BACK: f64 = 0.1;
    let back = |i: usize| nodes[..i].iter().take_while(move |node| node.s < nodes[i].s - BACK);
    let meets = |&i: &usize| back(i).any(|node| node.p.distance_squared(nodes[i].p) < NEAR * NEAR);
    (1..nodes.len()).find(meets).unwrap_or(nodes.len()).max(2)
}

/// The heading of a curve of length 1.
pub(super) struct Law<'a> {
    charge: &'a Charge,
    alpha: f64,
    /// Factor of the charge that gives the turning asked for: B.
    field: f64,
    /// Turning up to each of [`SAMPLES`] places, for charges without a closed form.
    turned: Vec<f64>,
}

impl<'a> Law<'a> {
    /// `turning` in radians: what the curve turns in all; for charges that change sign, all
    /// turns one way and the other together.
    pub fn new(charge: &'a Charge, alpha: f64, turning: f64) -> Self {
        let mut law = Law { charge, alpha, field: 1.0, turned: Vec::new() };
        if *charge == Charge::Power {
            law.field = turning / law.heading(1.0 - END);
            return law;
        }
        // Trapezoids: the heading is then consistent with the curvature to 1e-5 of a turn.
        let q = |i: usize| charge.at(i as f64 / SAMPLES as f64, alpha);
        let (mut sum, mut absolute) = (0.0, 0.0);
        law.turned.push(0.0);
        for i in 1..=SAMPLES {
            let mean = f64::midpoint(q(i - 1), q(i)) / SAMPLES as f64;
            sum += mean;
            absolute += mean.abs();
            law.turned.push(sum);
        }
        law.field = if absolute > 0.0 { turning / absolute } else { 0.0 };
        law
    }

    /// Heading at x in radians.
    pub fn heading(&self, x: f64) -> f64 {
        if *self.charge == Charge::Power {
            let exponent = 1.0 - self.alpha;
            let left = (1.0 - x).max(0.5 * END);
            let turned = if exponent.abs() < 1e-9 {
                -libm::log(left)
            } else {
                (1.0 - libm::pow(left, exponent)) / exponent
            };
            return self.field * turned;
        }
        let place = (x * SAMPLES as f64).clamp(0.0, SAMPLES as f64);
        let i = (place as usize).min(SAMPLES - 1);
        self.field * (self.turned[i] + (place - i as f64) * (self.turned[i + 1] - self.turned[i]))
    }

    /// Curvature at x.
    pub fn curvature(&self, x: f64) -> f64 {
        self.field * self.charge.at(x.min(1.0 - 0.5 * END), self.alpha)
    }

    /// Places of nodes: close enough where the curve turns fast.
    fn places(&self) -> Vec<f64> {
        let end = if *self.charge == Charge::Power { 1.0 - END } else { 1.0 };
        let mut places = vec![0.0];
        let mut x = 0.0;
        while x < end {
            // The curvature may grow within the step, so it is asked at its far end too.
            let turn = |x: f64| self.curvature(x).abs().max(f64::MIN_POSITIVE);
            let first = STEP.min(STEP_ANGLE / turn(x));
            let step = first.min(STEP_ANGLE / turn((x + first).min(end))).max(1e-5);
            x = if x + 1.2 * step >= end { end } else { x + step };
            places.push(x);
        }
        places
    }

    /// The heading is exact; the position is its integral by Gauss's three points, whose
    /// error at these steps is below 1e-9.
    fn exact(&self) -> Vec<Node> {
        const GAUSS: [(f64, f64); 3] = [
            (0.112_701_665_379_258_31, 5.0 / 18.0),
            (0.5, 8.0 / 18.0),
            (0.887_298_334_620_741_7, 5.0 / 18.0),
        ];
        let mut p = Point::ORIGIN;
        let mut before = 0.0;
        self.places()
            .into_iter()
            .map(|x| {
                let h = x - before;
                for (place, weight) in GAUSS {
                    p += h * weight * unit(self.heading(before + place * h));
                }
                before = x;
                Node { s: x, p, along: unit(self.heading(x)), curvature: self.curvature(x) }
            })
            .collect()
    }

    /// The article's loop: as many steps as a curve of this length has pixels there.
    fn euler(&self) -> Vec<Node> {
        const STEPS: usize = 300;
        let dt = 1.0 / STEPS as f64;
        let (mut p, mut v) = (Point::ORIGIN, Vec2::new(1.0, 0.0));
        let mut s = 0.0;
        let mut nodes = Vec::with_capacity(STEPS);
        for i in 0..STEPS {
            let turn = self.curvature(i as f64 * dt) * dt;
            let speed = v.hypot();
            nodes.push(Node { s, p, along: v / speed, curvature: turn / (dt * speed) });
            p += dt * v;
            s += dt * speed;
            v += turn * Vec2::new(-v.y, v.x);
            // Beyond this the article's speed-up has left any page.
            if v.hypot() > 50.0 {
                break;
            }
        }
        let last = nodes.last().map_or(0.0, |node: &Node| node.curvature);
        nodes.push(Node { s, p, along: v / v.hypot(), curvature: last });
        nodes
    }
}

/// The unit vector of a heading.
pub(super) fn unit(heading: f64) -> Vec2 {
    Vec2::new(libm::cos(heading), libm::sin(heading))
}

/// Follows a law from a place where the field is not the same everywhere: `strength` gives B at
/// a place as a multiple of the constant one. Returns the curve of nominal length `length`.
pub(super) fn follow(
    law: &Law,
    start: Node,
    length: f64,
    side: f64,
    strength: impl Fn(Point) -> f64,
) -> Vec<Node> {
    let heading = libm::atan2(start.along.y, start.along.x);
    let mut turned = 0.0;
    let mut p = start.p;
    let mut nodes = Vec::new();
    let mut before = 0.0;
    for x in law.places() {
        // The field at the middle of the step, and the law's own exact turning over it.
        let h = x - before;
        let middle = p + 0.5 * h * length * unit(heading + side * turned);
        let b = strength(middle).clamp(0.0, 8.0);
        let turn = b * (law.heading(x) - law.heading(before));
        p += h * length * unit(heading + side * (turned + 0.5 * turn)) * sinc(0.5 * turn);
        turned += turn;
        nodes.push(Node {
            s: x * length,
            p,
            along: unit(heading + side * turned),
            curvature: side * b * law.curvature(x) / length,
        });
        before = x;
    }
    nodes
}

/// Chord over arc of a circle of half this angle.
fn sinc(x: f64) -> f64 {
    if x.abs() < 1e-4 {
        1.0 - x * x / 6.0
    } else {
        libm::sin(x.abs().min(FRAC_PI_2)) / x.abs().min(FRAC_PI_2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Fine forward steps of the heading's definition, for comparison.
    fn brute(alpha: f64, turning: f64) -> (Point, f64) {
        let n = 2_000_000;
        let h = (1.0 - END) / f64::from(n);
        let total: f64 = (0..n).map(|i| h * libm::pow(1.0 - (f64::from(i) + 0.5) * h, -alpha)).sum();
        let (mut p, mut heading) = (Point::ORIGIN, 0.0);
        for i in 0..n {
            let q = turning / total * libm::pow(1.0 - (f64::from(i) + 0.5) * h, -alpha);
            p += h * unit(heading + 0.5 * q * h);
            heading += q * h;
        }
        (p, heading)
    }

    #[test]
    fn forms_turn_as_asked_and_end_where_the_integral_ends() {
        for (alpha, turns) in [(0.0, 0.75), (0.5, 2.0), (0.8, 1.3), (1.0, 1.0), (-1.0, 1.5)] {
            let form = Form::new(&Charge::Power, alpha, turns, false);
            let (p, heading) = brute(alpha, turns * TAU);
            let last = form.nodes.last().unwrap();
            assert!((heading - turns * TAU).abs() < 1e-4, "{alpha}");
            assert!(last.p.distance(p) < 2e-6, "{alpha}: {:?} {p:?}", last.p);
            assert!((last.along - unit(turns * TAU)).hypot() < 1e-9);
        }
    }

    #[test]
    fn a_circle_ends_before_it_meets_its_start() {
        let form = Form::new(&Charge::Constant, 0.0, 1.75, false);
        let turned = form.length() * 1.75;
        assert!((0.8..1.0).contains(&turned), "{turned}");
    }

    #[test]
    fn eulers_steps_speed_up_as_measured() {
        // alpha = 1/2, B = 1 in pixels, T = 300: the speed grows by exactly sqrt(T + 1).
        let t = 300.0f64;
        let turning = 2.0 * t.sqrt() * (1.0 - END.sqrt());
        let nodes = Law::new(&Charge::Power, 0.5, turning).euler();
        let length = nodes.last().unwrap().s * t;
        assert!((length - 560.0).abs() < 8.0, "{length}");
    }

    #[test]
    fn an_even_field_changes_nothing() {
        let law = Law::new(&Charge::Power, 0.6, 1.2 * TAU);
        let form = Form::new(&Charge::Power, 0.6, 1.2, false);
        let start = Node { s: 0.0, p: Point::ORIGIN, along: Vec2::new(1.0, 0.0), curvature: 0.0 };
        let followed = follow(&law, start, 1.0, 1.0, |_| 1.0);
        assert!(followed.last().unwrap().p.distance(form.nodes.last().unwrap().p) < 2e-3);
    }

    #[test]
    fn charges_are_names_or_numbers() {
        assert_eq!(Charge::from_param("1 -1 2").unwrap(), Charge::Points(vec![1.0, -1.0, 2.0]));
        assert!(Charge::from_param("1").is_err() && Charge::from_param("0 0").is_err());
        assert!(Charge::from_param("banana").is_err() && Charge::from_param("nan 1").is_err());
    }
}
