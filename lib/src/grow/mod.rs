//! Growth by rules: adaptive clip art.
//!
//! Michael T. Wong, Douglas E. Zongker, David H. Salesin: *Computer-Generated Floral Ornament*,
//! SIGGRAPH 1998.
//!
//! 1. Read a rule file (000 4.2, Appendix A): `rules`.
//! 2. Measure each container, and start from seeds (4.1; W-073, W-103): `start`, `space`, `symmetry`,
//!    `section`.
//! 3. Again and again find the largest empty circle that touches the ornament, and let the elements
//!    near it try their rules (4.1; W-090 to W-104): `growth`, `world`.
//! 4. Draw the elements, apart from all that (3.2; W-064, W-084 to W-086): `design`, `draw`.
//!
//! Departures, with their reasons where they happen: exact distances instead of a buffer and inflated
//! circles (`space`); children that would leave the shape or lie over others fail, whatever their
//! rule says (`world`); looks are declared, not programmed (`draw`), since an artist can choose
//! one. Taxonomies (W-004, W-005) and manifolds (W-132) are not of this plane.

mod design;
mod draw;
mod growth;
mod index;
mod params;
mod piece;
mod room;
mod rules;
mod section;
mod space;
mod start;
mod symmetry;
mod world;

pub use design::Design;
pub use params::{PATTERNS, Params};
pub use rules::RuleText;
pub use space::Circle;

use crate::progress::Progress;
use crate::rng::Rng;
use rinceau_format::{Artwork, Error, Scene};

/// The built-in rule files by name.
const BUILT_IN: &[(&str, &str)] = &[
    ("dots", include_str!("../../../samples/rules/dots.rules")),
    ("flower", include_str!("../../../samples/rules/flower.rules")),
    ("spiral", include_str!("../../../samples/rules/spiral.rules")),
    ("vines", include_str!("../../../samples/rules/vines.rules")),
    ("vase", include_str!("../../../samples/rules/vase.rules")),
    ("willow", include_str!("../../../samples/rules/willow.rules")),
    ("willow-planned", include_str!("../../../samples/rules/willow-planned.rules")),
];

/// Grows ornament in every container of a scene, and draws it.
///
/// Errors: nothing to fill; rules that cannot be read or that fail; nothing that grows.
pub fn generate(
    params: &Params,
    scene: &Scene,
    rng: &mut Rng,
    progress: &mut dyn Progress,
) -> Result<Artwork, Error> {
    let design = Design::grow(params, scene, rng, progress)?;
    progress.step("draw", 0.0);
    design.draw(params, scene)
}

/// Reads growth rules without growing anything.
///
/// Errors: they cannot be read, with line and column of their text.
pub fn check_rules(text: RuleText) -> Result<(), Error> {
    rules::Rules::read(text).map(drop)
}

/// Finds a rule file: one that the scene carries, or one that is built in.
///
/// Errors: there is none of this name.
pub fn rule_text(name: &str, scene: &Scene) -> Result<RuleText, Error> {
    let built_in = |name: &str| {
        let found = BUILT_IN.iter().find(|(known, _)| *known == name);
        found.map(|&(name, text)| RuleText { name: name.into(), text: text.into() })
    };
    let own = scene.rules.iter().find(|rules| rules.name == name);
    let own = own.or(scene.rules.first().filter(|_| name == "auto"));
    if let Some(rules) = own {
        return Ok(RuleText { name: rules.name.clone(), text: rules.text.clone() });
    }
    built_in(if name == "auto" { "spiral" } else { name }).ok_or_else(|| {
        let known: Vec<&str> = PATTERNS.iter().map(|(name, _)| *name).collect();
        Error::new(
            "unknown-rules",
            format!("There are no growth rules called '{name}'"),
            format!("Use one of {}, or a file whose name ends in .rules", known.join(", ")),
        )
    })
}
