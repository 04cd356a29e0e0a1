//! Drawings to hand on: without marks and recipes, or as nothing but paths.

use super::Document;
use super::edit::{splice, start_tag_end, tag_name};
use crate::error::Error;
use crate::look::ARROW;
use crate::number::{decimals_for, path_data};
use crate::read::has_mark;
use crate::units::mean_scale;
use crate::vocabulary::{NAMESPACE, Role, XLINK};
use crate::write::{attribute, escaped};
use crate::xml::PlainAttribute;
use roxmltree::Node;
use std::collections::{BTreeMap, HashSet};
use std::ops::Range;

impl Document {
    /// The artwork alone: without objects that carry a mark, hidden sublayers of results, explored forms,
    /// recipes, and anything else of this format. Results stay, and what is not marked. A marked object that
    /// a clone refers to stays where it is, but in `<defs>`.
    ///
    /// Errors: something of this format comes out of an entity.
    pub fn artwork_only(&self) -> Result<Document, Error> {
        let text = self.parse(|xml| {
            let root = xml.root_element();
            self.check_verbatim(root)?;
            let removed = removed(root);
            let kept = referred_to(root, &removed);
            let mut edits: Vec<(Range<usize>, String)> = Vec::new();
            let root_tag = &self.text[root.range()];
            let p = tag_name(root_tag).strip_suffix("svg").unwrap_or("");
            let mut gone: Range<usize> = 0..0;
            for node in root.descendants().filter(Node::is_element) {
                let range = node.range();
                if gone.contains(&range.start) {
                    continue;
                }
                if removed.contains(&range.start) {
                    self.check_verbatim(node)?;
                    if kept.contains(&range.start) {
                        edits.push((range.start..range.start, format!("<{p}defs>")));
                        edits.push((range.end..range.end, format!("</{p}defs>")));
                    } else {
                        let before = self.text[..range.start].trim_end_matches([' ', '\t']);
                        let start = before
                            .strip_suffix('\n')
                            .map_or(range.start, |before| before.strip_suffix('\r').unwrap_or(before).len());
                        edits.push((start..range.end, String::new()));
                        gone = range;
                        continue;
                    }
                }
                self.plain_tag(node, &mut edits)?;
            }
            Ok(splice(&self.text, edits))
        })?;
        Document::with_limits(crate::encoding::encode(&text, self.encoding), self.limits.clone())
    }

    /// Takes attributes, classes and declarations of this format off a tag.
    fn plain_tag(&self, node: Node, edits: &mut Vec<(Range<usize>, String)>) -> Result<(), Error> {
        let range = node.range();
        let ours = node.attributes().filter(|a| a.namespace() == Some(NAMESPACE)).map(|a| a.range());
        let class = node.plain_node("class").filter(|class| class.value().contains("rinceau-"));
        let tag = range.start..range.start + start_tag_end(&self.text[range.clone()]).0;
        let declared = declarations(&self.text[tag.clone()]);
        let own: Vec<Range<usize>> = ours
            .chain(declared.into_iter().map(|found| tag.start + found.start..tag.start + found.end))
            .collect();
        if own.is_empty() && class.is_none() {
            return Ok(());
        }
        self.check_verbatim(node)?;
        let with_space = |range: Range<usize>| self.text[..range.start].trim_end().len()..range.end;
        edits.extend(own.into_iter().map(|range| (with_space(range), String::new())));
        if let Some(class) = class {
            let tokens = class.value().split_whitespace().filter(|token| Role::from_class(token).is_none());
            let rest = tokens.collect::<Vec<_>>().join(" ");
            match rest.is_empty() {
                true => edits.push((with_space(class.range()), String::new())),
                false => edits.push((class.range_value(), escaped(&rest).replace('\'', "&#39;"))),
            }
        }
        Ok(())
    }

    /// The artwork alone as nothing but paths in the units of the page, in drawing order: for cutters and
    /// plotters. Text is outlines, clones are shapes. Also what paths cannot say, in words.
    ///
    /// Errors: as [`Document::artwork_only`]; an object that cannot be read.
    pub fn flat(&self) -> Result<(Document, Vec<String>), Error> {
        let clean = self.artwork_only()?;
        // As if all of it were one fixed object: that is read shape by shape.
        let (head, whole) = clean.parse(|xml| {
            let range = xml.root_element().range();
            let element = &clean.text[range.clone()];
            let (tag_end, closes) = start_tag_end(element);
            let head = clean.text[..range.start + tag_end].to_owned();
            if closes {
                return Ok((head, None));
            }
            let p = tag_name(element).strip_suffix("svg").unwrap_or("");
            let (start, end) = (range.start + tag_end + 1, range.start + element.rfind("</").unwrap_or(0));
            let group = format!("<{p}g class=\"{}\">", Role::Fixed.class());
            let edits = vec![(start..start, group), (end..end, format!("</{p}g>"))];
            Ok((head, Some((p.to_owned(), splice(&clean.text, edits)))))
        })?;
        let Some((p, whole)) = whole else { return Ok((clean, Vec::new())) };
        let whole = self.with_text(whole);
        // What cannot be read is left out, and said.
        let (scene, problems) = whole.check()?;
        let mut lost: BTreeMap<&str, usize> = BTreeMap::new();
        let pages = whole.parse(|xml| {
            let clips = |node: &Node| node.plain("overflow").is_none_or(|overflow| overflow == "hidden");
            let pages = xml.root_element().descendants().skip(1);
            Ok(pages.filter(|node| matches!(node.tag_name().name(), "svg" | "symbol") && clips(node)).count())
        })?;
        let decimals = decimals_for(scene.view.size().max_side());
        let mut text = head + ">" + self.newline();
        for part in scene.fixed.iter().flat_map(|fixed| &fixed.parts) {
            part.style.effects().iter().for_each(|effect| *lost.entry(effect).or_default() += 1);
            if part.style.is_picture() || part.style.is_invisible() {
                continue;
            }
            let mut path = part.path.clone();
            path.apply_affine(part.transform);
            let is_fixed_width = part.style.get("vector-effect") == Some("non-scaling-stroke");
            if part.style.stroke_width().is_some() && !is_fixed_width && !is_even(part.transform) {
                *lost.entry("slanted stroke (Path > Stroke to Path keeps it)").or_default() += 1;
            }
            let scale = if is_fixed_width { 1.0 } else { mean_scale(part.transform) };
            let mut style = part.style.scaled(scale, decimals);
            for name in ["fill", "stroke"] {
                if style.get(name).is_some_and(|paint| paint.contains("url(")) {
                    *lost.entry("gradient or pattern").or_default() += 1;
                    style.set(name, "#808080");
                }
            }
            for name in ["marker-start", "marker-mid", "marker-end"] {
                if style.get(name).is_some_and(|marker| marker != "none") {
                    *lost.entry("marker").or_default() += 1;
                    style.set(name, "none");
                }
            }
            text.push_str(&format!("<{p}path"));
            attribute(&mut text, "style", &style.css());
            attribute(&mut text, "d", &path_data(&path, decimals));
            text.push_str("/>");
            text.push_str(self.newline());
        }
        text.push_str(&format!("</{p}svg>"));
        text.push_str(self.newline());
        let flat = Document::with_limits(crate::encoding::encode(&text, self.encoding), self.limits.clone())?;
        let mut notes: Vec<String> = problems
            .iter()
            .map(|problem| match (problem.is_error, &problem.id) {
                (true, Some(id)) => format!("'{id}' is left out: {}", problem.error.sentence()),
                (true, None) => format!("Something is left out: {}", problem.error.sentence()),
                (false, _) => problem.error.sentence().to_owned(),
            })
            .collect();
        if pages > 0 {
            notes.push(format!("{pages} nested pages or symbols no longer cut off what they show"));
        }
        notes.extend(lost.into_iter().map(|(what, count)| {
            let shapes = if count == 1 { "1 shape loses its" } else { &format!("{count} shapes lose their") };
            format!("{shapes} {what}: paths have none")
        }));
        Ok((flat, notes))
    }
}

/// True if a map makes strokes as wide in all directions.
fn is_even(map: kurbo::Affine) -> bool {
    let [a, b, c, d, ..] = map.as_coeffs();
    let (x, y) = (a.hypot(b), c.hypot(d));
    (x - y).abs() <= 1e-3 * x.max(y) && (a * c + b * d).abs() <= 1e-3 * x * y
}

/// Where nodes start that are no artwork, outermost first.
fn removed(root: Node) -> HashSet<usize> {
    let mut removed = HashSet::new();
    let (mut gone, mut result): (Range<usize>, Range<usize>) = (0..0, 0..0);
    for node in root.descendants().skip(1).filter(Node::is_element) {
        let range = node.range();
        if gone.contains(&range.start) {
            continue;
        }
        if node.attribute((NAMESPACE, "result")).is_some() && !result.contains(&range.start) {
            result = range.clone();
        }
        let is_hidden = || {
            node.plain("style").is_some_and(|style| {
                crate::css::declarations(style).any(|d| d.name == "display" && d.value.trim() == "none")
            })
        };
        let is_mark = !result.contains(&range.start) && has_mark(node) && has_role(node);
        let is_ours = node.tag_name().namespace() == Some(NAMESPACE)
            || node.attribute((NAMESPACE, "history")).is_some()
            || node.has_attribute((NAMESPACE, "pieces"))
            || node.plain("id") == Some(ARROW)
            || is_arrows(node);
        if is_mark || is_ours || result.contains(&range.start) && is_hidden() {
            removed.insert(range.start);
            gone = range;
        }
    }
    removed
}

fn has_role(node: Node) -> bool {
    let class = node.plain("class").unwrap_or("");
    node.attribute((NAMESPACE, "role")).is_some()
        || class.split_whitespace().any(|token| Role::from_class(token).is_some())
}

/// True for definitions of the arrow head of guides and nothing else.
fn is_arrows(node: Node) -> bool {
    let mut children = node.children().filter(Node::is_element).peekable();
    node.tag_name().name() == "defs"
        && children.peek().is_some()
        && children.all(|child| child.plain("id") == Some(ARROW))
}

/// Which of the removed nodes hold something that what stays refers to.
fn referred_to(root: Node, removed: &HashSet<usize>) -> HashSet<usize> {
    // Each removed node with the ids in it and the references out of it; what stays has number 0.
    let mut owners: BTreeMap<&str, usize> = BTreeMap::new();
    let mut references: BTreeMap<usize, Vec<String>> = BTreeMap::new();
    let (mut owner, mut inside): (usize, Range<usize>) = (0, 0..0);
    for node in root.descendants() {
        let start = node.range().start;
        if !inside.contains(&start) {
            owner = 0;
            if removed.contains(&start) && node.is_element() {
                (owner, inside) = (start, node.range());
            }
        }
        if let Some(id) = node.plain("id") {
            owners.entry(id).or_insert(owner);
        }
        let list = references.entry(owner).or_default();
        if let Some(href) = node.plain("href").or_else(|| node.attribute((XLINK, "href"))) {
            list.extend(href.trim().strip_prefix('#').map(str::to_owned));
        }
        let values =
            node.attributes().map(|attribute| attribute.value()).filter(|value| value.contains("url("));
        for value in values.chain(node.text().filter(|text| text.contains("url("))) {
            for piece in value.split("url(").skip(1) {
                let name = piece.trim_start_matches([' ', '"', '\'']).strip_prefix('#');
                let end = |name: &str| name.find([')', '"', '\'', ' ']).unwrap_or(name.len());
                list.extend(name.map(|name| name[..end(name)].to_owned()));
            }
        }
    }
    let mut kept = HashSet::new();
    let mut fresh = vec![0];
    while let Some(owner) = fresh.pop() {
        for id in references.get(&owner).into_iter().flatten() {
            if let Some(&target) = owners.get(id.as_str())
                && target != 0
                && kept.insert(target)
            {
                fresh.push(target);
            }
        }
    }
    kept
}

/// Where a tag declares our namespace, under whatever prefixes.
fn declarations(tag: &str) -> Vec<Range<usize>> {
    let mut found = Vec::new();
    // Attribute by attribute, since a value may hold whatever a name does.
    let mut at = tag.find(char::is_whitespace).unwrap_or(tag.len());
    loop {
        at = tag.len() - tag[at..].trim_start().len();
        let Some(equals) = tag[at..].find('=') else { break };
        let value = tag[at + equals + 1..].trim_start();
        let open = tag.len() - value.len();
        let Some(quote) = value.chars().next().filter(|quote| matches!(quote, '"' | '\'')) else { break };
        let Some(length) = value[1..].find(quote) else { break };
        if tag[at..].starts_with("xmlns:") && &value[1..=length] == NAMESPACE {
            found.push(at..open + length + 2);
        }
        at = open + length + 2;
    }
    found
}
