//! The reference pages in `docs`, made from the parameter tables and kept current by a test.

use crate::args::help;
use rinceau::params::{Page, ParamSpec};
use rinceau::{GENERATORS, Generator};
use std::fmt::Write;

fn page(generator: &Generator) -> String {
    let mut out = format!("# rinceau {}\n\n{}.\n\n", generator.name, generator.about);
    out += "Lengths are in user units of the drawing, or with a unit (`mm cm in pt px`) in real size on paper.\n";
    out += "A container may set any of these for itself, as an attribute `rinceau:` and the name.\n\n";
    out += "This page is generated from the parameter table; edit that.\n";
    for (page, title) in [(Page::Basic, "Basic"), (Page::More, "More"), (Page::Curves, "Curves")] {
        if generator.table.iter().all(|spec| spec.page != page) {
            continue;
        }
        let _ = write!(out, "\n## {title}\n\n");
        for spec in generator.table.iter().filter(|spec| spec.page == page) {
            parameter(&mut out, spec);
        }
    }
    out + "\n## Every run\n\n\
        - `--id ID`: use this object, marked or not; may be given several times.\n\
        - `--seed N`: another number, another composition. [default: 1]\n\
        - `--time-limit SECONDS`: stop after this long and write the best so far.\n\
        - `--report FILE`: counts, coverage, warnings and timings as JSON.\n"
}

fn parameter(out: &mut String, spec: &ParamSpec) {
    let _ = writeln!(out, "- `--{}` ({}): {}", spec.name, spec.label, help(spec));
}

#[test]
fn reference_pages_are_current() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs");
    for generator in GENERATORS {
        let path = folder.join(format!("{}.md", generator.name));
        if std::env::var_os("RINCEAU_BLESS").is_some() {
            std::fs::write(&path, page(generator)).unwrap();
        }
        let committed = std::fs::read_to_string(&path).unwrap_or_default();
        assert_eq!(committed, page(generator), "stale: run the tests with RINCEAU_BLESS=1");
    }
}
