//! A picture of the flow: which way it runs, and where it has no direction.

use super::prepare::{Field, Prepared};
use crate::field::DirectionField;
use kurbo::{Affine, BezPath, Circle, Point, Shape, Vec2};
use rinceau_format::{Group, Item, Part, Style};

/// Ticks along the longer side of a container, at most.
const MOST_TICKS: f64 = 160.0;

/// A hidden sublayer: ticks along the flow half an element width apart, and the singularities of the field: a disc
/// where lines turn back around a point (index 1/2), a triangle where three ways part (-1/2). `None` where
/// nothing flows.
pub(super) fn flow(prepared: &Prepared, flows: &[Option<DirectionField>]) -> Option<Group> {
    let mut group = Group { name: "flow".into(), hidden: true, ..Group::default() };
    for (field, flow) in prepared.fields.iter().zip(flows).filter(|(field, _)| field.params.show_flow) {
        let Some(flow) = flow else { continue };
        let size = field.sizes.spacing;
        let mut style = Style::filled("none");
        style.set("stroke", "#8899aa");
        style.set("stroke-width", &format!("{:.4}", size / 30.0));
        let ticks = Part { path: ticks(field, flow), transform: Affine::IDENTITY, style };
        group.items.push(Item::new("flow", vec![ticks]));
        for (at, index) in flow.singularities().into_iter().filter(|(at, _)| field.region.contains(*at)) {
            let (path, colour) = if index > 0.0 {
                (Circle::new(at, size / 5.0).to_path(1e-3 * size), "#d1495b")
            } else {
                (triangle(at, size / 4.0), "#2654a4")
            };
            let part = Part { path, transform: Affine::IDENTITY, style: Style::filled(colour) };
            group.items.push(Item::new("singularity", vec![part]));
        }
    }
    (!group.items.is_empty()).then_some(group)
}

fn ticks(field: &Field, flow: &DirectionField) -> BezPath {
    let bounds = field.region.bounds();
    let step = (field.sizes.spacing / 2.0).max(bounds.size().max_side() / MOST_TICKS);
    let (columns, rows) = ((bounds.width() / step) as usize, (bounds.height() / step) as usize);
    let mut path = BezPath::new();
    for row in 0..=rows {
        for column in 0..=columns {
            let at = bounds.origin() + step * Vec2::new(column as f64 + 0.5, row as f64 + 0.5);
            if let Some(along) = flow.direction(at, Vec2::new(1.0, 0.0)).filter(|_| field.region.contains(at))
            {
                path.move_to(at - 0.35 * step * along);
                path.line_to(at + 0.35 * step * along);
            }
        }
    }
    path
}

fn triangle(at: Point, radius: f64) -> BezPath {
    let corner = |k: i32| {
        let angle = f64::from(k) * std::f64::consts::TAU / 3.0;
        at + radius * Vec2::new(libm::sin(angle), -libm::cos(angle))
    };
    let mut path = BezPath::new();
    path.move_to(corner(0));
    path.line_to(corner(1));
    path.line_to(corner(2));
    path.close_path();
    path
}
