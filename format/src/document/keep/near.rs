//! Which new piece stands where an old one stood.

use crate::write::record::Entry;
use kurbo::{Point, Rect, Vec2};
use std::collections::HashMap;

/// From where pieces stood to where they would stand now.
#[derive(Clone, Copy)]
pub(super) struct Map {
    from: Rect,
    to: Rect,
}

impl Map {
    /// As it is, or with the box of all pieces: whichever brings more of the old onto new ones.
    pub fn of(old: &[(usize, Entry)], new: &[(usize, Entry)]) -> Self {
        let boxed = |all: &[(usize, Entry)]| {
            let first = all.first().map_or(Point::ZERO, |first| first.1.at);
            all.iter().fold(Rect::from_points(first, first), |all, one| all.union_pt(one.1.at))
        };
        let (from, to) = (boxed(old), boxed(new));
        let stays = Map { from, to: from };
        let follows = Map { from, to };
        let near = Near::of(new);
        let hits = |map: Map| {
            old.iter().filter(|(group, one)| near.nearest(*group, &map.moved(one)).is_some()).count()
        };
        if hits(follows) > hits(stays) { follows } else { stays }
    }

    /// An entry where it would be now.
    pub fn moved(&self, one: &Entry) -> Entry {
        let along = |v: f64, (a0, a1): (f64, f64), (b0, b1): (f64, f64)| {
            let share = if a1 > a0 { (v - a0) / (a1 - a0) } else { 0.5 };
            b0 + share * (b1 - b0)
        };
        if self.from == self.to {
            return *one;
        }
        let at = Point::new(
            along(one.at.x, (self.from.x0, self.from.x1), (self.to.x0, self.to.x1)),
            along(one.at.y, (self.from.y0, self.from.y1), (self.to.y0, self.to.y1)),
        );
        Entry { at, ..*one }
    }
}

/// New pieces in cells.
pub(super) struct Near<'e> {
    entries: &'e [(usize, Entry)],
    cell: f64,
    cells: HashMap<(usize, i64, i64), Vec<usize>>,
}

impl<'e> Near<'e> {
    pub fn of(entries: &'e [(usize, Entry)]) -> Self {
        let reach: f64 = entries.iter().map(|one| one.1.reach).sum();
        let cell = (reach / entries.len().max(1) as f64).max(1e-9);
        let mut near = Near { entries, cell, cells: HashMap::new() };
        for (i, (group, one)) in entries.iter().enumerate() {
            let (x, y) = near.cell(one.at);
            near.cells.entry((*group, x, y)).or_default().push(i);
        }
        near
    }

    fn cell(&self, at: Point) -> (i64, i64) {
        ((at.x / self.cell).floor() as i64, (at.y / self.cell).floor() as i64)
    }

    /// Those of a sublayer that stand where a piece stood, nearest last not sorted: index and distance.
    pub fn at(&self, group: usize, old: &Entry) -> impl Iterator<Item = (usize, f64)> + '_ {
        let old = *old;
        let reach = 0.5 * old.reach;
        // A large piece among many small ones would look through all their cells.
        const MOST_CELLS: i64 = 40;
        let (low, high) =
            (self.cell(old.at - Vec2::new(reach, reach)), self.cell(old.at + Vec2::new(reach, reach)));
        let high =
            (high.0.min(low.0.saturating_add(MOST_CELLS)), high.1.min(low.1.saturating_add(MOST_CELLS)));
        let cells = (low.0..=high.0).flat_map(move |x| (low.1..=high.1).map(move |y| (group, x, y)));
        cells.filter_map(|cell| self.cells.get(&cell)).flatten().filter_map(move |&i| {
            let one = &self.entries[i].1;
            let distance = one.at.distance(old.at);
            let is_like = one.reach <= 2.0 * old.reach && old.reach <= 2.0 * one.reach;
            // Pieces without size stand exactly there.
            (is_like && distance <= 0.5 * one.reach.min(old.reach) + 1e-9).then_some((i, distance))
        })
    }

    fn nearest(&self, group: usize, old: &Entry) -> Option<usize> {
        self.at(group, old).min_by(|a, b| a.1.total_cmp(&b.1)).map(|found| found.0)
    }
}
