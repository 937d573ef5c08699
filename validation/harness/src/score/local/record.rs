//! What is said of one record, beside what the exact continuation has.

use super::continuation::{Exact, Found, Named};
use super::judgement::{Defects, WrongKind, exceeds};
use super::parts::{MAX_INCONSISTENCY, MAX_LOCATION_ERROR};
use super::walk::{Said, Walk};
use crate::engine::Event;
use crate::score::WINDOW;
use percuss::Ending;

impl Walk<'_> {
    /// Says of a record what the continuation makes of it.
    pub(super) fn said_of(&mut self, n: usize, event: &Event, found: Found, decided: bool) -> Said {
        let named = Named { event: event.event, next: event.mode };
        let window = WINDOW * self.judge.problem.period();
        match found {
            Found::Same(exact) => {
                self.take_pending(named);
                self.judge_on_time(event, named, exact)
            }
            Found::Another(exact) => self.another(event, named, exact),
            Found::Late(exact) if event.elapsed - exact.elapsed <= window => {
                self.judge_off_time(event, named, exact)
            }
            Found::Late(exact) => {
                self.count_missed(n, Some(event), exact);
                self.judge_unexpected(event, named, None, decided)
            }
            Found::Nothing(next) => self.judge_unexpected(event, named, next, decided),
            Found::Ended(Ending::Undecided) => match self.take_pending(named) {
                Some(pending) => self.judge_awaited(event, named, &pending),
                None => self.after_undecided(event, named),
            },
            Found::Ended(_) => self.judge_unexpected(event, named, None, decided),
        }
    }

    /// A record beyond which the exact continuation is not decided: its parts still have to agree.
    fn after_undecided(&mut self, event: &Event, named: Named) -> Said {
        let mut defects = Defects::default();
        let said = self.contradiction(event, named, &mut defects);
        self.found.defects.append(defects);
        said.unwrap_or(Said::Undecidable)
    }

    /// A record of the exact continuation's event, at its time.
    fn judge_on_time(&mut self, event: &Event, named: Named, exact: Exact) -> Said {
        let stretch = self.place.stretch(exact.elapsed);
        let off = event.elapsed - exact.elapsed;
        let time = self.units.of_time(off, &stretch, named.event);
        self.found.defects.time.push(time);
        if exact.named.next != named.next {
            if self.successor_is_open(event, named, &stretch) {
                return self.open(event, named).with_exact_event(exact);
            }
            return Said::Wrong(WrongKind::WrongMode, Some(exact), f64::NAN);
        }
        let location = if exact.at_once { None } else { self.location(event, named) };
        self.found.defects.location.extend(location);
        if let Some(location) = location.filter(|it| exceeds(*it, MAX_LOCATION_ERROR)) {
            return Said::Wrong(WrongKind::Location, Some(exact), location);
        }
        let inconsistency = self.inconsistency(event, named);
        self.found.defects.inconsistency.extend(inconsistency);
        if let Some(defect) = inconsistency.filter(|it| exceeds(*it, MAX_INCONSISTENCY)) {
            return Said::Wrong(WrongKind::Inconsistent, Some(exact), defect);
        }
        let state = self.off_the_state(event, named, &exact);
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
            return self.open(event, named).with_exact_event(exact);
        }
        self.found.defects.state.push(state);
        if is_close {
            Said::Wrong(WrongKind::State, Some(exact), state)
        } else {
            Said::Wrong(WrongKind::Time, Some(exact), time)
        }
    }

    /// The defect of a record's state beside the exact one. Of a crossing that is nearly tangential
    /// the states of its two times differ by more than the time's error to first order: a state
    /// that its event makes of the flow at its own time has no error of its own, and where the
    /// state before the reset is told, the time has been judged by the location.
    fn off_the_state(&mut self, event: &Event, named: Named, exact: &Exact) -> f64 {
        let stretch = self.place.stretch(exact.elapsed);
        let state = self.units.of_state((&event.state, &exact.state), &stretch, named.event);
        if event.before.is_some() && exceeds(state, self.units.allowance.state) {
            return state.min(self.off_the_reset(event, named));
        }
        state
    }

    /// A record of an event in whose instant the exact continuation has another.
    fn another(&mut self, event: &Event, named: Named, exact: Exact) -> Said {
        if let Some(pending) = self.take_pending(named) {
            return self.judge_awaited(event, named, &pending);
        }
        if !exact.ends_mode {
            // An event that is only counted does not change what follows: it has to come too.
            self.await_event(&exact);
        }
        if !self.is_admissible(event, named) {
            return self.judge_unexpected(event, named, Some(exact), true);
        }
        self.by_its_own_event(event, named).with_exact_event(exact)
    }

    /// A record that the exact continuation does not have.
    fn judge_unexpected(
        &mut self,
        event: &Event,
        named: Named,
        next: Option<Exact>,
        decided: bool,
    ) -> Said {
        if let Some(pending) = self.take_pending(named) {
            return self.judge_awaited(event, named, &pending);
        }
        let undecided = !decided && self.is_admissible(event, named);
        if undecided || self.is_graze(event.elapsed, named.event) {
            return self.open(event, named);
        }
        let window = WINDOW * self.judge.problem.period();
        match next {
            Some(exact)
                if exact.named.event == named.event && exact.elapsed - event.elapsed <= window =>
            {
                self.judge_off_time(event, named, exact)
            }
            next => Said::Wrong(WrongKind::Spurious, next, f64::NAN),
        }
    }

    /// A record of the exact continuation's event, at another time than is allowed.
    fn judge_off_time(&mut self, event: &Event, named: Named, exact: Exact) -> Said {
        let location = self.location(event, named);
        self.found.defects.location.extend(location);
        if let Some(location) = location.filter(|it| exceeds(*it, MAX_LOCATION_ERROR)) {
            return Said::Wrong(WrongKind::Location, Some(exact), location);
        }
        let on_flow = self.off_the_flow(event).is_none_or(|it| it <= self.units.allowance.sample);
        if on_flow && self.is_graze(exact.elapsed, named.event) {
            return self.open(event, named).with_exact_event(exact);
        }
        let stretch = self.place.stretch(exact.elapsed);
        let defect = self.units.of_time(event.elapsed - exact.elapsed, &stretch, named.event);
        self.found.defects.time.push(defect);
        Said::Wrong(WrongKind::Time, Some(exact), defect)
    }
}
