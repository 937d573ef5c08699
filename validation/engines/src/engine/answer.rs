//! An engine's answer, checked for completeness before anything is measured of it, and the work
//! that it takes at the least.

use super::derivatives;
use super::{Engine, Limits, Outcome, Task, contain};
use crate::accuracy::Accuracy;
use crate::failure::Failure;

/// Runs an engine on a system, contains its panics and checks that its answer is complete.
///
/// # Errors
/// The run's failure, or what its answer lacks.
pub fn answer(
    engine: &dyn Engine,
    task: &Task,
    accuracy: Accuracy,
    limits: &Limits,
) -> Result<Outcome, Failure> {
    let outcome = contain(|| engine.run(task, accuracy, limits))?;
    complete(&outcome, task)?;
    derivatives::complete(&outcome, task)?;
    Ok(outcome)
}

/// Right-hand sides that a run takes at the least, as far as that is known beforehand, where it
/// goes on to its horizon.
#[must_use]
pub fn least_work(engine: &dyn Engine, task: &Task, accuracy: Accuracy) -> f64 {
    // No explicit method here is stable over a step of as many of the fastest decay's times as it
    // has stages: a longer run takes more than a right-hand side for each of these times.
    let declaration = engine.declaration();
    let stiff =
        if declaration.is_slowed_by_stiffness() { task.span * task.system.decay() } else { 0.0 };
    let short = least_work_of_short_steps(engine, task);
    engine.least_work(task, accuracy).max(stiff).max(short)
}

/// Right-hand sides that a run takes at the least because an engine keeps its steps short.
fn least_work_of_short_steps(engine: &dyn Engine, task: &Task) -> f64 {
    let Some(longest) = engine.longest_step_on(task) else { return 0.0 };
    // A method of order p has p stages or more if it is explicit, and else at least half as many.
    let declaration = engine.declaration();
    let order = declaration.order.unwrap_or(1);
    let stages = if declaration.is_slowed_by_stiffness() { order } else { order.div_ceil(2) };
    f64::from(stages) * task.span / longest
}

/// Checks that there is a sample for each instant asked for or none at all, that events follow each
/// other, and that modes and states are the system's.
fn complete(outcome: &Outcome, task: &Task) -> Result<(), Failure> {
    let (given, asked) = (outcome.samples.len(), task.instants().len());
    if given > 0 && given != asked {
        return Err(Failure::new(format!("gave {given} samples where {asked} were asked for")));
    }
    let mut before = 0.0;
    for (n, event) in outcome.events.iter().enumerate() {
        // Written so that a NaN is refused.
        let follows = event.elapsed >= before && event.elapsed.is_finite();
        if !follows {
            let time = event.elapsed;
            return Err(Failure::new(format!("event {n} is at {time:?}, not after {before:?}")));
        }
        before = event.elapsed;
    }
    let (modes, size) = (task.system.system().modes.len(), task.state.len());
    if let Some(event) = outcome.events.iter().find(|it| it.mode >= modes) {
        return Err(Failure::new(format!("gave the mode {}, of {modes} modes", event.mode)));
    }
    let states = outcome.events.iter().map(|it| &it.state).chain(&outcome.samples);
    if states.chain([&outcome.end]).any(|it| it.len() != size) {
        return Err(Failure::new(format!("gave a state that has not {size} numbers")));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::embedded;
    use crate::engine::{Event, OscillatorTask, SampleGrid};
    use crate::equations::Numbers;
    use crate::integrators::exact;
    use crate::system::Values;

    const SAMPLES: usize = 100;

    fn task() -> Task {
        let case = embedded().unwrap_or_default().into_iter().find(|it| it.name == "small-b");
        let Some(case) = case else { unreachable!("small-b is embedded") };
        let Some(own) = &case.oscillator else { unreachable!("it is of the oscillator") };
        let task = OscillatorTask::new(own, SampleGrid { per_period: 8, count: SAMPLES });
        let Ok(task) = Task::of_oscillator(&task) else { unreachable!("it is a system") };
        task
    }

    fn complete_outcome(task: &Task) -> Outcome {
        let outcome = answer(exact(), task, Accuracy::Exact, &Limits::default());
        outcome.unwrap_or_default()
    }

    #[test]
    fn missing_and_surplus_samples_are_refused() {
        let task = task();
        let mut outcome = complete_outcome(&task);
        assert_eq!(complete(&outcome, &task), Ok(()));
        outcome.samples.push(Values::from_slice(&[0.0; 4]));
        let refused = |outcome: &Outcome| complete(outcome, &task).map_err(|it| it.reason);
        let said = |count| Err(format!("gave {count} samples where {SAMPLES} were asked for"));
        assert_eq!(refused(&outcome), said(SAMPLES + 1));
        outcome.samples.truncate(2);
        assert_eq!(refused(&outcome), said(2));
    }

    #[test]
    fn events_out_of_order_or_without_a_time_are_refused() {
        let task = task();
        let outcome = complete_outcome(&task);
        let late = outcome.events.last().map_or(0.0, |it| it.elapsed);
        for elapsed in [f64::NAN, f64::INFINITY, 0.5 * late] {
            let (mode, state) = (1, Values::from_slice(&[0.0; 4]));
            let event = Event { event: 0, mode, elapsed, state, before: None };
            let events = [outcome.events.as_slice(), &[event]].concat();
            let odd = Outcome { events, ..outcome.clone() };
            assert!(complete(&odd, &task).is_err(), "{elapsed}");
        }
    }

    #[test]
    fn modes_and_states_that_the_system_lacks_are_refused() {
        let task = task();
        let outcome = complete_outcome(&task);
        let mut mode = outcome.clone();
        mode.events[1].mode = 3;
        let short = Values::from_slice(&[0.5; 3]);
        let mut sample = outcome.clone();
        sample.samples[1] = short;
        for odd in [mode, sample, Outcome { end: short, ..outcome }] {
            assert!(complete(&odd, &task).is_err(), "{odd:?}");
        }
    }
}
