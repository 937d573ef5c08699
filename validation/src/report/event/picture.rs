//! The picture of a row's first wrong event.

use super::scene::{Scene, SceneCurve, in_order, telling};
use super::{EventPicture, View};
use crate::case::Case;
use crate::engine::{Equations, GuardSample, Task};
use crate::suite::PreparedCase;
use crate::suite::first_wrong::{EventMismatch, FirstWrongEvent, MismatchKind};
use crate::system::{AffineEquations, Direction, Row, System};

/// The pictures of first wrong events; none of an event whose guard is not known.
#[must_use]
pub fn event_pictures(events: &[FirstWrongEvent<'_>]) -> Vec<EventPicture> {
    events.iter().filter_map(picture).collect()
}

fn picture(shown: &FirstWrongEvent<'_>) -> Option<EventPicture> {
    let FirstWrongEvent { row, prepared, mismatch, .. } = shown;
    let PreparedCase { task, case, .. } = prepared;
    let system = task.system.system();
    let (mode, event) = mismatch.event;
    let guard = EventGuard::new(task, mismatch.event)?;
    let scene = scene(shown, &guard);
    let views: Vec<View> = shown.spans.iter().map(|span| scene.view(*span)).collect();
    let event = system.event_name(mode, event)?;
    Some(EventPicture {
        case: row.case.clone(),
        engine: row.engine.to_owned(),
        tolerance: row.accuracy.tolerance(),
        step: row.accuracy.step(),
        kind: mismatch.kind,
        title: title(mismatch, prepared, event),
        guard: format!("guard of {event}"),
        modes: modes(case, system),
        centre: mismatch.at,
        telling: telling(&views),
        views,
    })
}

/// The event and what is wrong with it, in one sentence.
fn title(mismatch: &EventMismatch, prepared: &PreparedCase, event: &str) -> String {
    if let Some(sentence) = &mismatch.sentence {
        let mut letters = sentence.chars();
        let first = letters.next().into_iter().flat_map(char::to_uppercase);
        return first.chain(letters).collect::<String>() + ".";
    }
    let system = prepared.task.system.system();
    let mode = &system.modes[mismatch.event.0].name;
    let EventMismatch { at, .. } = mismatch;
    let time = match at {
        1e-2..1e6 => format!("{at:.6}"),
        _ => format!("{at:.6e}"),
    };
    let period = at / prepared.period();
    let when =
        format!("{event} at {time} after the start (period {period:.2}), in the mode {mode}");
    match mismatch.kind {
        MismatchKind::Missed => format!("The first missed event is {when}."),
        MismatchKind::Spurious => format!("The first spurious event is {when}."),
        MismatchKind::Displaced => format!("The event farthest from its place is {when}."),
    }
}

/// The names of the modes; none of the oscillator, whose phases everyone knows.
fn modes(case: &Case, system: &System) -> Vec<String> {
    let modes = system.modes.iter().filter(|_| case.oscillator.is_none());
    modes.map(|mode| mode.name.clone()).collect()
}

/// The true run and the engine's run around an event.
fn scene(shown: &FirstWrongEvent<'_>, guard: &EventGuard) -> Scene {
    let FirstWrongEvent { prepared, mismatch, instants, .. } = shown;
    let PreparedCase { task, truth, .. } = prepared;
    let system = task.system.system();
    let values = |states: &[Vec<f64>]| -> Vec<f64> {
        instants.iter().zip(states).map(|(t, state)| guard.value(task, *t, state)).collect()
    };
    let known = |place: fn(&(usize, usize)) -> usize, i: usize| {
        mismatch.pairs.iter().any(|pair| place(pair) == i)
    };
    let name = |mode: usize| system.modes.get(mode).map(|it| it.name.clone()).unwrap_or_default();
    let rows = truth.events.iter().enumerate();
    let own = shown.engine.outcome.events.iter().enumerate();
    Scene {
        at: mismatch.at,
        first: name(task.mode),
        truth: SceneCurve {
            values: values(&shown.truth),
            events: rows
                .map(|(i, row)| (row.elapsed.value(), name(row.mode), known(|pair| pair.0, i)))
                .collect(),
        },
        engine: SceneCurve {
            values: values(&shown.engine.states),
            events: own
                .map(|(j, event)| (event.elapsed, name(event.mode), known(|pair| pair.1, j)))
                .collect(),
        },
        steps: shown.engine.steps.clone(),
        looks: in_order(shown.engine.looks.iter().filter_map(|look| guard.of_look(look))),
        instants: instants.clone(),
    }
}

/// The guard whose zero is an event.
struct EventGuard {
    row: Row,
    mode: usize,
    /// The guards of its mode that belong to the event, each with the sign with which it is looked
    /// at.
    looked: Vec<(usize, f64)>,
}

impl EventGuard {
    fn new(task: &Task, (mode, event): (usize, usize)) -> Option<Self> {
        let own = task.system.system().modes.get(mode)?;
        let equations = AffineEquations::new(&task.system);
        let guards = (0..equations.count(mode)).filter(|it| equations.event(mode, *it) == event);
        let watch = event.checked_sub(own.until.len()).and_then(|k| own.watch.get(k));
        let row = match own.until.get(event) {
            Some(until) => until.guard.clone(),
            None => watch?.guard.clone(),
        };
        let signs = match watch.map(|it| it.direction) {
            Some(Direction::Falling) => [-1.0, 1.0],
            _ => [1.0, -1.0],
        };
        Some(Self { row, mode, looked: guards.zip(signs).collect() })
    }

    fn value(&self, task: &Task, t: f64, state: &[f64]) -> f64 {
        let system = task.system.system();
        let (sin, cos) = (system.omega * t + system.phi).sin_cos();
        let z = state.iter().copied().chain([cos, sin, 1.0]);
        self.row.iter().zip(z).map(|(factor, value)| factor * value).sum()
    }

    /// When a search looked at the guard, and what it saw; none where it looked at another.
    fn of_look(&self, look: &GuardSample) -> Option<[f64; 2]> {
        let (_, sign) = self.looked.iter().find(|(guard, _)| *guard == look.guard)?;
        (look.mode == self.mode).then_some([look.t, sign * look.value])
    }
}
