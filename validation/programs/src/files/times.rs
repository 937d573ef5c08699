//! When the state of a run is asked for.

use crate::wire::samples;
use percuss_engines::engine::Task;

/// The instants at which the state is compared, and the horizon.
pub(super) fn sample_times(task: &Task) -> Vec<f64> {
    let mut times = samples(task);
    if times.last() != Some(&task.span) {
        times.push(task.span);
    }
    times
}
