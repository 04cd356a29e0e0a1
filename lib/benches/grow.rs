//! Growth: the paper's dots at a thousand, ten thousand and a hundred thousand, and every pattern on
//! its panel.

use rinceau::{Deadline, GENERATORS, Values};
use rinceau_format::{Document, Scene, Selection};

/// The program's.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() {
    divan::main();
}

/// A square of so many units of the rules.
fn panel(units: f64) -> Scene {
    let svg = format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {units} {units}"><rect class="rinceau-container" width="{units}" height="{units}"/></svg>"##
    );
    Document::from_bytes(svg.into_bytes()).unwrap().scene(&Selection::default()).unwrap()
}

fn grown(scene: &Scene, pattern: &str) -> f64 {
    let generator = GENERATORS.iter().find(|generator| generator.name == "grow").unwrap();
    let mut values = Values::default();
    for (name, value) in [("rules", pattern), ("rule-unit", "1"), ("max-elements", "200000")] {
        values.set(generator.table, name, value).unwrap();
    }
    rinceau::generate(generator, &values, scene, 1, &mut Deadline::new(None)).unwrap().counts["elements"]
}

/// About so many dots: a panel of 100 units has 817.
#[divan::bench(args = [1_000, 10_000, 100_000], max_time = 8)]
fn dots(bencher: divan::Bencher, count: u32) {
    let scene = panel(100.0 * (f64::from(count) / 817.0).sqrt());
    bencher
        .counter(divan::counter::ItemsCount::new(grown(&scene, "dots") as usize))
        .bench(|| grown(&scene, "dots"));
}

#[divan::bench(args = ["spiral", "vines", "vase", "willow", "willow-planned", "flower"], max_time = 3)]
fn pattern(bencher: divan::Bencher, name: &str) {
    let scene = panel(100.0);
    bencher
        .counter(divan::counter::ItemsCount::new(grown(&scene, name) as usize))
        .bench(|| grown(&scene, name));
}
