//! Elements on their spines, and the proof that they keep apart (FLOWPAK 4.5, F-045).
//!
//! The room of 4.4 already keeps elements apart up to sampling. What is drawn is checked
//! exactly all the same, outline by outline: inside the region, the gap kept to every element
//! placed before, not crossing itself. What fails is made narrower, then shorter, and at last
//! left out; nothing that fails is drawn.

use super::blob::Spine;
use super::choose::{Pose, extent, fit};
use super::params::Sizes;
use super::prepare::{Field, Prepared};
use super::refine::Body;
use super::template::{BINS, Template};
use crate::field::LineKind;
use crate::geom::bend::Bend;
use crate::geom::boolean::{Contour, area, encloses, is_outer, simplified};
use crate::geom::crossing::{any_crossing, self_crossings};
use crate::geom::flatten::flatten;
use crate::geom::polyline;
use crate::geom::region::Region;
use crate::geom::segment::{SegmentGrid, crosses, segment_segment};
use kurbo::{Affine, BezPath, Point, Rect};
use rayon::prelude::*;
use rinceau_format::subpaths;

/// Widths, and shares of the length given up at both ends, tried one after the other until
/// the outline keeps its distances. What is in the way is mostly ahead of a tip.
const TRIES: [(f64, f64); 9] = [
    (1.0, 0.0),
    (1.0, 0.025),
    (0.97, 0.0),
    (0.94, 0.05),
    (0.88, 0.08),
    (0.8, 0.1),
    (0.7, 0.14),
    (0.58, 0.18),
    (0.46, 0.22),
];

/// An element in its place.
#[derive(Clone, Debug)]
pub(super) struct Placed {
    /// Index of its container's field.
    pub field: usize,
    pub kind: LineKind,
    pub template: usize,
    pub pose: Pose,
    pub bend: Bend,
    /// Mean scale, for stroke widths.
    pub scale: f64,
    pub centre: Point,
    pub area: f64,
    pub spine: Vec<Point>,
    /// Its outer subpaths, bent.
    pub outer: Vec<BezPath>,
    /// What keeps apart from neighbours: those as polygons.
    pub outlines: Vec<Contour>,
    /// Outer contours alone, without holes.
    pub silhouette: Vec<Contour>,
}

impl Placed {
    /// The template's paths, bent.
    pub fn paths(&self, template: &Template, sizes: &Sizes) -> Vec<BezPath> {
        let mut outer = self.outer.iter();
        let mut is_outer = template.is_outer.iter();
        let mut one = |path: &BezPath| {
            let mut whole = BezPath::new();
            for subpath in subpaths(path) {
                match is_outer.next() {
                    Some(true) => whole.extend(outer.next().into_iter().flatten()),
                    _ => whole
                        .extend(bent([&subpath], self.pose, &self.bend, FINER * sizes.tolerance()).remove(0)),
                }
            }
            whole
        };
        let paths = template.parts.iter().map(|(path, _)| one(path)).collect();
        unfolded(paths, template, self.pose, &self.bend, sizes)
    }
}

/// An element bent by one of the tries, before it is known whether it goes there.
struct Candidate {
    pose: Pose,
    bend: Bend,
    scale: f64,
    /// Half stroke width.
    stroke: f64,
    outer: Vec<BezPath>,
    outlines: Vec<Contour>,
    /// Outer contours alone; empty until it is known that the candidate goes.
    silhouette: Vec<Contour>,
}

/// Everything placed so far.
pub(super) struct Placement {
    outlines: SegmentGrid,
    /// Half stroke width of each placed element.
    strokes: Vec<f64>,
    /// The widest of them.
    widest: f64,
    pub placed: Vec<Placed>,
}

impl Placement {
    /// Nothing placed yet.
    pub fn new(prepared: &Prepared) -> Self {
        let spacing = prepared.fields.iter().map(|field| field.sizes.spacing).fold(f64::INFINITY, f64::min);
        Placement {
            outlines: SegmentGrid::new(prepared.bounds, spacing / 6.0),
            strokes: Vec::new(),
            widest: 0.0,
            placed: Vec::new(),
        }
    }

    /// Places the elements in order, each as wide as it goes; those that do not go at all are
    /// left out. False if the time ran out first; one is placed all the same.
    pub fn place(
        &mut self,
        bodies: &[Body],
        templates: &[Template],
        prepared: &Prepared,
        mut go_on: impl FnMut(f64) -> bool,
    ) -> bool {
        // Most of the work is done for the next few elements at once, on all cores: the first
        // try that keeps its distance from everything before them. What they do to each other
        // is settled in order.
        const AHEAD: usize = 64;
        // Neighbours follow each other in the list, so each round takes one in so many.
        let rounds = bodies.len().div_ceil(AHEAD);
        for round in 0..rounds {
            if !go_on(round as f64 / rounds as f64) && round > 0 {
                return false;
            }
            let ahead: Vec<&Body> = bodies.iter().skip(round).step_by(rounds).collect();
            let context =
                |body: &Body| (&templates[body.fit.pose.template], &prepared.fields[body.blob.field]);
            let from = |placement: &Placement, body: &Body, from: usize| {
                let (template, field) = context(body);
                (from..TRIES.len()).find_map(|i| {
                    let mut candidate = candidate(body, TRIES[i], template, field)?;
                    let goes = placement.goes(&candidate, template, field);
                    candidate.silhouette = if goes { silhouette(&candidate.outlines) } else { Vec::new() };
                    goes.then_some((i, candidate))
                })
            };
            // The time is asked for more often than that: elements may be of very many shapes.
            const AT_ONCE: usize = 8;
            let mut firsts: Vec<_> = Vec::with_capacity(ahead.len());
            let mut is_late = false;
            for some in ahead.chunks(AT_ONCE) {
                firsts.par_extend(some.par_iter().map(|body| from(self, body, 0)));
                is_late = !go_on(round as f64 / rounds as f64);
                if is_late {
                    break;
                }
            }
            for (body, first) in ahead.into_iter().zip(firsts) {
                if is_late && !self.placed.is_empty() {
                    return false;
                }
                is_late |= !go_on(round as f64 / rounds as f64);
                let settled = first.and_then(|(i, candidate)| {
                    // It has been checked against the rest already.
                    let field = context(body).1;
                    if self.keeps_apart(&candidate.outlines, candidate.stroke, field)
                        && !self.nests(&candidate.outlines, field)
                    {
                        return Some(candidate);
                    }
                    from(self, body, i + 1).map(|(_, candidate)| candidate)
                });
                if let Some(candidate) = settled {
                    self.accept(body, candidate);
                }
            }
        }
        true
    }

    fn goes(&self, candidate: &Candidate, template: &Template, field: &Field) -> bool {
        self.keeps_apart(&candidate.outlines, candidate.stroke, field)
            && !self.nests(&candidate.outlines, field)
            && !folded(template, candidate.pose, &candidate.bend)
    }

    fn accept(&mut self, body: &Body, candidate: Candidate) {
        let Candidate { pose, bend, scale, stroke, outer, outlines, silhouette } = candidate;
        let owner = self.strokes.len() as u32;
        outlines.iter().for_each(|outline| self.outlines.insert_contour(outline, owner));
        self.strokes.push(stroke);
        self.widest = self.widest.max(stroke);
        self.placed.push(Placed {
            field: body.blob.field,
            kind: body.blob.kind,
            template: pose.template,
            pose,
            scale,
            centre: centre(&outlines),
            area: area(&silhouette),
            spine: (0..=24).map(|i| bend.spine.jet(f64::from(i) / 24.0).p).collect(),
            bend,
            outer,
            outlines,
            silhouette,
        });
    }

    /// Adds the outlines of something that is not an element, and half its stroke width.
    pub fn add_filler(&mut self, outlines: &[Contour], stroke: f64) {
        let owner = self.strokes.len() as u32;
        self.strokes.push(stroke);
        self.widest = self.widest.max(stroke);
        outlines.iter().for_each(|outline| self.outlines.insert_contour(outline, owner));
    }

    /// Outer contours of all elements, without holes.
    pub fn silhouettes(&self) -> Vec<&Contour> {
        self.placed.iter().flat_map(|placed| &placed.silhouette).collect()
    }

    /// Half stroke widths, of elements and then of fillers.
    pub fn strokes(&self) -> &[f64] {
        &self.strokes
    }

    /// An empty grid for the outlines of everything that moves; without them, all is as if nothing were placed.
    pub fn take_outlines(&mut self) -> SegmentGrid {
        let nothing = SegmentGrid::new(Rect::ZERO, 1.0);
        let mut outlines = std::mem::replace(&mut self.outlines, nothing);
        outlines.clear();
        outlines
    }

    /// Takes moved outlines for those of before.
    pub fn give_outlines(&mut self, outlines: SegmentGrid) {
        self.outlines = outlines;
    }

    /// Half the width of the widest stroke.
    pub fn widest_stroke(&self) -> f64 {
        self.widest
    }

    /// The outlines of everything placed.
    pub fn outlines(&self) -> &SegmentGrid {
        &self.outlines
    }

    /// True if the outlines of a filler are inside the region and keep its gap to what is placed.
    pub fn filler_goes(
        &self,
        outlines: &[Contour],
        stroke: f64,
        (field, region, gap): (&Field, &Region, f64),
    ) -> bool {
        let margin = stroke + (field.sizes.tolerance() - field.sizes.edge).max(0.0);
        let gap = field.sizes.safe(gap) + stroke;
        outlines.iter().all(|outline| is_inside(outline, margin, region) && self.is_clear(outline, gap))
    }

    /// True if every outline is inside the region and keeps the gap to what is placed.
    fn keeps_apart(&self, outlines: &[Contour], stroke: f64, field: &Field) -> bool {
        // Where the outline wants next to no distance, chords must not hide an excess.
        let margin = stroke + (field.sizes.tolerance() - field.sizes.edge).max(0.0);
        let gap = field.sizes.safe_gap() + stroke;
        outlines
            .iter()
            .all(|outline| is_inside(outline, margin, &field.region) && self.is_clear(outline, gap))
    }

    /// True if an element lies in another, or another in it, far enough from the outline. Lines that move as a
    /// whole stay between their neighbours; those of the paper may end up in the middle of one.
    fn nests(&self, outlines: &[Contour], field: &Field) -> bool {
        if !field.params.moves_by_paths() {
            return false;
        }
        let bounds = |outlines: &[Contour]| polyline::bounds(outlines.iter().flatten().copied());
        let holds = |outer: &[Contour], inner: &[Contour]| {
            let Some(&first) = inner.first().and_then(|contour| contour.first()) else { return false };
            bounds(outer).is_some_and(|bounds| bounds.contains(first))
                && outer.iter().filter(|contour| encloses(contour, first)).count() % 2 == 1
        };
        self.placed
            .iter()
            .any(|placed| holds(&placed.outlines, outlines) || holds(outlines, &placed.outlines))
    }

    fn is_clear(&self, outline: &Contour, gap: f64) -> bool {
        sides(outline).all(|(p, q)| {
            let mut clear = true;
            self.outlines.visit(p, q, gap + self.widest, |a, b, owner| {
                clear = segment_segment(p, q, a, b) >= gap + self.strokes[owner as usize];
                clear
            });
            clear
        })
    }
}

/// An element bent as one of the tries says. `None` if it does not fit its own room then.
fn candidate(body: &Body, (width, cut): (f64, f64), template: &Template, field: &Field) -> Option<Candidate> {
    let (part, length) = ((cut, 1.0 - cut), body.blob.length);
    let line = polyline::between(&body.blob.points, part.0 * length, part.1 * length);
    let spine = Spine::new(&line, field.sizes.spacing);
    let fit = fit(template, body.fit.pose, &body.blob, part, &spine.curvature, &field.params)?;
    let bend = spine.bend(fit.width.map(|side| side.scaled(width)), template);
    // The geometric mean of the scales along and across, for stroke widths.
    let along = (part.1 - part.0) * length / template.length;
    let scale = width * along * libm::exp(fit.distortion / 2.0);
    let outer = bent(&template.outer, fit.pose, &bend, FINER * field.sizes.tolerance());
    let outlines = outer.iter().flat_map(|path| outlines(path, &field.sizes)).collect();
    Some(Candidate {
        pose: fit.pose,
        bend,
        scale,
        stroke: template.stroke * scale,
        outer,
        outlines,
        silhouette: Vec::new(),
    })
}

/// True if an outline lies in the region, `margin` from its edge.
pub(super) fn is_inside(outline: &Contour, margin: f64, region: &Region) -> bool {
    if region.holds_circle(outline.iter().copied(), margin) {
        return true;
    }
    // One corner inside and no side across the edge: all of it is inside.
    outline.first().is_some_and(|&p| region.contains(p))
        && sides(outline).all(|(p, q)| {
            let mut clear = true;
            region.edges().visit(p, q, margin, |a, b, _| {
                clear =
                    if margin > 0.0 { segment_segment(p, q, a, b) >= margin } else { !crosses(p, q, a, b) };
                clear
            });
            clear
        })
}

pub(super) fn sides(contour: &Contour) -> impl Iterator<Item = (Point, Point)> + '_ {
    let previous = contour.last().into_iter().chain(contour);
    previous.zip(contour).map(|(&p, &q)| (p, q))
}

/// Outer contours alone, joined: a hole is covered too, and an island in it.
pub(super) fn silhouette(outlines: &[Contour]) -> Vec<Contour> {
    if let [outline] = outlines {
        // It does not cross itself, or it would not have been placed.
        return vec![outline.clone()];
    }
    let outer: Vec<Contour> = simplified(outlines, false).into_iter().filter(is_outer).collect();
    if outer.len() > 1 { simplified(&outer, false) } else { outer }
}

/// Curves are bent finer than the chords of the checks.
pub(super) const FINER: f64 = 0.25;

/// The whole template, whose `paths` are bent into place. The map keeps the sides of the thinnest needle apart,
/// but curves that are near the truth may cross where the truth does not by less than that; a
/// drawn element is then bent finer.
fn unfolded(
    mut paths: Vec<BezPath>,
    template: &Template,
    pose: Pose,
    bend: &Bend,
    sizes: &Sizes,
) -> Vec<BezPath> {
    const FINEST: f64 = 1e-6;
    let mut share = FINER;
    loop {
        let tolerance = share * sizes.tolerance();
        if template.builtin || template.crosses_itself || share < FINEST || !any_crossing(&paths, tolerance) {
            return paths;
        }
        share /= 16.0;
        paths = bent(template.parts.iter().map(|(path, _)| path), pose, bend, share * sizes.tolerance());
    }
}

/// Paths of a template bent into place. Without warps nothing is turned over.
pub(super) fn bent<'a>(
    paths: impl IntoIterator<Item = &'a BezPath>,
    pose: Pose,
    bend: &Bend,
    tolerance: f64,
) -> Vec<BezPath> {
    bent_and_checked(paths, pose, bend, tolerance).0
}

/// The same, and false if warps turn over what they were looked at for.
pub(super) fn bent_and_checked<'a>(
    paths: impl IntoIterator<Item = &'a BezPath>,
    pose: Pose,
    bend: &Bend,
    tolerance: f64,
) -> (Vec<BezPath>, bool) {
    let (u0, du) = if pose.along { (1.0, -1.0) } else { (0.0, 1.0) };
    let to_pose = Affine::new([du, 0.0, 0.0, if pose.across { -1.0 } else { 1.0 }, u0, 0.0]);
    let mut keeps_sense = true;
    let bend_one = |path: &BezPath| {
        let mut out = BezPath::new();
        keeps_sense &= bend.path(&(to_pose * path.clone()), tolerance, &mut out);
        out
    };
    let all = paths.into_iter().map(bend_one).collect();
    (all, keeps_sense)
}

fn outlines(path: &BezPath, sizes: &Sizes) -> impl Iterator<Item = Contour> + use<> {
    flatten(path, sizes.tolerance()).into_iter().map(|subpath| subpath.points)
}

/// True if the bent strip comes back to itself. The map is locally injective, so if the
/// outline of the strip that holds the artwork does not cross itself, nothing in it does.
fn folded(template: &Template, pose: Pose, bend: &Bend) -> bool {
    let side = |side: usize, sign: f64| {
        (0..BINS).map(move |i| (i, side, sign)).map(|(i, side, sign)| {
            let extent = extent(template, pose, side, i).max(0.02 * template.half_width);
            bend.point((i as f64 + 0.5) / BINS as f64, sign * extent)
        })
    };
    let mut strip: Contour = side(0, 1.0).collect();
    let mut right: Contour = side(1, -1.0).collect();
    right.reverse();
    strip.extend(right);
    !self_crossings(&strip, 1).is_empty()
}

fn centre(outlines: &[Contour]) -> Point {
    let (mut sum, mut count) = (kurbo::Vec2::ZERO, 0.0);
    for p in outlines.iter().flatten() {
        sum += p.to_vec2();
        count += 1.0;
    }
    (sum / f64::max(count, 1.0)).to_point()
}
