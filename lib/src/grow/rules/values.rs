//! Points, directions, elements and proxies as rules see them (checklist W-065, W-069, W-070,
//! W-080).

use super::engine::{Answer, Shared, wrong};
use crate::grow::piece::{Kind, MOST_CORNERS, Proxy};
use crate::grow::space::Circle;
use crate::grow::world::World;
use kurbo::{CubicBez, Point, Vec2};
use rhai::{Array, Dynamic, Engine, FLOAT, INT, ImmutableString};

/// Corners of all polygons that one application of a rule sets, at most.
const MOST_CORNERS_AT_ONCE: usize = 5000;

/// A step from one point to another: a direction with a length. It knows where it starts, so that it
/// can be taken for the point that it leads to.
#[derive(Clone, Copy, Debug)]
pub(super) struct Direction {
    pub tail: Point,
    pub by: Vec2,
}

impl Direction {
    pub fn new(by: Vec2) -> Self {
        Direction { tail: Point::ORIGIN, by }
    }

    pub fn of_angle(angle: f64) -> Self {
        Direction::new(Vec2::new(libm::cos(angle), libm::sin(angle)))
    }

    fn turned(self, angle: f64) -> Self {
        let (sin, cos) = (libm::sin(angle), libm::cos(angle));
        let by = Vec2::new(cos * self.by.x - sin * self.by.y, sin * self.by.x + cos * self.by.y);
        Direction { by, ..self }
    }

    fn unit(self) -> Vec2 {
        let length = self.by.hypot();
        if length > 0.0 { self.by / length } else { Vec2::new(1.0, 0.0) }
    }
}

/// An element by its serial number, which stays what it is whatever becomes of the element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ElementRef(pub u32);

/// A proxy of an element.
#[derive(Clone, Copy, Debug)]
pub(super) struct ProxyRef {
    pub element: u32,
    pub proxy: usize,
}

/// Where an element is.
pub(super) fn place_of(world: &World, serial: u32) -> Answer<usize> {
    world.find(serial).ok_or_else(|| wrong("the element is no more: its rule failed, or did not add it"))
}

/// A number, whole or not.
pub(super) fn number(value: &Dynamic) -> Answer<f64> {
    if let Ok(number) = value.as_float() {
        return Ok(number);
    }
    value.as_int().map(|n| n as f64).map_err(|kind| wrong(format!("a number is wanted, not {kind}")))
}

pub(super) fn point(shared: &Shared, value: &Dynamic) -> Answer<Point> {
    if let Some(point) = value.clone().try_cast::<Point>() {
        return Ok(point);
    }
    if let Some(direction) = value.clone().try_cast::<Direction>() {
        return Ok(direction.tail + direction.by);
    }
    if let Some(circle) = value.clone().try_cast::<Circle>() {
        return Ok(circle.center);
    }
    let proxy = match (value.clone().try_cast::<ProxyRef>(), value.clone().try_cast::<ElementRef>()) {
        (Some(proxy), _) => Some(proxy),
        (_, Some(element)) => Some(ProxyRef { element: element.0, proxy: 0 }),
        _ => None,
    };
    match proxy {
        Some(proxy) => center(&get(shared, proxy)?),
        None => Err(wrong(format!("a point is wanted, not {}", value.type_name()))),
    }
}

fn center(proxy: &Proxy) -> Answer<Point> {
    Ok(match proxy {
        Proxy::Point(p) | Proxy::Circle(p, _) | Proxy::Arc(p, ..) => *p,
        Proxy::Line(a, b) => a.midpoint(*b),
        Proxy::Bezier(_) => proxy.point(0.5),
        Proxy::Polygon(points) => {
            let sum = points.iter().fold(Vec2::ZERO, |sum, p| sum + p.to_vec2());
            (sum / points.len().max(1) as f64).to_point()
        }
    })
}

/// A direction, or an angle in radians.
pub(super) fn direction(value: &Dynamic) -> Answer<Direction> {
    match value.clone().try_cast::<Direction>() {
        Some(direction) => Ok(direction),
        None => number(value).map(Direction::of_angle),
    }
}

/// A proxy in its place.
pub(super) fn get(shared: &Shared, at: ProxyRef) -> Answer<Proxy> {
    let state = shared.borrow();
    let element = &state.world.elements[place_of(&state.world, at.element)?];
    match element.proxies.get(at.proxy) {
        Some(Some(proxy)) => Ok(proxy.clone()),
        Some(None) => Err(wrong("this proxy has not been set yet")),
        None => Err(no_proxy(at.proxy)),
    }
}

fn no_proxy(number: usize) -> Box<rhai::EvalAltResult> {
    match number {
        usize::MAX => wrong("proxies are counted from 0"),
        number => wrong(format!("the element has no proxy number {number}")),
    }
}

fn kind_of(shared: &Shared, at: ProxyRef) -> Answer<Kind> {
    let state = shared.borrow();
    let kind = state.world.elements[place_of(&state.world, at.element)?].kind;
    state.world.kinds[kind].proxies.get(at.proxy).copied().ok_or_else(|| no_proxy(at.proxy))
}

fn put(shared: &Shared, at: ProxyRef, proxy: Proxy) -> Answer<()> {
    let mut state = shared.borrow_mut();
    let world = &mut state.world;
    let place = place_of(world, at.element)?;
    if place < world.placed {
        return Err(wrong("a placed element stays as it is: set the new ones"));
    }
    if let Proxy::Polygon(corners) = &proxy {
        world.corners += corners.len();
        if world.corners > MOST_CORNERS_AT_ONCE {
            return Err(wrong(format!("the rule sets more than {MOST_CORNERS_AT_ONCE} corners at once")));
        }
    }
    world.elements[place].proxies[at.proxy] = Some(proxy);
    Ok(())
}

/// `set`, whatever the proxy is.
fn set(shared: &Shared, at: ProxyRef, values: &[&Dynamic]) -> Answer<()> {
    let p = |i: usize| point(shared, values[i]);
    let n = |i: usize| number(values[i]);
    let kind = kind_of(shared, at)?;
    let proxy = match (kind, values.len()) {
        (Kind::Point, 1) => Proxy::Point(p(0)?),
        (Kind::Circle, 2) => Proxy::Circle(p(0)?, n(1)?.abs()),
        (Kind::Line, 2) => Proxy::Line(p(0)?, p(1)?),
        (Kind::Arc, 4) => {
            let angle = |value: &Dynamic| -> Answer<f64> {
                match value.clone().try_cast::<Direction>() {
                    Some(direction) => Ok(libm::atan2(direction.by.y, direction.by.x)),
                    None => number(value),
                }
            };
            let (from, to) = (angle(values[2])?, angle(values[3])?);
            Proxy::Arc(p(0)?, n(1)?.abs(), from, to - from)
        }
        (Kind::Bezier, 4) => Proxy::Bezier(CubicBez::new(p(0)?, p(1)?, p(2)?, p(3)?)),
        (Kind::Bezier, 6) => {
            // Tangents are as long as their magnitude says, in lengths of the chord.
            let (a, b) = (p(0)?, p(3)?);
            let chord = a.distance(b);
            let start = direction(values[1])?.unit() * (n(2)? * chord);
            let end = direction(values[4])?.unit() * (n(5)? * chord);
            Proxy::Bezier(CubicBez::new(a, a + start, b - end, b))
        }
        (Kind::Polygon, 1) => {
            let corners = values[0].clone().try_cast::<Array>().unwrap_or_default();
            if !(3..=MOST_CORNERS).contains(&corners.len()) {
                return Err(wrong(format!("a polygon is set to an array of 3 to {MOST_CORNERS} points")));
            }
            let points: Answer<Vec<Point>> = corners.iter().map(|corner| point(shared, corner)).collect();
            Proxy::Polygon(points?)
        }
        (kind, count) => {
            let takes = match kind {
                Kind::Point => "a point",
                Kind::Circle => "a centre and a radius",
                Kind::Line => "two points",
                Kind::Arc => "a centre, a radius and two angles",
                Kind::Bezier => "four points, or point, tangent and magnitude of both ends",
                Kind::Polygon => "an array of points",
            };
            return Err(wrong(format!("a {} is set to {takes}, not to {count} values", kind.name())));
        }
    };
    put(shared, at, proxy)
}

/// A field of a proxy.
fn proxy_field(shared: &Shared, at: ProxyRef, name: &str) -> Answer<Dynamic> {
    let proxy = get(shared, at)?;
    let from_point = |p: Point| Ok(Dynamic::from(p));
    match (name, &proxy) {
        ("center" | "middle", _) => from_point(center(&proxy)?),
        ("radius", Proxy::Circle(_, r) | Proxy::Arc(_, r, ..)) => Ok((*r).into()),
        ("radius", _) => Ok(0.0.into()),
        ("p0" | "start", _) => from_point(if proxy.is_line() { proxy.point(0.0) } else { proxy.start() }),
        ("p1" | "end", _) => from_point(if proxy.is_line() { proxy.point(1.0) } else { proxy.start() }),
        ("c", Proxy::Bezier(c)) => {
            let points: Array = [c.p0, c.p1, c.p2, c.p3].into_iter().map(Dynamic::from).collect();
            Ok(points.into())
        }
        ("x", _) => Ok(center(&proxy)?.x.into()),
        ("y", _) => Ok(center(&proxy)?.y.into()),
        ("length", _) => {
            const STEPS: usize = 32;
            let at = |i: usize| proxy.point(i as f64 / STEPS as f64);
            let length: f64 = (0..STEPS).map(|i| at(i).distance(at(i + 1))).sum();
            Ok(length.into())
        }
        _ => Err(wrong(format!("a proxy of this kind has no '{name}'"))),
    }
}

/// A field of an element: its own, a standard one, or one of its first proxy.
fn element_field(shared: &Shared, element: ElementRef, name: &str) -> Answer<Dynamic> {
    {
        let state = shared.borrow();
        let place = place_of(&state.world, element.0)?;
        let of = &state.world.elements[place];
        let kind = &state.world.kinds[of.kind];
        if let Some(i) = kind.fields.iter().position(|(field, _)| field == name) {
            return Ok(of.fields[i].clone());
        }
        match name {
            "sterile" => return Ok(of.sterile.into()),
            "children" => return Ok((of.children.len() as INT).into()),
            "generation" => return Ok(INT::from(of.generation).into()),
            "number" => return Ok((place as INT).into()),
            "type" => return Ok(kind.name.clone().into()),
            "parent" => {
                let parent = state.world.elements.get(of.parent as usize);
                return Ok(parent.map_or(Dynamic::UNIT, |parent| Dynamic::from(ElementRef(parent.serial))));
            }
            _ => {}
        }
    }
    proxy_field(shared, ProxyRef { element: element.0, proxy: 0 }, name)
}

fn set_element_field(shared: &Shared, element: ElementRef, name: &str, value: Dynamic) -> Answer<()> {
    let mut state = shared.borrow_mut();
    let world = &mut state.world;
    let place = place_of(world, element.0)?;
    let of = &mut world.elements[place];
    let kind = &world.kinds[of.kind];
    if let Some(i) = kind.fields.iter().position(|(field, _)| field == name) {
        if !(value.is_int() || value.is_float() || value.is_bool()) {
            return Err(wrong(format!("a field holds a number, true or false, not {}", value.type_name())));
        }
        of.fields[i] = value;
        return Ok(());
    }
    if name == "sterile" {
        of.sterile = value.as_bool().unwrap_or_else(|_| value.as_int().is_ok_and(|n| n != 0));
        return Ok(());
    }
    let sentence = format!("the element type '{}' has no field '{name}' that can be set", kind.name);
    drop(state);
    // The language hands back what a method was called on, unchanged.
    match element_field(shared, element, name) {
        Ok(known) if is_same(&known, &value) => Ok(()),
        _ => Err(wrong(sentence)),
    }
}

fn is_same(a: &Dynamic, b: &Dynamic) -> bool {
    match (a.clone().try_cast::<Point>(), b.clone().try_cast::<Point>()) {
        (Some(a), Some(b)) => a == b,
        _ => a.type_id() == b.type_id() && (a.is_array() || a.to_string() == b.to_string()),
    }
}

/// Points and directions.
fn register_points(engine: &mut Engine, shared: &Shared) {
    engine.register_type_with_name::<Point>("Point");
    engine.register_type_with_name::<Direction>("Direction");
    engine.register_get("x", |p: &mut Point| p.x).register_get("y", |p: &mut Point| p.y);
    engine.register_get("x", |d: &mut Direction| d.by.x).register_get("y", |d: &mut Direction| d.by.y);
    engine.register_get("length", |d: &mut Direction| d.by.hypot());
    engine.register_get("angle", |d: &mut Direction| libm::atan2(d.by.y, d.by.x));
    engine.register_fn("-", |a: Point, b: Point| Direction { tail: b, by: a - b });
    engine.register_fn("+", |p: Point, d: Direction| p + d.by);
    engine.register_fn("-", |p: Point, d: Direction| p - d.by);
    engine.register_fn("+", |a: Direction, b: Direction| Direction { by: a.by + b.by, ..a });
    engine.register_fn("-", |a: Direction, b: Direction| Direction { by: a.by - b.by, ..a });
    engine.register_fn("-", |d: Direction| Direction { by: -d.by, ..d });
    // A number is added to a direction as an angle.
    engine.register_fn("+", |d: Direction, angle: FLOAT| d.turned(angle));
    engine.register_fn("-", |d: Direction, angle: FLOAT| d.turned(-angle));
    engine.register_fn("+", |d: Direction, angle: INT| d.turned(angle as f64));
    engine.register_fn("-", |d: Direction, angle: INT| d.turned(-(angle as f64)));
    engine.register_fn("*", |d: Direction, by: FLOAT| Direction { by: d.by * by, ..d });
    engine.register_fn("*", |d: Direction, by: INT| Direction { by: d.by * by as f64, ..d });
    engine.register_fn("*", |by: FLOAT, d: Direction| Direction { by: d.by * by, ..d });
    engine.register_fn("/", |d: Direction, by: FLOAT| Direction { by: d.by / by, ..d });
    engine.register_fn("/", |d: Direction, by: INT| Direction { by: d.by / by as f64, ..d });
    engine.register_fn("length", |d: Direction| d.by.hypot());
    engine.register_fn("unit", |d: Direction| Direction { by: d.unit(), ..d });
    engine.register_fn("cross", |a: Direction, b: Direction| a.by.cross(b.by));
    engine.register_fn("dot", |a: Direction, b: Direction| a.by.dot(b.by));
    engine.register_fn("offset", |p: &mut Point, d: Direction, by: FLOAT| *p + d.unit() * by);
    engine.register_fn("offset", |p: &mut Point, d: Direction, by: INT| *p + d.unit() * by as f64);
    engine.register_fn("offset", |p: &mut Point, angle: FLOAT, by: FLOAT| {
        *p + Direction::of_angle(angle).by * by
    });
    engine.register_fn("middle", |a: Point, b: Point| a.midpoint(b));
    engine.register_fn("mix", |a: Point, b: Point, t: FLOAT| a.lerp(b, t));
    engine.register_fn("direction", Direction::of_angle);
    let state = shared.clone();
    engine.register_fn("distance", move |a: Dynamic, b: Dynamic| -> Answer<f64> {
        Ok(point(&state, &a)?.distance(point(&state, &b)?))
    });
    engine.register_fn("point", |x: Dynamic, y: Dynamic| -> Answer<Point> {
        Ok(Point::new(number(&x)?, number(&y)?))
    });
    let state = shared.clone();
    engine.register_fn("to_point", move |value: Dynamic| point(&state, &value));
    engine.register_fn("to_number", |value: Dynamic| number(&value));
    engine.register_fn("to_whole", |value: Dynamic| number(&value).map(|n| n as INT));
}

/// Elements and proxies.
fn register_elements(engine: &mut Engine, shared: &Shared) {
    engine.register_type_with_name::<ElementRef>("Element");
    engine.register_type_with_name::<ProxyRef>("Proxy");
    engine.register_type_with_name::<Circle>("Circle");
    engine.register_get("center", |c: &mut Circle| c.center);
    engine.register_get("radius", |c: &mut Circle| c.radius);
    engine.register_fn("==", |a: ElementRef, b: ElementRef| a == b);
    engine.register_fn("!=", |a: ElementRef, b: ElementRef| a != b);
    engine.register_fn("proxy", |e: &mut ElementRef, k: INT| ProxyRef {
        element: e.0,
        proxy: usize::try_from(k).unwrap_or(usize::MAX),
    });
    let state = shared.clone();
    engine.register_get("center", move |p: &mut ProxyRef| center(&get(&state, *p)?));
    let state = shared.clone();
    engine
        .register_indexer_get(move |p: &mut ProxyRef, name: ImmutableString| proxy_field(&state, *p, &name));
    let state = shared.clone();
    engine.register_indexer_get(move |e: &mut ElementRef, name: ImmutableString| {
        element_field(&state, *e, &name)
    });
    let state = shared.clone();
    engine.register_indexer_set(move |e: &mut ElementRef, name: ImmutableString, value: Dynamic| {
        set_element_field(&state, *e, &name, value)
    });
    register_sets::<ProxyRef>(engine, shared, |p| *p);
    register_sets::<ElementRef>(engine, shared, |e| ProxyRef { element: e.0, proxy: 0 });
}

/// What can be done with a proxy, and with an element for its first one.
fn register_sets<T: Clone + 'static>(engine: &mut Engine, shared: &Shared, of: fn(&T) -> ProxyRef) {
    let state = shared.clone();
    engine.register_fn("set", move |p: &mut T, a: Dynamic| set(&state, of(p), &[&a]));
    let state = shared.clone();
    engine.register_fn("set", move |p: &mut T, a: Dynamic, b: Dynamic| set(&state, of(p), &[&a, &b]));
    let state = shared.clone();
    engine.register_fn("set", move |p: &mut T, a: Dynamic, b: Dynamic, c: Dynamic, d: Dynamic| {
        set(&state, of(p), &[&a, &b, &c, &d])
    });
    let state = shared.clone();
    engine.register_fn(
        "set",
        move |p: &mut T, a: Dynamic, b: Dynamic, c: Dynamic, d: Dynamic, e: Dynamic, f: Dynamic| {
            set(&state, of(p), &[&a, &b, &c, &d, &e, &f])
        },
    );
    let state = shared.clone();
    engine.register_fn("at", move |p: &mut T, t: Dynamic| -> Answer<Point> {
        Ok(get(&state, of(p))?.point(number(&t)?))
    });
    let state = shared.clone();
    engine.register_fn("tangent", move |p: &mut T, t: Dynamic| -> Answer<Direction> {
        let proxy = get(&state, of(p))?;
        let t = number(&t)?;
        Ok(Direction { tail: proxy.point(t), by: proxy.tangent(t) })
    });
}

pub(super) fn register(engine: &mut Engine, shared: &Shared) {
    register_points(engine, shared);
    register_elements(engine, shared);
}
