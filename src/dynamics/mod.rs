//! The nonlinear dynamics of Section 5, built on the exact strobe map.

pub mod continuation;
pub mod linear;
pub mod orbit;
pub mod strobe;
