//! The first wrong event of a row: which event it is, and how far it is from what it may be
//! confused with.

use crate::engine::{Outcome, Task};
use crate::score::local::{FirstWrong, WrongKind};
use crate::score::{Matching, Measures, Verdict, WINDOW};
use crate::suite::{PreparedCase, Scored};
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
#[derive(Clone, Debug)]
pub struct EventMismatch {
    /// What is wrong with it.
    pub kind: MismatchKind,
    /// The time of the event, since the start.
    pub at: f64,
    /// The distance to the event that it may be confused with: the next one of the same run, or its
    /// partner in the other.
    pub(super) reach: f64,
    /// The mode in which it lies, and its number there.
    pub event: (usize, usize),
    /// Indices of the truth's and the engine's events that are the same.
    pub pairs: Vec<(usize, usize)>,
    /// What is wrong by the judgement of records, in a sentence.
    pub sentence: Option<String>,
}

/// Room for the rounding of a horizon that is kept in forcing periods.
const HORIZON_TOLERANCE: f64 = 1e-12;

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
                Some(Self::new(MismatchKind::Spurious, &engine, j, pairs))
            }
            Some((_, kind, i)) => Some(Self::new(kind, &truth, i, pairs)),
            None if row.judgement.verdict == Verdict::Fail => {
                let (i, j) = farthest_pair(prepared, (&truth, &engine), &pairs)?;
                let reach = (truth[i].0 - engine[j].0).abs();
                Some(Self { reach, ..Self::new(MismatchKind::Displaced, &truth, i, pairs) })
            }
            None => None,
        }
    }

    fn new(kind: MismatchKind, events: &Events, i: usize, pairs: Vec<(usize, usize)>) -> Self {
        let (at, event) = events[i];
        let others = events.iter().map(|it| (it.0 - at).abs()).filter(|apart| *apart > 0.0);
        let reach = others.fold(f64::INFINITY, f64::min);
        Self { kind, at, reach, event, pairs, sentence: None }
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
    let horizon = measures.horizon_periods * prepared.period() * (1.0 + HORIZON_TOLERANCE);
    let near = |events: Vec<crate::score::Occurrence>| {
        let near = events.into_iter().take_while(|it| it.elapsed <= horizon + window);
        near.collect::<Vec<_>>()
    };
    let (all, own) = (near(names.of_truth(truth)), near(names.of_outcome(task, truth, outcome)));
    Matching::new(&all, &own, window).pairs
}

/// The pair whose times differ most for what errors have grown to there.
fn farthest_pair(
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
