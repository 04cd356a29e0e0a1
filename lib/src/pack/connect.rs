//! One connected piece, for cutters: nothing thinner than the bridge width, and bridges of that width
//! from piece to piece.
//!
//! The core of a piece is where a disc of that width can be without leaving it; what such discs cover is the piece
//! without what is thinner. Cores are joined by lines, the edges of a shortest tree (Kruskal), in containers
//! as from one to the next. The one piece is what discs cover whose middles run through all cores and along all
//! lines, so the width holds everywhere, also where two parts of a piece had hung by a thinner neck.
//! Bridges go around what is fixed, unless nothing else joins what lies on both sides of it.

use crate::geom::boolean::{Contour, is_outer, offset, parts, signed_area, simplified, stroked};
use crate::geom::polyline::{self, simplified_closed};
use crate::geom::region::Region;
use crate::geom::segment::{foot, segment_segment};
use crate::geom::triangulate::delaunay;
use crate::ink::area_of;
use kurbo::{Affine, BezPath, Point};
use rayon::prelude::*;
use rinceau_format::{Artwork, Error, Group, Item, Part, Style};

/// Sublayers that become one piece.
const JOINED: [&str; 3] = ["elements", "fillers", "negative"];

/// Joins all that an artwork draws to one piece, in a sublayer of its own in their place. `width` is that of
/// bridges, `fixed` what they keep clear of, `tone` the colour of the piece. False, and nothing changed, if the
/// time ran out first. What is drawn in mirrored halves has mirrored bridges.
///
/// Errors: nothing is as thick as a bridge.
pub(super) fn join(
    artwork: &mut Artwork,
    fixed: &[Contour],
    ((width, tolerance), mirror): ((f64, f64), Option<Affine>),
    tone: &str,
    mut go_on: impl FnMut(f64) -> bool,
) -> Result<bool, Error> {
    // Arcs are made of chords, which lie inside them by a share of the radius.
    const ROUNDING: f64 = 0.02;
    let radius = 0.5 * width * (1.0 + ROUNDING) + tolerance;
    let is_joined = |group: &&Group| JOINED.contains(&group.name.as_str());
    let items: Vec<&Item> = artwork.groups.iter().filter(is_joined).flat_map(|group| &group.items).collect();
    // Where a disc of that radius can be without leaving the item.
    let core = |item: &&Item| -> Vec<Contour> {
        let covered: Vec<Contour> =
            item.parts.iter().flat_map(|part| area_of(part, 0.5 * tolerance)).collect();
        // Nothing that is done here goes beyond its box: offsets far larger than a shape would take long.
        let sides = polyline::bounds(covered.iter().flatten().copied()).unwrap_or_default().size();
        if sides.min_side() < 2.0 * radius {
            return Vec::new();
        }
        // Slits that are narrower than a bridge would cut a leaf into its ribs.
        let grown = light(offset(&light(simplified(&covered, false), tolerance), 0.5 * width), tolerance);
        let closed = light(offset(&grown, -0.5 * width), tolerance);
        light(offset(&closed, -radius), tolerance)
    };
    let (mut cores, mut too_thin) = (Vec::new(), 0);
    const ASK_EVERY: usize = 128;
    for (index, items_ahead) in items.chunks(ASK_EVERY).enumerate() {
        if !go_on((index * ASK_EVERY) as f64 / items.len() as f64) {
            return Ok(false);
        }
        let all: Vec<Vec<Contour>> = items_ahead.par_iter().map(core).collect();
        too_thin += all.iter().filter(|contours| contours.is_empty()).count();
        cores.extend(all.into_iter().flat_map(parts));
    }
    if cores.is_empty() {
        let remedy = "Set the bridge width (--bridge) lower, or the element width (--spacing) higher";
        return Err(Error::new("bridge-too-wide", "No element is as thick as a bridge", remedy));
    }
    // Finer than the outlines themselves, samples would tell nothing.
    let fixed = Region::new(fixed.to_vec());
    let crosses = |[p, q]: [Point; 2]| {
        let too_near = |a, b| segment_segment(p, q, a, b) < radius;
        fixed.as_ref().is_some_and(|fixed| {
            let mut is_clear = !fixed.contains(p);
            fixed.edges().visit(p, q, radius, |a, b, _| {
                is_clear &= !too_near(a, b);
                is_clear
            });
            !is_clear
        })
    };
    let step = (0.5 * width).max(4.0 * tolerance);
    let (bridges, crossing) = match mirror {
        Some(mirror) => mirrored_bridges(&cores, step, crosses, mirror),
        None => bridges(&cores, step, crosses),
    };
    let path = united(&cores, &bridges, radius, tolerance);
    let part = Part { path, transform: Affine::IDENTITY, style: Style::filled(tone) };
    artwork.groups.retain(|group| !is_joined(&group));
    let items = vec![Item::new("piece", vec![part])];
    artwork.groups.insert(0, Group { name: "piece".into(), items, ..Group::default() });
    artwork.counts.insert("bridges".into(), bridges.len() as f64);
    artwork.counts.insert("too-thin".into(), too_thin as f64);
    if too_thin > 0 {
        artwork
            .warnings
            .push(format!("{too_thin} shapes are thinner than a bridge and were left out of the piece"));
    }
    if crossing > 0 {
        let cross = if crossing == 1 { "bridge crosses" } else { "bridges cross" };
        artwork.warnings.push(format!(
            "{crossing} {cross} what is fixed, since nothing else joins the piece on both sides of it"
        ));
    }
    Ok(true)
}

/// The outline of all that discs of a radius cover whose middles lie in cores or on bridges.
fn united(cores: &[Vec<Contour>], bridges: &[[Point; 2]], radius: f64, tolerance: f64) -> BezPath {
    let grown: Vec<Vec<Contour>> =
        cores.par_iter().map(|core| light(offset(core, radius), tolerance)).collect();
    let mut all: Vec<Contour> = grown.into_iter().flatten().collect();
    all.extend(bridges.iter().flat_map(|bridge| stroked(bridge, false, 2.0 * radius)));
    let mut path = BezPath::new();
    // A hole that a bridge would fill is a speck.
    let least = radius * radius;
    let one = simplified(&all, false);
    for contour in one.into_iter().filter(|contour| is_outer(contour) || -signed_area(contour) >= least) {
        let contour = simplified_closed(&contour, 0.25 * tolerance);
        path.move_to(contour[0]);
        contour[1..].iter().for_each(|&p| path.line_to(p));
        path.close_path();
    }
    path
}

/// Contours without the points that nobody would miss: offsets cost more than their number.
fn light(contours: Vec<Contour>, tolerance: f64) -> Vec<Contour> {
    let lighter = contours.iter().map(|contour| simplified_closed(contour, 0.5 * tolerance));
    lighter.filter(|contour| contour.len() > 2).collect()
}

/// The shortest bridges that join all cores, of which those that cross what they should not come last, and how
/// many these are: a shortest tree is among the edges of a Delaunay triangulation of their samples.
fn bridges(
    cores: &[Vec<Contour>],
    step: f64,
    crosses: impl Fn([Point; 2]) -> bool,
) -> (Vec<[Point; 2]>, usize) {
    let (mut samples, mut of) = (Vec::new(), Vec::new());
    for (node, contours) in cores.iter().enumerate() {
        for contour in contours {
            let closed: Vec<Point> = contour.iter().chain(contour.first()).copied().collect();
            let steps = (polyline::length(&closed) / step).ceil().clamp(3.0, 1e5) as usize;
            samples.extend(polyline::resample(&closed, steps).into_iter().skip(1));
            of.resize(samples.len(), node);
        }
    }
    let mut edges: Vec<(f64, usize, usize)> = delaunay(&samples)
        .into_iter()
        .flat_map(|[a, b, c]| [(a, b), (b, c), (c, a)])
        .filter(|&(a, b)| of[a] != of[b])
        .map(|(a, b)| (samples[a].distance_squared(samples[b]), a.min(b), a.max(b)))
        .collect();
    edges.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let mut sets = Sets((0..cores.len()).collect());
    let mut bridges = Vec::new();
    for &(_, a, b) in &edges {
        let plain = [samples[a], samples[b]];
        if sets.find(of[a]) == sets.find(of[b]) || crosses(plain) {
            continue;
        }
        let shortest = nearest(&cores[of[a]], &cores[of[b]], samples[b]);
        bridges.push(if crosses(shortest) { plain } else { shortest });
        sets.join(of[a], of[b]);
    }
    let clear = bridges.len();
    let across = edges.iter().filter(|&&(_, a, b)| sets.join(of[a], of[b]));
    bridges.extend(across.map(|&(_, a, b)| nearest(&cores[of[a]], &cores[of[b]], samples[b])));
    let crossing = bridges.len() - clear;
    (bridges, crossing)
}

/// Bridges in one half, their images in the other, and two across the axis, each its own image: halves that
/// hang together in one place would swing.
fn mirrored_bridges(
    cores: &[Vec<Contour>],
    step: f64,
    crosses: impl Fn([Point; 2]) -> bool,
    mirror: Affine,
) -> (Vec<[Point; 2]>, usize) {
    let to_image = |p: Point| mirror * p - p;
    let image = |[p, q]: [Point; 2]| [mirror * p, mirror * q];
    let Some(&first) = cores.iter().flatten().flatten().next() else { return (Vec::new(), 0) };
    let is_here = |core: &&Vec<Contour>| to_image(core[0][0]).dot(to_image(first)) > 0.0;
    let half: Vec<Vec<Contour>> = cores.iter().filter(is_here).cloned().collect();
    let (mut bridges, crossing) = bridges(&half, step, |bridge| crosses(bridge) || crosses(image(bridge)));
    let images: Vec<[Point; 2]> = bridges.iter().map(|&bridge| image(bridge)).collect();
    bridges.extend(images);
    // Where each comes nearest to the axis.
    let near = |a: &&Point, b: &&Point| to_image(**a).hypot2().total_cmp(&to_image(**b).hypot2());
    let mut over: Vec<[Point; 2]> =
        half.iter().filter_map(|core| core.iter().flatten().min_by(near)).map(|&p| [p, mirror * p]).collect();
    over.sort_by(|a, b| a[0].distance_squared(a[1]).total_cmp(&b[0].distance_squared(b[1])));
    let length = |bridge: &[Point; 2]| bridge[0].distance(bridge[1]);
    let mut clear = over.iter().filter(|&&bridge| !crosses(bridge));
    let shortest = clear.next();
    bridges.extend(shortest.or(over.first()));
    if let Some(one) = shortest {
        let short = clear.take_while(|bridge| length(bridge) <= 2.0 * length(one));
        let from_it = |bridge: &[Point; 2]| bridge[0].distance_squared(one[0]);
        bridges.extend(short.max_by(|a, b| from_it(a).total_cmp(&from_it(b))));
    }
    (bridges, 2 * crossing + usize::from(shortest.is_none()))
}

/// The nearest places of two cores, from a place on the second that is nearly one of them.
fn nearest(first: &[Contour], second: &[Contour], mut q: Point) -> [Point; 2] {
    const ROUNDS: usize = 8;
    let mut p = q;
    for _ in 0..ROUNDS {
        p = nearest_on(first, q);
        q = nearest_on(second, p);
    }
    [p, q]
}

/// The place on some contours that is nearest to another.
fn nearest_on(contours: &[Contour], at: Point) -> Point {
    let mut best = (f64::INFINITY, at);
    for contour in contours {
        let Some(&last) = contour.last() else { continue };
        let mut previous = last;
        for &p in contour {
            let on = foot(at, previous, p);
            let squared = on.distance_squared(at);
            if squared < best.0 {
                best = (squared, on);
            }
            previous = p;
        }
    }
    best.1
}

/// Disjoint sets.
struct Sets(Vec<usize>);

impl Sets {
    fn find(&mut self, mut i: usize) -> usize {
        while self.0[i] != i {
            self.0[i] = self.0[self.0[i]];
            i = self.0[i];
        }
        i
    }

    /// True if they were not joined before.
    fn join(&mut self, a: usize, b: usize) -> bool {
        let (a, b) = (self.find(a), self.find(b));
        self.0[a] = b;
        a != b
    }
}
