//! Runs the matrix of cases, engines and settings, and the probes beyond it.

mod matrix;
mod probes;
mod scope;
mod system;

pub use matrix::{
    CaseRun, Measured, Prepared, Scored, Status, one, prepare, probes_any, run, size,
};
pub use probes::{Extent, is_shown};
pub use scope::{Suite, SuiteScope};
pub use system::{PreparedSystem, prepare_systems};
