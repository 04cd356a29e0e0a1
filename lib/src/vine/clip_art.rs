//! Leaves, flowers and buds (checklist M-021 to M-028): templates with an origin and a
//! direction, and the places where they go.

use super::cells::{Cells, Owner};
use crate::geom::distance::cover_wound;
use crate::geom::flatten::flatten;
use crate::geom::polyline::left_of;
use crate::rng::Rng;
use kurbo::{Affine, BezPath, Point, Rect, Shape, Vec2};
use rinceau_format::{Document, Element, Error, Scene, Selection, Style};
use std::collections::BTreeSet;

const DRAWING: &str = include_str!("../../../samples/elements/vine.svg");

/// Samples of an outline are this far apart, in lengths of the template.
const APART: f64 = 1.0 / 14.0;
/// Samples of its inside, so that nothing small settles there.
const INSIDE: f64 = 1.0 / 7.0;

/// Clip art of size 1: the origin at 0, growing along x.
#[derive(Clone, Debug)]
pub(super) struct Art {
    pub id: String,
    pub builtin: bool,
    names: Vec<String>,
    pub parts: Vec<(BezPath, Style)>,
    /// Distance from the origin to the farthest point.
    pub radius: f64,
    /// Samples of what it covers, each with the distance to the next: first the outline.
    samples: Vec<(Point, f64)>,
    /// Half as many samples of the outline alone.
    around: Vec<(Point, f64)>,
    /// Those of the samples that lie within.
    inside: Vec<(Point, f64)>,
    /// True if it grows around its origin, as a flower does.
    pub central: bool,
    /// How far it reaches from its origin against its direction.
    pub back: f64,
}

/// Clip art in its place.
#[derive(Clone, Debug)]
pub(super) struct PlacedArt {
    pub art: usize,
    pub pose: Affine,
    pub size: f64,
}

impl Art {
    fn new(element: &Element, builtin: bool) -> Result<Self, Error> {
        let source = &element.source;
        let Some((base, tip)) = element.template.spine else {
            return Err(source.error("no-spine", format!("The element '{}' has no spine", source.id), "Draw a straight line from where it grows to where it points, mark it as spine, and group it with the element"));
        };
        let length = base.distance(tip);
        let along = (tip - base) / length;
        let normal = left_of(along);
        let straight = Affine::new([
            along.x / length,
            normal.x / length,
            along.y / length,
            normal.y / length,
            -along.dot(base.to_vec2()) / length,
            -normal.dot(base.to_vec2()) / length,
        ]);
        let parts: Vec<(BezPath, Style)> = element
            .template
            .parts
            .iter()
            .map(|part| {
                let to_unit = straight * part.transform;
                (to_unit * part.path.clone(), part.style.scaled(to_unit.determinant().abs().sqrt(), 9))
            })
            .collect();
        let silhouette = Silhouette::new(&parts);
        let area = silhouette.area();
        if area.is_nan() || area < 1e-9 {
            let sentence = format!("The element '{}' covers nothing", source.id);
            return Err(source.error("flat-element", sentence, "Draw it as closed or stroked shapes"));
        }
        // A template's size is what it covers, whatever the length of its spine.
        const LEAF: f64 = 0.3;
        let shrunk = (area / LEAF).sqrt();
        let to_size = Affine::scale(1.0 / shrunk);
        let parts: Vec<(BezPath, Style)> =
            parts.into_iter().map(|(path, style)| (to_size * path, style.scaled(1.0 / shrunk, 9))).collect();
        let names = names(element).map(str::to_owned).collect();
        Ok(Art::of_size(source.id.clone(), builtin, names, parts, &silhouette.scaled(1.0 / shrunk)))
    }

    fn of_size(
        id: String,
        builtin: bool,
        names: Vec<String>,
        parts: Vec<(BezPath, Style)>,
        silhouette: &Silhouette,
    ) -> Self {
        let middle = silhouette.bounds.center().to_vec2().hypot();
        let radius = silhouette.lines.iter().flatten().map(|p| p.to_vec2().hypot()).fold(0.0, f64::max);
        let around: Vec<(Point, f64)> =
            silhouette.outline(2.0 * APART).into_iter().map(|p| (p, 2.0 * APART)).collect();
        let outline = silhouette.outline(APART).into_iter().map(|p| (p, APART));
        let inside: Vec<(Point, f64)> = silhouette.inside().into_iter().map(|p| (p, 0.9 * INSIDE)).collect();
        Art {
            id,
            builtin,
            names,
            radius,
            samples: spread(outline.chain(inside.iter().copied()).collect()),
            inside,
            around,
            back: silhouette.back(),
            central: middle < 0.2 * silhouette.bounds.size().max_side(),
            parts,
        }
    }

    /// True if `may` allows every cell that the art touches in this pose.
    pub fn fits(
        &self,
        pose: Affine,
        size: f64,
        cells: &Cells,
        mut may: impl FnMut(Point, Owner, f64) -> bool,
    ) -> bool {
        self.samples.iter().all(|&(p, apart)| {
            let at = pose * p;
            cells.allows(at, 0.0, apart * size, |owner, place| may(at, owner, place))
        })
    }

    /// Closes what it covers.
    pub fn close(&self, pose: Affine, size: f64, cells: &mut Cells, gap: f64) {
        // Near where it is attached it lies over the gap of its stem, which allows too much.
        const BASE: f64 = 0.5;
        for &(p, apart) in &self.samples {
            if self.central || p.to_vec2().hypot2() < BASE * BASE {
                cells.close(pose * p, apart * size);
            }
        }
        // The gap is wide against the samples of the outline: some of them are enough.
        for &(p, apart) in &self.around {
            cells.close_gap(pose * p, gap, apart * size);
        }
        for &(p, apart) in &self.inside {
            cells.close_gap(pose * p, 0.0, apart * size);
        }
    }
}

/// Samples in an order that meets whatever is there early: each as far as can be from all before.
fn spread(mut samples: Vec<(Point, f64)>) -> Vec<(Point, f64)> {
    /// To sort more would take longer than it saves.
    const MOST: usize = 2000;
    if samples.len() > MOST {
        return samples;
    }
    let mut nearest = vec![f64::INFINITY; samples.len()];
    // What is farthest from the stem meets others first.
    let far = |p: Point| p.to_vec2().hypot2();
    let first = (0..samples.len()).max_by(|&i, &j| far(samples[i].0).total_cmp(&far(samples[j].0)));
    let mut next = first.unwrap_or(0);
    for i in 0..samples.len() {
        samples.swap(i, next);
        nearest.swap(i, next);
        let at = samples[i].0;
        next = i + 1;
        for j in i + 1..samples.len() {
            nearest[j] = nearest[j].min(samples[j].0.distance_squared(at));
            if nearest[j] > nearest[next] {
                next = j;
            }
        }
    }
    samples
}

/// What an element may be called: its families, kind, symbol and id.
fn names(element: &Element) -> impl Iterator<Item = &str> {
    let own = [&element.kind, &element.symbol, &element.source.id];
    element.sets.iter().chain(own).map(String::as_str).filter(|name| !name.is_empty())
}

/// What parts cover together, strokes included: in squares, which is exact enough to lay
/// samples and takes a hundredth of the time that a union of outlines does.
struct Silhouette {
    bounds: Rect,
    /// Their edges, as lines; some may lie inside other parts.
    lines: Vec<Vec<Point>>,
    /// Side of a square.
    cell: f64,
    columns: usize,
    covered: Vec<bool>,
}

impl Silhouette {
    /// Squares along the longer side.
    const SQUARES: f64 = 96.0;

    fn new(parts: &[(BezPath, Style)]) -> Self {
        const TOLERANCE: f64 = 5e-3;
        let mut fills: Vec<Vec<Vec<Point>>> = Vec::new();
        let mut strokes: Vec<(Vec<Point>, f64)> = Vec::new();
        let mut lines = Vec::new();
        for (path, style) in parts {
            let half = style.stroke_width().unwrap_or(0.0) / 2.0;
            let mut filled = Vec::new();
            for subpath in flatten(path, TOLERANCE) {
                let mut points = subpath.points;
                if half > 0.0 || !style.is_filled() {
                    let mut line = points.clone();
                    line.extend(subpath.closed.then(|| points[0]));
                    lines.extend([half, -half].map(|half| beside(&line, half)));
                    strokes.push((line, half));
                }
                if style.is_filled() {
                    filled.push(points.clone());
                    points.push(points[0]);
                    lines.push(points);
                }
            }
            fills.push(filled);
        }
        let mut points = lines.iter().flatten();
        let first = points.next().copied().unwrap_or_default();
        let bounds = points.fold(Rect::from_points(first, first), |bounds, &p| bounds.union_pt(p));
        let cell = (bounds.size().max_side() / Self::SQUARES).max(f64::MIN_POSITIVE);
        let count = |side: f64| (side / cell) as usize + 1;
        let (columns, rows) = (count(bounds.width()), count(bounds.height()));
        let mut silhouette =
            Silhouette { bounds, lines, cell, columns, covered: vec![false; columns * rows] };
        for contours in &fills {
            cover_wound(contours, bounds.origin(), cell, columns, &mut silhouette.covered);
        }
        for (line, half) in &strokes {
            silhouette.cover_stroke(line, *half);
        }
        silhouette
    }

    fn cover_stroke(&mut self, line: &[Point], half: f64) {
        let step = self.cell.max(0.5 * half);
        for at in spaced(line, step) {
            let (low, high) = (at - Vec2::new(half, half), at + Vec2::new(half, half));
            let index = |side: f64| (side / self.cell).max(0.0) as usize;
            let (left, top) = (index(low.x - self.bounds.x0), index(low.y - self.bounds.y0));
            let (right, bottom) = (index(high.x - self.bounds.x0), index(high.y - self.bounds.y0));
            for row in top..=bottom.min(self.covered.len() / self.columns - 1) {
                for column in left..=right.min(self.columns - 1) {
                    if self.middle(column, row).distance(at) <= half {
                        self.covered[row * self.columns + column] = true;
                    }
                }
            }
        }
    }

    fn middle(&self, column: usize, row: usize) -> Point {
        self.bounds.origin() + self.cell * Vec2::new(column as f64 + 0.5, row as f64 + 0.5)
    }

    fn scaled(mut self, scale: f64) -> Self {
        self.bounds = self.bounds.scale_from_origin(scale);
        self.cell *= scale;
        self.lines.iter_mut().flatten().for_each(|p| *p = (scale * p.to_vec2()).to_point());
        self
    }

    fn area(&self) -> f64 {
        self.covered.iter().filter(|&&covered| covered).count() as f64 * self.cell * self.cell
    }

    /// True if all is covered around a place.
    fn is_inside(&self, at: Point, radius: f64) -> bool {
        let covers = |p: Point| {
            let (x, y) = ((p.x - self.bounds.x0) / self.cell, (p.y - self.bounds.y0) / self.cell);
            let (column, row) = (x as usize, y as usize);
            x >= 0.0
                && y >= 0.0
                && column < self.columns
                && self.covered.get(row * self.columns + column).is_some_and(|&covered| covered)
        };
        const DIRECTIONS: [(f64, f64); 8] = [
            (1.0, 0.0),
            (0.7, 0.7),
            (0.0, 1.0),
            (-0.7, 0.7),
            (-1.0, 0.0),
            (-0.7, -0.7),
            (0.0, -1.0),
            (0.7, -0.7),
        ];
        covers(at) && DIRECTIONS.iter().all(|&(x, y)| covers(at + radius * Vec2::new(x, y)))
    }

    fn back(&self) -> f64 {
        let mut x = self.bounds.x0;
        while x < 0.0 && !self.is_inside(Point::new(x, 0.0), self.cell) {
            x += self.cell;
        }
        (-x).max(0.0)
    }

    /// Samples along the edges, but for those within other parts.
    fn outline(&self, apart: f64) -> Vec<Point> {
        let samples = self.lines.iter().flat_map(|line| spaced(line, apart));
        samples.filter(|&at| !self.is_inside(at, 2.5 * self.cell)).collect()
    }

    /// Samples away from the edges.
    fn inside(&self) -> Vec<Point> {
        let count = |side: f64| (side / INSIDE).ceil() as usize;
        let (columns, rows) = (count(self.bounds.width()), count(self.bounds.height()));
        let place = |i: usize| Vec2::new((i % columns) as f64 + 0.5, (i / columns) as f64 + 0.5);
        let places = (0..columns * rows).map(|i| self.bounds.origin() + INSIDE * place(i));
        places.filter(|&at| self.is_inside(at, 0.5 * INSIDE)).collect()
    }
}

/// A line beside another; sharp corners are cut or looped, as samples may.
fn beside(line: &[Point], distance: f64) -> Vec<Point> {
    let offset = |pair: &[Point]| {
        let along = (pair[1] - pair[0]) / pair[1].distance(pair[0]).max(f64::MIN_POSITIVE);
        pair.iter().map(|&p| p + distance * left_of(along)).collect::<Vec<_>>()
    };
    line.windows(2).flat_map(offset).collect()
}

/// Points along a line at equal distances, its start first.
fn spaced(line: &[Point], apart: f64) -> Vec<Point> {
    let mut points = Vec::new();
    let mut left = 0.0;
    for pair in line.windows(2) {
        let length = pair[0].distance(pair[1]);
        let mut s = left;
        while s < length {
            points.push(pair[0].lerp(pair[1], s / length));
            s += apart;
        }
        left = s - length;
    }
    points
}

/// For each level some names, and for each name the templates it means.
pub(super) type Choices = Vec<Vec<Vec<usize>>>;

/// Every template, and which are asked for at each level.
pub(super) struct Library {
    pub arts: Vec<Art>,
}

impl Library {
    /// Drawn elements, and those built-in ones that any of the lists names: reading them all
    /// would take longer than growing a small vine.
    ///
    /// Errors: a drawn element without a spine, or that covers nothing.
    pub fn new(scene: &Scene, lists: &[&str]) -> Result<Self, Error> {
        let mut arts =
            scene.elements.iter().map(|element| Art::new(element, false)).collect::<Result<Vec<_>, _>>()?;
        let split = |list: &&str| list.split([',', ' ']).map(str::to_owned).collect::<Vec<_>>();
        let words: BTreeSet<String> = lists.iter().flat_map(split).collect();
        let is_named = |element: &&Element| names(element).any(|name| words.contains(name));
        if words.iter().any(|word| !matches!(word.as_str(), "" | "none" | "ball")) {
            let drawing = Document::from_bytes(DRAWING.as_bytes().to_vec())?.scene(&Selection::default())?;
            let named: Vec<&Element> = drawing.elements.iter().filter(is_named).collect();
            let built: Result<Vec<Art>, Error> =
                named.into_iter().map(|element| Art::new(element, true)).collect();
            arts.extend(built?);
        }
        arts.push(ball());
        Ok(Library { arts })
    }

    /// What a list of names means at each of some levels. A name written twice counts twice.
    ///
    /// Errors: a name that means nothing.
    pub fn choices(&self, names: &str, levels: usize) -> Result<Choices, Error> {
        let mut lists = names.split(',').map(|list| {
            list.split_whitespace().filter(|&name| name != "none").map(|name| self.named(name)).collect()
        });
        let lists: Choices = lists.by_ref().collect::<Result<_, _>>()?;
        Ok((0..levels).map(|level| lists[level.min(lists.len() - 1)].clone()).collect())
    }

    /// What a name means: the artist's own before the built-in.
    fn named(&self, name: &str) -> Result<Vec<usize>, Error> {
        let of = |builtin: bool| -> Vec<usize> {
            let means = |art: &Art| art.builtin == builtin && art.names.iter().any(|own| own == name);
            (0..self.arts.len()).filter(|&i| means(&self.arts[i])).collect()
        };
        let own = of(false);
        let found = if own.is_empty() { of(true) } else { own };
        if found.is_empty() {
            return Err(Error::new(
                "no-element",
                format!("No clip art is called '{name}'"),
                "Use leaf, flower, bud, ball or none, a family (classic, meadow, ivy), or the id or kind of an element that you drew",
            ));
        }
        Ok(found)
    }
}

/// One of the templates that a level asks for.
pub(super) fn pick(choices: &[Vec<usize>], rng: &mut Rng) -> Option<usize> {
    let index = |n: usize, rng: &mut Rng| ((rng.unit() * n as f64) as usize).min(n - 1);
    if choices.is_empty() {
        return None;
    }
    let list = &choices[index(choices.len(), rng)];
    Some(list[index(list.len(), rng)])
}

/// A disc about its origin, as smiths end a curl with.
fn ball() -> Art {
    let path = kurbo::Circle::new((0.0, 0.0), 0.22).to_path(1e-4);
    let parts = vec![(path, Style::filled("#111111"))];
    let silhouette = Silhouette::new(&parts);
    Art::of_size("ball".into(), true, vec!["ball".into()], parts, &silhouette)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn built_in_art_grows_from_its_origin() {
        let library = Library::new(&Scene::default(), &["leaf flower,bud"]).unwrap();
        for kind in ["leaf", "flower", "bud"] {
            let choices = library.choices(kind, 1).unwrap();
            assert!(choices[0][0].len() >= 4, "{kind}");
            for &i in &choices[0][0] {
                let art = &library.arts[i];
                let bounds =
                    art.parts.iter().map(|(path, _)| path.bounding_box()).reduce(|a, b| a.union(b)).unwrap();
                assert_eq!(art.central, kind == "flower", "{}", art.id);
                assert!(bounds.inflate(0.05, 0.05).contains(Point::ORIGIN), "{}: {bounds}", art.id);
                if kind != "flower" {
                    assert!(bounds.x1 > 4.0 * -bounds.x0, "{} points along its spine: {bounds}", art.id);
                }
            }
        }
        assert!(library.choices("leaf leaf bud,none", 3).unwrap()[1].is_empty());
        assert_eq!(library.choices("banana", 1).unwrap_err().code(), "no-element");
    }
}
