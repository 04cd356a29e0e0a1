//! Sections of a container: most grow as a whole; a frame grows a module of its sides and a corner, each
//! for itself, and repeats them around (000 2.1.3; checklist W-011, W-020 to W-023).

use super::symmetry::Symmetry;
use crate::geom::boolean::{self, Contour};
use kurbo::{Affine, Point, Rect, Vec2};
use rinceau_format::Error;

/// What grows at once.
#[derive(Clone, Debug)]
pub(super) struct Section {
    /// What rules call it.
    pub name: &'static str,
    /// Where it grows, as if it lay along the upper side; `None` if that is the container's matter.
    pub domain: Option<Rect>,
    pub symmetry: Symmetry,
    /// Where it is in the container, the same or mirrored: all places alike.
    pub places: Vec<Affine>,
}

impl Section {
    /// Where what has grown is to be seen, its own symmetry included; `None` if that is wherever its
    /// images are.
    pub fn all_places(&self) -> Option<Vec<Affine>> {
        let cosets = self.symmetry.cosets();
        let of = |&place: &Affine| cosets.iter().map(move |&coset| place * coset);
        self.domain.map(|_| self.places.iter().flat_map(of).collect())
    }
}

/// Sections of a container with these contours, in units of the rules.
///
/// Errors: a frame that is none.
pub(super) fn sections(symmetry: &str, shape: &[Contour], repeats: usize) -> Result<Vec<Section>, Error> {
    let bounds = shape.iter().map(boxed).reduce(|a, b| a.union(b)).unwrap_or(Rect::ZERO);
    if symmetry != "frame" {
        let symmetry = Symmetry::new(symmetry, bounds, repeats);
        return Ok(vec![Section { name: "whole", domain: None, symmetry, places: Vec::new() }]);
    }
    let not_a_frame = || {
        Error::new(
            "no-frame",
            "The symmetry 'frame' needs a frame: a shape with a hole in it",
            "Cut a hole into the shape (Path > Difference), or choose another symmetry",
        )
    };
    let hole = opening(shape).ok_or_else(not_a_frame)?;
    let margins = [hole.x0 - bounds.x0, bounds.x1 - hole.x1, hole.y0 - bounds.y0, bounds.y1 - hole.y1];
    let side = margins.into_iter().fold(f64::INFINITY, f64::min);
    let (wide, tall) = (bounds.width() - 2.0 * side, bounds.height() - 2.0 * side);
    if !(side > 0.0 && wide > 0.0 && tall > 0.0) {
        return Err(not_a_frame());
    }
    let modules = |length: f64, period: f64| (length / period).round().max(1.0);
    let period = wide / repeats.max(1) as f64;
    let upright = modules(tall, period);
    let differs = tall / upright / period - 1.0;
    let frame = Frame { bounds, side };
    let mut sections = vec![frame.module(period, &[(false, wide)])];
    if differs.abs() < 1e-6 {
        sections = vec![frame.module(period, &[(false, wide), (true, tall)])];
    } else {
        sections.push(frame.module(tall / upright, &[(true, tall)]));
    }
    if differs.abs() > 1e-3 {
        let note = format!(
            "The frame repeats after {:.4} of its width along its upper side, but after {:.4} along its left one: for four sides alike, make it {:.4} times as tall as it is wide",
            period / bounds.width(),
            tall / upright / bounds.width(),
            (2.0 * side + upright * period) / bounds.width()
        );
        sections[0].symmetry.note = Some(note);
    }
    sections.push(frame.corner());
    Ok(sections)
}

/// The box around the largest hole.
fn opening(shape: &[Contour]) -> Option<Rect> {
    let holes = shape.iter().filter(|contour| !boolean::is_outer(contour));
    let largest = holes.min_by(|a, b| boolean::signed_area(a).total_cmp(&boolean::signed_area(b)))?;
    Some(boxed(largest))
}

fn boxed(contour: &Contour) -> Rect {
    let around = |bounds: Rect, &p: &Point| bounds.union_pt(p);
    contour.iter().fold(Rect::from_points(contour[0], contour[0]), around)
}

/// A frame, mirrored to the right and down.
struct Frame {
    bounds: Rect,
    /// Width of its sides.
    side: f64,
}

impl Frame {
    /// A module of its sides, mirrored within itself: those along the upper and lower side, or along
    /// the left and right one, or both; each with the length of the side between the corners.
    fn module(&self, period: f64, sides: &[(bool, f64)]) -> Section {
        let corner = self.bounds.origin() + Vec2::new(self.side, 0.0);
        let domain = Rect::from_origin_size(corner, (period, self.side));
        let along = |&(is_upright, length): &(bool, f64)| {
            let (turn, across) = match is_upright {
                true => (self.diagonal(), self.flip(-1.0, 1.0)),
                false => (Affine::IDENTITY, self.flip(1.0, -1.0)),
            };
            let count = (length / period).round() as usize;
            (0..count).flat_map(move |k| {
                let place = turn * Affine::translate((k as f64 * period, 0.0));
                [place, across * place]
            })
        };
        let places = sides.iter().flat_map(along).collect();
        Section { name: "side", domain: Some(domain), symmetry: Symmetry::new("pm11", domain, 1), places }
    }

    /// Its upper left corner, mirrored along the diagonal.
    fn corner(&self) -> Section {
        let domain = Rect::from_origin_size(self.bounds.origin(), (self.side, self.side));
        let places =
            vec![Affine::IDENTITY, self.flip(-1.0, 1.0), self.flip(1.0, -1.0), self.flip(-1.0, -1.0)];
        Section { name: "corner", domain: Some(domain), symmetry: Symmetry::diagonal(domain), places }
    }

    /// Brings what lies along the upper side to the left one.
    fn diagonal(&self) -> Affine {
        let origin = self.bounds.origin().to_vec2();
        Affine::translate(origin) * Affine::new([0.0, 1.0, 1.0, 0.0, 0.0, 0.0]) * Affine::translate(-origin)
    }

    /// Mirrors about the middle of the frame.
    fn flip(&self, x: f64, y: f64) -> Affine {
        let about = self.bounds.center().to_vec2();
        Affine::translate(about) * Affine::scale_non_uniform(x, y) * Affine::translate(-about)
    }
}
