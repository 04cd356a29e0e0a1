//! Recursive forms as grammars of Context Free (`cfdg`, version 3), and back, for what both have: shapes
//! of primitives and copies of shapes, each with a transform of the plane.
//!
//! A grammar has its y axis upwards and starts in black; a path of it may be filled and stroked. What a
//! grammar has and a form has not (chance, colours that change from copy to copy, parameters) is refused
//! where it changes the shape, and noted where it does not; so is the reverse.

mod read;
mod syntax;
mod write;

use kurbo::Affine;

/// Points of a drawing for a unit of a grammar, whose shapes are about a unit large.
const UNIT: f64 = 100.0;

/// The map that `transform x1 y1 x2 y2 x3 y3` stands for: where (0,0), (1,0) and (1,1) go.
fn of_corners([x1, y1, x2, y2, x3, y3]: [f64; 6]) -> Affine {
    Affine::new([x2 - x1, y2 - y1, x3 - x2, y3 - y2, x1, y1])
}

/// The corners of a map.
fn corners(map: Affine) -> [f64; 6] {
    let [a, b, c, d, e, f] = map.as_coeffs();
    [e, f, a + e, b + f, a + c + e, b + d + f]
}

/// Hue in degrees, saturation and brightness of red, green and blue, all but the hue from 0 to 1.
fn hsv([r, g, b]: [f64; 3]) -> [f64; 3] {
    let (most, least) = (r.max(g).max(b), r.min(g).min(b));
    let span = most - least;
    let hue = if span == 0.0 {
        0.0
    } else if most == r {
        60.0 * ((g - b) / span).rem_euclid(6.0)
    } else if most == g {
        120.0 + 60.0 * (b - r) / span
    } else {
        240.0 + 60.0 * (r - g) / span
    };
    [hue, if most > 0.0 { span / most } else { 0.0 }, most]
}

/// The reverse.
fn rgb([hue, saturation, brightness]: [f64; 3]) -> [f64; 3] {
    let part = |n: f64| {
        let k = (n + hue / 60.0).rem_euclid(6.0);
        brightness * (1.0 - saturation * k.min(4.0 - k).clamp(0.0, 1.0))
    };
    [part(5.0), part(3.0), part(1.0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_and_corners_come_back() {
        for colour in [[0.0, 0.0, 0.0], [1.0, 0.5, 0.25], [0.2, 0.9, 0.7], [0.3, 0.1, 0.8], [1.0, 1.0, 1.0]] {
            let back = rgb(hsv(colour));
            assert!(colour.iter().zip(back).all(|(a, b)| (a - b).abs() < 1e-12), "{colour:?} {back:?}");
        }
        let map = Affine::new([1.0, 2.0, 3.0, 5.0, 7.0, 11.0]);
        assert_eq!(of_corners(corners(map)), map);
    }
}
