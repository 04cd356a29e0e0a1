//! What the walk gathers for each annotated object.

use super::forms::{RawClone, RawForm, RawItem};
use super::resolver::Resolver;
use super::role::role_of;
use crate::artwork::Part;
use crate::error::Error;
use crate::number::path_data;
use crate::scene::{
    Container, Element, Example, Fixed, Guide, Live, Outline, Primitive, Reference, Scene, Seed, Source,
    Stroke, Template, When,
};
use crate::shape::{closed, is_closed, points_of};
use crate::units::mean_scale;
use crate::vocabulary::{INKSCAPE, NAMESPACE, OWN_STYLE, Role};
use kurbo::{Affine, BezPath, ParamCurve, Point, Rect, Shape};
use roxmltree::{Node, NodeId};
use std::collections::{BTreeMap, HashMap};

/// What stands open: an annotated object, or a selected one without a role.
#[derive(Clone)]
struct Collector {
    role: Option<Role>,
    source: Source,
    node: NodeId,
    is_group: bool,
    selected: bool,
    parts: Vec<Part>,
    spines: Vec<(Point, Point)>,
    /// For a form or a selected group: what else a display list knows of its parts, one each.
    drawn: Vec<Drawn>,
    /// Its clones, and before which part each stands.
    clones: Vec<(usize, RawClone)>,
    /// For a clone: from its own coordinates to the root's.
    pose: Affine,
}

/// What a display list knows of a part beyond its shape.
#[derive(Clone, Default)]
pub(super) struct Drawn {
    pub when: When,
    pub live: Option<Live>,
    /// Drawn by a clone: part of a shape, but no primitive.
    pub of_clone: bool,
    /// The child of the annotated group that it is in.
    pub child: Option<NodeId>,
}

/// Where in the drawing a node stands, as far as roles depend on it.
pub(super) struct Situation {
    /// Inside `<defs>`, where only templates are looked for.
    pub in_defs: bool,
    /// Inside a clone, where only the spine of an element is looked for.
    pub in_clone: bool,
    /// Asked for by id.
    pub selected: bool,
}

/// The scene so far, and the annotated objects around the walk.
pub(super) struct Gathering<'r, 'a, 'i> {
    resolver: &'r Resolver<'a, 'i>,
    open: Vec<Collector>,
    scene: Scene,
    /// For each container of the scene, whether it was selected.
    selected_containers: Vec<bool>,
    forms: Vec<RawForm>,
    /// Whose each id of the scene is.
    named: HashMap<String, NodeId>,
}

impl<'r, 'a, 'i> Gathering<'r, 'a, 'i> {
    pub fn new(resolver: &'r Resolver<'a, 'i>) -> Self {
        let scene = Scene { view: resolver.view, px_per_unit: resolver.px_per_unit, ..Scene::default() };
        let (open, selected_containers, forms) = (Vec::new(), Vec::new(), Vec::new());
        Gathering { resolver, open, scene, selected_containers, forms, named: HashMap::new() }
    }

    /// True outside annotated objects.
    pub fn is_empty(&self) -> bool {
        self.open.is_empty()
    }

    pub fn warn(&mut self, warning: String) {
        self.scene.warnings.push(warning);
    }

    /// Adds a shape to the innermost object; `drawn` tells a form more about it.
    pub fn add(&mut self, part: Part, drawn: Drawn) {
        if let Some(collector) = self.open.last_mut() {
            collector.parts.push(part);
            if collector.wants_children() {
                collector.drawn.push(drawn);
            }
        }
    }

    /// True if the innermost object is a display list.
    pub fn is_form(&self) -> bool {
        self.open.last().is_some_and(Collector::is_list)
    }

    /// True if it matters to the innermost object which of its children a part is in.
    pub fn wants_children(&self) -> bool {
        self.open.last().is_some_and(Collector::wants_children)
    }

    /// True if the innermost object is marked as one.
    pub fn is_marked_form(&self) -> bool {
        self.open.last().is_some_and(|collector| collector.role == Some(Role::Form))
    }

    /// True for the node of the innermost object.
    pub fn is_innermost(&self, node: Node) -> bool {
        self.open.last().is_some_and(|collector| collector.node == node.id())
    }

    /// True if the innermost object is a clone of a form.
    pub fn is_clone(&self) -> bool {
        self.open.last().is_some_and(|collector| collector.role == Some(Role::Clone))
    }

    /// Where the innermost object, a clone, stands.
    pub fn place(&mut self, pose: Affine) {
        if let Some(collector) = self.open.last_mut() {
            collector.pose = pose;
        }
    }

    /// True if a node lies in a display list.
    pub fn is_in_form(&self, node: Node) -> bool {
        node.ancestors().any(|ancestor| {
            self.open.iter().any(|open| open.is_list() && open.node == ancestor.id())
                || matches!(role_of(self.resolver, ancestor), Ok(Some((Role::Form, _))))
        })
    }

    /// Adds a clone to the innermost object, a display list.
    pub fn add_clone(&mut self, node: Node, pose: Affine) {
        let source = self.source(node);
        if let Some(collector) = self.open.last_mut() {
            collector.clones.push((collector.parts.len(), RawClone { node: node.id(), source, pose }));
        }
    }

    pub fn finish(mut self) -> Result<Scene, Error> {
        let forms = std::mem::take(&mut self.forms);
        self.scene.forms = super::forms::resolve(self.resolver, forms, &mut self.scene.warnings)?;
        // A selection of some annotated containers narrows the run to those.
        if self.selected_containers.contains(&true) {
            let mut keep = self.selected_containers.iter();
            self.scene.containers.retain(|_| *keep.next().unwrap_or(&true));
        }
        Ok(self.scene)
    }

    /// What a node is called. An id that stands twice names the first alone; the others go by their place.
    fn source(&mut self, node: Node) -> Source {
        let mut id = self.resolver.reference(node);
        if *self.named.entry(id.clone()).or_insert(node.id()) != node.id() {
            let mut place = self.resolver.place(node);
            while *self.named.entry(place.clone()).or_insert(node.id()) != node.id() {
                place.push('+');
            }
            let at = self.resolver.position(node);
            self.warn(format!(
                "{at}: another object has the id '{id}' too; this one is called '{place}'. Give it an id of \
                 its own (Object > Object Properties)."
            ));
            id = place;
        }
        let label = node
            .attribute((INKSCAPE, "label"))
            .map_or_else(|| id.trim_start_matches("node:").to_owned(), str::to_owned);
        Source { id, label, at: self.resolver.position(node) }
    }

    /// Opens a collector if the node has a role that counts here, or is selected.
    pub fn open(&mut self, node: Node, situation: &Situation) -> Result<bool, Error> {
        let found = role_of(self.resolver, node)?.filter(|(role, _)| match (situation.in_clone, role) {
            (true, role) => *role == Role::Spine,
            (false, role) => {
                !situation.in_defs || matches!(role, Role::Element | Role::Spine | Role::Form | Role::Clone)
            }
        });
        let role = found.as_ref().map(|(role, _)| *role);
        self.scene.warnings.extend(found.and_then(|(_, warning)| warning));
        if role.is_none() && !(situation.selected && self.open.is_empty()) {
            return Ok(false);
        }
        self.check_nesting(node, role)?;
        let source = self.source(node);
        self.open.push(Collector {
            role,
            source,
            node: node.id(),
            is_group: node.tag_name().name() == "g",
            selected: situation.selected,
            parts: Vec::new(),
            spines: Vec::new(),
            drawn: Vec::new(),
            clones: Vec::new(),
            pose: Affine::IDENTITY,
        });
        Ok(true)
    }

    /// Groups may hold annotated objects of their own; a path's role covers all of it.
    fn check_nesting(&self, node: Node, role: Option<Role>) -> Result<(), Error> {
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
                    self.resolver.reference(node),
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
        Ok(())
    }

    /// The newest object is done: it enters the scene.
    pub fn close(&mut self) -> Result<(), Error> {
        let Some(done) = self.open.pop() else { return Ok(()) };
        match done.role {
            Some(Role::Container) => self.container(done),
            Some(Role::Guide) => self.scene.guides.push(done.guide()),
            Some(Role::FixedSpine) => self.scene.fixed_spines.push(done.guide()),
            Some(Role::Stem) => self.scene.stems.push(done.guide()),
            Some(Role::Boundary) => self.scene.boundaries.push(done.guide()),
            Some(Role::Spray) => {
                let widths = done
                    .parts
                    .iter()
                    .filter_map(|part| Some(part.style.stroke_width()? * mean_scale(part.transform)));
                let width = widths.fold(0.0, f64::max);
                let overrides = self.overrides(done.node);
                let Guide { source, path, .. } = done.guide();
                self.scene.sprays.push(Stroke { source, path, width, overrides });
            }
            Some(Role::Fixed) => self.scene.fixed.push(Fixed { source: done.source, parts: done.parts }),
            Some(Role::Seed) => {
                let seed = self.middle(done.guide());
                self.scene.seeds.extend(seed);
            }
            Some(Role::Spine) => self.spine(&done.guide())?,
            Some(Role::Element) => self.element(done)?,
            Some(Role::Tack) => {
                let tack = self.middle(done.guide());
                self.scene.tacks.extend(tack);
            }
            Some(Role::Form) => self.form(done),
            Some(Role::Clone) => self.close_clone(done),
            Some(Role::Reference) => self.reference(done)?,
            // Rules are text in the metadata, not an object.
            Some(Role::Rules) => {}
            // A selected group with clones of its own shapes is a form without a mark, for those who
            // look for one, and a shape for others.
            None if !done.clones.is_empty() => {
                self.form(done.clone());
                self.shape(done);
            }
            None => self.shape(done),
        }
        Ok(())
    }

    /// A selected object without a mark. What is painted inside is a shape, also if its ends do not meet: its
    /// fill closes it.
    fn shape(&mut self, mut done: Collector) {
        let filled = done.parts.iter_mut();
        filled
            .filter(|part| part.style.is_filled() && part.style.get("fill").is_some())
            .for_each(|part| part.path = closed(&part.path));
        match &done.parts[..] {
            parts if parts.iter().any(|part| is_closed(&part.path)) => self.container(done),
            [] => {}
            _ => self.scene.guides.push(Guide { marked: false, ..done.guide() }),
        }
    }

    /// The middle of what is drawn; a path that only moves is a point.
    fn middle(&mut self, Guide { source, path, .. }: Guide) -> Option<Seed> {
        let mut points = path.elements().iter().flat_map(points_of);
        let Some(first) = points.next() else {
            self.warn(format!("{}: the mark '{}' has nothing drawn in it", source.at, source.id));
            return None;
        };
        let bounds = match path.segments().next() {
            Some(_) => path.bounding_box(),
            None => points.fold(Rect::from_points(first, first), |bounds, p| bounds.union_pt(p)),
        };
        Some(Seed { at: bounds.center(), source })
    }

    fn form(&mut self, done: Collector) {
        let overrides = self.overrides(done.node);
        let Collector { role, source, node, selected, parts, drawn, clones, .. } = done;
        let mut clones = clones.into_iter().peekable();
        let mut items = Vec::new();
        for (i, (part, drawn)) in parts.into_iter().zip(drawn).enumerate() {
            while let Some((_, clone)) = clones.next_if(|(before, _)| *before <= i) {
                items.push(RawItem::Clone(clone));
            }
            if !drawn.of_clone && !part.style.is_invisible() {
                items.push(RawItem::Primitive(Primitive { part, when: drawn.when, live: drawn.live }));
            }
        }
        items.extend(clones.map(|(_, clone)| RawItem::Clone(clone)));
        self.forms.push(RawForm { node, source, selected, marked: role.is_some(), items, overrides });
    }

    /// The children of an example with something drawn in them, and what each is one of.
    fn reference(&mut self, done: Collector) -> Result<(), Error> {
        let mut children: Vec<(NodeId, Vec<Part>)> = Vec::new();
        for (part, drawn) in done.parts.into_iter().zip(done.drawn) {
            let Some(child) = drawn.child else { continue };
            match children.last_mut().filter(|(node, _)| *node == child) {
                Some((_, parts)) => parts.push(part),
                None => children.push((child, vec![part])),
            }
        }
        let mut shapes: BTreeMap<String, String> = BTreeMap::new();
        let mut examples = Vec::with_capacity(children.len());
        for (node, parts) in children {
            let Some(node) = self.resolver.xml.get_node(node) else { continue };
            let source = self.source(node);
            let named = node.attribute((NAMESPACE, "symbol")).map(str::trim).filter(|name| !name.is_empty());
            let cloned = match node.tag_name().name() {
                "use" => self.resolver.href(node)?.map(|target| self.resolver.reference(target)),
                _ => None,
            };
            let same = shapes.entry(signature(&parts)).or_insert_with(|| source.id.clone());
            let symbol = named.map(str::to_owned).or(cloned).unwrap_or_else(|| same.clone());
            examples.push(Example { source, symbol, parts });
        }
        let node = self.resolver.xml.get_node(done.node);
        let flips = node.and_then(|node| node.attribute((NAMESPACE, "flip"))).unwrap_or("");
        let ids: Vec<&str> = flips.split([' ', ',', ';', '\t', '\n']).filter(|id| !id.is_empty()).collect();
        let flips = ids.chunks_exact(2).map(|pair| (pair[0].to_owned(), pair[1].to_owned())).collect();
        self.scene.references.push(Reference { source: done.source, examples, flips });
        Ok(())
    }

    /// A marked clone goes into the form around it.
    fn close_clone(&mut self, Collector { source, node, pose, .. }: Collector) {
        match self.open.last_mut() {
            Some(form) if form.is_list() => {
                form.clones.push((form.parts.len(), RawClone { node, source, pose }));
            }
            _ => self.warn(format!("{}: the clone '{}' is in no form and is not used", source.at, source.id)),
        }
    }

    /// Parameters that an object sets for itself.
    fn overrides(&self, node: NodeId) -> BTreeMap<String, String> {
        let node = self.resolver.xml.get_node(node);
        let ours = node.iter().flat_map(|node| node.attributes()).filter(|a| {
            a.namespace() == Some(NAMESPACE) && !matches!(a.name(), "role" | "parent" | OWN_STYLE)
        });
        ours.map(|a| (a.name().to_owned(), a.value().to_owned())).collect()
    }

    fn container(&mut self, done: Collector) {
        let fill = done
            .parts
            .iter()
            .find(|part| part.style.is_filled())
            .map(|part| part.style.get("fill").unwrap_or("#000000").to_owned());
        let overrides = self.overrides(done.node);
        let hidden = ["clip", "mask"].into_iter();
        let hidden: Vec<&str> = hidden
            .filter(|effect| done.parts.iter().any(|part| part.style.effects().contains(effect)))
            .collect();
        if !hidden.is_empty() {
            let Source { at, id, .. } = &done.source;
            self.warn(format!(
                "{at}: a {} hides some of '{id}', but all of it is filled. To fill what shows alone, make that a shape of its own (Path > Intersection)",
                hidden.join(" and a "),
            ));
        }
        let outlines = done.parts.into_iter().map(root_outline).collect();
        self.scene.containers.push(Container { source: done.source, outlines, fill, overrides });
        self.selected_containers.push(done.selected);
    }

    fn spine(&mut self, Guide { source, path, .. }: &Guide) -> Result<(), Error> {
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
                .warn(format!("{}: the spine '{}' is in no element and is not used", source.at, source.id)),
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
}

/// The same for shapes of one look, wherever they are.
fn signature(parts: &[Part]) -> String {
    let drawn: Vec<BezPath> = parts.iter().map(|part| part.transform * part.path.clone()).collect();
    let bounds = drawn.iter().map(Shape::bounding_box).reduce(|a, b| a.union(b)).unwrap_or(Rect::ZERO);
    let mut out = String::new();
    for (part, path) in parts.iter().zip(drawn) {
        let here = Affine::translate(-bounds.center().to_vec2()) * path;
        out += &path_data(&here, 2);
        out += &part.style.css();
    }
    out
}

impl Collector {
    /// True for a form, and for a selected group, which may be one without a mark.
    fn is_list(&self) -> bool {
        self.role == Some(Role::Form) || (self.role.is_none() && self.is_group)
    }

    fn wants_children(&self) -> bool {
        self.is_list() || self.role == Some(Role::Reference)
    }

    /// All shapes as one path.
    fn guide(self) -> Guide {
        let mut outlines = self.parts.into_iter().map(|part| root_outline(part).path);
        let mut path = outlines.next().unwrap_or_default();
        path.extend(outlines.flatten());
        Guide { source: self.source, marked: true, path }
    }
}

/// A part's outline in root units. The path is moved, not copied: it may be most of the file.
fn root_outline(part: Part) -> Outline {
    let mut path = part.path;
    path.apply_affine(part.transform);
    Outline { path, rule: part.style.fill_rule() }
}
