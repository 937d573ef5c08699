//! Cases and answers as files: what a case asks, for readers of any language, and what a program
//! answered without percuss being there. Both are what the protocol says, in files.

mod answer;
mod case;
mod engine;
mod equations;
mod rows;
mod table;
#[cfg(test)]
mod tests;

pub use case::CaseFile;
pub use engine::{Answerer, FileEngine};
pub use table::{EVENTS, SAMPLES};

use percuss_engines::engine::SystemTask;

/// When the state of a run is asked for: the instants at which it is compared, and the horizon.
fn sample_times(task: &SystemTask) -> Vec<f64> {
    let mut times = crate::wire::samples(task);
    if times.last() != Some(&task.span) {
        times.push(task.span);
    }
    times
}
