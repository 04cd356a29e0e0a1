//! Space in cells: which stem or clip art each belongs to (checklist M-020, M-026, M-027).
//!
//! A shape claims every cell that it comes nearer to than the gap. A new shape must touch no
//! cell that is claimed. Both sides are counted generously, by half the diagonal of a cell, so
//! two shapes that share no cell are apart by the gap for certain.

use crate::geom::boolean::Contour;
use crate::geom::distance::{covered, squared_distances};
use crate::geom::region::Region;
use kurbo::Point;

/// Half the diagonal of a cell, in cells.
const HALF_DIAGONAL: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Who claims a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Owner(u32);

impl Owner {
    pub const FREE: Owner = Owner(0);
    /// Not in the region: the paper's -1.
    pub const OUTSIDE: Owner = Owner(u32::MAX);

    /// A claim of the thing with this number.
    fn of(id: u32, body: bool) -> Self {
        Owner((id + 1) << 1 | u32::from(body))
    }

    /// The thing, unless the cell is free or outside.
    pub fn id(self) -> Option<u32> {
        (self != Owner::FREE && self != Owner::OUTSIDE).then(|| (self.0 >> 1) - 1)
    }

    /// True if the thing itself is there, not only its gap.
    pub fn is_body(self) -> bool {
        self.0 & 1 == 1 && self != Owner::OUTSIDE
    }
}

/// Where the cells lie.
#[derive(Clone, Copy, Debug)]
struct Grid {
    origin: Point,
    /// Side of a cell, and its inverse.
    size: f64,
    per_unit: f64,
    columns: usize,
    rows: usize,
    /// Columns after which the cells begin anew; 0 for no repeat.
    wrap: usize,
}

/// The cells of a container.
pub(super) struct Cells {
    grid: Grid,
    owners: Vec<Owner>,
    /// Where on its stem a claim lies, by arc length.
    places: Vec<f32>,
}

/// Rounded down; the processor's own instruction for it is not on every machine.
fn floor(x: f64) -> i64 {
    let whole = x as i64;
    whole - i64::from((whole as f64) > x)
}

impl Grid {
    /// The radius about samples `apart` from each other, so that all cells that a line between
    /// them touches are found, if it is twice `radius` wide.
    fn reach(&self, radius: f64, apart: f64) -> f64 {
        let half = radius + HALF_DIAGONAL * self.size;
        (half * half + 0.25 * apart * apart).sqrt()
    }

    /// Visits the cells whose middle lies within a radius, `None` for those beyond the grid,
    /// until `visit` says false. True if it never did.
    fn near(&self, at: Point, radius: f64, mut visit: impl FnMut(Option<usize>) -> bool) -> bool {
        let x = (at.x - self.origin.x) * self.per_unit - 0.5;
        let y = (at.y - self.origin.y) * self.per_unit - 0.5;
        let r = radius * self.per_unit;
        for row in -floor(r - y)..=floor(y + r) {
            let dy = row as f64 - y;
            let half = (r * r - dy * dy).max(0.0).sqrt();
            for column in -floor(half - x)..=floor(x + half) {
                if !visit(self.index(column, row)) {
                    return false;
                }
            }
        }
        true
    }

    fn index(&self, column: i64, row: i64) -> Option<usize> {
        let column = if self.wrap > 0 { column.rem_euclid(self.wrap as i64) } else { column };
        let inside =
            column >= 0 && row >= 0 && (column as usize) < self.columns && (row as usize) < self.rows;
        inside.then(|| row as usize * self.columns + column as usize)
    }
}

impl Cells {
    /// Free cells inside a region. `span`, a left end and a width, is what repeats sideways.
    pub fn new(region: &Region, size: f64, span: Option<(f64, f64)>) -> Self {
        let bounds = region.bounds();
        let origin = Point::new(span.map_or(bounds.x0, |(left, _)| left), bounds.y0);
        // A whole number of cells in a period, so that the join is like any other place.
        let (size, wrap) = match span {
            Some((_, period)) => {
                let columns = (period / size).ceil().max(1.0);
                (period / columns, columns as usize)
            }
            None => (size, 0),
        };
        let count = |side: f64| (side / size).ceil() as usize + 1;
        let columns = if wrap > 0 { wrap } else { count(bounds.width()) };
        let rows = count(bounds.height());
        let inside = covered(region.contours(), origin, size, columns, rows);
        let owners = inside.iter().map(|&inside| if inside { Owner::FREE } else { Owner::OUTSIDE }).collect();
        let places = vec![0.0; columns * rows];
        let grid = Grid { origin, size, per_unit: 1.0 / size, columns, rows, wrap };
        let mut cells = Cells { grid, owners, places };
        // What the edge passes near is outside for certain.
        for contour in region.contours() {
            cells.close_edge(contour);
        }
        cells
    }

    /// The side of cells for a region: fine against the thinnest of what is drawn, but not
    /// more of them than `most`.
    pub fn size_for(area: f64, wanted: f64, most: f64) -> f64 {
        wanted.max((area / most).sqrt())
    }

    fn close_edge(&mut self, contour: &Contour) {
        let Some(&last) = contour.last() else { return };
        let (left, right) =
            (self.grid.origin.x, self.grid.origin.x + self.grid.columns as f64 * self.grid.size);
        let mut previous = last;
        for &p in contour {
            let apart = 0.5 * self.grid.size;
            let pieces = (previous.distance(p) / apart).ceil().clamp(1.0, 1e5);
            for k in 0..pieces as usize {
                let at = previous.lerp(p, k as f64 / pieces);
                // What repeats goes on beyond its span, where its edge is no edge of ours.
                if self.grid.wrap > 0 && !(left..=right).contains(&at.x) {
                    continue;
                }
                self.grid.near(at, self.grid.reach(0.0, apart), |i| {
                    i.into_iter().for_each(|i| self.owners[i] = Owner::OUTSIDE);
                    true
                });
            }
            previous = p;
        }
    }

    /// True if `may` allows every cell that a disc touches. `apart` is the distance to the next
    /// disc of the same shape.
    pub fn allows(
        &self,
        at: Point,
        radius: f64,
        apart: f64,
        mut may: impl FnMut(Owner, f64) -> bool,
    ) -> bool {
        self.grid.near(at, self.grid.reach(radius, apart), |i| {
            let owner = i.map_or(Owner::OUTSIDE, |i| self.owners[i]);
            owner == Owner::FREE || may(owner, i.map_or(0.0, |i| f64::from(self.places[i])))
        })
    }

    /// Claims a disc for a thing; `place` is the arc length there.
    pub fn claim(&mut self, id: u32, at: Point, radius: f64, apart: f64, place: f64) {
        let (owners, places) = (&mut self.owners, &mut self.places);
        self.grid.near(at, self.grid.reach(radius, apart), |i| {
            if let Some(i) = i.filter(|&i| owners[i] != Owner::OUTSIDE && !owners[i].is_body()) {
                (owners[i], places[i]) = (Owner::of(id, true), place as f32);
            }
            true
        });
    }

    /// Claims the gap around a disc: what others have there is theirs already.
    pub fn claim_gap(&mut self, id: u32, at: Point, radius: f64, apart: f64, place: f64) {
        let (owners, places) = (&mut self.owners, &mut self.places);
        self.grid.near(at, self.grid.reach(radius, apart), |i| {
            if let Some(i) = i.filter(|&i| owners[i] == Owner::FREE) {
                (owners[i], places[i]) = (Owner::of(id, false), place as f32);
            }
            true
        });
    }

    /// Side of a cell.
    pub fn size(&self) -> f64 {
        self.grid.size
    }

    /// These cells, outside where another grid over the same place is claimed.
    pub fn less(&self, other: &Cells) -> Cells {
        let owners = self.owners.iter().enumerate().map(|(i, &owner)| {
            if other.owner(self.middle(i)) == Owner::FREE { owner } else { Owner::OUTSIDE }
        });
        Cells { grid: self.grid, owners: owners.collect(), places: self.places.clone() }
    }

    /// Who claims a place.
    pub fn owner(&self, at: Point) -> Owner {
        self.cell(at).map_or(Owner::OUTSIDE, |i| self.owners[i])
    }

    /// Squared distance of every cell to the nearest that is not free, in cells; and the number
    /// of columns.
    pub fn clearances(&self) -> (Vec<f64>, usize) {
        // A frame of taken cells stands for what lies beyond the grid.
        let columns = self.grid.columns + 2;
        let mut taken = vec![true; columns * (self.grid.rows + 2)];
        for row in 0..self.grid.rows {
            for column in 0..self.grid.columns {
                taken[(row + 1) * columns + column + 1] =
                    self.owners[row * self.grid.columns + column] != Owner::FREE;
            }
        }
        let framed = squared_distances(&taken, columns);
        let unframed = (0..self.grid.rows)
            .flat_map(|row| framed[(row + 1) * columns + 1..][..self.grid.columns].iter().copied())
            .collect();
        (unframed, self.grid.columns)
    }

    /// Width of what repeats sideways.
    pub fn period(&self) -> Option<f64> {
        (self.grid.wrap > 0).then_some(self.grid.wrap as f64 * self.grid.size)
    }

    /// Radius of the largest circle that is free.
    pub fn inradius(&self) -> f64 {
        self.clearances().0.into_iter().fold(0.0, f64::max).sqrt() * self.grid.size
    }

    /// The middle of a cell.
    pub fn middle(&self, i: usize) -> Point {
        let (column, row) = ((i % self.grid.columns) as f64, (i / self.grid.columns) as f64);
        Point::new(
            self.grid.origin.x + (column + 0.5) * self.grid.size,
            self.grid.origin.y + (row + 0.5) * self.grid.size,
        )
    }

    /// The cell of a place, if it is on the grid.
    pub fn cell(&self, at: Point) -> Option<usize> {
        let (x, y) =
            ((at.x - self.grid.origin.x) / self.grid.size, (at.y - self.grid.origin.y) / self.grid.size);
        self.grid.index(floor(x), floor(y))
    }
}
