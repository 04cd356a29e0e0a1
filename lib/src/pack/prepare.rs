//! From the scene to regions with flow (FLOWPAK 4.1 and the start of 4.4, checklist F-007 to
//! F-015, F-040).

use super::params::{Params, Sizes};
use crate::geom::boolean::{Contour, intersection};
use crate::geom::mirror::Axis;
use crate::geom::polyline;
use crate::geom::region::Region;
use crate::geom::segment::{SegmentGrid, crosses};
use crate::shapes::{Lines, Shapes, closed, passes, polylines};
use kurbo::{Affine, Point, Rect};
use rinceau_format::{Container, Error, Guide, Scene};

/// One container ready to fill.
pub(super) struct Field {
    /// Index of the container in the scene.
    pub container: usize,
    pub params: Params,
    pub sizes: Sizes,
    /// Where elements may be: the container without fixed areas, less the edge distance.
    pub region: Region,
    /// Where specks may be, nearer to its edge.
    pub nooks: Region,
    /// Guides that pass inside, as polylines; the boundary where there is none.
    pub guides: Vec<Vec<Point>>,
    /// True if the artist drew them, so that their sense means something.
    pub guided: bool,
    pub fixed_spines: Vec<Vec<Point>>,
    /// If the region is one half: where its artwork is drawn again.
    pub mirror: Option<Affine>,
}

/// What all containers share.
pub(super) struct Prepared {
    pub fields: Vec<Field>,
    /// Largest side of all containers and fixed elements (F-014).
    pub input_size: f64,
    pub bounds: Rect,
    /// Area of all containers without fixed elements.
    pub area: f64,
    /// What fixed elements cover.
    pub fixed: Vec<Contour>,
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
    let (spines, crossing) = apart(polylines(&scene.fixed_spines, tolerance), &shapes);
    check_guides(&scene.guides, &guides, &shapes.containers)?;

    let mut prepared = Prepared {
        fields: Vec::new(),
        input_size: shapes.size,
        bounds: shapes.bounds,
        area: shapes.area(),
        fixed: shapes.fixed().to_vec(),
        warnings: crossing.into_iter().collect(),
    };
    for (index, (container, shape)) in scene.containers.iter().zip(&shapes.containers).enumerate() {
        let overrides = container.overrides.iter().map(|(name, value)| (name.as_str(), value.as_str()));
        let own = params.overridden(overrides).map_err(|error| error.at(container.source.at))?;
        let perimeter = shape.iter().map(|contour| polyline::length(&closed(contour))).sum();
        let sizes = Sizes::new(&own, shapes.area(), (shapes.areas[index], perimeter), scene.px_per_unit);
        check_gap(&sizes, container)?;
        match shapes.free(index, sizes.filler_gap, sizes.edge) {
            Some(region) => {
                let axis = axis(&own, &region, (&guides, container))?;
                match half(region, axis, &sizes) {
                    Some(region) => {
                        // Nearer to the edge there is always more.
                        let nooks = shapes.free(index, sizes.nook_gap, sizes.nook_edge);
                        let nooks = nooks.and_then(|nooks| half(nooks, axis, &sizes));
                        let nooks = nooks.unwrap_or_else(|| region.clone());
                        let regions = (region, nooks);
                        prepared.fields.push(field(index, own, sizes, regions, (&guides, &spines), axis));
                    }
                    None => prepared.warnings.push(format!(
                        "The container '{}' has nothing alike on both sides of its axis",
                        container.source.id
                    )),
                }
            }
            None => prepared.warnings.push(format!(
                "The container '{}' is too small or too thin for anything to fit, or lies under another",
                container.source.id
            )),
        }
    }
    Ok(prepared)
}

/// Lines without those that cross an earlier one or run along it, since two elements cannot lie in one place, and
/// what to say of these.
fn apart(lines: Lines, shapes: &Shapes) -> (Lines, Option<String>) {
    /// The most that two lines may have in common, as a share of the second. A fork has less.
    const COMMON: f64 = 0.05;
    let (all, bounds) = (lines.len(), shapes.bounds);
    let mut taken = SegmentGrid::new(bounds, bounds.size().max_side() / 100.0);
    let mut kept = Lines::new();
    for (owner, line) in lines {
        let crosses_one = |side: &[Point]| {
            let mut found = false;
            taken.visit(side[0], side[1], 0.0, |p, q, _| {
                found = crosses(side[0], side[1], p, q);
                !found
            });
            found
        };
        // Chords of the same curve may differ by as much as they do from it.
        let near = 4.0 * shapes.tolerance;
        let points = polyline::resample(&line, 100);
        let common = points.iter().filter(|p| taken.distance(**p, near) < near).count();
        let is_apart = common as f64 <= COMMON * points.len() as f64;
        if is_apart && !line.windows(2).any(crosses_one) {
            line.windows(2).for_each(|side| taken.insert(side[0], side[1], owner as u32));
            kept.push((owner, line));
        }
    }
    let crossing = all - kept.len();
    let told = format!(
        "{crossing} of {all} fixed spines carry no element: others that lie below cross them or run there too"
    );
    (kept, (crossing > 0).then_some(told))
}

/// A region with the guides and fixed spines that pass through it.
fn field(
    container: usize,
    params: Params,
    sizes: Sizes,
    (region, nooks): (Region, Region),
    (guides, spines): (&Lines, &Lines),
    axis: Option<Axis>,
) -> Field {
    let through = |lines: &Lines, reach: f64| -> Vec<Vec<Point>> {
        lines.iter().map(|(_, line)| line).filter(|line| passes(line, &region, reach)).cloned().collect()
    };
    let mirror = axis.map(|axis| axis.reflection());
    // Of a mirrored shape each line counts in the half that it lies in, or else from the other side.
    let through = |lines: &Lines, reach: f64| -> Vec<Vec<Point>> {
        let reflected = |mirror: Affine| -> Vec<Vec<Point>> {
            let across =
                |(index, line): &(usize, Vec<Point>)| (*index, line.iter().map(|&p| mirror * p).collect());
            through(&lines.iter().map(across).collect(), reach)
        };
        match through(lines, reach) {
            own if own.is_empty() => mirror.map_or(own, reflected),
            own => own,
        }
    };
    let guides: Lines =
        guides.iter().filter(|(_, line)| params.symmetry != "line" || !is_straight(line)).cloned().collect();
    let own_guides = through(&guides, sizes.spacing / 2.0);
    let fixed_spines = through(spines, 0.0);
    let guided = !own_guides.is_empty();
    let guides = if guided { own_guides } else { region.contours().iter().map(closed).collect() };
    Field { container, params, sizes, region, nooks, guides, guided, fixed_spines, mirror }
}

/// What a container is mirrored about, if it is.
///
/// Errors: it should be about a straight guide, and there is none.
fn axis(
    params: &Params,
    region: &Region,
    (guides, container): (&Lines, &Container),
) -> Result<Option<Axis>, Error> {
    match params.symmetry.as_str() {
        "mirror" => Ok(Axis::of(region.contours())),
        "line" => {
            let straight = guides.iter().map(|(_, line)| line).find(|line| is_straight(line));
            let Some([at, .., end]) = straight.map(Vec::as_slice) else {
                return Err(container.source.error(
                    "no-axis",
                    format!("There is no straight guide to mirror '{}' about", container.source.id),
                    "Draw a straight line as the axis and mark it as guide, or let the axis be found",
                ));
            };
            let along = *end - *at;
            Ok(Some(Axis { at: *at, along: along / along.hypot() }))
        }
        _ => Ok(None),
    }
}

/// True for a line that bows by a hundredth of its length at most.
fn is_straight(line: &[Point]) -> bool {
    const BOW: f64 = 0.01;
    let [start, .., end] = line else { return false };
    let chord = *end - *start;
    let off = |p: &Point| chord.cross(*p - *start).abs() / chord.hypot();
    chord.hypot() > 0.0 && line.iter().all(|p| off(p) <= BOW * chord.hypot())
}

/// The half of a region that is composed: what it has in common with its mirror image, half a gap from
/// the axis, so that the two halves keep the gap.
fn half(region: Region, axis: Option<Axis>, sizes: &Sizes) -> Option<Region> {
    let Some(axis) = axis else { return Some(region) };
    let reach = 4.0 * region.bounds().union_pt(axis.at).size().max_side();
    let alike = intersection(region.contours(), &axis.reflected(region.contours()));
    Region::new(intersection(&alike, &[axis.half(sizes.safe_gap() / 2.0, reach)]))
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
