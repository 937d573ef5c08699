//! ode_solvers' Dopri5 with our own event location on its continuous output, as an expert user sets
//! it up.
//!
//! - The library locates no events. It is run at most one forcing period at a time with
//!   `integrate_with_continuous_output_model`; `solout` stops it at the end of a step that leaves the
//!   phase (in continuous mode `solout` gets the right state; in dense mode it does not).
//! - The continuous output is then searched step by step at [`INTERIOR`] interior instants, so that an
//!   excursion shorter than a step is seen if the interpolant shows it, and the crossing is bisected
//!   on the interpolant to the last bit.
//! - Steps are at most an eighth of a forcing period, so that no step hides a whole phase.
//! - Its stiffness detection (`n_stiff`) is switched off: it gives up on light damping, where the
//!   integration is dear but right.
//! - Times are elapsed since the start: its dense output fails for negative ones.

use super::meter::{Failure, Limits, Meter};
use super::phases::{GUARDS, Oscillator, Sampler};
use super::{Declaration, Engine, Event, Location, Outcome, Stepping, Task, Work, pins};
use ode_solvers::continuous_output_model::ContinuousOutputModel;
use ode_solvers::{OutputType, System, Vector4};
use percuss::Phase;

/// Instants inside a step at which the guards are looked at.
const INTERIOR: u32 = 8;
/// The longest step, in forcing periods.
const LONGEST_STEP: f64 = 0.125;

/// ode_solvers' `Dopri5`.
pub(super) struct Dopri5;

impl Engine for Dopri5 {
    fn declaration(&self) -> Declaration {
        Declaration {
            name: "ode_solvers-dopri5",
            library: "ode_solvers",
            version: pins::version("ode_solvers"),
            method: "Dormand-Prince 5(4)",
            events: Location::Harness,
            dense_output: true,
            stepping: Stepping::Adaptive,
        }
    }

    fn run(
        &self,
        task: &Task,
        tolerance: Option<f64>,
        limits: &Limits,
    ) -> Result<Outcome, Failure> {
        let tolerance = tolerance.ok_or_else(|| Failure::new("needs a tolerance"))?;
        let meter = Meter::new(limits);
        let oscillator = Oscillator::new(&task.parameters, task.forcing_angle);
        let mut run = Run { task, tolerance, meter: &meter, oscillator, steps: 0 };
        let mut outcome = run.all_phases()?;
        outcome.work =
            Work { rhs_evaluations: meter.rhs_count(), jacobian_evaluations: 0, steps: run.steps };
        Ok(outcome)
    }
}

type Output = ContinuousOutputModel<f64, Vector4<f64>>;

/// The right-hand side of one phase, and the end of it.
struct Field<'a> {
    oscillator: Oscillator,
    phase: Phase,
    meter: &'a Meter,
}

impl System<f64, Vector4<f64>> for Field<'_> {
    fn system(&self, t: f64, u: &Vector4<f64>, du: &mut Vector4<f64>) {
        self.oscillator.derivatives(self.phase, t, u.as_slice(), du.as_mut_slice());
        self.meter.rhs(du.as_slice());
    }

    fn solout(&mut self, _: f64, u: &Vector4<f64>, _: &Vector4<f64>) -> bool {
        self.oscillator.guards(self.phase, u.as_slice()).iter().any(|guard| *guard >= 0.0)
    }
}

struct Run<'a> {
    task: &'a Task,
    tolerance: f64,
    meter: &'a Meter,
    oscillator: Oscillator,
    steps: u64,
}

/// A stretch of one phase, with the ends of its steps.
struct Stretch {
    output: Output,
    ends: Vec<f64>,
    end: [f64; 4],
}

impl Run<'_> {
    fn all_phases(&mut self) -> Result<Outcome, Failure> {
        let mut outcome = Outcome::default();
        let mut sampler = Sampler::new(self.task.sample_times());
        let (mut t, mut phase, mut state) = (0.0, self.task.phase, self.task.state);
        let mut step = 0.0;
        sampler.take(0.0, |_| Ok::<_, Failure>(state))?;
        while t < self.task.span {
            let stretch = self.integrate(t, phase, &state, step)?;
            let last = stretch.ends.last().copied().unwrap_or(t);
            let state_at = |t: f64| evaluate(&stretch.output, t);
            if let Some((at, guard)) = self.first_crossing(phase, t, &stretch) {
                sampler.take(at, state_at)?;
                let (next, there) = self.oscillator.switch(phase, guard, &state_at(at)?);
                self.meter.events(outcome.events.len())?;
                (t, phase, state, step) = (at, next, there, 0.0);
                outcome.events.push(Event { phase, elapsed: t, state });
            } else {
                sampler.take(last, state_at)?;
                step = stretch.ends.iter().rev().nth(1).map_or(0.0, |before| last - before);
                (t, state) = (last, stretch.end);
            }
        }
        outcome.end = state;
        sampler.take(f64::INFINITY, |_| Ok::<_, Failure>(state))?;
        outcome.samples = sampler.taken;
        Ok(outcome)
    }

    /// Integrates one phase for at most a forcing period, or to the first step's end outside it.
    fn integrate(
        &mut self,
        t: f64,
        phase: Phase,
        state: &[f64; 4],
        step: f64,
    ) -> Result<Stretch, Failure> {
        let period = self.task.problem.model.period();
        let field = Field { oscillator: self.oscillator, phase, meter: self.meter };
        let until = (t + period).min(self.task.span);
        let longest = LONGEST_STEP * period;
        let mut solver = ode_solvers::Dopri5::from_param(
            field,
            t,
            until,
            longest,
            Vector4::from_row_slice(state),
            self.tolerance,
            self.tolerance,
            0.9,
            0.04,
            0.2,
            10.0,
            longest,
            step.min(until - t),
            u32::MAX - 1,
            u32::MAX,
            OutputType::Continuous,
        );
        let mut output = Output::new();
        let stats =
            solver.integrate_with_continuous_output_model(&mut output).map_err(Failure::new)?;
        self.steps += u64::from(stats.accepted_steps);
        let end = solver.y_out().last().ok_or_else(|| Failure::new("took no step"))?;
        let end = [end[0], end[1], end[2], end[3]];
        Ok(Stretch { output, ends: solver.x_out().clone(), end })
    }

    /// The first instant of a stretch at which a guard has risen to zero.
    fn first_crossing(&self, phase: Phase, from: f64, stretch: &Stretch) -> Option<(f64, usize)> {
        let look = Look { run: self, phase, output: &stretch.output };
        let mut left = from;
        for end in &stretch.ends {
            let (begin, width) = (left, (end - left) / f64::from(INTERIOR));
            for i in 1..=INTERIOR {
                let right = if i == INTERIOR { *end } else { begin + width * f64::from(i) };
                if let Some(found) = look.between(left, right) {
                    return Some(found);
                }
                left = right;
            }
        }
        None
    }
}

/// One phase's guards on the continuous output.
struct Look<'a> {
    run: &'a Run<'a>,
    phase: Phase,
    output: &'a Output,
}

impl Look<'_> {
    /// A crossing outwards between two instants.
    fn between(&self, left: f64, right: f64) -> Option<(f64, usize)> {
        (0..GUARDS).find_map(|guard| {
            if self.guard(guard, right) < 0.0 {
                return None;
            }
            if self.leaves(guard, right) {
                return Some((bisect(left, right, |t| self.leaves(guard, t)), guard));
            }
            // Outside, but on the way back: it may have left and turned in between.
            let root = bisect(left, right, |t| self.guard(guard, t) >= 0.0);
            (self.guard(guard, left) < 0.0 && self.leaves(guard, root)).then_some((root, guard))
        })
    }

    fn guard(&self, guard: usize, t: f64) -> f64 {
        self.run.meter.call();
        evaluate(self.output, t)
            .map_or(f64::NAN, |u| self.run.oscillator.guards(self.phase, &u)[guard])
    }

    /// Outside, and by the equations of motion not on the way back: the interpolant of a loose
    /// tolerance ripples through a threshold that the motion itself is leaving.
    fn leaves(&self, guard: usize, t: f64) -> bool {
        let rises = |u: &[f64; 4]| self.run.oscillator.rises(self.phase, guard, t, u);
        self.guard(guard, t) >= 0.0 && evaluate(self.output, t).is_ok_and(|u| rises(&u))
    }
}

/// The first instant, to the last bit, from which `is_out` holds.
fn bisect(mut inside: f64, mut outside: f64, is_out: impl Fn(f64) -> bool) -> f64 {
    loop {
        let middle = inside + 0.5 * (outside - inside);
        if middle <= inside || middle >= outside {
            return outside;
        }
        if is_out(middle) { outside = middle } else { inside = middle }
    }
}

fn evaluate(output: &Output, t: f64) -> Result<[f64; 4], Failure> {
    let state =
        output.evaluate(t).ok_or_else(|| Failure::new("its continuous output has a hole"))?;
    Ok([state[0], state[1], state[2], state[3]])
}
