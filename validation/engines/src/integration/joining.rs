//! Modes joined at their events: what every integrator's run has in common.

use super::field::Coordinates;
use super::meter::Meter;
use super::sampler::Sampler;
use super::script::{GuardRise, note};
use crate::accuracy::shortest_time;
use crate::engine::{Event, OscillatorTask, Outcome, Task, Watched, place};
use crate::equations::{Entered, Equations, Numbers};
use crate::failure::Failure;
use crate::system::{AffineEquations, Values};
use percuss::Ending;
use std::f64::consts::TAU;

/// The times in which a system changes; libraries that have to be told how long a step may be are
/// told by these.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Times {
    /// The forcing period, or the time that stands for one.
    pub(crate) period: f64,
    /// The shortest turn of an oscillation.
    pub(crate) turn: f64,
    /// The unit of fixed steps.
    pub(crate) shortest: f64,
}

/// A run that an integrator is asked for, in the time elapsed since its start.
pub(crate) struct Integration<'a, E: Equations> {
    pub(crate) equations: E,
    pub(crate) mode: usize,
    pub(crate) state: E::State,
    pub(crate) span: f64,
    /// The instants at which the state is taken.
    pub(crate) samples: Vec<f64>,
    pub(crate) times: Times,
    pub(crate) watched: Option<&'a Watched>,
}

impl<'a, E: Coordinates> Integration<'a, E> {
    /// The integration of the oscillator that a task asks for, in the oscillator's own words too.
    pub(crate) fn new(task: &'a Task, own: &OscillatorTask) -> Self {
        Self::by(task, own, E::new(&own.parameters, own.forcing_angle))
    }

    /// The integration of a task of the oscillator by these equations.
    pub(crate) fn by(task: &'a Task, own: &OscillatorTask, equations: E) -> Self {
        let period = own.problem.model.period();
        Self {
            equations,
            mode: place(own.phase),
            state: equations.of_bounded(&own.state),
            span: own.span,
            samples: instants(task),
            times: Times { period, turn: TAU, shortest: shortest_time(&own.parameters) },
            watched: task.watched.as_ref(),
        }
    }
}

impl<'a> Integration<'a, AffineEquations<'a>> {
    /// The integration of the system that a task asks for.
    pub(crate) fn of_system(task: &'a Task) -> Self {
        let system = &*task.system;
        Self {
            equations: AffineEquations::new(system),
            mode: task.mode,
            state: task.state,
            span: task.span,
            samples: instants(task),
            times: Times {
                period: system.period(),
                turn: system.turn(),
                shortest: system.shortest_time(),
            },
            watched: task.watched.as_ref(),
        }
    }
}

/// The instants at which the state is taken, none beyond the run's end.
fn instants(task: &Task) -> Vec<f64> {
    task.instants().iter().map(|time| time.min(task.span)).collect()
}

/// A state of a run, in the co-ordinates of its equations.
#[derive(Debug)]
pub(crate) struct Moment<E: Equations> {
    /// Time since the start.
    pub(crate) t: f64,
    /// The time at which the mode began.
    pub(crate) began: f64,
    pub(crate) mode: usize,
    pub(crate) state: E::State,
    /// The guards that are known at the mode's entry.
    pub(crate) entered: Entered,
}

impl<E: Equations> Clone for Moment<E> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<E: Equations> Copy for Moment<E> {}

impl<E: Equations> Moment<E> {
    /// The start of a run.
    pub(crate) fn start(equations: &E, mode: usize, state: E::State) -> Self {
        let entered = equations.enter(None, mode, 0.0, &state);
        Self { t: 0.0, began: 0.0, mode, state, entered }
    }

    /// The mode that begins where a guard has ended this one.
    fn after(&self, equations: &E, t: f64, guard: usize, state: &E::State) -> Self {
        let (mode, state) = equations.after_event(self.mode, guard, t, state);
        let entered = equations.enter(Some((self.mode, guard)), mode, t, &state);
        Self { t, began: t, mode, state, entered }
    }
}

/// The ending of a stretch of one mode.
#[derive(Clone, Copy, Debug)]
pub(crate) enum StretchEnd<S> {
    /// A guard has risen to zero.
    Event { t: f64, guard: usize, state: S },
    /// The stretch ended without an event, and the mode goes on.
    Inside { t: f64, state: S },
}

/// A remainder below this share of the whole run is no step for any library; the state does not
/// change in it.
const MIN_STEP_SHARE: f64 = 16.0 * f64::EPSILON;

/// Runs an integration by stretches of one mode, each from the moment given to an event or to some
/// later time in the same mode, the end of the integration at the latest.
pub(crate) fn join<E: Equations>(
    integration: &Integration<'_, E>,
    meter: &Meter,
    mut stretch: impl FnMut(&Moment<E>, &mut Sampler<E::State>) -> Result<StretchEnd<E::State>, Failure>,
) -> Result<Outcome, Failure> {
    let Integration { equations, span, .. } = integration;
    let mut outcome = Outcome::default();
    integration.watched.iter().for_each(|watched| meter.watch(watched));
    let mut sampler = Sampler::new(integration.samples.clone());
    let mut now = Moment::start(equations, integration.mode, integration.state);
    let mut instant = SimultaneousEvents::default();
    sampler.take(0.0, |_| Ok::<_, Failure>(now.state))?;
    let goes_on =
        |now: &Moment<E>| now.entered.fires.is_some() || span - now.t > MIN_STEP_SHARE * span;
    while goes_on(&now) && !meter.has_seen_enough(now.t) {
        let ended = match now.entered.fires {
            Some(guard) => StretchEnd::Event { t: now.t, guard, state: now.state },
            None => stretch(&now, &mut sampler)?,
        };
        note_located(&now, &sampler, &ended);
        record_counted(equations, now.mode, (&mut sampler, meter), &mut outcome)?;
        now = match ended {
            StretchEnd::Inside { t, state } => Moment { t, state, ..now },
            StretchEnd::Event { t, state, .. } if equations.leaves_domain() => {
                now = Moment { t, state, ..now };
                outcome.ended = Ending::LeavesDomain;
                break;
            }
            StretchEnd::Event { t, guard, state } => {
                meter.events(outcome.events.len())?;
                meter.phase_ended(t);
                let next = now.after(equations, t, guard, &state);
                let event = equations.event(now.mode, guard);
                let [before, state] = [&state, &next.state].map(|it| reported(equations, it));
                let (mode, before) = (next.mode, Some(before));
                outcome.events.push(Event { event, mode, elapsed: t, state, before });
                now = next;
                if instant.is_crowded(t) {
                    outcome.ended = Ending::NoProgress;
                    break;
                }
                now
            }
        };
    }
    outcome.end = reported(equations, &now.state);
    outcome.ended_at = now.t;
    let samples = sampler.finish(now.state);
    outcome.samples = samples.iter().map(|it| reported(equations, it)).collect();
    outcome.work = meter.work();
    meter.hand_over(&mut outcome);
    Ok(outcome)
}

/// A state as an outcome has it.
fn reported<E: Equations>(equations: &E, state: &E::State) -> Values {
    Values::from_slice(equations.reported(state).as_ref())
}

/// Notes what the search has found in a stretch, where a run is to be repeated without it.
fn note_located<E: Equations>(
    now: &Moment<E>,
    sampler: &Sampler<E::State>,
    ended: &StretchEnd<E::State>,
) {
    for crossing in &sampler.counted {
        note(GuardRise { t: crossing.t, guard: crossing.guard }, false);
    }
    if let (None, StretchEnd::Event { t, guard, .. }) = (now.entered.fires, ended) {
        note(GuardRise { t: *t, guard: *guard }, true);
    }
}

/// Moves the crossings of guards that do not end the mode from the sampler to the outcome.
fn record_counted<E: Equations>(
    equations: &E,
    mode: usize,
    (sampler, meter): (&mut Sampler<E::State>, &Meter),
    outcome: &mut Outcome,
) -> Result<(), Failure> {
    for crossing in sampler.counted.drain(..) {
        meter.events(outcome.events.len())?;
        let event = equations.event(mode, crossing.guard);
        let state = reported(equations, &crossing.state);
        let (elapsed, before) = (crossing.t, Some(state));
        outcome.events.push(Event { event, mode, elapsed, state, before });
    }
    Ok(())
}

/// The number of events in one instant that ends a run.
const MAX_SIMULTANEOUS_EVENTS: u32 = 64;
/// Events that are no further apart than this, relative to their time, lie in one instant.
const INSTANT_TOLERANCE: f64 = 8.0 * f64::EPSILON;

/// A count of the events that lie in one instant.
#[derive(Default)]
struct SimultaneousEvents {
    last: f64,
    count: u32,
}

impl SimultaneousEvents {
    /// Counts an event and returns whether too many events lie in its instant.
    fn is_crowded(&mut self, t: f64) -> bool {
        self.count = if t - self.last <= INSTANT_TOLERANCE * t { self.count + 1 } else { 1 };
        self.last = t;
        self.count >= MAX_SIMULTANEOUS_EVENTS
    }
}
