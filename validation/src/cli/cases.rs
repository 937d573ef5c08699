//! `cases`: what engines are held to.

use super::format::OutputFlags;
use super::list::{self, Format};
use crate::case::{self, Case, FileError, Horizon, Regime};
use crate::truth::Library;
use anyhow::{Context, Result};
use clap::Args;
use percuss::Instant;
use serde::Serialize;
use std::path::PathBuf;

/// List the cases that validate and bench run
#[derive(Args)]
pub(super) struct Arguments {
    /// Reads the cases from this folder instead of those inside the binary
    #[arg(long, value_name = "DIR")]
    cases: Option<PathBuf>,
    #[command(flatten)]
    output: OutputFlags<Format>,
}

/// The model that all cases are of.
const SYSTEM: &str = "oscillator";

#[derive(Serialize)]
struct Line {
    name: String,
    regime: Regime,
    system: &'static str,
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
            let cases = case::from_directory(folder).context("--cases")?;
            (cases, Library::embedded()?.replaying())
        }
        None => (case::embedded()?, Library::embedded()?),
    };
    let lines: Vec<Line> =
        cases.iter().map(|case| line(case, &library)).collect::<Result<_, _>>()?;
    let list = List { schema: 1, percuss: env!("CARGO_PKG_VERSION"), cases: &lines };
    list::write(&arguments.output, format, &list, &lines)
}

fn line(case: &Case, library: &Library) -> Result<Line, FileError> {
    Ok(Line {
        name: case.name.clone(),
        regime: case.regime.clone(),
        system: SYSTEM,
        events: library.truth(case)?.events.len(),
        periods: periods(case),
        table: library.table(case).unwrap_or_default(),
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
