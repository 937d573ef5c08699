//! Scores of the oscillator: its growth of errors, its grazes, the measures of a run, the restart
//! test and the valid horizons, in phases and forcing periods.

mod grazes;
mod growth;
mod horizon;
mod measure;
mod restart;
mod starts;

pub use grazes::grazes;
pub use growth::RunGrowth;
pub use horizon::HorizonTest;
pub use measure::{measure, sample_errors};
pub use restart::{MOST_PERIODS, RestartRun, RestartTest};
pub use starts::{far_apart, on_attractor};
