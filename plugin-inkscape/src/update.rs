//! `rinceau update`: every ornament of a drawing made again from its recipe, after the shapes that
//! it fills were changed. This is what makes clip art adaptive (checklist W-002).

use crate::progress::Staged;
use crate::run::{self, Job};
use rinceau::{Error, GENERATORS, Values};
use rinceau_format::{Document, Recipe};
use std::time::Duration;

/// A drawing made again, and what could not be.
pub struct Updated {
    pub document: Document,
    /// A sentence for each layer that was left as it is.
    pub notes: Vec<String>,
}

/// Makes every result layer again, in drawing order, each within the time limit.
///
/// Errors: there is no layer, or none that could be made again.
pub fn update(
    mut document: Document,
    time_limit: Option<Duration>,
    progress: &mut dyn Staged,
) -> Result<Updated, Error> {
    let layers = document.layers()?;
    if layers.is_empty() {
        return Err(Error::new(
            "nothing-to-update",
            "The drawing has no ornament that could be made again",
            "Run one of the generators first",
        ));
    }
    let (mut notes, mut first) = (Vec::new(), None);
    let count = layers.len();
    for layer in layers {
        let recipe = layer.recipe;
        match again(&document, &recipe, time_limit, progress) {
            Ok(updated) => document = updated,
            Err(error) => {
                notes.push(format!("the layer '{}' stays as it is: {error}", recipe.label));
                first = first.or(Some(error));
            }
        }
    }
    match first {
        Some(error) if notes.len() == count => Err(error),
        _ => Ok(Updated { document, notes }),
    }
}

/// One layer made again.
fn again(
    document: &Document,
    recipe: &Recipe,
    time_limit: Option<Duration>,
    progress: &mut dyn Staged,
) -> Result<Document, Error> {
    let generator =
        GENERATORS.iter().find(|generator| generator.name == recipe.generator).ok_or_else(|| {
            Error::new(
                "unknown-generator",
                format!("This version has no generator '{}'", recipe.generator),
                "Update the layer with the version that made it, or delete it",
            )
        })?;
    let done = run::generate(Job {
        generator,
        values: Values::from_recipe(generator.table, &recipe.params)?,
        seed: recipe.seed,
        ids: recipe.sources.iter().chain(&recipe.with).cloned().collect(),
        time_limit,
        bytes: document.to_bytes(),
        progress,
    })?;
    done.document.with_layer(&done.artwork, &done.recipe)
}
