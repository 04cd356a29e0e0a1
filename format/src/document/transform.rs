//! Moving objects where they stand.

use super::Document;
use super::edit::{splice, start_tag_end};
use crate::error::Error;
use crate::read::{Resolver, own_transform, parent_transform, unknown_id};
use crate::units::Units;
use crate::write::{attribute, matrix};
use crate::xml::PlainAttribute;
use kurbo::Affine;
use roxmltree::Node;
use std::ops::Range;

impl Document {
    /// Transforms objects by a map of user units of the root. Nothing but their `transform`
    /// attributes changes.
    ///
    /// Errors: an id that no object or two objects have, or that comes out of an entity; an object
    /// that is moved by its style, or lies in a group that is scaled to nothing.
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
            let source = source.ok_or_else(|| {
                Error::new(
                    "no-clone",
                    format!("'{}' is no clone of anything in this drawing", resolver.reference(node)),
                    "Select a clone (Edit > Clone > Create Clone)",
                )
                .at(self.position(node))
            })?;
            let units = units(resolver);
            let shift = crate::read::shift_of_use(node, &units);
            let drawn =
                parent_transform(resolver, node) * own_transform(node, &units).unwrap_or_default() * shift;
            Ok(parent_transform(resolver, source) * drawn.inverse())
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
            let mut edits = Vec::new();
            for node in nodes {
                edits.push(self.moved(&resolver, node, by(&resolver, node)?)?);
            }
            Ok(splice(&self.text, edits))
        })?;
        Document::with_limits(crate::encoding::encode(&text, self.encoding), self.limits.clone())
    }

    /// The edit of one object's transform.
    fn moved(&self, resolver: &Resolver, node: Node, by: Affine) -> Result<(Range<usize>, String), Error> {
        self.check_verbatim(node)?;
        let refused = |code, sentence: &str, remedy| {
            Err(Error::new(code, format!("'{}' {sentence}", resolver.reference(node)), remedy)
                .at(self.position(node)))
        };
        let styled = node.plain("style").unwrap_or("");
        if crate::css::declarations(styled).any(|d| d.name == "transform") {
            return refused(
                "styled-transform",
                "is moved by its style",
                "Group it (Object > Group), and select the group",
            );
        }
        let units = units(resolver);
        let own = own_transform(node, &units).unwrap_or_default();
        let parent = parent_transform(resolver, node);
        let moved = parent.inverse() * by * parent * own;
        // The attribute is applied about an origin, which stays as it is written.
        let origin = crate::read::transform_origin(node, &units).to_vec2();
        let written = Affine::translate(-origin) * moved * Affine::translate(origin);
        // So small that its decimals would be cut off.
        const SMALLEST: f64 = 1e-6;
        let size = written.as_coeffs()[..4].iter().fold(0.0_f64, |most, c| most.max(c.abs()));
        if !written.is_finite() || size < SMALLEST {
            return refused(
                "flat-layer",
                "cannot be moved: a group around it is scaled to nothing",
                "Move it out of the group",
            );
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

fn units(resolver: &Resolver) -> Units {
    Units { viewport: resolver.view.size(), em: 16.0 }
}
