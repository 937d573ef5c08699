//! The transition from an `until` to the next segment: the reset, the successor, and the endings of
//! a run there.

use super::Run;
use super::accumulation::Impact;
use super::limit::Jump;
use crate::affine::arithmetic::clock::Time;
use crate::affine::arithmetic::vector::{Vector, twice_summed_rounding};
use crate::affine::model::system::LARGEST_DIMENSION;
use crate::affine::solver::event::{Ending, What};
use crate::affine::zeros::exact::Entries;
use crate::affine::zeros::graph::Firing;
use crate::affine::zeros::impact::Impacts;
use crate::numeric::number::{Bound, Number};

/// The largest number of `until` events in one instant.
const MAX_SIMULTANEOUS_EVENTS: u32 = 64;

impl<T: Number> Run<'_, T> {
    /// Ends the mode by an `until`: resets the state, chooses the successor and enters the next
    /// segment.
    ///
    /// A run that follows its errors stays in its segment where rounding leaves open whether this
    /// event is the next one, or what follows it: it ends there.
    pub(super) fn fire(&mut self, firing: Firing, time: Time<T>, before: Vector<T>) {
        if self.is_open() {
            return;
        }
        let solver = self.solver;
        let mode = self.graph.node(self.node).mode;
        // Without enclosed errors a time below the clock's last digit is none: impacts that
        // accumulate without a proof of it would go on without end.
        let has_not_moved =
            || self.enclosure.is_none() && time.since(&self.entered).value() == T::zero();
        let is_at_once = firing.at_entry || has_not_moved();
        self.events_in_instant = if is_at_once { self.events_in_instant + 1 } else { 1 };
        let mut state = before;
        solver.reset(mode, firing.until, &mut state);
        let limit = firing.until.checked_sub(solver.system.modes[mode].until.len());
        let exact = match limit {
            Some(_) => self.exact_at_limit(),
            None => self.exact_before(mode, firing.zero, firing.at_entry),
        };
        let exact = exact.map(|it| self.exact_after(mode, firing.until, &it));
        let successor = self.successor(mode, firing, &state, exact.as_ref());
        if self.is_open() {
            return;
        }
        let arrival = self.graph.arrival(self.node, firing);
        let (impacts, rests) = (arrival.impacts, arrival.rests);
        let zero_entries = arrival.zero_entries;
        self.returning = 0;
        let from = self.node;
        let discards = self.graph.discards;
        let next = self.graph.enter(from, firing, successor);
        let is_known = self.graph.discards == discards;
        let impacts = impacts.filter(|it| self.graph.are_idle(next, it.idle));
        if !is_known {
            self.restitution = None;
        }
        self.flight = if is_known { self.flight(firing, next, time) } else { None };
        self.node = next;
        (self.entered, self.state) = (time, state);
        let cycle = self.place_in_cycle((from, mode), firing, successor, (impacts, rests));
        self.pass_exactly(mode, firing.until, exact);
        let what = limit.map_or(What::Until(mode, firing.until), |it| What::Limit(mode, it));
        let mut event = self.event(what, time, &self.state);
        let mut errors_before = None;
        if let Some(errors) = self.enclosure.take() {
            errors_before = Some(errors.state());
            let reset = &solver.modes[mode].resets[firing.until];
            let sizes = reset.iter().map(|row| {
                let terms = row.iter().zip(&before).map(|(a, b)| (a.bound() * b.bound()).abs());
                T::unit() * (reset.len() + 2) as f64 * terms.sum::<T::Bound>()
            });
            let mut errors = errors.after_reset(reset, &sizes.collect::<Vec<_>>());
            errors.reduce();
            event.errors = Some(self.errors(&errors));
            event.set_zeros(zero_entries);
            self.enclosure = Some(errors);
        }
        if !self.is_silent {
            self.queue.push_back(event);
        }
        if self.work.undecidable == 0 {
            self.decided = self.queue.len();
        }
        self.enter();
        let errors_before = errors_before.unwrap_or([T::Bound::ZERO; LARGEST_DIMENSION]);
        let jump = Jump { until: firing.until, before: &before, errors: errors_before };
        let turn = cycle.closing;
        let comes_back = |it: &Impacts| is_known && self.graph.are_alike([next, from], it.idle);
        if let Some(impacts) = impacts.filter(|it| turn.is_some() || comes_back(it)) {
            let (before, errors_before) = (&before, &jump.errors);
            let own =
                Impact { mode, firing, successor, from, before, errors_before, turn, impacts };
            let remaining = self.accumulation(&own);
            self.accumulate(&own, &jump, remaining);
        } else if let Some(until) = cycle.rested {
            let mode = self.graph.node(next).mode;
            self.remember_rest(mode, &Jump { until, ..jump });
        } else if self.is_silent && !cycle.is_turn {
            // Up to a limit there is no other event; rounding has made one.
            self.end(Ending::Undecided);
        } else if rests && self.graph.node(next).mode == mode {
            self.remember_rest(mode, &jump);
        }
        if self.events_in_instant >= MAX_SIMULTANEOUS_EVENTS {
            self.end(Ending::NoProgress);
        }
    }

    /// The first successor whose condition holds.
    #[inline]
    fn successor(
        &mut self,
        mode: usize,
        firing: Firing,
        state: &Vector<T>,
        exact: Option<&Entries>,
    ) -> usize {
        let solver = self.solver;
        let orders = &self.graph.arrival(self.node, firing).orders;
        let conditions = &solver.modes[mode].conditions[firing.until];
        let next = solver.system.modes[mode].exits().nth(firing.until).map(|(_, next)| next);
        let next = next.unwrap_or_default();
        for (n, (condition, order)) in conditions.iter().zip(orders.iter()).enumerate() {
            let chain = || solver.exact_mode(mode).conditions[firing.until][n].as_ref();
            if let Some(begin) = exact.and_then(|it| chain()?.begin(it)) {
                if begin.is_some_and(|(_, is_positive)| is_positive) {
                    return n;
                }
                continue;
            }
            let (Some(condition), Some(order)) = (condition, *order) else {
                if condition.is_none() {
                    return n;
                }
                continue;
            };
            let flow = &solver.modes[next[n].mode].flow;
            let (value, size) = condition.order(order, &flow.modal(state));
            let value = value.bound();
            let mut slack = twice_summed_rounding::<T>(flow.dimension) * size;
            if let Some(errors) = &self.enclosure {
                // The errors before the reset bound those after it for all that follows here.
                let reset = &solver.modes[mode].resets[firing.until];
                slack += errors.after_reset(reset, &[]).of_row(flow, condition, order);
            }
            self.work.undecidable += u64::from(value.abs() <= slack);
            if value > 0.0 {
                return n;
            }
        }
        conditions.len() - 1
    }
}
