//! The first wrong event of a row, and its picture.

use super::scales::Scales;
use super::scene::{Scene, SceneCurve, in_order, telling};
use super::{EventPicture, View};
use crate::case::Case;
use crate::engine::{Engine, Equations, GuardSample, Limits, Outcome, Task, Watched, contain};
use crate::score::local::{FirstWrong, WrongKind};
use crate::score::{Matching, Measures, Verdict, WINDOW};
use crate::suite::{PreparedCase, Scored};
use crate::system::{Affine, Direction, Row, System};
use crate::truth::Truth;
use serde::Serialize;

/// The kind of error of an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum MismatchKind {
    /// A true event that the engine does not have.
    Missed,
    /// An event of the engine that the truth does not have.
    Spurious,
    /// Truth and engine have the event, and of all events its time is the worst for what errors
    /// have grown to there.
    Displaced,
}

/// An event that is wrong, and which events of truth and engine are the same.
pub(super) struct EventMismatch {
    kind: MismatchKind,
    /// The time of the event, since the start.
    at: f64,
    /// The distance to the event that it may be confused with: the next one of the same run, or its
    /// partner in the other.
    reach: f64,
    /// The mode in which it lies, and its number there.
    event: (usize, usize),
    /// Indices of the truth's and the engine's events that are the same.
    pairs: Vec<(usize, usize)>,
    /// What is wrong by the judgement of records, in a sentence.
    sentence: Option<String>,
}

/// Room for the rounding of a horizon that is kept in forcing periods.
const HORIZON_ROUNDING: f64 = 1e-12;

/// The events of truth or engine: when, and the mode and number of each.
type Events = Vec<(f64, (usize, usize))>;

impl EventMismatch {
    /// The first wrong event before the scored horizon, up to which the truth of the start can be
    /// drawn beside the run; in a row that is out of bounds without one, the event that is farthest
    /// from its place. An ending that is missed has no picture.
    pub(super) fn first(
        prepared: &PreparedCase,
        measures: &Measures,
        outcome: &Outcome,
        row: &Scored,
    ) -> Option<Self> {
        let first = measures.local.as_ref().and_then(|it| it.first_wrong.as_ref());
        if let Some(first) = first {
            let is_scored = first.elapsed <= measures.horizon_periods * prepared.period();
            let pairs = pairs(prepared, measures, outcome);
            return Self::of_record(prepared, outcome, first, pairs).filter(|_| is_scored);
        }
        Self::beside_the_truth(prepared, measures, outcome, row)
    }

    /// The first wrong event by the judgement of records.
    fn of_record(
        prepared: &PreparedCase,
        outcome: &Outcome,
        first: &FirstWrong,
        pairs: Vec<(usize, usize)>,
    ) -> Option<Self> {
        let engine = of_engine(&prepared.task, outcome);
        let (kind, event) = match first.kind {
            WrongKind::Missed => {
                let before = first.n.checked_sub(2).and_then(|it| outcome.events.get(it));
                let mode = before.map_or(prepared.task.mode, |it| it.mode);
                let (name, ..) = first.exact.as_ref()?;
                (MismatchKind::Missed, (mode, number(prepared, mode, name)?))
            }
            WrongKind::Sample => {
                let next = engine.iter().find(|it| it.0 > first.elapsed).or(engine.last())?;
                (MismatchKind::Displaced, next.1)
            }
            WrongKind::Spurious => (MismatchKind::Spurious, engine.get(first.n - 1)?.1),
            _ => (MismatchKind::Displaced, engine.get(first.n - 1)?.1),
        };
        let exact = first.exact.as_ref().map(|it| it.2).zip(first.time);
        let off = exact.map_or(f64::INFINITY, |(exact, own)| (exact - own).abs());
        let others = engine.iter().map(|it| (it.0 - first.elapsed).abs());
        let apart = others.filter(|apart| *apart > 0.0).fold(f64::INFINITY, f64::min);
        let reach = if off > 0.0 { off.min(apart) } else { apart };
        let sentence = Some(first.sentence());
        Some(Self { kind, at: first.elapsed, reach, event, pairs, sentence })
    }

    fn beside_the_truth(
        prepared: &PreparedCase,
        measures: &Measures,
        outcome: &Outcome,
        row: &Scored,
    ) -> Option<Self> {
        let truth = of_truth(&prepared.truth);
        let engine = of_engine(&prepared.task, outcome);
        let pairs = pairs(prepared, measures, outcome);
        let missed = measures.mismatch.missed.first().and_then(|i| Some((truth.get(*i)?.0, *i)));
        let missed = missed.map(|(at, i)| (at, MismatchKind::Missed, i));
        let spurious = measures.mismatch.spurious.first();
        let spurious = spurious.and_then(|j| Some((engine.get(*j)?.0, *j)));
        let spurious = spurious.map(|(at, j)| (at, MismatchKind::Spurious, j));
        let first = [missed, spurious].into_iter().flatten().min_by(|a, b| a.0.total_cmp(&b.0));
        match first {
            Some((_, MismatchKind::Spurious, j)) => {
                Some(Self::of(MismatchKind::Spurious, &engine, j, pairs))
            }
            Some((_, kind, i)) => Some(Self::of(kind, &truth, i, pairs)),
            None if row.judgement.verdict == Verdict::Fail => {
                let (i, j) = farthest(prepared, (&truth, &engine), &pairs)?;
                let reach = (truth[i].0 - engine[j].0).abs();
                Some(Self { reach, ..Self::of(MismatchKind::Displaced, &truth, i, pairs) })
            }
            None => None,
        }
    }

    fn of(kind: MismatchKind, events: &Events, i: usize, pairs: Vec<(usize, usize)>) -> Self {
        let (at, event) = events[i];
        let others = events.iter().map(|it| (it.0 - at).abs()).filter(|apart| *apart > 0.0);
        let reach = others.fold(f64::INFINITY, f64::min);
        Self { kind, at, reach, event, pairs, sentence: None }
    }

    fn title(&self, prepared: &PreparedCase, event: &str) -> String {
        if let Some(sentence) = &self.sentence {
            let mut letters = sentence.chars();
            let first = letters.next().into_iter().flat_map(char::to_uppercase);
            return first.chain(letters).collect::<String>() + ".";
        }
        let system = prepared.task.system.system();
        let mode = &system.modes[self.event.0].name;
        let Self { at, .. } = self;
        let time = match at {
            1e-2..1e6 => format!("{at:.6}"),
            _ => format!("{at:.6e}"),
        };
        let period = at / prepared.period();
        let when =
            format!("{event} at {time} after the start (period {period:.2}), in the mode {mode}");
        match self.kind {
            MismatchKind::Missed => format!("The first missed event is {when}."),
            MismatchKind::Spurious => format!("The first spurious event is {when}."),
            MismatchKind::Displaced => format!("The event farthest from its place is {when}."),
        }
    }
}

/// The number of an event of a mode by its name.
fn number(prepared: &PreparedCase, mode: usize, name: &str) -> Option<usize> {
    let system = prepared.task.system.system();
    let own = system.modes.get(mode)?;
    let all = 0..own.until.len() + own.watch.len();
    all.into_iter().find(|it| system.event_name(mode, *it) == Some(name))
}

fn of_truth(truth: &Truth) -> Events {
    let mut mode = truth.start.mode;
    let one = |row: &crate::truth::TruthRow| {
        let before = std::mem::replace(&mut mode, row.mode);
        (row.elapsed.value(), (before, row.event))
    };
    truth.events.iter().map(one).collect()
}

fn of_engine(task: &Task, outcome: &Outcome) -> Events {
    let mut mode = task.mode;
    let one = |event: &crate::engine::Event| {
        let before = std::mem::replace(&mut mode, event.mode);
        (event.elapsed, (before, event.event))
    };
    outcome.events.iter().map(one).collect()
}

/// The events of truth and engine that are the same, paired as the scores pair them.
fn pairs(prepared: &PreparedCase, measures: &Measures, outcome: &Outcome) -> Vec<(usize, usize)> {
    let PreparedCase { task, truth, .. } = prepared;
    let names = prepared.names();
    let window = WINDOW * prepared.period();
    let horizon = measures.horizon_periods * prepared.period() * (1.0 + HORIZON_ROUNDING);
    let near = |events: Vec<crate::score::Occurrence>| {
        let near = events.into_iter().take_while(|it| it.elapsed <= horizon + window);
        near.collect::<Vec<_>>()
    };
    let (all, own) = (near(names.of_truth(truth)), near(names.of_outcome(task, truth, outcome)));
    Matching::of(&all, &own, window).pairs
}

/// The pair whose times differ most for what errors have grown to there.
fn farthest(
    prepared: &PreparedCase,
    (truth, engine): (&Events, &Events),
    pairs: &[(usize, usize)],
) -> Option<(usize, usize)> {
    let share = |(i, j): &(usize, usize)| {
        let growth = prepared.truth.events[*i].growth_time;
        (truth[*i].0 - engine[*j].0).abs() / (growth * (*i + 1) as f64)
    };
    let events = pairs.iter().filter(|(i, j)| *i < truth.len() && *j < engine.len());
    events.max_by(|a, b| share(a).total_cmp(&share(b))).copied()
}

/// Runs a row again and watches it around its first wrong event.
pub(super) fn picture(
    prepared: &PreparedCase,
    row: &Scored,
    it: &EventMismatch,
    (engine, mean_step, limits): (&dyn Engine, f64, &Limits),
) -> Option<EventPicture> {
    let PreparedCase { task, case, .. } = prepared;
    let system = task.system.system();
    let (mode, event) = it.event;
    let guard = EventGuard::of(task, it.event)?;
    let scales = Scales::around((it.at, it.reach), mean_step, prepared.period(), task.span);
    let instants = scales.all_instants();
    let states = Truth::states(case, &instants)?;
    let watched = Watched { window: scales.window(), instants: instants.clone() };
    let again = Task { watched: Some(watched), ..task.clone() };
    let outcome = contain(|| engine.run(&again, row.accuracy, limits)).ok()?;
    let scene = scene(prepared, it, &guard, &outcome, (&instants, &states));
    let views: Vec<View> = scales.spans.iter().map(|span| scene.view(*span)).collect();
    let event = system.event_name(mode, event)?;
    Some(EventPicture {
        case: row.case.clone(),
        engine: row.engine.to_owned(),
        tolerance: row.accuracy.tolerance(),
        step: row.accuracy.step(),
        kind: it.kind,
        title: it.title(prepared, event),
        guard: format!("guard of {event}"),
        modes: modes(case, system),
        centre: it.at,
        telling: telling(&views),
        views,
    })
}

/// The names of the modes; none of the oscillator, whose phases everyone knows.
fn modes(case: &Case, system: &System) -> Vec<String> {
    let modes = system.modes.iter().filter(|_| case.oscillator.is_none());
    modes.map(|mode| mode.name.clone()).collect()
}

/// The true run and the engine's run around an event, from the true states and the outcome of the
/// engine's run at the same instants.
fn scene(
    prepared: &PreparedCase,
    it: &EventMismatch,
    guard: &EventGuard,
    outcome: &Outcome,
    (instants, states): (&[f64], &[Vec<f64>]),
) -> Scene {
    let PreparedCase { task, truth, .. } = prepared;
    let system = task.system.system();
    let of_states = |states: &mut dyn Iterator<Item = &[f64]>| -> Vec<f64> {
        instants.iter().zip(states).map(|(t, state)| guard.value(task, *t, state)).collect()
    };
    let trace = outcome.trace.as_ref();
    let looks = trace.map_or(&[][..], |trace| &trace.looks).iter();
    let known = |place: fn(&(usize, usize)) -> usize, i: usize| {
        it.pairs.iter().any(|pair| place(pair) == i)
    };
    let name = |mode: usize| system.modes.get(mode).map(|it| it.name.clone()).unwrap_or_default();
    let rows = truth.events.iter().enumerate();
    let own = outcome.events.iter().enumerate();
    Scene {
        at: it.at,
        first: name(task.mode),
        truth: SceneCurve {
            values: of_states(&mut states.iter().map(Vec::as_slice)),
            events: rows
                .map(|(i, row)| (row.elapsed.value(), name(row.mode), known(|pair| pair.0, i)))
                .collect(),
        },
        engine: SceneCurve {
            values: match trace {
                Some(_) => of_states(&mut outcome.samples.iter().map(|it| &it[..])),
                None => Vec::new(),
            },
            events: own
                .map(|(j, event)| (event.elapsed, name(event.mode), known(|pair| pair.1, j)))
                .collect(),
        },
        steps: trace.map(|trace| trace.steps.clone()).unwrap_or_default(),
        looks: in_order(looks.filter_map(|look| guard.of_look(look))),
        instants: instants.to_vec(),
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
    fn of(task: &Task, (mode, event): (usize, usize)) -> Option<Self> {
        let own = task.system.system().modes.get(mode)?;
        let equations = Affine::of(&task.system);
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
