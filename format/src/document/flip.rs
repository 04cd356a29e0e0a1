//! Flipping edges of an example's connectivity, where it is drawn (checklist E-009).

use super::Document;
use super::edit::{splice, start_tag_end};
use crate::error::Error;
use crate::read::{Resolver, unknown_id};
use crate::vocabulary::NAMESPACE;
use crate::write::{attribute, escaped};
use roxmltree::Node;
use std::collections::BTreeMap;

impl Document {
    /// The drawing with edges flipped in their examples, and those of the ids that are no edges. An edge
    /// is an object of a result layer that is of two children of one group.
    ///
    /// Errors: an id that no object or two objects have.
    pub fn with_flipped(&self, ids: &[String]) -> Result<(Document, Vec<String>), Error> {
        let mut others = Vec::new();
        let text = self.parse(|xml| {
            let resolver = Resolver::new(xml, &self.limits)?;
            let mut flips: BTreeMap<usize, (Node, Vec<&str>)> = BTreeMap::new();
            for id in ids {
                let node = resolver.by_reference(id)?.ok_or_else(|| unknown_id(id))?;
                let ends = node.attribute((NAMESPACE, "of")).unwrap_or("");
                let ends: Vec<&str> = ends.split_whitespace().collect();
                let is_result = node.ancestors().any(|node| node.has_attribute((NAMESPACE, "result")));
                match ends[..] {
                    [a, b] if is_result => {
                        let group = |id: &str| -> Result<Option<Node>, Error> {
                            Ok(resolver.by_reference(id)?.and_then(|node| node.parent_element()))
                        };
                        if let (Some(group), Some(other)) = (group(a)?, group(b)?)
                            && group == other
                        {
                            flips.entry(group.range().start).or_insert((group, Vec::new())).1.extend([a, b]);
                        }
                    }
                    _ => others.push(id.clone()),
                }
            }
            if flips.is_empty() {
                return Ok(self.text.to_string());
            }
            let mut edits = Vec::new();
            self.check_verbatim(xml.root_element())?;
            let prefix = self.declare(xml, &mut edits);
            for (group, pairs) in flips.into_values() {
                self.check_verbatim(group)?;
                let own = group.attributes().find(|a| a.namespace() == Some(NAMESPACE) && a.name() == "flip");
                match own {
                    Some(own) => {
                        let all = format!("{} {}", own.value().trim(), pairs.join(" "));
                        edits.push((own.range_value(), escaped(&all).replace('\'', "&#39;")));
                    }
                    None => {
                        let mut fresh = String::new();
                        attribute(&mut fresh, &format!("{prefix}:flip"), &pairs.join(" "));
                        let start = group.range().start;
                        let end = start + start_tag_end(&self.text[group.range()]).0;
                        edits.push((end..end, fresh));
                    }
                }
            }
            Ok(splice(&self.text, edits))
        })?;
        let flipped =
            Document::with_limits(crate::encoding::encode(&text, self.encoding), self.limits.clone())?;
        Ok((flipped, others))
    }
}
