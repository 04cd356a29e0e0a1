//! Room for growth in a container, between the images of symmetric growth.

use super::piece::Piece;
use super::space::{Circle, Space};
use crate::geom::distance::covered;
use crate::geom::region::Region;
use crate::geom::segment::point_segment;
use kurbo::{Affine, Point, Rect, Vec2};

/// Room at two scales: all of it in coarse cells, and what is near to something in fine ones. The first
/// elements of a large container change distances all over it, which would cost too much in fine cells.
#[derive(Clone, Debug)]
pub(super) struct Room {
    pub fine: Space,
    coarse: Space,
    /// True once no place has room for a large circle, whatever stops it: none can come any more, and
    /// coarse cells need not be kept up.
    is_small: bool,
    /// How often there was no large circle to be chosen.
    without: usize,
}

impl Room {
    /// Coarse cells along the side of a fine one.
    const COARSE: f64 = 3.0;
    /// Distances up to so many fine cells are known there.
    const NEAR: f64 = 16.0;
    /// Circles larger than so many fine cells are looked for in the coarse ones, whose middles may be
    /// as far from a circle's as the difference allows.
    const LARGE: f64 = 12.0;

    /// A circle that overlaps its own images by more than so many fine cells is of no use to any rule;
    /// one that does by less leads growth up to the seam.
    const SEAM: f64 = 7.0;

    /// No room, in cells of a size.
    pub fn none(cell: f64) -> Self {
        Self::new(None, Rect::new(0.0, 0.0, cell, cell), cell, &[])
    }

    /// The room in a region, or all over a box, between the images of symmetric growth.
    pub fn new(region: Option<&Region>, bounds: Rect, cell: f64, images: &[Affine]) -> Self {
        let space = |grain: f64, most: f32| {
            let (columns, rows) = Space::grid(bounds, grain);
            let mut inside = match region {
                Some(region) => inside_distances(region, bounds, grain, most),
                None => vec![most; columns * rows],
            };
            if images.len() > 1 {
                let most = f64::from(most) - Self::SEAM * cell;
                between_images(images, bounds.origin(), grain, (columns, rows), most, |i, wall| {
                    inside[i] = inside[i].min((wall + Self::SEAM * cell) as f32);
                });
            }
            Space::new(bounds, grain, &inside)
        };
        let (is_small, without) = (false, 0);
        Room {
            is_small,
            without,
            fine: space(cell, (Self::NEAR * cell) as f32),
            coarse: space(Self::COARSE * cell, f32::MAX),
        }
    }

    /// Side of a fine cell.
    pub fn cell(&self) -> f64 {
        self.fine.cell
    }

    /// Distance from a place, about, to what is nearest; `None` outside.
    pub fn distance(&self, at: Point) -> Option<f64> {
        let near = self.fine.distance(at)?;
        let is_known = near < (Self::NEAR - 1.0) * self.fine.cell;
        if is_known { Some(near) } else { self.coarse.distance(at).or(Some(near)) }
    }

    /// As [`Space::add`].
    pub fn add(&mut self, piece: &Piece, element: u32, only: bool) {
        self.fine.add(piece, element, only);
        if !self.is_small {
            self.coarse.add(piece, element, only);
        }
    }

    /// As [`Space::largest`].
    pub fn largest(&mut self, smallest: f64) -> Option<Circle> {
        if !self.is_small {
            let large = self.coarse.largest(smallest.max(Self::LARGE * self.fine.cell));
            if large.is_some() {
                return large;
            }
            // To look at all cells takes long: not every time.
            const LOOK_EVERY: usize = 64;
            if self.without.is_multiple_of(LOOK_EVERY) {
                self.is_small = self.coarse.is_within(Self::LARGE * self.fine.cell);
            }
            self.without += 1;
        }
        self.fine.largest(smallest)
    }

    /// As [`Space::exclude`].
    pub fn exclude(&mut self, at: Point) {
        self.fine.exclude(at);
        if !self.is_small {
            self.coarse.exclude(at);
        }
    }

    /// As [`Space::readmit`].
    pub fn readmit(&mut self, at: Point, radius: f64) {
        self.fine.readmit(at, radius);
        if !self.is_small {
            self.coarse.readmit(at, radius);
        }
    }

    /// As [`Space::readmit_all`].
    pub fn readmit_all(&mut self) {
        self.fine.readmit_all();
        self.coarse.readmit_all();
    }

    /// As [`Space::view`], of circles of all sizes.
    pub fn view(&self, smallest: f64) -> (Vec<Circle>, Vec<Point>) {
        let large = Self::LARGE * self.fine.cell;
        let (mut circles, excluded) = self.fine.view(smallest);
        circles.retain(|circle| circle.radius <= large);
        circles.extend(self.coarse.view(large).0);
        (circles, excluded)
    }

    /// As [`Space::widest`].
    pub fn widest(&self) -> Option<Point> {
        self.coarse.widest().or_else(|| self.fine.widest())
    }

    /// As [`Space::widest_in`].
    pub fn widest_in(&self, part: &Region) -> Option<Point> {
        self.coarse.widest_in(part).or_else(|| self.fine.widest_in(part))
    }

    /// As [`Space::widest_by`].
    pub fn widest_by(&self, other: impl Fn(Point) -> f64) -> Option<Point> {
        self.coarse.widest_by(other)
    }

    /// As [`Space::farthest`].
    pub fn farthest(&self, towards: Vec2) -> Option<Point> {
        self.coarse.farthest(towards).or_else(|| self.fine.farthest(towards))
    }
}

/// For cells of a grid half the distance of their middles to the nearest of their images, if that is less
/// than `most`.
fn between_images(
    images: &[Affine],
    origin: Point,
    cell: f64,
    (columns, rows): (usize, usize),
    most: f64,
    mut take: impl FnMut(usize, f64),
) {
    /// Cells of a block along its side, which look at the same few images.
    const BLOCK: usize = 16;
    let half = |p: Point, by: Affine| 0.5 * p.distance(by * p);
    let middle = |x: f64, y: f64| origin + cell * Vec2::new(x, y);
    let radius = 0.5 * BLOCK as f64 * cell * std::f64::consts::SQRT_2;
    for y0 in (0..rows).step_by(BLOCK) {
        for x0 in (0..columns).step_by(BLOCK) {
            let center = middle((x0 + BLOCK / 2) as f64, (y0 + BLOCK / 2) as f64);
            let all: Vec<f64> = images[1..].iter().map(|&by| half(center, by)).collect();
            // No image comes nearer by more than the way from the centre.
            let least = all.iter().copied().fold(most, f64::min);
            let near: Vec<Affine> =
                (1..images.len()).filter(|i| all[i - 1] <= least + 2.0 * radius).map(|i| images[i]).collect();
            for y in y0..(y0 + BLOCK).min(rows) {
                for x in x0..(x0 + BLOCK).min(columns) {
                    let p = middle(x as f64 + 0.5, y as f64 + 0.5);
                    let wall = near.iter().map(|&by| half(p, by)).fold(most, f64::min);
                    take(y * columns + x, wall);
                }
            }
        }
    }
}

/// For every cell of a grid the distance of its middle to the boundary of a region, `most` at most and
/// 0 outside.
/// Cells hand the edges that they are nearest to on to their neighbours, so that distances are to edges
/// and not to cells.
fn inside_distances(region: &Region, bounds: Rect, cell: f64, most: f32) -> Vec<f32> {
    let (columns, rows) = Space::grid(bounds, cell);
    let edges: Vec<(Point, Point)> = region
        .contours()
        .iter()
        .flat_map(|contour| (0..contour.len()).map(move |i| (contour[i], contour[(i + 1) % contour.len()])))
        .collect();
    let inside = covered(region.contours(), bounds.origin(), cell, columns, rows);
    let mut nearest = vec![u32::MAX; columns * rows];
    let mut distances = vec![most; columns * rows];
    let mut queue: Vec<(u32, u32)> = Vec::new();
    let mut take = |queue: &mut Vec<(u32, u32)>, nearest: &mut [u32], x: usize, y: usize, edge: u32| {
        let i = y * columns + x;
        if nearest[i] == edge {
            return;
        }
        let (a, b) = edges[edge as usize];
        let middle = bounds.origin() + cell * Vec2::new(x as f64 + 0.5, y as f64 + 0.5);
        let distance = point_segment(middle, a, b) as f32;
        if distance < distances[i] {
            (nearest[i], distances[i]) = (edge, distance);
            queue.push((x as u32, y as u32));
        }
    };
    for (number, &(a, b)) in edges.iter().enumerate() {
        Piece::Segment(a, b).along(0.5 * cell, |p| {
            let (x, y) = ((p.x - bounds.x0) / cell, (p.y - bounds.y0) / cell);
            for (dx, dy) in [(-0.5, -0.5), (0.5, -0.5), (-0.5, 0.5), (0.5, 0.5)] {
                let (x, y) = (x + dx, y + dy);
                if x >= 0.0 && y >= 0.0 && x < columns as f64 && y < rows as f64 {
                    take(&mut queue, &mut nearest, x as usize, y as usize, number as u32);
                }
            }
        });
    }
    let mut next = 0;
    while let Some(&(x, y)) = queue.get(next) {
        next += 1;
        let (x, y) = (x as usize, y as usize);
        let edge = nearest[y * columns + x];
        for y in y.saturating_sub(1)..(y + 2).min(rows) {
            for x in x.saturating_sub(1)..(x + 2).min(columns) {
                if inside[y * columns + x] {
                    take(&mut queue, &mut nearest, x, y, edge);
                }
            }
        }
    }
    for (distance, inside) in distances.iter_mut().zip(inside) {
        if !inside {
            *distance = 0.0;
        }
    }
    distances
}
