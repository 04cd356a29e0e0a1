//! Lines of many copies as one: squigs, dragons and Hilbert's curve for pens (checklist R-040).

use kurbo::{BezPath, ParamCurve, ParamCurveDeriv, PathEl, PathSeg, Point, Vec2};
use std::collections::HashMap;

/// Which ends are joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Join {
    /// Those that touch, wherever they come in drawing order.
    Touching,
    /// All, in drawing order, with straight bridges.
    All,
}

/// An open line with its ends.
struct Piece {
    path: BezPath,
    ends: [Point; 2],
    /// Which way a pen goes on from each end.
    ways: [Vec2; 2],
}

/// Collects pieces in drawing order and joins them.
pub(super) struct Joiner {
    join: Join,
    /// So near ends touch.
    near: f64,
    pieces: Vec<Piece>,
    closed: Vec<BezPath>,
}

impl Joiner {
    pub fn new(join: Join, near: f64) -> Self {
        Joiner { join, near, pieces: Vec::new(), closed: Vec::new() }
    }

    /// Adds a path; each of its subpaths is a piece.
    pub fn add(&mut self, path: &BezPath) {
        let mut piece = BezPath::new();
        for el in path.elements() {
            if matches!(el, PathEl::MoveTo(_)) && !piece.is_empty() {
                self.add_piece(std::mem::take(&mut piece));
            }
            piece.push(*el);
        }
        self.add_piece(piece);
    }

    fn add_piece(&mut self, path: BezPath) {
        if path.elements().iter().any(|el| matches!(el, PathEl::ClosePath)) {
            self.closed.push(path);
            return;
        }
        let (Some(first), Some(last)) = (path.segments().next(), path.segments().last()) else { return };
        let ends = [first.start(), last.end()];
        self.pieces.push(Piece { path, ends, ways: [-way(first, 0.0), way(last, 1.0)] });
    }

    /// The lines, closed ones last.
    pub fn finish(self) -> Vec<BezPath> {
        let mut lines = match self.join {
            Join::All => all_in_order(self.pieces, self.near),
            Join::Touching => touching(&self.pieces, self.near),
        };
        lines.extend(self.closed);
        lines
    }
}

fn way(segment: PathSeg, t: f64) -> Vec2 {
    let way = match segment {
        PathSeg::Line(line) => line.p1 - line.p0,
        PathSeg::Quad(quad) => quad.deriv().eval(t).to_vec2(),
        PathSeg::Cubic(cubic) => cubic.deriv().eval(t).to_vec2(),
    };
    way / way.hypot().max(f64::MIN_POSITIVE)
}

/// Appends a piece to a line, from its end `from` to the other; ends that touch are one node.
fn append(line: &mut BezPath, piece: &BezPath, from: usize, touches: bool) {
    let turned = (from == 1).then(|| piece.reverse_subpaths());
    let elements = turned.as_ref().unwrap_or(piece).elements();
    let bridge = |el: &PathEl| match *el {
        PathEl::MoveTo(p) => PathEl::LineTo(p),
        el => el,
    };
    if line.is_empty() {
        line.extend(elements.iter().copied());
    } else {
        line.extend(elements.iter().skip(usize::from(touches)).map(bridge));
    }
}

/// One line through all pieces in their order, each from its nearer end.
fn all_in_order(pieces: Vec<Piece>, near: f64) -> Vec<BezPath> {
    let gap = |p: Point, piece: &Piece| p.distance(piece.ends[0]).min(p.distance(piece.ends[1]));
    let mut line = BezPath::new();
    let mut at = match &pieces[..] {
        [] => return Vec::new(),
        // The first is drawn towards the second.
        [first, second, ..] if gap(first.ends[0], second) < gap(first.ends[1], second) => first.ends[1],
        [first, ..] => first.ends[0],
    };
    for piece in &pieces {
        let from = usize::from(at.distance(piece.ends[1]) < at.distance(piece.ends[0]));
        append(&mut line, &piece.path, from, at.distance(piece.ends[from]) <= near);
        at = piece.ends[1 - from];
    }
    vec![line]
}

/// Lines through pieces whose ends touch. Where several meet, a line goes on with its neighbour in
/// drawing order, or else as straight as it can.
fn touching(pieces: &[Piece], near: f64) -> Vec<BezPath> {
    let mut grid = Grid::new(pieces, near);
    let mut used = vec![false; pieces.len()];
    let mut lines = Vec::new();
    // Ends where nothing else touches come first, so that no line starts in its middle.
    let is_loose = |&(piece, end): &(usize, usize)| {
        let at = pieces[piece].ends[end];
        grid.around(at).all(|(i, j)| (i, j) == (piece, end) || pieces[i].ends[j].distance(at) > near)
    };
    let loose = (0..pieces.len()).flat_map(|piece| [(piece, 0), (piece, 1)]).filter(is_loose);
    let starts: Vec<(usize, usize)> = loose.chain((0..pieces.len()).map(|piece| (piece, 0))).collect();
    for start in starts {
        if used[start.0] {
            continue;
        }
        let mut line = BezPath::new();
        let mut next = Some(start);
        while let Some((piece, from)) = next {
            used[piece] = true;
            append(&mut line, &pieces[piece].path, from, true);
            grid.pass_over(pieces[piece].ends[1 - from], &used);
            next = successor(&grid, pieces, &used, near, (piece, 1 - from));
        }
        lines.push(line);
    }
    lines
}

/// Where a line goes on from an end of a piece.
fn successor(
    grid: &Grid,
    pieces: &[Piece],
    used: &[bool],
    near: f64,
    (piece, end): (usize, usize),
) -> Option<(usize, usize)> {
    let (at, way) = (pieces[piece].ends[end], pieces[piece].ways[end]);
    let touches = |&(i, from): &(usize, usize)| !used[i] && pieces[i].ends[from].distance(at) <= near;
    let rank = |(i, from): (usize, usize)| (i.abs_diff(piece) != 1, way.dot(pieces[i].ways[from]));
    grid.around(at).filter(touches).min_by(|&a, &b| {
        let ((far_a, bend_a), (far_b, bend_b)) = (rank(a), rank(b));
        far_a.cmp(&far_b).then(bend_a.total_cmp(&bend_b)).then(a.cmp(&b))
    })
}

/// Ends by cells as wide as twice the tolerance.
struct Grid {
    cell: f64,
    cells: HashMap<(i64, i64), Cell>,
}

#[derive(Default)]
struct Cell {
    /// Pieces and which end of them.
    ends: Vec<(usize, usize)>,
    /// So many at the start are used up.
    used: usize,
}

/// Ends of one cell that are looked at. Thousands of copies may meet in one point.
const MEETING: usize = 64;

impl Grid {
    fn new(pieces: &[Piece], near: f64) -> Self {
        let mut grid = Grid { cell: (2.0 * near).max(f64::MIN_POSITIVE), cells: HashMap::new() };
        for (i, piece) in pieces.iter().enumerate() {
            for (end, &p) in piece.ends.iter().enumerate() {
                grid.cells.entry(grid.of(p)).or_default().ends.push((i, end));
            }
        }
        grid
    }

    fn of(&self, p: Point) -> (i64, i64) {
        ((p.x / self.cell).floor() as i64, (p.y / self.cell).floor() as i64)
    }

    /// The cells around a point.
    fn near(&self, p: Point) -> impl Iterator<Item = (i64, i64)> + use<> {
        let (x, y) = self.of(p);
        (-1..=1).flat_map(move |i| (-1..=1).map(move |j| (x.saturating_add(i), y.saturating_add(j))))
    }

    /// Passes over used ends at the start of the cells around a point.
    fn pass_over(&mut self, p: Point, used: &[bool]) {
        for at in self.near(p) {
            if let Some(cell) = self.cells.get_mut(&at) {
                cell.used += cell.ends[cell.used..].iter().take_while(|&&(piece, _)| used[piece]).count();
            }
        }
    }

    fn around(&self, p: Point) -> impl Iterator<Item = (usize, usize)> {
        let cells = self.near(p).filter_map(|at| self.cells.get(&at));
        cells.flat_map(|cell| cell.ends[cell.used..].iter().take(MEETING).copied())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path(d: &str) -> BezPath {
        BezPath::from_svg(d).unwrap()
    }

    fn joined(join: Join, pieces: &[&str]) -> Vec<BezPath> {
        let mut joiner = Joiner::new(join, 1e-6);
        pieces.iter().for_each(|d| joiner.add(&path(d)));
        joiner.finish()
    }

    #[test]
    fn touching_ends_are_joined_whichever_way_they_were_drawn() {
        let lines = joined(Join::Touching, &["M1,0 L0,0", "M2,1 L1,0", "M2,1 L3,1", "M9,9 L8,8"]);
        assert_eq!(lines, [path("M0,0 L1,0 L2,1 L3,1"), path("M9,9 L8,8")]);
    }

    #[test]
    fn touching_ends_are_joined_in_whatever_order_they_come() {
        let lines = joined(Join::Touching, &["M2,0 L3,0", "M0,0 L1,0", "M9,0 V1 H8 Z", "M2,0 Q1.5,1 1,0"]);
        assert_eq!(lines, [path("M3,0 L2,0 Q1.5,1 1,0 L0,0"), path("M9,0 V1 H8 Z")]);
        // Around a square and back.
        let round = joined(Join::Touching, &["M0,0 L1,0", "M1,1 L0,1", "M1,0 L1,1", "M0,1 L0,0"]);
        assert_eq!(round, [path("M0,0 L1,0 L1,1 L0,1 L0,0")]);
    }

    #[test]
    fn where_many_meet_a_line_goes_on_straight() {
        let lines = joined(
            Join::Touching,
            &["M0,0 L1,0", "M5,5 L6,6", "M1,0 L1,-1", "M5,7 L6,8", "M1,0 L2,0.1", "M8,8 L9,7", "M1,1 L1,0"],
        );
        assert_eq!(lines[0], path("M0,0 L1,0 L2,0.1"));
        assert!(lines.contains(&path("M1,-1 L1,0 L1,1")));
    }

    #[test]
    fn gaps_are_bridged_on_request() {
        assert_eq!(joined(Join::All, &["M0,0 L1,0", "M3,0 L2,0"]), [path("M0,0 L1,0 L2,0 L3,0")]);
        assert_eq!(joined(Join::All, &["M1,0 L0,0", "M1,0 L2,0"]), [path("M0,0 L1,0 L2,0")]);
    }
}
