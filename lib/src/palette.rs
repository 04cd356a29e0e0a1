//! Colours of built-in elements: three tones that print well.

/// Colours for built-in elements.
pub const PALETTES: &[(&str, &str)] = &[
    ("auto", "To suit the shape's fill"),
    ("lagoon", "Lagoon: deep teal, sea green, ochre"),
    ("ember", "Ember: wine, brick, amber"),
    ("meadow", "Meadow: forest, moss, straw"),
    ("dusk", "Dusk: indigo, plum, rose"),
    ("pale", "Pale: cream, sand, sky (for dark shapes)"),
    ("ink", "Ink: black"),
    ("white", "White (for dark shapes)"),
];

/// The tones of a palette: main, second, accent.
fn tones(palette: &str) -> [&'static str; 3] {
    match palette {
        "ember" => ["#6d1f2b", "#b4482f", "#dd9a3c"],
        "meadow" => ["#24452f", "#5c7a3a", "#c2a54a"],
        "dusk" => ["#2b2a5a", "#7b3f72", "#cf7f86"],
        "pale" => ["#f6ecd2", "#e2c48d", "#a9cfd6"],
        "ink" => ["#1a1a1a"; 3],
        "white" => ["#ffffff"; 3],
        _ => ["#14444f", "#2f7f79", "#d2913a"],
    }
}

/// The palette for a container: `auto` looks at what the elements will lie on, and takes one of which all
/// tones stand out from it.
pub fn palette(name: &str, container_fill: Option<&str>) -> [&'static str; 3] {
    /// Tones nearer to each other than this (in Oklab) look alike side by side.
    const APART: f64 = 0.12;
    if name != "auto" {
        return tones(name);
    }
    let Some(fill) = container_fill.and_then(rinceau_format::rgb) else { return tones("lagoon") };
    let candidates: &[&str] = match luminance(fill) < 0.42 {
        true => &["pale", "white", "lagoon"],
        false => &["lagoon", "ember", "dusk", "meadow", "pale", "ink"],
    };
    let apart = |name: &str| {
        let distances =
            tones(name).map(|tone| rinceau_format::rgb(tone).map_or(0.0, |tone| distance(tone, fill)));
        distances.into_iter().fold(f64::INFINITY, f64::min)
    };
    let clear = candidates.iter().find(|name| apart(name) >= APART);
    let clearest = || candidates.iter().max_by(|a, b| apart(a).total_cmp(&apart(b)));
    tones(clear.or_else(clearest).copied().unwrap_or("lagoon"))
}

/// How unlike two colours look: the distance in Oklab.
fn distance(a: [u8; 3], b: [u8; 3]) -> f64 {
    let (a, b) = (oklab(a), oklab(b));
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
}

/// A colour in Oklab, where distances are as the eye has them (Björn Ottosson 2020).
pub fn oklab(rgb: [u8; 3]) -> [f64; 3] {
    let linear = |byte: u8| {
        let c = f64::from(byte) / 255.0;
        if c <= 0.040_45 { c / 12.92 } else { libm::pow((c + 0.055) / 1.055, 2.4) }
    };
    let [r, g, b] = rgb.map(linear);
    let l = libm::cbrt(0.412_221_470_8 * r + 0.536_332_536_3 * g + 0.051_445_992_9 * b);
    let m = libm::cbrt(0.211_903_498_2 * r + 0.680_699_545_1 * g + 0.107_396_956_6 * b);
    let s = libm::cbrt(0.088_302_461_9 * r + 0.281_718_837_6 * g + 0.629_978_700_5 * b);
    [
        0.210_454_255_3 * l + 0.793_617_785_0 * m - 0.004_072_046_8 * s,
        1.977_998_495_1 * l - 2.428_592_205_0 * m + 0.450_593_709_9 * s,
        0.025_904_037_1 * l + 0.782_771_766_2 * m - 0.808_675_766_0 * s,
    ]
}

/// Perceived brightness of a colour, 0 black to 1 white.
fn luminance([r, g, b]: [u8; 3]) -> f64 {
    (0.299 * f64::from(r) + 0.587 * f64::from(g) + 0.114 * f64::from(b)) / 255.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_palette_stands_out_from_the_fill() {
        assert!((oklab([255, 255, 255])[0] - 1.0).abs() < 1e-4);
        let fills = [
            "#ffffff", "#eeeeee", "#d2913a", "#009999", "#2e86de", "#14444f", "#000000", "#d40000",
            "#c8a2c8", "#f6ecd2", "#7f7f7f", "#ffcc00", "#5c7a3a", "#cf7f86", "#a9cfd6",
        ];
        for fill in fills {
            let colour = rinceau_format::rgb(fill).unwrap();
            for tone in palette("auto", Some(fill)) {
                let apart = distance(rinceau_format::rgb(tone).unwrap(), colour);
                assert!(apart > 0.1, "{tone} on {fill}: {apart}");
            }
        }
        assert_eq!(palette("auto", Some("#ffffff")), tones("lagoon"));
        assert_eq!(palette("auto", None), tones("lagoon"));
        assert_eq!(palette("auto", Some("#111111")), tones("pale"));
        assert_eq!(palette("ember", Some("#6d1f2b")), tones("ember"));
    }
}
