//! Paint carried along: the cascade of presentation attributes, style sheets and `style`.

use crate::units::{Axis, Units};
use roxmltree::Node;
use simplecss::{AttributeOperator, PseudoClass, StyleSheet};
use std::collections::BTreeMap;

/// Which inside a path fills.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FillRule {
    /// Any winding but zero.
    #[default]
    NonZero,
    /// An odd winding.
    EvenOdd,
}

/// Properties that children inherit, and that a placed copy must carry along.
const INHERITED: [&str; 15] = [
    "color",
    "fill",
    "fill-opacity",
    "fill-rule",
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
const OWN: [&str; 4] = ["display", "vector-effect", "transform", "transform-origin"];

/// The computed paint of an object: property names to values, without defaults.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Style {
    properties: BTreeMap<&'static str, String>,
    /// Product of the opacities of the object and the groups around it, inside its role.
    opacity: f64,
    /// Font size in px, for `em`.
    font_size: f64,
}

impl Style {
    /// The style of the root's parent: SVG's initial values.
    pub(crate) fn initial() -> Self {
        Style { properties: BTreeMap::new(), opacity: 1.0, font_size: 16.0 }
    }

    /// A style that only fills.
    pub fn filled(color: &str) -> Self {
        let mut style = Style::initial();
        style.set("fill", color);
        style
    }

    /// A property's value, if it is not the default.
    pub fn get(&self, name: &str) -> Option<&str> {
        self.properties.get(name).map(String::as_str)
    }

    /// Sets a property that is carried along; others are ignored.
    pub fn set(&mut self, name: &str, value: &str) {
        if let Some(&name) = INHERITED.iter().chain(&OWN).find(|&&known| known == name) {
            self.properties.insert(name, value.to_owned());
        }
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

    /// Opacity of groups around an annotated object belongs to those groups, not to copies.
    pub(crate) fn forget_opacity(&mut self) {
        self.opacity = 1.0;
    }

    /// This style with all widths multiplied, for a copy drawn larger or smaller.
    #[must_use]
    pub fn scaled(&self, factor: f64, decimals: usize) -> Self {
        let mut style = self.clone();
        for name in ["stroke-width", "stroke-dashoffset", "stroke-dasharray"] {
            let Some(value) = style.properties.get_mut(name) else { continue };
            let numbers: Option<Vec<f64>> =
                value.split([' ', ',']).filter(|t| !t.is_empty()).map(|t| t.parse().ok()).collect();
            let Some(numbers) = numbers else { continue };
            let mut text = String::new();
            for number in numbers {
                if !text.is_empty() {
                    text.push(' ');
                }
                crate::number::write_number(&mut text, number * factor, decimals);
            }
            *value = text;
        }
        if factor != 1.0
            && style.get("stroke").is_some_and(|s| s != "none")
            && style.get("stroke-width").is_none()
        {
            let mut text = String::new();
            crate::number::write_number(&mut text, factor, decimals);
            style.properties.insert("stroke-width", text);
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

/// All style sheets of a drawing.
pub(crate) struct Cascade<'a> {
    sheet: StyleSheet<'a>,
}

impl<'a> Cascade<'a> {
    pub fn new(sheets: &[&'a str]) -> Self {
        let mut sheet = StyleSheet::new();
        for text in sheets {
            sheet.parse_more(text);
        }
        Cascade { sheet }
    }

    /// The computed style of a node inside a parent's.
    pub fn computed(&self, node: Node, parent: &Style, units: &Units) -> Style {
        let mut style = parent.clone();
        for name in OWN {
            style.properties.remove(name);
        }
        let mut opacity = 1.0;
        for (name, value) in self.declared(node) {
            if name == "opacity" {
                opacity = parse_opacity(&value).unwrap_or(1.0);
            } else if name == "font-size" {
                let relative = Units { em: parent.font_size, viewport: units.viewport };
                let percent = value
                    .trim()
                    .strip_suffix('%')
                    .and_then(|p| p.parse::<f64>().ok())
                    .map(|p| p / 100.0 * parent.font_size);
                if let Some(size) = percent
                    .or_else(|| relative.resolve(&value, Axis::Y))
                    .filter(|s| s.is_finite() && *s >= 0.0)
                {
                    style.font_size = size;
                }
            } else if let Some(&name) =
                INHERITED.iter().chain(&TEXT).chain(&OWN).find(|&&known| known == name)
            {
                set_property(&mut style, parent, name, value.trim(), units);
            }
        }
        style.opacity = parent.opacity * opacity;
        style
    }

    /// Declarations from weakest to strongest: attributes, rules, `style`, then `!important`.
    fn declared(&self, node: Node) -> Vec<(String, String)> {
        let mut declared = Vec::new();
        let mut important = Vec::new();
        for attribute in node.attributes().filter(|a| a.namespace().is_none()) {
            if attribute.name() != "style" && attribute.name() != "transform" {
                declared.push((attribute.name().to_owned(), attribute.value().to_owned()));
            }
        }
        let mut put = |d: &simplecss::Declaration| {
            let list = if d.important { &mut important } else { &mut declared };
            list.push((d.name.to_owned(), d.value.to_owned()));
        };
        let element = CssNode(node);
        for rule in &self.sheet.rules {
            if rule.selector.matches(&element) {
                rule.declarations.iter().for_each(&mut put);
            }
        }
        if let Some(style) = node.attribute("style") {
            for declaration in simplecss::DeclarationTokenizer::from(style) {
                put(&declaration);
            }
        }
        declared.extend(important);
        declared
    }
}

fn set_property(style: &mut Style, parent: &Style, name: &'static str, value: &str, units: &Units) {
    if value == "inherit" {
        match parent.properties.get(name) {
            Some(inherited) => style.properties.insert(name, inherited.clone()),
            None => style.properties.remove(name),
        };
        return;
    }
    let value = match name {
        "stroke-width" | "stroke-dashoffset" => match units.resolve(value, Axis::Diagonal) {
            Some(width) if width.is_finite() => width.to_string(),
            _ => return,
        },
        "stroke-dasharray" if value != "none" => {
            let lengths: Option<Vec<String>> = value
                .split([' ', ','])
                .filter(|t| !t.is_empty())
                .map(|t| units.resolve(t, Axis::Diagonal).map(|l| l.to_string()))
                .collect();
            match lengths {
                Some(lengths) => lengths.join(" "),
                None => return,
            }
        }
        _ if value.eq_ignore_ascii_case("currentColor") => style.get("color").unwrap_or("#000000").to_owned(),
        _ => value.to_owned(),
    };
    style.properties.insert(name, value);
}

fn parse_opacity(text: &str) -> Option<f64> {
    let text = text.trim();
    let value = match text.strip_suffix('%') {
        Some(percent) => percent.parse::<f64>().ok()? / 100.0,
        None => text.parse::<f64>().ok()?,
    };
    value.is_finite().then(|| value.clamp(0.0, 1.0))
}

/// A node as simplecss wants to see it.
struct CssNode<'a, 'i>(Node<'a, 'i>);

impl simplecss::Element for CssNode<'_, '_> {
    fn parent_element(&self) -> Option<Self> {
        self.0.parent_element().map(CssNode)
    }

    fn prev_sibling_element(&self) -> Option<Self> {
        self.0.prev_sibling_element().map(CssNode)
    }

    fn has_local_name(&self, name: &str) -> bool {
        self.0.tag_name().name() == name
    }

    fn attribute_matches(&self, local_name: &str, operator: AttributeOperator) -> bool {
        self.0.attribute(local_name).is_some_and(|value| operator.matches(value))
    }

    fn pseudo_class_matches(&self, class: PseudoClass) -> bool {
        matches!(class, PseudoClass::FirstChild) && self.0.prev_sibling_element().is_none()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn computed(xml: &str, sheet: &str) -> Style {
        let document = roxmltree::Document::parse(xml).unwrap();
        let units = Units { viewport: kurbo::Size::new(100.0, 100.0), em: 16.0 };
        let cascade = Cascade::new(&[sheet]);
        let root = cascade.computed(document.root_element(), &Style::initial(), &units);
        let leaf = document.descendants().filter(Node::is_element).last().unwrap();
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
    }

    #[test]
    fn scaling_scales_every_width() {
        let style = computed("<g><path stroke='red' stroke-dasharray='1,2' fill='none'/></g>", "");
        assert_eq!(style.scaled(2.0, 3).css(), "fill:none;stroke:red;stroke-dasharray:2 4;stroke-width:2");
    }
}
