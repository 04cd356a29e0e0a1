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

use super::piece::Piece;
use crate::geom::distance::covered;
use crate::geom::near::point_segment;
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

#[derive(Clone, Copy, Debug)]
struct Cell {
    distance: f32,
    nearest: u32,
    /// To the nearest excluded point whose disc reaches here.
    excluded: f32,
    excluded_by: u32,
}

/// A level of the pyramid: the largest value in each block of the level below.
#[derive(Clone, Debug)]
struct Level {
    columns: usize,
    best: Vec<f32>,
}

/// Distances in a container, and the places that were tried in vain.
#[derive(Clone, Debug)]
pub(super) struct Space {
    origin: Point,
    pub cell: f64,
    columns: usize,
    rows: usize,
    cells: Vec<Cell>,
    levels: Vec<Level>,
    is_dirty: Vec<bool>,
    dirty: Vec<usize>,
    /// The exclude list; `None` where a point was taken off.
    excluded: Vec<Option<Point>>,
    /// Points of the list by block.
    excluded_in: Vec<Vec<u32>>,
    /// Work space of the waves.
    queue: Vec<usize>,
}

impl Space {
    /// A space of cells whose middles are inside where `is_inside` says so, at this distance from
    /// the boundary.
    pub fn new(bounds: Rect, cell: f64, inside: &[f32]) -> Self {
        let (columns, rows) = Self::grid(bounds, cell);
        let cells = inside.iter().map(|&distance| Cell {
            distance,
            nearest: if distance > 0.0 { BOUNDARY } else { OUTSIDE },
            excluded: f32::INFINITY,
            excluded_by: NONE,
        });
        let cells: Vec<Cell> = cells.collect();
        let mut levels = Vec::new();
        let (mut c, mut r) = (columns, rows);
        while levels.is_empty() || c * r > 1 {
            (c, r) = (c.div_ceil(BLOCK), r.div_ceil(BLOCK));
            levels.push(Level { columns: c, best: vec![-1.0; c * r] });
        }
        let blocks = levels[0].best.len();
        Space {
            origin: bounds.origin(),
            cell,
            columns,
            rows,
            cells,
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

    /// The middle of a cell.
    fn middle(&self, index: usize) -> Point {
        let (x, y) = (index % self.columns, index / self.columns);
        self.origin + Vec2::new((x as f64 + 0.5) * self.cell, (y as f64 + 0.5) * self.cell)
    }

    fn index(&self, p: Point) -> Option<usize> {
        let (x, y) = ((p.x - self.origin.x) / self.cell, (p.y - self.origin.y) / self.cell);
        let is_in = x >= 0.0 && y >= 0.0 && x < self.columns as f64 && y < self.rows as f64;
        is_in.then(|| y as usize * self.columns + x as usize)
    }

    fn block_of(&self, index: usize) -> usize {
        let (x, y) = (index % self.columns, index / self.columns);
        y / BLOCK * self.levels[0].columns + x / BLOCK
    }

    fn touch(&mut self, index: usize) {
        let block = self.block_of(index);
        if !self.is_dirty[block] {
            self.is_dirty[block] = true;
            self.dirty.push(block);
        }
    }

    /// The cells beside one.
    fn beside(&self, index: usize) -> impl Iterator<Item = usize> + use<> {
        let (x, columns, count) = (index % self.columns, self.columns, self.cells.len());
        let left = (x > 0).then(|| index - 1);
        let right = (x + 1 < columns).then(|| index + 1);
        let up = index.checked_sub(columns);
        let down = (index + columns < count).then(|| index + columns);
        [left, right, up, down].into_iter().flatten()
    }

    /// Distance from the middle of the cell at a place to what is nearest; `None` outside.
    pub fn distance(&self, at: Point) -> Option<f64> {
        let cell = self.cells[self.index(at)?];
        (cell.nearest != OUTSIDE).then_some(f64::from(cell.distance))
    }

    /// Adds a piece of an element. The cells that it is nearest to hang together, so that a wave
    /// from the cells along it reaches them all.
    pub fn add(&mut self, piece: &Piece, element: u32) {
        let mut queue = std::mem::take(&mut self.queue);
        let lower = |space: &mut Self, index: usize, queue: &mut Vec<usize>| {
            let distance = piece.distance(space.middle(index)) as f32;
            let cell = &mut space.cells[index];
            if distance < cell.distance && cell.nearest != OUTSIDE {
                cell.distance = distance;
                cell.nearest = element;
                space.touch(index);
                queue.push(index);
            }
        };
        piece.along(0.5 * self.cell, |p| {
            for (dx, dy) in [(0.0, 0.0), (-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0)] {
                if let Some(index) = self.index(p + Vec2::new(dx, dy) * self.cell) {
                    lower(self, index, &mut queue);
                }
            }
        });
        let mut next = 0;
        while let Some(&index) = queue.get(next) {
            next += 1;
            for beside in self.beside(index) {
                lower(self, beside, &mut queue);
            }
        }
        queue.clear();
        self.queue = queue;
    }

    /// A cell's radius, if a circle around it may be chosen.
    fn value(cell: &Cell) -> f32 {
        let is_eligible = cell.nearest < OUTSIDE && cell.excluded > cell.distance;
        if is_eligible { cell.distance } else { -1.0 }
    }

    fn refresh(&mut self) {
        let columns = self.levels[0].columns;
        let mut changed: Vec<usize> = Vec::new();
        for block in std::mem::take(&mut self.dirty) {
            self.is_dirty[block] = false;
            let (bx, by) = (block % columns * BLOCK, block / columns * BLOCK);
            let mut best = -1.0_f32;
            for y in by..(by + BLOCK).min(self.rows) {
                let row = y * self.columns;
                for cell in &self.cells[row + bx..row + (bx + BLOCK).min(self.columns)] {
                    best = best.max(Self::value(cell));
                }
            }
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

    /// The largest empty circle that an element stops and no excluded point lies in; of equal ones
    /// the first, row by row. `None` if none is larger than `smallest`.
    pub fn largest(&mut self, smallest: f64) -> Option<Circle> {
        self.refresh();
        let mut block = 0;
        let best = self.levels.last()?.best[0];
        if f64::from(best) <= smallest {
            return None;
        }
        for level in (0..self.levels.len()).rev() {
            // `block` is of this level; the one below has the same value somewhere in it.
            let columns = self.levels[level].columns;
            let (bx, by) = (block % columns * BLOCK, block / columns * BLOCK);
            let (below_columns, below_rows) = match level {
                0 => (self.columns, self.rows),
                _ => {
                    let below = &self.levels[level - 1];
                    (below.columns, below.best.len() / below.columns)
                }
            };
            let value = |i: usize| match level {
                0 => Self::value(&self.cells[i]),
                _ => self.levels[level - 1].best[i],
            };
            let inside = (by..(by + BLOCK).min(below_rows))
                .flat_map(|y| (bx..(bx + BLOCK).min(below_columns)).map(move |x| y * below_columns + x));
            block = inside.into_iter().find(|&i| value(i) == best)?;
        }
        Some(Circle { center: self.middle(block), radius: f64::from(best) })
    }

    /// The middle of the widest place.
    pub fn widest(&self) -> Option<Point> {
        let inside = (0..self.cells.len()).filter(|&i| self.cells[i].nearest != OUTSIDE);
        // Where all is equally far, as in the open plane, the middle.
        let center = self.origin + 0.5 * self.cell * Vec2::new(self.columns as f64, self.rows as f64);
        inside
            .max_by(|&a, &b| {
                let far = |i: usize| center.distance(self.middle(i));
                let of = |i: usize| self.cells[i].distance;
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
            let i = y * self.columns + x;
            if self.cells[i].nearest == OUTSIDE {
                continue;
            }
            let at = self.middle(i);
            let width = f64::from(self.cells[i].distance).min(other(at));
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
        let widest = self.cells.iter().filter(|cell| cell.nearest != OUTSIDE).map(|cell| cell.distance);
        let off = (0.6 * widest.fold(0.0, f32::max)).min(OFF);
        let inside = (0..self.cells.len())
            .filter(|&i| self.cells[i].nearest != OUTSIDE && self.cells[i].distance > off);
        let along = |i: usize| self.middle(i).to_vec2().dot(towards);
        inside.max_by(|&a, &b| along(a).total_cmp(&along(b)).then(b.cmp(&a))).map(|i| self.middle(i))
    }

    /// Circles that might be chosen, the middle of each being no lower than its neighbours, and the
    /// exclude list.
    pub fn view(&self, smallest: f64) -> (Vec<Circle>, Vec<Point>) {
        let is_peak = |i: &usize| {
            let value = Self::value(&self.cells[*i]);
            f64::from(value) > smallest && self.beside(*i).all(|j| Self::value(&self.cells[j]) <= value)
        };
        let circle = |i: usize| Circle { center: self.middle(i), radius: f64::from(self.cells[i].distance) };
        let circles = (0..self.cells.len()).filter(is_peak).map(circle).collect();
        (circles, self.excluded.iter().flatten().copied().collect())
    }

    /// Puts the middle of a cell on the exclude list. The cells whose circles it lies in hang
    /// together, because distances change no faster than places.
    pub fn exclude(&mut self, at: Point) {
        let Some(start) = self.index(at) else { return };
        let number = self.excluded.len() as u32;
        self.excluded.push(Some(at));
        let block = self.block_of(start);
        self.excluded_in[block].push(number);
        let mut queue = std::mem::take(&mut self.queue);
        queue.push(start);
        let mut next = 0;
        while let Some(&index) = queue.get(next) {
            next += 1;
            let distance = at.distance(self.middle(index)) as f32;
            let cell = &mut self.cells[index];
            if next > 1 && (distance > cell.distance || distance >= cell.excluded) {
                continue;
            }
            if cell.excluded_by == number {
                continue;
            }
            cell.excluded = distance;
            cell.excluded_by = number;
            self.touch(index);
            queue.extend(self.beside(index));
        }
        queue.clear();
        self.queue = queue;
    }

    /// Takes the points within `radius` off the exclude list.
    pub fn readmit(&mut self, at: Point, radius: f64) {
        let columns = self.levels[0].columns as i64;
        let rows = self.levels[0].best.len() as i64 / columns;
        let side = self.cell * BLOCK as f64;
        let of = |v: f64, most: i64| ((v / side).floor() as i64).clamp(0, most - 1);
        let from = at - self.origin;
        let (x0, x1) = (of(from.x - radius, columns), of(from.x + radius, columns));
        let (y0, y1) = (of(from.y - radius, rows), of(from.y + radius, rows));
        let mut freed = Vec::new();
        for block in (y0..=y1).flat_map(|y| (x0..=x1).map(move |x| (y * columns + x) as usize)) {
            let excluded = &mut self.excluded;
            self.excluded_in[block].retain(|&number| {
                let is_near = excluded[number as usize].is_some_and(|point| point.distance(at) <= radius);
                if is_near {
                    freed.push((number, excluded[number as usize].take()));
                }
                !is_near
            });
        }
        for (number, point) in freed {
            if let Some(start) = point.and_then(|point| self.index(point)) {
                self.free(number, start);
            }
        }
    }

    /// Clears the exclude list.
    pub fn readmit_all(&mut self) {
        for index in 0..self.cells.len() {
            if self.cells[index].excluded_by != NONE {
                self.cells[index].excluded_by = NONE;
                self.cells[index].excluded = f32::INFINITY;
                self.touch(index);
            }
        }
        self.excluded.clear();
        self.excluded_in.iter_mut().for_each(Vec::clear);
    }

    /// Cells that a point was nearest to look for another.
    fn free(&mut self, number: u32, start: usize) {
        let mut cells = vec![start];
        let mut largest = 0.0_f32;
        let mut next = 0;
        while let Some(&index) = cells.get(next) {
            next += 1;
            let cell = &mut self.cells[index];
            if cell.excluded_by != number {
                continue;
            }
            cell.excluded_by = NONE;
            cell.excluded = f32::INFINITY;
            largest = largest.max(cell.distance);
            cells.extend(self.beside(index));
        }
        let reach = f64::from(largest).max(0.0);
        let others = self.listed_near(self.middle(start), 2.0 * reach);
        for index in cells {
            let at = self.middle(index);
            let cell = &mut self.cells[index];
            if cell.excluded_by != NONE {
                continue;
            }
            for &(number, point) in &others {
                let distance = point.distance(at) as f32;
                if distance <= cell.distance && distance < cell.excluded {
                    cell.excluded = distance;
                    cell.excluded_by = number;
                }
            }
            self.touch(index);
        }
    }

    fn listed_near(&self, at: Point, radius: f64) -> Vec<(u32, Point)> {
        let columns = self.levels[0].columns as i64;
        let rows = self.levels[0].best.len() as i64 / columns;
        let side = self.cell * BLOCK as f64;
        let of = |v: f64, most: i64| ((v / side).floor() as i64).clamp(0, most - 1);
        let from = at - self.origin;
        let (x0, x1) = (of(from.x - radius, columns), of(from.x + radius, columns));
        let (y0, y1) = (of(from.y - radius, rows), of(from.y + radius, rows));
        (y0..=y1)
            .flat_map(|y| (x0..=x1).map(move |x| (y * columns + x) as usize))
            .flat_map(|block| &self.excluded_in[block])
            .filter_map(|&number| Some((number, self.excluded[number as usize]?)))
            .filter(|(_, point)| point.distance(at) <= radius)
            .collect()
    }
}

/// For every cell of a grid the distance of its middle to the boundary of a region, 0 outside.
/// Two sweeps hand each cell the nearest edges of its neighbours, so that distances are to edges and
/// not to cells.
pub(super) fn inside_distances(region: &Region, bounds: Rect, cell: f64) -> Vec<f32> {
    let (columns, rows) = Space::grid(bounds, cell);
    let edges: Vec<(Point, Point)> = region
        .contours()
        .iter()
        .flat_map(|contour| (0..contour.len()).map(move |i| (contour[i], contour[(i + 1) % contour.len()])))
        .collect();
    let inside = covered(region.contours(), bounds.origin(), cell, columns, rows);
    let middle = |i: usize| {
        let (x, y) = ((i % columns) as f64 + 0.5, (i / columns) as f64 + 0.5);
        bounds.origin() + cell * Vec2::new(x, y)
    };
    let mut nearest = vec![u32::MAX; columns * rows];
    let mut distances = vec![f32::INFINITY; columns * rows];
    let take = |nearest: &mut [u32], distances: &mut [f32], i: usize, edge: u32| {
        if edge == u32::MAX || nearest[i] == edge {
            return;
        }
        let (a, b) = edges[edge as usize];
        let distance = point_segment(middle(i), a, b) as f32;
        if distance < distances[i] {
            (nearest[i], distances[i]) = (edge, distance);
        }
    };
    for (number, &(a, b)) in edges.iter().enumerate() {
        Piece::Segment(a, b).along(0.5 * cell, |p| {
            let (x, y) = ((p.x - bounds.x0) / cell, (p.y - bounds.y0) / cell);
            for (dx, dy) in [(-0.5, -0.5), (0.5, -0.5), (-0.5, 0.5), (0.5, 0.5)] {
                let (x, y) = (x + dx, y + dy);
                if x >= 0.0 && y >= 0.0 && x < columns as f64 && y < rows as f64 {
                    let i = y as usize * columns + x as usize;
                    take(&mut nearest, &mut distances, i, number as u32);
                }
            }
        });
    }
    for is_back in [false, true] {
        for step in 0..columns * rows {
            let i = if is_back { columns * rows - 1 - step } else { step };
            if !inside[i] {
                continue;
            }
            let (x, y) = (i % columns, i / columns);
            let (left, right) = (x > 0, x + 1 < columns);
            let (up, down) = (y > 0, y + 1 < rows);
            let sides = match is_back {
                false => [
                    (left, i.wrapping_sub(1)),
                    (up, i.wrapping_sub(columns)),
                    (up && left, i.wrapping_sub(columns + 1)),
                    (up && right, i.wrapping_sub(columns).wrapping_add(1)),
                ],
                true => [
                    (right, i + 1),
                    (down, i + columns),
                    (down && left, (i + columns).wrapping_sub(1)),
                    (down && right, i + columns + 1),
                ],
            };
            for (_, beside) in sides.into_iter().filter(|side| side.0) {
                let edge = nearest[beside];
                take(&mut nearest, &mut distances, i, edge);
            }
        }
        // A row's cells may be nearer to what is on their other side.
        for row in 0..rows {
            for step in 1..columns {
                let x = if is_back { step } else { columns - 1 - step };
                let i = row * columns + x;
                let beside = if is_back { i - 1 } else { i + 1 };
                if inside[i] {
                    let edge = nearest[beside];
                    take(&mut nearest, &mut distances, i, edge);
                }
            }
        }
    }
    for (distance, inside) in distances.iter_mut().zip(inside) {
        if !inside || !distance.is_finite() {
            *distance = 0.0;
        }
    }
    distances
}
