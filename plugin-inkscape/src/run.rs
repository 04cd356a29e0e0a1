//! The whole flow on one screen: text, document, scene, generate, artwork, layer, text.

use crate::{args, check, convert, diagnostics, install, output, progress, render, update};
use clap::ArgMatches;
use rinceau::params::Kind;
use rinceau::tack::Tacked;
use rinceau::{Error, GENERATORS, Generator, Values};
use rinceau_format::{Artwork, Document, Recipe, Role, RuleSet, Scene, Selection};
use serde_json::json;
use std::io::Read;
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
    pub recipe: Recipe,
}

impl Done {
    /// The drawing with the artwork in it.
    pub fn to_bytes(&self) -> Result<Vec<u8>, Error> {
        Ok(self.document.with_layer(&self.artwork, &self.recipe)?.to_bytes())
    }

    /// How evenly the containers are filled, where that is what the generator does.
    fn quality(&self) -> Result<serde_json::Value, Error> {
        let fills = self.artwork.groups.iter().all(|group| group.hidden || group.stream.is_none());
        if !fills || self.scene.containers.is_empty() {
            return Ok(serde_json::Value::Null);
        }
        Ok(json!(rinceau::quality::measure(&self.scene, &self.artwork)?))
    }

    /// Writes the same as it is made; what it measures.
    fn write(&self, path: Option<&Path>) -> Result<output::Size, Error> {
        let mut size = output::Size::default();
        output::write_by(path, |out| {
            let mut counted = output::Counted { out, size: &mut size };
            self.document.write_with_layer(&self.artwork, &self.recipe, &mut counted)
        })?;
        Ok(size)
    }
}

/// Runs a generator on a drawing.
pub fn generate(job: Job) -> Result<Done, Error> {
    job.progress.begin("read");
    let mut document = Document::from_bytes(job.bytes)?;
    let mut selection = Selection { ids: job.ids };
    if job.generator.name == "connect" {
        // Selected edges are flipped, and drawn anew.
        (document, selection.ids) = document.with_flipped(&selection.ids)?;
    }
    let mut scene = document.scene(&selection)?;
    add_rules(&mut scene, job.generator, &job.values)?;
    job.progress.limit(job.time_limit);
    let mut artwork =
        rinceau::generate(job.generator, &job.values, &scene, job.seed, job.progress.as_progress())?;
    let sources = job.generator.sources(&scene);
    let ids: Vec<String> = sources.iter().map(|source| source.id.clone()).collect();
    if let Some(held) = document.held(job.generator.name, &ids)? {
        // An ornament that has not changed stays the same around what the artist moved.
        if !document.is_made_of(&artwork, job.generator.name, &ids)? {
            let mut scene = held.scene(&selection)?;
            add_rules(&mut scene, job.generator, &job.values)?;
            job.progress.limit(job.time_limit);
            let progress = job.progress.as_progress();
            artwork = rinceau::generate(job.generator, &job.values, &scene, job.seed, progress)?;
            held.take_out_of(&mut artwork);
        }
    }
    let is_source = |id: &&String| sources.iter().any(|source| source.id == **id);
    let with = selection.ids.iter().filter(|id| !is_source(id)).cloned().collect();
    let labels: Vec<&str> = sources.iter().map(|source| source.label.as_str()).collect();
    let recipe = Recipe {
        generator: job.generator.name.to_owned(),
        params: job.values.recipe(job.generator.table),
        seed: job.seed,
        sources: ids,
        with,
        label: format!("Ornament - {}", labels.join(", ")),
    };
    let document = document.with_steps(&artwork.steps, &recipe)?;
    Ok(Done { document, scene, artwork, recipe })
}

/// Reads the rule file that a run asks for, if it is neither built in nor part of the drawing.
fn add_rules(scene: &mut Scene, generator: &Generator, values: &Values) -> Result<(), Error> {
    for spec in generator.table {
        let Kind::Rules(names) = spec.kind else { continue };
        let name = values.text(spec);
        let is_known = names.iter().any(|(known, _)| *known == name)
            || scene.rules.iter().any(|rules| rules.name == name);
        if !is_known && (name.ends_with(".rules") || Path::new(&name).is_file()) {
            let text = read_rules(Path::new(&name)).map_err(|what| {
                Error::new(
                    "rules-file",
                    format!("The rules '{name}' cannot be read: {what}"),
                    "Check the name: it has to be a file of text in UTF-8",
                )
            })?;
            scene.rules.push(RuleSet { name, text });
        }
    }
    Ok(())
}

fn read_rules(path: &Path) -> Result<String, String> {
    // One byte more than the generator takes, so that it can say that it is too much.
    const MOST: u64 = (1 << 18) + 1;
    let kind = std::fs::metadata(path).map_err(|error| error.to_string())?;
    if !kind.is_file() {
        return Err("it is no file".to_owned());
    }
    let mut text = String::new();
    let file = std::fs::File::open(path).map_err(|error| error.to_string())?;
    file.take(MOST).read_to_string(&mut text).map_err(|error| error.to_string())?;
    Ok(text)
}

/// Moves objects by tacks.
pub fn tacked(document: &Document, operation: &str, ids: &[String]) -> Result<Document, Error> {
    let scene = document.scene(&Selection::default())?;
    match rinceau::tack::tacked(operation, &scene, ids)? {
        (moved, Tacked::By(by)) => document.with_transform(&moved, by),
        (moved, Tacked::OntoSource) => document.with_clones_on_source(&moved),
    }
}

/// Runs a parsed command line.
pub fn command(matches: &ArgMatches) -> Result<(), Error> {
    let Some((name, matches)) = matches.subcommand() else { return Ok(()) };
    match name {
        "mark" => {
            let role = matches.get_one::<String>("role").and_then(|name| Role::from_name(name));
            let document =
                Document::from_bytes(output::read(input(matches))?)?.with_role(&ids(matches), role)?;
            output::write(path(matches, "out"), &document.to_bytes())
        }
        "tack" => {
            let operation = matches.get_one::<String>("operation").map_or("drag", String::as_str);
            let document = Document::from_bytes(output::read(input(matches))?)?;
            output::write(path(matches, "out"), &tacked(&document, operation, &ids(matches))?.to_bytes())
        }
        "update" => {
            let document = Document::from_bytes(output::read(input(matches))?)?;
            let mut progress = progress::Terminal::new();
            let limit = matches.get_one::<f64>("time-limit").map(|&s| Duration::from_secs_f64(s.min(1e9)));
            let updated = update::update(document, limit, &mut progress)?;
            output::write(path(matches, "out"), &updated.document.to_bytes())?;
            updated.notes.iter().for_each(|note| output::note(note));
            Ok(())
        }
        "resume" => {
            let mut document = Document::from_bytes(output::read(input(matches))?)?;
            for id in ids(matches) {
                document = document.with_resumed(&id)?;
            }
            output::write(path(matches, "out"), &document.to_bytes())
        }
        "check" => check::run(input(matches), matches.get_flag("json")),
        "convert" => convert::run(matches, input(matches), path(matches, "out")),
        "render" => {
            let width = matches.get_one::<u32>("width").copied().unwrap_or(0);
            let picture = matches.get_one::<String>("picture").map_or("png", String::as_str);
            render::work(picture, width)
                .map_err(|what| Error::new("cannot-render", what, "Draw it otherwise"))
        }
        "uninstall" => install::uninstall(matches.get_one::<PathBuf>("dir").map(PathBuf::as_path)),
        "completions" => {
            let mut text = Vec::new();
            if let Some(&shell) = matches.get_one::<clap_complete::Shell>("shell") {
                clap_complete::generate(shell, &mut args::command(), "rinceau", &mut text);
            }
            output::write(None, &text)
        }
        "manual" => {
            let mut text = Vec::new();
            // Memory takes everything.
            let _ = clap_mangen::Man::new(args::command()).render(&mut text);
            output::write(None, &text)
        }
        "diagnostics" => output::write(None, diagnostics::text().as_bytes()),
        "install" => install::install(matches.get_one::<PathBuf>("dir").map(PathBuf::as_path)),
        name => match GENERATORS.iter().find(|generator| generator.name == name) {
            Some(generator) => generator_command(generator, matches),
            None => unreachable!("clap knows {name} from the same table"),
        },
    }
}

/// Errors before any work is done: a report that would take the place of a drawing, or has no folder.
fn check_report(report: &Path, drawings: [Option<&Path>; 2]) -> Result<(), Error> {
    let whole = |path: &Path| std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    if drawings.into_iter().flatten().any(|drawing| whole(drawing) == whole(report)) {
        let sentence = "The report would take the place of the drawing";
        return Err(Error::new("bad-parameter", sentence, "Give --report a file of its own"));
    }
    let folder = report.parent().filter(|folder| !folder.as_os_str().is_empty());
    if folder.is_some_and(|folder| !folder.is_dir()) {
        let sentence = format!("There is no folder for the report '{}'", report.display());
        return Err(Error::new("bad-parameter", sentence, "Create it, or give --report another file"));
    }
    Ok(())
}

fn generator_command(generator: &'static Generator, matches: &ArgMatches) -> Result<(), Error> {
    let mut values = Values::default();
    for spec in generator.table {
        if let Some(value) = matches.get_one::<String>(spec.name) {
            values.set(generator.table, spec.name, value)?;
        }
    }
    let report = matches.get_one::<PathBuf>("report");
    // As everywhere a dash is standard output, unless the drawing goes there.
    let is_printed = report.is_some_and(|report| report == Path::new("-"));
    if is_printed && path(matches, "out").is_none() {
        let sentence = "The drawing goes to standard output, and so would the report";
        return Err(Error::new("bad-parameter", sentence, "Give --report or -o a file"));
    }
    if let Some(report) = report.filter(|_| !is_printed) {
        check_report(report, [input(matches), path(matches, "out")])?;
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
    progress.start("write");
    let size = done.write(path(matches, "out"))?;
    done.artwork.warnings.iter().for_each(|warning| output::note(warning));
    if let Some(warning) = size.warning() {
        output::note(&warning);
    }
    if let Some(report) = report {
        let stages: serde_json::Map<_, _> =
            progress.stages().iter().map(|(name, ms)| ((*name).to_owned(), json!(ms))).collect();
        // The clock stops before the measuring, which is no part of the work.
        let total = start.elapsed().as_secs_f64() * 1e3;
        let report_json = json!({
            "generator": generator.name,
            "params": recipe,
            "seed": seed,
            "counts": done.artwork.counts,
            "quality": done.quality()?,
            "complete": done.artwork.complete,
            "warnings": done.artwork.warnings,
            "milliseconds": stages,
            "milliseconds_total": total,
        });
        let report_path = Some(report.as_path()).filter(|_| !is_printed);
        output::write(report_path, format!("{report_json:#}\n").as_bytes()).map_err(|error| {
            let sentence = format!("The report '{}' cannot be written; the drawing was", report.display());
            Error::new(
                error.code(),
                sentence,
                "Check the report's folder, its permissions and the free space",
            )
        })?;
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
