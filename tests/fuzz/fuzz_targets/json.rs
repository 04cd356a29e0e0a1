//! Any text as a scene: no panic, and what is read comes back the same.

#![no_main]

use libfuzzer_sys::fuzz_target;
use rinceau_format::{Document, Scene, Selection};

fuzz_target!(|text: &str| {
    let Ok(scene) = Scene::from_json(text) else { return };
    let json = scene.to_json();
    let again = Scene::from_json(&json).expect("what was written is read");
    assert_eq!(again.to_json(), json);
    let _ = scene.to_cfdg();
    let _ = Document::diagram(&scene);
    if let Ok(document) = Document::from_scene(&scene) {
        let _ = document.scene(&Selection::default());
    }
});
