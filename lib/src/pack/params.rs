//! What an artist can set.

use crate::palette::PALETTES;
use crate::params::Kind;
use rinceau_format::Length;

/// Families of built-in elements, and the drawing's own.
pub(super) const FAMILIES: &[(&str, &str)] = &[
    ("auto", "My own if I drew any, else mixed"),
    ("drawn", "My own"),
    ("mixed", "Mixed"),
    ("leaves", "Leaves"),
    ("drops", "Drops"),
    ("spirals", "Spirals"),
    ("scales", "Scales"),
    ("feathers", "Feathers"),
];

/// What fills gaps.
const FILLERS: &[(&str, &str)] = &[
    ("pebbles", "Pebbles"),
    ("dots", "Dots"),
    ("diamonds", "Diamonds"),
    ("drops", "Drops"),
    ("dots diamonds drops", "Dots, diamonds and drops"),
    ("shapes", "Shapes of the gaps"),
    ("none", "Nothing"),
];

crate::params! {
    /// Parameters of packing. Lengths of 0 are derived from the area that is filled.
    pub struct Params {
        #[doc = "How wide the elements are, roughly. Larger means fewer, bolder elements. 0 chooses from the size of the shape"]
        spacing: Length = "spacing", "Element width", Basic, Kind::Length, "0";
        #[doc = "Which elements fill the shape: a built-in family, or names, kinds or families of your own"]
        elements: String = "elements", "Elements", Basic, Kind::Names(FAMILIES), "auto";
        #[doc = "Empty distance kept between elements. No two ever come closer. 0 chooses an eighth of the element width"]
        min_gap: Length = "min-gap", "Gap", Basic, Kind::Length, "0";
        #[doc = "Colours of the built-in elements. Elements that you drew keep their own"]
        palette: String = "palette", "Colours", Basic, Kind::Choice(PALETTES), "auto";
        #[doc = "Longest element. 0 chooses four element widths"]
        max_length: Length = "max-length", "Longest element", More, Kind::Length, "0";
        #[doc = "Shortest element; where only a shorter one would fit, the space stays empty. 0 chooses 1.5 element widths"]
        min_length: Length = "min-length", "Shortest element", More, Kind::Length, "0";
        #[doc = "Empty distance kept from the outline of the shape. 0 chooses a little less than the gap, or all of a gap that you chose yourself"]
        edge: Length = "edge", "Distance from outline", More, Kind::Length, "0";
        #[doc = "What goes into the gaps that are left: pebbles that take the form of their gap, dots, diamonds or drops, names of your own small elements, shapes that follow the elements around them, or nothing"]
        fillers: String = "fillers", "Fill gaps with", Basic, Kind::Names(FILLERS), "pebbles";
        #[doc = "Empty distance kept around what fills the gaps. 0 chooses a little less than the gap, half of it for specks in nooks, or all of a gap that you chose yourself"]
        filler_gap: Length = "filler-gap", "Gap around fillers", More, Kind::Length, "0";
        #[doc = "How freely an element's width may swell and shrink along its length to fill the space it has: 1 keeps its proportions, 3 is very free"]
        stretch: f64 = "stretch", "Swelling", More, Kind::Number { min: 1.0, max: 3.0 }, "1.6";
        #[doc = "How far outlines give way to what is beside them, so that all gaps become alike: 0 leaves elements as they were bent, 1 presses them into every corner"]
        mould: f64 = "mould", "Moulding", More, Kind::Number { min: 0.0, max: 1.0 }, "1";
        #[doc = "How hard equal neighbours are avoided: 0 takes whatever fits best, 1 mixes as much as it can"]
        variety: f64 = "variety", "Variety", More, Kind::Number { min: 0.0, max: 1.0 }, "0.5";
        #[doc = "Which way elements point: with the arrows of the guides, or either way, whatever fits best"]
        sense: String = "sense", "Pointing", More, Kind::Choice(&[("arrow", "With the arrows"), ("any", "Either way")]), "arrow";
        #[doc = "Whether one half is composed and the other is its mirror image: about the line that the shape is most alike about, or about the first guide that is straight"]
        symmetry: String = "symmetry", "Symmetry", More, Kind::Choice(&[("none", "None"), ("mirror", "Alike on both sides"), ("line", "Alike beside a straight guide")]), "none";
        #[doc = "How many elements may share one line, one behind the other"]
        thread: usize = "thread", "Elements on one line", More, Kind::Whole { min: 1, max: 20 }, "1";
        #[doc = "How often the composition is refined: elements move apart, turn and grow into the gaps. 0 leaves them as first placed"]
        iterations: usize = "iterations", "Refinements", More, Kind::Whole { min: 0, max: 200 }, "15";
        #[doc = "How lines are shifted when they are refined: the whole line at once, or along a shortest path as in the paper, which is slow"]
        shift: String = "shift", "Lines move", More, Kind::Choice(&[("whole", "As a whole"), ("paper", "Along a shortest path (slow)")]), "whole";
        #[doc = "Whether a hidden sublayer shows how wide the gaps are: blue where they are narrower than their mean, red where they are wider"]
        show_gaps: bool = "show-gaps", "Map of the gaps", More, Kind::Switch, "false";
        #[doc = "Whether a hidden sublayer shows which way the flow runs, and where it has no direction: discs where it turns around a point, triangles where it parts"]
        show_flow: bool = "show-flow", "Picture of the flow", More, Kind::Switch, "false";
        #[doc = "Radius that corners are rounded to. Nothing grows by it"]
        rounding: Length = "rounding", "Round corners", More, Kind::Length, "0";
        #[doc = "How worn the elements look, as if printed from an old block: 0 not at all"]
        distress: f64 = "distress", "Worn look", More, Kind::Number { min: 0.0, max: 1.0 }, "0";
        #[doc = "Whether everything is joined to one piece that can be cut out: thinner parts are left out, and bridges join the rest"]
        connect: bool = "connect", "Join to one piece", More, Kind::Switch, "false";
        #[doc = "How wide bridges are, and the least thickness of such a piece. 0 chooses the gap"]
        bridge: Length = "bridge", "Bridge width", More, Kind::Length, "0";
        #[doc = "Whether half elements line the outline where the flow runs along it"]
        border: bool = "border", "Line the outline with half elements", More, Kind::Switch, "true";
    }
}

impl Params {
    /// True if lines are shifted along shortest paths, as in the paper.
    pub fn moves_by_paths(&self) -> bool {
        self.shift == "paper"
    }

    /// True if the gaps become shapes themselves.
    pub(super) fn has_shapes(&self) -> bool {
        self.fillers.split_whitespace().any(|word| word == "shapes")
    }
}

/// Curves are true to this share of the element width: a tenth of a millimetre on a poster.
const TOLERANCE: f64 = 1.0 / 400.0;

/// The lengths of one run in user units, all derived.
#[derive(Clone, Debug)]
pub(super) struct Sizes {
    pub spacing: f64,
    pub min_length: f64,
    pub max_length: f64,
    /// Between elements.
    pub gap: f64,
    /// Around what fills the gaps.
    pub filler_gap: f64,
    /// Around specks in nooks.
    pub nook_gap: f64,
    pub edge: f64,
    pub nook_edge: f64,
    pub rounding: f64,
    pub bridge: f64,
}

impl Sizes {
    /// How far bent curves, and the chords that stand for them, may be from the truth.
    pub fn tolerance(&self) -> f64 {
        TOLERANCE * self.spacing
    }

    /// The gap between chords that guarantees the gap between what they stand for, also after
    /// rounding to the written decimals.
    pub fn safe_gap(&self) -> f64 {
        self.safe(self.gap)
    }

    /// As [`Sizes::safe_gap`], of any gap.
    pub fn safe(&self, gap: f64) -> f64 {
        const ROUNDING: f64 = 1e-3;
        gap * (1.0 + ROUNDING) + 2.0 * self.tolerance()
    }

    /// `area` is that of everything to be filled; then area and perimeter of this container.
    pub fn new(params: &Params, area: f64, (own, perimeter): (f64, f64), px_per_unit: f64) -> Self {
        /// About this many elements fill the shapes when no width is given.
        const ELEMENTS: f64 = 60.0;
        let or = |length: Length, default: f64| {
            let length = length.to_user(px_per_unit);
            if length > 0.0 { length } else { default }
        };
        // An average element is this many times longer than its share of the width.
        const ASPECT: f64 = 2.9;
        let all = (area / (ELEMENTS * ASPECT)).sqrt();
        // A small part of the drawing gets smaller elements, so that it holds some at all.
        const AT_LEAST: f64 = 7.0;
        // And a thin one elements that fit across it: twice area over perimeter is the width of
        // a strip, and half that of a disc, which this leaves alone.
        let across = 2.2 * own / perimeter.max(f64::MIN_POSITIVE);
        let spacing = or(params.spacing, all.min((own / (AT_LEAST * ASPECT)).sqrt()).min(across));
        let max_length = or(params.max_length, 4.0 * spacing);
        let min_length = or(params.min_length, 1.5 * spacing).min(max_length);
        let gap = or(params.min_gap, spacing / 8.0);
        // Round and small things look farther from their neighbours than they are, and so does the outline.
        const NARROWER: f64 = 0.85;
        const NOOK: f64 = 0.42;
        // Who says how wide a gap has to be, to cut it out for instance, means all of them.
        let chosen = |length: Length| length.to_user(px_per_unit) > 0.0;
        let is_cut = chosen(params.min_gap);
        let filler_gap = or(params.filler_gap, if is_cut { gap } else { NARROWER * gap });
        let edge = or(params.edge, if is_cut { gap } else { NARROWER * gap });
        let nook_gap = if is_cut || chosen(params.filler_gap) { filler_gap } else { NOOK * gap };
        let nook_edge = if chosen(params.edge) { edge } else { edge.min(nook_gap) };
        // Nothing is so thick that a larger radius would be seen.
        let rounding = or(params.rounding, 0.0).min(spacing / 4.0);
        let bridge = or(params.bridge, gap);
        Sizes {
            spacing,
            min_length,
            max_length,
            gap,
            filler_gap,
            nook_gap,
            edge,
            nook_edge,
            rounding,
            bridge,
        }
    }
}
