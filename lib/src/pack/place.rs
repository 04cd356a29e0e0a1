//! Elements on their spines, and the proof that they keep apart (FLOWPAK 4.5, F-045).
//!
//! The room of 4.4 already keeps elements apart up to sampling. What is drawn is checked
//! exactly all the same, outline by outline: inside the region, the gap kept to every element
//! placed before, not crossing itself. What fails is made narrower, then shorter, and at last
//! left out; nothing that fails is drawn.

use super::blob::Blob;
use super::choose::{Fit, fit};
use super::params::Params;
use super::prepare::{Field, self_crossing};
use super::template::Template;
use crate::geom::bend::Bend;
use crate::geom::boolean::Contour;
use crate::geom::flatten::flatten;
use crate::geom::near::{SegmentGrid, crosses, segment_segment};
use kurbo::{Affine, BezPath, Point};

/// Widths tried, one after the other, until the outline keeps its distances.
const NARROWER: [f64; 7] = [1.0, 0.96, 0.9, 0.82, 0.72, 0.6, 0.48];
/// Shares of the length tried after that.
const SHORTER: [f64; 3] = [0.0, 0.07, 0.15];

/// An element in its place.
#[derive(Clone, Debug)]
pub(super) struct Placed {
    pub blob: usize,
    pub fit: Fit,
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
}

impl Placement {
    pub fn new(bounds: kurbo::Rect, cell: f64) -> Self {
        Placement { outlines: SegmentGrid::new(bounds, cell), strokes: Vec::new(), placed: Vec::new() }
    }

    /// Places an element as wide as it goes. False if it does not go at all.
    pub fn place(
        &mut self,
        index: usize,
        blob: &Blob,
        first: &Fit,
        template: &Template,
        field: &Field,
    ) -> bool {
        let spacing = field.sizes.spacing;
        for cut in SHORTER {
            let length = first.to - first.from;
            let part = (first.from + cut * length, first.to - cut * length);
            let (spine, bounds, curvature) = blob.spine(part.0, part.1, spacing);
            let Some(fit) = fit(template, first.pose, blob, part, Some(&curvature), &field.params) else {
                continue;
            };
            for factor in NARROWER {
                let width = [fit.width[0].scaled(factor), fit.width[1].scaled(factor)];
                let bend = Bend {
                    spine: spine.clone(),
                    width: width.clone().into(),
                    curvature: bounds.clone().into(),
                    blend: 0.2 * template.half_width(),
                };
                let (paths, outlines) = bent(template, &fit, &bend, &field.sizes);
                let scale = factor * template_scale(&fit, template, blob);
                let stroke = template.stroke * scale;
                if self.keeps_apart(&outlines, stroke, field) && !folded(&outlines, template) {
                    let spine = (0..=24).map(|i| spine.jet(f64::from(i) / 24.0).p).collect();
                    self.accept(
                        Placed {
                            blob: index,
                            fit: Fit { width, ..fit },
                            paths,
                            scale,
                            centre: centre(&outlines),
                            area: 0.0,
                            spine,
                        },
                        &outlines,
                        stroke,
                    );
                    return true;
                }
            }
        }
        false
    }

    fn accept(&mut self, mut placed: Placed, outlines: &[Contour], stroke: f64) {
        let owner = self.placed.len() as u32;
        for outline in outlines {
            self.outlines.insert_contour(outline, owner);
        }
        placed.area = crate::geom::boolean::area(&crate::geom::boolean::simplified(outlines, false));
        self.strokes.push(stroke);
        self.placed.push(placed);
    }

    /// True if every outline is inside the region and keeps the gap to what is placed.
    fn keeps_apart(&self, outlines: &[Contour], stroke: f64, field: &Field) -> bool {
        // Rounding to the written decimals moves points by less than this share of the gap.
        const ROUNDING: f64 = 1e-3;
        let gap = field.sizes.gap * (1.0 + ROUNDING) + stroke;
        for outline in outlines {
            let Some(&last) = outline.last() else { continue };
            let mut previous = last;
            for &p in outline {
                if !field.region.contains(p) || (stroke > 0.0 && field.region.distance(p, stroke) < stroke) {
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
    fit: &Fit,
    bend: &Bend,
    sizes: &super::params::Sizes,
) -> (Vec<BezPath>, Vec<Contour>) {
    let pose = fit.pose;
    let (u0, du) = if pose.along { (1.0, -1.0) } else { (0.0, 1.0) };
    let to_pose = Affine::new([du, 0.0, 0.0, if pose.across { -1.0 } else { 1.0 }, u0, 0.0]);
    // Curves are true to a four-hundredth of the spacing: a tenth of a millimetre on a poster.
    let tolerance = sizes.spacing / 400.0;
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

/// Geometric mean of the scales along and across.
fn template_scale(fit: &Fit, template: &Template, blob: &Blob) -> f64 {
    let along = (fit.to - fit.from) * blob.length / template.length;
    along * libm::exp(fit.distortion / 2.0)
}

fn centre(outlines: &[Contour]) -> Point {
    let (mut sum, mut count) = (kurbo::Vec2::ZERO, 0.0);
    for p in outlines.iter().flatten() {
        sum += p.to_vec2();
        count += 1.0;
    }
    (sum / f64::max(count, 1.0)).to_point()
}

/// How much of a fit's praise stays after its distortion and its neighbours.
pub(super) fn score(fit: &Fit, room: f64, repeats: f64, against: bool, params: &Params) -> f64 {
    // Weights of the three against the share of the room that is filled.
    const DISTORTION: f64 = 0.12;
    const REPEATS: f64 = 0.3;
    const AGAINST: f64 = 0.25;
    fit.area / room.max(f64::MIN_POSITIVE)
        - DISTORTION * fit.distortion.abs()
        - REPEATS * params.variety * repeats
        - if against { AGAINST } else { 0.0 }
}
