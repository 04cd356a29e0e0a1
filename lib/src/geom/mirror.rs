//! Mirror axes of shapes.

use super::boolean::{Contour, area, intersection, signed_area};
use super::polyline;
use kurbo::{Affine, Point, Vec2};

/// A line that a shape is mirrored about.
#[derive(Clone, Copy, Debug)]
pub struct Axis {
    /// A point on it.
    pub at: Point,
    /// Its direction, of length 1.
    pub along: Vec2,
}

impl Axis {
    /// The reflection about it.
    pub fn reflection(&self) -> Affine {
        Affine::reflect(self.at, self.along)
    }

    /// Contours on the other side, wound as they were.
    pub fn reflected(&self, contours: &[Contour]) -> Vec<Contour> {
        let reflection = self.reflection();
        let reflected = |contour: &Contour| contour.iter().rev().map(|&p| reflection * p).collect();
        contours.iter().map(reflected).collect()
    }

    /// The half plane to the left of it, `inset` from it and `reach` wide.
    pub fn half(&self, inset: f64, reach: f64) -> Contour {
        let across = polyline::left_of(self.along);
        let corner = |s: f64, t: f64| self.at + s * reach * self.along + t * across;
        vec![corner(-1.0, inset), corner(1.0, inset), corner(1.0, reach), corner(-1.0, reach)]
    }

    /// The axis about which a shape is most alike: through its centroid, upright if another is hardly
    /// better. `None` for a shape without area.
    pub fn of(contours: &[Contour]) -> Option<Self> {
        /// Corners of all contours together; more would not move the axis.
        const CORNERS: f64 = 240.0;
        const ANGLES: usize = 36;
        /// What an artist takes for symmetric is so about an upright line.
        const UPRIGHT: f64 = 0.02;
        let closed =
            |contour: &Contour| -> Contour { contour.iter().chain(contour.first()).copied().collect() };
        let contours: Vec<Contour> = contours.iter().map(closed).collect();
        let lengths: f64 = contours.iter().map(|contour| polyline::length(contour)).sum();
        let coarse: Vec<Contour> = contours
            .iter()
            .map(|contour| {
                let corners = CORNERS * polyline::length(contour) / lengths.max(f64::MIN_POSITIVE);
                polyline::resample(contour, (corners as usize).clamp(8, contour.len().max(8)))
            })
            .collect();
        let at = centroid(&coarse)?;
        let axis = |angle: f64| Axis { at, along: Vec2::from_angle(angle) };
        let alike =
            |angle: f64| area(&intersection(&coarse, &axis(angle).reflected(&coarse))) / area(&coarse);
        let step = std::f64::consts::PI / ANGLES as f64;
        // From upright on, so that of equals that one is taken.
        let angles = (0..ANGLES).map(|i| std::f64::consts::FRAC_PI_2 + step * i as f64);
        let mut best = (f64::NEG_INFINITY, 0.0);
        for (i, angle) in angles.enumerate() {
            let score = alike(angle) + if i == 0 { UPRIGHT } else { 0.0 };
            if score > best.0 {
                best = (score, angle);
            }
        }
        if best.1 > std::f64::consts::FRAC_PI_2 {
            let mut step = step / 2.0;
            while step > 1e-4 {
                for angle in [best.1 - step, best.1 + step] {
                    let score = alike(angle);
                    if score > best.0 {
                        best = (score, angle);
                    }
                }
                step /= 2.0;
            }
        }
        Some(axis(best.1))
    }
}

fn centroid(contours: &[Contour]) -> Option<Point> {
    let (mut sum, mut twice) = (Vec2::ZERO, 0.0);
    for contour in contours {
        let previous = contour.last().into_iter().chain(contour);
        for (p, q) in previous.zip(contour) {
            let cross = p.to_vec2().cross(q.to_vec2());
            sum += cross * (p.to_vec2() + q.to_vec2());
            twice += cross;
        }
    }
    let total: f64 = contours.iter().map(|contour| signed_area(contour)).sum();
    (total != 0.0 && twice != 0.0).then(|| (sum / (3.0 * twice)).to_point())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An arrow head, turned.
    fn arrow(turn: f64) -> Vec<Contour> {
        let turned =
            |(x, y): (f64, f64)| Affine::translate((50.0, 70.0)) * Affine::rotate(turn) * Point::new(x, y);
        vec![[(0.0, 0.0), (20.0, -30.0), (0.0, 40.0), (-20.0, -30.0)].map(turned).to_vec()]
    }

    #[test]
    fn the_axis_of_a_turned_shape_turns_with_it() {
        for degrees in [0.0_f64, 12.0, 33.0, 71.0, 90.0, 140.0] {
            let axis = Axis::of(&arrow(degrees.to_radians())).unwrap();
            let expected = Vec2::from_angle(degrees.to_radians() + std::f64::consts::FRAC_PI_2);
            assert!(axis.along.cross(expected).abs() < 0.02, "{degrees}: {axis:?}");
            let own = arrow(degrees.to_radians());
            assert!(area(&intersection(&own, &axis.reflected(&own))) > 0.97 * area(&own));
        }
    }

    #[test]
    fn halves_meet_at_the_axis() {
        let axis = Axis { at: Point::new(5.0, 5.0), along: Vec2::new(0.0, 1.0) };
        let square = vec![[(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)].map(Point::from).to_vec()];
        let half = intersection(&square, &[axis.half(1.0, 100.0)]);
        assert!((area(&half) - 40.0).abs() < 1e-9);
        let other = axis.reflected(&half);
        assert!(intersection(&half, &other).is_empty());
        assert!(Axis::of(&[]).is_none());
    }
}
