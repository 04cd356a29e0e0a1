//! The walk itself: coordinates and styles from the root down, clones followed.

use super::collect::{Drawn, Gathering, Situation};
use super::forms::shift_of_use;
use super::resolver::{Resolver, is_svg, nested_viewport, own_transform};
use crate::artwork::Part;
use crate::error::{Error, Position};
use crate::scene::{Live, Scene, When};
use crate::style::Style;
use crate::units::{Axis, Units, mean_scale};
use crate::vocabulary::NAMESPACE;
use crate::xml::PlainAttribute;
use crate::{shape, style, text};
use kurbo::{Affine, BezPath, Size};
use roxmltree::{Node, NodeId};
use std::collections::HashSet;
use std::rc::Rc;

/// Largest coefficient of a transform: it takes the smallest drawing to the largest.
const LARGEST_SCALE: f64 = 1e18;

/// What to do next; the stack holds the rest of the drawing.
enum Visit<'a, 'i> {
    /// An element and its siblings after it.
    Row(Place<'a, 'i>),
    /// An element alone.
    One(Place<'a, 'i>),
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
    /// The parent's style.
    style: Rc<Style>,
    /// Once entered: from the parent's coordinates to the root's, and the parent's style if that
    /// matters.
    frame: Affine,
    inherited: Rc<Style>,
    /// Inside `<defs>`, where only templates are looked for.
    in_defs: bool,
    /// Inside `display:none` or a definition, where only annotated objects count.
    hidden: bool,
}

struct Walk<'r, 'a, 'i> {
    resolver: &'r Resolver<'a, 'i>,
    selection: HashSet<NodeId>,
    /// Places of objects that are passed over.
    passed: &'r HashSet<Position>,
    stack: Vec<Visit<'a, 'i>>,
    gathering: Gathering<'r, 'a, 'i>,
    /// Targets of the `<use>` elements around, to find clones that contain themselves.
    uses: Vec<NodeId>,
    used: HashSet<NodeId>,
    /// The outermost `<use>` around, as a display list refers to it.
    outer_use: Drawn,
    /// True if the next `<use>` entered replicates a form.
    is_replica: bool,
    counts: Counts,
}

/// What grows faster than the drawing's text, and so has a limit of its own.
#[derive(Default)]
struct Counts {
    instances: usize,
    nodes: usize,
    bytes: usize,
    texts: usize,
}

/// Walks the drawing once, past the objects at some places.
pub(super) fn walk(
    resolver: &Resolver,
    selection: HashSet<NodeId>,
    passed: &HashSet<Position>,
) -> Result<Scene, Error> {
    let root = resolver.xml.root_element();
    let units = Units { viewport: resolver.view.size(), em: 16.0 };
    let mut walk = Walk {
        resolver,
        selection,
        passed,
        stack: Vec::new(),
        gathering: Gathering::new(resolver),
        uses: Vec::new(),
        used: HashSet::new(),
        outer_use: Drawn::default(),
        is_replica: false,
        counts: Counts::default(),
    };
    let style = Rc::new(resolver.cascade.computed(root, &Style::initial(), &units));
    walk.push_children(&Place {
        node: root,
        transform: Affine::IDENTITY,
        viewport: units.viewport,
        inherited: Rc::clone(&style),
        style,
        frame: Affine::IDENTITY,
        in_defs: false,
        hidden: false,
    });
    while let Some(visit) = walk.stack.pop() {
        walk.visit(visit)?;
    }
    walk.gathering.finish()
}

impl<'a, 'i> Walk<'_, 'a, 'i> {
    fn visit(&mut self, visit: Visit<'a, 'i>) -> Result<(), Error> {
        match visit {
            Visit::Row(place) => {
                // An ordinary drawing around the annotated objects costs nothing.
                let only_marked = self.gathering.is_empty() || place.hidden;
                let is_passed = |node: &Node| only_marked && !self.resolver.is_marked(*node);
                let mut row = std::iter::successors(Some(place.node), Node::next_sibling_element);
                let Some(node) = row.by_ref().find(|node| !is_passed(node)) else { return Ok(()) };
                if let Some(next) = row.next() {
                    self.stack.push(Visit::Row(Place { node: next, ..place.clone() }));
                }
                self.enter(Place { node, ..place })
            }
            Visit::One(place) => self.enter(place),
            Visit::Close => self.gathering.close(),
            Visit::LeaveUse => {
                if let Some(target) = self.uses.pop() {
                    self.used.remove(&target);
                }
                Ok(())
            }
        }
    }

    fn push_children(&mut self, parent: &Place<'a, 'i>) {
        if let Some(first) = parent.node.first_element_child() {
            self.stack.push(Visit::Row(Place { node: first, ..parent.clone() }));
        }
    }

    /// True inside the content of a `<use>`.
    fn in_clone(&self) -> bool {
        !self.uses.is_empty()
    }

    fn enter(&mut self, mut place: Place<'a, 'i>) -> Result<(), Error> {
        let node = place.node;
        let name = node.tag_name().name();
        let is_result = node.attribute((NAMESPACE, "result")).is_some();
        if !is_svg(&node, name) || is_result || is_never_drawn(name) || self.is_other_step(node) {
            return Ok(());
        }
        if !self.passed.is_empty() && self.passed.contains(&self.resolver.position(node)) {
            return Ok(());
        }
        self.count(node)?;
        if matches!(name, "defs" | "symbol") {
            // Drawn only where a clone refers to it, which does not come this way.
            (place.in_defs, place.hidden) = (true, true);
        }

        let outermost = self.gathering.is_empty();
        let situation = Situation {
            in_defs: place.in_defs,
            in_clone: self.in_clone(),
            selected: !self.in_clone() && self.selection.contains(&node.id()),
        };
        let opened = self.gathering.open(node, &situation)?;
        if opened {
            self.stack.push(Visit::Close);
            place.hidden = false;
            if outermost {
                // Opacity of the groups around belongs to those groups, not to copies.
                Rc::make_mut(&mut place.style).forget_groups();
            }
        }
        let units = Units { viewport: place.viewport, em: place.style.font_size() };
        place.frame = place.transform;
        if self.gathering.is_form() {
            place.inherited = Rc::clone(&place.style);
        }
        // A group with a broken transform is entered only for what is annotated below it,
        // and that has no place either.
        place.transform *= own_transform(node, &units).map_err(|what| self.broken(node, &what))?;
        place.style = Rc::new(self.resolver.cascade.computed(node, &place.style, &units));
        if self.resolver.cascade.is_exhausted() {
            return Err(self.style_too_complex(node));
        }
        place.hidden |= place.style.is_display_none() && !opened;
        if place.hidden && !self.resolver.is_marked(node) {
            return Ok(());
        }
        self.content(place, &units)
    }

    /// True for a step of an exploration that was not selected.
    fn is_other_step(&self, node: Node) -> bool {
        node.attribute((NAMESPACE, "step")).is_some()
            && !node.descendants().any(|below| self.selection.contains(&below.id()))
    }

    /// Counts a node of a clone's content.
    fn count(&mut self, node: Node) -> Result<(), Error> {
        if !self.in_clone() {
            return Ok(());
        }
        let limits = self.resolver.limits;
        let tag_end = node.first_child().map_or(node.range().end, |child| child.range().start);
        self.counts.nodes += 1;
        self.counts.bytes += tag_end.saturating_sub(node.range().start);
        if self.counts.nodes > limits.instance_nodes || self.counts.bytes > limits.instance_bytes {
            return Err(self.too_many_clones(node, "The clones in the annotated objects repeat too much"));
        }
        Ok(())
    }

    /// What a node draws, or the nodes below it.
    fn content(&mut self, mut place: Place<'a, 'i>, units: &Units) -> Result<(), Error> {
        let node = place.node;
        let is_drawn = !self.gathering.is_empty() && !place.hidden;
        if !self.in_clone() && self.replicates(&place, units)? {
            return Ok(());
        }
        match node.tag_name().name() {
            "use" if is_drawn => self.enter_use(&place, units),
            "use" => Ok(()),
            "svg" => {
                if let Some((fit, viewport)) = nested_viewport(node, units, (None, None)) {
                    place.transform *= fit;
                    place.viewport = viewport;
                    self.push_children(&place);
                }
                Ok(())
            }
            "switch" => {
                // Only the first that can be drawn is.
                if let Some(node) = node.children().find(is_supported) {
                    self.stack.push(Visit::One(Place { node, ..place }));
                }
                Ok(())
            }
            "text" if is_drawn => self.text(&place),
            "text" => Ok(()),
            _ if !shape::is_shape(node) => {
                self.push_children(&place);
                Ok(())
            }
            _ if !is_drawn => Ok(()),
            _ => {
                let path = shape::outline(node, units).map_err(|what| self.broken(node, &what))?;
                if node.tag_name().name() == "image" {
                    Rc::make_mut(&mut place.style).add_effect(style::PICTURE);
                }
                self.part(&place, path)
            }
        }
    }

    /// True if a node is a clone of a form and not a drawn part of one; it is noted then.
    fn replicates(&mut self, place: &Place<'a, 'i>, units: &Units) -> Result<bool, Error> {
        let node = place.node;
        let is_use = node.tag_name().name() == "use";
        let pose = if is_use { place.transform * shift_of_use(node, units) } else { place.transform };
        if self.gathering.is_clone() {
            self.gathering.place(pose);
            return Ok(true);
        }
        if !is_use || !self.gathering.is_form() {
            return Ok(false);
        }
        // A use of something else is drawn like any other shape.
        let is_marked = self.gathering.is_marked_form();
        let target = self.resolver.href(node)?;
        let is_clone = target.map_or(is_marked, |target| self.gathering.is_in_form(target));
        if !is_clone {
            return Ok(false);
        }
        self.gathering.add_clone(node, pose);
        // In a group without a mark, which may be meant as a shape, it is drawn all the same.
        self.is_replica = !is_marked && target.is_some_and(|target| !node.ancestors().any(|a| a == target));
        Ok(!self.is_replica)
    }

    /// What a display list knows of a node beyond its shape.
    fn drawn(&self, place: &Place) -> Drawn {
        if self.in_clone() {
            return self.outer_use.clone();
        }
        let id = place.node.plain("id").filter(|id| !id.is_empty());
        let live = id.map(|id| Live {
            id: id.to_owned(),
            frame: place.frame,
            inherited: place.inherited.inherited_css(),
        });
        let inside = || place.node.ancestors().take_while(|&node| !self.gathering.is_innermost(node));
        let child = inside().last().map(|node| node.id());
        // Its own word, or that of a group around it; the form's is a parameter.
        let when = inside().find_map(|node| node.attribute((NAMESPACE, "generations")));
        let when = match when.map(str::trim) {
            Some("last") => When::Last,
            Some("inner") => When::Inner,
            _ => When::AsForm,
        };
        Drawn { when, live, of_clone: false, child }
    }

    fn enter_use(&mut self, place: &Place<'a, 'i>, units: &Units) -> Result<(), Error> {
        let node = place.node;
        if self.gathering.wants_children() && !self.in_clone() {
            let of_clone = std::mem::take(&mut self.is_replica);
            self.outer_use = Drawn { of_clone, ..self.drawn(place) };
        }
        let Some(target) = self.resolver.href(node)? else {
            self.gathering.warn(format!(
                "{}: a clone refers to nothing in this drawing and is left out",
                self.resolver.position(node)
            ));
            return Ok(());
        };
        let is_cycle =
            self.used.contains(&target.id()) || node.ancestors().any(|ancestor| ancestor == target);
        if is_cycle && self.gathering.is_form() && !self.gathering.is_marked_form() {
            self.gathering.warn(format!(
                "{}: the clone '{}' contains itself and is left out",
                self.resolver.position(node),
                self.resolver.reference(node)
            ));
            return Ok(());
        }
        if is_cycle {
            return Err(Error::new(
                "clone-cycle",
                format!("The clone '{}' contains itself", self.resolver.reference(node)),
                "Delete the clone, or unlink it (Edit > Clone > Unlink Clone)",
            )
            .at(self.resolver.position(node)));
        }
        self.counts.instances += 1;
        let limit = self.resolver.limits.instances;
        if self.counts.instances > limit {
            let sentence = format!("The annotated objects contain more than {limit} clones");
            return Err(self.too_many_clones(node, &sentence));
        }
        let side = |name, axis| node.plain(name).and_then(|text| units.resolve(text, axis));
        let mut inner = place.clone();
        inner.transform *= shift_of_use(node, units);
        inner.in_defs = false;
        inner.node = target;
        self.uses.push(target.id());
        self.used.insert(target.id());
        self.stack.push(Visit::LeaveUse);
        if !matches!(target.tag_name().name(), "symbol" | "svg") {
            self.stack.push(Visit::One(inner));
            return Ok(());
        }
        self.count(target)?;
        let size = (side("width", Axis::X), side("height", Axis::Y));
        if let Some((fit, viewport)) = nested_viewport(target, units, size) {
            inner.transform *= fit;
            inner.viewport = viewport;
            inner.style = Rc::new(self.resolver.cascade.computed(target, &inner.style, units));
            self.push_children(&inner);
        }
        Ok(())
    }

    fn text(&mut self, place: &Place<'a, 'i>) -> Result<(), Error> {
        let node = place.node;
        let mut place = place.clone();
        let mut paints = node.descendants().filter(|inner| inner.tag_name().name() == "tspan").map(|span| {
            let units = Units { viewport: place.viewport, em: place.style.font_size() };
            self.resolver.cascade.computed(span, &place.style, &units).css()
        });
        if paints.any(|paint| paint != place.style.css()) {
            Rc::make_mut(&mut place.style).add_effect("colours of single words");
        }
        let place = &place;
        self.counts.texts += 1;
        let limit = self.resolver.limits.texts;
        let outlines = if self.counts.texts > limit {
            Err(format!("only {limit} texts of a drawing are laid out"))
        } else {
            text::outlines(node, &place.style, self.resolver)
        };
        let outlines = outlines.map_err(|what| {
            Error::new(
                "text-without-outline",
                format!("The text '{}' has no outline: {what}", self.resolver.reference(node)),
                "Install its font, or turn it into a path (Path > Object to Path)",
            )
            .at(self.resolver.position(node))
        })?;
        for path in outlines {
            self.part(place, path)?;
        }
        Ok(())
    }

    fn part(&mut self, place: &Place<'a, 'i>, path: BezPath) -> Result<(), Error> {
        let limit = self.resolver.limits.coordinate;
        let in_range = |value: f64| value.abs() <= limit;
        let is_sane = place.transform.as_coeffs().iter().all(|c| c.abs() <= LARGEST_SCALE);
        let width = place.style.stroke_width().unwrap_or(0.0) * mean_scale(place.transform);
        let mut points = path.elements().iter().flat_map(shape::points_of).map(|p| (p, place.transform * p));
        let points_fit =
            points.all(|(own, p)| in_range(p.x) && in_range(p.y) && own.x.is_finite() && own.y.is_finite());
        if !(is_sane && in_range(width) && points_fit) {
            return Err(Error::new(
                "coordinate-range",
                format!(
                    "The object '{}' has a coordinate that is no number or beyond {limit:e}",
                    self.resolver.reference(place.node)
                ),
                "Move or scale it back onto the page",
            )
            .at(self.resolver.position(place.node)));
        }
        let part = Part { path, transform: place.transform, style: place.style.as_ref().clone() };
        let drawn = if self.gathering.wants_children() { self.drawn(place) } else { Drawn::default() };
        self.gathering.add(part, drawn);
        Ok(())
    }

    fn broken(&self, node: Node, what: &str) -> Error {
        Error::new(
            "broken-object",
            format!("The object '{}' cannot be read: {what}", self.resolver.reference(node)),
            "Redraw it, or clear its mark",
        )
        .at(self.resolver.position(node))
    }

    fn too_many_clones(&self, node: Node, sentence: &str) -> Error {
        Error::new("too-many-clones", sentence, "Mark fewer objects, or unlink some clones")
            .at(self.resolver.position(node))
    }

    fn style_too_complex(&self, node: Node) -> Error {
        Error::new(
            "style-too-complex",
            "The drawing's style sheets have too many rules for the number of annotated objects",
            "Copy what is to be filled into a new drawing",
        )
        .at(self.resolver.position(node))
    }
}

/// True for a child of a `<switch>` that can be drawn: one for everybody.
fn is_supported(node: &Node) -> bool {
    let says = |name| node.plain(name).is_some_and(|text| !text.trim().is_empty());
    let is_english =
        |text: &str| text.split(',').any(|language| language.trim().to_ascii_lowercase().starts_with("en"));
    node.is_element()
        && !says("requiredExtensions")
        && node.plain("systemLanguage").is_none_or(is_english)
        && node.tag_name().name() != "foreignObject"
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
