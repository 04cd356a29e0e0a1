//! A sheet of neighbours: the form with one of its clones changed a little, one picture for each
//! clone and change (checklist; the paper's remark that one sees too little of the
//! landscape around a form).

use super::expand::{Expansion, Looks, Step};
use super::lists::{Entry, Lists, Reach};
use super::{Run, fitted};
use crate::progress::Progress;
use kurbo::{Affine, Point, Rect, Vec2};
use rinceau_format::{Artwork, Error, Group, Item, Part};
use std::sync::Arc;

/// Changes of a clone: one column each.
const CHANGES: usize = 5;
/// Shapes of one picture at most.
const MOST: f64 = 4000.0;
/// Clones that are changed at most.
const ROWS: usize = 12;

/// Draws the sheet into the frame, or to the right of the page.
pub(super) fn draw(
    run: &Run,
    expansion: &Expansion,
    artwork: &mut Artwork,
    progress: &mut dyn Progress,
) -> Result<(), Error> {
    let view = run.scene.view;
    let frame = run.frame.unwrap_or_else(|| view.with_origin((view.x1, view.y0)));
    let clones: Vec<usize> = (0..run.lists.lists[run.root].entries.len())
        .filter(|&i| matches!(run.lists.lists[run.root].entries[i], Entry::Clone(..)))
        .take(ROWS)
        .collect();
    if clones.is_empty() {
        return Err(run.form.source.error(
            "nothing-to-change",
            format!("The form '{}' has no clones to change", run.form.source.id),
            "Clone its motif (Edit > Clone > Create Clone)",
        ));
    }
    let reach = expansion.reach;
    let depth = run.lists.deepest(run.root, reach, MOST).max(1);
    let own_lists = run.lists.of(run.root);
    let cell = Vec2::new(frame.width() / CHANGES as f64, frame.height() / clones.len() as f64);
    let mut group = Group { name: run.name.clone(), ..Group::default() };
    for (row, &entry) in clones.iter().enumerate() {
        for column in 0..CHANGES {
            if !progress.step("sheet", (row * CHANGES + column) as f64 / (CHANGES * clones.len()) as f64) {
                artwork.complete = false;
                artwork.groups.push(group);
                return Ok(());
            }
            let lists = Arc::new(changed(&own_lists, 0, entry, column, run.params.change));
            let own = Expansion {
                lists,
                root: 0,
                reach: Reach { depth, ..reach },
                place: Affine::IDENTITY,
                ..expansion.clone()
            };
            let corner = frame.origin() + Vec2::new(column as f64 * cell.x, row as f64 * cell.y);
            let into = Rect::from_origin_size(corner, cell.to_size());
            let survey = run.survey(&own, progress)?;
            let place = survey.bounds.and_then(|bounds| fitted(bounds, into)).unwrap_or_default();
            let parts = picture(&Expansion { place, ..own });
            group.items.push(Item::new(run.form.source.id.clone(), parts));
        }
    }
    artwork.counts.insert("pictures".into(), group.items.len() as f64);
    artwork.groups.push(group);
    Ok(())
}

/// The lists with one clone changed, about its foot, so that it stays attached.
fn changed(lists: &Lists, root: usize, entry: usize, change: usize, degrees: f64) -> Lists {
    let mut lists = lists.clone();
    if let Entry::Clone(other, by) = lists.lists[root].entries[entry] {
        let foot = by * foot(&lists, other);
        let angle = degrees.to_radians();
        let factor = 1.0 + degrees / 100.0;
        let change = match change {
            0 => Affine::rotate(-angle),
            1 => Affine::rotate(angle),
            2 => Affine::scale(1.0 / factor),
            3 => Affine::scale(factor),
            // In its own upright axis.
            _ => {
                let [a, b, ..] = by.as_coeffs();
                let turn = libm::atan2(b, a);
                Affine::rotate(turn) * Affine::scale_non_uniform(-1.0, 1.0) * Affine::rotate(-turn)
            }
        };
        let about = Affine::translate(foot.to_vec2()) * change * Affine::translate(-foot.to_vec2());
        lists.lists[root].entries[entry] = Entry::Clone(other, about * by);
    }
    lists
}

/// Where the first line of a motif starts: the foot of a trunk, and a corner of a polygon.
fn foot(lists: &Lists, list: usize) -> Point {
    let first = lists.lists[list].entries.iter().find_map(|entry| match *entry {
        Entry::Draw(primitive) => Some(&lists.primitives[primitive]),
        Entry::Clone(..) => None,
    });
    let start = first.and_then(|drawn| Some(drawn.base * drawn.path.elements().first()?.end_point()?));
    start.unwrap_or_default()
}

/// Everything that a form draws.
pub(super) fn picture(expansion: &Expansion) -> Vec<Part> {
    let mut looks = Looks::default();
    let mut parts: Vec<Part> = Vec::new();
    expansion.walk(|step| {
        if let Step::Draw(drawn) = step {
            let look = expansion.look(&drawn, &mut looks);
            let style = expansion.own_style(&drawn, &look);
            let path = expansion.lists.primitives[drawn.primitive].path.clone();
            parts.push(match look.is_flat {
                true => Part { path: look.transform * path, transform: Affine::IDENTITY, style },
                false => Part { path, transform: look.transform, style },
            });
        }
        true
    });
    parts
}
