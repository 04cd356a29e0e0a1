//! Arrangement by example: regular examples go on exactly, everything stays where it may be, and no
//! example is too poor for an answer.

mod support;

use kurbo::{Affine, Point};
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
        insta::assert_snapshot!(refusal(CIRCLE, &[]), @"rinceau: There is no example to continue. Group some elements as they should be arranged, and mark the group as reference (Extensions > Ornament > Mark as). [no-reference]");
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
