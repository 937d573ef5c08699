//! Short flights back to an impact, in f64.
//!
//! Between a turn and the next impact the gap is as small as the square of the flight's time. Where
//! it is small beside the entries that it is summed from, a state in f64 has lost its digits. It
//! follows from the last impact, where the gap is zero by the model: it is what the motion since
//! then has added.

use super::Run;
use super::series::{MAX_SERIES_ARGUMENT, gain, landing, sum};
use crate::affine::arithmetic::clock::Time;
use crate::affine::arithmetic::vector::{dot, is_f64};
use crate::affine::zeros::graph::{Firing, ZeroGuards};
use crate::numeric::number::Number;

/// The share of the sizes of its terms below which a gap is followed from the last impact: the
/// state has all but four bits of a larger one.
const SMALL_GAP: f64 = 1.0 / 16.0;

/// The rest of a flight.
#[derive(Clone, Copy, Debug)]
pub(super) struct Flight<T> {
    /// The guards that cross zero at its end, as bits, and those of them that fall.
    pub guards: u64,
    pub falling: u64,
    /// The time from the entry of the segment to the impact.
    pub elapsed: T,
}

impl<T: Number> Run<'_, T> {
    /// The flight from an `until` that is passed at this time into another node, if a guard was
    /// zero by the model where the present segment was entered, and has turned back near it.
    pub(super) fn flight(&mut self, firing: Firing, next: usize, at: Time<T>) -> Option<Flight<T>> {
        let is_plain = is_f64::<T>() && self.enclosure.is_none() && !self.solver.backward;
        // States that someone else has computed are not where the model has them.
        if !is_plain || firing.at_entry || self.is_lenient {
            return None;
        }
        let until = self.graph.returning_guard(self.node, firing.until, next)?;
        let (solver, start) = (self.solver, self.state);
        let [before, after] = [self.node, next].map(|node| self.graph.node(node).mode);
        let row = &solver.modes[after].rows[until];
        let elapsed = at.since(&self.entered).value();
        if solver.modes[before].flow.speed * elapsed.to_f64() > MAX_SERIES_ARGUMENT {
            return None;
        }
        let gained = gain(solver, before, &start, elapsed);
        let gap = dot(row, &gained, solver.system.dimension());
        let here = sum(&start, &gained, T::one());
        // The state has come from modal co-ordinates, and has their roundings.
        let own = &solver.modes[after];
        let (_, size) = own.guards[until].order(0, &own.flow.modal(&here));
        let is_small = gap < T::zero() && -gap.bound() < size * SMALL_GAP;
        if !is_small {
            return None;
        }
        let elapsed = landing(solver, after, row, gap, &here)?;
        let zero = ZeroGuards { guards: 1 << until, point: None };
        let guards = self.graph.tied_guards(next, zero, false);
        let bends = solver.rates_of(after, &solver.rates_of(after, &here));
        // A multiple of the gap bends as the gap does, times its factor.
        let falls = |n: &usize| dot(&own.rows[*n], &bends, solver.system.dimension()) < T::zero();
        let all = (0..own.rows.len()).filter(|n| guards >> n & 1 == 1);
        let falling = all.filter(falls).fold(0, |mask, n| mask | 1 << n);
        Some(Flight { guards, falling, elapsed })
    }
}
