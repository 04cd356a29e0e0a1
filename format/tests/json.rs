//! Scenes as JSON and as drawings of their own: nothing that the format knows is lost on the way.

use kurbo::{Affine, BezPath, Point, Rect};
use proptest::collection::{btree_map, vec};
use proptest::option;
use proptest::prelude::*;
use rinceau_format::{
    Container, Document, Element, Example, Fixed, Form, FormItem, Guide, Outline, Part, Position, Primitive,
    Reference, Replication, RuleSet, Scene, Seed, Selection, Source, Stroke, Style, Template, When,
};
use std::collections::BTreeMap;

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![-500.0..500.0f64, (-500..500i32).prop_map(f64::from), -1e-6..1e-6f64]
}

fn point() -> impl Strategy<Value = Point> {
    (number(), number()).prop_map(Point::from)
}

fn path() -> impl Strategy<Value = BezPath> {
    let subpath = (point(), vec((0..3u8, point(), point(), point()), 1..5), any::<bool>());
    vec(subpath, 1..3).prop_map(|subpaths| {
        let mut path = BezPath::new();
        for (start, pieces, closed) in subpaths {
            path.move_to(start);
            for (kind, a, b, c) in pieces {
                match kind {
                    0 => path.line_to(a),
                    1 => path.quad_to(a, b),
                    _ => path.curve_to(a, b, c),
                }
            }
            if closed {
                path.close_path();
            }
        }
        path
    })
}

fn affine() -> impl Strategy<Value = Affine> {
    let moved = (0.1..3.0f64, -3.0..3.0f64, number(), number());
    moved.prop_map(|(scale, turn, x, y)| Affine::new([scale, turn, -turn, scale, x, y]))
}

fn style() -> impl Strategy<Value = Style> {
    let property = prop_oneof![
        Just(("fill", "none".to_owned())),
        Just(("fill", "#ab12cd".to_owned())),
        Just(("fill-rule", "evenodd".to_owned())),
        Just(("stroke", "#00aa00".to_owned())),
        (0.01..9.0f64).prop_map(|width| ("stroke-width", width.to_string())),
        Just(("stroke-linecap", "round".to_owned())),
        (0.01..0.99f64).prop_map(|opacity| ("opacity", opacity.to_string())),
        (0.01..0.99f64).prop_map(|opacity| ("fill-opacity", opacity.to_string())),
    ];
    vec(property, 0..5).prop_map(|properties| {
        let map: BTreeMap<String, String> =
            properties.into_iter().map(|(name, value)| (name.to_owned(), value)).collect();
        Style::from_properties(&map).expect("properties of paint")
    })
}

fn part() -> impl Strategy<Value = Part> {
    (path(), prop_oneof![Just(Affine::IDENTITY), affine()], style())
        .prop_map(|(path, transform, style)| Part { path, transform, style })
}

fn overrides() -> impl Strategy<Value = BTreeMap<String, String>> {
    btree_map("[b-d][a-z0-9-]{1,8}", "[ -~äß]{0,12}", 0..3)
}

fn named(label: &str) -> Source {
    Source { id: String::new(), label: label.to_owned(), at: Position::default() }
}

fn label() -> impl Strategy<Value = Source> {
    prop_oneof![Just(String::new()), "[ -~äß]{1,10}"].prop_map(|label| named(&label))
}

fn guides() -> impl Strategy<Value = Vec<Guide>> {
    vec((label(), path()).prop_map(|(source, path)| Guide { source, marked: true, path }), 0..3)
}

fn forms() -> impl Strategy<Value = Vec<Form>> {
    let primitive = (part(), prop_oneof![Just(When::AsForm), Just(When::Last), Just(When::Inner)])
        .prop_map(|(part, when)| FormItem::Primitive(Primitive { part, when, live: None }));
    let clone = (label(), 0..100usize, affine())
        .prop_map(|(source, form, transform)| FormItem::Clone(Replication { source, form, transform }));
    let form = (label(), vec(prop_oneof![primitive, clone], 1..5), overrides())
        .prop_map(|(source, items, overrides)| Form { source, is_root: false, items, overrides });
    vec(form, 0..3).prop_map(|mut forms| {
        let count = forms.len();
        for form in &mut forms {
            for item in &mut form.items {
                if let FormItem::Clone(clone) = item {
                    clone.form %= count;
                }
            }
        }
        forms
    })
}

prop_compose! {
    fn shapes()(
        containers in vec((label(), vec((path(), any::<bool>()), 1..3), option::of(Just("#fedcba")), overrides()), 0..3),
        fixed in vec((label(), vec(part(), 1..3)), 0..2),
        lines in (guides(), guides(), guides(), guides()),
        points in vec((label(), point()), 0..4),
        sprays in vec((label(), path(), 0.0..20.0f64, overrides()), 0..2),
        rules in vec(("[a-z]{1,5}", "[ -~\n]{0,40}"), 0..2),
    ) -> Scene {
        let rule = |even| if even { rinceau_format::FillRule::EvenOdd } else { rinceau_format::FillRule::NonZero };
        let container = |(source, outlines, fill, overrides): (Source, Vec<(BezPath, bool)>, Option<&str>, _)| {
            let outlines = outlines.into_iter().map(|(path, even)| Outline { path, rule: rule(even) }).collect();
            Container { source, outlines, fill: fill.map(str::to_owned), overrides }
        };
        let seed = |(source, at): (Source, Point)| Seed { source, at };
        let (seeds, tacks) = points.split_at(points.len() / 2);
        Scene {
            view: Rect::new(0.0, -8.0, 640.0, 480.0),
            px_per_unit: 0.25,
            containers: containers.into_iter().map(container).collect(),
            fixed: fixed.into_iter().map(|(source, parts)| Fixed { source, parts }).collect(),
            guides: lines.0,
            fixed_spines: lines.1,
            stems: lines.2,
            boundaries: lines.3,
            seeds: seeds.iter().cloned().map(seed).collect(),
            tacks: tacks.iter().cloned().map(seed).collect(),
            sprays: sprays.into_iter().map(|(source, path, width, overrides)| Stroke { source, path, width, overrides }).collect(),
            rules: rules.into_iter().map(|(name, text)| RuleSet { name, text }).collect(),
            ..Scene::default()
        }
    }
}

prop_compose! {
    fn templates()(
        elements in vec((label(), "[a-z]{0,4}", "[a-z]{1,4}", vec("[a-z]{1,4}", 0..3), vec(part(), 1..3), option::of((point(), point()))), 0..3),
        examples in vec((label(), "[a-z]{1,3}", vec(part(), 1..3)), 0..4),
        forms in forms(),
    ) -> (Vec<Element>, Vec<Reference>, Vec<Form>) {
        let elements = elements.into_iter().map(|(source, kind, symbol, sets, parts, spine)| {
            let spine = spine.filter(|(base, tip)| base.distance(*tip) > 1e-3);
            Element { source, kind, symbol, sets, template: Template { parts, spine } }
        });
        let examples: Vec<Example> = examples.into_iter().map(|(source, symbol, parts)| Example { source, symbol, parts }).collect();
        let reference = |examples: Vec<Example>| Reference { source: named("tiles"), flips: vec![("a".into(), "b".into())], examples };
        let references = if examples.is_empty() { vec![] } else { vec![reference(examples)] };
        (elements.collect(), references, forms)
    }
}

/// A random scene in which every object has an id of its own.
fn scenes() -> impl Strategy<Value = Scene> {
    (shapes(), templates()).prop_map(|(mut scene, (elements, references, forms))| {
        (scene.elements, scene.references, scene.forms) = (elements, references, forms);
        let mut next = 0;
        let mut name = |source: &mut Source| {
            next += 1;
            source.id = format!("one {next}");
            if source.label.is_empty() {
                source.label.clone_from(&source.id);
            }
        };
        scene.containers.iter_mut().for_each(|one| name(&mut one.source));
        for lines in [&mut scene.guides, &mut scene.fixed_spines, &mut scene.stems, &mut scene.boundaries] {
            lines.iter_mut().for_each(|one| name(&mut one.source));
        }
        scene.fixed.iter_mut().for_each(|one| name(&mut one.source));
        scene.seeds.iter_mut().chain(&mut scene.tacks).for_each(|one| name(&mut one.source));
        scene.sprays.iter_mut().for_each(|one| name(&mut one.source));
        scene.elements.iter_mut().for_each(|one| name(&mut one.source));
        for reference in &mut scene.references {
            name(&mut reference.source);
            reference.examples.iter_mut().for_each(|one| name(&mut one.source));
        }
        for form in &mut scene.forms {
            name(&mut form.source);
            for item in &mut form.items {
                if let FormItem::Clone(clone) = item {
                    name(&mut clone.source);
                }
            }
        }
        scene
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, rng_seed: proptest::test_runner::RngSeed::Fixed(1), ..ProptestConfig::default() })]

    #[test]
    fn json_loses_nothing(scene in scenes()) {
        let json = scene.to_json();
        let back = Scene::from_json(&json).map_err(|error| TestCaseError::fail(format!("{error}\n{json}")))?;
        prop_assert_eq!(back.to_json(), json);
    }

    #[test]
    fn a_drawing_of_a_scene_reads_as_the_scene(scene in scenes()) {
        let document = Document::from_scene(&scene).unwrap();
        let back = document.scene(&Selection::default()).map_err(|error| TestCaseError::fail(format!("{error}\n{}", document.text())))?;
        prop_assert_eq!(back.to_json(), scene.to_json());
        prop_assert!(back.warnings.is_empty(), "{:?}", back.warnings);
    }
}

/// Objects with the same id, and marked groups that hold nothing, are one scene in both forms.
#[test]
fn a_broken_drawing_comes_back_too() {
    let drawing = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 50'>\
                   <path id='a' class='rinceau-container' d='M0,0h5v5z'/>\
                   <path id='a' class='rinceau-guide' d='M0,0h5'/>\
                   <path class='rinceau-guide' d='M1,0h5'/>\
                   <g class='rinceau-fixed'/><g class='rinceau-form'/><g class='rinceau-reference'/></svg>";
    let document = Document::from_bytes(drawing.into()).unwrap();
    let scene = document.scene(&Selection::default()).unwrap();
    let id = |guide: &Guide| guide.source.id.clone();
    assert_eq!(scene.guides.iter().map(id).collect::<Vec<_>>(), ["node:2", "node:3"]);
    let from_json = Scene::from_json(&scene.to_json()).unwrap();
    assert_eq!(from_json.to_json(), scene.to_json());
    let back = Document::from_scene(&from_json).unwrap().scene(&Selection::default()).unwrap();
    assert_eq!(back.to_json(), scene.to_json());
}

#[test]
fn an_object_without_a_symbol_is_one_of_itself() {
    let parts = "\"parts\":[{\"path\":\"M0,0L1,1\",\"style\":{}}]";
    let json = format!(
        "{{\"rinceau\":1,\"scene\":{{\"view\":[0,0,9,9],\"px_per_unit\":1,\"references\":[{{\"source\":{{\"id\":\"r\"}},\
         \"examples\":[{{\"source\":{{\"id\":\"a\"}},\"symbol\":\" \",{parts}}},\
         {{\"source\":{{\"id\":\"b\"}},\"symbol\":\" c \",{parts}}}]}}]}}}}"
    );
    let scene = Scene::from_json(&json).unwrap();
    let symbols: Vec<&str> = scene.references[0].examples.iter().map(|one| &one.symbol[..]).collect();
    assert_eq!(symbols, ["a", "c"]);
    let back = Document::from_scene(&scene).unwrap().scene(&Selection::default()).unwrap();
    assert_eq!(back.to_json(), scene.to_json());
}

#[test]
fn what_is_no_scene_is_said_with_its_place() {
    let refused = |json: &str| Scene::from_json(json).unwrap_err().to_string();
    let scene = |inside: &str| {
        format!("{{\"rinceau\":1,\n\"scene\":{{\"view\":[0,0,9,9],\"px_per_unit\":1{inside}}}}}")
    };
    assert!(Scene::from_json(&scene("")).is_ok());
    let source = "\"source\":{\"id\":\"a\"}";
    for (json, what) in [
        ("{".to_owned(), "1:1: This is no scene: EOF"),
        ("{\"rinceau\":2,\"scene\":{\"view\":[0,0,9,9],\"px_per_unit\":1}}".to_owned(), "of version 2"),
        (scene(",\"colour\":1"), "2:50: This is no scene: unknown field `colour`"),
        (
            scene(&format!(",\"guides\":[{{{source},\"path\":\"M0,0 L\"}}]")),
            "path data is broken at command 2",
        ),
        (
            scene(&format!(",\"guides\":[{{{source},\"path\":\"M0,0 L1e12,5\"}}]")),
            "'a' has a coordinate beyond 1e9",
        ),
        (scene(&format!(",\"sprays\":[{{{source},\"path\":\"M0,0\",\"width\":-1}}]")), "no width"),
        (
            scene(&format!(
                ",\"containers\":[{{{source},\"outlines\":[{{\"path\":\"M0,0L1,1\"}}],\"overrides\":{{\"a b\":\"1\"}}}}]"
            )),
            "'a' sets 'a b', which is no parameter's name",
        ),
        (
            scene(&format!(
                ",\"forms\":[{{{source},\"items\":[{{\"clone\":{{{source},\"form\":7,\"transform\":[1,0,0,1,0,0]}}}}]}}]"
            )),
            "of form 7, which there is not",
        ),
        (
            scene(&format!(
                ",\"forms\":[{{{source},\"items\":[{{\"clone\":{{{source},\"form\":0,\"transform\":[0,0,0,0,0,0]}}}}]}}]"
            )),
            "scaled to nothing",
        ),
        (
            scene(&format!(
                ",\"fixed\":[{{{source},\"parts\":[{{\"path\":\"M0,0L1,1\",\"style\":{{\"font\":\"x\"}}}}]}}]"
            )),
            "'font' is no property of paint",
        ),
        (scene(",\"seeds\":[{\"source\":{\"id\":\" \"},\"at\":[1,2]}]"), "has no id"),
        (
            scene(&format!(",\"fixed\":[{{{source},\"parts\":[]}},{{{source},\"parts\":[]}}]")),
            "Two objects of it have the id 'a'",
        ),
        (
            scene(&format!(
                ",\"references\":[{{{source},\"examples\":[{{\"source\":{{\"id\":\"b\"}},\"symbol\":\"s\",\"parts\":[]}}]}}]"
            )),
            "'b' has nothing in it",
        ),
        (
            scene(&format!(
                ",\"references\":[{{{source},\"flips\":[[\"b c\",\"d\"]],\"examples\":[{{{source},\"symbol\":\"s\",\
                 \"parts\":[{{\"path\":\"M0,0L1,1\",\"style\":{{}}}}]}}]}}]"
            )),
            "'a' flips an edge between objects that no id could name",
        ),
    ] {
        let error = refused(&json);
        assert!(error.contains(what), "{error}\nnot {what}");
    }
    // However deep: a sentence, and no end of the stack.
    assert!(refused(&"[".repeat(100_000)).contains("This is no scene"));
}

#[test]
fn the_published_schema_is_that_of_the_types() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/scene.schema.json");
    let schema = Scene::json_schema();
    if std::env::var_os("RINCEAU_BLESS").is_some() {
        std::fs::write(path, &schema).unwrap();
    }
    let published = std::fs::read_to_string(path).unwrap_or_default();
    assert!(published == schema, "run with RINCEAU_BLESS=1 to publish the schema");
}

/// A drawing may have a container with nothing in it, which generators refuse; its scene is no other.
#[test]
fn an_empty_container_comes_back() {
    let text = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 9 9'><g id='a' class='rinceau-container'/></svg>";
    let scene = Document::from_bytes(text.into()).unwrap().scene(&Selection::default()).unwrap();
    let json = scene.to_json();
    let back = Scene::from_json(&json).unwrap();
    assert!(back.containers[0].outlines.is_empty());
    let drawn = Document::from_scene(&back).unwrap().scene(&Selection::default()).unwrap();
    assert_eq!(drawn.to_json(), json);
}
