//! `lyapunov`: the exponents of one motion.

use super::note;
use super::orbits::Format;
use super::shared::format::OutputFlags;
use super::shared::long_work;
use super::shared::model::{ModelFlags, ParametersJson};
use super::shared::parse::{self, MAX_PERIODS};
use super::shared::progress::Progress;
use super::shared::terminal::endless_notice;
use crate::case::Problem;
use anyhow::Result;
use clap::Args;
use percuss::Segment;
use percuss::dynamics::lyapunov::{BATCHES, Spectrum};
use serde::Serialize;

/// Lyapunov exponents with saltation
#[derive(Args)]
pub(super) struct Arguments {
    /// Forcing periods that are left out
    #[arg(long, value_name = "M", value_parser = parse::whole::<u64>(0, MAX_PERIODS), allow_hyphen_values = true)]
    pub(super) transient: u64,
    /// Forcing periods over which the exponents are taken, at least 1
    #[arg(long, value_name = "N", value_parser = parse::whole::<u64>(1, MAX_PERIODS), allow_hyphen_values = true)]
    pub(super) periods: u64,
    #[command(flatten)]
    output: OutputFlags<Format>,
    #[command(flatten)]
    pub(super) model: ModelFlags,
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

/// Writes the exponents; whether the motion was decided to its end.
pub(super) fn run(arguments: &Arguments) -> Result<bool> {
    arguments.output.format(Format::Json)?;
    let problem = arguments.model.problem()?;
    long_work::check_horizon(arguments.transient, arguments.periods)?;
    let found = spectrum(arguments, &problem);
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
    arguments.output.destination().json(&json)?;
    if found.undecidable {
        note(
            "undecidable: rounding hides how a phase ends, no exponent is known; simulate with the \
             same flags shows the phase",
        );
    } else if let Some(endless) = found.endless {
        note(&endless_notice(endless));
    }
    Ok(!found.undecidable)
}

fn spectrum(arguments: &Arguments, problem: &Problem) -> Spectrum {
    let Arguments { transient, periods, .. } = *arguments;
    let Problem { model, entry, .. } = problem;
    let end = entry.instant.after_periods(transient + periods, 1);
    let bar = Some(long_work::share_bar());
    let progress = Progress::new(bar, model.parameters().omega, entry.instant, &end);
    let mut seen = |segment: &Segment| progress.at(&segment.entry().instant);
    Spectrum::told(model, *entry, transient, periods, &mut seen)
}
