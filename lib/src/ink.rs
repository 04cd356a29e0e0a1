//! What a drawn part covers.

use crate::geom::boolean::{Contour, simplified, stroked};
use crate::geom::flatten::flatten;
use rinceau_format::{FillRule, Part};

/// The fill and the stroke of a part as simple contours: outer ones and the holes in them.
pub fn area_of(part: &Part, tolerance: f64) -> Vec<Contour> {
    let scale = part.transform.determinant().abs().sqrt();
    let subpaths = flatten(&(part.transform * part.path.clone()), tolerance);
    let mut contours = Vec::new();
    if part.style.is_filled() {
        contours.extend(subpaths.iter().map(|subpath| subpath.points.clone()));
        contours = simplified(&contours, part.style.fill_rule() == FillRule::EvenOdd);
    }
    let width = part.style.stroke_width().unwrap_or(0.0) * scale;
    for subpath in &subpaths {
        contours.extend(stroked(&subpath.points, subpath.closed, width));
    }
    if width > 0.0 {
        contours = simplified(&contours, false);
    }
    contours
}
