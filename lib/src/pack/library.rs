//! Which elements there are, and which a container asks for, in its lines and in its gaps.

use super::builtin;
use super::motif::Motif;
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
            return Err(at_container(unknown(word), "elements", field, scene));
        }
    }
    Ok((0..templates.len()).filter(|&i| usable[i]).collect())
}

/// What a container asks for in its gaps. Empty for nothing, and for the shapes of the gaps.
///
/// Errors: as [`usable`].
pub(super) fn motifs(templates: &[Template], field: &Field, scene: &Scene) -> Result<Vec<Motif>, Error> {
    let mut motifs = Vec::new();
    for word in field.params.fillers.split_whitespace() {
        match word {
            "pebbles" => motifs.push(Motif::Pebble),
            "dots" => motifs.push(Motif::Dot),
            "diamonds" => motifs.push(Motif::Diamond),
            "drops" => motifs.push(Motif::Drop),
            "shapes" | "none" => {}
            name => {
                let named = |i: &usize| templates[*i].names.iter().any(|own| own == name);
                let before = motifs.len();
                motifs.extend((0..templates.len()).filter(named).map(Motif::Element));
                if motifs.len() == before {
                    let sentence = format!("Nothing that fills gaps is called '{name}'");
                    let remedy = "Use pebbles, dots, diamonds, drops, shapes, none, or the id, kind or family of an element";
                    let error = Error::new("no-filler", sentence, remedy);
                    return Err(at_container(error, "fillers", field, scene));
                }
            }
        }
    }
    Ok(motifs)
}

/// A container's own wish is wrong where it stands; the run's is not in the drawing.
fn at_container(error: Error, param: &str, field: &Field, scene: &Scene) -> Error {
    let container = &scene.containers[field.container];
    if container.overrides.contains_key(param) { error.at(container.source.at) } else { error }
}

fn unknown(word: &str) -> Error {
    if word == "drawn" {
        let remedy = "Draw one: group its shapes with a straight spine and mark the group as element";
        return Error::new("no-element", "No element is drawn", remedy);
    }
    let remedy = "Use auto, drawn, mixed, leaves, drops, spirals, scales, feathers, or the id of an element";
    Error::new("no-element", format!("No element, kind or family is called '{word}'"), remedy)
}
