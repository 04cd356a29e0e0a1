//! What the walk looks up: ids, style sheets, the root's coordinate system, positions.

use crate::error::{Error, Position};
use crate::limits::Limits;
use crate::style::{Cascade, Style};
use crate::units::{self, Axis, Units};
use crate::vocabulary::{SVG, XLINK};
use kurbo::{Affine, Rect, Size};
use roxmltree::{Document, Node, NodeId};
use std::collections::HashMap;
use std::str::FromStr;

/// The looked-up side of one drawing.
pub(crate) struct Resolver<'a, 'i> {
    pub xml: &'a Document<'i>,
    pub limits: &'a Limits,
    pub cascade: Cascade<'a>,
    pub view: Rect,
    pub px_per_unit: f64,
    ids: HashMap<&'a str, NodeId>,
    /// Second place of every id that stands more than once.
    twice: HashMap<&'a str, NodeId>,
}

impl<'a, 'i> Resolver<'a, 'i> {
    pub fn new(xml: &'a Document<'i>, limits: &'a Limits) -> Result<Self, Error> {
        let mut sheets: Vec<&'a str> = Vec::new();
        let (mut ids, mut twice) = (HashMap::new(), HashMap::new());
        for node in xml.descendants().filter(Node::is_element) {
            if let Some(id) = node.attribute("id") {
                if ids.contains_key(id) {
                    twice.entry(id).or_insert(node.id());
                } else {
                    ids.insert(id, node.id());
                }
            }
            if is_svg(&node, "style") {
                sheets.extend(node.children().filter_map(|child| child.text()));
            }
        }
        if sheets.iter().map(|sheet| sheet.len()).sum::<usize>() > limits.style_sheet {
            return Err(Error::new(
                "style-too-large",
                "The drawing's style sheets are larger than 1 MiB",
                "Copy what is to be filled into a new drawing",
            ));
        }
        let (view, px_per_unit) = root_view(xml.root_element());
        Ok(Resolver { xml, limits, cascade: Cascade::new(&sheets), view, px_per_unit, ids, twice })
    }

    /// The position of a node's start tag.
    pub fn position(&self, node: Node) -> Position {
        Position::of(self.xml.input_text(), node.range().start)
    }

    /// The node with this id. An id that stands twice is an error where it is asked for.
    pub fn by_id(&self, id: &str, asked_at: Option<Position>) -> Result<Option<Node<'a, 'i>>, Error> {
        let Some(first) = self.ids.get(id).and_then(|&node| self.xml.get_node(node)) else { return Ok(None) };
        if let Some(second) = self.twice.get(id).and_then(|&node| self.xml.get_node(node)) {
            let error = Error::new(
                "duplicate-id",
                format!(
                    "Two objects have the id '{id}', at {} and {}",
                    self.position(first),
                    self.position(second)
                ),
                "Give one of them another id (Object > Object Properties)",
            );
            return Err(error.at(asked_at.unwrap_or_else(|| self.position(second))));
        }
        Ok(Some(first))
    }

    /// The target of a `<use>`, if it is inside this drawing.
    pub fn href(&self, node: Node) -> Result<Option<Node<'a, 'i>>, Error> {
        let href = node.attribute("href").or_else(|| node.attribute((XLINK, "href")));
        match href.and_then(|href| href.trim().strip_prefix('#')) {
            Some(id) => self.by_id(id, Some(self.position(node))),
            None => Ok(None),
        }
    }

    /// The computed style of a node's parents, from the root down.
    pub fn inherited_style(&self, node: Node) -> Style {
        let mut style = Style::initial();
        let mut chain: Vec<Node> = node.ancestors().skip(1).filter(Node::is_element).collect();
        chain.reverse();
        for ancestor in chain {
            let units = Units { viewport: self.view.size(), em: style.font_size() };
            style = self.cascade.computed(ancestor, &style, &units);
        }
        style.forget_opacity();
        style
    }
}

/// True for an element of this SVG name, also in drawings that lack the SVG namespace.
pub(crate) fn is_svg(node: &Node, name: &str) -> bool {
    let tag = node.tag_name();
    tag.name() == name && tag.namespace().is_none_or(|namespace| namespace == SVG)
}

/// The id of a node, or its place from the root down where it has none.
pub(crate) fn node_reference(node: Node) -> String {
    if let Some(id) = node.attribute("id").filter(|id| !id.is_empty()) {
        return id.to_owned();
    }
    let mut places: Vec<String> = node
        .ancestors()
        .filter(|ancestor| ancestor.parent_element().is_some())
        .map(|ancestor| (1 + ancestor.prev_siblings().skip(1).filter(Node::is_element).count()).to_string())
        .collect();
    places.reverse();
    format!("node:{}", places.join("/"))
}

/// The root's view box and the CSS pixels in one of its user units.
fn root_view(root: Node) -> (Rect, f64) {
    // Browsers' default size, for percentages of a drawing that states no size at all.
    const DEFAULT: Size = Size::new(300.0, 150.0);
    let view = root
        .attribute("viewBox")
        .and_then(units::view_box)
        .filter(|view| view.width() > 0.0 && view.height() > 0.0);
    let base = Units { viewport: view.map_or(DEFAULT, |view| view.size()), em: 16.0 };
    let side = |name, axis| {
        root.attribute(name)
            .filter(|text| !text.contains('%'))
            .and_then(|text| base.resolve(text, axis))
            .filter(|side| side.is_finite() && *side > 0.0)
    };
    let (width, height) = (side("width", Axis::X), side("height", Axis::Y));
    match view {
        Some(view) => {
            let scale = match (width, height) {
                (Some(w), Some(h)) => (w / view.width()).min(h / view.height()),
                (Some(w), None) => w / view.width(),
                (None, Some(h)) => h / view.height(),
                (None, None) => 1.0,
            };
            (view, scale)
        }
        None => (
            Rect::from_origin_size(
                (0.0, 0.0),
                (width.unwrap_or(DEFAULT.width), height.unwrap_or(DEFAULT.height)),
            ),
            1.0,
        ),
    }
}

/// A node's own transform: the attribute, else the CSS property, about its origin.
pub(crate) fn own_transform(node: Node, units: &Units) -> Result<Affine, String> {
    let Some(text) = node.attribute("transform").filter(|text| !text.trim().is_empty()) else {
        return Ok(css_transform(node).unwrap_or(Affine::IDENTITY));
    };
    let transform = units::transform(text).ok_or_else(|| "its transform cannot be read".to_owned())?;
    let Some(origin) = node.attribute("transform-origin") else { return Ok(transform) };
    let mut sides = origin.split_whitespace();
    let mut side = |axis| {
        sides
            .next()
            .and_then(|text| keyword(text).or(Some(text)).and_then(|text| units.resolve(text, axis)))
            .unwrap_or(0.0)
    };
    let (x, y) = (side(Axis::X), side(Axis::Y));
    Ok(Affine::translate((x, y)) * transform * Affine::translate((-x, -y)))
}

fn keyword(text: &str) -> Option<&'static str> {
    match text {
        "left" | "top" => Some("0%"),
        "center" => Some("50%"),
        "right" | "bottom" => Some("100%"),
        _ => None,
    }
}

/// `style="transform:..."` where it is written like the attribute, with px and deg units.
fn css_transform(node: Node) -> Option<Affine> {
    let style = node.attribute("style").filter(|style| style.contains("transform"))?;
    let declaration = simplecss::DeclarationTokenizer::from(style).find(|d| d.name == "transform")?;
    units::transform(&declaration.value.replace("px", "").replace("deg", ""))
}

/// The transform and viewport of a nested `<svg>` or an instanced `<symbol>`; `None` if it
/// has no area and renders nothing. `size` is what a `<use>` sets.
pub(crate) fn nested_viewport(
    node: Node,
    units: &Units,
    size: (Option<f64>, Option<f64>),
) -> Option<(Affine, Size)> {
    let side = |name, axis| node.attribute(name).and_then(|text| units.resolve(text, axis));
    let is_symbol = node.tag_name().name() == "symbol";
    let width = size.0.or_else(|| side("width", Axis::X)).unwrap_or(units.viewport.width);
    let height = size.1.or_else(|| side("height", Axis::Y)).unwrap_or(units.viewport.height);
    let (x, y) = if is_symbol {
        (0.0, 0.0)
    } else {
        (side("x", Axis::X).unwrap_or(0.0), side("y", Axis::Y).unwrap_or(0.0))
    };
    let place = Affine::translate((x, y));
    let Some(view) = node.attribute("viewBox").and_then(units::view_box) else {
        return Some((place, Size::new(width, height)));
    };
    let aspect = node
        .attribute("preserveAspectRatio")
        .and_then(|text| svgtypes::AspectRatio::from_str(text).ok())
        .unwrap_or_default();
    let fit = units::view_box_transform(view, aspect, Size::new(width, height))?;
    Some((place * fit, view.size()))
}
