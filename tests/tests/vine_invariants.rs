//! Promises of vines that hold for any drawing: inside the container, fixed areas clear, no two
//! branches touching but where one forks, clip art on its own stem alone, plait-work over and
//! under in turn, copies of what repeats side by side without a seam, the same bytes for the
//! same seed.
//!
//! The checks know nothing of cells: they read outlines and centre lines of the artwork. Who is
//! whose parent they see from where a centre line starts.

mod support;

use kurbo::{BezPath, Point, Rect, Vec2};
use proptest::prelude::*;
use rinceau::geom::flatten::flatten;
use rinceau::geom::region::Region;
use rinceau::geom::segment::{SegmentGrid, crosses, point_segment};
use rinceau_format::{Artwork, Container, Scene};
use std::collections::HashSet;
use support::geometry::*;

/// A centre line starts on that of its parent, but for rounding and chords: so much of the
/// drawing's size.
const ON_LINE: f64 = 3e-4;
/// And this, in user units: a hundredth of the thinnest stem that is asked for.
const LEAST_ON_LINE: f64 = 0.03;
/// Curves are as exact as that, in widths of the widest stem a fifth of its way along, where the
/// strongest taper has halved it: 1/250 of the full width, and rounding.
const EXACT: f64 = 1.0 / 100.0;

/// How far a branch's edge may stand out of its parent's at the fork, in widths of the parent.
const BULGE: f64 = 0.25;

/// So near where a branch leaves, in widths of the parent, both are one.
const FORK: f64 = 3.0;

/// A stem as drawn.
struct Stem {
    outline: Piece,
    /// Its centre line; several where it is cut.
    line: Piece,
    start: Point,
    length: f64,
    is_main: bool,
    parent: Option<usize>,
    /// The parent's width where this leaves it.
    fork_width: f64,
}

impl Stem {
    fn moved(&self, by: Vec2) -> Self {
        Stem {
            outline: moved(&self.outline, by),
            line: moved(&self.line, by),
            start: self.start + by,
            ..*self
        }
    }
}

/// All that has grown.
struct Plant {
    stems: Vec<Stem>,
    elements: Vec<Piece>,
    /// The main stems are an artist's, who may let them touch.
    drawn: bool,
}

impl Plant {
    fn read(artwork: &Artwork, drawn_stems: bool) -> Self {
        let open = |path: &BezPath| flatten(path, 0.004).into_iter().map(|subpath| subpath.points).collect();
        let lines: Vec<Piece> =
            artwork.group("spines").unwrap().items.iter().map(|item| open(&item.parts[0].path)).collect();
        let all: Piece = lines.concat();
        let drawn = pieces(artwork, "stems");
        let items = &artwork.group("stems").unwrap().items;
        assert_eq!(drawn.len(), lines.len());
        let places = matched(&lines, &drawn);
        let outlines: Vec<Piece> = places.iter().map(|&place| drawn[place].clone()).collect();
        let is_main = |i: usize| items[places[i]].of == "stem";
        let width = |i: usize| 2.0 * depth(&outlines[i], part_way(&lines[i].concat(), 0.2));
        let widest = (0..lines.len()).map(width).fold(0.0, f64::max);
        let on_line = (ON_LINE * bounds(&all).size().max_side()).max(LEAST_ON_LINE).max(EXACT * widest);
        let parent = |i: usize| {
            let start = lines[i][0][0];
            // Of several, as where two branches leave a stem at one place, the one whose base is not there.
            let nearest = (0..lines.len())
                .filter(|&j| j != i && bounds(&lines[j]).inflate(on_line, on_line).contains(start))
                .map(|j| (along(&lines[j], start), j))
                .filter(|((distance, _), _)| *distance < on_line)
                .map(|((distance, s), j)| (s < 0.1 * length(&lines[j].concat()), distance, j))
                .min_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)))
                .map(|nearest| nearest.2);
            assert!(is_main(i) || nearest.is_some(), "branch {i} starts on no stem, at {start:?}");
            nearest
        };
        let parents: Vec<Option<usize>> = (0..lines.len()).map(parent).collect();
        let stem = |i: usize| Stem {
            start: lines[i][0][0],
            length: lines[i].iter().map(|line| length(line)).sum(),
            is_main: is_main(i),
            parent: parents[i],
            fork_width: parents[i]
                .map_or(0.0, |parent: usize| 2.0 * depth(&outlines[parent], lines[i][0][0])),
            outline: outlines[i].clone(),
            line: lines[i].clone(),
        };
        let stems: Vec<Stem> = (0..lines.len()).map(stem).collect();
        let elements = [pieces(artwork, "elements"), pieces(artwork, "flowers")].concat();
        Plant { stems, elements, drawn: drawn_stems }
    }

    /// This and, if it repeats, the copy beside it.
    fn copies(&self, period: Option<f64>) -> Vec<Plant> {
        let copy = |by: f64| Plant {
            stems: self.stems.iter().map(|stem| stem.moved(Vec2::new(by, 0.0))).collect(),
            elements: self.elements.iter().map(|element| moved(element, Vec2::new(by, 0.0))).collect(),
            drawn: self.drawn,
        };
        [0.0].into_iter().chain(period).map(copy).collect()
    }
}

/// An artwork that repeats, without the copies of what lies over its ends. Panics unless each of
/// those has one.
fn without_copies(artwork: &Artwork, (left, period): (f64, f64)) -> Artwork {
    let same = |a: Rect, b: Rect| {
        [a.x0 - b.x0, a.x1 - b.x1, a.y0 - b.y0, a.y1 - b.y1].iter().all(|d| d.abs() < 2.0 * SLACK)
    };
    let by = |rect: Rect, by: f64| rect + Vec2::new(by, 0.0);
    let mut artwork = artwork.clone();
    for name in ["stems", "elements", "flowers"] {
        let boxes: Vec<Rect> = pieces(&artwork, name).iter().map(|piece| bounds(piece)).collect();
        // A few periods away there is nothing.
        let shifts = || (-4..=4).filter(|&k| k != 0).map(|k| f64::from(k) * period);
        for &rect in boxes.iter().filter(|rect| rect.width() < period - SLACK) {
            for shift in shifts() {
                let moved = by(rect, shift);
                let is_over = moved.x1 > left + SLACK && moved.x0 < left + period - SLACK;
                let is_there = || boxes.iter().any(|&other| same(other, moved));
                assert!(!is_over || is_there(), "{name} at {rect:?} is missing {shift} to the right");
            }
        }
        let is_copy =
            |i: usize| boxes[..i].iter().any(|&first| shifts().any(|shift| same(by(first, shift), boxes[i])));
        let Some(group) = artwork.groups.iter_mut().find(|group| group.name == name) else { continue };
        let mut i = 0;
        group.items.retain(|_| {
            i += 1;
            !is_copy(i - 1)
        });
    }
    artwork
}

/// The outline around each centre line.
fn matched(lines: &[Piece], outlines: &[Piece]) -> Vec<usize> {
    let boxes: Vec<Rect> = outlines.iter().map(|outline| bounds(outline)).collect();
    // Not the ends, which may be cut askew, nor the half towards the tip, which may be thinner than
    // chords are exact.
    let samples = |line: &Piece| {
        let points = line.iter().max_by(|a, b| length(a).total_cmp(&length(b))).expect("a centre line");
        [0.15, 0.25, 0.35, 0.45].map(|share| part_way(points, share))
    };
    // Those around a line, the narrowest first: a twig may start within its parent.
    let around = |line: &Piece| {
        let samples = samples(line);
        let is_in = |j: &usize| samples.iter().all(|&p| boxes[*j].contains(p) && covers(&outlines[*j], p));
        let width = |j: usize| samples.iter().map(|&p| depth(&outlines[j], p)).sum::<f64>();
        let mut around: Vec<usize> = (0..outlines.len()).filter(is_in).collect();
        around.sort_by(|&a, &b| width(a).total_cmp(&width(b)));
        around
    };
    let around: Vec<Vec<usize>> = lines.iter().map(around).collect();
    // What has least to choose from chooses first.
    let mut order: Vec<usize> = (0..lines.len()).collect();
    order.sort_by_key(|&i| around[i].len());
    let mut places = vec![usize::MAX; lines.len()];
    for i in order {
        let free = around[i].iter().find(|place| !places.contains(place));
        places[i] = *free.unwrap_or_else(|| panic!("no outline is around the centre line {i}"));
    }
    places
}

fn moved(piece: &[Vec<Point>], by: Vec2) -> Piece {
    piece.iter().map(|contour| contour.iter().map(|&p| p + by).collect()).collect()
}

fn length(line: &[Point]) -> f64 {
    line.windows(2).map(|pair| pair[0].distance(pair[1])).sum()
}

/// The place at a share of the length of a line.
fn part_way(line: &[Point], share: f64) -> Point {
    let mut left = share * length(line);
    for pair in line.windows(2) {
        let step = pair[0].distance(pair[1]);
        if step > 0.0 && left <= step {
            return pair[0].lerp(pair[1], left / step);
        }
        left -= step;
    }
    line[line.len() - 1]
}

/// Distance of a place from a centre line, and the arc length of what is nearest; gaps count
/// as their chords.
fn along(line: &[Vec<Point>], at: Point) -> (f64, f64) {
    let points: Vec<Point> = line.concat();
    let mut best = (f64::INFINITY, 0.0);
    let mut s = 0.0;
    for pair in points.windows(2) {
        let d = pair[1] - pair[0];
        let distance = point_segment(at, pair[0], pair[1]);
        if distance < best.0 {
            let t = ((at - pair[0]).dot(d) / d.hypot2()).clamp(0.0, 1.0);
            best = (distance, s + t * d.hypot());
        }
        s += d.hypot();
    }
    best
}

/// Distance to the nearest outline.
fn depth(piece: &[Vec<Point>], at: Point) -> f64 {
    let distances = piece.iter().flat_map(|contour| sides(contour)).map(|(p, q)| point_segment(at, p, q));
    distances.fold(f64::INFINITY, f64::min)
}

/// True if a contour of the piece winds around a place.
fn covers(piece: &[Vec<Point>], at: Point) -> bool {
    piece.iter().any(|contour| {
        let mut winding = 0;
        for (p, q) in sides(contour) {
            let left = (q - p).cross(at - p) > 0.0;
            if p.y <= at.y && q.y > at.y && left {
                winding += 1;
            } else if p.y > at.y && q.y <= at.y && !left {
                winding -= 1;
            }
        }
        winding != 0
    })
}

/// Two things that touch.
struct Touch {
    a: usize,
    b: usize,
    at: Point,
}

/// Every place where outlines of two pieces cross, and every piece that lies within another.
fn touches(pieces: &[&Piece]) -> Vec<Touch> {
    let boxes: Vec<Rect> = pieces.iter().map(|piece| bounds(piece)).collect();
    let all = boxes.iter().copied().reduce(|a, b| a.union(b)).unwrap();
    let mut grid = SegmentGrid::new(all, all.size().max_side() / 150.0);
    for (i, piece) in pieces.iter().enumerate() {
        piece.iter().for_each(|contour| grid.insert_contour(contour, i as u32));
    }
    let mut found = Vec::new();
    for (a, piece) in pieces.iter().enumerate() {
        for (p, q) in piece.iter().flat_map(|contour| sides(contour)) {
            grid.visit(p, q, 0.0, |r, s, b| {
                let b = b as usize;
                if b > a && crosses(p, q, r, s) {
                    let (d, e) = (q - p, s - r);
                    found.push(Touch { a, b, at: p + (r - p).cross(e) / d.cross(e) * d });
                }
                true
            });
        }
    }
    let met: HashSet<(usize, usize)> = found.iter().map(|touch| (touch.a, touch.b)).collect();
    for a in 0..pieces.len() {
        for b in a + 1..pieces.len() {
            if !boxes[a].overlaps(boxes[b]) || met.contains(&(a, b)) {
                continue;
            }
            for (inner, outer) in [(a, b), (b, a)] {
                let at = pieces[inner][0][0];
                if boxes[outer].contains(at) && covers(pieces[outer], at) {
                    found.push(Touch { a, b, at });
                }
            }
        }
    }
    found
}

/// What a touch is between.
#[derive(Clone, Copy, Debug)]
enum Thing {
    /// Which copy, and which stem.
    Stem(usize, usize),
    Element(usize, usize),
}

/// Panics if anything touches what it should not. `gap` is the distance that was asked for.
fn assert_apart(plant: &Plant, gap: f64, period: Option<f64>) {
    let copies = plant.copies(period);
    let mut things = Vec::new();
    let mut all: Vec<&Piece> = Vec::new();
    for (copy, plant) in copies.iter().enumerate() {
        things.extend((0..plant.stems.len()).map(|i| Thing::Stem(copy, i)));
        all.extend(plant.stems.iter().map(|stem| &stem.outline));
        things.extend((0..plant.elements.len()).map(|i| Thing::Element(copy, i)));
        all.extend(plant.elements.iter());
    }
    let mut on: Vec<Vec<(usize, usize, Point)>> = vec![Vec::new(); plant.elements.len()];
    for Touch { a, b, at } in touches(&all) {
        match (things[a], things[b]) {
            (Thing::Stem(m, i), Thing::Stem(n, j)) => {
                let allowed = may_touch(&copies, (m, i), (n, j), at, gap);
                assert!(
                    allowed,
                    "stems {i} and {j}, children of {:?} and {:?}, touch at {at:?} (copies {m}, {n})",
                    plant.stems[i].parent, plant.stems[j].parent,
                );
            }
            (Thing::Element(_, i), Thing::Element(_, j)) => {
                // Opposite leaves may meet at the stem that they both grow from.
                let of_both = |stem: &Stem| covers(&stem.outline, at) || depth(&stem.outline, at) < gap;
                let hidden = copies.iter().flat_map(|copy| &copy.stems).any(of_both);
                assert!(hidden, "elements {i} and {j} touch at {at:?}");
            }
            (Thing::Stem(n, j), Thing::Element(m, i)) | (Thing::Element(m, i), Thing::Stem(n, j)) => {
                // In the frame of the first copy; what is among copies of a second is told twice.
                let back = Vec2::new(m as f64 * period.unwrap_or(0.0), 0.0);
                on[i].push((j, n.abs_diff(m), at - back));
            }
        }
    }
    for (i, on) in on.iter().enumerate() {
        assert!(!on.is_empty(), "element {i} is on no stem: {:?}", bounds(&plant.elements[i]));
        let within = |own: usize, at: Point| {
            let shifts = [0.0, period.unwrap_or(0.0), -period.unwrap_or(0.0)];
            shifts.into_iter().any(|by| is_within(&plant.stems[own].outline, at - Vec2::new(by, 0.0)))
        };
        // Where a branch forks, its edge bulges out of its parent's by a little, and what grows
        // at the fork itself grows on both.
        let forks = |own: usize, j: usize, at: Point| {
            let (a, b) = (&plant.stems[own], &plant.stems[j]);
            let width = a.fork_width.max(b.fork_width);
            let child = if a.parent == Some(j) { a } else { b };
            let is_fork = a.parent == Some(j) || b.parent == Some(own);
            is_fork && (depth(&a.outline, at) < BULGE * width || at.distance(child.start) < FORK * width)
        };
        let is_own =
            |own: usize| on.iter().all(|&(j, _, at)| j == own || within(own, at) || forks(own, j, at));
        assert!(on.iter().any(|&(own, ..)| is_own(own)), "element {i} touches several stems: {on:?}");
    }
}

fn is_within(outline: &[Vec<Point>], at: Point) -> bool {
    covers(outline, at) || depth(outline, at) < SLACK
}

/// True if two stems may touch at a place: a child its parent near its fork, siblings within
/// their parent, and a main stem that repeats itself at the seam.
fn may_touch(copies: &[Plant], (m, i): (usize, usize), (n, j): (usize, usize), at: Point, gap: f64) -> bool {
    let (a, b) = (&copies[m].stems[i], &copies[n].stems[j]);
    let near_fork =
        |child: &Stem| at.distance(child.start) <= 8.0 * (child.fork_width + gap) + 0.35 * child.length;
    if copies[0].drawn && a.is_main && b.is_main {
        return true;
    }
    if i == j {
        let later = if m > n { a } else { b };
        return a.is_main && at.distance(later.start) < 2.0 * depth(&a.outline, a.line[0][1]);
    }
    if a.parent == Some(j) {
        return near_fork(a);
    }
    if b.parent == Some(i) {
        return near_fork(b);
    }
    let Some(parent) = a.parent.filter(|_| a.parent == b.parent) else { return false };
    copies.iter().any(|copy| {
        let outline = &copy.stems[parent].outline;
        covers(outline, at) || depth(outline, at) < BULGE * a.fork_width.max(b.fork_width)
    })
}

/// Panics unless all lies inside the container and clear of what is fixed.
fn assert_in_place(plant: &Plant, container: &Region, edge: f64, fixed: &[Vec<Point>], gap: f64) {
    let stems = plant.stems.iter().map(|stem| &stem.outline);
    for (i, piece) in stems.chain(&plant.elements).enumerate() {
        let name = match i.checked_sub(plant.stems.len()) {
            None => format!("stem {i}"),
            Some(i) => format!("element {i}"),
        };
        assert_inside(&name, piece, container);
        for &p in piece.iter().flatten() {
            let apart = container.distance(p, edge);
            assert!(
                apart > edge - SLACK - 0.02 * edge,
                "{name} is {apart} from the outline at {p:?}, not {edge}"
            );
        }
        for circle in fixed {
            let apart = distance(piece, std::slice::from_ref(circle), gap);
            assert!(apart > gap - SLACK - 0.02 * gap, "{name} is {apart} from what is fixed, not {gap}");
        }
    }
}

/// Panics unless every stem that is cut goes under one other at each gap, and every stem goes
/// over and under in turn.
fn assert_plaited(plant: &Plant, crossings: f64) {
    let cuts: usize = plant.stems.iter().map(|stem| stem.line.len() - 1).sum();
    assert_eq!(cuts as f64, crossings, "cuts and crossings");
    let mut ways: Vec<Vec<(f64, bool)>> = vec![Vec::new(); plant.stems.len()];
    for (i, stem) in plant.stems.iter().enumerate() {
        assert_eq!(stem.outline.len(), stem.line.len(), "stem {i} has a gap in its centre line alone");
        for pair in stem.line.windows(2) {
            let (from, to) = (pair[0][pair[0].len() - 1], pair[1][0]);
            let is_over = |other: &Stem| {
                other.line.iter().any(|line| line.windows(2).any(|pair| crosses(from, to, pair[0], pair[1])))
            };
            let over: Vec<usize> =
                (0..plant.stems.len()).filter(|&j| j != i && is_over(&plant.stems[j])).collect();
            let [over] = over[..] else { panic!("stem {i} goes under {over:?} at {from:?}") };
            let middle = from.midpoint(to);
            ways[i].push((along(&stem.line, middle).1, false));
            ways[over].push((along(&plant.stems[over].line, middle).1, true));
        }
    }
    for (i, way) in ways.iter_mut().enumerate() {
        way.sort_by(|a, b| a.0.total_cmp(&b.0));
        let in_turn = way.windows(2).all(|pair| pair[0].1 != pair[1].1);
        assert!(in_turn, "stem {i} goes over (true) and under: {way:?}");
    }
}

type Params = Vec<(&'static str, String)>;

fn one_of(values: &'static [&'static str]) -> impl Strategy<Value = String> {
    prop::sample::select(values.to_vec()).prop_map(str::to_owned)
}

fn numbers(range: std::ops::Range<f64>) -> impl Strategy<Value = String> {
    prop::collection::vec(range, 1..4)
        .prop_map(|list| list.iter().map(|x| format!("{x:.2}")).collect::<Vec<_>>().join(","))
}

fn number(range: std::ops::Range<f64>) -> impl Strategy<Value = String> {
    range.prop_map(|x| format!("{x:.3}"))
}

prop_compose! {
    /// How curves run.
    fn curves()(
        levels in 1..6u8, turns in numbers(0.2..2.5), alpha in numbers(-1.0..1.5),
        charge in one_of(&["power", "power", "power", "constant", "sine", "triangle", "1 -1 2", "0.2 1 3"]),
        field in one_of(&["constant", "constant", "walls", "noise"]),
        integrator in one_of(&["exact", "exact", "exact", "euler"]),
        places in one_of(&["best", "best", "equal"]), rule in one_of(&["natural", "largest"]),
        stem in one_of(&["wander", "wander", "curl"]), curl in one_of(&["right", "left"]),
    ) -> Params {
        vec![
            ("levels", levels.to_string()), ("turns", turns), ("alpha", alpha), ("charge", charge),
            ("field", field), ("integrator", integrator), ("places", places), ("rule", rule),
            ("stem", stem), ("curl", curl),
        ]
    }
}

prop_compose! {
    /// How they are drawn and what grows on them. The gap and the edge come first.
    fn looks()(
        gap in number(0.4..4.0), edge in number(0.4..8.0), width in number(3.0..11.0),
        taper in number(0.0..3.0), tip_width in number(0.0..1.0), leaves in number(0.0..1.0),
        size in number(0.4..2.0),
        tips in one_of(&["flower", "bud", "leaf", "ball", "none", "flower,flower,bud", "leaf bud ball"]),
        forks in one_of(&["leaf", "leaf leaf bud", "bud", "none", "flower leaf,none,ball"]),
    ) -> Params {
        vec![
            ("gap", gap), ("edge", edge), ("stem-width", width), ("taper", taper), ("tip-width", tip_width),
            ("leaves", leaves), ("clip-art", size), ("tips", tips), ("forks", forks),
        ]
    }
}

fn drawing(container: &str) -> String {
    format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 400 400'>{container}</svg>")
}

/// Grows twice, which must give the same bytes. `None` if nothing fits.
fn grown(svg: &str, params: &Params, seed: u64) -> Option<(Scene, Artwork)> {
    // Shown only when a check fails: what to run to see it.
    let options: String = params.iter().map(|(name, value)| format!(" --{name}='{value}'")).collect();
    println!("{svg}\nrinceau vine --seed {seed}{options}");
    let (document, scene) = read(svg);
    let vine = || generated("vine", &scene, params, seed);
    let artwork = match vine() {
        Ok(artwork) => artwork,
        Err(error) => {
            assert_eq!(error.code(), "nothing-fits");
            return None;
        }
    };
    let again = vine().unwrap();
    let bytes = |artwork: &Artwork| written(&document, artwork, ("vine", params, seed)).to_bytes();
    assert!(bytes(&artwork) == bytes(&again), "two runs differ");
    assert!(artwork.complete);
    Some((scene, artwork))
}

fn value(params: &Params, name: &str) -> f64 {
    params.iter().find(|(own, _)| *own == name).unwrap().1.parse().unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(6), failure_persistence: None, rng_seed: rng_seed(), ..ProptestConfig::default() })]

    #[test]
    fn random_shapes_and_settings(
        outer in waves(), hole in waves(), hole_radius in 0.0..60.0f64, is_rectangle: bool,
        fixed_at in (130.0..270.0f64, 130.0..270.0f64), seed in 0..1000u64, curves in curves(), looks in looks(),
    ) {
        let hole = if hole_radius > 12.0 { blob((200.0, 200.0), hole_radius, &hole) } else { String::new() };
        let outer = if is_rectangle { "M40,60H360V330H40Z".to_owned() } else { blob((200.0, 200.0), 150.0, &outer) };
        let outline = format!("{outer}{hole}");
        let svg = drawing(&format!("<path id='c' class='rinceau-container' fill-rule='evenodd' d='{outline}'/><circle class='rinceau-fixed' cx='{}' cy='{}' r='15'/>", fixed_at.0, fixed_at.1));
        let params = [looks, curves].concat();
        let (gap, edge) = (value(&params, "gap"), value(&params, "edge"));
        if let Some((scene, artwork)) = grown(&svg, &params, seed) {
            let container = Region::new(contours(&BezPath::from_svg(&outline).unwrap())).unwrap();
            let plant = Plant::read(&artwork, !scene.stems.is_empty());
            assert_in_place(&plant, &container, edge, &[disc(fixed_at, 15.0)], gap);
            assert_apart(&plant, gap, None);
        }
    }

    #[test]
    fn plait_work_goes_over_and_under_in_turn(
        outer in waves(), seed in 0..1000u64, curves in curves(), looks in looks(),
    ) {
        let outline = blob((200.0, 200.0), 170.0, &outer);
        let svg = drawing(&format!("<path id='c' class='rinceau-container' d='{outline}'/>"));
        let params = [looks, curves, vec![("plait", "true".to_owned())]].concat();
        if let Some((scene, artwork)) = grown(&svg, &params, seed) {
            let plant = Plant::read(&artwork, !scene.stems.is_empty());
            let container = Region::new(contours(&BezPath::from_svg(&outline).unwrap())).unwrap();
            let gap = value(&params, "gap");
            assert_in_place(&plant, &container, value(&params, "edge"), &[], gap);
            assert_apart(&plant, gap, None);
            assert_plaited(&plant, artwork.counts["crossings"]);
        }
    }

    #[test]
    fn what_repeats_has_no_seam(
        size in (150.0..390.0f64, 60.0..200.0f64), fixed_at in (60.0..140.0f64, 60.0..140.0f64),
        seed in 0..1000u64, curves in curves(), looks in looks(),
    ) {
        let (width, height) = ((size.0 * 100.0).round() / 100.0, size.1);
        let svg = drawing(&format!("<rect id='c' class='rinceau-container' x='5' y='10' width='{width}' height='{height}'/><circle class='rinceau-fixed' cx='{}' cy='{}' r='8'/>", fixed_at.0, fixed_at.1));
        let params = [looks, curves, vec![("repeat", "true".to_owned())]].concat();
        if let Some((scene, artwork)) = grown(&svg, &params, seed) {
            let plant = Plant::read(&without_copies(&artwork, (5.0, width)), !scene.stems.is_empty());
            let band = Rect::new(5.0 - 3.0 * width, 10.0, 5.0 + 4.0 * width, 10.0 + height);
            let band = [(band.x0, band.y0), (band.x1, band.y0), (band.x1, band.y1), (band.x0, band.y1)];
            let container = Region::new(vec![band.map(Point::from).to_vec()]).unwrap();
            let circles = [-1.0, 0.0, 1.0].map(|k| disc((fixed_at.0 + k * width, fixed_at.1), 8.0));
            let gap = value(&params, "gap");
            assert_in_place(&plant, &container, value(&params, "edge"), &circles, gap);
            assert_apart(&plant, gap, Some(width));
        }
    }
}

#[test]
fn every_sample_keeps_its_promises() {
    for path in samples_of("vine") {
        let (document, scene) = read(std::fs::read(&path).unwrap());
        println!("{}", path.display());
        let vine = |seed| generated("vine", &scene, &[], seed).unwrap();
        let artwork = vine(1);
        assert!(artwork.complete);
        let region = |container: &Container| {
            Region::new(container.outlines.iter().flat_map(|outline| contours(&outline.path)).collect())
        };
        if let [container] = &scene.containers[..] {
            let region = region(container).unwrap();
            let repeats = container.overrides.get("repeat").is_some_and(|repeat| repeat == "true");
            let bounds = region.bounds();
            let artwork =
                if repeats { without_copies(&artwork, (bounds.x0, bounds.width())) } else { artwork.clone() };
            let plant = Plant::read(&artwork, !scene.stems.is_empty());
            if !repeats {
                assert_in_place(&plant, &region, 0.0, &[], 0.0);
            }
            assert_apart(&plant, 0.0, repeats.then(|| region.bounds().width()));
        }
        let bytes = |artwork: &Artwork, seed| written(&document, artwork, ("vine", &[], seed)).to_bytes();
        assert!(bytes(&artwork, 1) == bytes(&vine(1), 1), "two runs differ");
    }
}

#[test]
fn another_seed_is_another_picture() {
    let svg = drawing("<circle class='rinceau-container' cx='200' cy='200' r='150'/>");
    let outlines = |seed| format!("{:?}", grown(&svg, &Vec::new(), seed).unwrap().1.groups);
    assert!(outlines(1) != outlines(2));
}
