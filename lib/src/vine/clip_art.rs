//! Leaves, flowers and buds (checklist M-021 to M-028): templates with an origin and a
//! direction, and the places where they go.

use super::cells::{Cells, Owner};
use crate::geom::boolean::{Contour, simplified};
use crate::geom::flatten::flatten;
use crate::geom::polyline::left_of;
use crate::geom::region::Region;
use crate::rng::Rng;
use kurbo::{Affine, BezPath, Point, Rect, Shape};
use rayon::prelude::*;
use rinceau_format::{Document, Element, Error, Scene, Selection, Style};
use std::collections::BTreeSet;

const DRAWING: &str = include_str!("../../../samples/elements/vine.svg");

/// Samples of an outline are this far apart, in lengths of the template.
const APART: f64 = 1.0 / 18.0;
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
    /// True if it grows around its origin, as a flower does.
    pub central: bool,
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
        let contours = silhouette(&parts);
        let bounds = bounds_of(&contours);
        let Some(region) = Region::new(contours.clone()).filter(|_| bounds.area() > 1e-9) else {
            let sentence = format!("The element '{}' covers nothing", source.id);
            return Err(source.error("flat-element", sentence, "Draw it as closed or stroked shapes"));
        };
        // A template's size is what it covers, whatever the length of its spine.
        const LEAF: f64 = 0.3;
        let shrunk = (region.area() / LEAF).sqrt();
        let to_size = Affine::scale(1.0 / shrunk);
        let parts: Vec<(BezPath, Style)> =
            parts.into_iter().map(|(path, style)| (to_size * path, style.scaled(1.0 / shrunk, 9))).collect();
        let contours: Vec<Contour> =
            contours.iter().map(|contour| contour.iter().map(|&p| to_size * p).collect()).collect();
        let bounds = bounds_of(&contours);
        let samples = samples(&contours);
        let middle = bounds.center().to_vec2().hypot();
        let names = names(element).map(str::to_owned).collect();
        Ok(Art {
            id: source.id.clone(),
            builtin,
            names,
            parts,
            radius: radius(&contours),
            around: outline_samples(&contours, 2.0 * APART),
            samples,
            central: middle < 0.2 * bounds.size().max_side(),
        })
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

    /// Claims what it covers.
    pub fn claim(&self, pose: Affine, size: f64, cells: &mut Cells, id: u32, gap: f64) {
        for &(p, apart) in &self.samples {
            cells.claim(id, pose * p, 0.0, apart * size, 0.0);
        }
        // The gap is wide against the samples of the outline: some of them are enough.
        for &(p, apart) in self.around.iter() {
            cells.claim_gap(id, pose * p, gap, apart * size, 0.0);
        }
    }
}

/// What an element may be called: its families, kind, symbol and id.
fn names(element: &Element) -> impl Iterator<Item = &str> {
    let own = [&element.kind, &element.symbol, &element.source.id];
    element.sets.iter().chain(own).map(String::as_str).filter(|name| !name.is_empty())
}

/// What parts cover together, strokes included.
fn silhouette(parts: &[(BezPath, Style)]) -> Vec<Contour> {
    const TOLERANCE: f64 = 5e-3;
    let mut contours = Vec::new();
    for (path, style) in parts {
        let subpaths = flatten(path, TOLERANCE);
        if style.is_filled() {
            contours
                .extend(simplified(&subpaths.iter().map(|s| s.points.clone()).collect::<Vec<_>>(), false));
        }
        for subpath in &subpaths {
            let width = style.stroke_width().unwrap_or(0.0);
            contours.extend(crate::geom::boolean::stroked(&subpath.points, subpath.closed, width));
        }
    }
    simplified(&contours, false)
}

fn bounds_of(contours: &[Contour]) -> Rect {
    let mut points = contours.iter().flatten();
    let first = points.next().copied().unwrap_or_default();
    points.fold(Rect::from_points(first, first), |bounds, &p| bounds.union_pt(p))
}

fn radius(contours: &[Contour]) -> f64 {
    contours.iter().flatten().map(|p| p.to_vec2().hypot()).fold(0.0, f64::max)
}

/// Samples of outlines at equal distances.
fn outline_samples(contours: &[Contour], apart: f64) -> Vec<(Point, f64)> {
    let mut samples = Vec::new();
    for contour in contours {
        let Some(&last) = contour.last() else { continue };
        let mut previous = last;
        let mut left = 0.0;
        for &p in contour {
            let length = previous.distance(p);
            let mut s = left;
            while s < length {
                samples.push((previous.lerp(p, s / length), apart));
                s += apart;
            }
            left = s - length;
            previous = p;
        }
    }
    samples
}

/// Samples of what contours cover.
fn samples(contours: &[Contour]) -> Vec<(Point, f64)> {
    let mut samples = outline_samples(contours, APART);
    // What is farthest from the stem meets others first.
    samples.sort_by(|(p, _), (q, _)| q.to_vec2().hypot2().total_cmp(&p.to_vec2().hypot2()));
    let Some(region) = Region::new(contours.to_vec()) else { return samples };
    let bounds = region.bounds();
    let count = |side: f64| (side / INSIDE).ceil() as usize;
    for row in 0..count(bounds.height()) {
        for column in 0..count(bounds.width()) {
            let at = bounds.origin() + INSIDE * kurbo::Vec2::new(column as f64 + 0.5, row as f64 + 0.5);
            if region.contains(at) && region.distance(at, INSIDE) > 0.5 * INSIDE {
                samples.push((at, 0.9 * INSIDE));
            }
        }
    }
    samples
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
                named.into_par_iter().map(|element| Art::new(element, true)).collect();
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
    let contours = silhouette(&parts);
    let samples = samples(&contours);
    Art {
        id: "ball".into(),
        builtin: true,
        names: vec!["ball".into()],
        around: outline_samples(&contours, 2.0 * APART),
        samples,
        radius: radius(&contours),
        parts,
        central: true,
    }
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
