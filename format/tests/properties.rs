//! Properties of random small drawings.

mod support;

use kurbo::{ParamCurve, Rect, Shape};
use proptest::prelude::*;
use rinceau_format::{Document, Role, Selection};
use std::collections::BTreeMap;
use support::{artwork, recipe};

// Random drawings. `@` in an attribute stands for the object's number, set once the whole is
// put together; so fragments can be combined and shrunk freely.

fn number() -> impl Strategy<Value = String> {
    let unit = prop::sample::select(vec!["", "", "", "px", "mm", "pt", "%", "em"]);
    (1..400_i32, unit).prop_map(|(tenths, unit)| match unit {
        "mm" | "pt" | "em" => format!("{}{unit}", f64::from(tenths) / 40.0),
        unit => format!("{}{unit}", f64::from(tenths) / 10.0),
    })
}

fn transform() -> impl Strategy<Value = String> {
    let n = || (-300..300_i32).prop_map(|tenths| f64::from(tenths) / 10.0);
    prop_oneof![
        Just(String::new()),
        (n(), n()).prop_map(|(x, y)| format!(" transform='translate({x},{y})'")),
        (n(), n()).prop_map(|(a, x)| format!(" transform=\"rotate({a} {x} 5)\"")),
        (1..30_i32, 1..30_i32).prop_map(|(x, y)| format!(
            "\ttransform='scale({} {})'",
            f64::from(x) / 10.0,
            f64::from(y) / -10.0
        )),
        (n(), n()).prop_map(|(a, x)| format!("\n transform='skewX({a}) translate({x})'")),
        n().prop_map(|x| format!(" transform='matrix(1 .5 -.25 1 {x} 2)'")),
    ]
}

fn class() -> impl Strategy<Value = String> {
    prop::sample::select(vec![
        "",
        " class='st0'",
        " class=\"a > b\"",
        " class=' rinceau-guide  x '",
        " class='rinceau-nothing'",
        " rinceau:role='fixed'",
        " rinceau:role = \"container\" class='rinceau-guide'",
        " data-x='&lt;svg&gt;'",
        " data-x=\">\"",
    ])
    .prop_map(str::to_owned)
}

fn shape() -> impl Strategy<Value = String> {
    let n = number;
    let body = prop_oneof![
        (n(), n(), n(), n()).prop_map(|(x, y, w, h)| format!("rect x='{x}' y='{y}' width='{w}' height='{h}'")),
        (n(), n(), n()).prop_map(|(w, h, r)| format!("rect width='{w}' height='{h}' rx='{r}'")),
        (n(), n(), n()).prop_map(|(x, y, r)| format!("circle cx='{x}' cy='{y}' r='{r}'")),
        (n(), n(), n()).prop_map(|(x, a, b)| format!("ellipse cx='{x}' rx='{a}' ry='{b}'")),
        (n(), n(), n()).prop_map(|(x, y, z)| format!("line x1='{x}' y1='{y}' x2='{z}' stroke='red'")),
        (1..99, 1..99, 1..99).prop_map(|(x, y, z)| format!("polygon points='{x},{y} {y} {z},{z},{x}'")),
        (1..99, 1..99, 1..99, any::<bool>(), any::<bool>()).prop_map(|(x, y, z, large, sweep)| {
            let (large, sweep) = (u8::from(large), u8::from(sweep));
            format!("path d='M{x} {y}A{z} {x} {y} {large} {sweep} {z} {x}q1-9 {y}.5 4t3 3v-{z}h3c1 1 9 {y} 4,4s5 5-{x} {z}z'")
        }),
    ];
    (
        body,
        transform(),
        class(),
        prop::sample::select(vec!["/>", " />", "></X>", ">\r\n<title>t</title></X>"]),
    )
        .prop_map(|(body, transform, class, end)| {
            let tag = body.split(' ').next().unwrap_or("").to_owned();
            format!("<{body} id=\"@\"{transform}{class}{}", end.replace('X', &tag))
        })
}

fn fragment() -> impl Strategy<Value = String> {
    let leaf = prop_oneof![
        8 => shape(),
        1 => Just("<!-- </svg> <g> -->".to_owned()),
        1 => Just("<![CDATA[</svg>]]>".to_owned()),
        1 => Just("\r\n \t".to_owned()),
        1 => Just("<?pi </svg>?>".to_owned()),
    ];
    leaf.prop_recursive(4, 24, 4, |inner| {
        let several = prop::collection::vec(inner, 0..4).prop_map(|parts| parts.concat());
        prop_oneof![
            (several.clone(), transform(), class())
                .prop_map(|(inner, transform, class)| format!("<g id='@'{transform}{class}>{inner}</g>")),
            (several.clone(), number(), number()).prop_map(|(inner, w, h)| format!(
                "<svg id='@' x='{w}' width='{w}' height='{h}' viewBox='1 2 30 20' preserveAspectRatio='xMinYMax slice' overflow='visible'>{inner}</svg>"
            )),
            // The transform stands around, and there are no percentages: usvg applies the first
            // twice, and takes the others of the clone's size instead of the symbol's view box.
            (several.clone(), number(), transform()).prop_map(|(inner, n, transform)| format!(
                "<symbol id='s@' viewBox='0 0 40 30' overflow='visible'>{inner}</symbol><g{transform}><use id='@' href='#s@' x='{n}' width='{n}' height='30'/></g>"
            ).replace('%', "")),
            (several, number(), transform()).prop_map(|(inner, n, transform)| format!(
                "<defs><g id='d@'{transform}>{inner}</g></defs><use\nid='@' xlink:href=\"#d@\" y='{n}'{transform}/>"
            )),
        ]
    })
}

fn drawing() -> impl Strategy<Value = String> {
    let before = prop::sample::select(vec![
        "",
        "<?xml version='1.0'?>\r\n",
        "\u{feff}",
        "<!-- <svg> --><?p?>\n",
        "<!DOCTYPE svg PUBLIC \"-//W3C//DTD SVG 1.1//EN\" \"x\" [<!ENTITY e '</svg>'><!-- ]> -->]>\n",
    ]);
    let after = prop::sample::select(vec!["", "\n", "\r\n", "<!-- </svg> -->", "<?p </svg>?>\n\n", "  "]);
    let content = prop::collection::vec(fragment(), 0..4).prop_map(|parts| parts.concat());
    let root_end = prop::sample::select(vec!["</svg>", "\n</svg >", " </svg\r\n>"]);
    (before, content, root_end, after, any::<bool>()).prop_map(|(before, content, root_end, after, empty)| {
        let root = "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' xmlns:rinceau='urn:rinceau:1' width='200' height='100' viewBox='0 0 200 100' font-size='16'";
        let content = numbered(&content);
        if empty { format!("{before}{root} />{after}") } else { format!("{before}{root}>{content}{root_end}{after}") }
    })
}

/// `@` replaced by the number of the object. A clone and its source are written together, so
/// that `s@` and `#s@` are the same number apart from the order of nesting: they are counted
/// by a stack of what is still open.
fn numbered(content: &str) -> String {
    let mut out = String::new();
    let (mut next, mut pending) = (0, BTreeMap::<char, Vec<usize>>::new());
    let mut rest = content;
    while let Some(at) = rest.find('@') {
        let kind = rest[..at].chars().next_back().unwrap_or(' ');
        let is_reference = rest[..at].ends_with("#s") || rest[..at].ends_with("#d");
        let number = match kind {
            's' | 'd' if is_reference => pending.entry(kind).or_default().pop().unwrap_or(0),
            's' | 'd' => {
                next += 1;
                pending.entry(kind).or_default().push(next);
                next
            }
            _ => {
                next += 1;
                next
            }
        };
        out.push_str(&rest[..at]);
        out.push_str(&number.to_string());
        rest = &rest[at + 1..];
    }
    out + rest
}

fn open(text: &str) -> Document {
    Document::from_bytes(text.as_bytes().to_vec()).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn parse(text: &str) -> roxmltree::Document<'_> {
    let options = roxmltree::ParsingOptions { allow_dtd: true, ..roxmltree::ParsingOptions::default() };
    roxmltree::Document::parse_with_options(text, options).unwrap()
}

/// Ids of the drawn objects that have an outline or hold some.
fn ids(text: &str) -> Vec<String> {
    let xml = parse(text.trim_start_matches('\u{feff}'));
    let in_definition =
        |node: &roxmltree::Node| node.ancestors().any(|a| matches!(a.tag_name().name(), "defs" | "symbol"));
    let nodes = xml.root_element().descendants().skip(1).filter(|node| !in_definition(node));
    nodes.filter_map(|node| node.attribute("id").map(str::to_owned)).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 192, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_layer_leaves_as_it_came(text in drawing(), leaves in 0..260_usize) {
        let document = open(&text);
        let once = document.with_layer(&artwork(leaves), &recipe(&["a b", "c"])).unwrap();
        prop_assert_eq!(once.layers().unwrap().len(), 1);
        prop_assert_eq!(once.without_layers().unwrap().to_bytes(), document.to_bytes());
        let twice = once.with_layer(&artwork(leaves), &recipe(&["a b", "c"])).unwrap();
        prop_assert_eq!(twice.text(), once.text());
        let other = once.with_layer(&artwork(2), &recipe(&["d"])).unwrap();
        prop_assert_eq!(other.layers().unwrap().len(), 2);
        prop_assert_eq!(other.without_layers().unwrap().to_bytes(), text.as_bytes());
        let smaller = other.with_layer(&artwork(1), &recipe(&["a b", "c"])).unwrap();
        let restored = smaller.with_layer(&artwork(leaves), &recipe(&["a b", "c"])).unwrap();
        prop_assert_eq!(restored.text(), other.text());
    }

    #[test]
    fn a_role_leaves_nothing_behind(text in drawing(), role in prop::sample::select(Role::ALL.to_vec())) {
        let document = open(&text);
        let ids = ids(&text);
        let marked = document.with_role(&ids, Some(role)).unwrap();
        let cleared = marked.with_role(&ids, None).unwrap();
        let xml = parse(cleared.text());
        for node in xml.descendants().filter(|node| node.attribute("id").is_some_and(|id| ids.iter().any(|i| i == id))) {
            prop_assert!(!node.has_attribute(("urn:rinceau:1", "role")), "{:?}", node);
            let class = node.attribute("class").unwrap_or("");
            prop_assert!(Role::ALL.iter().all(|role| !class.split_whitespace().any(|token| token == role.class())));
            prop_assert_eq!(node.attribute("class").is_some_and(|class| class.trim().is_empty()), false);
        }
        // Where nothing was marked before, clearing gives everything back but the declaration.
        let is_plain = !text.contains("role=") && !text.contains("class=");
        if is_plain {
            // White space at the end of a tag apart.
            let undeclared = |text: &str| {
                let text = text.replacen(" xmlns:rinceau=\"urn:rinceau:1\"", "", 1).replace("/>", ">");
                let pieces: Vec<&str> = text.split('>').map(str::trim_end).collect();
                pieces.join(">")
            };
            prop_assert_eq!(undeclared(cleared.text()), undeclared(text.trim_start_matches('\u{feff}')));
        }
        prop_assert_eq!(marked.with_role(&ids, Some(role)).unwrap().to_bytes(), marked.to_bytes());
        prop_assert_eq!(cleared.with_role(&ids, None).unwrap().to_bytes(), cleared.to_bytes());
    }

    #[test]
    fn geometry_agrees_with_usvg(text in drawing()) {
        let plain = without_roles(&text);
        compare_with_usvg(&plain)?;
    }
}

/// The drawing without roles: they decide what is read, not where it is.
fn without_roles(text: &str) -> String {
    text.replace("rinceau:role", "data-role").replace("rinceau-", "other-")
}

/// Compares what both keep; how many that was.
fn compare_with_usvg(text: &str) -> Result<usize, TestCaseError> {
    let document = open(text);
    let theirs = usvg_boxes(text.trim_start_matches('\u{feff}').to_owned());
    let mut compared = 0;
    for id in ids(text) {
        let scene = document.scene(&Selection { ids: vec![id.clone()] }).unwrap();
        let outlines = scene.containers.iter().flat_map(|c| c.outlines.iter().map(|o| &o.path));
        let paths = outlines.chain(scene.guides.iter().map(|guide| &guide.path));
        let paths = paths.filter(|path| path.segments().any(|s| s.start() != s.end()));
        let ours = paths.map(|path| path.bounding_box()).reduce(|a, b| a.union(b));
        let (Some(ours), Some(theirs)) = (ours, theirs.get(&id)) else { continue };
        let tolerance = 1e-3 * ours.size().max_side().max(ours.center().to_vec2().hypot()).max(1.0);
        let off = [ours.x0 - theirs.x0, ours.y0 - theirs.y0, ours.x1 - theirs.x1, ours.y1 - theirs.y1];
        prop_assert!(off.iter().all(|d| d.abs() < tolerance), "{id}: {ours:?} {theirs:?}\n{text}");
        compared += 1;
    }
    Ok(compared)
}

/// Boxes of everything usvg keeps an id of.
fn usvg_boxes(text: String) -> BTreeMap<String, Rect> {
    let collect = move || {
        let mut boxes: BTreeMap<String, Rect> = BTreeMap::new();
        let Ok(tree) = usvg::Tree::from_str(&text, &usvg::Options::default()) else { return boxes };
        // Each group with the ids around it: usvg gives an empty group a box at the origin, so
        // the box of a group is made of the paths in it.
        let mut groups = vec![(tree.root(), Vec::new())];
        while let Some((group, around)) = groups.pop() {
            for child in group.children() {
                let mut ids = around.clone();
                ids.push(child.id().to_owned());
                if let usvg::Node::Group(group) = child {
                    groups.push((group, ids));
                    continue;
                }
                let b = child.abs_bounding_box();
                let [x0, y0, x1, y1] = [b.left(), b.top(), b.right(), b.bottom()].map(f64::from);
                let own = Rect::new(x0, y0, x1, y1);
                for id in ids {
                    boxes.entry(id).and_modify(|all| *all = all.union(own)).or_insert(own);
                }
            }
        }
        boxes
    };
    std::thread::Builder::new().stack_size(64 << 20).spawn(collect).unwrap().join().unwrap()
}

#[test]
fn the_oracle_sees_something() {
    let text = "<svg xmlns='http://www.w3.org/2000/svg' width='200' height='100' viewBox='0 0 200 100' font-size='16'>
        <g transform='rotate(30)'><circle id='1' cx='9mm' cy='10%' r='4'/><g id='2' transform='scale(2)'>
        <path id='3' d='M1 1A5 9 20 1 0 30 10Z'/></g></g>
        <symbol id='s' viewBox='0 0 4 3'><rect width='1' height='2'/></symbol><use id='4' href='#s' width='50'/></svg>";
    assert!(compare_with_usvg(text).unwrap() >= 3);
}
