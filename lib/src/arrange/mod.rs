//! Arrangement by example: a drawn pattern that goes on.
//!
//! Takashi Ijiri, Radomír Měch, Takeo Igarashi, Gavin Miller: *An Example-based Procedural System
//! for Element Arrangement*, Computer Graphics Forum 27(2), 2008.
//!
//! 1. Find which elements of the example are neighbours (section 4, E-004 to E-009): `example`.
//! 2. Find where things may grow: shapes, sprayed strokes, boundaries, flow (section 3): `ground`.
//! 3. Let seeds grow one by one into the element whose neighbours in the example stand most like
//!    those around the seed (sections 5.1 to 5.4, E-020 to E-036): `grow`, `ring`.
//! 4. Between and after that let all rings come as near to the example's as they can (section 5.5,
//!    E-040 to E-043): `relax`.
//! 5. Draw the elements that lie in the shape, varied if asked for (E-003): `artwork`.
//!
//! Departures: growth starts again where some of the shape was not reached, so that a shape in
//! several pieces fills; relaxation runs each time the pattern has grown by a quarter, not after
//! every element, which costs a hundredth and comes to the same; the flow is interpolated by the
//! direction field of the house, which knows walls, with the sense of the neighbours. Where a ring
//! fits nowhere see `grow`.
//!
//! Where no example is drawn, a built-in one fills the shapes (`builtin`).
//!
//! Beyond the paper: the neighbours' own rings count in the comparison (E-060, `ring`); where errors
//! gather elements are chosen again (E-062, `Arrangement::mend`), and where alike ones lie nearer than in
//! the example they change places (`exchange`); elements keep apart by their outlines, with most of the
//! room that the example's have (E-063, `extent`, `part`); patterns repeat as tiles; the example's connectivity is drawn, and edges are
//! flipped there (`connect`); numbers say how like its example a result is (`measure`).

mod artwork;
mod builtin;
pub mod connect;
mod example;
mod exchange;
mod extent;
mod ground;
mod grow;
mod measure;
mod params;
mod part;
mod relax;
mod ring;

pub use params::Params;

use crate::geom::boolean;
use crate::progress::Progress;
use crate::rng::Rng;
use crate::shapes::{Shapes, polylines};
use artwork::{Drawing, Outline};
use example::Analysis;
use ground::Ground;
use grow::{Arrangement, Mode, Rules};
use kurbo::{BezPath, Point, Rect};
use measure::Likeness;
use rinceau_format::{Artwork, Container, Error, FillRule, Guide, Reference, Scene, Source, decimals_for};
use ring::Weights;
use std::collections::BTreeMap;

/// Elements of one run at most.
pub const MOST_ELEMENTS: usize = 200_000;
/// Elements where there is neither a shape nor a number.
const SOME: usize = 200;

/// What a result is made from: shapes and sprayed strokes, or else the example.
pub fn sources(scene: &Scene) -> Vec<&Source> {
    let shapes = scene.containers.iter().map(|container| &container.source);
    let all: Vec<&Source> = shapes.chain(scene.sprays.iter().map(|spray| &spray.source)).collect();
    if all.is_empty() { scene.references.iter().map(|reference| &reference.source).collect() } else { all }
}

/// Continues an example over a scene.
///
/// Errors: there is no example, or none of its elements has neighbours all around; a shape that
/// cannot be used; a symbol that the example does not have.
pub fn generate(
    params: &Params,
    scene: &Scene,
    rng: &mut Rng,
    progress: &mut dyn Progress,
) -> Result<Artwork, Error> {
    progress.step("prepare", 0.0);
    let mut scene = with_sprays(scene);
    if scene.references.is_empty() {
        if scene.containers.is_empty() {
            return Err(no_reference());
        }
        scene = builtin::with_example(&scene)?;
    }
    let scene = &scene;
    let mut artwork = Artwork { complete: true, warnings: scene.warnings.clone(), ..Artwork::default() };
    let analyses: Vec<Analysis> = scene
        .references
        .iter()
        .map(|reference| Analysis::new(reference, &mut artwork.warnings))
        .collect::<Result<_, Error>>()?;
    let mut drawing = Drawing::new(scene);
    let mut sum = Sum::default();
    if scene.containers.is_empty() {
        artwork.decimals = decimals_for(scene.view.size().max_side());
        let one = One { scene, reference: 0, params, outline: None };
        one.arrange(&analyses, &mut drawing, (rng, &mut sum), progress)?;
    } else {
        let shapes = Shapes::new(scene, &[])?;
        artwork.decimals = shapes.decimals();
        for (index, container) in scene.containers.iter().enumerate() {
            let overrides = container.overrides.iter().map(|(name, value)| (name.as_str(), value.as_str()));
            let own = params.overridden(overrides).map_err(|error| error.at(container.source.at))?;
            let gap = own.gap.to_user(scene.px_per_unit);
            let outline = match own.repeat {
                true => Outline::tile(&shapes, index, gap),
                false => Outline::new(&shapes, index, gap),
            };
            let Some(outline) = outline else {
                artwork.warnings.push(format!(
                    "{}: nothing of the container '{}' is left free",
                    container.source.at, container.source.id
                ));
                continue;
            };
            // A reference for each shape, if there are several.
            let reference = index.min(scene.references.len() - 1);
            let one = One { scene, reference, params: &own, outline: Some(&outline) };
            one.arrange(&analyses, &mut drawing, (rng, &mut sum), progress)?;
        }
    }
    progress.step("artwork", 0.0);
    artwork.complete = !sum.is_late;
    artwork.counts = BTreeMap::from([
        ("elements".to_owned(), drawing.count() as f64),
        ("grown".to_owned(), sum.grown as f64),
    ]);
    let likeness = sum.likeness.iter().flat_map(Likeness::counts);
    artwork.counts.extend(likeness.map(|(name, value)| (name.to_owned(), value)));
    if drawing.count() == 0 {
        return Err(Error::new(
            "nothing-fits",
            "No element of the example fits into the shape",
            "Make the shape larger, draw the example smaller, or let elements cross the outline",
        ));
    }
    (artwork.groups, artwork.symbols) = drawing.into_parts();
    Ok(artwork)
}

fn no_reference() -> Error {
    Error::new(
        "no-reference",
        "There is no example to continue",
        "Group some elements as they should be arranged, and mark the group as reference (Extensions > Ornament > Mark as)",
    )
}

/// A scene in which sprayed strokes are shapes (E-022), with parameters of their own.
fn with_sprays(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    let tolerance = 1e-4 * scene.view.size().max_side();
    for spray in &scene.sprays {
        let mut contours = Vec::new();
        for subpath in crate::geom::flatten::flatten(&spray.path, tolerance) {
            contours.extend(boolean::stroked(&subpath.points, subpath.closed, spray.width));
        }
        let mut path = BezPath::new();
        for contour in boolean::simplified(&contours, false) {
            path.move_to(contour[0]);
            contour[1..].iter().for_each(|&p| path.line_to(p));
            path.close_path();
        }
        if !path.is_empty() {
            let outlines = vec![rinceau_format::Outline { path, rule: FillRule::EvenOdd }];
            let source = spray.source.clone();
            let overrides = spray.overrides.clone();
            scene.containers.push(Container { source, outlines, fill: None, overrides });
        }
    }
    scene
}

/// What is known of all shapes together.
#[derive(Default)]
struct Sum {
    grown: usize,
    likeness: Option<Likeness>,
    is_late: bool,
}

/// One shape, or the open plane.
struct One<'a> {
    scene: &'a Scene,
    reference: usize,
    params: &'a Params,
    outline: Option<&'a Outline>,
}

impl One<'_> {
    fn arrange(
        &self,
        analyses: &[Analysis],
        drawing: &mut Drawing,
        (rng, sum): (&mut Rng, &mut Sum),
        progress: &mut dyn Progress,
    ) -> Result<(), Error> {
        let example = &analyses[self.reference];
        let reference = &self.scene.references[self.reference];
        let rules = self.rules(example, reference, sum)?;
        let ground = self.ground(example, &rules)?;
        let mut own = rng.fork();
        let fitted = ground.repeats.then(|| self.fitted(example, &ground, &rules, (&own, &mut *progress)));
        let example = fitted.as_ref().unwrap_or(example);
        let mut arrangement = Arrangement::new(example, &ground, &rules, &mut own);
        let starts: Vec<Point> =
            self.scene.seeds.iter().map(|seed| seed.at).filter(|&at| ground.allows(at)).collect();
        match starts.is_empty() {
            true => arrangement.start(self.innermost(&ground)),
            false => starts.into_iter().for_each(|at| arrangement.start(at)),
        }
        self.fill(&mut arrangement, &ground, example, (&rules, sum), progress);
        sum.grown += arrangement.grown.len();
        let likeness = Likeness::new(&arrangement, example, &ground);
        sum.likeness = Some(likeness.worse(sum.likeness.take()));
        drawing.add(arrangement, (example, reference, &ground), self.outline, (self.params, rng))
    }

    /// The example stretched a little, so that a whole number of its rows and columns goes into a tile:
    /// of several stretches the one after which the fewest rings are broken where growth meets itself.
    fn fitted(
        &self,
        example: &Analysis,
        ground: &Ground,
        rules: &Rules,
        (rng, progress): (&Rng, &mut dyn Progress),
    ) -> Analysis {
        const STRETCHES: [f64; 9] = [1.0, 1.02, 0.98, 1.04, 0.97, 1.06, 1.08, 1.1, 1.12];
        /// Of larger tiles a seam is a small part, and to try takes long.
        const MOST_TRIED: f64 = 2000.0;
        let expected = ground.bounds.area() / (example.mean * example.mean);
        let mut best = (f64::INFINITY, (1.0, 1.0));
        let tries = STRETCHES.into_iter().flat_map(|x| STRETCHES.map(|y| (x, y)));
        for by in tries {
            if expected > MOST_TRIED || !progress.step("fit", 0.5) {
                break;
            }
            let stretched = example.stretched(by);
            let mut tried = Arrangement::new(&stretched, ground, rules, &mut rng.clone());
            tried.start(self.innermost(ground));
            tried.grow(usize::MAX);
            // Of two that are alike the one that is stretched less.
            let badness = tried.broken() + 0.3 * ((by.0 - 1.0).abs() + (by.1 - 1.0).abs());
            if badness < best.0 {
                best = (badness, by);
            }
        }
        example.stretched(best.1)
    }

    fn rules(&self, example: &Analysis, reference: &Reference, sum: &Sum) -> Result<Rules, Error> {
        let params = self.params;
        let mut ranks = vec![0; example.symbols.len()];
        if params.priority != "none" {
            let names: Vec<&str> = params.priority.split_whitespace().collect();
            for name in &names {
                if !example.symbols.iter().any(|symbol| symbol == name) {
                    return Err(reference.source.error(
                        "no-symbol",
                        format!("The example '{}' has no symbol '{name}'", reference.source.id),
                        format!("Use one of {}", example.symbols.join(", ")),
                    ));
                }
            }
            for (symbol, rank) in example.symbols.iter().zip(&mut ranks) {
                *rank = names.iter().position(|name| name == symbol).unwrap_or(names.len());
            }
        }
        let mode = match params.mode.as_str() {
            "rotate" => Mode::Rotate,
            "flow" => Mode::Flow,
            _ => Mode::Fixed,
        };
        let weights = Weights {
            place: params.w_place,
            symbol: params.w_symbol,
            repeat: params.w_repeat,
            rings: params.w_rings,
        };
        let room = MOST_ELEMENTS.saturating_sub(sum.grown);
        let most = match (params.count, self.outline) {
            (0, None) => SOME,
            (0, Some(_)) => room,
            (count, _) => count.min(room),
        };
        Ok(Rules { weights, mode, ranks, most })
    }

    fn ground(&self, example: &Analysis, rules: &Rules) -> Result<Ground, Error> {
        let repeats = self.params.repeat;
        let wrong = |sentence: &str, remedy: &str| Err(Error::new("no-tile", sentence, remedy));
        if repeats && self.outline.is_none() {
            return wrong("There is no shape to repeat", "Mark a rectangle as container: it is the tile");
        }
        if repeats && rules.mode == Mode::Flow {
            return wrong(
                "A flow does not repeat",
                "Turn elements as drawn or as they fit best, or fill without repeating",
            );
        }
        let middles = self.outline.map(|outline| outline.middles(&self.params.edge, example));
        let tile = self.outline.and_then(|outline| outline.tile);
        let bounds = match (&middles, tile) {
            (_, Some(tile)) => tile,
            (Some(region), None) => region.bounds(),
            (None, None) => {
                // So many elements surely find room around the start: four times what they take.
                let side = example.mean * (4.0 + (rules.most as f64).sqrt());
                let seed = self.scene.seeds.first().map_or(self.scene.view.center(), |seed| seed.at);
                Rect::from_center_size(seed, (2.0 * side, 2.0 * side))
            }
        };
        if let Some(region) = &middles {
            let expected = region.area() / (example.mean * example.mean);
            if self.params.count == 0 && expected > MOST_ELEMENTS as f64 {
                return Err(Error::new(
                    "too-many-elements",
                    format!("The shape would take about {expected:.0} elements, more than {MOST_ELEMENTS}"),
                    "Draw the example larger, or give a number of elements",
                ));
            }
        }
        let tolerance = 0.02 * example.mean;
        let lines = |guides: &[Guide]| -> Vec<Vec<Point>> {
            polylines(guides, tolerance)
                .into_iter()
                .map(|(_, line)| line)
                .filter(|line| line.len() > 1)
                .collect()
        };
        let with_flow = rules.mode == Mode::Flow;
        let guides = lines(&self.scene.guides);
        let ground = Ground::new(
            middles,
            if repeats { bounds } else { bounds.inflate(1e-9, 1e-9) },
            (guides, with_flow),
            &lines(&self.scene.boundaries),
            (example.mean, repeats),
        );
        if with_flow && ground.flow.is_none() {
            return Err(Error::new(
                "no-guide",
                "There is no guide in the shape that the elements could turn with",
                "Draw a line along the flow and mark it as guide, or turn elements as drawn",
            ));
        }
        Ok(ground)
    }

    /// The place farthest from the outline.
    fn innermost(&self, ground: &Ground) -> Point {
        let Some(region) = &ground.middles else { return ground.bounds.center() };
        if ground.repeats && ground.allows(ground.bounds.center()) {
            return ground.bounds.center();
        }
        let (bounds, reach) = (ground.bounds, ground.bounds.size().max_side());
        const STEPS: usize = 24;
        let place = |i: usize| {
            let share = |i: usize| (i as f64 + 0.5) / STEPS as f64;
            let (x, y) = (share(i % STEPS), share(i / STEPS));
            Point::new(bounds.x0 + x * bounds.width(), bounds.y0 + y * bounds.height())
        };
        let places = (0..STEPS * STEPS).map(place).filter(|&at| ground.allows(at));
        let best = places.map(|at| (region.distance(at, reach), at)).max_by(|a, b| a.0.total_cmp(&b.0));
        best.map_or_else(|| region.contours()[0][0], |(_, at)| at)
    }

    /// Grows, relaxes and starts again until all is full or the time is over.
    fn fill(
        &self,
        arrangement: &mut Arrangement,
        ground: &Ground,
        example: &Analysis,
        (rules, sum): (&Rules, &mut Sum),
        progress: &mut dyn Progress,
    ) {
        const ASK_EVERY: usize = 64;
        const FIRST: usize = 48;
        /// Steps from what is new within which things move while others grow.
        const RIM: usize = 5;
        let (mut next, mut settled) = (FIRST, 0);
        let mut holes = if ground.middles.is_some() { holes(ground, example) } else { Vec::new() };
        loop {
            let done = arrangement.grown.len() as f64 / rules.most as f64;
            if !progress.step("grow", done) {
                sum.is_late = true;
                break;
            }
            let goes_on = arrangement.grow(ASK_EVERY);
            if self.params.relax && arrangement.grown.len() >= next {
                next = arrangement.grown.len() * 5 / 4 + FIRST;
                progress.step("relax", done);
                // What grew before stands well by now.
                let window = if self.params.window > 0 { self.params.window } else { RIM };
                relaxed(arrangement, ground, example, (relax::FEW_STEPS, (window, settled)));
                settled = arrangement.grown.len();
            }
            if goes_on {
                continue;
            }
            if arrangement.grown.len() >= rules.most {
                break;
            }
            // Somewhere that nothing has come to.
            let place = loop {
                match holes.pop() {
                    Some(at) if arrangement.is_empty_at(at, example.hollow) => break Some(at),
                    Some(_) => {}
                    None => break None,
                }
            };
            match place {
                Some(at) => arrangement.start_amid(arrangement.midst(at, example.hollow)),
                None => break,
            }
        }
        if self.params.relax {
            progress.step("relax", 1.0);
            const MENDED: usize = 2;
            for round in 0..=MENDED {
                let steps = if round == MENDED { relax::STEPS } else { 2 * relax::FEW_STEPS };
                let fixed = relaxed(arrangement, ground, example, (steps, (self.params.window, settled)));
                if round == MENDED || (arrangement.mend() == 0 && round > 0) {
                    exchange::exchange(arrangement, &fixed, (example, &rules.ranks), ground);
                    part::part(arrangement, &fixed, example, ground);
                    break;
                }
            }
        }
    }
}

/// Places all over the ground, to be looked at when growth has come to an end; the first come last.
fn holes(ground: &Ground, example: &Analysis) -> Vec<Point> {
    let step = 0.7 * example.hollow;
    let bounds = ground.bounds;
    let count = |side: f64| ((side / step).ceil() as usize).clamp(1, 4000);
    let (columns, rows) = (count(bounds.width()), count(bounds.height()));
    let place = |i: usize| {
        let (x, y) = ((i % columns) as f64 + 0.5, (i / columns) as f64 + 0.5);
        Point::new(
            bounds.x0 + x / columns as f64 * bounds.width(),
            bounds.y0 + y / rows as f64 * bounds.height(),
        )
    };
    (0..columns * rows).rev().map(place).filter(|&at| ground.allows(at)).collect()
}

/// Relaxes with the starts in their places, and what stands at a boundary (E-041). With a window, also
/// with all that is more than so many steps from what grew since then.
fn relaxed(
    arrangement: &mut Arrangement,
    ground: &Ground,
    example: &Analysis,
    (steps, (window, since)): (usize, (usize, usize)),
) -> Vec<bool> {
    let mut fixed: Vec<bool> = arrangement
        .objects
        .iter()
        .map(|object| object.is_gone || ground.is_at_boundary(object.at, 0.75 * example.mean))
        .collect();
    arrangement.starts.iter().for_each(|&start| fixed[start as usize] = true);
    if window > 0 {
        let is_near = arrangement.near_new(since, window);
        fixed.iter_mut().zip(is_near).for_each(|(fixed, is_near)| *fixed |= !is_near);
    }
    const NEAR: f64 = 1e-3;
    relax::relax(&mut arrangement.objects, ground, &fixed, (steps, NEAR * example.mean));
    arrangement.moved();
    fixed
}
