//! Derivatives of a run's events by a name: a parameter, or a state at the start.
//!
//! With z' = M z in a segment, the derivative s of z by the name obeys s' = M s + (dM) z: both come
//! from one exponential, whose entries have derivatives ([`exponential`], of numbers with bounds of
//! their errors in [`ball`]). At a guard w the event's time moves by -(w s + dw z)/(w M z), and a
//! reset R leaves R s + dR z. What is zero by the model has to be so to first order in the name
//! ([`first_order`]); where it is not, a derivative has two sides and is refused. [`walk`] goes
//! from event to event. Read it first.
//!
//! A guard that touches zero between two events without crossing, by exact arithmetic alone, is not
//! noticed: behind it the derivatives are those of the side on which there is no event.

mod ball;
mod exponential;
mod first_order;
pub mod walk;
