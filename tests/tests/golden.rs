//! Golden files: a small drawing in full, and every sample by its counts and a fingerprint of
//! its bytes. A changed fingerprint means a changed picture: look at it (`docs/gallery`)
//! before accepting the snapshot.

mod support;

use rinceau::params::Values;
use rinceau::{Deadline, GENERATORS};
use rinceau_format::{Artwork, Document, Recipe, Selection};

fn packed(bytes: Vec<u8>, params: &[(&str, &str)]) -> (Document, Artwork) {
    let generator = &GENERATORS[0];
    let document = Document::from_bytes(bytes).unwrap();
    let scene = document.scene(&Selection::default()).unwrap();
    let mut values = Values::default();
    params.iter().for_each(|(name, value)| values.set(generator.table, name, value).unwrap());
    let artwork = rinceau::generate(generator, &values, &scene, 1, &mut Deadline::new(None)).unwrap();
    let recipe = Recipe {
        generator: "pack".into(),
        params: values.recipe(generator.table),
        seed: 1,
        sources: scene.containers.iter().map(|container| container.source.id.clone()).collect(),
        label: "Ornament".into(),
    };
    (document.with_layer(&artwork, &recipe).unwrap(), artwork)
}

/// FNV-1a, 64 bits.
fn fingerprint(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, &b| (hash ^ u64::from(b)).wrapping_mul(0x100_0000_01b3))
}

#[test]
fn a_small_drawing_in_full() {
    let svg = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 120 60">
  <ellipse id="pond" class="rinceau-container" cx="60" cy="30" rx="55" ry="25"/>
  <circle id="stone" class="rinceau-fixed" cx="80" cy="30" r="6" fill="#777777"/>
  <g id="reed" class="rinceau-element"><path d="M0,0C20,-8 40,-8 50,0C40,8 20,8 0,0Z" fill="#2a6b4f" stroke="#103020" stroke-width="1"/>
    <path class="rinceau-spine" d="M0,0H50"/></g>
</svg>
"##;
    let (document, _) = packed(svg.as_bytes().to_vec(), &[("spacing", "14"), ("stretch", "1.2")]);
    insta::assert_snapshot!(document.text());
}

#[test]
fn every_sample() {
    let mut table = String::new();
    for path in support::samples() {
        let (document, artwork) = packed(std::fs::read(&path).unwrap(), &[]);
        let count = |name: &str| artwork.counts[name];
        table += &format!(
            "{:12} {:3} elements {:3} fillers, coverage {:.3}, {:016x}\n",
            path.file_stem().unwrap().to_string_lossy(),
            count("elements"),
            count("fillers"),
            count("coverage"),
            fingerprint(&document.to_bytes()),
        );
    }
    insta::assert_snapshot!(table);
}
