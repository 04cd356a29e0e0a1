//! The guide in `docs`: it builds (into `target/guide`), every page is in its contents, every link leads
//! somewhere, and what it calls menus and controls is what they are called.

use mdbook_driver::MDBook;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().join("docs")
}

/// Pages by name, with their text.
fn pages() -> Vec<(String, String)> {
    let mut pages: Vec<_> = fs::read_dir(docs())
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "md"))
        .map(|path| {
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            (name, fs::read_to_string(path).unwrap())
        })
        .collect();
    pages.sort();
    pages
}

/// Targets of the links and pictures of a page.
fn targets(text: &str) -> impl Iterator<Item = &str> {
    text.split("](").skip(1).filter_map(|rest| rest.split(')').next())
}

#[test]
fn builds() {
    MDBook::load(docs()).unwrap().build().unwrap();
    let out = docs().parent().unwrap().join("target/guide");
    for (name, text) in pages().iter().filter(|(name, _)| name != "SUMMARY.md") {
        let html = fs::read_to_string(out.join(name.replace(".md", ".html"))).unwrap();
        for target in targets(text).filter(|target| target.starts_with("pictures/")) {
            assert!(html.contains(target) && out.join(target).is_file(), "{name} lacks {target}");
        }
    }
    assert!(out.join("index.html").is_file());
}

#[test]
fn every_page_is_in_the_contents_and_every_link_leads_somewhere() {
    let pages = pages();
    let (_, contents) = pages.iter().find(|(name, _)| name == "SUMMARY.md").unwrap();
    let listed: BTreeSet<&str> = targets(contents).collect();
    let there: BTreeSet<&str> =
        pages.iter().map(|(name, _)| &name[..]).filter(|name| *name != "SUMMARY.md").collect();
    assert_eq!(listed, there);
    for (name, text) in &pages {
        for target in targets(text).filter(|target| !target.contains("://")) {
            let file = target.split('#').next().unwrap();
            assert!(file.is_empty() || docs().join(file).is_file(), "{name} leads to {target}");
        }
    }
}

/// Words in italics that name a control are those of the dialogs, and menu entries those of the menu.
#[test]
fn controls_and_menus_are_called_what_they_are() {
    let folder = docs().parent().unwrap().join("plugin-inkscape/inx");
    let dialogs: String = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "inx"))
        .map(|path| fs::read_to_string(path).unwrap())
        .collect();
    // Not of ours: a page of the dialogs, a value with its control, and Inkscape's own.
    let others =
        ["More", "User extensions", "Draw: only the last", "Join lines: into one line", "Elements: auto"];
    for (name, text) in pages().iter().filter(|(name, _)| name != "rules.md") {
        let words = text.split('\n').flat_map(|line| line.split("**").step_by(2)).collect::<Vec<_>>();
        for control in words.iter().flat_map(|text| text.split('*').skip(1).step_by(2)) {
            let is_named = dialogs.contains(&format!("gui-text=\"{control}:\""))
                || dialogs.contains(&format!("gui-text=\"{control}\""));
            assert!(is_named || others.contains(&control), "{name} names a control '{control}'");
        }
    }
    for entry in [
        "Pack along flow",
        "Grow vines",
        "Grow by rules",
        "Repeat a form",
        "Continue an example",
        "Show connectivity",
        "Update all",
        "Take out explored form",
        "Check document",
        "Diagnostics",
    ] {
        assert!(dialogs.contains(&format!("<name>{entry}</name>")), "{entry}");
    }
}
