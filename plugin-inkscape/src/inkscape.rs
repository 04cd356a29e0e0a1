//! Inkscape's side of the bargain: parameters come as flags, the file comes last, the drawing
//! goes to standard output. Any text on standard error opens a dialog, and an empty output
//! leaves the drawing as it is, so a failure writes the input back and one sentence.

use crate::check::Check;
use crate::run::{self, Job};
use crate::unbroken;
use crate::{convert, diagnostics, output, progress, update};
use rinceau::params::Kind;
use rinceau::{Error, GENERATORS, Generator, Values};
use rinceau_format::{Document, Role, printable};
use std::ffi::OsString;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

/// The window is frozen while an extension runs and cannot be cancelled, so a run ends by
/// itself. The dialog may ask for less.
const LONGEST_RUN: f64 = 30.0;

/// Seconds of a run at quick quality: with reading, drawing and writing it ends before 200 ms, which a live
/// preview may take.
const QUICK_RUN: f64 = 0.08;

/// True if the hidden parameter `tool` is there.
pub fn called_by_inkscape(arguments: &[OsString]) -> bool {
    arguments.iter().any(|argument| argument.to_string_lossy().starts_with("--tool="))
}

/// Runs the tool Inkscape asks for.
pub fn run(arguments: &[OsString]) -> ExitCode {
    let call = Call::parse(arguments);
    let (file, tool) = (call.file.clone(), call.tool.clone());
    let is_file_format = call.file_format().is_some();
    let result = output::read(file.as_deref())
        .and_then(|input| unbroken(|| call.result(input)))
        .and_then(|bytes| output::write(None, &bytes));
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            diagnostics::failed(&tool, &error);
            // The drawing goes back unchanged, whatever happened. It comes from the file again:
            // what was read of a drawing beyond the limit ends there.
            if !is_file_format {
                let _ = file.map(|file| output::copy(&file));
            }
            fail(&error)
        }
    }
}

fn fail(error: &Error) -> ExitCode {
    eprintln!("{error}");
    ExitCode::from(1)
}

/// The parsed call.
#[derive(Debug, Default)]
struct Call {
    tool: String,
    ids: Vec<String>,
    params: Vec<(String, String)>,
    file: Option<PathBuf>,
}

impl Call {
    fn parse(arguments: &[OsString]) -> Self {
        let mut call = Call::default();
        for argument in arguments {
            let text = argument.to_string_lossy();
            let flag = text.strip_prefix("--").and_then(|flag| flag.split_once('='));
            match flag {
                Some(("id", id)) => call.ids.push(id.to_owned()),
                Some(("tool", tool)) => call.tool = tool.to_owned(),
                // Which page of the dialog was open.
                Some(("tab", _)) => {}
                // Selected nodes; nothing here works on single nodes.
                Some(("selected-nodes", _)) => {}
                Some((name, value)) => call.params.push((name.replace('_', "-"), value.to_owned())),
                None => call.file = Some(PathBuf::from(argument)),
            }
        }
        call
    }

    /// For what Inkscape opens or saves through us: from and to which format.
    fn file_format(&self) -> Option<(&str, &str)> {
        let from = self.tool.strip_prefix("open-").map(|format| (format, "svg"));
        from.or_else(|| self.tool.strip_prefix("save-").map(|format| ("svg", format)))
    }

    fn result(self, input: Vec<u8>) -> Result<Vec<u8>, Error> {
        if let Some((from, to)) = self.file_format() {
            // What a format lacks, its menu entry says; a message here would look like a failure.
            return Ok(convert::converted(input, Some(from), to, convert::Finish::default())?.0);
        }
        if let Some(role) = self.tool.strip_prefix("mark-") {
            if self.ids.is_empty() {
                return Err(Error::new(
                    "nothing-selected",
                    "Nothing is selected",
                    "Select what you want to mark, then choose the entry again",
                ));
            }
            let role = Role::from_name(role);
            return Ok(Document::from_bytes(input)?.with_role(&self.ids, role)?.to_bytes());
        }
        if let Some(operation) = self.tool.strip_prefix("tack-") {
            return Ok(run::tacked(&Document::from_bytes(input)?, operation, &self.ids)?.to_bytes());
        }
        if self.tool == "update" {
            let limit = Some(Duration::from_secs_f64(LONGEST_RUN));
            let document = Document::from_bytes(input)?;
            let updated = update::update(document, limit, &mut progress::Terminal::new())?;
            // What stays as it is has to be said, and the dialog is the place for it.
            updated.notes.iter().for_each(|note| eprintln!("Note: {}", printable(note)));
            return Ok(updated.document.to_bytes());
        }
        if self.tool == "resume" {
            let Some(id) = self.ids.first() else {
                return Err(Error::new(
                    "nothing-selected",
                    "Nothing is selected",
                    "Select one of the pictures in the layer of explored forms",
                ));
            };
            return Ok(Document::from_bytes(input)?.with_resumed(id)?.to_bytes());
        }
        if self.tool == "check" {
            // The dialog that standard error opens is what the artist asked for here.
            eprintln!("{}", Check::new(&Document::from_bytes(input.clone())?)?.text(None));
            return Ok(input);
        }
        if self.tool == "diagnostics" {
            eprintln!("{}", diagnostics::text());
            return Ok(input);
        }
        self.generated(input)
    }

    /// Runs a generator with what its dialog says.
    fn generated(mut self, input: Vec<u8>) -> Result<Vec<u8>, Error> {
        let generator = GENERATORS.iter().find(|generator| generator.name == self.tool).ok_or_else(|| {
            Error::new(
                "unknown-tool",
                format!("This version has no tool '{}'", self.tool),
                "Run 'rinceau install' again",
            )
        })?;
        let seed = self.take("seed").and_then(|text| text.parse().ok()).unwrap_or(1);
        let asked = self.take("time-limit").and_then(|text| text.parse().ok());
        let seconds: f64 = asked.filter(|seconds: &f64| !seconds.is_nan()).unwrap_or(LONGEST_RUN);
        let is_quick = self.take("quality").is_some_and(|quality| quality == "quick");
        let seconds = if is_quick { QUICK_RUN } else { seconds.clamp(QUICK_RUN, LONGEST_RUN) };
        let values = self.values(generator)?;
        let mut progress = progress::Terminal::new();
        let done = run::generate(Job {
            generator,
            values,
            seed,
            ids: self.ids,
            time_limit: Some(Duration::from_secs_f64(seconds)),
            bytes: input,
            progress: &mut progress,
        })?;
        progress.start("write");
        let bytes = done.to_bytes()?;
        diagnostics::ran(generator.name, progress.stages());
        Ok(bytes)
    }

    /// What the parameters that are left say.
    fn values(&mut self, generator: &Generator) -> Result<Values, Error> {
        // A file goes before the pattern beside it.
        if let Some(file) = self.take("rules-file").filter(|file| !file.trim().is_empty()) {
            self.params.retain(|(name, _)| name != "rules");
            self.params.push(("rules".to_owned(), file));
        }
        let unit = self.take("unit").filter(|unit| unit != "document").unwrap_or_default();
        let mut values = Values::default();
        for (name, value) in &mut self.params {
            let spec = generator.table.iter().find(|spec| spec.name == name);
            // The dialog's lengths are all in the unit chosen beside them.
            if spec.is_some_and(|spec| spec.kind == Kind::Length) && value.parse() != Ok(0.0) {
                value.push_str(&unit);
            } else if spec.is_some_and(|spec| spec.kind == Kind::Lengths) {
                let bare = |item: &&str| item.trim().parse::<f64>().is_ok_and(|length| length != 0.0);
                let with = |item: &str| {
                    if bare(&item) { format!("{}{unit}", item.trim()) } else { item.trim().to_owned() }
                };
                *value = value.split(',').map(with).collect::<Vec<_>>().join(",");
            }
            let default = spec.map(|spec| spec.default);
            // A dialog passes every parameter, with all the digits of its spin buttons.
            let same_number =
                || value.parse::<f64>().ok().zip(default?.parse::<f64>().ok()).map(|(a, b)| a == b);
            if default != Some(value.as_str()) && same_number() != Some(true) {
                values.set(generator.table, name, value)?;
            }
        }
        Ok(values)
    }

    fn take(&mut self, name: &str) -> Option<String> {
        let at = self.params.iter().position(|(other, _)| other == name)?;
        Some(self.params.remove(at).1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_call_is_read_as_inkscape_writes_it() {
        let arguments = ["--id=a b", "--id=c", "--tab=basic", "--tool=pack", "--min_gap=1.5", "/tmp/x=y.svg"]
            .map(OsString::from);
        assert!(called_by_inkscape(&arguments));
        let call = Call::parse(&arguments);
        assert_eq!(
            (call.tool.as_str(), call.ids.len(), call.file),
            ("pack", 2, Some(PathBuf::from("/tmp/x=y.svg")))
        );
        assert_eq!(call.params, [("min-gap".to_owned(), "1.5".to_owned())]);
    }
}
