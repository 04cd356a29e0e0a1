//! How far elements reach (checklist E-063): convex outlines, so that shapes of any size keep clear of
//! each other as they do in the example, and not their middles alone.

use super::ring::rotated;
use crate::geom::flatten::flatten;
use kurbo::{Point, Vec2};
use rinceau_format::Example;

/// So true are chords of curved outlines, in mean edges.
const TOLERANCE: f64 = 5e-4;
/// Points on an outline at most, where it is tested against a container.
const MOST: usize = 200;
/// Corners of a convex outline at most.
const CORNERS: usize = 16;

/// The outline of an element, from its middle.
#[derive(Clone, Debug, Default)]
pub(super) struct Extent {
    /// Points on it, strokes included.
    pub points: Vec<Vec2>,
    /// What is convex around them, counter-clockwise in a system whose y axis points up.
    hull: Vec<Vec2>,
    radius: f64,
}

impl Extent {
    /// The extent of an element that stands at a place, with edges of this mean length.
    pub fn new(one: &Example, at: Point, mean: f64) -> Self {
        let mut all: Vec<Vec2> = Vec::new();
        for part in &one.parts {
            let scale = part.transform.determinant().abs().sqrt();
            let half = 0.5 * scale * part.style.stroke_width().unwrap_or(0.0);
            for line in flatten(&(part.transform * part.path.clone()), TOLERANCE * mean) {
                all.extend(line.points.iter().map(|&p| grown(p - at, half)));
            }
        }
        // Evenly many, and the corners of what is convex around them.
        let mut hull = convex(&all);
        let step = all.len().div_ceil(MOST).max(1);
        let mut points: Vec<Vec2> = all.into_iter().step_by(step).collect();
        points.extend(&hull);
        simplify(&mut hull);
        let radius = hull.iter().map(|v| v.hypot()).fold(0.0, f64::max);
        Extent { points, hull, radius }
    }

    /// Distance of what is farthest from the middle.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// How deep two elements lie in each other, and the shortest way out for the first; `None` if it is
    /// no more than `allowed`. What is apart has a depth below 0: the room between, or less where corners
    /// face each other. `between` is from the middle of the first to that of the second.
    pub fn depth(
        &self,
        turn: Vec2,
        (other, other_turn): (&Extent, Vec2),
        between: Vec2,
        allowed: f64,
    ) -> Option<(f64, Vec2)> {
        if between.hypot() >= self.radius + other.radius - allowed.min(0.0) {
            return None;
        }
        let mut least: Option<(f64, Vec2)> = None;
        let mut consider = |axis: Vec2| {
            // Of an axis in the drawing, as each of the two sees it.
            let farthest = |extent: &Extent, turn: Vec2, axis: Vec2| {
                let own = rotated(axis, Vec2::new(turn.x, -turn.y));
                extent.hull.iter().map(|v| own.dot(*v)).fold(f64::NEG_INFINITY, f64::max)
            };
            let deep = farthest(self, turn, axis) + farthest(other, other_turn, -axis) - axis.dot(between);
            if least.is_none_or(|(depth, _)| deep < depth) {
                least = Some((deep, -axis));
            }
            deep > allowed
        };
        // Most are apart along the line between them.
        let length = between.hypot();
        if length > 0.0 && !consider(between / length) {
            return None;
        }
        let is_deep = normals(&self.hull).all(|axis| consider(rotated(axis, turn)))
            && normals(&other.hull).all(|axis| consider(-rotated(axis, other_turn)));
        least.filter(|_| is_deep)
    }
}

/// Farther out by half a stroke.
fn grown(v: Vec2, half: f64) -> Vec2 {
    let length = v.hypot();
    if length > 0.0 { v * (1.0 + half / length) } else { v }
}

/// Unit vectors out of a convex outline, one for each side.
fn normals(hull: &[Vec2]) -> impl Iterator<Item = Vec2> + '_ {
    (0..hull.len()).filter_map(|i| {
        let side = hull[(i + 1) % hull.len()] - hull[i];
        let length = side.hypot();
        (length > 0.0).then(|| Vec2::new(side.y, -side.x) / length)
    })
}

/// The corners of what is convex around points (Andrew 1979).
fn convex(points: &[Vec2]) -> Vec<Vec2> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    sorted.dedup();
    if sorted.len() < 3 {
        return sorted;
    }
    let chain = |points: &mut dyn Iterator<Item = &Vec2>| {
        let mut chain: Vec<Vec2> = Vec::new();
        for &p in points {
            while let [.., a, b] = chain[..]
                && (b - a).cross(p - b) <= 0.0
            {
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut hull = chain(&mut sorted.iter());
    hull.extend(chain(&mut sorted.iter().rev()));
    hull
}

/// Takes out the corners that matter least until there are few.
fn simplify(hull: &mut Vec<Vec2>) {
    while hull.len() > CORNERS {
        let n = hull.len();
        let area = |i: usize| {
            let (a, b, c) = (hull[(i + n - 1) % n], hull[i], hull[(i + 1) % n]);
            (b - a).cross(c - b)
        };
        let flattest = (0..n).min_by(|&i, &j| area(i).total_cmp(&area(j))).unwrap_or(0);
        hull.remove(flattest);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(half: f64) -> Extent {
        let points = vec![
            Vec2::new(-half, -half),
            Vec2::new(half, -half),
            Vec2::new(half, half),
            Vec2::new(-half, half),
            Vec2::new(0.0, 0.5 * half),
        ];
        let hull = convex(&points);
        assert_eq!(hull.len(), 4);
        Extent { radius: half * 2.0_f64.sqrt(), points, hull }
    }

    #[test]
    fn squares_are_as_deep_in_each_other_as_they_overlap() {
        let (none, eighth) = (Vec2::new(1.0, 0.0), Vec2::new(0.5_f64.sqrt(), 0.5_f64.sqrt()));
        let (a, b) = (square(1.0), square(2.0));
        assert!(a.depth(none, (&b, none), Vec2::new(3.01, 0.0), 0.0).is_none());
        assert!(a.depth(none, (&b, none), Vec2::new(3.01, 2.0), 0.0).is_none());
        let (depth, out) = a.depth(none, (&b, none), Vec2::new(3.5, 0.5), -1.0).unwrap();
        assert!(depth == -0.5 && out == Vec2::new(-1.0, 0.0), "{depth} {out:?}");
        let (depth, out) = a.depth(none, (&b, none), Vec2::new(2.75, 0.5), 0.0).unwrap();
        assert!(
            (depth - 0.25).abs() < 1e-12 && (out - Vec2::new(-1.0, 0.0)).hypot() < 1e-12,
            "{depth} {out:?}"
        );
        // On its corner the small one reaches farther.
        assert!(a.depth(eighth, (&b, none), Vec2::new(3.3, 0.0), 0.0).is_some());
        assert!(a.depth(eighth, (&b, none), Vec2::new(3.45, 0.0), 0.0).is_none());
    }
}
