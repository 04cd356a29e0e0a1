//! The generators by name, and the one place that chooses between them.

use crate::pack;
use crate::params::{ParamSpec, Values};
use crate::progress::Progress;
use crate::rng::Rng;
use crate::vine;
use rinceau_format::{Artwork, Error, Scene};

/// A generator: its name, what a menu calls it, and its parameters.
#[derive(Clone, Copy, Debug)]
pub struct Generator {
    /// Name on the command line and in recipes.
    pub name: &'static str,
    /// Name in Inkscape's menu.
    pub title: &'static str,
    /// What it does, in one sentence.
    pub about: &'static str,
    /// Its parameters.
    pub table: &'static [ParamSpec],
    run: Run,
}

type Run = fn(&Values, &Scene, &mut Rng, &mut dyn Progress) -> Result<Artwork, Error>;

/// Every generator, in menu order.
pub const GENERATORS: &[Generator] = &[
    Generator {
        name: "pack",
        title: "Pack along flow",
        about: "Fill shapes with leaves, drops or your own elements that bend along a flow",
        table: pack::Params::TABLE,
        run: |values, scene, rng, progress| {
            pack::generate(&pack::Params::from_values(values), scene, rng, progress)
        },
    },
    Generator {
        name: "vine",
        title: "Grow vines",
        about: "Fill shapes with scrolling vines: stems that curl and branch, with leaves and flowers",
        table: vine::Params::TABLE,
        run: |values, scene, rng, progress| {
            vine::generate(&vine::Params::from_values(values), scene, rng, progress)
        },
    },
];

/// Runs a generator.
///
/// Errors: what the scene lacks for this generator, with a position and a remedy.
pub fn generate(
    generator: &Generator,
    values: &Values,
    scene: &Scene,
    seed: u64,
    progress: &mut dyn Progress,
) -> Result<Artwork, Error> {
    (generator.run)(values, scene, &mut Rng::new(seed), progress)
}
