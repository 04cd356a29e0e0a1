//! Proxies: the simple shapes that stand for elements when room is looked for and when it is tested
//! what touches what (000 3.2, 4.2; checklist W-063, W-068, W-069).

use crate::geom::flatten::flatten;
use crate::geom::segment::{crosses, point_segment, segment_segment};
use kurbo::{Affine, Arc, BezPath, CubicBez, ParamCurve, Point, Rect, Shape, Vec2};

/// Points of a polygon at most.
pub(super) const MOST_CORNERS: usize = 1000;

/// Angle of an arc at most, in radians: a hundred turns.
const MOST_TURNED: f64 = 630.0;

/// What kind of shape a proxy is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A place.
    Point,
    /// A full disc.
    Circle,
    /// Part of a circle's line.
    Arc,
    /// A cubic curve.
    Bezier,
    /// A straight line.
    Line,
    /// A filled area with corners.
    Polygon,
}

impl Kind {
    /// Kinds by the names that rule files use.
    pub const NAMES: &'static [(&'static str, Kind)] = &[
        ("point", Kind::Point),
        ("circle", Kind::Circle),
        ("arc", Kind::Arc),
        ("bezier", Kind::Bezier),
        ("linesegment", Kind::Line),
        ("line", Kind::Line),
        ("polygon", Kind::Polygon),
    ];

    /// The kind of this name.
    pub fn from_name(name: &str) -> Option<Kind> {
        Self::NAMES.iter().find(|(known, _)| *known == name).map(|&(_, kind)| kind)
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        Self::NAMES.iter().find(|&&(_, kind)| kind == self).map_or("point", |&(name, _)| name)
    }
}

/// A proxy in its place.
#[derive(Clone, Debug, PartialEq)]
pub enum Proxy {
    /// A place.
    Point(Point),
    /// Centre and radius of a disc.
    Circle(Point, f64),
    /// Centre, radius, start angle and sweep in radians.
    Arc(Point, f64, f64, f64),
    /// A cubic curve.
    Bezier(CubicBez),
    /// A straight line from one point to another.
    Line(Point, Point),
    /// A filled area.
    Polygon(Vec<Point>),
}

impl Proxy {
    /// As a path: discs and polygons closed, a point as a circle of no size.
    pub fn path(&self) -> BezPath {
        const TOLERANCE: f64 = 1e-3;
        match self {
            Proxy::Point(p) => {
                let mut path = BezPath::new();
                path.move_to(*p);
                path.line_to(*p);
                path
            }
            Proxy::Circle(center, radius) => kurbo::Circle::new(*center, *radius).to_path(TOLERANCE),
            Proxy::Arc(center, radius, start, sweep) => {
                let arc = Arc::new(*center, (*radius, *radius), *start, *sweep, 0.0);
                arc.to_path(TOLERANCE * radius.max(1e-9))
            }
            Proxy::Bezier(curve) => {
                let mut path = BezPath::new();
                path.move_to(curve.p0);
                path.curve_to(curve.p1, curve.p2, curve.p3);
                path
            }
            Proxy::Line(a, b) => {
                let mut path = BezPath::new();
                path.move_to(*a);
                path.line_to(*b);
                path
            }
            Proxy::Polygon(points) => {
                let mut path = BezPath::new();
                for (i, &p) in points.iter().enumerate() {
                    if i == 0 { path.move_to(p) } else { path.line_to(p) }
                }
                path.close_path();
                path
            }
        }
    }

    /// True for curves and lines, along which artwork can be bent.
    pub fn is_line(&self) -> bool {
        matches!(self, Proxy::Arc(..) | Proxy::Bezier(_) | Proxy::Line(..))
    }

    /// The place where it starts: the centre of a disc, the first corner of a polygon.
    pub fn start(&self) -> Point {
        match self {
            Proxy::Point(p) | Proxy::Circle(p, _) | Proxy::Line(p, _) => *p,
            Proxy::Arc(..) => self.point(0.0),
            Proxy::Bezier(curve) => curve.p0,
            Proxy::Polygon(points) => points.first().copied().unwrap_or_default(),
        }
    }

    /// A place along it, from 0 to 1; around the rim of a disc.
    pub fn point(&self, t: f64) -> Point {
        match self {
            Proxy::Point(p) => *p,
            Proxy::Circle(center, radius) => {
                let angle = std::f64::consts::TAU * t;
                *center + *radius * Vec2::new(libm::cos(angle), libm::sin(angle))
            }
            Proxy::Arc(center, radius, start, sweep) => {
                let angle = start + sweep * t;
                *center + *radius * Vec2::new(libm::cos(angle), libm::sin(angle))
            }
            Proxy::Bezier(curve) => curve.eval(t),
            Proxy::Line(a, b) => a.lerp(*b, t),
            Proxy::Polygon(points) => {
                let n = points.len().max(1);
                let at = t.rem_euclid(1.0) * n as f64;
                let i = at as usize % n;
                points[i].lerp(points[(i + 1) % n], at - at.floor())
            }
        }
    }

    /// The direction along it.
    pub fn tangent(&self, t: f64) -> Vec2 {
        const STEP: f64 = 1e-4;
        let (a, b) = ((t - STEP).max(0.0), (t + STEP).min(1.0));
        self.point(b) - self.point(a)
    }

    /// True if all its numbers are of this world.
    pub fn is_sane(&self) -> bool {
        const LARGEST: f64 = 1e7;
        let fits = |p: &Point| p.x.abs() < LARGEST && p.y.abs() < LARGEST;
        match self {
            Proxy::Point(p) => fits(p),
            Proxy::Circle(p, r) => fits(p) && (0.0..LARGEST).contains(r),
            Proxy::Arc(p, r, start, sweep) => {
                fits(p) && (0.0..LARGEST).contains(r) && start.abs() < LARGEST && sweep.abs() < MOST_TURNED
            }
            Proxy::Bezier(c) => [c.p0, c.p1, c.p2, c.p3].iter().all(fits),
            Proxy::Line(a, b) => fits(a) && fits(b),
            Proxy::Polygon(points) => points.iter().all(fits),
        }
    }

    /// What it covers; chords of curves are within `tolerance`.
    pub fn pieces(&self, tolerance: f64) -> Vec<Piece> {
        let chords = |path: &BezPath| -> Vec<Piece> {
            let lines = flatten(path, tolerance);
            lines
                .iter()
                .flat_map(|line| line.points.windows(2).map(|pair| Piece::Segment(pair[0], pair[1])))
                .collect()
        };
        match self {
            Proxy::Point(p) => vec![Piece::Disc(*p, 0.0)],
            Proxy::Circle(center, radius) => vec![Piece::Disc(*center, *radius)],
            Proxy::Line(a, b) => vec![Piece::Segment(*a, *b)],
            Proxy::Polygon(points) => vec![Piece::Area(points.clone())],
            Proxy::Arc(..) | Proxy::Bezier(_) => chords(&self.path()),
        }
    }
}

/// What distances are measured to.
#[derive(Clone, Debug)]
pub(super) enum Piece {
    Disc(Point, f64),
    Segment(Point, Point),
    /// Filled.
    Area(Vec<Point>),
}

impl Piece {
    /// Distance from a point; negative inside.
    pub fn distance(&self, at: Point) -> f64 {
        match self {
            Piece::Disc(center, radius) => at.distance(*center) - radius,
            Piece::Segment(a, b) => point_segment(at, *a, *b),
            Piece::Area(points) => {
                let edge = sides(points).map(|(a, b)| point_segment(at, a, b)).fold(f64::INFINITY, f64::min);
                if contains(points, at) { -edge } else { edge }
            }
        }
    }

    /// Distance between two pieces; 0 or less if they overlap.
    pub fn apart(&self, other: &Piece) -> f64 {
        match (self, other) {
            (Piece::Disc(center, radius), piece) | (piece, Piece::Disc(center, radius)) => {
                piece.distance(*center) - radius
            }
            (Piece::Segment(a, b), Piece::Segment(p, q)) => segment_segment(*a, *b, *p, *q),
            (Piece::Segment(a, b), Piece::Area(points)) | (Piece::Area(points), Piece::Segment(a, b)) => {
                if contains(points, *a) || contains(points, *b) {
                    return 0.0;
                }
                sides(points).map(|(p, q)| segment_segment(*a, *b, p, q)).fold(f64::INFINITY, f64::min)
            }
            (Piece::Area(one), Piece::Area(two)) => {
                let inside =
                    |points: &[Point], other: &[Point]| other.first().is_some_and(|&p| contains(points, p));
                if inside(one, two) || inside(two, one) {
                    return 0.0;
                }
                sides(one)
                    .flat_map(|(a, b)| sides(two).map(move |(p, q)| segment_segment(a, b, p, q)))
                    .fold(f64::INFINITY, f64::min)
            }
        }
    }

    /// The box around it.
    pub fn bounds(&self) -> Rect {
        match self {
            Piece::Disc(center, radius) => Rect::from_center_size(*center, (2.0 * radius, 2.0 * radius)),
            Piece::Segment(a, b) => Rect::from_points(*a, *b),
            Piece::Area(points) => {
                let first = points.first().copied().unwrap_or_default();
                points.iter().fold(Rect::from_points(first, first), |rect, &p| rect.union_pt(p))
            }
        }
    }

    /// Visits places along its outline, no more than `step` apart.
    pub fn along(&self, step: f64, mut visit: impl FnMut(Point)) {
        let mut line = |a: Point, b: Point| {
            let n = (a.distance(b) / step).ceil().clamp(1.0, 1e6) as usize;
            (0..=n).for_each(|i| visit(a.lerp(b, i as f64 / n as f64)));
        };
        match self {
            Piece::Disc(center, radius) => {
                let n = (std::f64::consts::TAU * radius / step).ceil().clamp(1.0, 1e6) as usize;
                for i in 0..n {
                    let angle = std::f64::consts::TAU * i as f64 / n as f64;
                    visit(*center + *radius * Vec2::new(libm::cos(angle), libm::sin(angle)));
                }
            }
            Piece::Segment(a, b) => line(*a, *b),
            Piece::Area(points) => sides(points).for_each(|(a, b)| line(a, b)),
        }
    }

    /// The same elsewhere.
    pub fn moved(&self, by: Affine) -> Piece {
        match self {
            Piece::Disc(center, radius) => Piece::Disc(by * *center, radius * by.determinant().abs().sqrt()),
            Piece::Segment(a, b) => Piece::Segment(by * *a, by * *b),
            Piece::Area(points) => Piece::Area(points.iter().map(|&p| by * p).collect()),
        }
    }

    /// True if it crosses a line.
    pub fn meets(&self, a: Point, b: Point) -> bool {
        match self {
            Piece::Disc(center, radius) => point_segment(*center, a, b) < *radius,
            Piece::Segment(p, q) => crosses(*p, *q, a, b),
            Piece::Area(points) => sides(points).any(|(p, q)| crosses(p, q, a, b)),
        }
    }

    /// Some points of it: if they are inside and it crosses no boundary, all of it is.
    pub fn sample(&self) -> Point {
        match self {
            Piece::Disc(center, _) => *center,
            Piece::Segment(a, _) => *a,
            Piece::Area(points) => points.first().copied().unwrap_or_default(),
        }
    }
}

fn sides(points: &[Point]) -> impl Iterator<Item = (Point, Point)> + '_ {
    (0..points.len()).map(|i| (points[i], points[(i + 1) % points.len()]))
}

fn contains(points: &[Point], at: Point) -> bool {
    let mut is_inside = false;
    for (a, b) in sides(points) {
        if (a.y > at.y) != (b.y > at.y) && at.x < a.x + (at.y - a.y) / (b.y - a.y) * (b.x - a.x) {
            is_inside = !is_inside;
        }
    }
    is_inside
}
