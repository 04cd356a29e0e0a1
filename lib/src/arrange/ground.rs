//! Where things may grow: shapes and sprayed strokes, without what is fixed, within boundaries; and
//! which way the flow runs there (checklist E-022, E-050, E-051).

use crate::field::direction::DirectionField;
use crate::geom::polyline::tangents;
use crate::geom::region::Region;
use crate::geom::segment::{SegmentGrid, crosses};
use kurbo::{Point, Rect, Vec2};

/// A region with its flow and boundaries.
pub(super) struct Ground {
    /// Where middles of elements may be; `None` for the whole plane.
    pub middles: Option<Region>,
    pub flow: Option<DirectionField>,
    guides: Vec<Vec<Point>>,
    boundaries: Option<SegmentGrid>,
    pub bounds: Rect,
    /// True if what leaves the bounds on one side comes in on the other (a torus).
    pub repeats: bool,
}

impl Ground {
    pub fn new(
        middles: Option<Region>,
        bounds: Rect,
        (guides, with_flow): (Vec<Vec<Point>>, bool),
        boundaries: &[Vec<Point>],
        (cell, repeats): (f64, bool),
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
        let boundaries = (!boundaries.is_empty()).then(|| {
            let mut walls = SegmentGrid::new(bounds, cell);
            let sides = boundaries.iter().flat_map(|line| line.windows(2));
            sides.for_each(|pair| walls.insert(pair[0], pair[1], 0));
            walls
        });
        Ground { middles, flow, guides, boundaries, bounds, repeats }
    }

    /// The image of a place within the bounds.
    pub fn within(&self, at: Point) -> Point {
        if !self.repeats {
            return at;
        }
        let Rect { x0, y0, .. } = self.bounds;
        let (width, height) = (self.bounds.width(), self.bounds.height());
        Point::new(x0 + (at.x - x0).rem_euclid(width), y0 + (at.y - y0).rem_euclid(height))
    }

    /// The image of a place that is nearest to another.
    pub fn near(&self, at: Point, to: Point) -> Point {
        if !self.repeats {
            return at;
        }
        let (width, height) = (self.bounds.width(), self.bounds.height());
        let by =
            Vec2::new(((to.x - at.x) / width).round() * width, ((to.y - at.y) / height).round() * height);
        at + by
    }

    /// Visits all images of a place that are within the bounds with what reaches so far around them, itself
    /// first.
    pub fn each_image(&self, at: Point, reach: Rect, visit: impl FnMut(Point)) {
        if !self.repeats {
            return std::iter::once(at).for_each(visit);
        }
        let (width, height) = (self.bounds.width(), self.bounds.height());
        let moves = (0..9).map(|i| Vec2::new(f64::from((i + 1) % 3 - 1), f64::from((i / 3 + 1) % 3 - 1)));
        let all = moves.map(|by| at + Vec2::new(by.x * width, by.y * height));
        all.enumerate()
            .filter(|(i, p)| *i == 0 || self.bounds.overlaps(reach + p.to_vec2()))
            .map(|(_, p)| p)
            .for_each(visit);
    }

    /// True if a line crosses a boundary that was drawn.
    pub fn is_cut(&self, line: &[Point]) -> bool {
        self.boundaries.is_some() && line.windows(2).any(|pair| self.divides(pair[0], pair[1]))
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
