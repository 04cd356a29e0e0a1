//! Space in cells: which stem or clip art each belongs to (checklist M-020, M-026, M-027).
//!
//! A stem claims every cell that it comes nearer to than the gap; clip art, which nothing may touch,
//! closes them. A new shape must touch no cell that is claimed or closed. Both sides are counted generously, by half the diagonal of a cell, so
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
    /// Not in the region, the paper's -1, or taken by clip art.
    pub const CLOSED: Owner = Owner(u32::MAX);

    /// A claim of the stem with this number.
    fn of(stem: usize, body: bool) -> Self {
        Owner((stem as u32 + 1) << 1 | u32::from(body))
    }

    /// The stem, unless the cell is free or closed.
    pub fn stem(self) -> Option<usize> {
        (self != Owner::FREE && self != Owner::CLOSED).then(|| (self.0 >> 1) as usize - 1)
    }

    /// True if the stem itself is there, not only its gap.
    pub fn is_body(self) -> bool {
        self.0 & 1 == 1 && self != Owner::CLOSED
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

/// What lies in a cell that is not free: its owner, and where on the stem it lies by arc length. Zeros
/// if it is closed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Claim(u64);

impl Claim {
    fn new(owner: Owner, place: f64) -> Self {
        Claim(u64::from(owner.0) << 32 | u64::from((place as f32).to_bits()))
    }

    fn owner(self) -> Owner {
        if self.0 == 0 { Owner::CLOSED } else { Owner((self.0 >> 32) as u32) }
    }

    fn place(self) -> f64 {
        f64::from(f32::from_bits(self.0 as u32))
    }
}

/// The cells of a container.
///
/// Most tests ask only whether cells are free, so that is kept apart, a bit each: 64 cells are
/// looked at in one step, and even millions of them stay in the processor's cache.
pub(super) struct Cells {
    grid: Grid,
    free: Bits,
    /// Inside, and no body there.
    open: Bits,
    inside: Bits,
    /// The claim of cells that are not free, at `Grid::place`. As numbers, of which the system has
    /// zeros at hand.
    claims: Vec<u64>,
}

/// Claims of so many columns and rows lie together, as memory likes it.
const TILE: usize = 8;

/// A bit for every cell, row by row, each row in whole words.
#[derive(Clone)]
struct Bits {
    words: Vec<u64>,
    per_row: usize,
}

impl Bits {
    fn new(columns: usize, rows: usize) -> Self {
        let per_row = columns.div_ceil(64);
        Bits { words: vec![0; per_row * rows], per_row }
    }

    fn get(&self, column: usize, row: usize) -> bool {
        self.words[row * self.per_row + column / 64] >> (column % 64) & 1 == 1
    }

    fn set(&mut self, column: usize, row: usize) {
        self.words[row * self.per_row + column / 64] |= 1 << (column % 64);
    }

    fn clear(&mut self, Run { row, from, to }: Run) {
        let (mut word, last) = (from / 64, to / 64);
        while word <= last {
            self.words[row * self.per_row + word] &= !mask(word, from, to);
            word += 1;
        }
    }

    /// Visits those columns of a run whose bit is `wanted`, until `visit` says false. True if it
    /// never did.
    #[inline(always)]
    fn each(&self, Run { row, from, to }: Run, wanted: bool, mut visit: impl FnMut(usize) -> bool) -> bool {
        let (mut word, last) = (from / 64, to / 64);
        while word <= last {
            let bits = self.words[row * self.per_row + word];
            let mut left = if wanted { bits } else { !bits } & mask(word, from, to);
            while left != 0 {
                if !visit(word * 64 + left.trailing_zeros() as usize) {
                    return false;
                }
                left &= left - 1;
            }
            word += 1;
        }
        true
    }
}

/// Those bits of a word whose columns lie in a run.
#[inline]
fn mask(word: usize, from: usize, to: usize) -> u64 {
    let low = if word == from / 64 { u64::MAX << (from % 64) } else { u64::MAX };
    let high = if word == to / 64 { u64::MAX >> (63 - to % 64) } else { u64::MAX };
    low & high
}

/// Neighbours in a row, the last included.
#[derive(Clone, Copy, Debug)]
struct Run {
    row: usize,
    from: usize,
    to: usize,
}

/// Rounded down; the processor's own instruction for it is not on every machine.
#[inline]
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

    /// Visits the runs of cells whose middle lies within a radius, `None` for those beyond the
    /// grid, until `visit` says false. True if it never did.
    #[inline(always)]
    fn near(&self, at: Point, radius: f64, mut visit: impl FnMut(Option<Run>) -> bool) -> bool {
        // Far from zero, where whole numbers are found by cutting off what follows the point.
        const BIAS: f64 = 1048576.0;
        let x = (at.x - self.origin.x) * self.per_unit - 0.5 + BIAS;
        let y = (at.y - self.origin.y) * self.per_unit - 0.5 + BIAS;
        let r = radius * self.per_unit;
        let (top, bottom) = ((y - r) as i64 + 1, (y + r) as i64);
        let (left, right) = ((x - r) as i64 + 1, (x + r) as i64);
        let bias = BIAS as i64;
        let inside = left >= bias
            && right < bias + self.columns as i64
            && top >= bias
            && bottom < bias + self.rows as i64;
        for row in top..bottom + 1 {
            let dy = row as f64 - y;
            let half = (r * r - dy * dy).max(0.0).sqrt();
            let (mut from, to) = ((x - half) as i64 + 1 - bias, (x + half) as i64 - bias);
            while from <= to {
                let (run, next) = self.run(row - bias, from, to, inside);
                if !visit(run) {
                    return false;
                }
                from = next;
            }
        }
        true
    }

    /// The first cells of a row, from a column on, that are neighbours on the grid; `None` if
    /// they are beyond it. And the column where to go on. Most are well `inside`.
    #[inline(always)]
    fn run(&self, row: i64, from: i64, to: i64, inside: bool) -> (Option<Run>, i64) {
        if inside {
            return (Some(Run { row: row as usize, from: from as usize, to: to as usize }), to + 1);
        }
        self.run_at_edge(row, from, to)
    }

    #[cold]
    fn run_at_edge(&self, row: i64, from: i64, to: i64) -> (Option<Run>, i64) {
        let columns = self.columns as i64;
        if row < 0 || row >= self.rows as i64 {
            return (None, to + 1);
        }
        let (first, next) = if self.wrap > 0 {
            let first = from.rem_euclid(columns);
            (first, (from + columns - first).min(to + 1))
        } else if from < 0 {
            return (None, 0);
        } else if from >= columns {
            return (None, to + 1);
        } else {
            (from, columns.min(to + 1))
        };
        let run = Run { row: row as usize, from: first as usize, to: (first + next - from - 1) as usize };
        (Some(run), next)
    }

    /// Where the claim of a cell lies: tile by tile.
    #[inline(always)]
    fn place(&self, column: usize, row: usize) -> usize {
        let tile = row / TILE * self.columns.div_ceil(TILE) + column / TILE;
        (tile * TILE + row % TILE) * TILE + column % TILE
    }

    /// Column and row of a place, if it is on the grid.
    fn cell(&self, at: Point) -> Option<(usize, usize)> {
        let column = floor((at.x - self.origin.x) * self.per_unit);
        let row = floor((at.y - self.origin.y) * self.per_unit);
        let column = if self.wrap > 0 { column.rem_euclid(self.wrap as i64) } else { column };
        let inside =
            column >= 0 && row >= 0 && (column as usize) < self.columns && (row as usize) < self.rows;
        inside.then_some((column as usize, row as usize))
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
        let mut free = Bits::new(columns, rows);
        for (i, _) in inside.iter().enumerate().filter(|(_, inside)| **inside) {
            free.set(i % columns, i / columns);
        }
        let grid = Grid { origin, size, per_unit: 1.0 / size, columns, rows, wrap };
        let tiles = columns.div_ceil(TILE) * rows.div_ceil(TILE);
        let claims = vec![0; tiles * TILE * TILE];
        let mut cells = Cells { grid, open: free.clone(), inside: Bits::new(0, 0), free, claims };
        // What the edge passes near is outside for certain.
        for contour in region.contours() {
            cells.close_edge(contour);
        }
        cells.inside = cells.free.clone();
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
                self.grid.near(at, self.grid.reach(0.0, apart), |run| {
                    if let Some(run) = run {
                        self.free.clear(run);
                        self.open.clear(run);
                    }
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
        let reach = self.grid.reach(radius, apart);
        self.is_box_free(at, reach)
            || self.grid.near(at, reach, |run| match run {
                None => may(Owner::CLOSED, 0.0),
                Some(run) => self.free.each(run, false, |column| {
                    let claim = Claim(self.claims[self.grid.place(column, run.row)]);
                    may(claim.owner(), claim.place())
                }),
            })
    }

    /// True if all cells of the square around a disc are free, which most are that are asked for: no
    /// root has to be drawn then.
    #[inline(always)]
    fn is_box_free(&self, at: Point, radius: f64) -> bool {
        let Grid { origin, per_unit, .. } = self.grid;
        let (x, y) = ((at.x - origin.x) * per_unit - 0.5, (at.y - origin.y) * per_unit - 0.5);
        let r = radius * per_unit;
        if x < r || y < r || x + r >= self.grid.columns as f64 || y + r >= self.grid.rows as f64 {
            return false;
        }
        let (left, right) = ((x - r) as usize, (x + r) as usize);
        let (top, bottom) = ((y - r) as usize, (y + r) as usize);
        let (first, last) = (left / 64, right / 64);
        if last > first + 1 {
            return false;
        }
        let (low, high) = (mask(first, left, right), mask(last, left, right));
        let Bits { words, per_row } = &self.free;
        let mut missing = 0;
        for row in top..bottom + 1 {
            missing |= low & !words[row * per_row + first] | high & !words[row * per_row + last];
        }
        missing == 0
    }

    /// True if a disc lies in the region, whatever else is there.
    pub fn is_inside(&self, at: Point, radius: f64) -> bool {
        self.grid.near(at, self.grid.reach(radius, 0.0), |run| {
            run.is_some_and(|run| self.inside.each(run, false, |_| false))
        })
    }

    /// Claims a disc for a stem; `place` is the arc length there.
    pub fn claim(&mut self, stem: usize, at: Point, radius: f64, apart: f64, place: f64) {
        let Cells { grid, free, open, claims, .. } = self;
        let Claim(claim) = Claim::new(Owner::of(stem, true), place);
        grid.near(at, grid.reach(radius, apart), |run| {
            if let Some(run) = run {
                open.each(run, true, |column| {
                    claims[grid.place(column, run.row)] = claim;
                    true
                });
                open.clear(run);
                free.clear(run);
            }
            true
        });
    }

    /// Claims the gap around a disc: what others have there is theirs already.
    pub fn claim_gap(&mut self, stem: usize, at: Point, radius: f64, apart: f64, place: f64) {
        let Cells { grid, free, claims, .. } = self;
        let Claim(claim) = Claim::new(Owner::of(stem, false), place);
        grid.near(at, grid.reach(radius, apart), |run| {
            if let Some(run) = run {
                free.each(run, true, |column| {
                    claims[grid.place(column, run.row)] = claim;
                    true
                });
                free.clear(run);
            }
            true
        });
    }

    /// Closes a disc that clip art covers.
    pub fn close(&mut self, at: Point, apart: f64) {
        let Cells { grid, free, open, claims, .. } = self;
        grid.near(at, grid.reach(0.0, apart), |run| {
            if let Some(run) = run {
                // What is free has no claim.
                free.each(run, false, |column| {
                    if open.get(column, run.row) {
                        claims[grid.place(column, run.row)] = 0;
                    }
                    true
                });
                open.clear(run);
                free.clear(run);
            }
            true
        });
    }

    /// Closes the gap around it: what stems have there is theirs already.
    pub fn close_gap(&mut self, at: Point, radius: f64, apart: f64) {
        let Cells { grid, free, .. } = self;
        grid.near(at, grid.reach(radius, apart), |run| {
            if let Some(run) = run {
                free.clear(run);
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
        let mut free = Bits::new(self.grid.columns, self.grid.rows);
        for row in 0..self.grid.rows {
            let run = Run { row, from: 0, to: self.grid.columns - 1 };
            self.free.each(run, true, |column| {
                if other.is_free(self.middle(row * self.grid.columns + column)) {
                    free.set(column, row);
                }
                true
            });
        }
        Cells {
            grid: self.grid,
            open: free.clone(),
            inside: self.inside.clone(),
            free,
            claims: self.claims.clone(),
        }
    }

    /// True if nobody claims a place.
    #[inline]
    pub fn is_free(&self, at: Point) -> bool {
        self.grid.cell(at).is_some_and(|(column, row)| self.free.get(column, row))
    }

    /// Who claims a place.
    pub fn owner(&self, at: Point) -> Owner {
        match self.grid.cell(at) {
            None => Owner::CLOSED,
            Some((column, row)) if self.free.get(column, row) => Owner::FREE,
            Some((column, row)) => Claim(self.claims[self.grid.place(column, row)]).owner(),
        }
    }

    /// Squared distance of every cell to the nearest that is not free, in cells; and the number
    /// of columns.
    pub fn clearances(&self) -> (Vec<f64>, usize) {
        // A frame of taken cells stands for what lies beyond the grid.
        let columns = self.grid.columns + 2;
        let mut taken = vec![true; columns * (self.grid.rows + 2)];
        for row in 0..self.grid.rows {
            for column in 0..self.grid.columns {
                taken[(row + 1) * columns + column + 1] = !self.free.get(column, row);
            }
        }
        let framed = squared_distances(&taken, columns);
        let unframed = (0..self.grid.rows)
            .flat_map(|row| framed[(row + 1) * columns + 1..][..self.grid.columns].iter().copied())
            .collect();
        (unframed, self.grid.columns)
    }

    /// Left end and width of what repeats sideways.
    pub fn span(&self) -> Option<(f64, f64)> {
        (self.grid.wrap > 0).then_some((self.grid.origin.x, self.grid.wrap as f64 * self.grid.size))
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
        self.grid.cell(at).map(|(column, row)| row * self.grid.columns + column)
    }
}
