//! A form for whoever has drawn none: a rosette in the selected shape.

use super::Params;
use crate::shapes::Shapes;
use kurbo::{Rect, Shape};
use rinceau_format::{Document, Error, FillRule, Outline, Scene, Selection};

const DRAWING: &str = include_str!("../../../samples/recurse/rosette.svg");

/// The scene with the built-in form, each of its shapes the square around the largest circle in it.
///
/// Errors: there is no shape either; a shape that cannot be used; clones are wanted, and the drawing has
/// nothing that they could be of.
pub(super) fn with_form(params: &Params, scene: &Scene) -> Result<Scene, Error> {
    if scene.containers.is_empty() || params.output == "clones" {
        let remedy = "Group a motif with clones of it (Edit > Clone > Create Clone), then select the group or mark it as form";
        return Err(Error::new("no-form", "The drawing has no form", remedy));
    }
    let shapes = Shapes::new(scene, &[])?;
    let mut scene = scene.clone();
    scene.forms = Document::from_bytes(DRAWING.as_bytes().to_vec())?.scene(&Selection::default())?.forms;
    for (index, container) in scene.containers.iter_mut().enumerate() {
        let Some(region) = shapes.free(index, 0.0, 0.0) else { continue };
        let (centre, radius) = region.largest_circle();
        let square = Rect::from_center_size(centre, (2.0 * radius, 2.0 * radius));
        container.outlines = vec![Outline { path: square.to_path(1e-3), rule: FillRule::NonZero }];
    }
    Ok(scene)
}
