//! The main loop (000 4.1, checklist W-061, W-066, W-090 to W-105): find the largest empty circle,
//! let the elements near it try their rules, go on.

use super::rules::{Applied, Rules, Shared};
use super::space::Circle;
use super::world::Candidate;
use crate::progress::Progress;
use kurbo::Point;
use rinceau_format::Error;

/// Elements that may try to grow into one circle, at most.
const MOST_CANDIDATES: usize = 24;

/// What the loop goes by.
#[derive(Clone, Copy, Debug)]
pub(super) struct Settings {
    /// How far candidates may be from a circle, in its radii (the paper's epsilon, which has no
    /// value there).
    pub reach: f64,
    /// Smaller circles are not tried.
    pub smallest: f64,
    /// The step whose choice is to be shown; 0 for none.
    pub debug: usize,
}

/// What one step looked like (000 Figure 8).
#[derive(Clone, Debug, Default)]
pub(super) struct View {
    pub chosen: Option<Circle>,
    pub candidates: Vec<u32>,
    /// Other circles that might have been chosen.
    pub eligible: Vec<Circle>,
    /// Middles of those that are excluded.
    pub excluded: Vec<Point>,
    /// Elements that were there already.
    pub placed: usize,
}

/// How a run went.
#[derive(Clone, Debug, Default)]
pub(super) struct Grown {
    /// Applications of rules that placed something.
    pub steps: usize,
    /// Circles that nothing could grow into.
    pub failed: usize,
    pub complete: bool,
    /// True if it ended because there were as many elements as allowed.
    pub full: bool,
    pub view: Option<View>,
    /// Why children were not placed: unset or without sense, outside, over others.
    pub refused: [usize; 3],
}

impl Grown {
    /// Why so little grew, in words.
    pub fn reasons(&self) -> String {
        match self.refused {
            [0, 0, 0] => "every rule that was asked said no".to_owned(),
            [unset, outside, over] => format!(
                "of what its rules made, {unset} had no shape or one without sense, {outside} lay outside, and {over} over something else"
            ),
        }
    }
}

/// Grows until there is no room that anything can grow into.
///
/// Errors: those of the rules.
pub(super) fn grow(
    rules: &mut Rules,
    shared: &Shared,
    settings: &Settings,
    progress: &mut dyn Progress,
) -> Result<Grown, Error> {
    let mut grown = Grown { complete: true, ..Grown::default() };
    let grows = rules.grows();
    for round in 0_usize.. {
        const ASK_EVERY: usize = 32;
        if round % ASK_EVERY == 0 && !progress.step("grow", share(shared)) {
            grown.complete = false;
            break;
        }
        let (circle, reach, candidates) = {
            let mut state = shared.borrow_mut();
            let world = state.world();
            let Some(circle) = world.space.largest(settings.smallest) else { break };
            let reach = (settings.reach * circle.radius).max(2.0 * world.space.cell());
            let candidates = world.candidates(circle, reach, &grows);
            if settings.debug > 0 && grown.steps + 1 == settings.debug && grown.view.is_none() {
                let view = world.space.view(settings.smallest);
                grown.view = Some(View {
                    chosen: Some(circle),
                    candidates: candidates.iter().map(|candidate| candidate.element).collect(),
                    eligible: view.0,
                    excluded: view.1,
                    placed: world.placed,
                });
            }
            (circle, reach, candidates)
        };
        let mut applied = Applied::Failed;
        for candidate in candidates.iter().take(MOST_CANDIDATES) {
            applied = rules.grow(candidate, || progress.step("grow", 0.5))?;
            if applied != Applied::Failed {
                break;
            }
        }
        let mut state = shared.borrow_mut();
        let world = state.world();
        match applied {
            Applied::Placed => {
                grown.steps += 1;
                world.space.readmit(circle.center, reach);
            }
            Applied::Failed if world.is_full => {}
            Applied::Failed => {
                grown.failed += 1;
                world.space.exclude(circle.center);
            }
            Applied::Late => {
                grown.complete = false;
                break;
            }
        }
        if world.is_full {
            grown.full = true;
            break;
        }
    }
    grown.refused = shared.borrow_mut().world().refused;
    Ok(grown)
}

/// How much of the work is done, about: circles shrink to the smallest.
fn share(shared: &Shared) -> f64 {
    let mut state = shared.borrow_mut();
    let world = state.world();
    let placed = world.placed as f64;
    placed / (placed + 500.0)
}

/// Lets the first elements, which are seeds, grow at once, whatever room there is: how many did, and
/// whether there was time for all.
///
/// Errors: those of the rules.
pub(super) fn sprout(
    rules: &mut Rules,
    shared: &Shared,
    seeds: usize,
    progress: &mut dyn Progress,
) -> Result<(usize, bool), Error> {
    let mut sprouted = 0;
    for seed in 0..seeds {
        let goal = {
            let mut state = shared.borrow_mut();
            let world = state.world();
            let place = world.elements[seed].proxies[0].as_ref();
            let center = place.map_or(Point::ORIGIN, |proxy| proxy.start());
            Circle { center, radius: world.wall_distance(center).max(0.0) }
        };
        let candidate = Candidate { element: seed as u32, goal };
        match rules.grow(&candidate, || progress.step("grow", 0.0))? {
            Applied::Placed => sprouted += 1,
            Applied::Failed => {}
            Applied::Late => return Ok((sprouted, false)),
        }
    }
    Ok((sprouted, true))
}
