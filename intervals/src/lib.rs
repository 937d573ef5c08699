//! The events of the f64 solver, proved again in interval arithmetic: see docs/ROUNDING.md.

#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "a NaN must prove nothing")]

pub mod ball;
mod end;
pub mod frame;
pub mod functions;
pub mod guard;
mod hull;
pub mod proof;
pub mod regimes;
pub mod tally;
