//! Any text as a grammar of Context Free: no panic, always an end.

#![no_main]

use libfuzzer_sys::fuzz_target;
use rinceau_format::{Document, Scene};

fuzz_target!(|text: &str| {
    let Ok((scene, _)) = Scene::from_cfdg(text) else { return };
    let (grammar, _) = scene.to_cfdg();
    let _ = Scene::from_cfdg(&grammar);
    let _ = Document::from_scene(&scene);
});
