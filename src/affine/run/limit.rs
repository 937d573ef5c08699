//! The limit at which impacts accumulate, where the run goes on after it.
//!
//! After an impact let T be the time left, z the state and J v the jump of an impact of the speed
//! v. The limit is z + T M z + J S with the sum S = u/(1 - e) of the speeds of arrival that follow,
//! up to terms of second order: M D T, where D bounds how far the state goes, and the error of S. A
//! tube as wide as D holds the rest of the motion if the rates in it and all jumps reach no farther.
//! So a run goes on with impacts, without events, until T is the root of the arithmetic's unit.

use super::Run;
use super::accumulation::Remaining;
use super::enclosure::{Enclosure, ErrorColumn, rates};
use crate::affine::arithmetic::clock::Time;
use crate::affine::arithmetic::vector::Vector;
use crate::affine::model::system::LARGEST_DIMENSION;
use crate::affine::solver::event::{Ending, What};
use crate::affine::zeros::graph::{Firing, ZeroGuards};
use crate::numeric::number::{Bound, Number};

/// The bits by which the time left to a limit may exceed the root of the arithmetic's unit.
const SPARE_BITS: u32 = 3;

/// The bits of the time left, in units of the system's, below which a horizon before the limit is
/// told from one behind it no more: so many fewer than those of the arithmetic.
const LOST_BITS: u32 = 9;

/// The largest number of times that a tube is widened until it holds the motion.
const MOST_WIDENINGS: u32 = 8;

/// The event just passed: an `until`, the state before its reset, and bounds of the errors of that.
pub(super) struct Jump<T: Number> {
    pub until: usize,
    pub before: Vector<T>,
    pub errors: Vector<T::Bound>,
}

/// A limit that lies ahead of the impact just passed.
#[derive(Clone, Debug)]
pub(super) struct LimitAhead<T: Number> {
    /// The `until` that accumulates.
    pub until: usize,
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
}

impl<T: Number> Run<'_, T> {
    /// Ends the run where impacts accumulate, or remembers that it passes their limit next.
    pub(super) fn accumulate(
        &mut self,
        mode: usize,
        jump: &Jump<T>,
        remaining: Option<Remaining<T>>,
    ) {
        match remaining {
            Some(remaining) if self.goes_on_after(mode, jump.until) => {
                self.approach(jump, Some(remaining));
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
    pub(super) fn rest(&mut self, mode: usize, jump: &Jump<T>) {
        let is_next = self.at_entry != 0 && self.at_entry.trailing_zeros() as usize == jump.until;
        if is_next && self.goes_on_after(mode, jump.until) {
            self.approach(jump, None);
        }
    }

    /// Whether the run goes on where this event of a mode accumulates.
    fn goes_on_after(&self, mode: usize, until: usize) -> bool {
        self.solver.system.modes[mode].until[until].accumulates_to.is_some()
    }

    fn approach(&mut self, jump: &Jump<T>, remaining: Option<Remaining<T>>) {
        let Jump { until, before, errors } = jump;
        let after = self.enclosure.as_ref().map(Enclosure::state);
        let after = after.unwrap_or([T::Bound::ZERO; LARGEST_DIMENSION]);
        let limit = LimitAhead {
            until: *until,
            jump: std::array::from_fn(|n| self.state[n] - before[n]),
            jump_errors: std::array::from_fn(|n| errors[n] + after[n]),
            remaining,
        };
        self.limit_ahead = Some(Box::new(limit));
    }

    /// Passes the limit ahead, if there is one that is known well enough, and says whether it does.
    pub(super) fn pass_limit(&mut self) -> bool {
        let Some(limit) = self.limit_ahead.take() else { return false };
        let Some(remaining) = &limit.remaining else {
            self.events_in_instant += 1;
            self.fire_limit(&limit, self.entered, self.state);
            return true;
        };
        let scale = self.solver.system.time_scale;
        let bits = T::WORDS as u32 * f64::MANTISSA_DIGITS;
        let is_within =
            |bits: u32| remaining.latest.bound() <= T::Bound::of(scale).scaled(-i64::from(bits));
        // In f64 the second order is lost in rounding wherever an accumulation is proved.
        let is_near = T::WORDS == 1 || is_within(bits / 2 - SPARE_BITS);
        let left = self.time_left().value();
        let doubt = T::of_bound(self.enclosure.as_ref().map_or(T::Bound::ZERO, Enclosure::time));
        if is_near && remaining.latest + doubt <= left {
            return self.pass_near_limit(&limit, remaining);
        }
        self.is_silent = true;
        if remaining.earliest - doubt > left || !is_within(bits - LOST_BITS) {
            return false;
        }
        if self.enclosure.is_some() {
            self.work.undecidable += 1;
            self.end(Ending::Undecided);
        } else if (remaining.earliest + remaining.latest) * T::exact(0.5) <= left {
            return self.pass_near_limit(&limit, remaining);
        } else {
            let what = What::End(Ending::Horizon);
            let event = self.event(what, self.horizon, &self.state);
            self.finish(event);
        }
        true
    }

    fn pass_near_limit(&mut self, limit: &LimitAhead<T>, remaining: &Remaining<T>) -> bool {
        let Some(there) = self.limit_state(limit, remaining) else {
            self.end(Ending::Undecided);
            return true;
        };
        let mode = self.graph.node(self.node).mode;
        let solver = self.solver;
        let phase = solver.phase();
        if let Some(errors) = &mut self.enclosure {
            let own = &solver.modes[mode];
            let rates = rates(&own.flow, &own.matrix, &there.state);
            let mut late = ErrorColumn::ZERO;
            late.delayed(there.late, &rates);
            errors.columns.push(late);
            errors.anchor(phase, own.flow.dimension - 1, &rates);
            errors.add_box(&there.errors);
            errors.add_box(&solver.phase_roundings(&there.time));
        }
        self.events_in_instant = 0;
        self.fire_limit(limit, there.time, there.state);
        true
    }

    /// Resets the limit of the state and enters the mode that follows.
    fn fire_limit(&mut self, limit: &LimitAhead<T>, time: Time<T>, mut state: Vector<T>) {
        let mode = self.graph.node(self.node).mode;
        let until = self.solver.system.modes[mode].until.len() + limit.until;
        let zero = ZeroGuards { guards: 1 << limit.until, point: None };
        let firing = Firing { until, zero, at_entry: true };
        let zeros = self.graph.arrival(self.node, firing).zero_before;
        for n in (0..LARGEST_DIMENSION).filter(|n| zeros >> n & 1 == 1) {
            state[n] = T::zero();
            for column in self.enclosure.iter_mut().flat_map(|it| &mut it.columns) {
                column.state[n] = T::Bound::ZERO;
            }
        }
        self.is_silent = false;
        self.fire(firing, time, state);
    }

    /// The state at a limit that is near; none where no tube is found that holds the motion.
    fn limit_state(&self, limit: &LimitAhead<T>, left: &Remaining<T>) -> Option<LimitState<T>> {
        let mode = self.graph.node(self.node).mode;
        let own = &self.solver.modes[mode];
        let dimension = own.flow.dimension;
        let (half, one) = (T::exact(0.5), T::one());
        let elapsed = (left.earliest + left.latest) * half;
        let jumps = left.restitution / (one - left.restitution);
        let time = self.entered.after(elapsed);
        let mut state = self.state;
        for (n, row) in own.matrix.iter().enumerate() {
            let rate = row.iter().zip(&self.state).fold(T::zero(), |sum, (a, b)| sum + *a * *b);
            state[n] = self.state[n] + rate * elapsed + limit.jump[n] * jumps;
        }
        let (sin, cos) = self.solver.sin_cos(&time);
        self.solver.append(&mut state, sin, cos);
        let late = ((left.latest - left.earliest) * half).bound() + left.unknown;
        let errors = self.limit_errors(limit, left, dimension)?;
        Some(LimitState { time, state, late, errors })
    }

    /// Bounds of what the first order leaves out of the limit of the state.
    fn limit_errors(
        &self,
        limit: &LimitAhead<T>,
        left: &Remaining<T>,
        dimension: usize,
    ) -> Option<Vector<T::Bound>> {
        let mode = self.graph.node(self.node).mode;
        let matrix = &self.solver.modes[mode].matrix;
        let mut all = [T::Bound::ZERO; LARGEST_DIMENSION];
        let Some(enclosure) = &self.enclosure else { return Some(all) };
        let off = enclosure.state();
        let time = left.latest.bound() + left.unknown;
        // The sum of the jumps that follow, in jumps of the impact just passed.
        let sum = |e: T| e / (T::one() - e);
        let (e, s) = (left.restitution, left.spread);
        let (jumps, most_jumps) = (sum(e).bound(), sum(e * s).bound());
        let unknown = most_jumps * left.restitution_error / (T::one() - e * s).bound();
        let apart = (sum(e * s) - sum(e / s)).bound() + unknown;
        let jump = |n: usize| limit.jump[n].bound().abs() + limit.jump_errors[n];
        let rate = |n: usize, wide: &Vector<T::Bound>| {
            let terms = matrix[n].iter().zip(self.state.iter().zip(wide));
            terms.map(|(a, (z, it))| a.bound().abs() * (z.bound().abs() + *it)).sum::<T::Bound>()
        };
        let reach = |wide: &Vector<T::Bound>| -> Vector<T::Bound> {
            std::array::from_fn(|n| {
                if n >= dimension {
                    return T::Bound::ZERO;
                }
                rate(n, wide) * time + jump(n) * most_jumps + off[n]
            })
        };
        let mut tube = reach(&off);
        let mut is_held = false;
        for _ in 0..MOST_WIDENINGS {
            let wider = tube.map(|it| it * 2.0);
            tube = reach(&wider);
            is_held = tube.iter().zip(&wider).all(|(it, wider)| *it <= *wider);
            if is_held {
                tube = wider;
                break;
            }
        }
        for (n, error) in all.iter_mut().enumerate().take(dimension) {
            let second: T::Bound =
                matrix[n].iter().zip(&tube).map(|(a, it)| a.bound().abs() * *it).sum();
            let size = self.state[n].bound().abs() + rate(n, &off) * time + jump(n) * jumps;
            let rounding = T::unit() * 2.0 * (dimension + 4) as f64 * size;
            *error = second * time
                + jump(n) * apart
                + limit.jump_errors[n] * jumps
                + rounding
                + T::Bound::LAST_WORD * f64::from(u8::from(size > 0.0));
        }
        is_held.then_some(all)
    }
}
