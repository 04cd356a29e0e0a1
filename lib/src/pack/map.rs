//! A map of the gaps, for whoever wants to see where a composition is uneven.

use crate::quality;
use kurbo::{Affine, Circle, Shape};
use rinceau_format::{Artwork, Error, Group, Item, Part, Scene, Style};

/// A hidden sublayer of discs that fill the gaps: blue where they are narrower than their mean, through
/// white, to red where they are twice as wide or more. None where there is no gap.
///
/// Errors: as [`quality::gap_discs`].
pub(super) fn map(scene: &Scene, artwork: &Artwork) -> Result<Option<Group>, Error> {
    let discs = quality::gap_discs(scene, artwork)?;
    // Each counts as much as it covers, or specks would make the mean.
    let moment = |power| discs.iter().map(|disc| disc.1.powi(power)).sum::<f64>();
    let mean = moment(3) / moment(2);
    let mut group = Group { name: "gaps".into(), hidden: true, ..Group::default() };
    for (centre, radius) in discs {
        let path = Circle::new(centre, radius).to_path(1e-2 * radius);
        let style = Style::filled(&colour(radius / mean));
        group.items.push(Item::new("gap-width", vec![Part { path, transform: Affine::IDENTITY, style }]));
    }
    Ok((!group.items.is_empty()).then_some(group))
}

/// The colour of a gap by its width over the mean.
fn colour(ratio: f64) -> String {
    let mix = |from: [f64; 3], to: [f64; 3], t: f64| {
        let channel = |i: usize| (from[i] + t * (to[i] - from[i])).round() as u8;
        format!("#{:02x}{:02x}{:02x}", channel(0), channel(1), channel(2))
    };
    const NARROW: [f64; 3] = [38.0, 84.0, 164.0];
    const MEAN: [f64; 3] = [245.0, 240.0, 225.0];
    const WIDE: [f64; 3] = [190.0, 40.0, 40.0];
    match ratio < 1.0 {
        true => mix(NARROW, MEAN, ratio.max(0.0)),
        false => mix(MEAN, WIDE, (ratio - 1.0).min(1.0)),
    }
}

#[cfg(test)]
mod tests {
    use super::colour;

    #[test]
    fn colours_run_from_blue_to_red() {
        assert_eq!([0.0, 1.0, 2.0, 9.0].map(colour), ["#2654a4", "#f5f0e1", "#be2828", "#be2828"]);
    }
}
