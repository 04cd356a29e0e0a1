//! Namespaces, roles, selections and recipes that make little sense.

use crate::support::{artwork, recipe, svg};
use crate::{code, read};
use rinceau_format::{Document, Role, Selection};

#[test]
fn namespaces() {
    let bare = "<svg><path class='rinceau-guide' d='M0 0L1 1'/></svg>";
    assert_eq!(read(bare).unwrap().guides.len(), 1);
    let prefixed = "<s:svg xmlns:s='http://www.w3.org/2000/svg' xmlns:r='urn:rinceau:1'><s:path r:role='guide' d='M0 0L1 1'/></s:svg>";
    assert_eq!(read(prefixed).unwrap().guides.len(), 1);
    let stolen = svg("<path xmlns:rinceau='urn:other' id='p' rinceau:role='guide' d='M0 0L1 1'/>");
    assert_eq!(read(stolen.clone()).unwrap().guides.len(), 0);
    let document = Document::from_bytes(stolen.into()).unwrap();
    let error = document.with_role(&["p".into()], Some(Role::Guide)).unwrap_err();
    assert_eq!(error.code(), "prefix-taken");
    let at_root = "<svg xmlns:rinceau='urn:other'><path id='p' d='M0 0L1 1'/></svg>";
    let document = Document::from_bytes(at_root.into()).unwrap();
    let marked = document.with_role(&["p".into()], Some(Role::Guide)).unwrap();
    assert_eq!(marked.scene(&Selection::default()).unwrap().guides.len(), 1);
    // Attributes of other namespaces are not mistaken for SVG's.
    let foreign =
        svg("<rect class='rinceau-container' xmlns:o='urn:o' o:x='x' o:id='o' id='r' width='2' height='2'/>");
    assert_eq!(read(foreign).unwrap().containers[0].source.id, "r");
}

#[test]
fn roles_that_make_no_sense() {
    let with = |attributes: &str| {
        let path = format!("<path xmlns:rinceau='urn:rinceau:1' d='M0 0L1 1' {attributes}/>");
        read(svg(&path))
    };
    assert_eq!(with("rinceau:role='leader'").unwrap_err().code(), "unknown-role");
    assert_eq!(with("rinceau:role=''").unwrap_err().code(), "unknown-role");
    assert_eq!(with("rinceau:role='é\u{1F600}'").unwrap_err().code(), "unknown-role");
    let long = format!("rinceau:role='{}'", "x".repeat(1 << 20));
    assert!(with(&long).unwrap_err().to_string().len() < 1500);
    assert!(with("class='rinceau-nonsense rinceau- rinceau-é'").unwrap().guides.is_empty());
    let both = with("rinceau:role='guide' class='rinceau-stem rinceau-boundary'").unwrap();
    assert_eq!((both.guides.len(), both.stems.len(), both.warnings.len()), (1, 0, 1));
}

#[test]
fn nested_containers_and_selection() {
    let body = "<g id='outer' class='rinceau-container'><rect width='9' height='9'/><rect id='inner' class='rinceau-container' width='2' height='2'/></g>";
    let document = Document::from_bytes(svg(body).into()).unwrap();
    let ids = |selected: &[&str]| {
        let ids = selected.iter().map(|&id| id.to_owned()).collect();
        let scene = document.scene(&Selection { ids }).unwrap();
        scene.containers.into_iter().map(|c| c.source.id).collect::<Vec<_>>()
    };
    assert_eq!(ids(&[]), ["inner", "outer"]);
    assert_eq!(ids(&["outer"]), ["outer"]);
    assert_eq!(ids(&["inner"]), ["inner"]);
}

#[test]
fn objects_without_an_id_are_found_by_their_reference() {
    let body = "<!-- c --><g/>text<g><path d='M0 0L1 1'/><path d='M0 0h1v1z' class='rinceau-container'/></g>";
    let document = Document::from_bytes(svg(body).into()).unwrap();
    let scene = document.scene(&Selection::default()).unwrap();
    assert_eq!(scene.containers[0].source.id, "node:2/2");
    let scene = document.scene(&Selection { ids: vec!["node:2/1".into()] }).unwrap();
    assert_eq!(scene.guides.len(), 1);
    for id in ["node:", "node:0", "node:9", "node:2/2/1", "node:-1", "node:x", ""] {
        let error = document.scene(&Selection { ids: vec![id.into()] }).unwrap_err();
        assert_eq!(error.code(), "unknown-id", "{id}");
    }
}

#[test]
fn broken_recipes() {
    let with = |attributes: &str| {
        code(svg(&format!("<g xmlns:rinceau='urn:rinceau:1' rinceau:result='pack' {attributes}/>")))
    };
    assert_eq!(with(""), "read");
    for params in ["[]", "1", "null", "{", "", "{\"a\":1e999}", "\u{1F600}"] {
        assert_eq!(with(&format!("rinceau:params='{params}'")), "broken-recipe", "{params}");
    }
    let nested = "[".repeat(1_000_000);
    assert_eq!(with(&format!("rinceau:params='{{\"a\":{nested}'")), "broken-recipe");
    let large: String = (0..500_000).map(|i| format!("\"p{i}\":[{i}],")).collect();
    assert_eq!(with(&format!("rinceau:params='{{{large}\"a\":1}}'")), "read");
    for seed in ["-1", "1.5", "99999999999999999999", "é", ""] {
        assert_eq!(with(&format!("rinceau:seed='{seed}'")), "broken-recipe", "{seed}");
    }
    let inner = "<g rinceau:result='pack'><g rinceau:result='pack' rinceau:seed='x'/></g>";
    let nested = svg(&format!("<g xmlns:rinceau='urn:rinceau:1' class='rinceau-container'>{inner}</g>"));
    let document = Document::from_bytes(nested.into()).unwrap();
    assert_eq!(document.layers().unwrap().len(), 1);
}

#[test]
fn control_characters_in_ids_are_escaped_in_messages() {
    let body = "<path id='a\u{9b}31m\u{202e}b' class='rinceau-spine' d='M1 1'/>";
    let message = read(svg(body)).unwrap_err().to_string();
    assert!(message.contains("\\u{9b}") && message.contains("\\u{202e}"), "{message}");
    let id = "a b\t%20é\u{202e}'\"&<>";
    let document = Document::from_bytes(svg("").into()).unwrap();
    let layered = document.with_layer(&artwork(1), &recipe(&[id])).unwrap();
    assert_eq!(layered.layers().unwrap()[0].recipe.sources.len(), 1);
}
