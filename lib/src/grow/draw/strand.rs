//! What is drawn of elements as one: lines that go on from each other, what lies between two lines,
//! and what is round.

use crate::grow::piece::Proxy;
use crate::grow::rules::Look;
use crate::grow::world::{Element, World};
use kurbo::{BezPath, PathEl, Point, Vec2};

/// Lines that are drawn as one, or something round.
pub(super) struct Strand {
    /// The elements it is made of, the first for its colour.
    pub element: usize,
    pub path: BezPath,
    /// For something round: its disc, and the direction it grew in.
    pub disc: Option<(Point, f64, f64)>,
    /// Half the width at equal steps along, for an element that is between two lines.
    pub widths: Option<Vec<f64>>,
}

/// What an element between two lines is drawn as.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum How {
    /// Artwork along its middle.
    Bent,
    /// The area between the lines.
    Areas,
    /// Each line.
    Lines,
}

/// The outline of what lies between two lines.
fn around(a: &Proxy, b: &Proxy) -> BezPath {
    let mut path = a.path();
    path.extend(b.path().reverse_subpaths().elements().iter().skip(1).copied());
    path.close_path();
    path
}

/// What is drawn of a type: lines that continue each other are one if they are to be joined.
pub(super) fn strands(world: &World, look: &Look, how: How) -> Vec<Strand> {
    let mut strands: Vec<(u32, Strand)> = Vec::new();
    for (number, element) in world.elements[..world.placed].iter().enumerate() {
        if element.kind != look.kind {
            continue;
        }
        let lines: Vec<&Proxy> = element.proxies.iter().flatten().filter(|proxy| proxy.is_line()).collect();
        if let [a, b] = lines[..]
            && how != How::Lines
            && let Some(mut strand) = between(number, a, b)
        {
            if how == How::Areas {
                strand = Strand { path: around(a, b), widths: None, ..strand };
            }
            strands.push((element.firing, strand));
            continue;
        }
        for proxy in element.proxies.iter().flatten() {
            let disc = match proxy {
                Proxy::Circle(center, radius) => {
                    Some((*center, *radius, grown_towards(world, element, *center)))
                }
                Proxy::Point(_) => continue,
                _ => None,
            };
            let path = proxy.path();
            let goes_on = look.join && proxy.is_line();
            if let Some((firing, last)) = strands.last_mut()
                && goes_on
                && *firing == element.firing
                && last.disc.is_none()
                && end_of(&last.path).is_some_and(|end| end.distance(proxy.point(0.0)) < 1e-6)
            {
                last.path.extend(path.elements().iter().skip(1).copied());
                continue;
            }
            strands.push((element.firing, Strand { element: number, path, disc, widths: None }));
        }
    }
    strands.into_iter().map(|(_, strand)| strand).collect()
}

/// An element between two lines from one point to another: their middle, and its widths.
fn between(element: usize, a: &Proxy, b: &Proxy) -> Option<Strand> {
    let size = a.point(0.0).distance(a.point(1.0));
    let meets = |t: f64| a.point(t).distance(b.point(t)) < 1e-6 * (1.0 + size);
    if !(meets(0.0) && meets(1.0)) {
        return None;
    }
    const STEPS: usize = 16;
    let (mut path, mut widths) = (BezPath::new(), Vec::with_capacity(STEPS + 1));
    for i in 0..=STEPS {
        let t = i as f64 / STEPS as f64;
        let (p, q) = (a.point(t), b.point(t));
        let middle = p.midpoint(q);
        if i == 0 {
            path.move_to(middle)
        } else {
            path.line_to(middle)
        }
        widths.push(0.5 * p.distance(q));
    }
    Some(Strand { element, path, disc: None, widths: Some(widths) })
}

/// The angle in which something has grown: away from its parent.
fn grown_towards(world: &World, element: &Element, at: Point) -> f64 {
    let parent = world.elements.get(element.parent as usize);
    let from = parent.and_then(|parent| parent.proxies.iter().flatten().next());
    let away = from.map_or(Vec2::new(0.0, -1.0), |proxy| {
        let from = if proxy.is_line() { proxy.point(1.0) } else { proxy.start() };
        at - from
    });
    if away.hypot() < 1e-9 { 0.0 } else { libm::atan2(away.y, away.x) }
}

fn end_of(path: &BezPath) -> Option<Point> {
    path.elements().iter().rev().find_map(PathEl::end_point)
}
