//! Outlines of annotated text. Laying out text is usvg's business; it gets a minimal drawing
//! with this text alone, in a thread with a stack of its own.

use crate::read::Resolver;
use crate::style::Style;
use kurbo::{BezPath, Point};
use roxmltree::Node;
use std::sync::Arc;
use usvg::tiny_skia_path::PathSegment;
use xmlwriter::XmlWriter;

/// Spans inside spans, and characters, that are laid out at most.
const DEEPEST: usize = 64;
const LONGEST: usize = 20_000;
const STACK: usize = 64 << 20;

/// The outlines of a text element in its own coordinates. Err says what is missing.
pub(crate) fn outlines(node: Node, style: &Style, resolver: &Resolver) -> Result<Vec<BezPath>, String> {
    let mut xml = XmlWriter::new(xmlwriter::Options {
        indent: xmlwriter::Indent::None,
        ..xmlwriter::Options::default()
    });
    xml.start_element("svg");
    xml.write_attribute("xmlns", crate::vocabulary::SVG);
    xml.write_attribute("width", "100");
    xml.write_attribute("height", "100");
    xml.set_preserve_whitespaces(true);
    let mut budget = LONGEST;
    write_text(&mut xml, node, style, resolver, (DEEPEST, &mut budget))?;
    let svg = xml.end_document();
    let thread = std::thread::Builder::new()
        .stack_size(STACK)
        .spawn(move || lay_out(&svg))
        .map_err(|error| error.to_string())?;
    thread.join().map_err(|_| "it cannot be laid out".to_owned())?
}

fn write_text(
    xml: &mut XmlWriter,
    node: Node,
    style: &Style,
    resolver: &Resolver,
    (depth, budget): (usize, &mut usize),
) -> Result<(), String> {
    if depth == 0 {
        return Err(format!("its spans are nested more than {DEEPEST} deep"));
    }
    xml.start_element(if node.tag_name().name() == "text" { "text" } else { "tspan" });
    for name in ["x", "y", "dx", "dy", "rotate", "textLength", "lengthAdjust"] {
        if let Some(value) = node.attribute(name) {
            xml.write_attribute(name, value);
        }
    }
    xml.write_attribute("style", &style.text_css());
    xml.write_attribute(
        "xml:space",
        node.attribute(("http://www.w3.org/XML/1998/namespace", "space")).unwrap_or("default"),
    );
    for child in node.children() {
        if child.is_text() {
            let text = child.text().unwrap_or("");
            *budget = budget.checked_sub(text.len()).ok_or(format!("it is longer than {LONGEST} bytes"))?;
            xml.write_text(text);
        } else if child.is_element() && child.tag_name().name() == "tspan" {
            let units = crate::units::Units { viewport: resolver.view.size(), em: style.font_size() };
            let style = resolver.cascade.computed(child, style, &units);
            write_text(xml, child, &style, resolver, (depth - 1, budget))?;
        }
    }
    xml.end_element();
    Ok(())
}

fn lay_out(svg: &str) -> Result<Vec<BezPath>, String> {
    let mut options = usvg::Options::default();
    Arc::make_mut(&mut options.fontdb).load_system_fonts();
    let tree = usvg::Tree::from_str(svg, &options).map_err(|error| error.to_string())?;
    let mut paths = Vec::new();
    let mut groups = vec![tree.root()];
    while let Some(group) = groups.pop() {
        for child in group.children() {
            match child {
                usvg::Node::Group(group) => groups.push(group),
                usvg::Node::Path(path) => paths.push(kurbo_path(path)),
                usvg::Node::Text(text) => groups.push(text.flattened()),
                usvg::Node::Image(_) => {}
            }
        }
    }
    if paths.is_empty() { Err("its font is not installed".into()) } else { Ok(paths) }
}

fn kurbo_path(path: &usvg::Path) -> BezPath {
    let transform = path.abs_transform();
    let point = |p: usvg::tiny_skia_path::Point| {
        let mut p = p;
        transform.map_point(&mut p);
        Point::new(f64::from(p.x), f64::from(p.y))
    };
    let mut out = BezPath::new();
    for segment in path.data().segments() {
        match segment {
            PathSegment::MoveTo(p) => out.move_to(point(p)),
            PathSegment::LineTo(p) => out.line_to(point(p)),
            PathSegment::QuadTo(a, p) => out.quad_to(point(a), point(p)),
            PathSegment::CubicTo(a, b, p) => out.curve_to(point(a), point(b), point(p)),
            PathSegment::Close => out.close_path(),
        }
    }
    out
}
