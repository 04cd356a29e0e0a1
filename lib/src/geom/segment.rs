//! Segments: how far they are from points and each other, and which are near a place.

use super::near::Cells;
use kurbo::{Point, Rect};

/// Segments with an owner each, to be found by place.
#[derive(Clone, Debug)]
pub struct SegmentGrid {
    cells: Cells,
    /// The first and the last block of each cell.
    ends: Vec<(u32, u32)>,
    /// In every cell that a segment's box touches, the segment itself: looking it up by a
    /// number would cost more than the copies.
    blocks: Blocks,
}

/// A segment with its owner.
type Owned = (Point, Point, u32);

/// Some segments of a cell, and the number of its next block.
#[derive(Clone, Debug)]
struct Block {
    segments: [Owned; BLOCK],
    count: u32,
    next: u32,
}

/// Segments of a block at most: more would leave more unused.
const BLOCK: usize = 5;

/// Stands for no block.
const NO_BLOCK: u32 = u32::MAX;

/// Blocks by number, in chunks: one that is full is never copied to grow.
#[derive(Clone, Debug, Default)]
struct Blocks {
    chunks: Vec<Vec<Block>>,
    count: usize,
}

impl Blocks {
    const CHUNK: usize = 256;

    fn get(&self, number: u32) -> Option<&Block> {
        self.chunks.get(number as usize / Self::CHUNK)?.get(number as usize % Self::CHUNK)
    }

    fn get_mut(&mut self, number: u32) -> Option<&mut Block> {
        self.chunks.get_mut(number as usize / Self::CHUNK)?.get_mut(number as usize % Self::CHUNK)
    }

    /// Adds one with this segment and tells its number.
    fn add(&mut self, segment: Owned) -> u32 {
        let chunk = self.count / Self::CHUNK;
        if chunk == self.chunks.len() {
            self.chunks.push(Vec::new());
        }
        self.chunks[chunk].push(Block { segments: [segment; BLOCK], count: 1, next: NO_BLOCK });
        self.count += 1;
        self.count as u32 - 1
    }

    /// Takes all out, and keeps the memory.
    fn clear(&mut self) {
        self.chunks.iter_mut().for_each(Vec::clear);
        self.count = 0;
    }
}

impl SegmentGrid {
    /// An empty grid over `bounds`; places outside fall into the border cells.
    pub fn new(bounds: Rect, cell: f64) -> Self {
        let cells = Cells::new(bounds, cell);
        let ends = vec![(NO_BLOCK, NO_BLOCK); cells.columns * cells.rows];
        SegmentGrid { cells, ends, blocks: Blocks::default() }
    }

    /// Takes all segments out.
    pub fn clear(&mut self) {
        self.ends.fill((NO_BLOCK, NO_BLOCK));
        self.blocks.clear();
    }

    /// Adds a segment.
    pub fn insert(&mut self, a: Point, b: Point, owner: u32) {
        let (low, high) = (Point::new(a.x.min(b.x), a.y.min(b.y)), Point::new(a.x.max(b.x), a.y.max(b.y)));
        for index in self.cells.covered(low, high) {
            let last = self.ends[index].1;
            match self.blocks.get_mut(last) {
                Some(block) if (block.count as usize) < BLOCK => {
                    block.segments[block.count as usize] = (a, b, owner);
                    block.count += 1;
                }
                _ => {
                    let number = self.blocks.add((a, b, owner));
                    match self.blocks.get_mut(last) {
                        Some(block) => block.next = number,
                        None => self.ends[index].0 = number,
                    }
                    self.ends[index].1 = number;
                }
            }
        }
    }

    /// Takes out all of an owner's segments that pass where the sides of a closed contour do.
    pub fn remove_contour(&mut self, contour: &[Point], owner: u32) {
        let Some(&last) = contour.last() else { return };
        let mut previous = last;
        for &p in contour {
            let low = Point::new(previous.x.min(p.x), previous.y.min(p.y));
            let high = Point::new(previous.x.max(p.x), previous.y.max(p.y));
            for index in self.cells.covered(low, high) {
                let mut number = self.ends[index].0;
                while let Some(block) = self.blocks.get_mut(number) {
                    let mut kept = 0;
                    for k in 0..block.count as usize {
                        if block.segments[k].2 != owner {
                            block.segments[kept] = block.segments[k];
                            kept += 1;
                        }
                    }
                    block.count = kept as u32;
                    number = block.next;
                }
            }
            previous = p;
        }
    }

    /// The segments in a cell.
    fn content(&self, index: usize) -> impl Iterator<Item = &Owned> {
        let block = |number: u32| self.blocks.get(number);
        let blocks = std::iter::successors(block(self.ends[index].0), move |last| block(last.next));
        blocks.flat_map(|block| &block.segments[..block.count as usize])
    }

    /// Adds the sides of a closed contour.
    pub fn insert_contour(&mut self, contour: &[Point], owner: u32) {
        let Some(&last) = contour.last() else { return };
        let mut previous = last;
        for &p in contour {
            self.insert(previous, p, owner);
            previous = p;
        }
    }

    /// Visits the segments that may come within `radius` of the box of `a` and `b`, until
    /// `visit` says false. A segment may be visited more than once.
    pub fn visit(&self, a: Point, b: Point, radius: f64, mut visit: impl FnMut(Point, Point, u32) -> bool) {
        let low = Point::new(a.x.min(b.x) - radius, a.y.min(b.y) - radius);
        let high = Point::new(a.x.max(b.x) + radius, a.y.max(b.y) + radius);
        for index in self.cells.covered(low, high) {
            for &(p, q, owner) in self.content(index) {
                if !visit(p, q, owner) {
                    return;
                }
            }
        }
    }

    /// Distance to the nearest segment, or `reach` if none is nearer.
    pub fn distance(&self, at: Point, reach: f64) -> f64 {
        self.nearest(at, reach, |_| 0.0, 0.0).0
    }

    /// Distance to the nearest stroke along a segment, `reach` if none is nearer, and that segment: half stroke
    /// widths by owner, and the `widest` of them. Negative in a stroke.
    pub fn nearest_stroke(
        &self,
        at: Point,
        reach: f64,
        (strokes, widest): (&[f64], f64),
    ) -> (f64, Option<Owned>) {
        if widest == 0.0 {
            return self.nearest(at, reach, |_| 0.0, 0.0);
        }
        self.nearest(at, reach, |owner| strokes[owner as usize], widest)
    }

    /// The segment that is nearest where each is wider by half a stroke, `widest` at most.
    fn nearest(
        &self,
        at: Point,
        reach: f64,
        stroke: impl Fn(u32) -> f64,
        widest: f64,
    ) -> (f64, Option<Owned>) {
        let (column, row) = (self.cells.column(at.x) as i64, self.cells.row(at.y) as i64);
        let all = self.cells.columns.max(self.cells.rows) as i64;
        let rings = (((reach + widest) / self.cells.size).min(1e9) as i64 + 1).min(all);
        let (mut best, mut found) = (reach, None);
        // No segment beyond this is any nearer.
        let mut squared = (best + widest).powi(2);
        for ring in 0..=rings {
            // What lies in this ring of cells is at least this far away, also from a place
            // outside the grid, whose ring is that of the border cell next to it.
            let nearest = (ring - 1) as f64 * self.cells.size;
            if ring > 1 && nearest * nearest >= squared {
                break;
            }
            self.cells.ring(column, row, ring, |index| {
                let is_empty = self.ends[index].0 == NO_BLOCK;
                if is_empty || self.cells.distance_squared(at, index) >= squared {
                    return;
                }
                for &(p, q, owner) in self.content(index) {
                    let apart = point_segment_squared(at, p, q);
                    if apart < squared {
                        let distance = apart.sqrt() - stroke(owner);
                        if distance < best {
                            (best, found) = (distance, Some((p, q, owner)));
                            squared = (best + widest).powi(2);
                        }
                    }
                }
            });
        }
        (best, found)
    }

    /// How far a ray from `at` along the unit vector `along` runs before it meets a segment,
    /// `reach` at most.
    pub fn ray(&self, at: Point, along: kurbo::Vec2, reach: f64) -> f64 {
        let mut best = reach;
        // Walk in pieces, so that a short way does not look at far cells.
        let piece = self.cells.size.max(reach / 256.0);
        let mut walked = 0.0;
        while walked < best {
            let to = (walked + piece).min(reach);
            self.visit(at + walked * along, at + to * along, 0.0, |p, q, _| {
                if let Some(t) = ray_segment(at, along, p, q) {
                    best = best.min(t);
                }
                true
            });
            walked = to;
            if to >= reach {
                break;
            }
        }
        best
    }
}

/// Distance from a point to a segment.
pub fn point_segment(at: Point, p: Point, q: Point) -> f64 {
    point_segment_squared(at, p, q).sqrt()
}

/// The place of a segment that is nearest to a point.
pub fn foot(at: Point, p: Point, q: Point) -> Point {
    let d = q - p;
    p + ((at - p).dot(d) / d.hypot2().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0) * d
}

fn point_segment_squared(at: Point, p: Point, q: Point) -> f64 {
    let (d, w) = (q - p, at - p);
    let (along, squared) = (w.dot(d), d.hypot2());
    if along <= 0.0 {
        w.hypot2()
    } else if along >= squared {
        at.distance_squared(q)
    } else {
        (w - (along / squared) * d).hypot2()
    }
}

/// Distance between two segments; 0 if they cross.
pub fn segment_segment(a: Point, b: Point, p: Point, q: Point) -> f64 {
    if crosses(a, b, p, q) {
        return 0.0;
    }
    point_segment(a, p, q).min(point_segment(b, p, q)).min(point_segment(p, a, b)).min(point_segment(q, a, b))
}

/// True if two segments cross in their interiors.
pub fn crosses(a: Point, b: Point, p: Point, q: Point) -> bool {
    let side = |o: Point, d: Point, x: Point| (d - o).cross(x - o);
    let (s1, s2) = (side(a, b, p), side(a, b, q));
    let (s3, s4) = (side(p, q, a), side(p, q, b));
    s1 * s2 < 0.0 && s3 * s4 < 0.0
}

fn ray_segment(at: Point, along: kurbo::Vec2, p: Point, q: Point) -> Option<f64> {
    let d = q - p;
    let denominator = along.cross(d);
    if denominator == 0.0 {
        return None;
    }
    let w = p - at;
    let (t, u) = (w.cross(d) / denominator, w.cross(along) / denominator);
    (t >= 0.0 && (0.0..=1.0).contains(&u)).then_some(t)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Rng;
    use kurbo::Vec2;

    #[test]
    fn distances_and_rays_agree_with_brute_force() {
        let mut rng = Rng::new(1);
        let mut point = || Point::new(rng.between(0.0, 100.0), rng.between(0.0, 100.0));
        let segments: Vec<(Point, Point)> = (0..200)
            .map(|_| {
                let p = point();
                (p, p.lerp(point(), 0.1))
            })
            .collect();
        let mut grid = SegmentGrid::new(Rect::new(0.0, 0.0, 100.0, 100.0), 3.0);
        segments.iter().for_each(|&(p, q)| grid.insert(p, q, 0));
        // What is taken out again leaves no trace.
        let contour = [Point::new(10.0, 10.0), Point::new(90.0, 50.0), Point::new(10.0, 90.0)];
        grid.insert_contour(&contour, 1);
        segments.iter().for_each(|&(p, q)| grid.insert(p, q, 2));
        grid.remove_contour(&contour, 1);
        for i in 0..200 {
            let at = point();
            let brute = segments.iter().map(|&(p, q)| point_segment(at, p, q)).fold(50.0, f64::min);
            assert!((grid.distance(at, 50.0) - brute).abs() < 1e-12);
            let outside = at + Vec2::new(-30.0, 95.0);
            let brute = segments.iter().map(|&(p, q)| point_segment(outside, p, q)).fold(70.0, f64::min);
            assert!((grid.distance(outside, 70.0) - brute).abs() < 1e-12);
            let angle = f64::from(i);
            let along = Vec2::new(libm::cos(angle), libm::sin(angle));
            let brute =
                segments.iter().filter_map(|&(p, q)| ray_segment(at, along, p, q)).fold(60.0, f64::min);
            assert!((grid.ray(at, along, 60.0) - brute).abs() < 1e-9);
        }
    }
}
