//! Scores of any piecewise-affine system: its events by their names, its grazes and decisions, the
//! measures of a run and the restart test, in modes and units of the system's own scales.

mod decisions;
mod event_names;
mod grazes;
mod measure;
mod restart;

pub use decisions::{Decision, decisions};
pub use event_names::EventNames;
pub use grazes::system_grazes;
pub use measure::{SystemScale, measure_system};
pub use restart::{SystemRestartRun, SystemRestartTest};
