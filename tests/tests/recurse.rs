//! Recursive forms: what is drawn is what the paper's algorithm draws, however it is written; and
//! the facts that the samples show.

mod support;

use kurbo::{Affine, BezPath, PathEl, Point, Rect, Shape};
use proptest::prelude::*;
use rinceau_format::{Artwork, Form, FormItem, Pieces, Scene};
use std::fmt::Write;
use support::geometry::{cases, generated, read, rng_seed, samples_of, written};

/// A drawn shape: what it is a copy of, its style, and its outline in its place.
type Drawn = (String, String, BezPath);

/// Takes every path of a stream as a shape of its own.
#[derive(Default)]
struct Shapes {
    drawn: Vec<Drawn>,
    pieces: usize,
    open: (String, Affine, String),
}

impl Pieces for Shapes {
    fn begin(&mut self, of: &str, transform: Affine, style: &str) {
        self.pieces += 1;
        self.open = (of.to_owned(), transform, style.to_owned());
    }

    fn add(&mut self, path: &BezPath, pose: Affine) {
        let (of, transform, style) = &self.open;
        self.drawn.push((of.clone(), style.clone(), *transform * pose * path.clone()));
    }
}

fn shapes(artwork: &Artwork) -> Shapes {
    let mut shapes = Shapes::default();
    for group in &artwork.groups {
        group.stream.as_ref().expect("paths come as a stream").each(&mut shapes);
    }
    shapes
}

/// The form that is drawn for its own sake.
fn root(scene: &Scene) -> usize {
    scene.forms.iter().position(|form| form.is_root).expect("a form")
}

/// The paper's Figure 2, for several forms, word by word.
fn figure_2(
    forms: &[Form],
    form: usize,
    transform: Affine,
    depth: usize,
    all: bool,
    out: &mut Vec<(usize, BezPath)>,
) {
    if depth == 0 {
        return;
    }
    for (number, item) in forms[form].items.iter().enumerate() {
        match item {
            FormItem::Primitive(drawn) if all || depth == 1 => {
                out.push((number, transform * drawn.part.transform * drawn.part.path.clone()));
            }
            FormItem::Primitive(_) => {}
            FormItem::Clone(clone) => {
                figure_2(forms, clone.form, transform * clone.transform, depth - 1, all, out);
            }
        }
    }
}

fn points(path: &BezPath) -> Vec<Point> {
    path.elements()
        .iter()
        .flat_map(|el| match *el {
            PathEl::MoveTo(p) | PathEl::LineTo(p) => vec![p],
            PathEl::QuadTo(a, p) => vec![a, p],
            PathEl::CurveTo(a, b, p) => vec![a, b, p],
            PathEl::ClosePath => Vec::new(),
        })
        .collect()
}

fn are_near(a: &BezPath, b: &BezPath, by: f64) -> bool {
    let (a, b) = (points(a), points(b));
    a.len() == b.len() && a.iter().zip(&b).all(|(p, q)| p.distance(*q) <= by)
}

prop_compose! {
    /// A clone that shrinks, anyhow turned, mirrored and sheared.
    fn clone()(scale in 0.2..0.9f64, turn in 0.0..360.0f64, shear in -40.0..40.0f64, flip in any::<bool>(),
               x in -30.0..30.0f64, y in -30.0..30.0f64, at in 0..4usize, of in 0..2usize) -> (String, usize, usize) {
        let flip = if flip { " scale(-1 1)" } else { "" };
        (format!("translate({x:.3} {y:.3}) rotate({turn:.3}) skewX({shear:.3}) scale({scale:.3}){flip}"), at, of)
    }
}

/// Two forms that clone each other.
fn drawing(clones: [&[(String, usize, usize)]; 2]) -> String {
    let motifs = [
        [
            "<rect id='a1' width='20' height='9' fill='#aa0000'/>",
            "<path id='a2' d='M5,5 Q20,0 25,15' fill='none' stroke='#008800' stroke-width='2'/>",
            "<circle id='a3' cx='9' cy='20' r='6' fill='#aa0000'/>",
        ],
        [
            "<path id='b1' d='M0,0 L12,3 L4,14 Z' fill='#0000aa'/>",
            "<path id='b2' d='M2,2 h9 v9 h-9 z M4,4 h5 v5 h-5 z' fill='#0000aa' fill-rule='evenodd'/>",
            "<ellipse id='b3' rx='5' ry='3'/>",
        ],
    ];
    let mut out = String::from(
        "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' viewBox='-100 -100 200 200'>",
    );
    for (form, name) in ["a", "b"].into_iter().enumerate() {
        let _ = write!(out, "<g id='{name}' class='rinceau-form' transform='translate({} 7)'>", 11 * form);
        for place in 0..4 {
            for (transform, _, of) in clones[form].iter().filter(|(_, at, _)| *at == place) {
                let of = if *of == 0 { "a1" } else { "b1" };
                let _ = write!(out, "<use xlink:href='#{of}' transform='{transform}'/>");
            }
            out.push_str(motifs[form].get(place).unwrap_or(&""));
        }
        out.push_str("</g>");
    }
    out + "</svg>"
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(40), rng_seed: rng_seed(), failure_persistence: None, ..ProptestConfig::default() })]

    /// Order, places and count are those of the paper's algorithm; joining equal neighbours changes
    /// neither.
    #[test]
    fn forms_are_drawn_as_figure_2_says(
        a in proptest::collection::vec(clone(), 1..4),
        b in proptest::collection::vec(clone(), 0..3),
        depth in 1..6usize,
        all in any::<bool>(),
    ) {
        let (_, mut scene) = read(drawing([&a, &b]));
        // Whichever refers to the other.
        scene.forms[0].is_root = true;
        scene.forms[1].is_root = false;
        let mut expected = Vec::new();
        figure_2(&scene.forms, 0, Affine::IDENTITY, depth, all, &mut expected);
        let generations = if all { "all" } else { "last" };
        let params = |merge: &str| [("depth", depth.to_string()), ("generations", generations.to_owned()), ("merge", merge.to_owned())];
        let result = generated("recurse", &scene, &params("false"), 1);
        if expected.is_empty() {
            prop_assert_eq!(result.unwrap_err().code(), "empty-generation");
            return Ok(());
        }
        let artwork = result.unwrap();
        prop_assert_eq!(artwork.counts["elements"], expected.len() as f64);
        let one_by_one = shapes(&artwork);
        prop_assert_eq!(one_by_one.drawn.len(), expected.len());
        prop_assert_eq!(one_by_one.pieces, expected.len());
        for ((_, _, drawn), (_, path)) in one_by_one.drawn.iter().zip(&expected) {
            prop_assert!(are_near(drawn, path, 1e-6), "{} is not {}", drawn.to_svg(), path.to_svg());
        }
        let merged = shapes(&generated("recurse", &scene, &params("true"), 1).unwrap());
        prop_assert!(merged.pieces <= expected.len());
        for (a, b) in merged.drawn.iter().zip(&one_by_one.drawn) {
            // Mirrored ones may run the other way round.
            let turned = b.2.reverse_subpaths();
            prop_assert!(a.1 == b.1 && (are_near(&a.2, &b.2, 1e-6) || are_near(&a.2, &turned, 1e-6)));
        }
    }

    /// Clones and paths show the same.
    #[test]
    fn both_outputs_look_the_same(
        a in proptest::collection::vec(clone(), 1..3),
        b in proptest::collection::vec(clone(), 0..3),
        depth in 1..5usize,
    ) {
        let (document, mut scene) = read(drawing([&a, &b]));
        scene.forms[0].is_root = true;
        scene.forms[1].is_root = false;
        let rendered = |output: &str, merge: &str| {
            let params = [("depth", depth.to_string()), ("output", output.to_owned()), ("merge", merge.to_owned())];
            let artwork = generated("recurse", &scene, &params, 1).unwrap();
            rendered(written(&document, &artwork, ("recurse", &params, 1)).text())
        };
        let (paths, clones) = (rendered("paths", "false"), rendered("clones", "false"));
        prop_assert_eq!(paths.len(), clones.len());
        for (a, b) in paths.iter().zip(&clones) {
            prop_assert_eq!(&a.0, &b.0);
            let size = 0.02 + 0.01 * a.1.width().max(a.1.height());
            let near = |x: f64, y: f64| (x - y).abs() < size;
            prop_assert!(near(a.1.x0, b.1.x0) && near(a.1.y0, b.1.y0) && near(a.1.x1, b.1.x1) && near(a.1.y1, b.1.y1), "{:?} is not {:?}", a, b);
        }
    }
}

/// Paint and box of everything that an independent renderer draws, in order.
fn rendered(svg: &str) -> Vec<(String, Rect)> {
    fn walk(group: &usvg::Group, out: &mut Vec<(String, Rect)>) {
        for node in group.children() {
            match node {
                usvg::Node::Group(group) => walk(group, out),
                usvg::Node::Path(path) => {
                    let paint = |fill: Option<&usvg::Paint>| format!("{fill:?}");
                    let paint = paint(path.fill().map(usvg::Fill::paint))
                        + &paint(path.stroke().map(usvg::Stroke::paint));
                    let r = path.abs_stroke_bounding_box();
                    out.push((
                        paint,
                        Rect::new(r.left().into(), r.top().into(), r.right().into(), r.bottom().into()),
                    ));
                }
                _ => {}
            }
        }
    }
    let tree = usvg::Tree::from_str(svg, &usvg::Options::default()).unwrap();
    let mut out = Vec::new();
    walk(tree.root(), &mut out);
    out
}
