//! Derivatives of a run's events by a name: a parameter, or a state at the start.
//!
//! With z' = M z in a segment, the derivative s of z by the name obeys s' = M s + (dM) z: both come
//! from one exponential, whose entries have derivatives ([`exponential`], of numbers with bounds of
//! their errors in [`ball`]). At a guard w the event's time moves by -(w s + dw z)/(w M z), and a
//! reset R leaves R s + dR z. What is zero by the model has to be so to first order in the name
//! ([`first_order`]). Where it is not, a derivative has two sides, each of which is followed by
//! itself at the entry of a segment, and refused elsewhere ([`checks`]); so it is behind a guard
//! that touches zero without crossing, of which the run tells, unless the name moves nothing there
//! ([`unmoved`]). [`walk`] goes from event to event,
//! [`start`] begins it with the [`coefficients`] of the modes, and [`derivative`] is what it gives
//! out. Read `walk` first.

mod ball;
mod checks;
mod coefficients;
pub mod derivative;
mod exponential;
mod first_order;
mod start;
mod unmoved;
pub mod walk;
