//! `lyapunov`: the exponents of one motion, of the impact oscillator or of a SYSTEM.

mod system;

use super::help;
use super::note;
use super::shared::format::OutputFlags;
use super::shared::long_work;
use super::shared::model::{ModelFlags, ParametersJson};
use super::shared::parse::{self, MAX_PERIODS};
use super::shared::progress::Progress;
use super::shared::section::{SectionFlags, without_system};
use super::shared::system_choice::SystemChoice;
use super::shared::terminal::endless_notice;
use crate::case::Problem;
use anyhow::{Result, bail};
use clap::{ArgGroup, Args, ValueEnum};
use percuss::Segment;
use percuss::dynamics::batches::{
    Batches, MAX_BATCHES, MIN_BATCH_PERIODS, MIN_BATCHES, Stationarity,
};
use percuss::dynamics::lyapunov::Spectrum;
use serde::Serialize;

/// The output format of exponents.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    Json,
}

/// Compute the Lyapunov exponents of one motion, with their errors; of the oscillator its drift too
///
/// Answers whether a motion is chaotic, how fast it forgets a disturbance, and
/// how fast it goes forward on average. Of a SYSTEM the motion is measured from
/// return to return to a section.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = help::LYAPUNOV)]
#[command(group(ArgGroup::new("length").required(true).args(["periods", "returns"])))]
pub(super) struct Arguments {
    #[command(flatten)]
    pub(super) system: SystemChoice,
    /// Forcing periods that are left out, with SYSTEM returns to the section
    #[arg(long, value_name = "M", value_parser = parse::whole::<u64>(0, MAX_PERIODS), allow_hyphen_values = true)]
    pub(super) transient: u64,
    /// Forcing periods over which the exponents are taken, at least 1
    #[arg(long, value_name = "N", value_parser = parse::whole::<u64>(1, MAX_PERIODS), allow_hyphen_values = true)]
    pub(super) periods: Option<u64>,
    /// With SYSTEM: returns to the section over which the exponents are taken, at least 1
    #[arg(long, value_name = "N", value_parser = parse::whole::<u64>(1, MAX_PERIODS), allow_hyphen_values = true)]
    pub(super) returns: Option<u64>,
    #[command(flatten)]
    pub(super) section: SectionFlags,
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
    if let Some(chosen) = arguments.system.chosen(&arguments.model)? {
        return system::run(arguments, &chosen, arguments.returns_of_system()?);
    }
    let periods = arguments.periods_of_oscillator()?;
    let problem = arguments.model.problem()?;
    long_work::check_horizon(arguments.transient, periods)?;
    let found = spectrum(arguments.transient, periods, &problem);
    let json = Json {
        schema: 1,
        percuss: env!("CARGO_PKG_VERSION"),
        parameters: problem.model.parameters().into(),
        exponents_per_period: found.exponents_per_period,
        standard_error: found.standard_error,
        batches: Batches::new(periods).count(),
        stationary: stationary(found.stationarity),
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
        tell_errors(arguments.transient, periods, found.stationarity);
    }
    Ok(!found.undecidable)
}

impl Arguments {
    /// The number of returns of a SYSTEM's motion.
    pub(super) fn returns_of_system(&self) -> Result<u64> {
        if let Some(periods) = self.periods {
            bail!("--periods {periods} is not accepted with SYSTEM: --returns is");
        }
        Ok(self.returns.unwrap_or(1))
    }

    /// The number of forcing periods of the impact oscillator's motion.
    pub(super) fn periods_of_oscillator(&self) -> Result<u64> {
        self.section.refuse()?;
        let returns = || without_system("--returns", &self.returns.unwrap_or(1));
        let Some(periods) = self.periods else { bail!("{}", returns()) };
        Ok(periods)
    }
}

/// Whether batches scatter about one value; nothing where too few tell.
const fn stationary(stationarity: Stationarity) -> Option<bool> {
    match stationarity {
        Stationarity::Unknown => None,
        Stationarity::Stationary => Some(true),
        Stationarity::ChangesAfter(_) => Some(false),
    }
}

/// One line where the means and their errors are not those of a motion that has settled, or the
/// run is too short for errors that hold.
fn tell_errors(transient: u64, periods: u64, stationarity: Stationarity) {
    if let Stationarity::ChangesAfter(after) = stationarity {
        let settled = rounded_up(transient + after + periods / MAX_BATCHES);
        note(&format!(
            "the motion changes on the way: the means of its batches differ before and after \
             {after} of {periods} forcing periods; --transient {settled} leaves that out"
        ));
    } else if periods < MIN_PERIODS {
        note(&format!(
            "standard errors hold from {MIN_PERIODS} forcing periods on: here they are of the right \
             order only"
        ));
    }
}

/// The forcing periods from which on standard errors hold; those of shorter runs are of the right
/// order only.
const MIN_PERIODS: u64 = MIN_BATCHES * MIN_BATCH_PERIODS;

/// The next number with at most two digits that are not zero.
fn rounded_up(number: u64) -> u64 {
    let unit = 10_u64.pow(number.max(1).ilog10().saturating_sub(1));
    number.div_ceil(unit) * unit
}

fn spectrum(transient: u64, periods: u64, problem: &Problem) -> Spectrum {
    let Problem { model, entry, .. } = problem;
    let end = entry.instant.after_periods(transient + periods, 1);
    let bar = Some(long_work::share_bar());
    let progress = Progress::new(bar, model.parameters().omega, entry.instant, &end);
    let mut seen = |segment: &Segment| progress.at(&segment.entry().instant);
    Spectrum::observe(model, *entry, transient, periods, &mut seen)
}
