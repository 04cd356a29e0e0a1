//! Where rings do not fit what came to lie around them: other elements in their place (checklist E-062).

use super::super::relax::ring_error;
use super::super::ring::rotated;
use super::{Arrangement, Distance, Link, Object};

impl Arrangement<'_> {
    /// A cure for errors that gather in places (E-062): where the ring of an element lost or gained
    /// neighbours, or does not fit them, or one of them is a copy of the same element, another element
    /// of the same symbol that fits better takes its place. How many did.
    pub fn mend(&mut self) -> usize {
        /// Whole rings that are nearer to the example's than this, in mean edges, are well.
        const WELL: f64 = 0.25;
        let mut mended = 0;
        for number in 0..self.grown.len() {
            let index = self.grown[number];
            let object = &self.objects[index as usize];
            let Some((copy, _)) = object.copy else { continue };
            let is_whole = object.is_whole();
            let (sum, count) = ring_error(&self.objects, object, self.ground);
            let present = (sum / count.max(1.0)).sqrt() / self.example.mean;
            let copy_of = |i: u32| self.objects[i as usize].copy.map(|copy| copy.0);
            let repeats = object.edges.iter().any(|&other| copy_of(other) == Some(copy));
            if is_whole && present < WELL && !repeats {
                continue;
            }
            let Some((around, found)) = self.fitting(index) else { continue };
            if repeats && around.iter().any(|&other| copy_of(other) == Some(found.element)) {
                mended += usize::from(self.vary(index));
                continue;
            }
            let ring = &self.example.elements[found.element].ring;
            if repeats && around.len() != object.edges.len() {
                mended += usize::from(self.vary(index));
                continue;
            }
            // Only against repeats may some of its ring be missing.
            if around.len() != object.edges.len()
                || ring.len() != around.len() && !repeats
                || is_whole && found.element == copy
            {
                continue;
            }
            let links: Vec<Link> = around
                .iter()
                .enumerate()
                .map(|(i, &to)| {
                    let own = &ring[(found.shift + i) % ring.len()];
                    Link { to, offset: rotated(own.offset, found.turn), element: own.element as u32 }
                })
                .collect();
            let mended_object = Object { ring: links, ..object.clone() };
            let (sum, count) = ring_error(&self.objects, &mended_object, self.ground);
            let better = (sum / count.max(1.0)).sqrt() / self.example.mean < 0.9 * present;
            let is_new = around.iter().all(|&other| copy_of(other) != Some(found.element));
            if !is_new || is_whole && !(better || repeats) {
                continue;
            }
            self.objects[index as usize] =
                Object { copy: Some((found.element, found.turn)), ..mended_object };
            mended += 1;
        }
        mended
    }

    /// Makes an element a copy of another of its symbol than all its neighbours are, in its place and with
    /// its ring: the last way out against repeats. False if there is none.
    fn vary(&mut self, index: u32) -> bool {
        let object = &self.objects[index as usize];
        let Some((copy, turn)) = object.copy else { return false };
        let is_near = |element: usize| {
            let others = object.edges.iter().filter_map(|&other| self.objects[other as usize].copy);
            others.into_iter().any(|(other, _)| other == element)
        };
        let symbol = self.example.elements[copy].symbol;
        let alike = (0..self.example.elements.len())
            .filter(|&element| self.example.elements[element].symbol == symbol && !is_near(element));
        let difference = |&element: &usize| Distance(self.example.difference(copy, element));
        let Some(other) = alike.min_by_key(difference) else { return false };
        self.objects[index as usize].copy = Some((other, turn));
        true
    }

    /// The share of elements whose rings are broken: neighbours missing, or one too many.
    pub fn broken(&self) -> f64 {
        let is_broken = |&&i: &&u32| {
            let object = &self.objects[i as usize];
            let is_seed = |link: &Link| self.objects[link.to as usize].copy.is_none();
            let (sum, count) = ring_error(&self.objects, object, self.ground);
            !object.is_whole()
                || object.ring.iter().any(is_seed)
                || (sum / count.max(1.0)).sqrt() > 0.2 * self.example.mean
        };
        self.grown.iter().filter(is_broken).count() as f64 / self.grown.len().max(1) as f64
    }

    /// Which objects are within so many steps of what has grown since some number of elements.
    pub fn near_new(&self, since: usize, steps: usize) -> Vec<bool> {
        let mut is_near = vec![false; self.objects.len()];
        let mut front: Vec<u32> = self.grown[since.min(self.grown.len())..].to_vec();
        front.iter().for_each(|&i| is_near[i as usize] = true);
        for _ in 0..steps {
            let mut next = Vec::new();
            for &i in &front {
                for &j in &self.objects[i as usize].edges {
                    if !std::mem::replace(&mut is_near[j as usize], true) {
                        next.push(j);
                    }
                }
            }
            front = next;
        }
        is_near
    }
}
