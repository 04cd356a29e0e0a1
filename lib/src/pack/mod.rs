//! Packing elements along a flow.
//!
//! Reza Adhitya Saputra, Craig S. Kaplan, Paul Asente, Radomír Měch: *FLOWPAK: Flow-based
//! Ornamental Element Packing*, Graphics Interface 2017.
//!
//! 1. Read the containers and copy the fixed elements (4.1): `prepare`.
//! 2. Describe each element by how far it reaches beside its spine (4.2): `template`.
//! 3. Fill each container with a direction field and trace streamlines (4.3): `field`, `lines`.
//! 4. Measure the room around each streamline (4.4): `blob`.
//! 5. Choose the element for each room, bend it along the streamline (4.5): `choose`, `place`.
//!
//! Departures are argued where they happen: lines on the boundary (`lines`), lines cut into
//! equal pieces (`field::streamline`), rooms in closed form (`blob`), trial fits and smooth
//! widths (`choose`), a map that cannot fold (`geom::bend`).

mod blob;
mod builtin;
mod choose;
mod lines;
mod paint;
mod params;
mod place;
mod prepare;
mod template;

pub use params::Params;

use crate::field::{DirectionField, LineKind};
use crate::geom::polyline;
use crate::progress::Progress;
use crate::rng::Rng;
use blob::Blob;
use choose::Fit;
use kurbo::{Affine, BezPath, Point};
use place::{Placed, Placement};
use prepare::{Field, Prepared};
use rinceau_format::{Artwork, Error, Group, Item, Part, Scene, Style};
use template::{Side, Template};

/// Elements of one run at most, estimated before anything is traced.
pub const MOST_ELEMENTS: f64 = 50_000.0;

/// Packs every container of a scene.
///
/// Errors: nothing to fill or to fill it with; a container, guide or element that cannot be
/// used; more than [`MOST_ELEMENTS`].
pub fn generate(
    params: &Params,
    scene: &Scene,
    rng: &mut Rng,
    progress: &mut dyn Progress,
) -> Result<Artwork, Error> {
    progress.step("prepare", 0.0);
    let prepared = prepare::prepare(params, scene)?;
    check_work(&prepared)?;
    let templates = templates(scene)?;

    let mut blobs: Vec<Blob> = Vec::new();
    let mut complete = true;
    for (index, field) in prepared.fields.iter().enumerate() {
        complete &= progress.step("field", index as f64 / prepared.fields.len() as f64);
        let usable = usable(&templates, field, scene)?;
        let cell = (field.sizes.spacing / 4.0).min(prepared.input_size / 160.0);
        let Some(flow) = DirectionField::new(&field.region, &field.guides, cell) else { continue };
        let half_elements = usable.iter().any(|&t| templates[t].side != Side::Full);
        progress.step("streamlines", 0.0);
        let (lines, finished) =
            lines::trace(field, &flow, half_elements, rng, |done| progress.step("streamlines", done));
        complete &= finished;
        progress.step("blobs", 0.0);
        blobs.extend(blob::blobs(index, field, &flow, lines));
    }
    let placement =
        place_all(&prepared, &templates, &blobs, scene, &mut rng.fork(), progress, &mut complete)?;
    if placement.placed.is_empty() && complete {
        return Err(Error::new(
            "nothing-fits",
            "No element fits into the shape",
            "Make the element width or the shortest length smaller",
        ));
    }
    progress.step("artwork", 0.0);
    Ok(artwork(&prepared, &templates, &blobs, placement.placed, scene, complete))
}

/// Counts the elements before anything is built.
fn check_work(prepared: &Prepared) -> Result<(), Error> {
    for field in &prepared.fields {
        let sizes = &field.sizes;
        let each = sizes.spacing * (sizes.min_length + sizes.max_length) / 2.0;
        let count = prepared.area / each;
        if count > MOST_ELEMENTS {
            let spacing = sizes.spacing * (count / MOST_ELEMENTS).sqrt();
            return Err(Error::new(
                "too-many-elements",
                format!(
                    "An element width of {:.4} would need about {count:.0} elements, more than {MOST_ELEMENTS:.0}",
                    sizes.spacing
                ),
                format!("Set the element width (--spacing) to {:.4} or more", spacing * 1.05),
            ));
        }
    }
    Ok(())
}

/// The drawn elements and the built-in ones.
fn templates(scene: &Scene) -> Result<Vec<Template>, Error> {
    let mut templates =
        scene.elements.iter().map(|element| Template::new(element, false)).collect::<Result<Vec<_>, _>>()?;
    templates.extend(builtin::templates()?);
    Ok(templates)
}

/// Which templates a container asks for.
fn usable(templates: &[Template], field: &Field, scene: &Scene) -> Result<Vec<usize>, Error> {
    let wanted = field.params.elements.as_str();
    let any_drawn = !scene.elements.is_empty();
    let named = |template: &Template| match wanted {
        "auto" if any_drawn => !template.builtin,
        "auto" => template.names.iter().any(|name| name == "mixed"),
        "drawn" => !template.builtin,
        names => names.split_whitespace().any(|name| template.names.iter().any(|own| own == name)),
    };
    let usable: Vec<usize> = (0..templates.len()).filter(|&i| named(&templates[i])).collect();
    if usable.is_empty() {
        let container = &scene.containers[field.container].source;
        let (sentence, remedy) = if wanted == "drawn" {
            (
                "No element is drawn".to_owned(),
                "Draw one: group its shapes with a straight spine and mark the group as element",
            )
        } else {
            (
                format!("No element, kind or family is called '{wanted}'"),
                "Use auto, drawn, mixed, leaves, drops, spirals, scales, feathers, or the id of an element",
            )
        };
        return Err(container.error("no-element", sentence, remedy));
    }
    Ok(usable)
}

/// Step 5 for all containers, in drawing order.
fn place_all(
    prepared: &Prepared,
    templates: &[Template],
    blobs: &[Blob],
    scene: &Scene,
    rng: &mut Rng,
    progress: &mut dyn Progress,
    complete: &mut bool,
) -> Result<Placement, Error> {
    let spacing = prepared.fields.iter().map(|field| field.sizes.spacing).fold(f64::INFINITY, f64::min);
    let mut placement = Placement::new(prepared.bounds, spacing / 2.0);
    let mut neighbours = Neighbours::new(prepared, spacing);
    for (index, blob) in blobs.iter().enumerate() {
        if !progress.step("place", index as f64 / blobs.len() as f64) {
            *complete = false;
            break;
        }
        let field = &prepared.fields[blob.field];
        let usable = usable(templates, field, scene)?;
        for fit in ranked(templates, &usable, blob, field, &neighbours, rng) {
            let template = &templates[fit.pose.template];
            let fit = choose::trimmed(template, fit, blob, field.sizes.min_length, &field.params);
            if placement.place(index, blob, &fit, template, field) {
                neighbours.add(blob, fit.pose.template);
                break;
            }
        }
    }
    Ok(placement)
}

/// Candidates for a blob, best first; a few are enough, since the first nearly always goes.
fn ranked(
    templates: &[Template],
    usable: &[usize],
    blob: &Blob,
    field: &Field,
    neighbours: &Neighbours,
    rng: &mut Rng,
) -> Vec<Fit> {
    const TRIED: usize = 3;
    let bin = blob.length / template::BINS as f64;
    let room: f64 = blob.room.iter().flatten().sum::<f64>() * bin;
    let reversed = field.guided && field.params.sense == "arrow" && runs_against(blob, &field.guides);
    let mut scored: Vec<(f64, Fit)> = Vec::new();
    for pose in choose::poses(templates, usable, blob) {
        let Some(fit) = choose::fit(&templates[pose.template], pose, blob, (0.0, 1.0), None, &field.params)
        else {
            continue;
        };
        let against = field.guided && field.params.sense == "arrow" && pose.along != reversed;
        let repeats = neighbours.repeats(blob, pose.template);
        let score = place::score(&fit, room, repeats, against, &field.params)
            + rng.between(0.0, 0.06 * field.params.variety);
        scored.push((score, fit));
    }
    scored.sort_by(|a, b| b.0.total_cmp(&a.0));
    scored.into_iter().take(TRIED).map(|(_, fit)| fit).collect()
}

/// True if a line runs against the arrows of the nearest guide.
fn runs_against(blob: &Blob, guides: &[Vec<Point>]) -> bool {
    let middle = blob.points[blob.points.len() / 2];
    let along = blob.points[blob.points.len() - 1] - blob.points[0];
    let segments = guides.iter().flat_map(|guide| guide.windows(2));
    let nearest = segments.min_by(|a, b| {
        let distance = |s: &[Point]| crate::geom::near::point_segment(middle, s[0], s[1]);
        distance(a).total_cmp(&distance(b))
    });
    nearest.is_some_and(|segment| (segment[1] - segment[0]).dot(along) < 0.0)
}

/// Where which template already is.
struct Neighbours {
    grid: crate::geom::near::PointGrid,
    reach: f64,
}

impl Neighbours {
    fn new(prepared: &Prepared, spacing: f64) -> Self {
        Neighbours {
            grid: crate::geom::near::PointGrid::new(prepared.bounds, 2.0 * spacing),
            reach: 1.6 * spacing,
        }
    }

    fn add(&mut self, blob: &Blob, template: usize) {
        Self::marks(blob).for_each(|p| self.grid.insert(p, template as u32));
    }

    /// 1 for an equal element beside most of a blob, 0 for none.
    fn repeats(&self, blob: &Blob, template: usize) -> f64 {
        let beside = Self::marks(blob)
            .filter(|&p| self.grid.any_within(p, self.reach, |_, other| other == template as u32))
            .count();
        beside as f64 / Self::marks(blob).count() as f64
    }

    /// A few places along a blob.
    fn marks(blob: &Blob) -> impl Iterator<Item = Point> + '_ {
        let n = blob.points.len();
        (0..5).map(move |i| blob.points[i * (n - 1) / 4])
    }
}

fn artwork(
    prepared: &Prepared,
    templates: &[Template],
    blobs: &[Blob],
    placed: Vec<Placed>,
    scene: &Scene,
    complete: bool,
) -> Artwork {
    let decimals = rinceau_format::decimals_for(prepared.input_size);
    let spacing = prepared.fields.iter().map(|field| field.sizes.spacing).fold(0.0, f64::max);
    let tones = paint::assign(&placed, 2.6 * spacing);
    let mut elements = Group { name: "elements".into(), ..Group::default() };
    let mut spines = Group { name: "spines".into(), hidden: true, ..Group::default() };
    let mut counts = std::collections::BTreeMap::new();
    for (placed, tone) in placed.iter().zip(tones) {
        let template = &templates[placed.fit.pose.template];
        let field = &prepared.fields[blobs[placed.blob].field];
        let palette =
            paint::palette(&field.params.palette, scene.containers[field.container].fill.as_deref());
        let parts = template.parts.iter().zip(&placed.paths).map(|((_, style), path)| {
            let style = if template.builtin {
                painted(style, palette[tone])
            } else {
                style.scaled(placed.scale, decimals)
            };
            Part { path: path.clone(), transform: Affine::IDENTITY, style }
        });
        elements.items.push(Item { of: template.id.clone(), parts: parts.collect() });
        spines.items.push(spine_item(&placed.spine));
        *counts.entry(format!("elements.{}", template.id)).or_insert(0.0) += 1.0;
    }
    let ink: f64 = placed.iter().map(|placed| placed.area).sum();
    counts.insert("elements".into(), placed.len() as f64);
    counts.insert("streamlines".into(), blobs.len() as f64);
    counts.insert(
        "streamlines.boundary".into(),
        blobs.iter().filter(|blob| blob.kind == LineKind::Boundary).count() as f64,
    );
    counts.insert("coverage".into(), if prepared.area > 0.0 { ink / prepared.area } else { 0.0 });
    let fixed = Group {
        name: "fixed".into(),
        items: scene
            .fixed
            .iter()
            .map(|fixed| Item { of: fixed.source.id.clone(), parts: fixed.parts.clone() })
            .collect(),
        ..Group::default()
    };
    let mut groups = vec![elements, fixed, spines];
    groups.retain(|group| !group.items.is_empty());
    let mut warnings = scene.warnings.clone();
    warnings.extend(prepared.warnings.iter().cloned());
    Artwork { groups, complete, warnings, counts, decimals }
}

/// A built-in part in a palette's tone. Its holes are holes, so one tone is enough.
fn painted(style: &Style, tone: &str) -> Style {
    let mut style = style.clone();
    style.set("fill", tone);
    style
}

/// A spine as a line that can be edited and marked as fixed spine.
fn spine_item(points: &[Point]) -> Item {
    let mut path = BezPath::new();
    path.move_to(points[0]);
    points[1..].iter().for_each(|&p| path.line_to(p));
    let mut style = Style::filled("none");
    style.set("stroke", "#ff0000");
    style.set("stroke-width", &format!("{:.4}", polyline::length(points) / 200.0));
    Item { of: "spine".into(), parts: vec![Part { path, transform: Affine::IDENTITY, style }] }
}
