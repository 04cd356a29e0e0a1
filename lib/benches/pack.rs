//! The paper's workload (50 elements, 15 iterations: an hour in FLOWPAK 5), and ten and a
//! hundred times as many, to show the cost curve.

use rinceau::params::Values;
use rinceau::{Deadline, GENERATORS};
use rinceau_format::{Document, Scene, Selection};

/// The program's.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() {
    divan::main();
}

/// A disc with an S-shaped guide.
fn scene() -> Scene {
    let svg = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 1000 1000'>
        <circle class='rinceau-container' cx='500' cy='500' r='450'/>
        <path class='rinceau-guide' d='M200,300C500,0 600,900 850,650'/></svg>";
    Document::from_bytes(svg.as_bytes().to_vec()).unwrap().scene(&Selection::default()).unwrap()
}

/// Packs about `n` elements.
fn pack(n: usize, iterations: &str) -> usize {
    let generator = &GENERATORS[0];
    // An average element takes 2.9 times the square of the spacing.
    let area = std::f64::consts::PI * 450.0 * 450.0;
    let spacing = (area / (n as f64 * 2.9)).sqrt();
    let mut values = Values::default();
    values.set(generator.table, "spacing", &spacing.to_string()).unwrap();
    values.set(generator.table, "iterations", iterations).unwrap();
    let artwork = rinceau::generate(generator, &values, &scene(), 1, &mut Deadline::new(None)).unwrap();
    artwork.counts["elements"] as usize
}

#[divan::bench(args = [50, 500, 5000], max_time = 20)]
fn first_pass(n: usize) -> usize {
    pack(n, "0")
}

#[divan::bench(args = [50, 500, 5000], max_time = 20)]
fn refined(n: usize) -> usize {
    pack(n, "15")
}
