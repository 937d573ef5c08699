//! The `percuss` command and what stands behind it: engines, cases, truth, scores and reports.
//!
//! The exact solver lives in the crate `percuss` and knows nothing of this one. Here it is one
//! [`engine::Engine`] among others, held against tables ([`truth`]) that none of them knows.

pub mod arrays;
pub mod bench;
pub mod build;
pub mod case;
pub mod cli;
pub mod engine;
pub mod number;
pub mod picture;
pub mod power;
pub mod report;
pub mod reproduce;
pub mod score;
pub mod suite;
pub mod truth;
