//! The growing ornament: its elements, where they are, and what may join them (000 4.1, 4.2).

mod overlap;

use super::index::{Index, Placed};
use super::piece::{Kind, Piece, Proxy};
use super::room::Room;
use super::space::Circle;
use crate::geom::region::Region;
use kurbo::{Affine, Point, Rect};
use rhai::Dynamic;

/// No element.
pub const NONE: u32 = u32::MAX;

/// What a rule file says of a type of element (checklist W-067 to W-070).
#[derive(Clone, Debug)]
pub struct ElementKind {
    /// Its name.
    pub name: String,
    /// The shapes that stand for it.
    pub proxies: Vec<Kind>,
    /// Its user fields and what they start with.
    pub fields: Vec<(String, Dynamic)>,
    /// True if it may lie over others.
    pub overlaps: bool,
}

/// An element in the tree (checklist W-071).
#[derive(Clone, Debug)]
pub struct Element {
    /// No other element ever has the same.
    pub serial: u32,
    /// Index of its type.
    pub kind: usize,
    /// What it grew from.
    pub parent: u32,
    /// What has grown from it.
    pub children: Vec<u32>,
    /// Nothing grows from it any more.
    pub sterile: bool,
    /// Which application of a rule made it.
    pub firing: u32,
    /// Steps from a seed.
    pub generation: u32,
    /// User fields, in the order in which they are declared.
    pub fields: Vec<Dynamic>,
    /// Its proxies; `None` where none was set.
    pub proxies: Vec<Option<Proxy>>,
}

/// What grows and where.
#[derive(Debug)]
pub(super) struct World {
    pub kinds: Vec<ElementKind>,
    /// Placed ones first, then those that a rule works on.
    pub elements: Vec<Element>,
    pub placed: usize,
    /// What the rule has declared as its children with `new_child`, beside the static ones.
    pub children: Vec<u32>,
    pub space: Room,
    index: Index,
    /// Where ornament may be; `None` where it repeats all over the plane.
    pub region: Option<Region>,
    pub bounds: Rect,
    /// What rules call the section of the container that this is.
    pub section: &'static str,
    /// The symmetries of the ornament; the first changes nothing.
    images: Vec<Affine>,
    firing: u32,
    serial: u32,
    /// Elements at most; `is_full` once there is no room for more.
    pub most: usize,
    pub is_full: bool,
    /// Corners of polygons that the rule at work has set.
    pub corners: usize,
    /// Why children were not placed: unset or without sense, outside, over others.
    pub refused: [usize; 3],
    /// How often the exclude list was cleared since something was placed.
    pub clearings: usize,
    /// Distance that chords keep to curves.
    tolerance: f64,
}

/// An element near an empty circle, and the circle as its image sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub element: u32,
    pub goal: Circle,
}

impl World {
    pub fn new(kinds: Vec<ElementKind>, space: Room, region: Option<Region>, bounds: Rect) -> Self {
        // About as large as what usually grows.
        const SIDE: f64 = 12.0;
        let side = SIDE * space.cell();
        World {
            kinds,
            elements: Vec::new(),
            placed: 0,
            children: Vec::new(),
            index: Index::new(bounds, side),
            tolerance: 0.1 * space.cell(),
            space,
            region,
            bounds,
            section: "whole",
            images: vec![Affine::IDENTITY],
            firing: 0,
            serial: 0,
            most: usize::MAX,
            is_full: false,
            corners: 0,
            clearings: 0,
            refused: [0; 3],
        }
    }

    /// Grows all at once what these symmetries map onto each other; the first is the identity.
    pub fn set_images(&mut self, images: Vec<Affine>) {
        self.images = images;
    }

    pub fn images(&self) -> &[Affine] {
        &self.images
    }

    /// A fresh element that is not placed yet.
    pub fn fresh(&mut self, kind: usize, parent: u32) -> u32 {
        let of = &self.kinds[kind];
        let generation = self.elements.get(parent as usize).map_or(0, |parent| parent.generation + 1);
        self.serial += 1;
        self.elements.push(Element {
            serial: self.serial,
            kind,
            parent,
            children: Vec::new(),
            sterile: false,
            firing: self.firing,
            generation,
            fields: of.fields.iter().map(|(_, value)| value.clone()).collect(),
            proxies: vec![None; of.proxies.len()],
        });
        self.elements.len() as u32 - 1
    }

    /// Forgets what has not been placed.
    pub fn discard(&mut self) {
        self.elements.truncate(self.placed);
        self.children.clear();
        self.corners = 0;
    }

    /// Where the element of this number is, if it still is. Numbers grow with the place.
    pub fn find(&self, serial: u32) -> Option<usize> {
        self.elements.binary_search_by_key(&serial, |element| element.serial).ok()
    }

    fn refuse(&mut self, why: usize) -> bool {
        self.refused[why] += 1;
        self.discard();
        false
    }

    fn pieces(&self, element: u32) -> Vec<Piece> {
        let proxies = self.elements[element as usize].proxies.iter().flatten();
        proxies.flat_map(|proxy| proxy.pieces(self.tolerance)).collect()
    }

    /// Places the fresh elements that are children: the static ones and those that a rule declared.
    /// False, and nothing is placed, if one of them is outside or in the way of another.
    pub fn commit(&mut self, parent: u32, statics: usize) -> bool {
        let first = self.placed as u32;
        let mut chosen: Vec<u32> = (first..first + statics as u32).collect();
        for &child in &self.children {
            if !chosen.contains(&child) {
                chosen.push(child);
            }
        }
        // In the order in which they were made, which is that of their numbers.
        chosen.sort_unstable();
        if self.placed + chosen.len() > self.most {
            self.is_full = true;
            self.discard();
            return false;
        }
        let is_sane =
            |&child: &u32| self.elements[child as usize].proxies.iter().flatten().all(Proxy::is_sane);
        if !chosen.iter().all(is_sane) {
            return self.refuse(0);
        }
        let all: Vec<Vec<Piece>> = chosen.iter().map(|&child| self.pieces(child)).collect();
        if all.iter().all(Vec::is_empty) {
            return self.refuse(0);
        }
        for (&child, pieces) in chosen.iter().zip(&all) {
            let kind = self.elements[child as usize].kind;
            if !pieces.iter().all(|piece| self.is_inside(piece)) {
                return self.refuse(1);
            }
            if !self.kinds[kind].overlaps && self.overlaps(pieces, parent, true) {
                return self.refuse(2);
            }
        }
        if self.meets_itself(&all, parent) {
            return self.refuse(2);
        }
        let mut kept: Vec<Element> = Vec::with_capacity(chosen.len());
        for &child in &chosen {
            kept.push(self.elements[child as usize].clone());
        }
        self.elements.truncate(self.placed);
        self.elements.extend(kept);
        for (i, pieces) in all.into_iter().enumerate() {
            self.stamp(pieces, first + i as u32);
        }
        if let Some(parent) = self.elements.get_mut(parent as usize) {
            parent.children.extend(first..first + chosen.len() as u32);
        }
        self.placed = self.elements.len();
        self.children.clear();
        self.corners = 0;
        self.clearings = 0;
        self.firing += 1;
        true
    }

    /// Enters the pieces of an element and all their images. Where room is looked for, lines may be
    /// coarser than where it is tested.
    fn stamp(&mut self, pieces: Vec<Piece>, element: u32) {
        let coarse: Vec<Piece> = self.elements[element as usize]
            .proxies
            .iter()
            .flatten()
            .flat_map(|proxy| proxy.pieces(0.5 * self.space.cell()))
            .collect();
        let is_only = coarse.len() == 1 && self.images.len() == 1;
        let around = self.bounds.inflate(0.6 * self.bounds.width(), 0.6 * self.bounds.height());
        for (image, &by) in self.images.iter().enumerate() {
            for piece in &coarse {
                let piece = if image == 0 { piece.clone() } else { piece.moved(by) };
                if image == 0 || piece.bounds().overlaps(around) {
                    self.space.add(&piece, element, is_only);
                }
            }
            for piece in &pieces {
                let piece = if image == 0 { piece.clone() } else { piece.moved(by) };
                if image > 0 && !piece.bounds().overlaps(around) {
                    continue;
                }
                self.index.add(Placed { piece, element, image: image as u16 });
            }
        }
    }

    /// True if a piece lies in the region, which has the symmetries of the ornament.
    pub fn is_inside(&self, piece: &Piece) -> bool {
        let Some(region) = &self.region else { return true };
        let crosses = |a: Point, b: Point| {
            let mut is_crossed = false;
            region.edges().visit(a, b, 0.0, |p, q, _| {
                is_crossed = piece.meets(p, q);
                !is_crossed
            });
            is_crossed
        };
        region.contains(piece.sample())
            && match piece {
                Piece::Disc(center, radius) => region.distance(*center, *radius) >= *radius - 1e-9,
                Piece::Segment(a, b) => !crosses(*a, *b),
                Piece::Area(_) => {
                    let bounds = piece.bounds();
                    let is_around = |hole: &Vec<Point>| piece.distance(hole[0]) < 0.0;
                    !crosses(bounds.origin(), Point::new(bounds.x1, bounds.y1))
                        && !region.contours().iter().any(is_around)
                }
            }
    }

    /// True if all of a proxy lies in the region.
    pub fn has_inside(&self, proxy: &Proxy) -> bool {
        proxy.is_sane() && proxy.pieces(self.tolerance).iter().all(|piece| self.is_inside(piece))
    }

    /// Distance to the boundary, negative outside, or to where the images of a place would meet it.
    pub fn wall_distance(&self, p: Point) -> f64 {
        let reach = self.bounds.size().max_side();
        let wall = self.region.as_ref().map_or(reach, |region| match region.contains(p) {
            true => region.distance(p, reach),
            false => -region.distance(p, reach),
        });
        self.images[1..].iter().map(|&by| 0.5 * p.distance(by * p)).fold(wall, f64::min)
    }

    /// Elements within `reach` of a circle from which something may grow, nearest first.
    pub fn candidates(&mut self, circle: Circle, reach: f64, grows: &[bool]) -> Vec<Candidate> {
        let within = circle.radius + reach;
        let around = Rect::from_center_size(circle.center, (2.0 * within, 2.0 * within));
        let mut found: Vec<(f64, u32, u16)> = Vec::new();
        let elements = &self.elements;
        self.index.near(around, |placed| {
            let element = &elements[placed.element as usize];
            if element.sterile || !grows[element.kind] {
                return true;
            }
            let distance = placed.piece.distance(circle.center);
            if distance <= within {
                match found.iter_mut().find(|known| known.1 == placed.element && known.2 == placed.image) {
                    Some(known) => known.0 = known.0.min(distance),
                    None => found.push((distance, placed.element, placed.image)),
                }
            }
            true
        });
        found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
        found
            .into_iter()
            .map(|(_, element, image)| {
                let back = self.images[image as usize].inverse();
                let goal = Circle { center: back * circle.center, ..circle };
                Candidate { element, goal }
            })
            .collect()
    }

    /// The nearest element of a type, if there is one within `reach`.
    pub fn nearest(&mut self, kind: Option<usize>, at: Point, reach: f64) -> Option<(u32, f64)> {
        let mut best: Option<(u32, f64)> = None;
        let around = Rect::from_center_size(at, (2.0 * reach, 2.0 * reach));
        let elements = &self.elements;
        self.index.near(around, |placed| {
            if kind.is_none_or(|kind| elements[placed.element as usize].kind == kind) {
                let distance = placed.piece.distance(at);
                let is_nearer = best.is_none_or(|(element, least)| {
                    distance < least || distance == least && placed.element < element
                });
                if distance <= reach && is_nearer {
                    best = Some((placed.element, distance));
                }
            }
            true
        });
        best
    }

    /// Room along a curve: the least distance from it to the boundary and to what is placed, `reach`
    /// at most. Not counting an element and its kin.
    pub fn clearance(&mut self, proxy: &Proxy, without: u32, reach: f64) -> f64 {
        let mut least = reach;
        let mut kin = self.made_with(without);
        kin.push(without);
        for piece in proxy.pieces(self.tolerance) {
            if !self.is_inside(&piece) {
                return 0.0;
            }
            let mut places = Vec::new();
            piece.along(self.space.cell(), |p| places.push(p));
            if let Some(region) = &self.region {
                least = places.iter().fold(least, |least, &p| least.min(region.distance(p, reach)));
            }
            self.index.near(piece.bounds().inflate(reach, reach), |other| {
                if !kin.contains(&other.element) {
                    least = least.min(piece.apart(&other.piece));
                }
                true
            });
        }
        least.max(0.0)
    }
}
