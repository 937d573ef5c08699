//! The closed form of a mode: where a state is at any later time, and bounds of how it moves.
//!
//! [`flow`] takes a state to modal co-ordinates and back, and moves them block by block. How a
//! block moves stands in [`motion`], with [`nilpotent`] for polynomials of the time and
//! [`taylor_step`] for times so short that no exponential is needed. [`modal_state`] has the
//! co-ordinates with what rounding may do to them, and [`bound`] bounds what a block adds to a
//! guard's derivatives at all later times. [`propagator`] moves states that share a time. Read
//! `flow` first, then `motion` and `bound`.

pub mod bound;
pub mod flow;
pub mod modal_state;
mod motion;
mod nilpotent;
pub mod propagator;
mod taylor_step;
