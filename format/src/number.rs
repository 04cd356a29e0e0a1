//! Numbers and path data with fixed decimals, so that the same picture is the same bytes.

use kurbo::{BezPath, PathEl, Point};
use std::fmt::Write;

/// Decimals that keep a coordinate of a drawing of this size (its larger side, in user
/// units) within a millionth of the size: 3 for 800 px, 5 for 8 mm.
pub fn decimals_for(size: f64) -> usize {
    const RELATIVE: f64 = 2e-6;
    let mut decimals = 0;
    let mut step = 1.0;
    while step > size.max(f64::MIN_POSITIVE) * RELATIVE && decimals < 9 {
        step /= 10.0;
        decimals += 1;
    }
    decimals
}

/// Appends `value` with at most `decimals` decimals: no exponent, no `-0`, no trailing zero.
pub fn write_number(out: &mut String, value: f64, decimals: usize) {
    const POWERS: [f64; 10] = [1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9];
    // Below this a scaled value is a whole number without loss.
    const MOST: f64 = 9e15;
    let scaled = POWERS.get(decimals).map_or(f64::INFINITY, |power| (value * power).round());
    if scaled.abs() < MOST {
        write_scaled(out, scaled as i64, decimals);
        return;
    }
    let start = out.len();
    let _ = write!(out, "{value:.decimals$}");
    if decimals > 0 {
        let kept = out[start..].trim_end_matches('0').trim_end_matches('.').len();
        out.truncate(start + kept);
    }
}

/// Appends a whole number divided by a power of ten: several times as fast as the general way,
/// and most of what a layer consists of.
fn write_scaled(out: &mut String, scaled: i64, decimals: usize) {
    const POWERS: [u64; 10] =
        [1, 10, 100, 1000, 10_000, 100_000, 1_000_000, 10_000_000, 100_000_000, 1_000_000_000];
    let size = scaled.unsigned_abs();
    let (whole, mut fraction) = (size / POWERS[decimals], size % POWERS[decimals]);
    let mut digits = [0u8; 32];
    let mut at = digits.len();
    let mut push = |digit: u8| {
        at -= 1;
        digits[at] = digit;
    };
    if fraction > 0 {
        let mut places = decimals;
        while fraction % 10 == 0 {
            fraction /= 10;
            places -= 1;
        }
        for _ in 0..places {
            push(b'0' + (fraction % 10) as u8);
            fraction /= 10;
        }
        push(b'.');
    }
    // Coordinates are small, and small numbers are divided faster.
    let mut rest = whole;
    while rest > u64::from(u32::MAX) {
        push(b'0' + (rest % 10) as u8);
        rest /= 10;
    }
    let mut rest = rest as u32;
    while rest >= 10 {
        push(b'0' + (rest % 10) as u8);
        rest /= 10;
    }
    push(b'0' + rest as u8);
    if scaled < 0 {
        push(b'-');
    }
    out.push_str(std::str::from_utf8(&digits[at..]).unwrap_or_default());
}

/// SVG path data in absolute commands.
pub fn path_data(path: &BezPath, decimals: usize) -> String {
    let mut out = String::new();
    write_path_data(&mut out, path, decimals);
    out
}

/// Appends SVG path data in absolute commands.
pub(crate) fn write_path_data(out: &mut String, path: &BezPath, decimals: usize) {
    for el in path.elements() {
        match *el {
            PathEl::MoveTo(p) => command(out, 'M', &[p], decimals),
            PathEl::LineTo(p) => command(out, 'L', &[p], decimals),
            PathEl::QuadTo(a, p) => command(out, 'Q', &[a, p], decimals),
            PathEl::CurveTo(a, b, p) => command(out, 'C', &[a, b, p], decimals),
            PathEl::ClosePath => out.push('Z'),
        }
    }
}

fn command(out: &mut String, letter: char, points: &[Point], decimals: usize) {
    out.push(letter);
    for (i, p) in points.iter().enumerate() {
        if i > 0 {
            out.push(' ');
        }
        write_number(out, p.x, decimals);
        out.push(',');
        write_number(out, p.y, decimals);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_fixed() {
        let show = |value, decimals| {
            let mut out = String::new();
            write_number(&mut out, value, decimals);
            out
        };
        assert_eq!(show(1.0, 3), "1");
        assert_eq!(show(-0.0001, 3), "0");
        assert_eq!(show(1.2346, 3), "1.235");
        assert_eq!(show(100.0, 0), "100");
        assert_eq!(show(1e12, 2), "1000000000000");
        assert_eq!(show(1e18, 2), "1000000000000000000");
        assert_eq!(
            (show(0.05, 3), show(-20.5, 1), show(1e-9, 9)),
            ("0.05".into(), "-20.5".into(), "0.000000001".into())
        );
        assert_eq!((show(0.0, 3), show(-0.0, 0), show(1000.0, 3)), ("0".into(), "0".into(), "1000".into()));
        assert_eq!((decimals_for(800.0), decimals_for(8.0), decimals_for(1e9)), (3, 5, 0));
    }
}
