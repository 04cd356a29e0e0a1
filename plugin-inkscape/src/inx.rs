//! Inkscape's extension descriptions, generated from the parameter tables.

use rinceau::params::{Kind, Page, ParamSpec};
use rinceau::{GENERATORS, Generator};
use rinceau_format::Role;
use xmlwriter::XmlWriter;

const NAMESPACE: &str = "http://www.inkscape.org/namespace/inkscape/extension";
const MENU: &str = "Ornament";

/// Units for the lengths of a dialog.
const UNITS: &[(&str, &str)] =
    &[("document", "units of the document"), ("mm", "mm"), ("px", "px"), ("in", "inches"), ("pt", "pt")];

/// How much time a run may take.
const QUALITIES: &[(&str, &str)] = &[("full", "Full"), ("quick", "Quick, for Live preview")];

/// Pages of a dialog, in order.
const PAGES: [(Page, &str, &str); 3] =
    [(Page::Basic, "basic", "Basic"), (Page::More, "more", "More"), (Page::Curves, "curves", "Curves")];

/// A picture of what can be chosen in a dialog, on a page of its own. `docs/gallery` draws them.
pub struct Picture {
    generator: &'static str,
    /// Title of the page.
    title: &'static str,
    /// Name of the file, beside the descriptions.
    pub name: &'static str,
    /// The file.
    pub content: &'static [u8],
}

const fn picture(
    generator: &'static str,
    title: &'static str,
    name: &'static str,
    content: &'static [u8],
) -> Picture {
    Picture { generator, title, name, content }
}

pub const PICTURES: [Picture; 5] = [
    picture("grow", "Patterns", "grow-patterns.png", include_bytes!("../inx/grow-patterns.png")),
    picture("grow", "Styles", "grow-styles.png", include_bytes!("../inx/grow-styles.png")),
    picture("pack", "Pictures", "pack-choices.png", include_bytes!("../inx/pack-choices.png")),
    picture("vine", "Pictures", "vine-choices.png", include_bytes!("../inx/vine-choices.png")),
    picture("arrange", "Pictures", "arrange-choices.png", include_bytes!("../inx/arrange-choices.png")),
];

/// Roles in the menu, with what the menu calls them.
const MARKS: &[(&str, &str)] = &[
    ("container", "Container (a shape to fill)"),
    ("guide", "Guide (a line the flow follows)"),
    ("fixed", "Fixed (kept clear and kept as it is)"),
    ("element", "Element (a group to fill with)"),
    ("spine", "Spine (from an element's base to its tip)"),
    ("fixed-spine", "Fixed spine (a line an element must lie along)"),
    ("stem", "Stem (a main stem, that vines and patterns grow from)"),
    ("seed", "Seed (where growth starts)"),
    ("form", "Form (a motif with clones of itself)"),
    ("clone", "Clone (a copy in a form, where it goes on)"),
    ("reference", "Reference (an example that is continued)"),
    ("boundary", "Boundary (a line that stops growth)"),
    ("spray", "Spray (a stroke that paints where things grow)"),
    ("tack", "Tack (a point that stays when others are dragged)"),
    ("none", "Clear marks"),
];

/// Every description: file name and content. `binary` is how the file names the program,
/// with the ending that the system needs.
pub fn all(binary: &str) -> Vec<(String, String)> {
    let mut files = Vec::new();
    for generator in GENERATORS {
        files.push((format!("{}.inx", generator.name), dialog(generator, binary)));
    }
    for (role, title) in MARKS {
        debug_assert!(*role == "none" || Role::from_name(role).is_some());
        let tip = format!("Marks the selected objects: {}", title.to_lowercase());
        files.push((
            format!("mark-{role}.inx"),
            command(&format!("mark-{role}"), title, &tip, &[MENU, "Mark as"], binary),
        ));
    }
    for (operation, title, tip) in rinceau::tack::OPERATIONS {
        files.push((
            format!("tack-{operation}.inx"),
            command(&format!("tack-{operation}"), title, tip, &[MENU, "Tacks"], binary),
        ));
    }
    files.push((
        "update.inx".to_owned(),
        command(
            "update",
            "Update all",
            "Makes every ornament of the drawing again, after the shapes that it fills were changed",
            &[MENU],
            binary,
        ),
    ));
    files.push((
        "resume.inx".to_owned(),
        command(
            "resume",
            "Take out explored form",
            "Puts the form of a picture in the layer of explored forms back into the drawing, to be changed",
            &[MENU],
            binary,
        ),
    ));
    files.push((
        "check.inx".to_owned(),
        command(
            "check",
            "Check document",
            "Lists what is marked, and what is wrong with it",
            &[MENU],
            binary,
        ),
    ));
    files.push((
        "diagnostics.inx".to_owned(),
        command(
            "diagnostics",
            "Diagnostics",
            "Versions, folders, how long the last run took, and the last error: for a report",
            &[MENU],
            binary,
        ),
    ));
    for (format, title, mime) in FILES {
        files.push((format!("open-{format}.inx"), file_format("open", format, title, mime, binary)));
        files.push((format!("save-{format}.inx"), file_format("save", format, title, mime, binary)));
    }
    files
}

/// File formats that Inkscape opens and saves through us: ending, what its dialogs call it, and type.
const FILES: &[(&str, &str, &str)] = &[
    ("json", "Rinceau scene (*.json)", "application/json"),
    ("cfdg", "Context Free grammar, recursive forms (*.cfdg)", "text/x-cfdg"),
];

/// A file format in Open or Save As.
fn file_format(way: &str, format: &str, title: &str, mime: &str, binary: &str) -> String {
    let tool = format!("{way}-{format}");
    let mut inx = Inx::new(&tool, title);
    inx.hidden("tool", &tool);
    inx.0.start_element(if way == "open" { "input" } else { "output" });
    inx.text("extension", &[], &format!(".{format}"));
    inx.text("mimetype", &[], mime);
    inx.text("filetypename", &[], title);
    inx.text("filetypetooltip", &[], "What is marked in a drawing, and nothing else of it");
    if way == "save" {
        inx.text("dataloss", &[], "true");
    }
    inx.0.end_element();
    inx.script(binary)
}

struct Inx(XmlWriter);

impl Inx {
    fn new(tool: &str, title: &str) -> Self {
        let mut xml = XmlWriter::new(xmlwriter::Options {
            indent: xmlwriter::Indent::Spaces(2),
            ..xmlwriter::Options::default()
        });
        xml.write_declaration();
        xml.start_element("inkscape-extension");
        xml.write_attribute("xmlns", NAMESPACE);
        let mut inx = Inx(xml);
        inx.text("name", &[], title);
        inx.text("id", &[], &format!("org.rinceau.{tool}"));
        inx
    }

    fn text(&mut self, element: &str, attributes: &[(&str, &str)], text: &str) {
        self.0.start_element(element);
        for (name, value) in attributes {
            self.0.write_attribute(name, *value);
        }
        self.0.set_preserve_whitespaces(true);
        self.0.write_text(text);
        self.0.end_element();
        self.0.set_preserve_whitespaces(false);
    }

    fn hidden(&mut self, name: &str, value: &str) {
        self.text("param", &[("name", name), ("type", "string"), ("gui-hidden", "true")], value);
    }

    fn finish(mut self, tip: &str, menus: &[&str], live_preview: bool, binary: &str) -> String {
        self.0.start_element("effect");
        if !live_preview {
            self.0.write_attribute("needs-live-preview", "false");
        }
        self.text("object-type", &[], "all");
        self.0.start_element("effects-menu");
        for menu in menus {
            self.0.start_element("submenu");
            self.0.write_attribute("name", *menu);
        }
        for _ in menus {
            self.0.end_element();
        }
        self.0.end_element();
        self.text("menu-tip", &[], tip);
        self.0.end_element();
        self.script(binary)
    }

    fn script(mut self, binary: &str) -> String {
        self.0.start_element("script");
        // Without a space around it: it is the name of a file.
        self.text("command", &[("location", "inx")], binary);
        self.0.end_document()
    }
}

/// A menu entry without a dialog: it runs at once.
fn command(tool: &str, title: &str, tip: &str, menus: &[&str], binary: &str) -> String {
    let mut inx = Inx::new(tool, title);
    inx.hidden("tool", tool);
    inx.finish(tip, menus, false, binary)
}

fn dialog(generator: &Generator, binary: &str) -> String {
    let mut inx = Inx::new(generator.name, generator.title);
    inx.0.start_element("param");
    inx.0.write_attribute("name", "tab");
    inx.0.write_attribute("type", "notebook");
    for (page, name, title) in PAGES {
        if generator.table.iter().all(|spec| spec.page != page) {
            continue;
        }
        inx.0.start_element("page");
        inx.0.write_attribute("name", name);
        inx.0.write_attribute("gui-text", title);
        for spec in generator.table.iter().filter(|spec| spec.page == page) {
            parameter(&mut inx, spec);
        }
        if page == Page::Basic {
            number(
                &mut inx,
                "seed",
                "int",
                "Variation",
                "Another number, another composition",
                ("0", "99999", "1"),
                false,
            );
        }
        if page == Page::More {
            let lengths =
                "What the numbers for width and gap count in; the unit of the document is that of its ruler";
            combo(&mut inx, "unit", "Lengths in", lengths, (UNITS, "document"));
            let quality = "Quick shows what there is after a moment, which matters for large shapes alone. Update all makes it in full";
            combo(&mut inx, "quality", "Quality", quality, (QUALITIES, "full"));
            number(
                &mut inx,
                "time-limit",
                "int",
                "Longest run in seconds",
                "After this long the best so far is used",
                ("1", "30", "20"),
                false,
            );
        }
        inx.0.end_element();
    }
    for picture in PICTURES.iter().filter(|picture| picture.generator == generator.name) {
        inx.0.start_element("page");
        inx.0.write_attribute("name", &picture.title.to_lowercase());
        inx.0.write_attribute("gui-text", picture.title);
        inx.text("image", &[], picture.name);
        inx.0.end_element();
    }
    inx.0.start_element("page");
    inx.0.write_attribute("name", "help");
    inx.0.write_attribute("gui-text", "Help");
    for line in help(generator) {
        inx.text("label", &[], line);
    }
    inx.0.end_element();
    inx.0.end_element();
    inx.hidden("tool", generator.name);
    inx.finish(generator.about, &[MENU], true, binary)
}

/// What the help page says.
fn help(generator: &Generator) -> &'static [&'static str] {
    match generator.name {
        "pack" => &[
            "Select a closed shape and press Apply: it fills with ornament that follows its outline.",
            "Select open lines together with it, and the ornament follows those.",
            "For more, mark objects with Extensions > Ornament > Mark as: shapes to fill as containers, lines as guides, what must stay free as fixed, and your own leaves as elements, each grouped with a straight spine.",
            "Run it again after a change: the layer is replaced, not added.",
            "A length of 0 is chosen to suit the size of the shape. Lengths are in the units of the document unless you choose another unit.",
        ],
        "vine" => &[
            "Select a closed shape and press Apply: a vine finds its way through it, with leaves and flowers.",
            "Select open lines together with the shape, and they become its main stems: the vine runs smoothly through their nodes.",
            "For more, mark objects with Extensions > Ornament > Mark as: shapes to fill as containers, lines as stems, small dots as seeds where a stem starts, what must stay free as fixed. A group marked as element, with a straight spine and the kind leaf, flower or bud, is used instead of the built-in ones.",
            "Lists such as 1.4,1.2,1 give a value per level: the main stem first, then its branches, then theirs.",
            "Leaves and flowers are clones: edit one in the layer's symbols, and all follow. For cutting and plotting choose copies, and one shape or lines for the stems.",
        ],
        "recurse" => &[
            "Select a closed shape and press Apply: a built-in rosette fits into it.",
            "Draw a motif, clone it (Edit > Clone > Create Clone), and move, turn, scale, shear or mirror the clones. Group motif and clones, select the group and press Apply: every clone gets clones of its own, and so on.",
            "What lies on top in the group lies on top in every copy.",
            "Generations is how often it goes on; switch on Live preview and change the drawing.",
            "A closed shape selected with the group, or marked as container, is a frame that the form is fitted into, so that the motif can stay beside it.",
            "A clone placed exactly: mark points as tacks and a line as guide, and use Extensions > Ornament > Tacks.",
            "Several groups may clone each other: mark each as form.",
        ],
        "arrange" => &[
            "Select a closed shape and press Apply: a built-in pattern fills it.",
            "Draw some elements as they should be arranged, about five rows of five, group them, and mark the group as reference (Extensions > Ornament > Mark as). Those in the middle are copied; those around them show how they stand.",
            "Select a closed shape, or mark one as container, and press Apply: the example goes on over it.",
            "Repeated as a tile, the box around the shape fits its copies on all sides; the example is stretched a little so that whole rows go in.",
            "Strokes marked as spray are filled as wide as they are, each with parameters of its own if it has some; lines marked as boundary stop growth; a dot marked as seed is where it starts; with the flow, elements turn as guides do.",
            "Elements that stand for the same thing are clones of each other, look the same, or have one name as rinceau:symbol.",
            "Elements are clones: change one in the layer's symbols, and all follow.",
        ],
        "connect" => &[
            "Draws lines between the elements of an example that count as neighbours: blue ones can be flipped, grey ones lie at the border.",
            "Where a line joins the wrong two, select it and choose this entry again: the other diagonal takes its place, orange from then on. Then continue the example.",
            "Delete the layer when you no longer need it; what is flipped stays with the example.",
        ],
        "grow" => &[
            "Select a closed shape and press Apply: the pattern grows into it, into the largest empty place first.",
            "Mark small dots as seeds to say where growth starts. With fixed blossoms, or a stem of your own, it grows around them and along it.",
            "Draw your own blossom or leaf, group it with a straight spine, mark it as element, and name it as the pattern does (rinceau:symbol): it is used instead.",
            "A symmetry grows everything together with its images: rosettes in the shape, bands and wallpapers that repeat without a seam in the rectangle around it.",
            "Rules of your own are a text file (docs/rules.md), or text in the drawing's metadata.",
        ],
        _ => &[],
    }
}

fn parameter(inx: &mut Inx, spec: &ParamSpec) {
    match spec.kind {
        Kind::Length => {
            number(inx, spec.name, "float", spec.label, spec.help, ("0", "10000", spec.default), true)
        }
        Kind::Number { min, max } => number(
            inx,
            spec.name,
            "float",
            spec.label,
            spec.help,
            (&min.to_string(), &max.to_string(), spec.default),
            true,
        ),
        Kind::Whole { min, max } => number(
            inx,
            spec.name,
            "int",
            spec.label,
            spec.help,
            (&min.to_string(), &max.to_string(), spec.default),
            false,
        ),
        Kind::Numbers { .. } | Kind::Lengths => {
            inx.0.start_element("param");
            common(inx, spec.name, "string", &format!("{}:", spec.label), spec.help);
            inx.0.set_preserve_whitespaces(true);
            inx.0.write_text(spec.default);
            inx.0.end_element();
            inx.0.set_preserve_whitespaces(false);
        }
        Kind::Choice(choices) | Kind::Names(choices) => {
            combo(inx, spec.name, spec.label, spec.help, (choices, spec.default));
        }
        Kind::Rules(choices) => {
            combo(inx, spec.name, spec.label, spec.help, (choices, spec.default));
            inx.0.start_element("param");
            let file = format!("{}-file", spec.name);
            common(
                inx,
                &file,
                "path",
                "Or a file of rules:",
                "Growth rules of your own, instead of a pattern",
            );
            inx.0.write_attribute("mode", "file");
            inx.0.write_attribute("filetypes", "rules,txt");
            inx.0.end_element();
        }
        Kind::Switch => inx.text(
            "param",
            &[
                ("name", &name(spec.name)),
                ("type", "bool"),
                ("gui-text", spec.label),
                ("gui-description", spec.help),
            ],
            spec.default,
        ),
    }
}

/// A drop-down list. Its first option is the default; there is no attribute for it.
fn combo(inx: &mut Inx, param: &str, label: &str, help: &str, (choices, default): (&[(&str, &str)], &str)) {
    inx.0.start_element("param");
    common(inx, param, "optiongroup", &format!("{label}:"), help);
    inx.0.write_attribute("appearance", "combo");
    let (first, others): (Vec<_>, Vec<_>) = choices.iter().partition(|(value, _)| *value == default);
    for (value, label) in first.into_iter().chain(others) {
        inx.text("option", &[("value", value)], label);
    }
    inx.0.end_element();
}

fn number(
    inx: &mut Inx,
    param: &str,
    kind: &str,
    label: &str,
    help: &str,
    (min, max, default): (&str, &str, &str),
    decimals: bool,
) {
    inx.0.start_element("param");
    common(inx, param, kind, &format!("{label}:"), help);
    inx.0.write_attribute("min", min);
    inx.0.write_attribute("max", max);
    if decimals {
        inx.0.write_attribute("precision", "2");
    }
    inx.0.set_preserve_whitespaces(true);
    inx.0.write_text(default);
    inx.0.end_element();
    inx.0.set_preserve_whitespaces(false);
}

fn common(inx: &mut Inx, param: &str, kind: &str, label: &str, help: &str) {
    inx.0.write_attribute("name", &name(param));
    inx.0.write_attribute("type", kind);
    inx.0.write_attribute("gui-text", label);
    inx.0.write_attribute("gui-description", help);
}

/// Inkscape's parameter names have no hyphens.
fn name(param: &str) -> String {
    param.replace('-', "_")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The committed descriptions are those the tables make. `RINCEAU_BLESS=1` rewrites them.
    #[test]
    fn committed_descriptions_are_current() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("inx");
        let files = all("bin/rinceau");
        if std::env::var_os("RINCEAU_BLESS").is_some() {
            std::fs::create_dir_all(&folder).unwrap();
            for (name, content) in &files {
                std::fs::write(folder.join(name), content).unwrap();
            }
        }
        for (name, content) in &files {
            let committed = std::fs::read_to_string(folder.join(name)).unwrap_or_default();
            assert_eq!(&committed, content, "{name} is stale: run the tests with RINCEAU_BLESS=1");
        }
        // And the pictures.
        assert_eq!(std::fs::read_dir(&folder).unwrap().count(), files.len() + PICTURES.len());
    }

    /// The first page of a dialog can be taken in at a glance.
    #[test]
    fn first_pages_are_short() {
        for generator in GENERATORS {
            let basic = generator.table.iter().filter(|spec| spec.page == Page::Basic).count();
            assert!(basic < 6, "{}: {basic} parameters and the variation", generator.name);
        }
    }
}
