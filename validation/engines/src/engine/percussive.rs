//! The oscillator written down as any other system is, which is how engines are asked to run it.

use super::{
    Ended, Event, GuardSample, OscillatorEvent, OscillatorOutcome, OscillatorTask, Outcome, Task,
    Trace,
};
use crate::equations::Numbers;
use crate::failure::Failure;
use crate::system::by_hand::{self, mode, until};
use crate::system::{CheckedSystem, Row, System, Values};
use percuss::{Parameters, Phase};
use std::sync::Arc;

/// The oscillator's phases in the order of its modes.
const MODES: [Phase; 3] = [Phase::NoContact, Phase::Contact, Phase::Progression];
/// p, y, q and v.
const STATES: usize = 4;
/// The place of the coefficient of cos theta in a row.
const COS: usize = STATES;
/// The place of the constant term in a row.
const ONE: usize = STATES + 2;

/// The oscillator as a system; `angle` is omega tau + phi at the start.
///
/// An event puts the state on the surface that it defines by moving p and q, as the engines that
/// know the oscillator do.
#[must_use]
pub fn percussive(parameters: &Parameters, angle: f64) -> System {
    let Parameters { xi, omega, g, .. } = *parameters;
    let two_xi = 2.0 * xi;
    // sign (f - level), with the trial force f.
    let trial = |sign: f64, level: f64| row(&[(1, sign * two_xi), (2, sign), (ONE, -sign * level)]);
    // p = q + g, and q such that f is what is imposed.
    let surface = |imposed: f64| {
        let q = [(1, -two_xi), (ONE, imposed)];
        let p = [(1, -two_xi), (ONE, imposed + g)];
        Some(vec![row(&p), state(1), row(&q), state(3)])
    };
    let meets = Some(vec![row(&[(2, 1.0), (ONE, g)]), state(1), state(2), state(3)]);
    let gap = row(&[(0, 1.0), (2, -1.0), (ONE, -g)]);
    let impact = until("impact", gap, meets, vec![(Some(trial(1.0, 1.0)), 2), (None, 1)]);
    let yields = until("give-way", trial(1.0, 1.0), surface(1.0), vec![(None, 2)]);
    let leaves = until("separation", trial(-1.0, 0.0), surface(0.0), vec![(None, 0)]);
    let holds = until("hold", trial(-1.0, 1.0), surface(1.0), vec![(None, 1)]);
    let [flight, contact, progression] = rates(parameters);
    System {
        name: "percussive-oscillator".to_owned(),
        states: ["p", "y", "q", "v"].map(str::to_owned).to_vec(),
        scales: vec![1.0; STATES],
        time_scale: 1.0 / omega,
        omega,
        phi: angle,
        modes: vec![
            mode("no-contact", &flight, vec![impact]),
            mode("contact", &contact, vec![yields, leaves]),
            mode("progression", &progression, vec![holds]),
        ],
    }
}

/// The rates of the states in each phase.
fn rates(parameters: &Parameters) -> [[Row; STATES]; 3] {
    let Parameters { a, b, xi, .. } = *parameters;
    let two_xi = 2.0 * xi;
    let rate = 1.0 / two_xi;
    let force = |extra: &[(usize, f64)]| row(&[&[(COS, a), (ONE, b)], extra].concat());
    // sign (1 - q)/(2 xi).
    let closing = |sign: f64| [(2, -sign * rate), (ONE, sign * rate)];
    let still = || row(&[]);
    [
        [state(1), force(&[]), row(&[(2, -rate)]), still()],
        [state(1), force(&[(1, -two_xi), (2, -1.0)]), state(1), still()],
        [
            row(&closing(1.0)),
            force(&[(ONE, -1.0)]),
            row(&closing(1.0)),
            row(&[&[(1, 1.0)], closing(-1.0).as_slice()].concat()),
        ],
    ]
}

/// A row of which some entries are given and the others are zero.
fn row(entries: &[(usize, f64)]) -> Row {
    by_hand::row(STATES, entries)
}

/// The row that selects one state.
fn state(place: usize) -> Row {
    by_hand::state(STATES, place)
}

/// The place of a phase among the oscillator's modes.
pub(crate) fn place(phase: Phase) -> usize {
    MODES.iter().position(|mode| *mode == phase).unwrap_or_default()
}

impl Task {
    /// A task of the oscillator, as the task of a system.
    ///
    /// # Errors
    /// A start or a horizon that no system has.
    pub fn of_oscillator(task: &OscillatorTask) -> Result<Self, Failure> {
        let system = CheckedSystem::new(percussive(&task.parameters, task.forcing_angle))?;
        let system = Arc::new(system);
        let samples = task.sample_times();
        let run = Self::new(system, place(task.phase), &task.state, task.span, samples)?;
        let oscillator = Some(Arc::new(task.clone()));
        Ok(Self { watched: task.watched.clone(), oscillator, ..run })
    }
}

impl From<OscillatorOutcome> for Outcome {
    fn from(run: OscillatorOutcome) -> Self {
        let event = |it: OscillatorEvent| Event {
            event: it.event,
            mode: place(it.mode),
            elapsed: it.elapsed,
            state: Values::of(&it.state),
            before: it.before.map(|before| Values::of(&before)),
        };
        let look = |it: GuardSample<Phase>| GuardSample {
            t: it.t,
            mode: place(it.mode),
            guard: it.guard,
            value: it.value,
        };
        let trace = |it: Trace<Phase>| Trace {
            steps: it.steps,
            looks: it.looks.into_iter().map(look).collect(),
        };
        Self {
            events: run.events.into_iter().map(event).collect(),
            samples: run.samples.iter().map(|it| Values::of(it)).collect(),
            end: Values::of(&run.end),
            ended: run.ended,
            ended_at: run.ended_at,
            work: run.work,
            own_time: run.own_time,
            trace: run.trace.map(trace),
        }
    }
}

impl OscillatorOutcome {
    /// The outcome of a system's run as an outcome of the oscillator.
    ///
    /// # Errors
    /// A mode or a state that the oscillator does not have, or an end before the horizon.
    pub fn of_system(run: Outcome) -> Result<Self, Failure> {
        if run.ended != Ended::Horizon {
            return Err(Failure::new(format!("the run ended early: {:?}", run.ended)));
        }
        let event = |it: &Event| -> Result<OscillatorEvent, Failure> {
            let &Event { event, elapsed, .. } = it;
            let before = it.before.map(|before| four(&before)).transpose()?;
            Ok(Event { event, mode: phase(it.mode)?, elapsed, state: four(&it.state)?, before })
        };
        Ok(Self {
            events: run.events.iter().map(event).collect::<Result<_, _>>()?,
            samples: run.samples.iter().map(|it| four(it)).collect::<Result<_, _>>()?,
            end: four(&run.end)?,
            ended: run.ended,
            ended_at: run.ended_at,
            work: run.work,
            own_time: run.own_time,
            trace: run.trace.map(phases).transpose()?,
        })
    }
}

/// The phase of the oscillator that a mode stands for.
fn phase(mode: usize) -> Result<Phase, Failure> {
    MODES.get(mode).copied().ok_or_else(|| Failure::new(format!("no phase is {mode}")))
}

/// p, y, q and v.
fn four(state: &[f64]) -> Result<[f64; STATES], Failure> {
    let four = state.try_into();
    four.map_err(|_| Failure::new(format!("{} states, not {STATES}", state.len())))
}

/// A record of guards, with the phases that their modes are.
fn phases(trace: Trace) -> Result<Trace<Phase>, Failure> {
    let look = |it: GuardSample| -> Result<GuardSample<Phase>, Failure> {
        Ok(GuardSample { t: it.t, mode: phase(it.mode)?, guard: it.guard, value: it.value })
    };
    let looks = trace.looks.into_iter().map(look).collect::<Result<_, _>>()?;
    Ok(Trace { steps: trace.steps, looks })
}
