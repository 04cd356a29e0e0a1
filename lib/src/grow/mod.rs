//! Growth by rules: adaptive clip art.
//!
//! Michael T. Wong, Douglas E. Zongker, David H. Salesin: *Computer-Generated Floral Ornament*,
//! SIGGRAPH 1998.
//!
//! 1. Read a rule file (000 4.2, Appendix A): `rules`.
//! 2. Measure each container, and start from seeds (4.1; W-073, W-103): `space`, `symmetry`.
//! 3. Again and again find the largest empty circle that touches the ornament, and let the elements
//!    near it try their rules (4.1; W-090 to W-104): `growth`, `world`.
//! 4. Draw the elements, apart from all that (3.2; W-064, W-084 to W-086): `draw`.
//!
//! Departures, with their reasons where they happen: exact distances instead of a buffer and inflated
//! circles (`space`); children that would leave the shape or lie over others fail, whatever their
//! rule says (`world`); looks are declared, not programmed (`draw`), since an artist can choose
//! one. Taxonomies (W-004, W-005) and manifolds (W-132) are not of this plane.

mod draw;
mod growth;
mod index;
mod params;
mod piece;
mod rules;
mod space;
mod symmetry;
mod world;

pub use params::{PATTERNS, Params};
pub use rules::RuleText;
pub use space::Circle;

use crate::geom::boolean::Contour;
use crate::geom::region::Region;
use crate::progress::Progress;
use crate::rng::Rng;
use crate::shapes::Shapes;
use draw::{Arts, Drawing};
use growth::{Grown, Settings};
use kurbo::{Affine, CubicBez, ParamCurve, PathSeg, Point, Rect, Shape, Vec2};
use piece::{Kind, Proxy};
use rinceau_format::{Artwork, Error, Scene};
use rules::{Applied, Rules, State};
use space::Room;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::rc::Rc;
use symmetry::{Extent, Symmetry};
use world::World;

/// Cells of one container at most; a larger one has coarser cells.
const MOST_CELLS: f64 = 3e6;
/// Side of a cell in units of the rules: about a tenth of the radius of a dot of the paper's.
const CELL: f64 = 0.28;
/// A shape has so many units along the side of a square as large as it.
const UNITS: f64 = 100.0;
/// Seeds of one container at most.
const MOST_SEEDS: usize = 1000;

/// The built-in rule files by name.
const BUILT_IN: &[(&str, &str)] = &[
    ("dots", include_str!("../../../samples/rules/dots.rules")),
    ("flower", include_str!("../../../samples/rules/flower.rules")),
    ("spiral", include_str!("../../../samples/rules/spiral.rules")),
    ("vines", include_str!("../../../samples/rules/vines.rules")),
    ("vase", include_str!("../../../samples/rules/vase.rules")),
    ("willow", include_str!("../../../samples/rules/willow.rules")),
    ("willow-planned", include_str!("../../../samples/rules/willow-planned.rules")),
];

/// Grows ornament in every container of a scene.
///
/// Errors: nothing to fill; rules that cannot be read or that fail; nothing that grows.
pub fn generate(
    params: &Params,
    scene: &Scene,
    rng: &mut Rng,
    progress: &mut dyn Progress,
) -> Result<Artwork, Error> {
    progress.step("prepare", 0.0);
    let own: Vec<Params> = scene
        .containers
        .iter()
        .map(|container| {
            let overrides = container.overrides.iter().map(|(name, value)| (name.as_str(), value.as_str()));
            params.overridden(overrides).map_err(|error| error.at(container.source.at))
        })
        .collect::<Result<_, Error>>()?;
    let shapes = Shapes::new(scene, &[])?;
    let arts = Arts::new(scene)?;
    let mut artwork = Artwork {
        complete: true,
        warnings: scene.warnings.clone(),
        decimals: shapes.decimals(),
        ..Artwork::default()
    };
    let mut counts: BTreeMap<String, f64> = BTreeMap::new();
    for (index, own) in own.iter().enumerate() {
        let container = &scene.containers[index];
        let one = One { scene, shapes: &shapes, index, params: own, arts: &arts };
        let Some(grown) = one.grow(&mut rng.fork(), &mut artwork, progress)? else {
            artwork.warnings.push(format!(
                "{}: the container '{}' has no room for anything to grow",
                container.source.at, container.source.id
            ));
            continue;
        };
        artwork.complete &= grown.complete;
        if grown.steps == 0 && grown.complete {
            artwork.warnings.push(format!(
                "{}: nothing of the pattern grows in '{}': {}",
                container.source.at,
                container.source.id,
                grown.reasons()
            ));
        }
        *counts.entry("steps".into()).or_insert(0.0) += grown.steps as f64;
        *counts.entry("failed".into()).or_insert(0.0) += grown.failed as f64;
        if grown.full {
            artwork.complete = false;
            artwork.warnings.push(format!(
                "{}: the growth in '{}' ended because there may be {} elements at most",
                container.source.at, container.source.id, own.max_elements
            ));
        }
    }
    progress.step("artwork", 0.0);
    let elements: usize =
        artwork.groups.iter().filter(|group| !group.hidden).map(|group| group.items.len()).sum();
    counts.insert("elements".into(), elements as f64);
    artwork.counts = counts;
    if elements == 0 {
        return Err(Error::new(
            "nothing-fits",
            "Nothing grows in the shape",
            "Make the shape larger or the pattern smaller, or mark seeds where there is room",
        ));
    }
    artwork.groups = draw::merged(artwork.groups);
    Ok(artwork)
}

/// Finds a rule file: one that the scene carries, or one that is built in.
///
/// Errors: there is none of this name.
pub fn rule_text(name: &str, scene: &Scene) -> Result<RuleText, Error> {
    let built_in = |name: &str| {
        let found = BUILT_IN.iter().find(|(known, _)| *known == name);
        found.map(|&(name, text)| RuleText { name: name.into(), text: text.into() })
    };
    let own = scene.rules.iter().find(|rules| rules.name == name);
    let own = own.or(scene.rules.first().filter(|_| name == "auto"));
    if let Some(rules) = own {
        return Ok(RuleText { name: rules.name.clone(), text: rules.text.clone() });
    }
    built_in(if name == "auto" { "spiral" } else { name }).ok_or_else(|| {
        let known: Vec<&str> = PATTERNS.iter().map(|(name, _)| *name).collect();
        Error::new(
            "unknown-rules",
            format!("There are no growth rules called '{name}'"),
            format!("Use one of {}, or a file whose name ends in .rules", known.join(", ")),
        )
    })
}

/// One container of a run.
struct One<'a> {
    scene: &'a Scene,
    shapes: &'a Shapes,
    index: usize,
    params: &'a Params,
    arts: &'a Arts,
}

impl One<'_> {
    fn grow(
        &self,
        rng: &mut Rng,
        artwork: &mut Artwork,
        progress: &mut dyn Progress,
    ) -> Result<Option<Grown>, Error> {
        let params = self.params;
        let text = rule_text(&params.rules, self.scene).map_err(|error| {
            let container = &self.scene.containers[self.index];
            let is_own = container.overrides.contains_key("rules");
            if is_own { error.at(container.source.at) } else { error }
        })?;
        let mut rules = Rules::read(text)?;
        if let Some((look, known)) = self.drawing(&rules, 1.0).missing() {
            let sentence = format!("no artwork is called '{}'", look.art);
            return Err(rules.error(
                look.at,
                sentence,
                format!("Use {known}; what you draw for a type needs no art"),
            ));
        }
        let area = self.shapes.areas[self.index];
        let px = self.scene.px_per_unit;
        let mut unit = params.rule_unit.to_user(px);
        if unit == 0.0 {
            unit = area.sqrt() / UNITS;
        }
        if !(unit > 0.0 && area / (unit * unit) < 1e8) {
            return Ok(None);
        }
        progress.step("space", 0.0);
        let user_bounds = bounds_of(&self.shapes.containers[self.index]);
        let symmetry = Symmetry::new(&params.symmetry, scaled(user_bounds, 1.0 / unit), params.repeats);
        artwork.warnings.extend(symmetry.note.clone());
        let Some(region) = self.region(unit, &symmetry) else { return Ok(None) };
        let bounds = match symmetry.extent {
            Extent::Panel => region.bounds(),
            Extent::Band | Extent::Plane => scaled(user_bounds, 1.0 / unit),
        };
        let cell = CELL.max((bounds.area() / MOST_CELLS).sqrt());
        let region = (!matches!(symmetry.extent, Extent::Plane)).then_some(region);
        let images = symmetry.images(bounds)?;
        let space = Room::new(region.as_ref(), bounds, cell, &images);
        let mut world = World::new(rules.kinds(), space, region, bounds);
        world.set_images(images);
        world.most = params.max_elements;
        let stems = self.stems(unit);
        let stem_kind = stem_kind(&world).filter(|_| !stems.is_empty());
        let seeds = self.seeds(&world, unit, stem_kind.is_none());
        let shared = rules.start(State::new(world, rng.fork(), self.targets(unit)))?;
        let placed = plant(&rules, &shared, &seeds, stem_kind.map(|kind| (kind, &stems[..])));
        let (mut sprouted, mut is_late) = (0, false);
        for seed in 0..placed {
            match growth::sprout(&mut rules, &shared, seed as u32, progress)? {
                Applied::Placed => sprouted += 1,
                Applied::Failed => {}
                Applied::Late => is_late = true,
            }
            if is_late {
                break;
            }
        }
        let settings = Settings {
            reach: params.reach * rules.reach(),
            smallest: params.smallest.max(rules.smallest()).max(cell),
            debug: params.debug,
        };
        let mut grown = growth::grow(&mut rules, &shared, &settings, progress)?;
        grown.steps += sprouted;
        grown.complete &= !is_late;
        if params.debug > 0 && grown.view.is_none() {
            artwork
                .warnings
                .push(format!("Growth ended before step {}: there is nothing to show of it", params.debug));
        }
        progress.step("draw", 0.0);
        let mut state = shared.borrow_mut();
        let drawing = self.drawing(&rules, unit);
        artwork.groups.extend(drawing.groups(state.world(), &grown)?);
        Ok(Some(grown))
    }

    fn drawing<'d>(&'d self, rules: &'d Rules, unit: f64) -> Drawing<'d> {
        let fill = self.scene.containers[self.index].fill.as_deref();
        Drawing { looks: rules.looks(), params: self.params, unit, fill, arts: self.arts }
    }

    /// Where ornament may be, in units of the rules.
    fn region(&self, unit: f64, symmetry: &Symmetry) -> Option<Region> {
        let px = self.scene.px_per_unit;
        let edge = match self.params.edge.to_user(px) {
            0.0 => 0.5 * unit,
            edge => edge,
        };
        let gap = match self.params.gap.to_user(px) {
            0.0 => unit,
            gap => gap,
        };
        let region = match symmetry.extent {
            Extent::Band => self.shapes.free_repeated(self.index, gap, edge),
            _ => self.shapes.free(self.index, gap, edge),
        }?;
        let small: Vec<Contour> = region
            .contours()
            .iter()
            .map(|contour| contour.iter().map(|p| (p.to_vec2() / unit).to_point()).collect())
            .collect();
        match symmetry.extent {
            Extent::Plane => Region::new(small),
            _ => Region::new(symmetry.shared(&small)),
        }
    }

    /// Where growth starts, in units of the rules: marked seeds, or as the artist wishes if nothing else
    /// is there to grow from.
    fn seeds(&self, world: &World, unit: f64, by_itself: bool) -> Vec<Point> {
        let seeds = self.scene.seeds.iter().map(|seed| (seed.at.to_vec2() / unit).to_point());
        let is_inside = |p: &Point| world.space.distance(*p).is_some_and(|distance| distance > 0.0);
        let marked: Vec<Point> = seeds.filter(is_inside).take(MOST_SEEDS).collect();
        if !marked.is_empty() || !by_itself {
            return marked;
        }
        // Away from its own images, and from the boundary.
        let widest = || match world.images() {
            [_] => world.space.widest(),
            _ => world.space.widest_by(|p| world.wall_distance(p)),
        };
        match self.params.start.as_str() {
            "lower-left" => {
                let bounds = world.bounds;
                let towards = Vec2::new(-bounds.height().max(1e-9), bounds.width().max(1e-9));
                world.space.farthest(towards).into_iter().collect()
            }
            "corners" => {
                let corners = world.region.as_ref().map(rules::corners).unwrap_or_default();
                let inner = corners.into_iter().map(|(at, into)| at + 2.0 * into).filter(|p| is_inside(p));
                let inner: Vec<Point> = inner.take(MOST_SEEDS).collect();
                if inner.is_empty() { widest().into_iter().collect() } else { inner }
            }
            _ => widest().into_iter().collect(),
        }
    }

    /// Drawn stems, piece by piece.
    fn stems(&self, unit: f64) -> Vec<Vec<CubicBez>> {
        let shrink = Affine::scale(1.0 / unit);
        let stems = self.scene.stems.iter().chain(self.scene.guides.iter().filter(|guide| !guide.marked));
        stems
            .map(|stem| {
                (shrink * stem.path.clone()).segments().map(|segment| PathSeg::to_cubic(&segment)).collect()
            })
            .collect()
    }

    /// What is fixed: places to grow to.
    fn targets(&self, unit: f64) -> Vec<(String, Circle)> {
        let target = |fixed: &rinceau_format::Fixed| {
            let boxes = fixed.parts.iter().map(|part| (part.transform * part.path.clone()).bounding_box());
            let bounds = boxes.reduce(|a, b| a.union(b))?;
            let center = (bounds.center().to_vec2() / unit).to_point();
            let radius = bounds.size().to_vec2().hypot() / (2.0 * 2.0_f64.sqrt() * unit);
            Some((fixed.source.label.clone(), Circle { center, radius }))
        };
        self.scene.fixed.iter().filter_map(target).collect()
    }
}

/// The type of element that drawn stems are: one called so, or the first that is a curve.
fn stem_kind(world: &World) -> Option<usize> {
    let is_stem = |kind: &&world::ElementKind| kind.proxies.first() == Some(&Kind::Bezier);
    let named = world.kinds.iter().position(|kind| kind.name == "stem" && is_stem(&kind));
    named.or_else(|| world.kinds.iter().position(|kind| is_stem(&kind)))
}

/// Places seeds, and what of drawn stems lies inside; returns how many seeds.
fn plant(
    rules: &Rules,
    shared: &Rc<RefCell<State>>,
    seeds: &[Point],
    stems: Option<(usize, &[Vec<CubicBez>])>,
) -> usize {
    /// Pieces of a curve that crosses the outline.
    const PARTS: u32 = 16;
    let mut state = shared.borrow_mut();
    let world = state.world();
    let mut placed = 0;
    for &seed in seeds {
        let element = world.fresh(rules.seed(), world::NONE);
        world.elements[element as usize].proxies[0] = Some(Proxy::Point(seed));
        placed += usize::from(world.commit(world::NONE, 1));
    }
    let Some((kind, stems)) = stems else { return placed };
    for &curve in stems.iter().flatten() {
        let parts = (0..PARTS).map(|i| {
            let at = |i: u32| f64::from(i) / f64::from(PARTS);
            curve.subsegment(at(i)..at(i + 1))
        });
        let is_inside = |world: &World, curve| world.has_inside(&Proxy::Bezier(curve));
        let curves = if is_inside(world, curve) { vec![curve] } else { parts.collect() };
        for curve in curves {
            if is_inside(world, curve) {
                let element = world.fresh(kind, world::NONE);
                world.elements[element as usize].proxies[0] = Some(Proxy::Bezier(curve));
                world.children.push(element);
            }
        }
    }
    world.commit(world::NONE, 0);
    placed
}

fn bounds_of(shape: &[Contour]) -> Rect {
    let mut points = shape.iter().flatten();
    let Some(&first) = points.next() else { return Rect::ZERO };
    points.fold(Rect::from_points(first, first), |rect, &p| rect.union_pt(p))
}

fn scaled(rect: Rect, by: f64) -> Rect {
    Rect::new(rect.x0 * by, rect.y0 * by, rect.x1 * by, rect.y1 * by)
}
