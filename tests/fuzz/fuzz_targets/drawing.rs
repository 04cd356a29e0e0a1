//! Any bytes: no panic, always an end, no byte lost.

#![no_main]

use libfuzzer_sys::fuzz_target;
use rinceau_format::{Document, Limits, Selection};

/// Small limits, so that a run spends its time on new inputs and not on large ones.
fn limits() -> Limits {
    Limits { bytes: 1 << 20, instances: 1_000, texts: 1, ..Limits::default() }
}

fuzz_target!(|bytes: &[u8]| {
    let Ok(document) = Document::with_limits(bytes.to_vec(), limits()) else { return };
    if !bytes.starts_with(&[0x1f, 0x8b]) {
        assert_eq!(document.to_bytes(), bytes);
    }
    let _ = document.scene(&Selection::default());
    let _ = document.layers();
    if let Ok(without) = document.without_layers() {
        assert!(Document::with_limits(without.to_bytes(), limits()).is_ok());
    }
});
