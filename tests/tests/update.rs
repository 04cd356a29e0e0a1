//! `rinceau update`: ornaments follow the shapes that they fill.

mod support;

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
