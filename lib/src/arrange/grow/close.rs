//! The edges around an element that has grown (Ijiri et al. 2008, 5.1; checklist E-034 to E-036).

use super::{Arrangement, SHORT};
use crate::geom::segment::crosses;
use kurbo::{Point, Vec2};

/// An edge this many times longer than the example's makes room for another seed (E-035).
const LONG: f64 = 1.5;

impl Arrangement<'_> {
    /// The edge between two neighbours of an element; where it is too long, a seed between them; and
    /// where something lies in the triangle, edges to that.
    pub(super) fn close(&mut self, (centre, o): (u32, Point), (a, b): (u32, u32), original: f64) {
        let (p, q) = (self.at(a, o), self.at(b, o));
        if self.objects[a as usize].edges.contains(&b) {
            return;
        }
        if self.collides((a, b), p, q) {
            self.join_inside((centre, o), (a, p), (b, q));
            return;
        }
        if p.distance(q) > LONG * original && self.extra(centre, (a, b), (o, p, q)) {
            return;
        }
        self.connect(a, b);
    }

    /// A seed of any symbol on the bisector of a wide angle (E-035).
    fn extra(&mut self, centre: u32, (a, b): (u32, u32), (o, p, q): (Point, Point, Point)) -> bool {
        let (u, v) = (p - o, q - o);
        let (lu, lv) = (u.hypot(), v.hypot());
        let way = u / lu + v / lv;
        // Across, where the angle is straight.
        let way = if way.hypot() < 1e-6 { Vec2::new(-u.y, u.x) / lu } else { way / way.hypot() };
        let way = if u.cross(v) < 0.0 { -way } else { way };
        let at = o + 0.5 * (lu + lv) * way;
        let is_free = self.nearest(centre, at, SHORT * self.example.least).is_none();
        if !is_free
            || self.ground.divides(o, at)
            || self.collides((centre, centre), o, at)
            || self.collides((a, a), p, at)
            || self.collides((b, b), q, at)
        {
            return false;
        }
        let new = self.sow(at, None);
        for other in [centre, a, b] {
            self.connect(new, other);
        }
        true
    }

    /// Joins what lies in a triangle to its corners (E-036).
    fn join_inside(&mut self, (centre, o): (u32, Point), (a, p): (u32, Point), (b, q): (u32, Point)) {
        let reach = p.distance(q).max(o.distance(p)).max(o.distance(q));
        let side = |u: Point, v: Point, at: Point| (v - u).cross(at - u);
        let sense = side(o, p, q).signum();
        let mut inside: Vec<(u32, Point)> = Vec::new();
        self.grid.visit(o, reach, |at, other| {
            let is_inside = [(o, p), (p, q), (q, o)].into_iter().all(|(u, v)| side(u, v, at) * sense > 0.0);
            if is_inside && !self.objects[other as usize].is_gone && ![centre, a, b].contains(&other) {
                inside.push((other, at));
            }
            true
        });
        for (other, at) in inside {
            for (corner, from) in [(centre, o), (a, p), (b, q)] {
                let is_linked = self.objects[other as usize].edges.contains(&corner);
                if !is_linked && !self.collides((corner, other), from, at) {
                    self.connect(corner, other);
                }
            }
        }
    }

    /// The nearest object within a radius, another than one's own.
    pub(super) fn nearest(&self, own: u32, at: Point, radius: f64) -> Option<u32> {
        let mut nearest: Option<(f64, u32)> = None;
        self.grid.visit(at, radius, |p, other| {
            let distance = p.distance(at);
            if other != own
                && distance < radius
                && !self.objects[other as usize].is_gone
                && nearest.is_none_or(|best| (distance, other) < best)
            {
                nearest = Some((distance, other));
            }
            true
        });
        nearest.map(|(_, other)| other)
    }

    /// True if a new edge would cross another. `ends` are objects at its ends.
    pub(super) fn collides(&self, ends: (u32, u32), p: Point, q: Point) -> bool {
        let longest = 2.0 * self.example.mean;
        let reach = 0.5 * p.distance(q) + 0.5 * longest;
        let is_end = |i: u32| i == ends.0 || i == ends.1;
        let mut found = false;
        let middle = p.midpoint(q);
        self.grid.visit(middle, reach, |at, other| {
            if at.distance_squared(middle) > reach * reach
                || is_end(other)
                || self.objects[other as usize].is_gone
            {
                return true;
            }
            let edges = self.objects[other as usize].edges.iter();
            found = edges.filter(|&&to| !is_end(to)).any(|&to| crosses(p, q, at, self.at(to, at)));
            !found
        });
        found
    }
}
