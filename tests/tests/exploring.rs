//! What an explorer of recursive forms has beside the generator: tacks, and the map of explored
//! forms. Both touch nothing but what they are meant to.

mod support;

use kurbo::{Affine, Point};
use rinceau_format::{Document, FormItem, Scene, Selection};
use roxmltree::Node;
use support::{RINCEAU, by_id, parse, rinceau, svg};

fn scene_of(text: &str) -> Scene {
    Document::from_bytes(text.as_bytes().to_vec()).unwrap().scene(&Selection::default()).unwrap()
}

/// A group that is moved and turned, with a square, a clone of it, two tacks and a guide.
fn drawing() -> String {
    svg(r##"<g transform="translate(20 10) rotate(15) scale(2)">
<g id="form" class="rinceau-form"><rect id="square" width="10" height="10" fill="teal"/>
<use id="copy" x="3" href="#square" transform="translate(12 0)" class="rinceau-clone"/></g>
</g>
<circle id="t1" class="rinceau-tack" cx="60" cy="80" r="2"/><circle id="t2" class="rinceau-tack" cx="120" cy="60" r="2"/>
<path id="way" class="rinceau-guide" d="M70,30 L90,45"/>"##)
}

/// From the square to its clone, in user units of the root.
fn replication(text: &str) -> Affine {
    let scene = scene_of(text);
    let clone = scene.forms[0].items.iter().find_map(|item| match item {
        FormItem::Clone(clone) => Some(clone.transform),
        FormItem::Primitive(_) => None,
    });
    clone.expect("a clone")
}

fn tack(text: &str, operation: &str, ids: &[&str]) -> String {
    let ids = ids.iter().flat_map(|id| ["--id", id]);
    rinceau(["tack", operation].into_iter().chain(ids)).input(text).succeed().text().to_owned()
}

/// The text with the value of one `transform` cut out.
fn without_transform(text: &str, id: &str) -> (String, String) {
    let xml = parse(text);
    let node: Node = by_id(&xml, id);
    let attribute = node.attributes().find(|a| a.name() == "transform").expect("a transform");
    let range = attribute.range_value();
    (text[..range.start].to_owned(), text[range.end..].to_owned())
}

fn assert_maps(map: Affine, from: (f64, f64), to: (f64, f64)) {
    let (p, q) = (map * Point::from(from), Point::from(to));
    assert!(p.distance(q) < 1e-5, "{p:?} is not {q:?}");
}

mod tacks {
    use super::*;

    /// By how much a command moved the clone, in user units of the root.
    fn moved_by(operation: &str, ids: &[&str]) -> Affine {
        let before = drawing();
        let after = tack(&before, operation, ids);
        assert_eq!(
            without_transform(&before, "copy"),
            without_transform(&after, "copy"),
            "something else changed"
        );
        replication(&after) * replication(&before).inverse()
    }

    #[test]
    fn hold_while_a_guide_drags() {
        // The guide drags 70,30 to 90,45.
        assert_maps(moved_by("drag", &["copy", "t1", "way"]), (70.0, 30.0), (90.0, 45.0));
        assert_maps(moved_by("drag", &["copy", "t1", "way"]), (60.0, 80.0), (60.0, 80.0));
        let by_two = moved_by("drag", &["copy"]);
        for (from, to) in
            [((70.0, 30.0), (90.0, 45.0)), ((60.0, 80.0), (60.0, 80.0)), ((120.0, 60.0), (120.0, 60.0))]
        {
            assert_maps(by_two, from, to);
        }
    }

    #[test]
    fn are_kept_as_a_pair_by_mirrors_and_half_turn() {
        let (a, b) = ((60.0, 80.0), (120.0, 60.0));
        for (operation, det, swaps) in
            [("mirror", -1.0, false), ("mirror-across", -1.0, true), ("half-turn", 1.0, true)]
        {
            let map = moved_by(operation, &["copy"]);
            assert_maps(map, a, if swaps { b } else { a });
            assert_maps(map, b, if swaps { a } else { b });
            assert!((map.determinant() - det).abs() < 1e-5, "{operation}");
        }
    }

    #[test]
    fn the_identity_lays_a_clone_on_its_source() {
        let after = tack(&drawing(), "identity", &["copy"]);
        let map = replication(&after);
        assert!(
            map.as_coeffs().iter().zip(Affine::IDENTITY.as_coeffs()).all(|(a, b)| (a - b).abs() < 1e-6),
            "{map:?}"
        );
    }

    #[test]
    fn without_any_the_guide_only_moves() {
        let plain = drawing().replace("rinceau-tack", "dot");
        let after = tack(&plain, "drag", &["copy"]);
        let map = replication(&after) * replication(&plain).inverse();
        assert_maps(map, (0.0, 0.0), (20.0, 15.0));
        assert_maps(map, (50.0, 7.0), (70.0, 22.0));
    }

    #[test]
    fn an_object_about_an_origin_of_its_own_moves_as_one_without() {
        let plain = svg(
            "<rect id='a' transform='rotate(30)' transform-origin='20 20' width='9' height='9'/><path class='rinceau-guide' d='M0,0 L10,5'/>",
        );
        let after = tack(&plain, "drag", &["a"]);
        let outline = |text: &str| {
            let marked = text.replace("id='a'", "id='a' class='rinceau-container'");
            scene_of(&marked).containers[0].outlines[0].path.clone()
        };
        let expected = Affine::translate((10.0, 5.0)) * outline(&plain);
        let corners = |path: &kurbo::BezPath| -> Vec<Point> {
            path.elements().iter().filter_map(|el| el.end_point()).collect()
        };
        for (p, q) in corners(&outline(&after)).into_iter().zip(corners(&expected)) {
            assert!(p.distance(q) < 1e-5);
        }
    }

    /// Its own coordinates are not the root's.
    #[test]
    fn move_what_lies_in_a_drawing_within_the_drawing() {
        let marks = "<circle class='rinceau-tack' cx='20' cy='150' r='1'/><circle class='rinceau-tack' cx='60' cy='150' r='1'/>";
        let inner = "<svg x='3' y='4' width='50' height='50' viewBox='0 0 10 10'><rect id='a' width='5' height='5'/></svg>";
        let after = tack(&svg(&format!("{inner}{marks}")), "half-turn", &["a"]);
        assert_eq!(by_id(&parse(&after), "a").attribute("transform"), Some("matrix(-1 0 0 -1 14.8 58.4)"));
    }

    /// The clone follows its source already: it is moved once, not twice.
    #[test]
    fn move_a_clone_with_its_source() {
        let before = drawing().replace("<rect id=\"square\"", "<rect id=\"square\" transform=\"rotate(9)\"");
        let after = tack(&before, "mirror", &["square", "copy"]);
        let base = |text: &str| match &scene_of(text).forms[0].items[0] {
            FormItem::Primitive(drawn) => drawn.part.transform,
            FormItem::Clone(_) => panic!("the square comes first"),
        };
        let by = base(&after) * base(&before).inverse();
        assert_maps(by, (60.0, 80.0), (60.0, 80.0));
        assert!((by.determinant() + 1.0).abs() < 1e-5);
        let drawn = |text: &str| replication(text) * base(text);
        let expected = by * drawn(&before);
        assert!(
            drawn(&after).as_coeffs().iter().zip(expected.as_coeffs()).all(|(a, b)| (a - b).abs() < 1e-5)
        );
    }

    /// `transform-origin` in a style, and of one value.
    #[test]
    fn know_where_an_origin_is() {
        let moved = |origin: &str| {
            let text = svg(&format!(
                "<rect id='a' transform='rotate(90)' {origin} width='9' height='9'/><path class='rinceau-guide' d='M0,0 L10,0'/>"
            ));
            by_id(&parse(&tack(&text, "drag", &["a"])), "a").attribute("transform").unwrap().to_owned()
        };
        // About 100,100: the attribute itself stays a turn and a shift.
        for origin in
            ["transform-origin='center'", "style='transform-origin:50% 50%'", "transform-origin='100'"]
        {
            assert_eq!(moved(origin), "matrix(0 1 -1 0 10 0)", "{origin}");
        }
    }

    #[test]
    fn that_say_nothing_are_refused() {
        let refusal = |text: &str, operation: &str, ids: &[&str]| {
            let ids = ids.iter().flat_map(|id| ["--id", id]);
            let done = rinceau(["tack", operation].into_iter().chain(ids)).input(text).done();
            assert!(done.code == Some(1) && done.stdout.is_empty());
            done.stderr.trim_end().to_owned()
        };
        insta::assert_snapshot!(refusal(&drawing(), "mirror", &["copy", "t1"]), @"rinceau: This needs two tacks, and there is one. Mark two points as tacks (Extensions > Ornament > Mark as), or select the two that are meant. [tacks]");
        insta::assert_snapshot!(refusal(&drawing(), "mirror", &["t1"]), @"rinceau: Nothing is selected that could be moved. Select objects, and with them the tacks and the guide that are meant. [nothing-selected]");
        insta::assert_snapshot!(refusal(&drawing().replace("rinceau-guide", "line"), "drag", &["copy"]), @"rinceau: A drag needs one guide, and there is none. Mark one line as guide, from the point that is dragged to where it goes, or select the one that is meant. [drag-guide]");
        insta::assert_snapshot!(refusal(&drawing().replace("M70,30 L90,45", "M60,80 L90,70"), "drag", &["copy"]), @"rinceau: The tacks and the ends of the guide are too close to each other to say how to move. Move them apart: two tacks from each other, the guide's ends from the tacks and from their line. [tacks]");
        insta::assert_snapshot!(refusal(&drawing(), "identity", &["square"]), @"rinceau: 3:35: 'square' is no clone of anything in this drawing. Select a clone (Edit > Clone > Create Clone). [no-clone]");
        insta::assert_snapshot!(refusal(&drawing(), "mirror", &["nobody"]), @"rinceau: No object has the id 'nobody'. Check the id in Object > Object Properties. [unknown-id]");
        insta::assert_snapshot!(refusal(&drawing().replace("fill=\"teal\"", "style=\"transform:scale(2)\""), "mirror", &["square"]), @"rinceau: 3:35: 'square' is moved by its style. Group it (Object > Group), and select the group. [styled-transform]");
        let sheet =
            drawing().replace("<g transform=", "<style>#square{transform:scale(2)}</style><g transform=");
        insta::assert_snapshot!(refusal(&sheet, "mirror", &["square"]), @"rinceau: 3:35: 'square' is moved by its style. Group it (Object > Group), and select the group. [styled-transform]");
        let unreadable =
            drawing().replace("<rect id=\"square\"", "<rect id=\"square\" transform=\"spin(9)\"");
        insta::assert_snapshot!(refusal(&unreadable, "mirror", &["square"]), @"rinceau: 3:35: The object 'square' cannot be read: its transform cannot be read. Redraw it, or clear its mark. [broken-object]");
        let text = drawing()
            .replace("<circle id=\"t1\"", "<text><tspan id=\"word\">a</tspan></text><circle id=\"t1\"");
        insta::assert_snapshot!(refusal(&text, "mirror", &["word"]), @"rinceau: 6:7: 'word' is nothing that can be moved by itself. Select the shape, text or group that it belongs to. [not-movable]");
    }
}

mod a_map {
    use super::*;

    const TREE: &str = r##"<g id="layer" transform="translate(10,0)" style="stroke:#14444f">
<g id="tree"><path id="trunk" d="M90,190 V130" style="fill:none;stroke-width:6"/>
<use id="left" href="#trunk" transform="translate(90,130) rotate(-30) scale(.7) translate(-90,-190)"/>
<use id="right" href="#trunk" transform="translate(90,130) rotate(40) scale(.7) translate(-90,-190)"/></g></g>"##;

    fn run(text: &str, flags: &[&str]) -> String {
        rinceau(["recurse", "--history", "true", "--depth", "3"])
            .args(flags)
            .input(text)
            .succeed()
            .text()
            .to_owned()
    }

    fn steps(text: &str) -> Vec<(String, Option<String>)> {
        let xml = parse(text);
        let get = |node: &Node, name: &str| node.attribute((RINCEAU, name)).map(str::to_owned);
        let steps = xml.descendants().filter_map(|node| Some((get(&node, "step")?, get(&node, "parent"))));
        steps.filter(|(step, _)| !step.is_empty()).collect()
    }

    fn changed(text: &str, from: &str, to: &str) -> String {
        assert_eq!(text.matches(from).count(), 1, "{from}");
        text.replace(from, to)
    }

    #[test]
    fn grows_with_every_new_form_and_tells_where_it_came_from() {
        let one = run(&svg(TREE), &["--id", "tree"]);
        assert_eq!(steps(&one), [("1".into(), None)]);
        assert_eq!(steps(&run(&one, &["--id", "tree"])).len(), 1, "nothing changed");
        // Only the drawing's own clone, the first in the text, and not the kept one.
        let turned = one.replacen("rotate(40)", "rotate(60)", 1);
        let two = run(&turned, &["--id", "tree"]);
        assert_eq!(steps(&two)[1], ("2".into(), Some("1".into())));
        // From the first picture again, with other parameters.
        let three = run(&two, &["--id", "step-1", "--generations", "last"]);
        assert_eq!(steps(&three)[2], ("3".into(), Some("1".into())));
        let xml = parse(&three);
        let cells: Vec<_> = ["step-1", "step-2", "step-3"]
            .map(|id| by_id(&xml, id).attribute((RINCEAU, "cell")).unwrap())
            .into();
        assert_eq!(cells, ["0 0", "1 0", "1 1"]);
        let layer = support::layers(&xml)
            .into_iter()
            .map(|layer| layer.attribute((RINCEAU, "source")).unwrap())
            .collect::<Vec<_>>();
        assert_eq!(layer, ["tree", "step-1-tree"]);
    }

    /// Rules for an id do not know a copy, and still paint it.
    #[test]
    fn keeps_the_paint_of_rules() {
        let ruled = svg(&format!("<style>#trunk{{stroke:red}}</style>{TREE}"));
        let out = run(&ruled, &["--id", "tree"]);
        let xml = parse(&out);
        assert_eq!(
            by_id(&xml, "step-1-trunk").attribute("style"),
            Some("stroke:red;fill:none;stroke-width:6")
        );
        assert_eq!(by_id(&xml, "trunk").attribute("style"), Some("fill:none;stroke-width:6"));
    }

    /// A layer is renewed where its form is drawn again with another.
    #[test]
    fn of_two_forms_takes_the_layer_of_one() {
        let marked = svg(&TREE.replace("id=\"tree\"", "id=\"tree\" class=\"rinceau-form\""));
        let one = run(&marked, &[]);
        let resumed = rinceau(["resume", "--id", "step-1"]).input(one).succeed().text().to_owned();
        let both = run(&resumed, &[]);
        let xml = parse(&both);
        let layers = support::layers(&xml);
        assert_eq!(layers.len(), 1);
        assert_eq!(layers[0].attribute((RINCEAU, "source")), Some("tree form-of-step-1-tree"));
    }

    #[test]
    fn keeps_what_was_drawn() {
        let before = svg(TREE);
        let after = run(&before, &["--id", "tree"]);
        let kept = before.strip_suffix("</svg>\n").unwrap();
        assert!(after.starts_with(kept) && after.ends_with("</svg>\n"));
        let xml = parse(&after);
        let mut ids: Vec<&str> = xml.descendants().filter_map(|node| node.attribute("id")).collect();
        let all = ids.len();
        ids.sort_unstable();
        ids.dedup();
        assert_eq!(ids.len(), all, "an id stands twice");
    }

    /// The same form again, to be changed; its step is its parent.
    #[test]
    fn gives_a_form_back() {
        let one = run(&svg(TREE), &["--id", "tree"]);
        let out = rinceau(["resume", "--id", "step-1"]).input(one.as_str()).succeed().text().to_owned();
        let scene = scene_of(&out);
        assert_eq!(scene.forms.len(), 1, "steps are not read unless they are selected");
        let clones = |scene: &Scene| -> Vec<Affine> {
            let clone = |item: &FormItem| match item {
                FormItem::Clone(clone) => Some(clone.transform),
                FormItem::Primitive(_) => None,
            };
            scene.forms[0].items.iter().filter_map(clone).collect()
        };
        let document = Document::from_bytes(svg(TREE).into_bytes()).unwrap();
        let first = document.scene(&Selection { ids: vec!["tree".into()] }).unwrap();
        for (a, b) in clones(&scene).into_iter().zip(clones(&first)) {
            assert!(a.as_coeffs().iter().zip(b.as_coeffs()).all(|(a, b)| (a - b).abs() < 1e-6));
        }
        let changed = changed(
            &out,
            "id=\"form-of-step-1-right\" href=\"#form-of-step-1-trunk\" transform=\"translate(90,130)",
            "id=\"form-of-step-1-right\" href=\"#form-of-step-1-trunk\" transform=\"translate(90,150)",
        );
        let two = run(&changed, &[]);
        assert_eq!(steps(&two)[1], ("2".into(), Some("1".into())));
    }

    #[test]
    fn is_not_where_it_is_not() {
        let done = rinceau(["resume", "--id", "tree"]).input(svg(TREE)).done();
        insta::assert_snapshot!(done.stderr.trim_end(), @"rinceau: 3:1: 'tree' is no step of an exploration. Select one of the pictures in the layer of explored forms. [no-step]");
        assert!(done.code == Some(1) && done.stdout.is_empty());
    }
}
