//! What fills a gap: a dot, a diamond, a drop, or a small element of the artist's own.

use super::template::Template;
use kurbo::{Affine, BezPath, Circle, Point, Shape, Vec2};

/// A kind of filler.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Motif {
    Dot,
    /// A dot that is moulded into its gap.
    Pebble,
    Diamond,
    Drop,
    /// The template with this number, as it was drawn, no more than scaled and turned.
    Element(usize),
}

/// A gap as a filler sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pocket {
    pub centre: Point,
    /// Radius of the largest disc that goes there.
    pub radius: f64,
    /// Unit vector along the gap.
    pub along: Vec2,
    /// How far it goes on that way, and the other way.
    pub reach: [f64; 2],
}

impl Motif {
    /// True for discs.
    pub fn is_round(self) -> bool {
        matches!(self, Motif::Dot | Motif::Pebble)
    }

    /// True for what is moulded into its gap.
    pub fn gives_way(self) -> bool {
        self == Motif::Pebble
    }

    /// What its items are called.
    pub fn name(self, templates: &[Template]) -> &str {
        match self {
            Motif::Dot => "dot",
            Motif::Pebble => "pebble",
            Motif::Diamond => "diamond",
            Motif::Drop => "drop",
            Motif::Element(template) => &templates[template].id,
        }
    }

    /// Half its stroke width in place.
    pub fn stroke(self, transform: Affine, templates: &[Template]) -> f64 {
        match self {
            Motif::Element(i) => {
                templates[i].stroke * (transform.determinant().abs() / templates[i].length).sqrt()
            }
            _ => 0.0,
        }
    }

    /// The most that this can be in discs of a radius.
    pub fn widest_stroke(self, radius: f64, templates: &[Template]) -> f64 {
        match self {
            Motif::Element(i) => templates[i].stroke * SCALES[0] * radius / farthest(&templates[i]),
            _ => 0.0,
        }
    }

    /// Its forms for a pocket, the best first; the last lies in the disc and always goes. A form is its
    /// parts; the outline of all of them together is that of the `outer` ones of a template.
    pub fn forms(self, pocket: &Pocket, templates: &[Template]) -> Vec<Form> {
        let r = pocket.radius;
        let frame = |scale: f64| {
            let x = scale * pocket.along;
            Affine::new([x.x, x.y, -x.y, x.x, pocket.centre.x, pocket.centre.y])
        };
        match self {
            Motif::Dot | Motif::Pebble => vec![Form::plain(circle(pocket.centre, r), Affine::IDENTITY)],
            Motif::Diamond => {
                let long = (pocket.reach[0].min(pocket.reach[1]) / r).clamp(1.0, 2.8);
                slim(long).map(|(long, wide)| Form::plain(diamond(long, wide), frame(r))).collect()
            }
            Motif::Drop => {
                let long = (pocket.reach[0] / r).clamp(1.0, 3.4);
                slim(long).map(|(long, wide)| Form::plain(drop_shape(long, wide), frame(r))).collect()
            }
            Motif::Element(template) => {
                let template = &templates[template];
                let farthest = farthest(template);
                // (u, v) about the middle of the spine.
                let middle = Affine::new([template.length, 0.0, 0.0, 1.0, -template.length / 2.0, 0.0]);
                let form = |scale: f64| Form {
                    outer: template.outer.clone(),
                    transform: frame(scale * r / farthest) * middle,
                };
                SCALES.map(form).into()
            }
        }
    }
}

/// Scales of an element in its disc, and out of it where there is more room.
const SCALES: [f64; 5] = [2.2, 1.8, 1.5, 1.25, 1.0];

/// How far an element reaches from the middle of its spine at most.
fn farthest(template: &Template) -> f64 {
    (template.length / 2.0 + template.stroke).hypot(template.half_width)
}

/// A filler before and after it is put in place.
#[derive(Clone, Debug)]
pub(super) struct Form {
    /// What keeps apart from neighbours.
    outer: Vec<BezPath>,
    pub transform: Affine,
}

impl Form {
    fn plain(path: BezPath, transform: Affine) -> Self {
        Form { outer: vec![path], transform }
    }

    /// Its outer paths in place.
    pub fn paths(&self) -> impl Iterator<Item = BezPath> + '_ {
        self.outer.iter().map(|path| self.transform * path.clone())
    }
}

/// Lengths and widths in radii, from what the gap allows at most to what a disc does.
fn slim(long: f64) -> impl Iterator<Item = (f64, f64)> {
    const WIDTHS: [f64; 3] = [1.0, 0.85, 0.7];
    let lengths = [long, 0.8 * long, 0.64 * long];
    let tried = lengths.into_iter().filter(|&long| long > 1.0);
    let tried = tried.flat_map(|long| WIDTHS.map(|wide| (long, wide)));
    // Both lie in the disc.
    tried.chain([(1.0, 0.6)])
}

fn circle(centre: Point, radius: f64) -> BezPath {
    // Four cubics; the error of a quarter circle is 0.03 % of the radius.
    Circle::new(centre, radius).to_path(1e-3 * radius)
}

/// A rhombus.
fn diamond(long: f64, wide: f64) -> BezPath {
    let mut path = BezPath::new();
    path.move_to((long, 0.0));
    [(0.0, wide), (-long, 0.0), (0.0, -wide)].into_iter().for_each(|p| path.line_to(p));
    path.close_path();
    path
}

/// A drop with its tip ahead.
fn drop_shape(long: f64, wide: f64) -> BezPath {
    // The handle of a quarter circle.
    const QUARTER: f64 = 0.5523;
    let round = QUARTER * wide;
    let back = (wide).min(1.0);
    let mut path = BezPath::new();
    path.move_to((long, 0.0));
    path.curve_to((0.5 * long, 0.3 * wide), (0.5 * long, wide), (0.0, wide));
    path.curve_to((-round, wide), (-back, round), (-back, 0.0));
    path.curve_to((-back, -round), (-round, -wide), (0.0, -wide));
    path.curve_to((0.5 * long, -wide), (0.5 * long, -0.3 * wide), (long, 0.0));
    path.close_path();
    path
}
