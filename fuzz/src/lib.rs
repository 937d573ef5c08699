//! What the fuzz targets run: bytes decoded into a case over the whole accepted ranges, and the
//! checks a run must pass. A library, so that a case can be replayed without libFuzzer.

mod case;
mod check;

pub use case::Case;
pub use check::check;
