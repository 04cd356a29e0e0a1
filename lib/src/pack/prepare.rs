//! From the scene to regions with flow (FLOWPAK 4.1 and the start of 4.4, checklist F-007 to
//! F-015, F-040).

use super::params::{Params, Sizes};
use crate::geom::boolean::Contour;
use crate::geom::polyline;
use crate::geom::region::Region;
use crate::shapes::{Lines, Shapes, closed, passes, polylines};
use kurbo::{Point, Rect};
use rinceau_format::{Container, Error, Guide, Scene};

/// One container ready to fill.
pub(super) struct Field {
    /// Index of the container in the scene.
    pub container: usize,
    pub params: Params,
    pub sizes: Sizes,
    /// Where elements may be: the container without fixed areas, less the edge distance.
    pub region: Region,
    /// Guides that pass inside, as polylines; the boundary where there is none.
    pub guides: Vec<Vec<Point>>,
    /// True if the artist drew them, so that their sense means something.
    pub guided: bool,
    pub fixed_spines: Vec<Vec<Point>>,
}

/// What all containers share.
pub(super) struct Prepared {
    pub fields: Vec<Field>,
    /// Largest side of all containers and fixed elements (F-014).
    pub input_size: f64,
    pub bounds: Rect,
    /// Area of all containers without fixed elements.
    pub area: f64,
    pub warnings: Vec<String>,
}

/// Resolves the scene for packing.
///
/// Errors: no container; one that is open, crosses itself or has no area; a guide outside all
/// containers; a container's own parameter that does not exist.
pub(super) fn prepare(params: &Params, scene: &Scene) -> Result<Prepared, Error> {
    let shapes = Shapes::new(scene, &[])?;
    let tolerance = shapes.tolerance;
    let guides = polylines(&scene.guides, tolerance);
    let spines = polylines(&scene.fixed_spines, tolerance);
    check_guides(&scene.guides, &guides, &shapes.containers)?;

    let mut prepared = Prepared {
        fields: Vec::new(),
        input_size: shapes.size,
        bounds: shapes.bounds,
        area: shapes.area(),
        warnings: Vec::new(),
    };
    for (index, (container, shape)) in scene.containers.iter().zip(&shapes.containers).enumerate() {
        let overrides = container.overrides.iter().map(|(name, value)| (name.as_str(), value.as_str()));
        let own = params.overridden(overrides).map_err(|error| error.at(container.source.at))?;
        let perimeter = shape.iter().map(|contour| polyline::length(&closed(contour))).sum();
        let sizes = Sizes::new(&own, shapes.area(), (shapes.areas[index], perimeter), scene.px_per_unit);
        check_gap(&sizes, container)?;
        match shapes.free(index, sizes.gap, sizes.edge) {
            Some(region) => {
                prepared.fields.push(field(index, own, sizes, region, (&guides, &spines)));
            }
            None => prepared.warnings.push(format!(
                "The container '{}' is too small or too thin for anything to fit, or lies under another",
                container.source.id
            )),
        }
    }
    Ok(prepared)
}

/// A region with the guides and fixed spines that pass through it.
fn field(
    container: usize,
    params: Params,
    sizes: Sizes,
    region: Region,
    (guides, spines): (&Lines, &Lines),
) -> Field {
    let through = |lines: &Lines, reach: f64| -> Vec<Vec<Point>> {
        lines.iter().map(|(_, line)| line).filter(|line| passes(line, &region, reach)).cloned().collect()
    };
    let own_guides = through(guides, sizes.spacing / 2.0);
    let fixed_spines = through(spines, 0.0);
    let guided = !own_guides.is_empty();
    let guides = if guided { own_guides } else { region.contours().iter().map(closed).collect() };
    Field { container, params, sizes, region, guides, guided, fixed_spines }
}

/// A gap as wide as an element leaves no room for the element.
fn check_gap(sizes: &Sizes, container: &Container) -> Result<(), Error> {
    const MOST: f64 = 0.9;
    if sizes.gap <= MOST * sizes.spacing {
        return Ok(());
    }
    let sentence = format!(
        "A gap of {:.4} leaves no room for elements {:.4} wide in '{}'",
        sizes.gap, sizes.spacing, container.source.id
    );
    let remedy = format!(
        "Set the gap (--min-gap) below {:.4}, or the element width (--spacing) higher",
        MOST * sizes.spacing
    );
    Err(Error::new("gap-too-wide", sentence, remedy))
}

fn check_guides(
    guides: &[Guide],
    lines: &[(usize, Vec<Point>)],
    shapes: &[Vec<Contour>],
) -> Result<(), Error> {
    let regions: Vec<Region> = shapes.iter().filter_map(|shape| Region::new(shape.clone())).collect();
    for (i, guide) in guides.iter().enumerate() {
        let mut own = lines.iter().filter(|(owner, _)| *owner == i).map(|(_, line)| line).peekable();
        if own.peek().is_none() {
            return Err(guide.source.error(
                "zero-guide",
                format!("The guide '{}' has no length", guide.source.id),
                "Draw it as a line along the flow, or delete it",
            ));
        }
        let reach = |region: &Region| region.bounds().size().max_side() * 0.02;
        if !own.any(|line| regions.iter().any(|region| passes(line, region, reach(region)))) {
            return Err(guide.source.error(
                "guide-outside",
                format!("The guide '{}' is outside every container", guide.source.id),
                "Move it into the shape whose flow it should guide, or clear its mark",
            ));
        }
    }
    Ok(())
}
