//! The truth: the proved tables of `reference_data/`, read and checked, and for any other start
//! the exact solver's run made again in 106 bits.

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
