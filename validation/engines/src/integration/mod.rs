//! What the runs of all integrators have in common: modes joined at their events, events located on
//! any dense output, states taken on the way, and every call counted, with a limit.
//!
//! The oscillator's equations stand here as an integrator's user writes them, in bounded
//! co-ordinates (`field.rs`) and in the paper's original ones (`original.rs`). Which library makes
//! the steps is not known here.

mod bracket;
mod crossing;
mod cubic;
mod field;
mod guard_cubic;
mod guard_values;
mod joining;
mod location;
mod meter;
mod original;
mod recorder;
mod sampler;
mod script;
mod step_ends;

pub(crate) use cubic::{Cubic, CubicEnd};
pub(crate) use field::Coordinates;
pub use field::{GUARDS, Oscillator, event_between};
pub(crate) use joining::{Integration, Moment, StretchEnd, Times, join};
pub(crate) use location::GuardSearch;
pub(crate) use meter::Meter;
pub use original::NOT_THE_OSCILLATOR;
pub(crate) use original::OriginalOscillator;
pub(crate) use sampler::{CountedCrossing, Sampler};
pub(crate) use script::GuardRise;
pub use script::Script;
pub(crate) use step_ends::{StepEnds, locate_at_step_ends, longest_of_period, longest_step};
