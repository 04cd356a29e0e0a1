//! Any drawing as a diagram, checked, cleaned and flattened: no panic, and results are drawings.

#![no_main]

use libfuzzer_sys::fuzz_target;
use rinceau_format::{Document, Limits};

fuzz_target!(|bytes: &[u8]| {
    let limits = Limits { bytes: 1 << 18, instances: 1_000, texts: 1, ..Limits::default() };
    let Ok(document) = Document::with_limits(bytes.to_vec(), limits) else { return };
    let _ = document.with_roles_by_colour();
    if let Ok(clean) = document.artwork_only() {
        let _ = clean.artwork_only().map(|again| assert_eq!(again.text(), clean.text()));
    }
    let _ = document.flat();
    if let Ok((scene, _)) = document.check() {
        let _ = rinceau::faults(&scene);
    }
});
