//! `cases`: what engines are held to.

use super::help;
use super::shared::format::OutputFlags;
use super::shared::list::{self, Format};
use crate::case::{Case, Cases, FileError, Horizon, SystemCase};
use crate::report::OSCILLATOR;
use crate::truth::Library;
use anyhow::{Context, Result};
use clap::Args;
use percuss::Instant;
use serde::Serialize;
use std::path::PathBuf;

/// List the cases that validate and bench run
///
/// Answers what engines are asked, and why each case is there. The names are what
/// -c of `validate`, `bench` and `export` selects from.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = help::CASES)]
pub(super) struct Arguments {
    /// Reads the cases from this folder instead of those inside the binary
    #[arg(long, value_name = "DIR")]
    cases: Option<PathBuf>,
    #[command(flatten)]
    output: OutputFlags<Format>,
}

#[derive(Serialize)]
struct Line {
    name: String,
    regime: String,
    system: String,
    events: usize,
    periods: f64,
    table: String,
    why: String,
}

#[derive(Serialize)]
struct List<'a> {
    schema: u32,
    percuss: &'static str,
    cases: &'a [Line],
}

pub(super) fn run(arguments: &Arguments) -> Result<()> {
    let format = arguments.output.format(Format::Csv)?;
    let (cases, library) = match &arguments.cases {
        Some(folder) => {
            let cases = Cases::from_directory(folder).context("--cases")?;
            (cases, Library::embedded()?.replaying())
        }
        None => (Cases::embedded()?, Library::embedded()?),
    };
    let oscillator = cases.oscillator.iter().map(|case| line(case, &library));
    let systems = cases.systems.iter().map(|case| line_of_system(case, &library));
    let mut lines: Vec<Line> = oscillator.chain(systems).collect::<Result<_, _>>()?;
    lines.sort_by(|a, b| a.name.cmp(&b.name));
    let list = List { schema: 1, percuss: env!("CARGO_PKG_VERSION"), cases: &lines };
    list::write(&arguments.output, format, &list, &lines)
}

fn line(case: &Case, library: &Library) -> Result<Line, FileError> {
    Ok(Line {
        name: case.name.clone(),
        regime: case.regime.to_string(),
        system: OSCILLATOR.to_owned(),
        events: library.truth(case)?.events.len(),
        periods: periods(case),
        table: library.table(&case.name).unwrap_or_default(),
        why: case.why.clone(),
    })
}

fn line_of_system(case: &SystemCase, library: &Library) -> Result<Line, FileError> {
    let period = std::f64::consts::TAU * case.system.time_scale;
    Ok(Line {
        name: case.name.clone(),
        regime: case.trouble.join(" "),
        system: case.system.name.clone(),
        events: library.system_truth(case)?.events.len(),
        periods: case.span() / period,
        table: library.table(&case.name).unwrap_or_default(),
        why: case.why.clone(),
    })
}

/// The horizon after the start, in forcing periods.
fn periods(case: &Case) -> f64 {
    let tau = match case.horizon {
        Horizon::Periods(periods) => return f64::from(periods),
        Horizon::Until(tau) => tau,
    };
    let omega = case.parameters.omega;
    let start = Instant::at(omega, case.start.tau, case.start.cycle);
    Instant::at(omega, tau, 0).since(&start, omega).value() * omega / std::f64::consts::TAU
}
