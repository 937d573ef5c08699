//! The truth: the proved tables of `reference_data/`, read and checked, and for any other start
//! the exact solver's run made again in 106 bits.

mod cautious;
mod decimal;
mod forms;
mod landing;
mod library;
mod replay;
mod replayed;
mod system;
mod system_growth;
mod system_replay;
mod table;

pub use library::Library;
pub use percuss::affine::DoubleDouble;
pub use replay::{Beginning, Replay, ReplayedPhase, Undecided};
pub use system::{SystemTruth, SystemTruthRow};
pub use system_replay::solver;
pub use table::{Truth, TruthRow};
