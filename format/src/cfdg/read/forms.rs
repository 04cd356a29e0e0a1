//! The shapes of a grammar as forms.

use super::super::UNIT;
use super::super::syntax::Word;
use super::adjust::Adjust;
use super::{Grammar, MOST_PIECES, Piece};
use crate::artwork::Part;
use crate::error::{Error, Position};
use crate::read::set_roots;
use crate::scene::{Container, Form, FormItem, Outline, Primitive, Replication, Scene, Source, When};
use crate::style::{FillRule, Style};
use kurbo::{Affine, BezPath, Circle, Rect, Shape};
use std::collections::{BTreeMap, HashMap};

impl<'t> Grammar<'t> {
    /// The forms, and what of the grammar they cannot say.
    pub(super) fn scene(mut self) -> Result<(Scene, Vec<String>), Error> {
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
            "CIRCLE" => Circle::new((0.0, 0.0), 0.5).to_path(1e-6),
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
    Source { id: name.to_owned(), label: name.to_owned(), at: Position::default() }
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
