//! The way in which a run ended, beside the ending of the exact continuation.

use super::continuation::Named;
use super::judgement::{FirstWrong, WrongKind, exceeds};
use super::parts::MAX_LOCATION_ERROR;
use super::units::Units;
use super::walk::{MAX_SIMULTANEOUS_EVENTS, Walk};
use crate::engine::{self, Outcome};
use percuss::Ending;
use percuss::affine::{self, Event, What};

/// The relative distance by which rounding may part a run's end from its horizon: programs stop
/// stepping there.
const END_TOLERANCE: f64 = 32.0 * f64::EPSILON;

impl Walk<'_> {
    /// Holds the ending of a run, of which `n` records tell, against that of the exact
    /// continuation: one that it lacks is missed, and one that the continuation lacks is spurious.
    pub(super) fn ending(&mut self, n: usize, outcome: &Outcome, end: &Event<f64>) {
        let What::End(ref ending) = end.what else { return };
        // What follows an accumulation is no part of a case.
        let Some(exact) = before_the_horizon(ending) else { return };
        let early = self.is_early(outcome);
        if exact.is_none() && early && outcome.ended == Ending::Undecided {
            return self.cut_short(n, outcome.ended_at);
        }
        // A run that is followed as far as its impacts accumulate may say so.
        let own = match outcome.ended {
            Ending::Accumulation => early.then_some(Ending::Accumulation),
            own => Some(own).filter(|it| is_of_the_model(*it)),
        };
        // What comes after the last time that is judged is not.
        let own = own.filter(|_| outcome.ended_at <= self.judge.judged_until);
        let elapsed = self.coarse.elapsed(end);
        let is_in_time = (outcome.ended_at - elapsed).abs() <= self.allowed_at(end);
        match (exact, own) {
            (None, None) => {}
            (Some(exact), Some(own)) if exact == own && is_in_time => {
                let location = self.location_of_end(outcome);
                self.found.defects.location.extend(location);
                if let Some(defect) = location.filter(|it| exceeds(*it, MAX_LOCATION_ERROR)) {
                    self.found.inaccurate += 1;
                    let wrong = (WrongKind::Location, defect);
                    self.wrong_ending(n, wrong, Some(own), (Some(exact), elapsed), outcome);
                }
            }
            (None, Some(own)) if is_in_time && self.ends_just_after(own, end) => {}
            (Some(exact), _) => {
                self.found.missed += 1;
                self.wrong_ending(
                    n,
                    (WrongKind::Missed, f64::NAN),
                    own,
                    (Some(exact), elapsed),
                    outcome,
                );
            }
            (None, own) => {
                self.found.spurious += 1;
                self.wrong_ending(
                    n,
                    (WrongKind::Spurious, f64::NAN),
                    own,
                    (None, elapsed),
                    outcome,
                );
            }
        }
    }

    /// Whether the exact continuation, which comes to its horizon, ends in this way so soon after
    /// it that the run may say so.
    fn ends_just_after(&mut self, own: Ending, end: &Event<f64>) -> bool {
        let until = self.coarse.elapsed(end) + 2.0 * self.allowed_at(end);
        let place = &self.place;
        self.coarse.go_on(place.elapsed, &place.state, until, place.late);
        let mut events = self.coarse.by_ref().take(MAX_SIMULTANEOUS_EVENTS + 1);
        events.any(|it| matches!(&it.what, What::End(ending) if Ending::from(ending) == own))
    }

    /// Whether a run ends before its horizon by more than another count of the same time.
    pub(super) fn is_early(&self, outcome: &Outcome) -> bool {
        self.judge.judged_until - outcome.ended_at > END_TOLERANCE * self.judge.judged_until
    }

    /// The time by which the ending may be off: that of the guard which is nearest to zero.
    fn allowed_at(&self, end: &Event<f64>) -> f64 {
        let elapsed = self.coarse.elapsed(end);
        let motion = self.motion();
        let nearness = |guard: &usize| {
            let value = motion.value((self.place.mode, *guard, 0), elapsed, &end.state).value;
            value.abs() / motion.size(motion.guard(self.place.mode, *guard), &end.state)
        };
        let guards = 0..self.until_count();
        let nearest = guards.min_by(|a, b| nearness(a).total_cmp(&nearness(b)));
        let plain = self.units.allowance.time * self.at_once_within();
        let allowed = |guard| self.units.allowed_time(&self.place.stretch(elapsed), guard);
        nearest.map_or(plain + Units::rounding_of_time(elapsed), allowed)
    }

    /// The location of the end of a run back in time that leaves its mode: the guard nearest to
    /// zero in its last state.
    fn location_of_end(&self, outcome: &Outcome) -> Option<f64> {
        if outcome.ended != Ending::LeavesDomain {
            return None;
        }
        let mode = self.place.mode;
        let of = |event: usize| {
            let (elapsed, state) = (outcome.ended_at, outcome.end);
            let left = engine::Event { elapsed, event, mode, state, before: Some(state) };
            self.location(&left, Named { event, next: mode })
        };
        (0..self.until_count()).filter_map(of).min_by(f64::total_cmp)
    }

    fn wrong_ending(
        &mut self,
        n: usize,
        (kind, defect): (WrongKind, f64),
        own: Option<Ending>,
        (exact, elapsed): (Option<Ending>, f64),
        outcome: &Outcome,
    ) {
        let clock = |elapsed| self.judge.problem.clock(elapsed);
        let mode = self.judge.mode_name(self.place.mode);
        let word = |it: Ending| it.as_str().to_owned();
        let exact = exact.map_or_else(|| word(Ending::Horizon), word);
        let wrong = FirstWrong {
            n: n + 1,
            kind,
            elapsed: elapsed.min(outcome.ended_at),
            event: own.map(word),
            mode: own.map(|_| mode.clone()),
            time: own.map(|_| clock(outcome.ended_at)),
            state: None,
            exact: Some((exact, mode, clock(elapsed))),
            defect,
        };
        self.found.wrong(wrong);
    }
}

/// An ending that the model decides before a horizon.
const fn is_of_the_model(ended: Ending) -> bool {
    matches!(ended, Ending::LeavesDomain | Ending::NoProgress | Ending::BeyondGuard)
}

/// The ending before the horizon, or none at it; nothing where it cannot be told.
fn before_the_horizon(ending: &affine::Ending<f64>) -> Option<Option<Ending>> {
    match Ending::from(ending) {
        Ending::Horizon => Some(None),
        ending => is_of_the_model(ending).then_some(Some(ending)),
    }
}
