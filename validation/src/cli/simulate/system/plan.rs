//! The beginning of a run's rows, its horizon and its samples.

use super::super::Arguments;
use super::section::counted;
use crate::cli::shared::long_work::Bar;
use crate::cli::shared::parse::Typed;
use crate::returns::{CountedReturns, Strobes};
use anyhow::{Result, anyhow};
use percuss::affine::{MAX_HORIZON, StartPoint};
use percuss::{Solver, System};
use std::f64::consts::TAU;

/// A run to be made.
pub(super) struct PlannedRun<'a> {
    pub(super) solver: &'a Solver<f64>,
    start: &'a StartPoint,
    /// The returns in which the run is measured, if it is in any.
    pub(super) returns: Option<CountedReturns>,
    /// The time at which rows begin, where a transient is left out before whose end is known.
    pub(super) transient: Option<f64>,
    /// The time at which the run ends at the latest.
    pub(super) horizon: f64,
    /// Whether `--until` states that time.
    pub(super) is_timed: bool,
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
    /// The number of samples, where they begin and end at returns.
    count: Option<u64>,
}

impl Samples {
    /// Samples from the start, or from the end of the transient.
    fn new(begins: f64, unit: f64, parts: u32, strobes: Option<&Strobes>) -> Self {
        let per_unit = u64::from(parts);
        let from =
            |start, first, count| Self { start, unit, parts: f64::from(parts), first, count };
        match strobes.filter(|it| it.left_out > 0 || it.zeroth == begins) {
            None => from(begins, 0, None),
            Some(strobes) => {
                let per_return = per_unit * strobes.every;
                let count = strobes.wanted.map(|wanted| wanted * per_return + 1);
                from(strobes.zeroth, strobes.left_out * per_return, count)
            }
        }
    }

    /// The time of a sample.
    pub(super) fn at(&self, n: u64) -> f64 {
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
        let returns = counted(arguments, solver)?;
        let (begins, unit) = (start.time.to_f64(), unit(system));
        let strobes = match &returns {
            Some(CountedReturns::Strobes(strobes)) => Some(strobes),
            _ => None,
        };
        let transient = strobes.filter(|it| it.left_out > 0).map(Strobes::first);
        let first_row = transient.unwrap_or(begins);
        let last = strobes.and_then(Strobes::last);
        let samples = arguments.samples.map(|parts| Samples::new(begins, unit, parts, strobes));
        let left_out = arguments.transient.unwrap_or(0);
        let horizon = match (&arguments.until, last) {
            (Some(until), _) => checked(until, first_row, left_out)?,
            (None, Some(last)) => last,
            (None, None) => first_row + MAX_HORIZON * system.time_scale,
        };
        let (events, is_timed) = (arguments.events, arguments.until.is_some());
        Ok(Self { solver, start, returns, transient, horizon, is_timed, events, samples, bar })
    }

    pub(super) fn system(&self) -> &'a System {
        self.solver.system()
    }

    /// The time up to which the run goes first.
    pub(super) fn first_stop(&self) -> f64 {
        let start = self.start.time.to_f64();
        match &self.returns {
            _ if self.samples.is_some() && self.transient.is_none() => start,
            Some(CountedReturns::Events(returning)) if !self.is_timed => start + returning.longest,
            _ => self.transient.unwrap_or(self.horizon),
        }
    }

    /// Shows the share of the run that is done: of its time, or this one where that is more.
    pub(super) fn show_progress(&self, time: f64, share: f64) {
        let Some(bar) = self.bar else { return };
        let start = self.start.time.to_f64();
        let of_time = (time - start) / (self.horizon - start);
        bar.show_share(of_time.max(share).clamp(0.0, 1.0));
    }

    /// The share of the events that are wanted, if a number of them is.
    pub(super) fn share_of_events(&self, events: u64) -> f64 {
        self.events.map_or(0.0, |wanted| events as f64 / wanted as f64)
    }
}

/// The unit of time of which samples take parts: a forcing period, or the system's scale of time.
fn unit(system: &System) -> f64 {
    let of = |omega: f64| TAU / omega;
    system.forcing.as_ref().map_or(system.time_scale, |it| of(it.omega.to_f64()))
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
