//! Paths of a grammar.

use super::super::UNIT;
use super::super::syntax::Word;
use super::Grammar;
use super::adjust::Adjust;
use crate::error::Error;
use crate::shape::arc_to_cubics;
use kurbo::{BezPath, PathEl, Point, Vec2};

/// A path and how it is painted: filled by a rule, or stroked with a width.
pub(super) struct Painted {
    pub path: BezPath,
    pub properties: Vec<(&'static str, String)>,
    pub adjust: Adjust,
}

impl<'t> Grammar<'t> {
    /// A path: commands, and each way in which it is painted.
    pub(super) fn path(&mut self) -> Result<Vec<Painted>, Error> {
        self.words.expect("{")?;
        let (mut path, mut at, mut painted) = (BezPath::new(), Point::ORIGIN, Vec::new());
        while !self.words.take("}") {
            let command = self.command()?;
            match (command.word.text, &command.numbers[..]) {
                ("FILL", []) => {
                    let adjust = self.adjust_if_any()?;
                    let rule = command.has("EvenOdd").then(|| ("fill-rule", "evenodd".to_owned()));
                    let properties = rule.into_iter().collect();
                    painted.push(Painted { path: path.clone(), properties, adjust });
                }
                ("STROKE", width) if width.len() <= 1 => {
                    let properties = command.stroke(width.first().copied().unwrap_or(0.1) * UNIT);
                    let adjust = self.adjust_if_any()?;
                    painted.push(Painted { path: path.clone(), properties, adjust });
                }
                _ => {
                    if let Err(sentence) = command.draw(&mut path, at) {
                        return Err(self.words.error_at(command.word.start, &sentence));
                    }
                }
            }
            at = path.elements().iter().rev().find_map(PathEl::end_point).unwrap_or(at);
        }
        if painted.is_empty() && !path.is_empty() {
            painted.push(Painted { path, properties: Vec::new(), adjust: Adjust::NONE });
        }
        Ok(painted)
    }

    /// A command of a path.
    fn command(&mut self) -> Result<Command<'t>, Error> {
        let mut command = Command { word: self.words.name()?, numbers: Vec::new(), flags: Vec::new() };
        if self.words.take("(") {
            while !self.words.take(")") {
                if let Some(number) = self.words.number() {
                    command.numbers.push(number);
                } else {
                    let flag = self.words.next();
                    command
                        .flags
                        .push(flag.ok_or_else(|| self.words.unexpected("A path does not end"))?.text);
                }
            }
        }
        if !command.numbers.iter().all(|number| number.abs() < 1e6) {
            return Err(self.words.error_at(command.word.start, "A number is beyond all measure"));
        }
        Ok(command)
    }
}

/// A command of a path with what stands in its brackets.
struct Command<'t> {
    word: Word<'t>,
    numbers: Vec<f64>,
    flags: Vec<&'t str>,
}

impl Command<'_> {
    fn has(&self, flag: &str) -> bool {
        self.flags.iter().any(|known| known.strip_prefix("CF::") == Some(flag))
    }

    /// Continues a path from where it is; an error is a sentence.
    fn draw(&self, path: &mut BezPath, at: Point) -> Result<(), String> {
        let name = self.word.text;
        let from = if name.ends_with("REL") { at.to_vec2() } else { Vec2::ZERO };
        let p = |x: f64, y: f64| Point::new(x, y) + from;
        if path.is_empty() && !matches!(name, "MOVETO" | "MOVEREL") {
            path.move_to(at);
        }
        match (name, &self.numbers[..]) {
            ("MOVETO" | "MOVEREL", &[x, y]) => path.move_to(p(x, y)),
            ("LINETO" | "LINEREL", &[x, y]) => path.line_to(p(x, y)),
            ("CURVETO" | "CURVEREL", &[x, y, a, b]) => path.quad_to(p(a, b), p(x, y)),
            ("CURVETO" | "CURVEREL", &[x, y, a, b, c, d]) => path.curve_to(p(a, b), p(c, d), p(x, y)),
            ("ARCTO" | "ARCREL", &[x, y, ref radii @ ..]) => {
                let (rx, ry, turn) = match *radii {
                    [r] => (r, r, 0.0),
                    [rx, ry, turn] => (rx, ry, turn),
                    _ => return Err("An arc has one radius, or two and an angle".to_owned()),
                };
                let sweep = self.has("ArcCW") == (rx < 0.0);
                let is_large = self.has("ArcLarge");
                match arc_to_cubics(at, Vec2::new(rx, ry), turn.to_radians(), is_large, sweep, p(x, y)) {
                    Some(curves) => curves.into_iter().for_each(|[a, b, p]| path.curve_to(a, b, p)),
                    None => path.line_to(p(x, y)),
                }
            }
            ("CLOSEPOLY", []) => {
                if self.has("Align") {
                    align(path);
                }
                path.close_path();
            }
            (what, _) => {
                return Err(format!(
                    "The path command '{what}' is none that a form has, or has other numbers than it should"
                ));
            }
        }
        Ok(())
    }

    /// The properties of a stroke.
    fn stroke(&self, width: f64) -> Vec<(&'static str, String)> {
        let mut properties = vec![("fill", "none".to_owned()), ("stroke-width", width.to_string())];
        let names = [
            ("RoundCap", "stroke-linecap", "round"),
            ("SquareCap", "stroke-linecap", "square"),
            ("RoundJoin", "stroke-linejoin", "round"),
            ("BevelJoin", "stroke-linejoin", "bevel"),
        ];
        let said = names.into_iter().filter(|&(flag, ..)| self.has(flag));
        properties.extend(said.map(|(_, name, value)| (name, value.to_owned())));
        properties
    }
}

/// Moves the last point of a path to where its subpath started.
fn align(path: &mut BezPath) {
    let start = path.elements().iter().rev().find_map(|el| match el {
        PathEl::MoveTo(p) => Some(*p),
        _ => None,
    });
    if let (Some(start), Some(last)) = (start, path.elements_mut().last_mut()) {
        match last {
            PathEl::LineTo(p) | PathEl::QuadTo(_, p) | PathEl::CurveTo(_, _, p) => *p = start,
            PathEl::MoveTo(_) | PathEl::ClosePath => {}
        }
    }
}
