//! Colours over generations.

use crate::palette::oklab;
use rinceau_format::{Error, Style, rgb};

/// Colours from the first generation to the last, in Oklab (Björn Ottosson 2020), where the way
/// from one colour to another looks even.
#[derive(Clone, Debug)]
pub(super) struct Ramp(Vec<[f64; 3]>);

impl Ramp {
    /// From the parameter; `None` for colours as drawn.
    ///
    /// Errors: something that is no colour.
    pub fn new(colours: &str) -> Result<Option<Self>, Error> {
        if matches!(colours.trim(), "" | "drawn") {
            return Ok(None);
        }
        let colour = |name: &str| {
            rgb(name).map(oklab).ok_or_else(|| {
                Error::new(
                    "bad-colour",
                    format!("'{}' is no colour", name.trim()),
                    "Write colours such as '#14444f,#d2913a', or drawn",
                )
            })
        };
        colours.split(',').map(colour).collect::<Result<Vec<_>, _>>().map(|stops| Some(Ramp(stops)))
    }

    /// The colour of a generation, from 1 to `depth`.
    fn at(&self, generation: usize, depth: usize) -> String {
        let last = self.0.len() - 1;
        let share = (generation - 1) as f64 / (depth.max(2) - 1) as f64;
        let place = share.clamp(0.0, 1.0) * last as f64;
        let i = (place as usize).min(last.saturating_sub(1));
        let (a, b, t) = (self.0[i], self.0[(i + 1).min(last)], place - i as f64);
        let mixed = std::array::from_fn(|k| a[k] + t * (b[k] - a[k]));
        let [r, g, b] = srgb(mixed);
        format!("#{r:02x}{g:02x}{b:02x}")
    }

    /// Gives a style the colour of its generation.
    pub fn paint(&self, style: &mut Style, generation: usize, depth: usize) {
        let colour = self.at(generation, depth);
        if style.is_filled() {
            style.set("fill", &colour);
        }
        if style.stroke_width().is_some() {
            style.set("stroke", &colour);
        }
    }
}

fn srgb([l, a, b]: [f64; 3]) -> [u8; 3] {
    let cube = |x: f64| x * x * x;
    let long = cube(l + 0.396_337_777_4 * a + 0.215_803_757_3 * b);
    let middle = cube(l - 0.105_561_345_8 * a - 0.063_854_172_8 * b);
    let short = cube(l - 0.089_484_177_5 * a - 1.291_485_548_0 * b);
    let linear = [
        4.076_741_662_1 * long - 3.307_711_591_3 * middle + 0.230_969_929_2 * short,
        -1.268_438_004_6 * long + 2.609_757_401_1 * middle - 0.341_319_396_5 * short,
        -0.004_196_086_3 * long - 0.703_418_614_7 * middle + 1.707_614_701_0 * short,
    ];
    linear.map(|c| {
        let c = c.clamp(0.0, 1.0);
        let c = if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * libm::pow(c, 1.0 / 2.4) - 0.055 };
        (c * 255.0).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ramp_runs_from_the_first_colour_to_the_last() {
        let ramp = Ramp::new("#14444f, #d2913a,white").unwrap().unwrap();
        let colours: Vec<String> = (1..=5).map(|generation| ramp.at(generation, 5)).collect();
        assert_eq!((&colours[0][..], &colours[2][..], &colours[4][..]), ("#14444f", "#d2913a", "#ffffff"));
        assert_eq!(ramp.at(1, 1), "#14444f");
        assert_eq!(Ramp::new("#12345").unwrap_err().code(), "bad-colour");
        assert!(Ramp::new("drawn").unwrap().is_none());
    }
}
