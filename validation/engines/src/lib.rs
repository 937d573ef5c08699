//! What is run and who runs it: cases as data, and engines, which are integrators as their experts
//! would set them up, beside the exact solver.
//!
//! The integrators' libraries are compiled here and nowhere else.

mod accuracy;
pub mod case;
mod class;
pub mod engine;
mod equations;
mod failure;
pub mod integration;
pub mod integrators;
pub mod number;
pub mod system;
