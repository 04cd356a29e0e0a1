//! From the scene to regions with flow (FLOWPAK 4.1 and the start of 4.4, checklist F-007 to
//! F-015, F-040).

use super::params::{Params, Sizes};
use crate::geom::boolean::{self, Contour};
use crate::geom::crossing::self_crossings;
use crate::geom::flatten::{Subpath, flatten};
use crate::geom::near::crosses;
use crate::geom::polyline;
use crate::geom::region::Region;
use kurbo::{BezPath, Point, Rect, Shape};
use rinceau_format::{Container, Error, FillRule, Fixed, Guide, Scene};

/// Chords of outlines stay within this share of the size of everything.
const FLATNESS: f64 = 1e-4;

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
    if scene.containers.is_empty() {
        return Err(Error::new(
            "no-container",
            "There is no shape to fill",
            "Select a closed shape, or mark one as container (Extensions > Ornament > Mark as)",
        ));
    }
    let bounds = bounds_of(scene);
    let input_size = bounds.width().max(bounds.height());
    let tolerance = input_size * FLATNESS;
    let mut shapes: Vec<Vec<Contour>> = Vec::new();
    for container in &scene.containers {
        shapes.push(silhouette(container, tolerance)?);
    }
    // Of overlapping containers the upper one has the common area.
    for i in 0..shapes.len() {
        for j in i + 1..shapes.len() {
            if may_touch(&shapes[i], &shapes[j]) {
                shapes[i] = boolean::difference(&shapes[i], &shapes[j]);
            }
        }
    }
    let fixed = fixed_area(&scene.fixed, tolerance);
    let areas: Vec<f64> = shapes
        .iter()
        .map(|shape| boolean::area(&boolean::difference(shape, &near(&fixed, shape, 0.0))))
        .collect();
    let area: f64 = areas.iter().sum();
    let guides = polylines(&scene.guides, tolerance);
    let spines = polylines(&scene.fixed_spines, tolerance);
    check_guides(&scene.guides, &guides, &shapes)?;

    let mut prepared = Prepared { fields: Vec::new(), input_size, bounds, area, warnings: Vec::new() };
    for (index, (container, shape)) in scene.containers.iter().zip(&shapes).enumerate() {
        let overrides = container.overrides.iter().map(|(name, value)| (name.as_str(), value.as_str()));
        let own = params.overridden(overrides).map_err(|error| error.at(container.source.at))?;
        let perimeter = shape.iter().map(|contour| polyline::length(&closed(contour))).sum();
        let sizes = Sizes::new(&own, area, (areas[index], perimeter), scene.px_per_unit);
        check_gap(&sizes, container)?;
        match region(shape, &fixed, &sizes, tolerance) {
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

/// Where elements may be: fixed areas are kept clear by the gap, the outline by the edge
/// distance.
fn region(shape: &[Contour], fixed: &[Contour], sizes: &Sizes, tolerance: f64) -> Option<Region> {
    // Chords may lie on the wrong side of a curve by the tolerance.
    let distance = (sizes.gap - sizes.edge).max(0.0) + tolerance;
    let clear = boolean::offset(&near(fixed, shape, sizes.gap), distance);
    let free = boolean::difference(shape, &clear);
    Region::new(boolean::offset(&free, -sizes.edge - tolerance))
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

fn bounds_of(scene: &Scene) -> Rect {
    let containers = scene
        .containers
        .iter()
        .flat_map(|container| container.outlines.iter().map(|outline| outline.path.bounding_box()));
    let fixed = scene
        .fixed
        .iter()
        .flat_map(|fixed| fixed.parts.iter().map(|part| (part.transform * part.path.clone()).bounding_box()));
    containers.chain(fixed).reduce(|a, b| a.union(b)).unwrap_or(Rect::ZERO)
}

/// A container's area as simple contours.
fn silhouette(container: &Container, tolerance: f64) -> Result<Vec<Contour>, Error> {
    let source = &container.source;
    let name = &source.id;
    if container.outlines.is_empty() {
        return Err(source.error(
            "empty-container",
            format!(
                "The container '{name}' has no shape of its own: it is empty, or all in it is marked as well"
            ),
            "Draw a closed shape in it, or clear its mark",
        ));
    }
    let mut union: Vec<Contour> = Vec::new();
    for outline in &container.outlines {
        let mut contours = Vec::new();
        for subpath in flatten(&outline.path, tolerance) {
            if !subpath.closed {
                // A stray line in a text or group encloses nothing; a lone open path is a mistake.
                let (first, last) = (subpath.points[0], subpath.points[subpath.points.len() - 1]);
                if container.outlines.len() > 1 && subpath.points.len() < 3 {
                    continue;
                }
                return Err(source.error("open-container", format!("The container '{name}' is open: its ends are {:.1} apart, at {:.1},{:.1} and {:.1},{:.1}", first.distance(last), first.x, first.y, last.x, last.y), "Join its end nodes (with the node tool, or close the path), or mark it as guide"));
            }
            contours.push(subpath.points);
        }
        for contour in &contours {
            check_crossing(contour, container, tolerance)?;
        }
        let simple = boolean::simplified(&contours, outline.rule == FillRule::EvenOdd);
        union = if union.is_empty() { simple } else { boolean::union(&union, &simple) };
    }
    let size = container
        .outlines
        .iter()
        .map(|outline| outline.path.bounding_box())
        .reduce(|a, b| a.union(b))
        .unwrap_or(Rect::ZERO)
        .size();
    if boolean::area(&union) <= 1e-6 * size.max_side() * size.max_side() {
        return Err(source.error(
            "flat-container",
            format!("The container '{name}' encloses no area"),
            "Draw it as a closed shape that no transform flattens, or clear its mark",
        ));
    }
    Ok(union)
}

/// A contour that crosses itself is refused where it says, because what is inside is then a
/// guess; a loop of next to no area, as a hand-drawn line leaves where it closes, is not.
fn check_crossing(contour: &Contour, container: &Container, tolerance: f64) -> Result<(), Error> {
    const SMALL_LOOP: f64 = 2e-3;
    // More crossings than a slip of the pen makes are not worth measuring.
    const MOST_CROSSINGS: usize = 64;
    let crossings = self_crossings(contour, MOST_CROSSINGS);
    let Some(&at) = crossings.first() else { return Ok(()) };
    let refused = container.source.error(
        "crossing-container",
        format!(
            "The outline of the container '{}' crosses itself at {:.1},{:.1}",
            container.source.id, at.x, at.y
        ),
        "Clean it with Path > Union, or move the nodes apart",
    );
    if crossings.len() >= MOST_CROSSINGS {
        return Err(refused);
    }
    let odd = boolean::area(&boolean::simplified(std::slice::from_ref(contour), true));
    let winding = boolean::area(&boolean::simplified(std::slice::from_ref(contour), false));
    let signed = boolean::signed_area(contour).abs();
    let loops = (winding - odd).abs().max((winding - signed).abs());
    if loops <= SMALL_LOOP * winding || winding <= tolerance * tolerance {
        return Ok(());
    }
    Err(refused)
}

fn may_touch(a: &[Contour], b: &[Contour]) -> bool {
    match (bounding_box(a), bounding_box(b)) {
        (Some(a), Some(b)) => a.overlaps(b),
        _ => false,
    }
}

/// What fixed elements cover, strokes included.
fn fixed_area(fixed: &[Fixed], tolerance: f64) -> Vec<Contour> {
    let mut areas: Vec<Contour> = Vec::new();
    for part in fixed.iter().flat_map(|fixed| &fixed.parts) {
        let scale = part.transform.determinant().abs().sqrt();
        let path: BezPath = part.transform * part.path.clone();
        let subpaths = flatten(&path, tolerance);
        if part.style.is_filled() {
            let contours: Vec<Contour> = subpaths.iter().map(|subpath| subpath.points.clone()).collect();
            areas.extend(boolean::simplified(&contours, part.style.fill_rule() == FillRule::EvenOdd));
        }
        // A fixed object with no paint at all still counts, as its outline.
        let unpainted = if part.style.is_filled() { 0.0 } else { 2.0 * tolerance };
        let width = part.style.stroke_width().map_or(unpainted, |width| width * scale);
        for Subpath { points, closed, .. } in &subpaths {
            areas.extend(boolean::stroked(points, *closed, width));
        }
    }
    // Outer contours and holes run opposite ways, so windings of the parts add up to a union.
    boolean::simplified(&areas, false)
}

/// The contours that come near a shape.
fn near(contours: &[Contour], shape: &[Contour], distance: f64) -> Vec<Contour> {
    let Some(around) = bounding_box(shape) else { return Vec::new() };
    let around = around.inflate(distance, distance);
    let is_near = |contour: &&Contour| {
        bounding_box(std::slice::from_ref(*contour)).is_some_and(|bounds| bounds.overlaps(around))
    };
    contours.iter().filter(is_near).cloned().collect()
}

fn bounding_box(shape: &[Contour]) -> Option<Rect> {
    let mut points = shape.iter().flatten();
    points.next().map(|&first| points.fold(Rect::from_points(first, first), |r, &p| r.union_pt(p)))
}

/// Polylines, each with the index of the object it comes from.
type Lines = Vec<(usize, Vec<Point>)>;

fn polylines(guides: &[Guide], tolerance: f64) -> Lines {
    let mut lines = Vec::new();
    for (i, guide) in guides.iter().enumerate() {
        for subpath in flatten(&guide.path, tolerance) {
            let line = if subpath.closed { closed(&subpath.points) } else { subpath.points };
            lines.push((i, line));
        }
    }
    lines
}

fn closed(contour: &Contour) -> Vec<Point> {
    contour.iter().chain(contour.first()).copied().collect()
}

/// True if a polyline passes through a region or within `reach` of it.
fn passes(line: &[Point], region: &Region, reach: f64) -> bool {
    line.windows(2).any(|pair| {
        let mut across = false;
        region.edges().visit(pair[0], pair[1], 0.0, |a, b, _| {
            across = crosses(pair[0], pair[1], a, b);
            !across
        });
        if across {
            return true;
        }
        let steps = ((pair[0].distance(pair[1]) / (region.bounds().size().max_side() / 64.0)).ceil()
            as usize)
            .clamp(1, 256);
        (0..=steps).any(|k| {
            let p = pair[0].lerp(pair[1], k as f64 / steps as f64);
            region.contains(p) || (reach > 0.0 && region.distance(p, reach) < reach)
        })
    })
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
