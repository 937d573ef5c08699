//! Modules that several tests use.

pub mod draw;
pub mod draws;
pub mod graze;
pub mod one_sided;
pub mod original;
pub mod plant;
pub mod printed;
pub mod random;
pub mod reference;
pub mod taylor;
