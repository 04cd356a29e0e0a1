//! Uniform grids: which points are near a place.

use kurbo::{Point, Rect};

/// Cells of a grid at most; more would cost memory without finding faster.
const MOST_CELLS: f64 = 4e6;

/// Maps places to cells of equal size.
#[derive(Clone, Debug)]
pub(super) struct Cells {
    origin: Point,
    pub size: f64,
    /// Cells in a unit of length.
    per_unit: f64,
    pub columns: usize,
    pub rows: usize,
}

impl Cells {
    pub fn new(bounds: Rect, size: f64) -> Self {
        let size = size.max((bounds.width() * bounds.height() / MOST_CELLS).sqrt()).max(f64::MIN_POSITIVE);
        let count = |side: f64| ((side / size).ceil().min(MOST_CELLS) as usize).max(1);
        let (columns, rows) = (count(bounds.width()), count(bounds.height()));
        Cells { origin: bounds.origin(), size, per_unit: 1.0 / size, columns, rows }
    }

    pub fn column(&self, x: f64) -> usize {
        (((x - self.origin.x) * self.per_unit).max(0.0) as usize).min(self.columns - 1)
    }

    pub fn row(&self, y: f64) -> usize {
        (((y - self.origin.y) * self.per_unit).max(0.0) as usize).min(self.rows - 1)
    }

    pub fn index(&self, p: Point) -> usize {
        self.row(p.y) * self.columns + self.column(p.x)
    }

    /// Visits the cells at a distance of `ring` cells, those that exist.
    pub fn ring(&self, column: i64, row: i64, ring: i64, mut visit: impl FnMut(usize)) {
        let (columns, rows) = (self.columns as i64, self.rows as i64);
        for r in (row - ring).max(0)..=(row + ring).min(rows - 1) {
            let whole = (r - row).abs() == ring;
            let step = if whole { 1 } else { (2 * ring).max(1) };
            let mut c = column - ring;
            while c <= column + ring {
                if (0..columns).contains(&c) {
                    visit((r * columns + c) as usize);
                }
                c += step;
            }
        }
    }

    /// Squared distance from a place to a cell. Cells of the border hold all that lies beyond.
    pub fn distance_squared(&self, at: Point, index: usize) -> f64 {
        let (column, row) = (index % self.columns, index / self.columns);
        let apart = |at: f64, origin: f64, i: usize, count: usize| {
            let low = origin + i as f64 * self.size;
            let before = if i == 0 { 0.0 } else { low - at };
            let after = if i + 1 == count { 0.0 } else { at - low - self.size };
            before.max(after).max(0.0)
        };
        let (x, y) =
            (apart(at.x, self.origin.x, column, self.columns), apart(at.y, self.origin.y, row, self.rows));
        x * x + y * y
    }

    /// Indices of the cells a box touches, row by row.
    pub fn covered(&self, low: Point, high: Point) -> impl Iterator<Item = usize> + use<> {
        let (c0, c1) = (self.column(low.x), self.column(high.x));
        let (r0, r1, columns) = (self.row(low.y), self.row(high.y), self.columns);
        (r0..=r1).flat_map(move |row| (c0..=c1).map(move |column| row * columns + column))
    }
}

/// Points with an owner each, to be found by place.
#[derive(Clone, Debug)]
pub struct PointGrid {
    cells: Cells,
    /// The first and the last point of each cell.
    ends: Vec<(u32, u32)>,
    points: Vec<Linked>,
}

/// A point with its owner, and the number of the next one in its cell.
#[derive(Clone, Debug)]
struct Linked {
    at: Point,
    owner: u32,
    next: u32,
}

/// Stands for no point.
const NO_POINT: u32 = u32::MAX;

impl PointGrid {
    /// An empty grid over `bounds`; places outside fall into the border cells.
    pub fn new(bounds: Rect, cell: f64) -> Self {
        let cells = Cells::new(bounds, cell);
        let ends = vec![(NO_POINT, NO_POINT); cells.columns * cells.rows];
        PointGrid { cells, ends, points: Vec::new() }
    }

    /// Takes all points out.
    pub fn clear(&mut self) {
        self.ends.fill((NO_POINT, NO_POINT));
        self.points.clear();
    }

    /// Adds a point.
    pub fn insert(&mut self, p: Point, owner: u32) {
        let number = self.points.len() as u32;
        let (first, last) = &mut self.ends[self.cells.index(p)];
        match self.points.get_mut(*last as usize) {
            Some(last) => last.next = number,
            None => *first = number,
        }
        *last = number;
        self.points.push(Linked { at: p, owner, next: NO_POINT });
    }

    /// Visits the points within `radius` (and some beyond), until `visit` says false.
    pub fn visit(&self, at: Point, radius: f64, mut visit: impl FnMut(Point, u32) -> bool) {
        let (low, high) =
            (Point::new(at.x - radius, at.y - radius), Point::new(at.x + radius, at.y + radius));
        for index in self.cells.covered(low, high) {
            let mut number = self.ends[index].0;
            while let Some(&Linked { at, owner, next }) = self.points.get(number as usize) {
                if !visit(at, owner) {
                    return;
                }
                number = next;
            }
        }
    }

    /// True if a point that `counts` lies closer than `radius`.
    pub fn any_within(&self, at: Point, radius: f64, mut counts: impl FnMut(Point, u32) -> bool) -> bool {
        let mut found = false;
        self.visit(at, radius, |p, owner| {
            found = p.distance_squared(at) < radius * radius && counts(p, owner);
            !found
        });
        found
    }
}

/// Points with something of each that are all known from the start: packed cell by cell, so that
/// the cells of a row are looked at in one run.
#[derive(Clone, Debug)]
pub struct PointTable<T> {
    cells: Cells,
    /// Where the points of each cell start, and the end of the last.
    starts: Vec<u32>,
    points: Vec<(Point, T)>,
}

impl<T: Copy + Default> PointTable<T> {
    /// A table over `bounds`; places outside fall into the border cells.
    pub fn new(bounds: Rect, cell: f64, points: impl Iterator<Item = (Point, T)> + Clone) -> Self {
        let cells = Cells::new(bounds, cell);
        let mut table = PointTable { cells, starts: Vec::new(), points: Vec::new() };
        table.fill(points);
        table
    }

    /// Takes other points, in the same memory.
    pub fn fill(&mut self, points: impl Iterator<Item = (Point, T)> + Clone) {
        let PointTable { cells, starts, points: packed } = self;
        // Two more than cells: what is the end of one while they are counted becomes its start.
        starts.clear();
        starts.resize(cells.columns * cells.rows + 2, 0);
        points.clone().for_each(|(p, _)| starts[cells.index(p) + 2] += 1);
        for i in 2..starts.len() {
            starts[i] += starts[i - 1];
        }
        let count = *starts.last().unwrap_or(&0) as usize;
        packed.clear();
        packed.reserve_exact(count);
        packed.resize(count, Default::default());
        points.for_each(|(p, of_it)| {
            let at = &mut starts[cells.index(p) + 1];
            packed[*at as usize] = (p, of_it);
            *at += 1;
        });
    }

    /// The points within `radius`, and some beyond.
    pub fn near(&self, at: Point, radius: f64) -> impl Iterator<Item = (Point, T)> + '_ {
        let (c0, c1) = (self.cells.column(at.x - radius), self.cells.column(at.x + radius));
        let rows = self.cells.row(at.y - radius)..=self.cells.row(at.y + radius);
        rows.flat_map(move |row| {
            let start = row * self.cells.columns;
            let (from, to) = (self.starts[start + c0], self.starts[start + c1 + 1]);
            self.points[from as usize..to as usize].iter().copied()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Rng;

    #[test]
    fn a_table_finds_every_point_in_reach() {
        let mut rng = Rng::new(3);
        let points: Vec<(Point, u32)> =
            (0..300).map(|i| (Point::new(rng.between(-5.0, 105.0), rng.between(-5.0, 105.0)), i)).collect();
        let table = PointTable::new(Rect::new(0.0, 0.0, 100.0, 100.0), 7.0, points.iter().copied());
        for &(at, _) in &points {
            let within = |&(p, _): &(Point, u32)| p.distance(at) < 11.0;
            let mut found: Vec<u32> = table.near(at, 11.0).filter(within).map(|(_, owner)| owner).collect();
            found.sort_unstable();
            let brute: Vec<u32> = points.iter().filter(|p| within(p)).map(|&(_, owner)| owner).collect();
            assert_eq!(found, brute);
        }
    }
}
