//! Many motions at once: phases of one kind, one a lane of the processor's vectors.
//!
//! What the scalar solver does for one phase (guess, evaluation, certificate, landing) is done here
//! for as many as a vector has lanes, without a branch on what a lane holds. A switch is accepted
//! only where a certificate proves it to be the first; the scalar solver takes every phase for
//! which that fails, which comes near a tie or a graze, or which begins away from the slider.
//!
//! Closed forms, series, tangents, certificates and inequalities are the scalar solver's own text,
//! written over [`crate::numeric::real::Real`], and so is what they allow for rounding
//! ([`crate::crossing::allowances`]). The functions, the guesses and the order of the steps are of
//! their own.
//!
//! Every operation is one of IEEE 754 in each lane by itself, and products and sums are fused where
//! they are written so, on every instruction set: a motion's bits depend neither on its neighbours
//! nor on the width of the vectors. The scalar solver, which fuses nothing, differs in the last
//! places.

mod batch;
mod certificate;
mod contact;
mod contact_ahead;
mod contact_shape;
mod damped;
mod flight;
mod forced;
mod functions;
mod guess;
mod harmonic;
mod instructions;
mod root;
mod series;
mod shape;
mod slip;
mod swing;
mod wide;
mod words;
mod work;

pub(crate) use batch::{Batch, Begin, PhaseEnds, Stage};
pub use instructions::Instructions;
pub(crate) use instructions::Permit;
pub(crate) use shape::Shape;
pub(crate) use wide::{Column, WIDEST};
