//! Main stems: through drawn paths, as one curl, or finding their own way (checklist M-002,
//! M-010, M-018, M-033, M-038).
//!
//! A stem that finds its way is the article's wish: a particle with a periodic charge, in a
//! field that turns it back from the walls, so that it bounces through the shape. Many such
//! particles are tried, from different places with different periods; the one that comes near
//! the largest part of the shape, without coming near itself, is taken. It ends in a curl.

use super::cells::Cells;
use super::grow::{Plant, Pose};
use super::particle::{Node, unit};
use super::stem::{Stem, Taper};
use crate::geom::catmull_rom;
use crate::geom::flatten::start_tangent;
use crate::rng::Rng;
use kurbo::{BezPath, CubicBez, ParamCurve, ParamCurveCurvature, ParamCurveDeriv, PathEl, Point, Rect, Vec2};

/// Particles that are tried for the first stem of a shape, and for those that fill up what it
/// left.
pub(super) const TRIES: [usize; 2] = [120, 24];

/// Stems along a drawn path: a path of straight lines becomes a smooth curve through its nodes
/// (M-018); one that the artist has curved is followed as drawn, through the same nodes.
pub(super) fn drawn(path: &BezPath, taper: Taper) -> Vec<Stem> {
    let mut subpaths: Vec<BezPath> = Vec::new();
    for el in path.elements() {
        if matches!(el, PathEl::MoveTo(_)) {
            subpaths.push(BezPath::new());
        }
        if let Some(last) = subpaths.last_mut() {
            last.push(*el);
        }
    }
    let stem = |subpath: BezPath| {
        let curved =
            subpath.elements().iter().any(|el| matches!(el, PathEl::CurveTo(..) | PathEl::QuadTo(..)));
        let cubics: Vec<CubicBez> = if curved {
            subpath.segments().map(|segment| segment.to_cubic()).collect()
        } else {
            let closed = subpath.elements().iter().any(|el| matches!(el, PathEl::ClosePath));
            let points: Vec<Point> = subpath.elements().iter().filter_map(PathEl::end_point).collect();
            catmull_rom::through(&points, closed)
        };
        let stem = Stem::new(0, None, 1.0, nodes(&cubics), taper);
        (stem.end > 0.0).then_some(stem)
    };
    subpaths.into_iter().filter_map(stem).collect()
}

/// Nodes along cubics, close enough that straight lines between them are near.
fn nodes(cubics: &[CubicBez]) -> Vec<Node> {
    const PER_CURVE: usize = 48;
    let mut nodes: Vec<Node> = Vec::new();
    let mut s = 0.0;
    for cubic in cubics {
        let deriv = cubic.deriv();
        for k in 0..=PER_CURVE {
            let t = k as f64 / PER_CURVE as f64;
            let d = deriv.eval(t).to_vec2();
            let p = cubic.eval(t);
            let Some(last) = nodes.last() else {
                // A handle may lie on its node.
                let along = start_tangent((*cubic).into());
                let curvature = if d.hypot() > 0.0 { cubic.curvature(t) } else { 0.0 };
                nodes.push(Node { s, p, along, curvature });
                continue;
            };
            if k == 0 || d.hypot() == 0.0 {
                continue;
            }
            // Simpson's rule between two parameters.
            let h = 1.0 / PER_CURVE as f64;
            let speed = |t: f64| deriv.eval(t).to_vec2().hypot();
            let piece = h / 6.0 * (speed(t - h) + 4.0 * speed(t - 0.5 * h) + speed(t));
            if piece <= 1e-9 * (s + last.p.to_vec2().hypot()) {
                continue;
            }
            s += piece;
            nodes.push(Node { s, p, along: d.normalize(), curvature: cubic.curvature(t) });
        }
    }
    nodes
}

/// One curl from a place (or from the bottom of the shape) upwards, as long as fits.
pub(super) fn curl(plant: &Plant, ground: &Ground, seed: Option<Point>, longest: f64) -> Option<Stem> {
    let side = if plant.params.curl == "right" { 1.0 } else { -1.0 };
    let starts: Vec<Point> = match seed {
        Some(at) => vec![at],
        None => bottom(ground, plant.sizes.edge + plant.sizes.width),
    };
    let form = plant.form(0);
    let taper = plant.taper(plant.sizes.width);
    let mut length = longest;
    while length > 12.0 * plant.sizes.width {
        for &at in &starts {
            for heading in [0.0, 0.35, -0.35, 0.7, -0.7, 1.2, -1.2] {
                let along = unit(heading - std::f64::consts::FRAC_PI_2);
                let pose = Pose::new(&Node { s: 0.0, p: at, along, curvature: 0.0 }, length, side);
                let nodes: Vec<Node> = form.nodes.iter().map(|node| pose.node(node)).collect();
                if plant.way(nodes.iter().copied(), form.length() * length, &taper, None).is_some() {
                    let stem = Stem::new(0, None, side, nodes, taper);
                    if fits_period(plant, &stem) {
                        return Some(stem);
                    }
                }
            }
        }
        length *= 0.92;
    }
    None
}

/// Places along the bottom of the free cells, from the middle outwards.
fn bottom(Ground { cells, clear, .. }: &Ground, from_wall: f64) -> Vec<Point> {
    let free: Vec<Point> =
        (0..clear.len()).filter(|&i| clear[i] > from_wall).map(|i| cells.middle(i)).collect();
    let Some(&first) = free.first() else { return Vec::new() };
    let bounds = free.iter().fold(Rect::from_points(first, first), |bounds, &p| bounds.union_pt(p));
    (0..=6)
        .flat_map(|k| [f64::from(k), -f64::from(k)])
        .filter_map(|k| {
            let x = bounds.center().x + k / 12.0 * bounds.width();
            let column = free.iter().filter(|p| (p.x - x).abs() <= 0.6 * cells.size());
            column.copied().max_by(|a, b| a.y.total_cmp(&b.y))
        })
        .collect()
}

/// A wave from the left end of a band to its right end, with a whole number of periods: as high as fits.
pub(super) fn wave(plant: &Plant, (left, width): (f64, f64), inradius: f64) -> Option<Stem> {
    let (clear, columns) = plant.cells.clearances();
    let middles = (0..clear.len()).step_by(columns).map(|i| plant.cells.middle(i).y);
    // The row that is farthest from anything at the left end is the middle of the band.
    let at = |row: usize| clear[row * columns + columns / 2];
    let row = (0..clear.len() / columns).max_by(|&a, &b| at(a).total_cmp(&at(b)))?;
    let middle = middles.clone().nth(row)?;
    const LONG: f64 = 4.4;
    const HIGH: [f64; 5] = [0.46, 0.42, 0.38, 0.33, 0.27];
    let periods = (width / (LONG * inradius)).round().max(1.0);
    const PER_PERIOD: usize = 8;
    let n = periods as usize * PER_PERIOD;
    let wave = |high: f64| {
        let point = |i: usize| {
            let up = libm::sin(std::f64::consts::TAU * (i % PER_PERIOD) as f64 / PER_PERIOD as f64);
            Point::new(left + width * i as f64 / n as f64, middle - high * inradius * up)
        };
        let mut path = BezPath::new();
        path.move_to(point(0));
        (1..=n).for_each(|i| path.line_to(point(i)));
        let stem = drawn(&path, plant.main_taper()).pop()?;
        part_inside(&plant.cells, &stem).filter(|part| part.length() > 0.99 * stem.length())
    };
    HIGH.into_iter().find_map(wave)
}

/// A few cells, for a first look at what is free.
pub(super) struct Ground {
    pub cells: Cells,
    /// Distance from each cell to the next thing, in user units.
    clear: Vec<f64>,
    columns: usize,
    /// Radius of the largest circle that is free.
    pub inradius: f64,
}

impl Ground {
    pub fn new(cells: Cells) -> Self {
        let (mut clear, columns) = cells.clearances();
        clear.iter_mut().for_each(|d| *d = d.sqrt() * cells.size());
        let inradius = clear.iter().copied().fold(0.0, f64::max);
        Ground { cells, clear, columns, inradius }
    }

    /// What of it is left.
    pub fn less(&self, taken: &Cells) -> Self {
        Ground::new(self.cells.less(taken))
    }
}

/// What a shape offers a wandering particle: its free area in squares.
struct Country<'a> {
    cells: &'a Cells,
    /// Distance to the next thing, in user units.
    clear: &'a [f64],
    /// Side of a square in cells.
    coarse: usize,
    columns: usize,
    /// True for squares that are free.
    free: Vec<bool>,
    squares: usize,
}

impl<'a> Country<'a> {
    fn new(&Ground { ref cells, ref clear, columns, .. }: &'a Ground, reach: f64) -> Self {
        let coarse = ((reach / 4.0 / cells.size()) as usize).max(1);
        let width = columns.div_ceil(coarse);
        let mut free = vec![false; width * (clear.len() / columns).div_ceil(coarse)];
        for (i, &clear) in clear.iter().enumerate() {
            if clear > cells.size() {
                free[i / columns / coarse * width + i % columns / coarse] = true;
            }
        }
        let squares = free.iter().filter(|&&free| free).count();
        Country { cells, clear, coarse, columns, free, squares }
    }

    fn clearance(&self, at: Point) -> f64 {
        self.cells.cell(at).map_or(0.0, |i| self.clear[i])
    }

    /// Which way the space opens.
    fn uphill(&self, at: Point) -> Vec2 {
        let h = 2.0 * self.cells.size();
        Vec2::new(
            self.clearance(at + Vec2::new(h, 0.0)) - self.clearance(at - Vec2::new(h, 0.0)),
            self.clearance(at + Vec2::new(0.0, h)) - self.clearance(at - Vec2::new(0.0, h)),
        )
    }

    /// Marks the squares within a radius; returns how many are new.
    fn cover(&self, at: Point, reach: f64, covered: &mut [bool]) -> usize {
        let Some(cell) = self.cells.cell(at) else { return 0 };
        let width = self.columns.div_ceil(self.coarse) as i64;
        let (column, row) =
            ((cell % self.columns / self.coarse) as i64, (cell / self.columns / self.coarse) as i64);
        let r = (reach / (self.coarse as f64 * self.cells.size())) as i64;
        let mut new = 0;
        for y in row - r..=row + r {
            for x in (column - r).max(0)..=(column + r).min(width - 1) {
                let near = (x - column).pow(2) + (y - row).pow(2) <= r * r;
                if let Some(i) = usize::try_from(y * width + x).ok().filter(|&i| near && i < covered.len())
                    && self.free[i]
                    && !covered[i]
                {
                    covered[i] = true;
                    new += 1;
                }
            }
        }
        new
    }
}

/// A stem that finds its way through what is still free of a shape. `seed` is where it starts,
/// if the artist says.
pub(super) fn wander(
    plant: &Plant,
    (whole, free): (&Ground, &Ground),
    (seed, tries): (Option<Point>, usize),
    rng: &mut Rng,
) -> Option<Stem> {
    let inradius = free.inradius;
    let reach = 0.95 * inradius;
    let country = Country::new(free, reach);
    let width = plant.sizes.width;
    // It grows from the wall, not from the middle of the air or from another plant.
    let starts: Vec<Point> = (0..country.clear.len())
        .filter(|&i| {
            let from_wall = whole.clear[i] - plant.sizes.edge - width;
            from_wall > 0.0 && from_wall < 2.5 * whole.cells.size() && country.clear[i] > width
        })
        .map(|i| whole.cells.middle(i))
        .collect();
    let bounds = starts.iter().fold(Rect::from_points(*starts.first()?, starts[0]), |b, &p| b.union_pt(p));
    let mut best: Option<(f64, Vec<Node>)> = None;
    for _ in 0..tries {
        let index = (rng.unit() * starts.len() as f64) as usize;
        let at = seed.or(starts.get(index).copied())?;
        let (score, nodes) = particle(&country, at, reach, 0.75 * width + plant.sizes.edge, rng);
        // Plants grow from the ground, if it makes no great difference.
        let score = score + 0.2 * (at.y - bounds.y0) / bounds.height().max(f64::MIN_POSITIVE);
        if nodes.len() > 8 && best.as_ref().is_none_or(|(other, _)| score > *other) {
            best = Some((score, nodes));
        }
    }
    let (_, nodes) = best?;
    let taper = Taper { start: width, tip: 0.34 * width, power: plant.params.taper.max(1e-3) };
    let stem = free_part(plant, Stem::new(0, None, 1.0, nodes, taper))?;
    Some(curled(plant, stem, 5.0 * inradius))
}

/// Runs one particle, which ends where it comes `nearest` to a wall; what it comes near, less
/// what it bends, is its score.
fn particle(country: &Country, at: Point, reach: f64, nearest: f64, rng: &mut Rng) -> (f64, Vec<Node>) {
    let step = reach / 14.0;
    let inwards = country.uphill(at);
    let start = libm::atan2(inwards.y, inwards.x) + rng.between(-1.1, 1.1);
    let (period, phase) = (rng.between(3.2, 8.0) * reach, rng.between(0.0, std::f64::consts::TAU));
    let charge = rng.between(0.25, 1.05) / reach;
    let (mut p, mut heading, mut s) = (at, start, 0.0);
    let mut covered = vec![false; country.free.len()];
    let (mut new, mut bending, mut stale) = (0, 0.0, 0.0);
    let mut nodes: Vec<Node> = Vec::new();
    // A way longer than this fills the shape with stem.
    let longest =
        0.8 * country.squares as f64 * (country.coarse as f64 * country.cells.size()).powi(2) / reach;
    while s < longest.max(4.0 * reach) && stale < 2.2 * reach {
        let along = unit(heading);
        let clear = country.clearance(p);
        // Coming back to itself it ends.
        let near_itself = |node: &Node| s - node.s > 2.6 * reach && node.p.distance(p) < 0.92 * reach;
        if clear < nearest || nodes.iter().any(near_itself) {
            break;
        }
        let meander = charge * libm::sin(std::f64::consts::TAU * s / period + phase);
        // The field that turns it back grows towards the wall (M-039).
        let close = (1.0 - clear / (0.62 * reach)).max(0.0);
        let uphill = country.uphill(p);
        let turn_to = along.cross(uphill);
        let grade = uphill.hypot().max(f64::MIN_POSITIVE);
        let heads_out = (0.35 - along.dot(uphill) / grade).max(0.0);
        let wall = 3.4 / reach * close * heads_out * if turn_to >= 0.0 { 1.0 } else { -1.0 };
        let curvature = (meander + wall).clamp(-1.7 / reach, 1.7 / reach);
        // Smoothed, so that the wall is a push and not a knock.
        let before = nodes.last().map_or(curvature, |node| node.curvature);
        let curvature = before + 0.35 * (curvature - before);
        nodes.push(Node { s, p, along, curvature });
        let found = country.cover(p, reach, &mut covered);
        stale = if found > 0 { 0.0 } else { stale + step };
        new += found;
        bending += curvature * curvature * step;
        p += step * unit(heading + 0.5 * step * curvature);
        heading += step * curvature;
        s += step;
    }
    (new as f64 / country.squares.max(1) as f64 - 0.006 * bending * reach, nodes)
}

/// The start of a stem up to where it would touch something: the rough cells that it found its
/// way through do not know exactly.
fn free_part(plant: &Plant, stem: Stem) -> Option<Stem> {
    const SHORTEST: f64 = 6.0;
    let cells = &plant.cells;
    let step = cells.size();
    let count = (stem.length() / step) as usize;
    let is_free = |k: &usize| {
        let s = *k as f64 * step;
        cells.allows(stem.at(s).p, stem.width(s) / 2.0, step, |_, _| false)
    };
    let first = (0..=count).find(is_free)?;
    let last = (first..=count).take_while(is_free).last()?;
    let (from, to) = (first as f64 * step, (last as f64 * step).min(stem.length()));
    if to - from < SHORTEST * stem.taper.start {
        return None;
    }
    Some(stem.part(from, to)).filter(|stem| fits_period(plant, stem))
}

/// True unless a stem would meet its own copies in what repeats.
fn fits_period(plant: &Plant, stem: &Stem) -> bool {
    plant.period.is_none_or(|period| stem.span() + plant.sizes.gap < period)
}

/// Lets a stem go over into the largest curl that fits near its end.
fn curled(plant: &Plant, stem: Stem, longest: f64) -> Stem {
    let full = stem.length();
    let form = plant.form(1.min(plant.params.levels - 1));
    let mut best: Option<(f64, f64, f64, f64)> = None;
    for k in 0..14 {
        let s = full * (1.0 - 0.045 * f64::from(k));
        let start = stem.at(s);
        let width = stem.width(s);
        let taper = Taper { start: width, tip: 0.5 * width, power: 1.0 };
        for side in [1.0, -1.0] {
            let mut length = longest;
            while length > 10.0 * width {
                let pose = Pose::new(&start, length, side);
                let nodes = form.nodes.iter().map(|node| pose.node(node));
                // It must keep away from the stem's own way to it as well.
                let apart = |node: &Node| {
                    stem.nodes.iter().all(|own| {
                        let along = s - own.s + node.s;
                        own.s > s
                            || along < 0.3 * length
                            || own.p.distance(node.p) > 2.5 * width + plant.sizes.gap
                    })
                };
                let free = !plant.is_taken(form, &pose)
                    && form.nodes.iter().step_by(3).all(|node| apart(&pose.node(node)));
                let crosses_nothing = |met: Vec<super::grow::Met>| met.is_empty();
                if free && plant.way(nodes, form.length() * length, &taper, None).is_some_and(crosses_nothing)
                {
                    // A longer curl is worth some of the way.
                    let score = length - 0.8 * (full - s);
                    if best.is_none_or(|(other, ..)| score > other) {
                        best = Some((score, s, side, length));
                    }
                    break;
                }
                length *= 0.9;
            }
        }
    }
    let Some((_, s, side, length)) = best else { return stem };
    let mut nodes = stem.between(0.0, s);
    let pose = Pose::new(&stem.at(s), length, side);
    nodes.extend(form.nodes.iter().skip(1).map(|node| {
        let node = pose.node(node);
        Node { s: node.s + s, ..node }
    }));
    // The way to the curl is wider now than when it was tried: the whole is longer.
    let curled = Stem::new(0, None, side, nodes, stem.taper);
    let length = curled.length();
    match free_part(plant, curled) {
        Some(whole) if whole.length() > 0.9 * length => whole,
        _ => stem,
    }
}

/// Width of the stem that another starts on.
pub(super) fn width_of_parent(stems: &[Stem], stem: &Stem) -> Option<f64> {
    let start = stem.nodes.first()?.p;
    stems.iter().find_map(|other| {
        let distance = |node: &Node| node.p.distance(start);
        let nearest = other.nodes.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
        let width = other.width(nearest.s);
        // Where both start together neither leaves the other.
        (distance(nearest) < 0.6 * width && nearest.s > width).then_some(width)
    })
}

/// The longest part of a stem that lies in the region. `None` if nothing of it does.
pub(super) fn part_inside(cells: &Cells, stem: &Stem) -> Option<Stem> {
    let is_inside = |node: &Node| cells.is_inside(node.p, stem.width(node.s) / 2.0);
    let mut best: Option<(f64, f64)> = None;
    for run in stem.nodes.chunk_by(|a, b| is_inside(a) == is_inside(b)) {
        let (from, to) = (run[0].s, run[run.len() - 1].s);
        if is_inside(&run[0]) && best.is_none_or(|(a, b)| to - from > b - a) {
            best = Some((from, to));
        }
    }
    let (from, to) = best.filter(|(from, to)| to - from > 2.0 * stem.taper.start)?;
    Some(stem.part(from, to))
}
