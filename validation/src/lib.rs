//! The `percuss` command, and all that stands behind it under one name: engines, cases, truth,
//! scores and reports.
//!
//! The exact solver lives in the crate `percuss` and knows nothing of this one. Here it is one
//! [`engine::Engine`] among others, held against tables ([`truth`]) that none of them knows.

pub mod cli;
pub mod provenance;
pub mod report;
pub mod returns;
pub mod sweep;
pub mod typed;
mod unfinished;

pub use percuss_bench as bench;
pub use percuss_engines::case::systems;
pub use percuss_engines::{case, engine, integration, integrators, number, system};
pub use percuss_harness::{gradients, power, score, suite, truth};
pub use percuss_paper as reproduce;
pub use percuss_pictures as picture;
pub use percuss_pictures::arrays;
