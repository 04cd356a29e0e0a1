//! Timings of every stage, a time limit, and a bar on a terminal.

use rinceau::{Deadline, Progress};
use std::io::IsTerminal;
use std::time::Duration;

/// Progress that also times what happens around a generator.
pub trait Staged: Progress {
    /// Starts a stage by name.
    fn begin(&mut self, stage: &'static str) {
        self.step(stage, 0.0);
    }
    /// Starts the clock of the time limit.
    fn limit(&mut self, limit: Option<Duration>);
    /// Itself, as generators take it.
    fn as_progress(&mut self) -> &mut dyn Progress;
}

/// Progress of the command line: a bar on standard error if that is a terminal.
pub struct Terminal {
    deadline: Deadline,
    bar: Option<indicatif::ProgressBar>,
}

impl Terminal {
    pub fn new() -> Self {
        let bar = std::io::stderr().is_terminal().then(|| {
            indicatif::ProgressBar::new(1000).with_style(
                indicatif::ProgressStyle::with_template("{msg:12} {wide_bar}")
                    .unwrap_or_else(|_| indicatif::ProgressStyle::default_bar()),
            )
        });
        Terminal { deadline: Deadline::new(None), bar }
    }

    /// Starts a stage by name.
    pub fn start(&mut self, stage: &'static str) {
        self.step(stage, 0.0);
    }

    /// Milliseconds by stage; takes the bar away.
    pub fn stages(&mut self) -> &[(&'static str, f64)] {
        if let Some(bar) = self.bar.take() {
            bar.finish_and_clear();
        }
        self.deadline.stages()
    }
}

impl Progress for Terminal {
    fn step(&mut self, stage: &'static str, done: f64) -> bool {
        if let Some(bar) = &self.bar {
            bar.set_message(stage);
            bar.set_position((done * 1000.0) as u64);
        }
        self.deadline.step(stage, done)
    }
}

impl Staged for Terminal {
    fn limit(&mut self, limit: Option<Duration>) {
        self.deadline.limit(limit);
    }

    fn as_progress(&mut self) -> &mut dyn Progress {
        self
    }
}
