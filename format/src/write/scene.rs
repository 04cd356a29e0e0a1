//! A scene as an annotated drawing of its own.

use super::{attribute, escaped};
use crate::artwork::Part;
use crate::json::{self, exact_path_data};
use crate::look;
use crate::scene::{Form, FormItem, Guide, Scene, Seed, Source, When};
use crate::style::{FillRule, Style};
use crate::vocabulary::{NAMESPACE, Role};
use kurbo::{Affine, BezPath};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::fmt::Write;

/// The text of a drawing that reads as this scene, number for number. Marked objects look as
/// [`Document::with_role`](crate::Document::with_role) makes them look, but for what is drawn in them.
pub(crate) fn drawing(scene: &Scene) -> String {
    let mut out = Drawing { is_marked: true, ..Drawing::default() };
    if !scene.forms.is_empty() {
        json::each_source(&mut scene.clone(), |source| {
            out.taken.insert(source.id.clone());
        });
    }
    out.page(scene, Drawing::all)
}

/// A scene as a diagram without marks, in which colours tell what is what; and what is left out, in words.
pub(crate) fn diagram(scene: &Scene) -> (String, Vec<String>) {
    let text = Drawing::default().page(scene, Drawing::inks);
    let others = [
        ("stems", scene.stems.len()),
        ("seeds", scene.seeds.len()),
        ("tacks", scene.tacks.len()),
        ("boundaries", scene.boundaries.len()),
        ("sprays", scene.sprays.len()),
        ("forms", scene.forms.len()),
        ("references", scene.references.len()),
        ("rules", scene.rules.len()),
    ];
    let lost = others.into_iter().filter(|(_, count)| *count > 0);
    (
        text,
        lost.map(|(what, count)| format!("{count} {what} have no colour in a diagram and are left out"))
            .collect(),
    )
}

/// A drawing while it is written.
#[derive(Default)]
struct Drawing {
    text: String,
    /// False for a diagram.
    is_marked: bool,
    /// Ids that are written.
    ids: HashSet<String>,
    /// Ids of the scene's objects, where others are made up.
    taken: HashSet<String>,
    /// The last number that was made up for each.
    numbers: HashMap<String, usize>,
}

impl Drawing {
    fn page(mut self, scene: &Scene, content: impl FnOnce(&mut Self, &Scene)) -> String {
        let out = &mut self;
        let view = scene.view;
        let (wide, tall) = (view.width() * scene.px_per_unit, view.height() * scene.px_per_unit);
        let _ = writeln!(
            out.text,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" \
         xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" xmlns:rinceau=\"{NAMESPACE}\" \
         width=\"{wide}\" height=\"{tall}\" viewBox=\"{} {} {} {}\">",
            view.x0,
            view.y0,
            view.width(),
            view.height()
        );
        if !scene.guides.is_empty() {
            out.text.push_str(&look::arrow(""));
            out.text.push('\n');
        }
        content(out, scene);
        out.text.push_str("</svg>\n");
        self.text
    }

    fn all(&mut self, scene: &Scene) {
        if !scene.rules.is_empty() {
            self.text.push_str("<metadata>\n");
            for rules in &scene.rules {
                self.text.push_str("<rinceau:rules");
                attribute(&mut self.text, "name", &rules.name);
                let _ = writeln!(self.text, ">{}</rinceau:rules>", escaped_text(&rules.text));
            }
            self.text.push_str("</metadata>\n");
        }
        self.containers(scene);
        for fixed in &scene.fixed {
            self.group(&fixed.source, Role::Fixed, &fixed.parts);
        }
        self.lines(&scene.guides, Role::Guide);
        self.lines(&scene.fixed_spines, Role::FixedSpine);
        self.lines(&scene.stems, Role::Stem);
        self.lines(&scene.boundaries, Role::Boundary);
        for spray in &scene.sprays {
            self.open("path", &spray.source, Some(Role::Spray), &spray.overrides);
            let style = format!("{};stroke:#808080;stroke-width:{}", look::style(Role::Spray), spray.width);
            attribute(&mut self.text, "style", &style);
            self.path(&spray.path);
        }
        self.points(&scene.seeds, Role::Seed);
        self.points(&scene.tacks, Role::Tack);
        self.elements(scene);
        for reference in &scene.references {
            self.open("g", &reference.source, Some(Role::Reference), &BTreeMap::new());
            if !reference.flips.is_empty() {
                let pairs: Vec<String> = reference.flips.iter().map(|(a, b)| format!("{a} {b}")).collect();
                attribute(&mut self.text, "rinceau:flip", &pairs.join(" "));
            }
            self.text.push_str(">\n");
            for example in &reference.examples {
                self.open("g", &example.source, None, &BTreeMap::new());
                attribute(&mut self.text, "rinceau:symbol", &example.symbol);
                self.text.push_str(">\n");
                example.parts.iter().for_each(|part| self.part(part));
                self.text.push_str("</g>\n");
            }
            self.text.push_str("</g>\n");
        }
        self.forms(&scene.forms);
    }

    /// What a diagram has a colour for.
    fn inks(&mut self, scene: &Scene) {
        self.containers(scene);
        for fixed in &scene.fixed {
            let green = |part: &Part| {
                let mut style = Style::filled("#00aa00");
                for name in ["fill-rule", "stroke-width"] {
                    part.style.get(name).into_iter().for_each(|value| style.set(name, value));
                }
                if part.style.stroke_width().is_some() {
                    style.set("stroke", "#00aa00");
                }
                Part { style, ..part.clone() }
            };
            self.group(&fixed.source, Role::Fixed, &fixed.parts.iter().map(green).collect::<Vec<_>>());
        }
        self.lines(&scene.guides, Role::Guide);
        self.lines(&scene.fixed_spines, Role::FixedSpine);
        self.elements(scene);
    }

    fn containers(&mut self, scene: &Scene) {
        for container in &scene.containers {
            let paint = container.fill.as_deref().filter(|_| self.is_marked).unwrap_or("none");
            let style = |rule: FillRule| match rule {
                FillRule::EvenOdd => format!("fill:{paint};stroke:#000000;fill-rule:evenodd"),
                FillRule::NonZero => format!("fill:{paint};stroke:#000000"),
            };
            if let [outline] = &container.outlines[..] {
                self.open("path", &container.source, Some(Role::Container), &container.overrides);
                attribute(&mut self.text, "style", &style(outline.rule));
                self.path(&outline.path);
                continue;
            }
            self.open("g", &container.source, Some(Role::Container), &container.overrides);
            self.text.push_str(">\n");
            for outline in &container.outlines {
                self.text.push_str("<path");
                attribute(&mut self.text, "style", &style(outline.rule));
                self.path(&outline.path);
            }
            self.text.push_str("</g>\n");
        }
    }

    fn elements(&mut self, scene: &Scene) {
        for element in &scene.elements {
            self.open("g", &element.source, Some(Role::Element), &BTreeMap::new());
            if !element.kind.is_empty() && self.is_marked {
                attribute(&mut self.text, "rinceau:kind", &element.kind);
            }
            if element.symbol != element.source.id && self.is_marked {
                attribute(&mut self.text, "rinceau:symbol", &element.symbol);
            }
            if !element.sets.is_empty() && self.is_marked {
                attribute(&mut self.text, "rinceau:set", &element.sets.join(" "));
            }
            self.text.push_str(">\n");
            element.template.parts.iter().for_each(|part| self.part(part));
            if let Some((base, tip)) = element.template.spine {
                let mut line = BezPath::new();
                line.move_to(base);
                line.line_to(tip);
                self.text.push_str("<path");
                if self.is_marked {
                    attribute(&mut self.text, "class", &Role::Spine.class());
                }
                attribute(&mut self.text, "style", &look::style(Role::Spine));
                self.path(&line);
            }
            self.text.push_str("</g>\n");
        }
    }

    /// A tag up to its first own attribute.
    fn open(&mut self, tag: &str, source: &Source, role: Option<Role>, overrides: &BTreeMap<String, String>) {
        let _ = write!(self.text, "<{tag}");
        if self.ids.insert(source.id.clone()) {
            attribute(&mut self.text, "id", &source.id);
        }
        if source.label != source.id {
            attribute(&mut self.text, "inkscape:label", &source.label);
        }
        if let Some(role) = role.filter(|_| self.is_marked) {
            attribute(&mut self.text, "class", &role.class());
            attribute(&mut self.text, "rinceau:role", role.name());
        }
        for (name, value) in overrides.iter().filter(|_| self.is_marked) {
            attribute(&mut self.text, &format!("rinceau:{name}"), value);
        }
    }

    /// The path of an open tag, and its end.
    fn path(&mut self, path: &BezPath) {
        let _ = writeln!(self.text, " d=\"{}\"/>", exact_path_data(path));
    }

    fn lines(&mut self, guides: &[Guide], role: Role) {
        for guide in guides {
            self.open("path", &guide.source, Some(role), &BTreeMap::new());
            attribute(&mut self.text, "style", &look::style(role));
            self.path(&guide.path);
        }
    }

    fn points(&mut self, points: &[Seed], role: Role) {
        for point in points {
            self.open("path", &point.source, Some(role), &BTreeMap::new());
            attribute(&mut self.text, "style", "stroke:#ff7f00;stroke-width:4;stroke-linecap:round");
            // A line of no length is a dot where ends are round.
            let mut dot = BezPath::new();
            dot.move_to(point.at);
            dot.line_to(point.at);
            self.path(&dot);
        }
    }

    fn group(&mut self, source: &Source, role: Role, parts: &[Part]) {
        self.open("g", source, Some(role), &BTreeMap::new());
        self.text.push_str(">\n");
        parts.iter().for_each(|part| self.part(part));
        self.text.push_str("</g>\n");
    }

    fn part(&mut self, part: &Part) {
        self.text.push_str("<path");
        self.painted(part);
    }

    fn painted(&mut self, part: &Part) {
        if part.transform != Affine::IDENTITY {
            attribute(&mut self.text, "transform", &exact_matrix(part.transform));
        }
        attribute(&mut self.text, "style", &style_text(&part.style));
        self.path(&part.path);
    }

    /// Display lists. Clones are of the first shape of what they repeat, which stands for all of it.
    fn forms(&mut self, forms: &[Form]) {
        let mut firsts: Vec<Option<String>> = Vec::new();
        for form in forms {
            let has_shape = form.items.iter().any(|item| matches!(item, FormItem::Primitive(_)));
            firsts.push(has_shape.then(|| self.free_id(&form.source.id)));
        }
        for (index, form) in forms.iter().enumerate() {
            self.open("g", &form.source, Some(Role::Form), &form.overrides);
            self.text.push_str(">\n");
            let mut first = firsts[index].clone();
            for item in &form.items {
                match item {
                    FormItem::Primitive(primitive) => {
                        self.text.push_str("<path");
                        let id = first.take().unwrap_or_else(|| self.free_id(&form.source.id));
                        attribute(&mut self.text, "id", &id);
                        match primitive.when {
                            When::AsForm => {}
                            When::Last => attribute(&mut self.text, "rinceau:generations", "last"),
                            When::Inner => attribute(&mut self.text, "rinceau:generations", "inner"),
                        }
                        self.painted(&primitive.part);
                    }
                    FormItem::Clone(clone) => {
                        let tag = if firsts[clone.form].is_some() { "use" } else { "path" };
                        self.open(tag, &clone.source, Some(Role::Clone), &BTreeMap::new());
                        match &firsts[clone.form] {
                            Some(first) => attribute(&mut self.text, "xlink:href", &format!("#{first}")),
                            None => {
                                attribute(&mut self.text, "rinceau:of", &forms[clone.form].source.id);
                                attribute(&mut self.text, "d", "M0,0");
                            }
                        }
                        attribute(&mut self.text, "transform", &exact_matrix(clone.transform));
                        self.text.push_str("/>\n");
                    }
                }
            }
            self.text.push_str("</g>\n");
        }
    }

    fn free_id(&mut self, of: &str) -> String {
        let of = of.replace([' ', '\t', '\n', '\r'], "_");
        let number = self.numbers.entry(of.clone()).or_insert(0);
        loop {
            *number += 1;
            let id = format!("{of}-{number}");
            if !self.taken.contains(&id) && self.ids.insert(id.clone()) {
                return id;
            }
        }
    }
}

fn exact_matrix(transform: Affine) -> String {
    let numbers: Vec<String> = transform.as_coeffs().iter().map(f64::to_string).collect();
    format!("matrix({})", numbers.join(" "))
}

fn style_text(style: &Style) -> String {
    let pairs: Vec<String> = style.properties().map(|(name, value)| format!("{name}:{value}")).collect();
    pairs.join(";")
}

/// Text between tags.
fn escaped_text(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for line in text.split_inclusive('\n') {
        let (line, end) = line.strip_suffix('\n').map_or((line, ""), |line| (line, "\n"));
        out.push_str(&escaped(line));
        out.push_str(end);
    }
    out
}
