//! `rinceau update`: ornaments follow the shapes that they fill.

mod support;

use kurbo::{Affine, BezPath, PathEl, Point, Shape};
use support::{INKSCAPE, RINCEAU, by_id, layers, parse, rinceau, svg};

const SHAPES: &str = "<rect id=\"panel\" x=\"10\" y=\"10\" width=\"90\" height=\"60\"/>\n<path id=\"way\" d=\"M15,60 L95,20\" fill=\"none\"/>\n<g id=\"tree\"><path id=\"trunk\" d=\"M150,190 V150\" stroke=\"#000000\"/><use href=\"#trunk\" transform=\"translate(150 150) rotate(30) scale(.7) translate(-150 -190)\"/></g>";

fn run(arguments: &[&str], input: &str) -> String {
    rinceau(arguments).input(input).succeed().text().to_owned()
}

/// A vine over a shape with a line as its stem, dots of its own seed, and a form.
fn ornamented() -> String {
    let vine = run(&["vine", "--id", "panel", "--id", "way", "--levels", "2", "--seed", "5"], &svg(SHAPES));
    run(&["recurse", "--id", "tree", "--depth", "4"], &vine)
}

fn changed(text: &str, from: &str, to: &str) -> String {
    assert_eq!(text.matches(from).count(), 1, "{from}");
    text.replace(from, to)
}

#[test]
fn changes_nothing_where_nothing_was_changed() {
    let once = ornamented();
    assert!(run(&["update"], &once) == once);
}

/// As if the generators had been run on the changed shapes, with the same lines, seeds and
/// parameters.
#[test]
fn follows_changed_shapes() {
    let reshaped = |text: &str| {
        let wider = changed(text, "width=\"90\"", "width=\"120\"");
        changed(&changed(&wider, "M15,60 L95,20", "M15,20 L125,60"), "M150,190 V150", "M150,190 V140")
    };
    let updated = run(&["update"], &reshaped(&ornamented()));
    let before = reshaped(&svg(SHAPES));
    let vine = run(&["vine", "--id", "panel", "--id", "way", "--levels", "2", "--seed", "5"], &before);
    assert!(updated == run(&["recurse", "--id", "tree", "--depth", "4"], &vine));
}

/// A record that does not fit its layer is none: nothing is kept twice, and no two objects have one id.
#[test]
fn takes_a_record_of_something_else_for_none() {
    let text = ornamented();
    let start = text.find("rinceau:pieces=\"").unwrap() + "rinceau:pieces=\"".len();
    let end = start + text[start..].find('"').unwrap();
    let broken = format!("{}ffffffffffff 1 2 3{}", &text[..start], &text[end..]);
    assert!(run(&["update"], &broken) == text);
}

/// What an artist set on a layer stays.
#[test]
fn keeps_the_layer() {
    let renamed = ornamented().replacen(
        "inkscape:label=\"Ornament - panel\"",
        "inkscape:label=\"My vine\" style=\"opacity:0.5\"",
        1,
    );
    let updated = run(&["update"], &changed(&renamed, "width=\"90\"", "width=\"80\""));
    let xml = parse(&updated);
    let [vine, form] = layers(&xml)[..] else { panic!("{} layers", layers(&xml).len()) };
    assert_eq!(vine.attribute((INKSCAPE, "label")), Some("My vine"));
    assert_eq!(vine.attribute("style"), Some("opacity:0.5"));
    assert_eq!(vine.attribute((RINCEAU, "with")), Some("way"));
    assert_eq!(form.attribute((RINCEAU, "with")), None);
    assert_eq!(by_id(&xml, "panel").attribute("width"), Some("80"));
}

/// A layer whose shape is gone, or that another version made, stays as it is; the others follow.
#[test]
fn leaves_what_it_cannot_make_again() {
    let gone = changed(&ornamented(), "<g id=\"tree\">", "<g id=\"other\">");
    let done = rinceau(["update"]).input(changed(&gone, "width=\"90\"", "width=\"80\"")).succeed();
    insta::assert_snapshot!(done.stderr.trim_end(), @"rinceau: note: the layer 'Ornament - tree' stays as it is: No object has the id 'tree'. Check the id in Object > Object Properties. [unknown-id]");
    let xml = parse(done.text());
    let [_, form] = layers(&xml)[..] else { panic!("{} layers", layers(&xml).len()) };
    let old = parse(&gone);
    assert_eq!(&done.text()[form.range()], &gone[layers(&old)[1].range()]);
    let foreign = gone.replace("rinceau:result=\"vine\"", "rinceau:result=\"weave\"");
    let refused = rinceau(["update"]).input(foreign).done();
    assert!(refused.code == Some(1) && refused.stdout.is_empty());
    insta::assert_snapshot!(refused.stderr.trim_end(), @"rinceau: This version has no generator 'weave'. Update the layer with the version that made it, or delete it. [unknown-generator]");
    let bare = rinceau(["update"]).input(svg(SHAPES)).done();
    assert!(bare.code == Some(1) && bare.stdout.is_empty());
    insta::assert_snapshot!(bare.stderr.trim_end(), @"rinceau: The drawing has no ornament that could be made again. Run one of the generators first. [nothing-to-update]");
}

/// Generators, what they are given, and a change of the shape that they fill.
const KEPT: [(&str, &[&str], (&str, &str)); 5] = [
    ("pack", &["--id", "pond"], ("H 260", "H 230")),
    ("vine", &["--id", "pond"], ("H 260", "H 230")),
    ("grow", &["--id", "pond", "--rules", "dots"], ("H 260", "H 230")),
    ("arrange", &["--id", "pond"], ("H 260", "H 230")),
    ("recurse", &["--id", "tree", "--depth", "5"], ("V150", "V145")),
];

fn drawing() -> String {
    let dots: String = (0..25)
        .map(|i| {
            let (x, y) = (300 + 12 * (i % 5), 20 + 12 * (i / 5));
            format!("<circle cx=\"{x}\" cy=\"{y}\" r=\"4\"/>")
        })
        .collect();
    svg(&format!(
        "<path id=\"pond\" d=\"M20,20 H 260 V140 H20 Z\" fill=\"#eeeeee\"/>\n<g id=\"example\" class=\"rinceau-reference\">{dots}</g>\n<g id=\"tree\"><path id=\"trunk\" d=\"M150,190 V150\" stroke=\"#000000\"/><use href=\"#trunk\" transform=\"translate(150 150) rotate(30) scale(.7) translate(-150 -190)\"/><use href=\"#trunk\" transform=\"translate(150 150) rotate(-40) scale(.6) translate(-150 -190)\"/></g>"
    ))
}

/// Ids of the pieces of a drawing's first layer, those of its first sublayer with some.
fn pieces(text: &str) -> Vec<String> {
    let xml = parse(text);
    let layer = layers(&xml)[0];
    let of = |node: roxmltree::Node| -> Vec<String> {
        let all = node.descendants().filter(|node| node.has_attribute((RINCEAU, "of")));
        all.map(|node| node.attribute("id").unwrap().to_owned()).collect()
    };
    layer.children().map(of).find(|ids| ids.len() > 3).unwrap()
}

/// The start tag of the object with an id.
fn tag(text: &str, id: &str) -> String {
    let xml = parse(text);
    let node = by_id(&xml, id);
    let element = &text[node.range()];
    element[..element.find('>').unwrap()].trim_end_matches('/').to_owned()
}

/// What an artist can do to a piece: (paint it, take it away, move it, lock it), and draw something.
fn edited(text: &str, painted: &str, gone: &str, moved: &str, locked: &str) -> String {
    let set = |text: String, id: &str, name: &str, value: &str| {
        let old = tag(&text, id);
        let new = match old.find(&format!(" {name}=\"")) {
            Some(at) => {
                let start = at + name.len() + 3;
                let end = start + old[start..].find('"').unwrap();
                format!("{}{value}{}", &old[..start], &old[end..])
            }
            None => format!("{old} {name}=\"{value}\""),
        };
        text.replace(&old, &new)
    };
    let text = set(text.to_owned(), painted, "style", "fill:#ff0000;stroke:#00ff00");
    let text = set(text, moved, "transform", "translate(3 5)");
    let text = set(text, locked, "sodipodi:insensitive", "true");
    let range = {
        let xml = parse(&text);
        by_id(&xml, gone).range()
    };
    let start = text[..range.start].trim_end_matches('\n').len();
    let text = format!("{}{}", &text[..start], &text[range.end..]);
    // The last line of the layer is its record, so what is drawn goes before it.
    let record = text.find("\n<metadata").unwrap();
    format!("{}\n<path id=\"mine\" d=\"M1,1H5\"/>{}", &text[..record], &text[record..])
}

/// Everything that an artist did to pieces is there after an update, byte for byte, in every generator.
#[test]
fn keeps_what_was_done_to_pieces() {
    for (name, arguments, _) in KEPT {
        let mut all = vec![name];
        all.extend(arguments);
        let made = run(&all, &drawing());
        let ids = pieces(&made);
        let mine = edited(&made, &ids[0], &ids[1], &ids[2], &ids[3]);
        let updated = run(&["update"], &mine);
        let lines = |text: &str| text.lines().map(str::to_owned).collect::<std::collections::BTreeSet<_>>();
        let (before, after) = (lines(&mine), lines(&updated));
        let differing: Vec<&String> = before.symmetric_difference(&after).collect();
        assert!(differing.is_empty(), "{name}: {differing:.300?}");
        assert!(run(&["update"], &updated) == updated, "{name}");
    }
}

/// The same where the shape changes: pieces that were moved and locked stand where they stood, the
/// colour is there, as many as were deleted are missing, and all ids are there once.
#[test]
fn keeps_what_was_done_to_pieces_in_other_shapes() {
    for (name, arguments, (from, to)) in KEPT {
        let mut all = vec![name];
        all.extend(arguments);
        let made = run(&all, &drawing());
        let ids = pieces(&made);
        let mine = edited(&made, &ids[0], &ids[1], &ids[2], &ids[3]);
        let updated = run(&["update"], &changed(&mine, from, to));
        assert!(updated != mine, "{name}");
        let tags = |id: &str| (tag(&mine, id), tag(&updated, id));
        for kept in [&ids[2], &ids[3], "mine"] {
            let (before, after) = tags(kept);
            assert_eq!(before, after, "{name}");
        }
        assert!(tag(&updated, &ids[0]).contains("fill:#ff0000;stroke:#00ff00"), "{name}");
        let xml = parse(&updated);
        let found = |id: &str| xml.descendants().filter(|node| node.attribute("id") == Some(id)).count();
        assert_eq!(found(&ids[1]), 0, "{name}");
        let mut all: Vec<&str> = xml.descendants().filter_map(|node| node.attribute("id")).collect();
        let count = all.len();
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), count, "{name}");
        assert!(run(&["update"], &updated) == updated, "{name}");
    }
}

/// New pieces keep clear of one that was moved into their midst.
#[test]
fn keeps_clear_of_what_was_moved() {
    let made = run(&["pack", "--id", "pond"], &drawing());
    let ids = pieces(&made);
    let old = tag(&made, &ids[2]);
    let moved = made.replace(&old, &format!("{old} transform=\"translate(40 30)\""));
    let updated = run(&["update"], &changed(&moved, "H 260", "H 230"));
    assert_eq!(tag(&updated, &ids[2]), tag(&moved, &ids[2]));
    assert!(!updated.contains("-fixed\""), "it is no fixed object of the result");
    let (_, scene) = support::geometry::read(updated.into_bytes());
    assert_eq!(scene.fixed.len(), 0);
}

/// Sublayers that were hidden, locked or deleted stay so; a group of pieces stays a group.
#[test]
fn keeps_sublayers_and_groups() {
    let made = run(&["pack", "--id", "pond"], &drawing());
    let xml = parse(&made);
    let layer = layers(&xml)[0].attribute("id").unwrap();
    let (fillers, spines) = (format!("{layer}-fillers"), format!("{layer}-spines"));
    let shown =
        made.replace("style=\"display:none\"", "style=\"display:inline\" sodipodi:insensitive=\"true\"");
    let range = by_id(&xml, &fillers).range();
    let cut = shown.replace(&made[range], "");
    let ids = pieces(&made);
    let pair = by_id(&xml, &ids[4]).range().start..by_id(&xml, &ids[5]).range().end;
    let pair = &made[pair];
    let mine = cut.replace(pair, &format!("<g id=\"pair\" transform=\"scale(1.01)\">{pair}</g>"));
    let updated = run(&["update"], &changed(&mine, "H 260", "H 230"));
    let xml = parse(&updated);
    assert!(tag(&updated, &spines).contains("display:inline\" sodipodi:insensitive=\"true\""));
    assert!(!xml.descendants().any(|node| node.attribute("id") == Some(&fillers)));
    assert!(updated.contains(&format!("<g id=\"pair\" transform=\"scale(1.01)\">{pair}</g>")));
    assert!(run(&["update"], &updated) == updated);
}

/// Whoever moves the whole ornament has moved no piece of it; whoever empties the layer wants it new.
#[test]
fn tells_a_moved_ornament_from_moved_pieces() {
    let made = run(&["pack", "--id", "pond"], &drawing());
    let mut moved = made.clone();
    for id in pieces(&made) {
        let old = tag(&moved, &id);
        moved = moved.replace(&old, &format!("{old} transform=\"translate(2 0)\""));
    }
    assert!(run(&["update"], &moved) == made);
    let xml = parse(&made);
    let layer = layers(&xml)[0].attribute("id").unwrap();
    let range = by_id(&xml, &format!("{layer}-elements")).range();
    let others = ["fillers", "spines"].map(|name| by_id(&xml, &format!("{layer}-{name}")).range());
    let mut emptied = made.clone();
    for range in [others[1].clone(), others[0].clone(), range] {
        emptied.replace_range(range, "");
    }
    let tag = |text: &str| text.matches("rinceau:of").count();
    assert_eq!(tag(&run(&["update"], &emptied)), tag(&made));
}

/// What can be seen through a piece that the artist moved is no room for fillers.
#[test]
fn leaves_the_holes_of_a_moved_piece_empty() {
    let sun = svg("<circle id=\"sun\" cx=\"100\" cy=\"100\" r=\"90\"/>");
    let flags = ["pack", "--id", "sun", "--elements", "pea-pod", "--spacing", "45", "--min-gap", "1"];
    let packed = run(&flags, &sun);
    let id = "id=\"ornament-sun-elements-8\"";
    let moved = changed(&packed, id, &format!("{id} transform=\"translate(2 3)\""));
    let again = run(&[&flags[..], &["--seed", "2"]].concat(), &moved);
    let xml = parse(&again);
    let piece =
        xml.descendants().find(|node| node.attribute("id") == Some("ornament-sun-elements-8")).unwrap();
    assert_eq!(piece.attribute("transform"), Some("translate(2 3)"), "it stays where it is");
    let outlines: Vec<BezPath> = piece
        .descendants()
        .filter_map(|node| node.attribute("d"))
        .map(|data| Affine::translate((2.0, 3.0)) * BezPath::from_svg(data).unwrap())
        .collect();
    let holes: usize = outlines.iter().map(|path| subpaths(path).len() - 1).sum();
    assert!(holes > 1, "{holes}");
    let inside = |at: Point| outlines.iter().flat_map(subpaths).any(|subpath| subpath.winding(at) != 0);
    let is_filler = |node: &roxmltree::Node| {
        node.attribute("id").is_some_and(|id| id.starts_with("ornament-sun-fillers-"))
    };
    let fillers: Vec<Point> = xml
        .descendants()
        .filter(is_filler)
        .filter_map(|node| node.attribute("d"))
        .flat_map(|data| subpaths(&BezPath::from_svg(data).unwrap()))
        .map(|dot| dot.bounding_box().center())
        .collect();
    assert!(fillers.len() > 5, "{}", fillers.len());
    assert!(!fillers.into_iter().any(inside));
}

fn subpaths(path: &BezPath) -> Vec<BezPath> {
    let mut all: Vec<BezPath> = Vec::new();
    for &el in path.elements() {
        if matches!(el, PathEl::MoveTo(_)) {
            all.push(BezPath::new());
        }
        all.last_mut().unwrap().push(el);
    }
    all
}
