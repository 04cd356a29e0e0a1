//! One walk over the XML fills the [`Scene`].
//!
//! The walk keeps its own stack, so that depth is bounded by memory already counted and not
//! by the thread's stack. A shape belongs to the innermost role around it. Styles are
//! computed only inside annotated objects; an ordinary drawing around them costs nothing.

mod collect;
mod forms;
mod resolver;
mod role;
mod walk;

use crate::document::forms_of_step;
use crate::error::{Error, Position};
use crate::limits::Limits;
use crate::scene::{RuleSet, Scene, Selection};
use crate::style::Style;
use crate::vocabulary::NAMESPACE;
use crate::xml::PlainAttribute;
use std::collections::HashSet;

/// Reads every annotated (or selected) object of a parsed drawing.
///
/// Errors: see SPEC.md, "Reason codes". Nothing outside annotated objects can be an error.
pub(crate) fn scene(
    xml: &roxmltree::Document,
    selection: &Selection,
    limits: &Limits,
) -> Result<Scene, Error> {
    scene_without(xml, selection, limits, &HashSet::new())
}

/// The same as if the objects at some places were not there.
pub(crate) fn scene_without(
    xml: &roxmltree::Document,
    selection: &Selection,
    limits: &Limits,
    passed: &HashSet<Position>,
) -> Result<Scene, Error> {
    let mut resolver = Resolver::new(xml, limits)?;
    let mut selected = Vec::new();
    for id in &selection.ids {
        let node = resolver.by_reference(id)?.ok_or_else(|| unknown_id(id))?;
        // A step of an exploration stands for the form that it keeps.
        let step = node.ancestors().find(|node| node.attribute((NAMESPACE, "step")).is_some());
        let form = step.and_then(|step| forms_of_step(step).first().copied());
        selected.push(form.unwrap_or(node));
    }
    resolver.mark(&selected);
    let selected = selected.iter().map(roxmltree::Node::id).collect();
    let mut scene = walk::walk(&resolver, selected, passed)?;
    scene.rules = rule_sets(xml);
    Ok(scene)
}

/// The rule sets of a drawing, wherever they stand.
fn rule_sets(xml: &roxmltree::Document) -> Vec<RuleSet> {
    let is_rules = |node: &roxmltree::Node| node.tag_name() == (NAMESPACE, "rules").into();
    let rule_set = |node: roxmltree::Node| {
        let name = node.plain("name").or_else(|| node.plain("id")).unwrap_or("rules").trim().to_owned();
        let text = node.children().filter_map(|child| child.text()).collect();
        RuleSet { name, text }
    };
    xml.descendants().filter(is_rules).map(rule_set).collect()
}

pub(crate) use forms::{set_roots, shift_of_use};
pub(crate) use resolver::{Resolver, has_mark, own_transform, transform_origin};

/// The error for an id that nothing has.
pub(crate) fn unknown_id(id: &str) -> Error {
    Error::new(
        "unknown-id",
        format!("No object has the id '{id}'"),
        "Check the id in Object > Object Properties",
    )
}

/// True for `<svg>`, with or without its namespace.
pub(crate) fn is_svg_root(root: roxmltree::Node) -> bool {
    resolver::is_svg(&root, "svg")
}

/// From a result layer's own coordinates to the root's. A transform that cannot be read
/// counts as none, as renderers do.
pub(crate) fn layer_transform(resolver: &Resolver, layer: roxmltree::Node) -> kurbo::Affine {
    to_root(resolver, layer)
}

/// What an object inherits from those around it.
pub(crate) fn inherited_style<'a>(resolver: &Resolver<'a, '_>, node: roxmltree::Node<'a, '_>) -> Style {
    let units = crate::units::Units { viewport: resolver.view.size(), em: 16.0 };
    let mut chain: Vec<_> = node.ancestors().skip(1).filter(roxmltree::Node::is_element).collect();
    chain.reverse();
    chain.into_iter().fold(Style::initial(), |style, node| resolver.cascade.computed(node, &style, &units))
}

/// From the coordinates of what is around an object to the root's.
pub(crate) fn parent_transform(resolver: &Resolver, node: roxmltree::Node) -> kurbo::Affine {
    node.parent_element().map_or(kurbo::Affine::IDENTITY, |parent| to_root(resolver, parent))
}

/// From an object's own coordinates, its transform included, to the root's.
fn to_root(resolver: &Resolver, node: roxmltree::Node) -> kurbo::Affine {
    let mut chain: Vec<_> = node.ancestors().filter(|node| node.parent_element().is_some()).collect();
    chain.reverse();
    let mut units = crate::units::Units { viewport: resolver.view.size(), em: 16.0 };
    let mut full = kurbo::Affine::IDENTITY;
    for node in chain {
        full *= resolver::own_transform(node, &units).unwrap_or_default();
        if let Some((fit, viewport)) = resolver::is_svg(&node, "svg")
            .then(|| resolver::nested_viewport(node, &units, (None, None)))
            .flatten()
        {
            full *= fit;
            units.viewport = viewport;
        }
    }
    full
}
