//! What cannot be used is refused: exit 1, one sentence with its position and a remedy, and
//! nothing written. The sentences themselves are under test, since an artist reads them.

mod support;

use std::path::Path;
use std::time::Duration;
use support::{CIRCLE, file, folder, gzip, rinceau, svg};

/// A drawing and flags that a generator must refuse.
struct Case {
    generator: &'static str,
    drawing: Vec<u8>,
    flags: Vec<(&'static str, String)>,
}

fn case(drawing: impl Into<Vec<u8>>) -> Case {
    Case { generator: "pack", drawing: drawing.into(), flags: Vec::new() }
}

fn vine(drawing: impl Into<Vec<u8>>) -> Case {
    Case { generator: "vine", ..case(drawing) }
}

impl Case {
    fn flag(mut self, name: &'static str, value: impl Into<String>) -> Self {
        self.flags.push((name, value.into()));
        self
    }

    /// Runs the generator as a person and as Inkscape do, and returns the sentence.
    fn refusal(self) -> String {
        let folder = folder();
        let input = file(&folder, "in.svg", &self.drawing);
        let sentence = self.at_the_command_line(&input, &folder.path().join("absent.svg"));
        assert!(!folder.path().join("absent.svg").exists(), "an output was written");

        let present = file(&folder, "present.svg", "an older drawing");
        assert_eq!(self.at_the_command_line(&input, &present), sentence);
        assert_eq!(std::fs::read(present).unwrap(), b"an older drawing");
        assert_eq!(folder.path().read_dir().unwrap().count(), 2, "a temporary file was left");

        let as_inkscape = self.in_inkscape(&input);
        assert_eq!(as_inkscape, sentence, "Inkscape shows another sentence");
        sentence
    }

    fn at_the_command_line(&self, input: &Path, output: &Path) -> String {
        let mut run = rinceau([self.generator]).arg(input).arg("-o").arg(output);
        for (name, value) in &self.flags {
            run = run.arg(format!("--{name}")).arg(value);
        }
        let done = run.done();
        assert_eq!(done.code, Some(1), "{}", done.stderr);
        assert!(done.stdout.is_empty(), "standard output is not empty");
        one_sentence(done.stderr.strip_prefix("rinceau: ").expect("a message says who speaks"))
    }

    /// The extension gives the drawing back unchanged, with the sentence for the dialog.
    fn in_inkscape(&self, input: &Path) -> String {
        let (ids, others): (Vec<_>, Vec<_>) = self.flags.iter().partition(|(name, _)| *name == "id");
        let mut run = rinceau(ids.iter().map(|(_, id)| format!("--id={id}")));
        for (name, value) in others {
            run = run.arg(format!("--{}={value}", name.replace('-', "_")));
        }
        let done = run.arg(format!("--tool={}", self.generator)).arg(input).done();
        assert!(done.stdout == self.drawing, "Inkscape's drawing was changed");
        one_sentence(&done.stderr)
    }
}

/// A message: one line, what is wrong, what to do, and the reason code.
fn one_sentence(stderr: &str) -> String {
    let line = stderr.strip_suffix('\n').expect("a line ends");
    assert!(!line.contains('\n'), "more than one line: {line}");
    let (message, code) = line.rsplit_once(". [").unwrap_or_else(|| panic!("no reason code: {line}"));
    assert!(code.ends_with(']') && !code.contains(' '), "no reason code: {line}");
    assert!(message.contains(". "), "no remedy: {line}");
    line.to_owned()
}

#[test]
fn an_empty_file() {
    insta::assert_snapshot!(case("").refusal(), @"The file is empty. Save the drawing again as SVG. [empty-file]");
}

#[test]
fn an_empty_drawing() {
    insta::assert_snapshot!(case("<svg/>").refusal(), @"There is no shape to fill. Select a closed shape, or mark one as container (Extensions > Ornament > Mark as). [no-container]");
}

#[test]
fn a_drawing_without_a_container() {
    insta::assert_snapshot!(case(svg("<path id='line' class='rinceau-guide' d='M0,0H100'/>")).refusal(), @"There is no shape to fill. Select a closed shape, or mark one as container (Extensions > Ornament > Mark as). [no-container]");
}

#[test]
fn an_open_container() {
    insta::assert_snapshot!(marked("d='M10,10 H190 V190'").refusal(), @"2:1: The container 'shape' is open: its ends are 254.6 apart, at 10.0,10.0 and 190.0,190.0. Join its end nodes (with the node tool, or close the path), or mark it as guide. [open-container]");
}

#[test]
fn a_container_that_crosses_itself() {
    insta::assert_snapshot!(marked("d='M10,10 L190,190 V10 L10,190 Z'").refusal(), @"2:1: The outline of the container 'shape' crosses itself at 100.0,100.0. Clean it with Path > Union, or move the nodes apart. [crossing-container]");
}

#[test]
fn a_container_without_area() {
    insta::assert_snapshot!(marked("d='M10,10 H190 Z'").refusal(), @"2:1: The container 'shape' encloses no area. Draw it as a closed shape that no transform flattens, or clear its mark. [flat-container]");
}

#[test]
fn a_container_that_is_a_point() {
    insta::assert_snapshot!(marked("d='M10,10'").refusal(), @"2:1: The container 'shape' encloses no area. Draw it as a closed shape that no transform flattens, or clear its mark. [flat-container]");
}

#[test]
fn a_container_without_path_data() {
    insta::assert_snapshot!(marked("").refusal(), @"2:1: The container 'shape' encloses no area. Draw it as a closed shape that no transform flattens, or clear its mark. [flat-container]");
}

#[test]
fn a_group_without_content() {
    insta::assert_snapshot!(case(svg("<g id='g' class='rinceau-container'/>")).refusal(), @"2:1: The container 'g' has no shape of its own: it is empty, or all in it is marked as well. Draw a closed shape in it, or clear its mark. [empty-container]");
}

#[test]
fn an_element_without_a_spine() {
    insta::assert_snapshot!(element("").refusal(), @"3:1: The element 'leaf' has no spine. Draw a straight line from its base to its tip, mark it as spine, and group it with the element. [no-spine]");
}

#[test]
fn a_spine_of_no_length() {
    insta::assert_snapshot!(element("<path id='s' class='rinceau-spine' d='M50,50 H50'/>").refusal(), @"4:1: The spine 's' has no length. Draw it as one straight line from the base to the tip of the element. [zero-spine]");
}

#[test]
fn a_bent_spine() {
    insta::assert_snapshot!(element("<path id='s' class='rinceau-spine' d='M50,50 L60,70 H80'/>").refusal(), @"4:1: The spine 's' is not straight. Draw it as one straight line from the base to the tip of the element. [bent-spine]");
}

#[test]
fn two_spines() {
    insta::assert_snapshot!(element("<path class='rinceau-spine' d='M50,50 H80'/><path class='rinceau-spine' d='M50,60 H80'/>").refusal(), @"3:1: The element 'leaf' has 2 spines. Keep one; group each element with its own spine. [two-spines]");
}

#[test]
fn an_element_with_nothing_drawn() {
    insta::assert_snapshot!(case(svg(&format!("{CIRCLE}\n<g id='e' class='rinceau-element'><path class='rinceau-spine' d='M0,0H9'/></g>"))).refusal(), @"3:1: The element 'e' has nothing drawn in it. Group its shapes with its spine, then mark the group as element. [empty-element]");
}

#[test]
fn an_element_without_width() {
    insta::assert_snapshot!(case(svg(&format!("{CIRCLE}\n<g id='e' class='rinceau-element'><path d='M0,0H9'/><path class='rinceau-spine' d='M0,0H9'/></g>"))).refusal(), @"3:1: The element 'e' has no width beside its spine. Draw its shapes around or beside the spine. [flat-element]");
}

#[test]
fn a_guide_outside_every_container() {
    insta::assert_snapshot!(guided("d='M-500,0 H-300'").refusal(), @"3:1: The guide 'flow' is outside every container. Move it into the shape whose flow it should guide, or clear its mark. [guide-outside]");
}

#[test]
fn a_guide_of_no_length() {
    insta::assert_snapshot!(guided("d='M100,100'").refusal(), @"3:1: The guide 'flow' has no length. Draw it as a line along the flow, or delete it. [zero-guide]");
}

#[test]
fn a_guide_that_ends_where_it_starts() {
    insta::assert_snapshot!(guided("d='M100,100 L100,100'").refusal(), @"3:1: The guide 'flow' has no length. Draw it as a line along the flow, or delete it. [zero-guide]");
}

#[test]
fn a_coordinate_that_is_no_number() {
    insta::assert_snapshot!(marked("d='M10,10 H190 V190 L NaN,10 Z'").refusal(), @"2:1: The object 'shape' cannot be read: its path data is broken at command 4. Redraw it, or clear its mark. [broken-object]");
}

#[test]
fn a_length_that_is_no_number() {
    insta::assert_snapshot!(case(svg("<circle id='c' class='rinceau-container' cx='9' cy='9' r='NaN'/>")).refusal(), @"2:1: The object 'c' cannot be read: its r='NaN' is not a length. Redraw it, or clear its mark. [broken-object]");
}

#[test]
fn a_coordinate_of_1e300() {
    insta::assert_snapshot!(marked("d='M10,10 H1e300 V190 Z'").refusal(), @"2:1: The object 'shape' has a coordinate that is no number or beyond 1e9. Move or scale it back onto the page. [coordinate-range]");
}

#[test]
fn a_length_of_1e300() {
    insta::assert_snapshot!(case(svg("<circle id='c' class='rinceau-container' cx='9' cy='9' r='1e300'/>")).refusal(), @"2:1: The object 'c' has a coordinate that is no number or beyond 1e9. Move or scale it back onto the page. [coordinate-range]");
}

#[test]
fn a_transform_that_scales_to_1e300() {
    insta::assert_snapshot!(case(svg(&format!("<g transform='scale(1e300)'>{CIRCLE}</g>"))).refusal(), @"2:29: The object 'sun' has a coordinate that is no number or beyond 1e9. Move or scale it back onto the page. [coordinate-range]");
}

#[test]
fn a_transform_that_scales_to_nothing() {
    insta::assert_snapshot!(case(svg(&format!("<g transform='scale(0)'>{CIRCLE}</g>"))).refusal(), @"2:25: The container 'sun' encloses no area. Draw it as a closed shape that no transform flattens, or clear its mark. [flat-container]");
}

#[test]
fn a_transform_that_cannot_be_read() {
    insta::assert_snapshot!(case(svg(&format!("<g transform='turn(3)'>{CIRCLE}</g>"))).refusal(), @"2:1: The object 'node:1' cannot be read: its transform cannot be read. Redraw it, or clear its mark. [broken-object]");
}

#[test]
fn a_file_cut_short() {
    let drawing = svg(CIRCLE);
    insta::assert_snapshot!(case(&drawing.as_bytes()[..drawing.len() - 30]).refusal(), @"2:48: The drawing is damaged or cut short: unexpected end of stream. Open it in Inkscape and save it again as SVG. [broken-xml]");
    insta::assert_snapshot!(case(&drawing.as_bytes()[..drawing.len() - 8]).refusal(), @"2:70: The drawing is damaged or cut short: the root node was opened but never closed. Open it in Inkscape and save it again as SVG. [broken-xml]");
}

#[test]
fn text_that_is_not_xml() {
    insta::assert_snapshot!(case("Dear editor,\nthe drawing is attached.").refusal(), @"1:1: The file is not an SVG drawing: it does not start with '<'. Open it in Inkscape and save it again as SVG. [not-xml]");
}

#[test]
fn a_picture_that_is_not_text() {
    insta::assert_snapshot!(case(b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR".to_vec()).refusal(), @"1:1: The file is not text in UTF-8. Check that it is an SVG drawing, and save it again as plain SVG. [not-text]");
}

#[test]
fn xml_that_is_not_svg() {
    insta::assert_snapshot!(case("<?xml version='1.0'?>\n<html><body/></html>").refusal(), @"2:1: This is XML, but its root is <html>, not <svg>. Open an SVG drawing. [not-svg]");
}

#[test]
fn a_zipped_drawing_cut_short() {
    insta::assert_snapshot!(case(gzip(svg(CIRCLE).as_bytes())[..40].to_vec()).refusal(), @"The compressed drawing (svgz) is damaged or cut short. Save it again, or use the uncompressed SVG. [broken-gzip]");
}

#[test]
fn an_unknown_role() {
    insta::assert_snapshot!(case(svg("<circle rinceau:role='contaner' r='9'/>")).refusal(), @"2:1: 'contaner' is not a role. Use one of container, guide, fixed, fixed-spine, stem, seed, element, spine, form, clone, tack, reference, boundary, spray, rules. [unknown-role]");
}

#[test]
fn a_role_inside_a_guide() {
    insta::assert_snapshot!(case(svg(&format!("<g id='g' rinceau:role='guide'>{CIRCLE}</g>"))).refusal(), @"2:32: The container 'sun' stands inside the guide 'g'. Move it out of the group, or clear one of the two marks. [nested-role]");
}

#[test]
fn a_container_inside_a_container() {
    insta::assert_snapshot!(case(svg(&format!("<g id='g' rinceau:role='container'>{CIRCLE}</g>"))).refusal(), @"2:1: The container 'g' has no shape of its own: it is empty, or all in it is marked as well. Draw a closed shape in it, or clear its mark. [empty-container]");
}

#[test]
fn a_clone_that_contains_itself() {
    insta::assert_snapshot!(case(svg("<g id='g' class='rinceau-container'>\n<use id='u' href='#g'/></g>")).refusal(), @"3:1: The clone 'u' contains itself. Delete the clone, or unlink it (Edit > Clone > Unlink Clone). [clone-cycle]");
}

#[test]
fn two_clones_that_contain_each_other() {
    insta::assert_snapshot!(case(svg("<g id='g' class='rinceau-container'><use id='u' href='#a'/></g>\n<g id='a'><use id='v' href='#b'/></g>\n<g id='b'><use id='w' href='#a'/></g>")).refusal(), @"4:11: The clone 'w' contains itself. Delete the clone, or unlink it (Edit > Clone > Unlink Clone). [clone-cycle]");
}

#[test]
fn clones_that_multiply_without_end() {
    insta::assert_snapshot!(case(multiplying_clones()).refusal(), @"2:188: The annotated objects contain more than 100000 clones. Mark fewer objects, or unlink some clones. [too-many-clones]");
}

#[test]
fn an_id_that_two_objects_have() {
    insta::assert_snapshot!(case(svg("<circle id='c' r='50'/>\n<rect id='c' width='50' height='50'/>")).flag("id", "c").refusal(), @"3:1: Two objects have the id 'c', at 2:1 and 3:1. Give one of them another id (Object > Object Properties). [duplicate-id]");
}

#[test]
fn a_clone_of_an_id_that_two_objects_have() {
    insta::assert_snapshot!(case(svg("<circle id='c' r='50'/>\n<rect id='c' width='50' height='50'/>\n<g class='rinceau-container'><use href='#c'/></g>")).refusal(), @"4:30: Two objects have the id 'c', at 2:1 and 3:1. Give one of them another id (Object > Object Properties). [duplicate-id]");
}

#[test]
fn an_id_that_no_object_has() {
    insta::assert_snapshot!(case(svg(CIRCLE)).flag("id", "moon").refusal(), @"No object has the id 'moon'. Check the id in Object > Object Properties. [unknown-id]");
}

#[test]
fn an_id_with_control_characters() {
    insta::assert_snapshot!(case(svg(CIRCLE)).flag("id", "a\u{1b}[31m\u{202e}b\u{9b}").refusal(), @r#"No object has the id 'a\u{1b}[31m\u{202e}b\u{9b}'. Check the id in Object > Object Properties. [unknown-id]"#);
}

#[test]
fn a_recipe_that_cannot_be_read() {
    insta::assert_snapshot!(case(svg(&format!("{CIRCLE}\n<g id='old' rinceau:result='pack' rinceau:params='{{' rinceau:source='sun'/>"))).refusal(), @"3:1: The recipe of the layer 'old' cannot be read: rinceau:params is not a JSON object. Delete the layer and run the generator again. [broken-recipe]");
}

#[test]
fn a_seed_that_cannot_be_read() {
    insta::assert_snapshot!(case(svg(&format!("{CIRCLE}\n<g id='old' rinceau:result='pack' rinceau:seed='x' rinceau:source='sun'/>"))).refusal(), @"3:1: The recipe of the layer 'old' cannot be read: rinceau:seed is not a whole number. Delete the layer and run the generator again. [broken-recipe]");
}

#[test]
fn a_layer_over_other_shapes_too() {
    insta::assert_snapshot!(case(svg(&format!("{CIRCLE}\n<g id='old' rinceau:result='pack' rinceau:source='sun moon'/>"))).refusal(), @"3:1: 'sun' is already filled, together with others, in the layer 'old'. Fill all of that layer's shapes at once, or delete the layer first. [layer-overlap]");
}

#[test]
fn layers_over_some_of_the_shapes_each() {
    let sun = CIRCLE.replace("sun", "moon");
    insta::assert_snapshot!(case(svg(&format!("{CIRCLE}{sun}\n<g id='old' rinceau:result='pack' rinceau:source='sun'/><g id='older' rinceau:result='pack' rinceau:source='moon'/>"))).refusal(), @"3:1: The layer 'old' already fills some of the shapes alone. Fill its shapes and the others separately (select them), or delete the layer first. [layer-overlap]");
}

#[test]
fn a_layer_scaled_to_nothing() {
    insta::assert_snapshot!(case(svg(&format!("{CIRCLE}\n<g id='old' transform='scale(0)' rinceau:result='pack' rinceau:source='sun'/>"))).refusal(), @"3:1: The layer 'old' is scaled to nothing. Delete it and run again. [flat-layer]");
}

#[test]
fn text_whose_font_is_missing() {
    insta::assert_snapshot!(case(svg("<text id='t' class='rinceau-container' y='90' font-family='No Such Font'>\u{10fffd}</text>")).refusal(), @"2:1: The text 't' has no outline: its font is not installed. Install its font, or turn it into a path (Path > Object to Path). [text-without-outline]");
}

#[test]
fn names_that_no_element_has() {
    insta::assert_snapshot!(case(svg(CIRCLE)).flag("elements", "thistle rose").refusal(), @"No element, kind or family is called 'thistle'. Use auto, drawn, mixed, leaves, drops, spirals, scales, feathers, or the id of an element. [no-element]");
}

#[test]
fn drawn_elements_where_none_is_drawn() {
    insta::assert_snapshot!(case(svg(CIRCLE)).flag("elements", "drawn").refusal(), @"No element is drawn. Draw one: group its shapes with a straight spine and mark the group as element. [no-element]");
}

#[test]
fn more_elements_than_allowed() {
    // How many there would be is a matter of taste, and changes with it.
    let sentence = case(svg(CIRCLE)).flag("spacing", "0.01").refusal();
    let digits = |c: char| c.is_ascii_digit() || c == '.';
    let words =
        sentence.split(' ').map(|word| if word.len() > 1 && word.chars().all(digits) { "#" } else { word });
    insta::assert_snapshot!(words.collect::<Vec<_>>().join(" "), @"An element width of # would need about # elements, more than # Set the element width (--spacing) to # or more. [too-many-elements]");
}

#[test]
fn an_element_width_larger_than_the_shape() {
    insta::assert_snapshot!(case(svg(CIRCLE)).flag("spacing", "5000").refusal(), @"No element fits into the shape. Make the element width or the shortest length smaller. [nothing-fits]");
}

#[test]
fn a_parameter_that_a_container_misspells() {
    insta::assert_snapshot!(case(svg(&CIRCLE.replace("/>", " rinceau:spacng=\"8\"/>"))).refusal(), @"2:1: There is no parameter 'spacng'. Use one of spacing, elements, min-gap, palette, max-length, min-length, edge, fillers, filler-gap, stretch, mould, variety, sense, symmetry, thread, iterations, shift, show-gaps, show-flow, rounding, distress, connect, bridge, border. [unknown-parameter]");
}

#[test]
fn a_value_that_a_container_gets_wrong() {
    insta::assert_snapshot!(case(svg(&CIRCLE.replace("/>", " rinceau:spacing=\"wide\"/>"))).refusal(), @"2:1: spacing cannot be 'wide'. Give a length of 0 or more, such as 12 or 4mm; 0 chooses by itself. [bad-parameter]");
}

#[test]
fn entities_that_multiply() {
    insta::assert_snapshot!(case(entity_bomb()).refusal(), @"2:6: Entities such as '&a12;' expand to more than 1024 KiB. Copy what is to be filled into a new drawing. [entity-expansion]");
}

#[test]
fn an_entity_repeated() {
    insta::assert_snapshot!(case(format!("<!DOCTYPE svg [<!ENTITY a '{}'>]>\n<svg>{}</svg>", "x".repeat(10_000), "&a;".repeat(1_000))).refusal(), @"2:318: Entities such as '&a;' expand to more than 1024 KiB. Copy what is to be filled into a new drawing. [entity-expansion]");
}

#[test]
fn an_entity_that_contains_itself() {
    insta::assert_snapshot!(case("<!DOCTYPE svg [<!ENTITY a '&b;'><!ENTITY b '&a;'>]>\n<svg>&a;</svg>").refusal(), @"2:6: Entities such as '&a;' expand to more than 1024 KiB. Copy what is to be filled into a new drawing. [entity-expansion]");
}

#[test]
fn an_entity_of_another_file() {
    insta::assert_snapshot!(case("<!DOCTYPE svg [<!ENTITY a SYSTEM 'file:///etc/passwd'>]>\n<svg>&a;</svg>").refusal(), @"2:6: The drawing uses an entity '&a;' that it does not declare. Open it in Inkscape and save it again as SVG. [unknown-entity]");
}

#[test]
fn nesting_a_million_deep() {
    insta::assert_snapshot!(case(format!("<svg>{}{}</svg>", "<g>".repeat(1_000_000), "</g>".repeat(1_000_000))).refusal(), @"1:3003: Objects are nested more than 1000 deep. Copy what is to be filled into a new drawing. [too-deep]");
}

#[test]
fn nesting_that_never_closes() {
    insta::assert_snapshot!(case(format!("<svg>{}", "<g>".repeat(1_000_000))).refusal(), @"1:3003: Objects are nested more than 1000 deep. Copy what is to be filled into a new drawing. [too-deep]");
}

#[test]
fn more_objects_than_allowed() {
    insta::assert_snapshot!(case(format!("<svg>\n{}</svg>", "<g/>".repeat(1_000_001))).refusal(), @"2:3999997: The drawing has more than 1000000 objects. Copy what is to be filled into a new drawing. [too-many-nodes]");
}

#[test]
fn two_hundred_thousand_attributes() {
    insta::assert_snapshot!(case(format!("<svg>\n<g{}/></svg>", numbered(200_000, " a#=''"))).refusal(), @"2:1: Objects have more than 4096 attributes or 256 namespace declarations. Copy what is to be filled into a new drawing. [too-many-attributes]");
}

#[test]
fn sixty_thousand_namespaces() {
    insta::assert_snapshot!(case(format!("<svg>\n<g{}/></svg>", numbered(60_000, " xmlns:a#='b'"))).refusal(), @"2:1: Objects have more than 4096 attributes or 256 namespace declarations. Copy what is to be filled into a new drawing. [too-many-attributes]");
}

/// A zip of nothing but spaces, 1,000 times as large as it looks.
#[test]
fn a_zip_bomb() {
    // A zip may consist of several, one after the other.
    let bomb = gzip(&vec![b' '; 1 << 20]).repeat(257);
    assert!(bomb.len() < 1 << 20);
    insta::assert_snapshot!(case(bomb).refusal(), @"The drawing is larger than 256 MiB. Move what is to be filled into a smaller drawing; embedded pictures are the usual cause. [too-large]");
}

/// A file beyond the limit, which is not read to its end.
#[test]
fn a_file_too_large() {
    let folder = folder();
    let input = file(&folder, "in.svg", svg(CIRCLE));
    // The rest of the file is a hole: zeros that take no space on the disk.
    let size = (256 << 20) + 10;
    std::fs::File::options().write(true).open(&input).unwrap().set_len(size).unwrap();
    let output = folder.path().join("out.svg");
    let done = rinceau(["pack"]).arg(&input).arg("-o").arg(&output).done();
    assert_eq!(done.code, Some(1));
    assert!(done.stdout.is_empty() && !output.exists());
    insta::assert_snapshot!(one_sentence(&done.stderr), @"rinceau: The drawing is larger than 256 MiB. Move what is to be filled into a smaller drawing; embedded pictures are the usual cause. [too-large]");

    let done = rinceau(["--tool=pack"]).arg(&input).done();
    // A drawing cut off at the limit would replace the artist's.
    assert_eq!(done.stdout.len() as u64, size, "Inkscape gets the drawing back whole");
    insta::assert_snapshot!(one_sentence(&done.stderr), @"The drawing is larger than 256 MiB. Move what is to be filled into a smaller drawing; embedded pictures are the usual cause. [too-large]");
}

/// A large drawing around a small container is fine, and takes time and memory in proportion.
#[test]
fn a_drawing_of_100_mb_works() {
    let folder = folder();
    let sizes = [10 << 20, 100 << 20];
    let seconds = sizes.map(|size| {
        let input = file(&folder, "in.svg", large_drawing(size));
        let output = folder.path().join("out.svg");
        // Four times the drawing, and 300 MiB for the program and its threads' stacks.
        let most = 4 * (size >> 10) + (300 << 10);
        let mut shell = std::process::Command::new("bash");
        shell.args(["-c", &format!("ulimit -v {most} && exec \"$@\""), "bash"]);
        shell.arg(support::binary()).arg("pack").arg(&input).arg("-o").arg(&output);
        let done = support::Run::of(shell).limit(Duration::from_secs(60)).succeed();
        let (before, after) = (std::fs::read(&input).unwrap(), std::fs::read(&output).unwrap());
        assert!(after.len() > before.len() && after.starts_with(&before[..before.len() - 8]));
        done.time.as_secs_f64()
    });
    // Ten times the bytes; the factor leaves room for a busy machine.
    assert!(seconds[1] < 30.0 * seconds[0].max(0.1), "{seconds:?} s for 10 and 100 MiB");
}

/// An unmarked path, an embedded picture and many small objects around a container.
fn large_drawing(size: usize) -> String {
    let mut body = String::with_capacity(size + 1000);
    body.push_str("<path d='M0,0");
    while body.len() < size / 2 {
        body.push_str(" L12.345,67.891");
    }
    body.push_str("'/>\n<image href='data:image/png;base64,");
    while body.len() < size - size / 10 {
        body.push_str("iVBORw0KGgoAAAANSUhEUgAAAAUA");
    }
    body.push_str("'/>\n");
    while body.len() < size {
        body.push_str("<g><rect width='20' height='30' style='fill:#123456;stroke:none'/></g>\n");
    }
    body.push_str(CIRCLE);
    svg(&body)
}

/// The remedy for too many elements works.
#[test]
fn the_least_element_width_named_is_accepted() {
    let done = rinceau(["pack", "--spacing", "0.01"]).input(svg(CIRCLE)).done();
    let (_, remedy) = done.stderr.split_once("(--spacing) to ").expect("a remedy");
    let (spacing, _) = remedy.split_once(' ').unwrap();
    let flags = ["pack", "--fillers", "none", "--time-limit", "0.1", "--spacing", spacing];
    let done = rinceau(flags).input(svg(CIRCLE)).done();
    assert!(!done.stderr.contains("[too-many-elements]"), "{}", done.stderr);
}

/// Wrong usage is exit 2, with the reason and nothing on standard output.
#[test]
fn wrong_usage_is_exit_2() {
    let wrong: [&[&str]; 11] = [
        &[],
        &["sprout"],
        &["pack", "--spicing", "8"],
        &["pack", "--spacing", "wide"],
        &["pack", "--spacing=-3"],
        &["pack", "--stretch", "9"],
        &["pack", "--palette", "mauve"],
        &["pack", "--seed", "-1"],
        &["pack", "--time-limit", "0"],
        &["mark", "petal", "--id", "a"],
        &["mark", "guide"],
    ];
    for arguments in wrong {
        let done = rinceau(arguments).input(svg(CIRCLE)).done();
        assert_eq!(done.code, Some(2), "{arguments:?}: {}", done.stderr);
        assert!(done.stdout.is_empty() && !done.stderr.is_empty(), "{arguments:?}");
    }
}

#[test]
fn wrong_values_name_what_is_right() {
    let first_line = |flag: &str, value: &str| {
        let done = rinceau(["pack"]).arg(format!("--{flag}={value}")).input(svg(CIRCLE)).done();
        done.stderr.lines().next().unwrap_or_default().to_owned()
    };
    insta::assert_snapshot!(first_line("spacing", "wide"), @"error: invalid value 'wide' for '--spacing <LENGTH>': spacing cannot be 'wide'. Give a length of 0 or more, such as 12 or 4mm; 0 chooses by itself. [bad-parameter]");
    insta::assert_snapshot!(first_line("stretch", "9"), @"error: invalid value '9' for '--stretch <NUMBER>': stretch cannot be '9'. Give a number from 1 to 3. [bad-parameter]");
    insta::assert_snapshot!(first_line("palette", "mauve"), @"error: invalid value 'mauve' for '--palette <CHOICE>': palette cannot be 'mauve'. Give one of auto, lagoon, ember, meadow, dusk, pale, ink, white. [bad-parameter]");
    insta::assert_snapshot!(first_line("border", "perhaps"), @"error: invalid value 'perhaps' for '--border <true|false>': border cannot be 'perhaps'. Give true or false. [bad-parameter]");
    insta::assert_snapshot!(first_line("elements", " "), @"error: invalid value ' ' for '--elements <NAMES>': elements cannot be ''. Give at least one name. [bad-parameter]");
}

/// A dialog's value that no dialog can give, as an old preferences file might.
#[test]
fn a_dialog_value_out_of_range() {
    let folder = folder();
    let input = file(&folder, "in.svg", svg(CIRCLE));
    let done = rinceau(["--tool=pack", "--stretch=9"]).arg(&input).done();
    assert_eq!(done.stdout, std::fs::read(&input).unwrap());
    insta::assert_snapshot!(one_sentence(&done.stderr), @"stretch cannot be '9'. Give a number from 1 to 3. [bad-parameter]");
}

/// Every way to call a tool that is not there, or on nothing.
#[test]
fn the_extension_says_what_is_missing() {
    let folder = folder();
    let input = file(&folder, "in.svg", svg(CIRCLE));
    let sentence = |arguments: &[&str]| {
        let done = rinceau(arguments).arg(&input).done();
        assert_eq!(done.stdout, std::fs::read(&input).unwrap());
        one_sentence(&done.stderr)
    };
    insta::assert_snapshot!(sentence(&["--tool=mark-container"]), @"Nothing is selected. Select what you want to mark, then choose the entry again. [nothing-selected]");
    insta::assert_snapshot!(sentence(&["--id=moon", "--tool=mark-container"]), @"No object has the id 'moon'. Check the id in Object > Object Properties. [unknown-id]");
    insta::assert_snapshot!(sentence(&["--tool=weave"]), @"This version has no tool 'weave'. Run 'rinceau install' again. [unknown-tool]");
}

#[test]
fn files_that_cannot_be_opened_or_written() {
    let folder = folder();
    let input = file(&folder, "in.svg", svg(CIRCLE));
    let sentence = |arguments: &[&str]| {
        let done = rinceau(arguments.iter().map(|name| name.replace("DIR", "/nowhere/at/all"))).done();
        assert_eq!(done.code, Some(1), "{}", done.stderr);
        assert!(done.stdout.is_empty());
        one_sentence(&done.stderr)
    };
    insta::assert_snapshot!(sentence(&["pack", "DIR/in.svg"]), @"rinceau: The drawing '/nowhere/at/all/in.svg' cannot be read: no such file or directory. Check its name and that you may open it. [cannot-read]");
    insta::assert_snapshot!(sentence(&["pack", "/"]), @"rinceau: The drawing '/' cannot be read: is a directory. Check its name and that you may open it. [cannot-read]");
    let input = input.to_str().unwrap();
    insta::assert_snapshot!(sentence(&["pack", input, "-o", "DIR/out.svg"]), @"rinceau: '/nowhere/at/all/out.svg' cannot be written: no such file or directory. Check the folder, its permissions and the free space; nothing was changed. [cannot-write]");
    insta::assert_snapshot!(sentence(&["pack", input, "-o", "/"]), @"rinceau: '/' cannot be written: is a directory. Check the folder, its permissions and the free space; nothing was changed. [cannot-write]");
    insta::assert_snapshot!(sentence(&["pack", input, "-o", "/dev/full"]), @"rinceau: '/dev/full' cannot be written: no space left on device. Check the folder, its permissions and the free space; nothing was changed. [cannot-write]");
}

mod vines {
    use super::*;

    #[test]
    fn without_a_container() {
        insta::assert_snapshot!(vine(svg("<path class='rinceau-stem' d='M0,0H100'/>")).refusal(), @"There is no shape to fill. Select a closed shape, or mark one as container (Extensions > Ornament > Mark as). [no-container]");
    }

    #[test]
    fn in_an_open_container() {
        insta::assert_snapshot!(vine(svg("<path id='shape' class='rinceau-container' d='M10,10 H190 V190'/>")).refusal(), @"2:1: The container 'shape' is open: its ends are 254.6 apart, at 10.0,10.0 and 190.0,190.0. Join its end nodes (with the node tool, or close the path), or mark it as guide. [open-container]");
    }

    #[test]
    fn of_charges_that_mean_nothing() {
        let charge = |text: &str| vine(svg(CIRCLE)).flag("charge", text).refusal();
        insta::assert_snapshot!(charge("banana"), @"charge cannot be 'banana'. Give power, constant, sine, triangle, or 2 to 64 numbers with spaces between, such as '1 -1 2'. [bad-charge]");
        insta::assert_snapshot!(charge("1 NaN"), @"charge cannot be '1 NaN'. Give power, constant, sine, triangle, or 2 to 64 numbers with spaces between, such as '1 -1 2'. [bad-charge]");
        insta::assert_snapshot!(charge("inf -1"), @"charge cannot be 'inf -1'. Give power, constant, sine, triangle, or 2 to 64 numbers with spaces between, such as '1 -1 2'. [bad-charge]");
        insta::assert_snapshot!(charge("1"), @"charge cannot be '1'. Give power, constant, sine, triangle, or 2 to 64 numbers with spaces between, such as '1 -1 2'. [bad-charge]");
        insta::assert_snapshot!(charge("0 0 0"), @"charge cannot be '0 0 0'. Give power, constant, sine, triangle, or 2 to 64 numbers with spaces between, such as '1 -1 2'. [bad-charge]");
    }

    #[test]
    fn with_clip_art_that_nobody_drew() {
        insta::assert_snapshot!(vine(svg(CIRCLE)).flag("tips", "flower,thistle").refusal(), @"No clip art is called 'thistle'. Use leaf, flower, bud, ball or none, a family (classic, meadow, ivy), or the id or kind of an element that you drew. [no-element]");
        insta::assert_snapshot!(vine(svg(CIRCLE)).flag("forks", "leaf thorn").refusal(), @"No clip art is called 'thorn'. Use leaf, flower, bud, ball or none, a family (classic, meadow, ivy), or the id or kind of an element that you drew. [no-element]");
    }

    #[test]
    fn with_an_element_without_spine() {
        insta::assert_snapshot!(vine(svg(&format!("{CIRCLE}\n<g id='leaf' class='rinceau-element'><path d='M50,50 60,60 90,50 60,40Z'/></g>"))).refusal(), @"3:1: The element 'leaf' has no spine. Draw a straight line from where it grows to where it points, mark it as spine, and group it with the element. [no-spine]");
    }

    #[test]
    fn with_an_element_that_covers_nothing() {
        insta::assert_snapshot!(vine(svg(&format!("{CIRCLE}\n<g id='leaf' class='rinceau-element'><path d='M50,50 H90' fill='none'/><path class='rinceau-spine' d='M50,50 H90'/></g>"))).refusal(), @"3:1: The element 'leaf' covers nothing. Draw it as closed or stroked shapes. [flat-element]");
    }

    #[test]
    fn too_wide_for_the_shape() {
        insta::assert_snapshot!(vine(svg(CIRCLE)).flag("stem-width", "5000").refusal(), @"No stem fits into the shape. Make the stem width or the gap smaller. [nothing-fits]");
        insta::assert_snapshot!(vine(svg(CIRCLE)).flag("stem-width", "100").refusal(), @"No stem fits into the shape. Make the stem width or the gap smaller. [nothing-fits]");
        insta::assert_snapshot!(vine(svg(CIRCLE)).flag("gap", "5000").refusal(), @"No stem fits into the shape. Make the stem width or the gap smaller. [nothing-fits]");
        insta::assert_snapshot!(vine(svg(CIRCLE)).flag("edge", "90").refusal(), @"No stem fits into the shape. Make the stem width or the gap smaller. [nothing-fits]");
    }

    #[test]
    fn in_a_container_that_is_all_fixed() {
        insta::assert_snapshot!(vine(svg(&format!("{CIRCLE}\n<rect class='rinceau-fixed' width='200' height='200'/>"))).refusal(), @"No stem fits into the shape. Make the stem width or the gap smaller. [nothing-fits]");
    }

    #[test]
    fn with_what_a_container_misspells() {
        insta::assert_snapshot!(vine(svg(&CIRCLE.replace("/>", " rinceau:turn=\"1\"/>"))).refusal(), @"2:1: There is no parameter 'turn'. Use one of levels, stem-width, turns, forks, tips, palette, length, branches, alpha, leaves, clip-art, gap, edge, taper, tip-width, stem, curl, places, rule, charge, field, integrator, stems, copies, overlay, plait, repeat. [unknown-parameter]");
        insta::assert_snapshot!(vine(svg(&CIRCLE.replace("/>", " rinceau:turns=\"1,x\"/>"))).refusal(), @"2:1: turns cannot be '1,x'. Give numbers from 0 to 8 with commas between. [bad-parameter]");
        insta::assert_snapshot!(vine(svg(&CIRCLE.replace("/>", " rinceau:charge=\"banana\"/>"))).refusal(), @"2:1: charge cannot be 'banana'. Give power, constant, sine, triangle, or 2 to 64 numbers with spaces between, such as '1 -1 2'. [bad-charge]");
    }

    #[test]
    fn beyond_all_bounds() {
        insta::assert_snapshot!(vine(svg("<circle id='sun' class='rinceau-container' r='1e12'/>")).refusal(), @"2:1: The object 'sun' has a coordinate that is no number or beyond 1e9. Move or scale it back onto the page. [coordinate-range]");
    }

    /// What an artist drew as stem and cannot be one must not vanish without a word.
    #[test]
    fn along_a_stem_outside_every_container() {
        let drawing = svg(&format!("{CIRCLE}\n<path id='main' class='rinceau-stem' d='M300,300 H400'/>"));
        let done = rinceau(["vine"]).input(drawing).done();
        assert!(
            done.stderr.contains("'main'"),
            "exit {:?}, not a word about the stem: {:?}",
            done.code,
            done.stderr
        );
        insta::assert_snapshot!(done.stderr, @"rinceau: 3:1: The stem 'main' is outside every container, or runs along its edge. Move it into the shape that it should fill, or clear its mark. [stem-outside]");
    }

    #[test]
    fn from_a_seed_outside_every_container() {
        let drawing =
            svg(&format!("{CIRCLE}\n<circle id='pip' class='rinceau-seed' cx='300' cy='300' r='2'/>"));
        let done = rinceau(["vine"]).input(drawing).done();
        assert!(
            done.stderr.contains("'pip'"),
            "exit {:?}, not a word about the seed: {:?}",
            done.code,
            done.stderr
        );
    }

    /// As small as a rounding error, and it still is a shape.
    #[test]
    fn of_no_size_are_drawn_or_refused() {
        for r in ["1e-9", "1e-4", "1e9"] {
            let done = rinceau(["vine"])
                .input(svg(&format!("<circle id='sun' class='rinceau-container' r='{r}'/>")))
                .done();
            match done.code {
                Some(0) => assert!(!done.text().contains("NaN") && !done.text().contains("inf"), "{r}"),
                _ => drop(one_sentence(&done.stderr)),
            }
        }
    }

    #[test]
    fn used_wrongly_are_exit_2() {
        let wrong: [&[&str]; 9] = [
            &["--levels", "0"],
            &["--levels", "9"],
            &["--turns", "1,x"],
            &["--turns", ""],
            &["--turns", "NaN"],
            &["--length", "12,-3"],
            &["--alpha", "2"],
            &["--branches", "1e9"],
            &["--stem", "zigzag"],
        ];
        for arguments in wrong {
            let done = rinceau(["vine"]).args(arguments).input(svg(CIRCLE)).done();
            assert_eq!(done.code, Some(2), "{arguments:?}: {}", done.stderr);
            assert!(done.stdout.is_empty() && !done.stderr.is_empty(), "{arguments:?}");
        }
        let done = rinceau(["vine", "--turns=1,x"]).input(svg(CIRCLE)).done();
        insta::assert_snapshot!(done.stderr.lines().next().unwrap(), @"error: invalid value '1,x' for '--turns <NUMBER,...>': turns cannot be '1,x'. Give numbers from 0 to 8 with commas between. [bad-parameter]");
    }
}

mod forms {
    use super::*;

    /// A form around a square, and what else is in it.
    fn form(clones: &str) -> Case {
        recurse(svg(&format!(
            "<g id='form' class='rinceau-form'><rect id='square' width='9' height='9'/>\n{clones}</g>"
        )))
    }

    fn recurse(drawing: impl Into<Vec<u8>>) -> Case {
        Case { generator: "recurse", ..case(drawing) }
    }

    const HALF: &str = "<use id='half' href='#square' transform='translate(9 9) scale(.5)'/>";

    #[test]
    fn that_are_none() {
        insta::assert_snapshot!(recurse(svg("<rect width='9' height='9'/>")).refusal(), @"The drawing has no form. Group a motif with clones of it (Edit > Clone > Create Clone), then select the group or mark it as form. [no-form]");
    }

    #[test]
    fn without_a_motif() {
        insta::assert_snapshot!(recurse(svg("<g id='form' class='rinceau-form'/>")).refusal(), @"2:1: The form 'form' has nothing drawn in it. Draw the motif into its group, then clone it (Edit > Clone > Create Clone). [empty-form]");
    }

    #[test]
    fn whose_last_generation_is_empty() {
        let inner = "<g id='form' class='rinceau-form'><rect id='a' rinceau:generations='inner' width='9' height='9'/></g>";
        insta::assert_snapshot!(recurse(svg(inner)).flag("depth", "1").refusal(), @"2:1: The form 'form' draws nothing in its generation 1. Draw all generations, or fewer of them. [empty-generation]");
    }

    #[test]
    fn with_clones_of_nothing() {
        insta::assert_snapshot!(form("<use id='lost' href='#gone' transform='scale(.5)'/>").refusal(), @"3:1: The clone 'lost' refers to nothing in this drawing. Clone a shape of the form again (Edit > Clone > Create Clone), or delete the clone. [missing-source]");
        insta::assert_snapshot!(form("<use id='far' href='other.svg#square'/>").refusal(), @"3:1: The clone 'far' refers to nothing in this drawing. Clone a shape of the form again (Edit > Clone > Create Clone), or delete the clone. [missing-source]");
        insta::assert_snapshot!(form("<use id='typed' rinceau:of='nobody' href='#square'/>").refusal(), @"3:1: The clone 'typed' refers to nothing in this drawing. Clone a shape of the form again (Edit > Clone > Create Clone), or delete the clone. [missing-source]");
    }

    #[test]
    fn with_clones_in_a_ring() {
        insta::assert_snapshot!(form("<use id='a' href='#b'/><use id='b' href='#a'/>").refusal(), @"3:1: The clone 'a' contains itself. Delete the clone, or unlink it (Edit > Clone > Unlink Clone). [clone-cycle]");
    }

    #[test]
    fn with_flat_clones() {
        insta::assert_snapshot!(form("<use id='flat' href='#square' transform='scale(1 0)'/>").refusal(), @"3:1: The clone 'flat' is scaled to nothing, or beyond all measure. Scale it back, or delete it. [flat-clone]");
        insta::assert_snapshot!(form("<use id='line' href='#square' transform='matrix(1 1 1 1 0 0)'/>").refusal(), @"3:1: The clone 'line' is scaled to nothing, or beyond all measure. Scale it back, or delete it. [flat-clone]");
    }

    #[test]
    fn with_clones_that_cannot_be_read() {
        insta::assert_snapshot!(form("<use id='odd' href='#square' transform='matrix(NaN 0 0 1 0 0)'/>").refusal(), @"3:1: The object 'odd' cannot be read: its transform cannot be read. Redraw it, or clear its mark. [broken-object]");
        insta::assert_snapshot!(form("<use id='vast' href='#square' transform='scale(1e300) scale(1e300)'/>").refusal(), @"3:1: The clone 'vast' is scaled to nothing, or beyond all measure. Scale it back, or delete it. [flat-clone]");
    }

    #[test]
    fn with_more_copies_than_anyone_can_look_at() {
        insta::assert_snapshot!(form(&HALF.repeat(2).replacen("half", "other", 1)).flag("depth", "40").refusal(), @"2:1: 40 generations of the form 'form' are more than 2000000 copies. At most 20 generations fit; or allow more copies. [too-many-copies]");
        insta::assert_snapshot!(form(HALF).flag("depth", "1000000000").refusal(), @"2:1: 1000000000 generations of the form 'form' are more than 2000000 copies. At most 2000000 generations fit; or allow more copies. [too-many-copies]");
        insta::assert_snapshot!(form(HALF).flag("depth", "1000000000").flag("most", "1e15").refusal(), @"2:1: 1000000000 generations of the form 'form' are more than 20000000 copies. At most 20000000 generations fit. [too-many-copies]");
        let clone = |i| format!("<use id='c{i}' href='#square' transform='translate({i} 1) scale(.5)'/>");
        let many: String = (0..10_000).map(clone).collect();
        insta::assert_snapshot!(form(&many).refusal(), @"2:1: 5 generations of the form 'form' are more than 2000000 copies. At most 2 generations fit; or allow more copies. [too-many-copies]");
        insta::assert_snapshot!(form(HALF).flag("min-size", "1e-300").flag("depth", "1000000000").flag("most", "1000").refusal(), @"2:1: The form 'form' has more than 1000 copies. Make its smallest copy larger, or draw fewer generations. [too-many-copies]");
    }

    #[test]
    fn that_clones_cannot_show() {
        insta::assert_snapshot!(form(HALF).flag("output", "clones").flag("min-size", "1").refusal(), @"2:1: A chain of clones repeats every copy to the last generation, however small. Choose paths as result, or set the smallest copy to 0. [clones-of-one-size]");
        insta::assert_snapshot!(form(HALF).flag("output", "clones").flag("strokes", "fixed").refusal(), @"2:1: Clones keep neither strokes of one width nor joined lines. Choose paths as result, or let strokes scale and lines be. [paths-only]");
        insta::assert_snapshot!(form(HALF).flag("output", "clones").flag("depth", "301").refusal(), @"2:1: A chain of clones has at most 300 generations. Draw fewer generations, or choose paths as result. [too-many-copies]");
    }

    #[test]
    fn in_colours_that_are_none() {
        insta::assert_snapshot!(form(HALF).flag("colours", "red,blueish").refusal(), @"2:1: 'blueish' is no colour. Write colours such as '#14444f,#d2913a', or drawn. [bad-colour]");
    }

    #[test]
    fn that_a_sheet_cannot_change() {
        insta::assert_snapshot!(form("").flag("sheet", "true").refusal(), @"2:1: The form 'form' has no clones to change. Clone its motif (Edit > Clone > Create Clone). [nothing-to-change]");
    }

    /// A clone that grows is drawn as far as there is any page, with a warning.
    #[test]
    fn that_grow_are_cut_off() {
        let growing = "<use id='big' href='#square' transform='translate(9 9) scale(3)'/>";
        let drawing =
            svg(&format!("<g class='rinceau-form'><rect id='square' width='9' height='9'/>{growing}</g>"));
        let done = rinceau(["recurse", "--depth", "1000"]).input(drawing).succeed();
        let notes: Vec<&str> = done.stderr.lines().collect();
        let [larger, left_out] = notes[..] else { panic!("{notes:?}") };
        insta::assert_snapshot!(larger, @"rinceau: note: 2:65: the clone 'big' is larger than its source, so that every generation is");
        insta::assert_snapshot!(left_out, @"rinceau: note: 2:1: the form 'node:1' grows: copies larger than any page are left out (1)");
        assert!(done.text().matches('M').count() < 40 && !done.text().contains("NaN"));
    }
}

/// A closed path, or what should be one, marked.
fn marked(attributes: &str) -> Case {
    case(svg(&format!("<path id='shape' class='rinceau-container' {attributes}/>")))
}

/// A container with a guide.
fn guided(attributes: &str) -> Case {
    case(svg(&format!("{CIRCLE}\n<path id='flow' class='rinceau-guide' {attributes}/>")))
}

/// A container with an element of one leaf.
fn element(spines: &str) -> Case {
    case(svg(&format!(
        "{CIRCLE}\n<g id='leaf' class='rinceau-element'><path d='M50,50 60,60 90,50 60,40Z'/>\n{spines}</g>"
    )))
}

/// 2^40 circles.
fn multiplying_clones() -> String {
    let doubled = |i: usize| format!("<g id='g{}'><use href='#g{i}'/><use href='#g{i}'/></g>", i + 1);
    let groups: String = (0..40).map(doubled).collect();
    svg(&format!(
        "<defs><circle id='g0' r='1'/>{groups}</defs>\n<g class='rinceau-container'><use id='all' href='#g40'/></g>"
    ))
}

/// 10^12 letters.
fn entity_bomb() -> String {
    let tenfold = |i: usize| format!("<!ENTITY a{} '{}'>", i + 1, format!("&a{i};").repeat(10));
    let entities: String = (0..12).map(tenfold).collect();
    format!("<!DOCTYPE svg [<!ENTITY a0 'a'>{entities}]>\n<svg>&a12;</svg>")
}

/// `template` with `#` counted up.
fn numbered(count: usize, template: &str) -> String {
    (0..count).map(|i| template.replace('#', &i.to_string())).collect()
}

/// Not refused: all of a clipped shape is filled, and that is said.
#[test]
fn a_clip_is_told() {
    let clipped = CIRCLE.replace("/>", " clip-path='url(#half)'/>");
    let drawing = svg(&format!("<clipPath id='half'><rect width='100' height='200'/></clipPath>{clipped}"));
    let done = rinceau(["pack"]).input(drawing).succeed();
    insta::assert_snapshot!(done.stderr.trim(), @"rinceau: note: 2:64: a clip hides some of 'sun', but all of it is filled. To fill what shows alone, make that a shape of its own (Path > Intersection)");
}
