//! A plain solver that walks along the closed forms in steps and looks at the guards: what someone
//! would write who knows the formulas and not how they fail.
//!
//! Without a fault it looks finely enough for what the power test asks of it. It is no peer: it has
//! no proof, and its steps miss what is shorter than they are.

use super::closed::Closed;
use crate::accuracy::Accuracy;
use crate::engine::{
    Declaration, Engine, Event, Limits, Location, OscillatorOutcome, OscillatorTask, Outcome, Role,
    Task, Work,
};
use crate::equations::Equations;
use crate::failure::Failure;
use crate::integration::{GUARDS, Oscillator, Sampler};
use crate::integrators::exact::Exact;
use percuss::Phase;

/// What is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum WalkFault {
    None,
    /// Every so many events one is not noticed.
    Dropped(u64),
    /// Contact by the printed equations.
    Arctangent,
    /// Guards only at the ends of long steps, any change of sign.
    SignChange,
    /// An impact never goes straight into progression.
    ContactAtImpact,
}

pub(super) struct WrongWalk {
    pub(super) name: &'static str,
    pub(super) fault: WalkFault,
}

/// Steps a forcing period.
const FINE: f64 = 512.0;
/// The number of steps per forcing period, as coarse as an integrator's longest steps.
const COARSE: f64 = 24.0;

impl Engine for WrongWalk {
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
        let mut run = WrongRun {
            task,
            fault: self.fault,
            oscillator: Oscillator::of(&task.parameters, task.forcing_angle),
            step: task.problem.model.period()
                / if self.fault == WalkFault::SignChange { COARSE } else { FINE },
            events: task.events_before,
            evaluations: 0,
        };
        run.all(limits).map(Into::into)
    }
}

struct WrongRun<'a> {
    task: &'a OscillatorTask,
    fault: WalkFault,
    oscillator: Oscillator,
    step: f64,
    /// Over the engine's whole life.
    events: u64,
    evaluations: u64,
}

impl WrongRun<'_> {
    fn all(&mut self, limits: &Limits) -> Result<OscillatorOutcome, Failure> {
        let mut outcome = OscillatorOutcome::default();
        let mut sampler = Sampler::new(self.task.sample_times());
        let (mut t, mut phase, mut state) = (0.0, self.task.phase, self.task.state);
        loop {
            let closed = self.closed(phase, t, state);
            let found = self.first(&closed, phase, t)?;
            let until = found.map_or(self.task.span, |(at, _)| at);
            sampler.take(until, |time| Ok::<_, Failure>(closed.at(time - t)))?;
            let there = closed.at(until - t);
            let Some((at, guard)) = found else {
                outcome.end = there;
                break;
            };
            let (next, on_surface) = self.switch(phase, guard, at, &there);
            (t, phase, state) = (at, next, on_surface);
            outcome.events.push(Event { event: guard, mode: phase, elapsed: t, state });
            if outcome.events.len() > limits.events {
                return Err(Failure::new(format!("gave up after {} events", limits.events)));
            }
        }
        outcome.samples = sampler.finish(outcome.end);
        let steps = outcome.events.len() as u64 + 1;
        outcome.work = Work { rhs_evaluations: self.evaluations, steps, ..Work::default() };
        Ok(outcome)
    }

    fn closed(&self, phase: Phase, t: f64, state: [f64; 4]) -> Closed {
        let angle = self.task.forcing_angle + self.task.parameters.omega * t;
        let printed = self.fault == WalkFault::Arctangent;
        Closed::new(&self.task.parameters, phase, state, angle, printed)
    }

    fn switch(&self, phase: Phase, guard: usize, t: f64, there: &[f64; 4]) -> (Phase, [f64; 4]) {
        let (next, state) = self.oscillator.switch(phase, guard, t, there);
        let impact = phase == Phase::NoContact && self.fault == WalkFault::ContactAtImpact;
        (if impact { Phase::Contact } else { next }, state)
    }

    /// The first event that is noticed.
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
        matches!(self.fault, WalkFault::Dropped(every) if self.events.is_multiple_of(every))
    }

    /// Whether a guard is positive, and by the equations of motion not on its way back.
    fn is_out(&mut self, closed: &Closed, phase: Phase, guard: usize, from: f64, t: f64) -> bool {
        self.evaluations += 1;
        let state = closed.at(t - from);
        let positive = self.oscillator.guards(phase, t, &state)[guard] > 0.0;
        let blind = self.fault == WalkFault::SignChange;
        positive && (blind || self.oscillator.rates(phase, t, &state)[guard] > 0.0)
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
