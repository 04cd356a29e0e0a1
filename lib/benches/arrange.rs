//! Bricks and irregular dots continued to a thousand, ten thousand and a hundred thousand elements,
//! with relaxation.

use divan::counter::ItemsCount;
use rinceau::params::Values;
use rinceau::{Deadline, GENERATORS, Generator, Rng};
use rinceau_format::{Document, Scene, Selection};
use std::fmt::Write;

/// The program's.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() {
    divan::main();
}

const COUNTS: [usize; 3] = [1000, 10_000, 100_000];

fn arrange() -> &'static Generator {
    GENERATORS.iter().find(|generator| generator.name == "arrange").expect("the table has it")
}

fn scene(example: &str) -> Scene {
    let svg = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' xmlns:rinceau='urn:rinceau:1' viewBox='0 0 200 200'><g class='rinceau-reference'>{example}</g></svg>"
    );
    Document::from_bytes(svg.into_bytes()).unwrap().scene(&Selection::default()).unwrap()
}

fn bricks() -> Scene {
    let mut example = String::new();
    for (row, column) in (0..6).flat_map(|row| (0..5).map(move |column| (row, column))) {
        let (x, y) = (40 * column + 20 * (row % 2), 20 * row);
        let _ = write!(example, "<rect rinceau:symbol='brick' x='{x}' y='{y}' width='38' height='18'/>");
    }
    scene(&example)
}

fn dots() -> Scene {
    let mut rng = Rng::new(5);
    let mut example = String::new();
    let mut places: Vec<(f64, f64)> = Vec::new();
    while places.len() < 40 {
        let (x, y) = (rng.between(0.0, 150.0), rng.between(0.0, 150.0));
        if places.iter().all(|(u, v)| (x - u).hypot(y - v) > 18.0) {
            let (kind, r) = (places.len() % 3, 4 + 2 * (places.len() % 3));
            let _ = write!(example, "<circle rinceau:symbol='s{kind}' cx='{x:.2}' cy='{y:.2}' r='{r}'/>");
            places.push((x, y));
        }
    }
    scene(&example)
}

fn run(scene: &Scene, count: usize) -> f64 {
    let mut values = Values::default();
    values.set(arrange().table, "count", &count.to_string()).unwrap();
    let artwork = rinceau::generate(arrange(), &values, scene, 1, &mut Deadline::new(None)).unwrap();
    artwork.counts["grown"]
}

#[divan::bench(args = COUNTS, max_time = 8)]
fn regular(bencher: divan::Bencher, count: usize) {
    let scene = bricks();
    bencher.counter(ItemsCount::new(count)).bench(|| run(&scene, count));
}

#[divan::bench(args = COUNTS, max_time = 8)]
fn irregular(bencher: divan::Bencher, count: usize) {
    let scene = dots();
    bencher.counter(ItemsCount::new(count)).bench(|| run(&scene, count));
}
