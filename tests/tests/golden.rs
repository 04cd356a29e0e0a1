//! Golden files: a small drawing in full, and every sample by its counts and a fingerprint of
//! its bytes. A changed fingerprint means a changed picture: look at it (`docs/gallery`)
//! before accepting the snapshot.

mod support;

use rinceau_format::{Artwork, Document};
use support::geometry::{generated, read, samples_of, written};

fn drawn(name: &str, bytes: Vec<u8>, params: &[(&str, &str)]) -> (Document, Artwork) {
    let params: Vec<(&str, String)> = params.iter().map(|&(name, value)| (name, value.to_owned())).collect();
    let (document, scene) = read(bytes);
    let artwork = generated(name, &scene, &params, 1).unwrap();
    (written(&document, &artwork, (name, &params, 1)), artwork)
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
    let (document, _) = drawn("pack", svg.as_bytes().to_vec(), &[("spacing", "14"), ("stretch", "1.2")]);
    insta::assert_snapshot!(document.text());
}

#[test]
fn every_sample() {
    let mut table = String::new();
    for path in support::samples() {
        let (document, artwork) = drawn("pack", std::fs::read(&path).unwrap(), &[]);
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

#[test]
fn a_small_vine_in_full() {
    let svg = r##"<svg xmlns="http://www.w3.org/2000/svg" xmlns:rinceau="urn:rinceau:1" viewBox="0 0 120 60">
  <rect id="panel" class="rinceau-container" x="2" y="2" width="116" height="56"/>
  <circle id="stone" class="rinceau-fixed" cx="96" cy="18" r="6" fill="#777777"/>
  <path id="main" class="rinceau-stem" d="M8,50 L40,24 L76,40 L112,44" fill="none"/>
  <g id="blade" class="rinceau-element" rinceau:kind="blade"><path d="M0,0C6,-4 12,-4 20,0C12,4 6,4 0,0Z" fill="#2a6b4f"/>
    <path class="rinceau-spine" d="M0,0H20"/></g>
</svg>
"##;
    let params = [("levels", "2"), ("forks", "blade"), ("tips", "ball"), ("stem-width", "2")];
    let (document, _) = drawn("vine", svg.as_bytes().to_vec(), &params);
    insta::assert_snapshot!(document.text());
}

#[test]
fn every_vine() {
    let mut table = String::new();
    for path in samples_of("vine") {
        let (document, artwork) = drawn("vine", std::fs::read(&path).unwrap(), &[]);
        let count = |name: &str| artwork.counts[name];
        table += &format!(
            "{:20} {:4} stems {:4} elements {:3} crossings, {:016x}\n",
            path.file_stem().unwrap().to_string_lossy(),
            count("stems"),
            count("elements"),
            count("crossings"),
            fingerprint(&document.to_bytes()),
        );
    }
    insta::assert_snapshot!(table);
}

#[test]
fn a_small_form_in_full() {
    let svg = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 120 60">
  <g id="tree" class="rinceau-form"><path id="trunk" d="M60,58V38" style="fill:none;stroke:#24452f;stroke-width:4"/>
    <use href="#trunk" transform="translate(60 38) rotate(-40) scale(.7) translate(-60 -58)"/>
    <use href="#trunk" transform="translate(60 38) rotate(40) scale(.7) translate(-60 -58)"/>
    <circle id="bud" cx="60" cy="38" r="3" fill="#d2913a"/></g>
</svg>
"##;
    for output in ["paths", "clones"] {
        let (document, _) = drawn("recurse", svg.as_bytes().to_vec(), &[("depth", "3"), ("output", output)]);
        insta::assert_snapshot!(format!("a_small_form_as_{output}"), document.text());
    }
}

#[test]
fn every_form() {
    let mut table = String::new();
    for path in samples_of("recurse") {
        let (document, artwork) = drawn("recurse", std::fs::read(&path).unwrap(), &[]);
        let count = |name: &str| artwork.counts[name];
        table += &format!(
            "{:22} {:6} shapes in {:6} copies, {:016x}\n",
            path.file_stem().unwrap().to_string_lossy(),
            count("elements"),
            count("copies"),
            fingerprint(&document.to_bytes()),
        );
        assert!(
            artwork.complete && artwork.warnings.is_empty(),
            "{}: {:?}",
            path.display(),
            artwork.warnings
        );
    }
    insta::assert_snapshot!(table);
}

#[test]
fn every_arrangement() {
    let mut table = String::new();
    for path in samples_of("arrange") {
        let (document, artwork) = drawn("arrange", std::fs::read(&path).unwrap(), &[]);
        let count = |name: &str| artwork.counts[name];
        table += &format!(
            "{:16} {:5} elements of {:5} grown, rings differ by {:.3}, {:016x}\n",
            path.file_stem().unwrap().to_string_lossy(),
            count("elements"),
            count("grown"),
            count("residual"),
            fingerprint(&document.to_bytes()),
        );
    }
    insta::assert_snapshot!(table);
}

#[test]
fn a_small_growth_in_full() {
    let svg = r##"<svg xmlns="http://www.w3.org/2000/svg" xmlns:rinceau="urn:rinceau:1" viewBox="0 0 120 60">
  <metadata><rinceau:rules name="chain">
element seed: point
element link: circle, order = 0
element tie: linesegment
let links = 0;
rule seed -> link first { parent.sterile = true; first.set(parent, 3); }
rule link -> tie bar, link next {
    if goal.radius &lt; 4.0 || links == 8 { return FAILURE; }
    links += 1;
    next.order = links;
    let far = min(distance(parent, goal), 12);
    next.set(parent.center.offset(goal.center - parent.center, far), 2.5);
    bar.set(parent, next);
}
look tie: art outline, width 0.8
look link: art outline, by order
</rinceau:rules></metadata>
  <rect id="panel" class="rinceau-container" x="2" y="2" width="116" height="56"/>
  <circle id="stone" class="rinceau-fixed" cx="96" cy="18" r="6" fill="#777777"/>
</svg>
"##;
    let (document, _) = drawn("grow", svg.as_bytes().to_vec(), &[]);
    insta::assert_snapshot!(document.text());
}

#[test]
fn every_growth() {
    let mut table = String::new();
    for path in samples_of("grow") {
        let (document, artwork) = drawn("grow", std::fs::read(&path).unwrap(), &[]);
        let count = |name: &str| artwork.counts[name];
        table += &format!(
            "{:20} {:5} elements in {:5} steps, {:5} in vain, {:016x}\n",
            path.file_stem().unwrap().to_string_lossy(),
            count("elements"),
            count("steps"),
            count("failed"),
            fingerprint(&document.to_bytes()),
        );
        assert!(
            artwork.complete && artwork.warnings.is_empty(),
            "{}: {:?}",
            path.display(),
            artwork.warnings
        );
    }
    insta::assert_snapshot!(table);
}
