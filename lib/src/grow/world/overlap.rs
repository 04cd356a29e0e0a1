//! What may touch what: relatives where they join, and nothing else.

use super::World;
use crate::grow::piece::Piece;
use kurbo::{Point, Rect};

impl World {
    /// True if some of the pieces touch what is placed, or their own images. Relatives may touch
    /// where the parent is: brothers leave it at one place.
    pub fn overlaps(&mut self, pieces: &[Piece], parent: u32, is_child: bool) -> bool {
        let slack = 1e-6 + 1e-6 * self.bounds.width();
        let family = if is_child { self.family(parent) } else { Vec::new() };
        let (elements, kinds) = (&self.elements, &self.kinds);
        let joint = 2.0 * slack;
        let parent_pieces: Vec<Piece> = match elements.get(parent as usize) {
            Some(element) if is_child => {
                element.proxies.iter().flatten().flat_map(|proxy| proxy.pieces(self.tolerance)).collect()
            }
            _ => Vec::new(),
        };
        for piece in pieces {
            let mut is_hit = false;
            self.index.near(piece.bounds(), |other| {
                let is_parent = is_child && other.element == parent && other.image == 0;
                if is_parent || kinds[elements[other.element as usize].kind].overlaps {
                    return true;
                }
                let apart = piece.apart(&other.piece);
                let is_thin = matches!((piece, &other.piece), (Piece::Segment(..), Piece::Segment(..)));
                let most = if is_thin { slack } else { -slack };
                if apart < most {
                    // Only lines join: two discs in one place are no joint.
                    let has_line =
                        matches!(piece, Piece::Segment(..)) || matches!(other.piece, Piece::Segment(..));
                    let is_joint = has_line && family.contains(&other.element) && {
                        let at = contact(piece, &other.piece);
                        parent_pieces.iter().any(|parent| parent.distance(at) <= joint)
                    };
                    is_hit = !is_joint;
                }
                !is_hit
            });
            if is_hit {
                return true;
            }
        }
        false
    }

    /// True if what grows at once touches its own images, elsewhere than at the parent. A disc in a special
    /// position, on a mirror or an axis, is its own image and does not.
    pub(super) fn meets_itself(&self, all: &[Vec<Piece>], parent: u32) -> bool {
        if self.images.len() == 1 {
            return false;
        }
        let slack = 1e-6 + 1e-6 * self.bounds.width();
        let pieces: Vec<(&Piece, Rect)> = all.iter().flatten().map(|piece| (piece, piece.bounds())).collect();
        let Some(whole) = pieces.iter().map(|piece| piece.1).reduce(|a, b| a.union(b)) else { return false };
        let parent = self.elements.get(parent as usize);
        let parent: Vec<Piece> = parent
            .into_iter()
            .flat_map(|parent| parent.proxies.iter().flatten())
            .flat_map(|proxy| proxy.pieces(self.tolerance))
            .collect();
        let is_joint = |at: Point| parent.iter().any(|piece| piece.distance(at) <= 4.0 * slack);
        self.images[1..].iter().any(|&by| {
            let elsewhere = by.transform_rect_bbox(whole);
            if !elsewhere.overlaps(whole) {
                return false;
            }
            pieces.iter().any(|(a, _)| {
                let moved = a.moved(by);
                let is_itself = |b: &Piece| match (b, &moved) {
                    (Piece::Disc(one, _), Piece::Disc(two, _)) => {
                        std::ptr::eq(b, *a) && one.distance(*two) < slack
                    }
                    _ => false,
                };
                let around = moved.bounds().inflate(slack, slack);
                pieces.iter().any(|(b, bounds)| {
                    let touches = bounds.x0 <= around.x1
                        && around.x0 <= bounds.x1
                        && bounds.y0 <= around.y1
                        && around.y0 <= bounds.y1;
                    touches && b.apart(&moved) < slack && !is_itself(b) && !is_joint(contact(b, &moved))
                })
            })
        })
    }

    /// Relatives of what grows from an element: its parent, what it was made with, its children.
    pub(super) fn family(&self, parent: u32) -> Vec<u32> {
        let Some(element) = self.elements.get(parent as usize) else { return Vec::new() };
        let mut family = self.made_with(parent);
        family.push(element.parent);
        family.extend(&element.children);
        family
    }

    /// What an application of a rule made together with an element.
    pub(super) fn made_with(&self, element: u32) -> Vec<u32> {
        let Some(of) = self.elements.get(element as usize) else { return Vec::new() };
        // They are placed one after the other.
        let is_of_it = |i: &usize| self.elements[*i].firing == of.firing;
        let before = (0..element as usize).rev().take_while(is_of_it);
        let after = (element as usize + 1..self.placed).take_while(is_of_it);
        before.chain(after).map(|i| i as u32).collect()
    }
}

/// Where two pieces touch, about.
fn contact(a: &Piece, b: &Piece) -> Point {
    match (a, b) {
        (Piece::Segment(p, q), Piece::Segment(r, s)) => {
            let (d, e, w) = (*q - *p, *s - *r, *r - *p);
            let cross = d.cross(e);
            if cross.abs() > 1e-12 {
                let (t, u) = (w.cross(e) / cross, w.cross(d) / cross);
                if (0.0..=1.0).contains(&t) && (0.0..=1.0).contains(&u) {
                    return *p + t * d;
                }
            }
            let ends =
                [(*p, b.distance(*p)), (*q, b.distance(*q)), (*r, a.distance(*r)), (*s, a.distance(*s))];
            ends.into_iter().min_by(|a, b| a.1.total_cmp(&b.1)).map_or(*p, |end| end.0)
        }
        (Piece::Disc(center, _), Piece::Segment(p, q)) | (Piece::Segment(p, q), Piece::Disc(center, _)) => {
            let d = *q - *p;
            let t = ((*center - *p).dot(d) / d.hypot2().max(1e-300)).clamp(0.0, 1.0);
            *p + t * d
        }
        (Piece::Disc(one, radius), Piece::Disc(two, _)) => {
            let d = *two - *one;
            *one + d * (radius / d.hypot().max(1e-300))
        }
        (piece, _) => piece.sample(),
    }
}
