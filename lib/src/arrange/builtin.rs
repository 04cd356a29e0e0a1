//! An example for whoever has drawn none: leaves that lean to and fro, with berries between.

use crate::palette::palette;
use crate::shapes::Shapes;
use kurbo::{Affine, BezPath, Circle, Point, Shape};
use rinceau_format::{Error, Example, Part, Position, Reference, Scene, Source, Style};

/// About so many leaves fill the shapes.
const LEAVES: f64 = 110.0;
/// Rows and columns; the border is not continued.
const SIDE: i32 = 7;

/// The scene with the example, as large as suits its shapes.
///
/// Errors: a shape that cannot be used.
pub(super) fn with_example(scene: &Scene) -> Result<Scene, Error> {
    let shapes = Shapes::new(scene, &[])?;
    let pitch = (shapes.area() / LEAVES).sqrt().max(f64::MIN_POSITIVE);
    let tones = palette("auto", scene.containers.first().and_then(|container| container.fill.as_deref()));
    let mut examples = Vec::new();
    let mut add = |symbol: &str, path: BezPath, tone: &str| {
        let source = source(&format!("{symbol}-{}", examples.len() + 1));
        let parts = vec![Part { path, transform: Affine::IDENTITY, style: Style::filled(tone) }];
        examples.push(Example { source, symbol: symbol.to_owned(), parts });
    };
    for row in 0..SIDE {
        for column in 0..SIDE {
            let at = Point::new(f64::from(column) * pitch, f64::from(row) * pitch);
            let leans_right = (row + column) % 2 == 0;
            let (lean, symbol, tone) =
                if leans_right { (0.5, "leaf", tones[0]) } else { (-0.5, "other-leaf", tones[1]) };
            let pose = Affine::translate(at.to_vec2()) * Affine::rotate(lean) * Affine::scale(LEAF * pitch);
            add(symbol, pose * leaf(), tone);
            let between = at + pitch * kurbo::Vec2::new(0.5, 0.5);
            add("berry", Circle::new(between, 0.13 * pitch).to_path(1e-3 * pitch), tones[2]);
        }
    }
    let reference = Reference { source: source("built-in"), examples, flips: Vec::new() };
    Ok(Scene { references: vec![reference], ..scene.clone() })
}

/// Size of a leaf, in pitches: neighbours do not touch.
const LEAF: f64 = 1.15;

/// A leaf of height 0.86 about the origin, with a vein cut out.
fn leaf() -> BezPath {
    let mut path = BezPath::new();
    path.move_to((0.0, 0.43));
    path.curve_to((-0.26, 0.22), (-0.26, -0.16), (0.0, -0.43));
    path.curve_to((0.26, -0.16), (0.26, 0.22), (0.0, 0.43));
    path.close_path();
    // The other way round, so that it is a hole by either rule.
    path.move_to((0.0, 0.3));
    path.curve_to((0.035, 0.1), (0.025, -0.1), (0.0, -0.27));
    path.curve_to((-0.025, -0.1), (-0.035, 0.1), (0.0, 0.3));
    path.close_path();
    path
}

fn source(id: &str) -> Source {
    Source { id: id.to_owned(), label: id.to_owned(), at: Position { line: 1, column: 1 } }
}
