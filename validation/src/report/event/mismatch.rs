//! The first event of a run that is not as it should be.

use super::guarded::GuardCurve;
use crate::engine::{Event, OscillatorTask, Outcome};
use crate::score::{Matching, Measures, RunGrowth, Verdict, WINDOW, occurrences};
use crate::suite::{Prepared, Scored, Status};
use crate::truth::{Truth, TruthRow};
use percuss::Phase;
use percuss::TwoWord;
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
    pub(super) kind: MismatchKind,
    /// When, since the start.
    pub(super) at: f64,
    /// How far it is to what it is confused with: the next event on its own side, or its partner.
    pub(super) reach: f64,
    pub(super) begins: Phase,
    pub(super) guarded: GuardCurve,
    /// Indices of the truth's and the engine's events that are the same.
    pub(super) pairs: Vec<(usize, usize)>,
}

/// Room for the rounding of a horizon that is kept in forcing periods.
const HORIZON_ROUNDING: f64 = 1e-12;

impl EventMismatch {
    /// The first missed or spurious event before the scored horizon; in a row that is out of bounds
    /// without one, the event that is farthest from its place.
    pub(super) fn first(prepared: &Prepared, task: &OscillatorTask, row: &Scored) -> Option<Self> {
        let Status::Ok(measures, outcome) = &row.status else { return None };
        let Sides { truth, engine, pairs } = Sides::of(&prepared.truth, task, measures, outcome);
        let missed = (0..truth.counted).find(|i| pairs.iter().all(|pair| pair.0 != *i));
        let missed = missed.map(|i| (truth.times[i], MismatchKind::Missed, i));
        let spurious = (0..engine.counted).find(|j| pairs.iter().all(|pair| pair.1 != *j));
        let spurious = spurious.map(|j| (engine.times[j], MismatchKind::Spurious, j));
        let first = [missed, spurious].into_iter().flatten().min_by(|a, b| a.0.total_cmp(&b.0));
        let found = match first {
            Some((_, MismatchKind::Spurious, j)) => engine.wrong(MismatchKind::Spurious, j),
            Some((_, kind, i)) => truth.wrong(kind, i),
            None if row.judgement.verdict == Verdict::Fail => {
                let (i, j) = farthest(&truth, &engine, &pairs, &prepared.growth)?;
                let reach = (truth.times[i] - engine.times[j]).abs();
                Self { reach, ..truth.wrong(MismatchKind::Displaced, i) }
            }
            None => return None,
        };
        Some(Self { pairs, ..found })
    }

    /// The event and what is wrong with it, in one sentence.
    pub(super) fn title(&self, period: f64) -> String {
        let what = match self.begins {
            Phase::NoContact => "the separation",
            Phase::Contact => "the beginning of contact",
            Phase::Progression => "the beginning of progression",
        };
        let when =
            format!("{:.6} after the start (forcing period {:.2})", self.at, self.at / period);
        match self.kind {
            MismatchKind::Missed => format!("The first missed event is {what} at {when}."),
            MismatchKind::Spurious => format!("The first spurious event is {what} at {when}."),
            MismatchKind::Displaced => {
                format!("The event farthest from its place is {what} at {when}.")
            }
        }
    }
}

/// The events of truth and engine around the scored horizon, paired as the scores pair them.
struct Sides {
    truth: EventsOf,
    engine: EventsOf,
    pairs: Vec<(usize, usize)>,
}

/// The events of one of them.
struct EventsOf {
    first: Phase,
    times: Vec<f64>,
    phases: Vec<Phase>,
    /// How many lie before the scored horizon.
    counted: usize,
}

impl Sides {
    fn of(truth: &Truth, task: &OscillatorTask, measures: &Measures, outcome: &Outcome) -> Self {
        let period = task.problem.model.period();
        let horizon = measures.horizon_periods * period * (1.0 + HORIZON_ROUNDING);
        let window = WINDOW * period;
        let near = |t: f64| t <= horizon + window;
        let rows = truth.events.iter().take_while(|row| near(row.elapsed.value()));
        let rows: Vec<TruthRow> = rows.copied().collect();
        let found = outcome.events.iter().take_while(|event| near(event.elapsed));
        let found: Vec<Event> = found.copied().collect();
        let pairs = Matching::of(&occurrences(&rows), &occurrences(&found), window).pairs;
        let phase = |row: &TruthRow| row.phase.unwrap_or(task.phase);
        let of = |times: Vec<f64>, phases| EventsOf {
            first: task.phase,
            counted: times.iter().take_while(|t| **t <= horizon).count(),
            times,
            phases,
        };
        Self {
            truth: of(
                rows.iter().map(|row| row.elapsed.value()).collect(),
                rows.iter().map(phase).collect(),
            ),
            engine: of(
                found.iter().map(|event| event.elapsed).collect(),
                found.iter().map(|event| Phase::ALL[event.mode]).collect(),
            ),
            pairs,
        }
    }
}

impl EventsOf {
    fn wrong(&self, kind: MismatchKind, i: usize) -> EventMismatch {
        let at = self.times[i];
        let before = if i == 0 { self.first } else { self.phases[i - 1] };
        let neighbours = [i.checked_sub(1), Some(i + 1)].into_iter().flatten();
        let distances = neighbours.filter_map(|k| self.times.get(k)).map(|t| (t - at).abs());
        EventMismatch {
            kind,
            at,
            reach: distances.fold(f64::INFINITY, f64::min),
            begins: self.phases[i],
            guarded: GuardCurve::of(before, self.phases[i]),
            pairs: Vec::new(),
        }
    }
}

/// The pair whose times differ most for what errors have grown to there.
fn farthest(
    truth: &EventsOf,
    engine: &EventsOf,
    pairs: &[(usize, usize)],
    growth: &RunGrowth,
) -> Option<(usize, usize)> {
    let share = |(i, j): &(usize, usize)| {
        let error = TwoWord::new(truth.times[*i]).minus(TwoWord::new(engine.times[*j]));
        error.value().abs() / (growth.events[*i][0] * (*i + 1) as f64)
    };
    let counted = pairs.iter().filter(|(i, _)| *i < truth.counted);
    counted.max_by(|a, b| share(a).total_cmp(&share(b))).copied()
}
