//! The guards that a search has found crossed: watched events, and the errors at the crossing.

use super::Run;
use super::enclosure::{EnclosedCrossing, Enclosure, roundings};
use crate::affine::arithmetic::clock::Time;
use crate::affine::arithmetic::vector::Vector;
use crate::affine::model::system::Direction;
use crate::affine::solver::event::{Ending, What};
use crate::affine::zeros::graph::{Firing, ZeroGuards};
use crate::numeric::number::{Bound, Number};

impl<T: Number> Run<'_, T> {
    /// The events whose guards cross within what rounding may do, so that it is open which is the
    /// first, in a run that ended so; none in a run that ended otherwise.
    #[must_use]
    pub fn tie(&self) -> Vec<What<T>> {
        let ended_so = self.ending() == Some(&Ending::Undecided) && self.enclosure.is_some();
        let tie = self.tie.filter(|_| ended_so);
        let events = tie.map(|(mode, guards)| bits(guards).map(move |n| self.event_of(mode, n)));
        events.into_iter().flatten().collect()
    }

    /// Passes the crossing of the guards with these bits: watched ones become events, and an
    /// `until` ends the mode.
    pub(super) fn pass_crossing(&mut self, guards: u64) {
        let mode = self.graph.node(self.node).mode;
        let until = self.solver.system.modes[mode].until.len();
        let Some((time, state)) = self.present_state() else { return self.end(Ending::Undecided) };
        let zero = self.zero_guards(guards, &state);
        let point = zero.point;
        // A guard with a rational point tells more about the others than the first of them does.
        let first = point.map_or(guards & guards.wrapping_neg(), |(guard, _)| 1 << guard);
        let first = ZeroGuards { guards: first, point };
        let errors = self.errors_at(mode, guards, &time, &state);
        let error = errors.as_ref().map_or(T::Bound::ZERO, Enclosure::time);
        let exactly_tied = self.exactly_tied(mode, first, error);
        let tied = self.graph.tied_guards(self.node, first, false) | exactly_tied;
        if guards & !tied != 0 {
            self.work.undecidable += 1;
            self.tie = Some((mode, guards));
        }
        for n in bits(guards & !low_bits(until)) {
            self.watched_event(mode, n, zero, time, &state, errors.as_ref());
            self.tracks[n].outward = -self.tracks[n].outward;
        }
        let back_inside = guards & self.returning;
        if back_inside != 0 {
            self.returning &= !back_inside;
            bits(back_inside).for_each(|n| self.tracks[n].outward = 1.0);
        }
        let ending = guards & low_bits(until) & !back_inside;
        if ending == 0 {
            self.segment.at_crossing(&mut self.ends.left, &mut self.work);
            self.ends.passed.guards &= !guards;
            self.tracks.iter_mut().for_each(|track| track.zeros = 0);
            for n in bits(guards) {
                self.tracks[n].zeros = 1;
                self.ends.left.orders[n][0] = T::zero();
            }
            return;
        }
        let guards = self.graph.tied_guards(self.node, zero, false) | exactly_tied;
        let zero = self.zero_guards(guards, &state);
        if self.solver.backward {
            (self.entered, self.state, self.enclosure) = (time, state, errors);
            return self.leave(zero, false);
        }
        let until = ending.trailing_zeros() as usize;
        self.enclosure = errors;
        self.fire(Firing { until, zero, at_entry: false }, time, state);
    }

    /// The errors at a crossing, where they are followed.
    fn errors_at(
        &self,
        mode: usize,
        guards: u64,
        time: &Time<T>,
        state: &Vector<T>,
    ) -> Option<Enclosure<T::Bound>> {
        let (enclosure, segment) = (self.enclosure.as_ref()?, &self.segment);
        let point = &self.ends.left;
        let solver_mode = &self.solver.modes[mode];
        let first = guards.trailing_zeros() as usize;
        let inherited = segment.inherited_by(first, point.time);
        let mut roundings = roundings(&solver_mode.flow, &segment.entry, point.time);
        let phase = self.solver.phase();
        if let Some(at) = phase {
            let own = self.solver.phase_roundings(time);
            roundings[at..at + 2].copy_from_slice(&own[at..at + 2]);
        }
        roundings[solver_mode.flow.dimension - 1] = T::Bound::ZERO;
        Some(enclosure.at_crossing(&EnclosedCrossing {
            flow: &solver_mode.flow,
            matrix: &solver_mode.matrix,
            guard: &solver_mode.guards[first],
            y: point.modal.y,
            elapsed: point.time,
            state: *state,
            // The guard differs from zero by its computed value and by the rounding error of that.
            slack: (point.slack[first] - inherited).max(T::Bound::ZERO)
                + point.orders[first][0].bound().abs()
                + T::Bound::LAST_WORD_UNDERFLOW,
            roundings,
            phase,
            zeros: segment.zeros_by_series(first, point.time.to_f64()),
        }))
    }

    #[inline]
    fn watched_event(
        &mut self,
        mode: usize,
        n: usize,
        zero: ZeroGuards,
        time: Time<T>,
        state: &Vector<T>,
        errors: Option<&Enclosure<T::Bound>>,
    ) {
        let rising = self.tracks[n].outward > 0.0;
        let own = &self.solver.system.modes[mode];
        let watch = n - own.until.len();
        let counted = match own.watch[watch].direction {
            Direction::Rising => rising,
            Direction::Falling => !rising,
            Direction::Both => true,
        };
        if counted && !self.is_silent {
            let mut event = self.event(What::Watch(mode, watch), time, state);
            event.errors = errors.map(|it| self.errors(it));
            if errors.is_some() {
                event.set_zeros(self.graph.zero_entries(self.node, zero, false));
            }
            self.queue.push_back(event);
        }
    }
}

#[inline]
fn bits(mask: u64) -> impl Iterator<Item = usize> {
    let without_lowest = |mask: &u64| Some(mask & mask.wrapping_sub(1));
    let masks = std::iter::successors(Some(mask), without_lowest).take_while(|it| *it != 0);
    masks.map(|it| it.trailing_zeros() as usize)
}

#[inline]
pub(super) fn low_bits(count: usize) -> u64 {
    if count >= 64 { u64::MAX } else { (1 << count) - 1 }
}
