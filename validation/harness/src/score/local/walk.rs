//! The walk along an engine's records: each is judged from the one before it.

use super::continuation::{Continuation, Exact, Found, Named, Place, continuation, exact};
use super::judgement::{END, FirstWrong, LocalJudgement, WrongKind};
use super::motion::Motion;
use super::pending::Pending;
use super::run::JudgedRun;
use super::units::Units;
use crate::engine::{Event, Outcome};
use crate::system::Values;
use percuss::Ending;
use percuss::affine::{DoubleDouble, Follower, What};

/// The tolerance below which f64 alone condemns nothing.
const MIN_F64_TOLERANCE: f64 = 1e-9;
/// The most exact events after the last record that are counted.
const MAX_EVENTS_LEFT: usize = 100_000;
/// Events of one instant after which a run makes no progress.
pub(super) const MAX_SIMULTANEOUS_EVENTS: usize = 64;

/// A walk, at one of the records.
pub(super) struct Walk<'a> {
    pub(super) judge: &'a JudgedRun,
    pub(super) units: Units<'a>,
    pub(super) coarse: Follower<'a, f64>,
    /// The same follower in 106 bits, once they are asked for.
    pub(super) fine: Option<Follower<'a, DoubleDouble>>,
    pub(super) place: Place,
    /// The time up to which the present flow is the answer's: that of the record in hand.
    pub(super) told_until: f64,
    pub(super) answer: Samples<'a>,
    pub(super) pending: Vec<Pending>,
    /// Whether the record in hand leaves the run where it was.
    pub(super) stays: bool,
    /// Records of the present instant.
    pub(super) at_once: usize,
    pub(super) found: LocalJudgement,
}

/// The states at the instants of output in an answer.
#[derive(Clone, Copy)]
pub(super) struct Samples<'a> {
    pub(super) times: &'a [f64],
    pub(super) states: &'a [Values],
}

/// What is said of a record.
pub(super) enum Said {
    /// The record is right.
    Right,
    /// Either answer is right.
    Undecidable,
    /// The record is wrong: the kind of error, the event of the exact continuation where one is
    /// known, and the defect as a multiple of its unit, NaN where nothing is measured.
    Wrong(WrongKind, Option<Exact>, f64),
}

impl Said {
    /// Adds the exact continuation's event to what is wrong, where none is named yet.
    pub(super) fn with_exact_event(self, exact: Exact) -> Self {
        match self {
            Self::Wrong(kind, None, defect) => Self::Wrong(kind, Some(exact), defect),
            said => said,
        }
    }
}

impl<'a> Walk<'a> {
    pub(super) fn motion(&self) -> &'a Motion {
        &self.judge.motion
    }

    pub(super) fn until_count(&self) -> usize {
        self.motion().system().modes[self.place.mode].until.len()
    }

    /// Judges a record, and goes on to it.
    pub(super) fn record(&mut self, n: usize, event: &Event) {
        self.told_until = event.elapsed;
        let named = Named { event: event.event, next: event.mode };
        let continuation = self.continuation((named, event.elapsed));
        let Continuation { found, passed, decided } = continuation;
        let at_entry = matches!(&found, Found::Same(exact) if exact.at_once);
        self.expire(n, event, event.elapsed);
        for exact in passed {
            self.count_missed(n, Some(event), exact);
        }
        let rests = event.elapsed - self.place.elapsed <= Units::rounding_of_time(event.elapsed);
        self.at_once = if rests { self.at_once + 1 } else { 1 };
        let mode = &self.motion().system().modes[self.place.mode];
        let is_of_the_mode = event.event < mode.until.len() + mode.watch.len();
        // A run that makes no progress has ended.
        let said = if !is_of_the_mode || self.at_once > MAX_SIMULTANEOUS_EVENTS {
            Said::Wrong(WrongKind::Spurious, None, f64::NAN)
        } else {
            self.said_of(n, event, found, decided)
        };
        self.count(n, event, said);
        if !std::mem::take(&mut self.stays) {
            self.go_on(named, event, at_entry);
        }
    }

    pub(super) fn at_once_within(&self) -> f64 {
        self.units.tolerance() * self.motion().system().time_scale
    }

    /// The exact continuation up to a record: in f64, and in 106 bits where that finds the record
    /// wrong by little or does not decide.
    fn continuation(&mut self, record: (Named, f64)) -> Continuation {
        let found = continuation(&self.units, &mut self.coarse, &self.place, record);
        let is_good = matches!(found.found, Found::Same(_)) && found.passed.is_empty();
        if found.decided && (is_good || self.units.tolerance() >= MIN_F64_TOLERANCE) {
            return found;
        }
        let Some(solver) = self.judge.fine() else { return found };
        if self.fine.is_none() {
            self.fine = solver.follow(&self.judge.problem.start).ok();
        }
        let Some(fine) = &mut self.fine else { return found };
        fine.adopt(&self.coarse);
        continuation(&self.units, fine, &self.place, record)
    }

    /// Counts an exact event that no record tells, and says whether it had to be told.
    pub(super) fn count_missed(&mut self, n: usize, next: Option<&Event>, exact: Exact) -> bool {
        // An event of a mode that the records have left since is none of the present flow.
        let is_present = exact.mode == self.place.mode;
        let guard = exact.named.event;
        if is_present
            && !self.begins_inside(guard, exact.elapsed)
            && self.is_graze(exact.elapsed, guard)
        {
            self.found.undecidable += 1;
            return false;
        }
        self.found.missed += 1;
        let wrong = FirstWrong {
            n: n + 1,
            kind: WrongKind::Missed,
            elapsed: exact.elapsed,
            event: None,
            mode: None,
            time: next.map(|it| self.judge.problem.clock(it.elapsed)),
            state: next.map(|it| it.state.to_vec()),
            exact: Some(self.named(&exact)),
            defect: f64::NAN,
        };
        self.found.wrong(wrong);
        true
    }

    fn named(&self, exact: &Exact) -> (String, String, f64) {
        let name = self.judge.name(exact.mode, exact.named.event);
        let next = self.judge.mode_name(exact.named.next);
        (name, next, self.judge.problem.clock(exact.elapsed))
    }

    fn count(&mut self, n: usize, event: &Event, said: Said) {
        let (kind, exact, defect) = match said {
            Said::Right => return self.found.right += 1,
            Said::Undecidable => return self.found.undecidable += 1,
            Said::Wrong(kind, exact, defect) => (kind, exact, defect),
        };
        let found = &mut self.found;
        let counter = match kind {
            WrongKind::Spurious => &mut found.spurious,
            WrongKind::WrongMode => &mut found.wrong_mode,
            WrongKind::Inconsistent => &mut found.inconsistent,
            _ => &mut found.inaccurate,
        };
        *counter += 1;
        let wrong = FirstWrong {
            n: n + 1,
            kind,
            elapsed: event.elapsed,
            event: Some(self.judge.name(self.place.mode, event.event)),
            mode: Some(self.judge.mode_name(event.mode)),
            time: Some(self.judge.problem.clock(event.elapsed)),
            state: Some(event.state.to_vec()),
            exact: exact.map(|it| self.named(&it)),
            defect,
        };
        self.found.wrong(wrong);
    }

    /// After the last record no exact event may lie before the end of what is judged.
    pub(super) fn end(&mut self, outcome: &Outcome) {
        let n = outcome.events.len();
        self.told_until = outcome.ended_at;
        for pending in std::mem::take(&mut self.pending) {
            self.count_missed(n, None, pending.exact);
        }
        let early = self.is_early(outcome);
        if early && outcome.ended == Ending::Horizon {
            return self.cut_short(n, outcome.ended_at);
        }
        if early && outcome.ended == Ending::NoProgress && self.at_once >= MAX_SIMULTANEOUS_EVENTS {
            return;
        }
        let end = self.judge.judged_until - self.units.allowance.time * self.at_once_within();
        let mut gone_past = self.place.late;
        self.coarse.go_on(self.place.elapsed, &self.place.state, end, gone_past);
        let until = self.until_count();
        for _ in 0..MAX_SIMULTANEOUS_EVENTS {
            let at_once = self.coarse.fires_at_once();
            let Some(event) = self.coarse.next() else { return };
            let Some(own) = exact(&self.coarse, &event, until, at_once) else {
                return self.ending(n, outcome, &event);
            };
            let allowed =
                self.units.allowed_time(&self.place.stretch(own.elapsed), own.named.event);
            let accumulates = own.elapsed - self.place.elapsed < self.judge.shortest;
            if accumulates || own.elapsed > self.judge.judged_until - allowed {
                return;
            }
            let (elapsed, guard, ends_mode) = (own.elapsed, own.named.event, own.ends_mode);
            let missed = self.count_missed(n, None, own);
            // What may be passed over is, and what is missed tells what else is.
            self.coarse.go_on(self.place.elapsed, &self.place.state, end, gone_past);
            if missed && ends_mode {
                return self.count_left();
            }
            gone_past |= if ends_mode { 1 << guard } else { 0 };
            let after = elapsed + (0.5 * allowed).min(0.5 * (end - elapsed));
            self.coarse.go_past(after, end, gone_past);
        }
    }

    /// Whether the exact continuation of the present record has an event within a time.
    pub(super) fn has_next_within(&mut self, time: f64) -> bool {
        let Place { elapsed, ref state, late, .. } = self.place;
        self.coarse.go_on(elapsed, state, elapsed + time, late);
        // Only at the start do events come together in such a run.
        let rests = self.coarse.fires_at_once() && elapsed == 0.0;
        let next = self.coarse.next();
        !rests && next.is_some_and(|it| !matches!(it.what, What::End(_)))
    }

    /// Counts the end of a run as missed that ends before its horizon without a reason.
    pub(super) fn cut_short(&mut self, n: usize, ended_at: f64) {
        self.found.missed += 1;
        let horizon = self.judge.problem.clock(self.judge.judged_until);
        self.found.wrong(FirstWrong {
            n: n + 1,
            kind: WrongKind::Missed,
            elapsed: ended_at,
            event: None,
            mode: None,
            time: None,
            state: None,
            exact: Some((END.to_owned(), self.judge.mode_name(self.place.mode), horizon)),
            defect: f64::NAN,
        });
    }

    /// Counts the events of the exact continuation as missed, but for the first, which was.
    fn count_left(&mut self) {
        let events = self.coarse.by_ref().take(MAX_EVENTS_LEFT);
        let is_event = |it: &percuss::affine::Event<f64>| !matches!(it.what, What::End(_));
        self.found.missed += events.filter(is_event).count().saturating_sub(1);
    }
}
