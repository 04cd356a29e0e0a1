//! A form as a chain of clones: for every form and every number of generations left a symbol
//! that draws the motif and clones the symbols of one generation less. Its size grows with forms
//! times depth, and it stays alive: the motif it draws is the drawing's own.

use super::colour::Ramp;
use super::lists::{Entry, Lists, Primitive, Reach};
use kurbo::Affine;
use rinceau_format::{Part, Symbol, SymbolItem};
use std::collections::HashMap;

/// The symbols that a form needs, those of fewer generations first, and the index of the one
/// that draws it all.
pub(super) fn chain(lists: &Lists, root: usize, reach: Reach, ramp: Option<&Ramp>) -> (Vec<Symbol>, usize) {
    // Which forms occur with how many generations left, from the whole downwards.
    let mut needed: Vec<Vec<bool>> = vec![vec![false; lists.lists.len()]; reach.depth + 1];
    needed[reach.depth][root] = true;
    for left in (2..=reach.depth).rev() {
        for list in 0..lists.lists.len() {
            if !needed[left][list] {
                continue;
            }
            for entry in &lists.lists[list].entries {
                if let Entry::Clone(other, _) = entry {
                    needed[left - 1][*other] = true;
                }
            }
        }
    }
    let mut symbols = Vec::new();
    let mut index: HashMap<(usize, usize), usize> = HashMap::new();
    for (left, needed) in needed.iter().enumerate().skip(1) {
        for list in (0..lists.lists.len()).filter(|&list| needed[list]) {
            let mut items = Vec::new();
            let mut last_object = None;
            for entry in &lists.lists[list].entries {
                match *entry {
                    Entry::Draw(i) if lists.is_drawn(i, reach, left == 1) => {
                        let primitive = &lists.primitives[i];
                        let generation = reach.depth - left + 1;
                        let item = drawn(primitive, ramp, generation, reach.depth);
                        // An object of several shapes, such as a text, is cloned once.
                        let object = match &item {
                            SymbolItem::Object(id, ..) => Some(id.clone()),
                            _ => None,
                        };
                        if object.is_none() || object != last_object {
                            items.push(item);
                        }
                        last_object = object;
                    }
                    Entry::Draw(_) => {}
                    Entry::Clone(other, by) => {
                        if let Some(&symbol) = index.get(&(other, left - 1)) {
                            items.push(SymbolItem::Symbol(symbol, by));
                        }
                        last_object = None;
                    }
                }
            }
            index.insert((list, left), symbols.len());
            symbols.push(Symbol { name: format!("{}-{left}", lists.lists[list].name), items });
        }
    }
    let root = index[&(root, reach.depth)];
    (symbols, root)
}

/// A primitive: a clone of what is drawn, or a copy where it has no id or gets a colour.
fn drawn(primitive: &Primitive, ramp: Option<&Ramp>, generation: usize, depth: usize) -> SymbolItem {
    match (&primitive.live, ramp) {
        (Some(live), None) => SymbolItem::Object(live.id.clone(), live.frame, live.inherited.clone()),
        _ => {
            let mut style = primitive.style.clone();
            if let Some(ramp) = ramp {
                ramp.paint(&mut style, generation, depth);
            }
            SymbolItem::Part(Part { path: primitive.path.clone(), transform: primitive.base, style })
        }
    }
}

/// From a form's place to that of a container: as large as fits with a margin, in its middle.
pub(super) fn fitted(bounds: kurbo::Rect, into: kurbo::Rect) -> Option<Affine> {
    const MARGIN: f64 = 0.04;
    let side = into.size().min_side();
    let into = into.inset(-MARGIN * side);
    let scale = (into.width() / bounds.width()).min(into.height() / bounds.height());
    let is_sane = scale.is_finite() && scale > 0.0;
    is_sane.then(|| {
        Affine::translate(into.center().to_vec2())
            * Affine::scale(scale)
            * Affine::translate(-bounds.center().to_vec2())
    })
}
