//! Elements and their LR functions (FLOWPAK 4.2, checklist F-020 to F-023).

use crate::geom::crossing::any_crossing;
use crate::geom::distance::{covered, passed, squared_distances};
use crate::geom::flatten::flatten;
use crate::geom::polyline::{self, left_of};
use crate::geom::region::Region;
use kurbo::{Affine, BezPath, Point, Rect};
use rinceau_format::{Element, Error, Part, Source, Style, subpaths};

/// Bins of an LR function. The paper samples it at n = 100 places (4.2); a bin here holds the
/// largest extent anywhere in it, so that fewer miss nothing, and every step is linear in them.
pub(super) const BINS: usize = 64;

/// An element as packing sees it: straightened along its spine.
#[derive(Clone, Debug)]
pub(super) struct Template {
    pub id: String,
    /// Built in, so that its colours are ours to choose.
    pub builtin: bool,
    /// Kind and families, to be asked for by name.
    pub names: Vec<String>,
    /// Paths in (u, v): u from 0 to 1 along the spine, v in user units; and their paint.
    pub parts: Vec<(BezPath, Style)>,
    /// An outline crosses itself as drawn. Not asked of built-in ones.
    pub crosses_itself: bool,
    /// The subpaths that no other one encloses: what keeps apart from neighbours.
    pub outer: Vec<BezPath>,
    /// Which of all subpaths, part by part, they are.
    pub is_outer: Vec<bool>,
    /// Largest extent on the side v > 0 and v < 0 in each bin of u.
    pub extents: [Vec<f64>; 2],
    /// Widest extent on either side.
    pub half_width: f64,
    /// Length along the spine.
    pub length: f64,
    /// Radius of the largest disc in it that no edge crosses, against `half_width`.
    pub blank: f64,
    pub side: Side,
    /// Half the widest stroke, in user units.
    pub stroke: f64,
}

/// On which sides of its spine an element lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    Full,
    /// v > 0 only.
    Left,
    /// v < 0 only.
    Right,
}

impl Template {
    /// Straightens a drawn element.
    ///
    /// Errors: no spine; nothing drawn along it.
    pub fn new(element: &Element, builtin: bool) -> Result<Self, Error> {
        let source = &element.source;
        let Some((base, tip)) = element.template.spine else {
            return Err(source.error("no-spine", format!("The element '{}' has no spine", source.id), "Draw a straight line from its base to its tip, mark it as spine, and group it with the element"));
        };
        let along = (tip - base).normalize();
        let normal = left_of(along);
        // Rows (x, y) -> (distance along the spine, distance to its left).
        let straight = Affine::new([
            along.x,
            normal.x,
            along.y,
            normal.y,
            -along.dot(base.to_vec2()),
            -normal.dot(base.to_vec2()),
        ]);
        let spine_length = base.distance(tip);
        let parts: Vec<(BezPath, Style, f64)> =
            element.template.parts.iter().map(|part| straightened(part, straight)).collect();
        let tolerance = spine_length / 1000.0;
        let outlines: Vec<Vec<Point>> = parts
            .iter()
            .flat_map(|(path, ..)| flatten(path, tolerance))
            .map(|mut subpath| {
                if subpath.has_close {
                    subpath.points.extend(subpath.points.first().copied());
                }
                subpath.points
            })
            .collect();
        let points = outlines.iter().flatten();
        let (x0, x1) = points.fold((0.0f64, spine_length), |(x0, x1), p| (x0.min(p.x), x1.max(p.x)));
        let to_uv = Affine::new([1.0 / (x1 - x0), 0.0, 0.0, 1.0, -x0 / (x1 - x0), 0.0]);

        let stroke = parts.iter().map(|part| part.2).fold(0.0, f64::max);
        let extents = extents(&outlines, to_uv, stroke);
        let widest = [max(&extents[0]), max(&extents[1])];
        let half_width = widest[0].max(widest[1]);
        check_width(source, half_width, x1 - x0)?;
        let names = element
            .sets
            .iter()
            .chain([&element.kind, &element.symbol, &source.id])
            .filter(|name| !name.is_empty())
            .cloned()
            .collect();
        let parts: Vec<(BezPath, Style)> =
            parts.into_iter().map(|(path, style, _)| (to_uv * path, style)).collect();
        let paths: Vec<BezPath> = parts.iter().map(|(path, _)| path.clone()).collect();
        let subpaths: Vec<BezPath> = paths.iter().flat_map(subpaths).collect();
        let is_outer = is_outer(&subpaths);
        let drawn: Vec<BezPath> =
            subpaths.iter().map(|path| Affine::scale_non_uniform(x1 - x0, 1.0) * path.clone()).collect();
        Ok(Template {
            blank: blank(&drawn, &is_outer, half_width),
            crosses_itself: !builtin && any_crossing(&paths, 1e-4),
            outer: subpaths.into_iter().zip(&is_outer).filter_map(|(path, &is)| is.then_some(path)).collect(),
            is_outer,
            id: source.id.clone(),
            builtin,
            names,
            parts,
            half_width,
            extents,
            length: x1 - x0,
            side: Side::of(widest),
            stroke,
        })
    }
}

/// A part beside a straight spine, its paint, and half its stroke width.
fn straightened(part: &Part, straight: Affine) -> (BezPath, Style, f64) {
    let scale = part.transform.determinant().abs().sqrt();
    let path = straight * part.transform * part.path.clone();
    (path, part.style.scaled(scale, 6), part.style.stroke_width().unwrap_or(0.0) * scale / 2.0)
}

/// Errors if there is nothing beside the spine, or nothing near it.
fn check_width(source: &Source, half_width: f64, length: f64) -> Result<(), Error> {
    // Beyond this the spine does not stand for the shapes at all.
    const FARTHEST: f64 = 8.0;
    let name = &source.id;
    if half_width <= 1e-6 * length {
        let sentence = format!("The element '{name}' has no width beside its spine");
        return Err(source.error("flat-element", sentence, "Draw its shapes around or beside the spine"));
    }
    if half_width > FARTHEST * length {
        let sentence = format!("The shapes of the element '{name}' lie far from its spine");
        let remedy = "Draw the spine through them or along their edge, from base to tip";
        return Err(source.error("far-element", sentence, remedy));
    }
    Ok(())
}

impl Side {
    /// From the widest extents for v > 0 and v < 0.
    fn of(widest: [f64; 2]) -> Self {
        // A half element may cross its spine by this share of its width: pen wobble.
        const HALF: f64 = 0.06;
        if widest[1] <= HALF * widest[0] {
            Side::Left
        } else if widest[0] <= HALF * widest[1] {
            Side::Right
        } else {
            Side::Full
        }
    }
}

/// The largest disc inside the outer subpaths that no edge crosses, against the half width.
fn blank(subpaths: &[BezPath], is_outer: &[bool], half_width: f64) -> f64 {
    // Of the half width; and so many cells at most.
    const CELL: f64 = 1.0 / 16.0;
    const MOST_CELLS: f64 = 1e5;
    let flat = |(path, &is_outer): (&BezPath, &bool)| {
        flatten(path, 0.1 * CELL * half_width).into_iter().map(move |flat| (flat.points, is_outer))
    };
    let (outer, inner): (Vec<_>, Vec<_>) =
        subpaths.iter().zip(is_outer).flat_map(flat).partition(|(_, is_outer)| *is_outer);
    let points = |subpaths: Vec<(Vec<Point>, bool)>| subpaths.into_iter().map(|(points, _)| points);
    let outer: Vec<Vec<Point>> = points(outer).collect();
    let edges: Vec<Vec<Point>> = outer.iter().cloned().chain(points(inner)).collect();
    let Some(bounds) = polyline::bounds(edges.iter().flatten().copied()) else { return 0.0 };
    let cell = (CELL * half_width).max((bounds.area() / MOST_CELLS).sqrt());
    let (columns, rows) = ((bounds.width() / cell) as usize + 1, (bounds.height() / cell) as usize + 1);
    let origin = bounds.origin();
    let distances = squared_distances(&passed(&edges, origin, cell, columns, rows), columns);
    let inside = covered(&outer, origin, cell, columns, rows);
    let largest =
        distances.iter().zip(inside).filter(|(_, inside)| *inside).map(|(d, _)| *d).fold(0.0, f64::max);
    largest.sqrt() * cell / half_width
}

/// Which subpaths have an outline that does not lie inside that of another.
fn is_outer(subpaths: &[BezPath]) -> Vec<bool> {
    let boxes: Vec<Rect> = subpaths.iter().map(|subpath| subpath.control_box()).collect();
    let encloses = |j: usize, i: usize| {
        // Most pairs are told apart by their boxes.
        if i == j || boxes[j].union(boxes[i]) != boxes[j] || boxes[i] == boxes[j] {
            return false;
        }
        let flat =
            |k: usize| flatten(&subpaths[k], 1e-3).into_iter().map(|flat| flat.points).collect::<Vec<_>>();
        Region::new(flat(j)).is_some_and(|outer| flat(i).iter().flatten().all(|&p| outer.contains(p)))
    };
    let all = 0..subpaths.len();
    all.clone().map(|i| !all.clone().any(|j| encloses(j, i))).collect()
}

fn max(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

/// Largest |v| of the outlines in each bin of u, on each side. Every part of a segment counts
/// in the bin it passes, so a bin's extent is never less than what lies in it.
fn extents(outlines: &[Vec<Point>], to_uv: Affine, stroke: f64) -> [Vec<f64>; 2] {
    let mut extents = [vec![0.0f64; BINS], vec![0.0f64; BINS]];
    let mut reach = |bin: usize, v: f64| {
        let extent: &mut f64 = &mut extents[usize::from(v < 0.0)][bin];
        *extent = extent.max(v.abs() + stroke);
    };
    for points in outlines {
        for pair in points.windows(2) {
            let (a, b) = (to_uv * pair[0], to_uv * pair[1]);
            let (a, b) = if a.x <= b.x { (a, b) } else { (b, a) };
            let bin = |u: f64| ((u * BINS as f64).max(0.0) as usize).min(BINS - 1);
            for i in bin(a.x)..=bin(b.x) {
                let at = |u: f64| {
                    if b.x > a.x {
                        a.y + (b.y - a.y) * ((u - a.x) / (b.x - a.x)).clamp(0.0, 1.0)
                    } else {
                        a.y
                    }
                };
                let ends = [at(i as f64 / BINS as f64), at((i + 1) as f64 / BINS as f64)];
                let ends = if b.x > a.x { ends } else { [a.y, b.y] };
                ends.into_iter().for_each(|v| reach(i, v));
            }
        }
    }
    extents
}

#[cfg(test)]
mod tests {
    use super::*;
    use rinceau_format::{Document, Selection};

    fn template(body: &str) -> Result<Template, Error> {
        let svg = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 200 200'><g class='rinceau-element' id='e'>{body}</g></svg>"
        );
        let scene = Document::from_bytes(svg.into_bytes()).unwrap().scene(&Selection::default()).unwrap();
        Template::new(&scene.elements[0], false)
    }

    #[test]
    fn extents_follow_the_outline() {
        // A rhombus of half width 10 on a spine of length 100 that points down.
        let t =
            template("<path d='M50,50 60,100 50,150 40,100Z'/><path class='rinceau-spine' d='M50,50V150'/>")
                .unwrap();
        assert_eq!(t.side, Side::Full);
        for side in &t.extents {
            assert!((side[31] - 10.0).abs() < 1e-6 && (side[0] - 20.0 / 64.0).abs() < 1e-6, "{side:?}");
        }
        assert!((t.length - 100.0).abs() < 1e-9);
    }

    #[test]
    fn half_elements_and_missing_spines_are_known() {
        assert_eq!(
            template("<path d='M0,0 100,0 50,20Z'/><path class='rinceau-spine' d='M0,0H100'/>").unwrap().side,
            Side::Left
        );
        assert_eq!(
            template("<path d='M0,0 100,0 50,-20Z'/><path class='rinceau-spine' d='M0,0H100'/>")
                .unwrap()
                .side,
            Side::Right
        );
        assert_eq!(template("<path d='M0,0 100,0 50,20Z'/>").unwrap_err().code(), "no-spine");
        assert_eq!(
            template("<path d='M0,0 100,0Z'/><path class='rinceau-spine' d='M0,0H100'/>").unwrap_err().code(),
            "flat-element"
        );
    }
}
