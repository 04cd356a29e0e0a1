//! What the walk looks up: ids, style sheets, the root's coordinate system, positions.

use crate::error::{Error, Position, Positions};
use crate::limits::Limits;
use crate::style::Cascade;
use crate::units::{self, Axis, Units};
use crate::vocabulary::{NAMESPACE, SVG, XLINK};
use crate::xml::PlainAttribute;
use kurbo::{Affine, Point, Rect, Size};
use roxmltree::{Document, Node, NodeId};
use std::cell::OnceCell;
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::str::FromStr;

/// Nodes by id.
#[derive(Default)]
struct Ids<'a> {
    first: HashMap<&'a str, NodeId, foldhash::fast::RandomState>,
    /// Second place of every id that stands more than once.
    twice: HashMap<&'a str, NodeId, foldhash::fast::RandomState>,
}

impl<'a> Ids<'a> {
    fn new(xml: &'a Document) -> Self {
        let mut ids = Ids::default();
        for node in xml.descendants() {
            if let Some(id) = node.plain("id") {
                match ids.first.entry(id) {
                    Entry::Vacant(place) => drop(place.insert(node.id())),
                    Entry::Occupied(_) => drop(ids.twice.entry(id).or_insert(node.id())),
                }
            }
        }
        ids
    }
}

/// The looked-up side of one drawing.
pub(crate) struct Resolver<'a, 'i> {
    pub xml: &'a Document<'i>,
    pub limits: &'a Limits,
    pub cascade: Cascade<'a>,
    pub view: Rect,
    pub px_per_unit: f64,
    ids: OnceCell<Ids<'a>>,
    /// Whether a node or one below it has a role, by node number.
    marked: Vec<bool>,
    positions: OnceCell<Positions<'i>>,
    /// Each element's place among its siblings, from 1, by node number.
    places: OnceCell<Vec<u32>>,
}

/// Style sheets of one drawing; each costs a sort.
const MOST_SHEETS: usize = 1_000;

impl<'a, 'i> Resolver<'a, 'i> {
    pub fn new(xml: &'a Document<'i>, limits: &'a Limits) -> Result<Self, Error> {
        let mut sheets: Vec<&'a str> = Vec::new();
        let mut marked = Vec::new();
        for node in xml.descendants() {
            let number = node.id().get() as usize;
            marked.resize(number + 1, false);
            if is_svg(&node, "style") {
                sheets.extend(node.children().filter_map(|child| child.text()));
            }
            if has_mark(node) {
                mark_upwards(&mut marked, node);
            }
        }
        let size = sheets.iter().map(|sheet| sheet.len()).sum::<usize>();
        if size > limits.style_sheet || sheets.len() > MOST_SHEETS {
            return Err(Error::new(
                "style-too-large",
                format!("The drawing's style sheets are larger than {} KiB", limits.style_sheet >> 10),
                "Copy what is to be filled into a new drawing",
            ));
        }
        let (view, px_per_unit) = root_view(xml.root_element(), limits.coordinate);
        let cascade = Cascade::new(&sheets);
        let (ids, positions, places) = (OnceCell::new(), OnceCell::new(), OnceCell::new());
        Ok(Resolver { xml, limits, cascade, view, px_per_unit, ids, marked, positions, places })
    }

    /// Notes that these nodes are of interest although they have no role.
    pub fn mark(&mut self, nodes: &[Node]) {
        nodes.iter().for_each(|&node| mark_upwards(&mut self.marked, node));
    }

    /// True if the node, or one below it, has a role or was noted.
    pub fn is_marked(&self, node: Node) -> bool {
        self.marked.get(node.id().get() as usize).copied().unwrap_or(false)
    }

    /// The position of a node's start tag.
    pub fn position(&self, node: Node) -> Position {
        self.position_at(node.range().start)
    }

    /// The position of a byte of the text.
    pub fn position_at(&self, offset: usize) -> Position {
        self.positions.get_or_init(|| Positions::new(self.xml.input_text())).at(offset)
    }

    /// The id of a node, or `node:` and its place from the root down where it has none.
    pub fn reference(&self, node: Node) -> String {
        if let Some(id) = node.plain("id").filter(|id| !id.is_empty()) {
            return id.to_owned();
        }
        self.place(node)
    }

    /// `node:` and a node's place from the root down.
    pub fn place(&self, node: Node) -> String {
        let places = self.places.get_or_init(|| places(self.xml));
        let mut path: Vec<String> = node
            .ancestors()
            .filter(|ancestor| ancestor.parent_element().is_some())
            .map(|ancestor| places[ancestor.id().get() as usize].to_string())
            .collect();
        path.reverse();
        format!("{NODE}{}", path.join("/"))
    }

    /// The node that [`Resolver::reference`] names, or the one with this id.
    pub fn by_reference(&self, reference: &str) -> Result<Option<Node<'a, 'i>>, Error> {
        let found = self.by_id(reference, None)?;
        let Some(path) = reference.strip_prefix(NODE).filter(|_| found.is_none()) else { return Ok(found) };
        let mut node = self.xml.root_element();
        for place in path.split('/') {
            let index = place.parse::<usize>().ok().and_then(|place| place.checked_sub(1));
            let child = index.and_then(|index| node.children().filter(Node::is_element).nth(index));
            match child {
                Some(child) => node = child,
                None => return Ok(None),
            }
        }
        Ok(Some(node))
    }

    /// The node with this id. An id that stands twice is an error where it is asked for.
    pub fn by_id(&self, id: &str, asked_by: Option<Node>) -> Result<Option<Node<'a, 'i>>, Error> {
        let ids = self.ids.get_or_init(|| Ids::new(self.xml));
        let Some(first) = ids.first.get(id).and_then(|&node| self.xml.get_node(node)) else {
            return Ok(None);
        };
        if let Some(second) = ids.twice.get(id).and_then(|&node| self.xml.get_node(node)) {
            let error = Error::new(
                "duplicate-id",
                format!(
                    "Two objects have the id '{id}', at {} and {}",
                    self.position(first),
                    self.position(second)
                ),
                "Give one of them another id (Object > Object Properties)",
            );
            return Err(error.at(self.position(asked_by.unwrap_or(second))));
        }
        Ok(Some(first))
    }

    /// The target of a `<use>`, if it is inside this drawing.
    pub fn href(&self, node: Node) -> Result<Option<Node<'a, 'i>>, Error> {
        let href = node.plain("href").or_else(|| node.attribute((XLINK, "href")));
        match href.and_then(|href| href.trim().strip_prefix('#')) {
            Some(id) => self.by_id(id, Some(node)),
            None => Ok(None),
        }
    }
}

/// True for an element of this SVG name, also in drawings that lack the SVG namespace.
pub(crate) fn is_svg(node: &Node, name: &str) -> bool {
    let tag = node.tag_name();
    tag.name() == name && tag.namespace().is_none_or(|namespace| namespace == SVG)
}

/// How references to objects without an id start.
const NODE: &str = "node:";

fn places(xml: &Document) -> Vec<u32> {
    let mut places = Vec::new();
    for node in xml.descendants() {
        let before = node.prev_sibling().map_or(0, |before| places[before.id().get() as usize]);
        places.resize(node.id().get() as usize + 1, 0);
        places[node.id().get() as usize] = before + u32::from(node.is_element());
    }
    places
}

/// True if the node itself has a role, by attribute or class.
pub(crate) fn has_mark(node: Node) -> bool {
    node.attribute((NAMESPACE, "role")).is_some()
        || node.plain("class").is_some_and(|class| class.contains("rinceau-"))
}

/// Stops at the first ancestor that is marked already, so that all marks cost one pass.
fn mark_upwards(marked: &mut [bool], node: Node) {
    for node in node.ancestors() {
        match marked.get_mut(node.id().get() as usize) {
            Some(mark) if !*mark => *mark = true,
            _ => return,
        }
    }
}

/// The root's view box and the CSS pixels in one of its user units. Sizes beyond `largest`,
/// or so small that a unit of them is beyond it, count as not given.
fn root_view(root: Node, largest: f64) -> (Rect, f64) {
    // Browsers' default size, for percentages of a drawing that states no size at all.
    const DEFAULT: Size = Size::new(300.0, 150.0);
    let usable = |side: f64| (1.0 / largest..=largest).contains(&side);
    let view = root.plain("viewBox").and_then(units::view_box).filter(|view| {
        usable(view.width())
            && usable(view.height())
            && [view.x0, view.y0].iter().all(|corner| corner.abs() <= largest)
    });
    let base = Units { viewport: view.map_or(DEFAULT, |view| view.size()), em: 16.0 };
    let side = |name, axis| {
        root.plain(name)
            .filter(|text| !text.contains('%'))
            .and_then(|text| base.resolve(text, axis))
            .filter(|&side| usable(side))
    };
    let (width, height) = (side("width", Axis::X), side("height", Axis::Y));
    let Some(view) = view else {
        let size = (width.unwrap_or(DEFAULT.width), height.unwrap_or(DEFAULT.height));
        return (Rect::from_origin_size((0.0, 0.0), size), 1.0);
    };
    let scale = match (width, height) {
        (Some(w), Some(h)) => (w / view.width()).min(h / view.height()),
        (Some(w), None) => w / view.width(),
        (None, Some(h)) => h / view.height(),
        (None, None) => 1.0,
    };
    (view, scale)
}

/// A node's own transform: the attribute, else the CSS property, about its origin.
pub(crate) fn own_transform(node: Node, units: &Units) -> Result<Affine, String> {
    let Some(text) = node.plain("transform").filter(|text| !text.trim().is_empty()) else {
        return Ok(css_transform(node).unwrap_or(Affine::IDENTITY));
    };
    let transform = units::transform(text).ok_or_else(|| "its transform cannot be read".to_owned())?;
    let origin = transform_origin(node, units).to_vec2();
    Ok(Affine::translate(origin) * transform * Affine::translate(-origin))
}

/// The point that a node's `transform` attribute is about.
pub(crate) fn transform_origin(node: Node, units: &Units) -> Point {
    let styled = node.plain("style").filter(|style| style.contains("transform-origin")).and_then(|style| {
        crate::css::declarations(style).filter(|d| d.name == "transform-origin").last().map(|d| d.value)
    });
    let text = styled.or(node.plain("transform-origin")).unwrap_or("");
    let mut sides: Vec<&str> = text.split_whitespace().collect();
    // One alone is of x, but for top and bottom; two may be turned around.
    let is_y = |side: &str| matches!(side, "top" | "bottom");
    match sides[..] {
        [] => return Point::ORIGIN,
        [one] if is_y(one) => sides.insert(0, "center"),
        [_] => sides.push("center"),
        [x, y, ..] if is_y(x) || matches!(y, "left" | "right") => sides.swap(0, 1),
        _ => {}
    }
    let side = |text: &str, axis| units.resolve(keyword(text).unwrap_or(text), axis).unwrap_or(0.0);
    Point::new(side(sides[0], Axis::X), side(sides[1], Axis::Y))
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
    let style = node.plain("style").filter(|style| style.contains("transform"))?;
    let declaration = crate::css::declarations(style).find(|d| d.name == "transform")?;
    units::transform(&declaration.value.replace("px", "").replace("deg", ""))
}

/// The transform and viewport of a nested `<svg>` or an instanced `<symbol>`; `None` if it
/// has no area and renders nothing. `size` is what a `<use>` sets.
pub(crate) fn nested_viewport(
    node: Node,
    units: &Units,
    size: (Option<f64>, Option<f64>),
) -> Option<(Affine, Size)> {
    let side = |name, axis| node.plain(name).and_then(|text| units.resolve(text, axis));
    let is_symbol = node.tag_name().name() == "symbol";
    let width = size.0.or_else(|| side("width", Axis::X)).unwrap_or(units.viewport.width);
    let height = size.1.or_else(|| side("height", Axis::Y)).unwrap_or(units.viewport.height);
    let (x, y) = if is_symbol {
        (0.0, 0.0)
    } else {
        (side("x", Axis::X).unwrap_or(0.0), side("y", Axis::Y).unwrap_or(0.0))
    };
    let place = Affine::translate((x, y));
    let Some(view) = node.plain("viewBox").and_then(units::view_box) else {
        return Some((place, Size::new(width, height)));
    };
    let aspect = node
        .plain("preserveAspectRatio")
        .and_then(|text| svgtypes::AspectRatio::from_str(text).ok())
        .unwrap_or_default();
    let fit = units::view_box_transform(view, aspect, Size::new(width, height))?;
    Some((place * fit, view.size()))
}
