//! What is run and who runs it: cases as data, and engines, which are integrators as their experts
//! would set them up, beside the exact solver.
//!
//! The integrators' libraries are compiled here and nowhere else.

pub mod case;
pub mod engine;
pub mod number;
pub mod system;
