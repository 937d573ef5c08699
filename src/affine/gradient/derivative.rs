//! The derivatives of an event, or the reason why it has none.

use crate::numeric::number::Number;
use std::fmt;

/// The derivatives of an event: each is within an error of its value, in a run that follows its
/// errors.
#[derive(Clone, Debug)]
pub struct Gradient<T: Number> {
    /// The derivative of the event's time, with its error.
    pub time: (T, T::Bound),
    /// The derivatives of the states just after the event, at its moving time, with their errors.
    pub state: Vec<(T, T::Bound)>,
}

/// A side of a name's value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Smaller values.
    Below,
    /// Larger values.
    Above,
}

/// The reason why an event of a run, and each that follows, has no derivative by a name, or none
/// that is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum NoGradient {
    /// A guard, or a condition of a successor, is zero without being so to first order: the
    /// derivatives on the two sides differ.
    OneSided,
    /// A guard, or a condition of a successor, is zero for this value of the name and not for
    /// others, though it is so to first order.
    HigherOrder,
    /// On this side of the name's value the run has other events from there on.
    OtherEvents,
    /// A guard touches zero without crossing, so that it crosses on one side or the other.
    Touch,
    /// The bits do not tell a value from zero that has to differ from it: the rate of a guard that
    /// fires, or the value of another.
    Undecided,
    /// The run passes the limit of infinitely many impacts, across which none is taken.
    Accumulation,
    /// The run ended, or its numbers are too large.
    Unknown,
}

impl fmt::Display for NoGradient {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::OneSided => "a zero there does not hold to first order: it has two sides",
            Self::HigherOrder => "a zero there is one of this value alone, if to first order",
            Self::OtherEvents => "the run has other events on that side",
            Self::Touch => "a guard touches zero without crossing: it has two sides",
            Self::Undecided => "a graze, a tie or an event at the horizon, or too few digits",
            Self::Accumulation => {
                "the run passes an accumulation of impacts, and none is taken there"
            }
            Self::Unknown => "the motion is not known",
        })
    }
}

impl std::error::Error for NoGradient {}
