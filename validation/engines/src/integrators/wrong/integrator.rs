//! A good integrator with one fault: ode_solvers' `Dopri5` with our location, as it is scored, and
//! the mistakes that users and libraries make around events.
//!
//! Without a fault it is the engine `ode_solvers-dopri5`, whose bounds it is held to.

use crate::accuracy::Accuracy;
use crate::engine::{Declaration, Engine, Limits, OscillatorTask, Outcome, Role, Task};
use crate::equations::Equations;
use crate::failure::Failure;
use crate::integration::{
    Cubic, CubicEnd, GUARDS, GuardRise, Integration, Meter, Moment, Oscillator, StretchEnd, join,
};
use crate::integrators::ode_solvers::DOPRI5;
use crate::integrators::ode_solvers::dopri5::{self, Dopri5Run};
use nalgebra::U4;
use percuss::Parameters;

type OscillatorStretch = dopri5::DenseStretch<Oscillator, U4>;

/// The fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum IntegratorFault {
    None,
    /// One event in so many is dropped.
    Dropped(u64),
    /// An event is put at the end of the step in which it lies.
    AtStepEnd,
    /// Guards are looked at only where steps end, for a rise through zero.
    SignAtEnds,
    /// An event is found thirty tolerances late.
    Late,
    /// A restart begins with the derivative of the phase before.
    OldDerivative,
    /// A guard that falls through zero is an event as well.
    AnyDirection,
    /// Hermite's cubic in place of the method's own interpolant of order 4.
    LowOrder,
    /// b and xi are larger by 1e-4 of themselves.
    Parameters,
    /// One run in so many ends without a result.
    GivesUp(u64),
}

/// The delay of a late event, in tolerances.
const DELAY_TOLERANCES: f64 = 30.0;
/// The relative error of wrong parameters.
const PARAMETER_ERROR: f64 = 1e-4;
/// Halvings that narrow a bracket down to rounding.
const HALVINGS: u32 = 80;

pub(super) struct Faulty {
    pub(super) name: &'static str,
    pub(super) slip: IntegratorFault,
}

impl Engine for Faulty {
    fn declaration(&self) -> Declaration {
        let method = "Dormand-Prince 5(4), wrong on purpose";
        Declaration { name: self.name, method, role: Role::Rows, ..DOPRI5.declaration() }
    }

    fn run(&self, asked: &Task, accuracy: Accuracy, limits: &Limits) -> Result<Outcome, Failure> {
        let task = asked.of_the_oscillator()?;
        let tolerance = accuracy.wanted_tolerance()?;
        if let IntegratorFault::GivesUp(every) = self.slip
            && task.events_before % every == every - 1
        {
            return Err(Failure::new("gave up, on purpose"));
        }
        let meter = Meter::new(limits);
        let equations = Oscillator::new(&self.parameters(task), task.forcing_angle);
        let integration = Integration::by(asked, task, equations);
        let mut run = Dopri5Run::<_, U4>::new(&integration, tolerance, &meter);
        let mut detection = FaultyDetection {
            slip: self.slip,
            equations,
            tolerance,
            events: task.events_before,
            overlooking: false,
            before: None,
        };
        let outcome = join(&integration, &meter, |from, sampler| {
            run.stale = detection.stale(from);
            let stretch = run.integrate(from)?;
            let sound = run.first_crossing(from, &stretch, sampler)?;
            let Some(GuardRise { t, guard }) = detection.notice(&stretch, from, sound)? else {
                sampler.take(stretch.last(), |t| detection.state_at(&stretch, from.mode, t))?;
                return Ok(StretchEnd::Inside { t: stretch.last(), state: stretch.end });
            };
            sampler.take(t, |t| detection.state_at(&stretch, from.mode, t))?;
            run.step = 0.0;
            detection.before = Some(from.mode);
            let state = detection.state_at(&stretch, from.mode, t)?;
            Ok(StretchEnd::Event { t, guard, state })
        })?;
        Ok(outcome)
    }
}

impl Faulty {
    fn parameters(&self, task: &OscillatorTask) -> Parameters {
        let Parameters { b, xi, .. } = task.parameters;
        if self.slip != IntegratorFault::Parameters {
            return task.parameters;
        }
        Parameters {
            b: (1.0 + PARAMETER_ERROR) * b,
            xi: (1.0 + PARAMETER_ERROR) * xi,
            ..task.parameters
        }
    }
}

/// Finds events with the fault.
struct FaultyDetection {
    slip: IntegratorFault,
    equations: Oscillator,
    tolerance: f64,
    /// Over the engine's whole life.
    events: u64,
    /// The phase goes on past an event that was not noticed.
    overlooking: bool,
    /// The phase before this one.
    before: Option<usize>,
}

impl FaultyDetection {
    /// The phase whose derivative begins a stretch: that before the last event, if that is the
    /// fault.
    fn stale(&self, from: &Moment<Oscillator>) -> Option<usize> {
        self.before.filter(|_| self.slip == IntegratorFault::OldDerivative && from.t == from.began)
    }

    /// The crossing that this integrator notices in a stretch; `sound` is the right one.
    fn notice(
        &mut self,
        stretch: &OscillatorStretch,
        from: &Moment<Oscillator>,
        sound: Option<GuardRise>,
    ) -> Result<Option<GuardRise>, Failure> {
        let found = match self.slip {
            IntegratorFault::SignAtEnds => self.by_sign(stretch, from.mode, false)?,
            IntegratorFault::AnyDirection => self.by_sign(stretch, from.mode, true)?,
            IntegratorFault::Dropped(_) if self.overlooking => {
                self.by_sign(stretch, from.mode, false)?
            }
            IntegratorFault::Dropped(every) => sound.filter(|_| !self.drops(every)),
            IntegratorFault::AtStepEnd => {
                sound.map(|it| GuardRise { t: end_of_step(&stretch.ends, it.t), ..it })
            }
            IntegratorFault::Late => sound.map(|it| self.delayed_crossing(stretch, it)),
            _ => sound,
        };
        if found.is_some() {
            self.overlooking = false;
        }
        Ok(found)
    }

    /// Counts an event; whether it is one that is not noticed.
    fn drops(&mut self, every: u64) -> bool {
        self.events += 1;
        self.overlooking = self.events.is_multiple_of(every);
        self.overlooking
    }

    fn delayed_crossing(&self, stretch: &OscillatorStretch, crossing: GuardRise) -> GuardRise {
        let t = (crossing.t + DELAY_TOLERANCES * self.tolerance).min(stretch.last());
        GuardRise { t, ..crossing }
    }

    /// The first change of sign from one step's end to the next.
    fn by_sign(
        &self,
        stretch: &OscillatorStretch,
        mode: usize,
        any_direction: bool,
    ) -> Result<Option<GuardRise>, Failure> {
        let mut left = stretch.begin;
        for right in stretch.ends.iter().copied().filter(|end| *end > stretch.begin) {
            let [before, after] =
                [self.guards(stretch, mode, left)?, self.guards(stretch, mode, right)?];
            for guard in 0..GUARDS {
                let rises = before[guard] < 0.0 && after[guard] >= 0.0;
                let falls = before[guard] > 0.0 && after[guard] <= 0.0;
                if rises || (any_direction && falls) {
                    let t = self.bisect(stretch, mode, guard, (left, right))?;
                    return Ok(Some(GuardRise { t, guard }));
                }
            }
            left = right;
        }
        Ok(None)
    }

    fn bisect(
        &self,
        stretch: &OscillatorStretch,
        mode: usize,
        guard: usize,
        (mut left, mut right): (f64, f64),
    ) -> Result<f64, Failure> {
        let side = self.guards(stretch, mode, left)?[guard] < 0.0;
        for _ in 0..HALVINGS {
            let middle = 0.5 * (left + right);
            let same = (self.guards(stretch, mode, middle)?[guard] < 0.0) == side;
            if same { left = middle } else { right = middle }
        }
        Ok(right)
    }

    fn guards(
        &self,
        stretch: &OscillatorStretch,
        mode: usize,
        t: f64,
    ) -> Result<[f64; GUARDS], Failure> {
        Ok(self.equations.guards(mode, t, &self.state_at(stretch, mode, t)?))
    }

    /// The state inside a stretch, by the interpolant that this integrator has.
    fn state_at(
        &self,
        stretch: &OscillatorStretch,
        mode: usize,
        t: f64,
    ) -> Result<[f64; 4], Failure> {
        if self.slip != IntegratorFault::LowOrder {
            return stretch.at(t);
        }
        let end = end_of_step(&stretch.ends, t);
        let begin =
            stretch.ends.iter().copied().filter(|it| *it < end).fold(stretch.begin, f64::max);
        if end <= begin {
            return stretch.at(t);
        }
        let point = |t: f64| -> Result<CubicEnd<[f64; 4]>, Failure> { Ok((t, stretch.at(t)?)) };
        let cubic = Cubic::between([point(begin)?, point(end)?], |(t, state), rates| {
            self.equations.derivatives(mode, t, &state, rates);
        });
        Ok(cubic.at(t))
    }
}

/// The end of the step in which a time lies, of all ends of steps.
pub(super) fn end_of_step(ends: &[f64], t: f64) -> f64 {
    ends.iter().copied().find(|end| *end >= t).unwrap_or(t)
}
