//! The work of the fuzz targets: bytes decoded into a case over the whole accepted ranges, and the
//! checks a run must pass. A library, so that a case can be replayed without libFuzzer.

mod case;
mod check;
/// The reference that decides phases in 106 bits, as the tests of the solver have it.
#[path = "../../tests/support/one_sided.rs"]
mod one_sided;
/// Random piecewise-affine systems, as the tests of the solver have them.
#[cfg(feature = "systems")]
#[path = "../../tests/affine/random.rs"]
pub mod systems;

pub use case::{Case, Family};
pub use check::{Tally, check, check_counted};
