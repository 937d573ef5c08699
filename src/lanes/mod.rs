//! Many motions at once: phases of one kind, one a lane of the processor's vectors.
//!
//! What the scalar solver does for one phase (guess, evaluation, certificate, landing) is done here
//! for as many as a vector has lanes. Every lane follows the same instructions, whatever it holds;
//! a form that no lane of the vector needs is skipped. A switch is accepted only where a
//! certificate proves it to be the first; the scalar solver takes every phase for which that fails,
//! which comes near a tie or a graze, or which begins away from the slider.
//!
//! What the lanes share with the scalar solver is written once, over the trait `Real` in
//! `src/numeric/real.rs`: closed forms, Taylor series with all derivatives, the bound of a
//! tangent, the coefficients of a certificate, the parts of a contact, the inequality that proves a
//! progression, and what these allow for rounding (`src/crossing/allowances.rs`). The lanes have of
//! their own: elementary functions, guesses, the polishing of roots, the way from tangent to
//! tangent, and in `src/dynamics/ensemble` the choice of the next phase.
//!
//! Every operation is one of IEEE 754 in each lane by itself, and products and sums are fused where
//! they are written so, on every instruction set: a motion's bits depend neither on its neighbours
//! nor on the width of the vectors. The scalar solver, which fuses nothing, differs in the last
//! places.

mod batch;
mod certificate;
mod contact;
mod contact_ahead;
mod contact_constants;
mod contact_steps;
mod damped;
mod flight;
mod forcing;
mod functions;
mod guess;
mod instructions;
mod root;
mod series;
mod shape;
mod slip;
mod wide;
mod words;
mod work;

pub(crate) use batch::{Batch, Begin, LaneTask, PhaseEnds};
pub use instructions::Instructions;
pub(crate) use instructions::Permit;
pub(crate) use shape::Shape;
pub(crate) use wide::{LaneValues, MAX_LANES};
