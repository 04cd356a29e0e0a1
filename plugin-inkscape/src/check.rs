//! `rinceau check`: what the marks in a drawing mean.

use crate::output;
use rinceau_format::{Document, Error, Scene, Selection};
use std::fmt::Write;

/// Prints what would be used, and every doubt. Errors as a generator would.
pub fn run(document: &Document) -> Result<(), Error> {
    let scene = document.scene(&Selection::default())?;
    output::write(None, summary(document, &scene)?.as_bytes())
}

/// The text of the check.
pub fn summary(document: &Document, scene: &Scene) -> Result<String, Error> {
    let mut out = String::new();
    let _ = writeln!(
        out,
        "page {:.2} x {:.2}, one unit is {:.4} px",
        scene.view.width(),
        scene.view.height(),
        scene.px_per_unit
    );
    let mut list = |role: &str, found: Vec<&rinceau_format::Source>| {
        for source in found {
            let _ = writeln!(out, "{}: {role} '{}'", source.at, source.id);
        }
    };
    list("container", scene.containers.iter().map(|c| &c.source).collect());
    list("guide", scene.guides.iter().map(|g| &g.source).collect());
    list("fixed", scene.fixed.iter().map(|f| &f.source).collect());
    list("fixed-spine", scene.fixed_spines.iter().map(|g| &g.source).collect());
    list("stem", scene.stems.iter().map(|g| &g.source).collect());
    list("seed", scene.seeds.iter().map(|s| &s.source).collect());
    list("element", scene.elements.iter().map(|e| &e.source).collect());
    list("form", scene.forms.iter().map(|f| &f.source).collect());
    list("tack", scene.tacks.iter().map(|t| &t.source).collect());
    list("reference", scene.references.iter().map(|r| &r.source).collect());
    list("boundary", scene.boundaries.iter().map(|g| &g.source).collect());
    list("spray", scene.sprays.iter().map(|s| &s.source).collect());
    for element in scene.elements.iter().filter(|element| element.template.spine.is_none()) {
        let _ = writeln!(
            out,
            "{}: the element '{}' has no spine, so nothing can place it",
            element.source.at, element.source.id
        );
    }
    for layer in document.layers()? {
        let _ =
            writeln!(out, "result of {} over {}", layer.recipe.generator, layer.recipe.sources.join(", "));
    }
    for warning in &scene.warnings {
        let _ = writeln!(out, "{warning}");
    }
    if scene.containers.is_empty() && scene.forms.is_empty() {
        let _ = writeln!(
            out,
            "nothing is marked as container: select a closed shape when you run a generator, or mark one"
        );
    }
    Ok(out)
}
