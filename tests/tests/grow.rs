//! Growth by rules: nothing leaves its panel, nothing overlaps but where it is attached, symmetric
//! growth is symmetric, rules are fenced in, and errors say where the author went wrong.

mod support;

use kurbo::{Affine, BezPath, ParamCurve, Point, Shape};
use proptest::prelude::*;
use rinceau::geom::region::Region;
use rinceau::geom::segment::{crosses, point_segment};
use rinceau::grow::{Design, Params};
use rinceau::{Deadline, Rng, quality};
use rinceau_format::{Artwork, Error, RuleSet, Scene};
use support::geometry::{
    assert_drawn_inside, blob, cases, contours, generated, pieces, read, rng_seed, waves,
};
use support::{RINCEAU, layers, parse, rinceau, svg};

const PATTERNS: [&str; 7] = ["dots", "flower", "spiral", "vines", "vase", "willow", "willow-planned"];

const STYLES: [&str; 8] = ["drawn", "outline", "brush", "ribbon", "rope", "leafy", "beads", "acanthus"];

/// A square of a hundred units of the rules.
const PANEL: &str = "<path id='panel' class='rinceau-container' d='M0,0H400V400H0Z' fill='#eeeeee'/>";

fn grown(scene: &Scene, params: &[(&str, &str)], seed: u64) -> Result<Artwork, Error> {
    let params: Vec<(&str, String)> = params.iter().map(|&(name, value)| (name, value.to_owned())).collect();
    generated("grow", scene, &params, seed)
}

/// A scene with rules of its own.
fn scene_with(rules: &str) -> Scene {
    let (_, mut scene) = read(svg(PANEL));
    scene.rules.push(RuleSet { name: "own".into(), text: rules.into() });
    scene
}

/// Elements by type, as their proxies lie in the drawing.
fn proxies(artwork: &Artwork) -> Vec<(String, BezPath)> {
    let items = &artwork.group("proxies").expect("proxies").items;
    items.iter().map(|item| (item.of.clone(), item.parts[0].path.clone())).collect()
}

/// Discs among the proxies: centre and radius.
fn discs(artwork: &Artwork, kind: &str) -> Vec<(Point, f64)> {
    let of_kind = proxies(artwork).into_iter().filter(|(of, _)| of == kind);
    of_kind.map(|(_, path)| (path.bounding_box().center(), 0.5 * path.bounding_box().width())).collect()
}

/// True for the outline of a circle.
fn is_disc(path: &BezPath) -> bool {
    let bounds = path.bounding_box();
    path.elements().len() > 4
        && (path.area().abs() - std::f64::consts::PI * 0.25 * bounds.area()).abs() < 0.01 * bounds.area()
}

fn region(path: &str) -> Region {
    let path = BezPath::from_svg(path).unwrap();
    Region::new(rinceau::geom::boolean::simplified(&contours(&path), true)).unwrap()
}

/// Lines that cross, but where one of them is attached: near an end of one.
fn crossing(a: &[Vec<Point>], b: &[Vec<Point>], joint: f64) -> Option<Point> {
    let ends = |lines: &[Vec<Point>]| -> Vec<Point> {
        lines.iter().flat_map(|line| [line[0], line[line.len() - 1]]).collect()
    };
    let ends: Vec<Point> = ends(a).into_iter().chain(ends(b)).collect();
    for s in a.iter().flat_map(|line| line.windows(2)) {
        for t in b.iter().flat_map(|line| line.windows(2)) {
            if crosses(s[0], s[1], t[0], t[1]) {
                let at = s[0].midpoint(s[1]);
                // What leaves a joint nearly along the other line is near it for longer.
                let angle = (s[1] - s[0]).normalize().cross((t[1] - t[0]).normalize()).abs();
                let reach = joint / angle.max(0.2) + s[0].distance(s[1]);
                if ends.iter().all(|end| end.distance(at) > reach) {
                    return Some(at);
                }
            }
        }
    }
    None
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(14), failure_persistence: None, rng_seed: rng_seed(), ..ProptestConfig::default() })]

    /// In any panel, with any pattern: all inside, clear of what is fixed, and no two elements over
    /// each other but those that may.
    #[test]
    fn what_grows_keeps_to_its_place(
        outer in waves(), hole in waves(), hole_radius in 20.0..70.0f64, seed in 0..1000u64,
        pattern in prop::sample::select(PATTERNS.to_vec()), unit in 4.0..9.0f64,
        style in prop::sample::select(STYLES.to_vec()),
    ) {
        let hole = if hole_radius > 30.0 { blob((200.0, 200.0), hole_radius, &hole) } else { String::new() };
        let shape = format!("{}{hole}", blob((200.0, 200.0), 150.0, &outer));
        let fixed = "<circle class='rinceau-fixed' cx='120' cy='200' r='14'/>";
        let (_, scene) = read(svg(&format!("<path class='rinceau-container' fill-rule='evenodd' d='{shape}'/>{fixed}")));
        let artwork = match grown(&scene, &[("rules", pattern), ("rule-unit", &unit.to_string()), ("style", style)], seed) {
            Ok(artwork) => artwork,
            // A panel may be too small for a pattern, and that has a sentence.
            Err(error) => { prop_assert!(error.to_string().contains("Nothing grows"), "{error}"); return Ok(()); }
        };
        let panel = region(&shape);
        let drawn = proxies(&artwork);
        let lines: Vec<Vec<Vec<Point>>> = drawn.iter().map(|(_, path)| contours(path)).collect();
        for group in ["proxies", "elements"] {
            for (i, item) in artwork.group(group).expect(group).items.iter().enumerate() {
                let name = format!("{pattern} as {style}: {} {i} of the {group}", item.of);
                item.parts.iter().for_each(|part| assert_drawn_inside(&name, part, &panel));
            }
        }
        for pair in lines.iter().flatten().flat_map(|line| line.windows(2)) {
            prop_assert!(point_segment(Point::new(120.0, 200.0), pair[0], pair[1]) > 14.0);
        }
        // Elements that may lie over others are so by their pattern's word.
        if pattern == "willow" { return Ok(()); }
        for i in 0..lines.len() {
            for j in 0..i {
                let apart = drawn[i].1.bounding_box().inflate(0.1, 0.1).overlaps(drawn[j].1.bounding_box());
                if !apart || drawn[i].0 != drawn[j].0 {
                    continue;
                }
                if is_disc(&drawn[i].1) && is_disc(&drawn[j].1) {
                    let of = |path: &BezPath| (path.bounding_box().center(), 0.5 * path.bounding_box().width());
                    let ((p, r), (q, s)) = (of(&drawn[i].1), of(&drawn[j].1));
                    prop_assert!(p.distance(q) - r - s > -0.01, "{pattern}: {} {i} and {j} overlap", drawn[i].0);
                    continue;
                }
                let at = crossing(&lines[i], &lines[j], 0.3 * unit);
                prop_assert!(at.is_none(), "{pattern}: {} {i} and {j} cross at {at:?}", drawn[i].0);
            }
        }
    }

    /// Dots touch and never overlap, exactly.
    #[test]
    fn dots_do_not_overlap(outer in waves(), seed in 0..1000u64) {
        let shape = blob((200.0, 200.0), 150.0, &outer);
        let (_, scene) = read(svg(&format!("<path class='rinceau-container' d='{shape}'/>")));
        let artwork = grown(&scene, &[("rules", "dots")], seed).unwrap();
        let dots = discs(&artwork, "dot");
        prop_assert!(dots.len() > 300);
        for (i, &(p, r)) in dots.iter().enumerate() {
            let nearest = dots.iter().enumerate().filter(|&(j, _)| j != i)
                .map(|(_, &(q, s))| p.distance(q) - r - s).fold(f64::INFINITY, f64::min);
            prop_assert!(nearest > -1e-3, "dot {i} overlaps by {}", -nearest);
            prop_assert!(nearest < 1e-3, "dot {i} touches nothing");
        }
    }

    /// Any rule file gives an ornament or a sentence, and ends.
    #[test]
    fn any_rules_end(text in "[a-zé“˜%$(){};=+*/<>\\-\\. \n0-9\"&|!,:~?]{0,300}") {
        let file = format!("element seed: point\nelement dot: circle\nrule seed -> dot d {{ {text} }}");
        let printed = format!("%element\nseed point\n%endelement\n%element\ndot circle\n%endelement\n%rule\nseed --> dot\n{{ {text} }}\n%endrule");
        for file in [file, printed, text] {
            let _ = grown(&scene_with(&file), &[("rules", "own")], 1);
        }
    }
}

#[test]
fn the_same_seed_grows_the_same_and_styles_do_not_matter() {
    let (_, scene) = read(svg(PANEL));
    for pattern in PATTERNS {
        let draw = |style: &str| grown(&scene, &[("rules", pattern), ("style", style)], 7).unwrap();
        let (one, two, rope) = (draw("drawn"), draw("drawn"), draw("rope"));
        assert_eq!(format!("{:?}", one.groups), format!("{:?}", two.groups), "{pattern}");
        assert_eq!(format!("{:?}", proxies(&one)), format!("{:?}", proxies(&rope)), "{pattern}");
    }
}

/// What has grown once is drawn in one style after another, as if it had grown in each.
#[test]
fn a_design_is_restyled_without_growing_again() {
    let (_, scene) = read(svg(PANEL));
    let own = |style| {
        Params::default().overridden([("rules", "vines"), ("style", style), ("palette", "ink")]).unwrap()
    };
    let design = Design::grow(&own("drawn"), &scene, &mut Rng::new(7), &mut Deadline::new(None)).unwrap();
    let mut seen: Vec<String> = Vec::new();
    for style in ["drawn", "outline", "brush", "ribbon", "rope", "leafy", "beads", "acanthus"] {
        let restyled = design.draw(&own(style), &scene).unwrap();
        let grown = grown(&scene, &[("rules", "vines"), ("style", style), ("palette", "ink")], 7).unwrap();
        let drawn = format!("{:?}", restyled.groups);
        assert_eq!(drawn, format!("{:?}", grown.groups), "{style}");
        assert!(!seen.contains(&drawn), "{style} looks like another");
        seen.push(drawn);
    }
}

/// A plain greedy packing of circles, largest place first, with the same largest and smallest radius,
/// covers less.
#[test]
fn dots_cover_more_than_greedy_circles() {
    let (_, scene) = read(svg(PANEL));
    let artwork = grown(&scene, &[("rules", "dots"), ("edge", "0.004")], 1).unwrap();
    let dots = discs(&artwork, "dot");
    let covered: f64 = dots.iter().map(|(_, r)| std::f64::consts::PI * r * r).sum::<f64>() / 160_000.0;
    let smallest = dots.iter().map(|dot| dot.1).fold(f64::INFINITY, f64::min) / 4.0;
    assert!(smallest > 0.499, "{smallest}");
    let greedy = greedy(100.0, 0.25, 3.0, 0.5);
    assert!(covered > greedy, "dots cover {covered:.3}, greedy circles {greedy:.3}");
    let measures = quality::measure(&scene, &artwork).unwrap();
    assert!(
        (measures["coverage"] - covered).abs() < 0.02,
        "{} is measured as {}",
        covered,
        measures["coverage"]
    );
    println!("dots cover {covered:.4}, greedy circles {greedy:.4}");
}

/// The share of a square that circles cover which are placed one by one in the middle of the largest
/// place there is.
fn greedy(side: f64, cell: f64, largest: f64, smallest: f64) -> f64 {
    let n = (side / cell) as usize;
    let middle = |i: usize| Point::new(((i % n) as f64 + 0.5) * cell, ((i / n) as f64 + 0.5) * cell);
    let mut room: Vec<f64> = (0..n * n)
        .map(|i| {
            let p = middle(i);
            p.x.min(p.y).min(side - p.x).min(side - p.y)
        })
        .collect();
    let mut covered = 0.0;
    loop {
        let best = (0..n * n).max_by(|&a, &b| room[a].total_cmp(&room[b])).unwrap();
        if room[best] < smallest {
            return covered / (side * side);
        }
        let (center, radius) = (middle(best), room[best].min(largest));
        covered += std::f64::consts::PI * radius * radius;
        for (i, room) in room.iter_mut().enumerate() {
            *room = room.min(middle(i).distance(center) - radius);
        }
    }
}

mod symmetry {
    use super::*;

    /// Every image of every disc is a disc, for all groups that map the panel onto itself.
    #[test]
    fn rosettes_are_mapped_onto_themselves() {
        let (_, scene) = read(svg("<circle class='rinceau-container' cx='200' cy='200' r='190'/>"));
        let center = Affine::translate((200.0, 200.0));
        for (name, turns, is_mirrored) in
            [("c5", 5, false), ("d6", 6, true), ("c2", 2, false), ("mirror", 1, true)]
        {
            let artwork = grown(&scene, &[("rules", "vines"), ("symmetry", name)], 1).unwrap();
            let flowers: Vec<Point> =
                pieces(&artwork, "elements").iter().map(|piece| middle(piece)).collect();
            let turn = center * Affine::rotate(std::f64::consts::TAU / f64::from(turns)) * center.inverse();
            assert_all_there(&flowers, turn, name);
            if is_mirrored {
                assert_all_there(
                    &flowers,
                    center * Affine::scale_non_uniform(-1.0, 1.0) * center.inverse(),
                    name,
                );
            }
        }
    }

    fn middle(piece: &[Vec<Point>]) -> Point {
        let points: Vec<Point> = piece.iter().flatten().copied().collect();
        let sum = points.iter().fold(kurbo::Vec2::ZERO, |sum, p| sum + p.to_vec2());
        (sum / points.len() as f64).to_point()
    }

    fn assert_all_there(points: &[Point], by: Affine, name: &str) {
        for &p in points {
            let image = by * p;
            assert!(
                points.iter().any(|q| q.distance(image) < 0.05),
                "{name}: no image of {p:?} at {image:?}"
            );
        }
    }

    /// Modules along each side, corners alike and mirrored, all within the frame.
    #[test]
    fn frames_repeat_along_their_sides_and_solve_their_corners() {
        let frame = "M10,10H570V350H10ZM70,70V290H510V70Z";
        let own = include_str!("../../samples/grow/half-open-frame.svg");
        for (name, shape, period, side) in [("vines", frame, 110.0, 60.0), ("half-open", "", 220.0, 100.0)] {
            let (scene, params, shape) = match name {
                "half-open" => (read(own).1, vec![], "M10,10H650V430H10ZM110,110V330H550V110Z"),
                _ => {
                    let frame = format!("<path class='rinceau-container' fill-rule='evenodd' d='{shape}'/>");
                    let params =
                        vec![("rules", "vines"), ("symmetry", "frame"), ("repeats", "4"), ("rule-unit", "3")];
                    (read(svg(&frame)).1, params, shape)
                }
            };
            let artwork = grown(&scene, &params, 1).unwrap();
            assert!(artwork.warnings.is_empty(), "{:?}", artwork.warnings);
            let panel = region(shape);
            for item in &artwork.group("elements").unwrap().items {
                item.parts.iter().for_each(|part| assert_drawn_inside(name, part, &panel));
            }
            let all: Vec<Point> = pieces(&artwork, "elements").iter().map(|piece| middle(piece)).collect();
            let bounds = panel.bounds();
            let center = Affine::translate(bounds.center().to_vec2());
            for (x, y) in [(-1.0, 1.0), (1.0, -1.0)] {
                assert_all_there(&all, center * Affine::scale_non_uniform(x, y) * center.inverse(), name);
            }
            let in_box = |x0: f64, x1: f64, y1: f64| -> Vec<Point> {
                let is_in = |p: &&Point| (x0..x1).contains(&p.x) && (10.0..y1).contains(&p.y);
                all.iter().filter(is_in).copied().collect()
            };
            let (start, end) = (10.0 + side, bounds.x1 - side - period);
            let first = in_box(start, start + period, start);
            assert!(first.len() > 20, "{name}: {}", first.len());
            let mut at = start;
            while at < end - 1.0 {
                at += period;
                let module = in_box(at, at + period, start);
                assert_eq!(module.len(), first.len(), "{name}");
                let is_there = |p: &Point| {
                    let back = Point::new(p.x - (at - start), p.y);
                    first.iter().any(|q| q.distance(back) < 0.05)
                };
                assert!(module.iter().all(is_there), "{name}");
            }
            let corner = in_box(10.0, start, start);
            assert!(corner.len() > 4, "{name}");
            // Down the diagonal.
            assert_all_there(&corner, Affine::new([0.0, 1.0, 1.0, 0.0, 0.0, 0.0]), name);
        }
    }

    /// Found by fuzzing.
    #[test]
    fn a_type_that_a_statement_took_in_is_missed() {
        let rules = "let llest 1.0\nelement seed: point\nlet a = 1;\nelement tip: point\nrule tip -> { true }\nlook tip: art dot";
        let error = grown(&scene_with(rules), &[], 1).unwrap_err().to_string();
        assert!(
            error.contains("2:9: the element type 'seed' is not declared where it seems to be"),
            "{error}"
        );
    }

    #[test]
    fn a_frame_needs_a_hole() {
        let (_, scene) = read(svg(PANEL));
        let error = grown(&scene, &[("symmetry", "frame")], 1).unwrap_err().to_string();
        assert!(error.contains("needs a frame: a shape with a hole"), "{error}");
    }

    /// What crosses one side of a tile crosses the other.
    #[test]
    fn bands_and_wallpapers_have_no_seam() {
        let half_open = include_str!("../../samples/grow/half-open-band.svg");
        for (name, height) in [
            ("half-open", 130.0),
            ("p111", 120.0),
            ("pma2", 120.0),
            ("pmm2", 120.0),
            ("p1", 400.0),
            ("pgg", 400.0),
            ("p4m", 400.0),
            ("cmm", 400.0),
        ] {
            let (scene, params) = match name {
                "half-open" => (read(half_open).1, vec![]),
                name => (
                    read(svg(&format!("<rect class='rinceau-container' width='400' height='{height}'/>"))).1,
                    vec![("rules", "vines"), ("symmetry", name), ("rule-unit", "4")],
                ),
            };
            let width = scene.containers[0].outlines[0].path.bounding_box().width();
            let artwork = grown(&scene, &params, 1).unwrap();
            let all = pieces(&artwork, "elements");
            let crossing = |x: f64| {
                let is_over = |piece: &&Vec<Vec<Point>>| {
                    let xs = || piece.iter().flatten().map(|p| p.x);
                    xs().fold(f64::INFINITY, f64::min) < x - 0.2
                        && xs().fold(f64::NEG_INFINITY, f64::max) > x + 0.2
                };
                let mut found: Vec<Point> = all
                    .iter()
                    .filter(is_over)
                    .map(|piece| middle(piece))
                    .map(|p| Point::new(p.x - x, p.y))
                    .collect();
                found.sort_by(|a, b| a.y.total_cmp(&b.y));
                found
            };
            let (left, right) = (crossing(0.0), crossing(width));
            assert_eq!(left.len(), right.len(), "{name}");
            // A mirror on the side keeps everything off it.
            assert!(!left.is_empty() || matches!(name, "pma2" | "pmm2" | "p4m" | "cmm"), "{name}");
            for (a, b) in left.iter().zip(&right) {
                assert!(a.distance(*b) < 0.2, "{name}: {a:?} and {b:?}");
            }
        }
    }
}

/// A reshaped panel is filled anew in its layer.
#[test]
fn update_grows_into_a_reshaped_panel() {
    let once =
        rinceau(["grow", "--rules", "dots", "--seed", "3"]).input(svg(PANEL)).succeed().text().to_owned();
    let reshaped = once.replace("M0,0H400V400H0Z", "M0,0H400V200H0Z");
    let twice = rinceau(["update"]).input(reshaped).succeed().text().to_owned();
    let xml = parse(&twice);
    let [layer] = layers(&xml)[..] else { panic!("one layer") };
    assert_eq!(layer.attribute((RINCEAU, "seed")), Some("3"));
    let lowest = layer
        .descendants()
        .filter_map(|node| node.attribute("d"))
        .map(|d| BezPath::from_svg(d).unwrap().bounding_box().y1)
        .fold(0.0, f64::max);
    assert!(lowest > 180.0 && lowest < 200.0, "{lowest}");
}

/// Growth starts where seeds are, goes along drawn stems, and is drawn with what the artist drew.
#[test]
fn what_the_artist_draws_is_used() {
    let seeds = "<circle class='rinceau-seed' cx='50' cy='60' r='2'/><circle class='rinceau-seed' cx='340' cy='300' r='2'/>";
    let (_, scene) = read(svg(&format!("{PANEL}{seeds}")));
    let dots = discs(&grown(&scene, &[("rules", "dots")], 1).unwrap(), "dot");
    assert!(
        dots[0].0.distance(Point::new(50.0, 60.0)) < 1e-6
            && dots[1].0.distance(Point::new(340.0, 300.0)) < 1e-6
    );

    let stem = "<path class='rinceau-stem' d='M20,380C100,100 300,300 380,20' fill='none'/>";
    let (_, scene) = read(svg(&format!("{PANEL}{stem}")));
    let artwork = grown(&scene, &[("rules", "spiral")], 1).unwrap();
    let drawn = BezPath::from_svg("M20,380C100,100 300,300 380,20").unwrap();
    let along = drawn.segments().next().unwrap();
    let (of, first) = &proxies(&artwork)[0];
    assert_eq!(of, "arm");
    let grown_along = first.segments().next().unwrap();
    assert!(
        (0..=4).all(|k| along.eval(f64::from(k) / 4.0).distance(grown_along.eval(f64::from(k) / 4.0)) < 1e-6)
    );

    // One that runs over the edge is kept as far as it is inside, and seeds beside it count.
    let stem = "<path class='rinceau-stem' d='M200,420C200,300 200,200 200,100' fill='none'/><circle class='rinceau-seed' cx='60' cy='60' r='2'/>";
    let (_, scene) = read(svg(&format!("{PANEL}{stem}")));
    let drawn = proxies(&grown(&scene, &[("rules", "spiral")], 1).unwrap());
    let is_upright = |path: &BezPath| path.bounding_box().width() < 0.1 && path.bounding_box().height() > 5.0;
    assert!(drawn.iter().filter(|(_, path)| is_upright(path)).count() > 8, "the part inside");
    let near_seed = |path: &BezPath| path.bounding_box().inflate(0.1, 0.1).contains(Point::new(60.0, 60.0));
    assert!(drawn.iter().any(|(_, path)| near_seed(path)));

    let tulip = "<g id='tulip' class='rinceau-element' rinceau:symbol='flower'><path d='M0,0C9,-9 20,-9 30,0C20,9 9,9 0,0Z' fill='#123456'/><path class='rinceau-spine' d='M0,0H30'/></g>";
    let (_, scene) = read(svg(&format!("{PANEL}{tulip}")));
    let artwork = grown(&scene, &[("rules", "flower")], 1).unwrap();
    let flowers = artwork.group("elements").unwrap().items.iter().filter(|item| item.of == "flower");
    assert!(flowers.flat_map(|item| &item.parts).all(|part| part.style.get("fill") == Some("#123456")));
}

/// The view of one step: what is there, what might be chosen, what is (000 Figure 8).
#[test]
fn a_step_can_be_looked_at() {
    let (_, scene) = read(svg(PANEL));
    let artwork = grown(&scene, &[("rules", "flower"), ("debug", "40")], 1).unwrap();
    let view = &artwork.group("debug").unwrap().items;
    let count = |name: &str| view.iter().filter(|item| item.of == name).count();
    assert_eq!(count("chosen"), 1);
    assert!(count("candidate") > 0 && count("placed") > 80 && count("eligible") > 5);
}

/// What there is when the time is over, and what there may be at most.
#[test]
fn growth_ends_when_it_is_told_to() {
    let large = "<rect id='panel' class='rinceau-container' width='4000' height='4000'/>";
    let run = |flags: &[&str]| {
        let folder = support::folder();
        let report = folder.path().join("report.json");
        let done = rinceau(["grow", "--rules", "dots", "--rule-unit", "4", "--report"])
            .arg(&report)
            .args(flags)
            .input(svg(large))
            .succeed();
        let text = std::fs::read_to_string(&report).unwrap();
        let report: serde_json::Value = serde_json::from_str(&text).unwrap();
        let dots = done.text().matches("rinceau:of=\"dot\"").count() / 2;
        (report["complete"].as_bool().unwrap(), dots)
    };
    let (complete, dots) = run(&["--time-limit", "0.7"]);
    assert!(!complete && dots > 10 && dots < 60_000, "{dots} dots");
    let (complete, dots) = run(&["--max-elements", "100"]);
    assert!(!complete && dots > 90 && dots <= 100, "{dots} dots");
}

mod rules {
    use super::*;

    /// A file with a body for the seed.
    fn seeded(body: &str) -> Scene {
        scene_with(&format!(
            "element seed: point\nelement dot: circle, f = 0\nelement area: polygon\nlet kept = 0;\n{body}"
        ))
    }

    /// What is discarded is no more, whoever still knows it.
    #[test]
    fn references_do_not_outlive_their_elements() {
        let body = "rule seed -> dot d { d.set(parent, 3); add(\"dot\"); kept = add(\"dot\"); return FAILURE; }\nrule seed -> dot d { d.set(parent, 3); new_child(kept); }";
        let error = grown(&seeded(body), &[("rules", "own")], 1).unwrap_err().to_string();
        assert!(error.contains("the element is no more"), "{error}");
        // One that was placed stays what it is, although others were not.
        let body = "rule seed -> dot d { new_element(\"area\"); kept = add(\"dot\"); kept.set(parent.center.offset(0.0, 9), 2); d.set(parent, 3); parent.sterile = true; }\nrule dot -> dot d { if kept.type != \"dot\" || (kept.radius - 2).abs() > 1e-9 { throw \"another\"; } return FAILURE; }";
        let artwork = grown(&seeded(body), &[("rules", "own")], 1).unwrap();
        assert_eq!(discs(&artwork, "dot").len(), 2);
    }

    #[test]
    fn nothing_is_placed_twice_or_around_a_hole() {
        let artwork =
            grown(&seeded("rule seed -> dot d { d.set(parent, 3); }"), &[("rules", "own")], 1).unwrap();
        assert_eq!(discs(&artwork, "dot").len(), 1, "brothers in one place");
        let ring =
            "<path class='rinceau-container' fill-rule='evenodd' d='M0,0H400V400H0ZM180,180V220H220V180Z'/>";
        let (_, mut scene) = read(svg(ring));
        let text = "element seed: point\nelement area: polygon\nrule seed -> area a { let c = panel().center; a.set([c.offset(0.785, 20), c.offset(2.356, 20), c.offset(3.927, 20), c.offset(5.498, 20)]); }";
        scene.rules.push(RuleSet { name: "own".into(), text: text.into() });
        let error = grown(&scene, &[("rules", "own")], 1).unwrap_err().to_string();
        assert!(error.contains("Nothing grows"), "{error}");
    }

    fn refusal(rules: &str) -> String {
        grown(&scene_with(rules), &[("rules", "own")], 1).map(|_| ()).unwrap_err().to_string()
    }

    /// One dot, placed by a body in the paper's spelling, with these values in its fields.
    fn printed(body: &str) -> Artwork {
        let rules = format!(
            "%element\nseed point\n%endelement\n%element\ndot circle\nint n;\ndouble x;\n%endelement\n%source\nint count = 3;\ndouble twice(double v) {{ return 2.0 * v; }}\n%endsource\n%element\nleaf bezier bezier\n%endelement\n%rule\nseed --> dot dot\n* l leaf\n{{\n{body}\n$$.sterile = 1;\nreturn SUCCESS;\n}}\n%endrule\n"
        );
        grown(&scene_with(&rules), &[("rules", "own"), ("rule-unit", "4")], 1)
            .unwrap_or_else(|error| panic!("{error}"))
    }

    /// The two static children as centre and radius, in units of the rules.
    fn two(body: &str) -> [(f64, f64, f64); 2] {
        let dots = discs(&printed(body), "dot");
        [0, 1].map(|i| {
            let round = |v: f64| (v * 1000.0).round() / 1000.0;
            (round(dots[i].0.x / 4.0), round(dots[i].0.y / 4.0), round(dots[i].1 / 4.0))
        })
    }

    #[test]
    fn every_token_of_table_1_means_what_it_says() {
        // `$`: the seed, here at 50,50 about; `$goal`; `$j`; `$$j`; `$$`.
        let [a, b] = two(
            "$0.set($, 2.0); $1.set($0.center.offset($goal.center - $.center + M_PI, 0.0).offset(M_PI / 2, 10), $0.radius + 1);",
        );
        assert_eq!((a.2, b.2), (2.0, 3.0));
        assert!((b.1 - a.1 - 10.0).abs() < 1e-3 && (b.0 - a.0).abs() < 1e-3, "{a:?} {b:?}");
        // `$(0)`, `$0(0)`, `$$0.n`, `$$1.x`.
        let [a, b] = two("$0(0).set($(0), 2); $$0.n = 4; $$1.x = $$0.n / 8.0; $1.set(Point_of($0.center, 7.0), $$1.x * 4);".replace("Point_of($0.center, 7.0)", "$0.center.offset(0.0, 7.0)").as_str());
        assert_eq!((a.2, b.2), (2.0, 2.0));
        // A dynamic child: `$$l`, `$l`, `$l(1)`.
        let artwork = printed(
            "$0.set($, 2); $1.set($0.center.offset(0.0, 9), 2); leaf *l = new leaf; Point base = $0.center.offset(1.5, 4); Direction d = $1.center - $0.center; Point tip = base.offset(d, 5); $l(0).set(base, d + M_PI/4, 0.6, tip, d, 0.4); $l(1).set(base, d - M_PI/4, 0.6, tip, d, 0.4); new_child($$l);",
        );
        assert_eq!(proxies(&artwork).iter().filter(|(of, _)| of == "leaf").count(), 1);
    }

    #[test]
    fn the_language_of_bodies_is_that_of_the_paper() {
        let radius = |body: &str| {
            let [a, _] = two(&format!(
                "double r = 1.0; int k = 0; {body} $0.set($, r); $1.set($.center.offset(0.0, 20), 1);"
            ));
            a.2
        };
        assert_eq!(radius("if (k < 1) r = 2.5; else r = 3.5;"), 2.5);
        assert_eq!(radius("for (int i = 0; i < 4; i++) { if (i == 2) continue; r += 1.0; }"), 4.0);
        assert_eq!(radius("while (k < 3) k++; r = k;"), 3.0);
        assert_eq!(radius("r = k > 0 ? 2.0 : 1.5;"), 1.5);
        assert_eq!(radius("r = count++; r = count;"), 4.0);
        assert_eq!(radius("r = min(3.0, max(2, twice(1.0)));"), 2.0);
        assert_eq!(radius("r = ~($goal.center - $.center) + 2.0;"), 2.0);
        assert_eq!(radius("k = (int) 2.9; r = (double) k; r -= -.5;"), 2.5);
        assert_eq!(radius("bool b = !(k == 0) && true || k != 1; if (b) { r = 2; } // why\n/* so */"), 2.0);
        assert_eq!(radius("const double wide = 2.25f; r = wide;"), 2.25);
        // The middle, which the printed half of a difference means.
        assert_eq!(
            radius(
                "Point a = $.center.offset(0.0, 4); Point m = (a - $.center) / 2; r = distance(m, $.center);"
            ),
            2.0
        );
    }

    #[test]
    fn surroundings_can_be_asked() {
        let rules = |body: &str| {
            format!(
                "element seed: point\nelement dot: circle\nelement tip: bezier\nlet ok = 0;\nrule seed -> dot d {{ parent.sterile = true; d.set(parent, 3); {body} }}"
            )
        };
        for truth in [
            "inside(parent) && !inside(point(-5, 5))",
            "(boundary_distance(parent) - 49.5).abs() < 0.6 && boundary_distance(point(-9.0, 50.0)) < 0.0",
            "distance(boundary_point(point(20, 50)), point(0.5, 50)) < 0.1",
            "(boundary_tangent(point(20, 50)).x).abs() < 0.001",
            "corners().len() == 4 && corners()[0].inwards.length > 0.0",
            "curvature_points().len() >= 4",
            "skeleton_point(point(10, 40)).radius < 30.0",
            "nearest(\"seed\", point(1, 1)) == parent && type_of(nearest(\"tip\", parent)) == \"()\"",
            "room(point(80, 50)) > 15.0 && room(point(80, 50)) < 21.0",
            "count(\"seed\") == 1 && count(\"dot\") == 0",
            "!intersects(new_tip(90.0)) && intersects(new_tip(130.0)) && clearance(new_tip(90.0), 4) > 3.0",
            "random() < 1.0 && random(2, 3) >= 2.0",
            "panel().width > 98.0 && panel().center.x > 49.0",
            "targets().is_empty() && targets(\"x\").is_empty()",
        ] {
            let file = rules(&format!("return {truth};")).replace(
                "let ok = 0;",
                "fn new_tip(x) { let t = new_element(\"tip\"); t.set(point(80, 30), direction(0.0), 0.3, point(x, 20), direction(0.0), 0.3); t }",
            );
            grown(&scene_with(&file), &[("rules", "own"), ("rule-unit", "4")], 1)
                .unwrap_or_else(|error| panic!("{truth}: {error}"));
        }
    }

    fn native(body: &str) -> String {
        format!("element seed: point\nelement dot: circle\n\nrule seed -> dot d {{\n    {body}\n}}\n")
    }

    #[test]
    fn errors_in_a_body_say_where() {
        insta::assert_snapshot!(refusal(&native("d.set(parent, goal.radious);")), @"The rules 'own', 5:24: a Circle has no 'radious'. See docs/rules.md for the fields that there are. [bad-rules]");
        insta::assert_snapshot!(refusal(&native("let x = ;")), @"The rules 'own', 5:13: the rule cannot be read: unexpected ';'. Correct it there. [bad-rules]");
        insta::assert_snapshot!(refusal(&native("d.set(parent);")), @"The rules 'own', 5:7: a circle is set to a centre and a radius, not to 1 values. Change the rule there. [bad-rules]");
        insta::assert_snapshot!(refusal(&native("d.radius = 4;")), @"The rules 'own', 5:6: the element type 'dot' has no field 'radius' that can be set. Change the rule there. [bad-rules]");
        insta::assert_snapshot!(refusal(&native("d.set(parent, 3); 1.0")), @"The rules 'own', 4:6: the rule ends with a value that says neither yes nor no: f64. End it with SUCCESS, with FAILURE, or with a statement and a semicolon. [bad-rules]");
        insta::assert_snapshot!(refusal(&native("let a = []; a.pad(1000, 1); d.f = a;")), @"The rules 'own', 5:34: the element type 'dot' has no field 'f' that can be set. Change the rule there. [bad-rules]");
        insta::assert_snapshot!(refusal(&native("d.proxy(-1).set(parent, 3);")), @"The rules 'own', 5:17: proxies are counted from 0. Change the rule there. [bad-rules]");
    }

    #[test]
    fn rules_are_fenced_in() {
        insta::assert_snapshot!(refusal(&native("loop {}")), @"The rules 'own', 5:10: the rule takes more than 100000 steps. Let its loops end sooner. [bad-rules]");
        insta::assert_snapshot!(refusal(&native("let a = []; loop { a.push(a.len()); }")), @"The rules 'own', 5:26: a text, array or map has more than 2000 entries. Keep less in it. [bad-rules]");
        insta::assert_snapshot!(refusal(&native("loop { add(\"dot\"); }")), @"The rules 'own', 5:12: the rule makes more than 2000 elements at once. Change the rule there. [bad-rules]");
        insta::assert_snapshot!(refusal(&native("eval(\"1\");")), @"The rules 'own', 5:5: the rule cannot be read: reserved keyword 'eval' is disabled. Correct it there. [bad-rules]");
        insta::assert_snapshot!(refusal(&native("timestamp();")), @"The rules 'own', 5:5: there is no function timestamp(). See docs/rules.md for what rules can call, and with which values. [bad-rules]");
        insta::assert_snapshot!(refusal(&native("open(\"/etc/passwd\");")), @"The rules 'own', 5:5: there is no function open (&str | ImmutableString | String). See docs/rules.md for what rules can call, and with which values. [bad-rules]");
        insta::assert_snapshot!(refusal(&native("sleep(1000);")), @"The rules 'own', 5:5: there is no function sleep (i64). See docs/rules.md for what rules can call, and with which values. [bad-rules]");
        insta::assert_snapshot!(refusal(&native("clear_excluded(); return FAILURE;")), @"The rules 'own', 5:5: clear_excluded was called 100 times, and nothing has grown. Change the rule there. [bad-rules]");
    }

    #[test]
    fn errors_in_the_printed_spelling_say_where() {
        let printed = |body: &str| {
            format!(
                "%element\nseed point\n%endelement\n%element\ndot circle\n%endelement\n%rule\nseed --> dot\n{{\n    {body}\n}}\n%endrule\n"
            )
        };
        insta::assert_snapshot!(refusal(&printed("$0.set($, ) ;")), @"The rules 'own', 10:8: a circle is set to a centre and a radius, not to 1 values. Change the rule there. [bad-rules]");
        insta::assert_snapshot!(refusal(&printed("$3.set($, 1.0);")), @"The rules 'own', 10:6: the rule has no child number 3. Children are counted from 0, in the order of the rule's first line. [bad-rules]");
        insta::assert_snapshot!(refusal(&printed("$0.set($, 1.0)")), @"The rules 'own', 10:19: ';' is missing before the end. Add it. [bad-rules]");
        insta::assert_snapshot!(refusal(&printed("$0.set($, $goal.width);")), @"The rules 'own', 10:21: a Circle has no 'width'. See docs/rules.md for the fields that there are. [bad-rules]");
        insta::assert_snapshot!(refusal(&printed("flower *x = new flower;")), @"The rules 'own', 10:15: ';' is missing before '='. Add it. [bad-rules]");
        insta::assert_snapshot!(refusal(&printed("int a; a = a[a++]++;")), @"The rules 'own', 10:22: counting inside of what is counted. Count before, in a statement of its own. [bad-rules]");
    }

    #[test]
    fn errors_of_a_file_say_where() {
        insta::assert_snapshot!(refusal("element seed: circle\n"), @"The rules 'own', 1:1: there is no element type 'seed' with a single point. Declare it: growth starts there (element seed: point). [bad-rules]");
        insta::assert_snapshot!(refusal("element seed: point\nrule sead -> {}"), @"The rules 'own', 2:6: no element type is called 'sead'. Declare it, or use one of seed. [bad-rules]");
        insta::assert_snapshot!(refusal("element seed: point\n"), @"The rules 'own', 2:1: there is no rule. Add one. [bad-rules]");
        insta::assert_snapshot!(refusal("element seed: point\nrule seed -> { "), @"The rules 'own', 2:16: the body of the rule has no end. Close it with }. [bad-rules]");
        insta::assert_snapshot!(refusal("element seed: point\nelement seed: point"), @"The rules 'own', 2:9: the element type 'seed' is declared twice. Give one of them another name. [bad-rules]");
        insta::assert_snapshot!(refusal("element seed: point\nrule seed -> {}\nlook seed: art nothing"), @"The rules 'own', 3:6: no artwork is called 'nothing'. Use stem, vine, brush, ribbon, rope, leafy, beads, acanthus, leaf, willow, drop, hook, petal, quote, dot, ring, rosette, daisy, peony, lotus, bud, star, outline, fill or none; what you draw for a type needs no art. [bad-rules]");
        insta::assert_snapshot!(refusal("element seed: point\nrule seed -> {}\nlook seed: colour red"), @"The rules 'own', 3:12: a look has no 'colour'. Use art, width, size, tone, by, thick or join. [bad-rules]");
        insta::assert_snapshot!(refusal("element seed: point\nlet k = add(\"seed\");\nrule seed -> {}"), @"The rules 'own', 2:9: elements are made by rules, not where variables are declared. Change the rule there. [bad-rules]");
        insta::assert_snapshot!(refusal("element seed: point, n = 1, n = 2\nrule seed -> {}"), @"The rules 'own', 1:29: the field 'n' is declared twice. Give one of them another name. [bad-rules]");
        insta::assert_snapshot!(refusal("element seed: point\nrule seed -> {}\nlook seed: thick wide"), @"The rules 'own', 3:6: the element type 'seed' has no field 'wide'. Declare it, or leave it out of the look. [bad-rules]");
        insta::assert_snapshot!(refusal("element seed: point\nrule seed -> {}\nlook seed: art dot tone 3"), @"The rules 'own', 3:20: a comma is missing before 'tone'. Add it. [bad-rules]");
        insta::assert_snapshot!(refusal("%element\nseed point\nint element\nint order;\n%endelement\nelement dot: circle\nrule seed -> dot d { oops(); }"), @"The rules 'own', 7:22: there is no function oops(). See docs/rules.md for what rules can call, and with which values. [bad-rules]");
        insta::assert_snapshot!(refusal("grow!"), @"The rules 'own', 1:1: 'grow' means nothing here. Write an element, a rule, a look, smallest, reach, let or fn. [bad-rules]");
    }

    /// What the tutorial shows does what it says.
    #[test]
    fn the_tutorial_runs() {
        let page = std::fs::read_to_string(support::root().join("docs/rules.md")).unwrap();
        let shown = page.split("```\n").nth(1).unwrap();
        let artwork = grown(&scene_with(shown), &[("rules", "own")], 1).unwrap();
        assert!(discs(&artwork, "berry").len() > 100);
        let printed = page.split("```\n").nth(3).unwrap();
        let start = "%element\nseed point\n%endelement\n%rule\nseed --> dot { $0.set($, 3); return SUCCESS; }\n%endrule\n";
        let artwork = grown(&scene_with(&format!("{start}{printed}")), &[("rules", "own")], 1).unwrap();
        assert!(discs(&artwork, "dot").len() > 500);
    }

    #[test]
    fn rules_come_from_the_drawing_or_a_file() {
        let rules = "element seed: point\nelement dot: circle\nrule seed -> dot d { d.set(parent, 5); parent.sterile = true; }";
        let text = svg(&format!(
            "<metadata><rinceau:rules name='five'>{}</rinceau:rules></metadata>{PANEL}",
            rules.replace('>', "&gt;")
        ));
        for chosen in ["auto", "five"] {
            let out = rinceau(["grow", "--rules", chosen]).input(text.as_str()).succeed().text().to_owned();
            assert_eq!(out.matches("rinceau:of=\"dot\"").count(), 2, "drawn, and its proxy");
        }
        let folder = support::folder();
        let path = support::file(&folder, "one.rules", rules);
        let out = rinceau(["grow", "--rules"]).arg(&path).input(svg(PANEL)).succeed().text().to_owned();
        assert_eq!(out.matches("rinceau:of=\"dot\"").count(), 2);
        let missing = rinceau(["grow", "--rules", "nowhere.rules"]).input(svg(PANEL)).done();
        assert!(
            missing.code == Some(1) && missing.stdout.is_empty() && missing.stderr.contains("[rules-file]")
        );
        let unknown = rinceau(["grow", "--rules", "spirals"]).input(svg(PANEL)).done();
        assert!(unknown.stderr.contains("[unknown-rules]"), "{}", unknown.stderr);
    }
}
