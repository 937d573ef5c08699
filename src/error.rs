//! What can be wrong with what a user gives.

use crate::phase::Phase;
use std::fmt;

/// An input that is not accepted; each variant names the culprit and carries its value.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum InputError {
    /// A number is out of its range, infinite or not a number.
    OutOfRange {
        /// The paper's symbol, as in flags and files.
        name: &'static str,
        /// What was given.
        value: f64,
        /// What is accepted.
        accepted: &'static str,
    },
    /// The mass is beyond the slider's top.
    Penetrates {
        /// Displacement of the mass.
        p: f64,
        /// The slider's top plus the gap, which p must not exceed.
        limit: f64,
    },
    /// The stated phase is further than 1e-4 from the given state.
    FarFromPhase {
        /// The phase that was stated.
        phase: Phase,
        /// The variable that would have to move.
        name: &'static str,
        /// The value that was given.
        from: f64,
        /// The value that the phase asks for.
        to: f64,
    },
}

impl fmt::Display for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OutOfRange { name, value, accepted } => {
                write!(f, "{name} = {value:?} is not accepted: {accepted}")
            }
            Self::Penetrates { p, limit } => {
                write!(f, "p = {p:?} is not accepted: p <= q + g = {limit:?}")
            }
            Self::FarFromPhase { phase, name, from, to } => write!(
                f,
                "phase = {phase} is not accepted: it would move {name} from {from:?} to {to:?}, by more than 1e-4"
            ),
        }
    }
}

impl std::error::Error for InputError {}
