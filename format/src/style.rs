//! Paint carried along: the cascade of presentation attributes, style sheets and `style`.

use crate::css::{self, Sheet};
use crate::units::{Axis, Units};
use crate::xml::PlainAttribute;
use roxmltree::Node;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Which inside a path fills.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum FillRule {
    /// Any winding but zero.
    #[default]
    NonZero,
    /// An odd winding.
    EvenOdd,
}

/// Properties that children inherit, and that a placed copy must carry along.
const INHERITED: [&str; 18] = [
    "color",
    "fill",
    "fill-opacity",
    "fill-rule",
    "marker-end",
    "marker-mid",
    "marker-start",
    "paint-order",
    "stroke",
    "stroke-dasharray",
    "stroke-dashoffset",
    "stroke-linecap",
    "stroke-linejoin",
    "stroke-miterlimit",
    "stroke-opacity",
    "stroke-width",
    "visibility",
    "shape-rendering",
];
/// Inherited properties that only text needs.
const TEXT: [&str; 12] = [
    "font-family",
    "font-size",
    "font-stretch",
    "font-style",
    "font-variant",
    "font-weight",
    "letter-spacing",
    "text-anchor",
    "text-decoration",
    "word-spacing",
    "writing-mode",
    "dominant-baseline",
];
/// Properties of one object alone.
const OWN: [&str; 8] = [
    "clip-path",
    "display",
    "filter",
    "mask",
    "mix-blend-mode",
    "transform",
    "transform-origin",
    "vector-effect",
];
/// What an object or a group around it may have that paint does not carry along, and the
/// property that gives it.
const EFFECTS: [(&str, &str); 4] =
    [("clip-path", "clip"), ("filter", "filter"), ("mask", "mask"), ("mix-blend-mode", "blend mode")];

/// The effect of an image, whose outline is otherwise like a shape's.
pub(crate) const PICTURE: &str = "picture";

/// The colour of the object itself.
const CURRENT_COLOR: &str = "currentColor";

/// A longer value is left out: each object that inherits it writes it out again.
const LONGEST_VALUE: usize = 4096;
/// Widths beyond this many user units are left out, as the coordinates would be.
const WIDEST: f64 = 1e9;

/// True if a property paints, whoever it is given to.
pub(crate) fn is_paint(name: &str) -> bool {
    let is_place = matches!(name, "transform" | "transform-origin");
    (INHERITED.contains(&name) || OWN.contains(&name)) && !is_place
}

/// Red, green and blue of an opaque CSS colour; `None` for anything else, such as a gradient.
pub fn rgb(colour: &str) -> Option<[u8; 3]> {
    let colour: svgtypes::Color = colour.trim().parse().ok()?;
    (colour.alpha == 255).then_some([colour.red, colour.green, colour.blue])
}

/// The computed paint of an object: property names to values, without defaults.
#[derive(Clone, Debug, PartialEq)]
pub struct Style {
    /// Shared, map and values, since a group's children inherit them by the thousand.
    properties: Arc<BTreeMap<&'static str, Arc<str>>>,
    /// Product of the opacities of the object and the groups around it, inside its role.
    opacity: f64,
    /// Font size in px, for `em`.
    font_size: f64,
    /// Effects of the object and the groups around it, inside its role, that paint does not
    /// carry along.
    effects: Vec<&'static str>,
}

impl Default for Style {
    fn default() -> Self {
        Style::initial()
    }
}

impl Style {
    /// The style of the root's parent: SVG's initial values.
    pub(crate) fn initial() -> Self {
        Style { properties: Arc::default(), opacity: 1.0, font_size: 16.0, effects: Vec::new() }
    }

    /// A style that only fills.
    pub fn filled(color: &str) -> Self {
        let mut style = Style::initial();
        style.set("fill", color);
        style
    }

    /// A property's value, if it is not the default.
    pub fn get(&self, name: &str) -> Option<&str> {
        let value = self.properties.get(name).map(AsRef::as_ref)?;
        // It is inherited as the word, and means the colour of whoever inherits it.
        match value == CURRENT_COLOR && name != "color" {
            true => Some(self.get("color").unwrap_or("#000000")),
            false => Some(value),
        }
    }

    /// Sets a property that is carried along; others are ignored.
    pub fn set(&mut self, name: &str, value: &str) {
        if let Some(&name) = INHERITED.iter().chain(&OWN).find(|&&known| known == name) {
            self.put(name, value);
        }
    }

    fn put(&mut self, name: &'static str, value: &str) {
        Arc::make_mut(&mut self.properties).insert(name, value.into());
    }

    fn remove(&mut self, name: &str) {
        if self.properties.contains_key(name) {
            Arc::make_mut(&mut self.properties).remove(name);
        }
    }

    /// What a copy carries along, by the names of CSS: paint, and `opacity`.
    pub fn properties(&self) -> impl Iterator<Item = (&'static str, String)> + '_ {
        let opacity = (self.opacity < 1.0).then(|| ("opacity", self.opacity.to_string()));
        let carried = |&(name, _): &(&'static str, String)| {
            name == "vector-effect" || INHERITED.contains(&name) && !matches!(name, "color" | "visibility")
        };
        let value = |name: &'static str| Some((name, self.get(name)?.to_owned()));
        let properties = self.properties.keys().filter_map(move |&name| value(name));
        properties.filter(carried).chain(opacity)
    }

    /// A style of such properties. Errors: a name that is none of them, or an opacity that is no number;
    /// what is wrong, in words.
    pub fn from_properties(properties: &BTreeMap<String, String>) -> Result<Self, String> {
        let mut style = Style::initial();
        for (name, value) in properties {
            let is_carried = name == "vector-effect"
                || INHERITED.contains(&name.as_str()) && !matches!(name.as_str(), "color" | "visibility");
            match name.as_str() {
                _ if value.len() > LONGEST_VALUE || value.contains([';', '{', '}']) => {
                    return Err(format!("the value of '{name}' is none of CSS"));
                }
                "opacity" => {
                    let opacity = value.parse().ok().filter(|opacity| (0.0..=1.0).contains(opacity));
                    style.opacity = opacity.ok_or_else(|| format!("'{value}' is no opacity"))?;
                }
                name if is_carried => style.set(name, value),
                name => return Err(format!("'{name}' is no property of paint")),
            }
        }
        Ok(style)
    }

    /// Which inside is filled.
    pub fn fill_rule(&self) -> FillRule {
        if self.get("fill-rule") == Some("evenodd") { FillRule::EvenOdd } else { FillRule::NonZero }
    }

    /// True if the fill is painted (SVG fills black by default).
    pub fn is_filled(&self) -> bool {
        self.get("fill") != Some("none")
    }

    /// Stroke width in the object's own units, or `None` if the stroke is not painted.
    pub fn stroke_width(&self) -> Option<f64> {
        if self.get("stroke").is_none_or(|stroke| stroke == "none") {
            return None;
        }
        let width = self.get("stroke-width").and_then(|width| width.parse().ok()).unwrap_or(1.0);
        (width > 0.0).then_some(width)
    }

    /// True if the object itself says that it and its content are not rendered.
    pub(crate) fn is_display_none(&self) -> bool {
        self.get("display") == Some("none")
    }

    pub(crate) fn font_size(&self) -> f64 {
        self.font_size
    }

    /// Opacity and effects of groups around an annotated object belong to those groups, not to
    /// copies.
    pub(crate) fn forget_groups(&mut self) {
        self.opacity = 1.0;
        self.effects.clear();
    }

    /// What the object is drawn with that copies of its shape and paint lack, such as a filter.
    pub fn effects(&self) -> &[&'static str] {
        &self.effects
    }

    /// True for the outline of an image, which is no shape to be painted.
    pub fn is_picture(&self) -> bool {
        self.effects.contains(&PICTURE)
    }

    /// True if the object takes up room but is not drawn.
    pub(crate) fn is_invisible(&self) -> bool {
        matches!(self.get("visibility"), Some("hidden" | "collapse"))
    }

    /// Notes an effect that is no property.
    pub(crate) fn add_effect(&mut self, effect: &'static str) {
        if !self.effects.contains(&effect) {
            self.effects.push(effect);
        }
    }

    /// True if what is drawn depends on where the object's own coordinates lie, as a gradient does.
    pub fn has_paint_server(&self) -> bool {
        ["fill", "stroke"].into_iter().any(|name| self.get(name).is_some_and(|paint| paint.contains("url(")))
    }

    /// True if something is drawn at the nodes of the path.
    pub fn has_markers(&self) -> bool {
        ["marker-start", "marker-mid", "marker-end"]
            .into_iter()
            .any(|name| self.get(name).is_some_and(|marker| marker != "none"))
    }

    /// This style with all widths multiplied, for a copy drawn larger or smaller.
    #[must_use]
    pub fn scaled(&self, factor: f64, decimals: usize) -> Self {
        let mut style = self.clone();
        for name in ["stroke-width", "stroke-dashoffset", "stroke-dasharray"] {
            let Some(value) = self.get(name) else { continue };
            let numbers: Option<Vec<f64>> =
                value.split([' ', ',']).filter(|t| !t.is_empty()).map(|t| t.parse().ok()).collect();
            let Some(numbers) = numbers else { continue };
            let mut text = String::new();
            for number in numbers {
                let scaled = (number * factor).clamp(-WIDEST, WIDEST);
                if !text.is_empty() {
                    text.push(' ');
                }
                crate::number::write_number(&mut text, scaled, decimals);
            }
            style.put(name, &text);
        }
        if factor != 1.0
            && style.get("stroke").is_some_and(|s| s != "none")
            && style.get("stroke-width").is_none()
        {
            let mut text = String::new();
            crate::number::write_number(&mut text, factor.clamp(0.0, WIDEST), decimals);
            style.put("stroke-width", &text);
        }
        style
    }

    /// The text of a `style` attribute that paints the same anywhere.
    pub fn css(&self) -> String {
        let mut out = String::new();
        let mut put = |name: &str, value: &str| {
            if !out.is_empty() {
                out.push(';');
            }
            out.push_str(name);
            out.push(':');
            out.push_str(value);
        };
        put("fill", self.get("fill").unwrap_or("#000000"));
        for name in INHERITED.iter().filter(|&&name| !matches!(name, "fill" | "color" | "visibility")) {
            if let Some(value) = self.get(name) {
                put(name, value);
            }
        }
        if let Some(value) = self.get("vector-effect") {
            put("vector-effect", value);
        }
        if self.opacity < 1.0 {
            let mut text = String::new();
            crate::number::write_number(&mut text, self.opacity, 4);
            put("opacity", &text);
        }
        out
    }

    /// The text of a `style` attribute for a group, so that what is in it inherits this style.
    pub(crate) fn inherited_css(&self) -> String {
        let mut out = self.css();
        for name in ["color", "visibility"] {
            if let Some(value) = self.get(name) {
                out.push_str(&format!(";{name}:{value}"));
            }
        }
        let text = self.text_css();
        if text != Style::initial().text_css() {
            out.push(';');
            out.push_str(&text);
        }
        out
    }

    /// Text properties as a `style` attribute, for the outlines of text.
    pub(crate) fn text_css(&self) -> String {
        let mut out = format!("font-size:{}px", self.font_size);
        for name in TEXT.iter().filter(|&&name| name != "font-size") {
            if let Some(value) = self.get(name) {
                out.push_str(&format!(";{name}:{value}"));
            }
        }
        out
    }
}

/// Properties of one object alone, and their values where nothing is said.
const OWN_INITIAL: [(&str, &str); 7] = [
    ("clip-path", "none"),
    ("display", "inline"),
    ("filter", "none"),
    ("mask", "none"),
    ("mix-blend-mode", "normal"),
    ("opacity", "1"),
    ("vector-effect", "none"),
];
/// The same of inherited properties; `fill` is always written.
const INHERITED_INITIAL: [(&str, &str); 16] = [
    ("fill-opacity", "1"),
    ("fill-rule", "nonzero"),
    ("marker-end", "none"),
    ("marker-mid", "none"),
    ("marker-start", "none"),
    ("paint-order", "normal"),
    ("shape-rendering", "auto"),
    ("stroke", "none"),
    ("stroke-dasharray", "none"),
    ("stroke-dashoffset", "0"),
    ("stroke-linecap", "butt"),
    ("stroke-linejoin", "miter"),
    ("stroke-miterlimit", "4"),
    ("stroke-opacity", "1"),
    ("stroke-width", "1"),
    ("visibility", "visible"),
];

/// What a drawing's rules would change in shapes that are added to it, and the values against it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Guard {
    own: Vec<(&'static str, &'static str)>,
    inherited: Vec<(&'static str, &'static str)>,
}

impl Guard {
    /// The style of a shape, with all that it does not say itself.
    pub fn shape<'t>(&self, css: &'t str) -> Cow<'t, str> {
        guarded(css, self.own.iter().chain(&self.inherited))
    }

    /// The style of a group or a clone.
    pub fn group<'t>(&self, css: &'t str) -> Cow<'t, str> {
        guarded(css, self.own.iter())
    }
}

fn guarded<'t, 'g>(
    css: &'t str,
    guard: impl Iterator<Item = &'g (&'static str, &'static str)>,
) -> Cow<'t, str> {
    let mut out = Cow::Borrowed(css);
    for (name, value) in guard {
        let mut said = css.split(';').filter_map(|declaration| declaration.split_once(':'));
        if !said.any(|(own, _)| own == *name) {
            let text = out.to_mut();
            if !text.is_empty() {
                text.push(';');
            }
            text.push_str(name);
            text.push(':');
            text.push_str(value);
        }
    }
    out
}

/// All style sheets of a drawing.
pub(crate) struct Cascade<'a> {
    sheet: Sheet<'a>,
}

impl<'a> Cascade<'a> {
    pub fn new(sheets: &[&'a str]) -> Self {
        Cascade { sheet: Sheet::new(sheets) }
    }

    /// True once matching selectors has taken longer than any drawing needs.
    pub fn is_exhausted(&self) -> bool {
        self.sheet.is_exhausted()
    }

    /// The computed style of a node inside a parent's.
    pub fn computed(&self, node: Node<'a, '_>, parent: &Style, units: &Units) -> Style {
        let mut style = parent.clone();
        for name in OWN {
            style.remove(name);
        }
        let declared = self.declared(node);
        // What other properties of the same object refer to comes first.
        for &(name, value) in &declared {
            match name {
                "font-size" => style.font_size = font_size(value, parent, units).unwrap_or(style.font_size),
                "color" => set_property(&mut style, parent, "color", value.trim(), units),
                _ => {}
            }
        }
        let units = Units { em: style.font_size, viewport: units.viewport };
        let mut opacity = 1.0;
        for (name, value) in declared {
            if name == "opacity" {
                opacity = parse_opacity(value).unwrap_or(1.0);
            } else if name == "marker" {
                for name in ["marker-start", "marker-mid", "marker-end"] {
                    set_property(&mut style, parent, name, value.trim(), &units);
                }
            } else if !matches!(name, "color" | "font-size")
                && let Some(&name) = INHERITED.iter().chain(&TEXT).chain(&OWN).find(|&&known| known == name)
            {
                set_property(&mut style, parent, name, value.trim(), &units);
            }
        }
        for (name, effect) in EFFECTS {
            if style.get(name).is_some_and(|value| !matches!(value, "none" | "normal" | "")) {
                style.add_effect(effect);
            }
        }
        if opacity < 1.0 && node.children().filter(Node::is_element).count() > 1 {
            style.add_effect("opacity as a group");
        }
        style.opacity = parent.opacity * opacity;
        style
    }

    /// Declarations that keep rules of the drawing from reaching what is added to it.
    pub fn guard(&self) -> Guard {
        let declared = |list: &[(&'static str, &'static str)]| {
            let is_declared = |name: &str| {
                self.sheet.declares(name) || name.starts_with("marker-") && self.sheet.declares("marker")
            };
            list.iter().filter(|(name, _)| is_declared(name)).copied().collect()
        };
        Guard { own: declared(&OWN_INITIAL), inherited: declared(&INHERITED_INITIAL) }
    }

    /// What rules say of a node, as the start of a `style` attribute, if some of them are for its id.
    pub fn rules_by_id(&self, node: Node<'a, '_>) -> String {
        let declarations = self.sheet.matching_by_id(node);
        declarations
            .iter()
            .map(|d| {
                let important = if d.important { "!important" } else { "" };
                format!("{}:{}{important};", d.name, d.value)
            })
            .collect()
    }

    /// Declarations from weakest to strongest: attributes, rules, `style`, then `!important`.
    fn declared(&self, node: Node<'a, '_>) -> Vec<(&'a str, &'a str)> {
        let mut declared: Vec<(&str, &str)> = node
            .attributes()
            .filter(|a| a.namespace().is_none() && a.value().len() <= LONGEST_VALUE)
            .map(|a| (a.name(), a.value()))
            .filter(|&(name, _)| name != "style" && name != "transform")
            .collect();
        let mut important = Vec::new();
        let style = css::declarations(node.plain("style").unwrap_or(""));
        for d in self.sheet.matching(node).into_iter().chain(style) {
            let list = if d.important { &mut important } else { &mut declared };
            list.push((d.name, d.value));
        }
        declared.extend(important);
        declared
    }
}

/// A font size in px.
fn font_size(value: &str, parent: &Style, units: &Units) -> Option<f64> {
    let value = value.trim();
    let percent = value.strip_suffix('%').and_then(|percent| percent.parse::<f64>().ok());
    let size = match percent {
        Some(percent) => percent / 100.0 * parent.font_size,
        None => Units { em: parent.font_size, viewport: units.viewport }.resolve(value, Axis::Y)?,
    };
    (0.0..=WIDEST).contains(&size).then_some(size)
}

fn set_property(style: &mut Style, parent: &Style, name: &'static str, value: &str, units: &Units) {
    // No value of these properties has any of these, and a style that it is written into would
    // say something else.
    if value.contains([';', '{', '}']) {
        return;
    }
    if value == "inherit" {
        match parent.properties.get(name) {
            Some(inherited) => style.put(name, inherited),
            None => style.remove(name),
        }
        return;
    }
    let value = match name {
        "stroke-width" | "stroke-dashoffset" => match units.resolve(value, Axis::Diagonal) {
            // One beyond all measure is refused with the coordinates.
            Some(width) => width.clamp(-f64::MAX, f64::MAX).to_string(),
            None => return,
        },
        "stroke-dasharray" if value != "none" => {
            let lengths: Option<Vec<String>> = value
                .split([' ', ','])
                .filter(|t| !t.is_empty())
                .map(|t| units.resolve(t, Axis::Diagonal))
                .map(|length| length.filter(|l| l.abs() <= WIDEST).map(|l| l.to_string()))
                .collect();
            match lengths {
                Some(lengths) => lengths.join(" "),
                None => return,
            }
        }
        "color" if value.eq_ignore_ascii_case(CURRENT_COLOR) => return,
        _ if value.eq_ignore_ascii_case(CURRENT_COLOR) => CURRENT_COLOR.to_owned(),
        _ => value.to_owned(),
    };
    style.put(name, &value);
}

fn parse_opacity(text: &str) -> Option<f64> {
    let text = text.trim();
    let value = match text.strip_suffix('%') {
        Some(percent) => percent.parse::<f64>().ok()? / 100.0,
        None => text.parse::<f64>().ok()?,
    };
    value.is_finite().then(|| value.clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn computed(xml: &str, sheet: &str) -> Style {
        let document = roxmltree::Document::parse(xml).unwrap();
        let units = Units { viewport: kurbo::Size::new(100.0, 100.0), em: 16.0 };
        let cascade = Cascade::new(&[sheet]);
        let root = cascade.computed(document.root_element(), &Style::initial(), &units);
        let leaf = document.descendants().rfind(Node::is_element).unwrap();
        cascade.computed(leaf, &root, &units)
    }

    #[test]
    fn later_and_more_specific_declarations_win() {
        let style = computed(
            "<g fill='red' opacity='.5'><path class='a' stroke='blue' stroke-width='1%' style='stroke-opacity:.5;opacity:50%'/></g>",
            ".a{stroke:lime} path{stroke:black}",
        );
        assert_eq!(style.css(), "fill:red;stroke:lime;stroke-opacity:.5;stroke-width:1;opacity:0.25");
    }

    #[test]
    fn current_color_and_important() {
        let style = computed(
            "<g color='teal'><path fill='currentColor' style='stroke:red'/></g>",
            "path{stroke:blue !important}",
        );
        assert_eq!((style.get("fill"), style.get("stroke")), (Some("teal"), Some("blue")));
        let style = computed("<g color='teal' fill='currentColor'><path color='gold'/></g>", "");
        assert_eq!(style.css(), "fill:gold");
    }

    #[test]
    fn an_objects_own_color_and_font_size_come_first() {
        let style = computed(
            "<g color='teal' font-size='10'><path fill='currentColor' stroke='red' stroke-width='2em' font-size='150%' color='gold'/></g>",
            "",
        );
        assert_eq!(style.css(), "fill:gold;stroke:red;stroke-width:30");
    }

    #[test]
    fn effects_are_known_and_a_value_cannot_end_a_declaration() {
        let style = computed(
            "<g filter='url(#f)' opacity='.5'><path fill='red;stroke:blue' style='clip-path:url(#c);mask:none'/><path/></g>",
            "",
        );
        assert_eq!(style.effects(), ["filter", "opacity as a group"]);
        let style = computed("<g><path fill='red;stroke:blue' style='clip-path:url(#c);mask:none'/></g>", "");
        assert_eq!((style.effects(), style.css().as_str()), (&["clip"][..], "fill:#000000"));
    }

    #[test]
    fn a_guard_says_what_a_style_leaves_out() {
        let guard = Cascade::new(&["path{stroke:lime;opacity:.5} #a{marker:url(#m)}"]).guard();
        assert_eq!(
            guard.shape("fill:red;marker-mid:url(#n)"),
            "fill:red;marker-mid:url(#n);opacity:1;marker-end:none;marker-start:none;stroke:none"
        );
        assert_eq!(guard.group(""), "opacity:1");
    }

    #[test]
    fn scaling_scales_every_width() {
        let style = computed("<g><path stroke='red' stroke-dasharray='1,2' fill='none'/></g>", "");
        assert_eq!(style.scaled(2.0, 3).css(), "fill:none;stroke:red;stroke-dasharray:2 4;stroke-width:2");
    }
}
