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
                    let (fill, stroke) = (path.fill(), path.stroke());
                    let paint = format!(
                        "{}{}",
                        paint(fill.map(usvg::Fill::paint)),
                        paint(stroke.map(usvg::Stroke::paint))
                    );
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

mod paint {
    use super::*;

    /// Paint, units and effects that a copy must not lose.
    const DRAWING: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" width="400" height="400">
<style>path{stroke:green;stroke-width:3} use{opacity:.9} #leaf{fill:crimson}</style>
<linearGradient id="g" gradientUnits="userSpaceOnUse" x1="20" y1="300" x2="90" y2="300"><stop stop-color="gold"/><stop offset="1" stop-color="navy"/></linearGradient>
<marker id="m" markerWidth="4" markerHeight="4" refX="2" refY="2"><circle cx="2" cy="2" r="2" fill="red"/></marker>
<g color="teal" font-size="20">
<g id="form" class="rinceau-form">
<rect id="r" x="20" y="280" width="70" height="40" fill="url(#g)" stroke="currentColor" stroke-width="0.2em" font-size="10"/>
<rect id="em" x="20" y="270" width="70" height="4" fill="none" stroke="currentColor" stroke-width="0.05em"/>
<line id="l" x1="20" y1="350" x2="90" y2="350" stroke="black" stroke-width="2" marker-end="url(#m)"/>
<circle id="leaf" cx="55" cy="260" r="10"/>
<switch><rect systemLanguage="fr" width="300" height="10"/><rect id="yes" x="20" y="330" width="30" height="5"/></switch>
<rect id="unseen" visibility="hidden" width="5" height="300"/>
<use href="#r" transform="translate(140 -20) rotate(-20 20 280) scale(.8)"/>
</g></g></svg>"##;

    #[test]
    fn is_the_same_in_both_outputs() {
        let draw = |output: &str| {
            let arguments = ["recurse", "--depth", "4", "--merge", "false", "--output", output];
            rendered(support::rinceau(arguments).input(DRAWING).succeed().text())
        };
        let (paths, clones) = (draw("paths"), draw("clones"));
        // The drawing itself and four generations of six shapes; a marker is drawn, too.
        assert_eq!(paths.len(), clones.len());
        assert!(paths.len() > 4 * 6);
        for (a, b) in paths.iter().zip(&clones) {
            assert_eq!(a.0, b.0);
            let corner = (a.1.origin() - b.1.origin()).hypot();
            let near = 0.2 + 0.03 * a.1.width().max(a.1.height());
            assert!(corner < near && (a.1.width() - b.1.width()).abs() < near, "{a:?} is not {b:?}");
        }
    }

    #[test]
    fn that_only_clones_keep_is_named() {
        let image = "<image id='photo' width='20' height='20' href='data:,'/><g filter='url(#f)'><path id='l2' d='M0,0H9'/></g>";
        let drawing = DRAWING.replace("<switch>", &format!("{image}<switch>"));
        let paths = support::rinceau(["recurse", "--depth", "2"]).input(drawing.as_str()).succeed();
        insta::assert_snapshot!(paths.stderr.trim_end(), @"rinceau: note: 'l2' is drawn without its filter; choose clones as result to keep it
rinceau: note: 'photo' is an image and left out; choose clones as result to keep it");
        assert!(!paths.text().contains("rinceau:of=\"photo\""));
        let clones =
            support::rinceau(["recurse", "--depth", "2", "--output", "clones"]).input(drawing).succeed();
        assert_eq!(clones.stderr, "");
        assert!(clones.text().contains("href=\"#photo\""));
    }
}

mod facts {
    use super::*;
    use rinceau::geom::affine::KeepsTacks;
    use rinceau::geom::flatten::flatten;
    use std::collections::BTreeSet;

    fn sample(name: &str) -> Scene {
        let path = support::root().join(format!("samples/recurse/{name}.svg"));
        let (_, mut scene) = read(std::fs::read(&path).unwrap_or_else(|error| panic!("{name}: {error}")));
        // As it is drawn, where it is drawn.
        scene.containers.clear();
        scene
    }

    /// Everything a form of a sample draws, one by one.
    fn drawn(name: &str, params: &[(&str, &str)]) -> Vec<Drawn> {
        let mut scene = sample(name);
        scene.forms.iter_mut().for_each(|form| {
            form.overrides.retain(|name, _| !params.iter().any(|(param, _)| param == name) && name != "join");
        });
        let mut params: Vec<(&str, String)> =
            params.iter().map(|&(name, value)| (name, value.to_owned())).collect();
        params.push(("merge", "false".to_owned()));
        shapes(&generated("recurse", &scene, &params, 1).unwrap()).drawn
    }

    fn clones(form: &Form) -> Vec<(usize, Affine)> {
        let clone = |item: &FormItem| match item {
            FormItem::Clone(clone) => Some((clone.form, clone.transform)),
            FormItem::Primitive(_) => None,
        };
        form.items.iter().filter_map(clone).collect()
    }

    fn ratio(map: Affine) -> f64 {
        map.determinant().abs().sqrt()
    }

    /// Figure 7 c to e (R-035): the ratios at which squares fill the sides of others are roots of
    /// 1 = r, 1 = r + r^2, 1 = r + r^2 + r^3 and so on, down to a half.
    #[test]
    fn squares_resonate_at_the_golden_ratio_and_its_kin() {
        for (name, terms) in [("fig7-c-golden", 2), ("fig7-d-three", 3), ("fig7-e-limit", 60)] {
            let scene = sample(name);
            for (_, map) in clones(&scene.forms[root(&scene)]) {
                let sum: f64 = (1..=terms).map(|n| ratio(map).powi(n)).sum();
                assert!((sum - 1.0).abs() < 1e-5, "{name}: {sum}");
            }
        }
        let scene = sample("fig7-d-three");
        assert!((ratio(clones(&scene.forms[0])[0].1) - 0.5437).abs() < 1e-4);
    }

    /// The squares of Figure 7c lie side by side: none overlaps another.
    #[test]
    fn golden_squares_do_not_overlap() {
        let boxes: Vec<Rect> = drawn("fig7-c-golden", &[("depth", "6")])
            .iter()
            .map(|(_, _, path)| path.bounding_box())
            .collect();
        assert_eq!(boxes.len(), 63);
        let side = boxes.iter().fold(0.0_f64, |most, rect| most.max(rect.width()));
        let distinct = distinct(
            boxes
                .iter()
                .map(|rect| [rect.x0, rect.y0, rect.width()].map(|v| (v / side * 1e4).round() as i64)),
        );
        for (i, a) in boxes.iter().enumerate() {
            for b in &boxes[..i] {
                let shared = a.intersect(*b).size();
                let is_same = (a.x0 - b.x0).abs() + (a.y0 - b.y0).abs() < 1e-3 * side
                    && (a.width() - b.width()).abs() < 1e-3 * side;
                assert!(is_same || shared.width.min(shared.height) < 1e-3 * side, "{a:?} and {b:?}");
            }
        }
        assert!(distinct > 20);
    }

    fn distinct<T: Ord>(items: impl Iterator<Item = T>) -> usize {
        items.collect::<BTreeSet<T>>().len()
    }

    /// Figure 7 p and r (R-037): within the pattern, the last generation is mapped onto itself by
    /// two translations, a quarter turn, and mirrors along and across.
    #[test]
    fn the_last_generation_of_the_compact_tree_has_the_symmetry_p4mm() {
        for name in ["fig7-p-halfway", "fig7-r-last"] {
            let drawn = drawn(name, &[("depth", "11"), ("generations", "last"), ("colours", "drawn")]);
            let centres: Vec<Point> = drawn.iter().map(|(_, _, path)| path.bounding_box().center()).collect();
            let shape = |path: &BezPath| path.bounding_box().size();
            let all = drawn.iter().map(|(_, _, path)| path.bounding_box()).reduce(|a, b| a.union(b)).unwrap();
            // Long and short side of each tell which way it lies; directions are not told apart.
            let lies: Vec<(Point, bool)> = centres
                .iter()
                .zip(&drawn)
                .map(|(&c, (_, _, path))| (c, shape(path).width > shape(path).height))
                .collect();
            let near = 0.02 * (all.area() / drawn.len() as f64).sqrt();
            let has = |p: Point, flat: bool| lies.iter().any(|&(q, f)| f == flat && p.distance(q) < near);
            let reach = 0.16 * all.width().min(all.height());
            let middle = Point::new(all.center().x, all.y0 + 0.62 * all.height());
            let middle = if name == "fig7-p-halfway" {
                Point::new(all.center().x, all.y0 + 0.38 * all.height())
            } else {
                middle
            };
            let inner: Vec<(Point, bool)> =
                lies.iter().copied().filter(|(p, _)| p.distance(middle) < reach).collect();
            assert!(inner.len() > 12, "{name}: {}", inner.len());
            let maps = |map: Affine, turns: bool| inner.iter().all(|&(p, flat)| has(map * p, flat != turns));
            let mut centre = None;
            'search: for (i, &(a, _)) in inner.iter().enumerate() {
                for &(b, _) in &inner[i..] {
                    let c = a.midpoint(b);
                    let about =
                        |map: Affine| Affine::translate(c.to_vec2()) * map * Affine::translate(-c.to_vec2());
                    let quarter = Affine::new([0.0, 1.0, -1.0, 0.0, 0.0, 0.0]);
                    if c.distance(middle) < reach
                        && maps(about(quarter), true)
                        && maps(about(Affine::FLIP_X), false)
                        && maps(about(Affine::FLIP_Y), false)
                    {
                        centre = Some(c);
                        break 'search;
                    }
                }
            }
            assert!(centre.is_some(), "{name}: no centre of symmetry among {} pieces", inner.len());
            let steps = inner.iter().map(|&(p, _)| p - inner[0].0).filter(|step| step.hypot() > near);
            let mut translations = steps.filter(|&step| maps(Affine::translate(step), false));
            let first = translations.next().unwrap_or_else(|| panic!("{name}: no translation"));
            assert!(
                translations.any(|step| step.cross(first).abs() > near * first.hypot()),
                "{name}: only one translation"
            );
        }
    }

    /// Figure 7z (R-038): every generation of the twindragon covers the motif's area once.
    #[test]
    fn the_twindragon_has_the_area_of_its_motif_and_no_overlap() {
        let area = |path: &BezPath| path.area().abs();
        let last = drawn("fig7-z-twindragon", &[("depth", "11")]);
        assert_eq!(last.len(), 1 << 10);
        let whole: f64 = last.iter().map(|(_, _, path)| area(path)).sum();
        let scene = sample("fig7-z-twindragon");
        let motif = |form: &Form| {
            form.items.iter().find_map(|item| match item {
                FormItem::Primitive(drawn) => Some(drawn.part.transform * drawn.part.path.clone()),
                FormItem::Clone(_) => None,
            })
        };
        // Two halves, each half as large as the motif of its form.
        let (dark, light) = (motif(&scene.forms[1]).unwrap(), motif(&scene.forms[2]).unwrap());
        assert!((whole / (0.5 * (area(&dark) + area(&light))) - 1.0).abs() < 1e-4);
        let side = area(&last[0].2).sqrt();
        let places = distinct(last.iter().map(|(_, _, path)| {
            let c = path.bounding_box().center();
            [c.x, c.y].map(|v| (v / side * 4.0).round() as i64)
        }));
        assert_eq!(places, last.len(), "no two squares in one place");
        for (_, _, path) in &last {
            assert!(
                (area(path).sqrt() / side - 1.0).abs() < 1e-3,
                "all of one size, so that those in different places of the grid do not overlap"
            );
        }
    }

    /// Figure 9 (R-040): every segment of the path takes a clone in four ways, that is 4^3 squigs.
    #[test]
    fn there_are_64_squigs_of_three_segments() {
        let scene = sample("fig9-b-squig");
        let form = &scene.forms[root(&scene)];
        let Some(FormItem::Primitive(motif)) = form.items.first() else { panic!("a motif") };
        let motif = &flatten(&(motif.part.transform * motif.part.path.clone()), 0.01)[0].points;
        assert_eq!(motif.len(), 4);
        let (start, end) = (motif[0], motif[3]);
        let lay = |a: Point, b: Point, how: KeepsTacks| {
            let straight = rinceau::geom::affine::drag_about(a, a + (end - start), b, 1e-9).unwrap();
            how.about((a, b), 1e-9).unwrap() * straight * Affine::translate(a - start)
        };
        let segments: Vec<(Point, Point)> = motif.windows(2).map(|pair| (pair[0], pair[1])).collect();
        let mut squigs = BTreeSet::new();
        for first in KeepsTacks::ALL {
            for second in KeepsTacks::ALL {
                for third in KeepsTacks::ALL {
                    let maps: Vec<Affine> = segments
                        .iter()
                        .zip([first, second, third])
                        .map(|(&(a, b), how)| lay(a, b, how))
                        .collect();
                    // The nine segments of the third generation tell squigs apart.
                    let mut drawn: Vec<[i64; 4]> = Vec::new();
                    for &m in &maps {
                        for &n in &maps {
                            for &(a, b) in &segments {
                                let (p, q) = (m * n * a, m * n * b);
                                let ends = [(p, q), (q, p)]
                                    .map(|(p, q)| [p.x, p.y, q.x, q.y].map(|v| (v * 1e3).round() as i64));
                                drawn.push(ends[0].min(ends[1]));
                            }
                        }
                    }
                    drawn.sort_unstable();
                    squigs.insert(drawn);
                }
            }
        }
        assert_eq!(squigs.len(), 64);
        // The first squig's clones are three of those ways; and the squares of lengths add up to one:
        // the curves have the dimension of a plane.
        let ways: Vec<Affine> =
            segments.iter().flat_map(|&(a, b)| KeepsTacks::ALL.map(|how| lay(a, b, how))).collect();
        for (_, map) in clones(form) {
            assert!(ways.iter().any(|way| (*way * start).distance(map * start)
                + (*way * motif[1]).distance(map * motif[1])
                < 1e-2));
        }
        assert!(
            (clones(form).iter().map(|(_, map)| map.determinant().abs()).sum::<f64>() - 1.0).abs() < 1e-4
        );
    }

    /// Penrose's rhombs by halves: areas add up, and there are 1, 2, 5, 13, 34 (Fibonacci numbers).
    #[test]
    fn penrose_triangles_are_counted_by_fibonacci_numbers() {
        fn count(forms: &[Form], form: usize, depth: usize) -> usize {
            if depth == 0 {
                1
            } else {
                clones(&forms[form]).iter().map(|&(other, _)| count(forms, other, depth - 1)).sum()
            }
        }
        let scene = sample("penrose");
        let two = scene.forms.iter().position(|form| clones(form).len() == 2).expect("a triangle of two");
        let counts: Vec<usize> = (0..5).map(|depth| count(&scene.forms, two, depth)).collect();
        assert_eq!(counts, [1, 2, 5, 13, 34]);
        // What a triangle is divided into is as large as the triangle.
        let golden = (5_f64.sqrt() - 1.0) / 2.0;
        for form in scene.forms.iter().filter(|form| (2..4).contains(&clones(form).len())) {
            for (_, map) in clones(form) {
                let [a, b, ..] = map.as_coeffs();
                assert!(
                    (a.hypot(b) - golden).abs() < 1e-4
                        || (map.determinant().abs() - golden * golden).abs() < 1e-4
                );
            }
        }
    }

    /// Hilbert's curve joined visits every cell of its square once, a step at a time.
    #[test]
    fn the_joined_hilbert_curve_visits_every_cell_once() {
        let mut scene = sample("fig8-b-hilbert-joined");
        let overrides: Vec<_> =
            scene.forms.iter_mut().map(|form| std::mem::take(&mut form.overrides)).collect();
        let get = |name: &str| overrides.iter().find_map(|own| own.get(name)).cloned();
        let params: Vec<(&str, String)> = ["generations", "join"]
            .into_iter()
            .filter_map(|name| Some((name, get(name)?)))
            .chain([("depth", "5".to_owned())])
            .collect();
        let artwork = generated("recurse", &scene, &params, 1).unwrap();
        let lines: Vec<BezPath> = artwork
            .groups
            .iter()
            .flat_map(|group| &group.items)
            .flat_map(|item| &item.parts)
            .map(|part| part.path.clone())
            .collect();
        let [line] = &lines[..] else { panic!("{} lines", lines.len()) };
        let nodes = points(line);
        let step = nodes.windows(2).map(|pair| pair[0].distance(pair[1])).fold(f64::INFINITY, f64::min);
        let mut cells = BTreeSet::new();
        for pair in nodes.windows(2) {
            let steps = (pair[0].distance(pair[1]) / step).round();
            for i in 0..steps as usize {
                let p = pair[0].lerp(pair[1], i as f64 / steps);
                assert!(
                    cells.insert([p.x, p.y].map(|v| (v / step * 4.0).round() as i64)),
                    "a cell is visited twice"
                );
            }
            assert!(
                (pair[0].x - pair[1].x).abs() < 1e-3 * step || (pair[0].y - pair[1].y).abs() < 1e-3 * step
            );
        }
        assert_eq!(cells.len() + 1, 4_usize.pow(5));
    }

    /// Figure 3 (R-011): polygons and clones in the paper's order.
    #[test]
    fn the_planes_are_listed_as_in_figure_3() {
        let scene = sample("fig3-planes");
        let kinds: String = scene.forms[0]
            .items
            .iter()
            .map(|item| if matches!(item, FormItem::Clone(_)) { 'c' } else { 'p' })
            .collect();
        assert_eq!(kinds, "ppcpppcpc");
        assert!(clones(&scene.forms[0]).iter().all(|(_, map)| (ratio(*map) - 0.5).abs() < 1e-6));
    }
}

/// A chain of clones grows by a line for each generation and form, however many copies that are.
#[test]
fn a_chain_of_clones_grows_with_the_depth_alone() {
    let name = samples_of("recurse").into_iter().find(|path| path.ends_with("fig7-a-tree.svg")).unwrap();
    let (document, mut scene) = read(std::fs::read(name).unwrap());
    scene.forms[0].overrides.clear();
    let size = |depth: usize| {
        let params =
            [("depth", depth.to_string()), ("output", "clones".to_owned()), ("most", "1e15".to_owned())];
        let artwork = generated("recurse", &scene, &params, 1).unwrap();
        assert_eq!(artwork.symbols.len(), depth);
        written(&document, &artwork, ("recurse", &params, 1)).text().len()
    };
    let (twenty, forty) = (size(20), size(40));
    assert!(forty - twenty < 20 * 600, "{} bytes for 20 generations", forty - twenty);
}

/// Without a form, a rosette goes into the selected shape, and not over its outline.
#[test]
fn a_shape_alone_is_filled() {
    let drawing = support::svg("<path id='panel' d='M20,20H180L100,180Z' fill='#eeeeee'/>");
    let done = support::rinceau(["recurse", "--id", "panel"]).input(drawing.as_str()).succeed();
    let (_, scene) = support::geometry::read(drawing.replace("id='panel'", "class='rinceau-container'"));
    let container = rinceau::geom::region::Region::new(support::geometry::contours(
        &scene.containers[0].outlines[0].path,
    ))
    .unwrap();
    let artwork = support::geometry::generated("recurse", &scene, &[], 1).unwrap();
    let written = support::geometry::written(
        &support::geometry::read(drawing.clone()).0,
        &artwork,
        ("recurse", &[], 1),
    );
    let xml = support::parse(written.text());
    let pieces = xml.descendants().filter(|node| node.has_attribute((support::RINCEAU, "of")));
    let pieces: Vec<_> = pieces.collect();
    assert!(pieces.len() > 5, "{}", pieces.len());
    for piece in pieces {
        let path = kurbo::BezPath::from_svg(piece.attribute("d").unwrap()).unwrap();
        for contour in support::geometry::contours(&path) {
            assert!(contour.iter().all(|&p| container.contains(p)), "{:?}", piece.attribute("id"));
        }
    }
    assert!(support::rinceau(["update"]).input(done.text()).succeed().text() == done.text());
    let clones = support::rinceau(["recurse", "--id", "panel", "--output", "clones"]).input(drawing).done();
    assert!(clones.code == Some(1) && clones.stderr.contains("[no-form]"));
}
