//! Vines of magnetic curves with clip art.
//!
//! Ling Xu, David Mould: *Magnetic Curves: Curvature-Controlled Aesthetic Curves Using Magnetic
//! Fields*, Computational Aesthetics 2009; and the article *Computer-generated Floral Ornament
//! Based on Magnetic Curves*, which adds levels, tapering strokes, regions and adaptive clip art.
//!
//! 1. Divide each container into cells (M-019, M-020): `cells`.
//! 2. Start main stems: as drawn, as one curl, or finding their own way: `start`.
//! 3. Let branches leave where they fit, each a magnetic curve (M-003 to M-014): `particle`,
//!    `grow`.
//! 4. Place flowers at tips, leaves at forks and where room is left (M-021 to M-028):
//!    `grow::place`, `clip_art`.
//! 5. Cut the lower stem where branches cross, if they may (M-041): `plait`.
//! 6. Draw the stems as tapered outlines (M-015 to M-017): `stem`, `artwork`.
//!
//! Departures are argued where they happen: exact curves instead of Euler steps (`particle`),
//! longest-first branching, slender children and leaning leaves (`grow`), round tips (`stem`).

mod artwork;
mod cells;
mod clip_art;
mod grow;
mod params;
mod particle;
mod plait;
mod start;
mod stem;

pub use params::Params;

use crate::geom::region::Region;
use crate::progress::Progress;
use crate::rng::Rng;
use crate::shapes::Shapes;
use artwork::Layers;
use cells::Cells;
use clip_art::Library;
use grow::Plant;
use kurbo::{PathEl, Point};
use params::Sizes;
use particle::Charge;
use rinceau_format::{Artwork, Error, Guide, Scene};
use start::Ground;
use std::collections::BTreeMap;
use stem::Stem;

/// Stems of one container at most.
pub const MOST_STEMS: usize = 60_000;
/// Nodes of a drawn stem at most.
pub const MOST_NODES: usize = 2000;
/// Main stems of one container that start by themselves, at most.
const MOST_STARTS: usize = 200;
/// Cells of one container at most; with more the same ornament takes longer and no other shape.
const MOST_CELLS: f64 = 4e6;

/// Grows a vine in every container of a scene.
///
/// Errors: nothing to fill; a container, stem or element that cannot be used; a name of clip art
/// or a charge that means nothing.
pub fn generate(
    params: &Params,
    scene: &Scene,
    rng: &mut Rng,
    progress: &mut dyn Progress,
) -> Result<Artwork, Error> {
    progress.step("prepare", 0.0);
    let own = scene.containers.iter().map(|container| own_params(params, container));
    let own = own.collect::<Result<Vec<Params>, Error>>()?;
    let overlay: Vec<bool> = own.iter().map(|own| own.overlay).collect();
    let mut shapes = Shapes::new(scene, &overlay)?;
    let lists: Vec<&str> = own.iter().flat_map(|own| [own.forks.as_str(), own.tips.as_str()]).collect();
    let library = Library::new(scene, &lists)?;
    check_seeds(scene, &shapes)?;
    let mut layers = Layers::new(scene);
    let mut warnings = scene.warnings.clone();
    let mut counts = BTreeMap::new();
    let mut complete = true;
    // A path that is selected together with a shape is its stem.
    let stems: Vec<&Guide> =
        scene.stems.iter().chain(scene.guides.iter().filter(|path| !path.marked)).collect();
    let mut used = vec![0.0; stems.len()];
    let owners = take_apart(&mut shapes, scene, &stems, &own);
    let mut largest = vec![0.0; own.len()];
    for (&area, &index) in shapes.areas.iter().zip(&owners) {
        largest[index] = f64::max(largest[index], area);
    }
    let mut grown = vec![false; own.len()];
    let mut has_ended = false;
    for (island, &index) in owners.iter().enumerate() {
        if !progress.step("cells", 0.0) && grown.contains(&true) {
            (complete, has_ended) = (false, true);
            break;
        }
        let mut one = Container {
            scene,
            shapes: &shapes,
            island,
            index,
            area: largest[index],
            library: &library,
            stems: &stems,
            used: &mut used,
            planned: false,
        };
        if let Some(finished) = one.grow(&own[index], &mut rng.fork(), &mut layers, &mut counts, progress)? {
            complete &= finished;
            grown[index] = true;
        }
    }
    let left_out = scene.containers.iter().zip(&grown).filter(|(_, grown)| !has_ended && !**grown);
    for (container, _) in left_out {
        warnings.push(format!(
            "The container '{}' is too small or too thin for anything to grow, or lies under another",
            container.source.id
        ));
    }
    if !has_ended {
        warnings.extend(stems_cut(&stems, &used)?);
    }
    progress.step("artwork", 0.0);
    if layers.stems.items.is_empty() {
        let remedy = "Make the stem width or the gap smaller";
        return Err(Error::new("nothing-fits", "No stem fits into the shape", remedy));
    }
    let (groups, symbols) = layers.into_parts();
    Ok(Artwork {
        symbols,
        groups,
        complete,
        warnings,
        counts,
        decimals: shapes.decimals(),
        ..Artwork::default()
    })
}

/// Takes containers apart that are in several pieces: a vine of its own grows in every letter of a word. A band
/// stays whole, and a container for which the artist says where stems start. Of which each is.
fn take_apart(shapes: &mut Shapes, scene: &Scene, stems: &[&Guide], own: &[Params]) -> Vec<usize> {
    shapes.take_apart(|index, contours| {
        own[index].repeat
            || Region::new(contours.to_vec()).is_none_or(|region| {
                let starts = scene.seeds.iter().map(|seed| seed.at);
                let nodes = stems.iter().flat_map(|stem| stem.path.elements());
                starts.chain(nodes.filter_map(PathEl::end_point)).any(|at| region.contains(at))
            })
    })
}

/// Errors on a seed outside every container.
fn check_seeds(scene: &Scene, shapes: &Shapes) -> Result<(), Error> {
    let regions: Vec<Region> =
        shapes.containers.iter().filter_map(|shape| Region::new(shape.clone())).collect();
    match scene.seeds.iter().find(|seed| !regions.iter().any(|region| region.contains(seed.at))) {
        None => Ok(()),
        Some(seed) => Err(seed.source.error(
            "seed-outside",
            format!("The seed '{}' is outside every container", seed.source.id),
            "Move it into the shape where a vine should start, or clear its mark",
        )),
    }
}

/// The parameters of a container, its own wishes included.
fn own_params(params: &Params, container: &rinceau_format::Container) -> Result<Params, Error> {
    let overrides = container.overrides.iter().map(|(name, value)| (name.as_str(), value.as_str()));
    params.overridden(overrides).map_err(|error| error.at(container.source.at))
}

/// A warning for every drawn stem that is used in part.
///
/// Errors: one lies outside every container.
fn stems_cut(stems: &[&Guide], used: &[f64]) -> Result<Vec<String>, Error> {
    // The ends of a stem may touch the edge that is kept free.
    const MOST: f64 = 0.8;
    let mut warnings = Vec::new();
    for (stem, &used) in stems.iter().zip(used) {
        let name = &stem.source.id;
        if used == 0.0 {
            return Err(stem.source.error(
                "stem-outside",
                format!("The stem '{name}' is outside every container, or runs along its edge"),
                "Move it into the shape that it should fill, or clear its mark",
            ));
        }
        if used < MOST {
            warnings.push(format!(
                "{}: the stem '{name}' leaves its container or crosses what is fixed; only its longest part inside is used",
                stem.source.at
            ));
        }
    }
    Ok(warnings)
}

/// One container of a run.
struct Container<'a> {
    scene: &'a Scene,
    /// Containers in one piece each, and which of them this is.
    shapes: &'a Shapes,
    island: usize,
    /// Which of the scene's it is, or is a part of.
    index: usize,
    /// Of its largest part.
    area: f64,
    library: &'a Library,
    /// Drawn stems.
    stems: &'a [&'a Guide],
    /// How much of each drawn stem any container uses.
    used: &'a mut [f64],
    /// True if the artist says where its stems start: then no others do.
    planned: bool,
}

impl Container<'_> {
    /// Grows and draws; false if the time ran out, `None` if there is no room at all.
    fn grow(
        &mut self,
        params: &Params,
        rng: &mut Rng,
        layers: &mut Layers,
        counts: &mut BTreeMap<String, f64>,
        progress: &mut dyn Progress,
    ) -> Result<Option<bool>, Error> {
        let container = &self.scene.containers[self.index];
        let at = |error: Error| error.at(container.source.at);
        let own = container.overrides.contains_key("charge");
        let charge =
            Charge::from_param(&params.charge).map_err(|error| if own { at(error) } else { error })?;
        let forks = self.library.choices(&params.forks, params.levels)?;
        let tips = self.library.choices(&params.tips, params.levels)?;
        progress.step("cells", 0.0);
        let Some(ground) = self.ground() else { return Ok(None) };
        let inradius = ground.inradius;
        let sizes = Sizes::new(params, self.area, inradius, self.scene.px_per_unit);
        let Some(cells) = self.cells(params, &sizes) else { return Ok(None) };
        let mut plant =
            Plant::new((params, &sizes), (self.library, &charge), (forks, tips), cells, rng.fork());
        progress.step("stem", 0.0);
        self.start(&mut plant, &ground, rng)?;
        let mut finished = true;
        // Where a large place stays empty another stem starts, smaller as the place is.
        for _ in 0..MOST_STARTS {
            progress.step("branches", 0.0);
            finished &= plant.branch(MOST_STEMS, |done| progress.step("branches", done));
            if !finished || self.planned || params.repeat {
                break;
            }
            progress.step("stem", 0.0);
            let free = ground.less(&plant.cells);
            let left = free.inradius;
            if left < (0.42 * inradius).min(14.0 * sizes.width) || left < 3.5 * sizes.width {
                break;
            }
            let Some(stem) = start::wander(&plant, (&ground, &free), (None, start::TRIES[1]), rng) else {
                break;
            };
            plant.add_main(stem);
        }
        finished &= plant.place_leaves(|done| progress.step("leaves", done));
        plait::cut(&mut plant.stems, &plant.crossings, plait::GAP * sizes.gap);
        layers.add(&plant, self.library, container.fill.as_deref(), self.shapes.decimals());
        *counts.entry("stems".into()).or_insert(0.0) += plant.stems.len() as f64;
        *counts.entry("crossings".into()).or_insert(0.0) += plant.crossings.len() as f64;
        *counts.entry("elements".into()).or_insert(0.0) += plant.arts.len() as f64;
        Ok(Some(finished))
    }

    /// A few cells, for a first look. `None` if there is no inside.
    fn ground(&self) -> Option<Ground> {
        const CELLS: f64 = 4e4;
        let region = self.shapes.free(self.island, 0.0, 0.0)?;
        let size = Cells::size_for(region.bounds().area(), 0.0, CELLS);
        Some(Ground::new(Cells::new(&region, size, None))).filter(|ground| ground.inradius > 0.0)
    }

    /// The free cells.
    fn cells(&self, params: &Params, sizes: &Sizes) -> Option<Cells> {
        let (left, width) = self.shapes.span(self.island);
        let free = if params.repeat { Shapes::free_repeated } else { Shapes::free };
        let region = free(self.shapes, self.island, sizes.gap, sizes.edge)?;
        // As fine as the thinnest twig.
        let size = Cells::size_for(width * region.bounds().height(), 0.17 * sizes.width, MOST_CELLS);
        Some(Cells::new(&region, size, params.repeat.then_some((left, width))))
    }

    /// Plants the main stems: those that were drawn, or from the seeds, or one that starts by
    /// itself.
    fn start(&mut self, plant: &mut Plant, ground: &Ground, rng: &mut Rng) -> Result<(), Error> {
        let repeat = plant.params.repeat;
        let taper = plant.main_taper();
        let mut drawn: Vec<Stem> = Vec::new();
        for (stem, used) in self.stems.iter().zip(&mut *self.used) {
            if stem.path.elements().len() > MOST_NODES {
                let sentence = format!("The stem '{}' has more than {MOST_NODES} nodes", stem.source.id);
                return Err(stem.source.error("too-many-nodes", sentence, "Simplify it (Path > Simplify)"));
            }
            for whole in start::drawn(&stem.path, taper) {
                let part = start::part_inside(&plant.cells, &whole);
                *used = used.max(part.as_ref().map_or(0.0, |part| part.length() / whole.length()));
                drawn.extend(part);
            }
        }
        let seeds = self.scene.seeds.iter().map(|seed| seed.at).filter(|&at| plant.cells.is_free(at));
        let mut seeds: Vec<Option<Point>> = seeds.map(Some).collect();
        self.planned = !drawn.is_empty() || !seeds.is_empty() || plant.params.stem == "curl";
        if drawn.is_empty() && seeds.is_empty() {
            if repeat {
                drawn.extend(start::wave(plant, self.shapes.span(self.island), ground.inradius));
            }
            if drawn.is_empty() {
                seeds.push(None);
            }
        }
        for mut stem in drawn {
            if repeat {
                plant.add(stem);
            } else {
                // One that leaves another is as wide as that one is there.
                if let Some(width) = start::width_of_parent(&plant.stems, &stem) {
                    stem.taper = plant.taper(width);
                }
                plant.add_main(stem);
            }
        }
        for seed in seeds {
            let longest = plant.sizes.length[0];
            let stem = if plant.params.stem == "curl" {
                start::curl(plant, ground, seed, longest)
            } else {
                start::wander(plant, (ground, &ground.less(&plant.cells)), (seed, start::TRIES[0]), rng)
                    .or_else(|| start::curl(plant, ground, seed, longest))
            };
            if let Some(stem) = stem {
                plant.add_main(stem);
            }
        }
        Ok(())
    }
}
