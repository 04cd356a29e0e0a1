//! Several shorter elements threaded on one line, which the paper names as future work (section 6,
//! checklist F-080).

use super::blob::{Blob, END_GAP};
use super::choose::blob_bin;
use super::prepare::Field;
use super::template::BINS;
use crate::field::LineKind;
use crate::geom::polyline;

/// A threaded element is at least this long, in spacings.
const SHORTEST: f64 = 1.05;

/// The rooms of the elements on one line: the whole room, or equal parts of it with the gap between them.
pub(super) fn threaded(blob: Blob, field: &Field) -> Vec<Blob> {
    let gap = END_GAP * field.sizes.gap;
    let most = ((blob.length + gap) / (SHORTEST * field.sizes.spacing + gap)) as usize;
    let pieces = field.params.thread.min(most);
    // A spine that the artist drew is meant for one element.
    if pieces < 2 || blob.kind == LineKind::Fixed {
        return vec![blob];
    }
    let step = (blob.length + gap) / pieces as f64;
    let piece = |k: usize| {
        let from = k as f64 * step;
        let to = from + step - gap;
        let part = (from / blob.length, to / blob.length);
        let room = |side: &Vec<f64>| (0..BINS).map(|i| side[blob_bin(i, part.0, part.1)]).collect();
        let points = polyline::between(&blob.points, from, to);
        Blob {
            length: polyline::length(&points),
            points,
            room: [room(&blob.room[0]), room(&blob.room[1])],
            ..blob
        }
    };
    (0..pieces).map(piece).collect()
}
