//! Where growth may be and what it starts from (000 4.1; W-073, W-103), in units of the rules.

use super::Params;
use super::piece::{Kind, Proxy};
use super::rules::{Rules, Shared, corners};
use super::section::Section;
use super::space::Circle;
use super::symmetry::Extent;
use super::world::{self, World};
use crate::geom::boolean::{self, Contour};
use crate::geom::region::Region;
use crate::shapes::Shapes;
use kurbo::{Affine, CubicBez, ParamCurve, PathSeg, Point, Rect, Shape, Vec2};
use rinceau_format::Scene;

/// Seeds of one container at most.
const MOST_SEEDS: usize = 1000;

/// What the artist has given to start from.
pub(super) struct Start<'a> {
    pub scene: &'a Scene,
    pub shapes: &'a Shapes,
    /// Of the container.
    pub index: usize,
    pub params: &'a Params,
    /// Length of a unit of the rules.
    pub unit: f64,
}

impl Start<'_> {
    /// Where proxies may be in a section, wherever it has a place; `None` if there is no room.
    pub fn region(&self, section: &Section) -> Option<Region> {
        let px = self.scene.px_per_unit;
        let edge = match self.params.edge.to_user(px) {
            0.0 => 0.5 * self.unit,
            edge => edge,
        };
        let gap = match self.params.gap.to_user(px) {
            0.0 => self.unit,
            gap => gap,
        };
        self.shared(section, section.domain, gap, edge)
    }

    /// What nothing that is drawn may leave; `None` where nothing ends.
    pub fn outline(&self, section: &Section) -> Option<Region> {
        // What is drawn may reach from a section into the next.
        let around = |domain: Rect| domain.inflate(domain.width(), domain.height());
        match section.symmetry.extent {
            Extent::Plane => None,
            _ => self.shared(section, section.domain.map(around), 0.0, 0.0),
        }
    }

    /// What all places of a section have in common, its images included, without what is so near to the
    /// outline or to something fixed.
    fn shared(&self, section: &Section, domain: Option<Rect>, gap: f64, edge: f64) -> Option<Region> {
        let extent = section.symmetry.extent;
        let free = match (extent, domain) {
            (Extent::Band, None) => self.shapes.free_repeated(self.index, gap, edge),
            _ => self.shapes.free(self.index, gap, edge),
        }?;
        let free = self.in_units(free.contours());
        let Some(domain) = domain else {
            return match extent {
                Extent::Plane => Region::new(free),
                _ => Region::new(section.symmetry.shared(&free)),
            };
        };
        let (low, high) = (domain.origin(), Point::new(domain.x1, domain.y1));
        let mut shared = vec![vec![low, Point::new(high.x, low.y), high, Point::new(low.x, high.y)]];
        for place in &section.places {
            let back = place.inverse();
            let moved: Vec<Contour> =
                free.iter().map(|contour| contour.iter().map(|&p| back * p).collect()).collect();
            shared = boolean::intersection(&shared, &boolean::simplified(&moved, true));
        }
        Region::new(section.symmetry.shared(&shared))
    }

    /// The container in units of the rules.
    pub fn shape(&self) -> Vec<Contour> {
        self.in_units(&self.shapes.containers[self.index])
    }

    fn in_units(&self, shape: &[Contour]) -> Vec<Contour> {
        let small = |p: &Point| (p.to_vec2() / self.unit).to_point();
        shape.iter().map(|contour| contour.iter().map(small).collect()).collect()
    }

    /// Where growth starts: marked seeds, or as the artist wishes if nothing else
    /// is there to grow from.
    pub fn seeds(&self, world: &World, by_itself: bool) -> Vec<Point> {
        let unit = self.unit;
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
                let corners = world.region.as_ref().map(corners).unwrap_or_default();
                let inner = corners.into_iter().map(|(at, into)| at + 2.0 * into).filter(|p| is_inside(p));
                let inner: Vec<Point> = inner.take(MOST_SEEDS).collect();
                if inner.is_empty() { widest().into_iter().collect() } else { inner }
            }
            _ => match &world.region {
                // One in each part of the shape, as in each letter of a word.
                Some(region) if world.images().len() == 1 => {
                    let mut parts = boolean::parts(region.contours().to_vec());
                    parts.reverse();
                    if parts.len() < 2 {
                        return widest().into_iter().collect();
                    }
                    let parts = parts.into_iter().take(MOST_SEEDS).filter_map(Region::new);
                    parts.filter_map(|part| world.space.widest_in(&part)).collect()
                }
                _ => widest().into_iter().collect(),
            },
        }
    }

    /// Drawn stems, piece by piece.
    pub fn stems(&self) -> Vec<Vec<CubicBez>> {
        let shrink = Affine::scale(1.0 / self.unit);
        let stems = self.scene.stems.iter().chain(self.scene.guides.iter().filter(|guide| !guide.marked));
        stems
            .map(|stem| {
                (shrink * stem.path.clone()).segments().map(|segment| PathSeg::to_cubic(&segment)).collect()
            })
            .collect()
    }

    /// What is fixed: places to grow to.
    pub fn targets(&self) -> Vec<(String, Circle)> {
        let unit = self.unit;
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
pub(super) fn stem_kind(world: &World) -> Option<usize> {
    let is_stem = |kind: &&world::ElementKind| kind.proxies.first() == Some(&Kind::Bezier);
    let named = world.kinds.iter().position(|kind| kind.name == "stem" && is_stem(&kind));
    named.or_else(|| world.kinds.iter().position(|kind| is_stem(&kind)))
}

/// Places seeds, and what of drawn stems lies inside; returns how many seeds.
pub(super) fn plant(
    rules: &Rules,
    shared: &Shared,
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
