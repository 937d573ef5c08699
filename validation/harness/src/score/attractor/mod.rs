//! The same-attractor test: whether an engine's long run in chaos has the right statistics.
//!
//! Where errors grow exponentially a long run cannot be compared point by point; what it visits,
//! how often, and how fast it drifts can. Distances are those between an engine's section and a
//! longer reference section of the exact solver; their limits come from reference runs against that
//! same reference, in batches of the engine's length, because successive strobes are not
//! independent.
//!
//! Over one period errors hardly grow, chaos or not. So each strobe is also compared with the exact
//! map's image of the engine's own strobe before it: this has no sampling noise, and notices a
//! model that is slightly different where two thousand periods of statistics cannot.
//! `docs/ATTRACTOR_TEST.md` has the measured rate of false alarms and the power.

mod binomial;
mod calibration;
mod comparison;
mod distance;
mod limits;
mod power;
mod runs;
mod section;

pub use binomial::interval;
pub use calibration::{Calibration, NULL_RUNS, calibrate};
pub use comparison::{AttractorTest, Comparison};
pub use distance::{Distances, STATISTICS, distances, is_sampled};
pub use limits::{Calibrated, ComparisonPlan, calibrated};
pub use power::{Alarms, Changed};
pub use runs::MAX_RUNS;
pub use section::{RunSection, run_of};
