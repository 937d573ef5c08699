//! Cases are data: a model, a start, a horizon, and what is expected of each engine.

mod accepted;
mod bound;
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
pub use expectations::Defaults;
pub use library::{
    Cases, defaults, defaults_of_own_cases, embedded, from_directory, shortcomings_of,
};
pub use located::{FileError, Origins, read_text};
pub use of_oscillator::{percussive_oscillator, place};
pub use percuss::affine::TROUBLE;
pub use probed::ProbedCase;
pub use problem::{Given, Problem};
pub use regime::Regime;
pub use system_case::{SystemCase, parse_system_case};
pub use wire::{parse_case, parse_problem, read_problem};

use percuss::{Parameters, Start};

/// The end of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Horizon {
    /// The run ends this many forcing periods after the start.
    Periods(u32),
    /// The run ends at this time tau.
    Until(f64),
}

/// A case of the harness.
#[derive(Clone, Debug)]
pub struct Case {
    /// Name, as in `-c` and in the reference data's file names.
    pub name: String,
    /// The path of the case's file; it begins with `cases/` for a case inside the binary.
    pub file: String,
    /// The text of the case's file.
    pub text: String,
    /// The regime that the case stands for.
    pub regime: Regime,
    /// The reason for the case.
    pub why: String,
    /// The margin of a near miss or light touch: how far the gap's first maximum reaches beyond the
    /// surface (negative: stays short of it), units of displacement.
    pub margin: Option<f64>,
    /// The model, checked.
    pub parameters: Parameters,
    /// The start, checked.
    pub start: Start,
    /// The horizon, after the start.
    pub horizon: Horizon,
    /// The tests of engines on this case beyond its own run.
    pub probed: ProbedCase,
    /// The bounds of this case, which come before the default bounds.
    pub bounds: Vec<Bound>,
    /// Expected failures of engines, with their reasons.
    pub shortcomings: Vec<Shortcoming>,
}
