//! Recursive forms as grammars of Context Free, and back.

use kurbo::{Affine, Shape};
use rinceau_format::{Document, FormItem, Scene, Selection};

/// Primitives and clones of the first form, as what they map the page to.
fn content(scene: &Scene) -> (Vec<kurbo::BezPath>, Vec<Affine>, Vec<String>) {
    let (mut paths, mut clones, mut paints) = (Vec::new(), Vec::new(), Vec::new());
    for item in &scene.forms[0].items {
        match item {
            FormItem::Primitive(primitive) => {
                paths.push(primitive.part.transform * primitive.part.path.clone());
                paints.push(primitive.part.style.css());
            }
            FormItem::Clone(clone) => clones.push(clone.transform),
        }
    }
    (paths, clones, paints)
}

#[test]
fn forms_come_back_from_their_grammar() {
    let svg = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 600 400">
      <g id="a form" class="rinceau-form">
        <rect id="r" x="10" y="20" width="50" height="30" fill="#c03020" fill-opacity="0.5"/>
        <path d="M0,0 C10,5 30,20 40,60 Q50,70 80,80" fill="none" stroke="#2060c0" stroke-width="4"
              stroke-linecap="round" stroke-linejoin="bevel" transform="rotate(20) scale(2)"/>
        <path d="M0,0H90V90H0ZM20,20H50V60H20Z" fill-rule="evenodd"/>
        <use href="#r" transform="translate(30 10) rotate(-25) skewX(10) scale(.6 .7)"/>
        <use href="#r" transform="translate(90 40) scale(-.5 .5)"/>
      </g></svg>"##;
    let scene = Document::from_bytes(svg.into()).unwrap().scene(&Selection::default()).unwrap();
    let (text, notes) = scene.to_cfdg();
    assert!(notes.is_empty(), "{notes:?}");
    let (back, notes) = Scene::from_cfdg(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    assert!(notes.is_empty(), "{notes:?}");
    // The first of two: the page, which shows it once.
    let is_form = |form: &&rinceau_format::Form| form.items.len() > 1;
    let forms: Vec<_> = back.forms.iter().filter(is_form).cloned().collect();
    let back = Scene { forms, ..Scene::default() };
    let ((paths, clones, paints), (paths_back, clones_back, paints_back)) = (content(&scene), content(&back));
    assert_eq!(
        paints_back,
        paints
            .iter()
            .map(|paint| {
                // Widths are of the page, and defaults are not written.
                paint.replace("stroke-width:4", "stroke-width:8")
            })
            .collect::<Vec<_>>()
    );
    // The page is another one: forms lie beside each other there.
    let shift = Affine::translate(paths_back[0].bounding_box().origin() - paths[0].bounding_box().origin());
    for (path, other) in paths.iter().zip(&paths_back) {
        let (here, there) = ((shift * path.clone()).bounding_box(), other.bounding_box());
        assert!(
            (here.origin() - there.origin()).hypot() < 1e-6
                && (here.size() - there.size()).to_vec2().hypot() < 1e-6
        );
        assert!(((shift * path.clone()).area() - other.area()).abs() < 1e-4);
    }
    assert_eq!(clones.len(), clones_back.len());
    for (clone, other) in clones.iter().zip(&clones_back) {
        let here = shift * *clone * shift.inverse();
        let (here, other) = (here.as_coeffs(), other.as_coeffs());
        let apart = here.iter().zip(other).map(|(a, b)| (a - b).abs());
        assert!(apart.fold(0.0, f64::max) < 1e-6, "{here:?} {other:?}");
    }
}

#[test]
fn a_grammar_is_a_drawing_with_a_frame() {
    let text = "startshape TREE // a tree\nCF::Background = [ b -0.1 ]\nshape TREE {\n SQUARE [ size 0.2 1 hue 120 sat 0.6 b 0.5 ]\n LEAF [ y 0.5 r 10 s 0.4 ]\n TREE [ y 0.9 s 0.7 r 30 ] /* two */ TREE [[ y 0.9 r -30 s 0.7 ]]\n loop 3 [ r 40 ] CIRCLE [ x 0.3 s 0.1 b 0.4 ]\n}\npath LEAF { MOVETO(0,0) CURVETO(1,0,0.2,0.4,0.8,0.4) CLOSEPOLY(CF::Align) FILL[] STROKE(0.04)[b 1] }\n";
    let (scene, notes) = Scene::from_cfdg(text).unwrap();
    assert_eq!(notes.len(), 1, "{notes:?}");
    let document = Document::from_scene(&scene).unwrap();
    let again = document.scene(&Selection::default()).unwrap();
    assert_eq!(again.to_json(), scene.to_json());
    let (paths, clones, paints) = content(&scene);
    assert_eq!((paths.len(), clones.len(), scene.containers.len()), (6, 2, 1));
    assert!(paints[0].starts_with("fill:#338033"), "{}", paints[0]);
    let square = paths[0].bounding_box();
    assert!((square.width() - 20.0).abs() < 1e-9 && (square.height() - 100.0).abs() < 1e-9);
    // A hundred units above it, upwards, and smaller.
    let above = clones[0] * square.center();
    assert!((above - square.center() - kurbo::Vec2::new(0.0, -90.0)).hypot() < 1e-9);
    assert!((clones[0].determinant() - 0.49).abs() < 1e-12);
}

#[test]
fn loops_may_stand_in_loops_without_braces() {
    let text = "startshape A\nshape A { loop 3 [x 2] loop 4 [y 1 r 10] CIRCLE [s 0.5] }";
    let (scene, _) = Scene::from_cfdg(text).unwrap();
    assert_eq!(content(&scene).0.len(), 12);
}

#[test]
fn what_no_form_has_is_said_with_its_place() {
    for (text, what) in [
        ("shape A { SQUARE [] }", "1:1: The grammar has no startshape"),
        ("startshape B\nshape A { SQUARE [] }", "1:12: There is no shape 'B'"),
        ("startshape A\nshape A { B [] }", "2:11: There is no shape 'B'"),
        ("startshape A\nrule A { SQUARE {} }\nrule A 2 { CIRCLE {} }", "3:6: 'A' has several rules"),
        ("startshape A\nshape A (number n) { SQUARE [] }", "2:9: A shape has parameters"),
        ("startshape A\nshape A { if (1) { SQUARE [] } }", "2:11: 'if' is nothing that a form has"),
        ("startshape A\nshape A { SQUARE [ colour 3 ] }", "2:20: The adjustment 'colour'"),
        ("startshape A\nshape A { SQUARE [ x 1e300 ] }", "2:20: A number is beyond all measure"),
        ("startshape A\nshape A { A [ s 0 ] }", "2:11: A copy is scaled to nothing"),
        ("startshape A\nshape A { loop 20000 [] { loop 20000 [] SQUARE [] } }", "too many pieces"),
        ("startshape A\nshape A { loop 1.5 [] SQUARE [] }", "a whole number of times"),
        ("startshape A\npath P { LINETO(1) }", "The path command 'LINETO'"),
        ("startshape A\nshape A { loop 1000000 [] SQUARE [] }", "20000 times at most"),
        ("import other.cfdg", "takes in other files"),
        ("/* open", "1:1: A comment does not end"),
        ("startshape A\nshape A { SQUARE [", "An adjustment does not end"),
        ("startshape A\nshape A { SQUARE", "Here should be '['"),
        ("startshape A shape A {{", "Here should be the name of a shape"),
    ] {
        let error = Scene::from_cfdg(text).unwrap_err().to_string();
        assert!(error.contains(what), "{error}\nnot {what}");
    }
}
