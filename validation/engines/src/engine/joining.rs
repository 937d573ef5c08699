//! Phases joined at their switches: what every integrator's run has in common.

use super::field::Equations;
use super::meter::{Failure, Meter};
use super::sampler::Sampler;
use super::{Event, Outcome, Task};
use percuss::Phase;

/// A state of a run, in the co-ordinates of its equations.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moment {
    /// Time since the start.
    pub(super) t: f64,
    /// When the phase began.
    pub(super) began: f64,
    pub(super) phase: Phase,
    pub(super) state: [f64; 4],
}

/// How a stretch of one phase ended.
#[derive(Clone, Copy, Debug)]
pub(super) enum StretchEnd {
    /// A guard has risen to zero.
    Switch { t: f64, guard: usize, state: [f64; 4] },
    /// The phase goes on.
    Inside { t: f64, state: [f64; 4] },
}

/// Less than this share of the whole run is no step for any library; the state does not change in
/// it.
const SHORTEST: f64 = 16.0 * f64::EPSILON;

/// Runs a task by stretches of one phase, each from the moment given to a switch or to some later
/// time in the same phase, the end of the task at the latest.
pub(super) fn join<E: Equations>(
    task: &Task,
    equations: &E,
    meter: &Meter,
    mut stretch: impl FnMut(&Moment, &mut Sampler) -> Result<StretchEnd, Failure>,
) -> Result<Outcome, Failure> {
    let mut outcome = Outcome::default();
    task.watched.iter().for_each(|watched| meter.watch(watched));
    let mut sampler = Sampler::new(task.sample_times());
    let mut now =
        Moment { t: 0.0, began: 0.0, phase: task.phase, state: equations.of_bounded(&task.state) };
    sampler.take(0.0, |_| Ok::<_, Failure>(now.state))?;
    while task.span - now.t > SHORTEST * task.span && !meter.has_seen_enough(now.t) {
        now = match stretch(&now, &mut sampler)? {
            StretchEnd::Inside { t, state } => Moment { t, state, ..now },
            StretchEnd::Switch { t, guard, state } => {
                meter.events(outcome.events.len())?;
                meter.phase_ended(t);
                let (phase, state) = equations.switch(now.phase, guard, &state);
                let bounded = equations.bounded(&state);
                outcome.events.push(Event { phase, elapsed: t, state: bounded });
                Moment { t, began: t, phase, state }
            }
        };
    }
    outcome.end = equations.bounded(&now.state);
    let samples = sampler.finish(now.state);
    outcome.samples = samples.iter().map(|state| equations.bounded(state)).collect();
    outcome.work = meter.work();
    meter.hand_over(&mut outcome);
    Ok(outcome)
}
