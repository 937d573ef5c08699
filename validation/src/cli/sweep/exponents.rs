//! `lyapunov` at the points of a sweep.

use crate::cli::lyapunov::Arguments;
use crate::cli::shared::long_work;
use crate::sweep::{Array, SweepPoint, SweepVerb, records};
use anyhow::Result;
use percuss::Endless;
use percuss::dynamics::batches::Stationarity;
use percuss::dynamics::lyapunov::Spectrum;

/// Exponents at each point; a point is one tile.
pub(super) struct ExponentWork {
    arguments: Arguments,
    periods: u64,
}

impl ExponentWork {
    pub(super) fn new(arguments: Arguments) -> Result<Self> {
        let periods = arguments.periods_of_oscillator()?;
        long_work::check_horizon(arguments.transient, periods)?;
        Ok(Self { arguments, periods })
    }
}

impl SweepVerb for ExponentWork {
    fn check(&self, point: &SweepPoint) -> Result<()> {
        self.arguments.model.at(point).problem().map(drop)
    }

    fn tile(&self, point: &SweepPoint, _tile: u32) -> Result<Vec<u8>> {
        let Arguments { transient, model, .. } = &self.arguments;
        let problem = model.at(point).problem()?;
        let found = Spectrum::new(&problem.model, problem.entry, *transient, self.periods);
        records::bytes(&arrays(&found))
    }
}

/// The arrays of the verb's JSON, with infinite exponents as they are.
fn arrays(found: &Spectrum) -> Vec<Array> {
    vec![
        Array::f8("exponents_per_period", &[3], found.exponents_per_period.to_vec()),
        Array::f8("standard_error", &[3], found.standard_error.to_vec()),
        Array::f8("contraction_per_period", &[], vec![found.contraction_per_period]),
        Array::f8("drift_per_period", &[], vec![found.drift_per_period]),
        Array::f8("drift_standard_error", &[], vec![found.drift_standard_error]),
        Array::i4("stationary", &[], vec![stationary(found.stationarity)]),
        Array::i4("endless", &[], vec![number_of(found.endless)]),
        Array::i4("undecidable", &[], vec![i32::from(found.undecidable)]),
    ]
}

/// The number in files of whether batches scatter about one value: -1 where too few tell.
pub(super) const fn stationary(stationarity: Stationarity) -> i32 {
    match stationarity {
        Stationarity::Unknown => -1,
        Stationarity::ChangesAfter(_) => 0,
        Stationarity::Stationary => 1,
    }
}

/// The number in files of a phase that never ends; -1 of a motion without one.
pub(super) const fn number_of(endless: Option<Endless>) -> i32 {
    match endless {
        None => -1,
        Some(Endless::NeverReturns) => 0,
        Some(Endless::NeverStops) => 1,
        Some(Endless::RestsForEver) => 2,
    }
}
