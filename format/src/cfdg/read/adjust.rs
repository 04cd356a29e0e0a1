//! Adjustments: how a copy lies to its original, and how its colour differs.

use super::super::syntax::Word;
use super::super::{of_corners, rgb};
use super::Grammar;
use crate::error::Error;
use kurbo::Affine;

/// How a copy differs from its original.
#[derive(Clone, Copy)]
pub(super) struct Adjust {
    pub map: Affine,
    /// Changes of hue, saturation, brightness and opacity.
    pub colour: [f64; 4],
}

impl Adjust {
    pub const NONE: Adjust = Adjust { map: Affine::IDENTITY, colour: [0.0; 4] };

    /// This one, and inside it another.
    pub fn then(self, inner: Adjust) -> Adjust {
        let [hue, s, b, a] = self.colour;
        let towards = |own: f64, by: f64| if by < 0.0 { own * (1.0 + by) } else { own + (1.0 - own) * by };
        let [dh, ds, db, da] = inner.colour;
        let opacity = towards(1.0 + a, da) - 1.0;
        Adjust { map: self.map * inner.map, colour: [hue + dh, towards(s, ds), towards(b, db), opacity] }
    }

    /// The colour that black becomes, and its opacity.
    pub fn paint(self) -> (String, f64) {
        let [hue, s, b, a] = self.colour;
        let [r, g, b] =
            rgb([hue, s.clamp(0.0, 1.0), b.clamp(0.0, 1.0)]).map(|part| (part * 255.0).round() as u8);
        (format!("#{r:02x}{g:02x}{b:02x}"), (1.0 + a).clamp(0.0, 1.0))
    }
}

impl Grammar<'_> {
    /// An adjustment: in brackets in their usual order, in double brackets (or, of old, in single ones) as
    /// written.
    pub(super) fn adjust(&mut self) -> Result<Adjust, Error> {
        let is_brace = self.words.peek() == Some("{");
        self.is_old |= is_brace;
        self.words.expect(if is_brace { "{" } else { "[" })?;
        let is_double = !is_brace && self.words.take("[");
        let is_ordered = is_double || self.is_old && !is_brace;
        let mut steps: Vec<(usize, Affine)> = Vec::new();
        let mut colour = [0.0; 4];
        while !self.words.take(if is_brace { "}" } else { "]" }) {
            let Some(word) = self.words.next() else {
                return Err(self.words.unexpected("An adjustment does not end"));
            };
            let numbers = self.adjustment_numbers(word)?;
            match step(word.text, &numbers) {
                Some(Step::Map(order, map)) if is_ordered => steps.push((order, map)),
                Some(Step::Map(order, map)) => put_in_order(&mut steps, order, map),
                Some(Step::Colour(part, by)) => colour[part] = by,
                Some(Step::Height) => {
                    self.note("Which shape lies above which is taken from their order, not from z");
                }
                None => {
                    let sentence = format!(
                        "The adjustment '{}' is none that a form has, or has other numbers than it should",
                        word.text
                    );
                    return Err(self.words.error_at(word.start, &sentence));
                }
            }
        }
        if is_double {
            self.words.expect("]")?;
        }
        let map = steps.into_iter().fold(Affine::IDENTITY, |map, (_, step)| map * step);
        Ok(Adjust { map, colour })
    }

    /// An adjustment if there is one.
    pub(super) fn adjust_if_any(&mut self) -> Result<Adjust, Error> {
        match self.words.peek() {
            Some("[" | "{") => self.adjust(),
            _ => Ok(Adjust::NONE),
        }
    }

    /// The numbers of one word of an adjustment.
    fn adjustment_numbers(&mut self, word: Word) -> Result<Vec<f64>, Error> {
        let mut numbers = Vec::new();
        while let Some(number) = self.words.number() {
            numbers.push(number);
            self.words.take(",");
        }
        if !numbers.iter().all(|number| number.abs() < 1e6) {
            return Err(self.words.error_at(word.start, "A number is beyond all measure"));
        }
        Ok(numbers)
    }
}

/// What one word of an adjustment does.
enum Step {
    /// A map, and when it is done: translation, rotation, scale, skew, flip, transform.
    Map(usize, Affine),
    /// A part of the colour, and its change.
    Colour(usize, f64),
    /// A height above the page.
    Height,
}

/// What a word of an adjustment does; nothing if it is not known with such numbers.
fn step(word: &str, numbers: &[f64]) -> Option<Step> {
    let (order, map) = match (word, numbers) {
        ("x", &[x]) => (0, Affine::translate((x, 0.0))),
        ("x", &[x, y] | &[x, y, _]) => (0, Affine::translate((x, y))),
        ("y", &[y]) => (0, Affine::translate((0.0, y))),
        ("z", &[_]) => return Some(Step::Height),
        ("rotate" | "r", &[turn]) => {
            let (sin, cos) = libm::sincos(turn.to_radians());
            (1, Affine::new([cos, sin, -sin, cos, 0.0, 0.0]))
        }
        ("size" | "s", &[s]) => (2, Affine::scale(s)),
        ("size" | "s", &[x, y] | &[x, y, _]) => (2, Affine::scale_non_uniform(x, y)),
        ("skew", &[y, x]) => (3, Affine::skew(libm::tan(y.to_radians()), libm::tan(x.to_radians()))),
        ("flip" | "f", &[angle]) => {
            let (sin, cos) = libm::sincos(2.0 * angle.to_radians());
            (4, Affine::new([cos, sin, sin, -cos, 0.0, 0.0]))
        }
        ("transform" | "trans", &[x]) => (5, Affine::translate((x, 0.0))),
        ("transform" | "trans", &[x, y]) => (5, Affine::translate((x, y))),
        ("transform" | "trans", &[x, y, u, v]) => (5, Affine::new([u - x, v - y, y - v, u - x, x, y])),
        ("transform" | "trans", &[a, b, c, d, e, f]) => (5, of_corners([a, b, c, d, e, f])),
        ("hue" | "h", &[by]) => return Some(Step::Colour(0, by)),
        ("saturation" | "sat", &[by]) if by.abs() <= 1.0 => return Some(Step::Colour(1, by)),
        ("brightness" | "b", &[by]) if by.abs() <= 1.0 => return Some(Step::Colour(2, by)),
        ("alpha" | "a", &[by]) if by.abs() <= 1.0 => return Some(Step::Colour(3, by)),
        _ => return None,
    };
    Some(Step::Map(order, map))
}

/// Puts a map among others at its place; of two of a kind the last one counts, but x and y are one
/// translation.
fn put_in_order(steps: &mut Vec<(usize, Affine)>, order: usize, map: Affine) {
    let at = steps.partition_point(|known| known.0 < order);
    match steps.get_mut(at) {
        Some((known, old)) if *known == order => {
            let (a, b) = (old.translation(), map.translation());
            let last = |a: f64, b: f64| if b == 0.0 { a } else { b };
            *old = if order == 0 { Affine::translate((last(a.x, b.x), last(a.y, b.y))) } else { map };
        }
        _ => steps.insert(at, (order, map)),
    }
}
