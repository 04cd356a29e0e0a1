//! The connectivity of examples, drawn, so that an artist sees which elements are neighbours and flips
//! edges where the wrong ones are (Ijiri et al. 2008, section 4 and Figure 3; checklist E-009).

use super::example::Connectivity;
use crate::progress::Progress;
use kurbo::{Affine, BezPath};
use rinceau_format::{
    Artwork, Error, Group, Item, Length, Part, Reference, Scene, Source, Style, decimals_for,
};

crate::params! {
    /// Parameters of the drawn connectivity.
    pub struct Params {
        #[doc = "Width of the lines. 0 chooses by itself"]
        width: Length = "width", "Line width", Basic, crate::params::Kind::Length, "0";
    }
}

/// Colours of edges: between two triangles, at the border, and flipped.
const INNER: &str = "#1b6ac9";
const BORDER: &str = "#9aa0a6";
const FLIPPED: &str = "#e8590c";

/// The examples of a scene.
pub fn sources(scene: &Scene) -> Vec<&Source> {
    scene.references.iter().map(|reference| &reference.source).collect()
}

/// Draws an edge between all elements of each example that are neighbours. Each is of the ids of both,
/// which is how one that is selected is known.
///
/// Errors: there is no example, or one of too many elements.
pub fn generate(params: &Params, scene: &Scene, progress: &mut dyn Progress) -> Result<Artwork, Error> {
    progress.step("prepare", 0.0);
    if scene.references.is_empty() {
        return Err(super::no_reference());
    }
    let mut artwork = Artwork {
        complete: true,
        warnings: scene.warnings.clone(),
        decimals: decimals_for(scene.view.size().max_side()),
        ..Artwork::default()
    };
    let width = params.width.to_user(scene.px_per_unit);
    let mut edges = Group { name: "connectivity".into(), ..Group::default() };
    for reference in &scene.references {
        edges.items.extend(drawn(reference, width, &mut artwork.warnings)?);
    }
    artwork.counts.insert("edges".into(), edges.items.len() as f64);
    if edges.items.is_empty() {
        return Err(Error::new(
            "no-neighbours",
            "No elements of the example are neighbours",
            "Draw at least three that do not lie on one line",
        ));
    }
    artwork.groups.push(edges);
    Ok(artwork)
}

fn drawn(reference: &Reference, width: f64, warnings: &mut Vec<String>) -> Result<Vec<Item>, Error> {
    let connectivity = Connectivity::new(reference, warnings)?;
    let edges = connectivity.edges();
    let at = |i: usize| connectivity.elements[i].at;
    let id = |i: usize| &reference.examples[connectivity.elements[i].index].source.id;
    let lengths: f64 = edges.keys().map(|&(a, b)| at(a).distance(at(b))).sum();
    let width = if width > 0.0 { width } else { 0.04 * lengths / edges.len().max(1) as f64 };
    let item = |(&(a, b), &triangles): (&(usize, usize), &usize)| {
        // What is listed was there before it was flipped; the other diagonal is here now.
        let is_flipped = reference.flips.iter().any(|(p, q)| {
            let corner = |id: &String| {
                connectivity.elements.iter().position(|one| reference.examples[one.index].source.id == *id)
            };
            corner(p).zip(corner(q)).is_some_and(|(p, q)| {
                [p, q]
                    .into_iter()
                    .all(|c| [a, b].into_iter().all(|e| edges.contains_key(&(c.min(e), c.max(e)))))
                    && !edges.contains_key(&(p.min(q), p.max(q)))
            })
        });
        let mut style = Style::filled("none");
        style.set(
            "stroke",
            if is_flipped {
                FLIPPED
            } else if triangles == 2 {
                INNER
            } else {
                BORDER
            },
        );
        style.set("stroke-width", &format!("{width:.4}"));
        style.set("stroke-linecap", "round");
        let mut path = BezPath::new();
        path.move_to(at(a));
        path.line_to(at(b));
        Item::new(format!("{} {}", id(a), id(b)), vec![Part { path, transform: Affine::IDENTITY, style }])
    };
    Ok(edges.iter().map(item).collect())
}
