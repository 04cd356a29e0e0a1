//! A two-clone tree of one rectangle (Carlson and Woodbury's Figure 1 with a filled trunk), from
//! a thousand to ten million rectangles, expanded and written as flat paths; beside it the plain
//! cost of writing as many bytes. Bytes per rectangle are printed once.

use divan::counter::ItemsCount;
use rinceau::params::Values;
use rinceau::{Deadline, GENERATORS, Generator};
use rinceau_format::{Document, Recipe, Selection};
use std::io::Write;

const DEPTHS: [usize; 5] = [10, 13, 17, 20, 23];

/// The program's.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() {
    for depth in DEPTHS {
        let n = (1_u64 << depth) - 1;
        let bytes = tree(depth);
        println!("depth {depth}: {n} rectangles, {:.1} bytes each", bytes as f64 / n as f64);
    }
    divan::main();
}

const TREE: &str = "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' viewBox='0 0 1000 1000'>
<g id='tree' class='rinceau-form'>
<rect id='trunk' x='480' y='700' width='40' height='280' fill='#24452f'/>
<use xlink:href='#trunk' transform='translate(500 700) rotate(-35) scale(.7) translate(-500 -980)'/>
<use xlink:href='#trunk' transform='translate(500 700) rotate(25) scale(.75) translate(-500 -980)'/>
</g></svg>";

fn recurse() -> &'static Generator {
    GENERATORS.iter().find(|generator| generator.name == "recurse").expect("the table has it")
}

/// Counts bytes on their way to nowhere.
struct Counted(u64);

impl Write for Counted {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0 += bytes.len() as u64;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

/// Expands the tree and writes it; returns how many bytes that were.
fn tree(depth: usize) -> u64 {
    written(depth, "paths")
}

fn written(depth: usize, output: &str) -> u64 {
    let document = Document::from_bytes(TREE.as_bytes().to_vec()).unwrap();
    let scene = document.scene(&Selection::default()).unwrap();
    let mut values = Values::default();
    let depth = depth.to_string();
    for (name, value) in [("depth", depth.as_str()), ("most", "1e15"), ("output", output)] {
        values.set(recurse().table, name, value).unwrap();
    }
    let artwork = rinceau::generate(recurse(), &values, &scene, 1, &mut Deadline::new(None)).unwrap();
    let recipe = Recipe {
        generator: "recurse".into(),
        params: values.recipe(recurse().table),
        seed: 1,
        sources: vec!["tree".into()],
        with: Vec::new(),
        label: "Ornament".into(),
    };
    let mut out = Counted(0);
    document.write_with_layer(&artwork, &recipe, &mut out).unwrap().unwrap();
    out.0
}

#[divan::bench(args = DEPTHS, max_time = 8)]
fn flat_paths(bencher: divan::Bencher, depth: usize) {
    bencher.counter(ItemsCount::new((1_u64 << depth) - 1)).bench(|| tree(depth));
}

/// What writing the bytes alone takes, from memory to memory.
#[divan::bench(args = DEPTHS, max_time = 4)]
fn bytes_alone(bencher: divan::Bencher, depth: usize) {
    let bytes = tree(depth);
    let chunk = vec![b'x'; 1 << 12];
    let mut page = Vec::with_capacity(1 << 12);
    bencher.counter(ItemsCount::new((1_u64 << depth) - 1)).bench_local(|| {
        for _ in 0..bytes >> 12 {
            page.clear();
            page.extend_from_slice(divan::black_box(&chunk));
            divan::black_box(&page);
        }
    });
}

/// Clones: the work does not grow with the copies.
#[divan::bench(args = [10, 20, 40])]
fn clones(depth: usize) -> u64 {
    written(depth, "clones")
}
