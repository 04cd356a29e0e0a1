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

/// Which templates a container asks for.
pub(super) fn usable(templates: &[Template], field: &Field, scene: &Scene) -> Result<Vec<usize>, Error> {
    let wanted = field.params.elements.as_str();
    let any_drawn = !scene.elements.is_empty();
    let named = |template: &Template| match wanted {
        "auto" if any_drawn => !template.builtin,
        "auto" => template.names.iter().any(|name| name == "mixed"),
        "drawn" => !template.builtin,
        names => names.split_whitespace().any(|name| template.names.iter().any(|own| own == name)),
    };
    let usable: Vec<usize> = (0..templates.len()).filter(|&i| named(&templates[i])).collect();
    if usable.is_empty() {
        let container = &scene.containers[field.container].source;
        let (sentence, remedy) = if wanted == "drawn" {
            (
                "No element is drawn".to_owned(),
                "Draw one: group its shapes with a straight spine and mark the group as element",
            )
        } else {
            (
                format!("No element, kind or family is called '{wanted}'"),
                "Use auto, drawn, mixed, leaves, drops, spirals, scales, feathers, or the id of an element",
            )
        };
        return Err(container.error("no-element", sentence, remedy));
    }
    Ok(usable)
}
