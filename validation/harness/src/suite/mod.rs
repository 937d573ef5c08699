//! What is run: the whole matrix, and the probes beyond it.

mod matrix;
mod probes;
mod scope;

pub use matrix::{Prepared, Scored, Status, prepare, run, size};
pub use probes::{Extent, is_shown};
pub use scope::Suite;
