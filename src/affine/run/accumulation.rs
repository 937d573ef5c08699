//! Impacts that accumulate: infinitely many of them in a time that is enclosed.
//!
//! After an impact the gap h is zero and its rate is -u. The gap turns back at a rate h'' between
//! b1 and b2, and comes to the next impact at one between a1 and a2: in the same mode, or in
//! another one, which a turn ([`turn`](super::turn)) leads out of. The way back takes u/b2 to u/b1,
//! and the way on u/sqrt(a2 b2) to u/sqrt(a1 b1). The next impact is at a rate of at most u
//! sqrt(a2/b1), and e times that follows. With q = e sqrt(a2/b1) < 1 the times form a geometric
//! series. The bounds hold in a tube of states that the motion cannot leave in that time: along the
//! flows, and by jumps that are proportional to the rates of the impacts or take a state back to
//! where it was after the impact before.

use super::enclosure::Enclosure;
use super::turn::Turn;
use super::{Restitution, Run};
use crate::affine::arithmetic::vector::{Vector, dot, row_size};
use crate::affine::model::system::LARGEST_DIMENSION;
use crate::affine::solver::{Solver, SolverMode};
use crate::affine::zeros::graph::{Cycle, Firing};
use crate::affine::zeros::impact::Impacts;
use crate::numeric::number::{Bound, Number};

/// A run ends at an accumulation once at most this share of the system's unit of time is left.
const MAX_TIME_LEFT: f64 = 1.0 / (1u64 << 30) as f64;
/// An estimate of the time left above so many times the largest is not worth a proof.
const WORTH_PROVING: f64 = 2.0;
/// The largest number of times that a tube is widened until it holds the motion.
const MAX_WIDENINGS: u32 = 8;

/// An impact just passed, in a mode that the run has left or begun anew.
pub(super) struct Impact<'a, T: Number> {
    pub mode: usize,
    pub firing: Firing,
    pub successor: usize,
    /// The node before the impact.
    pub from: usize,
    /// The state just before the reset, and bounds of its errors.
    pub before: &'a Vector<T>,
    pub errors_before: &'a Vector<T::Bound>,
    /// The turn by which impacts come back to their mode; none where they stay in it.
    pub turn: Option<Turn>,
    /// The changes by this impact and by those that follow.
    pub impacts: Impacts,
}

/// The rest of the motion from an impact to the limit at which impacts accumulate.
#[derive(Clone, Debug)]
pub(super) struct Remaining<T: Number> {
    /// The earliest and the latest time of the limit, after the impact.
    pub earliest: T,
    pub latest: T,
    /// The least and the largest part of it before turns, where another mode follows an impact.
    pub before_turns: [T; 2],
    /// The quotient of the rates of two impacts that follow each other, with a bound of its
    /// relative error.
    pub quotient: T,
    pub quotient_error: T::Bound,
    /// The least and the largest that the quotient may be on the way to the limit.
    pub quotients: [T; 2],
    /// A bound of what errors of e and of the accelerations add to the time.
    pub unknown: T::Bound,
    /// For each entry of z, how far the rest of the motion goes from the state at most.
    pub tube: Vector<T::Bound>,
    /// The modes before and after turns: twice the impacts' own where there are none.
    pub modes: [usize; 2],
    /// The states that have the same value after each impact, as bits.
    pub renewed: u64,
}

/// A mode on the way from an impact to the next one, with the rows of the gap and of its first two
/// derivatives.
struct Leg<'a, T: Number> {
    own: &'a SolverMode<T>,
    orders: [Vector<T>; 3],
}

/// Bounds that hold in a tube.
struct Bounds<T> {
    earliest: T,
    latest: T,
    before_turns: [T; 2],
    /// The least and the largest quotient of the rates of two impacts.
    quotients: [T; 2],
}

impl<'a, T: Number> Leg<'a, T> {
    fn new(solver: &'a Solver<T>, mode: usize, gap: &Vector<T>) -> Self {
        let rate = solver.rate_row(mode, gap);
        Self { own: &solver.modes[mode], orders: [*gap, rate, solver.rate_row(mode, &rate)] }
    }

    fn bend(&self, z: &Vector<T>) -> T {
        dot(&self.orders[2], z, self.own.flow.dimension)
    }

    /// The least and the largest bend in a tube.
    fn bends(&self, z: &Vector<T>, tube: &Vector<T::Bound>) -> [T; 2] {
        let (bend, room) = (self.bend(z), T::of_bound(row_size(&self.orders[2], tube)));
        [bend - room, bend + room]
    }

    /// The size of the rate of an entry of z in a tube, at most.
    fn fastest(&self, n: usize, z: &Vector<T>, tube: &Vector<T::Bound>) -> T::Bound {
        let row = &self.own.matrix[n];
        let rounding = row_size(row, &sizes(z)) * T::unit() * row.len() as f64;
        dot(row, z, self.own.flow.dimension).bound().abs() + rounding + row_size(row, tube)
    }

    /// A bound of the relative error of a derivative of the gap.
    fn share(
        &self,
        order: usize,
        z: &Vector<T>,
        enclosure: Option<&Enclosure<T::Bound>>,
    ) -> T::Bound {
        let row = &self.orders[order];
        let terms = (0..order).fold(sizes(z), |sizes, _| {
            let entry = |n: usize| self.own.matrix.get(n).map(|row| row_size(row, &sizes));
            std::array::from_fn(|n| entry(n).unwrap_or(T::Bound::ZERO))
        });
        let rounding = T::unit() * 32.0 * row_size(&self.orders[0], &terms);
        let inherited = enclosure.map_or(T::Bound::ZERO, |it| it.of_plain_row(row));
        let value = dot(row, z, self.own.flow.dimension).bound().abs();
        (inherited + rounding) * 4.0 / value
    }
}

impl<T: Number> Run<'_, T> {
    /// The time from an impact just passed to the limit at which impacts accumulate, if that is
    /// proved and near.
    pub(super) fn accumulation(&mut self, impact: &Impact<'_, T>) -> Option<Remaining<T>> {
        let (solver, z) = (self.solver, &{ self.state });
        let until = impact.firing.until;
        let own = &solver.modes[impact.mode];
        let gap = &own.rows[until];
        let modes = [self.graph.node(self.node).mode, impact.mode];
        let dimension = own.flow.dimension;
        let rates = modes.map(|mode| solver.rates_of(mode, z));
        let arriving = dot(gap, &solver.rates_of(impact.mode, impact.before), dimension);
        let departing = -dot(gap, &rates[0], dimension);
        let e = self.quotient(impact, [arriving, departing]);
        let [bend_back, bend_on] =
            [0, 1].map(|n| dot(gap, &solver.rates_of(modes[n], &rates[n]), dimension).to_f64());
        let (e_f64, u) = (e.to_f64(), departing.to_f64());
        let quotient = e_f64 * (bend_on / bend_back).sqrt();
        let guess = u * (1.0 / bend_back + 1.0 / (bend_on * bend_back).sqrt()) / (1.0 - quotient);
        let scale = solver.system.time_scale;
        // A comparison with NaN is false.
        let sensible = e_f64 > 0.0 && e_f64 < 1.0 && u > 0.0 && bend_back > 0.0 && quotient < 1.0;
        if !(sensible && guess <= WORTH_PROVING * MAX_TIME_LEFT * scale) {
            return None;
        }
        let legs = modes.map(|mode| Leg::new(solver, mode, gap));
        let errors = self.enclosure.as_ref().map(Enclosure::state);
        let off = errors.unwrap_or([T::Bound::ZERO; LARGEST_DIMENSION]);
        let Impacts { idle, renewed, .. } = impact.impacts;
        let jump: Vector<T::Bound> = std::array::from_fn(|n| {
            let jump =
                || (z[n] - impact.before[n]).bound().abs() + off[n] + impact.errors_before[n];
            if impact.impacts.add_up(n) { jump() } else { T::Bound::ZERO }
        });
        let (bounds, tube) = settled(&legs, z, [e, departing], [&off, &jump], idle)?;
        if !self.nothing_else_happens(impact, &tube) {
            return None;
        }
        let remaining = self.remaining(&legs, e, modes, bounds, tube)?;
        Some(Remaining { renewed, ..remaining })
    }

    /// The rest of the motion, if it is short, with what is not known of the state.
    fn remaining(
        &self,
        legs: &[Leg<'_, T>; 2],
        e: T,
        modes: [usize; 2],
        bounds: Bounds<T>,
        tube: Vector<T::Bound>,
    ) -> Option<Remaining<T>> {
        let (z, enclosure) = (&self.state, self.enclosure.as_ref());
        let [back, on] = legs;
        let rate_share = back.share(1, z, enclosure);
        let bend_share = |leg: &Leg<'_, T>| leg.share(2, z, enclosure);
        let is_cycle = modes[0] != modes[1];
        let bend_share = if is_cycle { bend_share(back) + bend_share(on) } else { bend_share(on) };
        let quotient = if is_cycle { e * (on.bend(z) / back.bend(z)).sqrt() } else { e };
        // Without enclosed errors there is nothing to widen by.
        let is_enclosed = enclosure.is_some();
        let room = if is_enclosed { bounds.latest * T::of_bound(rate_share) } else { T::zero() };
        let (earliest, latest) = (bounds.earliest - room, bounds.latest + room);
        let open = 1.0 / (1.0 - quotient.to_f64());
        let rest = T::unit() * 16.0 + (bend_share + rate_share) * (2.0 * open);
        let own_error = if is_cycle { bend_share } else { T::Bound::ZERO };
        let is_near = latest.to_f64() <= MAX_TIME_LEFT * self.solver.system.time_scale;
        is_near.then(|| Remaining {
            earliest,
            latest,
            before_turns: bounds.before_turns,
            quotient,
            quotient_error: rate_share + own_error + T::unit() * 8.0,
            quotients: bounds.quotients,
            unknown: if is_enclosed { rest * latest.bound() } else { T::Bound::ZERO },
            tube,
            modes,
            renewed: 0,
        })
    }

    /// Whether, in a tube, no other `until` fires, and every successor is the one that followed.
    fn nothing_else_happens(&mut self, impact: &Impact<'_, T>, tube: &Vector<T::Bound>) -> bool {
        let own = (impact.from, impact.firing);
        let until = impact.firing.until;
        let kept = match &impact.turn {
            None => [1 << until; 2],
            Some(turn) => {
                let cycle =
                    Cycle { impact: (impact.from, until), turn: (turn.node, turn.firing.until) };
                let Some(kept) = self.graph.kept_inside(cycle) else { return false };
                [kept[1], kept[0] | 1 << until]
            }
        };
        let nodes = [self.node, impact.from];
        let legs = if impact.turn.is_some() { 2 } else { 1 };
        let is_quiet = (0..legs).all(|n| self.stays_inside(nodes[n], kept[n], tube));
        is_quiet
            && self.is_followed_by(own, impact.successor, tube)
            && impact
                .turn
                .is_none_or(|it| self.is_followed_by((it.node, it.firing), it.successor, tube))
    }

    /// Whether the guards of `until` stay negative in a tube, in the mode of a node: but for those
    /// that are kept inside by the model, as bits, and those that stay zero.
    fn stays_inside(&self, node: usize, kept: u64, tube: &Vector<T::Bound>) -> bool {
        let node = self.graph.node(node);
        let (mode, stays_zero) = (node.mode, |n: usize| node.multiplicities[n].is_none());
        let own = &self.solver.modes[mode];
        let until = self.solver.system.modes[mode].until.len();
        let is_inside = |n: usize| {
            let row = &own.rows[n];
            dot(row, &self.state, own.flow.dimension).bound() + row_size(row, tube) < 0.0
        };
        (0..until).all(|n| kept >> n & 1 == 1 || stays_zero(n) || is_inside(n))
    }

    /// Whether an event of a node has the same successor wherever in a tube it happens.
    fn is_followed_by(
        &mut self,
        (node, firing): (usize, Firing),
        successor: usize,
        tube: &Vector<T::Bound>,
    ) -> bool {
        let arrival = self.graph.arrival(node, firing);
        let orders = arrival.orders.clone();
        let kept = arrival.impacts.map_or(0, |it| it.kept);
        let mode = self.graph.node(node).mode;
        let (solver, z) = (self.solver, &self.state);
        let exits = solver.system.modes[mode].exits().nth(firing.until);
        let Some((_, next)) = exits else { return false };
        let rows = &solver.modes[mode].condition_rows[firing.until];
        let all = rows.iter().zip(orders.iter().copied()).enumerate().take(successor + 1);
        for (n, (row, order)) in all {
            let (Some(row), Some(order)) = (row, order) else { continue };
            if kept >> n & 1 == 1 {
                continue;
            }
            let mode = next[n].mode;
            let row = (0..order).fold(*row, |row, _| solver.rate_row(mode, &row));
            let value = dot(&row, z, solver.system.dimension()).bound();
            let value = if n == successor { value } else { -value };
            if value - row_size(&row, tube) <= 0.0 {
                return false;
            }
        }
        true
    }

    /// The coefficient of restitution: it is a constant of the model, and the fastest impact shows
    /// it to the most digits.
    fn quotient(&mut self, impact: &Impact<'_, T>, [arriving, departing]: [T; 2]) -> T {
        let (node, until, rate) = (impact.from, impact.firing.until, arriving.to_f64());
        let is_alike = |it: usize| self.graph.are_alike([it, node], impact.impacts.idle);
        let same = |it: &Restitution<T>| it.until == until && it.rate >= rate && is_alike(it.node);
        if let Some(known) = self.restitution.filter(same) {
            return known.quotient;
        }
        let quotient = departing / arriving;
        self.restitution = Some(Restitution { node, until, rate, quotient });
        quotient
    }
}

/// The bounds that hold from a state on, after an impact with the coefficient of restitution e that
/// leaves the gap at this rate, and the tube in which they hold: the state is not known better than
/// by `off`, and the last impact has changed it by `jump`. Idle states, given as bits, may go
/// anywhere.
fn settled<T: Number>(
    legs: &[Leg<'_, T>; 2],
    z: &Vector<T>,
    [e, departing]: [T; 2],
    [off, jump]: [&Vector<T::Bound>; 2],
    idle: u64,
) -> Option<(Bounds<T>, Vector<T::Bound>)> {
    let dimension = legs[0].own.matrix.len();
    let mut tube = *off;
    for _ in 0..MAX_WIDENINGS {
        let bounds = bounds_in(legs, z, [e, departing], &tube)?;
        let time = bounds.latest.bound();
        let [_, largest] = bounds.quotients;
        let jumps = (largest / (T::one() - largest)).bound();
        let mut reach = [T::Bound::ZERO; LARGEST_DIMENSION];
        let bounded = |(n, _): &(usize, &mut T::Bound)| idle >> n & 1 == 0;
        for (n, reach) in reach.iter_mut().enumerate().take(dimension).filter(bounded) {
            let fastest = legs[0].fastest(n, z, &tube).max(legs[1].fastest(n, z, &tube));
            *reach = fastest * time + jump[n] * jumps + off[n];
        }
        if reach.iter().zip(&tube).all(|(reach, tube)| *reach <= *tube) {
            return Some((bounds, tube));
        }
        tube = reach.map(|it| it * 2.0);
    }
    None
}

fn bounds_in<T: Number>(
    legs: &[Leg<'_, T>; 2],
    z: &Vector<T>,
    [e, departing]: [T; 2],
    tube: &Vector<T::Bound>,
) -> Option<Bounds<T>> {
    let [[b1, b2], [a1, a2]] = [0, 1].map(|n| legs[n].bends(z, tube));
    let (one, zero) = (T::one(), T::zero());
    let (least, largest) = (e * (a1 / b2).sqrt(), e * (a2 / b1).sqrt());
    // A comparison with NaN is false.
    let accumulates = b1 > zero && a1 > zero && largest < one;
    if !accumulates {
        return None;
    }
    let [early, late] = [departing / (one - least), departing / (one - largest)];
    Some(Bounds {
        earliest: early / b2 + early / (a2 * b2).sqrt(),
        latest: late / b1 + late / (a1 * b1).sqrt(),
        before_turns: [early / b2, late / b1],
        quotients: [least, largest],
    })
}

fn sizes<T: Number>(z: &Vector<T>) -> Vector<T::Bound> {
    z.map(|it| it.bound().abs())
}
