//! The way in which a run ended, beside the ending of the exact continuation.

use super::judgement::{FirstWrong, WrongKind};
use super::units::Units;
use super::walk::Walk;
use crate::engine::Outcome;
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
            (Some(exact), Some(own)) if exact == own && is_in_time => {}
            // The ending may come just after the horizon, where it is not looked for.
            (None, Some(_)) if is_in_time => {}
            (Some(exact), _) => {
                self.found.missed += 1;
                self.wrong_ending(n, WrongKind::Missed, own, (Some(exact), elapsed), outcome);
            }
            (None, own) => {
                self.found.spurious += 1;
                self.wrong_ending(n, WrongKind::Spurious, own, (None, elapsed), outcome);
            }
        }
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

    fn wrong_ending(
        &mut self,
        n: usize,
        kind: WrongKind,
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
            defect: f64::NAN,
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
