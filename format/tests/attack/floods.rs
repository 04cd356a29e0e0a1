//! Very many of something.

use crate::support::svg;
use crate::{code, read, thread_time};
use rinceau_format::{Document, Role, Selection};
use std::time::Duration;

#[test]
fn deep_nesting() {
    for close in ["", "</g>"] {
        let deep = "<g>".repeat(1_000_000) + &close.repeat(1_000_000);
        assert!(["too-deep", "too-many-nodes"].contains(&code(svg(&deep))));
    }
    // The deepest that is allowed is read, on a small stack.
    let levels = 998;
    let inner = "<path class='rinceau-guide' d='M0 0L1 1'/>";
    let nested = |tag: &str| {
        format!("{}{inner}{}", format!("<{tag}>").repeat(levels), format!("</{tag}>").repeat(levels))
    };
    for tag in ["g", "svg", "a", "switch"] {
        assert_eq!(read(svg(&nested(tag))).unwrap().guides.len(), 1, "{tag}");
    }
    assert_eq!(code(svg(&nested("g class='rinceau-fixed'"))), "broken-xml");
    let fixed = "<g class='rinceau-fixed'>".repeat(levels) + inner + &"</g>".repeat(levels);
    assert_eq!(code(svg(&fixed)), "read");
    let clones = "<g class='rinceau-clone'>".repeat(levels) + &"</g>".repeat(levels);
    assert_eq!(code(svg(&clones)), "read");
    let tacks = "<g class='rinceau-tack'>".repeat(levels) + &"</g>".repeat(levels);
    assert_eq!(code(svg(&tacks)), "nested-role");
}

#[test]
fn hidden_groups_in_hidden_groups() {
    let levels = 990;
    let body = "<g style='display:none'>".repeat(levels)
        + &"<path d='M0 0'/>".repeat(20_000)
        + &"</g>".repeat(levels);
    assert_eq!(code(svg(&format!("<g class='rinceau-fixed'>{body}</g>"))), "read");
}

#[test]
fn floods_of_attributes_and_namespaces() {
    let attributes = |n: usize| (0..n).map(|i| format!(" a{i}=''")).collect::<String>();
    assert_eq!(code(svg(&format!("<g{}/>", attributes(200_000)))), "too-many-attributes");
    assert_eq!(code(svg(&format!("<g{}/>", attributes(4_096)))), "read");
    assert_eq!(code(svg(&format!("<g{}/>", attributes(4_097)))), "too-many-attributes");
    assert_eq!(code(svg(&format!("<g{}/>", attributes(4_096)).repeat(100))), "too-many-attributes");
    let namespaces = |n: usize| (0..n).map(|i| format!(" xmlns:a{i}='u{i}'")).collect::<String>();
    assert_eq!(code(svg(&format!("<g{}/>", namespaces(60_000)))), "too-many-attributes");
    assert_eq!(code(svg(&format!("<g{}/>", namespaces(256)))), "read");
    assert_eq!(code(svg(&format!("<g{}/>", namespaces(257)))), "too-many-attributes");
    assert_eq!(code(svg(&format!("<g{}>", namespaces(200)).repeat(900))), "too-many-attributes");
    let signs = svg(&format!("<text>{}</text>", "=".repeat(20 << 20)));
    assert_eq!(code(signs), "too-many-nodes");
    assert_eq!(code(svg(&format!("<!--{}-->", "<".repeat(20 << 20)))), "too-many-nodes");
    assert_eq!(code(format!("<g{}", "a=".repeat(5_000_000))), "too-many-attributes");
    assert_eq!(code(format!("<{}", "a".repeat(5_000_000) + &"=".repeat(1000))), "broken-xml");
}

#[test]
fn floods_of_objects() {
    let role = "<path class='rinceau-guide' d='M0 0L1 1'/>";
    assert_eq!(read(svg(&role.repeat(20_000))).unwrap().guides.len(), 20_000);
    let levels = 500;
    let deep = "<g>".repeat(levels) + &role.repeat(2_000) + &"</g>".repeat(levels);
    assert_eq!(read(svg(&deep)).unwrap().guides.len(), 2_000);
    let value = "x".repeat(1 << 20);
    let inherited =
        format!("<g font-family='{value}' fill='{value}'>{}</g>", "<path d='M0 0L1 1'/>".repeat(10_000));
    assert_eq!(code(svg(&format!("<g class='rinceau-fixed'>{inherited}</g>"))), "read");
    assert_eq!(code(svg(&"<g/>".repeat(1_000_000))), "too-many-nodes");
    let comments = svg(&("<!---->".repeat(100_000) + "<g class='rinceau-fixed'/>"));
    assert_eq!(code(comments), "read");
}

#[test]
fn many_selected_ids() {
    let body: String = (0..10_000).map(|i| format!("<path id='p{i}' d='M0 0L1 1'/>")).collect();
    let document = Document::from_bytes(svg(&body).into()).unwrap();
    let start = thread_time();
    let ids: Vec<String> = (0..10_000).map(|i| format!("p{i}")).collect();
    assert_eq!(document.scene(&Selection { ids: ids.clone() }).unwrap().guides.len(), 10_000);
    let marked = document.with_role(&ids[..2_000], Some(Role::Stem)).unwrap();
    assert_eq!(marked.scene(&Selection::default()).unwrap().stems.len(), 2_000);
    let took = thread_time() - start;
    assert!(took < Duration::from_secs(1), "took {took:?}");
}
