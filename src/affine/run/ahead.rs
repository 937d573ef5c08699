//! A search beyond the horizon, by a run that goes on from there: one that is asked for its state
//! at many times searches its events once, not anew from each of these times on.

use super::Run;
use crate::affine::first_crossing::search::SearchOutcome;
use crate::numeric::number::Number;

/// A run's search beyond its horizon.
#[derive(Clone, Copy, Debug)]
pub(super) struct SearchAhead<T> {
    /// The time beyond the horizon up to which events are searched.
    reach: T,
    /// The guards, as bits, of the crossing beyond the horizon at which the search has arrived.
    found: Option<u64>,
    /// The number of choices that rounding left open in the search from the horizon on.
    undecidable: u64,
}

impl<T: Number> Run<'_, T> {
    /// Lets each search go beyond the horizon by a time. A run that follows its errors does not,
    /// because what it cannot decide there would end it before its horizon.
    ///
    /// A choice that rounding leaves open in such a search is counted when the horizon has come to
    /// where the search arrived.
    pub fn search_ahead(&mut self, by: T) {
        let ahead = SearchAhead { reach: by, found: None, undecidable: 0 };
        self.ahead = self.enclosure.is_none().then_some(ahead);
    }

    /// Searches for the first crossing from the left end on that is not later than `limit` after
    /// the entry.
    #[inline]
    pub(super) fn search(&mut self, mode: usize, limit: T) -> SearchOutcome {
        let Some(ahead) = self.ahead else { return self.search_to(mode, limit) };
        if !self.is_by(limit) {
            return SearchOutcome::NoCrossing;
        }
        self.work.undecidable += ahead.undecidable;
        let anew = SearchAhead { found: None, undecidable: 0, ..ahead };
        self.ahead = Some(anew);
        match ahead.found {
            Some(guards) => SearchOutcome::Crossing(guards),
            None => self.search_beyond(mode, limit, anew),
        }
    }

    /// Searches up to a time after the entry, at which the left end is then where no guard crosses
    /// before.
    #[inline]
    pub(super) fn search_to(&mut self, mode: usize, limit: T) -> SearchOutcome {
        let (segment, ends, work) = (&self.segment, &mut self.ends, &mut self.work);
        let failed_attempts = &mut self.failed_attempts[mode];
        let from = ends.left.time;
        let outcome = segment.first(&mut self.tracks, ends, limit, failed_attempts, work);
        self.remember_doubt(mode);
        if outcome == SearchOutcome::NoCrossing && !self.is_open() {
            if limit > from {
                self.tracks.iter_mut().for_each(|track| track.zeros = 0);
            }
            let limit = if limit > T::zero() { limit } else { T::zero() };
            self.segment.evaluate(&mut self.ends.left, limit, &mut self.work);
        }
        outcome
    }

    #[inline]
    fn search_beyond(&mut self, mode: usize, limit: T, ahead: SearchAhead<T>) -> SearchOutcome {
        let before = self.work.undecidable;
        let outcome = self.search_to(mode, limit + ahead.reach);
        // A search that the run needs tells by itself whether it takes too much work.
        self.work.exhausted = false;
        let found = match outcome {
            SearchOutcome::Crossing(guards) if !self.is_by(limit) => Some(guards),
            SearchOutcome::Crossing(_) => return outcome,
            // The search goes on from where it has arrived.
            SearchOutcome::GivenUp if self.ends.left.time < limit => {
                return self.search_to(mode, limit);
            }
            SearchOutcome::GivenUp | SearchOutcome::NoCrossing => None,
        };
        let undecidable = self.work.undecidable - before;
        self.work.undecidable = before;
        self.ahead = Some(SearchAhead { found, undecidable, ..ahead });
        SearchOutcome::NoCrossing
    }

    /// Whether the left end is not later than a time after the entry; a crossing exactly there
    /// counts.
    #[inline]
    fn is_by(&self, limit: T) -> bool {
        let room = T::of_bound(T::unit() * 4.0 * limit.bound());
        self.ends.left.time + self.ends.left.to_crossing <= limit + room
    }

    /// Whether the left end is a crossing beyond the horizon.
    #[inline]
    pub(super) fn has_found(&self) -> bool {
        self.ahead.is_some_and(|it| it.found.is_some())
    }
}
