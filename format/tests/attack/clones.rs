//! Trees, chains and cycles of clones and of every other kind of link.

use crate::support::svg;
use crate::{code, read_within};
use rinceau_format::Limits;
use std::fmt::Write;
use std::time::Duration;

fn in_fixed(body: &str) -> String {
    svg(&format!("{body}<use class='rinceau-fixed' href='#a0'/>"))
}

#[test]
fn trees_of_clones() {
    let level = |tag: &str, i: usize| {
        let use_next = format!("<use href='#a{}'/>", i + 1);
        format!("<{tag} id='a{i}'>{use_next}{use_next}</{tag}>")
    };
    for tag in ["g", "symbol", "svg"] {
        let tree: String = (0..30).map(|i| level(tag, i)).collect();
        let body = format!("<defs>{tree}<rect id='a30' width='1' height='1'/></defs>");
        assert_eq!(code(in_fixed(&body)), "too-many-clones", "{tag}");
    }
    let wide = format!("<g id='a0'>{}</g>", "<path d='M0 0'/>".repeat(20_000));
    let body =
        format!("<defs>{wide}</defs><g class='rinceau-fixed'>{}</g>", "<use href='#a0'/>".repeat(1_000));
    assert_eq!(code(svg(&body)), "too-many-clones");
    let long = format!("<path id='a0' d='M0 0{}L1 1'/>", " ".repeat(1 << 20));
    let body =
        format!("<defs>{long}</defs><g class='rinceau-fixed'>{}</g>", "<use href='#a0'/>".repeat(1_000));
    assert_eq!(code(svg(&body)), "too-many-clones");
}

#[test]
fn trees_of_other_links() {
    let links = [
        ("pattern", "fill"),
        ("mask", "mask"),
        ("marker", "marker-end"),
        ("clipPath", "clip-path"),
        ("filter", "filter"),
        ("linearGradient", "fill"),
    ];
    for (tag, property) in links {
        let mut body = String::from("<defs>");
        for i in 0..30 {
            let next = format!("<path d='M0 0L1 1' {property}='url(#a{})'/>", i + 1);
            let _ = write!(body, "<{tag} id='a{i}' href='#a{}'>{next}{next}</{tag}>", i + 1);
        }
        let _ = write!(body, "<{tag} id='a30' {property}='url(#a0)' href='#a0'/></defs>");
        let _ = write!(body, "<path class='rinceau-fixed' d='M0 0L1 1' {property}='url(#a0)'/>");
        assert_eq!(code(svg(&body)), "read", "{tag}");
        assert_eq!(code(in_fixed(&body)), "read", "{tag}");
    }
}

#[test]
fn chains_of_clones() {
    let uses: String = (0..90_000).map(|i| format!("<use id='a{i}' href='#a{}'/>", i + 1)).collect();
    assert_eq!(code(in_fixed(&format!("<defs>{uses}<path id='a90000' d='M0 0L1 1'/></defs>"))), "read");
    let uses: String = (0..100_001).map(|i| format!("<use id='a{i}' href='#a{}'/>", i + 1)).collect();
    assert_eq!(code(in_fixed(&format!("<defs>{uses}</defs>"))), "too-many-clones");
}

#[test]
fn cycles_of_clones() {
    let cycles = [
        "<use id='a0' href='#a0'/>",
        "<g id='a0'><use href='#a0'/></g>",
        "<symbol id='a0'><use href='#a0'/></symbol>",
        "<svg id='a0'><use href='#a0'/></svg>",
        "<use id='a0' href='#b'/><use id='b' href='#a0'/>",
        "<g id='a0'><use href='#b'/></g><g id='b'><g><use href='#a0'/></g></g>",
        "<g id='a0'><g display='none'><use href='#b'/></g><use id='b' href='#a0'/></g>",
    ];
    for body in cycles {
        assert_eq!(code(in_fixed(body)), "clone-cycle", "{body}");
        assert_eq!(code(svg(body)), "read", "{body}");
    }
    assert_eq!(code(svg("<g id='x' class='rinceau-container'><use href='#x'/></g>")), "clone-cycle");
    assert_eq!(code(svg("<text id='t' class='rinceau-container'><tspan href='#t'/></text>")), "read");
}

#[test]
fn floods_of_missing_clones_and_texts() {
    let missing = "<use href='#none'/>".repeat(50_000);
    assert_eq!(code(svg(&format!("<g class='rinceau-fixed'>{missing}</g>"))), "read");
    let text = format!("<text>{}</text>", "a".repeat(1 << 20));
    assert_eq!(code(svg(&format!("<g class='rinceau-fixed'>{text}</g>"))), "text-without-outline");
    let spans = format!("<text>{}x{}</text>", "<tspan>".repeat(500), "</tspan>".repeat(500));
    assert_eq!(code(svg(&format!("<g class='rinceau-fixed'>{spans}</g>"))), "text-without-outline");
    let limits = Limits { texts: 2, ..Limits::default() };
    let three = svg(&format!("<g class='rinceau-fixed'>{}</g>", "<text>a</text>".repeat(3)));
    let error = read_within(three.into(), limits, Duration::from_secs(9)).unwrap_err();
    assert_eq!(error.code(), "text-without-outline");
}
