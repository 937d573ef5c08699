//! The exact solver on any piecewise-affine system.

use crate::engine::{Event, EventDerivatives, Limits, Outcome, RunDerivatives, Task, Work};
use crate::equations::Numbers;
use crate::failure::Failure;
use crate::system::{CoefficientDerivatives, SystemProblem, Values};
use percuss::affine::{self, Time, What};
use percuss::{Ending, Proved};
use std::hint::black_box;

/// Runs a task in closed form; the system has to be there with its exact coefficients.
pub(super) fn run(task: &Task, limits: &Limits) -> Result<Outcome, Failure> {
    let problem = task.exact.as_deref();
    let problem =
        problem.ok_or_else(|| Failure::new("the system's exact coefficients are not there"))?;
    let horizon = problem.clock(task.span);
    let run = problem.solver.run(&problem.start, horizon);
    let mut run = run.map_err(Failure::new)?;
    let begin = Time::new(&problem.start.time);
    let mut record = Record { problem, task, begin, outcome: Outcome::default() };
    let mut segment = run.start();
    for event in run.by_ref() {
        record.sample(&segment, record.elapsed(&event.time));
        if let What::End(ending) = event.what {
            record.end(&segment, &event, ending)?;
            break;
        }
        record.push(&event);
        if record.outcome.events.len() > limits.events {
            return Err(Failure::new(format!("gave up after {} events", limits.events)));
        }
        segment = event;
    }
    let mut outcome = record.outcome;
    let evaluations = run.work().evaluations;
    let steps = outcome.events.len() as u64 + 1;
    outcome.work = Work { rhs_evaluations: evaluations, steps, ..Work::default() };
    if let Some(asked) = &task.gradients {
        outcome.gradients = gradients(problem, asked, horizon)?;
    }
    Ok(outcome)
}

/// The derivatives by names, along the run of the system's own start: in proved digits, because
/// stiff systems leave none of them in f64.
fn gradients(
    problem: &SystemProblem,
    asked: &[CoefficientDerivatives],
    horizon: f64,
) -> Result<Vec<Option<RunDerivatives>>, Failure> {
    let solver = problem.exact.solver::<Proved>().map_err(Failure::new)?;
    let names = asked.iter().map(|it| it.name.as_str());
    let run = solver.run().gradients(names).and_then(|it| it.until(horizon));
    let events: Vec<_> = run.map_err(Failure::new)?.collect();
    let by = |rates: &CoefficientDerivatives| {
        let found = |event: &percuss::Event<'_, Proved>| {
            let gradient = event.gradient(&rates.name)?.ok()?;
            let state: Vec<f64> = gradient.state().iter().map(Proved::midpoint).collect();
            let (time, state) = (gradient.time().midpoint(), Values::from_slice(&state));
            Some(EventDerivatives { time: Some(time), state: Some(state) })
        };
        let mut events: Vec<_> = events.iter().map(found).collect::<Option<_>>()?;
        let end = events.pop()?.state?;
        Some(RunDerivatives { events, end })
    };
    Ok(asked.iter().map(by).collect())
}

/// The state at the end of a run whose events are looked at and not kept: what the exact solver
/// does by itself. It is here because generic code is as fast as the crate that compiles it.
#[must_use]
pub fn end_of_exact_run(problem: &SystemProblem, span: f64) -> Option<Values> {
    let run = problem.solver.run(&problem.start, problem.clock(span)).ok()?;
    let last = run.map(black_box).last()?;
    Some(Values::from_slice(&last.state))
}

struct Record<'a> {
    problem: &'a SystemProblem,
    task: &'a Task,
    /// The time of the start, which is a quotient of long integers in the problem.
    begin: Time<f64>,
    outcome: Outcome,
}

impl Record<'_> {
    fn elapsed(&self, time: &Time<f64>) -> f64 {
        let ahead = (time.high - self.begin.high) + (time.low - self.begin.low);
        if self.problem.backward { -ahead } else { ahead }
    }

    /// The states asked for in the segment that `segment` begins, those at its end left out.
    fn sample(&mut self, segment: &affine::Event<f64>, end: f64) {
        let asked = &self.task.samples[self.outcome.samples.len()..];
        for elapsed in asked.iter().take_while(|elapsed| **elapsed < end) {
            let state = self.state_at(segment, *elapsed);
            self.outcome.samples.push(Values::from_slice(&state));
        }
    }

    /// The state a time after the start, in the segment that `segment` begins.
    fn state_at(&self, segment: &affine::Event<f64>, elapsed: f64) -> Vec<f64> {
        let ahead = if self.problem.backward { -elapsed } else { elapsed };
        self.problem.solver.state_at(segment, &self.begin.after(ahead))
    }

    fn push(&mut self, event: &affine::Event<f64>) {
        let modes = &self.problem.exact.modes;
        let number = match event.what {
            What::Watch(mode, watch) => modes[mode].until.len() + watch,
            What::Until(_, until) => until,
            What::Start | What::Limit(..) | What::End(_) => return,
        };
        self.outcome.events.push(Event {
            event: number,
            mode: event.mode,
            elapsed: self.elapsed(&event.time),
            state: Values::from_slice(&event.state),
            before: None,
        });
    }

    /// Takes the ending of the segment that `segment` begins.
    fn end(
        &mut self,
        segment: &affine::Event<f64>,
        event: &affine::Event<f64>,
        ending: affine::Ending<f64>,
    ) -> Result<(), Failure> {
        if ending == affine::Ending::Undecided {
            return Err(Failure::new("rounding hides how a mode ends"));
        }
        self.outcome.ended = Ending::from(&ending);
        self.outcome.ended_at = self.elapsed(&event.time);
        self.outcome.end = match ending {
            // The run's horizon is the clock's time there, which is rounded.
            affine::Ending::Horizon => Values::from_slice(&self.state_at(segment, self.task.span)),
            _ => Values::from_slice(&event.state),
        };
        // A run that ends early stays where it is, and one at its horizon has a sample there.
        self.outcome.samples.resize(self.task.samples.len(), self.outcome.end);
        Ok(())
    }
}
