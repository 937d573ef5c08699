//! States on a case's attractor, from which restarts and horizons are measured.
//!
//! They come from the exact solver's own orbit: any state near the attractor serves, because the
//! f64 values are then taken exactly as a start of its own. No two are at the same phase of the
//! forcing: each is a golden number of periods after the last, so that a periodic orbit is covered
//! as evenly as a chaotic one and all three phases occur.

use crate::case::Problem;
use percuss::{Segment, Start};

/// Forcing periods after which a run counts as on its attractor.
const TRANSIENT_PERIODS: u64 = 300;
/// The golden number of periods, in units of a period's 2^32nd part.
const STEP_PARTS: u64 = 6_949_403_065;
const PARTS_PER_PERIOD: u64 = 1 << 32;

/// `count` states on the attractor that a run from `problem` reaches, each in the first forcing
/// cycle and without drift. Fewer if the run leaves the range of starts.
#[must_use]
pub fn on_attractor(problem: &Problem, count: usize) -> Vec<Problem> {
    far_apart(problem, count, 0)
}

/// The starts, each this many forcing periods further from the last: for long runs, which from
/// neighbouring states would pass through the same stretch of the orbit and say the same.
#[must_use]
pub fn far_apart(problem: &Problem, count: usize, periods: u64) -> Vec<Problem> {
    let step = STEP_PARTS + periods * PARTS_PER_PERIOD;
    let model = problem.model;
    let begin = problem.entry.instant;
    let instant = |k: u64| {
        begin.after_periods(TRANSIENT_PERIODS * PARTS_PER_PERIOD + k * step, PARTS_PER_PERIOD)
    };
    // A state that rounding puts on another phase's side of an event is passed over: a few in 1e15.
    let last = 2 * count as u64;
    let mut segments = model.trajectory(problem.entry).until(instant(last));
    let Some(mut segment) = segments.next() else { return Vec::new() };
    let mut starts = Vec::with_capacity(count);
    for instant in (0..last).map(instant) {
        while segment.ends_by(&instant) {
            match segments.next() {
                Some(next) => segment = next,
                None => return starts,
            }
        }
        starts.extend(restart_problem(problem, &segment, &instant));
        if starts.len() == count {
            break;
        }
    }
    starts
}

/// The state at an instant as a start; `None` if that is no start of the same phase.
fn restart_problem(
    problem: &Problem,
    segment: &Segment,
    instant: &percuss::Instant,
) -> Option<Problem> {
    let model = problem.model;
    let state = segment.at_instant(instant).state;
    let tau = instant.angle() / model.parameters().omega;
    let start = Start { tau, p: state.p, y: state.y, q: Some(state.q), ..Start::default() };
    let entry = model.start(&start).ok()?;
    (entry.phase() == segment.phase()).then_some(Problem { model, start, entry })
}
