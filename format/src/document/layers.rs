//! Result layers: find, replace, add and remove them.

use super::Document;
use super::edit::{New, splice, splice_to, start_tag_end, tag_name};
use super::keep::{Edits, merged};
use crate::artwork::Artwork;
use crate::encoding::Encoding;
use crate::error::Error;
use crate::read::{Resolver, layer_transform};
use crate::recipe::Recipe;
use crate::style::Guard;
use crate::vocabulary::{NAMESPACE, SVG};
use crate::write::{self, Sink, Target, attribute, escaped};
use crate::xml::{PlainAttribute, is_verbatim};
use kurbo::Affine;
use roxmltree::Node;
use std::collections::HashSet;
use std::io;
use std::ops::Range;

/// A result layer found in a drawing.
#[derive(Clone, Debug)]
pub struct Layer {
    /// What made it.
    pub recipe: Recipe,
    range: Range<usize>,
}

impl Document {
    /// The result layers in the drawing, in drawing order; not those inside another.
    ///
    /// Errors: a recipe that cannot be read.
    pub fn layers(&self) -> Result<Vec<Layer>, Error> {
        self.parse(|xml| {
            let mut layers = Vec::new();
            for node in result_nodes(xml) {
                self.check_verbatim(node)?;
                layers.push(Layer { recipe: read_recipe(self, node)?, range: node.range() });
            }
            Ok(layers)
        })
    }

    /// The drawing without its result layers. The line break written before a layer goes too.
    ///
    /// Errors: as [`Document::layers`].
    pub fn without_layers(&self) -> Result<Document, Error> {
        let newline = self.newline();
        let edits = self.layers()?.into_iter().map(|layer| {
            let start = layer.range.start;
            let start = if self.text[..start].ends_with(newline) { start - newline.len() } else { start };
            (start..layer.range.end, String::new())
        });
        let edits: Vec<_> = edits.collect();
        let text = self.parse(|xml| {
            let whole = self.emptied_root(xml, &edits).map(|edit| vec![edit]);
            Ok(splice(&self.text, whole.unwrap_or(edits)))
        })?;
        Ok(self.with_text(text))
    }

    /// What makes the root `<svg/>` again, if it was before the layers.
    fn emptied_root(
        &self,
        xml: &roxmltree::Document,
        removed: &[(Range<usize>, String)],
    ) -> Option<(Range<usize>, String)> {
        let root = xml.root_element();
        root.children().find(|node| node.attribute((NAMESPACE, "root")) == Some("empty"))?;
        let range = root.range();
        let (tag_end, closes) = start_tag_end(&self.text[range.clone()]);
        let content = range.start + tag_end + 1;
        let removed: usize = removed.iter().map(|(range, _)| range.len()).sum();
        let close = content + removed;
        let is_empty = !closes && self.text.get(close..range.end)?.starts_with("</");
        is_empty.then(|| (range.start + tag_end..range.end, "/>".to_owned()))
    }

    /// Puts an artwork into the drawing. A layer of the same generator over the same sources, or the
    /// only one over some of them and no others, is replaced in place and keeps its tag: id, label,
    /// transform, visibility, lock.
    ///
    /// Errors: a layer that shares some of the sources and has others, or two that have some each;
    /// a layer with a transform that cannot be inverted.
    pub fn with_layer(&self, artwork: &Artwork, recipe: &Recipe) -> Result<Document, Error> {
        let mut sink = Sink::default();
        self.put_layer(artwork, recipe, &mut sink)?;
        Ok(self.with_text(sink.text))
    }

    /// Writes the drawing with an artwork in it, as [`Document::with_layer`], without holding all
    /// of it in memory. The inner result is that of writing.
    ///
    /// Errors: as [`Document::with_layer`]; then nothing has been written.
    pub fn write_with_layer(
        &self,
        artwork: &Artwork,
        recipe: &Recipe,
        out: &mut dyn io::Write,
    ) -> Result<io::Result<()>, Error> {
        // Other encodings are made of the whole text.
        if self.encoding != Encoding::Utf8 {
            return Ok(out.write_all(&self.with_layer(artwork, recipe)?.to_bytes()));
        }
        let mut sink = Sink::to(out);
        self.put_layer(artwork, recipe, &mut sink)?;
        Ok(sink.finish())
    }

    fn put_layer(&self, artwork: &Artwork, recipe: &Recipe, sink: &mut Sink) -> Result<(), Error> {
        self.parse(|xml| {
            let survey = Survey::of(xml, &recipe.label);
            let mine = self.own_layer(&survey.results, &recipe.generator, &recipe.sources)?;
            match mine {
                Some(node) => self.replaced(xml, node, (artwork, recipe), &survey.ids, sink),
                None => self.appended(xml, (artwork, recipe), &survey, sink),
            }
        })
    }

    /// The layer that a generator makes again for some sources, if there is one.
    ///
    /// Errors: as [`Document::with_layer`].
    pub(super) fn layer_of<'a, 'i>(
        &self,
        xml: &'a roxmltree::Document<'i>,
        generator: &str,
        sources: &[String],
    ) -> Result<Option<Node<'a, 'i>>, Error> {
        self.own_layer(&result_nodes(xml), generator, sources)
    }

    fn own_layer<'a, 'i>(
        &self,
        results: &[Node<'a, 'i>],
        generator: &str,
        sources: &[String],
    ) -> Result<Option<Node<'a, 'i>>, Error> {
        let mut mine = None;
        // Layers whose sources are all filled again, with others.
        let mut covered: Vec<Node> = Vec::new();
        let wanted: HashSet<&String> = sources.iter().collect();
        for &node in results {
            let old = read_recipe(self, node)?;
            if old.generator != generator {
                continue;
            }
            if old.sources == sources {
                mine = mine.or(Some(node));
            } else if !old.sources.is_empty() && old.sources.iter().all(|id| wanted.contains(id)) {
                covered.push(node);
            } else if let Some(shared) = old.sources.iter().find(|id| wanted.contains(id)) {
                let sentence = format!(
                    "'{shared}' is already filled, together with others, in the layer '{}'",
                    label_of(node)
                );
                return Err(Error::new(
                    "layer-overlap",
                    sentence,
                    "Fill all of that layer's shapes at once, or delete the layer first",
                )
                .at(self.position(node)));
            }
        }
        if let [one] = covered[..] {
            mine = mine.or(Some(one));
        }
        if let Some(other) = covered.into_iter().find(|&node| Some(node) != mine) {
            return Err(Error::new(
                "layer-overlap",
                format!("The layer '{}' already fills some of the shapes alone", label_of(other)),
                "Fill its shapes and the others separately (select them), or delete the layer first",
            )
            .at(self.position(other)));
        }
        Ok(mine)
    }

    fn replaced(
        &self,
        xml: &roxmltree::Document,
        node: Node,
        (artwork, recipe): (&Artwork, &Recipe),
        ids: &Ids,
        sink: &mut Sink,
    ) -> Result<(), Error> {
        let id = node.plain("id").map_or_else(|| ids.free(), str::to_owned);
        self.within_layer(xml, node, &id, |target| {
            let range = node.range();
            let element = &self.text[range.clone()];
            let (tag_end, closes) = start_tag_end(element);
            let mut edits = Vec::new();
            let missing = self.recipe_edits(node, recipe, &mut edits)?;
            let tag = range.start + tag_end;
            let mut edits: Vec<_> = edits.into_iter().map(|(range, text)| (range, New::Text(text))).collect();
            if closes {
                let end = format!("</{}g>", target.svg_prefix);
                edits.push((tag..range.end, New::Layer(format!("{missing}>"), end)));
            } else {
                let close = range.start + element.rfind("</").unwrap_or(element.len());
                if !missing.is_empty() {
                    edits.push((tag..tag, New::Text(missing)));
                }
                edits.push((tag + 1..close, New::Layer(String::new(), String::new())));
            }
            let changes = Edits::of(node);
            if changes.is_empty() {
                splice_to(&self.text, edits, sink, |sink| write::content(sink, artwork, target));
                return Ok(());
            }
            let mut fresh = Sink::default();
            write::content(&mut fresh, artwork, target);
            let content = merged(self, &changes, (&fresh.text, target.svg_prefix, artwork.decimals))?;
            splice_to(&self.text, edits, sink, |sink| sink.put_text(&content));
            Ok(())
        })
    }

    /// Does something with what is written into a layer that exists.
    ///
    /// Errors: a layer with a transform that cannot be inverted.
    pub(super) fn within_layer<T>(
        &self,
        xml: &roxmltree::Document,
        node: Node,
        id: &str,
        f: impl FnOnce(&Target) -> Result<T, Error>,
    ) -> Result<T, Error> {
        self.check_verbatim(node)?;
        let resolver = Resolver::new(xml, &self.limits)?;
        let guard = resolver.cascade.guard();
        let full = layer_transform(&resolver, node);
        let inverse = full.inverse();
        if !inverse.is_finite() || full.determinant().abs() < 1e-12 {
            return Err(Error::new(
                "flat-layer",
                format!("The layer '{}' is scaled to nothing", label_of(node)),
                "Delete it and run again",
            )
            .at(self.position(node)));
        }
        f(&Target {
            id,
            svg_prefix: tag_name(&self.text[node.range()]).strip_suffix('g').unwrap_or(""),
            has_namespace: node.tag_name().namespace() == Some(SVG),
            inverse,
            in_empty_root: false,
            newline: self.newline(),
            guard: &guard,
        })
    }

    /// Edits that renew a layer's recipe; returns what its tag still lacks.
    fn recipe_edits(
        &self,
        node: Node,
        recipe: &Recipe,
        edits: &mut Vec<(Range<usize>, String)>,
    ) -> Result<String, Error> {
        let params = serde_json::Value::Object(recipe.params.clone()).to_string();
        let fresh = [
            ("params", params),
            ("seed", recipe.seed.to_string()),
            ("source", recipe.source_attribute()),
            ("with", recipe.with_attribute()),
        ];
        let mut missing = String::new();
        for (name, value) in fresh {
            match node.attributes().find(|a| a.namespace() == Some(NAMESPACE) && a.name() == name) {
                None if name == "with" && value.is_empty() => {}
                Some(a) => edits.push((a.range_value(), quoted_for(&self.text, a.range_value(), &value))),
                None => {
                    let prefix = node.lookup_prefix(NAMESPACE).unwrap_or("rinceau");
                    attribute(&mut missing, &format!("{prefix}:{name}"), &value);
                }
            }
        }
        // The content uses these prefixes; whoever saved the drawing may have moved or
        // renamed the declarations, so those not in scope are declared again.
        for (prefix, uri) in [
            ("rinceau", NAMESPACE),
            ("inkscape", crate::vocabulary::INKSCAPE),
            ("sodipodi", crate::vocabulary::SODIPODI),
        ] {
            if node.lookup_namespace_uri(Some(prefix)) != Some(uri) {
                if declares_itself(node, prefix) {
                    return Err(self.prefix_taken(node, prefix));
                }
                attribute(&mut missing, &format!("xmlns:{prefix}"), uri);
            }
        }
        Ok(missing)
    }

    fn appended(
        &self,
        xml: &roxmltree::Document,
        (artwork, recipe): (&Artwork, &Recipe),
        survey: &Survey,
        sink: &mut Sink,
    ) -> Result<(), Error> {
        let root = xml.root_element();
        self.check_verbatim(root)?;
        let guard = match survey.has_rules {
            true => Resolver::new(xml, &self.limits)?.cascade.guard(),
            false => Guard::default(),
        };
        let range = root.range();
        let element = &self.text[range.clone()];
        let (tag_end, closes) = start_tag_end(element);
        let prefix = self.prefix_of(root);
        let id = survey.ids.free();
        let newline = self.newline();
        let target = Target {
            id: &id,
            svg_prefix: prefix,
            has_namespace: root.tag_name().namespace() == Some(SVG),
            inverse: Affine::IDENTITY,
            in_empty_root: closes,
            newline,
            guard: &guard,
        };
        let (open, close) = (write::open_layer(recipe, &target), format!("</{prefix}g>"));
        let edit = if closes {
            let (before, after) = (format!(">{newline}{open}"), format!("{close}</{prefix}svg>"));
            (range.start + tag_end..range.end, New::Layer(before, after))
        } else {
            let end = range.start + element.rfind("</").unwrap_or(element.len());
            (end..end, New::Layer(format!("{newline}{open}"), close))
        };
        splice_to(&self.text, vec![edit], sink, |sink| write::content(sink, artwork, &target));
        Ok(())
    }

    /// The prefix of SVG elements at the root, with its colon.
    pub(super) fn prefix_of(&self, root: Node) -> &str {
        tag_name(&self.text[root.range()]).strip_suffix("svg").unwrap_or("")
    }

    /// The drawing's own line end.
    pub(super) fn newline(&self) -> &'static str {
        let first = self.text.find('\n');
        if first.is_some_and(|i| i > 0 && self.text.as_bytes()[i - 1] == b'\r') { "\r\n" } else { "\n" }
    }

    /// Errors if the element's tags are not where its range says, in the body of the drawing.
    pub(super) fn check_verbatim(&self, node: Node) -> Result<(), Error> {
        if is_verbatim(node) {
            return Ok(());
        }
        Err(Error::new(
            "in-entity",
            format!("'{}' comes out of an entity of the drawing, at least in part", label_of(node)),
            "Save the drawing in Inkscape first, which writes entities out",
        )
        .at(self.position(node)))
    }

    pub(super) fn prefix_taken(&self, node: Node, prefix: &str) -> Error {
        Error::new(
            "prefix-taken",
            format!("The object '{}' declares the prefix '{prefix}' for something else", label_of(node)),
            "Save the drawing in Inkscape first, which declares prefixes once",
        )
        .at(self.position(node))
    }

    pub(super) fn position(&self, node: Node) -> crate::error::Position {
        crate::error::Position::of(&self.text, node.range().start)
    }
}

/// What one look at every node tells about where a layer can go.
struct Survey<'a, 'i> {
    /// As [`result_nodes`].
    results: Vec<Node<'a, 'i>>,
    /// True if there are style sheets.
    has_rules: bool,
    ids: Ids<'a>,
}

impl<'a, 'i> Survey<'a, 'i> {
    fn of(xml: &'a roxmltree::Document<'i>, label: &str) -> Self {
        let mut survey = Survey { results: Vec::new(), has_rules: false, ids: Ids::of_label(label) };
        for node in xml.descendants().filter(Node::is_element) {
            push_outermost(&mut survey.results, node);
            survey.has_rules |= node.tag_name().name() == "style";
            survey.ids.note(node);
        }
        survey
    }
}

/// Nodes of result layers, outermost only.
pub(super) fn result_nodes<'a, 'i>(xml: &'a roxmltree::Document<'i>) -> Vec<Node<'a, 'i>> {
    let mut nodes = Vec::new();
    xml.descendants().for_each(|node| push_outermost(&mut nodes, node));
    nodes
}

/// Adds a node if it is a result layer behind the last one, not in it.
fn push_outermost<'a, 'i>(nodes: &mut Vec<Node<'a, 'i>>, node: Node<'a, 'i>) {
    let is_outside = |last: &Node| node.range().start >= last.range().end;
    if node.attribute((NAMESPACE, "result")).is_some() && nodes.last().is_none_or(is_outside) {
        nodes.push(node);
    }
}

pub(super) fn read_recipe(document: &Document, node: Node) -> Result<Recipe, Error> {
    let get = |name: &str| node.attribute((NAMESPACE, name));
    let broken = |what: &str| {
        Error::new(
            "broken-recipe",
            format!("The recipe of the layer '{}' cannot be read: {what}", label_of(node)),
            "Delete the layer and run the generator again",
        )
        .at(document.position(node))
    };
    let params = match serde_json::from_str(get("params").unwrap_or("{}")) {
        Ok(serde_json::Value::Object(params)) => params,
        _ => return Err(broken("rinceau:params is not a JSON object")),
    };
    let seed = get("seed")
        .unwrap_or("0")
        .trim()
        .parse()
        .map_err(|_| broken("rinceau:seed is not a whole number"))?;
    Ok(Recipe {
        generator: get("result").unwrap_or("").to_owned(),
        params,
        seed,
        sources: Recipe::parse_sources(get("source").unwrap_or("")),
        with: Recipe::parse_sources(get("with").unwrap_or("")),
        label: label_of(node),
    })
}

pub(super) fn label_of(node: Node) -> String {
    let label = node.attribute((crate::vocabulary::INKSCAPE, "label")).or_else(|| node.plain("id"));
    label.unwrap_or("Ornament").to_owned()
}

/// An id made from a label that no object has.
pub(super) fn free_id(xml: &roxmltree::Document, label: &str) -> String {
    let mut ids = Ids::of_label(label);
    xml.descendants().for_each(|node| ids.note(node));
    ids.free()
}

/// The ids that a new one could meet.
struct Ids<'a> {
    base: String,
    taken: HashSet<&'a str>,
}

impl<'a> Ids<'a> {
    fn of_label(label: &str) -> Self {
        let mut base = String::new();
        for c in label.chars().take(40) {
            let c = if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' };
            if !(c == '-' && (base.is_empty() || base.ends_with('-'))) {
                base.push(c);
            }
        }
        let base = match base.trim_end_matches('-') {
            "" => "ornament".to_owned(),
            base if base.starts_with(|c: char| c.is_ascii_digit()) => format!("ornament-{base}"),
            base => base.to_owned(),
        };
        Ids { base, taken: HashSet::new() }
    }

    fn note(&mut self, node: Node<'a, '_>) {
        let Some(id) = node.plain("id").filter(|id| id.starts_with(&self.base)) else { return };
        // The ids of the layer's content start with the layer's, so no id may start with it and a
        // dash. A number of seven digits is as long as the limit of nodes can make it.
        let longest = self.base.len() + 1 + 7;
        self.taken.insert(id);
        self.taken.extend(id.match_indices('-').take_while(|(i, _)| *i <= longest).map(|(i, _)| &id[..i]));
    }

    fn free(&self) -> String {
        let numbered = (2..).map(|n| format!("{}_{n}", self.base));
        let mut ids = std::iter::once(self.base.clone()).chain(numbered);
        ids.find(|id| !self.taken.contains(id.as_str())).unwrap_or_default()
    }
}

/// An attribute value escaped for the quotes that stand around it.
fn quoted_for(text: &str, range: Range<usize>, value: &str) -> String {
    let escaped = escaped(value);
    if text.as_bytes().get(range.end) == Some(&b'\'') {
        escaped.replace('\'', "&#39;")
    } else {
        escaped.into_owned()
    }
}

/// True if the element itself, and not one around it, declares the prefix.
fn declares_itself(node: Node, prefix: &str) -> bool {
    let of = |node: Node| node.lookup_namespace_uri(Some(prefix)).map(str::to_owned);
    of(node).is_some() && node.parent().is_none_or(|parent| of(parent) != of(node))
}
