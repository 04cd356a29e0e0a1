//! The annotated-SVG interchange format of Rinceau.
//!
//! A [`Document`] owns the bytes of a drawing and never loses one that is not ours.
//! From it comes a [`Scene`]: every role resolved to plain geometry in user units of the
//! root `<svg>`. A generator turns the scene into an [`Artwork`], and
//! [`Document::with_layer`] splices that back into the drawing as a result layer.
//!
//! ```
//! use rinceau_format::{Document, Selection};
//!
//! let svg = br#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 10 10">
//!   <circle id="sun" class="rinceau-container" cx="5" cy="5" r="4"/></svg>"#;
//! let document = Document::from_bytes(svg.to_vec())?;
//! let scene = document.scene(&Selection::default())?;
//! assert_eq!(scene.containers[0].source.id, "sun");
//! # Ok::<(), rinceau_format::Error>(())
//! ```
//!
//! The format itself is specified in `SPEC.md` beside this crate.

mod artwork;
mod cfdg;
mod css;
mod document;
mod encoding;
mod error;
mod file;
mod json;
mod limits;
mod look;
mod number;
mod prescan;
mod read;
mod recipe;
mod scene;
mod shape;
mod style;
mod text;
mod units;
mod vocabulary;
mod write;
mod xml;

pub use artwork::{Artwork, Group, Item, Part, Pieces, Step, Stream, Symbol, SymbolItem};
pub use document::{Document, Held, Layer, Problem};
pub use error::{Error, Position, is_deceptive, printable};
pub use file::read_file;
pub use limits::Limits;
pub use number::{decimals_for, path_data, write_number};
pub use recipe::Recipe;
pub use scene::{
    Container, Element, Example, Fixed, Form, FormItem, Guide, Live, Outline, Primitive, Reference,
    Replication, RuleSet, Scene, Seed, Selection, Source, Stroke, Template, When,
};
pub use shape::{arc_to_cubics, subpaths};
pub use style::{FillRule, Style, rgb};
pub use text::generic_fonts;
pub use units::Length;
pub use vocabulary::{NAMESPACE, Role};
