//! Everything that is wrong with a drawing, at once.

use super::Document;
use super::layers::{read_recipe, result_nodes};
use crate::error::{Error, Position};
use crate::read::{self, Resolver};
use crate::scene::{Scene, Selection};
use std::collections::HashSet;

/// Something that is wrong with a drawing, or doubtful.
#[derive(Clone, Debug)]
pub struct Problem {
    /// False for a doubt: the drawing is used all the same.
    pub is_error: bool,
    /// What it is, where, and what to do.
    pub error: Error,
    /// The object, by its id or its place among others.
    pub id: Option<String>,
}

/// Errors that are looked for beyond the first, at most: for each the drawing is read again.
const MOST: usize = 100;

impl Document {
    /// The scene without the objects that cannot be read, and what is wrong: those objects, recipes that
    /// cannot be read, and what was read with a doubt.
    ///
    /// Errors: the style sheets are beyond the limits, so that nothing can be read.
    pub fn check(&self) -> Result<(Scene, Vec<Problem>), Error> {
        self.parse(|xml| {
            let resolver = Resolver::new(xml, &self.limits)?;
            let mut errors: Vec<Error> = Vec::new();
            let mut passed: HashSet<Position> = HashSet::new();
            let scene = loop {
                match read::scene_without(xml, &Selection::default(), &self.limits, &passed) {
                    Ok(scene) => break scene,
                    Err(error) => {
                        let is_new = error.position().is_some_and(|at| passed.insert(at));
                        errors.push(error);
                        if !is_new || errors.len() >= MOST {
                            break Scene::default();
                        }
                    }
                }
            };
            for node in result_nodes(xml) {
                let recipe = self.check_verbatim(node).and_then(|()| read_recipe(self, node));
                errors.extend(recipe.err());
            }
            let mut problems: Vec<Problem> =
                errors.into_iter().map(|error| Problem { is_error: true, error, id: None }).collect();
            problems.extend(scene.warnings.iter().map(|text| Problem {
                is_error: false,
                error: doubt(text),
                id: None,
            }));
            if problems.iter().any(|problem| problem.error.position().is_some()) {
                for node in xml.descendants().filter(roxmltree::Node::is_element) {
                    let at = resolver.position(node);
                    for problem in problems.iter_mut().filter(|problem| problem.error.position() == Some(at))
                    {
                        problem.id.get_or_insert_with(|| resolver.reference(node));
                    }
                }
            }
            problems.sort_by_key(|problem| (!problem.is_error, problem.error.position()));
            Ok((scene, problems))
        })
    }
}

/// A warning as an error: its text starts with its place.
fn doubt(text: &str) -> Error {
    let (place, sentence) = text.split_once(": ").unwrap_or(("", text));
    let numbers = place.split_once(':').map(|(line, column)| (line.parse(), column.parse()));
    match numbers {
        Some((Ok(line), Ok(column))) => {
            Error::new("doubtful", sentence, "Change it if it is not what you mean")
                .at(Position { line, column })
        }
        _ => Error::new("doubtful", text, "Change it if it is not what you mean"),
    }
}
