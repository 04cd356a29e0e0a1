//! Tack transformations of marked and selected objects (Carlson and Woodbury 1990, Figure 5;
//! checklist ): up to two tacks stay where they are, and a guide drags one more
//! point. The maps themselves are in [`crate::geom::affine`].

use crate::geom::affine::{KeepsTacks, drag, drag_about, drag_across};
use kurbo::{Affine, PathEl, Point};
use rinceau_format::{Error, Scene, Source};

/// The operations: name, what a menu calls it, and its tip.
pub const OPERATIONS: &[(&str, &str, &str)] = &[
    (
        "drag",
        "Drag along a guide",
        "Moves what is selected so that the start of the guide comes to its end: with one tack it turns and scales about it, with two it shears and stretches beside their line",
    ),
    ("mirror", "Mirror in the line of two tacks", "Reflects what is selected in the line through both tacks"),
    ("mirror-across", "Mirror across two tacks", "Reflects what is selected so that the tacks change places"),
    (
        "half-turn",
        "Half-turn about two tacks",
        "Turns what is selected upside down about the middle of the tacks, so that they change places",
    ),
    (
        "identity",
        "Back onto its source",
        "Lays a clone exactly over what it is a clone of: the transformation that changes nothing",
    ),
];

/// What to do with objects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tacked {
    /// Transform them, in user units of the root.
    By(Affine),
    /// Lay them over what they are clones of.
    OntoSource,
}

/// What an operation does to the objects with these ids, and which of them are moved: tacks and
/// guides among them say how. Where there is none among them, those of the drawing do.
///
/// Errors: nothing to move; tacks or a guide that are missing, too many or too close.
pub fn tacked(operation: &str, scene: &Scene, ids: &[String]) -> Result<(Vec<String>, Tacked), Error> {
    let marks = || scene.tacks.iter().map(|tack| &tack.source).chain(scene.guides.iter().map(|g| &g.source));
    let moved: Vec<String> =
        ids.iter().filter(|&id| !marks().any(|source| source.id == *id)).cloned().collect();
    if moved.is_empty() {
        return Err(Error::new(
            "nothing-selected",
            "Nothing is selected that could be moved",
            "Select objects, and with them the tacks and the guide that are meant",
        ));
    }
    if operation == "identity" {
        return Ok((moved, Tacked::OntoSource));
    }
    let tacks: Vec<Point> =
        meant(&scene.tacks, ids, |tack| &tack.source).into_iter().map(|tack| tack.at).collect();
    let tolerance = NEAR * scene.view.size().max_side();
    let kept = match operation {
        "mirror" => KeepsTacks::Mirror,
        "mirror-across" => KeepsTacks::MirrorAcross,
        "half-turn" => KeepsTacks::HalfTurn,
        "drag" => return Ok((moved, Tacked::By(dragged(scene, ids, &tacks, tolerance)?))),
        other => {
            return Err(Error::new(
                "unknown-tool",
                format!("This version has no tack operation '{other}'"),
                "Run 'rinceau install' again",
            ));
        }
    };
    let &[a, b] = &tacks[..] else {
        return Err(Error::new(
            "tacks",
            format!("This needs two tacks, and there {}", number(tacks.len())),
            "Mark two points as tacks (Extensions > Ornament > Mark as), or select the two that are meant",
        ));
    };
    Ok((moved, Tacked::By(kept.about((a, b), tolerance).ok_or_else(too_close)?)))
}

/// Points nearer than this share of the page say nothing about a direction.
const NEAR: f64 = 1e-9;

fn dragged(scene: &Scene, ids: &[String], tacks: &[Point], tolerance: f64) -> Result<Affine, Error> {
    let guides = meant(&scene.guides, ids, |guide| &guide.source);
    let [guide] = guides[..] else {
        return Err(Error::new(
            "drag-guide",
            format!("A drag needs one guide, and there {}", number(guides.len())),
            "Mark one line as guide, from the point that is dragged to where it goes, or select the one that is meant",
        ));
    };
    let mut nodes = guide.path.elements().iter().filter_map(PathEl::end_point);
    let (Some(p), Some(q)) = (nodes.next(), nodes.next_back()) else { return Err(too_close()) };
    let by = match *tacks {
        [] => Some(drag(p, q)),
        [tack] => drag_about(tack, p, q, tolerance),
        [a, b] => drag_across((a, b), p, q, tolerance),
        _ => {
            return Err(Error::new(
                "tacks",
                format!("A drag has two tacks at most, and there {}", number(tacks.len())),
                "Select the tacks that are meant, or clear the marks of the others",
            ));
        }
    };
    by.ok_or_else(too_close)
}

/// Those marks that were selected, or all if none was.
fn meant<'a, T>(marks: &'a [T], ids: &[String], source: impl Fn(&T) -> &Source) -> Vec<&'a T> {
    let selected: Vec<&T> = marks.iter().filter(|mark| ids.contains(&source(mark).id)).collect();
    if selected.is_empty() { marks.iter().collect() } else { selected }
}

fn number(count: usize) -> String {
    match count {
        0 => "is none".to_owned(),
        1 => "is one".to_owned(),
        count => format!("are {count}"),
    }
}

fn too_close() -> Error {
    Error::new(
        "tacks",
        "The tacks and the ends of the guide are too close to each other to say how to move",
        "Move them apart: two tacks from each other, the guide's ends from the tacks and from their line",
    )
}
