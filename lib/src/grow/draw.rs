//! From proxies to pictures (000 3.2, 4; checklist W-064, W-084 to W-086, W-117): artwork bent along
//! lines as skeletal strokes, or laid on discs; growth does not know of it.

mod art;
mod inside;
mod strand;

use super::growth::{Grown, View};
use super::params::Params;
use super::piece::Proxy;
use super::rules::Look;
use super::section::Section;
use super::world::{Element, World};
use crate::geom::region::Region;
use crate::palette::palette;
use art::Art;
pub(super) use art::Arts;
use kurbo::{Affine, BezPath, Point, Rect, Shape};
use rinceau_format::{Group, Item, Part, Style};
use strand::{How, Strand, strands};

/// Width of an outline in units of the rules.
const OUTLINE: f64 = 0.3;

/// How the elements of one container are drawn.
pub(super) struct Drawing<'a> {
    pub looks: &'a [Look],
    pub params: &'a Params,
    /// Length of a unit of the rules.
    pub unit: f64,
    /// Of the container, to choose colours by.
    pub fill: Option<&'a str>,
    pub arts: &'a Arts,
    pub section: &'a Section,
    /// What is drawn stays in it; `None` where the ornament repeats all over the plane.
    pub outline: Option<&'a Region>,
}

impl Drawing<'_> {
    /// Sublayers for an ornament. Artwork that looks call for is known to exist.
    pub fn groups(&self, world: &World, grown: &Grown) -> Vec<Group> {
        let mut elements = Group { name: "elements".into(), ..Group::default() };
        let of_kind = |kind: usize| self.looks.iter().find(|look| look.kind == kind);
        // In the order of the looks; what has none comes first.
        let mut kinds: Vec<usize> = (0..world.kinds.len()).filter(|&kind| of_kind(kind).is_none()).collect();
        kinds.extend(self.looks.iter().map(|look| look.kind));
        kinds.dedup();
        for kind in kinds {
            let name = &world.kinds[kind].name;
            if name == "seed" && of_kind(kind).is_none() {
                continue;
            }
            let plain = Look::plain(0, kind);
            let look = of_kind(kind).unwrap_or(&plain);
            self.kind(world, look, &mut elements);
        }
        let mut groups = vec![elements];
        groups.push(self.proxies(world));
        if let Some(view) = &grown.view {
            groups.push(self.view(world, view));
        }
        groups
    }

    fn kind(&self, world: &World, look: &Look, group: &mut Group) {
        let arts = self.arts;
        let name = world.kinds[look.kind].name.clone();
        let style = self.params.style.as_str();
        let drawn = arts.drawn(&name);
        let largest = self.largest(world, look);
        let places = self.section.all_places();
        let how = match (drawn, style, look.art.as_str()) {
            (_, "outline", _) | (None, _, "outline" | "none") => How::Lines,
            (None, _, "fill") => How::Areas,
            _ => How::Bent,
        };
        for strand in strands(world, look, how) {
            let is_line = strand.disc.is_none();
            let art = match (drawn, style) {
                (Some(art), "drawn") => Some(art),
                (_, "outline") => None,
                (_, "drawn") => match look.art.as_str() {
                    "none" => continue,
                    "outline" | "fill" => None,
                    art => arts.named(art),
                },
                // Another stroke for lines that are one stroke; leaves and blossoms stay.
                (_, style) if is_line && strand.widths.is_none() && (look.join || look.art == "outline") => {
                    arts.named(style)
                }
                _ => match (drawn, look.art.as_str()) {
                    (Some(art), _) => Some(art),
                    (_, "none") => continue,
                    (_, "outline" | "fill") => None,
                    (_, art) => arts.named(art),
                },
            };
            let element = &world.elements[strand.element];
            let colour = self.colour(look, element, largest, world);
            let thick = field(world, element, &look.thick).unwrap_or(1.0).max(0.0);
            let drawn = |share: f64| match art {
                Some(art) => self.bent(&strand, look, art, colour.as_deref(), thick, share),
                None => self.plain(&strand, look, colour.as_deref(), share),
            };
            // What would leave the panel is drawn narrower. Its proxies keep inside.
            let shares = [1.0, 0.7, 0.45, 0.25, 0.1].into_iter().map(drawn);
            let Some(parts) = shares.into_iter().find(|parts| self.is_inside(parts)) else { continue };
            let images = places.as_deref().unwrap_or(world.images());
            // In a special position, on a mirror or an axis, several images are one.
            let near = 1e-6 * world.bounds.width();
            let is_special = |&(center, ..): &(Point, f64, f64)| {
                images[1..].iter().any(|&by| (by * center).distance(center) < near)
            };
            let special = strand.disc.filter(is_special);
            for (number, &image) in images.iter().enumerate() {
                let is_again = special.is_some_and(|(center, ..)| {
                    images[..number].iter().any(|&other| (other * center).distance(image * center) < near)
                });
                if is_again {
                    continue;
                }
                let moved: Vec<Part> = parts.iter().map(|part| self.placed(part, image)).collect();
                let is_all_seen = places.is_some() || world.images().len() == 1;
                if is_all_seen || is_seen(&moved, world.bounds.scale_from_origin(self.unit)) {
                    group.items.push(Item::new(name.clone(), moved));
                }
            }
        }
    }

    fn is_inside(&self, parts: &[Part]) -> bool {
        self.outline.is_none_or(|outline| {
            parts.iter().all(|part| {
                let stroke = part.style.stroke_width().unwrap_or(0.0) / self.unit;
                inside::is_inside(&part.path, 0.5 * stroke, outline)
            })
        })
    }

    /// A part in its place in the drawing.
    fn placed(&self, part: &Part, image: Affine) -> Part {
        let to_user = Affine::scale(self.unit);
        let mut path = part.path.clone();
        path.apply_affine(to_user * image);
        Part { path, transform: Affine::IDENTITY, style: part.style.clone() }
    }

    /// The largest number that colours go by.
    fn largest(&self, world: &World, look: &Look) -> f64 {
        let of_kind = world.elements.iter().filter(|element| element.kind == look.kind);
        of_kind.filter_map(|element| field(world, element, &look.by)).fold(0.0, f64::max)
    }

    fn colour(&self, look: &Look, element: &Element, largest: f64, world: &World) -> Option<String> {
        let value = field(world, element, &look.by)?;
        (look.tone == 0).then(|| rainbow(if largest > 0.0 { value / largest } else { 0.0 }))
    }

    fn tone(&self, look: &Look, shift: usize) -> &'static str {
        palette(&self.params.palette, self.fill)[(look.tone.max(1) - 1 + shift) % 3]
    }

    /// Artwork along a line or on a disc, with this share of its width or size.
    fn bent(
        &self,
        strand: &Strand,
        look: &Look,
        art: &Art,
        colour: Option<&str>,
        thick: f64,
        share: f64,
    ) -> Vec<Part> {
        let paths = match strand.disc {
            Some((center, radius, angle)) => art.round(center, radius * look.size * share, angle),
            None => art.along(&strand.path, look.width * thick, strand.widths.as_deref(), share),
        };
        let painted = |(path, style): (BezPath, &Style)| {
            let mut style = style.scaled(self.unit, 3);
            if art.builtin {
                let tone = match style.get("fill") {
                    Some("#111111") => Some(colour.unwrap_or_else(|| self.tone(look, 0)).to_owned()),
                    Some("#555555") => Some(self.tone(look, 1).to_owned()),
                    Some("#999999") => Some(self.tone(look, 2).to_owned()),
                    Some("#dddddd") => Some("#f3e3bd".to_owned()),
                    _ => None,
                };
                if let Some(tone) = tone {
                    style.set("fill", &tone);
                }
            }
            Part { path, transform: Affine::IDENTITY, style }
        };
        paths.into_iter().map(painted).collect()
    }

    /// The shapes themselves, as lines with this share of their width, or filled.
    fn plain(&self, strand: &Strand, look: &Look, colour: Option<&str>, share: f64) -> Vec<Part> {
        let colour = colour.unwrap_or_else(|| self.tone(look, 0));
        let style = if look.art == "fill" && self.params.style != "outline" {
            Style::filled(colour)
        } else {
            line(colour, if look.width > 0.0 { look.width } else { OUTLINE } * self.unit * share)
        };
        vec![Part { path: strand.path.clone(), transform: Affine::IDENTITY, style }]
    }

    /// Every proxy as an outline, hidden.
    fn proxies(&self, world: &World) -> Group {
        let mut group = Group { name: "proxies".into(), hidden: true, ..Group::default() };
        let style = line("#ff0000", 0.15 * self.unit);
        for element in &world.elements[..world.placed] {
            let mut path = BezPath::new();
            let shapes = element.proxies.iter().flatten().filter(|proxy| !matches!(proxy, Proxy::Point(_)));
            shapes.for_each(|proxy| path.extend(proxy.path()));
            if !path.is_empty() {
                path.apply_affine(Affine::scale(self.unit));
                let part = Part { path, transform: Affine::IDENTITY, style: style.clone() };
                group.items.push(Item::new(world.kinds[element.kind].name.clone(), vec![part]));
            }
        }
        group
    }

    /// How growth looked for room at one step (000 Figure 8): what was there in red, circles that
    /// might be chosen in yellow, excluded ones in green, the chosen one dashed in blue, and the
    /// candidates thick in purple.
    fn view(&self, world: &World, view: &View) -> Group {
        let mut group = Group { name: "debug".into(), ..Group::default() };
        let mut add = |name: &str, mut path: BezPath, style: Style| {
            path.apply_affine(Affine::scale(self.unit));
            group.items.push(Item::new(name, vec![Part { path, transform: Affine::IDENTITY, style }]));
        };
        let disc = |center: Point, radius: f64| kurbo::Circle::new(center, radius).to_path(1e-3);
        for circle in &view.eligible {
            let mut style = Style::filled("#ffd800");
            style.set("fill-opacity", "0.25");
            style.set("stroke", "#b89a00");
            style.set("stroke-width", &format!("{:.4}", 0.1 * self.unit));
            add("eligible", disc(circle.center, circle.radius), style);
        }
        for &at in &view.excluded {
            add("excluded", disc(at, 0.4), Style::filled("#1a9a3a"));
        }
        for (number, element) in world.elements[..view.placed].iter().enumerate() {
            let is_candidate = view.candidates.contains(&(number as u32));
            let mut path = BezPath::new();
            element.proxies.iter().flatten().for_each(|proxy| path.extend(proxy.path()));
            let style = match is_candidate {
                true => line("#8a2be2", 0.8 * self.unit),
                false => line("#e02020", 0.2 * self.unit),
            };
            add(if is_candidate { "candidate" } else { "placed" }, path, style);
        }
        if let Some(circle) = view.chosen {
            let mut style = line("#1040ff", 0.4 * self.unit);
            style.set("stroke-dasharray", &format!("{:.4} {:.4}", 1.2 * self.unit, 0.8 * self.unit));
            add("chosen", disc(circle.center, circle.radius), style);
        }
        group
    }
}

fn line(colour: &str, width: f64) -> Style {
    let mut style = Style::filled("none");
    style.set("stroke", colour);
    style.set("stroke-width", &format!("{width:.4}"));
    style.set("stroke-linecap", "round");
    style.set("stroke-linejoin", "round");
    style
}

/// A field as a number.
fn field(world: &World, element: &Element, name: &str) -> Option<f64> {
    let place = world.kinds[element.kind].fields.iter().position(|(field, _)| field == name)?;
    let value = &element.fields[place];
    let number = value.as_float().ok().or_else(|| value.as_int().ok().map(|n| n as f64));
    number.filter(|number| number.abs() < 1e9)
}

/// From red, the oldest, to purple (000 Figure 14).
fn rainbow(share: f64) -> String {
    const PURPLE: f64 = 280.0;
    let hue = PURPLE * share.clamp(0.0, 1.0) / 60.0;
    // Lower in yellow and cyan, which are glaring otherwise.
    let (value, chroma) = (0.82, 0.66);
    let x = chroma * (1.0 - (hue % 2.0 - 1.0).abs());
    let (r, g, b) = match hue as usize {
        0 => (chroma, x, 0.0),
        1 => (x, chroma, 0.0),
        2 => (0.0, chroma, x),
        3 => (0.0, x, chroma),
        _ => (x, 0.0, chroma),
    };
    let byte = |c: f64| ((c + value - chroma) * 255.0).round().clamp(0.0, 255.0) as u8;
    format!("#{:02x}{:02x}{:02x}", byte(r), byte(g), byte(b))
}

fn is_seen(parts: &[Part], window: Rect) -> bool {
    parts.iter().any(|part| part.path.bounding_box().overlaps(window))
}

/// Sublayers of the same name become one.
pub(super) fn merged(groups: Vec<Group>) -> Vec<Group> {
    let mut merged: Vec<Group> = Vec::new();
    for group in groups {
        match merged.iter_mut().find(|known| known.name == group.name) {
            Some(known) => known.items.extend(group.items),
            None => merged.push(group),
        }
    }
    merged.retain(|group| !group.items.is_empty());
    merged
}
