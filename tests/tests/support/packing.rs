//! What holds of every packing.
//!
//! The checks know nothing of how the packing was made: they read the written drawing.

use super::geometry::*;
use kurbo::Point;
use rinceau::geom::boolean::{area, signed_area, simplified};
use rinceau::geom::flatten::flatten;
use rinceau::geom::region::Region;
use rinceau::geom::segment::crosses;
use rinceau_format::{Artwork, Error, Scene};

/// An area that nobody sees: a hundredth of the square of the above in a drawing of 400 units.
const TINY: f64 = 1e-3;

/// Packs a scene.
pub fn pack(scene: &Scene, params: &[(&str, String)], seed: u64) -> Result<Artwork, Error> {
    generated("pack", scene, params, seed)
}

/// Checks every promise on one artwork. `gap` is that between elements, and that around what fills gaps.
pub fn check(artwork: &Artwork, container: &Region, clear: &[Piece], gap: (f64, f64)) {
    let (elements, fillers) = (pieces(artwork, "elements"), pieces(artwork, "fillers"));
    let all: Vec<&Piece> = elements.iter().chain(&fillers).collect();
    assert!(!elements.is_empty());
    for (i, piece) in all.iter().enumerate() {
        assert_inside(&format!("piece {i}"), piece, container);
        // Elements come first, so that the later of two tells.
        let gap = if i < elements.len() { gap.0 } else { gap.1 };
        for other in &all[..i] {
            let between = distance(piece, other, gap);
            assert!(
                between >= gap - SLACK,
                "pieces {i} of {} elements are {between} apart, less than {gap}: {:?} {:?}",
                elements.len(),
                bounds(piece),
                bounds(other)
            );
        }
        let lies_in = |other: &Piece| {
            bounds(other).contains(piece[0][0])
                && Region::new(simplified(other, false)).is_some_and(|other| other.contains(piece[0][0]))
        };
        assert!(
            !all.iter().enumerate().any(|(j, other)| i != j && lies_in(other)),
            "piece {i} lies in another"
        );
        for fixed in clear {
            assert!(distance(piece, fixed, gap) >= gap - SLACK - 0.02 * gap);
        }
    }
    for contour in &closed_contours(artwork, "elements") {
        let folded = folded_area(contour);
        assert!(folded <= 1e-5 * signed_area(contour).abs() + TINY, "an outline folds over {folded}");
    }
}

/// The closed outlines of a group: a vein has none.
fn closed_contours(artwork: &Artwork, group: &str) -> Piece {
    let items = artwork.group(group).map(|group| group.items.as_slice()).unwrap_or_default();
    let parts = items.iter().flat_map(|item| &item.parts);
    let subpaths = parts.flat_map(|part| flatten(&(part.transform * part.path.clone()), FLATNESS));
    subpaths.filter(|subpath| subpath.has_close).map(|subpath| subpath.points).collect()
}

/// Area that a contour winds around the wrong way, or more than once. Chords of two curves
/// that meet in a needle may cross by nothing; a fold has an area.
fn folded_area(contour: &[Point]) -> f64 {
    let sides: Vec<_> = sides(contour).collect();
    let crossed =
        (0..sides.len()).any(|i| sides[..i].iter().any(|&(r, s)| crosses(sides[i].0, sides[i].1, r, s)));
    if !crossed {
        return 0.0;
    }
    let covered = area(&simplified(&[contour.to_vec()], false));
    (covered - signed_area(contour).abs()).abs()
}
