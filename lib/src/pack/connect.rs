//! One connected piece, for cutters: nothing thinner than the bridge width, and bridges of that width
//! from piece to piece.
//!
//! Every piece is opened (made thinner by half the width, then wider again), which leaves it with no part
//! thinner than the width: a union of discs of that diameter. A bridge from a nearest point to a nearest
//! point is one too, and so is the union of all, so the width holds everywhere. Bridges are the edges of a
//! shortest tree (Kruskal) over the distances of neighbours.

use crate::geom::boolean::{Contour, is_outer, offset, signed_area, simplified, stroked, union};
use crate::geom::near::PointTable;
use crate::geom::polyline::simplified_closed;
use crate::ink::area_of;
use kurbo::{Affine, BezPath, Point, Rect};
use rinceau_format::{Error, Group, Item, Part, Style};

/// The piece made of many.
pub(super) struct Piece {
    pub group: Group,
    pub bridges: usize,
    /// Parts that were thinner than a bridge.
    pub too_thin: usize,
}

/// Joins the drawn items of some groups. `width` of bridges, `tone` of the piece.
///
/// Errors: nothing is as thick as a bridge.
pub(super) fn piece(groups: &[&Group], width: f64, tolerance: f64, tone: &str) -> Result<Piece, Error> {
    let mut nodes = Vec::new();
    let mut too_thin = 0;
    for item in groups.iter().flat_map(|group| &group.items) {
        let covered: Vec<Contour> =
            item.parts.iter().flat_map(|part| area_of(part, 0.5 * tolerance)).collect();
        // Slits that are narrower than a bridge would cut a leaf into its ribs.
        let solid = offset(&offset(&simplified(&covered, false), 0.5 * width), -0.5 * width);
        let opened = opened(&solid, width);
        if opened.is_empty() {
            too_thin += 1;
        }
        nodes.extend(connected(opened));
    }
    if nodes.is_empty() {
        let remedy = "Set the bridge width (--bridge) lower, or the element width (--spacing) higher";
        return Err(Error::new("bridge-too-wide", "No element is as thick as a bridge", remedy));
    }
    let bridges = bridges(&nodes, width);
    let mut all: Vec<Contour> = nodes.into_iter().flatten().collect();
    for [p, q] in &bridges {
        let along = (*q - *p) / (*q - *p).hypot().max(f64::MIN_POSITIVE);
        // Half a width into both, where a disc of that size lies.
        let ends = [*p - 0.5 * width * along, *q + 0.5 * width * along];
        all = [all, stroked(&ends, false, width * (1.0 + ROUNDING))].concat();
    }
    let mut path = BezPath::new();
    // A hole that a bridge would fill is a speck.
    let least = 0.25 * width * width;
    let one = union(&simplified(&all, false), &[]);
    for contour in one.into_iter().filter(|contour| is_outer(contour) || -signed_area(contour) >= least) {
        let contour = simplified_closed(&contour, 0.25 * tolerance);
        path.move_to(contour[0]);
        contour[1..].iter().for_each(|&p| path.line_to(p));
        path.close_path();
    }
    let part = Part { path, transform: Affine::IDENTITY, style: Style::filled(tone) };
    let items = vec![Item::new("piece", vec![part])];
    let group = Group { name: "piece".into(), items, ..Group::default() };
    Ok(Piece { group, bridges: bridges.len(), too_thin })
}

/// Arcs are made of chords, which lie inside them by this share of the radius.
const ROUNDING: f64 = 0.02;

/// What is left of contours where they are at least `width` thick.
fn opened(contours: &[Contour], width: f64) -> Vec<Contour> {
    let radius = 0.5 * width * (1.0 + ROUNDING);
    offset(&offset(contours, -radius), radius)
}

/// Contours by connected part: an outer one with its holes.
fn connected(contours: Vec<Contour>) -> Vec<Vec<Contour>> {
    let (outer, holes): (Vec<Contour>, Vec<Contour>) = contours.into_iter().partition(is_outer);
    let mut parts: Vec<Vec<Contour>> = outer.into_iter().map(|contour| vec![contour]).collect();
    // From the smallest on, so that a hole goes to the innermost.
    parts.sort_by(|a, b| signed_area(&a[0]).total_cmp(&signed_area(&b[0])));
    for hole in holes {
        if let Some(part) = parts.iter_mut().find(|part| encloses(&part[0], hole[0])) {
            part.push(hole);
        }
    }
    parts
}

/// True if a contour winds around a place.
fn encloses(contour: &Contour, at: Point) -> bool {
    let mut inside = false;
    let Some(&last) = contour.last() else { return false };
    let mut previous = last;
    for &p in contour {
        if (p.y > at.y) != (previous.y > at.y)
            && at.x < previous.x + (at.y - previous.y) / (p.y - previous.y) * (p.x - previous.x)
        {
            inside = !inside;
        }
        previous = p;
    }
    inside
}

/// The shortest bridges that join all nodes, from outline to outline.
fn bridges(nodes: &[Vec<Contour>], width: f64) -> Vec<[Point; 2]> {
    let mut samples: Vec<(Point, u32)> = Vec::new();
    for (node, contours) in nodes.iter().enumerate() {
        for contour in contours {
            let Some(&last) = contour.last() else { continue };
            let mut previous = last;
            for &p in contour {
                let steps = (previous.distance(p) / width).ceil().clamp(1.0, 1e4) as usize;
                samples.extend((1..=steps).map(|k| (previous.lerp(p, k as f64 / steps as f64), node as u32)));
                previous = p;
            }
        }
    }
    let Some(&(first, _)) = samples.first() else { return Vec::new() };
    let bounds = samples.iter().fold(Rect::from_points(first, first), |bounds, (p, _)| bounds.union_pt(*p));
    let farthest = bounds.size().max_side() * 2.0;
    let mut sets = Sets((0..nodes.len()).collect());
    let mut left = nodes.len() - 1;
    let mut all = Vec::new();
    let mut reach = 4.0 * width;
    while left > 0 {
        let table = PointTable::new(bounds, reach, &samples);
        let mut edges: Vec<(f64, u32, u32, Point, Point)> = Vec::new();
        for &(p, node) in &samples {
            let own = sets.find(node as usize);
            // The nearest of another part is enough: whatever else is joined comes by its own samples.
            let mut nearest: Option<(f64, u32, Point)> = None;
            for (q, other) in table.near(p, reach) {
                let distance = p.distance(q);
                let is_nearer = nearest.is_none_or(|(least, ..)| distance < least);
                if other != node && distance <= reach && is_nearer && sets.find(other as usize) != own {
                    nearest = Some((distance, other, q));
                }
            }
            edges.extend(nearest.map(|(distance, other, q)| (distance, node, other, p, q)));
        }
        edges.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        for (_, node, other, p, q) in edges {
            if sets.join(node as usize, other as usize) {
                all.push([p, q]);
                left -= 1;
            }
        }
        // Nothing lies farther apart than the whole is wide.
        if reach > farthest {
            break;
        }
        reach *= 2.0;
    }
    all
}

/// Disjoint sets.
struct Sets(Vec<usize>);

impl Sets {
    fn find(&mut self, mut i: usize) -> usize {
        while self.0[i] != i {
            self.0[i] = self.0[self.0[i]];
            i = self.0[i];
        }
        i
    }

    /// True if they were not joined before.
    fn join(&mut self, a: usize, b: usize) -> bool {
        let (a, b) = (self.find(a), self.find(b));
        self.0[a] = b;
        a != b
    }
}
