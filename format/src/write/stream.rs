//! The pieces of a stream, as they come. There may be millions, so that what one costs is what
//! its digits cost: points go from the form to bytes without a stop.

use super::page::Page;
use super::record::Record;
use super::{MATRIX_DECIMALS, SIBLINGS, Sink, Target, attribute, matrix};
use crate::artwork::{Pieces, Stream};
use crate::number::write_number;
use kurbo::{Affine, BezPath, Rect};
use std::fmt::Write;

/// Writes a stream's pieces in groups; ids start with `id`.
pub(super) fn write_stream(
    sink: &mut Sink,
    stream: &dyn Stream,
    (id, decimals): (&str, usize),
    target: &Target,
    record: &mut Record,
) {
    let mut writer = PieceWriter {
        sink,
        id,
        target,
        page: Page::new(decimals),
        pose: Affine::IDENTITY,
        count: 0,
        record,
        start: 0,
        outer: Affine::IDENTITY,
        bounds: None,
        decimals,
    };
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
    record: &'w mut Record,
    /// Where the text of the piece starts on the page.
    start: usize,
    /// From the piece's coordinates to the layer's.
    outer: Affine,
    /// The box of what was added to it, in its own coordinates.
    bounds: Option<Rect>,
    decimals: usize,
}

impl PieceWriter<'_, '_> {
    fn close(&mut self) {
        if self.count > 0 {
            self.page.text(b"\"/>");
            if self.record.has_room() {
                let bounds = self.outer.transform_rect_bbox(self.bounds.unwrap_or(Rect::ZERO));
                self.record.note(&self.page.bytes()[self.start..], bounds, self.decimals);
            }
        }
        if self.page.is_full() {
            self.sink.put(self.page.bytes());
            self.page.clear();
        }
    }

    fn end(mut self) {
        self.close();
        self.sink.put(self.page.bytes());
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
        self.start = self.page.bytes().len() + out.len() + newline.len();
        self.bounds = None;
        let _ = write!(out, "{newline}<{prefix}path id=\"{id}-");
        write_number(&mut out, self.count as f64, 0);
        out.push('"');
        attribute(&mut out, "rinceau:of", of);
        // Points are moved where that is all there is to do.
        self.pose = if transform == Affine::IDENTITY { inverse } else { Affine::IDENTITY };
        self.outer = if transform == Affine::IDENTITY { Affine::IDENTITY } else { inverse * transform };
        if transform != Affine::IDENTITY {
            attribute(&mut out, "transform", &matrix(inverse * transform, MATRIX_DECIMALS));
        }
        attribute(&mut out, "style", &self.target.guard.shape(style));
        out.push_str(" d=\"");
        self.page.text(out.as_bytes());
    }

    fn add(&mut self, path: &BezPath, pose: Affine) {
        let pose = self.pose * pose;
        self.page.path(path, pose);
        if self.record.has_room() {
            let bounds = pose.transform_rect_bbox(path.control_box());
            self.bounds = Some(self.bounds.map_or(bounds, |all| all.union(bounds)));
        }
    }
}
