//! A grammar to forms.

use super::syntax::{Word, Words};
use super::{UNIT, of_corners, rgb};
use crate::artwork::Part;
use crate::error::Error;
use crate::read::set_roots;
use crate::scene::{Container, Form, FormItem, Outline, Primitive, Replication, Scene, Source, When};
use crate::shape::arc_to_cubics;
use crate::style::{FillRule, Style};
use kurbo::{Affine, BezPath, PathEl, Point, Rect, Shape, Vec2};
use std::collections::{BTreeMap, HashMap};

/// Steps of loops, and pieces of a grammar, at most.
const MOST_PIECES: usize = 20_000;
/// Loops in loops at most.
const DEEPEST: usize = 50;
/// A longer text is no grammar that anybody wrote.
const LONGEST: usize = 4 << 20;

/// What a piece of a shape is.
enum Piece<'t> {
    Shape(Word<'t>),
    Loop(usize, Adjust, Vec<(Piece<'t>, Adjust)>),
}

/// How a copy differs from its original.
#[derive(Clone, Copy)]
struct Adjust {
    map: Affine,
    /// Changes of hue, saturation, brightness and opacity.
    colour: [f64; 4],
}

impl Adjust {
    const NONE: Adjust = Adjust { map: Affine::IDENTITY, colour: [0.0; 4] };

    /// This one, and inside it another.
    fn then(self, inner: Adjust) -> Adjust {
        let [hue, s, b, a] = self.colour;
        let towards = |own: f64, by: f64| if by < 0.0 { own * (1.0 + by) } else { own + (1.0 - own) * by };
        let [dh, ds, db, da] = inner.colour;
        let opacity = towards(1.0 + a, da) - 1.0;
        Adjust { map: self.map * inner.map, colour: [hue + dh, towards(s, ds), towards(b, db), opacity] }
    }

    /// The colour that black becomes, and its opacity.
    fn paint(self) -> (String, f64) {
        let [hue, s, b, a] = self.colour;
        let [r, g, b] =
            rgb([hue, s.clamp(0.0, 1.0), b.clamp(0.0, 1.0)]).map(|part| (part * 255.0).round() as u8);
        (format!("#{r:02x}{g:02x}{b:02x}"), (1.0 + a).clamp(0.0, 1.0))
    }
}

/// A path and how it is painted: filled by a rule, or stroked with a width.
struct Painted {
    path: BezPath,
    properties: Vec<(&'static str, String)>,
    adjust: Adjust,
}

impl Scene {
    /// Forms of a grammar of Context Free, each beside the other, and what of it they cannot say.
    ///
    /// Errors: a grammar with chance, parameters or conditions, or one that cannot be read; with its place.
    pub fn from_cfdg(text: &str) -> Result<(Self, Vec<String>), Error> {
        if text.len() > LONGEST {
            let sentence = format!("The grammar is larger than {} MiB", LONGEST >> 20);
            return Err(Error::new("too-large", sentence, "Take out what is not needed"));
        }
        let mut grammar = Grammar { words: Words::new(text)?, ..Grammar::new() };
        grammar.all()?;
        grammar.scene()
    }
}

/// A grammar while it is read.
struct Grammar<'t> {
    words: Words<'t>,
    start: Option<(Word<'t>, Adjust)>,
    shapes: Vec<(Word<'t>, Vec<(Piece<'t>, Adjust)>)>,
    paths: HashMap<&'t str, Vec<Painted>>,
    /// True for a grammar of version 2, which `rule` and braces around adjustments tell.
    is_old: bool,
    pieces: usize,
    notes: Vec<String>,
}

impl<'t> Grammar<'t> {
    fn new() -> Self {
        Grammar {
            words: Words::empty(),
            start: None,
            shapes: Vec::new(),
            paths: HashMap::new(),
            is_old: false,
            pieces: 0,
            notes: Vec::new(),
        }
    }

    fn note(&mut self, note: &str) {
        if !self.notes.iter().any(|known| known == note) {
            self.notes.push(note.to_owned());
        }
    }

    fn all(&mut self) -> Result<(), Error> {
        while let Some(word) = self.words.peek() {
            match word {
                "startshape" => {
                    self.words.next();
                    let name = self.words.name()?;
                    let adjust = match self.words.peek() {
                        Some("[" | "{") => self.adjust()?,
                        _ => Adjust::NONE,
                    };
                    self.start = Some((name, adjust));
                }
                "shape" | "rule" => {
                    self.is_old |= word == "rule";
                    self.words.next();
                    let name = self.words.name()?;
                    if self.words.peek() == Some("(") {
                        return Err(self.words.unexpected("A shape has parameters, which a form has not"));
                    }
                    if self.shapes.iter().any(|(known, _)| known.text == name.text)
                        || self.words.number().is_some()
                    {
                        let sentence = format!(
                            "'{}' has several rules: which one is taken is chance, and a form has none",
                            name.text
                        );
                        return Err(self.words.error_at(name.start, &sentence));
                    }
                    let content = self.block(0)?;
                    self.shapes.push((name, content));
                }
                "path" => {
                    self.words.next();
                    let name = self.words.name()?;
                    let painted = self.path()?;
                    self.paths.insert(name.text, painted);
                }
                "import" | "include" => {
                    return Err(self
                        .words
                        .unexpected("A grammar that takes in other files is not followed there"));
                }
                word if word.starts_with("CF::")
                    || matches!(word, "background" | "tile" | "size" | "time") =>
                {
                    self.note("Settings of the grammar (background, tiling and the like) are left out");
                    self.words.next();
                    self.words.take("=");
                    self.words.skip();
                }
                _ => return Err(self.words.unexpected(&format!("'{word}' begins nothing that a form has"))),
            }
        }
        Ok(())
    }

    /// The pieces between braces.
    fn block(&mut self, depth: usize) -> Result<Vec<(Piece<'t>, Adjust)>, Error> {
        self.words.expect("{")?;
        let mut pieces = Vec::new();
        while !self.words.take("}") {
            self.pieces += 1;
            if self.pieces > MOST_PIECES || depth > DEEPEST {
                return Err(self.words.unexpected("The grammar has too many pieces"));
            }
            pieces.push(self.item(depth)?);
        }
        Ok(pieces)
    }

    /// A shape, or a loop.
    fn item(&mut self, depth: usize) -> Result<(Piece<'t>, Adjust), Error> {
        if depth > DEEPEST {
            return Err(self.words.unexpected("The grammar has too many pieces"));
        }
        let is_loop = self.words.take("loop");
        let Some(count) = self.words.number() else {
            if is_loop {
                return Err(self.words.unexpected("A loop goes round a number of times"));
            }
            return self.piece();
        };
        if !is_loop {
            self.words.expect("*")?;
        }
        if !(0.0..=f64::MAX).contains(&count) || count.fract() != 0.0 {
            return Err(self.words.unexpected("A loop goes round a whole number of times"));
        }
        if count > MOST_PIECES as f64 {
            return Err(self.words.unexpected(&format!("A loop goes round {MOST_PIECES} times at most")));
        }
        let each = self.adjust()?;
        let inside = match self.words.peek() {
            Some("{") => self.block(depth + 1)?,
            _ => vec![self.item(depth + 1)?],
        };
        Ok((Piece::Loop(count as usize, each, inside), Adjust::NONE))
    }

    /// A shape with its adjustment.
    fn piece(&mut self) -> Result<(Piece<'t>, Adjust), Error> {
        if let Some(word @ ("if" | "else" | "switch" | "finally" | "transform" | "clone" | "let")) =
            self.words.peek()
        {
            return Err(self.words.unexpected(&format!("'{word}' is nothing that a form has")));
        }
        let name = self.words.name()?;
        if self.words.peek() == Some("(") {
            return Err(self.words.unexpected("A shape has parameters, which a form has not"));
        }
        let adjust = self.adjust()?;
        Ok((Piece::Shape(name), adjust))
    }

    /// An adjustment: in brackets in their usual order, in double brackets (or, of old, in single ones) as
    /// written.
    fn adjust(&mut self) -> Result<Adjust, Error> {
        let is_brace = self.words.peek() == Some("{");
        self.is_old |= is_brace;
        if !is_brace {
            self.words.expect("[")?;
        } else {
            self.words.next();
        }
        let is_double = !is_brace && self.words.take("[");
        let is_ordered = is_double || self.is_old && !is_brace;
        let close = if is_brace { "}" } else { "]" };
        // Translation, rotation, scale, skew, flip, transform.
        let mut steps: Vec<(usize, Affine)> = Vec::new();
        let mut colour = [0.0; 4];
        while !self.words.take(close) {
            let Some(word) = self.words.next() else {
                return Err(self.words.unexpected("An adjustment does not end"));
            };
            let mut numbers = Vec::new();
            while let Some(number) = self.words.number() {
                numbers.push(number);
                self.words.take(",");
            }
            if !numbers.iter().all(|number| number.abs() < 1e6) {
                return Err(self.words.error_at(word.start, "A number is beyond all measure"));
            }
            let step = match (word.text, &numbers[..]) {
                ("x", &[x]) => (0, Affine::translate((x, 0.0))),
                ("x", &[x, y] | &[x, y, _]) => (0, Affine::translate((x, y))),
                ("y", &[y]) => (0, Affine::translate((0.0, y))),
                ("z", &[_]) => {
                    self.note("Which shape lies above which is taken from their order, not from z");
                    continue;
                }
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
                ("transform" | "trans", &[x, y, u, v]) => {
                    (5, Affine::new([u - x, v - y, y - v, u - x, x, y]))
                }
                ("transform" | "trans", &[a, b, c, d, e, f]) => (5, of_corners([a, b, c, d, e, f])),
                ("hue" | "h", &[by]) => {
                    colour[0] = by;
                    continue;
                }
                ("saturation" | "sat", &[by]) if by.abs() <= 1.0 => {
                    colour[1] = by;
                    continue;
                }
                ("brightness" | "b", &[by]) if by.abs() <= 1.0 => {
                    colour[2] = by;
                    continue;
                }
                ("alpha" | "a", &[by]) if by.abs() <= 1.0 => {
                    colour[3] = by;
                    continue;
                }
                (what, _) => {
                    let sentence = format!(
                        "The adjustment '{what}' is none that a form has, or has other numbers than it should"
                    );
                    return Err(self.words.error_at(word.start, &sentence));
                }
            };
            match steps.iter_mut().find(|known| known.0 == step.0 && !is_ordered) {
                // x and y are one translation; of others the last one counts.
                Some(known) if step.0 == 0 => {
                    let (a, b) = (known.1.translation(), step.1.translation());
                    let last = |a: f64, b: f64| if b == 0.0 { a } else { b };
                    known.1 = Affine::translate(Vec2::new(last(a.x, b.x), last(a.y, b.y)));
                }
                Some(known) => *known = step,
                None => steps.push(step),
            }
        }
        if is_double {
            self.words.expect("]")?;
        }
        if !is_ordered {
            steps.sort_by_key(|step| step.0);
        }
        let map = steps.into_iter().fold(Affine::IDENTITY, |map, (_, step)| map * step);
        Ok(Adjust { map, colour })
    }

    /// A path: commands, and each way in which it is painted.
    fn path(&mut self) -> Result<Vec<Painted>, Error> {
        self.words.expect("{")?;
        let (mut path, mut at, mut painted) = (BezPath::new(), Point::ORIGIN, Vec::new());
        while !self.words.take("}") {
            let command = self.words.name()?;
            let (mut numbers, mut flags) = (Vec::new(), Vec::new());
            if self.words.take("(") {
                while !self.words.take(")") {
                    match self.words.number() {
                        Some(number) => numbers.push(number),
                        None => flags.push(
                            self.words
                                .next()
                                .ok_or_else(|| self.words.unexpected("A path does not end"))?
                                .text,
                        ),
                    }
                }
            }
            if !numbers.iter().all(|number| number.abs() < 1e6) {
                return Err(self.words.error_at(command.start, "A number is beyond all measure"));
            }
            let from = if command.text.ends_with("REL") { at.to_vec2() } else { Vec2::ZERO };
            let p = |x: f64, y: f64| Point::new(x, y) + from;
            if path.is_empty() && !matches!(command.text, "MOVETO" | "MOVEREL" | "FILL" | "STROKE") {
                path.move_to(at);
            }
            match (command.text, &numbers[..]) {
                ("MOVETO" | "MOVEREL", &[x, y]) => path.move_to(p(x, y)),
                ("LINETO" | "LINEREL", &[x, y]) => path.line_to(p(x, y)),
                ("CURVETO" | "CURVEREL", &[x, y, a, b]) => path.quad_to(p(a, b), p(x, y)),
                ("CURVETO" | "CURVEREL", &[x, y, a, b, c, d]) => path.curve_to(p(a, b), p(c, d), p(x, y)),
                ("ARCTO" | "ARCREL", &[x, y, ref radii @ ..]) => {
                    let (rx, ry, turn) = match *radii {
                        [r] => (r, r, 0.0),
                        [rx, ry, turn] => (rx, ry, turn),
                        _ => {
                            return Err(self
                                .words
                                .error_at(command.start, "An arc has one radius, or two and an angle"));
                        }
                    };
                    let sweep = flags.contains(&"CF::ArcCW") == (rx < 0.0);
                    let is_large = flags.contains(&"CF::ArcLarge");
                    match arc_to_cubics(at, Vec2::new(rx, ry), turn.to_radians(), is_large, sweep, p(x, y)) {
                        Some(curves) => curves.into_iter().for_each(|[a, b, p]| path.curve_to(a, b, p)),
                        None => path.line_to(p(x, y)),
                    }
                }
                ("CLOSEPOLY", []) => {
                    if flags.contains(&"CF::Align") {
                        align(&mut path);
                    }
                    path.close_path();
                }
                ("FILL", []) => {
                    let adjust = self.painted_with()?;
                    let rule = flags.contains(&"CF::EvenOdd").then(|| ("fill-rule", "evenodd".to_owned()));
                    let properties = rule.into_iter().collect();
                    painted.push(Painted { path: path.clone(), properties, adjust });
                }
                ("STROKE", width) if width.len() <= 1 => {
                    let adjust = self.painted_with()?;
                    let width = width.first().copied().unwrap_or(0.1) * UNIT;
                    let mut properties =
                        vec![("fill", "none".to_owned()), ("stroke-width", width.to_string())];
                    let names = [
                        ("RoundCap", "stroke-linecap", "round"),
                        ("SquareCap", "stroke-linecap", "square"),
                        ("RoundJoin", "stroke-linejoin", "round"),
                        ("BevelJoin", "stroke-linejoin", "bevel"),
                    ];
                    for (flag, name, value) in names {
                        if flags.iter().any(|known| known.strip_prefix("CF::") == Some(flag)) {
                            properties.push((name, value.to_owned()));
                        }
                    }
                    painted.push(Painted { path: path.clone(), properties, adjust });
                }
                (what, _) => {
                    let sentence = format!(
                        "The path command '{what}' is none that a form has, or has other numbers than it should"
                    );
                    return Err(self.words.error_at(command.start, &sentence));
                }
            }
            at = path.elements().iter().rev().find_map(kurbo::PathEl::end_point).unwrap_or(at);
        }
        if painted.is_empty() && !path.is_empty() {
            painted.push(Painted { path, properties: Vec::new(), adjust: Adjust::NONE });
        }
        Ok(painted)
    }

    fn painted_with(&mut self) -> Result<Adjust, Error> {
        match self.words.peek() {
            Some("[" | "{") => self.adjust(),
            _ => Ok(Adjust::NONE),
        }
    }

    fn scene(mut self) -> Result<(Scene, Vec<String>), Error> {
        let Some((start, start_by)) = self.start else {
            return Err(self.words.error_at(0, "The grammar has no startshape"));
        };
        let shapes = std::mem::take(&mut self.shapes);
        let index: HashMap<&str, usize> =
            shapes.iter().enumerate().map(|(i, (name, _))| (name.text, i)).collect();
        let Some(&first) = index.get(start.text) else {
            let sentence = format!("There is no shape '{}' to start with", start.text);
            return Err(self.words.error_at(start.start, &sentence));
        };
        if start_by.map != Affine::IDENTITY || start_by.colour != [0.0; 4] {
            self.note("How the first shape lies is left out: move and turn the result");
        }
        let mut forms: Vec<Form> = Vec::new();
        for (name, pieces) in &shapes {
            let source = source(name.text);
            let mut form = Form { source, is_root: false, items: Vec::new(), overrides: BTreeMap::new() };
            self.pieces = 0;
            self.put(pieces, Adjust::NONE, &index, &mut form)?;
            forms.push(form);
        }
        // The first is the one to be drawn.
        forms.swap(0, first);
        let renamed = |form: usize| {
            if form == first {
                0
            } else if form == 0 {
                first
            } else {
                form
            }
        };
        for clone in forms.iter_mut().flat_map(|form| &mut form.items) {
            if let FormItem::Clone(clone) = clone {
                clone.form = renamed(clone.form);
            }
        }
        let (view, frame) = spread(&mut forms);
        set_roots(&mut forms);
        let outline = Outline { path: frame.to_path(0.1), rule: FillRule::NonZero };
        let frame = Container {
            source: source("frame"),
            outlines: vec![outline],
            fill: None,
            overrides: BTreeMap::new(),
        };
        let scene = Scene { view, px_per_unit: 1.0, containers: vec![frame], forms, ..Scene::default() };
        Ok((scene, self.notes))
    }

    /// Puts pieces into a form.
    fn put(
        &mut self,
        pieces: &[(Piece<'t>, Adjust)],
        by: Adjust,
        index: &HashMap<&str, usize>,
        form: &mut Form,
    ) -> Result<(), Error> {
        for (piece, own) in pieces {
            let by = by.then(*own);
            match piece {
                Piece::Loop(count, each, inside) => {
                    let mut by = by;
                    for _ in 0..*count {
                        self.put(inside, by, index, form)?;
                        by = by.then(*each);
                    }
                }
                Piece::Shape(name) => {
                    self.pieces += 1;
                    if self.pieces > MOST_PIECES || !by.map.is_finite() {
                        return Err(self
                            .words
                            .error_at(name.start, "Loops make too many pieces, or endless ones"));
                    }
                    self.put_shape(*name, by, index, form)?;
                }
            }
        }
        Ok(())
    }

    fn put_shape(
        &mut self,
        name: Word<'t>,
        by: Adjust,
        index: &HashMap<&str, usize>,
        form: &mut Form,
    ) -> Result<(), Error> {
        let to_page = Affine::scale_non_uniform(UNIT, -UNIT);
        let primitive = |path: &BezPath, properties: &[(&'static str, String)], by: Adjust| {
            let (paint, opacity) = by.paint();
            let mut style = Style::filled(&paint);
            for (name, value) in properties {
                style.set(name, value);
            }
            if style.get("fill") == Some("none") {
                style.set("stroke", &paint);
            }
            if opacity < 1.0 {
                style.set(
                    if style.is_filled() { "fill-opacity" } else { "stroke-opacity" },
                    &opacity.to_string(),
                );
            }
            let mut path = path.clone();
            path.apply_affine(to_page);
            let transform = to_page * by.map * to_page.inverse();
            let part = Part { path, transform, style };
            FormItem::Primitive(Primitive { part, when: When::AsForm, live: None })
        };
        if let Some(&target) = index.get(name.text) {
            if by.colour != [0.0; 4] {
                self.note(
                    "Colours that change from copy to copy are left out: recurse has colours by generation",
                );
            }
            let transform = to_page * by.map * to_page.inverse();
            if !transform.inverse().is_finite() {
                return Err(self.words.error_at(name.start, "A copy is scaled to nothing"));
            }
            let source = source(&format!("{}-{}", form.source.id, form.items.len() + 1));
            form.items.push(FormItem::Clone(Replication { source, form: target, transform }));
            return Ok(());
        }
        if let Some(painted) = self.paths.get(name.text) {
            let items: Vec<FormItem> = painted
                .iter()
                .map(|one| {
                    primitive(
                        &one.path,
                        &one.properties,
                        Adjust { map: by.map, ..by.then(Adjust { map: Affine::IDENTITY, ..one.adjust }) },
                    )
                })
                .collect();
            form.items.extend(items);
            return Ok(());
        }
        let path = match name.text {
            "SQUARE" => Rect::new(-0.5, -0.5, 0.5, 0.5).to_path(0.1),
            "CIRCLE" => kurbo::Circle::new((0.0, 0.0), 0.5).to_path(1e-6),
            "TRIANGLE" => {
                let rise = 3.0_f64.sqrt() / 3.0;
                let mut path = BezPath::new();
                path.move_to((0.0, rise));
                path.line_to((-0.5, -0.5 * rise));
                path.line_to((0.5, -0.5 * rise));
                path.close_path();
                path
            }
            other => {
                let sentence = format!("There is no shape '{other}'");
                return Err(self.words.error_at(name.start, &sentence));
            }
        };
        form.items.push(primitive(&path, &[], by));
        Ok(())
    }
}

fn source(name: &str) -> Source {
    Source { id: name.to_owned(), label: name.to_owned(), at: crate::error::Position::default() }
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

/// Lays forms beside each other on a page, above a frame to be drawn in; both are returned.
fn spread(forms: &mut [Form]) -> (Rect, Rect) {
    const GAP: f64 = 0.5 * UNIT;
    const FRAME: f64 = 8.0 * UNIT;
    let bounds = |form: &Form| {
        let boxes = form.items.iter().filter_map(|item| match item {
            FormItem::Primitive(primitive) => {
                Some(primitive.part.transform.transform_rect_bbox(primitive.part.path.bounding_box()))
            }
            FormItem::Clone(_) => None,
        });
        boxes.reduce(|a, b| a.union(b)).unwrap_or(Rect::new(0.0, 0.0, UNIT, UNIT))
    };
    let boxes: Vec<Rect> = forms.iter().map(bounds).collect();
    let mut x = GAP;
    let mut shifts = Vec::new();
    for bounds in &boxes {
        shifts.push(Affine::translate((x - bounds.x0, GAP - bounds.y0)));
        x += bounds.width() + GAP;
    }
    for (form, &shift) in forms.iter_mut().zip(&shifts) {
        for item in &mut form.items {
            match item {
                FormItem::Primitive(primitive) => {
                    primitive.part.transform = shift * primitive.part.transform;
                }
                FormItem::Clone(clone) => {
                    clone.transform = shift * clone.transform * shifts[clone.form].inverse();
                }
            }
        }
    }
    let tallest = boxes.iter().map(Rect::height).fold(0.0, f64::max);
    let top = tallest + 2.0 * GAP;
    let frame = Rect::new(GAP, top, GAP + FRAME, top + FRAME);
    (Rect::new(0.0, 0.0, x.max(frame.x1 + GAP), frame.y1 + GAP), frame)
}
