//! Cases are data: a model, a start, a horizon, and what is expected of each engine.

mod accepted;
mod bound;
mod classes;
mod expectations;
mod library;
mod located;
mod of_oscillator;
mod probed;
mod problem;
mod regime;
mod shortcomings;
mod system_case;
pub mod systems;
mod wire;

pub use accepted::accepted;
pub use bound::{Bound, NamePattern, Quantity, Shortcoming, Statistic};
pub use classes::ClassBounds;
pub use expectations::Defaults;
pub use library::{bounds_alone, defaults, embedded, from_directory, parse_case, shortcomings_of};
pub use located::{FileError, Origins, read_text};
pub use of_oscillator::{SAMPLES_PER_PERIOD, percussive_oscillator, place};
pub use percuss::affine::TROUBLE;
pub use probed::ProbedCase;
pub use problem::{Given, Problem};
pub use regime::Regime;
pub use system_case::parse_system_case;
pub use wire::{parse_problem, read_problem};

use crate::failure::Failure;
use crate::system::SystemProblem;
use percuss::Parameters;
use percuss::affine::System;

/// The end of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Horizon {
    /// The run ends this many forcing periods after the start.
    Periods(u32),
    /// The run ends at this time tau.
    Until(f64),
}

/// A case of the harness: a run of a piecewise-affine system, as `docs/SYSTEM_FORMAT.md` has it, or
/// of the paper's oscillator, which is the system `percussive-oscillator`.
#[derive(Clone, Debug)]
pub struct Case {
    /// Name, as in `-c` and in the reference data's file names.
    pub name: String,
    /// The path of the case's file; it begins with `cases/` for a case inside the binary.
    pub file: String,
    /// The text of the case's file.
    pub text: String,
    /// The reason for the case.
    pub why: String,
    /// The kinds of trouble that the case makes for integrators.
    pub trouble: Vec<String>,
    /// The system with the case's parameters and start.
    pub system: System,
    /// The clock's time at the horizon.
    pub until: f64,
    /// Whether the run goes back in time.
    pub backward: bool,
    /// The number of instants at which the state is tabulated, the start included.
    pub samples: u32,
    /// What a case that is written in the oscillator's own words says besides.
    pub oscillator: Option<OscillatorCase>,
    /// The bounds of this case, which come before the default bounds.
    pub bounds: Vec<Bound>,
    /// Expected failures of engines, with their reasons.
    pub shortcomings: Vec<Shortcoming>,
}

/// A case in the words of the paper's oscillator: its own parameters, a start by forcing cycles,
/// and a horizon in forcing periods.
#[derive(Clone, Debug)]
pub struct OscillatorCase {
    /// The regime that the case stands for.
    pub regime: Regime,
    /// The margin of a near miss or light touch: how far the gap's first maximum reaches beyond the
    /// surface (negative: stays short of it), units of displacement.
    pub margin: Option<f64>,
    /// The model at its start, checked.
    pub problem: Problem,
    /// The horizon, after the start.
    pub horizon: Horizon,
    /// The tests of engines on this case beyond its own run.
    pub probed: ProbedCase,
}

impl OscillatorCase {
    /// The model's parameters.
    #[must_use]
    pub fn parameters(&self) -> &Parameters {
        self.problem.model.parameters()
    }
}

impl Case {
    /// The case in the oscillator's own words.
    ///
    /// # Errors
    /// It is written in those of its system.
    pub fn of_oscillator(&self) -> Result<&OscillatorCase, FileError> {
        let lacking = || FileError::new(&self.file, "is no case in the oscillator's own words");
        self.oscillator.as_ref().ok_or_else(lacking)
    }

    /// The regime that the case stands for, or the kinds of trouble that it makes.
    #[must_use]
    pub fn kind(&self, separator: &str) -> String {
        let regime = self.oscillator.as_ref().map(|it| it.regime.to_string());
        regime.unwrap_or_else(|| self.trouble.join(separator))
    }

    /// The unit in which errors of times are counted: plain tau in the oscillator's own words, and
    /// else the system's.
    #[must_use]
    pub fn unit_of_time(&self) -> f64 {
        if self.oscillator.is_some() { 1.0 } else { self.system.time_scale }
    }

    /// Time from the start to the horizon.
    #[must_use]
    pub fn span(&self) -> f64 {
        let begin = self.system.start.as_ref().map(|start| start.time.to_f64());
        (self.until - begin.unwrap_or_default()).abs()
    }

    /// The length of the case in forcing periods, or in what stands for them.
    #[must_use]
    pub fn periods(&self) -> f64 {
        match self.oscillator.as_ref().map(|it| (it.horizon, it.problem.model.period())) {
            Some((Horizon::Periods(periods), _)) => f64::from(periods),
            Some((Horizon::Until(_), period)) => self.span() / period,
            None => self.span() / (std::f64::consts::TAU * self.system.time_scale),
        }
    }

    /// The system made ready to be run from the case's start.
    ///
    /// # Errors
    /// [`FileError`] for a system that the solver or the engines do not take.
    pub fn problem(&self) -> Result<SystemProblem, FileError> {
        SystemProblem::new(self.system.clone(), self.backward)
            .map_err(|failure: Failure| FileError::new(&self.file, failure))
    }

    /// The times since the start at which the state is tabulated, as far as `end`.
    #[must_use]
    pub fn sample_times(&self, end: f64) -> Vec<f64> {
        let time = |k: u32| self.span() * f64::from(k) / f64::from(self.samples);
        (0..self.samples).map(time).take_while(|time| *time <= end).collect()
    }
}
