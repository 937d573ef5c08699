//! The beginning of a run's rows, its horizon and its samples.

use super::super::Arguments;
use crate::cli::shared::long_work::Bar;
use crate::cli::shared::parse::{MAX_PERIODS, Typed};
use anyhow::{Result, anyhow, bail};
use percuss::affine::{LONGEST, StartPoint};
use percuss::{Solver, System};
use std::f64::consts::TAU;

/// A run to be made.
pub(super) struct PlannedRun<'a> {
    pub(super) solver: &'a Solver<f64>,
    start: &'a StartPoint,
    /// The time at which rows begin, where a transient is left out before.
    pub(super) transient: Option<f64>,
    /// The time at which the run ends at the latest.
    pub(super) horizon: f64,
    /// The run ends after so many events, if that is sooner.
    pub(super) events: Option<u64>,
    pub(super) samples: Option<Samples>,
    pub(super) bar: Option<&'a Bar>,
}

/// The instants of samples, from the first that is shown.
pub(super) struct Samples {
    start: f64,
    /// A forcing period, or the system's scale of time.
    unit: f64,
    parts: f64,
    first: u64,
    /// The number of samples, where returns are counted.
    count: Option<u64>,
}

impl Samples {
    /// The time of a sample.
    fn at(&self, n: u64) -> f64 {
        self.start + (self.first + n) as f64 * self.unit / self.parts
    }

    /// The time of a sample, unless it is beyond the end of the run.
    pub(super) fn time(&self, n: u64, horizon: f64) -> Option<f64> {
        let time = self.at(n);
        let is_within = self.count.map_or(time <= horizon, |count| n < count);
        is_within.then_some(time)
    }
}

impl<'a> PlannedRun<'a> {
    pub(super) fn new(
        solver: &'a Solver<f64>,
        arguments: &Arguments,
        bar: Option<&'a Bar>,
    ) -> Result<Self> {
        let system = solver.system();
        let start = system.start()?;
        let (begins, unit) = (start.time.to_f64(), unit(system));
        let (left_out, returns) = returns(arguments, system)?;
        let samples = arguments.samples.map(|parts| Samples {
            start: begins,
            unit,
            parts: f64::from(parts),
            first: left_out * u64::from(parts),
            count: returns.map(|count| count * u64::from(parts) + 1),
        });
        let first_sample = samples.as_ref().map(|it| it.at(0));
        let first_return = || begins + left_out as f64 * unit;
        let transient = (left_out > 0).then(|| first_sample.unwrap_or_else(first_return));
        let first_row = transient.unwrap_or(begins);
        let horizon = match (&arguments.until, returns) {
            (Some(until), _) => checked(until, first_row, left_out)?,
            (None, Some(count)) => begins + (left_out + count) as f64 * unit,
            (None, None) => first_row + LONGEST * system.time_scale,
        };
        Ok(Self { solver, start, transient, horizon, events: arguments.events, samples, bar })
    }

    pub(super) fn system(&self) -> &'a System {
        self.solver.system()
    }

    /// The time up to which the run goes first.
    pub(super) fn first_stop(&self) -> f64 {
        let start = self.start.time.to_f64();
        let usual = if self.samples.is_some() { start } else { self.horizon };
        self.transient.unwrap_or(usual)
    }

    /// Shows the share of the run that is done: of its time, or of its events where that is more.
    pub(super) fn show_progress(&self, time: f64, events: u64) {
        let Some(bar) = self.bar else { return };
        let start = self.start.time.to_f64();
        let of_time = (time - start) / (self.horizon - start);
        let of_events = self.events.map_or(0.0, |wanted| events as f64 / wanted as f64);
        bar.show_share(of_time.max(of_events).clamp(0.0, 1.0));
    }
}

/// The unit of time of which samples take parts: a forcing period, or the system's scale of time.
fn unit(system: &System) -> f64 {
    let of = |omega: f64| TAU / omega;
    system.forcing.as_ref().map_or(system.time_scale, |it| of(it.omega.to_f64()))
}

/// The returns that are left out, and those that are wanted where the run's length is so many.
fn returns(arguments: &Arguments, system: &System) -> Result<(u64, Option<u64>)> {
    let given = match (arguments.returns, arguments.transient) {
        (Some(count), _) => format!("--returns {count}"),
        (None, Some(count)) => format!("--transient {count}"),
        (None, None) => return Ok((0, None)),
    };
    if system.forcing.is_none() {
        bail!(
            "{given} is not accepted: {} is not forced, so that no forcing period makes a return; \
             --events and --until are accepted",
            system.name
        );
    }
    let left_out = arguments.transient.unwrap_or(0);
    let whole = left_out.saturating_add(arguments.returns.unwrap_or(0));
    if whole > MAX_PERIODS {
        bail!(
            "--transient and --returns make {whole} forcing periods: accepted are at most \
             {MAX_PERIODS}"
        );
    }
    Ok((left_out, arguments.returns))
}

/// The end of a run that `--until` states.
fn checked(until: &Typed<f64>, first_row: f64, left_out: u64) -> Result<f64> {
    if until.value.is_finite() && until.value >= first_row {
        return Ok(until.value);
    }
    let after = match left_out {
        0 => format!("the start at {first_row}"),
        _ => format!("the end of --transient {left_out} at {first_row}"),
    };
    Err(anyhow!("--until {until} is not accepted: a finite time at or after {after} is"))
}
