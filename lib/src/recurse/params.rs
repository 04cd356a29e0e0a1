//! What an artist can set.

use crate::params::Kind;
use rinceau_format::Length;

/// Names for `colours`.
const COLOURS: &[(&str, &str)] = &[
    ("drawn", "As drawn"),
    ("#14444f,#2f7f79,#d2913a", "Lagoon"),
    ("#6d1f2b,#b4482f,#dd9a3c", "Ember"),
    ("#24452f,#5c7a3a,#c2a54a", "Meadow"),
    ("#2b2a5a,#7b3f72,#cf7f86", "Dusk"),
];

crate::params! {
    /// Parameters of recursive forms.
    pub struct Params {
        #[doc = "How many generations are drawn: 1 is the motif alone, 2 adds its clones, 3 the clones of the clones, and so on"]
        depth: usize = "depth", "Generations", Basic, Kind::Whole { min: 1, max: 1_000_000_000 }, "5";
        #[doc = "Which generations are drawn: all of them over each other, as for trees and spirals, or only the last, as for curves that fill a plane"]
        generations: String = "generations", "Draw", Basic, Kind::Choice(&[("all", "All generations"), ("last", "Only the last")]), "all";
        #[doc = "Colours from the first generation to the last, two or more with commas between, such as '#14444f,#d2913a'; they replace every fill and stroke. drawn keeps the motif's own"]
        colours: String = "colours", "Colours", Basic, Kind::Names(COLOURS), "drawn";
        #[doc = "Whether strokes get thinner with the copies, or stay as thick as they are drawn"]
        strokes: String = "strokes", "Strokes", Basic, Kind::Choice(&[("scaled", "As large as the copy"), ("fixed", "As thick as drawn")]), "scaled";
        #[doc = "What comes out: paths, every copy a shape of its own, or clones, which stay alive: change the motif, and every copy follows"]
        output: String = "output", "Result", Basic, Kind::Choice(&[("paths", "Paths"), ("clones", "Clones of the motif")]), "paths";
        #[doc = "Copies smaller than this are not repeated further. 0 repeats them to the last generation"]
        min_size: Length = "min-size", "Smallest copy", More, Kind::Length, "0";
        #[doc = "Shapes and repeats at most: a form that would have more is refused, with the number of generations that would do. Paths are 20 million at most, whatever this says"]
        most: f64 = "most", "Copies at most", More, Kind::Number { min: 1.0, max: 1e15 }, "2000000";
        #[doc = "Whether neighbours in paint order that look the same become one path, up to 200 copies each, where that changes no picture"]
        merge: bool = "merge", "Merge equal neighbours", More, Kind::Switch, "true";
        #[doc = "Whether lines become long ones: where their ends touch, or one line through all of them in drawing order, with straight bridges over the gaps. Plotters draw them without lifting the pen"]
        join: String = "join", "Join lines", More, Kind::Choice(&[("none", "No"), ("touching", "Where ends touch"), ("all", "Into one line")]), "none";
        #[doc = "Whether the form is kept, with a small picture, in a layer of explored forms beside the page, next to the one it came from. Select a picture there to run it again"]
        history: bool = "history", "Keep in explored forms", More, Kind::Switch, "false";
        #[doc = "A sheet of neighbours instead of the form: each clone turned, scaled and mirrored a little, one picture for each change"]
        sheet: bool = "sheet", "Sheet of neighbours", More, Kind::Switch, "false";
        #[doc = "How far a sheet turns each clone, in degrees; it scales it by as many hundredths"]
        change: f64 = "change", "Change on the sheet", More, Kind::Number { min: 0.1, max: 90.0 }, "10";
    }
}
