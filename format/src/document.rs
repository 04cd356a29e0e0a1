//! A drawing: its text, and edits that touch nothing but what is ours.

mod clean;
mod diagram;
mod edit;
mod flip;
mod history;
mod keep;
mod layers;
mod mark;
mod problems;
mod transform;

use crate::encoding::{self, Encoding};
use crate::error::{Error, Position};
use crate::limits::Limits;
use crate::prescan::prescan;
use crate::read;
use crate::scene::{Scene, Selection};
use roxmltree::ParsingOptions;
use std::sync::{Arc, OnceLock};

pub(crate) use history::forms_of_step;
pub use keep::Held;
pub use layers::Layer;
pub use problems::Problem;

/// A drawing. Every edit returns a new one; bytes outside the edit are the source's own.
#[derive(Clone, Debug)]
pub struct Document {
    text: Arc<String>,
    encoding: Encoding,
    limits: Limits,
    /// The tree of the text, once it is asked for; copies share it.
    tree: Arc<OnceLock<Tree>>,
}

self_cell::self_cell!(
    /// A tree and the text that it borrows.
    struct Tree {
        owner: Arc<String>,
        #[covariant]
        dependent: Xml,
    }
    impl {Debug}
);

type Xml<'t> = roxmltree::Document<'t>;

impl Document {
    /// Reads a drawing: SVG or svgz, with or without byte-order mark, in UTF-8, UTF-16 or
    /// ISO 8859-1.
    ///
    /// Errors: not text, not XML, not SVG, or beyond [`Limits`], each with its position.
    pub fn from_bytes(bytes: Vec<u8>) -> Result<Self, Error> {
        Document::with_limits(bytes, Limits::default())
    }

    /// The same with other limits.
    pub fn with_limits(bytes: Vec<u8>, limits: Limits) -> Result<Self, Error> {
        let (text, encoding) = encoding::decode(bytes, &limits)?;
        let document = Document::new(text, encoding, limits);
        prescan(&document.text, &document.limits)?;
        document.parse(|_| Ok(()))?;
        Ok(document)
    }

    fn new(text: String, encoding: Encoding, limits: Limits) -> Self {
        Document { text: Arc::new(text), encoding, limits, tree: Arc::default() }
    }

    /// The drawing with another text.
    fn with_text(&self, text: String) -> Self {
        Document::new(text, self.encoding, self.limits.clone())
    }

    /// A drawing of nothing but what a scene knows; it reads as that scene.
    ///
    /// Errors: a scene beyond the limits of a drawing.
    pub fn from_scene(scene: &Scene) -> Result<Self, Error> {
        Document::from_bytes(crate::write::scene::drawing(scene).into_bytes())
    }

    /// A scene as a diagram in the colours of the FLOWPAK paper, without marks: what
    /// [`Document::with_roles_by_colour`] reads. Also what has no colour there and is left out, in words.
    ///
    /// Errors: a scene beyond the limits of a drawing.
    pub fn diagram(scene: &Scene) -> Result<(Self, Vec<String>), Error> {
        let (text, lost) = crate::write::scene::diagram(scene);
        Ok((Document::from_bytes(text.into_bytes())?, lost))
    }

    /// The drawing as it is stored, uncompressed.
    pub fn to_bytes(&self) -> Vec<u8> {
        encoding::encode(&self.text, self.encoding)
    }

    /// The drawing in UTF-8, whatever its encoding, without a declaration that says otherwise.
    pub fn to_utf8(&self) -> Vec<u8> {
        let declared = self.text.starts_with("<?xml").then(|| self.text.find("?>")).flatten();
        self.text.as_bytes()[declared.map_or(0, |end| end + 2)..].to_vec()
    }

    /// The drawing's text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Resolves every annotated object to plain geometry.
    ///
    /// Errors: an annotated object that cannot be read; each reason code is listed in SPEC.md.
    pub fn scene(&self, selection: &Selection) -> Result<Scene, Error> {
        self.parse(|xml| read::scene(xml, selection, &self.limits))
    }

    /// Uses the tree of the text. It is parsed once, however often it is used.
    fn parse<T>(&self, f: impl FnOnce(&roxmltree::Document) -> Result<T, Error>) -> Result<T, Error> {
        if let Some(tree) = self.tree.get() {
            return f(tree.borrow_dependent());
        }
        let tree = Tree::try_new(Arc::clone(&self.text), |text| self.parsed(text))?;
        f(self.tree.get_or_init(|| tree).borrow_dependent())
    }

    fn parsed<'t>(&self, text: &'t str) -> Result<roxmltree::Document<'t>, Error> {
        if self.text.trim().is_empty() {
            return Err(Error::new("empty-file", "The file is empty", "Save the drawing again as SVG"));
        }
        let options = ParsingOptions { allow_dtd: true, nodes_limit: u32::MAX, ..ParsingOptions::default() };
        let xml =
            roxmltree::Document::parse_with_options(text, options).map_err(|error| self.xml_error(&error))?;
        let root = xml.root_element();
        if !read::is_svg_root(root) {
            let at = Position::of(&self.text, root.range().start);
            return Err(Error::new(
                "not-svg",
                format!("This is XML, but its root is <{}>, not <svg>", root.tag_name().name()),
                "Open an SVG drawing",
            )
            .at(at));
        }
        Ok(xml)
    }

    fn xml_error(&self, error: &roxmltree::Error) -> Error {
        let at = match error {
            // The parser does not say where the text ends.
            roxmltree::Error::UnexpectedEndOfStream | roxmltree::Error::UnclosedRootNode => {
                Position::of(&self.text, self.text.len())
            }
            _ => Position { line: error.pos().row as usize, column: error.pos().col as usize },
        };
        let full = error.to_string();
        let reason = full.rsplit_once(" at ").map_or(full.as_str(), |(reason, _)| reason);
        let (code, sentence) = if !self.text.trim_start().starts_with('<') {
            ("not-xml", "The file is not an SVG drawing: it does not start with '<'".to_owned())
        } else {
            ("broken-xml", format!("The drawing is damaged or cut short: {reason}"))
        };
        Error::new(code, sentence, "Open it in Inkscape and save it again as SVG").at(at)
    }
}
