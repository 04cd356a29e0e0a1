//! The one table of role, class and attribute names.

/// The namespace of every attribute and element of the format.
pub const NAMESPACE: &str = "urn:rinceau:1";
/// The attribute in it for the style that an object has without its mark.
pub(crate) const OWN_STYLE: &str = "own-style";
/// The SVG namespace.
pub(crate) const SVG: &str = "http://www.w3.org/2000/svg";
/// Inkscape's namespace: labels and layers.
pub(crate) const INKSCAPE: &str = "http://www.inkscape.org/namespaces/inkscape";
/// Sodipodi's namespace, which Inkscape still uses for locks.
pub(crate) const SODIPODI: &str = "http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd";
/// The namespace of `xlink:href`.
pub(crate) const XLINK: &str = "http://www.w3.org/1999/xlink";

/// What an object of the drawing means to a generator.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Role {
    /// A region to fill.
    Container,
    /// A direction of flow.
    Guide,
    /// Kept clear, and copied into the result.
    Fixed,
    /// An open path that an element must lie along.
    FixedSpine,
    /// A base stem.
    Stem,
    /// Where growth starts.
    Seed,
    /// A template.
    Element,
    /// Origin, direction and length of a template.
    Spine,
    /// A display list of primitives and clones.
    Form,
    /// A replication inside a form.
    Clone,
    /// A fixed point of a tack transformation.
    Tack,
    /// An example arrangement.
    Reference,
    /// Stops growth.
    Boundary,
    /// Paints a growth area.
    Spray,
    /// A rule set.
    Rules,
}

impl Role {
    /// Every role, in the order of SPEC.md.
    pub const ALL: [Role; 15] = [
        Role::Container,
        Role::Guide,
        Role::Fixed,
        Role::FixedSpine,
        Role::Stem,
        Role::Seed,
        Role::Element,
        Role::Spine,
        Role::Form,
        Role::Clone,
        Role::Tack,
        Role::Reference,
        Role::Boundary,
        Role::Spray,
        Role::Rules,
    ];

    /// The value of `rinceau:role`.
    pub fn name(self) -> &'static str {
        match self {
            Role::Container => "container",
            Role::Guide => "guide",
            Role::Fixed => "fixed",
            Role::FixedSpine => "fixed-spine",
            Role::Stem => "stem",
            Role::Seed => "seed",
            Role::Element => "element",
            Role::Spine => "spine",
            Role::Form => "form",
            Role::Clone => "clone",
            Role::Tack => "tack",
            Role::Reference => "reference",
            Role::Boundary => "boundary",
            Role::Spray => "spray",
            Role::Rules => "rules",
        }
    }

    /// The class token that means the same, `rinceau-` and the name.
    pub fn class(self) -> String {
        format!("rinceau-{}", self.name())
    }

    /// The role with this `rinceau:role` value.
    pub fn from_name(name: &str) -> Option<Role> {
        Role::ALL.into_iter().find(|role| role.name() == name)
    }

    /// The role with this class token.
    pub fn from_class(token: &str) -> Option<Role> {
        token.strip_prefix("rinceau-").and_then(Role::from_name)
    }
}
