//! Basic shapes and path data to Bézier paths, in f64, in the shape's own coordinates.

use crate::units::{Axis, Units};
use crate::xml::PlainAttribute;
use kurbo::{BezPath, ParamCurve, PathEl, Point, Shape, Vec2};
use roxmltree::Node;
use std::f64::consts::{FRAC_PI_2, PI};
use svgtypes::PathSegment;

/// Handle length of a cubic that stands for a quarter of a unit circle (error 0.03 %).
const KAPPA: f64 = 0.552_284_749_830_793_4;

/// True for the elements that have an outline.
pub(crate) fn is_shape(node: Node) -> bool {
    let name = node.tag_name().name();
    matches!(name, "path" | "rect" | "image" | "circle" | "ellipse" | "line" | "polyline" | "polygon")
}

/// The outline of a shape element, empty for any other. Err is what is wrong with it.
pub(crate) fn outline(node: Node, units: &Units) -> Result<BezPath, String> {
    let get = |name: &str, axis: Axis| length(node, name, axis, units);
    let or_zero = |name: &str, axis: Axis| Ok::<f64, String>(get(name, axis)?.unwrap_or(0.0));
    match node.tag_name().name() {
        "path" => path(node.plain("d").unwrap_or("")),
        name @ ("rect" | "image") => {
            let (x, y) = (or_zero("x", Axis::X)?, or_zero("y", Axis::Y)?);
            let (w, h) = (or_zero("width", Axis::X)?, or_zero("height", Axis::Y)?);
            let radii =
                if name == "rect" { (get("rx", Axis::X)?, get("ry", Axis::Y)?) } else { (None, None) };
            Ok(rect(x, y, w, h, radii))
        }
        "circle" => {
            let r = or_zero("r", Axis::Diagonal)?;
            Ok(ellipse(or_zero("cx", Axis::X)?, or_zero("cy", Axis::Y)?, r, r))
        }
        "ellipse" => {
            let (rx, ry) = (get("rx", Axis::X)?, get("ry", Axis::Y)?);
            let (rx, ry) = (rx.or(ry).unwrap_or(0.0), ry.or(rx).unwrap_or(0.0));
            Ok(ellipse(or_zero("cx", Axis::X)?, or_zero("cy", Axis::Y)?, rx, ry))
        }
        "line" => {
            let mut path = BezPath::new();
            path.move_to((or_zero("x1", Axis::X)?, or_zero("y1", Axis::Y)?));
            path.line_to((or_zero("x2", Axis::X)?, or_zero("y2", Axis::Y)?));
            Ok(path)
        }
        "polyline" => poly(node.plain("points").unwrap_or(""), false),
        "polygon" => poly(node.plain("points").unwrap_or(""), true),
        _ => Ok(BezPath::new()),
    }
}

/// The subpaths of a path, each a path of its own.
pub fn subpaths(path: &BezPath) -> Vec<BezPath> {
    let mut subpaths: Vec<BezPath> = Vec::new();
    for el in path.elements() {
        if matches!(el, PathEl::MoveTo(_)) || subpaths.is_empty() {
            subpaths.push(BezPath::new());
        }
        if let Some(last) = subpaths.last_mut() {
            last.push(*el);
        }
    }
    subpaths
}

/// The path with its open subpaths closed, but for straight lines.
pub(crate) fn closed(path: &BezPath) -> BezPath {
    let mut out = BezPath::new();
    for subpath in subpaths(path) {
        let is_open = match subpath.elements() {
            [_] | [_, PathEl::LineTo(_)] => false,
            elements => !matches!(elements.last(), Some(PathEl::ClosePath)),
        };
        out.extend(subpath);
        if is_open {
            out.close_path();
        }
    }
    out
}

/// True if the path has a closed subpath: a close command, or ends that meet.
pub(crate) fn is_closed(path: &BezPath) -> bool {
    if path.elements().iter().any(|el| matches!(el, PathEl::ClosePath)) {
        return true;
    }
    let (Some(first), Some(last)) = (path.segments().next(), path.segments().last()) else { return false };
    first.start().distance(last.end()) <= 1e-6 * path.bounding_box().size().max_side()
        && path.segments().count() > 1
}

/// The points of a path command, with its handles.
pub(crate) fn points_of(el: &PathEl) -> impl Iterator<Item = Point> + use<> {
    let points: [Option<Point>; 3] = match *el {
        PathEl::MoveTo(p) | PathEl::LineTo(p) => [Some(p), None, None],
        PathEl::QuadTo(a, p) => [Some(a), Some(p), None],
        PathEl::CurveTo(a, b, p) => [Some(a), Some(b), Some(p)],
        PathEl::ClosePath => [None; 3],
    };
    points.into_iter().flatten()
}

fn length(node: Node, name: &str, axis: Axis, units: &Units) -> Result<Option<f64>, String> {
    match node.plain(name) {
        None => Ok(None),
        Some(text) if text.trim().is_empty() || text.trim() == "auto" => Ok(None),
        Some(text) => {
            units.resolve(text, axis).map(Some).ok_or_else(|| format!("its {name}='{text}' is not a length"))
        }
    }
}

fn rect(x: f64, y: f64, w: f64, h: f64, radii: (Option<f64>, Option<f64>)) -> BezPath {
    let mut path = BezPath::new();
    if !(w > 0.0 && h > 0.0) {
        return path;
    }
    let rx = radii.0.or(radii.1).unwrap_or(0.0).clamp(0.0, w / 2.0);
    let ry = radii.1.or(radii.0).unwrap_or(0.0).clamp(0.0, h / 2.0);
    if rx == 0.0 || ry == 0.0 {
        path.move_to((x, y));
        path.line_to((x + w, y));
        path.line_to((x + w, y + h));
        path.line_to((x, y + h));
        path.close_path();
        return path;
    }
    let (kx, ky) = (rx * (1.0 - KAPPA), ry * (1.0 - KAPPA));
    path.move_to((x + rx, y));
    path.line_to((x + w - rx, y));
    path.curve_to((x + w - kx, y), (x + w, y + ky), (x + w, y + ry));
    path.line_to((x + w, y + h - ry));
    path.curve_to((x + w, y + h - ky), (x + w - kx, y + h), (x + w - rx, y + h));
    path.line_to((x + rx, y + h));
    path.curve_to((x + kx, y + h), (x, y + h - ky), (x, y + h - ry));
    path.line_to((x, y + ry));
    path.curve_to((x, y + ky), (x + kx, y), (x + rx, y));
    path.close_path();
    path
}

fn ellipse(cx: f64, cy: f64, rx: f64, ry: f64) -> BezPath {
    let mut path = BezPath::new();
    if !(rx > 0.0 && ry > 0.0) {
        return path;
    }
    let (kx, ky) = (rx * KAPPA, ry * KAPPA);
    path.move_to((cx + rx, cy));
    path.curve_to((cx + rx, cy + ky), (cx + kx, cy + ry), (cx, cy + ry));
    path.curve_to((cx - kx, cy + ry), (cx - rx, cy + ky), (cx - rx, cy));
    path.curve_to((cx - rx, cy - ky), (cx - kx, cy - ry), (cx, cy - ry));
    path.curve_to((cx + kx, cy - ry), (cx + rx, cy - ky), (cx + rx, cy));
    path.close_path();
    path
}

fn poly(points: &str, closed: bool) -> Result<BezPath, String> {
    // The points parser stops silently at an error, so what it would stop at is looked for.
    let is_point = |b: u8| b.is_ascii_digit() || b.is_ascii_whitespace() || b"+-.,eE".contains(&b);
    if !points.bytes().all(is_point) {
        return Err("its points are not all numbers".into());
    }
    let mut path = BezPath::new();
    for (i, (x, y)) in svgtypes::PointsParser::from(points).enumerate() {
        if i == 0 { path.move_to((x, y)) } else { path.line_to((x, y)) }
    }
    if closed && !path.is_empty() {
        path.close_path();
    }
    Ok(path)
}

/// Path data to Bézier segments. Err names the broken place.
/// Path data. Errors: what is wrong, in words.
pub(crate) fn path(data: &str) -> Result<BezPath, String> {
    let mut builder = PathBuilder::default();
    if data.trim() == "none" {
        return Ok(builder.path);
    }
    for (i, segment) in svgtypes::PathParser::from(data).enumerate() {
        let segment = segment.map_err(|_| format!("its path data is broken at command {}", i + 1))?;
        builder.add(segment);
    }
    Ok(builder.path)
}

/// The pen: current point, start of the subpath, and the handle a smooth command mirrors.
#[derive(Default)]
struct PathBuilder {
    path: BezPath,
    at: Point,
    start: Point,
    cubic_handle: Option<Point>,
    quad_handle: Option<Point>,
    /// After a close the next drawing command starts a subpath without saying so.
    pending_move: bool,
}

impl PathBuilder {
    fn add(&mut self, segment: PathSegment) {
        let from = if segment.is_abs() { Vec2::ZERO } else { self.at.to_vec2() };
        let point = |x: f64, y: f64| Point::new(x, y) + from;
        let (cubic, quad) = (self.cubic_handle.take(), self.quad_handle.take());
        let mirrored = |handle: Option<Point>, at: Point| handle.map_or(at, |h| at + (at - h));
        match segment {
            PathSegment::MoveTo { x, y, .. } => {
                self.at = point(x, y);
                self.start = self.at;
                self.pending_move = false;
                self.path.move_to(self.at);
            }
            PathSegment::LineTo { x, y, .. } => self.line(point(x, y)),
            PathSegment::HorizontalLineTo { x, .. } => self.line(Point::new(x + from.x, self.at.y)),
            PathSegment::VerticalLineTo { y, .. } => self.line(Point::new(self.at.x, y + from.y)),
            PathSegment::CurveTo { x1, y1, x2, y2, x, y, .. } => {
                self.cubic(point(x1, y1), point(x2, y2), point(x, y))
            }
            PathSegment::SmoothCurveTo { x2, y2, x, y, .. } => {
                self.cubic(mirrored(cubic, self.at), point(x2, y2), point(x, y));
            }
            PathSegment::Quadratic { x1, y1, x, y, .. } => self.quad(point(x1, y1), point(x, y)),
            PathSegment::SmoothQuadratic { x, y, .. } => self.quad(mirrored(quad, self.at), point(x, y)),
            PathSegment::EllipticalArc { rx, ry, x_axis_rotation, large_arc, sweep, x, y, .. } => {
                self.arc(Vec2::new(rx, ry), x_axis_rotation.to_radians(), (large_arc, sweep), point(x, y));
            }
            PathSegment::ClosePath { .. } => {
                if !self.path.is_empty() && !self.pending_move {
                    self.path.close_path();
                }
                self.at = self.start;
                self.pending_move = true;
            }
        }
    }

    fn begin(&mut self) {
        if self.pending_move {
            self.path.move_to(self.start);
            self.pending_move = false;
        }
    }

    fn line(&mut self, to: Point) {
        self.begin();
        self.path.line_to(to);
        self.at = to;
    }

    fn cubic(&mut self, a: Point, b: Point, to: Point) {
        self.begin();
        self.path.curve_to(a, b, to);
        self.at = to;
        self.cubic_handle = Some(b);
    }

    fn quad(&mut self, a: Point, to: Point) {
        self.begin();
        self.path.quad_to(a, to);
        self.at = to;
        self.quad_handle = Some(a);
    }

    fn arc(&mut self, radii: Vec2, rotation: f64, flags: (bool, bool), to: Point) {
        self.begin();
        match arc_to_cubics(self.at, radii, rotation, flags.0, flags.1, to) {
            Some(cubics) => {
                for [a, b, p] in cubics {
                    self.path.curve_to(a, b, p);
                }
            }
            None => self.path.line_to(to),
        }
        self.at = to;
    }
}

/// An elliptical arc as at most four cubics (SVG 2, implementation notes B.2.4). `None` where
/// the arc is a straight line: a zero radius, equal ends, or numbers beyond f64.
///
/// Own code, because the arc code of the usual crates does not end on huge coordinates.
pub fn arc_to_cubics(
    from: Point,
    radii: Vec2,
    rotation: f64,
    large: bool,
    sweep: bool,
    to: Point,
) -> Option<Vec<[Point; 3]>> {
    let (mut rx, mut ry) = (radii.x.abs(), radii.y.abs());
    if rx == 0.0 || ry == 0.0 || from == to {
        return None;
    }
    let (sin, cos) = (libm::sin(rotation), libm::cos(rotation));
    let half = (from - to) / 2.0;
    let (x1, y1) = (cos * half.x + sin * half.y, -sin * half.x + cos * half.y);
    let needed = (x1 / rx).powi(2) + (y1 / ry).powi(2);
    if needed > 1.0 {
        rx *= needed.sqrt();
        ry *= needed.sqrt();
    }
    let (u, v) = (x1 / rx, y1 / ry);
    let squared = u * u + v * v;
    let mut factor = ((1.0 - squared).max(0.0) / squared).sqrt();
    if large == sweep {
        factor = -factor;
    }
    // Centre and angles in the space where the ellipse is a unit circle.
    let (cu, cv) = (factor * v, -factor * u);
    let middle = from.midpoint(to);
    let start = libm::atan2(v - cv, u - cu);
    let mut turn = libm::atan2(-v - cv, -u - cu) - start;
    if sweep && turn < 0.0 {
        turn += 2.0 * PI;
    } else if !sweep && turn > 0.0 {
        turn -= 2.0 * PI;
    }
    let place = |x: f64, y: f64| {
        let (x, y) = ((x + cu) * rx, (y + cv) * ry);
        middle + Vec2::new(cos * x - sin * y, sin * x + cos * y)
    };
    if !(place(1.0, 1.0).is_finite() && turn.is_finite() && turn != 0.0) {
        return None;
    }
    // The tiny slack keeps a quarter that rounding made larger from becoming two pieces.
    let pieces = ((turn.abs() / FRAC_PI_2 - 1e-9).ceil()).clamp(1.0, 4.0);
    let step = turn / pieces;
    let handle = 4.0 / 3.0 * libm::tan(step / 4.0);
    let mut cubics = Vec::new();
    for i in 0..pieces as usize {
        let (a, b) = (start + step * i as f64, start + step * (i + 1) as f64);
        let ((sa, ca), (sb, cb)) = ((libm::sin(a), libm::cos(a)), (libm::sin(b), libm::cos(b)));
        cubics.push([
            place(ca - handle * sa, sa + handle * ca),
            place(cb + handle * sb, sb - handle * cb),
            place(cb, sb),
        ]);
    }
    if let Some(last) = cubics.last_mut() {
        last[2] = to;
    }
    Some(cubics)
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::Shape;

    #[test]
    fn arcs_agree_with_kurbo() {
        for (large, sweep) in [(false, false), (false, true), (true, false), (true, true)] {
            let data = format!("M10,0 A30 20 25 {} {} 40 15", u8::from(large), u8::from(sweep));
            let ours = path(&data).unwrap();
            let theirs = BezPath::from_svg(&data).unwrap();
            let (a, b) = (ours.bounding_box(), theirs.bounding_box());
            assert!(
                (a.x0 - b.x0).abs() + (a.x1 - b.x1).abs() + (a.y0 - b.y0).abs() + (a.y1 - b.y1).abs() < 0.02,
                "{a:?} {b:?}"
            );
        }
    }

    #[test]
    fn huge_arcs_end() {
        assert!(path("M0 0 A5 5 0 0 1 1e39 5").is_ok());
        assert!(path("M0 0 A1e300 1e300 0 0 1 1e308 5").is_ok());
    }

    #[test]
    fn relative_smooth_and_closed_commands() {
        let ours = path("m1,1 h2 v2 z l-1,0 c0,1 1,1 1,0 s1,-1 1,0 q1,1 2,0 t2,0").unwrap();
        let theirs =
            BezPath::from_svg("M1,1 L3,1 L3,3 Z M1,1 L0,1 C0,2 1,2 1,1 C1,0 2,0 2,1 Q3,2 4,1 Q5,0 6,1")
                .unwrap();
        assert_eq!(ours.elements(), theirs.elements());
    }

    #[test]
    fn broken_data_is_an_error_not_a_guess() {
        assert!(path("M0,0 L5,NaN").unwrap_err().contains("command 2"));
        assert!(poly("0,0 1,nan", true).is_err());
    }
}
