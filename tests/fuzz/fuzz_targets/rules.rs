//! Any text as growth rules: no panic, always an end.

#![no_main]

use libfuzzer_sys::fuzz_target;
use rinceau::grow::{RuleText, check_rules};

fuzz_target!(|text: &str| {
    let _ = check_rules(RuleText { name: "any".into(), text: text.into() });
});
