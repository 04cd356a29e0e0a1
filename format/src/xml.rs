//! What roxmltree leaves to be asked carefully.

use roxmltree::{Attribute, Node};

/// Attributes without a namespace. roxmltree's own lookup by a plain name also finds
/// `sodipodi:rx` or `xml:id` where one stands first.
pub(crate) trait PlainAttribute<'a, 'i: 'a> {
    /// The attribute of this name that has no namespace.
    fn plain_node(&self, name: &str) -> Option<Attribute<'a, 'i>>;

    /// Its value.
    fn plain(&self, name: &str) -> Option<&'a str> {
        self.plain_node(name).map(|attribute| attribute.value())
    }
}

impl<'a, 'i> PlainAttribute<'a, 'i> for Node<'a, 'i> {
    fn plain_node(&self, name: &str) -> Option<Attribute<'a, 'i>> {
        self.attributes().find(|attribute| attribute.namespace().is_none() && attribute.name() == name)
    }
}

/// True if the element, with all its tags, stands in the drawing's body as it was parsed. A
/// tag out of an entity has the place of the entity's declaration, before the root element;
/// splicing there would change every other use of the entity, or tear the drawing apart.
pub(crate) fn is_verbatim(node: Node) -> bool {
    let body = node.document().root_element().range().start;
    let range = node.range();
    let start = range.start;
    let inside = |attribute: Attribute| attribute.range().start >= start;
    start >= body
        && range.end > start
        && node.document().input_text()[range].starts_with('<')
        && node.attributes().all(inside)
}
