//! What an artist can set.

use crate::palette::PALETTES;
use crate::params::Kind;
use rinceau_format::Length;

crate::params! {
    /// Parameters of vines. Lists give a value per level, separated by commas; the last one
    /// holds for all levels after it. The first level is the main stem.
    pub struct Params {
        #[doc = "How many times stems branch, the main stem included: 1 is the stem alone, 3 adds branches and twigs"]
        levels: usize = "levels", "Levels", Basic, Kind::Whole { min: 1, max: 8 }, "4";
        #[doc = "Width of the main stem where it starts. 0 chooses from the size of the shape"]
        stem_width: Length = "stem-width", "Stem width", Basic, Kind::Length, "0";
        #[doc = "How far each curl winds, in full turns; a list gives a value per level. Small opens the curls, large makes spirals"]
        turns: Vec<f64> = "turns", "Turns", Curves, Kind::Numbers { min: 0.0, max: 8.0 }, "1.3,1.3,1.2,1";
        #[doc = "What grows at each fork, opposite to the branch: leaf, flower, bud, none, or a kind or id of your own; several names mix, as in 'leaf leaf bud', and commas give a choice per level"]
        forks: String = "forks", "At forks", Basic, Kind::Names(FORKS), "leaf";
        #[doc = "What sits at the end of each curl: flower, bud, leaf, ball, none, or a kind or id of your own; several names mix, and commas give a choice per level"]
        tips: String = "tips", "At tips", Basic, Kind::Names(TIPS), "flower";
        #[doc = "Colours of stems and built-in clip art. Elements that you drew keep their own"]
        palette: String = "palette", "Colours", Basic, Kind::Choice(PALETTES), "auto";
        #[doc = "Longest branch of each level; a list gives a value per level. 0 chooses from the size of the shape"]
        length: Vec<Length> = "length", "Longest branch", More, Kind::Lengths, "0";
        #[doc = "Branches of each stem at most; a list gives a value per level"]
        branches: Vec<f64> = "branches", "Branches", More, Kind::Numbers { min: 0.0, max: 1000.0 }, "40,12,8,6";
        #[doc = "How the curvature grows towards the tip: 0 draws circles, 0.5 even spirals, 1 spirals that tighten steadily, negative values start tight and open"]
        alpha: Vec<f64> = "alpha", "Tightening", Curves, Kind::Numbers { min: -1.0, max: 1.6 }, "0.55";
        #[doc = "Leaves along the stems where there is room between the branches: 0 none, 1 as many as fit"]
        leaves: f64 = "leaves", "Leaves along stems", More, Kind::Number { min: 0.0, max: 1.0 }, "1";
        #[doc = "Size of leaves, flowers and buds"]
        clip_art: f64 = "clip-art", "Size of leaves and flowers", More, Kind::Number { min: 0.1, max: 5.0 }, "1";
        #[doc = "Empty distance kept between stems, leaves and flowers. 0 chooses from the stem width"]
        gap: Length = "gap", "Gap", More, Kind::Length, "0";
        #[doc = "Empty distance kept from the outline of the shape. 0 chooses the gap"]
        edge: Length = "edge", "Distance from outline", More, Kind::Length, "0";
        #[doc = "How stems get thinner: 0 keeps their width, 1 thins evenly, 2 thins fast at first"]
        taper: f64 = "taper", "Taper", Curves, Kind::Number { min: 0.0, max: 4.0 }, "1";
        #[doc = "Width of a stem's tip, as a share of its width at the start"]
        tip_width: f64 = "tip-width", "Tip width", Curves, Kind::Number { min: 0.0, max: 1.0 }, "0.22";
        #[doc = "Where the main stem comes from when none is drawn: it finds its own way through the shape, or curls up from the bottom as a single spiral"]
        stem: String = "stem", "Main stem", Curves, Kind::Choice(&[("wander", "Finds its way"), ("curl", "One curl from the bottom")]), "wander";
        #[doc = "Which way the main curl turns first"]
        curl: String = "curl", "First curl", Curves, Kind::Choice(&[("right", "Right"), ("left", "Left")]), "right";
        #[doc = "Where branches leave their stem: wherever the largest one fits, or at equal intervals on alternate sides"]
        places: String = "places", "Forks", Curves, Kind::Choice(&[("best", "Where there is room"), ("equal", "At equal intervals")]), "best";
        #[doc = "How long a branch may be: never longer than its parent, as in nature, or the longest that fits"]
        rule: String = "rule", "Branch length", Curves, Kind::Choice(&[("natural", "At most its parent's"), ("largest", "The longest that fits")]), "natural";
        #[doc = "How the charge of the particle changes along its way: power (tightening curls), constant (circles), triangle or sine (meanders), or numbers of your own, evenly spaced, such as '1 -1 2'"]
        charge: String = "charge", "Charge", Curves, Kind::Names(CHARGES), "power";
        #[doc = "The magnetic field: the same everywhere, stronger near walls, or gently uneven"]
        field: String = "field", "Field", Curves, Kind::Choice(&[("constant", "Even"), ("walls", "Stronger near walls"), ("noise", "Uneven")]), "constant";
        #[doc = "How curves are computed: exactly, or in the steps of the original article, which speed up and open the curl"]
        integrator: String = "integrator", "Integrator", Curves, Kind::Choice(&[("exact", "Exact"), ("euler", "Euler steps")]), "exact";
        #[doc = "How stems are drawn: a tapered shape for each, all of a plant as one shape (for cutters), or plain lines (for pens)"]
        stems: String = "stems", "Stems", More, Kind::Choice(&[("shapes", "Tapered shapes"), ("united", "One shape"), ("lines", "Lines")]), "shapes";
        #[doc = "Whether leaves and flowers are copies; otherwise they are clones: edit one in the layer's symbols and all follow. Cutters and plotters want copies"]
        copies: bool = "copies", "Copies instead of clones", More, Kind::Switch, "false";
        #[doc = "Whether the vine lies over those of shapes below; otherwise the upper shape takes the place of the lower one"]
        overlay: bool = "overlay", "Lies over others", More, Kind::Switch, "false";
        #[doc = "Whether branches may cross others at steep angles, weaving over and under"]
        plait: bool = "plait", "Plait-work", More, Kind::Switch, "false";
        #[doc = "Whether the ornament repeats: the left and right end of the shape are then joined, so that copies set side by side make a band without a seam"]
        repeat: bool = "repeat", "Repeats sideways", More, Kind::Switch, "false";
    }
}

/// What a dialog offers for forks.
const FORKS: &[(&str, &str)] = &[
    ("leaf", "Leaves"),
    ("leaf leaf leaf bud", "Leaves and some buds"),
    ("bud", "Buds"),
    ("none", "Nothing"),
];

/// What a dialog offers for tips.
const TIPS: &[(&str, &str)] = &[
    ("flower", "Flowers"),
    ("flower,flower,bud", "Flowers, and buds on twigs"),
    ("ball", "Balls"),
    ("none", "Nothing"),
];

/// What a dialog offers as charge.
const CHARGES: &[(&str, &str)] =
    &[("power", "Curls"), ("constant", "Circles"), ("sine", "Waves"), ("triangle", "Meanders")];

/// The value of a level in a list, whose last one is repeated.
pub(super) fn of_level<T: Copy>(values: &[T], level: usize) -> Option<T> {
    values.get(level).or(values.last()).copied()
}

/// The lengths of one run in user units, all derived.
#[derive(Clone, Debug)]
pub(super) struct Sizes {
    /// Width of the main stem at its start.
    pub width: f64,
    pub gap: f64,
    pub edge: f64,
    /// Longest branch of each level.
    pub length: Vec<f64>,
    /// Side of the largest square that clip art of size 1 fills on a branch of level 1.
    pub art: f64,
}

impl Sizes {
    /// From the area of a container and the radius of the largest circle in it.
    pub fn new(params: &Params, area: f64, inradius: f64, px_per_unit: f64) -> Self {
        let or = |length: Length, default: f64| {
            let length = length.to_user(px_per_unit);
            if length > 0.0 { length } else { default }
        };
        // A stem this much thinner than the shape is a line in a field, not a pipe; and in
        // thin shapes it leaves room for curls on both sides.
        let width = or(params.stem_width, (0.026 * area.sqrt()).min(0.14 * inradius));
        let gap = or(params.gap, 0.36 * width);
        let edge = or(params.edge, gap);
        let longest = |level: usize| {
            let own = of_level(&params.length, level).unwrap_or(Length::user(0.0));
            or(own, 7.0 * inradius)
        };
        let length = (0..params.levels).map(longest).collect();
        Sizes { width, gap, edge, length, art: 6.0 * width * params.clip_art }
    }
}
