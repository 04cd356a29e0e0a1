//! Diagrams in the colours of the FLOWPAK paper, told apart without a mark (F-011): black outlines are
//! containers, red lines with an arrow head guides, what is green is fixed, open green lines are fixed
//! spines, and a red line in a group with other shapes is the spine of an element.

use super::Document;
use super::edit::splice;
use crate::error::{Error, Position};
use crate::read::Resolver;
use crate::shape;
use crate::style::{Style, rgb};
use crate::units::Units;
use crate::vocabulary::{INKSCAPE, NAMESPACE, Role};
use kurbo::{BezPath, PathEl};
use roxmltree::{Node, NodeId};
use std::collections::HashMap;
use std::ops::Range;

/// The inks of a diagram.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Ink {
    Black,
    Red,
    Green,
}

/// The ink of a paint, near ones included: scans, other editors and printers shift colours.
fn ink(paint: Option<&str>) -> Option<Ink> {
    /// Darker than this, a colour is black whatever its hue; paler or duller, it is none of the three.
    const DARK: f64 = 0.25;
    const VIVID: f64 = 0.45;
    /// How far a hue may be from red and from green, in degrees.
    const OFF_RED: f64 = 22.0;
    const OFF_GREEN: f64 = 42.0;
    let [r, g, b] = rgb(paint?)?.map(|part| f64::from(part) / 255.0);
    let (most, least) = (r.max(g).max(b), r.min(g).min(b));
    if most <= DARK {
        return Some(Ink::Black);
    }
    if (most - least) / most < VIVID {
        return None;
    }
    let span = most - least;
    let hue = match most {
        most if most == r => 60.0 * (g - b) / span,
        most if most == g => 120.0 + 60.0 * (b - r) / span,
        _ => 240.0 + 60.0 * (r - g) / span,
    };
    if hue.abs() <= OFF_RED {
        Some(Ink::Red)
    } else if (hue - 120.0).abs() <= OFF_GREEN {
        Some(Ink::Green)
    } else {
        None
    }
}

/// A drawn shape of a diagram.
struct Shape<'a, 'i> {
    node: Node<'a, 'i>,
    /// Of the line, or of the area where there is no line.
    ink: Option<Ink>,
    is_filled: bool,
    is_closed: bool,
    has_arrow: bool,
    /// Its arrow head is at its start alone.
    is_backwards: bool,
}

impl Document {
    /// The drawing with roles by the colours of its shapes, and what is doubtful about them. Looks do not
    /// change. What has a role already, or lies in something that has, keeps it.
    ///
    /// Errors: nothing has one of the colours; a shape that cannot be read.
    pub fn with_roles_by_colour(&self) -> Result<(Document, Vec<String>), Error> {
        let mut notes = Vec::new();
        let text = self.parse(|xml| {
            let resolver = Resolver::new(xml, &self.limits)?;
            let shapes = shapes(&resolver)?;
            let elements = elements(&shapes);
            let mut edits = Vec::new();
            self.check_verbatim(xml.root_element())?;
            let prefix = self.declare(xml, &mut edits);
            let none = edits.len();
            for &group in elements.values() {
                self.put_role(group, Some(Role::Element), &prefix, None, &mut edits)?;
            }
            for shape in &shapes {
                let in_element = shape.node.ancestors().skip(1).any(|node| elements.contains_key(&node.id()));
                let at = || resolver.position(shape.node);
                let name = || resolver.reference(shape.node);
                let role = match (shape.ink, in_element) {
                    (Some(Ink::Red), true) if !shape.is_closed => Some(Role::Spine),
                    (_, true) | (None, _) => None,
                    (Some(Ink::Red), _) => {
                        if !shape.has_arrow {
                            notes.push(format!("{}: the red line '{}' has no arrow head: it is taken as a guide from its start to its end", at(), name()));
                        } else if shape.is_backwards {
                            notes.push(format!("{}: the arrow head of '{}' is at its start: the flow follows the line, against the arrow (Path > Reverse turns it)", at(), name()));
                        }
                        Some(Role::Guide)
                    }
                    (Some(Ink::Green), _) => {
                        Some(if shape.is_closed || shape.is_filled { Role::Fixed } else { Role::FixedSpine })
                    }
                    (Some(Ink::Black), _) if shape.is_closed => Some(Role::Container),
                    (Some(Ink::Black), _) => {
                        notes.push(format!("{}: the black line '{}' is open and stays without a role", at(), name()));
                        None
                    }
                };
                if role.is_some() {
                    self.put_role(shape.node, role, &prefix, None, &mut edits)?;
                }
            }
            if edits.len() == none {
                return Err(Error::new(
                    "no-colours",
                    "Nothing in the drawing is black, red or green",
                    "Draw outlines in black, guides in red with an arrow head, what is fixed in green",
                )
                .at(Position::of(&self.text, xml.root_element().range().start)));
            }
            Ok(splice(&self.text, edits))
        })?;
        let document =
            Document::with_limits(crate::encoding::encode(&text, self.encoding), self.limits.clone())?;
        Ok((document, notes))
    }
}

/// Every shape that is drawn for itself.
fn shapes<'a, 'i>(resolver: &Resolver<'a, 'i>) -> Result<Vec<Shape<'a, 'i>>, Error> {
    const NEVER: [&str; 8] =
        ["defs", "symbol", "marker", "pattern", "mask", "clipPath", "metadata", "switch"];
    let units = Units { viewport: resolver.view.size(), em: 16.0 };
    let mut shapes = Vec::new();
    // What is below one of these is passed over; the text of a node comes before that of the next.
    let mut passed: Range<usize> = 0..0;
    let mut styles: HashMap<NodeId, Style> = HashMap::new();
    for node in resolver.xml.root_element().descendants().filter(Node::is_element) {
        if passed.contains(&node.range().start) {
            continue;
        }
        let around = node.parent_element().and_then(|parent| styles.get(&parent.id()));
        let style = resolver.cascade.computed(node, around.unwrap_or(&Style::initial()), &units);
        if resolver.cascade.is_exhausted() {
            return Err(Error::new(
                "style-too-complex",
                "The drawing's style sheets take too long to be matched",
                "Copy what is needed into a new drawing",
            ));
        }
        let is_ours = node.attribute((NAMESPACE, "result")).is_some()
            || node.attribute((NAMESPACE, "history")).is_some()
            || crate::read::has_mark(node);
        if NEVER.contains(&node.tag_name().name()) || is_ours || style.is_display_none() {
            passed = node.range();
            continue;
        }
        let is_shape = shape::is_shape(node) && node.tag_name().name() != "image";
        if !is_shape && node.tag_name().name() != "text" {
            styles.insert(node.id(), style);
            continue;
        }
        if style.is_invisible() {
            continue;
        }
        let is_text = !is_shape;
        let path = match is_shape {
            true => shape::outline(node, &units).map_err(|what| {
                Error::new(
                    "broken-object",
                    format!("The object '{}' cannot be read: {what}", resolver.reference(node)),
                    "Redraw it, or delete it",
                )
                .at(resolver.position(node))
            })?,
            false => BezPath::new(),
        };
        if is_shape && path.elements().len() < 2 {
            continue;
        }
        shapes.push(of(node, &style, is_text || closes(&path)));
    }
    Ok(shapes)
}

fn of<'a, 'i>(node: Node<'a, 'i>, style: &Style, is_closed: bool) -> Shape<'a, 'i> {
    let is_stroked = style.stroke_width().is_some();
    let marker = |name: &str| style.get(name).is_some_and(|marker| marker != "none");
    Shape {
        node,
        ink: match is_stroked {
            true => ink(style.get("stroke")),
            false if style.is_filled() => ink(style.get("fill").or(Some("#000000"))),
            false => None,
        },
        is_filled: style.is_filled() && (!is_stroked || style.get("fill").is_some()),
        is_closed,
        has_arrow: style.has_markers(),
        is_backwards: marker("marker-start") && !marker("marker-end") && !marker("marker-mid"),
    }
}

/// True if all of a path is closed.
fn closes(path: &BezPath) -> bool {
    let closed = path.elements().iter().filter(|el| matches!(el, PathEl::ClosePath)).count();
    let moves = path.elements().iter().filter(|el| matches!(el, PathEl::MoveTo(_))).count();
    let ends = path.segments().next().zip(path.segments().last());
    let meets = ends.is_some_and(|(first, last)| {
        use kurbo::{ParamCurve, Shape};
        moves == 1
            && path.segments().count() > 1
            && first.start().distance(last.end()) <= 1e-6 * path.bounding_box().size().max_side()
    });
    closed >= moves || meets
}

/// Groups of one red line without an arrow head, and other shapes: elements with their spines.
fn elements<'a, 'i>(shapes: &[Shape<'a, 'i>]) -> HashMap<NodeId, Node<'a, 'i>> {
    let is_spine = |shape: &Shape| shape.ink == Some(Ink::Red) && !shape.is_closed && !shape.has_arrow;
    let is_guide = |shape: &Shape| shape.ink == Some(Ink::Red) && shape.has_arrow;
    // How many spines, guides and shapes in all are in each group around a spine.
    let mut counts: HashMap<NodeId, [usize; 3]> = HashMap::new();
    let groups =
        shapes.iter().filter(|shape| is_spine(shape)).filter_map(|shape| shape.node.parent_element());
    for group in groups {
        counts.entry(group.id()).or_default();
    }
    for shape in shapes {
        for node in shape.node.ancestors().skip(1) {
            if let Some(count) = counts.get_mut(&node.id()) {
                count[0] += usize::from(is_spine(shape));
                count[1] += usize::from(is_guide(shape));
                count[2] += 1;
            }
        }
    }
    let is_element = |group: &Node| {
        let is_layer = group.attribute((INKSCAPE, "groupmode")) == Some("layer");
        let is_one = counts
            .get(&group.id())
            .is_some_and(|&[spines, guides, all]| spines == 1 && guides == 0 && all > 1);
        group.tag_name().name() == "g" && !is_layer && is_one
    };
    let groups =
        shapes.iter().filter(|shape| is_spine(shape)).filter_map(|shape| shape.node.parent_element());
    groups.filter(is_element).map(|group| (group.id(), group)).collect()
}
