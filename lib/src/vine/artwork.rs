//! A grown plant to an artwork with its sublayers.

use super::clip_art::{Art, Library};
use super::grow::Plant;
use super::stem::Stem;
use crate::geom::boolean;
use crate::geom::flatten::flatten;
use crate::palette::palette;
use kurbo::{Affine, BezPath};
use rinceau_format::{Group, Item, Part, Scene, Style, Symbol};
use std::collections::BTreeMap;

/// Sublayers of one run, filled plant by plant.
#[derive(Default)]
pub(super) struct Layers {
    /// Leaves and buds, under the stems that hide where they are attached.
    pub elements: Group,
    pub stems: Group,
    /// What lies over the end of its stem.
    pub flowers: Group,
    pub fixed: Group,
    pub centre_lines: Group,
    pub symbols: Vec<Symbol>,
}

impl Layers {
    pub fn new(scene: &Scene) -> Self {
        let named = |name: &str, hidden| Group { name: name.into(), hidden, ..Group::default() };
        let mut fixed = named("fixed", false);
        fixed.items =
            scene.fixed.iter().map(|fixed| Item::new(fixed.source.id.clone(), fixed.parts.clone())).collect();
        Layers {
            elements: named("elements", false),
            stems: named("stems", false),
            flowers: named("flowers", false),
            fixed,
            centre_lines: named("spines", true),
            symbols: Vec::new(),
        }
    }

    /// Adds what has grown in one container.
    pub fn add(&mut self, plant: &Plant, library: &Library, fill: Option<&str>, decimals: usize) {
        let tones = palette(&plant.params.palette, fill);
        let tolerance = plant.sizes.width / 250.0;
        self.add_stems(plant, tones[0], tolerance);
        // Built-in art has the tones of its container; what the artist drew is the same in all.
        let mut symbols: BTreeMap<usize, usize> = BTreeMap::new();
        for (placed, shift) in plant.arts.iter().flat_map(|placed| {
            let (x, reach) = (placed.pose.translation().x, library.arts[placed.art].radius * placed.size);
            shifts(plant, x - reach, x + reach).into_iter().map(move |shift| (placed, shift))
        }) {
            let art = &library.arts[placed.art];
            let pose = shift * placed.pose;
            let group = if art.central { &mut self.flowers } else { &mut self.elements };
            if plant.params.copies {
                let moved = |part: Part| Part { path: pose * part.path, transform: Affine::IDENTITY, ..part };
                let parts = painted(art, placed.size, tones, decimals).into_iter().map(moved).collect();
                group.items.push(Item::new(art.id.clone(), parts));
                continue;
            }
            let symbol = *symbols.entry(placed.art).or_insert_with(|| {
                let name = format!("{}{}", art.id, self.symbols.len() + 1);
                self.symbols.push(Symbol::new(name, painted(art, 1.0, tones, SYMBOL_DECIMALS)));
                self.symbols.len() - 1
            });
            group.items.push(Item::cloned(art.id.clone(), symbol, pose));
        }
    }

    fn add_stems(&mut self, plant: &Plant, tone: &str, tolerance: f64) {
        let name = |stem: &Stem| if stem.level == 0 { "stem" } else { "branch" };
        let item = |of: &str, path: BezPath, style: Style| {
            Item::new(of, vec![Part { path, transform: Affine::IDENTITY, style }])
        };
        let line = |width: f64, colour: &str| {
            let mut style = Style::filled("none");
            style.set("stroke", colour);
            style.set("stroke-width", &format!("{width:.4}"));
            style.set("stroke-linecap", "round");
            style
        };
        let shifted = |stem: &Stem| {
            let (left, right) = stem.sides();
            // What runs from end to end is joined already: all else is shorter.
            let is_joined = plant.period.is_some_and(|period| right - left >= period);
            if is_joined { vec![Affine::IDENTITY] } else { shifts(plant, left, right) }
        };
        match plant.params.stems.as_str() {
            "lines" => {
                for stem in &plant.stems {
                    let (path, style) = (stem.centre_line(tolerance), line(stem.taper.start, tone));
                    let items =
                        shifted(stem).into_iter().map(|by| item(name(stem), by * &path, style.clone()));
                    self.stems.items.extend(items);
                }
                return;
            }
            "united" => {
                let outlines: Vec<_> = plant
                    .stems
                    .iter()
                    .flat_map(|stem| shifted(stem).into_iter().map(|by| by * stem.outline(tolerance)))
                    .flat_map(|outline| flatten(&outline, 4.0 * tolerance))
                    .map(|subpath| subpath.points)
                    .collect();
                let mut path = BezPath::new();
                for contour in boolean::simplified(&outlines, false) {
                    path.move_to(contour[0]);
                    contour[1..].iter().for_each(|&p| path.line_to(p));
                    path.close_path();
                }
                self.stems.items.push(item("stem", path, Style::filled(tone)));
            }
            _ => {
                // Twigs first, so that older stems lie over the joints of younger ones.
                let mut order: Vec<&Stem> = plant.stems.iter().collect();
                order.sort_by_key(|stem| std::cmp::Reverse(stem.level));
                for stem in order {
                    let path = stem.outline(tolerance);
                    let items =
                        shifted(stem).into_iter().map(|by| item(name(stem), by * &path, Style::filled(tone)));
                    self.stems.items.extend(items);
                }
            }
        }
        for stem in &plant.stems {
            let style = line(plant.sizes.width / 20.0, "#ff0000");
            self.centre_lines.items.push(item("spine", stem.centre_line(tolerance), style));
        }
    }

    /// The sublayers that hold something, in drawing order, and what their clones repeat.
    pub fn into_parts(self) -> (Vec<Group>, Vec<Symbol>) {
        let mut groups = vec![self.elements, self.stems, self.flowers, self.fixed, self.centre_lines];
        groups.retain(|group| !group.items.is_empty());
        (groups, self.symbols)
    }
}

/// Where something between two sides is drawn: in its place, and in what repeats also wherever one of
/// its copies lies over the tile, so that one that is cut off there has no seam.
fn shifts(plant: &Plant, left: f64, right: f64) -> Vec<Affine> {
    let mut shifts = vec![Affine::IDENTITY];
    if let Some((start, period)) = plant.cells.span() {
        let first = ((start - right) / period).floor() as i64 + 1;
        let last = ((start + period - left) / period).ceil() as i64 - 1;
        let others = (first..=last).filter(|&k| k != 0);
        shifts.extend(others.map(|k| Affine::translate((k as f64 * period, 0.0))));
    }
    shifts
}

/// Decimals of stroke widths in clip art of size 1.
const SYMBOL_DECIMALS: usize = 6;

/// Clip art in its colours, its strokes scaled.
fn painted(art: &Art, size: f64, tones: [&str; 3], decimals: usize) -> Vec<Part> {
    let part = |(path, style): &(BezPath, Style)| {
        let mut style = style.scaled(size, decimals);
        if art.builtin {
            repaint(&mut style, tones);
        }
        Part { path: path.clone(), transform: Affine::IDENTITY, style }
    };
    art.parts.iter().map(part).collect()
}

/// The four greys of built-in clip art stand for the tones of a palette.
fn repaint(style: &mut Style, tones: [&str; 3]) {
    let tone = match style.get("fill") {
        Some("#111111") => tones[0],
        Some("#555555") => tones[1],
        Some("#999999") => tones[2],
        // Centres of flowers: between paper and accent.
        Some("#dddddd") => "#f3e3bd",
        _ => return,
    };
    style.set("fill", tone);
}
