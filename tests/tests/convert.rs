//! `rinceau convert` and `rinceau check` as a script would call them.

mod support;

use serde_json::Value;
use std::path::Path;
use support::geometry::samples_of;
use support::*;

/// Converts a file; the notes that were printed.
fn convert(from: &Path, to: &Path, flags: &[&str]) -> String {
    let done = rinceau([Path::new("convert"), from, to]).args(flags).succeed();
    done.stderr.clone()
}

fn drawing() -> String {
    svg("<path id='body' class='rinceau-container' rinceau:spacing='9' d='M0,0H90V60H0Z'/>\
         <path id='flow' class='rinceau-guide' d='M0,30H90'/>")
}

#[test]
fn every_sample_goes_to_json_and_back() {
    let folder = folder();
    let mut tried = 0;
    for generator in ["pack", "grow", "vine", "recurse", "arrange"] {
        for sample in samples_of(generator) {
            let (json, back, again) = (
                folder.path().join("scene.json"),
                folder.path().join("back.svg"),
                folder.path().join("again.json"),
            );
            convert(&sample, &json, &[]);
            convert(&json, &back, &[]);
            convert(&back, &again, &[]);
            let read = |path| std::fs::read_to_string(path).unwrap();
            let (first, second) = (read(&json), read(&again));
            // The size of the page may differ by the last bit.
            let rounded = |text: &str| {
                let mut value: Value = serde_json::from_str(text).unwrap();
                let px = value["scene"]["px_per_unit"].as_f64().unwrap();
                value["scene"]["px_per_unit"] = format!("{px:.9}").into();
                value
            };
            assert_eq!(rounded(&first), rounded(&second), "{}", sample.display());
            tried += 1;
        }
    }
    assert!(tried > 100, "{tried}");
}

#[test]
fn a_drawing_becomes_every_format() {
    let folder = folder();
    let input = file(&folder, "in.svg", drawing());
    let packed = folder.path().join("packed.svg");
    rinceau([Path::new("pack"), &input, Path::new("-o"), &packed]).succeed();
    let out = |name: &str| folder.path().join(name);
    convert(&packed, &out("a.svgz"), &[]);
    assert_eq!(gunzip(&std::fs::read(out("a.svgz")).unwrap()), std::fs::read(&packed).unwrap());
    convert(&packed, &out("a.png"), &["--width", "123"]);
    let png = std::fs::read(out("a.png")).unwrap();
    assert!(png.starts_with(b"\x89PNG") && png[16..20] == 123u32.to_be_bytes(), "{:?}", &png[..24]);
    convert(&packed, &out("a.pdf"), &[]);
    assert!(std::fs::read(out("a.pdf")).unwrap().starts_with(b"%PDF"));
    convert(&packed, &out("clean.svg"), &["--artwork-only"]);
    let clean = std::fs::read_to_string(out("clean.svg")).unwrap();
    assert!(!clean.contains("rinceau") && !clean.contains("id=\"body\"") && clean.contains("<path"));
    convert(&packed, &out("flat.svg"), &["--flat"]);
    let flat = std::fs::read_to_string(out("flat.svg")).unwrap();
    let xml = parse(&flat);
    assert!(
        xml.root_element()
            .children()
            .filter(|node| node.is_element())
            .all(|node| node.has_tag_name(("http://www.w3.org/2000/svg", "path")))
    );
    convert(&input, &out("inks.svg"), &["--to", "colours"]);
    let inks = std::fs::read_to_string(out("inks.svg")).unwrap();
    assert!(!inks.contains("rinceau-container") && inks.contains("stroke:#ff0000"));
    convert(&out("inks.svg"), &out("marked.svg"), &["--from", "colours"]);
    let marked = std::fs::read_to_string(out("marked.svg")).unwrap();
    assert!(marked.contains("rinceau-container") && marked.contains("rinceau-guide"));
    // The same picture twice is the same bytes.
    convert(&packed, &out("b.png"), &["--width", "123"]);
    assert_eq!(std::fs::read(out("b.png")).unwrap(), png);
}

/// Whatever fonts there are, a drawing that names none of them has its text.
#[test]
fn text_of_generic_families_is_drawn() {
    let folder = folder();
    for family in ["", "font-family='serif'", "font-family='monospace'"] {
        let text = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' width='90' height='40'><text x='5' y='30' font-size='24' {family}>Abc</text></svg>"
        );
        let input = file(&folder, "text.svg", text);
        let flat = folder.path().join("flat.svg");
        convert(&input, &flat, &["--flat"]);
        assert!(std::fs::read_to_string(&flat).unwrap().matches("<path").count() >= 1, "{family}");
        let (with, without) = (folder.path().join("with.png"), folder.path().join("without.png"));
        convert(&input, &with, &[]);
        convert(
            &file(&folder, "none.svg", "<svg xmlns='http://www.w3.org/2000/svg' width='90' height='40'/>"),
            &without,
            &[],
        );
        assert_ne!(std::fs::read(&with).unwrap(), std::fs::read(&without).unwrap(), "{family}");
    }
}

#[test]
fn grammars_come_in_and_go_out() {
    let folder = folder();
    let out = |name: &str| folder.path().join(name);
    let text = "startshape S\nshape S { SQUARE [ b 0.4 ] S [ x 1 s 0.8 r 20 ] }\n";
    let input = file(&folder, "in.cfdg", text);
    convert(&input, &out("form.svg"), &[]);
    let repeated =
        rinceau([Path::new("recurse"), &out("form.svg"), Path::new("--depth"), Path::new("6")]).succeed();
    let text = repeated.text().to_owned();
    let xml = parse(&text);
    let pieces = xml.descendants().filter(|node| node.attribute(("urn:rinceau:1", "of")).is_some());
    // Copies alike in paint may be one path.
    let copies: usize = pieces.filter_map(|node| node.attribute("d")).map(|d| d.matches('M').count()).sum();
    assert_eq!(copies, 6);
    convert(&out("form.svg"), &out("out.cfdg"), &[]);
    assert!(std::fs::read_to_string(out("out.cfdg")).unwrap().contains("transform"));
}

#[test]
fn standard_streams_need_no_names() {
    let run = |args: &[&str], input: Vec<u8>| rinceau(args).input(input).succeed().stdout;
    let json = run(&["convert", "-", "-", "--to", "json"], drawing().into());
    assert!(json.starts_with(b"{\n  \"rinceau\": 1"));
    // JSON is known by its first character.
    let back = String::from_utf8(run(&["convert", "-", "-"], json)).unwrap();
    assert!(back.contains("id=\"body\"") && back.contains("rinceau:spacing=\"9\""));
    let zipped = run(&["convert", "-", "-", "--to", "svgz"], drawing().into());
    assert_eq!(gunzip(&zipped), drawing().into_bytes());
}

#[test]
fn what_cannot_be_converted_leaves_no_file() {
    let folder = folder();
    let input = file(&folder, "in.svg", drawing());
    let failed = |args: &[&Path], what: &str| {
        let done = rinceau([&[Path::new("convert")], args].concat()).done();
        assert_eq!(done.code, Some(1), "{}", done.stderr);
        assert!(done.stderr.contains(what), "{}", done.stderr);
        assert!(!folder.path().join("out.svg").exists() && !folder.path().join("out.cfdg").exists());
    };
    let out = folder.path().join("out.svg");
    failed(&[&input, &folder.path().join("out.bmp")], "[unknown-format]");
    failed(&[&input, &folder.path().join("out.cfdg")], "[no-form]");
    failed(&[&input, &folder.path().join("out.json"), Path::new("--flat")], "[unfit-option]");
    failed(&[&file(&folder, "bad.json", "{\"rinceau\":1}"), &out], "[broken-json]");
    failed(&[&file(&folder, "bad.cfdg", "shape"), &out], "[broken-cfdg]");
    failed(
        &[
            &file(&folder, "plain.svg", svg("<circle r='3' fill='#77aaff'/>")),
            &out,
            Path::new("--from"),
            Path::new("colours"),
        ],
        "[no-colours]",
    );
    let png = folder.path().join("out.png");
    failed(
        &[
            &file(
                &folder,
                "wide.svg",
                "<svg xmlns='http://www.w3.org/2000/svg' width='1' height='99999999'/>",
            ),
            &png,
        ],
        "[cannot-render]",
    );
    assert!(!png.exists());
}

/// What hangs or breaks the renderer is beyond this program's doing, but not beyond its care.
#[test]
fn a_renderer_that_fails_takes_nothing_with_it() {
    let folder = folder();
    let deep = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'>{}{}</svg>",
        "<g opacity='.5'>".repeat(900),
        "</g>".repeat(900)
    );
    let cycle = "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' width='9' height='9'><defs><pattern id='a' width='1' height='1'><rect fill='url(#a)' width='1' height='1'/></pattern></defs><rect width='9' height='9' fill='url(#a)'/></svg>";
    for (name, text) in [("deep.svg", deep.as_str()), ("cycle.svg", cycle)] {
        let out = folder.path().join("out.png");
        let done = rinceau([Path::new("convert"), &file(&folder, name, text), &out]).done();
        assert!(done.code == Some(0) || done.stderr.contains("[cannot-render]"), "{name}: {}", done.stderr);
    }
}

#[test]
fn a_check_tells_scripts_everything() {
    let bad = svg("<path id='body' class='rinceau-container' rinceau:colour='9' d='M0,0H90V60'/>\n\
         <path id='flow' class='rinceau-guide' d='M0,30 L'/>\n\
         <g id='leaf' class='rinceau-element'><rect width='9' height='3'/></g>\n\
         <metadata><rinceau:rules name='own'>element</rinceau:rules></metadata>");
    let done = rinceau(["check", "-", "--json"]).input(bad.as_str()).done();
    assert_eq!(done.code, Some(1));
    let check: Value = serde_json::from_slice(&done.stdout).unwrap();
    let problems = check["problems"].as_array().unwrap();
    let found: Vec<String> = problems
        .iter()
        .map(|problem| {
            format!(
                "{} {} {}",
                problem["severity"].as_str().unwrap(),
                problem["code"].as_str().unwrap(),
                problem["id"]
            )
        })
        .collect();
    assert_eq!(
        found,
        [
            "error bad-rules null",
            "error open-container \"body\"",
            "error unknown-parameter \"body\"",
            "error broken-object \"flow\"",
            "warning no-spine \"leaf\""
        ]
    );
    for problem in problems {
        assert!(problem["message"].as_str().is_some_and(|text| text.len() > 10), "{problem}");
        assert!(problem["remedy"].as_str().is_some_and(|text| text.len() > 10), "{problem}");
    }
    assert!(problems[1]["line"].as_u64().is_some() && problems[1]["column"].as_u64().is_some());
    assert_eq!(check["errors"], 4);
    // As text the same, with a verdict on standard error.
    let done = rinceau(["check", "-"]).input(bad.as_str()).done();
    assert_eq!((done.code, done.text().matches("error: ").count()), (Some(1), 4));
    assert!(done.stderr.contains("There are 4 errors"), "{}", done.stderr);
    let good = rinceau(["check", "-", "--json"]).input(drawing()).succeed();
    let check: Value = serde_json::from_slice(&good.stdout).unwrap();
    assert_eq!((&check["errors"], check["objects"].as_array().unwrap().len()), (&Value::from(0), 2));
    // Names cannot fool a terminal.
    let fooling = svg(
        "<path id='a&#x9b;b' class='rinceau-guide rinceau-stem' rinceau:role='stem' d='M0,0H9'/><path class='rinceau-seed' id='c&#x202e;d'/>",
    );
    let check = rinceau(["check", "-"]).input(fooling.as_str()).succeed();
    let converted = rinceau(["convert", "-", "-", "--to", "json"]).input(fooling.as_str()).succeed();
    for text in [check.text(), converted.stderr.as_str()] {
        assert!(text.contains("\\u{202e}") && !text.contains(['\u{9b}', '\u{202e}']), "{text:?}");
    }
    // No drawing at all is a problem too.
    let done = rinceau(["check", "-", "--json"]).input("no drawing").done();
    let check: Value = serde_json::from_slice(&done.stdout).unwrap();
    assert_eq!((done.code, &check["problems"][0]["code"]), (Some(1), &Value::from("not-xml")));
}
