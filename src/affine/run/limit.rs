//! The limit at which impacts accumulate, where the run goes on after it.
//!
//! After an impact let T be the time left, z the state and J v the jump of an impact of the speed
//! v. The limit is z + T M z + J S with the sum S = u/(1 - e) of the speeds of arrival that follow,
//! up to terms of second order: M D T, where D bounds how far the state goes, and the error of S. A
//! tube as wide as D holds the rest of the motion if rates in it and all jumps reach no farther.
//! So a run goes on with impacts, without events, until T is the third root of the arithmetic's
//! unit; the depth of a flight, of the order of T^2, is then still told from rounding.

use super::Run;
use super::accumulation::{Impact, Remaining};
use super::enclosure::{Enclosure, ErrorColumn, rates};
use crate::affine::arithmetic::clock::Time;
use crate::affine::arithmetic::vector::{Vector, add_product, row_size};
use crate::affine::model::system::LARGEST_DIMENSION;
use crate::affine::solver::event::{Ending, What};
use crate::affine::zeros::graph::{Firing, ZeroGuards};
use crate::numeric::number::{Bound, Number};

/// The share of an arithmetic's bits by which the time left to a limit is below the system's unit
/// of time where its first order is taken: the depth of a flight then has a third of them left.
const FIRST_ORDER_SHARE: [u32; 2] = [1, 3];

/// The share of the bits beyond which errors leave open whether there is another impact at all.
const UNDECIDED_SHARE: [u32; 2] = [2, 5];

/// The most bits of which a share is taken.
const MAX_BITS: u32 = 848;

/// The bits by which the time left is below the unit of time in f64, where a horizon before the
/// limit is told no more from one behind it.
const UNDECIDED_F64_BITS: u32 = 44;

/// Errors that may come within this factor of what the first order leaves out are vague.
const VAGUE: f64 = 256.0;
/// The factor by which the error of the time grows from turn to turn where the time left halves.
const LEAST_GROWTH: f64 = 4.0;
/// The roundings of bounds, for their sums of products at a crossing.
const ROUNDING_OF_BOUNDS: f64 = 1e-12;

/// The event just passed: an `until`, the state before its reset, and bounds of the errors of that.
pub(super) struct Jump<'a, T: Number> {
    pub until: usize,
    pub before: &'a Vector<T>,
    pub errors: Vector<T::Bound>,
}

/// A limit that lies ahead of the impact just passed.
#[derive(Clone, Debug)]
pub(super) struct LimitAhead<T: Number> {
    /// The `until` that accumulates, and the node from which the run passes its limit.
    pub until: usize,
    pub node: usize,
    /// The change of the state by the impact just passed, and bounds of its errors.
    pub jump: Vector<T>,
    pub jump_errors: Vector<T::Bound>,
    /// The rest of the motion up to the limit; none where the limit is here.
    pub remaining: Option<Remaining<T>>,
}

/// The time and the state at a limit, with bounds of what they leave out.
struct LimitState<T: Number> {
    time: Time<T>,
    state: Vector<T>,
    /// Half the width of the enclosure of the time left.
    late: T::Bound,
    /// Bounds of the errors of the entries but for those of the last impact.
    errors: Vector<T::Bound>,
    /// The states that do not change with the time of the limit, as bits.
    renewed: u64,
}

impl<T: Number> Run<'_, T> {
    /// Whether impacts go on that are no events of the run, up to a limit or the horizon.
    #[must_use]
    pub fn is_silent(&self) -> bool {
        self.is_silent
    }

    /// Ends the run where impacts accumulate, or remembers that it passes their limit next.
    pub(super) fn accumulate(
        &mut self,
        impact: &Impact<'_, T>,
        jump: &Jump<'_, T>,
        remaining: Option<Remaining<T>>,
    ) {
        match remaining {
            Some(remaining)
                if impact.impacts.has_limit && self.goes_on_after(impact.mode, jump.until) =>
            {
                self.approach(impact.from, jump, Some(remaining));
            }
            Some(Remaining { earliest, latest, .. }) => {
                self.end(Ending::Accumulation(earliest, latest));
            }
            None if self.is_silent => self.end(Ending::Undecided),
            None => {}
        }
    }

    /// Remembers a limit at the instant of the event just passed, which leaves its guard and the
    /// rate of that at zero, if the event would be the next one again.
    pub(super) fn remember_rest(&mut self, mode: usize, jump: &Jump<'_, T>) {
        let is_next = self.at_entry != 0 && self.at_entry.trailing_zeros() as usize == jump.until;
        if is_next && self.goes_on_after(mode, jump.until) {
            self.approach(self.node, jump, None);
        }
    }

    /// Whether the run goes on where this event of a mode accumulates.
    fn goes_on_after(&self, mode: usize, until: usize) -> bool {
        self.solver.system.modes[mode].until[until].accumulates_to.is_some()
    }

    fn approach(&mut self, node: usize, jump: &Jump<'_, T>, remaining: Option<Remaining<T>>) {
        let Jump { until, before, errors } = jump;
        let none = [T::Bound::ZERO; LARGEST_DIMENSION];
        let after = self.enclosure.as_ref().map_or(none, Enclosure::state);
        let limit = LimitAhead {
            until: *until,
            node,
            jump: std::array::from_fn(|n| self.state[n] - before[n]),
            jump_errors: std::array::from_fn(|n| errors[n] + after[n]),
            remaining,
        };
        self.limit_ahead = Some(Box::new(limit));
    }

    /// Passes the limit ahead, if there is one that is known well enough, and says whether it has,
    /// or has ended the run.
    pub(super) fn pass_limit(&mut self) -> bool {
        let Some(limit) = self.limit_ahead.take() else { return false };
        let Some(remaining) = &limit.remaining else {
            self.fire_limit(&limit, self.entered, self.state);
            return true;
        };
        let last = if T::WORDS == 1 { UNDECIDED_F64_BITS } else { share::<T>(UNDECIDED_SHARE) };
        let is_last = self.is_within(remaining, last) || self.is_vague(remaining);
        let there = self.limit_state(&limit, remaining);
        let left = self.time_left().value();
        let doubt = T::of_bound(self.enclosure.as_ref().map_or(T::Bound::ZERO, Enclosure::time));
        let is_before_horizon = remaining.latest + doubt <= left;
        let middle = (remaining.earliest + remaining.latest) * T::exact(0.5);
        let is_taken = is_last && self.enclosure.is_none() && middle <= left;
        if let Some(there) = there.filter(|_| is_before_horizon || is_taken) {
            self.pass_near_limit(&limit, &there);
            return true;
        }
        self.is_silent = true;
        if !is_last || remaining.earliest - doubt > left {
            return false;
        }
        if self.enclosure.is_some() {
            self.end(Ending::Undecided);
        } else {
            let event = self.event(What::End(Ending::Horizon), self.horizon, &self.state);
            self.finish(event);
        }
        true
    }

    /// Whether the time left is so many bits below the system's unit of time.
    fn is_within(&self, remaining: &Remaining<T>, bits: u32) -> bool {
        let scale = T::Bound::from_f64(self.solver.system.time_scale);
        remaining.latest.bound() <= scale.scaled(-i64::from(bits))
    }

    /// Whether the error of the time, which is followed, may by the next turn come near the square
    /// of the time left, in units of time: the first order of the limit leaves out as much.
    ///
    /// After a turn the gap is not zero by the model, and its error moves an impact of the speed u
    /// by as much over u. That error has at least the roundings of bounds beside the error of u.
    fn is_vague(&self, remaining: &Remaining<T>) -> bool {
        let Some(enclosure) = self.enclosure.as_ref().filter(|_| remaining.has_turns()) else {
            return false;
        };
        let scale = self.solver.system.time_scale;
        let left = remaining.latest.bound() / scale;
        let growth =
            T::Bound::from_f64(LEAST_GROWTH) + T::Bound::from_f64(ROUNDING_OF_BOUNDS) / left;
        enclosure.time() / scale * growth * VAGUE >= left * left
    }

    /// Whether the first order of a limit leaves out no more than a rounding of the largest state,
    /// or no flight nearer to it can be told from rounding, in a run that follows no errors.
    fn has_small_second_order(&self, left: &Remaining<T>) -> bool {
        let (system, time) = (&self.solver.system, left.latest.bound());
        let states = self.state.iter().zip(&system.scales);
        let sizes = states.map(|(it, scale)| it.bound().abs() / *scale);
        let largest = sizes.fold(T::Bound::from_f64(1.0), |most, it| most.max(it));
        let is_small = |mode: usize| {
            let rows = self.solver.modes[mode].matrix.iter().zip(&system.scales);
            rows.into_iter().all(|(row, scale)| {
                row_size(row, &left.tube) * time <= largest * *scale * T::unit()
            })
        };
        left.modes.into_iter().all(is_small) || self.is_within(left, UNDECIDED_F64_BITS)
    }

    fn pass_near_limit(&mut self, limit: &LimitAhead<T>, there: &LimitState<T>) {
        let mode = self.graph.node(limit.node).mode;
        let solver = self.solver;
        if let Some(errors) = &mut self.enclosure {
            let own = &solver.modes[mode];
            let mut rates = rates(&own.flow, &own.matrix, &there.state);
            bits(there.renewed).for_each(|n| rates[n] = T::Bound::ZERO);
            let mut late = ErrorColumn::ZERO;
            late.delayed(there.late, &rates);
            errors.columns.push(late);
            errors.anchor(solver.phase(), own.flow.dimension - 1, &rates);
            errors.add_box(&there.errors);
            errors.add_box(&solver.phase_roundings(&there.time));
        }
        self.events_in_instant = 0;
        self.fire_limit(limit, there.time, there.state);
    }

    /// Resets the limit of the state and enters the mode that follows.
    fn fire_limit(&mut self, limit: &LimitAhead<T>, time: Time<T>, mut state: Vector<T>) {
        self.node = limit.node;
        let mode = self.graph.node(self.node).mode;
        let until = self.solver.system.modes[mode].until.len() + limit.until;
        let zero = ZeroGuards { guards: 1 << limit.until, point: None };
        let firing = Firing { until, zero, at_entry: true };
        let zeros = self.graph.arrival(self.node, firing).zero_before;
        for n in bits(zeros) {
            state[n] = T::zero();
            for column in self.enclosure.iter_mut().flat_map(|it| &mut it.columns) {
                column.state[n] = T::Bound::ZERO;
            }
        }
        self.is_silent = false;
        self.fire(firing, time, state);
    }

    /// The state at a limit; none where that is too far for the first order.
    fn limit_state(&self, limit: &LimitAhead<T>, left: &Remaining<T>) -> Option<LimitState<T>> {
        let is_near = match T::WORDS {
            1 => self.has_small_second_order(left),
            _ => self.is_within(left, share::<T>(FIRST_ORDER_SHARE)) || self.is_vague(left),
        };
        if !is_near {
            return None;
        }
        let solver = self.solver;
        let (half, one) = (T::exact(0.5), T::one());
        let elapsed = (left.earliest + left.latest) * half;
        let parts = left.parts(elapsed);
        let jumps = left.quotient / (one - left.quotient);
        let time = self.entered.after(elapsed);
        let mut state = self.state;
        if self.enclosure.is_none() {
            // Without bounds the flow itself serves fast motion of other states.
            for (mode, part) in &parts {
                let flow = &solver.modes[*mode].flow;
                state = flow.state(&flow.at(&flow.modal(&state), *part).y);
            }
        } else {
            for (mode, part) in &parts {
                let rates = solver.rates_of(*mode, &self.state);
                add_product(&mut state, &rates, *part);
            }
        }
        add_product(&mut state, &limit.jump, jumps);
        let (sin, cos) = solver.sin_cos(&time);
        solver.append(&mut state, sin, cos);
        let late = ((left.latest - left.earliest) * half).bound() + left.unknown;
        let mut errors = match &self.enclosure {
            Some(enclosure) => self.limit_errors(limit, left, &enclosure.state()),
            None => [T::Bound::ZERO; LARGEST_DIMENSION],
        };
        for n in bits(left.renewed) {
            (state[n], errors[n]) = (self.state[n], T::Bound::ZERO);
        }
        Some(LimitState { time, state, late, errors, renewed: left.renewed })
    }

    /// Bounds of what the first order leaves out of the limit of the state.
    fn limit_errors(
        &self,
        limit: &LimitAhead<T>,
        left: &Remaining<T>,
        off: &Vector<T::Bound>,
    ) -> Vector<T::Bound> {
        let solver = self.solver;
        let dimension = solver.system.dimension();
        let mut all = [T::Bound::ZERO; LARGEST_DIMENSION];
        let time = left.latest.bound() + left.unknown;
        // The sum of the jumps that follow, in jumps of the impact just passed.
        let sum = |q: T| q / (T::one() - q);
        let [least, largest] = left.quotients;
        let (jumps, most_jumps) = (sum(left.quotient).bound(), sum(largest).bound());
        let unknown = most_jumps * left.quotient_error / (T::one() - largest).bound();
        let apart = (sum(largest) - sum(least)).bound() + unknown;
        let jump = |n: usize| limit.jump[n].bound().abs() + limit.jump_errors[n];
        let matrices = left.modes.map(|mode| &solver.modes[mode].matrix);
        let size = |row: &Vector<T>, of: &dyn Fn(usize) -> T::Bound| -> T::Bound {
            row.iter().enumerate().map(|(k, a)| a.bound().abs() * of(k)).sum()
        };
        // Half of what is not known of the part before turns; the rest of the time has its own.
        let open_part = left.open_part();
        for (n, error) in all.iter_mut().enumerate().take(dimension) {
            let [before, after] = matrices.map(|matrix| &matrix[n]);
            let of_both = |of: &dyn Fn(usize) -> T::Bound| size(before, of).max(size(after, of));
            let rate = of_both(&|k| self.state[k].bound().abs() + off[k]);
            let second = of_both(&|k| left.tube[k]);
            let size = self.state[n].bound().abs() + rate * time + jump(n) * jumps;
            let rounding = T::unit() * 2.0 * (2 * dimension + 4) as f64 * size;
            *error = second * time
                + jump(n) * apart
                + limit.jump_errors[n] * jumps
                + rounding
                + T::Bound::LAST_WORD_UNDERFLOW * f64::from(u8::from(size > 0.0));
            if open_part > 0.0 {
                let apart = |k: usize| (before[k] - after[k]).bound();
                let terms = (0..dimension).map(|k| apart(k) * self.state[k].bound());
                let off = (0..dimension).map(|k| apart(k).abs() * off[k]);
                let apart = terms.sum::<T::Bound>().abs() + off.sum::<T::Bound>();
                *error += (apart + T::unit() * 2.0 * dimension as f64 * rate) * open_part;
            }
        }
        // The forcing's phase is computed from the time, and the entry that is 1 has no error.
        let computed = solver.phase().unwrap_or(dimension - 1)..dimension;
        all[computed].fill(T::Bound::ZERO);
        all
    }
}

impl<T: Number> Remaining<T> {
    /// Whether turns lead from one mode to another on the way.
    fn has_turns(&self) -> bool {
        self.modes[0] != self.modes[1]
    }

    /// The parts of the time left, with their modes, one after the other.
    fn parts(&self, elapsed: T) -> Vec<(usize, T)> {
        let [before, after] = self.modes;
        if !self.has_turns() {
            return vec![(before, elapsed)];
        }
        let [least, most] = self.before_turns;
        let part = (least + most) * T::exact(0.5);
        vec![(before, part), (after, elapsed - part)]
    }

    /// Half the width of the enclosure of the time before turns, where there are any.
    fn open_part(&self) -> T::Bound {
        if !self.has_turns() {
            return T::Bound::ZERO;
        }
        let [least, most] = self.before_turns;
        ((most - least) * T::exact(0.5)).bound() + self.unknown
    }
}

/// The entries of z that are given as bits.
fn bits(mask: u64) -> impl Iterator<Item = usize> {
    (0..LARGEST_DIMENSION).filter(move |n| mask >> n & 1 == 1)
}

/// A share of the arithmetic's bits, as far as times that are so short stay far from underflow in
/// f64.
fn share<T: Number>([part, whole]: [u32; 2]) -> u32 {
    (T::WORDS as u32 * f64::MANTISSA_DIGITS).min(MAX_BITS) * part / whole
}
