//! What marks look like on the canvas, after the diagrams of the FLOWPAK paper (F-011).

use crate::vocabulary::Role;

/// Id of the arrow head that shows which way a guide runs.
pub(crate) const ARROW: &str = "rinceau-arrow";

/// The properties that a mark sets.
pub(crate) fn appearance(role: Role) -> &'static [(&'static str, &'static str)] {
    match role {
        Role::Container => &[("fill", "none"), ("stroke", "#000000")],
        Role::Guide | Role::Spine => &[("fill", "none"), ("stroke", "#ff0000")],
        Role::Stem | Role::Boundary => &[("fill", "none"), ("stroke", "#0000ff")],
        Role::FixedSpine => &[("fill", "none"), ("stroke", "#00aa00")],
        Role::Seed | Role::Tack => &[("fill", "#ff7f00")],
        Role::Spray => &[("fill", "none"), ("stroke-opacity", "0.3")],
        // What is fixed is part of the picture: it is green in diagrams alone (F-011), or eyes would come out
        // green.
        Role::Fixed | Role::Element | Role::Form | Role::Clone | Role::Reference | Role::Rules => &[],
    }
}

/// The same as a `style` attribute, with a guide's arrow head.
pub(crate) fn style(role: Role) -> String {
    let pairs = appearance(role).iter().map(|(name, value)| format!("{name}:{value}"));
    let arrow = (role == Role::Guide).then(|| format!("marker-end:url(#{ARROW})"));
    pairs.chain(arrow).collect::<Vec<_>>().join(";")
}

/// The definition of the arrow head; `p` is the prefix of SVG's namespace.
pub(crate) fn arrow(p: &str) -> String {
    format!(
        "<{p}defs><{p}marker id=\"{ARROW}\" orient=\"auto\" markerWidth=\"6\" markerHeight=\"6\" refX=\"4\" refY=\"3\"><{p}path d=\"M0,0L6,3L0,6Z\" style=\"fill:#ff0000\"/></{p}marker></{p}defs>"
    )
}
