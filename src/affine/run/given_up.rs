//! The last row of a run that follows its errors and is given up: the motion is known farther than
//! to the last event, up to where the search has proved that no guard crosses.

use super::Run;
use super::enclosure::Enclosure;
use crate::affine::first_crossing::search::SearchOutcome;
use crate::affine::guards::point::{Ends, GuardedPoint};
use crate::affine::guards::row::ModalRow;
use crate::affine::guards::track::{SearchWork, Track, live_tracks};
use crate::affine::solver::event::{Ending, Event, What};
use crate::numeric::number::Number;

/// The number of times that the rest of the search is halved: what is open then is the last digits
/// of an f64.
const HALVINGS: usize = 50;

/// The point and the guards from which a search begins, in a run that follows its errors; boxed
/// where it is kept, because most runs have none.
pub(super) struct SearchStart<T: Number> {
    point: GuardedPoint<T>,
    tracks: Vec<Track>,
}

impl<T: Number> Run<'_, T> {
    /// Whether a run that follows its errors has met something that rounding leaves open.
    #[inline]
    pub(super) fn is_open(&self) -> bool {
        self.enclosure.is_some() && self.work.undecidable > 0
    }

    /// The beginning of the search that follows: none where errors are not followed, or where no
    /// time passes before the next event.
    #[inline]
    pub(super) fn search_start(&self) -> Option<Box<SearchStart<T>>> {
        let searches = self.enclosure.is_some() && self.at_entry == 0 && !self.is_open();
        let start = || SearchStart { point: self.ends.left.clone(), tracks: self.tracks.clone() };
        searches.then(|| Box::new(start()))
    }

    /// The errors at the entry of the segment, where they may be asked for once a crossing has
    /// replaced them: of several guards rounding may leave open which is the first, and of several
    /// successors which follows.
    #[inline]
    pub(super) fn errors_before(&self, mode: usize, guards: u64) -> Option<Enclosure<T::Bound>> {
        let is_choice = |it: &Vec<Option<ModalRow<T>>>| it.len() > 1;
        let several = guards.count_ones() > 1;
        let needed = several || self.solver.modes[mode].conditions.iter().any(is_choice);
        self.enclosure.as_ref().filter(|_| needed).cloned()
    }

    /// Gives an ending that the search just made has left undecided the time and the state that are
    /// known: the latest ones that it has proved to lie before every crossing.
    #[cold]
    #[inline(never)]
    pub(super) fn show_known_motion(&mut self, from: SearchStart<T>) {
        let is_own = self.queue.len() == 1 && self.ending() == Some(&Ending::Undecided);
        if !is_own || self.ends.left.time <= from.point.time {
            return;
        }
        let point = self.latest_clear(from);
        let Some(ending) = point.and_then(|point| self.undecided_at(&point)) else { return };
        self.queue.clear();
        self.queue.push_back(ending);
    }

    /// The ending at a point of the segment; none where the state or its errors have overflowed.
    fn undecided_at(&self, point: &GuardedPoint<T>) -> Option<Event<T>> {
        let (time, state) = self.time_and_state_at(point)?;
        let mode = self.graph.node(self.node).mode;
        let enclosure = self.errors_at_given_time(mode, point.time, &time, &state)?;
        let errors = Some(self.errors_near(&enclosure, &time)).filter(|it| it.are_finite())?;
        let what = What::End(Ending::Undecided);
        Some(Event { errors: Some(errors), ..self.event(what, time, &state) })
    }

    /// The latest point, as far as halving finds it, up to which no guard crosses and rounding
    /// leaves nothing open; none if that is where the search began.
    fn latest_clear(&mut self, from: SearchStart<T>) -> Option<GuardedPoint<T>> {
        if self.work.undecidable == 0 {
            // The search has taken too much work, and all before its left end is proved.
            let mut point = self.ends.left.clone();
            self.segment.complete(&mut point);
            return Some(point);
        }
        let (begin, mut end) = (from.point.time, self.ends.left.time);
        let mut clear = from;
        for _ in 0..HALVINGS {
            let middle = clear.point.time + (end - clear.point.time) * T::exact(0.5);
            match self.clear_at(&clear, middle) {
                Some(later) => clear = later,
                None => end = middle,
            }
        }
        (clear.point.time > begin).then(|| {
            self.segment.complete(&mut clear.point);
            clear.point
        })
    }

    /// The search's state at a time, if no guard crosses until then and each is clear of zero there
    /// by more than its errors, so that its next crossing is later.
    fn clear_at(&mut self, from: &SearchStart<T>, time: T) -> Option<SearchStart<T>> {
        let mode = self.graph.node(self.node).mode;
        let mut ends = Ends { left: from.point.clone(), ..Ends::default() };
        let (mut tracks, mut work) = (from.tracks.clone(), SearchWork::default());
        let failed_attempts = &mut self.failed_attempts[mode];
        let segment = &self.segment;
        let outcome = segment.first(&mut tracks, &mut ends, time, failed_attempts, &mut work);
        if outcome != SearchOutcome::NoCrossing || work.undecidable > 0 {
            return None;
        }
        segment.evaluate(&mut ends.left, time, &mut work);
        tracks.iter_mut().for_each(|track| track.zeros = 0);
        let is_inside = |(n, track): (usize, &Track)| {
            let value = ends.left.orders[n][0].bound() * track.outward;
            value < ends.left.slack[n] * -4.0
        };
        let is_clear = live_tracks(&tracks).all(is_inside);
        is_clear.then_some(SearchStart { point: ends.left, tracks })
    }
}
