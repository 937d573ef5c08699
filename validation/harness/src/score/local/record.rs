//! What is said of one record, beside what the exact continuation has.

use super::continuation::{Exact, Found, Named};
use super::judgement::{WrongKind, exceeds};
use super::walk::{Pending, Said, Walk};
use crate::engine::Event;
use crate::score::WINDOW;
use percuss::affine::Ending;

/// The largest location error of a right engine, in tolerances of the guard's size.
const LOCATION: f64 = 1.0;
/// The largest contradiction between the state before a reset and that after it, in tolerances.
const INCONSISTENCY: f64 = 1.0;

impl Walk<'_> {
    /// Says of a record what the continuation makes of it, and whether its event comes at the
    /// instant of the record before by the model.
    pub(super) fn said_of(
        &mut self,
        n: usize,
        event: &Event,
        found: Found,
        decided: bool,
    ) -> (Said, bool) {
        let named = Named { event: event.event, next: event.mode };
        let window = WINDOW * self.judge.problem.period();
        let said = match found {
            Found::Same(exact) => {
                let at_once = exact.at_once;
                self.take_pending(named);
                return (self.same(event, named, exact), at_once);
            }
            Found::Another(exact) => self.another(event, named, exact),
            Found::Late(exact) if event.elapsed - exact.elapsed <= window => {
                self.elsewhen(event, named, exact)
            }
            Found::Late(exact) => {
                self.missed(n, Some(event), exact);
                self.unexpected(event, named, None, decided)
            }
            Found::Nothing(next) => self.unexpected(event, named, next, decided),
            Found::Ended(Ending::Undecided) => {
                if self.take_pending(named) {
                    Said::Right
                } else {
                    Said::Undecidable
                }
            }
            Found::Ended(_) => self.unexpected(event, named, None, decided),
        };
        (said, false)
    }

    /// A record of the exact continuation's event, at its time.
    fn same(&mut self, event: &Event, named: Named, exact: Exact) -> Said {
        let stretch = self.place.stretch(exact.elapsed);
        let off = event.elapsed - exact.elapsed;
        let time = self.units.of_time(off, &stretch, named.event);
        self.found.defects.time.push(time);
        if exact.named.next != named.next {
            if self.successor_is_open(event, named, &stretch) {
                return Said::Undecidable;
            }
            return Said::Wrong(WrongKind::WrongMode, Some(exact), f64::NAN);
        }
        let location = if exact.at_once { None } else { self.location(event, named) };
        self.found.defects.location.extend(location);
        if let Some(location) = location.filter(|it| exceeds(*it, LOCATION)) {
            return Said::Wrong(WrongKind::Location, Some(exact), location);
        }
        let inconsistency = self.inconsistency(event, named);
        self.found.defects.inconsistency.extend(inconsistency);
        if let Some(defect) = inconsistency.filter(|it| exceeds(*it, INCONSISTENCY)) {
            return Said::Wrong(WrongKind::Inconsistent, Some(exact), defect);
        }
        let stretch = self.place.stretch(exact.elapsed);
        let state = self.units.of_state((&event.state, &exact.state), &stretch, named.event);
        // The time belongs to the state before the reset, which is one of the flow before it.
        let before = self.off_the_flow(event);
        self.found.defects.sample.extend(before);
        if before.is_some_and(|it| exceeds(it, self.units.allowance.sample)) {
            return Said::Wrong(WrongKind::Sample, Some(exact), before.unwrap_or(f64::NAN));
        }
        let is_close = time.abs() <= self.units.allowance.time;
        if is_close && state <= self.units.allowance.state {
            self.found.defects.state.push(state);
            return Said::Right;
        }
        // The time of a crossing that nearly is none says nothing.
        if state.is_finite() && self.is_graze(exact.elapsed, named.event) {
            self.found.defects.time.pop();
            return Said::Undecidable;
        }
        self.found.defects.state.push(state);
        if is_close {
            Said::Wrong(WrongKind::State, Some(exact), state)
        } else {
            Said::Wrong(WrongKind::Time, Some(exact), time)
        }
    }

    /// A record of an event in whose instant the exact continuation has another.
    fn another(&mut self, event: &Event, named: Named, exact: Exact) -> Said {
        if self.take_pending(named) {
            return Said::Right;
        }
        if !exact.ends_mode {
            // An event that is only counted does not change what follows: it has to come too.
            let stretch = self.place.stretch(exact.elapsed);
            let deadline = exact.elapsed + self.units.allowed_time(&stretch, exact.named.event);
            let name = self.judge.name(self.place.mode, exact.named.event);
            // The record before may have waited for the same one.
            if !self.pending.iter().any(|it| it.name == name) {
                self.pending.push(Pending { name, exact: exact.clone(), deadline });
            }
        }
        if !self.is_admissible(event, named) {
            return self.unexpected(event, named, Some(exact), true);
        }
        let location = self.location(event, named);
        self.found.defects.location.extend(location);
        match location.filter(|it| exceeds(*it, LOCATION)) {
            Some(location) => Said::Wrong(WrongKind::Location, None, location),
            None => Said::Right,
        }
    }

    /// A record that the exact continuation does not have.
    fn unexpected(
        &mut self,
        event: &Event,
        named: Named,
        next: Option<Exact>,
        decided: bool,
    ) -> Said {
        if self.take_pending(named) {
            return Said::Right;
        }
        if !decided || self.is_graze(event.elapsed, named.event) {
            return Said::Undecidable;
        }
        let window = WINDOW * self.judge.problem.period();
        match next {
            Some(exact)
                if exact.named.event == named.event && exact.elapsed - event.elapsed <= window =>
            {
                self.elsewhen(event, named, exact)
            }
            next => Said::Wrong(WrongKind::Spurious, next, f64::NAN),
        }
    }

    /// A record of the exact continuation's event, at another time than is allowed.
    fn elsewhen(&mut self, event: &Event, named: Named, exact: Exact) -> Said {
        let location = self.location(event, named);
        self.found.defects.location.extend(location);
        if let Some(location) = location.filter(|it| exceeds(*it, LOCATION)) {
            return Said::Wrong(WrongKind::Location, Some(exact), location);
        }
        let on_flow = self.off_the_flow(event).is_none_or(|it| it <= self.units.allowance.sample);
        if on_flow && self.is_graze(exact.elapsed, named.event) {
            return Said::Undecidable;
        }
        let stretch = self.place.stretch(exact.elapsed);
        let defect = self.units.of_time(event.elapsed - exact.elapsed, &stretch, named.event);
        self.found.defects.time.push(defect);
        Said::Wrong(WrongKind::Time, Some(exact), defect)
    }

    /// Takes an event that has to come from the list of those that do, which are in time still.
    fn take_pending(&mut self, named: Named) -> bool {
        let name = self.judge.name(self.place.mode, named.event);
        let place = self.pending.iter().position(|it| it.name == name);
        place.map(|it| self.pending.swap_remove(it)).is_some()
    }

    /// Counts the events as missed that had to come by now.
    pub(super) fn expire(&mut self, n: usize, event: &Event, now: f64) {
        let (over, open) = std::mem::take(&mut self.pending)
            .into_iter()
            .partition(|it: &Pending| it.deadline < now);
        self.pending = open;
        for pending in over {
            self.missed(n, Some(event), pending.exact);
        }
    }
}
