//! What every generator that fills shapes asks of a scene first: containers as simple
//! contours, and the area that fixed elements cover (FLOWPAK 4.1, checklist F-007 to F-015).

use crate::geom::boolean::{self, Contour};
use crate::geom::crossing::self_crossings;
use crate::geom::flatten::{Subpath, flatten};
use crate::geom::region::Region;
use crate::geom::segment::crosses;
use kurbo::{BezPath, Point, Rect, Shape};
use rinceau_format::{Container, Error, FillRule, Fixed, Guide, Scene};

/// Chords of outlines stay within this share of the size of everything.
const FLATNESS: f64 = 1e-4;

/// Containers and fixed areas of a scene.
pub struct Shapes {
    /// Of everything.
    pub bounds: Rect,
    /// Largest side of the bounds (F-014).
    pub size: f64,
    /// How far chords are from the curves they stand for.
    pub tolerance: f64,
    /// Each container of the scene as simple contours, less what lies above it.
    pub containers: Vec<Vec<Contour>>,
    /// Its area without what is fixed.
    pub areas: Vec<f64>,
    fixed: Vec<Contour>,
}

impl Shapes {
    /// Reads the containers. One that is an `overlay` lies over those below it and does not
    /// take their place.
    ///
    /// Errors: there is none; one is open, crosses itself or has no area.
    pub fn new(scene: &Scene, overlay: &[bool]) -> Result<Self, Error> {
        if scene.containers.is_empty() {
            return Err(Error::new(
                "no-container",
                "There is no shape to fill",
                "Select a closed shape, or mark one as container (Extensions > Ornament > Mark as)",
            ));
        }
        let bounds = bounds_of(scene);
        let size = bounds.width().max(bounds.height());
        let tolerance = size * FLATNESS;
        let mut containers: Vec<Vec<Contour>> = Vec::new();
        for container in &scene.containers {
            containers.push(silhouette(container, tolerance)?);
        }
        // Of overlapping containers the upper one has the common area.
        let boxes: Vec<Rect> =
            containers.iter().map(|shape| bounding_box(shape).unwrap_or(Rect::ZERO)).collect();
        for i in 0..containers.len() {
            for j in i + 1..containers.len() {
                let takes = !overlay.get(j).copied().unwrap_or(false);
                if takes && boxes[i].overlaps(boxes[j]) {
                    containers[i] = boolean::difference(&containers[i], &containers[j]);
                }
            }
        }
        let fixed = fixed_area(&scene.fixed, tolerance);
        let mut shapes = Shapes { bounds, size, tolerance, containers, areas: Vec::new(), fixed };
        shapes.measure();
        Ok(shapes)
    }

    /// Takes containers apart that are in several pieces, the largest first, but for those that `is_whole`
    /// says; of which container each is.
    pub fn take_apart(&mut self, is_whole: impl Fn(usize, &[Contour]) -> bool) -> Vec<usize> {
        let mut owners = Vec::new();
        for (index, contours) in std::mem::take(&mut self.containers).into_iter().enumerate() {
            let pieces = match is_whole(index, &contours) {
                true => vec![contours],
                false => boolean::parts(contours),
            };
            owners.extend(pieces.iter().map(|_| index));
            self.containers.extend(pieces.into_iter().rev());
        }
        if owners.len() > self.areas.len() {
            self.measure();
        }
        owners
    }

    fn measure(&mut self) {
        let free = |shape: &Vec<Contour>| boolean::difference(shape, &near(&self.fixed, shape, 0.0));
        self.areas = self.containers.iter().map(|shape| boolean::area(&free(shape))).collect();
    }

    /// Decimals of coordinates for results of this size.
    pub fn decimals(&self) -> usize {
        rinceau_format::decimals_for(self.size)
    }

    /// What is fixed, as simple contours.
    pub fn fixed(&self) -> &[Contour] {
        &self.fixed
    }

    /// Area of all containers without what is fixed.
    pub fn area(&self) -> f64 {
        self.areas.iter().sum()
    }

    /// Where ornament may be in a container: `gap` from what is fixed, `edge` from the outline.
    /// `None` if nothing is left.
    pub fn free(&self, container: usize, gap: f64, edge: f64) -> Option<Region> {
        self.free_in(&self.containers[container], gap, edge)
    }

    /// The same in a band that goes on to the left and to the right: the container between two
    /// copies of itself.
    pub fn free_repeated(&self, container: usize, gap: f64, edge: f64) -> Option<Region> {
        let shape = &self.containers[container];
        // The copies overlap by less than anyone sees, or rounding would leave a hairline.
        let period = bounding_box(shape)?.width() - 2.0 * self.tolerance;
        let copy = |by: f64| -> Vec<Contour> {
            let moved = |contour: &Contour| contour.iter().map(|&p| Point::new(p.x + by, p.y)).collect();
            shape.iter().map(moved).collect()
        };
        let band = boolean::union(&boolean::union(shape, &copy(period)), &copy(-period));
        self.free_in(&band, gap, edge)
    }

    /// The box around a container.
    pub fn frame(&self, container: usize) -> Rect {
        bounding_box(&self.containers[container]).unwrap_or(Rect::ZERO)
    }

    /// Left end and width of a container.
    pub fn span(&self, container: usize) -> (f64, f64) {
        let frame = self.frame(container);
        (frame.x0, frame.width())
    }

    /// The same in any shape.
    pub fn free_in(&self, shape: &[Contour], gap: f64, edge: f64) -> Option<Region> {
        // Chords may lie on the wrong side of a curve by the tolerance.
        let distance = (gap - edge).max(0.0) + self.tolerance;
        let clear = boolean::offset(&near(&self.fixed, shape, gap), distance);
        let free = boolean::difference(shape, &clear);
        Region::new(boolean::offset(&free, -edge - self.tolerance))
    }
}

/// What is wrong with each container, as a generator that fills it would say.
pub fn faults(scene: &Scene) -> Vec<Error> {
    let tolerance = bounds_of(scene).size().max_side() * FLATNESS;
    scene.containers.iter().filter_map(|container| silhouette(container, tolerance).err()).collect()
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
    let mut all: Vec<Contour> = Vec::new();
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
        all.extend(boolean::simplified(&contours, outline.rule == FillRule::EvenOdd));
    }
    // Outer contours run one way round and holes the other: what any of them covers winds at least once.
    let union = if container.outlines.len() > 1 { boolean::simplified(&all, false) } else { all };
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
pub type Lines = Vec<(usize, Vec<Point>)>;

/// Flattens guides.
pub fn polylines(guides: &[Guide], tolerance: f64) -> Lines {
    let mut lines = Vec::new();
    for (i, guide) in guides.iter().enumerate() {
        for subpath in flatten(&guide.path, tolerance) {
            let line = if subpath.closed { closed(&subpath.points) } else { subpath.points };
            lines.push((i, line));
        }
    }
    lines
}

/// A contour with its first point repeated.
pub fn closed(contour: &Contour) -> Vec<Point> {
    contour.iter().chain(contour.first()).copied().collect()
}

/// True if a polyline passes through a region or within `reach` of it.
pub fn passes(line: &[Point], region: &Region, reach: f64) -> bool {
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
