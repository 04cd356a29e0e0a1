//! The generation algorithm (003 Figure 2, checklist R-009): a walk over display lists with a
//! stack of its own, so that depth costs memory only where there is something left to draw.

use super::colour::Ramp;
use super::lists::{Entry, Lists, Reach};
use kurbo::{Affine, BezPath, PathEl, Point};
use rinceau_format::{FillRule, Pieces, Stream, Style};
use std::collections::HashMap;
use std::sync::Arc;

/// A form and all that says how it is drawn.
#[derive(Clone, Debug)]
pub(super) struct Expansion {
    pub lists: Arc<Lists>,
    pub root: usize,
    pub reach: Reach,
    /// From where the form is drawn to where the result goes.
    pub place: Affine,
    /// Copies smaller than this, in units of the result, do not go on.
    pub min_size: f64,
    /// Copies larger than this are left out, and what would follow from them.
    pub max_size: f64,
    pub ramp: Option<Ramp>,
    /// Strokes stay as thick as drawn.
    pub fixed_strokes: bool,
    pub merge: bool,
    pub decimals: usize,
}

/// A primitive that is to be drawn.
#[derive(Clone, Copy, Debug)]
pub(super) struct Drawn {
    pub primitive: usize,
    /// From where it is drawn in the motif to its place.
    pub pose: Affine,
    /// 1 for the motif.
    pub generation: usize,
}

/// What a walk meets.
#[derive(Clone, Copy, Debug)]
pub(super) enum Step {
    /// A list is entered.
    Enter,
    Draw(Drawn),
    /// A copy too large for any page is passed over.
    TooLarge,
}

/// How much of a list is done.
struct Frame {
    list: usize,
    next: usize,
    pose: Affine,
    generation: usize,
    is_last: bool,
}

/// How much a transform enlarges at most, squared.
fn scale2(pose: Affine) -> f64 {
    let [a, b, c, d, ..] = pose.as_coeffs();
    (a * a + b * b).max(c * c + d * d)
}

impl Expansion {
    /// Walks through the form in paint order until `visit` says false. True if it never did.
    pub fn walk(&self, mut visit: impl FnMut(Step) -> bool) -> bool {
        let lists = &self.lists.lists;
        let (min2, max2) = (self.min_size * self.min_size, self.max_size * self.max_size);
        let frame = |list: usize, pose: Affine, generation: usize| {
            let size2 = lists[list].size * lists[list].size * scale2(pose);
            let is_last = generation >= self.reach.depth || size2 < min2;
            (size2 <= max2).then_some(Frame { list, next: 0, pose, generation, is_last })
        };
        if !visit(Step::Enter) {
            return false;
        }
        let mut stack: Vec<Frame> = frame(self.root, self.place, 1).into_iter().collect();
        while let Some(top) = stack.last_mut() {
            let &mut Frame { list, pose, generation, is_last, next } = top;
            let entries = &lists[list].entries;
            let Some(&entry) = entries.get(next) else {
                stack.pop();
                continue;
            };
            top.next += 1;
            let goes_on = match entry {
                Entry::Draw(primitive) => {
                    !self.lists.is_drawn(primitive, self.reach, is_last)
                        || visit(Step::Draw(Drawn { primitive, pose, generation }))
                }
                Entry::Clone(..) if is_last => true,
                Entry::Clone(other, by) => {
                    // Nothing is left of a list after its last entry.
                    if next + 1 == entries.len() {
                        stack.pop();
                    }
                    match frame(other, pose * by, generation + 1) {
                        Some(frame) => {
                            stack.push(frame);
                            visit(Step::Enter)
                        }
                        None => visit(Step::TooLarge),
                    }
                }
            };
            if !goes_on {
                return false;
            }
        }
        true
    }

    /// What a drawn primitive looks like: its path where `transform` still has to be applied, or
    /// where it is the identity the path in its place.
    pub fn look(&self, drawn: &Drawn, looks: &mut Looks) -> Look {
        let primitive = &self.lists.primitives[drawn.primitive];
        let full = drawn.pose * primitive.base;
        if primitive.is_plain {
            return Look { style: looks.style(self, drawn, 1.0), width: 1.0, transform: full, is_flat: true };
        }
        let [a, b, c, d, ..] = full.as_coeffs();
        let size = full.determinant().abs().sqrt();
        let is_similar =
            (a * a + b * b - c * c - d * d).abs() + 2.0 * (a * c + b * d).abs() <= 1e-6 * size * size;
        let has_stroke = primitive.style.stroke_width().is_some();
        // A gradient goes along with the coordinates that it is defined in.
        let is_flat =
            !primitive.style.has_paint_server() && (!has_stroke || is_similar || self.fixed_strokes);
        let width = match (has_stroke, self.fixed_strokes) {
            (false, _) => 1.0,
            (true, true) if is_flat => primitive.base.determinant().abs().sqrt(),
            (true, true) => (primitive.base.determinant() / full.determinant()).abs().sqrt(),
            (true, false) if !is_flat => 1.0,
            (true, false) if is_similar => size,
            // What the transform does to the stroke no width can say.
            (true, false) => 1.0,
        };
        let style = looks.style(self, drawn, width);
        Look { style, width, transform: full, is_flat }
    }
}

/// How a primitive is drawn in some place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Look {
    /// Index among the styles.
    pub style: usize,
    /// What its widths are multiplied by.
    pub width: f64,
    /// From the path's own coordinates to the result.
    pub transform: Affine,
    /// True if the transform is to be applied to the points.
    pub is_flat: bool,
}

/// Styles that have occurred, as CSS.
#[derive(Default)]
pub(super) struct Looks {
    styles: Vec<(Arc<str>, bool)>,
    /// Of each primitive, generation and width.
    known: HashMap<(usize, usize, u64), usize>,
    last: Option<((usize, usize, u64), usize)>,
    by_text: HashMap<Arc<str>, usize>,
}

impl Looks {
    /// A style's CSS, and whether equal neighbours may become one path.
    pub fn get(&self, style: usize) -> (&Arc<str>, bool) {
        (&self.styles[style].0, self.styles[style].1)
    }

    fn style(&mut self, expansion: &Expansion, drawn: &Drawn, width: f64) -> usize {
        // Rounded as it will be written, so that equal copies are equal.
        let step = 1e6;
        let rounded = (width * step).round().clamp(0.0, 1e15) as u64;
        let generation = if expansion.ramp.is_some() { drawn.generation } else { 0 };
        let key = (drawn.primitive, generation, rounded);
        if let Some((last, style)) = self.last
            && last == key
        {
            return style;
        }
        const MOST: usize = 100_000;
        if self.known.len() > MOST {
            self.known.clear();
        }
        let style = match self.known.get(&key) {
            Some(&style) => style,
            None => {
                let style = expansion.style(drawn, rounded as f64 / step);
                let merges = can_merge(&style, &expansion.lists.primitives[drawn.primitive].path);
                let text: Arc<str> = style.css().into();
                let index = match self.by_text.get(&text) {
                    Some(&index) if self.styles[index].1 == merges => index,
                    _ => {
                        self.styles.push((Arc::clone(&text), merges));
                        self.by_text.insert(text, self.styles.len() - 1);
                        self.styles.len() - 1
                    }
                };
                self.known.insert(key, index);
                index
            }
        };
        self.last = Some((key, style));
        style
    }
}

impl Expansion {
    /// The style of a look.
    pub fn own_style(&self, drawn: &Drawn, look: &Look) -> Style {
        self.style(drawn, look.width)
    }

    fn style(&self, drawn: &Drawn, width: f64) -> Style {
        let primitive = &self.lists.primitives[drawn.primitive];
        let mut style = primitive.style.scaled(width, self.decimals.max(3));
        if let Some(ramp) = &self.ramp {
            ramp.paint(&mut style, drawn.generation, self.reach.depth);
        }
        style
    }
}

/// True if shapes of this paint look the same one after the other and as one path: opaque, and
/// either lines alone, or a fill alone of one contour that does not cross itself.
fn can_merge(style: &Style, path: &BezPath) -> bool {
    let is_opaque = |name: &str| style.get(name).is_none_or(|value| value.trim().parse() == Ok(1.0));
    let subpaths = path.elements().iter().filter(|el| matches!(el, PathEl::MoveTo(_))).count();
    let has_stroke = style.stroke_width().is_some();
    let shape = match (style.is_filled(), has_stroke) {
        (true, true) => false,
        (true, false) => subpaths == 1 && style.fill_rule() == FillRule::NonZero && is_simple(path),
        (false, _) => true,
    };
    // The opacity of the whole is in the text alone.
    let whole = style.css().split(';').all(|property| !property.starts_with("opacity:"));
    shape
        && whole
        && ["fill-opacity", "stroke-opacity"].into_iter().all(is_opaque)
        && !style.has_paint_server()
        && !style.has_markers()
}

/// True if a contour surely does not cross itself: it turns to one side only, once around.
fn is_simple(path: &BezPath) -> bool {
    let points: Vec<Point> = path
        .elements()
        .iter()
        .flat_map(|el| match *el {
            PathEl::MoveTo(p) | PathEl::LineTo(p) => vec![p],
            PathEl::QuadTo(a, p) => vec![a, p],
            PathEl::CurveTo(a, b, p) => vec![a, b, p],
            PathEl::ClosePath => Vec::new(),
        })
        .collect();
    let n = points.len();
    let mut turned = 0.0;
    let mut side = 0.0_f64;
    for i in 0..n {
        let (u, v) = (points[(i + 1) % n] - points[i], points[(i + 2) % n] - points[(i + 1) % n]);
        let turn = libm::atan2(u.cross(v), u.dot(v));
        if turn * side < -1e-9 {
            return false;
        }
        if turn.abs() > 1e-9 {
            side = turn.signum();
        }
        turned += turn;
    }
    turned.abs() < 1.5 * std::f64::consts::TAU
}

/// Copies that become one path at most.
const MERGED: usize = 200;

impl Stream for Expansion {
    fn each(&self, pieces: &mut dyn Pieces) {
        let mut looks = Looks::default();
        // Style of the piece that others may join, and how many there are in it.
        let mut open: Option<(usize, usize)> = None;
        self.walk(|step| {
            let Step::Draw(drawn) = step else { return true };
            let primitive = &self.lists.primitives[drawn.primitive];
            let look = self.look(&drawn, &mut looks);
            let merges = self.merge && look.is_flat && looks.get(look.style).1;
            match &mut open {
                Some((style, count)) if merges && *style == look.style && *count < MERGED => *count += 1,
                _ => {
                    let transform = if look.is_flat { Affine::IDENTITY } else { look.transform };
                    pieces.begin(&primitive.of, transform, looks.get(look.style).0);
                    open = merges.then_some((look.style, 1));
                }
            }
            let pose = if look.is_flat { look.transform } else { Affine::IDENTITY };
            // Mirrored copies wind the other way, and would cut holes into those below.
            let is_turned = merges && look.transform.determinant() < 0.0;
            pieces.add(if is_turned { &primitive.reversed } else { &primitive.path }, pose);
            true
        });
    }
}
