//! Placed pieces by place.

use super::piece::Piece;
use kurbo::{Point, Rect};

/// A piece of an element, or of one of its images under a symmetry.
#[derive(Clone, Debug)]
pub(super) struct Placed {
    pub piece: Piece,
    pub element: u32,
    /// Which image of the element: 0 is the element itself.
    pub image: u16,
}

/// A uniform grid of pieces; those beyond its bounds are in the cells of its border.
#[derive(Clone, Debug)]
pub(super) struct Index {
    origin: Point,
    side: f64,
    columns: usize,
    rows: usize,
    cells: Vec<Vec<u32>>,
    placed: Vec<Placed>,
    /// When each piece was last looked at, so that it is once for a query.
    seen: Vec<u32>,
    query: u32,
}

impl Index {
    pub fn new(bounds: Rect, side: f64) -> Self {
        let count = |length: f64| ((length / side).ceil().clamp(1.0, 2000.0)) as usize;
        let (columns, rows) = (count(bounds.width()), count(bounds.height()));
        Index {
            origin: bounds.origin(),
            side,
            columns,
            rows,
            cells: vec![Vec::new(); columns * rows],
            placed: Vec::new(),
            seen: Vec::new(),
            query: 0,
        }
    }

    fn range(&self, bounds: Rect) -> ((usize, usize), (usize, usize)) {
        let of = |v: f64, most: usize| ((v / self.side).max(0.0) as usize).min(most - 1);
        let (x, y) = (self.origin.x, self.origin.y);
        (
            (of(bounds.x0 - x, self.columns), of(bounds.x1 - x, self.columns)),
            (of(bounds.y0 - y, self.rows), of(bounds.y1 - y, self.rows)),
        )
    }

    pub fn add(&mut self, placed: Placed) {
        let number = self.placed.len() as u32;
        let ((x0, x1), (y0, y1)) = self.range(placed.piece.bounds());
        for y in y0..=y1 {
            for x in x0..=x1 {
                self.cells[y * self.columns + x].push(number);
            }
        }
        self.placed.push(placed);
        self.seen.push(0);
    }

    /// Visits every piece in the cells that a box touches, once, until `visit` says false.
    pub fn near(&mut self, bounds: Rect, mut visit: impl FnMut(&Placed) -> bool) {
        self.query = self.query.wrapping_add(1);
        let ((x0, x1), (y0, y1)) = self.range(bounds);
        for y in y0..=y1 {
            for x in x0..=x1 {
                for &number in &self.cells[y * self.columns + x] {
                    let seen = &mut self.seen[number as usize];
                    if *seen == self.query {
                        continue;
                    }
                    *seen = self.query;
                    if !visit(&self.placed[number as usize]) {
                        return;
                    }
                }
            }
        }
    }
}
