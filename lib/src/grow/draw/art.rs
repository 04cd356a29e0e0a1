//! Artwork for proxies: the built-in drawing, and what the artist has drawn.

use crate::geom::bend::Bend;
use crate::geom::flatten::flatten;
use crate::geom::polyline::{left_of, length, resample};
use crate::geom::spline::{Curve, Profile};
use crate::grow::rules::Look;
use kurbo::{Affine, BezPath, Point, Shape, Vec2};
use rinceau_format::{Document, Element, Error, Scene, Selection, Style};

const DRAWING: &str = include_str!("../../../../samples/elements/grow.svg");

/// A piece of artwork along its spine, which runs from (0, 0) to (1, 0).
#[derive(Clone, Debug)]
pub(in crate::grow) struct Art {
    name: String,
    /// Drawn by the artist for this type of element.
    symbol: String,
    /// Built in, so that its colours are ours to choose.
    pub builtin: bool,
    parts: Vec<(BezPath, Style)>,
    /// Widest extent beside the spine.
    half_width: f64,
}

/// All artwork.
pub(in crate::grow) struct Arts(Vec<Art>);

impl Arts {
    /// Reads the built-in artwork and that of the drawing.
    ///
    /// Errors: an element of the drawing without a spine.
    pub fn new(scene: &Scene) -> Result<Self, Error> {
        let own = scene.elements.iter().map(|element| Art::new(element, false));
        let mut arts = own.collect::<Result<Vec<_>, _>>()?;
        let builtin = Document::from_bytes(DRAWING.as_bytes().to_vec())?.scene(&Selection::default())?;
        for element in &builtin.elements {
            arts.push(Art::new(element, true)?);
        }
        Ok(Arts(arts))
    }

    /// The first look that calls for artwork that does not exist, and what there is.
    pub fn missing<'l>(&self, looks: &'l [Look]) -> Option<(&'l Look, String)> {
        let is_art = |look: &&Look| !matches!(look.art.as_str(), "none" | "outline" | "fill");
        let missing = looks.iter().filter(is_art).find(|look| self.named(&look.art).is_none());
        missing.map(|look| (look, self.names()))
    }

    /// What the artist has drawn for a type of element.
    pub fn drawn(&self, kind: &str) -> Option<&Art> {
        self.0.iter().find(|art| !art.builtin && art.symbol == kind)
    }

    /// The artwork of this name.
    pub fn named(&self, name: &str) -> Option<&Art> {
        self.0.iter().find(|art| art.name == name)
    }

    /// What there is.
    pub fn names(&self) -> String {
        let known: Vec<&str> = self.0.iter().map(|art| art.name.as_str()).collect();
        format!("{}, outline, fill or none", known.join(", "))
    }
}

impl Art {
    fn new(element: &Element, builtin: bool) -> Result<Self, Error> {
        let source = &element.source;
        let Some((base, tip)) = element.template.spine else {
            return Err(source.error("no-spine", format!("The element '{}' has no spine", source.id), "Draw a straight line from its base to its tip, mark it as spine, and group it with the element"));
        };
        let length = base.distance(tip);
        let along = (tip - base) / length;
        let across = left_of(along);
        let straight = Affine::new([along.x, across.x, along.y, across.y, 0.0, 0.0])
            * Affine::translate(-base.to_vec2());
        let to_unit = Affine::scale(1.0 / length) * straight;
        let mut half_width = 0.0_f64;
        let mut parts = Vec::new();
        for part in &element.template.parts {
            let path = to_unit * (part.transform * part.path.clone());
            let bounds = path.bounding_box();
            half_width = half_width.max(bounds.y0.abs()).max(bounds.y1.abs());
            let scale = part.transform.determinant().abs().sqrt() / length;
            parts.push((path, part.style.scaled(scale, 6)));
        }
        Ok(Art {
            name: source.id.clone(),
            symbol: element.symbol.clone(),
            builtin,
            parts,
            half_width: half_width.max(1e-3),
        })
    }

    /// On a disc, turned by an angle. Its spine is the radius.
    pub fn round(&self, center: Point, radius: f64, angle: f64) -> Vec<(BezPath, &Style)> {
        let (sin, cos) = (libm::sin(angle), libm::cos(angle));
        // The side called left here lies above the spine, as it was drawn.
        let across = left_of(Vec2::new(cos, sin));
        let pose = Affine::translate(center.to_vec2())
            * Affine::new([radius * cos, radius * sin, radius * across.x, radius * across.y, 0.0, 0.0]);
        self.parts.iter().map(|(path, style)| (pose * path.clone(), style)).collect()
    }

    /// Along a line, with a share of its width: as wide as asked for, as wide as the place, or in proportion.
    pub fn along(
        &self,
        line: &BezPath,
        width: f64,
        widths: Option<&[f64]>,
        share: f64,
    ) -> Vec<(BezPath, &Style)> {
        const FINEST: f64 = 2e-3;
        let points: Vec<Point> =
            flatten(line, FINEST).into_iter().flat_map(|subpath| subpath.points).collect();
        let total = length(&points);
        if points.len() < 2 || total <= 0.0 {
            return Vec::new();
        }
        // As many as a scroll of this length needs.
        let spine = resample(&points, ((3.0 * total) as usize).clamp(8, 400));
        let scale = match widths {
            Some(widths) => {
                let widest = widths.iter().copied().fold(0.0, f64::max);
                Profile::constant(share * widest / self.half_width)
            }
            None if width > 0.0 => Profile::constant(share * 0.5 * width / self.half_width),
            None => Profile::constant(share * total),
        };
        let turns = curvature(&spine);
        let side = |sign: f64| {
            let bins: Vec<f64> = turns.iter().map(|k| (k * sign).max(0.0)).collect();
            Profile::above(&bins, 12)
        };
        let bend = Bend {
            spine: Curve::near(&spine),
            width: (scale.clone(), scale),
            curvature: (side(1.0), side(-1.0)),
            blend: 1e-3,
            warps: Vec::new(),
        };
        let tolerance = (2e-3 * total).clamp(0.01, 0.03);
        let bent = |(path, _): &(BezPath, Style)| {
            let mut out = BezPath::new();
            bend.path(path, tolerance, &mut out);
            out
        };
        self.parts.iter().map(|part| (bent(part), &part.1)).collect()
    }
}

/// Signed curvature at each inner sample, positive where the line turns to its left side.
fn curvature(points: &[Point]) -> Vec<f64> {
    points
        .windows(3)
        .map(|three| {
            let (u, v) = (three[1] - three[0], three[2] - three[1]);
            let turn = libm::atan2(u.cross(v), u.dot(v));
            let towards = left_of(u).dot(v).signum();
            turn.abs() * towards / u.hypot().max(1e-9)
        })
        .collect()
}
