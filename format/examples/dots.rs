//! A generator of one's own: dots on a grid inside every container, as a layer of the drawing.
//!
//!     cargo run -p rinceau-format --example dots -- samples/pack/heart.svg > out.svg

use kurbo::{Affine, Circle, Point, Shape};
use rinceau_format::{Artwork, Document, Group, Item, Part, Recipe, Selection, Style};
use std::io::Write;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).ok_or("name a drawing")?;
    let document = Document::from_bytes(std::fs::read(path)?)?;
    let scene = document.scene(&Selection::default())?;
    let mut group = Group { name: "dots".into(), ..Group::default() };
    for outline in scene.containers.iter().flat_map(|container| &container.outlines) {
        let bounds = outline.path.bounding_box();
        let step = bounds.size().max_side() / 40.0;
        for i in 0..1600 {
            let (x, y) = (f64::from(i % 40) + 0.5, f64::from(i / 40) + 0.5);
            let at = Point::new(bounds.x0 + x * step, bounds.y0 + y * step);
            if outline.path.contains(at) {
                let path = Circle::new(at, 0.3 * step).to_path(0.01);
                let part = Part { path, transform: Affine::IDENTITY, style: Style::filled("#14444f") };
                group.items.push(Item::new("dot", vec![part]));
            }
        }
    }
    let artwork = Artwork { groups: vec![group], complete: true, decimals: 3, ..Artwork::default() };
    let recipe = Recipe {
        generator: "dots".into(),
        params: serde_json::Map::new(),
        seed: 0,
        sources: scene.containers.iter().map(|container| container.source.id.clone()).collect(),
        with: Vec::new(),
        label: "Dots".into(),
    };
    std::io::stdout().write_all(&document.with_layer(&artwork, &recipe)?.to_bytes())?;
    Ok(())
}
