//! How a generator tells how far it is and learns that it should stop.

use std::time::{Duration, Instant};

/// Told at the start of each stage and in its loops. Stopping is a return value: the
/// generator then returns the best it has, marked incomplete.
pub trait Progress {
    /// `done` runs from 0 to 1 within the stage. False: stop now.
    fn step(&mut self, stage: &'static str, done: f64) -> bool;
}

/// Stops at a time, and keeps the milliseconds of each stage for the report.
#[derive(Debug)]
pub struct Deadline {
    end: Option<Instant>,
    stages: Vec<(&'static str, f64)>,
    /// Index of the stage that runs.
    current: usize,
    since: Instant,
}

impl Deadline {
    /// `None` never stops.
    pub fn new(limit: Option<Duration>) -> Self {
        let now = Instant::now();
        Deadline {
            end: limit.and_then(|limit| now.checked_add(limit)),
            stages: Vec::new(),
            current: 0,
            since: now,
        }
    }

    /// Starts the clock of a limit now; `None` never stops.
    pub fn limit(&mut self, limit: Option<Duration>) {
        self.end = limit.and_then(|limit| Instant::now().checked_add(limit));
    }

    /// Milliseconds spent in each stage so far, in order of first appearance.
    pub fn stages(&mut self) -> &[(&'static str, f64)] {
        self.book();
        &self.stages
    }

    fn book(&mut self) {
        let now = Instant::now();
        if let Some(stage) = self.stages.get_mut(self.current) {
            stage.1 += (now - self.since).as_secs_f64() * 1e3;
        }
        self.since = now;
    }
}

impl Progress for Deadline {
    fn step(&mut self, stage: &'static str, _done: f64) -> bool {
        if self.stages.get(self.current).is_none_or(|current| current.0 != stage) {
            self.book();
            // A generator may come back to a stage, for every container or again and again.
            let known = self.stages.iter().position(|(name, _)| *name == stage);
            self.current = known.unwrap_or(self.stages.len());
            if known.is_none() {
                self.stages.push((stage, 0.0));
            }
        }
        self.end.is_none_or(|end| Instant::now() < end)
    }
}
