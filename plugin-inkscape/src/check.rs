//! `rinceau check`: what the marks in a drawing mean, and everything that is wrong with them.

use crate::output;
use rinceau_format::{Document, Error, Position, Problem, Scene, Source, is_deceptive, printable};
use serde_json::json;
use std::fmt::Write;
use std::io::IsTerminal;
use std::path::Path;

/// What a check found.
pub struct Check {
    scene: Scene,
    problems: Vec<Problem>,
    /// Generator and sources of each result layer that can be read.
    results: Vec<(String, Vec<String>)>,
}

/// Prints what would be used, and every problem.
///
/// Errors: the drawing has some that no generator takes; one that says nothing more, since all is said.
pub fn run(input: Option<&Path>, as_json: bool) -> Result<(), Error> {
    let found = Document::from_bytes(output::read(input)?).and_then(|document| {
        let check = Check::new(&document)?;
        Ok((document, check))
    });
    let (document, check) = match found {
        Ok(found) => found,
        // Not even a drawing: that is the one problem.
        Err(error) if as_json => {
            let problem = Problem { is_error: true, error, id: None };
            let check = Check { scene: Scene::default(), problems: vec![problem], results: Vec::new() };
            output::write(None, check.json().as_bytes())?;
            return check.verdict();
        }
        Err(error) => return Err(error),
    };
    let snippets = std::io::stdout().is_terminal().then(|| document.text());
    output::write(None, if as_json { check.json() } else { check.text(snippets) }.as_bytes())?;
    check.verdict()
}

impl Check {
    /// Checks a drawing.
    ///
    /// Errors: nothing of it can be read.
    pub fn new(document: &Document) -> Result<Self, Error> {
        let (scene, mut problems) = document.check()?;
        let known =
            |error: &Error| all(&scene).into_iter().find(|(_, source)| Some(source.at) == error.position());
        for error in rinceau::faults(&scene) {
            let id = known(&error).map(|(_, source)| source.id.clone());
            problems.push(Problem { is_error: true, error, id });
        }
        for element in scene.elements.iter().filter(|element| element.template.spine.is_none()) {
            let source = &element.source;
            let error = source.error(
                "no-spine",
                format!("the element '{}' has no spine, so nothing can place it", source.id),
                "Draw a straight line from its base to its tip in its group, and mark that as spine",
            );
            problems.push(Problem { is_error: false, error, id: Some(source.id.clone()) });
        }
        let is_well = problems.iter().all(|problem| !problem.is_error);
        if is_well && scene.containers.is_empty() && scene.forms.is_empty() && scene.references.is_empty() {
            let error = Error::new(
                "no-container",
                "nothing is marked as container",
                "Select a closed shape when you run a generator, or mark one",
            );
            problems.push(Problem { is_error: false, error, id: None });
        }
        problems.sort_by_key(|problem| (!problem.is_error, problem.error.position()));
        let layers = document.layers().unwrap_or_default();
        let results =
            layers.into_iter().map(|layer| (layer.recipe.generator, layer.recipe.sources)).collect();
        Ok(Check { scene, problems, results })
    }

    fn errors(&self) -> usize {
        self.problems.iter().filter(|problem| problem.is_error).count()
    }

    fn verdict(&self) -> Result<(), Error> {
        match self.errors() {
            0 => Ok(()),
            1 => Err(Error::new("problems", "There is an error in the drawing", "See above")),
            n => Err(Error::new("problems", format!("There are {n} errors in the drawing"), "See above")),
        }
    }

    /// As text; with the place of each problem in the drawing's text, if that is given.
    pub fn text(&self, snippets: Option<&str>) -> String {
        let mut out = String::new();
        let view = self.scene.view;
        let _ = writeln!(
            out,
            "page {:.2} x {:.2}, one unit is {:.4} px",
            view.width(),
            view.height(),
            self.scene.px_per_unit
        );
        for (role, source) in all(&self.scene) {
            let _ = writeln!(out, "{}: {role} '{}'", source.at, printable(&source.id));
        }
        for (generator, sources) in &self.results {
            let _ =
                writeln!(out, "result of {} over {}", printable(generator), printable(&sources.join(", ")));
        }
        for problem in &self.problems {
            let kind = if problem.is_error { "error: " } else { "" };
            let error = &problem.error;
            let at = error.position().map(|at| format!("{at}: ")).unwrap_or_default();
            let rest = match (problem.is_error, error.code()) {
                (true, code) => format!(". {}. [{code}]", error.remedy()),
                // What to do about a doubt is plain.
                (false, "doubtful") => String::new(),
                (false, _) => format!(". {}.", error.remedy()),
            };
            let _ = writeln!(out, "{at}{kind}{}{rest}", error.sentence());
            if let (Some(text), Some(at)) = (snippets, error.position()) {
                out += &snippet(text, at);
            }
        }
        out
    }

    /// As JSON.
    fn json(&self) -> String {
        let objects: Vec<_> = all(&self.scene)
            .into_iter()
            .map(|(role, source)| {
                json!({"role": role, "id": source.id, "label": source.label, "line": source.at.line, "column": source.at.column})
            })
            .collect();
        let problems: Vec<_> = self
            .problems
            .iter()
            .map(|problem| {
                let at = problem.error.position();
                json!({
                    "severity": if problem.is_error { "error" } else { "warning" },
                    "code": problem.error.code(),
                    "message": problem.error.sentence(),
                    "remedy": problem.error.remedy(),
                    "id": problem.id,
                    "line": at.map(|at| at.line),
                    "column": at.map(|at| at.column),
                })
            })
            .collect();
        let results: Vec<_> = self
            .results
            .iter()
            .map(|(generator, sources)| json!({"generator": generator, "sources": sources}))
            .collect();
        let view = self.scene.view;
        let check = json!({
            "page": {"x": view.x0, "y": view.y0, "width": view.width(), "height": view.height()},
            "px_per_unit": self.scene.px_per_unit,
            "objects": objects,
            "results": results,
            "problems": problems,
            "errors": self.errors(),
        });
        format!("{check:#}\n")
    }
}

/// Every object with a role.
fn all(scene: &Scene) -> Vec<(&'static str, &Source)> {
    let mut out: Vec<(&'static str, &Source)> = Vec::new();
    out.extend(scene.containers.iter().map(|one| ("container", &one.source)));
    out.extend(scene.guides.iter().map(|one| ("guide", &one.source)));
    out.extend(scene.fixed.iter().map(|one| ("fixed", &one.source)));
    out.extend(scene.fixed_spines.iter().map(|one| ("fixed-spine", &one.source)));
    out.extend(scene.stems.iter().map(|one| ("stem", &one.source)));
    out.extend(scene.seeds.iter().map(|one| ("seed", &one.source)));
    out.extend(scene.elements.iter().map(|one| ("element", &one.source)));
    out.extend(scene.forms.iter().map(|one| ("form", &one.source)));
    out.extend(scene.tacks.iter().map(|one| ("tack", &one.source)));
    out.extend(scene.references.iter().map(|one| ("reference", &one.source)));
    out.extend(scene.boundaries.iter().map(|one| ("boundary", &one.source)));
    out.extend(scene.sprays.iter().map(|one| ("spray", &one.source)));
    out
}

/// The line of a place, or what of a long one is around it, and a caret below the place.
fn snippet(text: &str, at: Position) -> String {
    const BEFORE: usize = 30;
    const LENGTH: usize = 76;
    let Some(line) = text.lines().nth(at.line.saturating_sub(1)) else { return String::new() };
    let column = at.column.saturating_sub(1);
    let skipped = column.saturating_sub(BEFORE);
    // What a terminal could be fooled by is no part of a snippet.
    let show = |c: char| if is_deceptive(c) { ' ' } else { c };
    let shown: String = line.chars().skip(skipped).take(LENGTH).map(show).collect();
    let number = at.line.to_string();
    let margin = " ".repeat(number.len());
    format!(" {number} | {shown}\n {margin} | {}^\n", " ".repeat(column - skipped))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_caret_stands_below_its_place() {
        let text = format!("<svg>\n{}<path é\u{1b}/>", "x".repeat(50));
        assert_eq!(snippet("<svg>", Position { line: 1, column: 3 }), " 1 | <svg>\n   |   ^\n");
        let shown = snippet(&text, Position { line: 2, column: 51 });
        let lines: Vec<&str> = shown.lines().collect();
        assert_eq!(lines[0].find('<'), lines[1].find('^'));
        assert!(lines[0].ends_with("<path é />"));
    }
}
