//! What a written drawing shows, as polygons: the checks of the invariants know nothing of how
//! an ornament was made.

use super::root;
use kurbo::{Affine, BezPath, Point, Rect};
use rinceau::geom::flatten::flatten;
use rinceau::geom::region::Region;
use rinceau::geom::segment::segment_segment;
use rinceau::params::Values;
use rinceau::{Deadline, GENERATORS, Generator};
use rinceau_format::{Artwork, Document, Error, Item, Part, Recipe, Scene, Selection};
use std::path::PathBuf;

/// Written coordinates are rounded to three decimals, and outlines are flattened for the
/// check; both move points by less than this.
pub const SLACK: f64 = 0.01;

/// How far chords lie from the curves they stand for.
pub const FLATNESS: f64 = 0.004;

/// A placed piece: its outlines as closed polylines.
pub type Piece = Vec<Vec<Point>>;

/// The generator of this name.
pub fn generator(name: &str) -> &'static Generator {
    GENERATORS.iter().find(|generator| generator.name == name).expect("a generator")
}

/// Settings by name.
pub fn values(generator: &Generator, params: &[(&str, String)]) -> Values {
    let mut values = Values::default();
    for (name, value) in params {
        values.set(generator.table, name, value).unwrap();
    }
    values
}

/// Runs a generator without a time limit.
pub fn generated(name: &str, scene: &Scene, params: &[(&str, String)], seed: u64) -> Result<Artwork, Error> {
    let generator = generator(name);
    rinceau::generate(generator, &values(generator, params), scene, seed, &mut Deadline::new(None))
}

/// A drawing and what it asks for.
pub fn read(svg: impl Into<Vec<u8>>) -> (Document, Scene) {
    let document = Document::from_bytes(svg.into()).unwrap();
    let scene = document.scene(&Selection::default()).unwrap();
    (document, scene)
}

/// The drawing with an artwork, as it would be saved.
pub fn written(
    document: &Document,
    artwork: &Artwork,
    (name, params, seed): (&str, &[(&str, String)], u64),
) -> Document {
    let generator = generator(name);
    let scene = document.scene(&Selection::default()).unwrap();
    let recipe = Recipe {
        generator: name.into(),
        params: values(generator, params).recipe(generator.table),
        seed,
        sources: scene.containers.iter().map(|container| container.source.id.clone()).collect(),
        with: Vec::new(),
        label: "Ornament".into(),
    };
    document.with_layer(artwork, &recipe).unwrap()
}

/// The drawings of a folder of `samples`, in order of name.
pub fn samples_of(name: &str) -> Vec<PathBuf> {
    let folder = root().join("samples").join(name);
    let entries = folder.read_dir().unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "svg"));
    paths.sort();
    assert!(!paths.is_empty(), "no sample in {}", folder.display());
    paths
}

/// A closed wavy blob around a centre, as path data.
pub fn blob(centre: (f64, f64), radius: f64, waves: &[f64]) -> String {
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

/// A circle as a polygon.
pub fn disc(centre: (f64, f64), radius: f64) -> Vec<Point> {
    let point = |i: i32| {
        let a = f64::from(i) / 128.0 * std::f64::consts::TAU;
        Point::new(centre.0 + radius * a.cos(), centre.1 + radius * a.sin())
    };
    (0..128).map(point).collect()
}

/// The contours of a path.
pub fn contours(path: &BezPath) -> Piece {
    flatten(path, FLATNESS).into_iter().map(|subpath| subpath.points).collect()
}

/// Outlines of every piece that a group places, clones as what they show.
pub fn pieces(artwork: &Artwork, group: &str) -> Vec<Piece> {
    let items = artwork.group(group).map(|group| group.items.as_slice()).unwrap_or_default();
    let of_item = |item: &Item| {
        let (parts, pose) = match item.clone {
            Some((symbol, pose)) => (artwork.symbols[symbol].parts().collect::<Vec<_>>(), pose),
            None => (item.parts.iter().collect(), Affine::IDENTITY),
        };
        parts.iter().flat_map(|part| contours(&(pose * part.transform * part.path.clone()))).collect()
    };
    items.iter().map(of_item).collect()
}

/// The sides of a closed contour.
pub fn sides(contour: &[Point]) -> impl Iterator<Item = (Point, Point)> + '_ {
    (0..contour.len()).map(|i| (contour[i], contour[(i + 1) % contour.len()]))
}

/// The bounding box of a piece.
pub fn bounds(piece: &[Vec<Point>]) -> Rect {
    piece.iter().flatten().fold(Rect::from_points(piece[0][0], piece[0][0]), |r, &p| r.union_pt(p))
}

/// Least distance between two pieces, `reach` at most; 0 if one crosses or contains the other.
pub fn distance(a: &[Vec<Point>], b: &[Vec<Point>], reach: f64) -> f64 {
    if !bounds(a).inflate(reach, reach).overlaps(bounds(b)) {
        return reach;
    }
    let mut least = reach;
    for (p, q) in a.iter().flat_map(|contour| sides(contour)) {
        let near = Rect::from_points(p, q).inflate(least, least);
        for (r, s) in b.iter().flat_map(|contour| sides(contour)) {
            if near.overlaps(Rect::from_points(r, s).inflate(1e-9, 1e-9)) {
                least = least.min(segment_segment(p, q, r, s));
            }
        }
    }
    let contains = |outer: &[Vec<Point>], inner: &[Vec<Point>]| {
        Region::new(outer.to_vec()).is_some_and(|region| region.contains(inner[0][0]))
    };
    if contains(a, b) || contains(b, a) { 0.0 } else { least }
}

/// Panics unless a piece lies inside a container.
pub fn assert_inside(name: &str, piece: &[Vec<Point>], container: &Region) {
    for (p, q) in piece.iter().flat_map(|contour| sides(contour)) {
        assert_side_inside(name, (p, q), container);
    }
}

fn assert_side_inside(name: &str, (p, q): (Point, Point), container: &Region) {
    assert!(container.contains(p), "{name} leaves the container at {p:?}");
    let way = container.ray(p, (q - p).normalize(), p.distance(q));
    assert!(way >= p.distance(q) - SLACK, "{name} leaves the container after {p:?}");
}

/// Panics unless a part, its stroke as well, lies inside a container.
pub fn assert_drawn_inside(name: &str, part: &Part, container: &Region) {
    let half = 0.5 * part.style.stroke_width().unwrap_or(0.0);
    for subpath in flatten(&(part.transform * part.path.clone()), FLATNESS) {
        let is_area = subpath.closed || part.style.is_filled();
        let ends = sides(&subpath.points).take(subpath.points.len() - usize::from(!is_area));
        ends.for_each(|side| assert_side_inside(name, side, container));
        for &p in subpath.points.iter().filter(|_| half > 0.0) {
            assert!(
                container.distance(p, half) > half - SLACK,
                "{name}: its stroke leaves the container at {p:?}"
            );
        }
    }
}

/// Few by default, since each case makes and checks a drawing; `PROPTEST_CASES` asks for more.
pub fn cases(default: u32) -> u32 {
    std::env::var("PROPTEST_CASES").ok().and_then(|cases| cases.parse().ok()).unwrap_or(default)
}

/// The same cases in every run, unless `PROPTEST_CASES` asks for a longer look.
pub fn rng_seed() -> proptest::test_runner::RngSeed {
    match std::env::var_os("PROPTEST_CASES") {
        Some(_) => proptest::test_runner::RngSeed::Random,
        None => proptest::test_runner::RngSeed::Fixed(1),
    }
}

proptest::prop_compose! {
    /// Heights of the waves of a [`blob`].
    pub fn waves()(a in -0.12..0.12f64, b in -0.1..0.1f64, c in -0.07..0.07f64, d in -0.05..0.05f64) -> Vec<f64> {
        vec![a, b, c, d]
    }
}
