//! Colours of built-in elements: three tones that print well, no two equal neighbours.

use super::place::Placed;
use kurbo::Point;

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
pub(super) fn palette(name: &str, container_fill: Option<&str>) -> [&'static str; 3] {
    let dark = container_fill.and_then(luminance).is_some_and(|luminance| luminance < 0.42);
    tones(match (name, dark) {
        ("auto", true) => "pale",
        ("auto", false) => "lagoon",
        (name, _) => name,
    })
}

/// Perceived brightness of a colour, 0 black to 1 white. `None` for gradients and patterns.
fn luminance(colour: &str) -> Option<f64> {
    let hex = colour.trim().strip_prefix('#');
    let channel =
        |range: std::ops::Range<usize>| hex.and_then(|hex| u8::from_str_radix(hex.get(range)?, 16).ok());
    let (r, g, b) = match (hex.map(str::len), colour.trim()) {
        (Some(6), _) => (channel(0..2)?, channel(2..4)?, channel(4..6)?),
        (Some(3), _) => (channel(0..1)? * 17, channel(1..2)? * 17, channel(2..3)? * 17),
        (_, "black" | "navy" | "darkgreen" | "darkblue" | "maroon" | "indigo") => (20, 20, 20),
        _ => return None,
    };
    Some((0.299 * f64::from(r) + 0.587 * f64::from(g) + 0.114 * f64::from(b)) / 255.0)
}

/// A tone for every element: about half main, a third second, the rest accent, each the one
/// that is rarest among its neighbours.
pub(super) fn assign(placed: &[Placed], reach: f64) -> Vec<usize> {
    const SHARES: [f64; 3] = [0.46, 0.34, 0.2];
    let centres: Vec<Point> = placed.iter().map(|placed| placed.centre).collect();
    let bounds = centres.iter().fold(None, |bounds: Option<kurbo::Rect>, &p| {
        Some(bounds.map_or(kurbo::Rect::from_points(p, p), |b| b.union_pt(p)))
    });
    let Some(bounds) = bounds else { return Vec::new() };
    let mut grid = crate::geom::near::PointGrid::new(bounds, reach);
    let mut assigned: Vec<usize> = Vec::new();
    let mut counts = [0.0; 3];
    for (i, &centre) in centres.iter().enumerate() {
        let mut near = [0.0; 3];
        grid.visit(centre, reach, |p, other| {
            let distance = p.distance(centre);
            if distance < reach {
                near[assigned[other as usize]] += 1.0 - distance / reach;
            }
            true
        });
        let want = |tone: usize| {
            near[tone] / SHARES[tone] + 3.0 * (counts[tone] / (i as f64 + 1.0) - SHARES[tone]) / SHARES[tone]
        };
        let best = (0..3).min_by(|&a, &b| want(a).total_cmp(&want(b))).unwrap_or(0);
        counts[best] += 1.0;
        assigned.push(best);
        grid.insert(centre, i as u32);
    }
    assigned
}
