//! Impacts that accumulate: infinitely many of them in a time that is enclosed.
//!
//! After an impact the gap h is zero and its rate is -u. As long as a1 <= h'' <= a2, the next
//! impact is between 2 u/a2 and 2 u/a1 later, at a rate of at most u sqrt(a2/a1), and e times that
//! follows. With q = e sqrt(a2/a1) < 1 the times form a geometric series. The bounds a1 and a2 hold
//! for all states that the motion can reach in that time: along the flow, and by jumps that are
//! proportional to the rates of the impacts.

use super::{Restitution, Run};
use crate::affine::arithmetic::vector::{Vector, dot};
use crate::affine::guards::row::ModalRow;
use crate::affine::zeros::graph::Firing;
use crate::numeric::number::{Bound, Number};

/// A run ends at an accumulation once at most this share of the system's unit of time is left.
const MAX_TIME_LEFT: f64 = 1.0 / (1u64 << 30) as f64;

/// The rest of the motion from an impact to the limit at which impacts accumulate.
#[derive(Clone, Debug)]
pub(super) struct Remaining<T: Number> {
    /// The earliest and the latest time of the limit, after the impact.
    pub earliest: T,
    pub latest: T,
    /// The coefficient of restitution e, with a bound of its relative error.
    pub restitution: T,
    pub restitution_error: T::Bound,
    /// The root of the largest acceleration in units of the smallest.
    pub spread: T,
    /// A bound of what errors of e and of the acceleration add to the time.
    pub unknown: T::Bound,
}

impl<T: Number> Run<'_, T> {
    /// The time from the impact just passed to the limit at which impacts accumulate, if that is
    /// proved and near. `before` is the state just before the impact, in the mode's
    /// co-ordinates.
    pub(super) fn accumulation(
        &mut self,
        mode: usize,
        firing: Firing,
        before: &Vector<T>,
        successor: usize,
    ) -> Option<Remaining<T>> {
        let solver_mode = &self.solver.modes[mode];
        let flow = &solver_mode.flow;
        let after = &{ self.segment.entry.y };
        let gap = &solver_mode.guards[firing.until];
        let at = |row: &Vector<T>, y: &Vector<T>| dot(row, y, flow.dimension);
        let (arriving, departing) = (at(&gap.orders[1], before), -at(&gap.orders[1], after));
        let e = self.quotient(firing.until, arriving, departing);
        let (e_f64, u) = (e.to_f64(), departing.to_f64());
        let bend = at(&gap.orders[2], after);
        let scale = self.solver.system.time_scale;
        let guess = 4.0 * u / (bend.to_f64() * (1.0 - e_f64));
        let sensible = e_f64 > 0.0 && e_f64 < 1.0 && u > 0.0 && bend.to_f64() > 0.0;
        let near = guess <= 4.0 * MAX_TIME_LEFT * scale;
        if !(sensible && near) {
            return None;
        }
        // How much the derivative of a row can change along the flow and by all jumps.
        let change = |row: &ModalRow<T>, order: usize| {
            let jump = (at(&row.orders[order], after) - at(&row.orders[order], before)).bound();
            (row.bound(order + 1, &flow.norms(after), guess) * guess + jump.abs() / (1.0 - e_f64))
                * 2.0
        };
        let room = T::of_bound(change(gap, 2));
        let (a1, a2) = (bend - room, bend + room);
        let until = self.solver.system.modes[mode].until.len();
        for (n, row) in solver_mode.guards.iter().enumerate().take(until) {
            let inside = at(&row.orders[0], after).bound() + change(row, 0) < 0.0;
            if n != firing.until && self.tracks_live(n) && !inside {
                return None;
            }
        }
        let orders = self.graph.arrival(self.node, firing).orders.clone();
        let conditions = &self.solver.modes[mode].conditions[firing.until];
        for (condition, order) in conditions.iter().zip(orders.iter().copied()).take(successor + 1)
        {
            let (Some(row), Some(order)) = (condition, order) else { continue };
            let settled = at(&row.orders[order], after).bound().abs() > change(row, order);
            if !settled {
                return None;
            }
        }
        let spread = (a2 / a1).sqrt();
        let q = e * spread;
        let twice = departing + departing;
        let one = T::one();
        let earliest = twice / (a2 * (one - e * (a1 / a2).sqrt()));
        let latest = twice / (a1 * (one - q));
        let (earliest, latest) = self.widened(earliest, latest, gap, u);
        let proved = a1 > T::zero() && q < one && latest.to_f64() <= MAX_TIME_LEFT * scale;
        let [rate_share, bend_share] = [(1, departing), (2, bend)]
            .map(|(order, value)| self.share(gap, order, value.to_f64()));
        let rest = T::unit() * 16.0 + bend_share * 2.0 + rate_share * (2.0 / (1.0 - e_f64));
        let unknown = if self.enclosure.is_some() { rest * latest.bound() } else { T::Bound::ZERO };
        let restitution_error = rate_share + T::unit() * 4.0;
        let restitution = e;
        let found = Remaining { earliest, latest, restitution, restitution_error, spread, unknown };
        proved.then_some(found)
    }

    /// Widens the bounds by the errors of the rate of departure, in a run that follows its errors.
    fn widened(&self, earliest: T, latest: T, gap: &ModalRow<T>, rate: f64) -> (T, T) {
        let share = self.share(gap, 1, rate);
        let share = if self.enclosure.is_some() { share } else { T::Bound::ZERO };
        let room = latest * T::of_bound(share);
        (earliest - room, latest + room)
    }

    /// A bound of the relative error of a derivative of the gap that has this value.
    fn share(&self, gap: &ModalRow<T>, order: usize, value: f64) -> T::Bound {
        let flow = &self.solver.modes[self.graph.node(self.node).mode].flow;
        let inherited = self.enclosure.as_ref();
        let inherited = inherited.map_or(T::Bound::ZERO, |it| it.of_row(flow, gap, order));
        let (_, size) = gap.order(order, &self.segment.entry);
        (inherited + T::unit() * 32.0 * size) * 4.0 / value
    }

    /// The coefficient of restitution: it is a constant of the model, and the fastest impact shows
    /// it to the most digits.
    fn quotient(&mut self, until: usize, arriving: T, departing: T) -> T {
        let rate = arriving.to_f64();
        let node = self.node;
        let same = |it: &Restitution<T>| (it.node, it.until) == (node, until) && it.rate >= rate;
        if let Some(known) = self.restitution.filter(same) {
            return known.quotient;
        }
        let quotient = departing / arriving;
        self.restitution = Some(Restitution { node, until, rate, quotient });
        quotient
    }
}
