//! The tests of the library, in one program: it is linked once, and its tests share all threads.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "a panic is a failed test"
)]

mod affine;
mod attack;
mod attractors;
mod closed_forms;
mod continuation;
mod cost;
mod counts;
mod cut;
mod diagram;
mod differential_equations;
mod errata;
mod examples;
mod face;
mod flow_properties;
mod fuzz_regressions;
mod judge;
#[cfg(feature = "lanes")]
mod lanes;
mod later_roots;
mod layers;
mod limit;
mod long_phases;
mod lyapunov;
mod orbits;
mod planted;
mod planted_surface;
mod reference;
mod remainders;
mod rounding;
mod strobe;
mod surface;
mod touches;
mod variation;

mod support;
