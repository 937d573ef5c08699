//! The model that a system's file describes, read exactly.
//!
//! [`system`] says what a piecewise-affine system is; the other rooms use nothing else of this one.
//! [`mod@file`] has the tables of a `*.system.toml` as they are written, and [`build`] makes a
//! system of them; [`mod@builder`] fills the same tables without a file. The text of an equation or
//! a guard ([`expression`]) becomes a form with rational coefficients ([`form`], of
//! [`mod@rational`] numbers), and what is refused becomes an [`error`] with its place in the
//! [`source`]. [`check`] refuses systems that were changed by hand and are none any more. Read
//! `system` first, then `file` and `build`. Coefficients are read with their derivatives
//! ([`dual`]), which [`tangent`] gives out. [`drift`] says on which states nothing depends, and an
//! [`observable`] is a function of the state.

mod build;
pub mod builder;
mod check;
mod drift;
mod dual;
pub mod ending;
pub mod error;
mod expression;
pub mod file;
mod form;
mod naming;
pub mod observable;
pub mod rational;
mod scalar;
mod source;
mod start;
mod start_mode;
pub mod system;
pub mod tangent;
