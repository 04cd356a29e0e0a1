//! Small drawings and artworks for the tests.
#![allow(dead_code, reason = "each test file uses some of them")]

use kurbo::{Affine, BezPath};
use rinceau_format::{Artwork, Group, Item, Part, Recipe, Style};

/// A drawing with this content.
pub fn svg(content: &str) -> String {
    format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>\n{content}</svg>\n")
}

/// An artwork of so many leaves, one of them in two parts.
pub fn artwork(leaves: usize) -> Artwork {
    let part = |x: f64, transform: Affine| Part {
        path: BezPath::from_svg("M0,0L10,1L5,5Z")
            .map(|path| Affine::translate((x, 0.0)) * path)
            .unwrap_or_default(),
        transform,
        style: Style::filled("#112233"),
    };
    let items = (0..leaves).map(|i| {
        let mut parts = vec![part(i as f64, Affine::IDENTITY)];
        if i == 1 {
            parts.push(part(0.5, Affine::rotate(0.3)));
        }
        Item::new("leaf", parts)
    });
    let group = Group { name: "elements".into(), hidden: false, items: items.collect(), stream: None };
    Artwork { groups: vec![group], complete: true, decimals: 3, ..Artwork::default() }
}

/// A recipe over these objects.
pub fn recipe(sources: &[&str]) -> Recipe {
    Recipe {
        generator: "pack".into(),
        params: serde_json::Map::from_iter([("spacing".into(), serde_json::json!(2.5))]),
        seed: 7,
        sources: sources.iter().map(|&id| id.to_owned()).collect(),
        with: Vec::new(),
        label: format!("Ornament - {}", sources.join(", ")),
    }
}
