//! Lines of many copies as one: squigs, dragons and Hilbert's curve for pens (checklist R-040).

use kurbo::{BezPath, ParamCurve, PathEl, Point};

/// Which ends are joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Join {
    /// Those that touch.
    Touching,
    /// All, in drawing order, with straight bridges.
    All,
}

/// Lines that grow at their end as pieces come, in drawing order.
pub(super) struct Joiner {
    join: Join,
    /// So near ends touch.
    near: f64,
    line: BezPath,
    /// How many pieces the line has, its start and its end.
    open: Option<(usize, Point, Point)>,
    done: Vec<BezPath>,
}

impl Joiner {
    pub fn new(join: Join, near: f64) -> Self {
        Joiner { join, near, line: BezPath::new(), open: None, done: Vec::new() }
    }

    /// Adds a piece; each of its subpaths is one.
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

    fn add_piece(&mut self, mut piece: BezPath) {
        let is_closed = piece.elements().iter().any(|el| matches!(el, PathEl::ClosePath));
        let ends = (piece.segments().next().map(|s| s.start()), piece.segments().last().map(|s| s.end()));
        let (Some(start), Some(mut end)) = ends else { return };
        if is_closed {
            self.finish_line();
            self.done.push(piece);
            return;
        }
        if let Some((count, from, at)) = self.open {
            let gap = |a: Point| a.distance(start).min(a.distance(end));
            // The first piece may be drawn the other way round.
            let turns = count == 1 && gap(from) < gap(at);
            let (from, at) = if turns { (at, from) } else { (from, at) };
            let touches = gap(at) <= self.near;
            if touches || self.join == Join::All {
                if turns {
                    self.line = self.line.reverse_subpaths();
                }
                if at.distance(end) < at.distance(start) {
                    piece = piece.reverse_subpaths();
                    end = start;
                }
                let bridge = |el: &PathEl| match *el {
                    PathEl::MoveTo(p) => PathEl::LineTo(p),
                    el => el,
                };
                self.line.extend(piece.elements().iter().skip(usize::from(touches)).map(bridge));
                self.open = Some((count + 1, from, end));
                return;
            }
            self.finish_line();
        }
        self.line = piece;
        self.open = Some((1, start, end));
    }

    fn finish_line(&mut self) {
        if self.open.take().is_some() {
            self.done.push(std::mem::take(&mut self.line));
        }
    }

    /// The lines.
    pub fn finish(mut self) -> Vec<BezPath> {
        self.finish_line();
        self.done
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path(d: &str) -> BezPath {
        BezPath::from_svg(d).unwrap()
    }

    #[test]
    fn touching_ends_are_joined_whichever_way_they_were_drawn() {
        let mut joiner = Joiner::new(Join::Touching, 1e-6);
        ["M1,0 L0,0", "M2,1 L1,0", "M2,1 L3,1", "M9,9 L8,8"].iter().for_each(|d| joiner.add(&path(d)));
        let lines = joiner.finish();
        assert_eq!(lines, [path("M0,0 L1,0 L2,1 L3,1"), path("M9,9 L8,8")]);
    }

    #[test]
    fn gaps_are_bridged_on_request() {
        let mut joiner = Joiner::new(Join::All, 1e-6);
        ["M0,0 L1,0", "M3,0 L2,0"].iter().for_each(|d| joiner.add(&path(d)));
        assert_eq!(joiner.finish(), [path("M0,0 L1,0 L2,0 L3,0")]);
    }
}
