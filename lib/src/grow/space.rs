//! Where there is room: the largest empty circle that touches the ornament (000 4.1, checklist
//! W-090 to W-104; method notes 7).
//!
//! A departure from the paper, for the same circles: instead of a buffer of covered pixels and
//! circles that are inflated from the ridges of a Manhattan transform, every cell keeps its exact
//! Euclidean distance to the nearest thing and whether that is the boundary or an element. A circle
//! around the middle of a cell with that radius is empty, stopped by the boundary in the one case
//! and by an element in the other, so that nothing has to be inflated. What is added lowers the
//! distances around it outwards while they drop, and a pyramid of maxima over blocks of cells finds
//! the largest circle at once.

mod exclude;

use super::piece::Piece;
use crate::geom::region::Region;
use kurbo::{Point, Rect, Vec2};

/// The nearest thing is the boundary.
pub(super) const BOUNDARY: u32 = u32::MAX;
/// Not inside at all.
const OUTSIDE: u32 = u32::MAX - 1;
/// No excluded point covers the cell.
const NONE: u32 = u32::MAX;
/// Cells along the side of a block.
const BLOCK: usize = 8;

/// An empty circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    /// Its middle.
    pub center: Point,
    /// Its radius.
    pub radius: f64,
}

/// The nearest excluded point whose disc reaches a cell, and how far it is.
#[derive(Clone, Copy, Debug)]
struct Exclusion {
    distance: f32,
    by: u32,
}

const FREE: Exclusion = Exclusion { distance: f32::INFINITY, by: NONE };

#[derive(Clone, Copy, Debug)]
struct Near {
    distance: f32,
    by: u32,
}

/// A level of the pyramid: the largest value in each block of the level below.
#[derive(Clone, Debug)]
struct Level {
    columns: usize,
    best: Vec<f32>,
}

/// Distances in a container at one scale, and the places that were tried in vain.
#[derive(Clone, Debug)]
pub(super) struct Space {
    origin: Point,
    /// Side of a cell.
    pub cell: f64,
    columns: usize,
    rows: usize,
    /// From the middle of each cell to what is nearest. Cells of a block lie together, so that a wave
    /// stays within little memory.
    near: Vec<Near>,
    /// What excludes the cells of a block, for blocks that an excluded point reaches.
    exclusions: Vec<Option<Box<[Exclusion; BLOCK * BLOCK]>>>,
    levels: Vec<Level>,
    is_dirty: Vec<bool>,
    dirty: Vec<usize>,
    /// The exclude list; `None` where a point was taken off.
    excluded: Vec<Option<Point>>,
    /// Points of the list by block.
    excluded_in: Vec<Vec<u32>>,
    /// Work space of the waves.
    queue: Vec<Visit>,
}

/// Column, row and number of a cell.
type Visit = (u32, u32, u32);

impl Space {
    /// A space of cells whose middles are inside where `is_inside` says so, at this distance from
    /// the boundary.
    pub fn new(bounds: Rect, cell: f64, inside: &[f32]) -> Self {
        let (columns, rows) = Self::grid(bounds, cell);
        let mut levels = Vec::new();
        let (mut c, mut r) = (columns, rows);
        while levels.is_empty() || c * r > 1 {
            (c, r) = (c.div_ceil(BLOCK), r.div_ceil(BLOCK));
            levels.push(Level { columns: c, best: vec![-1.0; c * r] });
        }
        let blocks = levels[0].best.len();
        let count = blocks * BLOCK * BLOCK;
        let mut near = vec![Near { distance: 0.0, by: OUTSIDE }; count];
        for (i, &distance) in inside.iter().enumerate() {
            let by = if distance > 0.0 { BOUNDARY } else { OUTSIDE };
            near[cell_number(i % columns, i / columns, levels[0].columns)] = Near { distance, by };
        }
        Space {
            origin: bounds.origin(),
            cell,
            columns,
            rows,
            near,
            exclusions: vec![None; blocks],
            levels,
            is_dirty: vec![false; blocks],
            dirty: Vec::new(),
            excluded: Vec::new(),
            excluded_in: vec![Vec::new(); blocks],
            queue: Vec::new(),
        }
    }

    /// Columns and rows of a grid over a box.
    pub fn grid(bounds: Rect, cell: f64) -> (usize, usize) {
        let count = |side: f64| ((side / cell).ceil() as usize).max(1);
        (count(bounds.width()), count(bounds.height()))
    }

    /// Number of the cell in a column and row.
    #[inline]
    fn number(&self, x: usize, y: usize) -> usize {
        cell_number(x, y, self.levels[0].columns)
    }

    /// Column and row of a cell.
    fn column_row(&self, number: usize) -> (usize, usize) {
        let (block, within) = (number / (BLOCK * BLOCK), number % (BLOCK * BLOCK));
        let columns = self.levels[0].columns;
        (block % columns * BLOCK + within % BLOCK, block / columns * BLOCK + within / BLOCK)
    }

    /// The middle of a cell.
    fn middle(&self, number: usize) -> Point {
        let (x, y) = self.column_row(number);
        self.middle_at(x, y)
    }

    fn middle_at(&self, x: usize, y: usize) -> Point {
        self.origin + Vec2::new((x as f64 + 0.5) * self.cell, (y as f64 + 0.5) * self.cell)
    }

    /// Column and row of a place.
    fn place(&self, p: Point) -> Option<(usize, usize)> {
        let (x, y) = ((p.x - self.origin.x) / self.cell, (p.y - self.origin.y) / self.cell);
        let is_in = x >= 0.0 && y >= 0.0 && x < self.columns as f64 && y < self.rows as f64;
        is_in.then_some((x as usize, y as usize))
    }

    fn index(&self, p: Point) -> Option<usize> {
        self.place(p).map(|(x, y)| self.number(x, y))
    }

    /// A cell has changed.
    fn touch(&mut self, number: usize) {
        let block = number / (BLOCK * BLOCK);
        if !self.is_dirty[block] {
            self.is_dirty[block] = true;
            self.dirty.push(block);
        }
    }

    /// The radius of a circle around a cell's middle that may be chosen, or -1.
    fn value(&self, number: usize) -> f32 {
        let near = self.near[number];
        if near.by < OUTSIDE && self.exclusion(number).distance > near.distance {
            near.distance
        } else {
            -1.0
        }
    }

    fn exclusion(&self, number: usize) -> Exclusion {
        let cells = &self.exclusions[number / (BLOCK * BLOCK)];
        cells.as_ref().map_or(FREE, |cells| cells[number % (BLOCK * BLOCK)])
    }

    fn set_exclusion(&mut self, number: usize, exclusion: Exclusion) {
        let cells = &mut self.exclusions[number / (BLOCK * BLOCK)];
        let cells = cells.get_or_insert_with(|| Box::new([FREE; BLOCK * BLOCK]));
        cells[number % (BLOCK * BLOCK)] = exclusion;
        self.touch(number);
    }

    /// Cells that a wave goes on to from one.
    fn beside(&self, x: usize, y: usize) -> impl Iterator<Item = (usize, usize)> + use<> {
        let left = (x > 0).then(|| (x - 1, y));
        let right = (x + 1 < self.columns).then_some((x + 1, y));
        let up = (y > 0).then(|| (x, y - 1));
        let down = (y + 1 < self.rows).then_some((x, y + 1));
        [left, right, up, down].into_iter().flatten()
    }

    /// Distance from the middle of the cell at a place to what is nearest; `None` outside.
    pub fn distance(&self, at: Point) -> Option<f64> {
        let index = self.index(at)?;
        (self.near[index].by != OUTSIDE).then_some(f64::from(self.near[index].distance))
    }

    /// Adds a piece of an element. If it is its `only` one, cells that are the element's need not be
    /// looked at again.
    pub fn add(&mut self, piece: &Piece, element: u32, only: bool) {
        let own = if only { element } else { OUTSIDE };
        let local = |p: Point| ((p.x - self.origin.x) as f32, (p.y - self.origin.y) as f32);
        match *piece {
            Piece::Disc(center, radius) => {
                let ((cx, cy), radius) = (local(center), radius as f32);
                self.fill(element, (cx, cy), radius);
                self.wave(piece, (element, own), |x, y, known| {
                    // Most cells are not nearer, and need no root to tell.
                    let (dx, dy, reach) = (x - cx, y - cy, known + radius);
                    let squared = dx * dx + dy * dy;
                    if reach > 0.0 && squared < reach * reach { squared.sqrt() - radius } else { known }
                });
            }
            Piece::Segment(a, b) => {
                let ((ax, ay), (bx, by)) = (local(a), local(b));
                let (ux, uy) = (bx - ax, by - ay);
                let scale = 1.0 / (ux * ux + uy * uy).max(f32::MIN_POSITIVE);
                self.wave(piece, (element, own), |x, y, known| {
                    let (wx, wy) = (x - ax, y - ay);
                    let t = ((wx * ux + wy * uy) * scale).clamp(0.0, 1.0);
                    let (dx, dy) = (wx - t * ux, wy - t * uy);
                    let squared = dx * dx + dy * dy;
                    if known > 0.0 && squared < known * known { squared.sqrt() } else { known }
                });
            }
            Piece::Area(_) => {
                let origin = self.origin.to_vec2();
                self.wave(piece, (element, own), |x, y, _| {
                    piece.distance(Point::new(f64::from(x), f64::from(y)) + origin) as f32
                });
            }
        }
    }

    /// Takes the inside of a disc, row by row, up to a rim that a wave then starts from: nobody asks how
    /// deep inside a cell lies.
    fn fill(&mut self, element: u32, (cx, cy): (f32, f32), radius: f32) {
        let cell = self.cell as f32;
        let inner = radius - 1.5 * cell;
        if inner <= 0.0 {
            return;
        }
        let range = |from: f32, to: f32, count: usize| {
            let of = |v: f32| (v / cell - 0.5).clamp(0.0, count as f32);
            of(from).ceil() as usize..(of(to) as usize + 1).min(count)
        };
        for y in range(cy - inner, cy + inner, self.rows) {
            let dy = (y as f32 + 0.5) * cell - cy;
            let half = (inner * inner - dy * dy).max(0.0).sqrt();
            for x in range(cx - half, cx + half, self.columns) {
                let number = self.number(x, y);
                let near = &mut self.near[number];
                if near.by != OUTSIDE && near.distance > -radius {
                    *near = Near { distance: -radius, by: element };
                    self.touch(number);
                }
            }
        }
    }

    /// The cells that a piece is nearest to hang together, so that a wave from the cells along it
    /// reaches them all. `distance` is that from a place beside the origin, or what is known if it is
    /// not less.
    fn wave(&mut self, piece: &Piece, (element, own): (u32, u32), distance: impl Fn(f32, f32, f32) -> f32) {
        let mut queue = std::mem::take(&mut self.queue);
        // A line passes between the middles of cells; a disc holds those along its rim.
        const AROUND: [(f64, f64); 5] = [(0.0, 0.0), (-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0)];
        let (step, around) = match piece {
            Piece::Disc(_, radius) if *radius > 2.0 * self.cell => (2.0 * self.cell, &AROUND[..1]),
            _ => (0.5 * self.cell, &AROUND[..]),
        };
        piece.along(step, |p| {
            for &(dx, dy) in around {
                if let Some((x, y)) = self.place(p + Vec2::new(dx, dy) * self.cell) {
                    self.lower((x, y, self.number(x, y)), (element, own), &distance, &mut queue);
                }
            }
        });
        // From the number of a cell to those beside it, within its block or in the next.
        let (last, row) = (BLOCK - 1, self.levels[0].columns * BLOCK * BLOCK - (BLOCK - 1) * BLOCK);
        let across = BLOCK * BLOCK - last;
        let mut next = 0;
        while let Some(&(x, y, number)) = queue.get(next) {
            next += 1;
            let (x, y, number) = (x as usize, y as usize, number as usize);
            if x > 0 {
                let by = if x % BLOCK == 0 { across } else { 1 };
                self.lower((x - 1, y, number - by), (element, own), &distance, &mut queue);
            }
            if x + 1 < self.columns {
                let by = if x % BLOCK == last { across } else { 1 };
                self.lower((x + 1, y, number + by), (element, own), &distance, &mut queue);
            }
            if y > 0 {
                let by = if y % BLOCK == 0 { row } else { BLOCK };
                self.lower((x, y - 1, number - by), (element, own), &distance, &mut queue);
            }
            if y + 1 < self.rows {
                let by = if y % BLOCK == last { row } else { BLOCK };
                self.lower((x, y + 1, number + by), (element, own), &distance, &mut queue);
            }
        }
        queue.clear();
        self.queue = queue;
    }

    /// Gives a cell to an element if that is nearer than what is known.
    #[inline(always)]
    fn lower(
        &mut self,
        (x, y, number): (usize, usize, usize),
        (element, own): (u32, u32),
        distance: &impl Fn(f32, f32, f32) -> f32,
        queue: &mut Vec<Visit>,
    ) {
        let near = self.near[number];
        if near.by == own {
            return;
        }
        let cell = self.cell as f32;
        let distance = distance((x as f32 + 0.5) * cell, (y as f32 + 0.5) * cell, near.distance);
        if distance < near.distance && near.by != OUTSIDE {
            self.near[number] = Near { distance, by: element };
            self.touch(number);
            queue.push((x as u32, y as u32, number as u32));
        }
    }

    fn refresh(&mut self) {
        let mut changed: Vec<usize> = Vec::new();
        for block in std::mem::take(&mut self.dirty) {
            self.is_dirty[block] = false;
            let cells = block * BLOCK * BLOCK..(block + 1) * BLOCK * BLOCK;
            let best = match self.exclusions[block].is_some() {
                true => cells.map(|number| self.value(number)).fold(-1.0, f32::max),
                false => {
                    let eligible = self.near[cells].iter().filter(|near| near.by < OUTSIDE);
                    eligible.map(|near| near.distance).fold(-1.0, f32::max)
                }
            };
            if self.levels[0].best[block] != best {
                self.levels[0].best[block] = best;
                changed.push(block);
            }
        }
        for above in 1..self.levels.len() {
            let (below, level) = self.levels.split_at_mut(above);
            let (below, level) = (&below[above - 1], &mut level[0]);
            let rows = below.best.len() / below.columns;
            let mut parents: Vec<usize> = changed
                .iter()
                .map(|&i| i / below.columns / BLOCK * level.columns + i % below.columns / BLOCK)
                .collect();
            parents.sort_unstable();
            parents.dedup();
            changed.clear();
            for parent in parents {
                let (bx, by) = (parent % level.columns * BLOCK, parent / level.columns * BLOCK);
                let mut best = -1.0_f32;
                for y in by..(by + BLOCK).min(rows) {
                    let row = y * below.columns;
                    for &value in &below.best[row + bx..row + (bx + BLOCK).min(below.columns)] {
                        best = best.max(value);
                    }
                }
                if level.best[parent] != best {
                    level.best[parent] = best;
                    changed.push(parent);
                }
            }
        }
    }

    /// True if no cell is farther from what is nearest.
    pub fn is_within(&self, most: f64) -> bool {
        self.near.iter().all(|near| f64::from(near.distance) <= most)
    }

    /// The largest empty circle that an element stops and no excluded point lies in; of equal ones
    /// the first, row by row. `None` if none is larger than `smallest`.
    pub fn largest(&mut self, smallest: f64) -> Option<Circle> {
        self.refresh();
        let mut block = 0;
        let best = self.levels.last()?.best[0];
        if f64::from(best) <= smallest {
            return None;
        }
        for level in (1..self.levels.len()).rev() {
            // `block` is of this level; some block of the one below has the same value.
            let columns = self.levels[level].columns;
            let (bx, by) = (block % columns * BLOCK, block / columns * BLOCK);
            let below = &self.levels[level - 1];
            let rows = below.best.len() / below.columns;
            let mut inside = (by..(by + BLOCK).min(rows))
                .flat_map(|y| (bx..(bx + BLOCK).min(below.columns)).map(move |x| y * below.columns + x));
            block = inside.find(|&i| below.best[i] == best)?;
        }
        let cell = (block * BLOCK * BLOCK..(block + 1) * BLOCK * BLOCK).find(|&i| self.value(i) == best)?;
        Some(Circle { center: self.middle(cell), radius: f64::from(best) })
    }

    /// The middle of the widest place.
    pub fn widest(&self) -> Option<Point> {
        self.widest_of((0..self.near.len()).filter(|&i| self.near[i].by != OUTSIDE))
    }

    /// The same in a part of the region.
    pub fn widest_in(&self, part: &Region) -> Option<Point> {
        let bounds = part.bounds();
        let from = (bounds.origin() - self.origin) / self.cell;
        let to = (Point::new(bounds.x1, bounds.y1) - self.origin) / self.cell;
        let range = |a: f64, b: f64, n: usize| a.max(0.0) as usize..(b.max(0.0).ceil() as usize).min(n);
        let columns = range(from.x, to.x, self.columns);
        let rows = range(from.y, to.y, self.rows);
        let cells = rows.flat_map(|y| columns.clone().map(move |x| (x, y))).map(|(x, y)| self.number(x, y));
        self.widest_of(cells.filter(|&i| self.near[i].by != OUTSIDE && part.contains(self.middle(i))))
    }

    fn widest_of(&self, cells: impl Iterator<Item = usize>) -> Option<Point> {
        // Where all is equally far, as in the open plane, the middle.
        let center = self.origin + 0.5 * self.cell * Vec2::new(self.columns as f64, self.rows as f64);
        cells
            .max_by(|&a, &b| {
                let far = |i: usize| center.distance(self.middle(i));
                let of = |i: usize| self.near[i].distance;
                of(a).total_cmp(&of(b)).then(far(b).total_cmp(&far(a)))
            })
            .map(|i| self.middle(i))
    }

    /// The middle of the widest place of a coarse grid, where another width counts too.
    pub fn widest_by(&self, other: impl Fn(Point) -> f64) -> Option<Point> {
        const COARSE: usize = 48;
        let step = (self.columns.max(self.rows) / COARSE).max(1);
        let rows = (step / 2..self.rows).step_by(step);
        let cells = rows.flat_map(|y| (step / 2..self.columns).step_by(step).map(move |x| (x, y)));
        let mut best: Option<(f64, Point)> = None;
        for (x, y) in cells {
            let i = self.number(x, y);
            if self.near[i].by == OUTSIDE {
                continue;
            }
            let at = self.middle(i);
            let width = f64::from(self.near[i].distance).min(other(at));
            if best.is_none_or(|(most, _)| width > most + 1e-9) {
                best = Some((width, at));
            }
        }
        best.map(|(_, at)| at)
    }

    /// The place inside that is farthest in a direction, a little off the boundary.
    pub fn farthest(&self, towards: Vec2) -> Option<Point> {
        // Room for a dot of the paper's.
        const OFF: f32 = 4.0;
        let widest = self.near.iter().map(|near| near.distance).fold(0.0, f32::max);
        let off = (0.6 * widest).min(OFF);
        let inside =
            (0..self.near.len()).filter(|&i| self.near[i].by != OUTSIDE && self.near[i].distance > off);
        let along = |i: usize| self.middle(i).to_vec2().dot(towards);
        inside.max_by(|&a, &b| along(a).total_cmp(&along(b)).then(b.cmp(&a))).map(|i| self.middle(i))
    }

    /// Circles that might be chosen, the middle of each being no lower than its neighbours, and the
    /// exclude list.
    pub fn view(&self, smallest: f64) -> (Vec<Circle>, Vec<Point>) {
        let is_peak = |i: &usize| {
            let value = self.value(*i);
            let (x, y) = self.column_row(*i);
            f64::from(value) > smallest
                && self.beside(x, y).all(|(x, y)| self.value(self.number(x, y)) <= value)
        };
        let circle = |i: usize| Circle { center: self.middle(i), radius: f64::from(self.near[i].distance) };
        let circles = (0..self.near.len()).filter(is_peak).map(circle).collect();
        (circles, self.excluded.iter().flatten().copied().collect())
    }
}

#[inline]
fn cell_number(x: usize, y: usize, block_columns: usize) -> usize {
    let block = y / BLOCK * block_columns + x / BLOCK;
    block * BLOCK * BLOCK + y % BLOCK * BLOCK + x % BLOCK
}
