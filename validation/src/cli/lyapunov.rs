//! `lyapunov`: the exponents of one motion.

use super::endless::notice;
use super::model::{ModelFlags, ParametersJson};
use super::output::Destination;
use super::{say, work};
use anyhow::Result;
use clap::Args;
use percuss::dynamics::lyapunov::{BATCHES, Spectrum};
use serde::Serialize;
use std::path::PathBuf;

/// Lyapunov exponents with saltation
#[derive(Args)]
pub(super) struct Arguments {
    /// Forcing periods that are left out
    #[arg(long, value_name = "M")]
    transient: u64,
    /// Forcing periods over which the exponents are taken, at least 1
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    periods: u64,
    /// Where the JSON goes, - is stdout
    #[arg(long, value_name = "PATH")]
    output: Option<PathBuf>,
    #[command(flatten)]
    model: ModelFlags,
}

#[derive(Serialize)]
struct Json {
    schema: u32,
    percuss: &'static str,
    parameters: ParametersJson,
    exponents_per_period: [f64; 3],
    standard_error: [f64; 3],
    batches: u64,
    contraction_per_period: f64,
    drift_per_period: f64,
}

pub(super) fn run(arguments: &Arguments) -> Result<()> {
    let problem = arguments.model.problem()?;
    work::check_horizon(arguments.transient, arguments.periods)?;
    let life = work::sign_of_life("following errors");
    let found = Spectrum::of(&problem.model, problem.entry, arguments.transient, arguments.periods);
    life.finish_and_clear();
    let json = Json {
        schema: 1,
        percuss: env!("CARGO_PKG_VERSION"),
        parameters: problem.model.parameters().into(),
        exponents_per_period: found.exponents_per_period,
        standard_error: found.standard_error,
        batches: arguments.periods.min(BATCHES),
        contraction_per_period: found.contraction_per_period,
        drift_per_period: found.drift_per_period,
    };
    Destination::new(arguments.output.as_deref()).json(&json)?;
    if let Some(endless) = found.endless {
        say(&notice(endless));
    }
    Ok(())
}
