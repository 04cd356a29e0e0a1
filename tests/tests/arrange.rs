//! Arrangement by example: regular examples go on exactly, everything stays where it may be, and no
//! example is too poor for an answer.

mod support;

use kurbo::{Affine, Point, Rect, Shape};
use proptest::prelude::*;
use rinceau::geom::region::Region;
use rinceau_format::{Artwork, Scene};
use std::fmt::Write;
use support::geometry::{
    assert_inside, bounds, cases, contours, distance, generated, pieces, read, rng_seed, samples_of, waves,
};
use support::{CIRCLE, RINCEAU, layers, parse, rinceau, svg};

/// Bricks in rows that are set off against each other.
fn bricks(columns: usize, rows: usize) -> String {
    let mut out = String::from("<g id='example' class='rinceau-reference'>");
    for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
        let (x, y) = (40 * column + 20 * (row % 2), 20 * row);
        let _ = write!(out, "<rect id='b{row}-{column}' x='{x}' y='{y}' width='38' height='18'/>");
    }
    out + "</g>"
}

/// Where clones put the middles of their symbols.
fn middles(artwork: &Artwork) -> Vec<Point> {
    pieces(artwork, "elements").iter().map(|piece| bounds(piece).center()).collect()
}

fn arranged(scene: &Scene, params: &[(&str, &str)]) -> Artwork {
    let params: Vec<(&str, String)> = params.iter().map(|&(name, value)| (name, value.to_owned())).collect();
    generated("arrange", scene, &params, 1).unwrap()
}

/// The same lattice, to rounding, over ten thousand elements (E-001).
#[test]
fn a_regular_example_goes_on_exactly() {
    let (_, scene) = read(svg(&bricks(5, 6)));
    let artwork = arranged(&scene, &[("count", "10000")]);
    let middles = middles(&artwork);
    assert_eq!(middles.len(), 10_000);
    let first = middles[0];
    let mut cells = std::collections::BTreeSet::new();
    for at in middles {
        let (row, column) = ((at.y - first.y) / 20.0, (at.x - first.x) / 20.0);
        assert!((row - row.round()).abs() < 1e-6 && (column - column.round()).abs() < 1e-6, "{at:?}");
        assert_eq!((row.round() as i64 + column.round() as i64).rem_euclid(2), 0, "off the lattice: {at:?}");
        assert!(cells.insert((row.round() as i64, column.round() as i64)), "twice at {at:?}");
    }
    assert!(artwork.counts["residual"] < 1e-9);
}

/// Without a gap inside: all four corners between bricks that are there have all their bricks.
#[test]
fn a_regular_example_leaves_no_hole() {
    let panel = "<rect class='rinceau-container' x='-500' y='-400' width='1000' height='800'/>";
    let (_, scene) = read(svg(&format!("{}{panel}", bricks(5, 6))));
    let middles = middles(&arranged(&scene, &[]));
    let rows: Vec<f64> = middles.iter().map(|at| at.y).collect();
    let (top, bottom) = rows.iter().fold((f64::MAX, f64::MIN), |(a, b), &y| (a.min(y), b.max(y)));
    assert!(top < -365.0 && bottom > 365.0, "{top} to {bottom}");
    let expected = ((bottom - top) / 20.0).round() as usize + 1;
    // 24 or 25 bricks fit side by side.
    assert!(middles.len() >= 23 * expected, "{} bricks in {expected} rows", middles.len());
}

/// Dots of three sizes, nowhere nearer than 18 to each other.
fn dots(seed: u64) -> String {
    let mut rng = rinceau::Rng::new(seed);
    let mut out = String::from("<g class='rinceau-reference'>");
    let mut places: Vec<(f64, f64)> = Vec::new();
    for _ in 0..4000 {
        let (x, y) = (rng.between(-300.0, -160.0), rng.between(0.0, 140.0));
        if places.len() < 36 && places.iter().all(|(u, v)| (x - u).hypot(y - v) > 18.0) {
            let (kind, r) = (places.len() % 3, 3 + 2 * (places.len() % 3));
            let _ = write!(out, "<circle rinceau:symbol='s{kind}' cx='{x:.2}' cy='{y:.2}' r='{r}'/>");
            places.push((x, y));
        }
    }
    out + "</g>"
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(12), rng_seed: rng_seed(), failure_persistence: None, ..ProptestConfig::default() })]

    /// Inside the outline, clear of what is fixed, and no two over each other where none are in the
    /// example.
    #[test]
    fn random_shapes_and_examples(
        outer in waves(), seed in 0..10_000_u64, mode in prop_oneof![Just("fixed"), Just("rotate"), Just("flow")], relax in any::<bool>(),
    ) {
        let shape = support::geometry::blob((100.0, 100.0), 90.0, &outer);
        let stone = "<circle class='rinceau-fixed' cx='100' cy='100' r='18'/>";
        let flow = "<path class='rinceau-guide' d='M20,60 Q100,160 180,60'/>";
        let drawing = svg(&format!("{}<path class='rinceau-container' d='{shape}'/>{stone}{flow}", dots(seed)));
        let (_, scene) = read(drawing);
        let params = [("mode", mode), ("relax", if relax { "true" } else { "false" })];
        let artwork = arranged(&scene, &params);
        let again = arranged(&scene, &params);
        let elements = pieces(&artwork, "elements");
        prop_assert_eq!(&elements, &pieces(&again, "elements"), "the same seed, the same result");
        prop_assert!(elements.len() > 12, "{} elements", elements.len());
        let outline = &scene.containers[0].outlines[0].path;
        let container = Region::new(contours(outline)).unwrap();
        let fixed = vec![support::geometry::disc((100.0, 100.0), 17.9)];
        for (i, piece) in elements.iter().enumerate() {
            assert_inside("an element", piece, &container);
            prop_assert!(distance(piece, &fixed, 1.0) > 0.0, "over the stone");
            if relax {
                for other in &elements[..i] {
                    prop_assert!(distance(piece, other, 0.1) > 0.0, "two elements overlap");
                }
            }
        }
    }
}

#[test]
fn symbols_are_named_cloned_or_alike() {
    let example = "<g class='rinceau-reference'><circle id='a' cx='9' r='3'/><circle cx='19' r='3'/><use id='u' href='#a' y='10'/><rect id='r' rinceau:symbol='named' width='2' height='2'/><circle r='4'/></g>";
    let (_, scene) = read(svg(example));
    let symbols: Vec<&str> = scene.references[0].examples.iter().map(|one| one.symbol.as_str()).collect();
    let own = symbols[4];
    assert_eq!(symbols, ["a", "a", "a", "named", own]);
    assert_ne!(own, "a");
}

#[test]
fn the_flow_turns_elements() {
    let panel = "<rect class='rinceau-container' x='-300' y='-300' width='600' height='600'/><path class='rinceau-guide' d='M0,300 V-300'/>";
    let (_, scene) = read(svg(&format!("{}{panel}", bricks(5, 6))));
    let artwork = arranged(&scene, &[("mode", "flow")]);
    let upright = pieces(&artwork, "elements").iter().filter(|piece| bounds(piece).height() > 30.0).count();
    assert!(upright > 200, "{upright}");
}

/// Seeds of higher priority grow before others near them.
#[test]
fn what_is_more_important_goes_first() {
    let (_, scene) =
        read(svg(&format!("{}<circle class='rinceau-container' cx='200' cy='200' r='190'/>", dots(3))));
    let artwork = arranged(&scene, &[("priority", "s2"), ("order", "growth"), ("output", "paths")]);
    let large = |piece: &Vec<Vec<Point>>| bounds(piece).width() > 12.0;
    let elements = pieces(&artwork, "elements");
    let ranks: Vec<usize> = (0..elements.len()).filter(|&i| large(&elements[i])).collect();
    let mean = ranks.iter().sum::<usize>() as f64 / ranks.len() as f64;
    assert!(mean < 0.5 * elements.len() as f64, "large ones are {mean} of {} on average", elements.len());
}

#[test]
fn a_boundary_stops_growth() {
    let rest = "<rect class='rinceau-container' x='-400' y='-300' width='800' height='600'/><path class='rinceau-boundary' d='M0,-400 V400'/><circle class='rinceau-seed' cx='-200' cy='0' r='2'/>";
    let (_, scene) = read(svg(&format!("{}{rest}", bricks(5, 6))));
    let artwork = arranged(&scene, &[("count", "60")]);
    assert!(middles(&artwork).iter().all(|at| at.x < 0.0));
}

#[test]
fn sprayed_strokes_are_filled() {
    let spray = "<path id='s' class='rinceau-spray' d='M300,100 H900' style='fill:none;stroke:#000;stroke-width:120'/>";
    let (_, scene) = read(svg(&format!("{}{spray}", bricks(5, 6))));
    let middles = middles(&arranged(&scene, &[]));
    assert!(middles.len() > 60, "{}", middles.len());
    assert!(middles.iter().all(|at| (40.0..=160.0).contains(&at.y) && (240.0..=960.0).contains(&at.x)));
}

/// Strokes that are sprayed may have parameters of their own.
#[test]
fn a_sprayed_stroke_has_its_own_way() {
    let spray = |y: i32, own: &str| {
        format!(
            "<path class='rinceau-spray' {own} d='M300,{y} H900' style='fill:none;stroke:#000;stroke-width:120'/>"
        )
    };
    let (_, scene) =
        read(svg(&format!("{}{}{}", bricks(5, 6), spray(100, "rinceau:count='7'"), spray(400, ""))));
    let middles = middles(&arranged(&scene, &[]));
    let upper = middles.iter().filter(|at| at.y < 250.0).count();
    assert!(upper > 0 && upper <= 7 && middles.len() - upper > 60, "{upper} of {}", middles.len());
}

/// With whole elements only, none crosses a boundary.
#[test]
fn boundaries_keep_whole_elements_off() {
    let rest = "<rect class='rinceau-container' x='-400' y='-300' width='800' height='600'/><path class='rinceau-boundary' d='M-420,-50 Q0,120 420,-40'/>";
    let (_, scene) = read(svg(&format!("{}{rest}", bricks(5, 6))));
    let line = contours(&scene.boundaries[0].path);
    for (edge, may) in [("inside", false), ("middle", true)] {
        let artwork = arranged(&scene, &[("edge", edge)]);
        let crosses = |piece: &&Vec<Vec<Point>>| {
            piece[0].windows(2).any(|pair| {
                line[0]
                    .windows(2)
                    .any(|wall| rinceau::geom::segment::crosses(pair[0], pair[1], wall[0], wall[1]))
            })
        };
        let elements = pieces(&artwork, "elements");
        assert!(elements.len() > 200, "{}", elements.len());
        assert_eq!(elements.iter().any(|piece| crosses(&piece)), may, "{edge}");
    }
}

/// What reaches exactly to the outline is inside.
#[test]
fn elements_may_touch_the_outline() {
    // Two bricks and half a joint on each side: as wide as they are.
    let panel = "<rect class='rinceau-container' x='0' y='0' width='78' height='38'/>";
    let seed = "<circle class='rinceau-seed' cx='19' cy='9' r='1'/>";
    let (_, scene) = read(svg(&format!("{}{panel}{seed}", bricks(5, 6))));
    let artwork = arranged(&scene, &[]);
    // Above two whole bricks, below one between them.
    assert_eq!(pieces(&artwork, "elements").len(), 3);
}

/// In a flow elements lie over each other as they do in the example, whichever way they are turned.
#[test]
fn the_overlap_follows_the_flow() {
    let sample = std::fs::read_to_string(support::root().join("samples/arrange/scales.svg")).unwrap();
    let (_, scene) = read(sample);
    let artwork = generated("arrange", &scene, &[("output", "paths".into())], 1).unwrap();
    let items = &artwork.group("elements").unwrap().items;
    let placed: Vec<(Point, Affine)> = items
        .iter()
        .map(|item| {
            let part = &item.parts[0];
            (bounds(&contours(&(part.transform * part.path.clone()))).center(), part.transform)
        })
        .collect();
    // The example's scales lie over those to the right of them.
    let (mut right, mut wrong) = (0, 0);
    for (i, (a, pose)) in placed.iter().enumerate() {
        for (b, _) in &placed[..i] {
            let apart = pose.inverse() * (*b - *a).to_point() - pose.inverse() * Point::ORIGIN;
            if apart.hypot() < 20.0 && apart.x.abs() > 6.0 {
                if apart.x > 0.0 { right += 1 } else { wrong += 1 }
            }
        }
    }
    let (most, least) = (right.max(wrong), right.min(wrong));
    assert!(most > 300 && least * 20 < most, "{right} one way, {wrong} the other");
}

/// With a window, what stands far from the newest elements stays where it was grown.
#[test]
fn a_window_leaves_the_rest_alone() {
    let (_, scene) = read(svg(&dots(5)));
    let places = |window: &str, relax: &str| {
        let params = [("count", "600"), ("window", window), ("relax", relax), ("order", "growth")];
        middles(&arranged(&scene, &params))
    };
    let (grown, whole, window) = (places("0", "false"), places("0", "true"), places("2", "true"));
    let moved =
        |other: &[Point]| grown.iter().zip(other).take(30).filter(|(a, b)| a.distance(**b) > 0.5).count();
    assert!(moved(&whole) > 0, "relaxation moves nothing");
    assert_ne!(whole, window);
}

mod tiles {
    use super::*;

    /// What crosses one side of a tile crosses the other.
    #[test]
    fn have_no_seam() {
        for path in [support::root().join("samples/arrange/cloth.svg")] {
            let (_, scene) = read(std::fs::read_to_string(&path).unwrap());
            let tile = scene.containers[0].outlines[0].path.clone();
            let tile = kurbo::Shape::bounding_box(&tile);
            let artwork = arranged(&scene, &[]);
            let all = pieces(&artwork, "elements");
            // Only what reaches into the tile is drawn.
            assert!(all.iter().all(|piece| bounds(piece).inflate(0.1, 0.1).overlaps(tile)));
            let over = |x: Option<f64>, y: Option<f64>| -> Vec<Point> {
                let mut over: Vec<Point> = all
                    .iter()
                    .map(|piece| bounds(piece))
                    .filter(|b| {
                        x.is_none_or(|x| b.x0 < x && b.x1 > x) && y.is_none_or(|y| b.y0 < y && b.y1 > y)
                    })
                    .map(|b| b.center() - kurbo::Vec2::new(x.unwrap_or(0.0), y.unwrap_or(0.0)))
                    .collect();
                over.sort_by(|a, b| (a.x + 3.0 * a.y).total_cmp(&(b.x + 3.0 * b.y)));
                over
            };
            for (a, b) in [
                (over(Some(tile.x0), None), over(Some(tile.x1), None)),
                (over(None, Some(tile.y0)), over(None, Some(tile.y1))),
            ] {
                assert!(!a.is_empty() && a.len() == b.len(), "{} and {}", a.len(), b.len());
                for (p, q) in a.iter().zip(&b) {
                    assert!(p.distance(*q) < 0.02, "{p:?} and {q:?}");
                }
            }
            assert_eq!(artwork.counts["collisions"], 0.0);
        }
    }

    /// A lattice whose steps do not go into the tile is stretched until they do.
    #[test]
    fn hold_whole_rows() {
        // 9.7 bricks and 10.8 rows.
        let panel =
            "<rect class='rinceau-container' x='300' width='388' height='216' rinceau:repeat='true'/>";
        let (_, scene) = read(svg(&format!("{}{panel}", bricks(5, 6))));
        let artwork = arranged(&scene, &[]);
        let grown = artwork.counts["grown"];
        assert!(grown == 100.0 || grown == 90.0, "{grown} bricks");
        assert!(artwork.counts["residual"] < 0.02, "{}", artwork.counts["residual"]);
    }

    #[test]
    fn are_shapes_without_a_flow() {
        let done = rinceau(["arrange", "--repeat", "true"]).input(svg(&bricks(5, 6))).done();
        assert!(done.stderr.contains("[no-tile]") && done.stdout.is_empty(), "{}", done.stderr);
        let panel = "<rect class='rinceau-container' x='300' width='388' height='230'/><path class='rinceau-guide' d='M320,9H600'/>";
        let done = rinceau(["arrange", "--repeat", "true", "--mode", "flow"])
            .input(svg(&format!("{}{panel}", bricks(5, 6))))
            .done();
        assert!(done.stderr.contains("A flow does not repeat"), "{}", done.stderr);
    }
}

mod connectivity {
    use super::*;

    /// An edge that is selected is flipped in the example, and the other diagonal drawn; a second time
    /// it is back.
    #[test]
    fn is_drawn_and_flipped() {
        let plain = svg(&format!("<!-- kept -->{}", bricks(4, 4)));
        let drawn = rinceau(["connect"]).input(plain.as_str()).succeed().text().to_owned();
        assert_eq!(support::without_layer(&drawn), plain);
        let edges = |text: &str| -> Vec<(String, String)> {
            let xml = parse(text);
            let [layer] = layers(&xml)[..] else { panic!("{} layers", layers(&xml).len()) };
            layer
                .descendants()
                .filter(|node| node.has_attribute((RINCEAU, "of")))
                .map(|node| {
                    let get = |name: &str| node.attribute(name).unwrap_or_default().to_owned();
                    (get("id"), node.attribute((RINCEAU, "of")).unwrap_or_default().to_owned())
                })
                .collect()
        };
        let before = edges(&drawn);
        let find = |all: &[(String, String)], of: &str| {
            all.iter().find(|edge| edge.1 == of).map(|edge| edge.0.clone())
        };
        // The edge between two neighbours of a row has a triangle on either side.
        let chosen = find(&before, "b1-1 b1-2").expect("an edge along a row");
        let flipped = rinceau(["connect", "--id", &chosen]).input(drawn.as_str()).succeed().text().to_owned();
        assert!(flipped.contains("rinceau:flip=\"b1-1 b1-2\""), "{flipped:.600}");
        let after = edges(&flipped);
        assert_eq!(before.len(), after.len());
        assert!(find(&after, "b1-1 b1-2").is_none());
        let new: Vec<&(String, String)> =
            after.iter().filter(|edge| find(&before, &edge.1).is_none()).collect();
        let [other] = new[..] else { panic!("{new:?}") };
        let back = rinceau(["connect", "--id", &other.0]).input(flipped.as_str()).succeed().text().to_owned();
        let ends = |all: &[(String, String)]| all.iter().map(|edge| edge.1.clone()).collect::<Vec<_>>();
        assert_eq!(ends(&edges(&back)), ends(&before));
    }

    #[test]
    fn needs_an_example_with_neighbours() {
        let refusal = |body: &str| rinceau(["connect"]).input(svg(body)).done().stderr;
        assert!(refusal("").contains("[no-reference]"));
        let two = "<g class='rinceau-reference'><circle r='2'/><circle cx='9' r='2'/></g>";
        assert!(refusal(two).contains("[no-neighbours]"));
        assert!(
            rinceau(["connect", "--id", "nobody"])
                .input(svg(&bricks(3, 3)))
                .done()
                .stderr
                .contains("[unknown-id]")
        );
    }
}

/// How like its example each sample is (checklist section 9's measures): see `measure`.
/// Without an example, a built-in one fills the selected shape.
#[test]
fn a_shape_alone_is_filled() {
    let done = rinceau(["arrange", "--id", "panel"])
        .input(svg("<path id='panel' d='M20,100C20,20 180,20 180,100S20,180 20,100Z' fill='#eeeeee'/>"))
        .succeed();
    let xml = support::parse(done.text());
    let elements = support::elements(support::layers(&xml)[0]);
    assert!(elements.len() > 100, "{}", elements.len());
    // What clones refer to is in the layer itself.
    for element in elements {
        let href = element.attribute(("http://www.w3.org/1999/xlink", "href")).unwrap();
        support::by_id(&xml, &href[1..]);
    }
    assert!(rinceau(["update"]).input(done.text()).succeed().text() == done.text());
}

#[test]
fn samples_are_like_their_examples() {
    for path in samples_of("arrange") {
        let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
        let (_, scene) = read(std::fs::read_to_string(&path).unwrap());
        let counts = arranged(&scene, &[]).counts;
        assert_eq!(counts["collisions"], 0.0, "{name}");
        assert_eq!(counts["repeats"], 0.0, "{name}");
        assert!(counts["spacing-variation"] < counts["example-spacing-variation"], "{name}: {counts:?}");
        assert!(counts["symbols-apart"] < 0.05, "{name}: {}", counts["symbols-apart"]);
        assert!(counts["neighbours-apart"] < 0.05, "{name}: {}", counts["neighbours-apart"]);
        assert!(counts["residual"] < if name == "bricks" || name == "euro" { 0.02 } else { 0.25 }, "{name}");
    }
}

/// Dots keep most of the room that those of the example have, and alike ones most of their distance.
#[test]
fn alike_elements_are_no_nearer_than_in_the_example() {
    let (_, scene) =
        read(std::fs::read_to_string(support::root().join("samples/arrange/confetti.svg")).unwrap());
    let dots = |boxes: Vec<Rect>| -> Vec<(Point, f64)> {
        boxes.iter().map(|b| (b.center(), 0.5 * b.width())).collect()
    };
    // Among those with about this radius, and the room between any two.
    let nearest = |dots: &[(Point, f64)], radius: f64| {
        let (mut nearest, mut room) = (f64::INFINITY, f64::INFINITY);
        for (i, &(a, own)) in dots.iter().enumerate() {
            for &(b, other) in &dots[..i] {
                room = room.min(a.distance(b) - own - other);
                if (own - radius).abs() < 0.1 && (other - radius).abs() < 0.1 {
                    nearest = nearest.min(a.distance(b));
                }
            }
        }
        (nearest, room)
    };
    let examples = &scene.references[0].examples;
    let drawn = dots(
        examples
            .iter()
            .map(|one| (one.parts[0].transform * one.parts[0].path.clone()).bounding_box())
            .collect(),
    );
    for seed in 1..=4 {
        let artwork = generated("arrange", &scene, &[], seed).unwrap();
        let grown = dots(pieces(&artwork, "elements").iter().map(|piece| bounds(piece)).collect());
        for radius in [7.2, 5.4, 3.6] {
            let ((example, room), (nearest, left)) = (nearest(&drawn, radius), nearest(&grown, radius));
            assert!(nearest > 0.7 * example, "{seed}: {nearest} of {example} between dots of {radius}");
            assert!(left > 0.6 * room, "{seed}: {left} of {room}");
        }
    }
}

#[test]
fn sizes_angles_and_tones_vary_by_seed() {
    let rest = "<rect class='rinceau-container' x='300' y='0' width='300' height='200'/>";
    let (_, scene) = read(svg(&format!("{}{rest}", bricks(5, 6))));
    let params = [("vary-size", "0.1"), ("vary-turn", "5"), ("vary-tone", "0.3"), ("output", "paths")];
    let artwork = arranged(&scene, &params);
    let items = &artwork.group("elements").unwrap().items;
    let fills: std::collections::BTreeSet<&str> =
        items.iter().filter_map(|item| item.parts[0].style.get("fill")).collect();
    assert!(fills.len() > 5, "{fills:?}");
    let scale = |affine: Affine| affine.determinant().sqrt();
    let scales: Vec<f64> = items.iter().map(|item| scale(item.parts[0].transform)).collect();
    assert!(
        scales.iter().all(|s| (0.9..=1.1).contains(s)) && scales.iter().any(|s| (s - scales[0]).abs() > 0.01)
    );
}

mod refused {
    use super::*;

    fn refusal(body: &str, flags: &[&str]) -> String {
        let done = rinceau(["arrange"]).args(flags).input(svg(body)).done();
        assert!(done.code == Some(1) && done.stdout.is_empty(), "{}", done.stderr);
        done.stderr.trim_end().to_owned()
    }

    #[test]
    fn without_an_example() {
        insta::assert_snapshot!(refusal("", &[]), @"rinceau: There is no example to continue. Group some elements as they should be arranged, and mark the group as reference (Extensions > Ornament > Mark as). [no-reference]");
    }

    /// One, two or three elements, all on a line, all in one place, an empty group.
    #[test]
    fn with_a_poor_example() {
        let group =
            |content: &str| format!("<g id='example' class='rinceau-reference'>{content}</g>{CIRCLE}");
        for count in [0, 1, 2, 3, 9] {
            let line: String =
                (0..count).map(|i| format!("<rect x='{}' width='5' height='5'/>", 9 * i)).collect();
            assert!(refusal(&group(&line), &[]).ends_with("[no-inner-element]"), "{count}");
        }
        let heap = "<rect width='5' height='5'/>".repeat(9);
        insta::assert_snapshot!(refusal(&group(&heap), &[]), @"rinceau: 2:1: No element of the example 'example' has neighbours all around it. Draw more of them: about three rows of three, so that at least one lies in the middle. [no-inner-element]");
    }

    #[test]
    fn with_wrong_wishes() {
        let body = format!("{}{CIRCLE}", bricks(5, 6));
        insta::assert_snapshot!(refusal(&body, &["--priority", "stone"]), @"rinceau: 2:1: The example 'example' has no symbol 'stone'. Use one of b0-0. [no-symbol]");
        insta::assert_snapshot!(refusal(&body, &["--mode", "flow"]), @"rinceau: There is no guide in the shape that the elements could turn with. Draw a line along the flow and mark it as guide, or turn elements as drawn. [no-guide]");
        insta::assert_snapshot!(refusal(&body, &["--vary-tone", "0.2"]), @"rinceau: 2:1: Clones have the tones of their symbol. Choose copies as result, or let tones be. [paths-only]");
        let small = format!("{}<rect class='rinceau-container' width='9' height='9'/>", bricks(5, 6));
        insta::assert_snapshot!(refusal(&small, &[]), @"rinceau: No element of the example fits into the shape. Make the shape larger, draw the example smaller, or let elements cross the outline. [nothing-fits]");
        let vast = format!("{}<rect class='rinceau-container' width='90000' height='90000'/>", bricks(5, 6));
        insta::assert_snapshot!(refusal(&vast, &[]), @"rinceau: The shape would take about 7539182 elements, more than 200000. Draw the example larger, or give a number of elements. [too-many-elements]");
    }

    /// A symbol that only occurs on the border is grown from no one; the others go on.
    #[test]
    fn not_with_a_symbol_on_the_border_alone() {
        let example = bricks(5, 6).replacen("<rect ", "<rect rinceau:symbol='corner' ", 1);
        let text = rinceau(["arrange"])
            .input(svg(&format!("{example}<circle class='rinceau-container' cx='400' cy='400' r='190'/>")))
            .succeed();
        let xml = parse(text.text());
        assert!(support::elements(layers(&xml)[0]).len() > 50);
    }
}

/// Clones of the drawn elements, and only a layer more in the drawing; a second run changes nothing.
#[test]
fn every_sample_goes_on_and_goes_on_the_same() {
    for path in samples_of("arrange") {
        let before = std::fs::read_to_string(&path).unwrap();
        let once = rinceau(["arrange"]).input(before.as_str()).succeed();
        let again = rinceau(["arrange"]).input(once.text()).succeed();
        assert_eq!(once.text(), again.text(), "{}", path.display());
        assert!(once.stderr.is_empty(), "{}: {}", path.display(), once.stderr);
        let xml = parse(once.text());
        let [layer] = layers(&xml)[..] else { panic!("{} layers", layers(&xml).len()) };
        assert_eq!(layer.attribute((RINCEAU, "result")), Some("arrange"));
        assert!(support::elements(layer).len() > 20, "{}", path.display());
        assert_eq!(support::without_layer(once.text()), before, "{}", path.display());
    }
}
