//! A run: segments joined at their events, by the rules of docs/SYSTEM_FORMAT.md.
//!
//! [`begin`] makes a run of a start. This file enters each segment and asks for its first crossing;
//! [`crossed`] says which events the crossed guards are, and [`transition`] resets the state and
//! picks the successor. [`accumulation`] encloses where impacts accumulate, with [`turn`]s or not,
//! [`limit`] goes on from there, [`flight`] finds the impacts on the way in f64, and [`enclosure`]
//! carries the errors along in a run that follows them. [`horizon`] has the errors at a time that
//! is given, and [`given_up`] the motion that is known where such a run is not decided. [`follow`]
//! continues the records of a run that someone else has made, [`place`] is where a run may be cut
//! and go on with another state, [`variation`] carries small changes of the state along,
//! [`variation_at_limit`] does so across limits, and [`parameter`] has what a parameter adds. Read
//! this file first, then `crossed` and `transition`.

mod accumulation;
mod ahead;
mod begin;
mod crossed;
mod enclosure;
mod exact;
mod flight;
pub mod follow;
mod given_up;
mod horizon;
mod limit;
mod origins;
pub mod parameter;
pub mod place;
mod reduction;
mod repeated;
mod series;
mod transition;
mod turn;
mod undecided;
pub mod variation;
mod variation_at_limit;

use crate::affine::arithmetic::clock::Time;
use crate::affine::arithmetic::vector::{Vector, all_finite, twice_summed_rounding};
use crate::affine::first_crossing::search::SearchOutcome;
use crate::affine::first_crossing::taylor::FailedAttempts;
use crate::affine::guards::point::{Ends, GuardedPoint, GuardedSegment, Passed};
use crate::affine::guards::track::{SearchWork, Track};
use crate::affine::solver::event::{Ending, Errors, Event, What};
use crate::affine::solver::pool::Loan;
use crate::affine::solver::{Solver, SolverMode};
use crate::affine::zeros::graph::{Firing, ZeroGuards};
use crate::numeric::number::{Bound, Number};
use ahead::SearchAhead;
use enclosure::Enclosure;
use flight::Flight;
use limit::LimitAhead;
use origins::ExactRun;
use std::collections::VecDeque;
use turn::LastOfCycle;

/// A run of a solver, as an iterator over its events; the last one is an [`Ending`].
pub struct Run<'a, T: Number> {
    solver: &'a Solver<T>,
    graph: Loan<'a, T>,
    work: SearchWork,
    horizon: Time<T>,
    /// The search beyond the horizon, where the run has one.
    ahead: Option<SearchAhead<T>>,
    node: usize,
    /// The time at which the segment was entered, and the state there.
    entered: Time<T>,
    state: Vector<T>,
    /// The state of each guard in the search.
    tracks: Vec<Track>,
    ends: Ends<T>,
    segment: GuardedSegment<'a, T>,
    /// For each mode, the failed attempts to prove a crossing by Taylor polynomials.
    failed_attempts: Vec<FailedAttempts>,
    /// The coefficient of restitution of an impact, from its fastest occurrence.
    restitution: Option<Restitution<T>>,
    /// The limit of the impact just passed, where it accumulates and the run goes on after it.
    limit_ahead: Option<Box<LimitAhead<T>>>,
    /// The last `until`, where a cycle of impacts and turns may go on from it.
    last_of_cycle: LastOfCycle,
    /// The flight to the next impact, where the gap is too small for the state's digits.
    flight: Option<Flight<T>>,
    /// Whether impacts go on without events up to a limit.
    is_silent: bool,
    /// The guards that fire at the instant of entry, as bits.
    at_entry: u64,
    /// The guards of `until` that are positive since the segment was entered and do not fire until
    /// they have been inside, as bits.
    returning: u64,
    /// Whether a guard that is positive at entry fires there instead of ending the run: the states
    /// of a run that someone else has made are not exact.
    is_lenient: bool,
    /// The mode and the guards of the last crossing whose order rounding left open.
    tie: Option<(usize, u64)>,
    /// The mode and the guard that rounding left open by itself, first of all.
    doubt: Option<(usize, usize)>,
    /// The modes and guards that touched zero and did not cross, each once, in order.
    touches: Vec<(usize, usize)>,
    events_in_instant: u32,
    queue: VecDeque<Event<T>>,
    /// The number of queued events that came before anything that rounding left open.
    decided: usize,
    ended: bool,
    /// The errors at the entry of the segment, where they are followed.
    enclosure: Option<Enclosure<T::Bound>>,
    /// The entries of z that are known exactly, in a run that follows its errors.
    exact: Option<ExactRun<T>>,
    /// The start, with the errors that it has before the rounding of its modal co-ordinates.
    start: Event<T>,
    /// The last event that the iterator returned, or the start.
    last: Event<T>,
}

/// The quotient of the rates after and before an impact, from its fastest occurrence.
#[derive(Clone, Copy, Debug)]
struct Restitution<T> {
    pub node: usize,
    pub until: usize,
    pub rate: f64,
    pub quotient: T,
}

impl<'a, T: Number> Run<'a, T> {
    /// The start, as an event of the kind [`What::Start`].
    #[must_use]
    pub fn start(&self) -> Event<T> {
        self.start.clone()
    }

    /// The cost of the run's searches so far.
    #[must_use]
    pub fn work(&self) -> SearchWork {
        self.work
    }

    /// The time up to which the run has searched: all events before it have been returned.
    #[must_use]
    #[inline]
    pub fn searched(&self) -> Time<T> {
        self.entered.after(self.solver.directed(self.ends.left.time))
    }

    /// The ending of a run that has ended.
    #[must_use]
    pub fn ending(&self) -> Option<&Ending<T>> {
        match &self.queue.back().unwrap_or(&self.last).what {
            What::End(ending) if self.ended => Some(ending),
            _ => None,
        }
    }

    /// The event that a guard of a mode makes.
    fn event_of(&self, mode: usize, guard: usize) -> What<T> {
        match guard.checked_sub(self.solver.system.modes[mode].until.len()) {
            Some(watch) => What::Watch(mode, watch),
            None => What::Until(mode, guard),
        }
    }

    /// Enters the mode of the present node with the present state.
    fn enter(&mut self) {
        let solver = self.solver;
        let mode = self.graph.node(self.node).mode;
        let solver_mode = &solver.modes[mode];
        let flow = &solver_mode.flow;
        flow.set_modal(&mut self.segment.entry, &self.state);
        // One entry of the state that is not finite makes all co-ordinates meaningless.
        if !all_finite(&self.segment.entry.y[..flow.dimension]) {
            return self.end(Ending::Undecided);
        }
        let ending = self.track_guards(mode, solver_mode);
        self.remember_doubt(mode);
        if let Some(ending) = ending {
            self.end(ending);
        }
        self.begin_segment(solver_mode);
    }

    /// Tracks each guard of a mode, by its first derivative at entry that is not a structural zero,
    /// and finds the guards that fire at once. A guard that is positive at entry may end the run.
    #[inline]
    fn track_guards(&mut self, mode: usize, solver_mode: &SolverMode<T>) -> Option<Ending<T>> {
        let SolverMode { flow, guards, .. } = solver_mode;
        if let Some(exact) = &mut self.exact {
            exact.enter(self.solver.exact_mode(mode));
        }
        let node = self.graph.node(self.node);
        let until = self.solver.system.modes[mode].until.len();
        let margin = twice_summed_rounding::<T>(flow.dimension);
        self.tracks.clear();
        self.at_entry = 0;
        let mut ending = None;
        for (n, (row, order)) in guards.iter().zip(node.multiplicities.iter()).enumerate() {
            let fate = self.exact.as_ref().and_then(|it| it.fate(n));
            let order = fate.map_or(*order, |it| it.begin.map(|(order, _)| order));
            let is_flying = self.flight.is_some_and(|it| it.guards >> n & 1 == 1);
            let order = order.filter(|_| !is_flying && !self.never_crosses(mode, n));
            let Some(order) = order else {
                let falls = self.flight.is_some_and(|it| it.falling >> n & 1 == 1);
                let outward = if falls { -1.0 } else { 1.0 };
                self.tracks.push(Track { outward, zeros: 0, live: false });
                continue;
            };
            let (value, size) = row.order(order, &self.segment.entry);
            let value = value.bound();
            let mut slack = margin * size;
            if let Some(errors) = &self.enclosure {
                slack += errors.of_row(flow, row, order);
            }
            let begin = fate.and_then(|it| it.begin);
            let doubtful = begin.is_none() && value.abs() <= slack;
            let is_positive = begin.map_or(value > 0.0, |(_, is_positive)| is_positive);
            let live = !self.exact.as_ref().is_some_and(|it| it.keeps_sign(n));
            if doubtful {
                self.work.doubt(n);
            }
            let returns = n >= until || self.returning >> n & 1 == 1;
            let outward = if returns && is_positive { -1.0 } else { 1.0 };
            self.tracks.push(Track { outward, zeros: order, live });
            if !returns && is_positive {
                if order == 0 && !doubtful && !self.is_lenient {
                    ending = ending.or(Some(Ending::BeyondGuard));
                } else if self.solver.backward {
                    ending = ending.or(Some(Ending::LeavesDomain));
                }
                self.at_entry |= 1 << n;
            }
        }
        ending
    }

    /// Begins a segment of a mode with the tracked guards, and with the errors that are followed.
    #[inline]
    fn begin_segment(&mut self, solver_mode: &'a SolverMode<T>) {
        let SolverMode { flow, guards, .. } = solver_mode;
        if let Some(errors) = &mut self.enclosure {
            // From here on the rounding of the entry is among the errors that are followed.
            errors.add_entry(flow, &self.state);
            self.segment.entry = flow.exact(&self.segment.entry.y);
        }
        let inherited = self
            .enclosure
            .as_ref()
            .map(|errors| guards.iter().map(|row| errors.error_along(flow, row)).collect());
        self.segment.enter(flow, guards, &self.tracks, inherited);
        self.segment.begin(&mut self.ends.left);
        self.ends.passed = Passed::none();
    }

    /// Ends the run before its horizon, at the entry or at the last event.
    fn end(&mut self, ending: Ending<T>) {
        if ending == Ending::LeavesDomain {
            return self.leave(ZeroGuards { guards: 0, point: None }, true);
        }
        let what = What::End(ending);
        let event = Event { what, ..self.queue.back().unwrap_or(&self.last).clone() };
        self.finish(event);
    }

    /// Ends a run that leaves its mode back in time, at the entry or where these guards are zero.
    fn leave(&mut self, zero: ZeroGuards, at_entry: bool) {
        let mut event = self.event(What::End(Ending::LeavesDomain), self.entered, &self.state);
        if let Some(errors) = &self.enclosure {
            event.errors = Some(self.errors(errors));
            event.set_zeros(self.graph.zero_entries(self.node, zero, at_entry));
        }
        self.finish(event);
    }

    /// Ends the run with an event, unless it has ended.
    fn finish(&mut self, ending: Event<T>) {
        if !self.ended {
            self.ended = true;
            self.queue.push_back(ending);
        }
    }

    #[inline]
    fn event(&self, what: What<T>, time: Time<T>, state: &Vector<T>) -> Event<T> {
        let states = self.solver.system.states.len();
        let mode = self.graph.node(self.node).mode;
        Event { what, time, state: state[..states].to_vec(), mode, errors: None }
    }

    fn errors(&self, enclosure: &Enclosure<T::Bound>) -> Errors<T::Bound> {
        self.errors_near(enclosure, &self.entered)
    }

    /// Searches for the next event, and queues the events of its instant.
    fn advance(&mut self) {
        if self.limit_ahead.is_some() && self.pass_limit() {
            return;
        }
        if self.at_entry != 0 {
            let zero = ZeroGuards { guards: self.at_entry, point: None };
            let guards = self.graph.tied_guards(self.node, zero, true);
            let until = self.at_entry.trailing_zeros() as usize;
            let zero = ZeroGuards { guards, point: None };
            self.fire(Firing { until, zero, at_entry: true }, self.entered, self.state);
            return;
        }
        let mode = self.graph.node(self.node).mode;
        let left = self.time_left();
        let flight = self.flight.filter(|it| it.elapsed <= left.high);
        let outcome = match self.flight {
            // Beyond the impact the segment means nothing.
            Some(_) => self.search_to(mode, flight.map_or(left.high, |it| it.elapsed)),
            None => self.search(mode, left.high),
        };
        if self.is_open() {
            return;
        }
        if let Some(flight) = flight.filter(|_| outcome == SearchOutcome::NoCrossing) {
            self.segment.complete(&mut self.ends.left);
            return self.pass_crossing(flight.guards);
        }
        match outcome {
            SearchOutcome::GivenUp => self.end(Ending::Undecided),
            SearchOutcome::NoCrossing => self.at_horizon(mode, left),
            SearchOutcome::Crossing(guards) => {
                self.segment.complete(&mut self.ends.left);
                let elapsed = self.ends.left.time + self.ends.left.to_crossing;
                self.remember_touch(mode, elapsed);
                let before = self.errors_before(mode, guards);
                self.pass_crossing(guards);
                if before.is_some() && self.is_open() {
                    self.enclosure = before;
                }
            }
        }
    }

    /// Ends the run at its horizon, a time after the entry.
    fn at_horizon(&mut self, mode: usize, left: Time<T>) {
        let is_ahead = left.high > T::zero();
        let limit = if is_ahead { left.high } else { T::zero() };
        // The time since an entry long before is rounded; the horizon is not. Modal co-ordinates
        // round the entry's state.
        let time = if is_ahead { self.horizon } else { self.entered };
        let state = if is_ahead { self.state_after(mode, &left) } else { self.state };
        if !all_finite(&state[..self.solver.system.states.len()]) {
            self.segment.complete(&mut self.ends.left);
            return self.end(Ending::Undecided);
        }
        self.remember_touch(mode, limit);
        let enclosure = self.errors_at_given_time(mode, limit, &time, &state);
        let errors = enclosure.map(|it| self.errors_near(&it, &time));
        let what = What::End(Ending::Horizon);
        self.finish(Event { errors, ..self.event(what, time, &state) });
    }

    /// The state z at a time after the entry of the present mode.
    #[inline]
    fn state_after(&self, mode: usize, elapsed: &Time<T>) -> Vector<T> {
        let flow = &self.solver.modes[mode].flow;
        let modal = flow.at(&self.segment.entry, elapsed.high);
        let mut state = flow.state_shortly_after(modal, elapsed.low);
        if self.enclosure.is_some() {
            let time = self.entered.after(self.solver.directed(elapsed.high));
            let (sin, cos) = self.solver.sin_cos(&time.after(self.solver.directed(elapsed.low)));
            self.solver.append(&mut state, sin, cos);
        }
        state
    }

    /// The time until the horizon, in two words.
    #[inline]
    fn time_left(&self) -> Time<T> {
        let Time { high, low } = self.horizon.since(&self.entered);
        Time { high: self.solver.directed(high), low: self.solver.directed(low) }
    }

    /// Time and state at which the search has arrived; none where the state has overflowed.
    #[inline]
    fn present_state(&self) -> Option<(Time<T>, Vector<T>)> {
        self.time_and_state_at(&self.ends.left)
    }

    /// Time and state at a point of the segment; none where the state has overflowed.
    #[inline]
    fn time_and_state_at(&self, point: &GuardedPoint<T>) -> Option<(Time<T>, Vector<T>)> {
        let mut time = self.entered.after(self.solver.directed(point.time));
        let mode = self.graph.node(self.node).mode;
        let flow = &self.solver.modes[mode].flow;
        let mut state = if point.to_crossing == T::zero() {
            flow.state(&point.modal.y)
        } else {
            time = time.after(self.solver.directed(point.to_crossing));
            flow.state_shortly_after(point.modal, point.to_crossing)
        };
        let (sin, cos) = self.solver.sin_cos(&time);
        self.solver.append(&mut state, sin, cos);
        all_finite(&state[..self.solver.system.states.len()]).then_some((time, state))
    }
}

impl<T: Number> Iterator for Run<'_, T> {
    type Item = Event<T>;

    fn next(&mut self) -> Option<Event<T>> {
        loop {
            if let Some(event) = self.queue.pop_front() {
                self.last.clone_from(&event);
                return Some(event);
            }
            if self.ended {
                return None;
            }
            self.decided = 0;
            let from = self.search_start();
            self.advance();
            // An enclosed run has no event that errors may have decided, and none without bounds of
            // its errors.
            let is_bounded = |it: &Event<T>| it.errors.as_ref().is_none_or(Errors::are_finite);
            let unbounded = self.queue.iter().position(|it| !is_bounded(it));
            let is_open = self.work.undecidable > 0 || unbounded.is_some();
            if self.enclosure.is_some() && is_open {
                self.queue.truncate(unbounded.map_or(self.decided, |it| it.min(self.decided)));
                self.ended = false;
                self.end(Ending::Undecided);
            }
            if unbounded.is_none()
                && let Some(from) = from
            {
                self.show_known_motion(*from);
            }
        }
    }
}

impl<T: Number> std::iter::FusedIterator for Run<'_, T> {}
