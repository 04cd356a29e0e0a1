//! A grown plant to an artwork with its sublayers.

use super::clip_art::Library;
use super::grow::Plant;
use super::stem::Stem;
use crate::geom::boolean;
use crate::geom::flatten::flatten;
use crate::palette::palette;
use kurbo::{Affine, BezPath};
use rinceau_format::{Group, Item, Part, Scene, Style};

/// Sublayers of one run, filled plant by plant.
#[derive(Default)]
pub(super) struct Layers {
    pub stems: Group,
    pub elements: Group,
    pub fixed: Group,
    pub centre_lines: Group,
}

impl Layers {
    pub fn new(scene: &Scene) -> Self {
        let named = |name: &str, hidden| Group { name: name.into(), hidden, ..Group::default() };
        let mut fixed = named("fixed", false);
        fixed.items = scene
            .fixed
            .iter()
            .map(|fixed| Item { of: fixed.source.id.clone(), parts: fixed.parts.clone() })
            .collect();
        Layers {
            stems: named("stems", false),
            elements: named("elements", false),
            fixed,
            centre_lines: named("spines", true),
        }
    }

    /// Adds what has grown in one container.
    pub fn add(&mut self, plant: &Plant, library: &Library, fill: Option<&str>, decimals: usize) {
        let tones = palette(&plant.params.palette, fill);
        let tolerance = plant.sizes.width / 400.0;
        self.add_stems(plant, tones[0], tolerance);
        for placed in &plant.arts {
            let art = &library.arts[placed.art];
            let parts = art.parts.iter().map(|(path, style)| {
                let mut style = style.scaled(placed.size, decimals);
                if art.builtin {
                    repaint(&mut style, tones);
                }
                Part { path: placed.pose * path.clone(), transform: Affine::IDENTITY, style }
            });
            self.elements.items.push(Item { of: art.id.clone(), parts: parts.collect() });
        }
    }

    fn add_stems(&mut self, plant: &Plant, tone: &str, tolerance: f64) {
        let name = |stem: &Stem| if stem.level == 0 { "stem" } else { "branch" };
        let item = |of: &str, path: BezPath, style: Style| Item {
            of: of.into(),
            parts: vec![Part { path, transform: Affine::IDENTITY, style }],
        };
        let line = |width: f64, colour: &str| {
            let mut style = Style::filled("none");
            style.set("stroke", colour);
            style.set("stroke-width", &format!("{width:.4}"));
            style.set("stroke-linecap", "round");
            style
        };
        match plant.params.stems.as_str() {
            "lines" => {
                for stem in &plant.stems {
                    let style = line(stem.taper.start, tone);
                    self.stems.items.push(item(name(stem), stem.centre_line(tolerance), style));
                }
                return;
            }
            "united" => {
                let outlines: Vec<_> = plant
                    .stems
                    .iter()
                    .flat_map(|stem| flatten(&stem.outline(tolerance), 4.0 * tolerance))
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
                    self.stems.items.push(item(name(stem), stem.outline(tolerance), Style::filled(tone)));
                }
            }
        }
        for stem in &plant.stems {
            let style = line(plant.sizes.width / 20.0, "#ff0000");
            self.centre_lines.items.push(item("spine", stem.centre_line(tolerance), style));
        }
    }

    /// The sublayers that hold something, in drawing order.
    pub fn into_groups(self) -> Vec<Group> {
        let mut groups = vec![self.stems, self.elements, self.fixed, self.centre_lines];
        groups.retain(|group| !group.items.is_empty());
        groups
    }
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
