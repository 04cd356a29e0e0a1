//! Streamlines: a box of 1000 by 1000 with lines 5 apart, in which npm `@anvaka/streamlines` 1.5 takes 1.9 s
//! for 212,000 points, and boxes with fewer and more of them. Bending: what a point of bent artwork costs.

use divan::Bencher;
use divan::counter::ItemsCount;
use kurbo::{BezPath, Circle, Point, Rect, Shape};
use rinceau::field::{DirectionField, StreamlineParams, Tracer};
use rinceau::geom::bend::Bend;
use rinceau::geom::flatten::flatten;
use rinceau::geom::region::Region;
use rinceau::geom::spline::{Curve, Profile};
use rinceau::rng::Rng;

/// The program's.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() {
    divan::main();
}

/// A box, and a flow around two centres in it.
fn flow() -> (Region, DirectionField) {
    let corners = [(0.0, 0.0), (1000.0, 0.0), (1000.0, 1000.0), (0.0, 1000.0)].map(Point::from);
    let region = Region::new(vec![corners.to_vec()]).unwrap();
    let circle = |x: f64, y: f64| -> Vec<Point> {
        flatten(&Circle::new((x, y), 180.0).to_path(0.1), 0.5).swap_remove(0).points
    };
    let field = DirectionField::new(&region, &[circle(280.0, 300.0), circle(700.0, 650.0)], 8.0).unwrap();
    (region, field)
}

/// Traces the box until no more line goes in.
fn trace(region: &Region, flow: &DirectionField, spacing: f64) -> usize {
    let params =
        StreamlineParams { spacing, min_length: 2.0 * spacing, max_length: 1e6, end_gap: 0.5 * spacing };
    let mut tracer = Tracer::new(region, flow, params, Rng::new(1), usize::MAX);
    let step = 3.0 * spacing;
    for i in 0..(1000.0 / step) as usize {
        for j in 0..(1000.0 / step) as usize {
            tracer.seed(Point::new((i as f64 + 0.5) * step, (j as f64 + 0.5) * step), 0.0);
        }
    }
    tracer.run(|_| true);
    tracer.into_lines().iter().map(|line| line.points.len()).sum()
}

#[divan::bench(args = [16.0, 5.0, 1.6], max_time = 10)]
fn streamlines(bencher: Bencher, spacing: f64) {
    let (region, flow) = flow();
    let points = trace(&region, &flow, spacing);
    bencher.counter(ItemsCount::new(points)).bench(|| trace(&region, &flow, spacing));
}

/// A leaf of four curves with eight veins, along a spine that turns.
#[divan::bench(max_time = 5)]
fn bending(bencher: Bencher) {
    let mut leaf = BezPath::from_svg("M0,0C0.2,12 0.5,14 1,0C0.5,-14 0.2,-12 0,0Z").unwrap();
    for k in 1..9 {
        let u = f64::from(k) / 10.0;
        leaf.extend(Rect::new(u, -6.0, u + 0.02, 6.0).to_path(0.1));
    }
    let points: Vec<Point> =
        (0..12).map(|k| Point::new(10.0 * f64::from(k), 30.0 * (f64::from(k) / 4.0).sin())).collect();
    let bend = Bend {
        warps: Vec::new(),
        spine: Curve::near(&points),
        width: (Profile::constant(1.0), Profile::constant(1.1)),
        curvature: (Profile::constant(0.05), Profile::constant(0.05)),
        blend: 2.0,
    };
    let bent = || {
        let mut out = BezPath::new();
        bend.path(&leaf, 0.02, &mut out);
        out
    };
    // A curve of the output has three points.
    let count = 3 * bent().segments().count();
    bencher.counter(ItemsCount::new(count)).bench(bent);
}
