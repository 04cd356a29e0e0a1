//! The exclude list, and the two ways out of it (000 4.1, checklist W-099 to W-102).

use super::{BLOCK, Exclusion, FREE, NONE, Space};
use kurbo::Point;

impl Space {
    /// Puts the middle of a cell on the exclude list. The cells whose circles it lies in hang
    /// together, because distances change no faster than places.
    pub fn exclude(&mut self, at: Point) {
        let Some((x, y)) = self.place(at) else { return };
        let number = self.excluded.len() as u32;
        self.excluded.push(Some(at));
        self.excluded_in[y / BLOCK * self.levels[0].columns + x / BLOCK].push(number);
        let mut queue = vec![(x, y)];
        let mut next = 0;
        while let Some(&(x, y)) = queue.get(next) {
            next += 1;
            let index = self.number(x, y);
            let distance = at.distance(self.middle_at(x, y)) as f32;
            let known = self.exclusion(index);
            let is_reached = distance <= self.near[index].distance && distance < known.distance;
            if next > 1 && !is_reached || known.by == number {
                continue;
            }
            self.set_exclusion(index, Exclusion { distance, by: number });
            queue.extend(self.beside(x, y));
        }
    }

    /// Takes the points within `radius` off the exclude list.
    pub fn readmit(&mut self, at: Point, radius: f64) {
        let mut freed = Vec::new();
        for block in self.blocks_near(at, radius) {
            let excluded = &mut self.excluded;
            self.excluded_in[block].retain(|&number| {
                let is_near = excluded[number as usize].is_some_and(|point| point.distance(at) <= radius);
                if is_near {
                    freed.push((number, excluded[number as usize].take()));
                }
                !is_near
            });
        }
        for (number, point) in freed {
            if let Some(start) = point.and_then(|point| self.place(point)) {
                self.free(number, start);
            }
        }
    }

    /// Clears the exclude list.
    pub fn readmit_all(&mut self) {
        for block in 0..self.exclusions.len() {
            if self.exclusions[block].take().is_some() {
                self.touch(block * BLOCK * BLOCK);
            }
        }
        self.excluded.clear();
        self.excluded_in.iter_mut().for_each(Vec::clear);
    }

    /// Cells that a point was nearest to look for another.
    fn free(&mut self, number: u32, start: (usize, usize)) {
        let mut cells = vec![start];
        let mut largest = 0.0_f32;
        let mut next = 0;
        while let Some(&(x, y)) = cells.get(next) {
            next += 1;
            let index = self.number(x, y);
            if self.exclusion(index).by != number {
                continue;
            }
            self.set_exclusion(index, FREE);
            largest = largest.max(self.near[index].distance);
            cells.extend(self.beside(x, y));
        }
        let reach = f64::from(largest).max(0.0);
        let others = self.listed_near(self.middle_at(start.0, start.1), 2.0 * reach);
        for (x, y) in cells {
            let index = self.number(x, y);
            if self.exclusion(index).by != NONE {
                continue;
            }
            let at = self.middle_at(x, y);
            let mut nearest = FREE;
            for &(number, point) in &others {
                let distance = point.distance(at) as f32;
                if distance <= self.near[index].distance && distance < nearest.distance {
                    nearest = Exclusion { distance, by: number };
                }
            }
            if nearest.by != NONE {
                self.set_exclusion(index, nearest);
            }
        }
    }

    /// Blocks that a disc may reach, row by row.
    fn blocks_near(&self, at: Point, radius: f64) -> impl Iterator<Item = usize> + use<> {
        let columns = self.levels[0].columns as i64;
        let rows = self.levels[0].best.len() as i64 / columns;
        let side = self.cell * BLOCK as f64;
        let of = |v: f64, most: i64| ((v / side).floor() as i64).clamp(0, most - 1);
        let from = at - self.origin;
        let (x0, x1) = (of(from.x - radius, columns), of(from.x + radius, columns));
        let (y0, y1) = (of(from.y - radius, rows), of(from.y + radius, rows));
        (y0..=y1).flat_map(move |y| (x0..=x1).map(move |x| (y * columns + x) as usize))
    }

    fn listed_near(&self, at: Point, radius: f64) -> Vec<(u32, Point)> {
        self.blocks_near(at, radius)
            .flat_map(|block| &self.excluded_in[block])
            .filter_map(|&number| Some((number, self.excluded[number as usize]?)))
            .filter(|(_, point)| point.distance(at) <= radius)
            .collect()
    }
}
