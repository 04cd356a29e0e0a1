//! Moving objects where they stand.

use super::Document;
use super::edit::{splice, start_tag_end};
use crate::error::Error;
use crate::read::{Resolver, inherited_style, own_transform, parent_transform, shift_of_use, unknown_id};
use crate::units::Units;
use crate::vocabulary::NAMESPACE;
use crate::write::{attribute, matrix};
use crate::xml::PlainAttribute;
use kurbo::Affine;
use roxmltree::{Node, NodeId};
use std::collections::HashMap;
use std::ops::Range;

/// Clones of clones deeper than this are no drawing.
const DEEPEST: usize = 100;

impl Document {
    /// Transforms objects by a map of user units of the root. Nothing but their `transform`
    /// attributes changes.
    ///
    /// Errors: an id that no object or two objects have, or that comes out of an entity; an object
    /// that cannot be moved by itself, has a transform that cannot be read, is moved by its style, or lies in a group that is scaled to nothing.
    pub fn with_transform(&self, ids: &[String], by: Affine) -> Result<Document, Error> {
        self.with_moved(ids, |_, _| Ok(by))
    }

    /// Lays clones exactly over what they are clones of.
    ///
    /// Errors: as [`Document::with_transform`]; an object that is no clone.
    pub fn with_clones_on_source(&self, ids: &[String]) -> Result<Document, Error> {
        self.with_moved(ids, |resolver, node| {
            let source = match node.tag_name().name() {
                "use" => resolver.href(node)?,
                _ => None,
            };
            let units = units(resolver);
            let own = own_transform(node, &units).unwrap_or_default();
            let drawn = parent_transform(resolver, node) * own;
            // A copy that says what it is a copy of lies over it in its own coordinates.
            let named = node.attribute((NAMESPACE, "of")).map(str::trim).filter(|name| !name.is_empty());
            if let (None, Some(named)) = (source, named)
                && let Some(named) = resolver.by_reference(named)?
            {
                let own = own_transform(named, &units).unwrap_or_default();
                return Ok(parent_transform(resolver, named) * own * drawn.inverse());
            }
            let source = source.ok_or_else(|| {
                Error::new(
                    "no-clone",
                    format!("'{}' is no clone of anything in this drawing", resolver.reference(node)),
                    "Select a clone (Edit > Clone > Create Clone)",
                )
                .at(self.position(node))
            })?;
            Ok(parent_transform(resolver, source) * (drawn * shift_of_use(node, &units)).inverse())
        })
    }

    fn with_moved(
        &self,
        ids: &[String],
        by: impl Fn(&Resolver, Node) -> Result<Affine, Error>,
    ) -> Result<Document, Error> {
        let text = self.parse(|xml| {
            let resolver = Resolver::new(xml, &self.limits)?;
            let mut nodes: Vec<Node> = Vec::new();
            for id in ids {
                let node = resolver.by_reference(id)?.ok_or_else(|| unknown_id(id))?;
                // A group takes what is in it along.
                let is_taken = |other: &Node| node.ancestors().any(|ancestor| ancestor == *other);
                if !nodes.iter().any(is_taken) {
                    nodes.retain(|other| !other.ancestors().any(|ancestor| ancestor == node));
                    nodes.push(node);
                }
            }
            let mut moved = HashMap::new();
            for &node in &nodes {
                self.check_movable(&resolver, node)?;
                moved.insert(node.id(), by(&resolver, node)?);
            }
            let moves = Moves { resolver: &resolver, moved };
            let mut edits = Vec::new();
            for node in nodes {
                edits.push(self.moved(&resolver, node, moves.state(node, 0)?.own.1)?);
            }
            Ok(splice(&self.text, edits))
        })?;
        Document::with_limits(crate::encoding::encode(&text, self.encoding), self.limits.clone())
    }

    /// Errors if an object has no transform that could be written.
    fn check_movable<'a, 'i>(&self, resolver: &Resolver<'a, 'i>, node: Node<'a, 'i>) -> Result<(), Error> {
        self.check_verbatim(node)?;
        let refused = |code, sentence: &str, remedy| {
            Err(Error::new(code, format!("'{}' {sentence}", resolver.reference(node)), remedy)
                .at(self.position(node)))
        };
        let name = node.tag_name().name();
        if !matches!(name, "g" | "use" | "a" | "switch" | "text") && !crate::shape::is_shape(node) {
            return refused(
                "not-movable",
                "is nothing that can be moved by itself",
                "Select the shape, text or group that it belongs to",
            );
        }
        let inherited = inherited_style(resolver, node);
        if resolver.cascade.computed(node, &inherited, &units(resolver)).get("transform").is_some() {
            return refused(
                "styled-transform",
                "is moved by its style",
                "Group it (Object > Group), and select the group",
            );
        }
        match own_transform(node, &units(resolver)) {
            Ok(_) => Ok(()),
            Err(_) => refused(
                "broken-object",
                "has a transform that cannot be read",
                "Remove it (Object > Transform, or the XML editor), and place the object again",
            ),
        }
    }

    /// The edit that gives an object a transform.
    fn moved(&self, resolver: &Resolver, node: Node, own: Affine) -> Result<(Range<usize>, String), Error> {
        // The attribute is applied about an origin, which stays as it is written.
        let origin = crate::read::transform_origin(node, &units(resolver)).to_vec2();
        let written = Affine::translate(-origin) * own * Affine::translate(origin);
        // So small that its decimals would be cut off.
        const SMALLEST: f64 = 1e-6;
        let size = written.as_coeffs()[..4].iter().fold(0.0_f64, |most, c| most.max(c.abs()));
        if !written.is_finite() || size < SMALLEST {
            return Err(Error::new(
                "flat-layer",
                format!(
                    "'{}' cannot be moved: a group around it is scaled to nothing",
                    resolver.reference(node)
                ),
                "Move it out of the group",
            )
            .at(self.position(node)));
        }
        let value = matrix(written, 9);
        Ok(match node.plain_node("transform") {
            Some(old) => (old.range_value(), value),
            None => {
                let range = node.range();
                let (tag_end, _) = start_tag_end(&self.text[range.clone()]);
                let mut fresh = String::new();
                attribute(&mut fresh, "transform", &value);
                (range.start + tag_end..range.start + tag_end, fresh)
            }
        })
    }
}

/// Objects that are moved together, and by what, in user units of the root.
struct Moves<'r, 'a, 'i> {
    resolver: &'r Resolver<'a, 'i>,
    moved: HashMap<NodeId, Affine>,
}

/// An object's transform and what it draws, from the coordinates of the shape at the end of a chain
/// of clones, as they were and as they will be.
struct State {
    own: (Affine, Affine),
    content: (Affine, Affine),
}

impl<'a, 'i> Moves<'_, 'a, 'i> {
    /// What a clone repeats may move too, and the clone with it: that is undone before the clone is
    /// moved itself.
    ///
    /// Errors: a clone that contains itself.
    fn state(&self, node: Node<'a, 'i>, depth: usize) -> Result<State, Error> {
        let units = units(self.resolver);
        let own = own_transform(node, &units).unwrap_or_default();
        let is_use = node.tag_name().name() == "use";
        let target = if is_use { self.resolver.href(node)? } else { None };
        let Some(target) = target else {
            let moved = self.moved(node, own);
            return Ok(State { own: (own, moved), content: (Affine::IDENTITY, Affine::IDENTITY) });
        };
        if depth > DEEPEST || node.ancestors().any(|ancestor| ancestor == target) {
            return Err(Error::new(
                "clone-cycle",
                format!("The clone '{}' contains itself", self.resolver.reference(node)),
                "Delete the clone, or unlink it (Edit > Clone > Unlink Clone)",
            )
            .at(self.resolver.position(node)));
        }
        let State { own: (old, new), content: (before, after) } = self.state(target, depth + 1)?;
        let shift = shift_of_use(node, &units);
        let (before, after) = (shift * old * before, shift * new * after);
        let mut moved = self.moved(node, own);
        if moved != own && before != after {
            moved = moved * before * after.inverse();
        }
        Ok(State { own: (own, moved), content: (before, after) })
    }

    /// The new transform of an object whose content stays.
    fn moved(&self, node: Node, own: Affine) -> Affine {
        let parent = parent_transform(self.resolver, node);
        self.moved.get(&node.id()).map_or(own, |&by| parent.inverse() * by * parent * own)
    }
}

fn units(resolver: &Resolver) -> Units {
    Units { viewport: resolver.view.size(), em: 16.0 }
}
