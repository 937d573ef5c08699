//! Event location from step ends, for methods whose states inside a step are expensive: such states
//! come from a second integration, or from an interpolant that costs right-hand sides.
//!
//! A method is watched alike whatever library it comes from, so that differences between its rows
//! are the libraries' own. Steps are at most an eighth of a forcing period and of a turn of the
//! elastic contact ([`longest_step`]), so that the rates at both ends of a step show a peak inside.

use super::cubic::CubicEnd;
use super::joining::{Moment, StretchEnd, Times};
use super::location::{GuardSearch, GuardValues};
use super::sampler::Sampler;
use crate::equations::Equations;
use crate::failure::Failure;

/// The longest step, in forcing periods; for a method whose events are located from step ends, also
/// in turns of the elastic contact.
const LONGEST_STEP: f64 = 0.125;

/// The longest step on a motion of the given period.
pub(crate) const fn longest_of_period(period: f64) -> f64 {
    LONGEST_STEP * period
}

/// The longest step of a method whose events are located from step ends.
pub(crate) fn longest_step(times: &Times) -> f64 {
    longest_of_period(times.period.min(times.turn))
}

/// A search for events that has come to the end of a step.
pub(crate) struct StepEnds<'a, E: Equations> {
    search: GuardSearch<'a, E>,
    at: CubicEnd<E::State>,
    look: GuardValues<E::Guards>,
}

impl<'a, E: Equations> StepEnds<'a, E> {
    /// Starts the search at the beginning of a stretch.
    pub(crate) fn new(search: GuardSearch<'a, E>, from: &Moment<E>) -> Self {
        let look = search.look(from.t, &from.state);
        Self { search, at: (from.t, from.state), look }
    }

    /// Goes to the end of the next step, `right`, or to an event before it. Evaluates the guards at
    /// the step's end, and inside the step only where both ends together show a crossing or a peak.
    /// `inside` returns the state at a time between the two ends.
    pub(crate) fn advance(
        &mut self,
        right: CubicEnd<E::State>,
        sampler: &mut Sampler<E::State>,
        mut inside: impl FnMut(
            &CubicEnd<E::State>,
            &CubicEnd<E::State>,
            f64,
        ) -> Result<E::State, Failure>,
    ) -> Result<Option<StretchEnd<E::State>>, Failure> {
        let left = self.at;
        let look = self.search.look(right.0, &right.1);
        let mut state_at = |t: f64| match t {
            t if t <= left.0 => Ok(left.1),
            t if t >= right.0 => Ok(right.1),
            t => inside(&left, &right, t),
        };
        let found = self.search.between(&self.look, &look, &mut state_at, &mut sampler.counted)?;
        sampler.take(found.map_or(right.0, |it| it.t), &mut state_at)?;
        if let Some(it) = found {
            return Ok(Some(StretchEnd::Event {
                t: it.t,
                guard: it.guard,
                state: state_at(it.t)?,
            }));
        }
        (self.at, self.look) = (right, look);
        Ok(None)
    }

    /// The end of a stretch without an event.
    pub(crate) fn ended(&self) -> StretchEnd<E::State> {
        StretchEnd::Inside { t: self.at.0, state: self.at.1 }
    }
}

/// Locates the first event among steps whose ends are known beforehand.
pub(crate) fn locate_at_step_ends<E: Equations>(
    search: GuardSearch<'_, E>,
    from: &Moment<E>,
    points: impl IntoIterator<Item = CubicEnd<E::State>>,
    sampler: &mut Sampler<E::State>,
    mut inside: impl FnMut(&CubicEnd<E::State>, &CubicEnd<E::State>, f64) -> Result<E::State, Failure>,
) -> Result<StretchEnd<E::State>, Failure> {
    let mut ends = StepEnds::new(search, from);
    for right in points {
        if let Some(ended) = ends.advance(right, sampler, &mut inside)? {
            return Ok(ended);
        }
    }
    Ok(ends.ended())
}

#[cfg(test)]
mod tests {
    use crate::accuracy::Accuracy;
    use crate::case::Given;
    use crate::engine::{Engine, Limits, OscillatorTask, Outcome, SampleGrid, Task, answer};
    use crate::integrators::all;
    use percuss::Start;

    /// Eight forcing periods of the default model from rest: an error of 1e-6 stays below 1e-3.
    fn run(name: &str, tolerance: f64) -> Option<Outcome> {
        let given = Given { start: Start::default(), ..Given::default() };
        let problem = given.check().ok()?;
        let horizon = problem.entry.instant.after_periods(8, 1);
        let grid = SampleGrid { per_period: 4, count: 33 };
        let task = OscillatorTask::until(given.parameters, problem, horizon, grid);
        let engine: &dyn Engine = *all().iter().find(|it| it.declaration().name == name)?;
        let task = Task::of_oscillator(&task).ok()?;
        answer(engine, &task, Accuracy::Tolerance(tolerance), &Limits::default()).ok()
    }

    /// Over 47 cases at 1e-6, 1e-9 and 1e-12 one library takes 1.05 to 1.44 times the right-hand
    /// sides of the other, because their step controls differ. Evaluating guards inside every step
    /// made it 4.5 to 6.7 times in the mean.
    const SAME_WORK: f64 = 2.0;

    #[test]
    fn one_method_costs_and_finds_the_same_in_two_libraries() {
        for tolerance in [1e-6, 1e-9, 1e-12] {
            let [one, other] = ["ode_solvers-dop853-time", "differential-equations-dop853"]
                .map(|name| run(name, tolerance).unwrap_or_default());
            let phases =
                |it: &Outcome| it.events.iter().map(|event| event.mode).collect::<Vec<_>>();
            assert!(one.events.len() >= 6 && phases(&one) == phases(&other));
            let [one, other] = [one, other].map(|it| it.work.rhs_evaluations as f64);
            assert!(one.max(other) <= SAME_WORK * one.min(other), "{tolerance}: {one}, {other}");
        }
    }
}
