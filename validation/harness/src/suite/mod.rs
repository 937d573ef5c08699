//! Runs the matrix of cases, engines and settings, and the probes beyond it.

pub mod first_wrong;
mod matrix;
mod prepared;
mod probes;
mod scope;

pub use matrix::{CaseTraits, Scored, Status, class_of, one, probes_any, run, size};
pub use prepared::{Measured, PreparedCase, prepare};
pub use probes::{Extent, is_shown};
pub use scope::{Suite, SuiteScope};
