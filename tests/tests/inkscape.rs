//! The extension inside a real Inkscape, on a virtual display.
//!
//! A failing extension opens a modal dialog, which blocks a run until somebody closes it: one
//! test does that with `xdotool`. That the drawing goes back byte by byte is tested without
//! Inkscape, for every kind of refusal, in `reject.rs`.

mod support;

use rinceau_format::Role;
use roxmltree::Node;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;
use support::*;

/// A user of Inkscape with nothing but our extension.
struct User {
    home: tempfile::TempDir,
    /// One Inkscape at a time: two at once are slower than one after the other.
    _turn: MutexGuard<'static, ()>,
}

impl User {
    fn new() -> Self {
        static TURN: Mutex<()> = Mutex::new(());
        let turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
        let user = User { home: folder(), _turn: turn };
        let mut install = Command::new(binary());
        install.arg("install");
        user.at_home(&mut install);
        let done = Run::of(install).succeed();
        assert!(done.text().contains(&user.extensions().display().to_string()), "{}", done.text());
        user
    }

    fn extensions(&self) -> PathBuf {
        self.home.path().join("profile/extensions/rinceau")
    }

    fn at_home(&self, command: &mut Command) {
        command.env("HOME", self.home.path()).env("INKSCAPE_PROFILE_DIR", self.home.path().join("profile"));
        for variable in ["XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_CACHE_HOME"] {
            command.env_remove(variable);
        }
        // No session bus: a call to one that does not answer waits 25 s, and one that answers
        // may lead to another Inkscape, already open.
        command.env("DBUS_SESSION_BUS_ADDRESS", "disabled:").env("NO_AT_BRIDGE", "1");
        // Messages in English, whoever runs the tests.
        command.env("LC_ALL", "C.UTF-8");
    }

    /// Opens a drawing, runs actions, and returns what it is then.
    fn edit(&self, drawing: &str, actions: &str) -> String {
        let input = file(&self.home, "in.svg", drawing);
        let output = self.home.path().join("out.svg");
        let _ = std::fs::remove_file(&output);
        let mut inkscape = Command::new("xvfb-run");
        inkscape.args(["-a", "inkscape", "--with-gui", "--batch-process"]);
        inkscape
            .arg(format!("--actions={actions};export-filename:{};export-do", output.display()))
            .arg(&input);
        self.at_home(&mut inkscape);
        let done = Run::of(inkscape).limit(Duration::from_secs(90)).done();
        std::fs::read_to_string(&output)
            .unwrap_or_else(|error| panic!("Inkscape wrote nothing ({error}): {}", done.stderr))
    }

    /// The same where actions open dialogs with a message, which Escape closes.
    fn edit_with_dialogs(&self, drawing: &str, actions: &str) -> String {
        let input = file(&self.home, "in.svg", drawing);
        let output = self.home.path().join("out.svg");
        let _ = std::fs::remove_file(&output);
        // The dialog takes the keys of the window that it belongs to.
        let script = "inkscape --with-gui --batch-process --actions=\"$1\" \"$2\" & \
            for i in $(seq 120); do sleep 0.5; kill -0 $! 2>/dev/null || break; \
            xdotool search --onlyvisible --name Inkscape windowfocus key Escape >/dev/null 2>&1 || true; done; \
            kill $! 2>/dev/null; wait";
        let mut session = Command::new("xvfb-run");
        session.args(["-a", "bash", "-c", script, "bash"]);
        session.arg(format!("{actions};export-filename:{};export-do", output.display())).arg(&input);
        self.at_home(&mut session);
        let done = Run::of(session).limit(Duration::from_secs(90)).done();
        std::fs::read_to_string(&output).unwrap_or_else(|error| panic!("{error}: {done:?}"))
    }
}

/// The drawing apart from our layers: names, ids, geometry and transforms, in order. Inkscape
/// adds an id to the root and empty definitions.
fn rest(text: &str) -> Vec<String> {
    let xml = parse(text);
    let ours = layers(&xml);
    let is_ours = |node: &Node| node.ancestors().any(|ancestor| ours.contains(&ancestor));
    let is_svg = |node: &Node| node.tag_name().namespace() == Some("http://www.w3.org/2000/svg");
    let objects = xml.descendants().filter(|node| node.is_element() && is_svg(node) && !is_ours(node));
    let kept =
        ["id", "d", "transform", "x", "y", "width", "height", "cx", "cy", "r", "viewBox", "style", "class"];
    objects
        .filter(|node| node.tag_name().name() != "defs" || node.children().any(|child| child.is_element()))
        .map(|node| {
            let kept = kept.iter().filter(|name| **name != "id" || node != xml.root_element());
            let attributes = kept.filter_map(|name| Some(format!("{name}={}", node.attribute(*name)?)));
            format!("{} {}", node.tag_name().name(), attributes.collect::<Vec<_>>().join(" "))
        })
        .collect()
}

#[test]
fn a_selected_shape_fills_and_fills_anew() {
    let user = User::new();
    let plain = svg(
        "<path id=\"leaf\" d=\"M 20,100 C 60,20 140,20 180,100 140,180 60,180 20,100 Z\" style=\"fill:#224466\"/>\n<rect id=\"frame\" x=\"1\" y=\"2\" width=\"190\" height=\"180\" style=\"fill:none\"/>",
    );
    let once = user.edit(&plain, "select-by-id:leaf;org.rinceau.pack.noprefs");
    assert_eq!(rest(&once), rest(&plain));
    let xml = parse(&once);
    let [layer] = layers(&xml)[..] else { panic!("{} layers:\n{once:.3000}", layers(&xml).len()) };
    assert_eq!(layer.attribute((INKSCAPE, "groupmode")), Some("layer"));
    assert_eq!(layer.attribute((INKSCAPE, "label")), Some("Ornament - leaf"));
    assert_eq!(layer.attribute((RINCEAU, "result")), Some("pack"));
    assert_eq!(layer.attribute((RINCEAU, "source")), Some("leaf"));
    assert_eq!(layer.attribute((RINCEAU, "seed")), Some("1"));
    assert_eq!(layer.attribute((RINCEAU, "params")), Some("{}"), "defaults are no parameters");
    assert!(elements(layer).len() > 10, "{} elements", elements(layer).len());

    // Saved by Inkscape, opened again: the layer is made anew, not added.
    let hidden = once.replacen("id=\"ornament-leaf\"", "id=\"ornament-leaf\" style=\"opacity:0.5\"", 1);
    let twice = user.edit(&hidden, "select-by-id:leaf;org.rinceau.pack.noprefs");
    assert_eq!(rest(&twice), rest(&plain));
    let xml = parse(&twice);
    let [layer] = layers(&xml)[..] else { panic!("{} layers", layers(&xml).len()) };
    assert_eq!(layer.attribute("id"), Some("ornament-leaf"));
    assert_eq!(layer.attribute("style"), Some("opacity:0.5"));
    assert!(elements(layer).len() > 10);
}

#[test]
fn a_selected_shape_fills_with_growth() {
    let user = User::new();
    let plain = svg(
        "<path id=\"leaf\" d=\"M 20,100 C 60,20 140,20 180,100 140,180 60,180 20,100 Z\" style=\"fill:#e8e0c8\"/>\n<circle id=\"start\" class=\"rinceau-seed\" cx=\"40\" cy=\"100\" r=\"1\" style=\"fill:none\"/>",
    );
    let once = user.edit(&plain, "select-by-id:leaf;org.rinceau.grow.noprefs");
    assert_eq!(rest(&once), rest(&plain));
    let xml = parse(&once);
    let [layer] = layers(&xml)[..] else { panic!("{} layers:\n{once:.3000}", layers(&xml).len()) };
    assert_eq!(layer.attribute((RINCEAU, "result")), Some("grow"));
    assert_eq!(layer.attribute((RINCEAU, "params")), Some("{}"), "defaults are no parameters");
    assert!(elements(layer).len() > 100, "{} elements", elements(layer).len());
}

/// Rules from a file that is chosen in the dialog, whose values Inkscape keeps among its preferences,
/// and from the drawing's metadata.
#[test]
fn growth_takes_rules_from_a_file_and_from_the_drawing() {
    let user = User::new();
    let rules = |radius: u32| {
        format!(
            "element seed: point\nelement dot: circle\nrule seed -> dot d {{ d.set(parent, {radius}); parent.sterile = true; }}\nlook dot: art fill"
        )
    };
    let shape = "<rect id=\"panel\" x=\"20\" y=\"20\" width=\"160\" height=\"160\" style=\"fill:#e8e0c8\"/>";
    let metadata = format!(
        "<metadata><rinceau:rules name=\"three\">{}</rinceau:rules></metadata>\n",
        rules(3).replace('>', "&gt;")
    );
    let width = |drawing: &str| {
        let xml = parse(drawing);
        let [layer] = layers(&xml)[..] else { panic!("{} layers:\n{drawing:.3000}", layers(&xml).len()) };
        let [dot] = elements(layer)[..] else { panic!("one dot:\n{drawing:.3000}") };
        let path = kurbo::BezPath::from_svg(dot.attribute("d").expect("a path")).unwrap();
        kurbo::Shape::bounding_box(&path).width()
    };
    // A panel of 160 units is 100 units of the rules wide.
    let drawn = user.edit(&svg(&(metadata.clone() + shape)), "select-by-id:panel;org.rinceau.grow.noprefs");
    assert!((width(&drawn) - 2.0 * 3.0 * 1.6).abs() < 0.1, "{}", width(&drawn));

    let path = file(&user.home, "own.rules", rules(7));
    let preferences = format!(
        "<inkscape version=\"1\"><group id=\"extensions\" org.rinceau.grow.rules_file=\"{}\"/></inkscape>",
        path.display()
    );
    std::fs::write(user.home.path().join("profile/preferences.xml"), preferences).unwrap();
    let drawn = user.edit(&svg(&(metadata + shape)), "select-by-id:panel;org.rinceau.grow.noprefs");
    assert!((width(&drawn) - 2.0 * 7.0 * 1.6).abs() < 0.1, "{}", width(&drawn));
}

#[test]
fn a_selected_shape_grows_a_vine_and_grows_anew() {
    let user = User::new();
    let plain = svg(
        "<path id=\"leaf\" d=\"M 20,100 C 60,20 140,20 180,100 140,180 60,180 20,100 Z\" style=\"fill:#224466\"/>\n<rect id=\"frame\" x=\"1\" y=\"2\" width=\"190\" height=\"180\" style=\"fill:none\"/>",
    );
    let once = user.edit(&plain, "select-by-id:leaf;org.rinceau.vine.noprefs");
    assert_eq!(rest(&once), rest(&plain));
    let xml = parse(&once);
    let [layer] = layers(&xml)[..] else { panic!("{} layers:\n{once:.3000}", layers(&xml).len()) };
    assert_eq!(layer.attribute((INKSCAPE, "groupmode")), Some("layer"));
    assert_eq!(layer.attribute((INKSCAPE, "label")), Some("Ornament - leaf"));
    assert_eq!(layer.attribute((RINCEAU, "result")), Some("vine"));
    assert_eq!(layer.attribute((RINCEAU, "source")), Some("leaf"));
    assert_eq!(layer.attribute((RINCEAU, "seed")), Some("1"));
    assert_eq!(layer.attribute((RINCEAU, "params")), Some("{}"), "defaults are no parameters");
    let stems = sublayer(layer, "stems");
    assert!(stems.children().filter(Node::is_element).count() > 5);
    assert!(elements(layer).len() > 5, "{} elements", elements(layer).len());

    // Saved by Inkscape, opened again: the layer is made anew, not added.
    let faded = once.replacen("id=\"ornament-leaf\"", "id=\"ornament-leaf\" style=\"opacity:0.5\"", 1);
    let twice = user.edit(&faded, "select-by-id:leaf;org.rinceau.vine.noprefs");
    assert_eq!(rest(&twice), rest(&plain));
    let xml = parse(&twice);
    let [layer] = layers(&xml)[..] else { panic!("{} layers", layers(&xml).len()) };
    assert_eq!(layer.attribute("id"), Some("ornament-leaf"));
    assert_eq!(layer.attribute("style"), Some("opacity:0.5"));
    assert!(elements(layer).len() > 5);
}

/// Motif and clone made as an artist makes them: clone, move, turn, shrink, group.
#[test]
fn a_motif_and_its_clone_repeat_and_repeat_anew() {
    let user = User::new();
    let plain = svg(
        "<g id=\"art\" transform=\"translate(5,5)\"><path id=\"trunk\" d=\"M 90,180 V 120\" style=\"fill:none;stroke:#224466;stroke-width:6\"/></g>",
    );
    let cloned = user.edit(
        &plain,
        "select-by-id:trunk;clone;transform-translate:0,-60;transform-rotate:30;select-by-id:trunk;selection-group",
    );
    let xml = parse(&cloned);
    let clone = xml.descendants().find(|node| node.tag_name().name() == "use").expect("a clone");
    let group = clone.parent_element().unwrap().attribute("id").unwrap().to_owned();
    let once = user.edit(&cloned, &format!("select-by-id:{group};org.rinceau.recurse.noprefs"));
    assert_eq!(rest(&once), rest(&cloned));
    let xml = parse(&once);
    let [layer] = layers(&xml)[..] else { panic!("{} layers:\n{once:.3000}", layers(&xml).len()) };
    assert_eq!(layer.attribute((RINCEAU, "result")), Some("recurse"));
    assert_eq!(layer.attribute((RINCEAU, "source")), Some(group.as_str()));
    let made = sublayer(layer, "form");
    let data: Vec<&str> = made.descendants().filter_map(|node| node.attribute("d")).collect();
    let lines: usize = data.iter().map(|d| d.matches(['M', 'm']).count()).sum();
    assert_eq!(lines, 5, "a line for each generation: {data:?}");

    let twice = user.edit(&once, &format!("select-by-id:{group};org.rinceau.recurse.noprefs"));
    assert_eq!(layers(&parse(&twice)).len(), 1);
    assert_eq!(rest(&twice), rest(&cloned));
}

/// An example marked and continued over a selected shape; then the shape is made wider, and all is
/// updated.
#[test]
fn an_example_goes_on_and_follows_its_shape() {
    let user = User::new();
    let mut example = String::new();
    for (row, column) in (0..6).flat_map(|row| (0..5).map(move |column| (row, column))) {
        let (x, y) = (8 * column + 4 * (row % 2), 4 * row);
        example += &format!("<rect id=\"b{row}-{column}\" x=\"{x}\" y=\"{y}\" width=\"7\" height=\"3\"/>");
    }
    let plain = svg(&format!(
        "<g id=\"bricks\">{example}</g>\n<rect id=\"wall\" x=\"60\" y=\"40\" width=\"60\" height=\"100\" style=\"fill:none\"/>"
    ));
    let marked = user.edit(&plain, "select-by-id:bricks;org.rinceau.mark-reference.noprefs");
    let once = user.edit(&marked, "select-by-id:wall;org.rinceau.arrange.noprefs");
    assert_eq!(rest(&once), rest(&marked));
    let count = |text: &str| elements(layers(&parse(text))[0]).len();
    assert!(count(&once) > 80, "{}", count(&once));
    // An edge of the drawn connectivity is flipped by selecting it.
    let drawn = user.edit(&marked, "select-clear;org.rinceau.connect.noprefs");
    let xml = parse(&drawn);
    let [layer] = layers(&xml)[..] else { panic!("{} layers", layers(&xml).len()) };
    let is_chosen = |node: &Node| node.attribute((RINCEAU, "of")) == Some("b2-1 b2-2");
    let edge = layer.descendants().find(is_chosen).and_then(|node| node.attribute("id")).expect("an edge");
    let flipped = user.edit(&drawn, &format!("select-by-id:{edge};org.rinceau.connect.noprefs"));
    assert!(flipped.contains("rinceau:flip=\"b2-1 b2-2\"") && layers(&parse(&flipped)).len() == 1);

    let wider = once.replacen("width=\"60\"", "width=\"120\"", 1);
    let updated = user.edit(&wider, "org.rinceau.update.noprefs");
    assert_eq!(layers(&parse(&updated)).len(), 1);
    assert!(count(&updated) > 3 * count(&once) / 2, "{} after {}", count(&updated), count(&once));
}

/// A tack, a guide and a clone, in one session.
#[test]
fn a_clone_is_dragged_about_a_tack() {
    let user = User::new();
    let plain = svg(
        "<rect id=\"square\" x=\"20\" y=\"20\" width=\"20\" height=\"20\"/>\n<use id=\"copy\" href=\"#square\" xlink:href=\"#square\" xmlns:xlink=\"http://www.w3.org/1999/xlink\"/>\n<circle id=\"pin\" cx=\"20\" cy=\"20\" r=\"1\"/>\n<path id=\"way\" d=\"M 40,20 L 20,60\"/>",
    );
    let after = user.edit(
        &plain,
        "select-by-id:pin;org.rinceau.mark-tack.noprefs;select-clear;select-by-id:way;org.rinceau.mark-guide.noprefs;select-clear;select-by-id:copy;org.rinceau.tack-drag.noprefs",
    );
    let xml = parse(&after);
    // A quarter turn, and twice as large, about the tack.
    assert_eq!(by_id(&xml, "copy").attribute("transform"), Some("matrix(0 2 -2 0 60 -20)"));
    assert_eq!(by_id(&xml, "square").attribute("transform"), None);
}

fn sublayer<'a, 'i>(layer: Node<'a, 'i>, label: &str) -> Node<'a, 'i> {
    let found = layer.children().find(|node| node.attribute((INKSCAPE, "label")) == Some(label));
    found.unwrap_or_else(|| panic!("no sublayer {label}"))
}

/// A drawing in millimetres with layers, a moved and turned group, and marks.
const IN_MM: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" xmlns:sodipodi="http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd" xmlns:rinceau="urn:rinceau:1" width="210mm" height="297mm" viewBox="0 0 210 297">
  <g id="paper" inkscape:groupmode="layer" inkscape:label="Paper"><rect id="sheet" x="0" y="0" width="210" height="297" style="fill:#ffffee"/></g>
  <g id="ink" inkscape:groupmode="layer" inkscape:label="Ink" transform="translate(100,100)">
    <g id="turned" transform="rotate(30) scale(2)">
      <rect id="panel" rinceau:role="container" class="rinceau-container" inkscape:label="Panel" x="-30" y="-20" width="60" height="40" style="fill:none;stroke:#000000"/>
      <path id="flow" rinceau:role="guide" class="rinceau-guide" d="M -28,0 H 28" style="fill:none;stroke:#ff0000"/>
    </g>
    <circle id="dot" cx="0" cy="80" r="9"/>
  </g>
</svg>
"##;

#[test]
fn a_drawing_in_mm_with_layers_and_a_turned_group() {
    let user = User::new();
    let after = user.edit(IN_MM, "org.rinceau.pack.noprefs");
    assert_eq!(rest(&after), rest(IN_MM));
    let xml = parse(&after);
    let [layer] = layers(&xml)[..] else { panic!("{} layers", layers(&xml).len()) };
    assert_eq!(layer.attribute((INKSCAPE, "label")), Some("Ornament - Panel"));
    assert_eq!(layer.parent_element(), Some(xml.root_element()));
    assert!(elements(layer).len() > 10);
    for element in elements(layer) {
        for d in element.descendants().filter_map(|node| node.attribute("d")) {
            assert!(start_is_in_panel(d), "outside the panel: {d:.60}");
        }
    }
}

/// True if the first point of path data is in the panel of [`IN_MM`], in root units.
fn start_is_in_panel(d: &str) -> bool {
    let mut numbers =
        d.split(|c: char| c.is_ascii_alphabetic() || c == ',' || c == ' ').filter_map(|n| n.parse().ok());
    let (x, y): (f64, f64) = (numbers.next().unwrap(), numbers.next().unwrap());
    let (sin, cos) = 30f64.to_radians().sin_cos();
    let (dx, dy) = ((x - 100.0) / 2.0, (y - 100.0) / 2.0);
    let (u, v) = (cos * dx + sin * dy, -sin * dx + cos * dy);
    u.abs() <= 30.0 && v.abs() <= 20.0
}

#[test]
fn marks_are_set_changed_and_cleared() {
    let user = User::new();
    let plain = svg(
        "<path id=\"shape\" d=\"M 20,20 H 180 V 180 Z\" style=\"fill:#ff8800;opacity:0.9\"/>\n<path id=\"line\" d=\"M 20,20 H 180\"/>\n<path id=\"other\" d=\"M 0,0 H 9\"/>",
    );
    // All in one session: every action sees what the one before it did.
    let after = user.edit(
        &plain,
        "select-by-id:shape;org.rinceau.mark-container.noprefs;select-clear;select-by-id:line;org.rinceau.mark-guide.noprefs;select-clear;select-by-id:other;org.rinceau.mark-fixed.noprefs;org.rinceau.mark-none.noprefs",
    );
    let xml = parse(&after);
    let shape = by_id(&xml, "shape");
    assert_eq!(shape.attribute((RINCEAU, "role")), Some("container"));
    assert_eq!(shape.attribute("class"), Some("rinceau-container"));
    assert_eq!(shape.attribute("style"), Some("opacity:0.9;fill:none;stroke:#000000"));
    assert_eq!(shape.attribute("d"), Some("M 20,20 H 180 V 180 Z"));
    let line = by_id(&xml, "line");
    assert_eq!(line.attribute((RINCEAU, "role")), Some("guide"));
    assert_eq!(line.attribute("style"), Some("fill:none;stroke:#ff0000;marker-end:url(#rinceau-arrow)"));
    assert_eq!(by_id(&xml, "rinceau-arrow").tag_name().name(), "marker");
    let other = by_id(&xml, "other");
    assert_eq!(other.attribute((RINCEAU, "role")), None);
    assert_eq!(other.attribute("class").unwrap_or_default(), "");
}

/// An artist paints a leaf, moves one, deletes one and reshapes the ornament in Inkscape itself, saves,
/// opens the drawing again and updates: all of that is there. Undo takes the whole update back.
#[test]
fn an_update_keeps_what_was_done_by_hand() {
    let user = User::new();
    let plain = svg("<path id=\"leaf\" d=\"M 20,20 H 180 V 180 H 20 Z\" style=\"fill:#e8e0c8\"/>");
    let once = user.edit(&plain, "select-by-id:leaf;org.rinceau.pack.noprefs");
    let piece = |number: usize| format!("ornament-leaf-elements-{number}");
    let by_hand = format!(
        "select-by-id:{};object-set-property:fill,#ff0000;select-clear;select-by-id:{};transform-translate:200,10;select-clear;select-by-id:{};delete-selection;select-clear;select-by-id:leaf;object-set-attribute:d,M 20 20 H 180 V 150 H 20 Z;select-clear",
        piece(3),
        piece(5),
        piece(7)
    );
    let edited = user.edit(&once, &by_hand);
    let updated = user.edit(&edited, "org.rinceau.update.noprefs");
    let (before, after) = (parse(&edited), parse(&updated));
    assert_eq!(by_id(&after, "leaf").attribute("d"), Some("M 20 20 H 180 V 150 H 20 Z"));
    let style = |id: &str| by_id(&after, id).attribute("style").unwrap_or_default().to_owned();
    let painted = by_id(&after, &piece(3));
    let is_red =
        painted.descendants().any(|node| node.attribute("style").is_some_and(|s| s.contains("#ff0000")));
    assert!(is_red, "{}", style(&piece(3)));
    for name in ["d", "transform", "style"] {
        assert_eq!(by_id(&after, &piece(5)).attribute(name), by_id(&before, &piece(5)).attribute(name));
    }
    assert!(!after.descendants().any(|node| node.attribute("id") == Some(&piece(7))));
    // Something else was made again.
    let differs = (1..30).filter(|&n| {
        let d = |xml: &roxmltree::Document| {
            let node = xml.descendants().find(|node| node.attribute("id") == Some(&piece(n)))?;
            node.descendants().find_map(|node| node.attribute("d")).map(str::to_owned)
        };
        d(&before) != d(&after)
    });
    assert!(differs.count() > 5);
    let undone = user.edit(&edited, "org.rinceau.update.noprefs;undo");
    assert_eq!(without_inkscape(&undone), without_inkscape(&edited), "one step of undo takes an update back");
}

/// Ids, geometry and paint of everything, in order.
fn without_inkscape(text: &str) -> Vec<String> {
    let xml = parse(text);
    let of = |node: Node| {
        let get = |name: &str| node.attribute(name).unwrap_or_default().to_owned();
        format!("{} {} {} {}", node.tag_name().name(), get("id"), get("d"), get("style"))
    };
    xml.descendants().filter(|node| node.has_attribute("d")).map(of).collect()
}

/// A dialog as an artist meets it: opened from the selection, a width typed, Apply pressed, closed, and the
/// drawing saved, with the keys and the mouse.
#[test]
fn a_dialog_is_filled_in_and_applied() {
    let user = User::new();
    let drawing = svg("<path id=\"leaf\" d=\"M 20,20 H 180 V 180 H 20 Z\" style=\"fill:#e8e0c8\"/>");
    let input = file(&user.home, "in.svg", drawing);
    // The width is the first control of the first page, at the right.
    let script = r#"
        inkscape --with-gui --actions="select-by-id:leaf;org.rinceau.pack" "$1" & inkscape=$!
        for i in $(seq 160); do
            sleep 0.5
            dialog=$(xdotool search --onlyvisible --name '^Pack along flow$' 2>/dev/null | tail -n 1)
            [ -n "$dialog" ] && break
        done
        sleep 1
        eval "$(xdotool getwindowgeometry --shell "$dialog")"
        # A busy machine is slow: a run has ended once it is told of.
        told="$INKSCAPE_PROFILE_DIR/extensions/rinceau/bin/last-run.json"
        for try in $(seq 3); do
            xdotool windowfocus --sync "$dialog"
            xdotool mousemove --window "$dialog" $((WIDTH - 104)) 76 click --repeat 3 1 sleep 0.3 type 30
            xdotool key Tab sleep 0.3 key alt+a
            for i in $(seq 100); do [ -e "$told" ] && break 2; sleep 0.3; done
        done
        sleep 2
        xdotool windowfocus --sync "$dialog" key Escape sleep 1
        main=$(xdotool search --onlyvisible --name ' - Inkscape$' | tail -n 1)
        for try in $(seq 10); do
            xdotool windowfocus --sync "$main" key ctrl+s sleep 2
            grep -q 'rinceau:result' "$1" && break
        done
        xdotool key ctrl+q
        for i in $(seq 20); do sleep 0.5; kill -0 $inkscape 2>/dev/null || exit 0; done
        kill $inkscape"#;
    let mut session = Command::new("xvfb-run");
    session.args(["-a", "-s", "-screen 0 1280x1000x24", "bash", "-c", script, "bash"]).arg(&input);
    user.at_home(&mut session);
    let done = Run::of(session).limit(Duration::from_secs(240)).done();
    let after = std::fs::read_to_string(&input).unwrap();
    let xml = parse(&after);
    let [layer] = layers(&xml)[..] else { panic!("{} layers: {done:?}", layers(&xml).len()) };
    assert_eq!(layer.attribute((RINCEAU, "params")), Some("{\"spacing\":\"30\"}"));
}

/// Every entry of the menu, each on something that suits it, in one session.
#[test]
fn every_entry_of_the_menu_runs() {
    let user = User::new();
    let roles = Role::ALL.map(|role| role.name()).into_iter().filter(|name| *name != "rules");
    let objects: String = roles
        .clone()
        .enumerate()
        .map(|(i, role)| format!("<g id=\"as-{role}\"><path d=\"M {0},300 h 8\"/></g>\n", 12 * i))
        .collect();
    let stones: String = (0..25)
        .map(|i| format!("<circle cx=\"{}\" cy=\"{}\" r=\"4\"/>", 220 + 12 * (i % 5), 20 + 12 * (i / 5)))
        .collect();
    let drawing = svg(&format!(
        "<rect id=\"a\" x=\"0\" y=\"0\" width=\"90\" height=\"90\"/><rect id=\"b\" x=\"100\" y=\"0\" width=\"90\" height=\"90\"/><rect id=\"c\" x=\"0\" y=\"100\" width=\"90\" height=\"90\"/>\n<g id=\"example\">{stones}</g><g id=\"tree\"><path id=\"trunk\" d=\"M150,190 V150\" stroke=\"#000000\"/><use id=\"branch\" href=\"#trunk\" transform=\"translate(150 150) rotate(30) scale(.7) translate(-150 -190)\"/></g>\n<path id=\"way\" d=\"M180,150 L186,140\"/><circle id=\"here\" cx=\"150\" cy=\"150\" r=\"1\"/><circle id=\"there\" cx=\"160\" cy=\"120\" r=\"1\"/>\n{objects}"
    ));
    let on = |ids: &str, entry: &str| format!("select-clear;select-by-id:{ids};org.rinceau.{entry}.noprefs;");
    let mut actions = String::new();
    for role in roles.clone() {
        actions += &on(&format!("as-{role}"), &format!("mark-{role}"));
    }
    let after_marks = user.edit(&drawing, actions.trim_end_matches(';'));
    let xml = parse(&after_marks);
    for role in roles.clone() {
        let found = by_id(&xml, &format!("as-{role}")).attribute((RINCEAU, "role")).map(str::to_owned);
        assert_eq!(found.as_deref(), Some(role));
    }
    // Cleared again, so that they are in nobody's way.
    let all: Vec<String> = roles.map(|role| format!("as-{role}")).collect();
    let mut actions = on(&all.join(","), "mark-none");
    actions += &on("way", "mark-guide");
    actions += &on("here,there", "mark-tack");
    actions += &on("branch,here,way", "tack-drag");
    for tack in ["half-turn", "mirror", "mirror-across", "identity"] {
        actions += &on("branch,here,there", &format!("tack-{tack}"));
    }
    actions += &on("way,here,there", "mark-none");
    actions += &on("example", "mark-reference");
    actions += "select-clear;org.rinceau.connect.noprefs;";
    actions += &on("a", "arrange");
    actions += &on("tree", "recurse");
    actions += &on("b", "vine");
    actions += &on("a", "pack");
    actions += &on("c", "grow");
    actions += "select-clear;org.rinceau.update.noprefs";
    let after = user.edit(&after_marks, &actions);
    let xml = parse(&after);
    let made: Vec<&str> =
        layers(&xml).iter().filter_map(|layer| layer.attribute((RINCEAU, "result"))).collect();
    for generator in ["pack", "vine", "grow", "recurse", "connect", "arrange"] {
        assert!(made.contains(&generator), "{generator} is not in {made:?}");
    }
    assert!(all.iter().all(|id| by_id(&xml, id).attribute((RINCEAU, "role")).is_none()));
    assert_ne!(
        by_id(&xml, "branch").attribute("transform"),
        by_id(&parse(&drawing), "branch").attribute("transform")
    );
    // These say what they find in a dialog, and change nothing.
    let told = user.edit_with_dialogs(&after, "org.rinceau.check.noprefs;org.rinceau.diagnostics.noprefs");
    assert_eq!(rest(&told), rest(&after));
    // A form that was explored is taken up again.
    let explored = rinceau(["recurse", "--id", "tree", "--history", "true"]).input(drawing).succeed();
    let resumed = user.edit(explored.text(), "select-by-id:step-1;org.rinceau.resume.noprefs");
    assert!(resumed.contains("form-of-step-1"));
}

/// A refusal opens a dialog, which Escape closes; the drawing is the one that was opened.
#[test]
fn a_refusal_leaves_the_drawing_as_it_was() {
    let user = User::new();
    let bow_tie = svg("<path id=\"tie\" class=\"rinceau-container\" d=\"M 10,10 190,190 V 10 L 10,190 Z\"/>");
    let after = user.edit_with_dialogs(&bow_tie, "org.rinceau.pack.noprefs");
    assert_eq!(rest(&after), rest(&bow_tie));
    assert!(layers(&parse(&after)).is_empty());
}

/// Both those committed and those written at installation.
/// Scenes and grammars are file formats of Inkscape's own dialogs.
#[test]
fn scenes_are_opened_and_saved() {
    let user = User::new();
    let marked = svg("<path id='body' class='rinceau-container' d='M0,0H90V60H0Z'/>");
    let drawing = file(&user.home, "in.svg", &marked);
    let json = user.home.path().join("scene.json");
    let export = |input: &Path, output: &Path, extension: Option<&str>| {
        let mut inkscape = Command::new("xvfb-run");
        inkscape.args(["-a", "inkscape"]).arg(input);
        inkscape.arg(format!("--export-filename={}", output.display()));
        inkscape.args(extension.map(|id| format!("--export-extension={id}")));
        user.at_home(&mut inkscape);
        let done = Run::of(inkscape).limit(Duration::from_secs(90)).done();
        std::fs::read_to_string(output).unwrap_or_else(|error| panic!("{error}: {}", done.stderr))
    };
    let saved = export(&drawing, &json, Some("org.rinceau.save-json"));
    assert!(saved.starts_with("{\n  \"rinceau\": 1") && saved.contains("\"body\""), "{saved}");
    let opened = export(&json, &user.home.path().join("opened.svg"), None);
    assert!(opened.contains("id=\"body\"") && opened.contains("rinceau-container"), "{opened}");
    let grammar = file(&user.home, "tree.cfdg", "startshape S\nshape S { SQUARE [] S [ y 1 s 0.7 r 20 ] }\n");
    let opened = export(&grammar, &user.home.path().join("form.svg"), None);
    assert!(opened.contains("rinceau-form"), "{opened}");
}

#[test]
fn what_is_installed_is_taken_out_again() {
    let folder = folder();
    let at = |command: &str| rinceau([command, "--dir"]).arg(folder.path());
    at("install").succeed();
    let own = folder.path().join("rinceau");
    file(&folder, "rinceau/notes.txt", "somebody's own");
    at("uninstall").succeed();
    let left: Vec<_> = own.read_dir().unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left, ["notes.txt"]);
    std::fs::remove_file(own.join("notes.txt")).unwrap();
    at("install").succeed();
    at("uninstall").succeed();
    assert!(!own.exists());
    let again = at("uninstall").done();
    assert!(again.code == Some(1) && again.stderr.contains("[not-installed]"), "{}", again.stderr);
}

#[test]
fn diagnostics_tell_of_the_last_run_and_the_last_error() {
    let folder = folder();
    rinceau(["install", "--dir"]).arg(folder.path()).succeed();
    let program = folder.path().join("rinceau/bin/rinceau");
    let drawing =
        file(&folder, "in.svg", svg("<circle id='disc' class='rinceau-container' cx='99' cy='99' r='90'/>"));
    let call = |arguments: &[&str]| {
        let mut command = Command::new(&program);
        command.args(arguments).arg(&drawing);
        Run::of(command).done()
    };
    let told = || call(&["--tool=diagnostics"]).stderr;
    let before = told();
    for line in ["Rinceau:           0.", "System:", "Last run:          none", "Last error:        none"] {
        assert!(before.contains(line), "{before}\nlacks {line}");
    }
    assert_eq!(call(&["--tool=pack"]).code, Some(0));
    assert_eq!(call(&["--tool=mark-guide"]).code, Some(1));
    let after = told();
    for line in [
        "Last run:          pack, just now, ",
        "write ",
        "Last error:        mark-guide, just now: Nothing is selected",
    ] {
        assert!(after.contains(line), "{after}\nlacks {line}");
    }
    // What is remembered may be broken by whatever else writes there.
    std::fs::write(folder.path().join("rinceau/bin/last-run.json"), "{").unwrap();
    assert!(told().contains("Last run:          none"));
    rinceau(["uninstall", "--dir"]).arg(folder.path()).succeed();
    assert!(!folder.path().join("rinceau").exists());
    // From a shell, of a program that is not installed.
    assert!(rinceau(["diagnostics"]).succeed().text().contains("Program:"));
}

#[test]
fn shells_and_man_are_served() {
    for (shell, mark) in
        [("bash", "complete -F"), ("zsh", "#compdef rinceau"), ("fish", "complete -c rinceau")]
    {
        let text = rinceau(["completions", shell]).succeed().text().to_owned();
        assert!(text.contains(mark) && text.contains("spacing"), "{shell}");
    }
    let page = rinceau(["manual"]).succeed().text().to_owned();
    assert!(page.contains(".TH rinceau 1") && page.contains("convert"), "{page}");
}

#[test]
fn descriptions_follow_inkscape_s_schema() {
    let folder = folder();
    rinceau(["install", "--dir"]).arg(folder.path()).succeed();
    let schema = Path::new("/usr/share/inkscape/extensions/inkscape.extension.rng");
    let mut count = 0;
    for descriptions in [folder.path().join("rinceau"), root().join("plugin-inkscape/inx")] {
        let entries = descriptions.read_dir().unwrap().map(|entry| entry.unwrap().path());
        for path in entries.filter(|path| path.extension().is_some_and(|extension| extension == "inx")) {
            let mut xmllint = Command::new("xmllint");
            xmllint.args(["--noout", "--nonet", "--relaxng"]).arg(schema).arg(&path);
            Run::of(xmllint).succeed();
            count += 1;
        }
    }
    assert!(count >= 9, "only {count} descriptions");
}

/// The program is there, may be run, and is the one that every description names.
#[test]
fn an_installation_is_whole() {
    let folder = folder();
    // Left by an older version, and somebody else's.
    std::fs::create_dir(folder.path().join("rinceau")).unwrap();
    file(&folder, "rinceau/gone.inx", "old");
    file(&folder, "other.inx", "other");
    for _ in 0..2 {
        rinceau(["install", "--dir"]).arg(folder.path()).succeed();
    }
    let own = folder.path().join("rinceau");
    assert!(!own.join("gone.inx").exists() && folder.path().join("other.inx").exists());
    for entry in own.read_dir().unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "inx") {
            let text = std::fs::read_to_string(&path).unwrap();
            let xml = parse(&text);
            let command = xml.descendants().find(|node| node.tag_name().name() == "command").unwrap();
            let program = own.join(command.text().unwrap());
            let version = Run::of({
                let mut command = Command::new(&program);
                command.arg("--version");
                command
            });
            assert!(version.succeed().text().starts_with("rinceau "));
            let id = xml.descendants().find(|node| node.tag_name().name() == "id").unwrap().text().unwrap();
            assert!(id.starts_with("org.rinceau.") && !id.contains("win32"), "{id}");
        }
    }
}
