//! What a layer remembers of its pieces, so that it can be told later what an artist did to them:
//! `<metadata rinceau:group="elements" rinceau:pieces="..."/>`, at the end of a layer, has an entry for each piece by
//! number: a digest of its shape, one of its paint, and where it stands.

use super::{attribute, escaped};
use crate::number::write_number;
use crate::vocabulary::{INKSCAPE, NAMESPACE, SODIPODI, SVG, XLINK};
use crate::xml::PlainAttribute;
use kurbo::{Point, Rect};
use roxmltree::Node;
use std::fmt::Write;

/// A layer of more pieces remembers none: nobody edits so many by hand, and the record has its size.
pub(crate) const MOST_REMEMBERED: usize = 20_000;

/// A piece as it was made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Entry {
    /// Digest of what gives it its shape and place.
    pub shape: u32,
    /// Digest of its paint.
    pub paint: u32,
    /// The middle of its box, in the layer's coordinates.
    pub at: Point,
    /// Half the diagonal of its box.
    pub reach: f64,
}

/// The pieces of one sublayer by number, from 1; none where a number is not in use.
pub(crate) type Entries = Vec<Option<Entry>>;

/// The record of a layer that is being written.
#[derive(Default)]
pub(crate) struct Record {
    text: String,
    group: String,
    count: usize,
    /// The same style comes again and again.
    last_paint: (Vec<u8>, u32),
}

impl Record {
    /// The pieces of a sublayer follow.
    pub fn begin(&mut self, group: &str, style: &str) {
        self.group.clear();
        open_entries(&mut self.group, group, style);
    }

    /// True if more pieces can be noted.
    pub fn has_room(&self) -> bool {
        self.count <= MOST_REMEMBERED
    }

    /// Notes a piece: its text, and its box in the layer's coordinates.
    pub fn note(&mut self, text: &[u8], bounds: Rect, decimals: usize) {
        self.count += 1;
        if !self.has_room() {
            self.text.clear();
            return;
        }
        let (mut shape, mut paint) = (Digest::new(), Digest::new());
        each_tag(text, |slots| {
            if slots.iter().all(|slot| slot.is_empty()) {
                return;
            }
            shape.feed(&slots[..3]);
            if self.last_paint.0 != slots[3] || self.last_paint.1 == 0 {
                let declarations = std::str::from_utf8(slots[3]).unwrap_or("").split(';');
                self.last_paint = (slots[3].to_vec(), paint_of(declarations.map(str::to_owned).collect()));
            }
            paint.feed(&[&self.last_paint.1.to_le_bytes()]);
        });
        let reach = 0.5 * bounds.width().hypot(bounds.height());
        let entry = Entry { shape: shape.short(), paint: paint.short(), at: bounds.center(), reach };
        if self.group.is_empty() {
            self.text.push(';');
        } else {
            if !self.text.is_empty() {
                self.text.push('\n');
            }
            self.text.push_str(&std::mem::take(&mut self.group));
        }
        write_entry(&mut self.text, Some(&entry), record_decimals(decimals));
    }

    /// Writes what was noted, an element for each sublayer.
    pub fn write(&self, out: &mut String, svg_prefix: &str, newline: &str) {
        for line in self.text.lines() {
            let _ = write!(out, "{newline}<{svg_prefix}metadata{line}\"/>");
        }
    }
}

/// The element of one sublayer, with the style that this was given.
pub(crate) fn write_entries(
    out: &mut String,
    svg_prefix: &str,
    (group, style): (&str, &str),
    (entries, decimals): (&Entries, usize),
) {
    let _ = write!(out, "<{svg_prefix}metadata");
    open_entries(out, group, style);
    for (i, entry) in entries.iter().enumerate() {
        if i > 0 {
            out.push(';');
        }
        write_entry(out, entry.as_ref(), decimals);
    }
    out.push_str("\"/>");
}

fn open_entries(out: &mut String, group: &str, style: &str) {
    attribute(out, "rinceau:group", group);
    if !style.is_empty() {
        attribute(out, "rinceau:style", style);
    }
    out.push_str(" rinceau:pieces=\"");
}

/// Decimals of places in a record: nobody sees less than a hundredth of a hundredth of a drawing.
pub(crate) fn record_decimals(decimals: usize) -> usize {
    decimals.saturating_sub(2)
}

fn write_entry(out: &mut String, entry: Option<&Entry>, decimals: usize) {
    let Some(entry) = entry else { return };
    let _ = write!(out, "{:06x}{:06x}", entry.shape, entry.paint);
    for value in [entry.at.x, entry.at.y, entry.reach] {
        out.push(' ');
        write_number(out, value, decimals);
    }
}

/// The entries in the text of an element; what cannot be read counts as not in use.
pub(crate) fn read_entries(text: &str) -> Entries {
    let entry = |text: &str| {
        let mut words = text.split_whitespace();
        let digests = words.next().filter(|digests| digests.len() == 12 && digests.is_ascii())?;
        let digest = |text: &str| u32::from_str_radix(text, 16).ok();
        let mut number = || words.next()?.parse::<f64>().ok().filter(|value| value.is_finite());
        let (shape, paint) = (digest(&digests[..6])?, digest(&digests[6..])?);
        Some(Entry { shape, paint, at: Point::new(number()?, number()?), reach: number()?.abs() })
    };
    text.split(';').map(entry).collect()
}

/// The digests of a piece as it stands in a drawing: of shape and paint.
pub(crate) fn digests(piece: Node) -> (u32, u32) {
    let (mut shape, mut paint) = (Digest::new(), Digest::new());
    for node in piece.descendants().filter(Node::is_element) {
        let get = |name: &str| escaped(node.plain(name).unwrap_or("")).into_owned();
        let href = node.attribute((XLINK, "href")).or_else(|| node.plain("href")).unwrap_or("");
        let slots = [get("transform"), get("d"), escaped(href).into_owned()];
        let declarations = paints_of(node);
        if declarations.is_empty() && slots.iter().all(String::is_empty) {
            continue;
        }
        shape.feed(&slots.each_ref().map(|slot| slot.as_bytes()));
        paint.feed(&[&paint_of(declarations).to_le_bytes()]);
    }
    (shape.short(), paint.short())
}

/// What paints an object of its own: declarations of its style, and the attributes that stand for some.
pub(crate) fn paints_of(node: Node) -> Vec<String> {
    let style = escaped(node.plain("style").unwrap_or("")).into_owned();
    let declarations = style.split(';').filter(|text| !text.trim().is_empty()).map(str::to_owned);
    let is_paint = |name: &str| name == "opacity" || crate::style::is_paint(name);
    let attributes = node.attributes().filter(|a| a.namespace().is_none() && is_paint(a.name()));
    declarations.chain(attributes.map(|a| format!("{}:{}", a.name(), escaped(a.value())))).collect()
}

/// The digest of declarations in any order.
pub(crate) fn paint_of(declarations: Vec<String>) -> u32 {
    let plain = |text: &String| text.chars().filter(|c| !c.is_whitespace()).collect::<String>();
    let mut all: Vec<String> = declarations.iter().map(plain).filter(|text| !text.is_empty()).collect();
    all.sort_unstable();
    let mut digest = Digest::new();
    all.iter().for_each(|text| digest.feed(&[text.as_bytes()]));
    // 0 stands for one that is not known.
    digest.short().max(1)
}

/// Gives `transform`, `d`, reference and `style` of each start tag in a text of our own.
fn each_tag(text: &[u8], mut tag: impl FnMut([&[u8]; 4])) {
    let mut slots: [&[u8]; 4] = [b""; 4];
    let (mut at, mut name) = (0, 0);
    while at < text.len() {
        match text[at] {
            b'<' => {
                tag(std::mem::replace(&mut slots, [b""; 4]));
                at += 1;
            }
            b' ' => {
                at += 1;
                name = at;
            }
            b'"' => {
                let value = &text[at + 1..];
                let end = value.iter().position(|&b| b == b'"').unwrap_or(value.len());
                let slot = match &text[name..at] {
                    b"transform=" => Some(0),
                    b"d=" => Some(1),
                    b"xlink:href=" => Some(2),
                    b"style=" => Some(3),
                    _ => None,
                };
                if let Some(slot) = slot {
                    slots[slot] = &value[..end];
                }
                at += end + 2;
            }
            _ => at += 1,
        }
    }
    tag(slots);
}

/// FNV-1a of 32 bits: it has to be the same in every version.
struct Digest(u32);

impl Digest {
    fn new() -> Self {
        Digest(0x811c_9dc5)
    }

    fn feed(&mut self, texts: &[&[u8]]) {
        for text in texts {
            // No text of XML has a byte of ones.
            for &b in text.iter().chain(&[0xff]) {
                self.0 = (self.0 ^ u32::from(b)).wrapping_mul(0x0100_0193);
            }
        }
    }

    /// Folded to 24 bits.
    fn short(&self) -> u32 {
        (self.0 >> 24) ^ (self.0 & 0x00ff_ffff)
    }
}

/// The start of a root in which the content of a layer can be parsed by itself.
pub(crate) fn wrapper(svg_prefix: &str, id: &str) -> String {
    let mut out = String::from("<root");
    let prefix = svg_prefix.trim_end_matches(':');
    attribute(&mut out, &if prefix.is_empty() { "xmlns".into() } else { format!("xmlns:{prefix}") }, SVG);
    for (name, uri) in
        [("inkscape", INKSCAPE), ("sodipodi", SODIPODI), ("rinceau", NAMESPACE), ("xlink", XLINK)]
    {
        attribute(&mut out, &format!("xmlns:{name}"), uri);
    }
    attribute(&mut out, "id", id);
    out.push('>');
    out
}
