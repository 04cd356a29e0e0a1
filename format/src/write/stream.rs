//! The pieces of a stream, as they come. There may be millions, so that what one costs is what
//! its digits cost: points go from the form to bytes without a stop, and paths are relative,
//! which makes the numbers of small shapes short.

use super::{MATRIX_DECIMALS, SIBLINGS, Sink, Target, attribute, matrix};
use crate::artwork::{Pieces, Stream};
use crate::number::write_number;
use kurbo::{Affine, BezPath, PathEl, Point};
use std::fmt::Write;

/// Writes a stream's pieces in groups; ids start with `id`.
pub(super) fn write_stream(sink: &mut Sink, stream: &dyn Stream, id: &str, decimals: usize, target: &Target) {
    let mut writer =
        PieceWriter { sink, id, target, page: Page::new(decimals), pose: Affine::IDENTITY, count: 0 };
    stream.each(&mut writer);
    writer.end();
}

struct PieceWriter<'w, 'o> {
    sink: &'w mut Sink<'o>,
    id: &'w str,
    target: &'w Target<'w>,
    page: Page,
    /// Where the piece's own points go.
    pose: Affine,
    count: usize,
}

impl PieceWriter<'_, '_> {
    fn close(&mut self) {
        if self.count > 0 {
            self.page.bytes.extend_from_slice(b"\"/>");
        }
        if self.page.bytes.len() > Page::FULL {
            self.sink.put(&self.page.bytes);
            self.page.bytes.clear();
        }
    }

    fn end(mut self) {
        self.close();
        self.sink.put(&self.page.bytes);
        if self.count > 0 {
            let _ = write!(self.sink.text, "{}</{}g>", self.target.newline, self.target.svg_prefix);
        }
    }
}

impl Pieces for PieceWriter<'_, '_> {
    fn begin(&mut self, of: &str, transform: Affine, style: &str) {
        self.close();
        let Target { svg_prefix: prefix, newline, inverse, .. } = *self.target;
        let id = self.id;
        let mut out = String::new();
        if self.count.is_multiple_of(SIBLINGS) {
            if self.count > 0 {
                let _ = write!(out, "{newline}</{prefix}g>");
            }
            let _ = write!(out, "{newline}<{prefix}g id=\"{id}-g{}\"", self.count / SIBLINGS + 1);
            self.target.guard_group(&mut out, "");
            out.push('>');
        }
        self.count += 1;
        let _ = write!(out, "{newline}<{prefix}path id=\"{id}-");
        write_number(&mut out, self.count as f64, 0);
        out.push('"');
        attribute(&mut out, "rinceau:of", of);
        // Points are moved where that is all there is to do.
        self.pose = if transform == Affine::IDENTITY { inverse } else { Affine::IDENTITY };
        if transform != Affine::IDENTITY {
            attribute(&mut out, "transform", &matrix(inverse * transform, MATRIX_DECIMALS));
        }
        attribute(&mut out, "style", &self.target.guard.shape(style));
        out.push_str(" d=\"");
        self.page.bytes.extend_from_slice(out.as_bytes());
    }

    fn add(&mut self, path: &BezPath, pose: Affine) {
        self.page.path(path, self.pose * pose);
    }
}

/// Path data in whole steps of the last decimal.
struct Page {
    bytes: Vec<u8>,
    decimals: usize,
    power: f64,
}

/// Steps between a point and the one before.
type Step = (i64, i64);

impl Page {
    /// So many bytes are worth a write.
    const FULL: usize = 1 << 18;

    fn new(decimals: usize) -> Self {
        let decimals = decimals.min(9);
        let power = (0..decimals).fold(1.0, |power, _| power * 10.0);
        Page { bytes: Vec::with_capacity(Self::FULL + Self::FULL / 4), decimals, power }
    }

    /// The nearest whole step. Coordinates are far below what a whole number of 64 bits holds.
    fn steps(&self, p: Point) -> Step {
        let whole = |v: f64| (v * self.power + 0.5_f64.copysign(v)) as i64;
        (whole(p.x), whole(p.y))
    }

    fn path(&mut self, path: &BezPath, pose: Affine) {
        let (mut start, mut at) = ((0, 0), (0, 0));
        let mut command = b' ';
        for el in path.elements() {
            match *el {
                PathEl::MoveTo(p) => {
                    at = self.steps(pose * p);
                    start = at;
                    self.bytes.push(b'M');
                    self.pair(at, false);
                    command = b'M';
                }
                PathEl::LineTo(p) => {
                    let to = self.steps(pose * p);
                    self.relative(b'l', &mut command, at, &[to]);
                    at = to;
                }
                PathEl::QuadTo(a, p) => {
                    let (a, to) = (self.steps(pose * a), self.steps(pose * p));
                    self.relative(b'q', &mut command, at, &[a, to]);
                    at = to;
                }
                PathEl::CurveTo(a, b, p) => {
                    let (a, b, to) = (self.steps(pose * a), self.steps(pose * b), self.steps(pose * p));
                    self.relative(b'c', &mut command, at, &[a, b, to]);
                    at = to;
                }
                PathEl::ClosePath => {
                    self.bytes.push(b'z');
                    command = b'z';
                    at = start;
                }
            }
        }
    }

    fn relative(&mut self, letter: u8, command: &mut u8, at: Step, points: &[Step]) {
        let mut is_separate = *command != letter;
        if is_separate {
            self.bytes.push(letter);
            *command = letter;
        }
        for p in points {
            self.pair((p.0 - at.0, p.1 - at.1), !is_separate);
            is_separate = false;
        }
    }

    fn pair(&mut self, (x, y): Step, after_number: bool) {
        if after_number && x >= 0 {
            self.bytes.push(b' ');
        }
        self.number(x);
        if y >= 0 {
            self.bytes.push(b' ');
        }
        self.number(y);
    }

    fn number(&mut self, steps: i64) {
        // The usual ones by constant divisors.
        match self.decimals {
            2 => write_steps::<100>(&mut self.bytes, steps),
            3 => write_steps::<1000>(&mut self.bytes, steps),
            4 => write_steps::<10_000>(&mut self.bytes, steps),
            _ => {
                let mut text = String::new();
                write_number(&mut text, steps as f64 / self.power, self.decimals);
                self.bytes.extend_from_slice(text.as_bytes());
            }
        }
    }
}

/// Every number below a hundred as two digits.
const PAIRS: [[u8; 2]; 100] = {
    let mut pairs = [[b'0'; 2]; 100];
    let mut i = 0;
    while i < 100 {
        pairs[i] = [b'0' + (i / 10) as u8, b'0' + (i % 10) as u8];
        i += 1;
    }
    pairs
};

/// Appends a number of steps of one `POWER`-th: no trailing zero, and no zero before the point.
fn write_steps<const POWER: u32>(out: &mut Vec<u8>, steps: i64) {
    let Ok(size) = u32::try_from(steps.unsigned_abs()) else {
        let mut text = String::new();
        let decimals = POWER.ilog10() as usize;
        write_number(&mut text, steps as f64 / f64::from(POWER), decimals);
        out.extend_from_slice(text.as_bytes());
        return;
    };
    let (mut whole, fraction) = (size / POWER, size % POWER);
    // From its end to its start, in a register: a copy of bytes that were just stored one by one
    // has to wait for them.
    let mut text = Text::default();
    if fraction > 0 {
        // As four digits, whatever the power.
        let digits = fraction * (10_000 / POWER);
        let (high, low) = (digits / 100, digits % 100);
        match (low, low % 10, high % 10) {
            (0, _, 0) => text.digit(high / 10),
            (0, _, _) => text.pair(high),
            (_, 0, _) => {
                text.digit(low / 10);
                text.pair(high);
            }
            _ => {
                text.pair(low);
                text.pair(high);
            }
        }
        text.byte(b'.');
    }
    while whole >= 100 {
        text.pair(whole % 100);
        whole /= 100;
    }
    if whole >= 10 {
        text.pair(whole);
    } else if whole > 0 || fraction == 0 {
        text.digit(whole);
    }
    if steps < 0 {
        text.byte(b'-');
    }
    let end = out.len() + text.len;
    out.extend_from_slice(&text.bytes.to_le_bytes());
    out.truncate(end);
}

/// Up to sixteen bytes; each goes before the others.
#[derive(Default)]
struct Text {
    bytes: u128,
    len: usize,
}

impl Text {
    fn byte(&mut self, byte: u8) {
        self.bytes = self.bytes << 8 | u128::from(byte);
        self.len += 1;
    }

    fn digit(&mut self, digit: u32) {
        self.byte(b'0' + digit as u8);
    }

    fn pair(&mut self, number: u32) {
        self.bytes = self.bytes << 16 | u128::from(u16::from_le_bytes(PAIRS[number as usize]));
        self.len += 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn data(d: &str, pose: Affine, decimals: usize) -> String {
        let mut page = Page::new(decimals);
        page.path(&BezPath::from_svg(d).unwrap(), pose);
        String::from_utf8(page.bytes).unwrap()
    }

    #[test]
    fn paths_are_short_and_relative() {
        let d = "M10,20 L30,20 L30,40.5 L10,40.5 Z M1,1 C1,2 3,4 5,6 L-0.25,0";
        assert_eq!(data(d, Affine::IDENTITY, 3), "M10 20l20 0 0 20.5-20 0zM1 1c0 1 2 3 4 5l-5.25-6");
        assert_eq!(data("M0,0 Q1,2 3,4", Affine::translate((-1.0, 0.0)), 5), "M-1 0q1 2 3 4");
        assert_eq!(data("M4294967.5,0 L0,0", Affine::IDENTITY, 3), "M4294967.5 0l-4294967.5 0");
    }

    #[test]
    fn numbers_are_those_of_the_general_way() {
        for decimals in 0..=9 {
            for value in
                [0.0, 0.5, -0.5, 0.001, -0.0101, 1.0, 9.99, 10.0, 99.5, 123.456, -4096.25, 1e5, 1e9, -1e9]
            {
                let d = data(&format!("M{value},0"), Affine::IDENTITY, decimals);
                let back: f64 = d[1..].split([' ']).next().unwrap().parse().unwrap();
                let mut general = String::new();
                write_number(&mut general, value, decimals);
                assert_eq!(back, general.parse::<f64>().unwrap(), "{value} in {decimals} decimals: {d}");
            }
        }
    }
}
