//! Promises of packing that hold for any drawing: inside the container, the gap kept, fixed
//! areas clear, no outline crossing itself, the same bytes for the same seed, an end.
//!
//! The checks know nothing of how the packing was made: they read the written drawing.

mod support;

use kurbo::{BezPath, Point};
use proptest::prelude::*;
use rinceau::geom::boolean::{area, signed_area, simplified};
use rinceau::geom::flatten::flatten;
use rinceau::geom::near::{crosses, segment_segment};
use rinceau::geom::region::Region;
use rinceau::params::Values;
use rinceau::{Deadline, GENERATORS};
use rinceau_format::{Artwork, Document, Scene, Selection};

/// Written coordinates are rounded to three decimals, and outlines are flattened for the
/// check; both move points by less than this.
const SLACK: f64 = 0.01;

/// An area that nobody sees: a hundredth of the square of the above in a drawing of 400 units.
const TINY: f64 = 1e-3;

fn pack(scene: &Scene, params: &[(&str, String)], seed: u64) -> Artwork {
    let generator = &GENERATORS[0];
    let mut values = Values::default();
    for (name, value) in params {
        values.set(generator.table, name, value).unwrap();
    }
    rinceau::generate(generator, &values, scene, seed, &mut Deadline::new(None)).unwrap()
}

fn scene(svg: &str) -> Scene {
    Document::from_bytes(svg.as_bytes().to_vec()).unwrap().scene(&Selection::default()).unwrap()
}

/// A closed wavy blob around a centre, as path data.
fn blob(centre: (f64, f64), radius: f64, waves: &[f64]) -> String {
    let n = 64;
    let points: Vec<String> = (0..n)
        .map(|i| {
            let a = f64::from(i) / f64::from(n) * std::f64::consts::TAU;
            let r =
                waves.iter().enumerate().fold(1.0, |r, (k, w)| r + w * ((k + 2) as f64 * a + w * 40.0).sin());
            format!("{:.2},{:.2}", centre.0 + radius * r * a.cos(), centre.1 + radius * r * a.sin())
        })
        .collect();
    format!("M{}Z", points.join(" "))
}

/// Outlines of every placed piece, each piece a list of closed polylines.
fn pieces(artwork: &Artwork, group: &str) -> Vec<Vec<Vec<Point>>> {
    let items = artwork.group(group).map(|group| group.items.as_slice()).unwrap_or_default();
    let outline = |path: &BezPath| flatten(path, 0.004).into_iter().map(|subpath| subpath.points).collect();
    items
        .iter()
        .map(|item| {
            item.parts
                .iter()
                .flat_map(|part| -> Vec<Vec<Point>> { outline(&(part.transform * part.path.clone())) })
                .collect()
        })
        .collect()
}

fn sides(contour: &[Point]) -> impl Iterator<Item = (Point, Point)> + '_ {
    (0..contour.len()).map(|i| (contour[i], contour[(i + 1) % contour.len()]))
}

fn bounds(piece: &[Vec<Point>]) -> kurbo::Rect {
    piece.iter().flatten().fold(kurbo::Rect::from_points(piece[0][0], piece[0][0]), |r, &p| r.union_pt(p))
}

/// Least distance between two pieces, `reach` at most; 0 if one crosses or contains the other.
fn distance(a: &[Vec<Point>], b: &[Vec<Point>], reach: f64) -> f64 {
    if !bounds(a).inflate(reach, reach).overlaps(bounds(b)) {
        return reach;
    }
    let mut least = reach;
    for (p, q) in a.iter().flat_map(|contour| sides(contour)) {
        let near = kurbo::Rect::from_points(p, q).inflate(least, least);
        for (r, s) in b.iter().flat_map(|contour| sides(contour)) {
            if near.overlaps(kurbo::Rect::from_points(r, s).inflate(1e-9, 1e-9)) {
                least = least.min(segment_segment(p, q, r, s));
            }
        }
    }
    let contains = |outer: &[Vec<Point>], inner: &[Vec<Point>]| {
        Region::new(outer.to_vec()).is_some_and(|region| region.contains(inner[0][0]))
    };
    if contains(a, b) || contains(b, a) { 0.0 } else { least }
}

/// Checks every promise on one artwork.
fn check(artwork: &Artwork, container: &Region, clear: &[Vec<Vec<Point>>], gap: f64) {
    let elements = pieces(artwork, "elements");
    let all: Vec<&Vec<Vec<Point>>> = elements
        .iter()
        .chain(&pieces(artwork, "fillers"))
        .cloned()
        .map(|p| &*Box::leak(Box::new(p)))
        .collect();
    assert!(!elements.is_empty());
    for (i, piece) in all.iter().enumerate() {
        for contour in piece.iter() {
            for (p, q) in sides(contour) {
                assert!(container.contains(p), "piece {i} leaves the container at {p:?}");
                assert!(container.ray(p, (q - p).normalize(), p.distance(q)) >= p.distance(q) - SLACK);
            }
        }
        for other in &all[..i] {
            let between = distance(piece, other, gap);
            assert!(
                between >= gap - SLACK,
                "pieces {i} of {} elements are {between} apart, less than {gap}: {:?} {:?}",
                elements.len(),
                bounds(piece),
                bounds(other)
            );
        }
        for fixed in clear {
            assert!(distance(piece, fixed, gap) >= gap - SLACK - 0.02 * gap);
        }
    }
    for contour in elements.iter().flatten() {
        let folded = folded_area(contour);
        assert!(folded <= 1e-5 * signed_area(contour).abs() + TINY, "an outline folds over {folded}");
    }
}

/// Area that a contour winds around the wrong way, or more than once. Chords of two curves
/// that meet in a needle may cross by nothing; a fold has an area.
fn folded_area(contour: &[Point]) -> f64 {
    let sides: Vec<_> = sides(contour).collect();
    let crossed =
        (0..sides.len()).any(|i| sides[..i].iter().any(|&(r, s)| crosses(sides[i].0, sides[i].1, r, s)));
    if !crossed {
        return 0.0;
    }
    let covered = area(&simplified(&[contour.to_vec()], false));
    (covered - signed_area(contour).abs()).abs()
}

prop_compose! {
    fn waves()(a in -0.12..0.12f64, b in -0.1..0.1f64, c in -0.07..0.07f64, d in -0.05..0.05f64) -> Vec<f64> {
        vec![a, b, c, d]
    }
}

/// Few by default, since each packs and checks a drawing; `PROPTEST_CASES` asks for more.
fn cases() -> u32 {
    std::env::var("PROPTEST_CASES").ok().and_then(|cases| cases.parse().ok()).unwrap_or(16)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(), failure_persistence: None, ..ProptestConfig::default() })]

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
        let document = Document::from_bytes(svg.into_bytes()).unwrap();
        let scene = document.scene(&Selection::default()).unwrap();
        let params = [("spacing", format!("{spacing:.3}")), ("min-gap", format!("{gap:.3}")), ("stretch", format!("{stretch:.3}")), ("elements", family.to_owned())];
        let run = |seed| {
            let generator = &GENERATORS[0];
            let mut values = Values::default();
            params.iter().for_each(|(name, value)| values.set(generator.table, name, value).unwrap());
            rinceau::generate(generator, &values, &scene, seed, &mut Deadline::new(None))
        };
        let artwork = match run(seed) {
            Ok(artwork) => artwork,
            Err(error) => {
                prop_assert_eq!(error.code(), "guide-outside");
                return Ok(());
            }
        };
        let contours = flatten(&BezPath::from_svg(&outline).unwrap(), 0.004).into_iter().map(|s| s.points).collect();
        let fixed: Vec<Point> = (0..128).map(|i| {
            let a = f64::from(i) / 128.0 * std::f64::consts::TAU;
            Point::new(fixed_at.0 + 15.0 * a.cos(), fixed_at.1 + 15.0 * a.sin())
        }).collect();
        check(&artwork, &Region::new(contours).unwrap(), &[vec![fixed]], gap.min((gap * 1e3).round() / 1e3));
        // The same seed draws the same picture.
        let again = run(seed).unwrap();
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
        let scene = scene(&svg);
        let generator = &GENERATORS[0];
        let mut values = Values::default();
        values.set(generator.table, "spacing", &format!("{spacing:.3}")).unwrap();
        match rinceau::generate(generator, &values, &scene, seed, &mut Deadline::new(None)) {
            Ok(artwork) => {
                let contours = flatten(&scene.containers[0].outlines[0].path, 0.004).into_iter().map(|s| s.points).collect();
                check(&artwork, &Region::new(contours).unwrap(), &[], spacing / 8.0);
            }
            Err(error) => prop_assert!(["nothing-fits", "flat-element"].contains(&error.code()), "{error}"),
        }
    }
}

#[test]
fn every_sample_keeps_its_promises() {
    for path in support::samples() {
        let svg = std::fs::read_to_string(&path).unwrap();
        let scene = scene(&svg);
        let gap = (scene.view.width() / 0.25).round() / 1e3;
        let artwork = pack(&scene, &[("min-gap", gap.to_string())], 7);
        let contours: Vec<Vec<Point>> = scene
            .containers
            .iter()
            .flat_map(|container| flatten(&container.outlines[0].path, 0.004))
            .map(|subpath| subpath.points)
            .collect();
        check(&artwork, &Region::new(contours).unwrap(), &[], gap);
        assert!(artwork.complete, "{}", path.display());
        assert!(artwork.counts["coverage"] > 0.3, "{}: {:?}", path.display(), artwork.counts);
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
    let svg = std::fs::read_to_string(&support::samples()[0]).unwrap();
    let scene = scene(&svg);
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
