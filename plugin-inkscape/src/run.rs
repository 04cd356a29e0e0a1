//! The whole flow on one screen: text, document, scene, generate, artwork, layer, text.

use crate::{check, install, output, progress};
use clap::ArgMatches;
use rinceau::{Error, GENERATORS, Generator, Values};
use rinceau_format::{Artwork, Document, Recipe, Role, Scene, Selection};
use serde_json::json;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// A run of a generator, wherever it was asked for.
pub struct Job<'a> {
    pub generator: &'static Generator,
    pub values: Values,
    pub seed: u64,
    pub ids: Vec<String>,
    pub time_limit: Option<Duration>,
    pub bytes: Vec<u8>,
    pub progress: &'a mut dyn progress::Staged,
}

/// What a run gave.
pub struct Done {
    pub document: Document,
    pub scene: Scene,
    pub artwork: Artwork,
}

/// Runs a generator on a drawing.
pub fn generate(job: Job) -> Result<Done, Error> {
    job.progress.begin("read");
    let document = Document::from_bytes(job.bytes)?;
    let scene = document.scene(&Selection { ids: job.ids })?;
    job.progress.limit(job.time_limit);
    let artwork =
        rinceau::generate(job.generator, &job.values, &scene, job.seed, job.progress.as_progress())?;
    job.progress.begin("write");
    let labels: Vec<&str> =
        scene.containers.iter().map(|container| container.source.label.as_str()).collect();
    let recipe = Recipe {
        generator: job.generator.name.to_owned(),
        params: job.values.recipe(job.generator.table),
        seed: job.seed,
        sources: scene.containers.iter().map(|container| container.source.id.clone()).collect(),
        label: format!("Ornament - {}", labels.join(", ")),
    };
    Ok(Done { document: document.with_layer(&artwork, &recipe)?, scene, artwork })
}

/// Runs a parsed command line.
pub fn command(matches: &ArgMatches) -> Result<(), Error> {
    let Some((name, matches)) = matches.subcommand() else { return Ok(()) };
    match name {
        "mark" => {
            let role = matches.get_one::<String>("role").and_then(|name| Role::from_name(name));
            let document =
                Document::from_bytes(output::read(input(matches))?)?.with_role(&ids(matches), role)?;
            output::write(path(matches, "output"), &document.to_bytes())
        }
        "check" => check::run(&Document::from_bytes(output::read(input(matches))?)?),
        "install" => install::install(matches.get_one::<PathBuf>("dir").map(PathBuf::as_path)),
        name => match GENERATORS.iter().find(|generator| generator.name == name) {
            Some(generator) => generator_command(generator, matches),
            None => unreachable!("clap knows {name} from the same table"),
        },
    }
}

fn generator_command(generator: &'static Generator, matches: &ArgMatches) -> Result<(), Error> {
    let mut values = Values::default();
    for spec in generator.table {
        if let Some(value) = matches.get_one::<String>(spec.name) {
            values.set(generator.table, spec.name, value)?;
        }
    }
    let seed = *matches.get_one::<u64>("seed").unwrap_or(&1);
    let time_limit =
        matches.get_one::<f64>("time-limit").map(|&seconds| Duration::from_secs_f64(seconds.min(1e9)));
    let start = Instant::now();
    let mut progress = progress::Terminal::new();
    progress.start("open");
    let bytes = output::read(input(matches))?;
    let recipe = values.recipe(generator.table);
    let done = generate(Job {
        generator,
        values,
        seed,
        ids: ids(matches),
        time_limit,
        bytes,
        progress: &mut progress,
    })?;
    let document = done.document.to_bytes();
    progress.start("save");
    output::write(path(matches, "output"), &document)?;
    for warning in &done.artwork.warnings {
        eprintln!("rinceau: note: {warning}");
    }
    if let Some(report) = matches.get_one::<PathBuf>("report") {
        let stages: serde_json::Map<_, _> =
            progress.stages().iter().map(|(name, ms)| ((*name).to_owned(), json!(ms))).collect();
        // The clock stops before the measuring, which is no part of the work.
        let total = start.elapsed().as_secs_f64() * 1e3;
        let report_json = json!({
            "generator": generator.name,
            "params": recipe,
            "seed": seed,
            "counts": done.artwork.counts,
            "quality": rinceau::quality::measure(&done.scene, &done.artwork)?,
            "complete": done.artwork.complete,
            "warnings": done.artwork.warnings,
            "milliseconds": stages,
            "milliseconds_total": total,
        });
        output::write(Some(report), format!("{report_json:#}\n").as_bytes())?;
    }
    Ok(())
}

fn input(matches: &ArgMatches) -> Option<&Path> {
    path(matches, "input")
}

/// A path argument; `-` and absence both mean a standard stream.
fn path<'a>(matches: &'a ArgMatches, name: &str) -> Option<&'a Path> {
    matches.get_one::<String>(name).filter(|path| *path != "-").map(Path::new)
}

fn ids(matches: &ArgMatches) -> Vec<String> {
    matches.get_many::<String>("id").into_iter().flatten().cloned().collect()
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_command_line_is_consistent() {
        crate::args::command().debug_assert();
    }
}
