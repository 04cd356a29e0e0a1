//! Which elements there are, and which a container asks for.

use super::builtin;
use super::prepare::Field;
use super::template::Template;
use rinceau_format::{Error, Scene};

/// The drawn elements and the built-in ones.
pub(super) fn templates(scene: &Scene) -> Result<Vec<Template>, Error> {
    let mut templates =
        scene.elements.iter().map(|element| Template::new(element, false)).collect::<Result<Vec<_>, _>>()?;
    templates.extend(builtin::templates()?);
    Ok(templates)
}

/// Which templates a container asks for: the union of what each name means.
///
/// Errors: a name that means nothing; no drawn element where one is asked for.
pub(super) fn usable(templates: &[Template], field: &Field, scene: &Scene) -> Result<Vec<usize>, Error> {
    let any_drawn = !scene.elements.is_empty();
    let mut usable = vec![false; templates.len()];
    for word in field.params.elements.split_whitespace() {
        let means = |template: &Template| match word {
            "auto" if any_drawn => !template.builtin,
            "auto" => template.names.iter().any(|name| name == "mixed"),
            "drawn" => !template.builtin,
            name => template.names.iter().any(|own| own == name),
        };
        let mut any = false;
        for (usable, template) in usable.iter_mut().zip(templates) {
            let meant = means(template);
            *usable |= meant;
            any |= meant;
        }
        if !any {
            let container = &scene.containers[field.container];
            let error = unknown(word);
            // A container's own wish is wrong where it stands; the run's is not in the drawing.
            let own = container.overrides.contains_key("elements");
            return Err(if own { error.at(container.source.at) } else { error });
        }
    }
    Ok((0..templates.len()).filter(|&i| usable[i]).collect())
}

fn unknown(word: &str) -> Error {
    if word == "drawn" {
        let remedy = "Draw one: group its shapes with a straight spine and mark the group as element";
        return Error::new("no-element", "No element is drawn", remedy);
    }
    let remedy = "Use auto, drawn, mixed, leaves, drops, spirals, scales, feathers, or the id of an element";
    Error::new("no-element", format!("No element, kind or family is called '{word}'"), remedy)
}
