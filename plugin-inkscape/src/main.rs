//! `rinceau`: the command line and the Inkscape extension in one binary.

mod args;
mod check;
mod inkscape;
mod install;
mod inx;
mod output;
mod progress;
#[cfg(test)]
mod reference;
mod run;
mod update;

use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<_> = std::env::args_os().skip(1).collect();
    // Inkscape passes the hidden parameter `tool`; a person never does.
    if inkscape::called_by_inkscape(&arguments) {
        return inkscape::run(&arguments);
    }
    match run::command(&args::parse(&arguments)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("rinceau: {error}");
            ExitCode::from(1)
        }
    }
}
