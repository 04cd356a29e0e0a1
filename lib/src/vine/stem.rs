//! Stems: a curve with a width that tapers, and its outline in few smooth Béziers (checklist
//! M-015 to M-017).

use super::particle::Node;
use super::plait::Cut;
use crate::geom::polyline::left_of;
use kurbo::{BezPath, CubicBez, ParamCurve, Point, Vec2};

/// How the width runs along a stem.
#[derive(Clone, Copy, Debug)]
pub(super) struct Taper {
    /// Width at the start.
    pub start: f64,
    /// Width at the tip.
    ///
    /// Departure: the article's stroke runs out to nothing. A needle breaks on a cutter and
    /// vanishes in print, so a tip keeps a share of the width, and a round end.
    pub tip: f64,
    /// 1 is linear.
    pub power: f64,
}

impl Taper {
    /// Width at a share of the length.
    pub fn at(&self, share: f64) -> f64 {
        let left = (1.0 - share).clamp(0.0, 1.0);
        // Most stems taper evenly, and powers are dear.
        let left = if self.power == 1.0 { left } else { libm::pow(left, self.power) };
        self.tip + (self.start - self.tip) * left
    }

    /// Change of the width by the share.
    fn slope(&self, share: f64) -> f64 {
        // A power below 1 falls off a cliff at the tip; an outline cannot follow it there.
        let left = (1.0 - share).clamp(0.05, 1.0);
        -(self.start - self.tip) * self.power * libm::pow(left, self.power - 1.0)
    }
}

/// A stem in its place.
#[derive(Clone, Debug)]
pub(super) struct Stem {
    /// 0 for a main stem.
    pub level: usize,
    /// Index of the stem it leaves, and the arc length there.
    pub parent: Option<(usize, f64)>,
    /// +1 if it curls from x towards y, -1 the other way.
    pub side: f64,
    pub nodes: Vec<Node>,
    pub taper: Taper,
    /// Where it is cut off, under the flower at its tip.
    pub end: f64,
    /// Gaps where it goes under others, in order.
    pub cuts: Vec<Cut>,
}

/// An end of a piece.
#[derive(Clone, Copy, Debug)]
struct End {
    s: f64,
    /// How much farther along it runs per unit to the left.
    skew: f64,
    round: bool,
}

impl Stem {
    /// A stem without cuts.
    pub fn new(
        level: usize,
        parent: Option<(usize, f64)>,
        side: f64,
        nodes: Vec<Node>,
        taper: Taper,
    ) -> Self {
        let end = nodes.last().map_or(0.0, |node| node.s);
        Stem { level, parent, side, nodes, taper, end, cuts: Vec::new() }
    }

    /// Arc length in all.
    pub fn length(&self) -> f64 {
        self.nodes.last().map_or(0.0, |node| node.s)
    }

    /// The stem between two arc lengths, as one of its own.
    pub fn part(&self, from: f64, to: f64) -> Self {
        let nodes = self.between(from, to).into_iter().map(|node| Node { s: node.s - from, ..node });
        Stem::new(self.level, self.parent, self.side, nodes.collect(), self.taper)
    }

    /// Where it lies from left to right, its width included.
    pub fn sides(&self) -> (f64, f64) {
        let xs = || self.nodes.iter().map(|node| node.p.x);
        let half = self.taper.start / 2.0;
        (xs().fold(f64::INFINITY, f64::min) - half, xs().fold(f64::NEG_INFINITY, f64::max) + half)
    }

    /// How far it reaches from left to right, its width included.
    pub fn span(&self) -> f64 {
        let (left, right) = self.sides();
        right - left
    }

    /// Width at an arc length.
    pub fn width(&self, s: f64) -> f64 {
        self.taper.at(s / self.length().max(f64::MIN_POSITIVE))
    }

    /// The curve at an arc length, between its nodes as cubics.
    pub fn at(&self, s: f64) -> Node {
        let i = self.nodes.partition_point(|node| node.s <= s).clamp(1, self.nodes.len() - 1);
        let (a, b) = (self.nodes[i - 1], self.nodes[i]);
        let h = b.s - a.s;
        if h <= 0.0 {
            return b;
        }
        let t = ((s - a.s) / h).clamp(0.0, 1.0);
        let cubic = hermite(a.p, h * a.along, b.p, h * b.along);
        let along = a.along.lerp(b.along, t);
        Node {
            s: a.s + t * h,
            p: cubic.eval(t),
            along: along / along.hypot().max(f64::MIN_POSITIVE),
            curvature: a.curvature + t * (b.curvature - a.curvature),
        }
    }

    /// The nodes between two arc lengths, with the curve at both.
    pub fn between(&self, from: f64, to: f64) -> Vec<Node> {
        let mut nodes = vec![self.at(from)];
        // A node next to an end would make a piece too short to have a direction.
        let apart = 1e-6 * self.length();
        nodes.extend(self.nodes.iter().filter(|node| node.s > from + apart && node.s < to - apart));
        nodes.push(self.at(to));
        nodes
    }

    /// The pieces that the cuts leave.
    fn pieces(&self) -> Vec<(End, End)> {
        // Nothing lies under the start of a main stem; a branch starts within its parent.
        let mut from = End { s: 0.0, skew: 0.0, round: self.parent.is_none() };
        let mut pieces = Vec::new();
        for cut in &self.cuts {
            let flat = |s: f64| End { s, skew: cut.skew, round: false };
            if cut.from > from.s && cut.to < self.end {
                pieces.push((from, flat(cut.from)));
                from = flat(cut.to);
            }
        }
        pieces.push((from, End { s: self.end, skew: 0.0, round: true }));
        pieces
    }

    /// The centre line from the start to the end, without what is cut.
    pub fn centre_line(&self, tolerance: f64) -> BezPath {
        let mut path = BezPath::new();
        for (from, to) in self.pieces() {
            let nodes = self.between(from.s, to.s);
            let edge: Vec<Edge> =
                nodes.iter().map(|node| Edge { s: node.s, p: node.p, d: node.along }).collect();
            path.move_to(edge[0].p);
            append(&edge, tolerance, &mut path);
        }
        path
    }

    /// The outline from the start to the end, without what is cut.
    pub fn outline(&self, tolerance: f64) -> BezPath {
        let mut path = BezPath::new();
        for (from, to) in self.pieces() {
            self.piece(from, to, tolerance, &mut path);
        }
        path
    }

    fn piece(&self, from: End, to: End, tolerance: f64, path: &mut BezPath) {
        let shift = |end: End, side: f64| end.s + side * end.skew * self.width(end.s) / 2.0;
        let edge = |side: f64| -> Vec<Edge> {
            let nodes = self.between(shift(from, side), shift(to, side));
            nodes.iter().map(|node| self.edge(node, side)).collect()
        };
        let left = edge(1.0);
        let mut right = edge(-1.0);
        right.reverse();
        right.iter_mut().for_each(|edge| (edge.s, edge.d) = (-edge.s, -edge.d));
        let (first, last) = (self.at(from.s), self.at(to.s));
        path.move_to(left[0].p);
        append(&left, tolerance, path);
        end(path, right[0].p, last.along, to.round);
        append(&right, tolerance, path);
        if from.round {
            end(path, left[0].p, -first.along, true);
        }
        path.close_path();
    }

    /// A point of an edge and how it moves with s.
    fn edge(&self, node: &Node, side: f64) -> Edge {
        let length = self.length().max(f64::MIN_POSITIVE);
        let (half, slope) = (self.width(node.s) / 2.0, self.taper.slope(node.s / length) / (2.0 * length));
        let normal = side * left_of(node.along);
        // Where the curl is tighter than the stem is wide the inner edge would turn back; it
        // stands still instead.
        let stretch = (1.0 - side * half * node.curvature).max(0.02);
        let half = half.min(0.98 / (side * node.curvature).max(f64::MIN_POSITIVE));
        Edge { s: node.s, p: node.p + half * normal, d: stretch * node.along + slope * normal }
    }
}

/// A point of an edge, and its derivative by `s`.
#[derive(Clone, Copy, Debug)]
struct Edge {
    s: f64,
    p: Point,
    d: Vec2,
}

/// Goes around the end of a piece to its other side.
fn end(path: &mut BezPath, to: Point, along: Vec2, round: bool) {
    let Some(from) = path.elements().last().and_then(kurbo::PathEl::end_point) else { return };
    if !round {
        path.line_to(to);
        return;
    }
    // Two quarter circles.
    const QUARTER: f64 = 0.552_284_75;
    let half = (to - from) / 2.0;
    let (middle, out) = (from + half, along * half.hypot());
    let top = middle + out;
    path.curve_to(from + QUARTER * out, top - QUARTER * half, top);
    path.curve_to(top + QUARTER * half, to + QUARTER * out, to);
}

fn hermite(a: Point, da: Vec2, b: Point, db: Vec2) -> CubicBez {
    CubicBez::new(a, a + da / 3.0, b - db / 3.0, b)
}

/// Appends cubics through the edge: each spans as many points as stay within `tolerance` of it.
/// Ends and tangents are exact, so joins are smooth.
fn append(edge: &[Edge], tolerance: f64, path: &mut BezPath) {
    let cubic = |i: usize, j: usize| {
        let h = edge[j].s - edge[i].s;
        hermite(edge[i].p, h * edge[i].d, edge[j].p, h * edge[j].d)
    };
    let fits = |i: usize, j: usize| {
        // Beyond a quarter turn a cubic is no good, whatever the points between say.
        if edge[i].d.dot(edge[j].d) < 0.0 {
            return false;
        }
        let cubic = cubic(i, j);
        let h = edge[j].s - edge[i].s;
        let off = |k: usize| cubic.eval((edge[k].s - edge[i].s) / h).distance_squared(edge[k].p);
        (i + 1..j).all(|k| off(k) <= tolerance * tolerance)
    };
    let last = edge.len().saturating_sub(1);
    let (mut i, mut span) = (0, 1);
    while i < last {
        // About as many as the last did.
        let mut j = (i + span).min(last);
        while j > i + 1 && !fits(i, j) {
            j -= 1;
        }
        if j >= i + span || j == i + 1 {
            while j < last && fits(i, j + 1) {
                j += 1;
            }
        }
        span = j - i;
        let cubic = cubic(i, j);
        path.curve_to(cubic.p1, cubic.p2, cubic.p3);
        i = j;
    }
}

#[cfg(test)]
mod tests {
    use super::super::particle::{Charge, Form};
    use super::*;
    use kurbo::{ParamCurveArclen, PathSeg, Shape};

    fn stem(alpha: f64, turns: f64, size: f64) -> Stem {
        let form = Form::new(&Charge::Power, alpha, turns, false);
        let nodes: Vec<Node> = form
            .nodes
            .iter()
            .map(|node| Node {
                s: node.s * size,
                p: (size * node.p.to_vec2()).to_point(),
                along: node.along,
                curvature: node.curvature / size,
            })
            .collect();
        let taper = Taper { start: size / 40.0, tip: size / 400.0, power: 1.0 };
        Stem::new(0, None, 1.0, nodes, taper)
    }

    #[test]
    fn centre_lines_are_few_smooth_curves_of_the_right_length() {
        for (alpha, turns) in [(0.0, 0.75), (0.5, 1.5), (0.8, 1.3), (1.0, 1.0), (-1.0, 1.0)] {
            let stem = stem(alpha, turns, 300.0);
            let path = stem.centre_line(0.02);
            let length: f64 = path.segments().map(|segment| segment.arclen(1e-6)).sum();
            assert!((length / stem.length() - 1.0).abs() < 1e-3, "{alpha}: {length} {}", stem.length());
            let count = path.segments().count();
            assert!(count <= (14.0 * turns) as usize + 4, "{alpha}: {count} curves");
            let cubics: Vec<CubicBez> = path.segments().map(|segment: PathSeg| segment.to_cubic()).collect();
            for pair in cubics.windows(2) {
                let (a, b) = (pair[0].p3 - pair[0].p2, pair[1].p1 - pair[1].p0);
                assert!(a.normalize().cross(b.normalize()).abs() < 1e-6 && a.dot(b) > 0.0, "a kink");
            }
        }
    }

    #[test]
    fn outlines_enclose_the_tapered_area() {
        let stem = stem(0.5, 1.0, 300.0);
        let mean = f64::midpoint(stem.taper.start, stem.taper.tip);
        let area = stem.outline(0.01).area().abs();
        assert!((area / (mean * stem.length()) - 1.0).abs() < 0.02, "{area}");
    }
}
