//! A form for whoever has drawn none: a rosette in the selected shape.

use super::Params;
use crate::geom::region::Region;
use crate::shapes::Shapes;
use kurbo::{Point, Rect, Shape};
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
        let (centre, radius) = largest_circle(&region);
        let square = Rect::from_center_size(centre, (2.0 * radius, 2.0 * radius));
        container.outlines = vec![Outline { path: square.to_path(1e-3), rule: FillRule::NonZero }];
    }
    Ok(scene)
}

/// The largest circle in a region, to a hundredth of its size.
fn largest_circle(region: &Region) -> (Point, f64) {
    const STEPS: i32 = 40;
    let bounds = region.bounds();
    let reach = bounds.size().max_side();
    let room = |at: Point| if region.contains(at) { region.distance(at, reach) } else { 0.0 };
    let mut best = (bounds.center(), room(bounds.center()));
    let mut around = bounds;
    // On a grid, and on a finer one about the best of it.
    for _ in 0..3 {
        for (i, j) in (0..STEPS).flat_map(|i| (0..STEPS).map(move |j| (i, j))) {
            let share = |k: i32| (f64::from(k) + 0.5) / f64::from(STEPS);
            let at =
                around.origin() + kurbo::Vec2::new(share(i) * around.width(), share(j) * around.height());
            let here = room(at);
            if here > best.1 {
                best = (at, here);
            }
        }
        let side = 3.0 / f64::from(STEPS);
        around = Rect::from_center_size(best.0, (side * around.width(), side * around.height()));
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_circle_touches_the_outline() {
        let triangle = [(0.0, 0.0), (30.0, 0.0), (0.0, 40.0)].map(Point::from).to_vec();
        let (centre, radius) = largest_circle(&Region::new(vec![triangle]).unwrap());
        assert!(
            (radius - 10.0).abs() < 0.1 && centre.distance(Point::new(10.0, 10.0)) < 0.2,
            "{centre} {radius}"
        );
    }
}
