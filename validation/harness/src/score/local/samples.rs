//! The states at the instants of output and at the end, each against the closed form from the
//! record before it.

use super::judgement::{FirstWrong, LocalJudgement, WrongKind, exceeds};
use super::units::{Stretch, Units};
use crate::engine::{Outcome, Task};
use crate::system::{SystemProblem, Values};
use percuss::Ending;
use percuss::affine::{Event, Time, What};

/// The relative distance within which an instant of output is that of a record: 8 roundings.
const INSTANT_TOLERANCE: f64 = 8.0 * f64::EPSILON;

/// An answer whose samples are judged.
pub(super) struct Sampled<'a> {
    pub(super) task: &'a Task,
    pub(super) outcome: &'a Outcome,
    /// Whether the run is judged to its end: that of one whose impacts accumulate is not.
    pub(super) to_its_end: bool,
}

/// Judges the samples of an answer.
pub(super) fn judge(
    units: &Units<'_>,
    problem: &SystemProblem,
    sampled: &Sampled<'_>,
    found: &mut LocalJudgement,
) {
    let Sampled { task, outcome, .. } = *sampled;
    let begin = Time::new(&problem.start.time);
    let mut record = 0;
    let all = task.samples.iter().copied().zip(&outcome.samples).chain(sampled.end());
    for (n, (elapsed, own)) in all.enumerate() {
        if elapsed > outcome.ended_at {
            continue;
        }
        while outcome.events.get(record).is_some_and(|it| it.elapsed <= elapsed) {
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
            let exact = problem.solver.state_at(&event, &clock(elapsed));
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
                elapsed,
                time: Some(problem.clock(elapsed)),
                state: Some(own.to_vec()),
                exact: None,
                defect,
            });
        }
    }
}

impl<'a> Sampled<'a> {
    /// The state at the end of a run that has samples, at its time, where a state is defined there
    /// and is none of the samples: at the horizon, and where a run back in time leaves its mode.
    fn end(&self) -> Option<(f64, &'a Values)> {
        let (task, outcome) = (self.task, self.outcome);
        let is_defined = matches!(outcome.ended, Ending::Horizon | Ending::LeavesDomain);
        let is_sample = task.samples.last().is_some_and(|it| *it >= outcome.ended_at);
        let is_judged = self.to_its_end && is_defined && !is_sample && !outcome.samples.is_empty();
        is_judged.then_some((outcome.ended_at, &outcome.end))
    }
}
