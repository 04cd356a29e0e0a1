//! What rules may ask of their surroundings (000 3.2, 4.2; checklist W-065, W-038 to W-040).

use super::engine::{Answer, MOST_CHILDREN, Shared, wrong};
use super::values::{Direction, ElementRef, ProxyRef, direction, get, number, place_of, point};
use crate::geom::region::Region;
use crate::grow::piece::{Piece, Proxy};
use crate::grow::space::Circle;
use crate::grow::world::World;
use kurbo::{Point, Vec2};
use rhai::{Array, Dynamic, Engine, FLOAT, INT, ImmutableString, Map};

/// Places of the outline, found once.
#[derive(Clone, Debug, Default)]
pub(super) struct Places {
    corners: Option<Vec<(Point, Vec2)>>,
    bends: Option<Vec<Point>>,
    skeleton: Option<Vec<Circle>>,
}

/// Corners of an outline: where it turns sharply, and the way inside from there.
pub(in crate::grow) fn corners(region: &Region) -> Vec<(Point, Vec2)> {
    // Less is a curve's flattening, or a dent.
    const SHARP: f64 = 0.6;
    let mut corners = Vec::new();
    for contour in region.contours() {
        let n = contour.len();
        for i in 0..n {
            let (a, b, c) = (contour[(i + n - 1) % n], contour[i], contour[(i + 1) % n]);
            let (u, v) = (b - a, c - b);
            let turn = libm::atan2(u.cross(v), u.dot(v));
            let inwards = unit(v) - unit(u);
            if turn.abs() > SHARP && region.contains(b + 1e-3 * region.bounds().width() * unit(inwards)) {
                corners.push((b, unit(inwards)));
            }
        }
    }
    corners
}

fn unit(v: Vec2) -> Vec2 {
    let length = v.hypot();
    if length > 0.0 { v / length } else { Vec2::ZERO }
}

/// Where an outline bends most: of each bulge or bay the sharpest place.
fn bends(region: &Region) -> Vec<Point> {
    let mut found = Vec::new();
    for contour in region.contours() {
        const SAMPLES: usize = 240;
        const AROUND: usize = 6;
        let closed: Vec<Point> = contour.iter().chain(contour.first()).copied().collect();
        let points = crate::geom::polyline::resample(&closed, SAMPLES);
        let turn = |i: usize| {
            let at = |k: usize| points[(i + SAMPLES + k - AROUND) % SAMPLES];
            let (u, v) = (at(AROUND) - at(0), at(2 * AROUND) - at(AROUND));
            libm::atan2(u.cross(v), u.dot(v)).abs()
        };
        let turns: Vec<f64> = (0..SAMPLES).map(turn).collect();
        for i in 0..SAMPLES {
            let around = |k: usize| turns[(i + SAMPLES + k - AROUND) % SAMPLES];
            let is_peak = (0..=2 * AROUND).all(|k| match k.cmp(&AROUND) {
                std::cmp::Ordering::Less => around(k) < turns[i],
                _ => around(k) <= turns[i],
            });
            if is_peak && turns[i] > 0.35 {
                found.push(points[i]);
            }
        }
    }
    found
}

/// Middles of circles that touch the outline on two sides.
fn skeleton(world: &World, region: &Region) -> Vec<Circle> {
    const SIDE: usize = 64;
    let (bounds, reach) = (region.bounds(), region.bounds().size().max_side());
    let step = reach / SIDE as f64;
    let (columns, rows) =
        ((bounds.width() / step).ceil() as usize + 1, (bounds.height() / step).ceil() as usize + 1);
    let at = |i: usize| bounds.origin() + Vec2::new((i % columns) as f64 * step, (i / columns) as f64 * step);
    let distance = |p: Point| if region.contains(p) { region.distance(p, reach) } else { 0.0 };
    let values: Vec<f64> = (0..columns * rows).map(|i| distance(at(i))).collect();
    let _ = world;
    (0..columns * rows)
        .filter(|&i| {
            let (x, y) = (i % columns, i / columns);
            if x == 0 || y == 0 || x + 1 == columns || y + 1 == rows || values[i] <= step {
                return false;
            }
            // A ridge: along some line through it, both sides are lower.
            [
                (i - 1, i + 1),
                (i - columns, i + columns),
                (i - columns - 1, i + columns + 1),
                (i - columns + 1, i + columns - 1),
            ]
            .into_iter()
            .any(|(a, b)| values[a] < values[i] - 0.2 * step && values[b] <= values[i] - 0.2 * step)
        })
        .map(|i| Circle { center: at(i), radius: values[i] })
        .collect()
}

/// The nearest point of the outline, and the direction along it.
fn boundary(region: &Region, at: Point) -> Option<(Point, Vec2)> {
    let mut best: Option<(f64, Point, Vec2)> = None;
    for contour in region.contours() {
        for i in 0..contour.len() {
            let (p, q) = (contour[i], contour[(i + 1) % contour.len()]);
            let d = q - p;
            let t = ((at - p).dot(d) / d.hypot2().max(1e-300)).clamp(0.0, 1.0);
            let near = p + t * d;
            let distance = near.distance_squared(at);
            if best.is_none_or(|(least, ..)| distance < least) {
                best = Some((distance, near, d));
            }
        }
    }
    best.map(|(_, p, d)| (p, d))
}

fn register_outline(engine: &mut Engine, shared: &Shared) {
    let state = shared.clone();
    engine.register_fn("inside", move |p: Dynamic| -> Answer<bool> {
        let p = point(&state, &p)?;
        Ok(state.borrow().world.region.as_ref().is_none_or(|region| region.contains(p)))
    });
    let state = shared.clone();
    engine.register_fn("boundary_distance", move |p: Dynamic| -> Answer<f64> {
        let p = point(&state, &p)?;
        Ok(state.borrow().world.wall_distance(p))
    });
    let state = shared.clone();
    engine.register_fn("boundary_point", move |p: Dynamic| -> Answer<Dynamic> {
        let p = point(&state, &p)?;
        let near = state.borrow().world.region.as_ref().and_then(|region| boundary(region, p));
        Ok(near.map_or(Dynamic::UNIT, |(p, _)| Dynamic::from(p)))
    });
    let state = shared.clone();
    engine.register_fn("boundary_tangent", move |p: Dynamic| -> Answer<Direction> {
        let p = point(&state, &p)?;
        let near = state.borrow().world.region.as_ref().and_then(|region| boundary(region, p));
        Ok(near.map_or(Direction::of_angle(0.0), |(tail, by)| Direction { tail, by }))
    });
    let state = shared.clone();
    engine.register_fn("corners", move || -> Array {
        let mut state = state.borrow_mut();
        if state.places.corners.is_none() {
            state.places.corners = Some(state.world.region.as_ref().map(corners).unwrap_or_default());
        }
        let corner = |&(at, into): &(Point, Vec2)| {
            let map = Map::from_iter([
                ("at".into(), Dynamic::from(at)),
                ("inwards".into(), Dynamic::from(Direction { tail: at, by: into })),
            ]);
            Dynamic::from(map)
        };
        state.places.corners.iter().flatten().map(corner).collect()
    });
    let state = shared.clone();
    engine.register_fn("curvature_points", move || -> Array {
        let mut state = state.borrow_mut();
        if state.places.bends.is_none() {
            state.places.bends = Some(state.world.region.as_ref().map(bends).unwrap_or_default());
        }
        state.places.bends.iter().flatten().map(|&p| Dynamic::from(p)).collect()
    });
    let state = shared.clone();
    engine.register_fn("skeleton_point", move |p: Dynamic| -> Answer<Dynamic> {
        let p = point(&state, &p)?;
        let mut state = state.borrow_mut();
        if state.places.skeleton.is_none() {
            let found = state.world.region.as_ref().map(|region| skeleton(&state.world, region));
            state.places.skeleton = Some(found.unwrap_or_default());
        }
        let circles = state.places.skeleton.iter().flatten();
        let nearest = circles.min_by(|a, b| a.center.distance(p).total_cmp(&b.center.distance(p)));
        Ok(nearest.map_or(Dynamic::UNIT, |circle| Dynamic::from(*circle)))
    });
}

fn register_ornament(engine: &mut Engine, shared: &Shared) {
    for name in ["intersection", "intersects"] {
        let state = shared.clone();
        engine.register_fn(name, move |e: ElementRef| is_in_the_way(&state, e.0));
        let state = shared.clone();
        engine.register_fn(name, move |p: ProxyRef| is_in_the_way(&state, p.element));
    }
    let state = shared.clone();
    engine.register_fn("nearest", move |kind: ImmutableString, p: Dynamic| -> Answer<Dynamic> {
        let index = kind_index(&state, &kind)?;
        nearest(&state, Some(index), &p)
    });
    let state = shared.clone();
    engine.register_fn("nearest", move |p: Dynamic| nearest(&state, None, &p));
    let state = shared.clone();
    engine.register_fn("clearance", move |p: ProxyRef, reach: Dynamic| -> Answer<f64> {
        let proxy = get(&state, p)?;
        clear(&state, &proxy, &reach)
    });
    let state = shared.clone();
    engine.register_fn("clearance", move |e: ElementRef, reach: Dynamic| -> Answer<f64> {
        let proxy = get(&state, ProxyRef { element: e.0, proxy: 0 })?;
        clear(&state, &proxy, &reach)
    });
    // Room around a place: the radius of the empty circle there.
    let state = shared.clone();
    engine.register_fn("room", move |p: Dynamic| -> Answer<f64> {
        let p = point(&state, &p)?;
        Ok(state.borrow().world.space.distance(p).unwrap_or(0.0))
    });
    let state = shared.clone();
    engine.register_fn("count", move |kind: ImmutableString| -> Answer<INT> {
        let index = kind_index(&state, &kind)?;
        let state = state.borrow();
        let placed = &state.world.elements[..state.world.placed];
        Ok(placed.iter().filter(|element| element.kind == index).count() as INT)
    });
    let state = shared.clone();
    engine.register_fn("clear_excluded", move || -> Answer<()> {
        let world = &mut state.borrow_mut().world;
        world.clearings += 1;
        if world.clearings > MOST_CLEARINGS {
            return Err(wrong(format!(
                "clear_excluded was called {MOST_CLEARINGS} times, and nothing has grown"
            )));
        }
        world.space.readmit_all();
        Ok(())
    });
    register_targets(engine, shared);
}

/// The fixed elements that growth may seek.
fn register_targets(engine: &mut Engine, shared: &Shared) {
    let state = shared.clone();
    engine.register_fn("targets", move || -> Array {
        let state = state.borrow();
        state.targets.iter().map(|(_, circle)| Dynamic::from(*circle)).collect()
    });
    let state = shared.clone();
    engine.register_fn("targets", move |kind: ImmutableString| -> Array {
        let state = state.borrow();
        let meant = state.targets.iter().filter(|(name, _)| *name == *kind);
        meant.map(|(_, circle)| Dynamic::from(*circle)).collect()
    });
}

/// The placed element, of one type or any, that is nearest to a place.
fn nearest(shared: &Shared, kind: Option<usize>, place: &Dynamic) -> Answer<Dynamic> {
    let at = point(shared, place)?;
    let mut state = shared.borrow_mut();
    let reach = state.world.bounds.size().to_vec2().hypot();
    let found = state.world.nearest(kind, at, reach);
    let reference = |(element, _)| ElementRef(state.world.elements[element as usize].serial);
    Ok(found.map_or(Dynamic::UNIT, |found| Dynamic::from(reference(found))))
}

fn kind_index(shared: &Shared, kind: &str) -> Answer<usize> {
    let state = shared.borrow();
    state
        .names
        .iter()
        .position(|name| name == kind)
        .ok_or_else(|| wrong(format!("no element type is called '{kind}'")))
}

/// Room along a proxy.
fn clear(shared: &Shared, proxy: &Proxy, reach: &Dynamic) -> Answer<f64> {
    let reach = number(reach)?.clamp(0.0, 1e6);
    let mut state = shared.borrow_mut();
    let without = state.parent;
    Ok(if proxy.is_sane() { state.world.clearance(proxy, without, reach) } else { 0.0 })
}

/// The exclude list may be cleared so often while nothing grows: once for each phase of a pattern.
const MOST_CLEARINGS: usize = 100;

/// True if a fresh element lies outside or over something placed.
fn is_in_the_way(shared: &Shared, element: u32) -> Answer<bool> {
    let mut state = shared.borrow_mut();
    let world = &mut state.world;
    let place = place_of(world, element)?;
    let proxies = world.elements[place].proxies.clone();
    if !proxies.iter().flatten().all(Proxy::is_sane) {
        return Ok(true);
    }
    let tolerance = 0.1 * world.space.cell();
    let pieces: Vec<Piece> = proxies.iter().flatten().flat_map(|proxy| proxy.pieces(tolerance)).collect();
    Ok(!pieces.iter().all(|piece| world.is_inside(piece)) || world.overlaps(&pieces, u32::MAX, false))
}

fn register_making(engine: &mut Engine, shared: &Shared) {
    let state = shared.clone();
    engine.register_fn("new_element", move |kind: ImmutableString| fresh(&state, &kind).map(|made| made.1));
    let state = shared.clone();
    engine.register_fn("new_child", move |e: ElementRef| -> Answer<()> {
        let world = &mut state.borrow_mut().world;
        let place = place_of(world, e.0)?;
        if place < world.placed {
            return Err(wrong("a placed element cannot become a child again"));
        }
        world.children.push(place as u32);
        Ok(())
    });
    // Both at once.
    let state = shared.clone();
    engine.register_fn("add", move |kind: ImmutableString| -> Answer<ElementRef> {
        let (place, element) = fresh(&state, &kind)?;
        state.borrow_mut().world.children.push(place);
        Ok(element)
    });
}

/// A new element of a type: its place, and a reference.
fn fresh(shared: &Shared, kind: &str) -> Answer<(u32, ElementRef)> {
    let index = kind_index(shared, kind)?;
    let mut state = shared.borrow_mut();
    let parent = state.parent;
    if parent == u32::MAX {
        return Err(wrong("elements are made by rules, not where variables are declared"));
    }
    if state.world.elements.len() - state.world.placed >= MOST_CHILDREN {
        return Err(wrong(format!("the rule makes more than {MOST_CHILDREN} elements at once")));
    }
    let place = state.world.fresh(index, parent);
    Ok((place, ElementRef(state.world.elements[place as usize].serial)))
}

fn register_numbers(engine: &mut Engine, shared: &Shared) {
    let state = shared.clone();
    engine.register_fn("random", move || state.borrow_mut().rng.unit());
    let state = shared.clone();
    engine.register_fn("random", move |low: Dynamic, high: Dynamic| -> Answer<f64> {
        let (low, high) = (number(&low)?, number(&high)?);
        Ok(state.borrow_mut().rng.between(low, high))
    });
    // The same bits on every machine, which the language's own functions do not promise.
    engine.register_fn("sin", |x: FLOAT| libm::sin(x));
    engine.register_fn("cos", |x: FLOAT| libm::cos(x));
    engine.register_fn("tan", |x: FLOAT| libm::tan(x));
    engine.register_fn("atan", |x: FLOAT| libm::atan(x));
    engine.register_fn("atan2", |y: FLOAT, x: FLOAT| libm::atan2(y, x));
    engine.register_fn("exp", |x: FLOAT| libm::exp(x));
    engine.register_fn("ln", |x: FLOAT| libm::log(x));
    engine.register_fn("log", |x: FLOAT| libm::log(x));
    engine.register_fn("pow", |x: Dynamic, y: Dynamic| -> Answer<f64> {
        Ok(libm::pow(number(&x)?, number(&y)?))
    });
    engine.register_fn("**", |x: FLOAT, y: FLOAT| libm::pow(x, y));
    engine.register_fn("**", |x: FLOAT, y: INT| libm::pow(x, y as f64));
    engine.register_fn("fabs", |x: Dynamic| -> Answer<f64> { Ok(number(&x)?.abs()) });
    engine.register_fn("clamp", |x: Dynamic, low: Dynamic, high: Dynamic| -> Answer<f64> {
        Ok(number(&x)?.max(number(&low)?).min(number(&high)?))
    });
    let state = shared.clone();
    engine.register_fn("offset", move |p: Dynamic, d: Dynamic, by: Dynamic| -> Answer<Point> {
        let (p, d) = (point(&state, &p)?, direction(&d)?);
        Ok(p + unit(d.by) * number(&by)?)
    });
    let state = shared.clone();
    engine.register_fn("panel", move || -> Map {
        let (bounds, section) = {
            let world = &state.borrow().world;
            (world.bounds, world.section)
        };
        let sides = [
            ("left", bounds.x0),
            ("top", bounds.y0),
            ("right", bounds.x1),
            ("bottom", bounds.y1),
            ("width", bounds.width()),
            ("height", bounds.height()),
        ];
        let mut map: Map = sides.into_iter().map(|(name, side)| (name.into(), side.into())).collect();
        map.insert("center".into(), Dynamic::from(bounds.center()));
        map.insert("section".into(), section.into());
        map
    });
}

pub(super) fn register(engine: &mut Engine, shared: &Shared) {
    register_outline(engine, shared);
    register_ornament(engine, shared);
    register_making(engine, shared);
    register_numbers(engine, shared);
}
