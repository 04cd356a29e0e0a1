//! What an artist can set.

use crate::params::Kind;
use rinceau_format::Length;

crate::params! {
    /// Parameters of arrangement by example.
    pub struct Params {
        #[doc = "How many elements at most; 0 fills the shapes. Without a shape they grow around the seed mark, or the middle of the page"]
        count: usize = "count", "Elements", Basic, Kind::Whole { min: 0, max: 200_000 }, "0";
        #[doc = "How the example is turned: as it is drawn; freely, each element as it fits best; or with the flow of the guides"]
        mode: String = "mode", "Turn", Basic, Kind::Choice(&[("fixed", "As drawn"), ("rotate", "As it fits best"), ("flow", "With the flow")]), "fixed";
        #[doc = "Whether elements move a little in the end, so that distances come as near to the example's as they can everywhere"]
        relax: bool = "relax", "Even out", More, Kind::Switch, "true";
        #[doc = "Moves only what is within so many steps of what grew last, so that the rest stays as it is. 0 moves everything"]
        window: usize = "window", "Even out within", More, Kind::Whole { min: 0, max: 1000 }, "0";
        #[doc = "Symbols that go first, the most important one first, separated by spaces; all others fill the room between them"]
        priority: String = "priority", "First", More, Kind::Names(&[("none", "None")]), "none";
        #[doc = "Which elements are left out at the outline: those that cross it, those whose middle lies outside, or none but those that lie outside"]
        edge: String = "edge", "At the outline", Basic, Kind::Choice(&[("inside", "Whole elements only"), ("middle", "Those with their middle inside"), ("over", "All that touch the shape")]), "inside";
        #[doc = "Whether the box around the shape is a tile that repeats to all sides, as for cloth and paper: what leaves it on one side comes in on the other"]
        repeat: bool = "repeat", "Repeat as a tile", Basic, Kind::Switch, "false";
        #[doc = "What comes out: clones, so that a change of one symbol changes all, or copies"]
        output: String = "output", "Result", Basic, Kind::Choice(&[("clones", "Clones"), ("paths", "Copies")]), "clones";
        #[doc = "In which order elements lie over each other: as in the example, row by row, or as they grew"]
        order: String = "order", "Overlap", More, Kind::Choice(&[("example", "As in the example"), ("rows", "Row by row"), ("growth", "As they grew")]), "example";
        #[doc = "How much sizes vary: 0.2 is up to a fifth larger or smaller"]
        vary_size: f64 = "vary-size", "Vary sizes", More, Kind::Number { min: 0.0, max: 0.9 }, "0";
        #[doc = "How far elements turn at random, in degrees to either side"]
        vary_turn: f64 = "vary-turn", "Vary angles", More, Kind::Number { min: 0.0, max: 180.0 }, "0";
        #[doc = "How far elements are lighter or darker at random: 0.1 is a tenth of the way from black to white"]
        vary_tone: f64 = "vary-tone", "Vary tones", More, Kind::Number { min: 0.0, max: 1.0 }, "0";
        #[doc = "Distance kept from what is fixed and from the outline"]
        gap: Length = "gap", "Gap", More, Kind::Length, "0";
        #[doc = "Weight of distances when the example's elements are compared with a place"]
        w_place: f64 = "w-place", "Weight of places", More, Kind::Number { min: 0.0, max: 1000.0 }, "1";
        #[doc = "Weight of symbols in the same comparison"]
        w_symbol: f64 = "w-symbol", "Weight of symbols", More, Kind::Number { min: 0.0, max: 1000.0 }, "1";
        #[doc = "Weight of the neighbours' own neighbours in the same comparison"]
        w_rings: f64 = "w-rings", "Weight of second neighbours", More, Kind::Number { min: 0.0, max: 1000.0 }, "0.5";
        #[doc = "Weight against the same element of the example next to itself"]
        w_repeat: f64 = "w-repeat", "Weight against repeats", More, Kind::Number { min: 0.0, max: 1000.0 }, "100";
    }
}
