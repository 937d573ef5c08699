//! A good integrator with one fault on other systems than the oscillator: mistakes that show in one
//! way of running a case, and nowhere else.
//!
//! Without a fault it is the engine `ode_solvers-dopri5`, whose bounds it is held to. Some faults
//! are a system that was misread, some an entry that was ([`Misled`]), some stand in the loop.

use super::integrator::end_of_step;
use super::misled::{Memory, Misled, SystemFault};
use crate::accuracy::Accuracy;
use crate::engine::{Declaration, Engine, Limits, Outcome, Role, Task};
use crate::equations::Equations;
use crate::failure::Failure;
use crate::integration::{
    CountedCrossing, GuardRise, Integration, Meter, Moment, Sampler, StretchEnd, join,
};
use crate::integrators::ode_solvers::DOPRI5;
use crate::integrators::ode_solvers::dopri5::{self, Dopri5Run};
use crate::system::{AffineEquations, CheckedSystem, Direction, System, Values};
use nalgebra::Dyn;
use std::sync::Arc;

/// The time after an event in which no other is noticed, in units of the system's time.
pub const COOLDOWN_TIME: f64 = 1e-2;

pub(super) struct FaultyOnSystems {
    pub(super) name: &'static str,
    pub(super) slip: SystemFault,
}

type SystemStretch<'a> = dopri5::DenseStretch<Misled<'a>, Dyn>;

impl Engine for FaultyOnSystems {
    fn declaration(&self) -> Declaration {
        let method = "Dormand-Prince 5(4), wrong on purpose";
        Declaration { name: self.name, method, role: Role::Rows, ..DOPRI5.declaration() }
    }

    fn run(&self, task: &Task, accuracy: Accuracy, limits: &Limits) -> Result<Outcome, Failure> {
        let tolerance = accuracy.wanted_tolerance()?;
        let system = Arc::new(self.slip.misread(&task.system)?);
        let task = Task { system, ..task.clone() };
        let memory = Memory::default();
        let integration = misled(&task, self.slip, &memory);
        let meter = Meter::new(limits);
        let mut run = Dopri5Run::<_, Dyn>::new(&integration, tolerance, &meter);
        let watch = FaultySystemDetection { slip: self.slip, memory: &memory, task: &task };
        let mut outcome = join(&integration, &meter, |from, sampler| {
            let stretch = run.integrate(from)?;
            let sound = run.first_crossing(from, &stretch, sampler)?;
            watch.count_at_start(from, sampler);
            let Some(GuardRise { t, guard }) = watch.notice(from, &stretch, sound) else {
                sampler.take(stretch.last(), |t| stretch.at(t))?;
                return Ok(StretchEnd::Inside { t: stretch.last(), state: stretch.end });
            };
            let uncut = self.slip == SystemFault::UncutOutput;
            let taken = if uncut { end_of_step(&stretch.ends, t) } else { t };
            sampler.take(taken, |t| stretch.at(t))?;
            run.step = 0.0;
            Ok(StretchEnd::Event { t, guard, state: stretch.at(t)? })
        })?;
        if self.slip == SystemFault::StateBefore {
            memory.put_back(&mut outcome, &integration);
        }
        Ok(outcome)
    }
}

impl SystemFault {
    /// The system as the faulty integrator reads it.
    fn misread(self, system: &CheckedSystem) -> Result<CheckedSystem, Failure> {
        let backward = system.is_backward();
        let given = system.system();
        // Back in time and back again all numbers are the same.
        let mut own = if backward { given.backward() } else { given.clone() };
        self.alter(&mut own, backward);
        let own = CheckedSystem::new(own)?;
        if backward { own.backward() } else { Ok(own) }
    }

    fn alter(self, system: &mut System, backward: bool) {
        match self {
            Self::ForwardDirections if backward => turn(system, |direction| match direction {
                Direction::Rising => Direction::Falling,
                Direction::Falling => Direction::Rising,
                Direction::Both => Direction::Both,
            }),
            Self::BothDirections => turn(system, |_| Direction::Both),
            Self::ForwardForcing if backward => system.omega = -system.omega,
            Self::PastBoundary if backward => {
                for until in system.modes.iter_mut().flat_map(|mode| &mut mode.until) {
                    until.guard.fill(0.0);
                    until.guard.last_mut().into_iter().for_each(|constant| *constant = -1.0);
                }
            }
            _ => (),
        }
    }
}

fn turn(system: &mut System, other: impl Fn(Direction) -> Direction) {
    for watch in system.modes.iter_mut().flat_map(|mode| &mut mode.watch) {
        watch.direction = other(watch.direction);
    }
}

/// The integration of a task with equations that are misled.
fn misled<'a>(
    task: &'a Task,
    slip: SystemFault,
    memory: &'a Memory,
) -> Integration<'a, Misled<'a>> {
    let Integration { equations, mode, state, span, samples, times, watched } =
        Integration::of_system(task);
    let equations = Misled { sound: equations, slip, memory };
    Integration { equations, mode, state, span, samples, times, watched }
}

/// Finds events with the fault.
struct FaultySystemDetection<'a> {
    slip: SystemFault,
    memory: &'a Memory,
    task: &'a Task,
}

impl FaultySystemDetection<'_> {
    /// The crossing that is noticed in a stretch; `sound` is the right one.
    fn notice(
        &self,
        from: &Moment<Misled<'_>>,
        stretch: &SystemStretch<'_>,
        sound: Option<GuardRise>,
    ) -> Option<GuardRise> {
        let found = sound.filter(|it| !self.memory.overlooks(it.guard) && !self.is_cool(from, it));
        if let (None, Some(passed)) = (found, sound) {
            self.memory.overlook(passed.guard);
        }
        let equations = AffineEquations::new(&self.task.system);
        let guards = equations.guards(from.mode, stretch.last(), stretch.end.as_ref());
        self.memory.notice_what_is_inside(guards.as_ref());
        found
    }

    /// Whether an event comes too early after the one before it to be noticed.
    fn is_cool(&self, from: &Moment<Misled<'_>>, found: &GuardRise) -> bool {
        let unit = self.task.system.system().time_scale;
        let since = found.t - from.began;
        self.slip == SystemFault::Cooldown && from.began > 0.0 && since < COOLDOWN_TIME * unit
    }

    /// Counts watched guards that are zero at the start.
    fn count_at_start(&self, from: &Moment<Misled<'_>>, sampler: &mut Sampler<Values>) {
        if self.slip != SystemFault::FiresAtStart || from.t > 0.0 || from.began > 0.0 {
            return;
        }
        let equations = AffineEquations::new(&self.task.system);
        let zero = (0..equations.count(from.mode))
            .filter(|guard| from.entered.is_zero(*guard) && !equations.ends(from.mode, *guard));
        // An event that counts in both directions has two guards; one will do.
        let mut guards: Vec<usize> = zero.collect();
        guards.dedup_by_key(|guard| equations.event(from.mode, *guard));
        let at = |guard: usize| CountedCrossing { t: from.t, guard, state: from.state };
        sampler.counted.splice(0..0, guards.into_iter().map(at));
    }
}
