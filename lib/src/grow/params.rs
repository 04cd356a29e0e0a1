//! The one table of growth's parameters.

use crate::palette::PALETTES;
use crate::params::Kind;
use rinceau_format::Length;

/// The patterns that are built in, and what a dialog calls them.
pub const PATTERNS: &[(&str, &str)] = &[
    ("auto", "The drawing's own rules, else spirals"),
    ("spiral", "Spirals that scroll to alternate sides"),
    ("vines", "Vines with blossoms, then leaves, then fillers"),
    ("vase", "Blossoms on a grid, joined by stems, with hooks"),
    ("willow", "Willow leaves"),
    ("willow-planned", "Willow leaves along planned stems"),
    ("flower", "Blossoms, stems and leaves"),
    ("dots", "Dots in the colours of the rainbow"),
];

/// Ways to draw lines that growth has made (000 Figure 17).
pub const STYLES: &[(&str, &str)] = &[
    ("drawn", "As the pattern says"),
    ("outline", "Outlines of the simple shapes"),
    ("brush", "Brush strokes"),
    ("ribbon", "Ribbons"),
    ("rope", "Ropes"),
    ("leafy", "Leafy stems"),
    ("beads", "Beads"),
    ("acanthus", "Acanthus scrolls"),
];

/// Symmetries, by the names of crystallography; rosettes by Schoenflies'.
pub const SYMMETRIES: &[(&str, &str)] = &[
    ("none", "None"),
    ("mirror", "Left and right alike"),
    ("c2", "Half-turn"),
    ("c3", "Turned three times"),
    ("c4", "Turned four times"),
    ("c5", "Turned five times"),
    ("c6", "Turned six times"),
    ("c8", "Turned eight times"),
    ("d2", "Two mirrors"),
    ("d3", "Three mirrors"),
    ("d4", "Four mirrors"),
    ("d5", "Five mirrors"),
    ("d6", "Six mirrors"),
    ("d8", "Eight mirrors"),
    ("frame", "Frame: sides repeat between corners"),
    ("p111", "Band: repeated"),
    ("p1a1", "Band: glide reflection"),
    ("p1m1", "Band: mirrored along the middle"),
    ("pm11", "Band: upright mirrors"),
    ("p112", "Band: half-turns"),
    ("pma2", "Band: mirrors and half-turns"),
    ("pmm2", "Band: both mirrors"),
    ("p1", "Wallpaper p1"),
    ("p2", "Wallpaper p2"),
    ("pm", "Wallpaper pm"),
    ("pg", "Wallpaper pg"),
    ("cm", "Wallpaper cm"),
    ("pmm", "Wallpaper pmm"),
    ("pmg", "Wallpaper pmg"),
    ("pgg", "Wallpaper pgg"),
    ("cmm", "Wallpaper cmm"),
    ("p4", "Wallpaper p4"),
    ("p4m", "Wallpaper p4m"),
    ("p4g", "Wallpaper p4g"),
    ("p3", "Wallpaper p3"),
    ("p3m1", "Wallpaper p3m1"),
    ("p31m", "Wallpaper p31m"),
    ("p6", "Wallpaper p6"),
    ("p6m", "Wallpaper p6m"),
];

/// Where seeds are put that nobody has placed.
const STARTS: &[(&str, &str)] =
    &[("middle", "In the widest place"), ("lower-left", "At the lower left"), ("corners", "In every corner")];

crate::params! {
    /// Parameters of growth by rules.
    pub struct Params {
        #[doc = "The pattern: one that is built in, or a file of growth rules. auto takes the rules that the drawing carries"]
        rules: String = "rules", "Pattern", Basic, Kind::Rules(PATTERNS), "auto";
        #[doc = "How lines are drawn. The growth is the same in every style"]
        style: String = "style", "Style", Basic, Kind::Choice(STYLES), "drawn";
        #[doc = "Length of one unit of the rules. 0 makes a shape as large as a square of 100 units"]
        rule_unit: Length = "rule-unit", "Size of the pattern", Basic, Kind::Length, "0";
        #[doc = "Where growth starts in a shape that no seed is marked in"]
        start: String = "start", "Starts", More, Kind::Choice(STARTS), "middle";
        #[doc = "Grows everything together with its images. Bands and wallpapers grow in the rectangle around the shape, which then repeats without a seam; a frame repeats a mirrored piece along each side, and one in its corners"]
        symmetry: String = "symmetry", "Symmetry", Basic, Kind::Choice(SYMMETRIES), "none";
        #[doc = "How often a band or wallpaper repeats within the width of the shape, or a frame between its corners"]
        repeats: usize = "repeats", "Repeats", More, Kind::Whole { min: 1, max: 50 }, "1";
        #[doc = "Colours: three tones that print well"]
        palette: String = "palette", "Colours", Basic, Kind::Choice(PALETTES), "auto";
        #[doc = "Distance kept to the shape's outline. 0 chooses by itself"]
        edge: Length = "edge", "Space at the edge", More, Kind::Length, "0";
        #[doc = "Space kept around what is marked as fixed. 0 chooses by itself"]
        gap: Length = "gap", "Space around fixed areas", More, Kind::Length, "0";
        #[doc = "How far an element may be from an empty circle to grow into it, in radii of the circle"]
        reach: f64 = "reach", "Reach", More, Kind::Number { min: 0.0, max: 4.0 }, "0.5";
        #[doc = "The smallest empty circle that is tried, in units of the rules"]
        smallest: f64 = "smallest", "Smallest room", More, Kind::Number { min: 0.05, max: 100.0 }, "0.35";
        #[doc = "Elements at most"]
        max_elements: usize = "max-elements", "Elements at most", More, Kind::Whole { min: 1, max: 200_000 }, "50000";
        #[doc = "Shows how growth looks for room, in a layer of its own: empty circles, those tried in vain, and the one that is next after this many steps. 0 shows nothing"]
        debug: usize = "debug", "Show step", More, Kind::Whole { min: 0, max: 1_000_000 }, "0";
    }
}
