//! Structural zeros: values that are zero by the model, whatever rounded numbers say.
//!
//! A guard may be zero at the entry of a segment because of the events that led there, as the gap
//! is after an impact. [`space`] is the space of all rows that are zero so, and [`graph`] follows
//! it from event to event. Whether a row belongs to it is decided by [`residue`], in exact
//! arithmetic modulo two primes. Guards of the forcing angle and a constant are zero at points that
//! may be rational ([`circle`]), and motion may be exactly rational ([`exact`], with [`parabola`],
//! and [`exact_mode`] for a mode's rows); [`touch`] says when a guard that never crosses touches
//! zero. Read `space` first, then `graph`.

pub mod circle;
pub mod exact;
pub mod exact_mode;
pub mod graph;
pub mod impact;
mod mode_residues;
mod parabola;
pub mod residue;
pub mod space;
pub mod touch;
