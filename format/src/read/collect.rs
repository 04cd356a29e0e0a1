//! The walk itself, and what it gathers for each annotated object.

use super::resolver::{Resolver, is_svg, nested_viewport, node_reference, own_transform};
use super::role::role_of;
use crate::artwork::Part;
use crate::error::Error;
use crate::scene::{
    Container, Element, Fixed, Guide, Outline, Scene, Seed, Selection, Source, Stroke, Template,
};
use crate::style::Style;
use crate::units::{Axis, Units, mean_scale};
use crate::vocabulary::{INKSCAPE, NAMESPACE, Role};
use crate::{shape, text};
use kurbo::{Affine, BezPath, ParamCurve, PathEl, Point, Shape, Size};
use roxmltree::{Node, NodeId};
use std::rc::Rc;

/// What to do next; the stack holds the rest of the drawing in reverse.
enum Visit<'a, 'i> {
    Enter(Place<'a, 'i>),
    /// The object that opened the newest collector is done.
    Close,
    /// The content of the newest `<use>` is done.
    LeaveUse,
}

/// A node with everything it inherits.
#[derive(Clone)]
struct Place<'a, 'i> {
    node: Node<'a, 'i>,
    /// From the parent's coordinates to the root's.
    transform: Affine,
    viewport: Size,
    /// The parent's style; `None` outside annotated objects.
    style: Option<Rc<Style>>,
    /// Inside `<defs>`, where only templates are looked for.
    in_defs: bool,
}

/// What stands open: an annotated object, or a selected one without a role.
struct Collector {
    role: Option<Role>,
    source: Source,
    node: NodeId,
    parts: Vec<Part>,
    spines: Vec<(Point, Point)>,
}

struct Walk<'r, 'a, 'i> {
    resolver: &'r Resolver<'a, 'i>,
    selection: &'r Selection,
    stack: Vec<Visit<'a, 'i>>,
    open: Vec<Collector>,
    uses: Vec<NodeId>,
    instances: usize,
    scene: Scene,
    selected_containers: Vec<bool>,
}

/// Walks the drawing once.
pub(super) fn walk(resolver: &Resolver, selection: &Selection) -> Result<Scene, Error> {
    for id in &selection.ids {
        if resolver.by_id(id, None)?.is_none() {
            return Err(Error::new(
                "unknown-id",
                format!("No object has the id '{id}'"),
                "Check the id in Object > Object Properties",
            ));
        }
    }
    let scene = Scene { view: resolver.view, px_per_unit: resolver.px_per_unit, ..Scene::default() };
    let root = resolver.xml.root_element();
    let mut walk = Walk {
        resolver,
        selection,
        stack: Vec::new(),
        open: Vec::new(),
        uses: Vec::new(),
        instances: 0,
        scene,
        selected_containers: Vec::new(),
    };
    walk.push_children(&Place {
        node: root,
        transform: Affine::IDENTITY,
        viewport: resolver.view.size(),
        style: None,
        in_defs: false,
    });
    while let Some(visit) = walk.stack.pop() {
        match visit {
            Visit::Enter(place) => walk.enter(place)?,
            Visit::Close => walk.close()?,
            Visit::LeaveUse => {
                walk.uses.pop();
            }
        }
    }
    // A selection of some annotated containers narrows the run to those.
    if walk.selected_containers.contains(&true) {
        let mut keep = walk.selected_containers.iter();
        walk.scene.containers.retain(|_| *keep.next().unwrap_or(&true));
    }
    Ok(walk.scene)
}

impl<'a, 'i> Walk<'_, 'a, 'i> {
    fn push_children(&mut self, parent: &Place<'a, 'i>) {
        for child in parent.node.children().rev().filter(Node::is_element) {
            self.stack.push(Visit::Enter(Place { node: child, ..parent.clone() }));
        }
    }

    fn enter(&mut self, mut place: Place<'a, 'i>) -> Result<(), Error> {
        let node = place.node;
        let name = node.tag_name().name();
        if !is_svg(&node, name) || node.attribute((NAMESPACE, "result")).is_some() {
            return Ok(());
        }
        if is_never_drawn(name) {
            return Ok(());
        }
        let is_definition = name == "defs" || (name == "symbol" && self.uses.is_empty());
        place.in_defs |= is_definition;

        let opened = self.open_role(&place)?;
        if opened {
            self.stack.push(Visit::Close);
            if place.style.is_none() {
                place.style = Some(Rc::new(self.resolver.inherited_style(node)));
            }
        }
        let em = place.style.as_ref().map_or(16.0, |style| style.font_size());
        let units = Units { viewport: place.viewport, em };
        match own_transform(node, &units) {
            Ok(own) => place.transform *= own,
            Err(what) if self.open.is_empty() => {
                // Outside annotated objects a broken transform is none of our business,
                // but whatever is annotated below it has no place either.
                if has_role_below(node) {
                    return Err(self.broken(node, &what));
                }
                return Ok(());
            }
            Err(what) => return Err(self.broken(node, &what)),
        }
        if let Some(parent) = place.style.take() {
            let style = self.resolver.cascade.computed(node, &parent, &units);
            if style.is_display_none() && !opened && !has_role_below(node) {
                return Ok(());
            }
            place.style = Some(Rc::new(style));
        }
        self.content(place, &units)
    }

    /// What a node draws, or the nodes below it.
    fn content(&mut self, mut place: Place<'a, 'i>, units: &Units) -> Result<(), Error> {
        let node = place.node;
        match node.tag_name().name() {
            "use" => self.enter_use(&place, units),
            "svg" | "symbol" => {
                if let Some((fit, viewport)) = nested_viewport(node, units, (None, None)) {
                    place.transform *= fit;
                    place.viewport = viewport;
                    self.push_children(&place);
                }
                Ok(())
            }
            "text" => self.text(&place),
            name => match shape::outline(node, units) {
                None => {
                    let _ = name;
                    self.push_children(&place);
                    Ok(())
                }
                Some(_) if self.open.is_empty() => Ok(()),
                Some(Ok(path)) => self.part(&place, path),
                Some(Err(what)) => Err(self.broken(node, &what)),
            },
        }
    }

    /// Opens a collector if the node has a role that counts here, or is selected.
    fn open_role(&mut self, place: &Place<'a, 'i>) -> Result<bool, Error> {
        let node = place.node;
        let found = role_of(self.resolver, node)?;
        let selected = self.uses.is_empty()
            && node.attribute("id").is_some_and(|id| self.selection.ids.iter().any(|other| other == id));
        let role = match found {
            Some((role, warning)) => {
                let counts = if self.uses.is_empty() {
                    !place.in_defs || matches!(role, Role::Element | Role::Spine)
                } else {
                    role == Role::Spine
                };
                if counts {
                    self.scene.warnings.extend(warning);
                }
                counts.then_some(role)
            }
            None => None,
        };
        if role.is_none() && !(selected && self.open.is_empty()) {
            return Ok(false);
        }
        if let (Some(role), Some(outer)) = (role, self.open.last()) {
            let fits = matches!((outer.role, role), (Some(Role::Element), Role::Spine) | (None, _));
            let is_group_role = matches!(
                outer.role,
                Some(Role::Container | Role::Element | Role::Fixed | Role::Reference | Role::Form)
            );
            if !fits && !is_group_role {
                let sentence = format!(
                    "The {} '{}' stands inside the {} '{}'",
                    role.name(),
                    node_reference(node),
                    outer.role.map_or("selection", Role::name),
                    outer.source.id
                );
                return Err(Error::new(
                    "nested-role",
                    sentence,
                    "Move it out of the group, or clear one of the two marks",
                )
                .at(self.resolver.position(node)));
            }
        }
        if role == Some(Role::Container) {
            self.selected_containers.push(selected);
        }
        let id = node_reference(node);
        let label = node
            .attribute((INKSCAPE, "label"))
            .map_or_else(|| id.trim_start_matches("node:").to_owned(), str::to_owned);
        let source = Source { id, label, at: self.resolver.position(node) };
        self.open.push(Collector { role, source, node: node.id(), parts: Vec::new(), spines: Vec::new() });
        Ok(true)
    }

    fn enter_use(&mut self, place: &Place<'a, 'i>, units: &Units) -> Result<(), Error> {
        if self.open.is_empty() {
            return Ok(());
        }
        let node = place.node;
        let Some(target) = self.resolver.href(node)? else {
            self.scene.warnings.push(format!(
                "{}: a clone refers to nothing in this drawing and is left out",
                self.resolver.position(node)
            ));
            return Ok(());
        };
        if self.uses.contains(&target.id()) || node.ancestors().any(|ancestor| ancestor == target) {
            return Err(Error::new(
                "clone-cycle",
                format!("The clone '{}' contains itself", node_reference(node)),
                "Delete the clone, or unlink it (Edit > Clone > Unlink Clone)",
            )
            .at(self.resolver.position(node)));
        }
        self.instances += 1;
        if self.instances > self.resolver.limits.instances {
            return Err(Error::new(
                "too-many-clones",
                format!("The annotated objects contain more than {} clones", self.resolver.limits.instances),
                "Mark fewer objects, or unlink some clones",
            )
            .at(self.resolver.position(node)));
        }
        let side = |name, axis| node.attribute(name).and_then(|text| units.resolve(text, axis));
        let mut inner = place.clone();
        inner.transform *=
            Affine::translate((side("x", Axis::X).unwrap_or(0.0), side("y", Axis::Y).unwrap_or(0.0)));
        inner.in_defs = false;
        inner.node = target;
        self.uses.push(target.id());
        self.stack.push(Visit::LeaveUse);
        if matches!(target.tag_name().name(), "symbol" | "svg") {
            let size = (side("width", Axis::X), side("height", Axis::Y));
            if let Some((fit, viewport)) = nested_viewport(target, units, size) {
                inner.transform *= fit;
                inner.viewport = viewport;
                inner.style =
                    inner.style.map(|style| Rc::new(self.resolver.cascade.computed(target, &style, units)));
                self.push_children(&inner);
            }
        } else {
            self.stack.push(Visit::Enter(inner));
        }
        Ok(())
    }

    fn text(&mut self, place: &Place<'a, 'i>) -> Result<(), Error> {
        let Some(style) = place.style.as_deref().filter(|_| !self.open.is_empty()) else { return Ok(()) };
        let outlines = text::outlines(place.node, style, self.resolver).map_err(|what| {
            Error::new(
                "text-without-outline",
                format!("The text '{}' has no outline: {what}", node_reference(place.node)),
                "Install its font, or turn it into a path (Path > Object to Path)",
            )
            .at(self.resolver.position(place.node))
        })?;
        for path in outlines {
            self.part(place, path)?;
        }
        Ok(())
    }

    fn part(&mut self, place: &Place<'a, 'i>, path: BezPath) -> Result<(), Error> {
        let limit = self.resolver.limits.coordinate;
        let in_range = |p: Point| p.x.abs() <= limit && p.y.abs() <= limit;
        let points = path.elements().iter().flat_map(points_of);
        let mut points = points.map(|p| place.transform * p);
        if !points.all(in_range) {
            return Err(Error::new(
                "coordinate-range",
                format!(
                    "The object '{}' has a coordinate that is no number or beyond {limit:e}",
                    node_reference(place.node)
                ),
                "Move or scale it back onto the page",
            )
            .at(self.resolver.position(place.node)));
        }
        let Some(collector) = self.open.last_mut() else { return Ok(()) };
        let style = place.style.as_deref().cloned().unwrap_or_default();
        collector.parts.push(Part { path, transform: place.transform, style });
        Ok(())
    }

    fn close(&mut self) -> Result<(), Error> {
        let Some(done) = self.open.pop() else { return Ok(()) };
        let paths: Vec<Outline> = done.parts.iter().map(root_outline).collect();
        let joined = || -> BezPath {
            paths.iter().flat_map(|outline| outline.path.elements().iter().copied()).collect()
        };
        let guide = || Guide { source: done.source.clone(), path: joined() };
        match done.role {
            Some(Role::Container) => {
                let container = self.container(&done, paths);
                self.scene.containers.push(container);
            }
            Some(Role::Guide) => self.scene.guides.push(guide()),
            Some(Role::FixedSpine) => self.scene.fixed_spines.push(guide()),
            Some(Role::Stem) => self.scene.stems.push(guide()),
            Some(Role::Boundary) => self.scene.boundaries.push(guide()),
            Some(Role::Spray) => {
                let width = done
                    .parts
                    .iter()
                    .filter_map(|part| Some(part.style.stroke_width()? * mean_scale(part.transform)))
                    .fold(0.0, f64::max);
                self.scene.sprays.push(Stroke { source: done.source.clone(), path: joined(), width });
            }
            Some(Role::Fixed) => self.scene.fixed.push(Fixed { source: done.source, parts: done.parts }),
            Some(Role::Seed) => {
                self.scene.seeds.push(Seed { at: joined().bounding_box().center(), source: done.source })
            }
            Some(Role::Spine) => self.spine(&done.source, &joined())?,
            Some(Role::Element) => self.element(done)?,
            // Read by the generators that use them, once they do.
            Some(Role::Form | Role::Clone | Role::Tack | Role::Reference | Role::Rules) => {}
            None => {
                if paths.iter().any(|outline| is_closed(&outline.path)) {
                    let container = self.container(&done, paths);
                    self.scene.containers.push(container);
                    self.selected_containers.push(true);
                } else if !paths.is_empty() {
                    self.scene.guides.push(guide());
                }
            }
        }
        Ok(())
    }

    fn container(&self, done: &Collector, outlines: Vec<Outline>) -> Container {
        let fill = done
            .parts
            .iter()
            .find(|part| part.style.is_filled())
            .map(|part| part.style.get("fill").unwrap_or("#000000").to_owned());
        let node = self.resolver.xml.get_node(done.node);
        let ours = node
            .iter()
            .flat_map(|node| node.attributes())
            .filter(|a| a.namespace() == Some(NAMESPACE) && a.name() != "role");
        let overrides = ours.map(|a| (a.name().to_owned(), a.value().to_owned())).collect();
        Container { source: done.source.clone(), outlines, fill, overrides }
    }

    fn spine(&mut self, source: &Source, path: &BezPath) -> Result<(), Error> {
        // A hand-drawn spine may bow this much of its length and still counts as straight.
        const STRAIGHT: f64 = 0.02;
        let remedy = "Draw it as one straight line from the base to the tip of the element";
        let mut segments = path.segments();
        let (Some(first), last) = (segments.next(), path.segments().last()) else {
            return Err(source.error(
                "zero-spine",
                format!("The spine '{}' has no length", source.id),
                remedy,
            ));
        };
        let (start, end) = (first.start(), last.map_or(first.end(), |segment| segment.end()));
        let length = start.distance(end);
        if length <= 1e-9 * self.scene.view.size().max_side() {
            return Err(source.error(
                "zero-spine",
                format!("The spine '{}' has no length", source.id),
                remedy,
            ));
        }
        let along = (end - start) / length;
        if path
            .elements()
            .iter()
            .flat_map(points_of)
            .any(|p| along.cross(p - start).abs() > STRAIGHT * length)
        {
            return Err(source.error(
                "bent-spine",
                format!("The spine '{}' is not straight", source.id),
                remedy,
            ));
        }
        match self.open.last_mut() {
            Some(element) => element.spines.push((start, end)),
            None => self
                .scene
                .warnings
                .push(format!("{}: the spine '{}' is in no element and is not used", source.at, source.id)),
        }
        Ok(())
    }

    fn element(&mut self, done: Collector) -> Result<(), Error> {
        if done.spines.len() > 1 {
            return Err(done.source.error(
                "two-spines",
                format!("The element '{}' has {} spines", done.source.id, done.spines.len()),
                "Keep one; group each element with its own spine",
            ));
        }
        if done.parts.iter().all(|part| part.path.elements().len() < 2) {
            return Err(done.source.error(
                "empty-element",
                format!("The element '{}' has nothing drawn in it", done.source.id),
                "Group its shapes with its spine, then mark the group as element",
            ));
        }
        let node = self.resolver.xml.get_node(done.node);
        let get =
            |name: &str| node.and_then(|node| node.attribute((NAMESPACE, name))).unwrap_or("").to_owned();
        let symbol =
            Some(get("symbol")).filter(|symbol| !symbol.is_empty()).unwrap_or_else(|| done.source.id.clone());
        let sets = get("set").split_whitespace().map(str::to_owned).collect();
        let template = Template { parts: done.parts, spine: done.spines.first().copied() };
        self.scene.elements.push(Element { source: done.source, kind: get("kind"), symbol, sets, template });
        Ok(())
    }

    fn broken(&self, node: Node, what: &str) -> Error {
        Error::new(
            "broken-object",
            format!("The object '{}' cannot be read: {what}", node_reference(node)),
            "Redraw it, or clear its mark",
        )
        .at(self.resolver.position(node))
    }
}

/// A part's outline in root units.
fn root_outline(part: &Part) -> Outline {
    Outline { path: part.transform * part.path.clone(), rule: part.style.fill_rule() }
}

/// True if the path has a closed subpath: a close command, or ends that meet.
fn is_closed(path: &BezPath) -> bool {
    if path.elements().iter().any(|el| matches!(el, PathEl::ClosePath)) {
        return true;
    }
    let (Some(first), Some(last)) = (path.segments().next(), path.segments().last()) else { return false };
    first.start().distance(last.end()) <= 1e-6 * path.bounding_box().size().max_side()
        && path.segments().count() > 1
}

/// Content that is never drawn where it stands and holds no templates.
fn is_never_drawn(name: &str) -> bool {
    matches!(
        name,
        "clipPath"
            | "mask"
            | "pattern"
            | "marker"
            | "linearGradient"
            | "radialGradient"
            | "filter"
            | "metadata"
            | "style"
            | "script"
            | "title"
            | "desc"
            | "foreignObject"
    )
}

fn has_role_below(node: Node) -> bool {
    node.descendants().any(|inner| {
        inner.attribute((NAMESPACE, "role")).is_some()
            || inner.attribute("class").is_some_and(|class| class.contains("rinceau-"))
    })
}

fn points_of(el: &PathEl) -> impl Iterator<Item = Point> + use<> {
    let points: [Option<Point>; 3] = match *el {
        PathEl::MoveTo(p) | PathEl::LineTo(p) => [Some(p), None, None],
        PathEl::QuadTo(a, p) => [Some(a), Some(p), None],
        PathEl::CurveTo(a, b, p) => [Some(a), Some(b), Some(p)],
        PathEl::ClosePath => [None; 3],
    };
    points.into_iter().flatten()
}
