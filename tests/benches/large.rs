//! Large drawings: what it costs to read one, splice a small layer into it and write it, beside the XML
//! parser alone.

use kurbo::{Affine, Circle, Shape};
use rinceau_format::{Artwork, Document, Group, Item, Limits, Part, Recipe, Selection, Style, read_file};
use std::fmt::Write;
use std::time::{Duration, Instant};

/// A drawing of 100,000 paths with so many points each.
fn drawing(points: usize) -> Vec<u8> {
    let mut text = String::from(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 1000 1000\">\n<path id=\"body\" class=\"rinceau-container\" d=\"M100,100H400V400H100Z\"/>\n",
    );
    let mut state = 1_u64;
    let mut number = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) % 1_000_000
    };
    for i in 0..100_000 {
        let _ = write!(text, "<path id=\"p{i}\" style=\"fill:none;stroke:#204060\" d=\"M");
        for _ in 0..points {
            let (x, y) = (number(), number());
            let _ = write!(text, "{}.{:03},{}.{:03} ", x / 1000, x % 1000, y / 1000, y % 1000);
        }
        text.push_str("\"/>\n");
    }
    text.push_str("</svg>\n");
    text.into_bytes()
}

/// The shortest of several runs of two things in turn, so that a slow moment is slow for both.
fn shortest(mut first: impl FnMut(), mut second: impl FnMut()) -> (Duration, Duration) {
    const RUNS: usize = 15;
    let timed = |run: &mut dyn FnMut()| {
        let start = Instant::now();
        run();
        start.elapsed()
    };
    let times = (0..RUNS).map(|_| (timed(&mut first), timed(&mut second)));
    times.fold((Duration::MAX, Duration::MAX), |least, time| (least.0.min(time.0), least.1.min(time.1)))
}

fn main() {
    let path = Circle::new((250.0, 250.0), 40.0).to_path(0.1);
    let part = Part { path, transform: Affine::IDENTITY, style: Style::filled("#14444f") };
    let group =
        Group { name: "elements".into(), items: vec![Item::new("dot", vec![part])], ..Group::default() };
    let artwork = Artwork { groups: vec![group], complete: true, decimals: 3, ..Artwork::default() };
    let recipe = Recipe {
        generator: "pack".into(),
        params: serde_json::Map::new(),
        seed: 1,
        sources: vec!["body".into()],
        with: Vec::new(),
        label: "Ornament".into(),
    };
    let folder = tempfile::tempdir().expect("a folder");
    let (input, output) = (folder.path().join("in.svg"), folder.path().join("out.svg"));
    println!("{:>8} {:>12} {:>16} {:>8}", "MB", "parser ms", "file to file ms", "times");
    for points in [3, 61] {
        let bytes = drawing(points);
        std::fs::write(&input, &bytes).expect("a file");
        let text = std::str::from_utf8(&bytes).expect("text");
        let parse = || drop(roxmltree::Document::parse(text).expect("XML"));
        let (parser, all) = shortest(parse, || {
            let document = Document::from_bytes(read_file(&input, Limits::default().bytes).expect("a file"))
                .expect("a drawing");
            let scene = document.scene(&Selection::default()).expect("a scene");
            assert_eq!(scene.containers.len(), 1);
            let mut out = std::fs::File::create(&output).expect("a file");
            document.write_with_layer(&artwork, &recipe, &mut out).expect("a layer").expect("written");
        });
        println!(
            "{:8.1} {:12.1} {:16.1} {:8.2}",
            bytes.len() as f64 / 1e6,
            parser.as_secs_f64() * 1e3,
            all.as_secs_f64() * 1e3,
            all.as_secs_f64() / parser.as_secs_f64()
        );
    }
}
