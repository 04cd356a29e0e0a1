//! Which new piece takes the place of an old one that was changed, and what number each has.

use super::near::{Map, Near};
use super::{Change, Content, Edit};
use crate::vocabulary::NAMESPACE;
use crate::write::record::Entry;
use roxmltree::Node;
use std::collections::{HashMap, HashSet};

/// What becomes of each new piece.
pub(super) struct Plan {
    /// All new pieces: sublayer, number, and how they are made.
    pub pieces: Vec<(usize, usize, Entry)>,
    /// The edit that applies to each.
    pub edit_of: Vec<Option<usize>>,
    /// The new piece to which an edit applies.
    pub piece_of: Vec<Option<usize>>,
    /// Numbers in the result.
    pub numbers: Vec<usize>,
    /// From the old places to the new ones.
    pub map: Map,
}

impl Plan {
    pub fn new(old: &Content, edits: &[Edit], new: &Content) -> Self {
        let index = |group: usize| new.groups.iter().position(|made| made.name == old.groups[group].name);
        let indices: Vec<Option<usize>> = (0..old.groups.len()).map(index).collect();
        let pieces: Vec<(usize, usize, Entry)> = new.made().collect();
        let entries: Vec<(usize, Entry)> = pieces.iter().map(|&(group, _, entry)| (group, entry)).collect();
        let before: Vec<(usize, Entry)> =
            old.made().filter_map(|(group, _, entry)| Some((indices[group]?, entry))).collect();
        let map = Map::of(&before, &entries);
        let near = Near::of(&entries);
        let of = |node: Node| node.attribute((NAMESPACE, "of")).map(str::to_owned);
        // The piece itself comes first. Another kind of piece would have to stand three times as near.
        let apart = |edit: &Edit, piece: usize, distance: f64| {
            let (group, number, entry) = pieces[piece];
            if entry.shape == edit.made.shape {
                return 0.0;
            }
            let is_other = edit.node.is_some_and(|node| {
                new.pieces.get(&(group, number)).is_some_and(|found| of(found.0) != of(node))
            });
            let distance = distance + 0.5 * (entry.reach - edit.made.reach).abs();
            if is_other { 3.0 * distance } else { distance }
        };
        let mut offers: Vec<(f64, bool, usize, usize)> = Vec::new();
        for (e, edit) in edits.iter().enumerate() {
            let Some(group) = indices[edit.group] else { continue };
            let found = near.at(group, &map.moved(&edit.made));
            offers.extend(found.map(|(piece, distance)| {
                (apart(edit, piece, distance), pieces[piece].1 != edit.number, e, piece)
            }));
        }
        offers.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2, a.3).cmp(&(b.1, b.2, b.3))));
        let mut plan = Plan {
            edit_of: vec![None; pieces.len()],
            piece_of: vec![None; edits.len()],
            numbers: pieces.iter().map(|piece| piece.1).collect(),
            pieces,
            map,
        };
        for (_, _, e, piece) in offers {
            if plan.edit_of[piece].is_none() && plan.piece_of[e].is_none() {
                plan.give(e, piece);
            }
        }
        // A colour is not lost because nothing stands there now: it goes to the nearest.
        for (e, edit) in edits.iter().enumerate() {
            let (Some(group), Change::Painted, None) = (indices[edit.group], edit.change, plan.piece_of[e])
            else {
                continue;
            };
            let at = map.moved(&edit.made).at;
            let free = (0..entries.len()).filter(|&i| entries[i].0 == group && plan.edit_of[i].is_none());
            let distance = |i: usize| plan.pieces[i].2.at.distance(at);
            let nearest = free.min_by(|&a, &b| distance(a).total_cmp(&distance(b)));
            if let Some(piece) = nearest {
                plan.give(e, piece);
            }
        }
        plan.number(edits, &indices);
        plan
    }

    fn give(&mut self, edit: usize, piece: usize) {
        self.edit_of[piece] = Some(edit);
        self.piece_of[edit] = Some(piece);
    }

    /// Pieces keep their numbers as far as edits leave them.
    fn number(&mut self, edits: &[Edit], indices: &[Option<usize>]) {
        let is_in_use = |e: usize| edits[e].change != Change::Painted || self.piece_of[e].is_some();
        let in_use = (0..edits.len()).filter(|&e| is_in_use(e));
        let mut taken: HashSet<(usize, usize)> =
            in_use.filter_map(|e| Some((indices[edits[e].group]?, edits[e].number))).collect();
        let mut homeless = Vec::new();
        for (i, &(group, number, _)) in self.pieces.iter().enumerate() {
            match self.edit_of[i].map(|e| &edits[e]) {
                Some(edit) => self.numbers[i] = edit.number,
                None if taken.insert((group, number)) => {}
                None => homeless.push(i),
            }
        }
        let mut next: HashMap<usize, usize> = HashMap::new();
        for i in homeless {
            let group = self.pieces[i].0;
            let number = next.entry(group).or_insert(1);
            while !taken.insert((group, *number)) {
                *number += 1;
            }
            self.numbers[i] = *number;
        }
    }
}
