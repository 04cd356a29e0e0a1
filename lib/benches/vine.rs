//! The article's sample ornament, and fillings of 100 to 10,000 branches with clip art, to show
//! the cost curve. Branch counts are what the run gave, printed once.

use rinceau::params::Values;
use rinceau::{Deadline, GENERATORS, Generator};
use rinceau_format::{Document, Scene, Selection};

/// The program's.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() {
    for n in SIZES {
        let artwork = filling(n);
        println!("filling {n}: {} branches, {} pieces of clip art", artwork.0, artwork.1);
    }
    divan::main();
}

const SIZES: [usize; 3] = [100, 1000, 10_000];

fn vine() -> &'static Generator {
    GENERATORS.iter().find(|generator| generator.name == "vine").expect("the table has it")
}

fn scene(svg: &str) -> Scene {
    Document::from_bytes(svg.as_bytes().to_vec()).unwrap().scene(&Selection::default()).unwrap()
}

fn run(scene: &Scene, params: &[(&str, &str)]) -> (f64, f64) {
    let mut values = Values::default();
    params.iter().for_each(|(name, value)| values.set(vine().table, name, value).unwrap());
    let artwork = rinceau::generate(vine(), &values, scene, 1, &mut Deadline::new(None)).unwrap();
    (artwork.counts["stems"], artwork.counts["elements"])
}

/// A square that about `n` branches fill.
fn filling(n: usize) -> (f64, f64) {
    // A branch with its leaf and flower takes about this many squares of the stem's width.
    const EACH: f64 = 39.0;
    let side = 10.0 * (EACH * n as f64).sqrt();
    let scene = scene(&format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {side} {side}'><rect class='rinceau-container' width='{side}' height='{side}'/></svg>"
    ));
    run(&scene, &[("stem-width", "10"), ("levels", "8"), ("branches", "1000")])
}

#[divan::bench(args = SIZES, max_time = 20)]
fn fill(n: usize) -> (f64, f64) {
    filling(n)
}

#[divan::bench]
fn sample_ornament(bencher: divan::Bencher) {
    let scene = scene(include_str!("../../samples/vine/ornament.svg"));
    bencher.bench(|| run(&scene, &[]));
}
