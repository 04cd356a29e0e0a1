//! Forms to a grammar.

use super::{UNIT, corners, hsv};
use crate::artwork::Part;
use crate::scene::{FormItem, Scene, When};
use crate::style::{FillRule, rgb};
use crate::units::mean_scale;
use kurbo::{Affine, BezPath, PathEl, Point};
use std::fmt::{self, Write};

impl Scene {
    /// The forms of a scene as a grammar of Context Free, and what it cannot say, in words. Copies go on
    /// until they are too small to be seen: a grammar has no depth.
    pub fn to_cfdg(&self) -> (String, Vec<String>) {
        let mut notes = Vec::new();
        let names: Vec<String> =
            self.forms.iter().enumerate().map(|(i, form)| name(i, &form.source.id)).collect();
        let to_grammar = Affine::scale_non_uniform(1.0 / UNIT, -1.0 / UNIT);
        let (mut paths, mut shapes) = (String::new(), String::new());
        for (index, (form, own)) in self.forms.iter().zip(&names).enumerate() {
            if !form.overrides.is_empty() {
                let set: Vec<&str> = form.overrides.keys().map(String::as_str).collect();
                notes.push(format!(
                    "'{}' sets {}, which a grammar does not have",
                    form.source.id,
                    set.join(", ")
                ));
            }
            let _ = writeln!(shapes, "shape {own} {{");
            let mut number = 0;
            for item in &form.items {
                match item {
                    FormItem::Primitive(primitive) => {
                        number += 1;
                        if primitive.when != When::AsForm {
                            notes.push(format!("'{}' draws some of its shapes in some generations only; a grammar draws them in all", form.source.id));
                        }
                        let path = format!("{own}_{number}");
                        if put_path(&mut paths, &path, &primitive.part, to_grammar, &mut notes) {
                            let _ = writeln!(shapes, "  {path} []");
                        }
                    }
                    FormItem::Clone(clone) => {
                        if clone.form == index && clone.transform.determinant().abs() >= 1.0 {
                            notes.push(format!(
                                "The clone '{}' is not smaller than its form: as a grammar it never ends",
                                clone.source.id
                            ));
                        }
                        let map = to_grammar * clone.transform * to_grammar.inverse();
                        let _ = write!(shapes, "  {} [ transform", names[clone.form]);
                        for number in corners(map) {
                            let _ = write!(shapes, " {}", Rounded(number));
                        }
                        shapes.push_str(" ]\n");
                    }
                }
            }
            shapes.push_str("}\n");
        }
        let mut out = String::from("startshape page\nshape page {\n");
        for (form, own) in self.forms.iter().zip(&names).filter(|(form, _)| form.is_root) {
            let _ = writeln!(out, "  {own} [] // {}", crate::error::printable(&form.source.label));
        }
        out.push_str("}\n");
        notes.dedup();
        (out + &shapes + &paths, notes)
    }
}

/// A name that a grammar takes.
fn name(index: usize, id: &str) -> String {
    let plain: String =
        id.chars().take(40).map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    format!("f{}_{plain}", index + 1)
}

/// A number as a grammar has it. Nothing is as small as the rounding that comes from moving points about.
struct Rounded(f64);

impl fmt::Display for Rounded {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let rounded = (self.0 * 1e12).round() / 1e12;
        // Zero has no sign.
        write!(f, "{}", rounded + 0.0)
    }
}

/// A path with its paint; false if it has none.
fn put_path(out: &mut String, name: &str, part: &Part, to_grammar: Affine, notes: &mut Vec<String>) -> bool {
    let mut fill = part.style.is_filled().then(|| part.style.get("fill").unwrap_or("#000000"));
    let mut stroke = part.style.stroke_width().and_then(|_| part.style.get("stroke"));
    for paint in [&mut fill, &mut stroke] {
        if paint.is_some_and(|paint| rgb(paint).is_none()) {
            notes.push("Gradients, patterns and colours that let light through become grey".to_owned());
            *paint = Some("#808080");
        }
    }
    if fill.is_none() && stroke.is_none() {
        return false;
    }
    let _ = writeln!(out, "path {name} {{");
    put_commands(out, &(to_grammar * part.transform * part.path.clone()));
    let opacity = |own: &str| {
        let whole = part.style.properties().find(|(name, _)| *name == "opacity");
        let parse = |text: Option<&str>| text.and_then(|text| text.parse::<f64>().ok()).unwrap_or(1.0);
        parse(whole.as_ref().map(|(_, value)| value.as_str())) * parse(part.style.get(own))
    };
    if let Some(colour) = fill {
        let rule = if part.style.fill_rule() == FillRule::EvenOdd { "(CF::EvenOdd)" } else { "" };
        let _ = writeln!(out, "  FILL{rule} [ {} ]", adjustment(colour, opacity("fill-opacity")));
    }
    if let Some(colour) = stroke {
        let width = part.style.stroke_width().unwrap_or(1.0) * mean_scale(part.transform) / UNIT;
        let cap = match part.style.get("stroke-linecap") {
            Some("round") => "CF::RoundCap",
            Some("square") => "CF::SquareCap",
            _ => "CF::ButtCap",
        };
        let join = match part.style.get("stroke-linejoin") {
            Some("round") => "CF::RoundJoin",
            Some("bevel") => "CF::BevelJoin",
            _ => "CF::MiterJoin",
        };
        let colour = adjustment(colour, opacity("stroke-opacity"));
        let _ = writeln!(out, "  STROKE({}, {cap} + {join}) [ {colour} ]", Rounded(width));
    }
    out.push_str("}\n");
    true
}

fn put_commands(out: &mut String, path: &BezPath) {
    let mut at = Point::ORIGIN;
    let n = Rounded;
    for el in path.elements() {
        let _ = match *el {
            PathEl::MoveTo(p) => writeln!(out, "  MOVETO({}, {})", n(p.x), n(p.y)),
            PathEl::LineTo(p) => writeln!(out, "  LINETO({}, {})", n(p.x), n(p.y)),
            PathEl::QuadTo(a, p) => {
                let (b, c) = (at.lerp(a, 2.0 / 3.0), p.lerp(a, 2.0 / 3.0));
                put_curve(out, b, c, p);
                Ok(())
            }
            PathEl::CurveTo(a, b, p) => {
                put_curve(out, a, b, p);
                Ok(())
            }
            PathEl::ClosePath => writeln!(out, "  CLOSEPOLY()"),
        };
        at = el.end_point().unwrap_or(at);
    }
}

fn put_curve(out: &mut String, a: Point, b: Point, p: Point) {
    let [px, py, ax, ay, bx, by] = [p.x, p.y, a.x, a.y, b.x, b.y].map(Rounded);
    let _ = writeln!(out, "  CURVETO({px}, {py}, {ax}, {ay}, {bx}, {by})");
}

/// From the black that a grammar starts with.
fn adjustment(colour: &str, opacity: f64) -> String {
    let [r, g, b] = rgb(colour).unwrap_or_default().map(|part| f64::from(part) / 255.0);
    let [hue, saturation, brightness] = hsv([r, g, b]).map(|part| (part * 1e6).round() / 1e6);
    let alpha = if opacity < 1.0 { format!(" a {}", Rounded(opacity - 1.0)) } else { String::new() };
    format!("hue {hue} sat {saturation} b {brightness}{alpha}")
}
