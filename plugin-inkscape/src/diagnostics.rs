//! What somebody who helps has to know: versions, folders, how long the last run in Inkscape took, and
//! the last sentence that went wrong there. Nothing of a drawing is kept but the ids in that sentence.

use crate::install;
use rinceau_format::{Error, printable};
use serde::{Deserialize, Serialize};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

/// Beside the installed program.
pub const FILE: &str = "last-run.json";

/// What is remembered from run to run.
#[derive(Default, Serialize, Deserialize)]
struct Memory {
    run: Option<Ran>,
    failure: Option<Failed>,
}

/// A run that gave a result.
#[derive(Serialize, Deserialize)]
struct Ran {
    tool: String,
    /// Seconds since 1970.
    at: u64,
    /// Stages in order, with milliseconds.
    stages: Vec<(String, f64)>,
}

/// A run that gave a sentence.
#[derive(Serialize, Deserialize)]
struct Failed {
    tool: String,
    at: u64,
    sentence: String,
}

/// Remembers a run that Inkscape asked for.
pub fn ran(tool: &str, stages: &[(&'static str, f64)]) {
    let stages = stages.iter().map(|&(name, ms)| (name.to_owned(), ms)).collect();
    remember(|memory| memory.run = Some(Ran { tool: tool.to_owned(), at: now(), stages }));
}

/// Remembers what went wrong.
pub fn failed(tool: &str, error: &Error) {
    let failure = Failed { tool: tool.to_owned(), at: now(), sentence: error.to_string() };
    remember(|memory| memory.failure = Some(failure));
}

/// Changes what is remembered, where that can be: it is no reason to fail.
fn remember(change: impl FnOnce(&mut Memory)) {
    let Some(file) = std::env::current_exe().ok().and_then(|program| memory_of(&program)) else { return };
    let mut memory = read(&file);
    change(&mut memory);
    if let Ok(json) = serde_json::to_vec(&memory) {
        let _ = std::fs::write(file, json);
    }
}

/// Where an installed program remembers; one that is not installed does not.
fn memory_of(program: &Path) -> Option<PathBuf> {
    let bin = program.parent()?;
    bin.parent()?.join("check.inx").is_file().then(|| bin.join(FILE))
}

/// What is remembered; nothing, if it cannot be read.
fn read(file: &Path) -> Memory {
    std::fs::read(file).ok().and_then(|json| serde_json::from_slice(&json).ok()).unwrap_or_default()
}

/// All of it, as text to be copied.
pub fn text() -> String {
    let mut out = String::new();
    let mut line = |what: &str, value: &str| {
        let _ = writeln!(out, "{:18} {}", format!("{what}:"), printable(value));
    };
    line("Rinceau", env!("CARGO_PKG_VERSION"));
    line("System", &format!("{} {}", std::env::consts::OS, std::env::consts::ARCH));
    let cores = std::thread::available_parallelism().map_or("unknown".to_owned(), |n| n.to_string());
    line("Processors", &cores);
    let program = std::env::current_exe().ok();
    let shown = |path: Option<&Path>| path.map_or("unknown".to_owned(), |path| path.display().to_string());
    line("Program", &shown(program.as_deref()));
    let folder = install::folder(None).ok();
    line("Inkscape's folder", &shown(folder.as_deref()));
    let installed = folder.map(|folder| install::program(&folder));
    line(
        "Installed there",
        match (&installed, &program) {
            (Some(installed), Some(program)) if installed == program => "yes, this program",
            (Some(installed), _) if installed.is_file() => "yes, another copy of the program",
            _ => "no",
        },
    );
    let known = |path: &Option<PathBuf>| path.as_deref().and_then(memory_of).filter(|file| file.is_file());
    let memory = known(&program).or_else(|| known(&installed)).map(|file| read(&file)).unwrap_or_default();
    match memory.run {
        None => line("Last run", "none in Inkscape yet"),
        Some(Ran { tool, at, stages }) => {
            let total: f64 = stages.iter().map(|(_, ms)| ms).sum();
            line("Last run", &format!("{tool}, {}, {total:.0} ms", ago(at)));
            for (name, ms) in stages {
                line("", &format!("{name} {ms:.1} ms"));
            }
        }
    }
    match memory.failure {
        None => line("Last error", "none"),
        Some(Failed { tool, at, sentence }) => {
            line("Last error", &format!("{tool}, {}: {sentence}", ago(at)));
        }
    }
    out
}

fn now() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs())
}

/// How long ago, in words.
fn ago(at: u64) -> String {
    let seconds = now().saturating_sub(at);
    let (count, unit) = match seconds {
        0..60 => return "just now".to_owned(),
        60..3600 => (seconds / 60, "minute"),
        3600..86_400 => (seconds / 3600, "hour"),
        _ => (seconds / 86_400, "day"),
    };
    format!("{count} {unit}{} ago", if count == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_words() {
        assert_eq!(ago(now()), "just now");
        assert_eq!(ago(now() - 61), "1 minute ago");
        assert_eq!(ago(now() - 7300), "2 hours ago");
        assert_eq!(ago(now() - 9 * 86_400), "9 days ago");
        // A clock that was set back.
        assert_eq!(ago(now() + 500), "just now");
    }

    #[test]
    fn a_program_that_is_not_installed_remembers_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let program = folder.path().join("bin/rinceau");
        assert_eq!(memory_of(&program), None);
        std::fs::write(folder.path().join("check.inx"), "").unwrap();
        assert_eq!(memory_of(&program), Some(folder.path().join("bin").join(FILE)));
    }
}
