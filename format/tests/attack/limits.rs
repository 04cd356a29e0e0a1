//! Each published limit just below, at and just beyond it. The limits are lowered, so that no
//! test has to make a drawing of 256 MiB.

use crate::read_within;
use crate::support::svg;
use rinceau_format::Limits;
use std::time::Duration;

/// What reading gives for limit - 1, limit and limit + 1 of something.
fn around(limit: usize, lowered: &Limits, text: impl Fn(usize) -> String) -> [&'static str; 3] {
    [limit - 1, limit, limit + 1].map(|n| {
        let result = read_within(text(n).into(), lowered.clone(), Duration::from_secs(2));
        result.map_or_else(|error| error.code(), |_| "read")
    })
}

#[test]
fn size() {
    let frame = svg("").len();
    let limits = Limits { bytes: frame + 10, ..Limits::default() };
    assert_eq!(around(10, &limits, |n| svg(&" ".repeat(n))), ["read", "read", "too-large"]);
    let limits = Limits { style_sheet: 10, ..Limits::default() };
    let style = |n: usize| svg(&format!("<style>{}</style>", "a".repeat(n)));
    assert_eq!(around(10, &limits, style), ["read", "read", "style-too-large"]);
}

#[test]
fn objects() {
    // The root is two tags and one level.
    let limits = Limits { nodes: 102, ..Limits::default() };
    assert_eq!(around(100, &limits, |n| svg(&"<g/>".repeat(n))), ["read", "read", "too-many-nodes"]);
    let limits = Limits { depth: 11, ..Limits::default() };
    let nested = |n: usize| svg(&("<g>".repeat(n) + &"</g>".repeat(n)));
    assert_eq!(around(10, &limits, nested), ["read", "read", "too-deep"]);
    let limits = Limits { attributes: 10, namespaces: 10, ..Limits::default() };
    let many = |name: &str, n: usize| {
        let list: String = (0..n).map(|i| format!(" {name}{i}='u'")).collect();
        svg(&format!("<g{list}/>"))
    };
    assert_eq!(around(10, &limits, |n| many("a", n)), ["read", "read", "too-many-attributes"]);
    assert_eq!(around(10, &limits, |n| many("xmlns:a", n)), ["read", "read", "too-many-attributes"]);
}

#[test]
fn entities() {
    let limits = Limits { expansion: 1000, ..Limits::default() };
    let expanding =
        |n: usize| format!("<!DOCTYPE svg [<!ENTITY e '{}'>]>{}", "x".repeat(n), svg("<g id='&e;'/>"));
    assert_eq!(around(1000, &limits, expanding), ["read", "read", "entity-expansion"]);
}

#[test]
fn clones() {
    let drawing = |n: usize| {
        let uses = "<use href='#a'/>".repeat(n);
        svg(&format!("<defs><path id='a' d='M0 0L1 1'/></defs><g class='rinceau-fixed'>{uses}</g>"))
    };
    let limits = Limits { instances: 10, ..Limits::default() };
    assert_eq!(around(10, &limits, drawing), ["read", "read", "too-many-clones"]);
    let limits = Limits { instance_nodes: 10, ..Limits::default() };
    assert_eq!(around(10, &limits, drawing), ["read", "read", "too-many-clones"]);
    let limits = Limits { instance_bytes: 10 * "<path id='a' d='M0 0L1 1'/>".len(), ..Limits::default() };
    assert_eq!(around(10, &limits, drawing), ["read", "read", "too-many-clones"]);
}

#[test]
fn coordinates() {
    let limits = Limits { coordinate: 1e4, ..Limits::default() };
    let line = |n: usize| svg(&format!("<path class='rinceau-guide' d='M0 0L{n} 0'/>"));
    assert_eq!(around(10_000, &limits, line), ["read", "read", "coordinate-range"]);
}
