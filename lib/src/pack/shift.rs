//! The shifted streamline of the paper: a shortest path in a graph along the old one (FLOWPAK 4.6, Figures 7
//! and 8, checklist F-055 to F-060).
//!
//! Not the default: `refine` moves the whole line at once, which measures better (see CONTRIBUTING) and takes
//! a thousandth of the steps. It is here for comparison.
//!
//! Nodes are samples of the line every quarter of `g_limit`, and copies of them that far apart on both sides
//! as far as the room reaches. From each of them edges lead to its 150 nearest neighbours, ahead only: what
//! the paper asks of the angle to the edge before comes to the same, since a path that never turns back along
//! the line never turns by more than a right angle on it. An edge costs `w_f (1 - f³) + w_d D`, where f is the
//! share of its direction along the field (erratum Q-9: of a unit vector) and D the distance of its start from
//! the old line; both are weighted with its length, or many short edges would cost more than one long one.

use crate::field::DirectionField;
use crate::geom::polyline::{self, left_of};
use kurbo::Point;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

const W_FIELD: f64 = 1.0;
const W_DISTANCE: f64 = 0.1;
/// Half of the 150 nearest nodes of a square lattice lie ahead, within this many steps.
const REACH: i64 = 7;
/// Nodes of one graph at most: lines that need more get wider steps.
const MOST_NODES: f64 = 40_000.0;

/// The path from the left-hand offset `ends[0]` at the start of a line to `ends[1]` at its end. `widths` are
/// how far the room reaches to the left and to the right.
pub(super) fn path(
    line: &[Point],
    ends: [f64; 2],
    widths: [f64; 2],
    limit: f64,
    flow: Option<&DirectionField>,
) -> Vec<Point> {
    let length = polyline::length(line);
    let step = (0.25 * limit).max((length * (widths[0] + widths[1]) / MOST_NODES).sqrt());
    let stations = (length / step).ceil().max(2.0) as i64;
    let (left, right) = ((widths[0] / step).ceil() as i64, (widths[1] / step).ceil() as i64);
    let points = polyline::resample(line, stations as usize);
    let tangents = polyline::tangents(&points, false);
    let rows = left + right + 1;
    let at = |station: i64, row: i64| {
        points[station as usize] + (row - right) as f64 * step * left_of(tangents[station as usize])
    };
    let row_of = |offset: f64| ((offset / step).round() as i64 + right).clamp(0, rows - 1);
    let (start, goal) = (row_of(ends[0]), stations * rows + row_of(ends[1]));

    let count = ((stations + 1) * rows) as usize;
    let (mut cost, mut before) = (vec![f64::INFINITY; count], vec![usize::MAX; count]);
    let mut heap = BinaryHeap::from([Reverse((0u64, start))]);
    cost[start as usize] = 0.0;
    while let Some(Reverse((bits, node))) = heap.pop() {
        if node == goal {
            break;
        }
        // Non-negative floats order as their bits do.
        if f64::from_bits(bits) > cost[node as usize] {
            continue;
        }
        let (station, row) = (node / rows, node % rows);
        let from = at(station, row);
        let direction = flow.and_then(|flow| flow.direction(from, tangents[station as usize]));
        let direction = direction.unwrap_or(tangents[station as usize]);
        let off = (row - right).abs() as f64 * step / limit;
        for ahead in 1..=REACH.min(stations - station) {
            for aside in -REACH..=REACH {
                let to = row + aside;
                if to < 0 || to >= rows || ahead * ahead + aside * aside > REACH * REACH {
                    continue;
                }
                let edge = at(station + ahead, to) - from;
                let long = edge.hypot().max(f64::MIN_POSITIVE);
                let f = edge.dot(direction) / long;
                let next =
                    cost[node as usize] + long / step * (W_FIELD * (1.0 - f * f * f) + W_DISTANCE * off);
                let index = ((station + ahead) * rows + to) as usize;
                if next < cost[index] {
                    (cost[index], before[index]) = (next, node as usize);
                    heap.push(Reverse((next.to_bits(), index as i64)));
                }
            }
        }
    }
    let mut path = Vec::new();
    let mut node = goal as usize;
    while node != usize::MAX {
        path.push(at(node as i64 / rows, node as i64 % rows));
        node = before[node];
    }
    path.reverse();
    path
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::region::Region;

    #[test]
    fn the_path_follows_the_field_between_its_ends() {
        let square = [(0.0, -50.0), (100.0, -50.0), (100.0, 50.0), (0.0, 50.0)].map(Point::from).to_vec();
        let region = Region::new(vec![square]).unwrap();
        let guide = vec![Point::new(0.0, 0.0), Point::new(100.0, 0.0)];
        let flow = DirectionField::new(&region, &[guide], 2.0).unwrap();
        let line = [Point::new(10.0, 0.0), Point::new(90.0, 0.0)];
        let path = path(&line, [2.0, -2.0], [6.0, 6.0], 2.0, Some(&flow));
        assert!(path[0].distance(Point::new(10.0, 2.0)) < 0.3, "{:?}", path[0]);
        let last = path[path.len() - 1];
        assert!(last.distance(Point::new(90.0, -2.0)) < 0.3, "{last:?}");
        assert!(path.windows(2).all(|pair| pair[1].x > pair[0].x), "it never turns back");
        // Most of the way along the field: the line is crossed once.
        let slope = |pair: &[Point]| ((pair[1].y - pair[0].y) / (pair[1].x - pair[0].x)).abs();
        assert!(path.windows(2).all(|pair| slope(pair) <= 1.0));
    }
}
