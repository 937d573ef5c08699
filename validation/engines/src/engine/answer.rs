//! An engine's answer, checked for completeness before anything is measured of it, and the work
//! that it takes at the least.

use super::{Engine, Limits, OscillatorOutcome, OscillatorTask, Outcome, Task, contain};
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
    complete(&outcome, task.samples.len())?;
    Ok(outcome)
}

/// Runs an engine on the oscillator as [`answer`] does on any system.
///
/// # Errors
/// The run's failure, or what its answer lacks.
pub fn answer_oscillator(
    engine: &dyn Engine,
    task: &OscillatorTask,
    accuracy: Accuracy,
    limits: &Limits,
) -> Result<OscillatorOutcome, Failure> {
    let outcome = answer(engine, &Task::of_oscillator(task)?, accuracy, limits)?;
    OscillatorOutcome::of_system(outcome)
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

/// Checks that there is a sample for each instant asked for, and that events follow each other.
fn complete<M, S>(outcome: &Outcome<M, S>, asked: usize) -> Result<(), Failure> {
    let given = outcome.samples.len();
    if given != asked {
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
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{Case, Given, embedded};
    use crate::engine::{Event, SampleGrid};
    use crate::integrators::exact;
    use percuss::Phase;

    const COUNT: usize = 100;

    fn task() -> OscillatorTask {
        let case = embedded().unwrap_or_default().into_iter().find(|it| it.name == "small-b");
        let Some(case) = case else { unreachable!("small-b is embedded") };
        let Case { parameters, start, .. } = case;
        let given = Given { parameters, start, ..Given::default() };
        let Ok(problem) = given.check() else { unreachable!("small-b is checked") };
        OscillatorTask::of(&case, problem, SampleGrid { per_period: 8, count: COUNT })
    }

    fn whole(task: &OscillatorTask) -> OscillatorOutcome {
        let outcome = answer_oscillator(exact(), task, Accuracy::Exact, &Limits::default());
        outcome.unwrap_or_default()
    }

    #[test]
    fn missing_and_surplus_samples_are_refused() {
        let task = task();
        let mut outcome = whole(&task);
        assert_eq!(complete(&outcome, COUNT), Ok(()));
        outcome.samples.push([0.0; 4]);
        let refused =
            |outcome: &OscillatorOutcome| complete(outcome, COUNT).map_err(|it| it.reason);
        let said = |count| Err(format!("gave {count} samples where {COUNT} were asked for"));
        assert_eq!(refused(&outcome), said(COUNT + 1));
        outcome.samples.truncate(2);
        assert_eq!(refused(&outcome), said(2));
    }

    #[test]
    fn events_out_of_order_or_without_a_time_are_refused() {
        let task = task();
        let outcome = whole(&task);
        let late = outcome.events.last().map_or(0.0, |it| it.elapsed);
        for elapsed in [f64::NAN, f64::INFINITY, 0.5 * late] {
            let (mode, state) = (Phase::Contact, [0.0; 4]);
            let event = Event { event: 0, mode, elapsed, state, before: None };
            let events = [outcome.events.as_slice(), &[event]].concat();
            let odd = OscillatorOutcome { events, ..outcome.clone() };
            assert!(complete(&odd, COUNT).is_err(), "{elapsed}");
        }
    }
}
