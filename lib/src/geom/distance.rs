//! Grids: which cells a shape covers, and the exact Euclidean distance transform
//! (Felzenszwalb and Huttenlocher 2012, *Distance transforms of sampled functions*). Both are
//! linear in the number of cells.

use kurbo::Point;
use std::ops::Range;

/// Squared distance, in cells, from every cell to the nearest marked one; infinite if none
/// is. Row by row.
pub fn squared_distances(marked: &[bool], columns: usize) -> Vec<f64> {
    let distances = Distances::new(marked, columns);
    let mut line = Line::default();
    let mut grid = Vec::with_capacity(marked.len());
    (0..distances.rows()).for_each(|row| grid.extend_from_slice(distances.row(row, &mut line)));
    grid
}

/// As [`squared_distances`], and which cell is the nearest marked one; a cell's own number if none is.
pub fn nearest_marked(marked: &[bool], columns: usize) -> (Vec<f64>, Vec<usize>) {
    let distances = Distances::new(marked, columns);
    let mut line = Line::default();
    let mut grid = Vec::with_capacity(marked.len());
    let mut cells: Vec<usize> = (0..marked.len()).collect();
    for (row, own) in cells.chunks_exact_mut(distances.columns).enumerate() {
        grid.extend_from_slice(distances.row(row, &mut line));
        let near = distances.near(row);
        for (cell, &root) in own.iter_mut().zip(&line.roots).filter(|(_, root)| near[**root] != NO_ROW) {
            *cell = near[root] as usize * distances.columns + root;
        }
    }
    (grid, cells)
}

/// Distances that are worked out a row at a time, in any order: whole grids of them would cost more to hold
/// than to make.
pub struct Distances {
    /// The row of the nearest marked cell in each cell's column.
    nearest: Vec<u32>,
    columns: usize,
}

impl Distances {
    /// To the cells that are marked.
    pub fn new(marked: &[bool], columns: usize) -> Self {
        let columns = columns.max(1);
        Distances { nearest: nearest_rows(marked, columns), columns }
    }

    fn rows(&self) -> usize {
        self.nearest.len() / self.columns
    }

    fn near(&self, row: usize) -> &[u32] {
        &self.nearest[row * self.columns..][..self.columns]
    }

    /// Squared distances of the cells of a row; infinite if no cell is marked.
    pub fn row<'a>(&self, row: usize, line: &'a mut Line) -> &'a [f64] {
        let heights = self.near(row).iter().map(|&near| match near {
            NO_ROW => f64::INFINITY,
            near => (row as f64 - f64::from(near)).powi(2),
        });
        line.values.clear();
        line.values.extend(heights);
        line.transform();
        &line.values
    }
}

/// Stands for no row.
const NO_ROW: u32 = u32::MAX;

/// The row of the nearest marked cell in each cell's column, the upper of two.
fn nearest_rows(marked: &[bool], columns: usize) -> Vec<u32> {
    let mut rows: Vec<u32> = vec![NO_ROW; marked.len()];
    let count = marked.len() / columns;
    for row in 0..count {
        let (before, own) = rows.split_at_mut(row * columns);
        let above = before.chunks_exact(columns).next_back();
        for (column, near) in own[..columns].iter_mut().enumerate() {
            *near = match marked[row * columns + column] {
                true => row as u32,
                false => above.map_or(NO_ROW, |above| above[column]),
            };
        }
    }
    for row in (1..count).rev() {
        let (before, own) = rows.split_at_mut(row * columns);
        let at = row as u32 - 1;
        for (near, &below) in before[(row - 1) * columns..].iter_mut().zip(&own[..columns]) {
            // What is no row, or no row below, is far beyond all others.
            let above = if *near == NO_ROW { NO_ROW } else { at - *near };
            if below.wrapping_sub(at) < above {
                *near = below;
            }
        }
    }
    rows
}

/// A row on its way, with the lower envelope of parabolas, one rooted in every sample.
#[derive(Default)]
pub struct Line {
    values: Vec<f64>,
    /// Where each value comes from.
    roots: Vec<usize>,
    /// The parabolas of the envelope, and where each begins to be the lowest.
    hull: Vec<(usize, f64)>,
    starts: Vec<f64>,
}

impl Line {
    /// Replaces heights by squared distances.
    fn transform(&mut self) {
        let Line { values, roots, hull, starts } = self;
        hull.clear();
        starts.clear();
        roots.clear();
        roots.extend(0..values.len());
        for (i, &height) in values.iter().enumerate() {
            if height.is_infinite() {
                continue;
            }
            let mut start = f64::NEG_INFINITY;
            while let Some(&(j, other)) = hull.last() {
                let (x, y) = (i as f64, j as f64);
                start = ((height + x * x) - (other + y * y)) / (2.0 * (x - y));
                if start > starts[starts.len() - 1] {
                    break;
                }
                hull.pop();
                starts.pop();
                start = f64::NEG_INFINITY;
            }
            hull.push((i, height));
            starts.push(start);
        }
        if hull.is_empty() {
            return;
        }
        let mut k = 0;
        for (x, value) in values.iter_mut().enumerate() {
            while k + 1 < hull.len() && starts[k + 1] < x as f64 {
                k += 1;
            }
            let (root, height) = hull[k];
            let d = x as f64 - root as f64;
            *value = d * d + height;
            roots[x] = root;
        }
    }
}

/// Which cells of a grid the sides of closed contours pass, to within half a cell; what lies outside counts for
/// the cells of the border.
pub fn passed(
    contours: &[impl AsRef<[Point]>],
    origin: Point,
    cell: f64,
    columns: usize,
    rows: usize,
) -> Vec<bool> {
    let mut passed = vec![false; columns * rows];
    for contour in contours.iter().map(AsRef::as_ref) {
        let sides = contour.last().into_iter().chain(contour).zip(contour);
        for (&p, &q) in sides {
            let steps = (p.distance(q) / (0.5 * cell)).ceil().clamp(1.0, 1e6);
            for k in 0..=steps as usize {
                let at = p.lerp(q, k as f64 / steps) - origin;
                let (x, y) = ((at.x / cell) as usize, (at.y / cell) as usize);
                passed[y.min(rows - 1) * columns + x.min(columns - 1)] = true;
            }
        }
    }
    passed
}

/// Which cells of a grid have their middle inside simple contours (even-odd), by scan lines.
pub fn covered(
    contours: &[impl AsRef<[Point]>],
    origin: Point,
    cell: f64,
    columns: usize,
    rows: usize,
) -> Vec<bool> {
    let mut covered = vec![false; columns * rows];
    cover(contours, origin, cell, columns, &mut covered);
    covered
}

/// Marks the cells inside simple contours in a grid with this many columns.
pub fn cover(
    contours: &[impl AsRef<[Point]>],
    origin: Point,
    cell: f64,
    columns: usize,
    covered: &mut [bool],
) {
    scan(
        contours,
        origin,
        cell,
        (columns, covered.len()),
        |around| around % 2 != 0,
        |run| covered[run].fill(true),
    );
}

/// Calls `visit` with the runs of cells inside simple contours in a grid of this many cells.
pub fn runs(
    contours: &[impl AsRef<[Point]>],
    origin: Point,
    cell: f64,
    (columns, cells): (usize, usize),
    visit: impl FnMut(Range<usize>),
) {
    scan(contours, origin, cell, (columns, cells), |around| around % 2 != 0, visit);
}

/// Marks the cells that contours wind around (nonzero), whatever crosses what.
pub fn cover_wound(
    contours: &[impl AsRef<[Point]>],
    origin: Point,
    cell: f64,
    columns: usize,
    covered: &mut [bool],
) {
    scan(
        contours,
        origin,
        cell,
        (columns, covered.len()),
        |around| around != 0,
        |run| covered[run].fill(true),
    );
}

/// Visits the runs of cells whose winding number is `inside`, by scan lines.
fn scan(
    contours: &[impl AsRef<[Point]>],
    origin: Point,
    cell: f64,
    (columns, cells): (usize, usize),
    inside: impl Fn(i32) -> bool,
    mut visit: impl FnMut(Range<usize>),
) {
    let rows = cells / columns.max(1);
    // Rows whose middle lies in [low, high): each edge end counts once.
    let row = |y: f64| (((y - origin.y) / cell - 0.5).ceil().max(0.0) as usize).min(rows);
    let ys = || contours.iter().flat_map(AsRef::as_ref).map(|p| p.y);
    let (first, last) =
        (row(ys().fold(f64::INFINITY, f64::min)), row(ys().fold(f64::NEG_INFINITY, f64::max)));
    let mut crossings: Vec<Vec<(f64, i32)>> = vec![Vec::new(); last.saturating_sub(first)];
    for contour in contours.iter().map(AsRef::as_ref) {
        let Some(&end) = contour.last() else { continue };
        let mut previous = end;
        for &p in contour {
            let (low, high, way) = if previous.y <= p.y { (previous, p, 1) } else { (p, previous, -1) };
            for r in row(low.y)..row(high.y) {
                let y = origin.y + (r as f64 + 0.5) * cell;
                let x = low.x + (y - low.y) / (high.y - low.y) * (high.x - low.x);
                crossings[r - first].push((x, way));
            }
            previous = p;
        }
    }
    let column = |x: f64| (((x - origin.x) / cell - 0.5).ceil().max(0.0) as usize).min(columns);
    for (r, crossings) in crossings.iter_mut().enumerate() {
        crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
        let start = (r + first) * columns;
        let mut around = 0;
        for pair in crossings.windows(2) {
            around += pair[0].1;
            if inside(around) {
                visit(start + column(pair[0].0)..start + column(pair[1].0));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Rng;

    #[test]
    fn covered_cells_have_their_middle_inside() {
        let contour: Vec<Point> = [(1.2, 0.7), (8.9, 2.1), (6.0, 9.3), (4.1, 4.0)].map(Point::from).to_vec();
        let region = crate::geom::region::Region::new(vec![contour.clone()]).unwrap();
        let covered = covered(&[contour], Point::new(0.5, 0.0), 0.7, 14, 14);
        for (i, &covered) in covered.iter().enumerate() {
            let middle = Point::new(0.5 + ((i % 14) as f64 + 0.5) * 0.7, ((i / 14) as f64 + 0.5) * 0.7);
            assert_eq!(covered, region.contains(middle), "{middle:?}");
        }
    }

    #[test]
    fn distances_are_exact() {
        let mut rng = Rng::new(3);
        let (columns, rows) = (37, 23);
        let marked: Vec<bool> = (0..columns * rows).map(|_| rng.unit() < 0.02).collect();
        let fast = squared_distances(&marked, columns);
        for (i, fast) in fast.iter().enumerate() {
            let brute = (0..marked.len()).filter(|&j| marked[j]).map(|j| {
                let (dx, dy) = ((i % columns).abs_diff(j % columns), (i / columns).abs_diff(j / columns));
                (dx * dx + dy * dy) as f64
            });
            assert!((fast - brute.fold(f64::INFINITY, f64::min)).abs() < 1e-9);
        }
        assert!(squared_distances(&[false; 6], 3).iter().all(|d| d.is_infinite()));
    }
}
