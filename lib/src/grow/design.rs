//! What has grown in the containers of a scene, before anything of it is drawn: one design can be
//! drawn in one style after another (000 3.2, Figure 17).

use super::draw::{self, Arts, Drawing};
use super::growth::{self, Grown, Settings};
use super::room::Room;
use super::rules::{Rules, Shared, State};
use super::section::{Section, sections};
use super::start::{Start, plant, stem_kind};
use super::symmetry::Extent;
use super::world::World;
use super::{Params, rule_text};
use crate::geom::region::Region;
use crate::progress::Progress;
use crate::rng::Rng;
use crate::shapes::Shapes;
use rinceau_format::{Artwork, Error, Scene, Source};
use std::collections::BTreeMap;

/// Cells of one container at most; a larger one has coarser cells.
const MOST_CELLS: f64 = 3e6;
/// Side of a cell in units of the rules: about a tenth of the radius of a dot of the paper's.
const CELL: f64 = 0.28;
/// A shape has so many units along the side of a square as large as it.
const UNITS: f64 = 100.0;

/// An ornament that has grown: the proxies of its elements, without their looks.
pub struct Design {
    panels: Vec<Panel>,
    arts: Arts,
    decimals: usize,
    complete: bool,
    warnings: Vec<String>,
    counts: BTreeMap<String, f64>,
}

/// What has grown in one container, or in a section of it.
struct Panel {
    /// Of the container.
    index: usize,
    rules: Rules,
    shared: Shared,
    grown: Grown,
    /// Length of a unit of the rules.
    unit: f64,
    section: Section,
    /// What nothing that is drawn leaves.
    outline: Option<Region>,
}

impl Design {
    /// Grows ornament in every container of a scene.
    ///
    /// Errors: nothing to fill; rules that cannot be read or that fail.
    pub fn grow(
        params: &Params,
        scene: &Scene,
        rng: &mut Rng,
        progress: &mut dyn Progress,
    ) -> Result<Self, Error> {
        progress.step("prepare", 0.0);
        let own = overridden(params, scene)?;
        let shapes = Shapes::new(scene, &[])?;
        let mut design = Design {
            panels: Vec::new(),
            arts: Arts::new(scene)?,
            decimals: shapes.decimals(),
            complete: true,
            warnings: scene.warnings.clone(),
            counts: BTreeMap::new(),
        };
        for (index, own) in own.iter().enumerate() {
            let source = &scene.containers[index].source;
            if !progress.step("space", 0.0) && !design.panels.is_empty() {
                design.complete = false;
                break;
            }
            let mut start = Start { scene, shapes: &shapes, index, params: own, unit: 0.0 };
            let area = shapes.areas[index];
            start.unit = match own.rule_unit.to_user(scene.px_per_unit) {
                0.0 => area.sqrt() / UNITS,
                unit => unit,
            };
            let is_sane = start.unit > 0.0 && area / (start.unit * start.unit) < 1e8;
            let mut panels = Vec::new();
            if is_sane {
                let sections = sections(&own.symmetry, &start.shape(), own.repeats);
                for section in sections.map_err(|error| error.at(source.at))? {
                    panels.extend(design.panel(&start, section, &mut rng.fork(), progress)?);
                }
            }
            if panels.is_empty() {
                let sentence = format!("the container '{}' has no room for anything to grow", source.id);
                design.warnings.push(format!("{}: {sentence}", source.at));
            }
            for panel in panels {
                design.take(panel, source, own);
            }
        }
        Ok(design)
    }

    /// Counts what has grown, and says what the artist should know of it.
    fn take(&mut self, panel: Panel, source: &Source, own: &Params) {
        let grown = &panel.grown;
        self.warnings.extend(panel.section.symmetry.note.clone());
        if grown.steps == 0 && grown.complete {
            self.warnings.push(format!(
                "{}: nothing of the pattern grows in '{}': {}",
                source.at,
                source.id,
                grown.reasons()
            ));
        }
        if grown.full {
            self.warnings.push(format!(
                "{}: the growth in '{}' ended because there may be {} elements at most",
                source.at, source.id, own.max_elements
            ));
        }
        if own.debug > 0 && grown.view.is_none() {
            self.warnings
                .push(format!("Growth ended before step {}: there is nothing to show of it", own.debug));
        }
        self.complete &= grown.complete && !grown.full;
        *self.counts.entry("steps".into()).or_insert(0.0) += grown.steps as f64;
        *self.counts.entry("failed".into()).or_insert(0.0) += grown.failed as f64;
        self.panels.push(panel);
    }

    /// Draws it. Of the parameters `style` and `palette` count; nothing grows again.
    ///
    /// Errors: nothing has grown; a container has a parameter that it cannot have.
    pub fn draw(&self, params: &Params, scene: &Scene) -> Result<Artwork, Error> {
        let own = overridden(params, scene)?;
        let mut artwork = Artwork {
            complete: self.complete,
            warnings: self.warnings.clone(),
            decimals: self.decimals,
            counts: self.counts.clone(),
            ..Artwork::default()
        };
        for panel in &self.panels {
            let drawing = Drawing {
                looks: panel.rules.looks(),
                params: &own[panel.index],
                unit: panel.unit,
                fill: scene.containers[panel.index].fill.as_deref(),
                arts: &self.arts,
                section: &panel.section,
                outline: panel.outline.as_ref(),
            };
            let mut state = panel.shared.borrow_mut();
            artwork.groups.extend(drawing.groups(state.world(), &panel.grown));
        }
        let visible = artwork.groups.iter().filter(|group| !group.hidden);
        let elements: usize = visible.map(|group| group.items.len()).sum();
        if elements == 0 {
            return Err(Error::new(
                "nothing-fits",
                "Nothing grows in the shape",
                "Make the shape larger or the pattern smaller, or mark seeds where there is room",
            ));
        }
        artwork.counts.insert("elements".into(), elements as f64);
        artwork.groups = draw::merged(artwork.groups);
        Ok(artwork)
    }

    /// Grows in a section of a container; `None` if there is no room.
    fn panel(
        &self,
        start: &Start,
        section: Section,
        rng: &mut Rng,
        progress: &mut dyn Progress,
    ) -> Result<Option<Panel>, Error> {
        let (params, index) = (start.params, start.index);
        let mut rules = self.rules(start)?;
        progress.step("space", 0.0);
        let Some(region) = start.region(&section) else { return Ok(None) };
        let frame = start.shapes.frame(index).scale_from_origin(1.0 / start.unit);
        let bounds = match (section.domain, section.symmetry.extent) {
            (Some(domain), _) => domain,
            (None, Extent::Panel) => region.bounds(),
            (None, Extent::Band | Extent::Plane) => frame,
        };
        let cell = CELL.max((bounds.area() / MOST_CELLS).sqrt());
        let region = (!matches!(section.symmetry.extent, Extent::Plane)).then_some(region);
        let images = section.symmetry.images(bounds)?;
        let space = Room::new(region.as_ref(), bounds, cell, &images);
        let mut world = World::new(rules.kinds(), space, region, bounds);
        world.set_images(images);
        world.section = section.name;
        world.most = params.max_elements;
        let stems = start.stems();
        let stem_kind = stem_kind(&world).filter(|_| !stems.is_empty());
        let seeds = start.seeds(&world, stem_kind.is_none());
        let shared = rules.start(State::new(world, rng.fork(), start.targets()))?;
        let placed = plant(&rules, &shared, &seeds, stem_kind.map(|kind| (kind, &stems[..])));
        let settings = Settings {
            reach: params.reach * rules.reach(),
            smallest: params.smallest.max(rules.smallest()).max(cell),
            debug: params.debug,
        };
        let (sprouted, is_in_time) = growth::sprout(&mut rules, &shared, placed, progress)?;
        let mut grown = growth::grow(&mut rules, &shared, &settings, progress)?;
        grown.steps += sprouted;
        grown.complete &= is_in_time;
        // Nothing grows here any more, and of many containers it would be most of the memory.
        shared.borrow_mut().world().space = Room::none(cell);
        Ok(Some(Panel {
            index,
            rules,
            shared,
            grown,
            unit: start.unit,
            outline: start.outline(&section),
            section,
        }))
    }

    /// The rules of a container.
    ///
    /// Errors: there are none of this name; they cannot be read; a look that calls for artwork that does
    /// not exist.
    fn rules(&self, start: &Start) -> Result<Rules, Error> {
        let text = rule_text(&start.params.rules, start.scene).map_err(|error| {
            let container = &start.scene.containers[start.index];
            let is_own = container.overrides.contains_key("rules");
            if is_own { error.at(container.source.at) } else { error }
        })?;
        let rules = Rules::read(text)?;
        match self.arts.missing(rules.looks()) {
            None => Ok(rules),
            Some((look, known)) => Err(rules.error(
                look.at,
                format!("no artwork is called '{}'", look.art),
                format!("Use {known}; what you draw for a type needs no art"),
            )),
        }
    }
}

/// The parameters of each container.
fn overridden(params: &Params, scene: &Scene) -> Result<Vec<Params>, Error> {
    let own = |container: &rinceau_format::Container| {
        let overrides = container.overrides.iter().map(|(name, value)| (name.as_str(), value.as_str()));
        params.overridden(overrides).map_err(|error| error.at(container.source.at))
    };
    scene.containers.iter().map(own).collect()
}
