//! Versions against each other.

pub mod binaries;
pub mod process;
pub mod recorded;
pub mod verdict;
pub mod worker;

pub use verdict::WorkloadVerdict;
