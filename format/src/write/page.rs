//! Path data as bytes: whole steps of the last decimal, one path after another. Most of a large layer
//! consists of its numbers, so that they are looked up, not computed.

use crate::number::write_number;
use kurbo::{Affine, BezPath, PathEl, Point};

/// Path data in whole steps of the last decimal.
pub(super) struct Page {
    /// What is written, and room for more.
    room: Vec<u8>,
    /// So many bytes of it are written.
    len: usize,
    decimals: usize,
    power: f64,
    digits: Option<Digits>,
}

/// Steps between a point and the one before.
type Step = (i64, i64);

impl Page {
    /// So many bytes are worth a write.
    const FULL: usize = 1 << 18;
    /// Bytes that one element of a path takes at most: a letter, and six numbers of 64 bits.
    const ELEMENT: usize = 192;

    pub fn new(decimals: usize) -> Self {
        let decimals = decimals.min(9);
        let power = (0..decimals).fold(1.0, |power, _| power * 10.0);
        Page { room: Vec::new(), len: 0, decimals, power, digits: Digits::new(decimals) }
    }

    /// What is written.
    pub fn bytes(&self) -> &[u8] {
        &self.room[..self.len]
    }

    /// True if it is worth a write.
    pub fn is_full(&self) -> bool {
        self.len > Self::FULL
    }

    pub fn clear(&mut self) {
        self.len = 0;
    }

    /// Appends text.
    pub fn text(&mut self, text: &[u8]) {
        self.reserve(text.len());
        self.room[self.len..self.len + text.len()].copy_from_slice(text);
        self.len += text.len();
    }

    fn reserve(&mut self, more: usize) {
        let needed = self.len + more;
        if self.room.len() < needed {
            self.room.resize(needed.max(Self::FULL + Self::FULL / 4), 0);
        }
    }

    /// The nearest whole step. Coordinates are far below what a whole number of 64 bits holds.
    fn steps(&self, p: Point) -> Step {
        let whole = |v: f64| (v * self.power + 0.5_f64.copysign(v)) as i64;
        (whole(p.x), whole(p.y))
    }

    /// Appends a path; all but its first points are relative, which makes the numbers of small
    /// shapes short.
    pub fn path(&mut self, path: &BezPath, pose: Affine) {
        self.reserve(path.elements().len() * Self::ELEMENT);
        let (mut start, mut at) = ((0, 0), (0, 0));
        let mut command = b' ';
        for el in path.elements() {
            match *el {
                PathEl::MoveTo(p) => {
                    at = self.steps(pose * p);
                    start = at;
                    self.byte(b'M');
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
                    self.byte(b'z');
                    command = b'z';
                    at = start;
                }
            }
        }
    }

    fn relative(&mut self, letter: u8, command: &mut u8, at: Step, points: &[Step]) {
        let mut is_separate = *command != letter;
        if is_separate {
            self.byte(letter);
            *command = letter;
        }
        for p in points {
            self.pair((p.0 - at.0, p.1 - at.1), !is_separate);
            is_separate = false;
        }
    }

    fn pair(&mut self, (x, y): Step, after_number: bool) {
        self.number(x, after_number);
        self.number(y, true);
    }

    fn byte(&mut self, byte: u8) {
        self.room[self.len] = byte;
        self.len += 1;
    }

    /// Appends a number, apart from another before it.
    #[inline]
    fn number(&mut self, steps: i64, after_number: bool) {
        // One byte either way, kept if there is something to say.
        self.room[self.len] = if steps < 0 { b'-' } else { b' ' };
        self.len += usize::from(after_number | (steps < 0));
        let size = steps.unsigned_abs();
        match &self.digits {
            Some(digits) if size < digits.end => {
                let (whole, fraction) = digits.texts(size as u32);
                self.word(whole);
                self.word(fraction);
            }
            _ => self.long_number(size),
        }
    }

    /// Appends what the tables do not hold.
    #[cold]
    #[inline(never)]
    fn long_number(&mut self, size: u64) {
        let mut text = String::new();
        write_number(&mut text, size as f64 / self.power, self.decimals);
        self.text(text.as_bytes());
    }

    /// Appends up to seven bytes; the eighth says how many.
    fn word(&mut self, word: u64) {
        self.room[self.len..self.len + 8].copy_from_slice(&word.to_le_bytes());
        self.len += (word >> 56) as usize;
    }
}

/// Numbers below a thousand as text: what is before the point, and what is after it.
struct Digits {
    decimals: usize,
    whole: Vec<u64>,
    fraction: Vec<u64>,
    /// Steps that are too many for the tables.
    end: u64,
}

impl Digits {
    const WHOLE: u32 = 1000;

    /// Tables for so many decimals, if they are few enough.
    fn new(decimals: usize) -> Option<Self> {
        if !(2..=4).contains(&decimals) {
            return None;
        }
        let power = 10_u32.pow(decimals as u32);
        let word = |text: &str| {
            let bytes = text.bytes().rev().fold(0, |word, byte| word << 8 | u64::from(byte));
            bytes | (text.len() as u64) << 56
        };
        // No zero before the point, unless nothing follows; and none at the end.
        let whole = (0..Self::WHOLE).map(|n| if n == 0 { 0 } else { word(&n.to_string()) });
        let after = |n: u32| word(format!(".{n:0decimals$}").trim_end_matches('0').trim_end_matches('.'));
        let end = u64::from(Self::WHOLE * power);
        Some(Digits { decimals, whole: whole.collect(), fraction: (0..power).map(after).collect(), end })
    }

    /// The two halves of a number of steps.
    fn texts(&self, steps: u32) -> (u64, u64) {
        // By constant divisors, which cost a multiplication.
        let (whole, fraction) = match self.decimals {
            2 => (steps / 100, steps % 100),
            3 => (steps / 1000, steps % 1000),
            _ => (steps / 10_000, steps % 10_000),
        };
        if steps == 0 {
            return (u64::from(b'0') | 1 << 56, 0);
        }
        (self.whole[whole as usize], self.fraction[fraction as usize])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn data(d: &str, pose: Affine, decimals: usize) -> String {
        let mut page = Page::new(decimals);
        page.path(&BezPath::from_svg(d).unwrap(), pose);
        String::from_utf8(page.bytes().to_vec()).unwrap()
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
            for value in [
                0.0, 0.5, -0.5, 0.001, -0.0101, 1.0, 9.99, 10.0, 99.5, 123.456, 999.9999, -4096.25, 1e5, 1e9,
                -1e9,
            ] {
                let d = data(&format!("M{value},0"), Affine::IDENTITY, decimals);
                let back: f64 = d[1..].split([' ']).next().unwrap().parse().unwrap();
                let mut general = String::new();
                write_number(&mut general, value, decimals);
                assert_eq!(back, general.parse::<f64>().unwrap(), "{value} in {decimals} decimals: {d}");
            }
        }
    }

    #[test]
    fn long_paths_have_room() {
        let mut d = String::from("M-9007199.2547,0");
        for i in 0..5000 {
            d += &format!("C{i},-9007199.2 9007199.5,{i} -9007199.1,9007199");
        }
        let path = BezPath::from_svg(&d).unwrap();
        let back = BezPath::from_svg(&data(&d, Affine::IDENTITY, 9)).unwrap();
        assert_eq!(back.elements().len(), path.elements().len());
    }
}
