//! The states at the instants of output, each against the closed form from the record before it.

use super::judgement::{FirstWrong, LocalJudgement, WrongKind, exceeds};
use super::units::{Stretch, Units};
use crate::engine::{Outcome, Task};
use crate::system::SystemProblem;
use percuss::affine::{Event, Time, What};

/// The relative distance within which an instant of output is that of a record: 8 roundings.
const INSTANT_TOLERANCE: f64 = 8.0 * f64::EPSILON;

/// Judges the samples of an answer.
pub(super) fn judge(
    units: &Units<'_>,
    problem: &SystemProblem,
    task: &Task,
    outcome: &Outcome,
    found: &mut LocalJudgement,
) {
    let begin = Time::new(&problem.start.time);
    let mut record = 0;
    for (n, (elapsed, own)) in task.samples.iter().zip(&outcome.samples).enumerate() {
        if *elapsed > outcome.ended_at {
            break;
        }
        while outcome.events.get(record).is_some_and(|it| it.elapsed <= *elapsed) {
            record += 1;
        }
        let near = |it: f64| (it - elapsed).abs() <= INSTANT_TOLERANCE * elapsed;
        // At the instant of records either side of each may be told.
        let mut first = record;
        while first > 0 && near(outcome.events[first - 1].elapsed) {
            first -= 1;
        }
        let mut last = record;
        while outcome.events.get(last).is_some_and(|it| near(it.elapsed)) {
            last += 1;
        }
        let judged = |from: usize| {
            let (mode, since, state) = match from.checked_sub(1).map(|it| &outcome.events[it]) {
                Some(event) => (event.mode, event.elapsed, &event.state),
                None => (task.mode, 0.0, &task.state),
            };
            if state.iter().any(|it| !it.is_finite()) {
                return (f64::NAN, None);
            }
            let clock =
                |elapsed: f64| begin.after(if problem.backward { -elapsed } else { elapsed });
            let event = Event {
                what: What::Start,
                time: clock(since),
                state: state.to_vec(),
                mode,
                errors: None,
            };
            let exact = problem.solver.state_at(&event, &clock(*elapsed));
            let length = (elapsed - since).max(0.0);
            let stretch = Stretch { mode, elapsed: since, state, length };
            let both = (&own[..], &exact[..]);
            let delay = units.delay(both, &stretch).filter(|_| from > 0);
            (units.of_sample(both, &stretch), delay)
        };
        let nearest = (first..=last).map(judged).min_by(|a, b| a.0.total_cmp(&b.0));
        let (defect, delay) = nearest.unwrap_or((f64::NAN, None));
        found.defects.sample.push(defect);
        found.defects.delay.extend(delay);
        if exceeds(defect, units.allowance.sample) {
            let mode = record.checked_sub(1).map_or(task.mode, |it| outcome.events[it].mode);
            found.wrong_sample(FirstWrong {
                n: n + 1,
                kind: WrongKind::Sample,
                event: None,
                mode: Some(units.motion.system().modes[mode].name.clone()),
                elapsed: *elapsed,
                time: Some(problem.clock(*elapsed)),
                state: Some(own.to_vec()),
                exact: None,
                defect,
            });
        }
    }
}
