//! The command line's promises: bytes outside the result stay, a file is whole or as it was,
//! a second run replaces, and nothing else is read.

mod support;

use roxmltree::Node;
use std::os::unix::fs::{MetadataExt, PermissionsExt, symlink};
use std::path::{Path, PathBuf};
use std::process::Command;
use support::*;

/// `pack` over standard input and output.
fn packed(drawing: impl Into<Vec<u8>>, flags: &[&str]) -> Vec<u8> {
    rinceau(["pack"]).arg("-").args(flags).input(drawing).succeed().stdout
}

fn packed_text(drawing: impl Into<Vec<u8>>, flags: &[&str]) -> String {
    String::from_utf8(packed(drawing, flags)).unwrap()
}

/// The drawing with its layer cut out is the drawing as it was.
fn assert_only_a_layer_was_added(before: &str, after: &str, name: &str) {
    assert_ne!(before, after, "{name}");
    let cut = without_layer(after);
    assert!(
        cut == before,
        "{name}: bytes outside the layer changed:\n{cut:.1000}\ninstead of\n{before:.1000}"
    );
}

mod bytes {
    use super::*;

    #[test]
    fn outside_the_layer_stay_in_every_sample() {
        for sample in samples() {
            let before = std::fs::read_to_string(&sample).unwrap();
            let after = packed_text(before.as_str(), &[]);
            assert_only_a_layer_was_added(&before, &after, &sample.display().to_string());
        }
    }

    #[test]
    fn outside_the_layer_stay_however_the_drawing_is_written() {
        for (name, before) in variants() {
            let after = packed_text(before.as_str(), &[]);
            assert_only_a_layer_was_added(&before, &after, name);
            let xml = parse(&after);
            let [layer] = layers(&xml)[..] else { panic!("{name}: {} layers", layers(&xml).len()) };
            assert!(elements(layer).len() > 10, "{name}: {} elements", elements(layer).len());
            // Whatever its prefixes are, the layer is SVG like the rest.
            let namespace = xml.root_element().tag_name().namespace();
            for node in layer.descendants().filter(Node::is_element) {
                assert_eq!(node.tag_name().namespace(), namespace, "{name}");
            }
            assert_eq!(packed_text(after.as_str(), &[]), after, "{name}: a second run changes something");
            if before.contains("\r\n") {
                assert!(!after.replace("\r\n", "").contains('\n'), "{name}: line ends are mixed");
            }
        }
    }

    /// The same drawing in many hands.
    fn variants() -> Vec<(&'static str, String)> {
        let shape = "<circle id=\"sun\" class=\"rinceau-container\" cx=\"100\" cy=\"100\" r=\"90\"/>";
        let marked = "<circle id=\"sun\" o:role=\"container\" cx=\"100\" cy=\"100\" r=\"90\"/>";
        let open = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 200 200\"";
        vec![
            ("a BOM in UTF-8", format!("\u{feff}{open}>{shape}</svg>")),
            ("CRLF", format!("<?xml version=\"1.0\"?>\r\n{open}>\r\n{shape}\r\n</svg>\r\n")),
            ("no line break at all", format!("{open}>{shape}</svg>")),
            ("apostrophes", format!("{open}>{shape}</svg>").replace('"', "'")),
            (
                "a DTD with entities, as Illustrator writes it",
                format!(
                    "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<!DOCTYPE svg PUBLIC \"-//W3C//DTD SVG 1.0//EN\" \"http://www.w3.org/TR/2001/REC-SVG-20010904/DTD/svg10.dtd\" [\n\t<!ENTITY ns_svg \"http://www.w3.org/2000/svg\">\n\t<!ENTITY ns_xlink \"http://www.w3.org/1999/xlink\">\n\t<!ENTITY st0 \"fill:#FFFFFF;\">\n]>\n<svg xmlns=\"&ns_svg;\" xmlns:xlink=\"&ns_xlink;\" viewBox=\"0 0 200 200\">{}</svg>",
                    shape.replace("/>", " style=\"&st0;\"/>")
                ),
            ),
            (
                "an svg: prefix",
                format!(
                    "<svg:svg xmlns:svg=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 200 200\">\n  <svg:{}\n</svg:svg>",
                    &shape[1..]
                ),
            ),
            ("no SVG namespace", format!("<svg viewBox=\"0 0 200 200\">{shape}</svg>")),
            (
                "our prefix bound to another namespace",
                format!(
                    "{open} xmlns:rinceau=\"http://example.com/carving\" xmlns:inkscape=\"urn:a\" xmlns:sodipodi=\"urn:b\"><g rinceau:role=\"oak\" rinceau:result=\"beech\">{shape}</g></svg>"
                ),
            ),
            ("our namespace under another prefix", format!("{open} xmlns:o=\"{RINCEAU}\">{marked}</svg>")),
            (
                "our namespace declared on the object",
                format!(
                    "{open}>{}</svg>",
                    marked.replace("<circle", &format!("<circle xmlns:o=\"{RINCEAU}\""))
                ),
            ),
            (
                "comments and instructions after the end",
                format!("{open}>{shape}</svg>\n<!-- </svg> -->\n<?end of=\"it\"?>\n"),
            ),
            ("a closing tag with spaces", format!("{open}>{shape}</svg  \n>")),
            (
                "misleading text",
                format!(
                    "{open} data-a=\"/svg>\" data-b='>'><!-- </svg> --><style><![CDATA[</svg>]]></style>{shape}</svg>"
                ),
            ),
            ("an id with a space", format!("{open}>{}</svg>", shape.replace("sun", "my sun"))),
            (
                "ids that ours could meet",
                format!("{open}><g id=\"ornament-sun\"/><g id=\"ornament-sun_2-elements-1\"/>{shape}</svg>"),
            ),
        ]
    }

    #[test]
    fn are_in_the_encoding_of_the_drawing() {
        let drawing = |encoding: &str| {
            format!(
                "<?xml version=\"1.0\" encoding=\"{encoding}\"?>\n{}",
                svg(&format!("<title>Blüte</title>{CIRCLE}"))
            )
        };
        let utf16 = |text: &str, unit: fn(u16) -> [u8; 2]| -> Vec<u8> {
            format!("\u{feff}{text}").encode_utf16().flat_map(unit).collect()
        };
        let utf16_text = |bytes: &[u8], unit: fn([u8; 2]) -> u16| {
            let units: Vec<u16> = bytes.chunks(2).map(|pair| unit([pair[0], pair[1]])).collect();
            String::from_utf16(&units).unwrap().trim_start_matches('\u{feff}').to_owned()
        };
        let before = drawing("UTF-16");
        let after = packed(utf16(&before, u16::to_le_bytes), &[]);
        assert_only_a_layer_was_added(&before, &utf16_text(&after, u16::from_le_bytes), "UTF-16 LE");
        let after = packed(utf16(&before, u16::to_be_bytes), &[]);
        assert_only_a_layer_was_added(&before, &utf16_text(&after, u16::from_be_bytes), "UTF-16 BE");

        let before = drawing("ISO-8859-1");
        let latin1 = |text: &str| -> Vec<u8> { text.chars().map(|c| u8::try_from(c).unwrap()).collect() };
        let after = packed(latin1(&before), &[]);
        let after: String = after.into_iter().map(char::from).collect();
        assert_only_a_layer_was_added(&before, &after, "ISO 8859-1");
    }

    /// A label that the drawing's encoding lacks is written as a reference.
    #[test]
    fn of_names_survive_any_encoding() {
        let text = format!(
            "<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>\n<svg xmlns:i=\"{INKSCAPE}\"><circle i:label=\"&#x82b1;\u{fc}&quot;&lt;\" class=\"rinceau-container\" cx=\"50\" cy=\"50\" r=\"50\"/></svg>"
        );
        let bytes: Vec<u8> = text.chars().map(|c| u8::try_from(c).unwrap()).collect();
        let after: String = packed(bytes, &[]).into_iter().map(char::from).collect();
        let xml = parse(&after);
        assert_eq!(layers(&xml)[0].attribute((INKSCAPE, "label")), Some("Ornament - 花ü\"<"));
    }

    #[test]
    fn are_the_same_in_every_run() {
        let drawing = std::fs::read(root().join("samples/pack/heart.svg")).unwrap();
        let flags = ["--seed", "5"];
        let once = packed(drawing.clone(), &flags);
        assert!(once == packed(drawing.clone(), &flags), "two runs differ");
        assert!(once == packed(once.clone(), &flags), "a run over its own result differs");
        assert!(once != packed(drawing, &["--seed", "6"]), "the seed changes nothing");
    }

    #[test]
    fn zipped_come_in_and_go_out() {
        let folder = folder();
        let input = file(&folder, "in.svgz", gzip(svg(CIRCLE).as_bytes()));
        let output = folder.path().join("out.SVGZ");
        rinceau(["pack"]).arg(&input).arg("-o").arg(&output).succeed();
        let zipped = std::fs::read(&output).unwrap();
        assert!(zipped.starts_with(&[0x1f, 0x8b]));
        let after = String::from_utf8(gunzip(&zipped)).unwrap();
        assert_only_a_layer_was_added(&svg(CIRCLE), &after, "svgz");
        // Over itself: no time and no name is in the file, so it stays as it is.
        rinceau(["pack"]).arg(&output).arg("-o").arg(&output).succeed();
        assert!(std::fs::read(&output).unwrap() == zipped);
        // A name that says svg gets svg.
        let plain = folder.path().join("out.svg");
        rinceau(["pack"]).arg(&input).arg("-o").arg(&plain).succeed();
        assert_eq!(std::fs::read_to_string(plain).unwrap(), after);
    }
}

mod files {
    use super::*;

    #[test]
    fn may_be_standard_streams() {
        let once = packed(svg(CIRCLE), &[]);
        assert_eq!(rinceau(["pack"]).input(svg(CIRCLE)).succeed().stdout, once);
        assert_eq!(rinceau(["pack", "-", "-o", "-"]).input(svg(CIRCLE)).succeed().stdout, once);
        let folder = folder();
        let input = file(&folder, "in.svg", svg(CIRCLE));
        let done = rinceau(["pack"]).arg(&input).succeed();
        assert_eq!(done.stdout, once);
        assert_eq!(done.stderr, "", "not a word on success");
        rinceau(["pack"]).arg(&input).args(&["-o", "/dev/stdout"]).succeed();
    }

    #[test]
    fn may_be_written_over() {
        let folder = folder();
        let path = file(&folder, "drawing.svg", svg(CIRCLE));
        std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o640)).unwrap();
        rinceau(["pack"]).arg(&path).arg("-o").arg(&path).succeed();
        assert_only_a_layer_was_added(&svg(CIRCLE), &std::fs::read_to_string(&path).unwrap(), "over itself");
        assert_eq!(std::fs::metadata(&path).unwrap().mode() & 0o7777, 0o640, "permissions");
        assert_eq!(folder.path().read_dir().unwrap().count(), 1, "a temporary file was left");
    }

    #[test]
    fn keep_the_link_they_are_reached_through() {
        let folder = folder();
        let target = file(&folder, "target.svg", "older");
        let link = folder.path().join("link.svg");
        symlink("target.svg", &link).unwrap();
        rinceau(["pack", "-o"]).arg(&link).input(svg(CIRCLE)).succeed();
        assert_eq!(std::fs::read_link(&link).unwrap(), Path::new("target.svg"));
        assert_only_a_layer_was_added(
            &svg(CIRCLE),
            &std::fs::read_to_string(&target).unwrap(),
            "through a link",
        );

        // A link to a file that is yet to be.
        let dangling = folder.path().join("dangling.svg");
        symlink("new.svg", &dangling).unwrap();
        rinceau(["pack", "-o"]).arg(&dangling).input(svg(CIRCLE)).succeed();
        assert_eq!(std::fs::read_link(&dangling).unwrap(), Path::new("new.svg"));
        assert!(folder.path().join("new.svg").exists());
    }

    /// A new file gets the permissions the user's mask gives to any.
    #[test]
    fn that_are_new_follow_the_umask() {
        let folder = folder();
        let output = folder.path().join("out.svg");
        let mut shell = Command::new("bash");
        shell
            .args(["-c", "umask 027 && exec \"$@\"", "bash"])
            .arg(binary())
            .args(["pack", "-o"])
            .arg(&output);
        Run::of(shell).input(svg(CIRCLE)).succeed();
        assert_eq!(std::fs::metadata(&output).unwrap().mode() & 0o777, 0o640);
    }

    /// Nothing stops root, so root becomes nobody for this.
    #[test]
    fn in_a_read_only_folder_are_an_error() {
        let folder = folder();
        let program = folder.path().join("rinceau");
        std::fs::copy(binary(), &program).unwrap();
        let locked = folder.path().join("locked");
        std::fs::create_dir(&locked).unwrap();
        let present = locked.join("present.svg");
        std::fs::write(&present, "older").unwrap();
        std::fs::set_permissions(&locked, std::fs::Permissions::from_mode(0o555)).unwrap();
        for output in [locked.join("absent.svg"), present.clone()] {
            let mut command = Command::new(&program);
            command.args(["pack", "-o"]).arg(&output);
            let is_root = std::fs::metadata("/proc/self").unwrap().uid() == 0;
            if is_root {
                const NOBODY: u32 = 65534;
                std::os::unix::process::CommandExt::uid(&mut command, NOBODY);
            }
            let done = Run::of(command).input(svg(CIRCLE)).done();
            assert_eq!(done.code, Some(1), "{}", done.stderr);
            assert!(done.stderr.ends_with("[cannot-write]\n"), "{}", done.stderr);
        }
        assert_eq!(std::fs::read(&present).unwrap(), b"older");
        assert!(!locked.join("absent.svg").exists());
        std::fs::set_permissions(&locked, std::fs::Permissions::from_mode(0o755)).unwrap();
    }

    /// Whatever fails, whenever the program dies: the file under the name is the old one or
    /// the new one, whole.
    #[test]
    fn are_whole_or_as_they_were() {
        // The first write is the drawing's; a message to standard error would be a later one.
        let faults = [
            "write:error=ENOSPC:when=1",
            "write:error=EIO:when=1",
            "fchmod:error=EPERM",
            "fsync:error=EIO",
            "?rename,?renameat,?renameat2:error=ENOSPC",
            "write:signal=KILL:when=1",
            "fchmod:signal=KILL",
            "fsync:signal=KILL",
            "?rename,?renameat,?renameat2:signal=KILL",
        ];
        for fault in faults {
            let folder = folder();
            let path = file(&folder, "drawing.svg", svg(CIRCLE));
            let mut strace = Command::new("strace");
            strace.args(["-f", "-qq", "-o", "/dev/null"]);
            strace.arg("-e").arg(format!("inject={fault}"));
            strace.arg(binary()).arg("pack").arg(&path).arg("-o").arg(&path);
            let done = Run::of(strace).done();
            let after = std::fs::read_to_string(&path).unwrap();
            if fault.contains("KILL") {
                assert_eq!(done.code, None, "{fault} did not happen: {}", done.stderr);
                // The signal may come while the call is done or before.
                if after != svg(CIRCLE) {
                    assert_only_a_layer_was_added(&svg(CIRCLE), &after, fault);
                }
            } else {
                assert_eq!(done.code, Some(1), "{fault}: {}", done.stderr);
                assert!(done.stderr.ends_with("[cannot-write]\n"), "{fault}: {}", done.stderr);
                assert_eq!(after, svg(CIRCLE), "{fault}");
                assert_eq!(
                    folder.path().read_dir().unwrap().count(),
                    1,
                    "{fault}: a temporary file was left"
                );
            }
        }
    }

    /// Two runs on one file at once: one of the two results, whole.
    #[test]
    fn survive_two_runs_at_once() {
        let folder = folder();
        let path = file(&folder, "drawing.svg", svg(CIRCLE));
        std::thread::scope(|scope| {
            for seed in ["1", "2"] {
                let path = &path;
                scope.spawn(move || {
                    rinceau(["pack", "--seed", seed]).arg(path).arg("-o").arg(path).succeed();
                });
            }
        });
        assert_only_a_layer_was_added(&svg(CIRCLE), &std::fs::read_to_string(&path).unwrap(), "at once");
    }
}

mod layer {
    use super::*;

    #[test]
    fn says_what_made_it() {
        let text = packed_text(svg(CIRCLE), &["--seed", "7", "--spacing", "15", "--elements", "leaves"]);
        let xml = parse(&text);
        let layer = layers(&xml)[0];
        let ours = |name| layer.attribute((RINCEAU, name));
        assert_eq!(ours("result"), Some("pack"));
        assert_eq!(ours("seed"), Some("7"));
        assert_eq!(ours("source"), Some("sun"));
        let params: serde_json::Value = serde_json::from_str(ours("params").unwrap()).unwrap();
        assert_eq!(params, serde_json::json!({ "elements": "leaves", "spacing": "15" }));
        assert_eq!(layer.attribute((INKSCAPE, "groupmode")), Some("layer"));
        assert_eq!(layer.attribute((INKSCAPE, "label")), Some("Ornament - sun"));
    }

    /// Inkscape's merge is quadratic in siblings, and every id in a drawing must be its own.
    #[test]
    fn has_few_siblings_and_its_own_ids() {
        let text = packed_text(svg(CIRCLE), &["--spacing", "4"]);
        let xml = parse(&text);
        assert!(elements(layers(&xml)[0]).len() > 200, "the test needs more elements");
        let mut ids: Vec<&str> = xml.descendants().filter_map(|node| node.attribute("id")).collect();
        for node in layers(&xml)[0].descendants() {
            assert!(node.children().filter(Node::is_element).count() <= 200);
        }
        let all = ids.len();
        ids.sort_unstable();
        ids.dedup();
        assert_eq!(ids.len(), all, "an id stands twice");
        let hidden =
            layers(&xml)[0].children().find(|node| node.attribute((INKSCAPE, "label")) == Some("spines"));
        assert_eq!(hidden.unwrap().attribute("style"), Some("display:none"));
    }

    /// What an artist did to the layer stays when it is made anew.
    #[test]
    fn keeps_what_was_edited_when_it_is_replaced() {
        let first = packed_text(svg(CIRCLE), &["--seed", "1"]);
        let edited = first
            .replacen("id=\"ornament-sun\"", "id=\"filigree\" transform=\"translate(40,0) scale(2)\" style=\"opacity:0.5\" sodipodi:insensitive=\"true\"", 1)
            .replacen("Ornament - sun", "My filigree", 1);
        assert_ne!(edited, first);
        let second = packed_text(edited.as_str(), &["--seed", "2"]);
        let xml = parse(&second);
        let [layer] = layers(&xml)[..] else { panic!("{} layers", layers(&xml).len()) };
        assert_eq!(layer.attribute("id"), Some("filigree"));
        assert_eq!(layer.attribute((INKSCAPE, "label")), Some("My filigree"));
        assert_eq!(layer.attribute("transform"), Some("translate(40,0) scale(2)"));
        assert_eq!(layer.attribute("style"), Some("opacity:0.5"));
        assert_eq!(layer.attribute((SODIPODI, "insensitive")), Some("true"));
        assert_eq!(layer.attribute((RINCEAU, "seed")), Some("2"));
        assert!(elements(layer).len() > 10);
        assert!(
            elements(layer).iter().all(|element| element.attribute("id").unwrap().starts_with("filigree-"))
        );

        // On the canvas the ornament has not moved: its points went through the inverse.
        let direct = packed_text(svg(CIRCLE), &["--seed", "2"]);
        let first_point = |text: &str| {
            let xml = parse(text);
            let path = elements(layers(&xml)[0])[0];
            let path = path.descendants().find_map(|node| node.attribute("d")).unwrap().to_owned();
            let (x, rest) = path[1..].split_once(',').unwrap();
            let y = rest.split(|c: char| c.is_ascii_alphabetic() || c == ' ').next().unwrap();
            (x.parse::<f64>().unwrap(), y.parse::<f64>().unwrap())
        };
        let (there, here) = (first_point(&direct), first_point(&second));
        assert!((there.0 - (2.0 * here.0 + 40.0)).abs() < 0.01, "{there:?} {here:?}");
        assert!((there.1 - 2.0 * here.1).abs() < 0.01, "{there:?} {here:?}");
    }

    /// A layer in a group that Inkscape moved, and under other declarations.
    #[test]
    fn is_found_wherever_it_was_put() {
        let first = packed_text(svg(CIRCLE), &[]);
        let xml = parse(&first);
        let range = layers(&xml)[0].range();
        let moved = format!(
            "{}<g id=\"moved\" transform=\"rotate(90)\">{}</g>{}",
            &first[..range.start],
            &first[range.clone()],
            &first[range.end..]
        );
        let second = packed_text(moved.as_str(), &["--seed", "2"]);
        let xml = parse(&second);
        assert_eq!(layers(&xml).len(), 1);
        assert_eq!(layers(&xml)[0].parent().unwrap().attribute("id"), Some("moved"));
        // And the same once more changes nothing.
        assert_eq!(packed_text(second.as_str(), &["--seed", "2"]), second);
    }

    #[test]
    fn of_other_shapes_stays() {
        let two = "<circle id=\"a\" cx=\"50\" cy=\"50\" r=\"40\"/><circle id=\"b\" cx=\"150\" cy=\"150\" r=\"40\"/>";
        let first = packed_text(svg(two), &["--id", "a"]);
        let second = packed_text(first.as_str(), &["--id", "b"]);
        let xml = parse(&second);
        let sources: Vec<_> = layers(&xml).iter().map(|layer| layer.attribute((RINCEAU, "source"))).collect();
        assert_eq!(sources, [Some("a"), Some("b")]);
    }
}

mod marks {
    use super::*;

    const ROLES: [&str; 15] = [
        "container",
        "guide",
        "fixed",
        "fixed-spine",
        "stem",
        "seed",
        "element",
        "spine",
        "form",
        "clone",
        "tack",
        "reference",
        "boundary",
        "spray",
        "rules",
    ];

    fn marked(drawing: &str, role: &str) -> String {
        rinceau(["mark", role, "--id", "it"]).input(drawing).succeed().text().to_owned()
    }

    #[test]
    fn of_every_role_are_set_and_cleared() {
        let plain = svg(
            "<path id=\"it\" class=\"mine\" style=\"fill:#abcdef;stroke-width:3\" d=\"M0,0 H90 V90 Z\"/>",
        );
        for role in ROLES {
            let with = marked(&plain, role);
            let xml = parse(&with);
            let node = by_id(&xml, "it");
            assert_eq!(node.attribute((RINCEAU, "role")), Some(role));
            assert_eq!(node.attribute("class"), Some(format!("mine rinceau-{role}").as_str()));
            assert!(node.attribute("style").unwrap().contains("stroke-width:3"), "{role}");
            assert_eq!(marked(&with, role), with, "{role}: marking twice changes something");

            let without = marked(&with, "none");
            let xml = parse(&without);
            let node = by_id(&xml, "it");
            assert_eq!(node.attribute((RINCEAU, "role")), None);
            assert_eq!(node.attribute("class"), Some("mine"));
            assert_eq!(marked(&without, "none"), without, "{role}: clearing twice changes something");
        }
    }

    /// Colours after the papers' diagrams.
    #[test]
    fn have_colours() {
        let plain = svg("<path id=\"it\" d=\"M0,0 H90 V90 Z\"/>");
        let style = |role| {
            let text = marked(&plain, role);
            by_id(&parse(&text), "it").attribute("style").unwrap_or_default().to_owned()
        };
        assert_eq!(style("container"), "fill:none;stroke:#000000");
        assert_eq!(style("guide"), "fill:none;stroke:#ff0000;marker-end:url(#rinceau-arrow)");
        assert_eq!(style("fixed"), "", "what is fixed is part of the picture");
        assert_eq!(style("element"), "");
        let text = marked(&plain, "guide");
        assert_eq!(by_id(&parse(&text), "rinceau-arrow").tag_name().name(), "marker");
    }

    /// Marks that are cleared leave an object as it was; what was changed meanwhile stays changed.
    #[test]
    fn give_the_look_back() {
        let drawn =
            "<path id=\"it\" fill=\"#123456\" style=\"fill: #d40000; stroke:none\" d=\"M0,0 H90 V90 Z\"/>\n";
        let plain = svg(drawn);
        let none = |text: &str| text.replace(" xmlns:rinceau=\"urn:rinceau:1\"", "");
        for role in ["container", "guide", "fixed", "stem", "seed", "boundary", "fixed-spine"] {
            let with = marked(&plain, role);
            assert_eq!(none(&marked(&with, "none")), none(&plain), "{role}");
            let twice = marked(&marked(&with, "guide"), "container");
            assert_eq!(none(&marked(&twice, "none")), none(&plain), "{role}, guide, container");
        }
        let changed = marked(&plain, "guide").replace("stroke:#ff0000", "stroke:#abcdef;stroke-width:3");
        let cleared = marked(&changed, "none");
        let style = by_id(&parse(&cleared), "it").attribute("style").unwrap().to_owned();
        assert_eq!(style, "stroke:#abcdef;stroke-width:3;fill:#d40000");
        assert!(!cleared.contains("rinceau-arrow") && !cleared.contains("own-style"));
    }

    /// A guide that was red before it was marked keeps its arrow head when the mark is cleared.
    #[test]
    fn without_a_style_kept_leave_the_arrow_on() {
        let marked = marked(&svg("<path id=\"it\" style=\"fill:none\" d=\"M0,0 H90\"/>"), "guide");
        let start = marked.find(" rinceau:own-style").unwrap();
        let end = start + marked[start..].find("\"fill:none\"").unwrap() + "\"fill:none\"".len();
        let old = format!("{}{}", &marked[..start], &marked[end..]);
        let cleared = self::marked(&old, "none");
        let xml = parse(&cleared);
        assert!(by_id(&xml, "it").attribute("style").unwrap().contains("#rinceau-arrow"));
        assert_eq!(by_id(&xml, "rinceau-arrow").tag_name().name(), "marker");
    }

    /// One role after the other: the last counts, and no trace of the first stays.
    #[test]
    fn replace_each_other() {
        let plain = svg("<path id=\"it\" d=\"M0,0 H90 V90 Z\"/>");
        let text = marked(&marked(&plain, "guide"), "container");
        let xml = parse(&text);
        let node = by_id(&xml, "it");
        assert_eq!(node.attribute((RINCEAU, "role")), Some("container"));
        assert_eq!(node.attribute("class"), Some("rinceau-container"));
        assert!(!node.attribute("style").unwrap().contains("marker-end"), "an arrow head on an outline");
    }

    /// Bytes outside the object, the root's declaration and the arrow head stay.
    #[test]
    fn change_nothing_else() {
        let folder = root().join("samples/pack/heart.svg");
        let before = std::fs::read_to_string(folder).unwrap();
        let id = by_id_of_first(&before, "container");
        let after = rinceau(["mark", "none", "--id", &id]).input(before.as_str()).succeed().text().to_owned();
        let (old, new) = (parse(&before), parse(&after));
        let (old, new) = (by_id(&old, &id).range(), by_id(&new, &id).range());
        assert_eq!(before[..old.start], after[..new.start]);
        assert_eq!(before[old.end..], after[new.end..]);
    }

    fn by_id_of_first(text: &str, role: &str) -> String {
        let xml = parse(text);
        let node = xml.descendants().find(|node| node.attribute((RINCEAU, "role")) == Some(role));
        node.and_then(|node| node.attribute("id")).expect("a marked object").to_owned()
    }

    /// Our prefix may be somebody else's.
    #[test]
    fn find_a_prefix() {
        let plain = "<svg xmlns='http://www.w3.org/2000/svg' xmlns:rinceau='urn:other'><path id='it' rinceau:role='x' d='M0,0 H90 V90 Z'/></svg>";
        let text = marked(plain, "container");
        let xml = parse(&text);
        assert_eq!(by_id(&xml, "it").attribute((RINCEAU, "role")), Some("container"));
        assert_eq!(by_id(&xml, "it").attribute(("urn:other", "role")), Some("x"));
        let plain =
            format!("<svg xmlns='http://www.w3.org/2000/svg' xmlns:o='{RINCEAU}'><path id='it'/></svg>");
        assert!(marked(&plain, "guide").contains("o:role=\"guide\""));
    }

    #[test]
    fn are_what_pack_reads() {
        let plain =
            svg("<rect id=\"it\" width=\"150\" height=\"90\"/>\n<path id=\"flow\" d=\"M0,45 H150\"/>");
        let text = marked(&plain, "container");
        let text = rinceau(["mark", "guide", "--id", "flow"]).input(text).succeed().text().to_owned();
        let report = rinceau(["check"]).input(text.as_str()).succeed().text().to_owned();
        insta::assert_snapshot!(report, @"
        page 200.00 x 200.00, one unit is 1.0000 px
        2:1: container 'it'
        3:1: guide 'flow'
        ");
        assert!(elements(layers(&parse(&packed_text(text, &[])))[0]).len() > 10);
    }
}

mod check {
    use super::*;

    #[test]
    fn lists_what_is_marked() {
        let before = std::fs::read_to_string(root().join("samples/pack/heart.svg")).unwrap();
        let report = rinceau(["check"]).input(before.as_str()).succeed().text().to_owned();
        let xml = parse(&before);
        for role in ["container", "guide", "element", "fixed"] {
            let marked = xml.descendants().filter(|node| node.attribute((RINCEAU, "role")) == Some(role));
            assert_eq!(report.matches(&format!(": {role} '")).count(), marked.count(), "{role}:\n{report}");
        }
    }

    #[test]
    fn says_what_is_doubtful() {
        let drawing = svg(
            "<circle id=\"sun\" class=\"rinceau-container\" rinceau:role=\"guide\" r=\"50\"/>\n<g id=\"leaf\" class=\"rinceau-element\"><path d=\"M0,0 9,9 0,9Z\"/></g>\n<path id=\"lost\" class=\"rinceau-spine\" d=\"M0,0H9\"/>",
        );
        insta::assert_snapshot!(rinceau(["check"]).input(drawing).succeed().text(), @"
        page 200.00 x 200.00, one unit is 1.0000 px
        2:1: guide 'sun'
        3:1: element 'leaf'
        nothing is marked as container. Select a closed shape when you run a generator, or mark one.
        2:44: rinceau:role says 'guide' but the class at 2:18 says 'container'; the attribute is used
        3:1: the element 'leaf' has no spine, so nothing can place it. Draw a straight line from its base to its tip in its group, and mark that as spine.
        4:1: the spine 'lost' is in no element and is not used
        ");
        insta::assert_snapshot!(rinceau(["check"]).input(svg("")).succeed().text(), @"
        page 200.00 x 200.00, one unit is 1.0000 px
        nothing is marked as container. Select a closed shape when you run a generator, or mark one.
        ");
    }

    #[test]
    fn names_results() {
        let text = packed_text(svg(CIRCLE), &[]);
        insta::assert_snapshot!(rinceau(["check"]).input(text).succeed().text(), @"
        page 200.00 x 200.00, one unit is 1.0000 px
        2:1: container 'sun'
        result of pack over sun
        ");
    }

    #[test]
    fn fails_on_what_cannot_be_used() {
        let done = rinceau(["check"]).input(svg("<g rinceau:role=\"oak\"/>")).done();
        assert_eq!(done.code, Some(1));
        assert!(done.text().contains("2:1: error: 'oak' is not a role"), "{}", done.text());
        assert!(done.stderr.ends_with("[problems]\n"), "{}", done.stderr);
    }
}

mod report {
    use super::*;
    use serde_json::Value;

    /// A dash is standard output, as for drawings, but not for both of them.
    #[test]
    fn goes_to_standard_output_for_a_dash() {
        let folder = folder();
        let out = folder.path().join("out.svg");
        let done = rinceau(["pack", "--report", "-", "-o"]).arg(&out).input(svg(CIRCLE)).succeed();
        let report: Value = serde_json::from_str(done.text()).unwrap();
        assert_eq!(report["generator"], "pack");
        assert!(out.exists() && !std::path::Path::new("-").exists());
        let both = rinceau(["pack", "--report", "-"]).input(svg(CIRCLE)).done();
        assert_eq!((both.code, both.text()), (Some(1), ""));
        assert!(both.stderr.contains("[bad-parameter]"), "{}", both.stderr);
    }

    fn report(flags: &[&str]) -> (Value, String) {
        let folder = folder();
        let path = folder.path().join("report.json");
        let done = rinceau(["pack", "--report"]).arg(&path).args(flags).input(svg(CIRCLE)).succeed();
        let report = serde_json::from_slice(&std::fs::read(&path).unwrap()).unwrap();
        (report, done.text().to_owned())
    }

    #[test]
    fn has_every_field() {
        let (report, text) = report(&["--seed", "3", "--spacing", "20"]);
        assert_eq!(report["generator"], "pack");
        assert_eq!(report["params"], serde_json::json!({ "spacing": "20" }));
        assert_eq!(report["seed"], 3);
        assert_eq!(report["complete"], true);
        assert_eq!(report["warnings"], serde_json::json!([]));
        let count = elements(layers(&parse(&text))[0]).len();
        assert_eq!(report["counts"]["elements"].as_f64(), Some(count as f64));
        let stages = report["milliseconds"].as_object().expect("milliseconds by stage");
        let sum: f64 = stages.values().map(|ms| ms.as_f64().expect("a number")).sum();
        let total = report["milliseconds_total"].as_f64().unwrap();
        assert!(stages.len() > 3 && sum > 0.0 && sum <= total + 1.0, "{report}");
    }

    /// Running out of time is a result: a valid drawing, marked incomplete. Before the first
    /// element is in place it is a sentence, and nothing is written.
    #[test]
    fn says_when_time_ran_out() {
        let folder = folder();
        let report = folder.path().join("report.json");
        let run = |limit: f64| {
            let limit = limit.to_string();
            let flags =
                ["pack", "--spacing", "3", "--time-limit", &limit, "--report", report.to_str().unwrap()];
            rinceau(flags).input(svg(CIRCLE)).done()
        };
        let done = run(1e-6);
        assert!(done.code == Some(1) && done.stderr.contains("[out-of-time]"), "{}", done.stderr);
        assert!(!report.exists() && done.stdout.is_empty());
        // Longer and longer, until there was time to begin but not to end.
        let mut limit = 0.02;
        let partial = loop {
            let done = run(limit);
            if done.code == Some(0) {
                break done;
            }
            assert!(done.stderr.contains("[out-of-time]") && limit < 60.0, "{}", done.stderr);
            limit *= 1.5;
        };
        let report: Value = serde_json::from_slice(&std::fs::read(&report).unwrap()).unwrap();
        assert_eq!(report["complete"], false);
        assert_only_a_layer_was_added(&svg(CIRCLE), partial.text(), "out of time");
    }
}

mod time_limit {
    use super::*;

    /// The window that waits for an extension is frozen, so every stage must stop in time.
    #[test]
    fn holds_in_a_drawing_of_many_elements() {
        let done = rinceau(["pack", "--spacing", "0.8", "--time-limit", "0.2"]).input(svg(CIRCLE)).done();
        assert!(done.code == Some(0) || done.stderr.contains("[out-of-time]"), "{}", done.stderr);
        assert!(done.time.as_secs_f64() < 20.0, "{:?}", done.time);
    }
}

mod units {
    use super::*;

    /// The same square of 100 mm, drawn in millimetres and in px.
    fn square(view: f64) -> String {
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"100mm\" height=\"100mm\" viewBox=\"0 0 {view} {view}\"><rect id=\"r\" class=\"rinceau-container\" width=\"{view}\" height=\"{view}\"/></svg>"
        )
    }

    fn count(view: f64, spacing: &str) -> usize {
        elements(layers(&parse(&packed_text(square(view), &["--spacing", spacing])))[0]).len()
    }

    #[test]
    fn of_lengths_mean_the_same_in_every_drawing() {
        const PX: f64 = 377.952_755_905_511_8;
        let in_mm = count(100.0, "8mm");
        let in_px = count(PX, "8mm");
        // Rounding of coordinates may tip a single choice.
        assert!(in_mm.abs_diff(in_px) <= 1 + in_mm / 20, "{in_mm} in mm, {in_px} in px");
        assert_eq!(count(100.0, "8"), in_mm, "a bare number is in user units, here mm");
        assert_eq!(count(100.0, "0.8cm"), in_mm);
        assert!(count(PX, "8px") > 5 * in_px, "8 px are 2.1 mm");
    }
}

mod selection {
    use super::*;

    const PLAIN: &str = "<circle id=\"sun\" cx=\"100\" cy=\"100\" r=\"80\"/>\n<path id=\"flow\" d=\"M20,100 H180\"/>\n<rect id=\"other\" x=\"0\" y=\"0\" width=\"9\" height=\"9\"/>";

    #[test]
    fn needs_no_marks() {
        let text = packed_text(svg(PLAIN), &["--id", "sun"]);
        let xml = parse(&text);
        assert_eq!(layers(&xml)[0].attribute((RINCEAU, "source")), Some("sun"));
        assert!(elements(layers(&xml)[0]).len() > 10);
    }

    /// What is painted inside is a shape, whether or not its ends meet.
    #[test]
    fn of_an_open_path_with_a_fill_is_a_shape() {
        let wing = "<path id=\"wing\" style=\"fill:#222222\" d=\"M20,20 C80,0 150,40 180,120 C120,100 80,120 40,180\"/>";
        let text = packed_text(svg(wing), &["--id", "wing"]);
        assert!(elements(layers(&parse(&text))[0]).len() > 10);
        let line = svg(&wing.replace("#222222", "none"));
        let failed = rinceau(["pack", "--id", "wing"]).input(line.as_str()).done();
        assert_eq!(failed.code, Some(1));
        assert!(failed.stderr.contains("[no-container]"), "{}", failed.stderr);
    }

    /// A selected open line leads the flow: along the line most spines run its way.
    #[test]
    fn of_an_open_path_is_a_guide() {
        let level = |ids: &[&str]| {
            let flags: Vec<&str> = ids.iter().flat_map(|id| ["--id", id]).collect();
            let text = packed_text(svg(PLAIN), &flags);
            let xml = parse(&text);
            assert_eq!(layers(&xml)[0].attribute((RINCEAU, "source")), Some("sun"));
            let spines =
                layers(&xml)[0].children().find(|node| node.attribute((INKSCAPE, "label")) == Some("spines"));
            let spines: Vec<(f64, f64)> = spines
                .expect("a sublayer of spines")
                .descendants()
                .filter_map(|node| node.attribute("d"))
                .map(run_and_rise)
                .collect();
            spines.iter().filter(|(run, rise)| rise.abs() < 0.3 * run.abs()).count() as f64
                / spines.len() as f64
        };
        let (with, without) = (level(&["sun", "flow"]), level(&["sun"]));
        assert!(
            with > 0.8 && without < 0.6,
            "{with} of the spines are level with the guide, {without} without"
        );
    }

    /// From the first point of path data to the last.
    fn run_and_rise(data: &str) -> (f64, f64) {
        let numbers: Vec<f64> = data
            .split(|c: char| c.is_ascii_alphabetic() || c == ',' || c == ' ')
            .filter_map(|text| text.parse().ok())
            .collect();
        let n = numbers.len();
        (numbers[n - 2] - numbers[0], numbers[n - 1] - numbers[1])
    }

    /// Of marked shapes only the selected are filled.
    #[test]
    fn narrows_marked_containers() {
        let two = "<circle id=\"a\" class=\"rinceau-container\" cx=\"50\" cy=\"50\" r=\"40\"/><circle id=\"b\" class=\"rinceau-container\" cx=\"150\" cy=\"150\" r=\"40\"/>";
        let source = |flags: &[&str]| {
            let text = packed_text(svg(two), flags);
            layers(&parse(&text))[0].attribute((RINCEAU, "source")).unwrap().to_owned()
        };
        assert_eq!(source(&[]), "a b");
        assert_eq!(source(&["--id", "b"]), "b");
    }
}

mod opened {
    use super::*;

    /// Nothing is opened but the input, the output's folder and what every program needs; a
    /// drawing's links lead nowhere.
    #[test]
    fn files_are_the_input_and_the_output() {
        let folder = folder();
        let secret = file(&folder, "secret.svg", svg(CIRCLE));
        let body = format!(
            "<style>@import url('file:///etc/passwd'); @font-face {{ font-family: x; src: url({secret}) }}</style>\n<image href=\"file:///etc/passwd\" width=\"9\" height=\"9\"/><image href=\"http://example.invalid/a.png\" width=\"9\" height=\"9\"/>\n<g class=\"rinceau-container\"><use href=\"{secret}#sun\"/><use href=\"secret.svg#sun\"/><use href=\"http://example.invalid/a.svg#b\"/><image href=\"../../../../etc/passwd\" width=\"150\" height=\"150\"/></g>\n<xi:include xmlns:xi=\"http://www.w3.org/2001/XInclude\" href=\"secret.svg\"/>",
            secret = secret.display()
        );
        let drawing = svg(&body).replacen(
            "<svg",
            "<?xml-stylesheet href=\"secret.css\"?>\n<!DOCTYPE svg SYSTEM \"file:///etc/passwd\" [<!ENTITY % p SYSTEM \"secret.svg\"> <!ENTITY e SYSTEM \"secret.svg\">]>\n<svg",
            1,
        );
        let input = file(&folder, "in.svg", drawing);
        let output = folder.path().join("out.svg");
        let trace = folder.path().join("trace.txt");
        let mut strace = Command::new("strace");
        strace
            .args(["-f", "-qq", "-e", "trace=open,openat,openat2,creat,connect,execve,socket", "-o"])
            .arg(&trace);
        strace.arg(binary()).arg("pack").arg(&input).arg("-o").arg(&output).current_dir(folder.path());
        // Cargo's, which sends every program through its own folders.
        strace.env_remove("LD_LIBRARY_PATH");
        Run::of(strace).succeed();
        let trace = std::fs::read_to_string(trace).unwrap();
        let opened = opened_paths(&trace, folder.path());
        let strangers: Vec<&PathBuf> = opened
            .iter()
            .filter(|path| {
                !is_of_every_program(path) && **path != input && !is_temporary(path, folder.path())
            })
            .collect();
        assert!(opened.contains(&input), "the trace misses the input:\n{trace}");
        assert!(strangers.is_empty(), "also opened: {strangers:?}\n{trace}");
        assert!(!trace.contains("socket(") && !trace.contains("connect("), "the network was used:\n{trace}");
        assert_eq!(trace.matches("execve(").count(), 1, "another program was started:\n{trace}");
    }

    /// Every path in calls that open, taken from the working directory.
    fn opened_paths(trace: &str, folder: &Path) -> Vec<PathBuf> {
        let opens = trace.lines().filter(|line| line.contains("open") || line.contains("creat("));
        opens.filter_map(|line| line.split('"').nth(1)).map(|path| folder.join(path)).collect()
    }

    /// Libraries, locale, and what the standard library asks the system.
    fn is_of_every_program(path: &Path) -> bool {
        ["/proc", "/sys", "/lib", "/lib64", "/usr/lib", "/usr/local/lib", "/usr/share/locale", "/dev"]
            .iter()
            .any(|folder| path.starts_with(folder))
            || path.to_string_lossy().starts_with("/etc/ld.so")
    }

    fn is_temporary(path: &Path, folder: &Path) -> bool {
        path.parent() == Some(folder)
            && path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(".rinceau-"))
    }
}

mod vines {
    use super::*;

    fn grown(drawing: impl Into<Vec<u8>>, flags: &[&str]) -> String {
        String::from_utf8(rinceau(["vine"]).args(flags).input(drawing).succeed().stdout).unwrap()
    }

    fn stems<'a, 'i>(xml: &'a roxmltree::Document<'i>) -> Vec<Node<'a, 'i>> {
        let is_stem = |node: &Node| matches!(node.attribute((RINCEAU, "of")), Some("stem" | "branch"));
        xml.descendants().filter(is_stem).collect()
    }

    #[test]
    fn grow_in_every_sample() {
        for sample in geometry::samples_of("vine") {
            let name = sample.display().to_string();
            let before = std::fs::read_to_string(&sample).unwrap();
            let after = grown(before.as_str(), &[]);
            assert_only_a_layer_was_added(&before, &after, &name);
            let xml = parse(&after);
            assert!(!stems(&xml).is_empty(), "{name}");
            assert_eq!(layers(&xml)[0].attribute((RINCEAU, "result")), Some("vine"));
            assert!(grown(after.as_str(), &[]) == after, "{name}: a second run changes something");
        }
    }

    #[test]
    fn have_ids_of_their_own_and_few_siblings() {
        let text = grown(svg(CIRCLE), &["--levels", "6", "--stem-width", "1"]);
        let xml = parse(&text);
        assert!(stems(&xml).len() > 200, "the test needs more stems");
        let mut ids: Vec<&str> = xml.descendants().filter_map(|node| node.attribute("id")).collect();
        let all = ids.len();
        ids.sort_unstable();
        ids.dedup();
        assert_eq!(ids.len(), all, "an id stands twice");
        for node in layers(&xml)[0].descendants() {
            assert!(node.children().filter(Node::is_element).count() <= 200);
        }
    }

    #[test]
    fn grow_in_what_is_named() {
        let two = svg(
            "<circle id=\"a\" cx=\"50\" cy=\"50\" r=\"40\"/><circle id=\"b\" cx=\"150\" cy=\"150\" r=\"40\"/>",
        );
        let text = grown(two, &["--id", "b", "--seed", "3", "--levels", "2"]);
        let xml = parse(&text);
        let [layer] = layers(&xml)[..] else { panic!("{} layers", layers(&xml).len()) };
        assert_eq!(layer.attribute((RINCEAU, "source")), Some("b"));
        assert_eq!(layer.attribute((RINCEAU, "seed")), Some("3"));
        let params: serde_json::Value =
            serde_json::from_str(layer.attribute((RINCEAU, "params")).unwrap()).unwrap();
        assert_eq!(params, serde_json::json!({ "levels": "2" }));
    }

    /// Whoever selects a line along with a shape means it to be the stem.
    #[test]
    fn follow_an_open_path_selected_with_the_shape() {
        let shape = "<rect id=\"a\" x=\"5\" y=\"5\" width=\"190\" height=\"190\"/>";
        let line = "<path id=\"way\" d=\"M20,30 L100,60 L180,30\" fill=\"none\"/>";
        let flags = ["--levels", "1", "--leaves", "0", "--tips", "none"];
        let selected =
            grown(svg(&format!("{shape}{line}")), &[&flags[..], &["--id", "a", "--id", "way"]].concat());
        let marked = line.replace("id=", "class=\"rinceau-stem\" id=");
        let marked = grown(svg(&format!("{shape}{marked}")), &[&flags[..], &["--id", "a"]].concat());
        let outlines = |text: &str| -> Vec<String> {
            stems(&parse(text)).iter().map(|stem| stem.attribute("d").unwrap().to_owned()).collect()
        };
        assert_eq!(outlines(&selected), outlines(&marked));
    }

    fn report(flags: &[&str]) -> serde_json::Value {
        let folder = folder();
        let path = folder.path().join("report.json");
        rinceau(["vine", "--report"]).arg(&path).args(flags).input(svg(CIRCLE)).succeed();
        serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
    }

    #[test]
    fn are_counted_and_timed() {
        let report = report(&["--seed", "2", "--plait", "true"]);
        assert_eq!(report["generator"], "vine");
        assert_eq!(report["seed"], 2);
        assert_eq!(report["complete"], true);
        assert!(report["counts"]["stems"].as_f64().unwrap() > 5.0, "{report}");
        assert!(report["counts"]["elements"].as_f64().unwrap() > 5.0, "{report}");
        assert!(report["counts"]["crossings"].is_number(), "{report}");
        for stage in ["cells", "stem", "branches", "leaves"] {
            assert!(report["milliseconds"][stage].is_number(), "{stage}: {report}");
        }
    }

    /// Whatever is there by then, or a sentence.
    #[test]
    fn end_when_the_time_does() {
        let folder = folder();
        let path = folder.path().join("report.json");
        let flags = ["--levels", "8", "--branches", "1000", "--stem-width", "0.05", "--time-limit", "0.001"];
        let done = rinceau(["vine", "--report"])
            .arg(&path)
            .args(&flags)
            .input(svg(CIRCLE))
            .limit(std::time::Duration::from_secs(10))
            .done();
        if done.code == Some(0) {
            let report: serde_json::Value =
                serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
            assert_eq!(report["complete"], false, "{report}");
        } else {
            assert_eq!(done.code, Some(1));
            assert!(done.stderr.ends_with("[out-of-time]\n"), "{}", done.stderr);
        }
    }
}

mod forms {
    use super::*;

    fn repeated(drawing: impl Into<Vec<u8>>, flags: &[&str]) -> String {
        String::from_utf8(rinceau(["recurse"]).args(flags).input(drawing).succeed().stdout).unwrap()
    }

    #[test]
    fn repeat_in_every_sample() {
        for sample in geometry::samples_of("recurse") {
            let name = sample.display().to_string();
            let before = std::fs::read_to_string(&sample).unwrap();
            let after = repeated(before.as_str(), &[]);
            assert_only_a_layer_was_added(&before, &after, &name);
            assert!(repeated(after.as_str(), &[]) == after, "{name}: a second run changes something");
        }
    }

    /// Merged copies are many in one; nothing else is.
    #[test]
    fn have_ids_of_their_own_and_few_siblings() {
        let tree = "<g class='rinceau-form'><rect id='a' width='20' height='50'/><use href='#a' transform='translate(90 9) scale(.9)'/><use href='#a' transform='translate(9 90) scale(.9)'/></g>";
        let text = repeated(svg(tree), &["--depth", "11", "--merge", "false"]);
        let xml = parse(&text);
        let mut ids: Vec<&str> = xml.descendants().filter_map(|node| node.attribute("id")).collect();
        let all = ids.len();
        ids.sort_unstable();
        ids.dedup();
        assert_eq!(ids.len(), all, "an id stands twice");
        assert!(all > 2047);
        for node in layers(&xml)[0].descendants() {
            assert!(node.children().filter(Node::is_element).count() <= 200);
        }
        let merged = repeated(svg(tree), &["--depth", "11"]);
        assert!(merged.len() < text.len() / 2, "{} and {}", merged.len(), text.len());
    }

    /// A clone inside a selected drawing makes it a form for one generator and stays a part of the
    /// shape for the others.
    #[test]
    fn that_are_selected_are_shapes_as_well() {
        let pair = svg("<g id='pair'><circle id='a' cx='60' cy='100' r='40'/><use href='#a' x='80'/></g>");
        let packed = packed_text(pair.as_str(), &["--id", "pair", "--spacing", "12"]);
        let right = elements(layers(&parse(&packed))[0]).iter().any(|node| {
            let d = node.descendants().find_map(|node| node.attribute("d")).unwrap_or("");
            d.trim_start_matches('M')
                .split(',')
                .next()
                .and_then(|x| x.parse::<f64>().ok())
                .is_some_and(|x| x > 120.0)
        });
        assert!(right, "the clone is filled too");
        let form = repeated(pair.as_str(), &["--id", "pair", "--depth", "2"]);
        let xml = parse(&form);
        let data: String = layers(&xml)[0].descendants().filter_map(|node| node.attribute("d")).collect();
        assert_eq!(data.matches('M').count(), 2, "{data}");
    }

    /// Lines are joined; a filled shape with a hole is none.
    #[test]
    fn keep_filled_shapes_where_lines_are_joined() {
        let form = "<g class='rinceau-form'><path id='a' d='M0,0h40v40h-40z M10,10h20v20h-20z' fill-rule='evenodd'/><use href='#a' transform='translate(50 0) scale(.9)'/></g>";
        for join in ["touching", "all"] {
            let text = repeated(svg(form), &["--join", join, "--depth", "3"]);
            let xml = parse(&text);
            let data: Vec<&str> =
                layers(&xml)[0].descendants().filter_map(|node| node.attribute("d")).collect();
            assert_eq!(data.len(), 3);
            assert!(
                data.iter().all(|d| d.matches('M').count() == 2 && d.matches('Z').count() == 2),
                "{data:?}"
            );
        }
    }

    #[test]
    fn end_when_the_time_does() {
        let tree = "<g class='rinceau-form'><rect id='a' width='20' height='50'/><use href='#a' transform='translate(90 9) scale(.9)'/><use href='#a' transform='translate(9 90) scale(.9)'/></g>";
        let folder = folder();
        let path = folder.path().join("report.json");
        let flags = ["--depth", "23", "--most", "20000000", "--time-limit", "0.001"];
        let done = rinceau(["recurse", "--report"]).arg(&path).args(&flags).input(svg(tree)).succeed();
        let report: serde_json::Value = serde_json::from_slice(&std::fs::read(&path).unwrap()).unwrap();
        assert_eq!(report["complete"], false, "{report}");
        assert!(report["counts"]["elements"].as_f64().unwrap() < 4e6, "{report}");
        assert_only_a_layer_was_added(&svg(tree), done.text(), "out of time");
    }
}

/// The same bytes for any number of threads.
#[test]
fn threads_do_not_show() {
    let first = |name: &str| geometry::samples_of(name)[0].clone();
    for (generator, sample) in ["pack", "vine", "recurse"].map(|name| (name, first(name))) {
        let drawn_with = |threads: &str| {
            let mut command = Command::new(binary());
            command.arg(generator).arg(&sample).env("RAYON_NUM_THREADS", threads);
            Run::of(command).succeed().stdout
        };
        let one = drawn_with("1");
        assert!(one == drawn_with("2") && one == drawn_with("5"), "{generator}");
    }
}

/// A report that would take the place of a drawing is refused before anything is written.
#[test]
fn a_report_is_kept_apart_from_drawings() {
    let folder = support::folder();
    let drawing = support::svg("<circle class='rinceau-container' cx='50' cy='50' r='40'/>");
    let input = support::file(&folder, "in.svg", &drawing);
    let out = folder.path().join("out.svg");
    for report in [input.clone(), out.clone(), folder.path().join("none/report.json")] {
        let done =
            support::rinceau(["pack"]).arg(&input).arg("-o").arg(&out).arg("--report").arg(&report).done();
        assert_ne!(done.code, Some(0));
        assert!(done.stderr.contains("[bad-parameter]"), "{}", done.stderr);
        assert_eq!(std::fs::read_to_string(&input).unwrap(), drawing);
        assert!(!out.exists());
    }
}
