//! Promises of packing that hold for any drawing: inside the container, the gap kept, fixed
//! areas clear, no outline crossing itself, the same bytes for the same seed, an end.
//!
//! The checks know nothing of how the packing was made: they read the written drawing.

mod support;

use kurbo::{BezPath, Point};
use proptest::prelude::*;
use rinceau::GENERATORS;
use rinceau::geom::boolean::signed_area;
use rinceau::geom::region::Region;
use rinceau::geom::segment::crosses;
use rinceau::params::Values;
use support::geometry::*;
use support::packing::{check, pack};

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(16), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_shapes_guides_and_settings(
        outer in waves(), hole in waves(), hole_radius in 0.0..60.0f64, fixed_at in (160.0..240.0f64, 160.0..240.0f64),
        guide in prop::option::of(((80.0..320.0f64, 80.0..320.0f64), (80.0..320.0f64, 80.0..320.0f64), (80.0..320.0f64, 80.0..320.0f64))),
        spacing in 24.0..60.0f64, gap in 0.5..5.0f64, stretch in 1.0..3.0f64, seed in 0..1000u64,
        family in prop::sample::select(vec!["mixed", "leaves", "drops", "spirals", "scales", "feathers"]),
    ) {
        let hole = if hole_radius > 12.0 { blob((200.0, 200.0), hole_radius, &hole) } else { String::new() };
        let outline = format!("{}{hole}", blob((200.0, 200.0), 150.0, &outer));
        let guide = guide.map_or(String::new(), |(a, b, c)| format!("<path class='rinceau-guide' d='M{},{}Q{},{} {},{}' fill='none'/>", a.0, a.1, b.0, b.1, c.0, c.1));
        let svg = format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 400 400'><path id='c' class='rinceau-container' fill-rule='evenodd' d='{outline}'/>{guide}<circle class='rinceau-fixed' cx='{}' cy='{}' r='15'/></svg>", fixed_at.0, fixed_at.1);
        let (_, scene) = read(svg);
        let params = [("spacing", format!("{spacing:.3}")), ("min-gap", format!("{gap:.3}")), ("stretch", format!("{stretch:.3}")), ("elements", family.to_owned())];
        let artwork = match pack(&scene, &params, seed) {
            Ok(artwork) => artwork,
            Err(error) => {
                prop_assert_eq!(error.code(), "guide-outside");
                return Ok(());
            }
        };
        let container = Region::new(contours(&BezPath::from_svg(&outline).unwrap())).unwrap();
        check(&artwork, &container, &[vec![disc(fixed_at, 15.0)]], (gap.min((gap * 1e3).round() / 1e3), gap.min((gap * 1e3).round() / 1e3)));
        // The same seed draws the same picture.
        let again = pack(&scene, &params, seed).unwrap();
        prop_assert_eq!(format!("{:?}", artwork.groups), format!("{:?}", again.groups));
    }

    #[test]
    fn random_elements_never_fold_or_touch(
        outline in prop::collection::vec((5.0..95.0f64, -28.0..28.0f64), 3..7), spacing in 25.0..60.0f64, seed in 0..1000u64,
    ) {
        // Sorted around the spine's middle, most outlines do not cross themselves.
        let mut points = outline;
        points.sort_by(|a, b| (a.1.atan2(a.0 - 50.0)).total_cmp(&b.1.atan2(b.0 - 50.0)));
        let corners: Vec<Point> = points.iter().map(|&p| p.into()).collect();
        let edges: Vec<_> = sides(&corners).collect();
        prop_assume!(!edges.iter().any(|&(p, q)| edges.iter().any(|&(r, s)| crosses(p, q, r, s))));
        let data: Vec<String> = points.iter().map(|p| format!("{:.2},{:.2}", p.0, p.1)).collect();
        let svg = format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 400 400'><path id='c' class='rinceau-container' d='M20,200C20,20 380,20 380,200C380,300 300,380 200,380C200,300 20,380 20,200Z'/><g class='rinceau-element' id='e'><path d='M{}Z'/><path class='rinceau-spine' d='M0,0H100'/></g></svg>", data.join(" "));
        let (_, scene) = read(svg);
        match pack(&scene, &[("spacing", format!("{spacing:.3}"))], seed) {
            Ok(artwork) => {
                let container = Region::new(contours(&scene.containers[0].outlines[0].path)).unwrap();
                check(&artwork, &container, &[], (spacing / 8.0, 0.42 * spacing / 8.0));
            }
            Err(error) => prop_assert!(["nothing-fits", "flat-element"].contains(&error.code()), "{error}"),
        }
    }
}

#[test]
fn every_sample_keeps_its_promises() {
    for path in support::samples() {
        let (_, scene) = read(std::fs::read(&path).unwrap());
        let gap = (scene.view.width() / 0.25).round() / 1e3;
        let artwork = pack(&scene, &[("min-gap", gap.to_string())], 7).unwrap();
        let outlines = scene.containers.iter().flat_map(|container| contours(&container.outlines[0].path));
        check(&artwork, &Region::new(outlines.collect()).unwrap(), &[], (gap, gap));
        assert!(artwork.complete, "{}", path.display());
        assert!(artwork.counts["coverage"] > 0.3, "{}: {:?}", path.display(), artwork.counts);
    }
}

/// A guide that lies in a hole, near enough to the edge to count, gives no flow: the outline does.
#[test]
fn a_guide_that_just_misses_the_region_is_no_flow() {
    let (_, scene) = read(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 400 400'><path class='rinceau-container' fill-rule='evenodd' d='M50,200A150,150 0 1 1 350,200A150,150 0 1 1 50,200ZM147.5,200A52.5,52.5 0 1 1 252.5,200A52.5,52.5 0 1 1 147.5,200Z'/><path class='rinceau-guide' d='M242.5,220Q242.5,191.5 163.2,207.5' fill='none'/></svg>",
    );
    let artwork = pack(&scene, &[("spacing", "24".to_owned())], 1).unwrap();
    assert!(artwork.counts["elements"] > 20.0);
}

/// Every piece of a mirrored composition has its image, and all promises hold across the axis.
#[test]
fn mirrored_halves_are_alike_and_keep_apart() {
    for (turn, symmetry, guide) in [
        (0, "mirror", ""),
        (35, "mirror", ""),
        (0, "line", "<path class='rinceau-guide' d='M20,210H380' fill='none'/>"),
    ] {
        let outline = "M200,60C260,10 370,30 370,120C370,220 250,300 200,360C150,300 30,220 30,120C30,30 140,10 200,60Z";
        let svg = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 400 400'><path id='c' class='rinceau-container' transform='rotate({turn} 200 200)' d='{outline}'/>{guide}</svg>"
        );
        let (_, scene) = read(svg);
        let params =
            [("spacing", "24".to_owned()), ("min-gap", "3".to_owned()), ("symmetry", symmetry.to_owned())];
        let artwork = pack(&scene, &params, 3).unwrap();
        let container = Region::new(contours(&scene.containers[0].outlines[0].path)).unwrap();
        check(&artwork, &container, &[], (3.0, 3.0));
        let elements = pieces(&artwork, "elements");
        assert!(elements.len() > 16 && elements.len().is_multiple_of(2), "{}", elements.len());
        for pair in elements.chunks(2) {
            let ink = |piece: &Vec<Vec<Point>>| piece.iter().map(|c| signed_area(c).abs()).sum::<f64>();
            assert!((ink(&pair[0]) - ink(&pair[1])).abs() < 1e-6 * ink(&pair[0]).max(1.0));
        }
    }
    let (_, scene) = read(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 400 400'><circle class='rinceau-container' cx='200' cy='200' r='150'/></svg>",
    );
    let refused = pack(&scene, &[("symmetry", "line".to_owned())], 1).unwrap_err();
    assert_eq!(refused.code(), "no-axis");
}

/// Shapes of the gaps keep the gap to elements, to each other's halves and to the outline; the map of the
/// gaps lies in them.
#[test]
fn shapes_of_the_gaps_keep_apart() {
    for symmetry in ["none", "mirror"] {
        let (_, scene) = read(
            "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 400 400'><path class='rinceau-container' d='M200,30C320,20 390,120 360,230S250,390 200,370 60,340 40,230 80,40 200,30Z'/><circle class='rinceau-fixed' cx='200' cy='190' r='25'/></svg>",
        );
        let params = [
            ("spacing", "40".to_owned()),
            ("min-gap", "4".to_owned()),
            ("fillers", "shapes".to_owned()),
            ("symmetry", symmetry.to_owned()),
            ("show-gaps", "true".to_owned()),
        ];
        let artwork = pack(&scene, &params, 2).unwrap();
        let container = Region::new(contours(&scene.containers[0].outlines[0].path)).unwrap();
        let (elements, shapes) = (pieces(&artwork, "elements"), pieces(&artwork, "negative"));
        assert!(shapes.len() > 4, "{}", shapes.len());
        for (i, shape) in shapes.iter().enumerate() {
            assert_inside(&format!("shape {i}"), shape, &container);
            assert!(elements.iter().all(|element| distance(shape, element, 4.0) >= 4.0 - SLACK));
            assert!(distance(shape, &[disc((200.0, 190.0), 25.0)], 4.0) >= 4.0 - SLACK - 0.08);
        }
        let gaps = artwork.group("gaps").unwrap();
        assert!(gaps.hidden && gaps.items.len() > 50);
        for gap in pieces(&artwork, "gaps") {
            assert_inside("a disc of the map", &gap, &container);
        }
    }
}

/// Stops after a number of steps, as a clock would, but at the same place every time.
struct Steps(usize);

impl rinceau::Progress for Steps {
    fn step(&mut self, _: &'static str, _: f64) -> bool {
        self.0 = self.0.saturating_sub(1);
        self.0 > 0
    }
}

#[test]
fn out_of_time_gives_the_best_so_far_or_a_sentence() {
    let (_, scene) = read(std::fs::read(&support::samples()[0]).unwrap());
    let run = |steps| rinceau::generate(&GENERATORS[0], &Values::default(), &scene, 1, &mut Steps(steps));
    assert_eq!(run(1).unwrap_err().code(), "out-of-time");
    let (mut partial, mut whole) = (0, 0);
    for steps in (10..400).step_by(30) {
        match run(steps) {
            Ok(artwork) if artwork.complete => whole += 1,
            Ok(artwork) => {
                partial += 1;
                assert!(!artwork.group("elements").unwrap().items.is_empty());
            }
            Err(error) => assert_eq!(error.code(), "out-of-time"),
        }
    }
    assert!(partial > 0 && whole > 0, "{partial} partial, {whole} whole");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(8), failure_persistence: None, ..ProptestConfig::default() })]

    /// However far outlines give way, whatever fills the gaps and however narrow those are: pieces keep apart, stay
    /// inside and do not fold, and what grows covers more.
    #[test]
    fn moulded_pieces_keep_apart(
        outer in waves(), seed in 0..1000u64, mould in 0.1..1.0f64, gap in 1.0..9.0f64, filled in any::<bool>(),
    ) {
        let shape = blob((200.0, 200.0), 180.0, &outer);
        let (_, scene) = read(format!(
            "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 400 400'><path class='rinceau-container' d='{shape}'/></svg>"
        ));
        let fillers = if filled { "pebbles" } else { "none" };
        let with = |mould: f64| {
            let params = [
                ("spacing", "52".to_owned()),
                ("min-gap", gap.to_string()),
                ("mould", mould.to_string()),
                ("fillers", fillers.to_owned()),
            ];
            pack(&scene, &params, seed).unwrap()
        };
        let moulded = with(mould);
        let outline = scene.containers.iter().flat_map(|container| contours(&container.outlines[0].path));
        check(&moulded, &Region::new(outline.collect()).unwrap(), &[], (gap, gap));
        prop_assert!(filled || moulded.counts["coverage"] > with(0.0).counts["coverage"]);
    }
}

/// A shape in several parts, as a word is, gets ornament in each of them from every generator that fills
/// shapes; a part that is far too small for any stays empty.
#[test]
fn every_part_of_a_shape_is_filled() {
    let parts = [(20.0, 120.0), (150.0, 40.0), (300.0, 140.0)];
    let square = |(x, side): (f64, f64)| format!("M{x},30h{side}v{side}h{}z", -side);
    let path = parts.map(square).concat() + "M5,5h0.5v0.5h-0.5z";
    // The first has a hole with an island in it.
    let hole = "M40,50v80h80v-80zM60,70h40v40h-40z";
    let (_, scene) =
        read(support::svg(&format!("<path id='three' class='rinceau-container' d='{path}{hole}'/>")));
    for generator in ["pack", "grow", "vine"] {
        let artwork = generated(generator, &scene, &[], 1).unwrap();
        let drawn: Vec<Point> = artwork
            .groups
            .iter()
            .filter(|group| !group.hidden)
            .flat_map(|group| pieces(&artwork, &group.name))
            .map(|piece| bounds(&piece).center())
            .collect();
        for (x, side) in parts.into_iter().chain([(60.0, 40.0)]) {
            let count = drawn.iter().filter(|p| (x..x + side).contains(&p.x)).count();
            assert!(count >= 2, "{generator}: {count} pieces at {x}");
        }
    }
}
