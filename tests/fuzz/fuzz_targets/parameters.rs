//! Any names and values as the parameters of a generator on a small drawing: a result or a sentence, in
//! time. The first byte says which generator; then come a name and a value on each line.

#![no_main]

use libfuzzer_sys::fuzz_target;
use rinceau::{Deadline, GENERATORS, Values};
use rinceau_format::{Document, Scene, Selection};
use std::sync::LazyLock;
use std::time::Duration;

const DRAWING: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 90 60">
<path class="rinceau-container" d="M0,0H60V60H0Z"/><path class="rinceau-guide" d="M0,30H60"/>
<g class="rinceau-form"><path id="m" d="M70,20V0" stroke="black"/><use href="#m" transform="translate(30 -8) scale(.6)"/></g>
<g class="rinceau-reference"><rect id="a" x="70" y="40" width="3" height="2"/><use href="#a" x="4"/><use href="#a" x="8"/>
<use href="#a" y="3"/><use href="#a" x="4" y="3"/><use href="#a" x="8" y="3"/><use href="#a" y="6"/><use href="#a" x="4" y="6"/><use href="#a" x="8" y="6"/></g>
</svg>"##;

static SCENE: LazyLock<Scene> = LazyLock::new(|| {
    let document = Document::from_bytes(DRAWING.as_bytes().to_vec()).expect("a drawing");
    document.scene(&Selection::default()).expect("a scene")
});

fuzz_target!(|text: &str| {
    let Some(&first) = text.as_bytes().first() else { return };
    let generator = &GENERATORS[first as usize % GENERATORS.len()];
    let mut values = Values::default();
    for line in text.lines().skip(1) {
        let (name, value) = line.split_once(' ').unwrap_or((line, ""));
        // Files are for the program to read.
        if name != "rules" {
            let _ = values.set(generator.table, name, value);
        }
    }
    let mut limit = Deadline::new(Some(Duration::from_millis(100)));
    let _ = rinceau::generate(generator, &values, &SCENE, u64::from(first), &mut limit);
});
