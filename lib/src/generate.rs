//! The generators by name, and the one place that chooses between them.

use crate::arrange;
use crate::grow;
use crate::pack;
use crate::params::{ParamSpec, Values};
use crate::progress::Progress;
use crate::recurse;
use crate::rng::Rng;
use crate::vine;
use rinceau_format::{Artwork, Error, Scene, Source};

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
    sources: fn(&Scene) -> Vec<&Source>,
    run: Run,
}

impl Generator {
    /// What a result is made from: its layer stands for these.
    pub fn sources<'a>(&self, scene: &'a Scene) -> Vec<&'a Source> {
        (self.sources)(scene)
    }
}

type Run = fn(&Values, &Scene, &mut Rng, &mut dyn Progress) -> Result<Artwork, Error>;

/// Every generator, in menu order.
pub const GENERATORS: &[Generator] = &[
    Generator {
        name: "pack",
        title: "Pack along flow",
        about: "Fill shapes with leaves, drops or your own elements that bend along a flow",
        table: pack::Params::TABLE,
        sources: containers,
        run: |values, scene, rng, progress| {
            pack::generate(&pack::Params::from_values(values), scene, rng, progress)
        },
    },
    Generator {
        name: "grow",
        title: "Grow by rules",
        about: "Grow ornament into shapes by rules: spirals, vines with blossoms, willow leaves, dots",
        table: grow::Params::TABLE,
        sources: containers,
        run: |values, scene, rng, progress| {
            grow::generate(&grow::Params::from_values(values), scene, rng, progress)
        },
    },
    Generator {
        name: "vine",
        title: "Grow vines",
        about: "Fill shapes with scrolling vines: stems that curl and branch, with leaves and flowers",
        table: vine::Params::TABLE,
        sources: containers,
        run: |values, scene, rng, progress| {
            vine::generate(&vine::Params::from_values(values), scene, rng, progress)
        },
    },
    Generator {
        name: "recurse",
        title: "Repeat a form",
        about: "Repeat a motif in clones of itself: trees, spirals, tilings, space-filling curves",
        table: recurse::Params::TABLE,
        sources: recurse::sources,
        run: |values, scene, rng, progress| {
            recurse::generate(&recurse::Params::from_values(values), scene, rng, progress)
        },
    },
    Generator {
        name: "arrange",
        title: "Continue an example",
        about: "Fill shapes with elements arranged as in an example: tiles, scales, stones, dots",
        table: arrange::Params::TABLE,
        sources: arrange::sources,
        run: |values, scene, rng, progress| {
            arrange::generate(&arrange::Params::from_values(values), scene, rng, progress)
        },
    },
    Generator {
        name: "connect",
        title: "Show connectivity",
        about: "Draw which elements of an example are neighbours; select edges there and run it again to flip them",
        table: arrange::connect::Params::TABLE,
        sources: arrange::connect::sources,
        run: |values, scene, _, progress| {
            arrange::connect::generate(&arrange::connect::Params::from_values(values), scene, progress)
        },
    },
];

fn containers(scene: &Scene) -> Vec<&Source> {
    scene.containers.iter().map(|container| &container.source).collect()
}

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
