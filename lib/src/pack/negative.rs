//! Shapes of the gaps (FLOWPAK 5, Figure 16, checklist F-075): what is left between elements, less the
//! gap on all sides, as forms of their own. They look best among long elements that lie far apart.

use super::place::Placement;
use super::prepare::{Field, Prepared};
use crate::geom::boolean::{Contour, area, difference, offset, parts, signed_area, touches};
use crate::geom::polyline;
use kurbo::BezPath;

/// Corners have this radius, in spacings, and what is thinner than twice it is left out.
const ROUND: f64 = 0.045;
/// Smaller shapes read as dust: area in squares of the spacing.
const SMALLEST: f64 = 0.03;

/// A shape with its holes.
#[derive(Clone, Debug)]
pub(super) struct Shape {
    pub field: usize,
    contours: Vec<Contour>,
}

impl Shape {
    /// Its outline.
    pub fn path(&self) -> BezPath {
        let mut path = BezPath::new();
        for contour in &self.contours {
            path.move_to(contour[0]);
            contour[1..].iter().for_each(|&p| path.line_to(p));
            path.close_path();
        }
        path
    }

    pub fn area(&self) -> f64 {
        area(&self.contours)
    }
}

/// The shapes of every container that asks for them. False if the time ran out first.
pub(super) fn shapes(
    prepared: &Prepared,
    placement: &Placement,
    mut go_on: impl FnMut(f64) -> bool,
) -> (Vec<Shape>, bool) {
    let mut all = Vec::new();
    for (index, field) in prepared.fields.iter().enumerate() {
        if !field.params.has_shapes() {
            continue;
        }
        if !go_on(index as f64 / prepared.fields.len() as f64) {
            return (all, false);
        }
        all.extend(of_field(field, placement).into_iter().map(|contours| Shape { field: index, contours }));
    }
    (all, true)
}

fn of_field(field: &Field, placement: &Placement) -> Vec<Vec<Contour>> {
    let sizes = &field.sizes;
    let reach = sizes.safe(sizes.filler_gap) + placement.widest_stroke();
    let bounds = field.region.bounds().inflate(reach, reach);
    let near = placement.silhouettes().into_iter().filter(|contour| touches(contour, bounds));
    let near: Vec<Contour> = near.cloned().collect();
    let free = difference(field.region.contours(), &offset(&near, reach));
    let round = ROUND * sizes.spacing;
    let contours = offset(&offset(&free, -round), round);
    let tolerance = 0.5 * sizes.tolerance();
    let smooth = |contour: &Contour| polyline::simplified_closed(contour, tolerance);
    let least = SMALLEST * sizes.spacing * sizes.spacing;
    let mut shapes = parts(contours.iter().map(smooth).filter(|contour| contour.len() > 2));
    shapes.retain(|shape| signed_area(&shape[0]) >= least);
    shapes.reverse();
    shapes
}
