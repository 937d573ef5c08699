//! The numbers in which systems are prepared and run.
//!
//! [`real`] has numbers of several hundred bits, for what is worked out once a mode. [`vector`]
//! rounds them to the arithmetic of a run, whose numbers have one or two words, and says what
//! rounding and underflow do to sums there. [`clock`] keeps a time, and the angle of the forcing,
//! as a sum of two such numbers. Read `vector` first.

pub mod clock;
pub mod real;
pub mod vector;
