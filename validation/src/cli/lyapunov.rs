//! `lyapunov`: the exponents of one motion.

use super::help;
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
use percuss::dynamics::batches::{BATCHES, Batches, LEAST_COUNT, LEAST_LENGTH, Stationarity};
use percuss::dynamics::lyapunov::Spectrum;
use serde::Serialize;

/// Compute the Lyapunov exponents and the drift of one motion, with their errors
///
/// Answers whether a motion is chaotic, how fast it forgets a disturbance, and
/// how fast it goes forward on average.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = help::LYAPUNOV)]
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
    /// Null where too few batches tell.
    stationary: Option<bool>,
    contraction_per_period: f64,
    drift_per_period: f64,
    drift_standard_error: f64,
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
        batches: Batches::of(arguments.periods).count(),
        stationary: match found.stationarity {
            Stationarity::Unknown => None,
            Stationarity::Stationary => Some(true),
            Stationarity::ChangesAfter(_) => Some(false),
        },
        contraction_per_period: found.contraction_per_period,
        drift_per_period: found.drift_per_period,
        drift_standard_error: found.drift_standard_error,
    };
    arguments.output.destination().json(&json)?;
    if found.undecidable {
        note(
            "undecidable: rounding hides how a phase ends, no exponent is known; simulate with the \
             same flags shows the phase",
        );
    } else if let Some(endless) = found.endless {
        note(&endless_notice(endless));
    } else {
        tell_errors(arguments, found.stationarity);
    }
    Ok(!found.undecidable)
}

/// One line where the means and their errors are not those of a motion that has settled, or the
/// run is too short for errors that hold.
fn tell_errors(arguments: &Arguments, stationarity: Stationarity) {
    let Arguments { transient, periods, .. } = *arguments;
    if let Stationarity::ChangesAfter(after) = stationarity {
        let settled = rounded_up(transient + after + periods / BATCHES);
        note(&format!(
            "the motion changes on the way: the means of its batches differ before and after \
             {after} of {periods} forcing periods; --transient {settled} leaves that out"
        ));
    } else if periods < SHORT {
        note(&format!(
            "standard errors hold from {SHORT} forcing periods on: here they are of the right order \
             only"
        ));
    }
}

/// Runs of fewer forcing periods have errors of the right order only.
const SHORT: u64 = LEAST_COUNT * LEAST_LENGTH;

/// The next number with at most two digits that are not zero.
fn rounded_up(number: u64) -> u64 {
    let unit = 10_u64.pow(number.max(1).ilog10().saturating_sub(1));
    number.div_ceil(unit) * unit
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
