//! Where things may grow: shapes and sprayed strokes, without what is fixed, within boundaries; and
//! which way the flow runs there (checklist E-022, E-050, E-051).

use crate::field::direction::DirectionField;
use crate::geom::near::{SegmentGrid, crosses};
use crate::geom::polyline::tangents;
use crate::geom::region::Region;
use kurbo::{Point, Rect, Vec2};

/// A region with its flow and boundaries.
pub(super) struct Ground {
    /// Where middles of elements may be; `None` for the whole plane.
    pub middles: Option<Region>,
    pub flow: Option<DirectionField>,
    guides: Vec<Vec<Point>>,
    boundaries: Option<SegmentGrid>,
    pub bounds: Rect,
}

impl Ground {
    pub fn new(
        middles: Option<Region>,
        bounds: Rect,
        (guides, with_flow): (Vec<Vec<Point>>, bool),
        boundaries: &[Vec<Point>],
        cell: f64,
    ) -> Self {
        let whole = || {
            Region::new(vec![vec![
                bounds.origin(),
                Point::new(bounds.x1, bounds.y0),
                Point::new(bounds.x1, bounds.y1),
                Point::new(bounds.x0, bounds.y1),
            ]])
        };
        let over = if middles.is_some() { middles.clone() } else { whole() };
        let flow =
            over.filter(|_| with_flow).and_then(|over| DirectionField::new(&over, &guides, 0.5 * cell));
        let mut walls = SegmentGrid::new(bounds, cell);
        boundaries.iter().flat_map(|line| line.windows(2)).for_each(|pair| walls.insert(pair[0], pair[1], 0));
        let boundaries = (!boundaries.is_empty()).then_some(walls);
        Ground { middles, flow, guides, boundaries, bounds }
    }

    /// True if the middle of an element may be in a place.
    pub fn allows(&self, at: Point) -> bool {
        self.bounds.contains(at) && self.middles.as_ref().is_none_or(|region| region.contains(at))
    }

    /// True if a boundary lies between two places.
    pub fn divides(&self, a: Point, b: Point) -> bool {
        let mut found = false;
        if let Some(walls) = &self.boundaries {
            walls.visit(a, b, 0.0, |p, q, _| {
                found = crosses(a, b, p, q);
                !found
            });
        }
        found
    }

    /// True if a boundary is nearer than `reach`.
    pub fn is_at_boundary(&self, at: Point, reach: f64) -> bool {
        self.boundaries.as_ref().is_some_and(|walls| walls.distance(at, reach) < reach)
    }

    /// The direction of the flow, in the sense of `towards` or else of the nearest guide.
    pub fn direction(&self, at: Point, towards: Option<Vec2>) -> Option<Vec2> {
        let towards = towards.or_else(|| self.nearest_guide(at))?;
        self.flow.as_ref()?.direction(at, towards)
    }

    fn nearest_guide(&self, at: Point) -> Option<Vec2> {
        let along = self.guides.iter().flat_map(|line| line.iter().copied().zip(tangents(line, false)));
        along.min_by(|a, b| a.0.distance_squared(at).total_cmp(&b.0.distance_squared(at))).map(|(_, way)| way)
    }
}
