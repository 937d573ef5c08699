//! The command line, a file a verb. What it promises is in the project's CONTRACT.

mod basins;
mod bench;
mod bifurcation;
mod endless;
mod engines;
mod format;
mod lyapunov;
mod model;
mod orbits;
mod output;
mod parse;
mod poincare;
mod reports;
mod reproduce;
mod simulate;
mod validate;
mod work;

use crate::engine::{self, Engine};
use clap::error::ErrorKind;
use clap::{Parser, Subcommand};
use std::ffi::OsString;
use std::io::{self, Write};
use std::process::ExitCode;

/// Done, and within bounds.
const DONE: u8 = 0;
/// Ran, and a bound failed or an engine erred.
const OUT_OF_BOUNDS: u8 = 1;
/// Bad usage, bad input, input or output that failed, or nothing selected.
const REFUSED: u8 = 2;

/// Exact solver of the visco-elastic impact oscillator with drift, and integrators held against it.
#[derive(Parser)]
#[command(name = "percuss", version, subcommand_required = true)]
struct Arguments {
    #[command(subcommand)]
    verb: Verb,
    /// Threads to use (default: all); results are the same for every number
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
}

#[derive(Subcommand)]
enum Verb {
    Simulate(Box<simulate::Arguments>),
    Poincare(Box<poincare::Arguments>),
    Lyapunov(Box<lyapunov::Arguments>),
    Bifurcation(Box<bifurcation::Arguments>),
    Attractors(Box<basins::AttractorArguments>),
    Basins(Box<basins::BasinArguments>),
    Engines(engines::Arguments),
    Validate(validate::Arguments),
    Reproduce(reproduce::Arguments),
    Bench(bench::Arguments),
    Orbit(Box<orbits::find::Arguments>),
    Continue(Box<orbits::follow::Arguments>),
}

/// Runs the command line with engines of another crate beside those of this one, and says how it went.
pub fn run_with(
    own: &[&'static dyn Engine],
    arguments: impl IntoIterator<Item = OsString>,
) -> ExitCode {
    match engine::add(own) {
        Ok(()) => run(arguments),
        Err(failure) => {
            say(&failure.to_string());
            ExitCode::from(REFUSED)
        }
    }
}

/// Runs the command line and says how it went.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let code = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => dispatch(&arguments),
        Err(error) => usage(&error),
    };
    ExitCode::from(code)
}

fn dispatch(arguments: &Arguments) -> u8 {
    let result = match &arguments.verb {
        Verb::Simulate(simulate) => {
            simulate::run(simulate).map(|decided| if decided { DONE } else { OUT_OF_BOUNDS })
        }
        Verb::Poincare(poincare) => poincare::run(poincare).map(|()| DONE),
        Verb::Lyapunov(lyapunov) => lyapunov::run(lyapunov).map(|()| DONE),
        Verb::Bifurcation(it) => bifurcation::run(it, arguments.threads).map(|()| DONE),
        Verb::Attractors(it) => basins::attractors(it, arguments.threads).map(|()| DONE),
        Verb::Basins(it) => basins::basins(it, arguments.threads).map(|()| DONE),
        Verb::Engines(engines) => engines::run(engines).map(|()| DONE),
        Verb::Validate(validate) => validate::run(validate, arguments.threads),
        Verb::Reproduce(reproduce) => reproduce::run(reproduce, arguments.threads),
        Verb::Bench(bench) => bench::run(bench),
        Verb::Orbit(orbit) => orbits::find::run(orbit),
        Verb::Continue(branch) => orbits::follow::run(branch),
    };
    match result {
        Ok(code) => code,
        Err(error) if output::reader_left(&error) => DONE,
        Err(error) => {
            say(&format!("{error:#}"));
            REFUSED
        }
    }
}

/// The verbs' names.
fn verbs() -> String {
    let command = <Arguments as clap::CommandFactory>::command();
    let names: Vec<_> = command.get_subcommands().map(|it| it.get_name().to_owned()).collect();
    names.join(", ")
}

/// One line on stderr.
fn say(line: &str) {
    let line = line.split_whitespace().collect::<Vec<_>>().join(" ");
    // Where stderr is closed there is no one to tell.
    let _ = writeln!(io::stderr(), "percuss: {line}");
}

/// What clap objects to, in one line; help and version are no objections.
fn usage(error: &clap::Error) -> u8 {
    match error.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => {
            let _ = error.print();
            DONE
        }
        ErrorKind::MissingSubcommand | ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => {
            say(&format!("no verb was given: accepted are {} (see percuss --help)", verbs()));
            REFUSED
        }
        _ => {
            let text = error.to_string();
            let text = text.strip_prefix("error: ").unwrap_or(&text);
            let end =
                ["\n\nUsage:", "\n\nFor more"].iter().filter_map(|mark| text.find(mark)).min();
            say(&text[..end.unwrap_or(text.len())]);
            REFUSED
        }
    }
}
