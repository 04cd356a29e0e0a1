//! `rinceau`: the command line and the Inkscape extension in one binary.

mod args;
mod check;
mod convert;
mod diagnostics;
mod inkscape;
mod install;
mod inx;
mod output;
mod progress;
#[cfg(test)]
mod reference;
mod render;
mod run;
mod update;

use rinceau_format::Error;
use std::panic::AssertUnwindSafe;
use std::process::ExitCode;
use std::sync::{Arc, Mutex};

/// Ornament is many small things, made on all cores.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    let arguments: Vec<_> = std::env::args_os().skip(1).collect();
    // Inkscape passes the hidden parameter `tool`; a person never does.
    if inkscape::called_by_inkscape(&arguments) {
        return inkscape::run(&arguments);
    }
    match unbroken(|| run::command(&args::parse(&arguments))) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("rinceau: {error}");
            ExitCode::from(1)
        }
    }
}

/// The last resort: a mistake in this program becomes a sentence, and files stay as they are.
pub fn unbroken<T>(work: impl FnOnce() -> Result<T, Error>) -> Result<T, Error> {
    let hook = std::panic::take_hook();
    let place = Arc::new(Mutex::new(String::new()));
    let noted = Arc::clone(&place);
    std::panic::set_hook(Box::new(move |info| {
        if let (Ok(mut noted), Some(at)) = (noted.lock(), info.location()) {
            *noted = format!("{}:{}", at.file(), at.line());
        }
    }));
    let result = std::panic::catch_unwind(AssertUnwindSafe(work));
    std::panic::set_hook(hook);
    result.unwrap_or_else(|_| {
        let at = place.lock().map(|at| at.clone()).unwrap_or_default();
        let sentence = format!("Rinceau made a mistake of its own ({at}); nothing was changed");
        Err(Error::new("internal", sentence, "Please report it, with the drawing if you can"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_a_sentence() {
        let error = unbroken(|| -> Result<(), Error> { panic!("a mistake") }).unwrap_err();
        assert_eq!(error.code(), "internal");
        assert!(error.sentence().contains("main.rs:"), "{error}");
        assert_eq!(unbroken(|| Ok(7)).unwrap(), 7);
    }
}
