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
//! 6. Refine the composition: shift, extend and grow (4.6), with small elements in the gaps that show
//!    (6): `refine`, `insert`.
//! 7. Mould outlines into the gaps, and fill those that are left (6), or draw their own shapes (5): `mould`,
//!    `settle`, `fill`, `negative`.
//! 8. Draw it, worn, rounded or as one piece if that is asked for (5): `artwork`, `finish`, `connect`.
//!
//! Departures are argued where they happen: lines on the boundary (`lines`), lines cut into
//! equal pieces (`field::streamline`), rooms in closed form (`blob`), trial fits and smooth
//! widths (`choose`), a map that cannot fold (`geom::bend`).

mod artwork;
mod blob;
mod builtin;
mod cast;
mod choose;
mod connect;
mod fill;
mod finish;
mod flow;
mod gaps;
mod insert;
mod library;
mod lines;
mod map;
mod motif;
mod mould;
mod negative;
mod paint;
mod params;
mod place;
mod prepare;
mod refine;
mod settle;
mod shift;
mod skin;
mod template;
mod thread;

pub use params::Params;

use crate::field::{DirectionField, LineKind};
use crate::geom::boolean::Contour;
use crate::palette::palette;
use crate::progress::Progress;
use crate::rng::Rng;
use crate::shapes::closed;
use artwork::Made;
use blob::Blob;
use fill::Filler;
use insert::Ground;
use motif::Motif;
use place::Placement;
use prepare::Prepared;
use rinceau_format::{Artwork, Error, Scene};
use std::ops::Range;
use template::{Side, Template};

/// Elements of one run at most, estimated before anything is traced.
pub const MOST_ELEMENTS: f64 = 20_000.0;

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
    let templates = library::templates(scene)?;
    let usable = prepared.fields.iter().map(|field| library::usable(&templates, field, scene));
    let usable = usable.collect::<Result<Vec<_>, _>>()?;

    let motifs = prepared.fields.iter().map(|field| library::motifs(&templates, field, scene));
    let motifs = motifs.collect::<Result<Vec<_>, _>>()?;

    let (blobs, flows, traced) = rooms(&prepared, &templates, &usable, rng, progress);
    let ground = Ground { prepared: &prepared, templates: &templates, usable: &usable, flows: &flows };
    let (mut placement, composed) = compose(&ground, &blobs, rng, progress);
    // Out of time, fillers would take what elements should have.
    let (fillers, negative, closed) = match traced && composed {
        true => close_gaps(&ground, &motifs, &mut placement, progress),
        false => (Vec::new(), Vec::new(), false),
    };
    let complete = traced && composed && closed;
    if placement.placed.is_empty() {
        return Err(nothing_placed(complete));
    }
    progress.step("artwork", 0.0);
    let mut artwork = artwork::artwork(
        &Made {
            prepared: &prepared,
            templates: &templates,
            placed: &placement.placed,
            fillers: &fillers,
            negative: &negative,
            streamlines: blobs.len(),
            seed: rng.bits(),
        },
        scene,
        |done| progress.step("artwork", done),
    );
    artwork.complete &= complete;
    // By the first container, since it is one piece for all of them.
    if let Some(first) = prepared.fields.first().filter(|field| field.params.connect) {
        let tone = palette(&first.params.palette, scene.containers[first.container].fill.as_deref())[0];
        let step = |done| progress.step("connect", done);
        // Of several containers each may have an axis of its own.
        let mirror = first.mirror.filter(|_| prepared.fields.len() == 1);
        let sizes = ((first.sizes.bridge, first.sizes.tolerance()), mirror);
        if !connect::join(&mut artwork, &prepared.fixed, sizes, tone, step)? {
            artwork.complete = false;
            let late = "The time ran out before all was joined to one piece; give it more (--time-limit)";
            artwork.warnings.push(late.to_owned());
        }
    }
    if prepared.fields.iter().any(|field| field.params.show_gaps) {
        artwork.groups.extend(map::map(scene, &artwork)?);
    }
    artwork.groups.extend(flow::flow(&prepared, &flows));
    artwork.counts.insert("flow-angle".to_owned(), flow_angle(&placement, &flows));
    Ok(artwork)
}

/// Step 7: outlines moulded into the gaps, and what fills the rest. False if the time ran out first.
fn close_gaps(
    ground: &Ground,
    motifs: &[Vec<Motif>],
    placement: &mut Placement,
    progress: &mut dyn Progress,
) -> (Vec<Filler>, Vec<negative::Shape>, bool) {
    let (prepared, templates) = (ground.prepared, ground.templates);
    let mut fillers = Vec::new();
    let stages = if motifs.iter().all(Vec::is_empty) { mould::ALONE } else { mould::BETWEEN };
    let mould =
        |placement: &mut Placement, fillers: &mut [Filler], stages: &[_], progress: &mut dyn Progress| {
            mould::mould(prepared, templates, placement, fillers, stages, |done| progress.step("mould", done))
        };
    let fill = |placement: &mut Placement, fillers: &mut Vec<_>, room, progress: &mut dyn Progress| {
        fill::fill(ground, motifs, placement, fillers, room, |done| progress.step("fill", done))
    };
    let complete = mould(placement, &mut [], &stages.wide, progress)
        && fill(placement, &mut fillers, fill::GAPS, progress)
        && mould(placement, &mut fillers, &stages.close, progress)
        && fill(placement, &mut fillers, fill::NOOKS, progress);
    if !complete {
        return (fillers, Vec::new(), false);
    }
    let (negative, complete) = negative::shapes(prepared, placement, |done| progress.step("fill", done));
    (fillers, negative, complete)
}

/// Steps 5 and 6: elements in the rooms, refined, and in their places. False if the time ran out first.
fn compose(ground: &Ground, blobs: &[Blob], rng: &mut Rng, progress: &mut dyn Progress) -> (Placement, bool) {
    let &Ground { prepared, templates, usable, flows } = ground;
    let step = |done| progress.step("cast", done);
    let (mut bodies, mut complete) = cast::cast(prepared, templates, usable, blobs, &mut rng.fork(), step);
    let refine = |bodies: &mut Vec<_>, part: Range<usize>, progress: &mut dyn Progress| {
        refine::refine(bodies, templates, flows, prepared, part, |done| progress.step("refine", done))
    };
    let insert =
        |bodies: &[_], silhouettes: (&[&Contour], f64), rng: &mut Rng, progress: &mut dyn Progress| {
            insert::insert(ground, bodies, silhouettes, rng, |done| progress.step("insert", done))
        };
    // Some room shows only once the first elements have moved.
    let iterations = prepared.fields.iter().map(|field| field.params.iterations).max().unwrap_or(0);
    let inserted_at = iterations / 3;
    complete &= refine(&mut bodies, 0..inserted_at, progress);
    if complete {
        let envelopes: Vec<_> = bodies.iter().map(refine::Body::outline).collect();
        let silhouettes: Vec<_> = envelopes.iter().collect();
        let (small, finished) = insert(&bodies, (&silhouettes, 0.0), &mut rng.fork(), progress);
        bodies.extend(small);
        complete = finished && refine(&mut bodies, inserted_at..iterations, progress);
    }
    let mut placement = Placement::new(prepared);
    complete &= placement.place(&bodies, templates, prepared, |done| progress.step("place", done));
    if complete {
        // Where one found no place after all, a smaller one may.
        let (small, finished) =
            insert(&bodies, (&placement.silhouettes(), placement.widest_stroke()), &mut rng.fork(), progress);
        complete = finished && placement.place(&small, templates, prepared, |_| true);
    }
    (placement, complete)
}

/// Mean angle between elements and the flow where they lie, in degrees. Fixed spines need not follow it.
fn flow_angle(placement: &Placement, flows: &[Option<DirectionField>]) -> f64 {
    let (mut sum, mut total) = (0.0, 0.0);
    for placed in placement.placed.iter().filter(|placed| placed.kind != LineKind::Fixed) {
        let Some(flow) = &flows[placed.field] else { continue };
        for side in placed.spine.windows(2) {
            let along = side[1] - side[0];
            let Some(direction) = flow.direction(side[0].midpoint(side[1]), along) else { continue };
            sum += along.hypot() * along.cross(direction).abs().atan2(along.dot(direction).abs());
            total += along.hypot();
        }
    }
    (sum / f64::max(total, f64::MIN_POSITIVE)).to_degrees()
}

/// Steps 3 and 4: a streamline for every element to be, the room around each, and the flow of each field. False if the
/// time ran out first.
fn rooms(
    prepared: &Prepared,
    templates: &[Template],
    usable: &[Vec<usize>],
    rng: &mut Rng,
    progress: &mut dyn Progress,
) -> (Vec<Blob>, Vec<Option<DirectionField>>, bool) {
    // Finer cells than these change no direction that an element could follow.
    const CELLS: f64 = 112.0;
    let mut complete = true;
    let (mut blobs, mut flows) = (Vec::new(), Vec::new());
    for (index, (field, usable)) in prepared.fields.iter().zip(usable).enumerate() {
        complete &= progress.step("field", index as f64 / prepared.fields.len() as f64);
        let cell = (field.sizes.spacing / 4.0).min(prepared.input_size / CELLS);
        // A guide that just misses the region gives no flow; then the boundary does.
        let along_boundary = || {
            let boundary: Vec<_> = field.region.contours().iter().map(closed).collect();
            DirectionField::new(&field.region, &boundary, cell)
        };
        let flow = DirectionField::new(&field.region, &field.guides, cell).or_else(along_boundary);
        let Some(flow) = flow else {
            flows.push(None);
            continue;
        };
        let half_elements = usable.iter().any(|&t| templates[t].side != Side::Full);
        progress.step("streamlines", 0.0);
        let (lines, finished) =
            lines::trace(field, &flow, half_elements, rng, |done| progress.step("streamlines", done));
        complete &= finished;
        progress.step("blobs", 0.0);
        let rooms = blob::blobs(index, field, &flow, lines);
        blobs.extend(rooms.into_iter().flat_map(|blob| thread::threaded(blob, field)));
        flows.push(Some(flow));
    }
    (blobs, flows, complete)
}

fn nothing_placed(complete: bool) -> Error {
    if complete {
        let remedy = "Make the element width or the shortest length smaller";
        return Error::new("nothing-fits", "No element fits into the shape", remedy);
    }
    // An empty layer would only take the place of an earlier, better one.
    let remedy = "Allow more time, or make the elements wider";
    Error::new("out-of-time", "The time ran out before any element was in its place", remedy)
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

#[cfg(test)]
mod tests {
    use super::*;
    use rinceau_format::{Document, Selection};

    /// The area of all envelopes together never shrinks, from one iteration to the next.
    #[test]
    fn refinement_is_monotone() {
        let svg = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 400 400'><path class='rinceau-container' d='M200,110C230,10 390,20 380,150C372,240 260,310 200,385C140,310 28,240 20,150C10,20 170,10 200,110Z'/></svg>";
        let scene =
            Document::from_bytes(svg.as_bytes().to_vec()).unwrap().scene(&Selection::default()).unwrap();
        let params = Params::from_values(&crate::params::Values::default());
        let prepared = prepare::prepare(&params, &scene).unwrap();
        let templates = library::templates(&scene).unwrap();
        let usable = vec![library::usable(&templates, &prepared.fields[0], &scene).unwrap()];
        let (mut rng, mut progress) = (Rng::new(3), crate::Deadline::new(None));
        let (blobs, flows, _) = rooms(&prepared, &templates, &usable, &mut rng, &mut progress);
        let (mut bodies, _) = cast::cast(&prepared, &templates, &usable, &blobs, &mut rng, |_| true);
        let all = |bodies: &[refine::Body]| bodies.iter().map(|body| body.fit.area).sum::<f64>();
        let (first, mut last) = (all(&bodies), all(&bodies));
        for i in 0..15 {
            refine::refine(&mut bodies, &templates, &flows, &prepared, i..i + 1, |_| true);
            assert!(all(&bodies) >= last, "iteration {i}: {} after {last}", all(&bodies));
            last = all(&bodies);
        }
        assert!(last > 1.05 * first, "{first} {last}");
    }
}
