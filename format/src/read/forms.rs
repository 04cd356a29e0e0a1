//! Display lists: which form each clone repeats, and from where to where.

use super::resolver::{Resolver, own_transform};
use super::{parent_transform, to_root};
use crate::error::Error;
use crate::scene::{Form, FormItem, Primitive, Replication, Source};
use crate::units::{Axis, Units};
use crate::vocabulary::NAMESPACE;
use crate::xml::PlainAttribute;
use kurbo::Affine;
use roxmltree::{Node, NodeId};
use std::collections::{BTreeMap, HashMap};

/// A clone as the walk found it.
#[derive(Clone)]
pub(super) struct RawClone {
    pub node: NodeId,
    pub source: Source,
    /// From its own coordinates, transform included, to the root's.
    pub pose: Affine,
}

/// A form as the walk found it.
pub(super) struct RawForm {
    pub node: NodeId,
    pub source: Source,
    pub selected: bool,
    /// False for a selected group that may be meant as a form.
    pub marked: bool,
    pub items: Vec<RawItem>,
    pub overrides: BTreeMap<String, String>,
}

pub(super) enum RawItem {
    Primitive(Primitive),
    Clone(RawClone),
}

/// Clones of clones deeper than this are no drawing.
const DEEPEST: usize = 100;

/// Settles every clone.
///
/// Errors: a clone of nothing, of itself, of a shape in no form, or one that is scaled to
/// nothing. In a group without a mark those are warnings, and the clone is left out.
pub(super) fn resolve(
    resolver: &Resolver,
    raw: Vec<RawForm>,
    warnings: &mut Vec<String>,
) -> Result<Vec<Form>, Error> {
    let by_node: HashMap<NodeId, usize> = raw.iter().enumerate().map(|(i, form)| (form.node, i)).collect();
    let frames: Vec<Affine> = raw
        .iter()
        .map(|form| resolver.xml.get_node(form.node).map_or(Affine::IDENTITY, |node| to_root(resolver, node)))
        .collect();
    let forms = Forms { resolver, by_node, frames };
    let is_any_selected = raw.iter().any(|form| form.selected);
    let mut resolved = Vec::with_capacity(raw.len());
    for (index, form) in raw.into_iter().enumerate() {
        let mut items = Vec::with_capacity(form.items.len());
        // Cloned shape by shape, a motif of several is still cloned once.
        let mut same: Vec<(usize, Affine, Option<NodeId>)> = Vec::new();
        for item in form.items {
            match item {
                RawItem::Primitive(primitive) => items.push(FormItem::Primitive(primitive)),
                RawItem::Clone(clone) => {
                    let (replication, target) = match forms.replication(index, clone) {
                        Err(error) if !form.marked => {
                            warnings.push(error.to_string());
                            continue;
                        }
                        replication => replication?,
                    };
                    let again = same.iter().any(|&(form, transform, other)| {
                        form == replication.form
                            && other != target
                            && is_near(transform, replication.transform)
                    });
                    if !again {
                        same.push((replication.form, replication.transform, target));
                        items.push(FormItem::Clone(replication));
                    }
                }
            }
        }
        resolved.push(Form { source: form.source, is_root: form.selected, items, overrides: form.overrides });
    }
    if !is_any_selected {
        set_roots(&mut resolved);
    }
    Ok(resolved)
}

/// Which forms are to be drawn for their own sake: those that no other has a clone of.
pub(crate) fn set_roots(forms: &mut [Form]) {
    let mut is_referred_to = vec![false; forms.len()];
    for (index, form) in forms.iter().enumerate() {
        for item in &form.items {
            if let FormItem::Clone(clone) = item {
                is_referred_to[clone.form] |= clone.form != index;
            }
        }
    }
    for (form, referred) in forms.iter_mut().zip(&is_referred_to) {
        form.is_root = !referred;
    }
    // In a ring of forms the first one drawn is meant.
    if let Some(first) = forms.first_mut().filter(|_| is_referred_to.iter().all(|&referred| referred)) {
        first.is_root = true;
    }
}

struct Forms<'r, 'a, 'i> {
    resolver: &'r Resolver<'a, 'i>,
    by_node: HashMap<NodeId, usize>,
    /// From each form's own coordinates to the root's.
    frames: Vec<Affine>,
}

impl<'a, 'i> Forms<'_, 'a, 'i> {
    /// A clone's form and transform, and what it was cloned from.
    fn replication(&self, own: usize, clone: RawClone) -> Result<(Replication, Option<NodeId>), Error> {
        let RawClone { node, source, pose } = clone;
        let Some(node) = self.resolver.xml.get_node(node) else { return Err(missing(&source)) };
        let named = match node.attribute((NAMESPACE, "of")).map(str::trim).filter(|name| !name.is_empty()) {
            Some(name) => Some(self.resolver.by_reference(name)?.ok_or_else(|| missing(&source))?),
            None => None,
        };
        let named_form = named.and_then(|node| self.form_of(node));
        let (from, drawn_in, target) = if node.tag_name().name() == "use" {
            let (from, target) = self.source_of_use(node, &source)?;
            (from, self.form_of(target).unwrap_or(own), Some(target.id()))
        } else if let Some(named) = named {
            // A copy: its own transform against that of what it is a copy of.
            (to_root(self.resolver, named), named_form.unwrap_or(own), Some(named.id()))
        } else {
            (self.frames[own], own, None)
        };
        let form = named_form.unwrap_or(drawn_in);
        // What is named but not drawn there is taken in its own coordinates.
        let transform = match form == drawn_in {
            true => pose * inverse(from, &source)?,
            false => {
                pose * inverse(from, &source)? * self.frames[drawn_in] * inverse(self.frames[form], &source)?
            }
        };
        inverse(transform, &source)?;
        Ok((Replication { source, form, transform }, target))
    }

    /// From where a use draws what it refers to in its own place to the root, through clones of
    /// clones; and the object drawn at the end of the chain.
    fn source_of_use(&self, node: Node<'a, 'i>, source: &Source) -> Result<(Affine, Node<'a, 'i>), Error> {
        let mut through = Affine::IDENTITY;
        let mut node = node;
        for _ in 0..DEEPEST {
            let Some(target) = self.resolver.href(node)? else { return Err(missing(source)) };
            if target.tag_name().name() != "use" {
                let from = parent_transform(self.resolver, target);
                return Ok((from * inverse(through, source)?, target));
            }
            // What this draws is itself a copy: back through it to the shape.
            through *= self.pose_of_use(target);
            node = target;
        }
        Err(Error::new(
            "clone-cycle",
            format!("The clone '{}' contains itself", source.id),
            "Delete the clone, or unlink it (Edit > Clone > Unlink Clone)",
        )
        .at(source.at))
    }

    /// The transform of a use, its x and y included.
    fn pose_of_use(&self, node: Node) -> Affine {
        let units = Units { viewport: self.resolver.view.size(), em: 16.0 };
        own_transform(node, &units).unwrap_or_default() * shift_of_use(node, &units)
    }

    fn form_of(&self, node: Node) -> Option<usize> {
        node.ancestors().find_map(|ancestor| self.by_node.get(&ancestor.id()).copied())
    }
}

/// Where x and y of a use move what it draws.
pub(crate) fn shift_of_use(node: Node, units: &Units) -> Affine {
    let side = |name, axis| node.plain(name).and_then(|text| units.resolve(text, axis)).unwrap_or(0.0);
    Affine::translate((side("x", Axis::X), side("y", Axis::Y)))
}

fn missing(source: &Source) -> Error {
    source.error(
        "missing-source",
        format!("The clone '{}' refers to nothing in this drawing", source.id),
        "Clone a shape of the form again (Edit > Clone > Create Clone), or delete the clone",
    )
}

/// The inverse of a transform.
///
/// Errors: it scales to nothing, or is beyond all measure.
fn inverse(transform: Affine, source: &Source) -> Result<Affine, Error> {
    let largest = transform.as_coeffs()[..4].iter().fold(0.0_f64, |most, c| most.max(c.abs()));
    let inverse = transform.inverse();
    if inverse.is_finite()
        && transform.is_finite()
        && transform.determinant().abs() > 1e-12 * largest * largest
    {
        return Ok(inverse);
    }
    Err(source.error(
        "flat-clone",
        format!("The clone '{}' is scaled to nothing, or beyond all measure", source.id),
        "Scale it back, or delete it",
    ))
}

fn is_near(a: Affine, b: Affine) -> bool {
    a.as_coeffs().iter().zip(b.as_coeffs()).all(|(a, b)| (a - b).abs() <= 1e-6 * (1.0 + a.abs()))
}
