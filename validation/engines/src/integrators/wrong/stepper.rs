//! A plain solver that evaluates the closed forms and the guards at fixed steps, as someone would
//! write it who knows the formulas and not how they fail.
//!
//! Without a fault the steps are fine enough for the power test. The solver is no peer: it has no
//! proof, and misses what is shorter than a step.

use super::closed::Closed;
use crate::accuracy::Accuracy;
use crate::engine::{
    Declaration, Engine, Event, Limits, Location, OscillatorTask, Outcome, Role, Task, Work, place,
};
use crate::equations::{Equations, Numbers};
use crate::failure::Failure;
use crate::integration::{GUARDS, Oscillator, Sampler};
use crate::integrators::exact::Exact;
use crate::system::Values;
use percuss::Phase;

/// The fault of a [`ClosedFormStepper`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum StepperFault {
    None,
    /// One event in so many is dropped.
    Dropped(u64),
    /// The contact phase follows the equations as printed in the paper.
    Arctangent,
    /// Guards are evaluated only at the ends of long steps, and any change of sign is an event.
    SignChange,
    /// An impact never goes straight into progression.
    ContactAtImpact,
}

pub(super) struct ClosedFormStepper {
    pub(super) name: &'static str,
    pub(super) fault: StepperFault,
}

/// The number of steps per forcing period without that fault.
const FINE_STEPS_PER_PERIOD: f64 = 512.0;
/// The number of steps per forcing period, as coarse as an integrator's longest steps.
const COARSE_STEPS_PER_PERIOD: f64 = 24.0;

impl Engine for ClosedFormStepper {
    fn declaration(&self) -> Declaration {
        Declaration {
            name: self.name,
            method: "closed forms in steps",
            events: Location::Harness,
            role: Role::Rows,
            ..Exact.declaration()
        }
    }

    fn run(&self, task: &Task, _: Accuracy, limits: &Limits) -> Result<Outcome, Failure> {
        let task = task.of_the_oscillator()?;
        let mut run = StepperRun {
            task,
            fault: self.fault,
            oscillator: Oscillator::new(&task.parameters, task.forcing_angle),
            step: task.problem.model.period()
                / if self.fault == StepperFault::SignChange {
                    COARSE_STEPS_PER_PERIOD
                } else {
                    FINE_STEPS_PER_PERIOD
                },
            events: task.events_before,
            evaluations: 0,
        };
        run.all(limits)
    }
}

struct StepperRun<'a> {
    task: &'a OscillatorTask,
    fault: StepperFault,
    oscillator: Oscillator,
    step: f64,
    /// Events over the engine's whole life.
    events: u64,
    evaluations: u64,
}

impl StepperRun<'_> {
    fn all(&mut self, limits: &Limits) -> Result<Outcome, Failure> {
        let mut outcome = Outcome { ended_at: self.task.span, ..Outcome::default() };
        let mut sampler = Sampler::new(self.task.sample_times());
        let end;
        let (mut t, mut phase, mut state) = (0.0, self.task.phase, self.task.state);
        loop {
            let closed = self.closed_form(phase, t, state);
            let found = self.first(&closed, phase, t)?;
            let until = found.map_or(self.task.span, |(at, _)| at);
            sampler.take(until, |time| Ok::<_, Failure>(closed.at(time - t)))?;
            let there = closed.at(until - t);
            let Some((at, guard)) = found else {
                end = there;
                break;
            };
            let (next, on_surface) = self.after_event(phase, guard, at, &there);
            (t, phase, state) = (at, next, on_surface);
            let (mode, before) = (place(phase), Some(Values::from_slice(&there)));
            let state = Values::from_slice(&state);
            outcome.events.push(Event { event: guard, mode, elapsed: t, state, before });
            if outcome.events.len() > limits.events {
                return Err(Failure::new(format!("gave up after {} events", limits.events)));
            }
        }
        outcome.end = Values::from_slice(&end);
        outcome.samples = sampler.finish(end).iter().map(|it| Values::from_slice(it)).collect();
        let steps = outcome.events.len() as u64 + 1;
        outcome.work = Work { rhs_evaluations: self.evaluations, steps, ..Work::default() };
        Ok(outcome)
    }

    fn closed_form(&self, phase: Phase, t: f64, state: [f64; 4]) -> Closed {
        let angle = self.task.forcing_angle + self.task.parameters.omega * t;
        let printed = self.fault == StepperFault::Arctangent;
        Closed::new(&self.task.parameters, phase, state, angle, printed)
    }

    fn after_event(
        &self,
        phase: Phase,
        guard: usize,
        t: f64,
        there: &[f64; 4],
    ) -> (Phase, [f64; 4]) {
        let (next, state) = self.oscillator.after_event(place(phase), guard, t, there);
        let impact = phase == Phase::NoContact && self.fault == StepperFault::ContactAtImpact;
        (if impact { Phase::Contact } else { Phase::ALL[next] }, state)
    }

    /// The first event that is not dropped.
    fn first(
        &mut self,
        closed: &Closed,
        phase: Phase,
        from: f64,
    ) -> Result<Option<(f64, usize)>, Failure> {
        let most = (self.task.span - from) / self.step;
        if most > 1e8 {
            return Err(Failure::new("too many steps"));
        }
        let mut left = from;
        let mut before = [false; GUARDS];
        for k in 1..=most.ceil() as u64 {
            let right = (from + k as f64 * self.step).min(self.task.span);
            for (guard, was_out) in before.iter_mut().enumerate() {
                let out = self.is_out(closed, phase, guard, from, right);
                if out && !*was_out {
                    let at = self.bisect(closed, (phase, guard), from, (left, right));
                    self.events += 1;
                    if !self.drops() {
                        return Ok(Some((at, guard)));
                    }
                }
                *was_out = out;
            }
            left = right;
        }
        Ok(None)
    }

    fn drops(&self) -> bool {
        matches!(self.fault, StepperFault::Dropped(every) if self.events.is_multiple_of(every))
    }

    /// Whether a guard is positive, and by the equations of motion not on its way back.
    fn is_out(&mut self, closed: &Closed, phase: Phase, guard: usize, from: f64, t: f64) -> bool {
        self.evaluations += 1;
        let state = closed.at(t - from);
        let positive = self.oscillator.guards(place(phase), t, &state)[guard] > 0.0;
        let blind = self.fault == StepperFault::SignChange;
        positive && (blind || self.oscillator.rates(place(phase), t, &state)[guard] > 0.0)
    }

    fn bisect(
        &mut self,
        closed: &Closed,
        (phase, guard): (Phase, usize),
        from: f64,
        (mut inside, mut outside): (f64, f64),
    ) -> f64 {
        loop {
            let middle = inside + 0.5 * (outside - inside);
            if middle <= inside || middle >= outside {
                return outside;
            }
            if self.is_out(closed, phase, guard, from, middle) {
                outside = middle;
            } else {
                inside = middle;
            }
        }
    }
}
