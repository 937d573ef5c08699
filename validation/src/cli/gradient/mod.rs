//! `gradient`: the derivatives of a system's events by parameters and starts, with digits that are
//! proved.

mod rows;
mod write;

use super::help;
use super::shared::format::OutputFlags;
use super::shared::horizon::horizon;
use super::shared::parse::{self, Typed};
use super::shared::system_choice::SystemFlags;
use super::{DONE, OUT_OF_BOUNDS, note};
use anyhow::{Context, Result, bail};
use clap::{ArgGroup, Args, ValueEnum};
use percuss::{Proved, Solver};
use rows::{Rows, RunEnd};
use std::path::PathBuf;

/// Print the derivatives of a system's events, every digit of them proved
///
/// Answers how the time of each event, the state just after it and the state at
/// the end change with a parameter of the system or with its start. They are the
/// derivatives of the exact solution, through all events before. The system is a
/// file of your own or a name of `percuss systems`.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = help::GRADIENT)]
#[command(group(ArgGroup::new("length").required(true).args(["until", "events"])))]
pub(super) struct Arguments {
    /// A *.system.toml, or a name that `percuss systems` prints
    #[arg(value_name = "SYSTEM")]
    system: PathBuf,
    /// Ends at this time
    #[arg(long, value_name = "T", value_parser = parse::time, allow_hyphen_values = true)]
    until: Option<Typed<f64>>,
    /// Ends after this many events
    #[arg(long, value_name = "N", value_parser = parse::whole::<usize>(1, 1_000_000_000), allow_hyphen_values = true)]
    events: Option<usize>,
    /// Parameters, and start.STATE for a state at the start, with commas
    #[arg(long, value_name = "NAMES", allow_hyphen_values = true)]
    wrt: String,
    /// The most significant digits of a number, 17 or 25 [default: 17]
    #[arg(long, value_name = "D", value_parser = ["17", "25"])]
    digits: Option<String>,
    #[command(flatten)]
    output: OutputFlags<Format>,
    #[command(flatten)]
    flags: SystemFlags,
}

/// The output format of the derivatives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    Csv,
    Json,
}

pub(super) fn run(arguments: &Arguments) -> Result<u8> {
    let format = arguments.output.format(Format::Csv)?;
    let system = arguments.flags.system(&arguments.system)?.system()?;
    let solver: Solver<Proved> = system.solver()?;
    let names = names(&arguments.wrt)?;
    let refused = || format!("--wrt {}", arguments.wrt);
    let digits = if arguments.digits.as_deref() == Some("25") { 25 } else { 17 };
    let run = solver.run().digits(digits).gradients(&names).with_context(refused)?;
    let start = system.start()?.time.to_f64();
    let events = run.until(horizon(arguments.until.as_ref(), &system, start, false)?)?;
    let rows = Rows { system: &system, names: &names, digits, limit: arguments.events };
    let mut end = RunEnd::default();
    arguments.output.destination().write(|out| {
        end = match format {
            Format::Csv => write::csv(&rows, events, out)?,
            Format::Json => write::json(&rows, events, out)?,
        };
        Ok(())
    })?;
    end.notes.iter().for_each(|it| note(it));
    Ok(if end.is_open { OUT_OF_BOUNDS } else { DONE })
}

/// The names by which is differentiated, each once.
fn names(wrt: &str) -> Result<Vec<String>> {
    let names: Vec<String> = wrt.split(',').map(|it| it.trim().to_owned()).collect();
    let accepted = "accepted are parameters and start.STATE, with commas between them";
    if names.iter().any(String::is_empty) {
        bail!("--wrt {wrt}: a name is missing: {accepted}");
    }
    if let Some(twice) = names.iter().enumerate().find(|(n, it)| names[..*n].contains(it)) {
        bail!("--wrt {wrt}: {} is there twice: {accepted}, each once", twice.1);
    }
    Ok(names)
}
