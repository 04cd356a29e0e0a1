//! Diagrams told apart by colour, and drawings to hand on.

use rinceau_format::{Artwork, Document, FillRule, Group, Item, Part, Recipe, Role, Scene, Selection, Style};

fn open(text: &str) -> Document {
    Document::from_bytes(text.as_bytes().to_vec()).unwrap()
}

fn scene(document: &Document) -> Scene {
    document.scene(&Selection::default()).unwrap_or_else(|error| panic!("{error}\n{}", document.text()))
}

const DIAGRAM: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 400 300">
  <defs><marker id="m"><path d="M0,0L6,3L0,6Z" fill="#ff0000"/></marker></defs>
  <style>.flow { stroke: #e8141c; fill: none; marker-end: url(#m) }</style>
  <path id="shape" d="M0,0H300V200H0Z" fill="none" stroke="#101215"/>
  <g style="stroke:rgb(0,170,20)">
    <path id="vein" fill="none" d="M10,10L60,60"/>
    <circle id="eye" cx="90" cy="90" r="9" style="fill:#22b14c;stroke:none"/>
  </g>
  <path id="flow" class="flow" d="M0,100C100,60 200,140 300,100"/>
  <path id="back" class="flow" style="marker-end:none;marker-start:url(#m)" d="M0,150H300"/>
  <path id="plain" fill="none" stroke="#d01010" d="M0,180H300"/>
  <g id="drop">
    <path id="body" d="M320,0Q340,20 320,60Q300,20 320,0Z"/>
    <path id="axis" fill="none" stroke="red" d="M320,60V0"/>
  </g>
  <path id="note" fill="#3060c0" d="M350,200h20v20z"/>
  <path id="open" fill="none" stroke="black" d="M350,0L390,90"/>
</svg>"##;

#[test]
fn colours_become_roles() {
    let document = open(DIAGRAM);
    let (marked, notes) = document.with_roles_by_colour().unwrap();
    let scene = scene(&marked);
    let ids = |sources: Vec<&rinceau_format::Source>| -> Vec<String> {
        sources.into_iter().map(|source| source.id.clone()).collect()
    };
    assert_eq!(ids(scene.containers.iter().map(|one| &one.source).collect()), ["shape"]);
    assert_eq!(ids(scene.guides.iter().map(|one| &one.source).collect()), ["flow", "back", "plain"]);
    assert_eq!(ids(scene.fixed.iter().map(|one| &one.source).collect()), ["eye"]);
    assert_eq!(ids(scene.fixed_spines.iter().map(|one| &one.source).collect()), ["vein"]);
    assert_eq!(ids(scene.elements.iter().map(|one| &one.source).collect()), ["drop"]);
    let template = &scene.elements[0].template;
    assert_eq!(
        (template.parts.len(), template.spine),
        (1, Some(((320.0, 60.0).into(), (320.0, 0.0).into())))
    );
    assert_eq!(notes.len(), 3, "{notes:#?}");
    assert!(notes[0].contains("the arrow head of 'back' is at its start"), "{}", notes[0]);
    assert!(notes[1].contains("the red line 'plain' has no arrow head"), "{}", notes[1]);
    assert!(notes[2].contains("the black line 'open' is open"), "{}", notes[2]);
    // Looks do not change: clearing the roles gives the file back, but for the declaration.
    let all: Vec<String> =
        ["shape", "vein", "eye", "flow", "back", "plain", "drop", "axis"].map(String::from).into();
    let cleared = marked.with_role(&all, None).unwrap();
    assert_eq!(cleared.text().replace(" xmlns:rinceau=\"urn:rinceau:1\"", ""), DIAGRAM);
    // What has a role keeps it.
    assert_eq!(marked.with_roles_by_colour().unwrap_err().code(), "no-colours");
}

#[test]
fn a_scene_comes_back_from_its_diagram() {
    let (marked, _) = open(DIAGRAM).with_roles_by_colour().unwrap();
    let first = scene(&marked);
    let (diagram, lost) = Document::diagram(&first).unwrap();
    assert!(lost.is_empty(), "{lost:?}");
    assert!(!diagram.text().contains("rinceau-container") && !diagram.text().contains("rinceau:role"));
    let (marked, notes) = diagram.with_roles_by_colour().unwrap();
    assert!(notes.is_empty(), "{notes:?}");
    let second = scene(&marked);
    let paths = |scene: &Scene| {
        let guides = scene.guides.iter().chain(&scene.fixed_spines).map(|one| one.path.to_svg());
        let outlines = scene.containers.iter().flat_map(|one| &one.outlines).map(|one| one.path.to_svg());
        let fixed = scene.fixed.iter().flat_map(|one| &one.parts).map(|part| part.path.to_svg());
        let elements = scene
            .elements
            .iter()
            .map(|one| format!("{:?} {}", one.template.spine, one.template.parts[0].path.to_svg()));
        guides.chain(outlines).chain(fixed).chain(elements).collect::<Vec<String>>()
    };
    assert_eq!(paths(&first), paths(&second));
    let with_stem =
        open(r#"<svg xmlns="http://www.w3.org/2000/svg"><path class="rinceau-stem" d="M0,0H9"/></svg>"#);
    let (_, lost) = Document::diagram(&scene(&with_stem)).unwrap();
    assert_eq!(lost, ["1 stems have no colour in a diagram and are left out"]);
}

/// A drawing with marks and a result.
fn with_result() -> Document {
    let text = r##"<?xml version="1.0"?>
<svg xmlns="http://www.w3.org/2000/svg" xmlns:rinceau='urn:rinceau:1' xmlns:xlink="http://www.w3.org/1999/xlink" viewBox="0 0 100 100">
  <metadata><rinceau:rules name="x">element seed: point</rinceau:rules></metadata>
  <rect id="paper" class="bright" width="100" height="100" fill="#ffeedd"/>
  <g id="marks">
    <path id="shape" class="rinceau-container big" rinceau:role="container" rinceau:spacing="8" d="M0,0H50V50H0Z"/>
    <g id="leaf" class="rinceau-element"><path id="blade" d="M0,0L9,3L0,6Z" fill="url(#green)"/><path class="rinceau-spine" d="M0,3H9"/></g>
  </g>
  <linearGradient id="green"><stop stop-color="#0a0"/></linearGradient>
  <use id="copy" xlink:href="#blade" x="60" y="60"/>
</svg>
"##;
    let style = Style::filled("#aa3300");
    let part = |d: &str| Part {
        path: kurbo::BezPath::from_svg(d).unwrap(),
        transform: Default::default(),
        style: style.clone(),
    };
    let group = |name: &str, hidden: bool, d: &str| Group {
        name: name.into(),
        hidden,
        items: vec![Item::new("leaf", vec![part(d)])],
        ..Group::default()
    };
    let artwork = Artwork {
        groups: vec![group("elements", false, "M5,5L9,5L9,9Z"), group("spines", true, "M1,1L2,2")],
        decimals: 2,
        complete: true,
        ..Artwork::default()
    };
    let recipe = Recipe {
        generator: "pack".into(),
        params: serde_json::Map::new(),
        seed: 1,
        sources: vec!["shape".into()],
        with: vec![],
        label: "Ornament".into(),
    };
    open(text).with_layer(&artwork, &recipe).unwrap()
}

#[test]
fn the_artwork_alone_has_no_marks() {
    let clean = with_result().artwork_only().unwrap();
    let text = clean.text();
    assert!(!text.contains("rinceau"), "{text}");
    assert!(!text.contains("id=\"shape\"") && !text.contains("M1,1"), "{text}");
    // What is not marked stays, and what a clone refers to stays out of sight.
    assert!(text.contains("id=\"paper\" class=\"bright\"") && text.contains("M5,5"), "{text}");
    assert!(text.contains("<defs><g id=\"leaf\"><path id=\"blade\""), "{text}");
    // Nothing is left to be taken away.
    assert_eq!(clean.artwork_only().unwrap().text(), text);
    let twice = open(
        "<svg xmlns='http://www.w3.org/2000/svg' xmlns:a='urn:rinceau:1' xmlns:b=\"urn:rinceau:1\"><path b:spacing='3' d='M0,0'/></svg>",
    );
    assert_eq!(
        twice.artwork_only().unwrap().text(),
        "<svg xmlns='http://www.w3.org/2000/svg'><path d='M0,0'/></svg>"
    );
    // A value that looks like a declaration is none.
    let like = open(
        "<svg xmlns='http://www.w3.org/2000/svg' id = 'xmlns:p' xmlns:rinceau='urn:rinceau:1' class='xmlns:a=\"urn:rinceau:1\"'><path d='M0,0'/></svg>",
    );
    assert_eq!(
        like.artwork_only().unwrap().text(),
        "<svg xmlns='http://www.w3.org/2000/svg' id = 'xmlns:p' class='xmlns:a=\"urn:rinceau:1\"'><path d='M0,0'/></svg>"
    );
    let plain = open("<svg xmlns='http://www.w3.org/2000/svg'><!-- rinceau --><path d='M0,0'/></svg>");
    assert_eq!(plain.artwork_only().unwrap().text(), plain.text());
}

#[test]
fn flat_drawings_are_paths_in_units_of_the_page() {
    let (flat, notes) = with_result().flat().unwrap();
    let xml = roxmltree::Document::parse(flat.text()).unwrap();
    let names: Vec<&str> = xml
        .root_element()
        .children()
        .filter(|node| node.is_element())
        .map(|node| node.tag_name().name())
        .collect();
    assert_eq!(names, ["path"; 3]);
    let d: Vec<&str> = xml.descendants().filter_map(|node| node.attribute("d")).collect();
    assert_eq!(d, ["M0,0L100,0L100,100L0,100Z", "M60,60L69,63L60,66Z", "M5,5L9,5L9,9Z"]);
    assert_eq!(notes, ["1 shape loses its gradient or pattern: paths have none"]);
    assert_eq!(xml.root_element().attribute("viewBox"), Some("0 0 100 100"));
    let nested = open(
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9"><g transform="translate(1 2) scale(2)"><circle r="1" fill-rule="evenodd" stroke="red" stroke-width="0.5"/></g></svg>"#,
    );
    let (flat, notes) = nested.flat().unwrap();
    assert!(notes.is_empty() && flat.text().contains("stroke-width:1"), "{}", flat.text());
    let doubtful = open(
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9"><path id="bad" d="M0,0 L"/><svg width="3" height="3"><path id="wide" d="M0,0H9" stroke="red" transform="scale(1 3)"/></svg></svg>"#,
    );
    let (partial, lost) = doubtful.flat().unwrap();
    assert!(partial.text().contains("M0,0L9,0") && !partial.text().contains("bad"), "{}", partial.text());
    assert_eq!(lost.len(), 3, "{lost:?}");
    assert!(lost[0].starts_with("'bad' is left out: ") && lost[1].contains("1 nested pages"), "{lost:?}");
    let empty = open(r#"<svg xmlns="http://www.w3.org/2000/svg"/>"#);
    assert_eq!(empty.flat().unwrap().0.text(), empty.text());
    // As a whole it reads like a drawing, and its shapes are what they were.
    let marked = flat.with_role(&["node:1".to_owned()], Some(Role::Container)).unwrap();
    let outline = &scene(&marked).containers[0].outlines[0];
    assert_eq!(outline.rule, FillRule::EvenOdd);
    assert_eq!(kurbo::Shape::bounding_box(&outline.path), kurbo::Rect::new(-1.0, 0.0, 3.0, 4.0));
}

#[test]
fn a_check_finds_everything_at_once() {
    let document = open(concat!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:rinceau=\"urn:rinceau:1\" viewBox=\"0 0 9 9\">\n",
        "<path id=\"a\" class=\"rinceau-guide\" d=\"M0,0 L5,\"/>\n",
        "<path id=\"b\" rinceau:role=\"leader\" d=\"M0,0 L5,5\"/>\n",
        "<g class=\"rinceau-fixed\"><circle r=\"wide\"/><circle r=\"2\"/></g>\n",
        "<path id=\"c\" class=\"rinceau-container\" d=\"M0,0H5V5Z\"/>\n",
        "<g id=\"d\" class=\"rinceau-form\"><circle id=\"e\" r=\"5\"/><use href=\"#gone\"/></g>\n",
        "<path id=\"f\" class=\"rinceau-seed\"/>\n",
        "<g id=\"r\" rinceau:result=\"pack\" rinceau:params=\"[1]\"/>\n",
        "</svg>"
    ));
    let (scene, problems) = document.check().unwrap();
    let found: Vec<String> = problems
        .iter()
        .map(|problem| {
            let at = problem.error.position().map(|at| at.to_string()).unwrap_or_default();
            format!("{at} {} {}", problem.error.code(), problem.id.as_deref().unwrap_or("-"))
        })
        .collect();
    assert_eq!(
        found,
        [
            "2:1 broken-object a",
            "3:1 unknown-role b",
            "4:26 broken-object node:3/1",
            "6:54 missing-source node:5/2",
            "8:1 broken-recipe r",
            "7:1 doubtful f"
        ]
    );
    // What can be read is read.
    assert_eq!((scene.containers.len(), scene.fixed[0].parts.len(), scene.forms.len()), (1, 1, 1));
}
