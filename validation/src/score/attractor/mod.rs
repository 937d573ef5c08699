//! Same attractor: whether an engine's long run in chaos has the right statistics.
//!
//! Where errors grow exponentially a long run cannot be compared point by point; what it visits, how
//! often, and how fast it drifts can. Distances are those between an engine's section and a longer
//! reference section of the exact solver; their limits come from reference runs against that same
//! reference, in batches of the engine's length, because successive strobes are not independent.

mod comparison;
mod distance;
mod limits;
mod section;

pub use comparison::{AttractorTest, Comparison};
pub use distance::{Distances, STATISTICS, distances};
pub use limits::{Calibrated, Plan, calibrate, calibrated};
pub use section::{Section, run_of};
