//! The command line, a file or a folder a verb; what several verbs share is in `shared`. What the
//! command line promises is in docs/COMMAND_LINE.md.

mod basins;
mod bench;
mod bifurcation;
mod cases;
mod check;
mod completions;
mod engines;
mod events;
mod export;
mod gradient;
mod help;
mod lyapunov;
mod man;
mod new;
mod orbits;
mod poincare;
mod proposals;
mod reproduce;
mod score;
mod shared;
mod simulate;
mod sweep;
mod systems;
mod validate;

use crate::engine::Engine;
use crate::integrators;
use clap::error::{ContextKind, ErrorKind};
use clap::{ColorChoice, Command, CommandFactory, FromArgMatches, Parser, Subcommand};
use shared::exit_codes::{DONE, OUT_OF_BOUNDS, REFUSED};
use shared::terminal::{note, say};
use shared::{output, parse, terminal};
use std::ffi::OsString;
use std::process::ExitCode;

/// Exact events of systems with impacts, friction and switches, and ODE solvers held against them
#[derive(Parser)]
#[command(name = "percuss", version, subcommand_required = true, after_help = help::PROGRAM)]
struct Arguments {
    #[command(subcommand)]
    verb: Verb,
    /// Threads to use (default: all); results are the same for every number
    #[arg(long, global = true, value_name = "N", value_parser = parse::whole::<u16>(1, 65535), allow_hyphen_values = true)]
    threads: Option<u16>,
    /// Says nothing but errors: no notes, no progress
    #[arg(long, global = true)]
    quiet: bool,
    /// Colours of help and messages; auto is where stderr or stdout is a terminal and NO_COLOR is
    /// not set
    #[arg(long, global = true, value_name = "WHEN", value_enum, default_value_t = ColorChoice::Auto)]
    color: ColorChoice,
}

#[derive(Subcommand)]
enum Verb {
    Validate(Box<validate::Arguments>),
    Score(Box<score::Arguments>),
    Export(export::Arguments),
    Engines(engines::Arguments),
    Cases(cases::Arguments),
    Bench(bench::Arguments),
    Events(events::Arguments),
    Gradient(gradient::Arguments),
    Systems(systems::Arguments),
    Check(check::Arguments),
    New(new::Arguments),
    Simulate(Box<simulate::Arguments>),
    Poincare(Box<poincare::Arguments>),
    Lyapunov(Box<lyapunov::Arguments>),
    Bifurcation(Box<bifurcation::Arguments>),
    Attractors(Box<basins::AttractorArguments>),
    Basins(Box<basins::BasinArguments>),
    Orbit(Box<orbits::find::Arguments>),
    Continue(Box<orbits::follow::Arguments>),
    Sweep(sweep::Arguments),
    Reproduce(reproduce::Arguments),
    Completions(completions::Arguments),
    Man(man::Arguments),
}

/// The command line with all its verbs and flags.
#[must_use]
pub fn command() -> Command {
    Arguments::command()
}

/// Runs the command line with engines of another crate beside those of this one, and says how it
/// went.
pub fn run_with(
    own: &[&'static dyn Engine],
    arguments: impl IntoIterator<Item = OsString>,
) -> ExitCode {
    match integrators::add(own) {
        Ok(()) => run(arguments),
        Err(failure) => {
            say(&failure.to_string());
            ExitCode::from(REFUSED)
        }
    }
}

/// Runs the command line and says how it went.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let words: Vec<OsString> = arguments.into_iter().collect();
    let color = terminal::stated_color(&words);
    terminal::configure(false, color);
    let parsed = command().color(color).try_get_matches_from(&words);
    let parsed = parsed.map_err(|error| missing_value(&words).unwrap_or(error));
    let code = match parsed.and_then(|it| Arguments::from_arg_matches(&it)) {
        Ok(arguments) => {
            terminal::configure(arguments.quiet, arguments.color);
            dispatch(&arguments)
        }
        Err(error) => usage(&error, &words),
    };
    ExitCode::from(code)
}

fn dispatch(arguments: &Arguments) -> u8 {
    let result = match &arguments.verb {
        Verb::Simulate(simulate) => simulate::run(simulate).map(code),
        Verb::Poincare(poincare) => poincare::run(poincare).map(code),
        Verb::Lyapunov(lyapunov) => lyapunov::run(lyapunov).map(code),
        Verb::Bifurcation(it) => bifurcation::run(it, arguments.threads).map(code),
        Verb::Attractors(it) => basins::attractors(it, arguments.threads).map(|()| DONE),
        Verb::Basins(it) => basins::basins(it, arguments.threads).map(|()| DONE),
        Verb::Engines(engines) => engines::run(engines).map(|()| DONE),
        Verb::Validate(validate) => validate::run(validate, arguments.threads),
        Verb::Export(export) => export::run(export).map(|()| DONE),
        Verb::Score(score) => score::run(score, arguments.threads),
        Verb::Reproduce(reproduce) => reproduce::run(reproduce, arguments.threads),
        Verb::Bench(bench) => bench::run(bench),
        Verb::Orbit(orbit) => orbits::find::run(orbit, arguments.threads),
        Verb::Continue(branch) => orbits::follow::run(branch),
        Verb::Sweep(sweep) => sweep::run(sweep, arguments.threads),
        Verb::Cases(cases) => cases::run(cases).map(|()| DONE),
        Verb::Events(events) => events::run(events),
        Verb::Gradient(gradient) => gradient::run(gradient),
        Verb::Systems(systems) => systems::run(systems).map(|()| DONE),
        Verb::Check(check) => check::run(check).map(|()| DONE),
        Verb::New(new) => new::run(new).map(|()| DONE),
        Verb::Completions(completions) => completions::run(completions).map(|()| DONE),
        Verb::Man(man) => man::run(man).map(|()| DONE),
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

/// The exit code of a run that was decided to its end, or not.
const fn code(decided: bool) -> u8 {
    if decided { DONE } else { OUT_OF_BOUNDS }
}

/// The verbs' names.
fn verbs() -> String {
    let names: Vec<_> = command().get_subcommands().map(|it| it.get_name().to_owned()).collect();
    names.join(", ")
}

/// What clap objects to, in one line; help and version are no objections.
fn usage(error: &clap::Error, words: &[OsString]) -> u8 {
    match error.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => {
            let _ = error.print();
            DONE
        }
        ErrorKind::MissingSubcommand | ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => {
            say(&format!("no verb was given: accepted are {} (see percuss --help)", verbs()));
            REFUSED
        }
        ErrorKind::InvalidSubcommand => {
            let verb = error.get(ContextKind::InvalidSubcommand);
            let verb = verb.map_or_else(String::new, |verb| format!("'{verb}' "));
            say(&format!("{verb}is no verb: accepted are {} (see percuss --help)", verbs()));
            REFUSED
        }
        ErrorKind::MissingRequiredArgument => {
            let tried = proposals::proposal(error, words);
            let tried = tried.map_or_else(String::new, |words| format!("; try {words}"));
            say(&format!("{}{tried}", objection(error)));
            REFUSED
        }
        _ => {
            say(&objection(error));
            REFUSED
        }
    }
}

/// The objection to a flag whose value is missing, where the next flag was taken for it: what
/// follows would be blamed otherwise.
fn missing_value(words: &[OsString]) -> Option<clap::Error> {
    let is_flag = |word: &OsString| word.to_str().is_some_and(|it| it.starts_with("--"));
    let pairs = words.windows(2).zip(1..);
    let mut pairs = pairs.filter(|(pair, _)| pair.iter().all(is_flag));
    pairs.find_map(|(pair, read)| {
        let error = command().try_get_matches_from(&words[..=read]).err()?;
        let told = error.get(ContextKind::InvalidValue)?.to_string();
        let is_it = error.kind() == ErrorKind::ValueValidation && told == pair[1].to_str()?;
        is_it.then_some(error)
    })
}

/// What clap objects to, and its tip, without what it says of usage.
fn objection(error: &clap::Error) -> String {
    let text = error.to_string();
    let text = text.strip_prefix("error: ").unwrap_or(&text);
    let end = ["\n\nUsage:", "\n\nFor more"].iter().filter_map(|mark| text.find(mark)).min();
    text[..end.unwrap_or(text.len())].replace("\n\n", "; ")
}
