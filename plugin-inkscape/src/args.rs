//! The command line, made from the parameter tables.

use crate::{convert, render};
use clap::builder::ValueParser;
use clap::{Arg, ArgAction, ArgMatches, Command};
use rinceau::GENERATORS;
use rinceau::params::{Kind, ParamSpec};
use rinceau_format::Role;
use std::ffi::OsString;

/// Parses arguments; on wrong usage or `--help` prints and exits (2 or 0).
pub fn parse(arguments: &[OsString]) -> ArgMatches {
    command().no_binary_name(true).get_matches_from(arguments)
}

/// The whole command line.
pub fn command() -> Command {
    let mut command = Command::new("rinceau")
        .version(env!("CARGO_PKG_VERSION"))
        .about("Fills shapes with ornament, from the command line or inside Inkscape")
        .subcommand_required(true)
        .arg_required_else_help(true);
    for generator in GENERATORS {
        let mut sub =
            Command::new(generator.name).about(generator.about).arg(input()).arg(output()).arg(ids(false));
        sub = sub
            .arg(
                Arg::new("seed")
                    .long("seed")
                    .value_name("N")
                    .value_parser(clap::value_parser!(u64))
                    .default_value("1")
                    .help("Another seed, another composition"),
            )
            .arg(
                Arg::new("report")
                    .long("report")
                    .value_name("FILE")
                    .value_parser(clap::value_parser!(std::path::PathBuf))
                    .help("Write counts, warnings and timings as JSON"),
            )
            .arg(time_limit("Stop after this long and write the best so far"));
        for spec in generator.table {
            sub = sub.arg(parameter(spec));
        }
        command = command.subcommand(sub);
    }
    installing(command)
        .subcommand(
            Command::new("mark")
                .about("Give objects a role (or clear it)")
                .arg(role())
                .arg(input())
                .arg(output())
                .arg(ids(true)),
        )
        .subcommand(
            Command::new("tack")
                .about("Move objects exactly, held by marked tacks and dragged along a marked guide")
                .arg(operation())
                .arg(input())
                .arg(output())
                .arg(ids(true)),
        )
        .subcommand(
            Command::new("update")
                .about("Make every ornament again from its recipe, after its shapes were changed")
                .arg(input())
                .arg(output())
                .arg(time_limit("Stop each after this long and use the best so far")),
        )
        .subcommand(
            Command::new("resume")
                .about("Put the form of a step of an exploration back into the drawing, to be changed")
                .arg(input())
                .arg(output())
                .arg(ids(true)),
        )
        .subcommand(
            Command::new("check")
                .about("Say what the marks in a drawing mean, and everything that is wrong with them")
                .arg(input())
                .arg(
                    Arg::new("json")
                        .long("json")
                        .action(ArgAction::SetTrue)
                        .help("As JSON, for scripts; the exit code is 1 if there is an error"),
                ),
        )
        .subcommand(convert())
        .subcommand(
            Command::new("render")
                .hide(true)
                .about("Renders a drawing; 'convert' calls it")
                .arg(Arg::new("picture").required(true))
                .arg(Arg::new("width").required(true).value_parser(clap::value_parser!(u32))),
        )
}

/// What has to do with where the program is.
fn installing(command: Command) -> Command {
    let dir = || {
        Arg::new("dir")
            .long("dir")
            .value_name("DIR")
            .value_parser(clap::value_parser!(std::path::PathBuf))
            .help("Inkscape's user extensions folder, if it is not the usual one")
    };
    command
        .subcommand(Command::new("install").about("Install the Inkscape extension for this user").arg(dir()))
        .subcommand(
            Command::new("uninstall").about("Take the Inkscape extension of this user out again").arg(dir()),
        )
        .subcommand(
            Command::new("completions").about("Print what a shell needs to complete this command line").arg(
                Arg::new("shell")
                    .value_name("SHELL")
                    .required(true)
                    .value_parser(clap::value_parser!(clap_complete::Shell))
                    .help("The shell"),
            ),
        )
        .subcommand(
            Command::new("diagnostics")
                .about("Print versions, folders, the last run in Inkscape and the last error"),
        )
        .subcommand(Command::new("manual").about("Print the manual page, for man"))
}

fn convert() -> Command {
    let switch = |name: &'static str| Arg::new(name).long(name).action(ArgAction::SetTrue);
    Command::new("convert")
        .about("Write a drawing in another format")
        .arg(input().required(true))
        .arg(
            Arg::new("out")
                .value_name("OUTPUT")
                .required(true)
                .help("Where to write: .svg .svgz .json (the scene) .png .pdf .cfdg (recursive forms); '-' for standard output"),
        )
        .arg(
            Arg::new("from")
                .long("from")
                .value_name("FORMAT")
                .value_parser(convert::FROM)
                .help("What the input is, if its name and content do not say: colours gives roles to a diagram by its inks (black outlines, red arrows, green shapes and paths)"),
        )
        .arg(
            Arg::new("to")
                .long("to")
                .value_name("FORMAT")
                .value_parser(convert::TO)
                .help("What to write, if the name of the output does not say: colours draws the roles as such a diagram"),
        )
        .arg(switch("artwork-only").help("Leave out what is marked, hidden sublayers, recipes and all marks: the ornament to hand on"))
        .arg(switch("flat").help("The artwork as nothing but paths in page units, for cutters and plotters: clones, text and transforms resolved"))
        .arg(
            Arg::new("width")
                .long("width")
                .value_name("PIXELS")
                .value_parser(clap::value_parser!(u32).range(1..=i64::from(render::MOST_PIXELS)))
                .help("Width of a PNG; that of the page if not given"),
        )
}

fn input() -> Arg {
    Arg::new("input").value_name("INPUT").help("The drawing (SVG or svgz); standard input if absent or '-'")
}

fn output() -> Arg {
    // `--output` is a parameter of one generator.
    Arg::new("out").short('o').value_name("OUTPUT").help("Where to write; standard output if absent or '-'")
}

fn ids(required: bool) -> Arg {
    Arg::new("id")
        .long("id")
        .value_name("ID")
        .action(ArgAction::Append)
        .required(required)
        .help("An object by its id; may be given several times")
}

fn time_limit(help: &'static str) -> Arg {
    Arg::new("time-limit").long("time-limit").value_name("SECONDS").value_parser(seconds).help(help)
}

fn role() -> Arg {
    let names = Role::ALL.iter().map(|role| role.name()).chain(["none"]);
    Arg::new("role")
        .value_name("ROLE")
        .required(true)
        .value_parser(names.collect::<Vec<_>>())
        .help("What the objects mean; 'none' clears")
}

fn operation() -> Arg {
    let names = rinceau::tack::OPERATIONS.iter().map(|(name, ..)| *name);
    let tips = rinceau::tack::OPERATIONS.iter().map(|(name, _, tip)| format!("{name}: {tip}"));
    Arg::new("operation")
        .value_name("OPERATION")
        .required(true)
        .value_parser(names.collect::<Vec<_>>())
        .help(tips.collect::<Vec<_>>().join(". "))
}

fn seconds(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|s: &f64| s.is_finite() && *s > 0.0)
        .ok_or_else(|| "give a number of seconds above 0".to_owned())
}

fn parameter(spec: &'static ParamSpec) -> Arg {
    let check = move |text: &str| {
        spec.check(text.trim()).map(|()| text.trim().to_owned()).map_err(|error| error.to_string())
    };
    let value = match spec.kind {
        Kind::Length => "LENGTH",
        Kind::Number { .. } => "NUMBER",
        Kind::Whole { .. } => "N",
        Kind::Lengths => "LENGTH,...",
        Kind::Numbers { .. } => "NUMBER,...",
        Kind::Choice(_) => "CHOICE",
        Kind::Names(_) => "NAMES",
        Kind::Rules(_) => "FILE|NAME",
        Kind::Switch => "true|false",
    };
    Arg::new(spec.name)
        .long(spec.name)
        .value_name(value)
        .help(help(spec))
        // Numbers below zero look like options.
        .allow_hyphen_values(true)
        .value_parser(ValueParser::from(check))
}

/// The help text with values and default.
pub fn help(spec: &ParamSpec) -> String {
    let values = match spec.kind {
        Kind::Choice(choices) | Kind::Names(choices) | Kind::Rules(choices) => {
            let names: Vec<&str> = choices.iter().map(|(name, _)| *name).collect();
            format!(" ({})", names.join(", "))
        }
        Kind::Number { min, max } | Kind::Numbers { min, max } => format!(" ({min} to {max})"),
        Kind::Whole { min, max } => format!(" ({min} to {max})"),
        Kind::Length | Kind::Lengths | Kind::Switch => String::new(),
    };
    format!("{}{values} [default: {}]", spec.help, spec.default)
}
