//! Artwork to a result layer.

mod page;
pub(crate) mod record;
pub(crate) mod scene;
mod stream;

use crate::artwork::{Artwork, Group, Item, Part, Symbol, SymbolItem};
use crate::number::{write_number, write_path_data};
use crate::recipe::Recipe;
use crate::style::Guard;
use crate::vocabulary::{INKSCAPE, NAMESPACE, SODIPODI, SVG, XLINK};
use kurbo::{Affine, Rect};
use record::Record;
use std::borrow::Cow;
use std::fmt::Write;
use std::io;

/// Inkscape's merge of an extension's result is quadratic in siblings, so they come in groups.
const SIBLINGS: usize = 200;

/// Where and how a layer is written.
pub(crate) struct Target<'a> {
    /// Id of the layer; ids of its content start with it.
    pub id: &'a str,
    /// Prefix of SVG elements with its colon, or empty.
    pub svg_prefix: &'a str,
    /// True if the drawing has the SVG namespace at all.
    pub has_namespace: bool,
    /// From root units to the layer's own coordinates.
    pub inverse: Affine,
    /// True if the root was an empty element, which it has to become again without the layer.
    pub in_empty_root: bool,
    /// The line end of the drawing.
    pub newline: &'a str,
    /// Against the drawing's style sheets.
    pub guard: &'a Guard,
}

impl Target<'_> {
    /// The attributes of a group or clone that keep rules off.
    fn guard_group(&self, out: &mut String, css: &str) {
        let css = self.guard.group(css);
        if !css.is_empty() {
            attribute(out, "style", &css);
        }
    }
}

/// Where text goes: into memory, or out as soon as there is some.
#[derive(Default)]
pub(crate) struct Sink<'a> {
    pub text: String,
    out: Option<&'a mut dyn io::Write>,
    failed: Option<io::Error>,
}

impl<'a> Sink<'a> {
    /// One that passes on what it gets.
    pub fn to(out: &'a mut dyn io::Write) -> Self {
        Sink { text: String::new(), out: Some(out), failed: None }
    }

    /// Passes on what there is, if it is worth it.
    pub fn flush_some(&mut self) {
        const SOME: usize = 1 << 16;
        if self.text.len() >= SOME {
            self.flush();
        }
    }

    /// Adds text as bytes, behind what there is.
    fn put(&mut self, bytes: &[u8]) {
        if self.out.is_none() {
            self.text.push_str(&String::from_utf8_lossy(bytes));
            return;
        }
        self.flush();
        if let (Some(out), None) = (self.out.as_mut(), &self.failed) {
            self.failed = out.write_all(bytes).err();
        }
    }

    /// Adds text, behind what there is; much of it goes out without a copy.
    pub fn put_text(&mut self, text: &str) {
        const MUCH: usize = 1 << 16;
        if text.len() < MUCH || self.out.is_none() {
            self.text.push_str(text);
        } else {
            self.put(text.as_bytes());
        }
    }

    fn flush(&mut self) {
        let Some(out) = self.out.as_mut() else { return };
        if self.failed.is_none() {
            self.failed = out.write_all(self.text.as_bytes()).err();
        }
        self.text.clear();
    }

    /// Passes on the rest.
    ///
    /// Errors: the first that there was.
    pub fn finish(mut self) -> io::Result<()> {
        self.flush();
        self.failed.map_or(Ok(()), Err)
    }
}

/// The start tag of a layer. It declares its own namespaces, so that nothing outside it has
/// to change, and taking it out leaves the drawing as it was.
pub(crate) fn open_layer(recipe: &Recipe, target: &Target) -> String {
    let mut out = String::new();
    let prefix = target.svg_prefix;
    let _ = write!(out, "<{prefix}g");
    if target.has_namespace {
        let name = if prefix.is_empty() {
            "xmlns".to_owned()
        } else {
            format!("xmlns:{}", prefix.trim_end_matches(':'))
        };
        attribute(&mut out, &name, SVG);
    }
    attribute(&mut out, "xmlns:inkscape", INKSCAPE);
    attribute(&mut out, "xmlns:sodipodi", SODIPODI);
    attribute(&mut out, "xmlns:rinceau", NAMESPACE);
    attribute(&mut out, "id", target.id);
    attribute(&mut out, "inkscape:groupmode", "layer");
    attribute(&mut out, "inkscape:label", &recipe.label);
    recipe_attributes(&mut out, recipe, "rinceau");
    if target.in_empty_root {
        attribute(&mut out, "rinceau:root", "empty");
    }
    out.push('>');
    out
}

/// ` rinceau:result=… rinceau:params=… rinceau:seed=… rinceau:source=…`
pub(crate) fn recipe_attributes(out: &mut String, recipe: &Recipe, prefix: &str) {
    attribute(out, &format!("{prefix}:result"), &recipe.generator);
    let params = serde_json::Value::Object(recipe.params.clone()).to_string();
    attribute(out, &format!("{prefix}:params"), &params);
    attribute(out, &format!("{prefix}:seed"), &recipe.seed.to_string());
    attribute(out, &format!("{prefix}:source"), &recipe.source_attribute());
    if !recipe.with.is_empty() {
        attribute(out, &format!("{prefix}:with"), &recipe.with_attribute());
    }
}

/// Everything between the layer's tags.
pub(crate) fn content(sink: &mut Sink, artwork: &Artwork, target: &Target) {
    if !artwork.symbols.is_empty() {
        symbols(&mut sink.text, artwork, target);
    }
    let mut record = Record::default();
    for group in &artwork.groups {
        sublayer(sink, group, artwork, target, &mut record);
    }
    record.write(&mut sink.text, target.svg_prefix, target.newline);
    sink.text.push_str(target.newline);
}

/// What clones repeat, in definitions of the layer's own.
fn symbols(out: &mut String, artwork: &Artwork, target: &Target) {
    let (prefix, newline) = (target.svg_prefix, target.newline);
    let _ = write!(out, "{newline}<{prefix}defs");
    attribute(out, "id", &format!("{}-symbols", target.id));
    target.guard_group(out, "");
    if artwork
        .symbols
        .iter()
        .flat_map(|symbol| &symbol.items)
        .any(|item| !matches!(item, SymbolItem::Part(_)))
    {
        attribute(out, "xmlns:xlink", XLINK);
    }
    out.push('>');
    // Clones carry the pose, and with it the way to the layer's coordinates.
    let own = Target { inverse: Affine::IDENTITY, ..*target };
    for symbol in &artwork.symbols {
        let _ = write!(out, "{newline}<{prefix}g");
        attribute(out, "id", &symbol_id(target, symbol));
        attribute(out, "inkscape:label", &symbol.name);
        target.guard_group(out, "");
        out.push('>');
        // Of size 1, so their coordinates need more decimals than those of a page.
        const DECIMALS: usize = 5;
        for item in &symbol.items {
            match item {
                SymbolItem::Part(part) => write_part(out, part, None, DECIMALS, &own),
                SymbolItem::Symbol(other, pose) => {
                    write_use(out, &symbol_id(target, &artwork.symbols[*other]), *pose, "", target);
                }
                SymbolItem::Object(id, pose, style) => write_use(out, id, *pose, style, target),
            }
        }
        let _ = write!(out, "</{prefix}g>");
    }
    let _ = write!(out, "{newline}</{prefix}defs>");
}

fn symbol_id(target: &Target, symbol: &Symbol) -> String {
    format!("{}-symbol-{}", target.id, symbol.name)
}

/// A clone without an id.
fn write_use(out: &mut String, id: &str, pose: Affine, style: &str, target: &Target) {
    let _ = write!(out, "<{}use", target.svg_prefix);
    if pose != Affine::IDENTITY {
        attribute(out, "transform", &matrix(pose, MATRIX_DECIMALS));
    }
    target.guard_group(out, style);
    // The old name: programs of before SVG 2 know only that.
    attribute(out, "xlink:href", &format!("#{id}"));
    out.push_str("/>");
}

fn sublayer(sink: &mut Sink, group: &Group, artwork: &Artwork, target: &Target, record: &mut Record) {
    let out = &mut sink.text;
    let (prefix, newline) = (target.svg_prefix, target.newline);
    let id = format!("{}-{}", target.id, group.name);
    let _ = write!(out, "{newline}<{prefix}g");
    attribute(out, "id", &id);
    attribute(out, "inkscape:groupmode", "layer");
    attribute(out, "inkscape:label", &group.name);
    if group.items.iter().any(|item| item.clone.is_some()) {
        attribute(out, "xmlns:xlink", XLINK);
    }
    let css = if group.hidden { "display:none" } else { "" };
    target.guard_group(out, css);
    record.begin(&group.name, &target.guard.group(css));
    out.push('>');
    let grouped = group.items.len() > SIBLINGS;
    for (chunk_index, chunk) in group.items.chunks(SIBLINGS).enumerate() {
        let out = &mut sink.text;
        if grouped {
            let _ = write!(out, "{newline}<{prefix}g");
            attribute(out, "id", &format!("{id}-g{}", chunk_index + 1));
            target.guard_group(out, "");
            out.push('>');
        }
        for (i, item) in chunk.iter().enumerate() {
            out.push_str(newline);
            let start = out.len();
            write_item(out, item, &format!("{id}-{}", chunk_index * SIBLINGS + i + 1), artwork, target);
            if record.has_room() {
                let bounds = bounds(item, artwork, target);
                record.note(&out.as_bytes()[start..], bounds, artwork.decimals);
            }
        }
        if grouped {
            let _ = write!(out, "{newline}</{prefix}g>");
        }
        sink.flush_some();
    }
    if let Some(stream) = &group.stream {
        stream::write_stream(sink, stream.as_ref(), (&id, artwork.decimals), target, record);
    }
    let _ = write!(sink.text, "{newline}</{prefix}g>");
}

/// The box of a piece, in the layer's coordinates.
fn bounds(item: &Item, artwork: &Artwork, target: &Target) -> Rect {
    let of = |parts: &mut dyn Iterator<Item = &Part>, pose: Affine| {
        let mut boxes =
            parts.map(|part| (pose * part.transform).transform_rect_bbox(part.path.control_box()));
        let first = boxes.next();
        first.map(|first| boxes.fold(first, |all, one| all.union(one)))
    };
    let found = match item.clone {
        None => of(&mut item.parts.iter(), target.inverse),
        Some((symbol, pose)) => {
            let pose = target.inverse * pose;
            // What it draws may be another symbol, or an object of the drawing: then its origin stands for it.
            let origin = || Rect::from_center_size(pose.translation().to_point(), (0.0, 0.0));
            of(&mut artwork.symbols[symbol].parts(), pose).or_else(|| Some(origin()))
        }
    };
    found.unwrap_or(Rect::ZERO)
}

fn write_item(out: &mut String, item: &Item, id: &str, artwork: &Artwork, target: &Target) {
    let decimals = artwork.decimals;
    if let Some((symbol, pose)) = item.clone {
        let _ = write!(out, "<{}use", target.svg_prefix);
        attribute(out, "id", id);
        attribute(out, "rinceau:of", &item.of);
        attribute(out, "transform", &matrix(target.inverse * pose, decimals + CLONE_DECIMALS));
        // The old name as well: programs of before SVG 2 know only that.
        attribute(out, "xlink:href", &format!("#{}", symbol_id(target, &artwork.symbols[symbol])));
        target.guard_group(out, "");
        out.push_str("/>");
        return;
    }
    if let [part] = item.parts.as_slice() {
        write_part(out, part, Some((id, &item.of)), decimals, target);
        return;
    }
    let prefix = target.svg_prefix;
    let _ = write!(out, "<{prefix}g");
    attribute(out, "id", id);
    attribute(out, "rinceau:of", &item.of);
    target.guard_group(out, "");
    out.push('>');
    for part in &item.parts {
        write_part(out, part, None, decimals, target);
    }
    let _ = write!(out, "</{prefix}g>");
}

/// A part of a picture, in the coordinates of the group around it.
pub(crate) fn write_part_at(out: &mut String, part: &Part, svg_prefix: &str) {
    const DECIMALS: usize = 2;
    let target = Target {
        id: "",
        svg_prefix,
        has_namespace: true,
        inverse: Affine::IDENTITY,
        in_empty_root: false,
        newline: "",
        guard: &Guard::default(),
    };
    write_part(out, part, None, DECIMALS, &target);
}

fn write_part(out: &mut String, part: &Part, item: Option<(&str, &str)>, decimals: usize, target: &Target) {
    let _ = write!(out, "<{}path", target.svg_prefix);
    if let Some((id, of)) = item {
        attribute(out, "id", id);
        attribute(out, "rinceau:of", of);
    }
    let transform = target.inverse * part.transform;
    let path = if part.transform == Affine::IDENTITY && target.inverse == Affine::IDENTITY {
        Cow::Borrowed(&part.path)
    } else if part.transform == Affine::IDENTITY {
        // Made in root units: no transform attribute is needed, the points are moved instead.
        Cow::Owned(target.inverse * part.path.clone())
    } else {
        if transform != Affine::IDENTITY {
            attribute(out, "transform", &matrix(transform, MATRIX_DECIMALS));
        }
        Cow::Borrowed(&part.path)
    };
    attribute(out, "style", &target.guard.shape(&part.style.css()));
    // Most of a layer, and nothing in it needs to be escaped.
    out.push_str(" d=\"");
    write_path_data(out, &path, decimals);
    out.push_str("\"/>");
}

/// Coefficients multiply coordinates of a whole page, so they carry more decimals.
const MATRIX_DECIMALS: usize = 9;
/// Those of a clone multiply coordinates of about 1.
const CLONE_DECIMALS: usize = 1;

pub(crate) fn matrix(transform: Affine, decimals: usize) -> String {
    let mut text = String::from("matrix(");
    for (i, c) in transform.as_coeffs().into_iter().enumerate() {
        if i > 0 {
            text.push(' ');
        }
        write_number(&mut text, c, decimals);
    }
    text.push(')');
    text
}

/// Appends ` name="value"`, escaped.
pub(crate) fn attribute(out: &mut String, name: &str, value: &str) {
    out.push(' ');
    out.push_str(name);
    out.push_str("=\"");
    out.push_str(&escaped(value));
    out.push('"');
}

/// A value escaped for double quotes. Characters that XML forbids are dropped: they cannot
/// come from a drawing, only from a shell.
pub(crate) fn escaped(value: &str) -> Cow<'_, str> {
    let is_plain = |b: u8| !matches!(b, b'&' | b'<' | b'>' | b'"' | 0..b' ' | 0x80..);
    if value.bytes().all(is_plain) {
        return Cow::Borrowed(value);
    }
    let mut out = String::with_capacity(value.len());
    for c in value.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\n' | '\r' | '\t' => {
                let _ = write!(out, "&#{};", u32::from(c));
            }
            c if c < ' ' || matches!(c, '\u{FFFE}' | '\u{FFFF}') => {}
            c => out.push(c),
        }
    }
    Cow::Owned(out)
}
