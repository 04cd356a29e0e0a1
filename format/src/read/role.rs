//! Which role an object has: the attribute wins, the class stands in for it.

use super::resolver::Resolver;
use crate::error::Error;
use crate::vocabulary::{NAMESPACE, Role};
use crate::xml::PlainAttribute;
use roxmltree::Node;

/// The role of a node, and a warning where attribute and class contradict.
///
/// Errors on an unknown `rinceau:role`: it would otherwise be silently ignored.
pub(crate) fn role_of(resolver: &Resolver, node: Node) -> Result<Option<(Role, Option<String>)>, Error> {
    let class = node
        .plain("class")
        .filter(|class| class.contains("rinceau-"))
        .and_then(|class| class.split_whitespace().find_map(Role::from_class));
    let Some(name) = node.attribute((NAMESPACE, "role")) else {
        return Ok(class.map(|role| (role, None)));
    };
    let Some(role) = Role::from_name(name.trim()) else {
        let known: Vec<&str> = Role::ALL.iter().map(|role| role.name()).collect();
        return Err(Error::new(
            "unknown-role",
            format!("'{name}' is not a role"),
            format!("Use one of {}", known.join(", ")),
        )
        .at(resolver.position(node)));
    };
    let warning = class.filter(|&class| class != role).map(|class| {
        let at = |name: &dyn Fn(&roxmltree::Attribute) -> bool| {
            let start = node.attributes().find(|a| name(a)).map_or(node.range().start, |a| a.range().start);
            resolver.position_at(start)
        };
        let role_at = at(&|a| a.namespace() == Some(NAMESPACE) && a.name() == "role");
        let class_at = at(&|a| a.namespace().is_none() && a.name() == "class");
        format!(
            "{role_at}: rinceau:role says '{}' but the class at {class_at} says '{}'; the attribute is used",
            role.name(),
            class.name()
        )
    });
    Ok(Some((role, warning)))
}
