//! Return maps of a system: where its motions return to a section, and the derivative of that.
//!
//! [`section`] says what a section is, [`map`] when a motion may return to it, and [`walk`] follows
//! a motion from one return to the next; [`passage`] has the derivative of that, and
//! [`by_parameter`] that by a parameter. [`shooting`] is any return map as Newton's method sees it,
//! which solves for [`orbit`]s, and [`multipliers`] has their stability. [`exponents`] has the mean
//! growth of small changes along any motion, and [`diagram`] the returns at many values of a
//! parameter. Read them in this order.

pub(in crate::affine) mod by_parameter;
pub(in crate::affine) mod crossings;
pub mod diagram;
pub mod exponents;
pub mod map;
pub(in crate::affine) mod multipliers;
pub mod orbit;
pub mod passage;
pub mod section;
pub(in crate::affine) mod shooting;
pub mod walk;
