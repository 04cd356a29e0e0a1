//! Display lists ready to be expanded, and how much they would draw (checklist,
//!

use kurbo::{Affine, BezPath, Point, Rect, Shape};
use rinceau_format::{Error, Form, FormItem, Live, Style, When};
use std::collections::BTreeSet;

/// An entry of a display list.
#[derive(Clone, Copy, Debug)]
pub(super) enum Entry {
    /// A primitive, by its index.
    Draw(usize),
    /// Another list, or the same one, and from its place to where it goes.
    Clone(usize, Affine),
}

/// A drawn part of a motif.
#[derive(Clone, Debug)]
pub(super) struct Primitive {
    /// Its id, or that of its form.
    pub of: String,
    pub path: BezPath,
    /// The same the other way round.
    pub reversed: BezPath,
    /// From the path's coordinates to user units of the root.
    pub base: Affine,
    pub style: Style,
    /// What its copies are drawn with depends on nothing but the colours: no stroke, no gradient.
    pub is_plain: bool,
    pub when: When,
    pub live: Option<Live>,
    /// Points that bound it, in user units of the root.
    pub hull: Vec<Point>,
}

/// The display list of a form.
#[derive(Clone, Debug)]
pub(super) struct List {
    pub name: String,
    pub entries: Vec<Entry>,
    /// Diagonal of what it draws itself, or of all forms if it draws nothing.
    pub size: f64,
}

/// All forms of a scene.
#[derive(Clone, Debug)]
pub(super) struct Lists {
    pub lists: Vec<List>,
    pub primitives: Vec<Primitive>,
}

/// How a form is expanded.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    pub depth: usize,
    /// Only the last generation.
    pub last: bool,
}

impl Lists {
    pub fn new(forms: &[Form]) -> Self {
        let mut primitives: Vec<Primitive> = Vec::new();
        let mut lists = Vec::with_capacity(forms.len());
        for form in forms {
            let first = primitives.len();
            let entry = |item: &FormItem| match item {
                FormItem::Clone(clone) => Entry::Clone(clone.form, clone.transform),
                FormItem::Primitive(drawn) => {
                    let of = drawn.live.as_ref().map_or(&form.source.id, |live| &live.id).clone();
                    let (path, base) = (drawn.part.path.clone(), drawn.part.transform);
                    let hull = hull(&path, base);
                    let (style, when, live) = (drawn.part.style.clone(), drawn.when, drawn.live.clone());
                    let reversed = path.reverse_subpaths();
                    let is_plain = style.stroke_width().is_none() && !style.has_paint_server();
                    primitives.push(Primitive {
                        of,
                        path,
                        reversed,
                        base,
                        style,
                        is_plain,
                        when,
                        live,
                        hull,
                    });
                    Entry::Draw(primitives.len() - 1)
                }
            };
            let entries = form.items.iter().map(entry).collect();
            let size = diagonal(&primitives[first..]);
            lists.push(List { name: form.source.id.clone(), entries, size });
        }
        let all = diagonal(&primitives);
        lists.iter_mut().filter(|list| list.size == 0.0).for_each(|list| list.size = all);
        Lists { lists, primitives }
    }

    /// What the primitives of a form are drawn with that their copies as paths lack: of which object,
    /// and what.
    pub fn lost_effects(&self, root: usize) -> BTreeSet<(&str, &'static str)> {
        let drawn = self.entries(root).filter_map(|entry| match *entry {
            Entry::Draw(primitive) => Some(&self.primitives[primitive]),
            Entry::Clone(..) => None,
        });
        drawn
            .flat_map(|drawn| drawn.style.effects().iter().map(|&effect| (drawn.of.as_str(), effect)))
            .collect()
    }

    /// The lists without images, which have no outline that could be drawn.
    pub fn without_pictures(&self) -> Self {
        let mut lists = self.clone();
        for list in &mut lists.lists {
            list.entries.retain(|entry| match *entry {
                Entry::Draw(primitive) => !self.primitives[primitive].style.is_picture(),
                Entry::Clone(..) => true,
            });
        }
        lists
    }

    /// The list of a form, now the first, and those that it repeats.
    pub fn of(&self, root: usize) -> Self {
        let reached = self.reached(root);
        let mut place = vec![None; self.lists.len()];
        reached.iter().enumerate().for_each(|(new, &old)| place[old] = Some(new));
        let mut primitives = Vec::new();
        let mut lists = Vec::with_capacity(reached.len());
        for &old in &reached {
            let mut list = self.lists[old].clone();
            for entry in &mut list.entries {
                *entry = match *entry {
                    Entry::Draw(primitive) => {
                        primitives.push(self.primitives[primitive].clone());
                        Entry::Draw(primitives.len() - 1)
                    }
                    Entry::Clone(other, by) => Entry::Clone(place[other].unwrap_or(0), by),
                };
            }
            lists.push(list);
        }
        Lists { lists, primitives }
    }

    /// True if a primitive is drawn where `is_last` tells whether it is the last generation.
    pub fn is_drawn(&self, primitive: usize, reach: Reach, is_last: bool) -> bool {
        match self.primitives[primitive].when {
            When::AsForm => !reach.last || is_last,
            When::Last => is_last,
            When::Inner => !is_last,
        }
    }

    /// Shapes drawn and lists entered for a form, without drawing any. Stops once more than `most`
    /// is certain.
    pub fn count(&self, root: usize, reach: Reach, most: f64) -> (f64, f64) {
        self.counted(root, reach, most).0
    }

    /// The most generations, `reach.depth` at most, whose counts stay within `most`.
    pub fn deepest(&self, root: usize, reach: Reach, most: f64) -> usize {
        self.counted(root, reach, most).1
    }

    /// Each generation's numbers follow from those of the one before. Returns those of the last
    /// that was looked at, and the deepest within `most`.
    fn counted(&self, root: usize, reach: Reach, most: f64) -> ((f64, f64), usize) {
        let n = self.lists.len();
        let (mut drawn, mut entered) = (vec![0.0_f64; n], vec![0.0_f64; n]);
        let (mut next_drawn, mut next_entered) = (drawn.clone(), entered.clone());
        for generation in 1..=reach.depth {
            let mut is_settled = generation > 1;
            for (i, list) in self.lists.iter().enumerate() {
                let (mut shapes, mut lists) = (0.0, 1.0);
                for entry in &list.entries {
                    match *entry {
                        Entry::Draw(primitive) => {
                            shapes += f64::from(u8::from(self.is_drawn(primitive, reach, generation == 1)));
                        }
                        Entry::Clone(other, _) if generation > 1 => {
                            shapes += drawn[other];
                            lists += entered[other];
                        }
                        Entry::Clone(..) => {}
                    }
                }
                is_settled &= shapes == drawn[i] && lists == entered[i];
                (next_drawn[i], next_entered[i]) = (shapes, lists);
            }
            std::mem::swap(&mut drawn, &mut next_drawn);
            std::mem::swap(&mut entered, &mut next_entered);
            if drawn[root].max(entered[root]) > most {
                return ((drawn[root], entered[root]), generation - 1);
            }
            // Without clones that go on, no generation changes anything.
            if is_settled {
                break;
            }
        }
        ((drawn[root], entered[root]), reach.depth)
    }

    /// A list and those that it repeats, each once; the list first.
    pub fn reached(&self, root: usize) -> Vec<usize> {
        let mut reached = vec![root];
        let mut is_reached = vec![false; self.lists.len()];
        is_reached[root] = true;
        let mut next = 0;
        while let Some(&list) = reached.get(next) {
            next += 1;
            for entry in &self.lists[list].entries {
                if let Entry::Clone(other, _) = *entry
                    && !std::mem::replace(&mut is_reached[other], true)
                {
                    reached.push(other);
                }
            }
        }
        reached
    }

    fn entries(&self, root: usize) -> impl Iterator<Item = &Entry> {
        self.reached(root).into_iter().flat_map(|list| &self.lists[list].entries)
    }

    /// True if some clone is larger than its source.
    pub fn grows(&self, root: usize) -> bool {
        const LARGER: f64 = 1.000_001;
        self.entries(root).any(|entry| match *entry {
            Entry::Clone(_, by) => {
                // The largest singular value, squared.
                let (all, det) = (by.as_coeffs()[..4].iter().map(|c| c * c).sum::<f64>(), by.determinant());
                let most = 0.5 * (all + (all * all - 4.0 * det * det).max(0.0).sqrt());
                most > LARGER * LARGER
            }
            Entry::Draw(_) => false,
        })
    }

    /// Errors on a form that draws nothing, however deep.
    pub fn check(&self, root: usize, form: &Form) -> Result<(), Error> {
        if self.entries(root).any(|entry| matches!(entry, Entry::Draw(_))) {
            return Ok(());
        }
        Err(form.source.error(
            "empty-form",
            format!("The form '{}' has nothing drawn in it", form.source.id),
            "Draw the motif into its group, then clone it (Edit > Clone > Create Clone)",
        ))
    }
}

/// Points that bound a shape: all of them, or the corners of its box if there are many.
fn hull(path: &BezPath, base: Affine) -> Vec<Point> {
    const MANY: usize = 12;
    let drawn = base * path.clone();
    if path.elements().len() <= MANY {
        return drawn
            .elements()
            .iter()
            .filter_map(kurbo::PathEl::end_point)
            .chain(curve_box(&drawn))
            .collect();
    }
    corners(drawn.bounding_box()).to_vec()
}

/// Corners of the box of what bulges beyond its nodes.
fn curve_box(path: &BezPath) -> Vec<Point> {
    let is_curved = |el: &kurbo::PathEl| matches!(el, kurbo::PathEl::CurveTo(..) | kurbo::PathEl::QuadTo(..));
    if path.elements().iter().any(is_curved) { corners(path.bounding_box()).to_vec() } else { Vec::new() }
}

fn corners(rect: Rect) -> [Point; 4] {
    [(rect.x0, rect.y0), (rect.x1, rect.y0), (rect.x1, rect.y1), (rect.x0, rect.y1)].map(Point::from)
}

fn diagonal(primitives: &[Primitive]) -> f64 {
    let mut points = primitives.iter().flat_map(|primitive| &primitive.hull);
    let Some(&first) = points.next() else { return 0.0 };
    let rect = points.fold(Rect::from_points(first, first), |rect, &p| rect.union_pt(p));
    rect.size().to_vec2().hypot()
}
