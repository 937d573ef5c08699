//! The nonlinear dynamics of Section 5, built on the exact strobe map.

pub mod attractor;
pub mod batches;
pub mod continuation;
pub mod diagram;
pub mod ensemble;
pub mod linear;
pub mod lyapunov;
pub mod orbit;
pub(crate) mod parallel;
pub mod section;
pub mod strobe;
mod tangent;
