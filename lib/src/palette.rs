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

/// The palette for a container: `auto` looks at what the elements will lie on.
pub fn palette(name: &str, container_fill: Option<&str>) -> [&'static str; 3] {
    let dark = container_fill.and_then(luminance).is_some_and(|luminance| luminance < 0.42);
    tones(match (name, dark) {
        ("auto", true) => "pale",
        ("auto", false) => "lagoon",
        (name, _) => name,
    })
}

/// Perceived brightness of a colour, 0 black to 1 white. `None` for gradients and patterns.
fn luminance(colour: &str) -> Option<f64> {
    let [r, g, b] = rinceau_format::rgb(colour)?;
    Some((0.299 * f64::from(r) + 0.587 * f64::from(g) + 0.114 * f64::from(b)) / 255.0)
}
