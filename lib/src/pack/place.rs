//! Elements on their spines, and the proof that they keep apart (FLOWPAK 4.5, F-045).
//!
//! The room of 4.4 already keeps elements apart up to sampling. What is drawn is checked
//! exactly all the same, outline by outline: inside the region, the gap kept to every element
//! placed before, not crossing itself. What fails is made narrower, then shorter, and at last
//! left out; nothing that fails is drawn.

use super::blob::Spine;
use super::choose::{Pose, fit};
use super::params::Sizes;
use super::prepare::{Field, Prepared, self_crossing};
use super::refine::Body;
use super::template::Template;
use crate::geom::bend::Bend;
use crate::geom::boolean::{Contour, area, is_outer, simplified};
use crate::geom::flatten::flatten;
use crate::geom::polyline;
use crate::geom::near::{SegmentGrid, crosses, segment_segment};
use kurbo::{Affine, BezPath, Point};

/// Widths tried, one after the other, until the outline keeps its distances.
const NARROWER: [f64; 7] = [1.0, 0.96, 0.9, 0.82, 0.72, 0.6, 0.48];
/// Shares of the length tried after that.
const SHORTER: [f64; 3] = [0.0, 0.07, 0.15];

/// An element in its place.
#[derive(Clone, Debug)]
pub(super) struct Placed {
    /// Index of its container's field.
    pub field: usize,
    pub template: usize,
    /// The template's paths, bent.
    pub paths: Vec<BezPath>,
    /// Mean scale, for stroke widths.
    pub scale: f64,
    pub centre: Point,
    pub area: f64,
    pub spine: Vec<Point>,
}

/// Everything placed so far.
pub(super) struct Placement {
    outlines: SegmentGrid,
    /// Half stroke width of each placed element.
    strokes: Vec<f64>,
    pub placed: Vec<Placed>,
    /// Outer contours of everything placed, without holes.
    pub silhouettes: Vec<Contour>,
}

impl Placement {
    /// Nothing placed yet.
    pub fn new(prepared: &Prepared) -> Self {
        let spacing = prepared.fields.iter().map(|field| field.sizes.spacing).fold(f64::INFINITY, f64::min);
        Placement {
            outlines: SegmentGrid::new(prepared.bounds, spacing / 6.0),
            strokes: Vec::new(),
            placed: Vec::new(),
            silhouettes: Vec::new(),
        }
    }

    /// Places an element as wide as it goes. False if it does not go at all.
    pub fn place(&mut self, body: &Body, template: &Template, field: &Field) -> bool {
        SHORTER.into_iter().any(|cut| self.place_part(body, (cut, 1.0 - cut), template, field))
    }

    fn place_part(&mut self, body: &Body, part: (f64, f64), template: &Template, field: &Field) -> bool {
        let line = polyline::between(&body.blob.points, part.0 * body.blob.length, part.1 * body.blob.length);
        let spine = Spine::new(&line, field.sizes.spacing);
        let fitted = fit(template, body.fit.pose, &body.blob, part, &spine.curvature, &field.params);
        let Some(fit) = fitted else { return false };
        let along = (part.1 - part.0) * body.blob.length / template.length;
        let mut bend = spine.bend(fit.width.clone(), template);
        for factor in NARROWER {
            bend.width = (fit.width[0].scaled(factor), fit.width[1].scaled(factor));
            let (paths, outlines) = bent(template, fit.pose, &bend, &field.sizes);
            // The geometric mean of the scales along and across, for stroke widths.
            let scale = factor * along * libm::exp(fit.distortion / 2.0);
            let stroke = template.stroke * scale;
            if self.keeps_apart(&outlines, stroke, field) && !folded(&outlines, template) {
                let owner = self.strokes.len() as u32;
                outlines.iter().for_each(|outline| self.outlines.insert_contour(outline, owner));
                self.strokes.push(stroke);
                let silhouette = simplified(&outlines, false);
                let painted = area(&silhouette);
                self.silhouettes.extend(silhouette.into_iter().filter(is_outer));
                self.placed.push(Placed {
                    field: body.blob.field,
                    template: fit.pose.template,
                    paths,
                    scale,
                    centre: centre(&outlines),
                    area: painted,
                    spine: (0..=24).map(|i| bend.spine.jet(f64::from(i) / 24.0).p).collect(),
                });
                return true;
            }
        }
        false
    }

    /// Adds the outline of something that is not an element.
    pub fn add_outline(&mut self, outline: &Contour) {
        let owner = self.strokes.len() as u32;
        self.strokes.push(0.0);
        self.outlines.insert_contour(outline, owner);
    }

    /// Distance from a place to the nearest outline, from inside as from outside; `reach` at
    /// most.
    pub fn distance(&self, at: Point, reach: f64) -> f64 {
        self.outlines.distance(at, reach)
    }

    /// True if every outline is inside the region and keeps the gap to what is placed.
    fn keeps_apart(&self, outlines: &[Contour], stroke: f64, field: &Field) -> bool {
        let gap = field.sizes.safe_gap() + stroke;
        // Where the outline wants next to no distance, chords must not hide an excess.
        let margin = stroke + (field.sizes.tolerance() - field.sizes.edge).max(0.0);
        for outline in outlines {
            let Some(&last) = outline.last() else { continue };
            let mut previous = last;
            for &p in outline {
                if !field.region.contains(p) || (margin > 0.0 && field.region.distance(p, margin) < margin) {
                    return false;
                }
                let mut fine = true;
                field.region.edges().visit(previous, p, 0.0, |a, b, _| {
                    fine = !crosses(previous, p, a, b);
                    fine
                });
                if fine {
                    self.outlines.visit(previous, p, gap, |a, b, owner| {
                        fine = segment_segment(previous, p, a, b) >= gap + self.strokes[owner as usize];
                        fine
                    });
                }
                if !fine {
                    return false;
                }
                previous = p;
            }
        }
        true
    }
}

/// The template's paths bent into place, and their outlines.
fn bent(
    template: &Template,
    pose: Pose,
    bend: &Bend,
    sizes: &Sizes,
) -> (Vec<BezPath>, Vec<Contour>) {
    let (u0, du) = if pose.along { (1.0, -1.0) } else { (0.0, 1.0) };
    let to_pose = Affine::new([du, 0.0, 0.0, if pose.across { -1.0 } else { 1.0 }, u0, 0.0]);
    let tolerance = sizes.tolerance();
    let mut paths = Vec::new();
    let mut outlines = Vec::new();
    for (path, _) in &template.parts {
        let mut out = BezPath::new();
        bend.path(&(to_pose * path.clone()), tolerance, &mut out);
        outlines.extend(flatten(&out, tolerance).into_iter().map(|subpath| subpath.points));
        paths.push(out);
    }
    (paths, outlines)
}

/// True if bending made an outline cross itself that did not before: the map is locally
/// injective, so this happens only where a spine comes back to itself.
fn folded(outlines: &[Contour], template: &Template) -> bool {
    let was_crossed = || {
        template
            .parts
            .iter()
            .flat_map(|(path, _)| flatten(path, 1e-3))
            .any(|subpath| self_crossing(&subpath.points).is_some())
    };
    outlines.iter().any(|outline| self_crossing(outline).is_some()) && !was_crossed()
}

fn centre(outlines: &[Contour]) -> Point {
    let (mut sum, mut count) = (kurbo::Vec2::ZERO, 0.0);
    for p in outlines.iter().flatten() {
        sum += p.to_vec2();
        count += 1.0;
    }
    (sum / f64::max(count, 1.0)).to_point()
}
