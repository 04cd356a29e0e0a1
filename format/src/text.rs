//! Outlines of annotated text. Laying out text is usvg's business; it gets a minimal drawing
//! with this text alone, in a thread with a stack of its own.

use crate::read::Resolver;
use crate::style::Style;
use crate::write::{attribute, escaped};
use crate::xml::PlainAttribute;
use kurbo::{BezPath, Point};
use roxmltree::Node;
use std::collections::BTreeSet;
use std::sync::{Arc, OnceLock};
use usvg::tiny_skia_path::PathSegment;

/// Spans inside spans, and characters, that are laid out at most.
const DEEPEST: usize = 64;
const LONGEST: usize = 20_000;
const STACK: usize = 64 << 20;

/// The outlines of a text element in its own coordinates. Err says what is missing.
pub(crate) fn outlines<'a>(
    node: Node<'a, '_>,
    style: &Style,
    resolver: &Resolver<'a, '_>,
) -> Result<Vec<BezPath>, String> {
    let is_drawn = |text: &str| text.chars().any(|c| !c.is_whitespace());
    if !node.descendants().filter_map(|inner| inner.text()).any(is_drawn) {
        return Ok(Vec::new());
    }
    if !style.get("font-family").is_none_or(has_font) {
        return Err("its font is not installed".to_owned());
    }
    let mut svg = String::from("<svg");
    attribute(&mut svg, "xmlns", crate::vocabulary::SVG);
    svg.push_str(" width=\"100\" height=\"100\">");
    let mut budget = LONGEST;
    write_text(&mut svg, node, style, resolver, (DEEPEST, &mut budget))?;
    svg.push_str("</svg>");
    let thread = std::thread::Builder::new()
        .stack_size(STACK)
        .spawn(move || lay_out(&svg))
        .map_err(|error| error.to_string())?;
    thread.join().map_err(|_| "it cannot be laid out".to_owned())?
}

fn write_text<'a>(
    svg: &mut String,
    node: Node<'a, '_>,
    style: &Style,
    resolver: &Resolver<'a, '_>,
    (depth, budget): (usize, &mut usize),
) -> Result<(), String> {
    let mut spend = |text: &str| {
        *budget = budget.checked_sub(text.len()).ok_or(format!("it is longer than {LONGEST} bytes"))?;
        Ok::<(), String>(())
    };
    if depth == 0 {
        return Err(format!("its spans are nested more than {DEEPEST} deep"));
    }
    let name = if node.tag_name().name() == "text" { "text" } else { "tspan" };
    svg.push('<');
    svg.push_str(name);
    for name in ["x", "y", "dx", "dy", "rotate", "textLength", "lengthAdjust"] {
        if let Some(value) = node.plain(name) {
            spend(value)?;
            attribute(svg, name, value);
        }
    }
    let css = style.text_css();
    spend(&css)?;
    attribute(svg, "style", &css);
    let space = node.attribute(("http://www.w3.org/XML/1998/namespace", "space"));
    attribute(svg, "xml:space", space.unwrap_or("default"));
    svg.push('>');
    for child in node.children() {
        if child.is_text() {
            let text = child.text().unwrap_or("");
            *budget = budget.checked_sub(text.len()).ok_or(format!("it is longer than {LONGEST} bytes"))?;
            svg.push_str(&escaped(text));
        } else if child.is_element() && child.tag_name().name() == "tspan" {
            let units = crate::units::Units { viewport: resolver.view.size(), em: style.font_size() };
            let style = resolver.cascade.computed(child, style, &units);
            write_text(svg, child, &style, resolver, (depth - 1, budget))?;
        }
    }
    svg.push_str(&format!("</{name}>"));
    Ok(())
}

/// True if one of these families is generic or installed: another font would be a guess.
fn has_font(families: &str) -> bool {
    const GENERIC: [&str; 5] = ["serif", "sans-serif", "monospace", "cursive", "fantasy"];
    let fonts = fonts();
    families.split(',').map(|name| name.trim().trim_matches(['"', '\''])).any(|name| {
        let is_it = |face: &usvg::fontdb::FaceInfo| face.families.iter().any(|(known, _)| known == name);
        GENERIC.contains(&name) || fonts.faces().any(is_it)
    })
}

/// Installed fonts for the generic families `serif`, `sans-serif` and `monospace`: the first of those that
/// are usual, else any. Without this a drawing that names no font, or a generic one, has no text where the
/// fonts of one large company are not installed.
pub fn generic_fonts(installed: &BTreeSet<String>) -> [String; 3] {
    const SERIF: [&str; 5] =
        ["Times New Roman", "Liberation Serif", "DejaVu Serif", "Noto Serif", "FreeSerif"];
    const SANS: [&str; 6] = ["Arial", "Liberation Sans", "DejaVu Sans", "Noto Sans", "Helvetica", "FreeSans"];
    const MONO: [&str; 5] =
        ["Courier New", "Liberation Mono", "DejaVu Sans Mono", "Noto Sans Mono", "FreeMono"];
    let first =
        |names: &[&str]| names.iter().find(|name| installed.contains(**name)).map(|name| (*name).to_owned());
    let any =
        first(&SANS).or_else(|| first(&SERIF)).or_else(|| installed.first().cloned()).unwrap_or_default();
    [&SERIF[..], &SANS, &MONO].map(|names| first(names).unwrap_or_else(|| any.clone()))
}

/// The installed fonts. Finding them takes a tenth of a second, so it is done once.
fn fonts() -> Arc<usvg::fontdb::Database> {
    static FONTS: OnceLock<Arc<usvg::fontdb::Database>> = OnceLock::new();
    let find = || {
        let mut fonts = usvg::fontdb::Database::new();
        fonts.load_system_fonts();
        let installed: BTreeSet<String> =
            fonts.faces().flat_map(|face| face.families.iter().map(|(name, _)| name.clone())).collect();
        let [serif, sans, mono] = generic_fonts(&installed);
        fonts.set_serif_family(serif);
        fonts.set_sans_serif_family(sans);
        fonts.set_monospace_family(mono);
        Arc::new(fonts)
    };
    FONTS.get_or_init(find).clone()
}

fn lay_out(svg: &str) -> Result<Vec<BezPath>, String> {
    let fontdb = fonts();
    let font_family = fontdb.family_name(&usvg::fontdb::Family::Serif).to_owned();
    let options = usvg::Options { fontdb, font_family, ..usvg::Options::default() };
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
