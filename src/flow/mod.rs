//! The closed forms of the three phases (Section 3 of the paper), in the time elapsed in the phase.
//!
//! Every form is written in remainders that do not cancel, evaluates its guard with three
//! derivatives from the same sine, cosine and exponential, and imposes at its entry what is known
//! there: the double zero of the gap at separation, and the threshold at a switch of force.

pub mod constants;
pub mod contact;
pub mod damped;
pub mod forcing;
pub mod no_contact;
pub mod progression;
pub mod steps;

use crate::numeric::number::Number;
use crate::state::State;

/// A guard and its first three derivatives with respect to elapsed time.
#[derive(Clone, Copy, Debug)]
pub struct Jet<T> {
    /// Value and derivatives of orders 1, 2, 3.
    pub orders: [T; 4],
    /// The largest term that went into the value: its rounding error is a few eps of it.
    pub largest_term: T,
}

/// Everything a phase knows at one elapsed time.
#[derive(Clone, Copy, Debug)]
pub struct Point<T> {
    /// Time since the phase began.
    pub elapsed: T,
    /// Bounded co-ordinates.
    pub state: State<T>,
    /// Velocity of the slider's top relative to its bottom, q'.
    pub slider_velocity: T,
    /// Drift since the phase began.
    pub drift: T,
    /// Harmonic force a cos(omega tau + phi) and its first two derivatives. The static force b is
    /// left out, beside which a small harmonic force would lose its digits.
    pub force: [T; 3],
    /// The guard of the phase: the gap function h = p - q - g without contact, the trial force
    /// f = 2 xi y + q less its reference in contact, the drift velocity v' in progression.
    pub guard: Jet<T>,
}

/// A phase that can be evaluated anywhere.
pub trait Flow<T: Number> {
    /// The motion `elapsed >= 0` after the phase began.
    fn at(&self, elapsed: T) -> Point<T>;
}
