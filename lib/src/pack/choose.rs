//! Which element goes where, and how wide (FLOWPAK 4.5, checklist F-044 to F-046).
//!
//! Departures. Equation (1) compares normalized LR functions; here every candidate is fitted
//! on trial and judged by the area it would fill, which measures the stated goals directly at
//! the same cost. And where the paper scales an element's width by one factor, the largest
//! that stays in the blob, the factor here is a smooth function along each side that nowhere
//! exceeds the room and varies by no more than `stretch`: `stretch = 1` is the paper's. Of two
//! elements that fill a large room as well, one with veins or holes is taken.

use super::blob::Blob;
use super::params::Params;
use super::template::{BINS, Side, Template};
use crate::field::LineKind;
use crate::geom::bend::width_before;
use crate::geom::spline::Profile;

/// Spans of a width profile along an element.
const SPANS: usize = 5;
/// The wider side is at most this many times as wide as the other, in template widths.
const MOST_UNEQUAL: f64 = 2.2;
/// Width may be stretched against length by at most this factor, and squeezed by at most its
/// inverse times [`SQUEEZE`].
const MOST_ASPECT: f64 = 2.4;
/// What is narrower than this against its own proportions reads as a thread.
const SQUEEZE: f64 = 0.22;

/// A template laid one of four ways (F-023).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Pose {
    pub template: usize,
    /// Reflected across the spine: sides swapped.
    pub across: bool,
    /// Reflected along the spine: base and tip swapped.
    pub along: bool,
}

/// A pose with its widths.
#[derive(Clone, Debug)]
pub(super) struct Fit {
    pub pose: Pose,
    /// Scale from template widths to user units, for v > 0 and v < 0.
    pub width: [Profile; 2],
    /// Area of the envelope.
    pub area: f64,
    /// Natural logarithm of how much wider than in proportion the element became.
    pub distortion: f64,
}

/// Extents of a posed template on a side of the blob.
pub(super) fn extent(template: &Template, pose: Pose, side: usize, bin: usize) -> f64 {
    let side = if pose.across { 1 - side } else { side };
    let bin = if pose.along { BINS - 1 - bin } else { bin };
    template.extents[side][bin]
}

/// The poses that make sense on a blob: half elements lie on the boundary, their flat side to
/// it; full ones elsewhere, unless there are none.
pub(super) fn poses(templates: &[Template], usable: &[usize], blob: &Blob) -> Vec<Pose> {
    let on_boundary = blob.kind == LineKind::Boundary;
    let has_full = usable.iter().any(|&t| templates[t].side == Side::Full);
    let mut poses = Vec::new();
    for &template in usable {
        for (across, along) in [(false, false), (true, false), (false, true), (true, true)] {
            let side = match (templates[template].side, across) {
                (Side::Full, _) => Side::Full,
                (Side::Left, false) | (Side::Right, true) => Side::Left,
                _ => Side::Right,
            };
            let fits = if on_boundary { side == Side::Left } else { side == Side::Full || !has_full };
            if fits {
                poses.push(Pose { template, across, along });
            }
        }
    }
    poses
}

/// What limits the width of a pose in a part of a blob.
struct Limits {
    /// Greatest scale of the template's width in each bin of each side.
    scale: [[f64; BINS]; 2],
    /// Scale along the spine.
    along: f64,
    /// Length of a bin in user units.
    bin: f64,
}

/// Measures the limits. `None` if the element would be a thread. `curvature` is that of the
/// part, by bins.
fn limits(
    template: &Template,
    pose: Pose,
    blob: &Blob,
    (from, to): (f64, f64),
    curvature: Option<&[Vec<f64>; 2]>,
    stretch: f64,
    stride: usize,
) -> Option<Limits> {
    let length = (to - from) * blob.length;
    let along = length / template.length;
    // Extents below this share of the widest do not limit the width: a tip has no width.
    const TIP: f64 = 0.03;
    let tip = TIP * template.half_width;
    let mut scale = [[f64::INFINITY; BINS]; 2];
    let mut least = MOST_ASPECT * along;
    for (side, scale) in scale.iter_mut().enumerate() {
        for (i, scale) in scale.iter_mut().enumerate().step_by(stride) {
            let extent = extent(template, pose, side, i);
            if extent <= tip {
                continue;
            }
            let room = blob.room[side][blob_bin(i, from, to)];
            // Pulling in on the inner side of a bend makes room for more width before it.
            const MOST_BEFORE: f64 = 4.0;
            let before = curvature.map_or(room, |k| width_before(room, k[side][i], MOST_BEFORE));
            *scale = before / extent;
            least = least.min(*scale);
        }
    }
    // On a line that the artist drew, a thin element is better than none.
    let squeeze = if blob.kind == LineKind::Fixed { SQUEEZE / 8.0 } else { SQUEEZE };
    if least.is_nan() || least <= squeeze * along {
        return None;
    }
    for scale in &mut scale {
        for (i, scale) in scale.iter_mut().enumerate().step_by(stride) {
            // Less freedom towards the ends: a tip that swells is a tip no more.
            let x = 2.0 * (i as f64 + 0.5) / BINS as f64 - 1.0;
            let freedom = 1.0 + (stretch - 1.0) * (1.0 - x * x);
            *scale = scale.min(least * freedom).min(MOST_ASPECT * along);
        }
    }
    Some(Limits { scale, along, bin: length / BINS as f64 })
}

/// What a pose would fill, for comparison: its area and its distortion.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trial {
    pub pose: Pose,
    /// Area of the envelope.
    pub area: f64,
    /// Natural logarithm of how much wider than in proportion the element would be.
    pub distortion: f64,
}

/// Every so many bins are enough to compare candidates.
const STRIDE: usize = 3;

/// Tries a pose in a part of a blob without shaping its widths.
pub(super) fn trial(
    template: &Template,
    pose: Pose,
    blob: &Blob,
    part: (f64, f64),
    params: &Params,
) -> Option<Trial> {
    let limits = limits(template, pose, blob, part, None, params.stretch, STRIDE)?;
    let (mut weight, mut scaled) = (0.0, 0.0);
    for (side, scale) in limits.scale.iter().enumerate() {
        for (i, scale) in scale.iter().enumerate().step_by(STRIDE) {
            let extent = extent(template, pose, side, i);
            weight += extent;
            scaled += scale * extent;
        }
    }
    let distortion = libm::log(scaled / weight.max(f64::MIN_POSITIVE) / limits.along);
    Some(Trial { pose, area: scaled * limits.bin * STRIDE as f64, distortion })
}

/// The widest smooth fit of a pose into a part of a blob. `None` if it would be a thread.
pub(super) fn fit(
    template: &Template,
    pose: Pose,
    blob: &Blob,
    part: (f64, f64),
    curvature: &[Vec<f64>; 2],
    params: &Params,
) -> Option<Fit> {
    let limits = limits(template, pose, blob, part, Some(curvature), params.stretch, 1)?;
    let spans = if params.stretch > 1.0 { SPANS } else { 1 };
    let [left, right] = limits.scale.each_ref().map(|bounds| Profile::under(bounds, spans));
    let capped = |a: &Profile, b: &Profile| a.zip(b, |a, b| a.min(MOST_UNEQUAL * b));
    let width = [capped(&left, &right), capped(&right, &left)];
    let (mut area, mut weight, mut scaled) = (0.0, 0.0, 0.0);
    for i in 0..BINS {
        let u = (i as f64 + 0.5) / BINS as f64;
        for (side, width) in width.iter().enumerate() {
            let extent = extent(template, pose, side, i);
            let s = width.value(u);
            // The share of the room is what counts, so widths are measured after pulling in.
            area += (s * extent).min(blob.room[side][blob_bin(i, part.0, part.1)]) * limits.bin;
            weight += extent;
            scaled += s * extent;
        }
    }
    let distortion = libm::log(scaled / weight.max(f64::MIN_POSITIVE) / limits.along);
    Some(Fit { pose, width, area, distortion })
}

pub(super) fn blob_bin(i: usize, from: f64, to: f64) -> usize {
    let u = from + (to - from) * (i as f64 + 0.5) / BINS as f64;
    ((u * BINS as f64) as usize).min(BINS - 1)
}

/// Cutting off an end may free the rest of a pinch there that made the whole thin: tries some
/// cuts and returns the part of the blob with the largest area.
pub(super) fn trimmed(
    template: &Template,
    first: Trial,
    blob: &Blob,
    min_length: f64,
    params: &Params,
) -> (f64, f64) {
    const CUTS: [f64; 4] = [0.0, 0.08, 0.18, 0.3];
    // Length given up must pay: it is a gap in the flow as well.
    const WORTH: f64 = 1.06;
    let (mut best, mut area) = ((0.0, 1.0), first.area);
    for from in CUTS {
        for cut in CUTS {
            let part = (from, 1.0 - cut);
            if (part.1 - part.0) * blob.length < min_length.min(0.7 * blob.length) {
                continue;
            }
            if let Some(trial) = trial(template, first.pose, blob, part, params)
                && trial.area > WORTH * area
            {
                (best, area) = (part, trial.area);
            }
        }
    }
    best
}
