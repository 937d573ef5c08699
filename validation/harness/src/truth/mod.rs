//! The truth: the proved tables of `reference_data/`, read and checked, and for any other start
//! the exact solver's run made again in 106 bits.
//!
//! That is made by the closed forms of any system, or by the oscillator's own: thousands of
//! restarts and of runs for valid horizons would take two to eight times as long by the others,
//! which follow their errors, and ask for horizons between events.

mod cautious;
mod decimal;
mod forms;
mod growth;
mod heading;
mod landing;
mod library;
mod replay;
mod replayed;
mod system_replay;
mod table;

pub use growth::GrowthMatrices;
pub use library::Library;
pub use percuss::affine::DoubleDouble;
pub use replay::{Beginning, Replay, ReplayedPhase, Undecided};
pub use system_replay::solver;
pub use table::{Truth, TruthRow};
