//! Small changes of a run's state from event to event, across impacts that accumulate and across
//! their limit.
//!
//! The time between two impacts is proportional to the speed u of the first, and so is the change
//! of a guard between them: what rounding leaves of its change divided by u is lost as u falls.
//! From one impact to the next the changes are therefore carried at the moved times, at which the
//! guard stays zero, by the series of the flow less what it begins with. Where a turn leads from
//! the mode after an impact to that of the next, the changes since the impact are kept at it.
//!
//! Towards the limit u/b becomes small beside the unit of time, where b is the bend of the guard
//! after an impact, and a that before one. With s = sqrt(a/b) and the coefficient of restitution e
//! the limit comes (u/b + u/sqrt(a b))/(1 - e s) after an impact, of first order, and the speeds of
//! all arrivals from there on sum up to u s/(1 - e s). So the change of the speed alone delays the
//! limit in proportion, and the state there changes by its rates times that delay, and by the jump
//! of an impact of unit speed times the change of that sum. What is left out is of the order of the
//! time to the limit, beside the unit of time: impacts go on until that is a rounding.

use super::parameter::{CoefficientRates, gain_by_parameter};
use super::repeated::{Gained, RepeatedImpact, SinceImpact};
use super::series::{MAX_SERIES_ARGUMENT, gain, landing, short_root, sum};
use super::variation::{Variation, Varied, is_at_once};
use crate::affine::arithmetic::vector::{Vector, dot};
use crate::affine::model::system::LARGEST_DIMENSION;
use crate::affine::solver::Solver;
use crate::affine::solver::event::{Event, What};
use crate::numeric::number::{Bound, Number};

/// The time to a limit at which the first order is taken, in roundings of the unit of time.
const ROUNDINGS_LEFT: f64 = 256.0;
/// The most impacts that are followed to a limit.
const MAX_IMPACTS: usize = 1_000_000;

/// The value at a state of a row's derivative by a parameter.
type OfRow<'a, T> = &'a dyn Fn(&CoefficientRates<T>, &Vector<T>) -> T;

/// An impact of a run: the state just after it, and the speed of its arrival.
struct Impact<T> {
    state: Vector<T>,
    /// The change of the state by the impact.
    jump: Vector<T>,
    arrival: T,
}

impl<T: Number> Variation<T> {
    /// Carries the changes from one event of a run to the next one, or to the horizon.
    pub fn pass(&mut self, solver: &Solver<T>, from: &Event<T>, to: &Event<T>) {
        if is_at_once(from, to) {
            return self.reset_at_once(solver, from, to);
        }
        if matches!(to.what, What::Limit(..)) {
            return self.pass_limit(solver, from, to);
        }
        let state = solver.complete(&from.state, &from.time);
        let elapsed = to.time.since(&from.time).value();
        if self.pass_short(solver, from, to, &state, elapsed) {
            return;
        }
        self.settle_at(solver, from, &state);
        let motion = solver.modes[from.mode].flow.propagator(elapsed);
        self.flow(&motion);
        for (column, parameter) in self.varied() {
            if let Some(rates) = parameter {
                *column = sum(column, &rates.added(solver, from.mode, &state, elapsed), T::one());
            }
        }
        self.arrive(solver, to, || motion.after(&state));
    }

    /// Carries changes that are at an impact, or at the turn after it, to the next turn or impact,
    /// and across it, where that is near. Says whether it is.
    fn pass_short(
        &mut self,
        solver: &Solver<T>,
        from: &Event<T>,
        to: &Event<T>,
        state: &Vector<T>,
        elapsed: T,
    ) -> bool {
        let since = self.since_impact.take();
        let speed = solver.modes[from.mode].flow.speed;
        if self.delays.is_none() || speed * elapsed.to_f64() > MAX_SERIES_ARGUMENT {
            return false;
        }
        if let Some(SinceImpact { impacts, mut gained }) = since {
            let is_next = to.what == What::Until(impacts.mode, impacts.until);
            if is_next {
                self.land(solver, impacts, state, elapsed, &mut gained);
            }
            return is_next;
        }
        let Some(impacts) = RepeatedImpact::of(solver, from) else { return false };
        if impacts.go_on_by(to) {
            self.land(solver, impacts, state, elapsed, &mut self.nothing_gained());
            return true;
        }
        let Some(turn) = impacts.turn(solver, to) else { return false };
        let (row, mut gained) = (&solver.modes[impacts.after].rows[turn], self.nothing_gained());
        let of_row =
            |rates: &CoefficientRates<T>, z: &Vector<T>| rates.guard(impacts.after, turn, z);
        self.turn(solver, impacts, (row, &of_row), state, elapsed, &mut gained);
        self.since_impact = Some(SinceImpact { impacts, gained });
        true
    }

    fn nothing_gained(&self) -> Gained<T> {
        let nothing = [T::zero(); LARGEST_DIMENSION];
        Gained { state: nothing, columns: vec![nothing; self.columns.len()] }
    }

    /// Carries changes from an impact to the zero of a row, which turns the motion back; `of_row`
    /// is the value at a state of the row's derivative by a parameter.
    fn turn(
        &mut self,
        solver: &Solver<T>,
        impacts: RepeatedImpact,
        (row, of_row): (&Vector<T>, OfRow<'_, T>),
        state: &Vector<T>,
        elapsed: T,
        gained: &mut Gained<T>,
    ) {
        let dimension = solver.modes[impacts.after].flow.dimension;
        let own = gain(solver, impacts.after, state, elapsed);
        let there = sum(state, &own, T::one());
        let slope = dot(row, &solver.rates_of(impacts.after, &there), dimension);
        self.leg(
            solver,
            impacts.after,
            (state, elapsed, &own),
            gained,
            |(column, parameter), _| {
                let own = parameter.map_or_else(T::zero, |it| of_row(it, &there));
                -(dot(row, column, dimension) + own) / slope
            },
        );
    }

    /// Carries changes along a mode to the next impact, and across it.
    fn land(
        &mut self,
        solver: &Solver<T>,
        impacts: RepeatedImpact,
        state: &Vector<T>,
        elapsed: T,
        gained: &mut Gained<T>,
    ) -> Impact<T> {
        let own = &solver.modes[impacts.mode];
        let (row, dimension) = (&own.rows[impacts.until], own.flow.dimension);
        let own_gain = gain(solver, impacts.mode, state, elapsed);
        let before = sum(state, &own_gain, T::one());
        let arrival = dot(row, &solver.rates_of(impacts.mode, &before), dimension);
        let since_impact = sum(&gained.state, &own_gain, T::one());
        self.leg(
            solver,
            impacts.mode,
            (state, elapsed, &own_gain),
            gained,
            |(_, parameter), gained| {
                let guard =
                    |it: &CoefficientRates<T>| it.guard(impacts.mode, impacts.until, &since_impact);
                let own = parameter.map_or_else(T::zero, guard);
                -(dot(row, gained, dimension) + own) / arrival
            },
        );
        self.reset_by(solver, impacts.mode, impacts.until, &before);
        let mut after = before;
        solver.reset(impacts.mode, impacts.until, &mut after);
        Impact { state: after, jump: sum(&after, &before, -T::one()), arrival }
    }

    /// Carries changes along a mode from a state on, which gains this in a time, to an event. Its
    /// delay follows from a change there and from what that has gained since the impact.
    fn leg(
        &mut self,
        solver: &Solver<T>,
        mode: usize,
        (state, elapsed, own): (&Vector<T>, T, &Vector<T>),
        gained: &mut Gained<T>,
        delay: impl Fn(Varied<'_, T>, &Vector<T>) -> T,
    ) {
        let rates = solver.rates_of(mode, &sum(state, own, T::one()));
        gained.state = sum(&gained.state, own, T::one());
        let mut delays = self.delays.take();
        let totals = delays.iter_mut().flatten();
        for (((column, parameter), all), total) in
            self.varied().zip(&mut gained.columns).zip(totals)
        {
            let own = match parameter {
                Some(by) => gain_by_parameter(solver, by, mode, (column, state), elapsed),
                None => gain(solver, mode, column, elapsed),
            };
            (*column, *all) = (sum(column, &own, T::one()), sum(all, &own, T::one()));
            let later = delay((column, parameter), all);
            (*column, *all) = (sum(column, &rates, later), sum(all, &rates, later));
            *total = *total + later;
        }
        self.delays = delays;
    }

    /// Carries changes from the last impact of a run before a limit to that, and across it. Where
    /// they cannot be they are NaN.
    fn pass_limit(&mut self, solver: &Solver<T>, from: &Event<T>, to: &Event<T>) {
        let What::Limit(mode, until) = to.what else { return };
        let exit = solver.system.modes[mode].until.len() + until;
        let is_at_once = to.time.since(&from.time).value() == T::zero();
        self.since_impact = None;
        let impacts =
            RepeatedImpact::of(solver, from).filter(|it| (it.mode, it.until) == (mode, until));
        let state = solver.complete(&from.state, &from.time);
        let last = if is_at_once {
            Some(state)
        } else {
            impacts.and_then(|it| self.approach(solver, it, state))
        };
        let last = last.filter(|_| self.delays.is_some()).unwrap_or_else(|| {
            let none = T::zero() / T::zero();
            self.columns.iter_mut().for_each(|it| *it = [none; LARGEST_DIMENSION]);
            self.delays = Some(vec![none; self.columns.len()]);
            state
        });
        self.keep_on_guard(solver, mode, until, &last);
        self.reset_by(solver, mode, exit, &last);
    }

    /// Takes away what rounding has made of the changes of a guard and of its rate, which are zero
    /// at a limit: by the states alone, since the time has its own changes. The state there is
    /// given, as is that at an impact so near to it that the rest is rounding.
    fn keep_on_guard(&mut self, solver: &Solver<T>, mode: usize, until: usize, z: &Vector<T>) {
        let states = solver.system.states.len();
        let guard = solver.modes[mode].rows[until];
        let rate = solver.rate_row(mode, &guard);
        let share = dot(&rate, &guard, states) / dot(&guard, &guard, states);
        let of_guard = |it: &CoefficientRates<T>, z: &Vector<T>| it.guard(mode, until, z);
        let of_rate = |it: &CoefficientRates<T>, z: &Vector<T>| {
            it.guard_rate(solver, (mode, until), mode, z) - share * of_guard(it, z)
        };
        let of_rows: [OfRow<'_, T>; 2] = [&of_guard, &of_rate];
        for (row, of_row) in [guard, sum(&rate, &guard, -share)].iter().zip(of_rows) {
            let square = dot(row, row, states);
            // A guard of the forcing alone has no states; a comparison with NaN is false.
            if square > T::zero() {
                for (column, parameter) in self.varied() {
                    let own = parameter.map_or_else(T::zero, |it| of_row(it, z));
                    let factor = (dot(row, column, solver.system.dimension()) + own) / square;
                    column[..states].iter_mut().zip(row).for_each(|(it, own)| {
                        *it = *it - factor * *own;
                    });
                }
            }
        }
    }

    /// Carries changes from an impact to the limit. Returns the state after the last impact on the
    /// way.
    fn approach(
        &mut self,
        solver: &Solver<T>,
        impacts: RepeatedImpact,
        mut state: Vector<T>,
    ) -> Option<Vector<T>> {
        self.delays.as_ref()?;
        let row = &solver.modes[impacts.mode].rows[impacts.until];
        let along = |it: &Vector<T>| dot(row, it, solver.system.dimension());
        let of_rate = |it: &CoefficientRates<T>, z: &Vector<T>| {
            it.guard_rate(solver, (impacts.mode, impacts.until), impacts.after, z)
        };
        let one = T::one();
        let scale = T::Bound::from_f64(solver.system.time_scale);
        let enough = T::unit() * ROUNDINGS_LEFT * scale.to_f64();
        for _ in 0..MAX_IMPACTS {
            let Impact { state: after, jump, arrival } = self.next(solver, impacts, &state)?;
            state = after;
            let [back, on] =
                [impacts.after, impacts.mode].map(|mode| solver.rates_of(mode, &state));
            let speed = -along(&back);
            let bend_back = along(&solver.rates_of(impacts.after, &back));
            let bend_on = along(&solver.rates_of(impacts.mode, &on));
            let faster = (bend_on / bend_back).sqrt();
            let quotient = speed / arrival * faster;
            let zero = T::zero();
            let is_sensible = speed > zero && bend_back > zero && bend_on > zero && quotient < one;
            if !is_sensible {
                return None;
            }
            let share = one / (one - quotient);
            let [way_back, way_on] = [share / bend_back, share / (bend_on * bend_back).sqrt()];
            if (speed * (way_back + way_on)).bound() > enough {
                continue;
            }
            let mut delays = self.delays.take();
            for ((column, parameter), delay) in self.varied().zip(delays.iter_mut().flatten()) {
                let own = parameter.map_or_else(T::zero, |it| of_rate(it, &state));
                let more = -(along(&solver.rates_of(impacts.after, column)) + own);
                *column = sum(column, &back, more * way_back);
                *column = sum(column, &on, more * way_on);
                *column = sum(column, &jump, more * faster * share / arrival);
                *delay = *delay + more * (way_back + way_on);
            }
            self.delays = delays;
            return Some(state);
        }
        None
    }

    /// Carries changes from an impact, at which the state is given, to the next one, and across it.
    fn next(
        &mut self,
        solver: &Solver<T>,
        impacts: RepeatedImpact,
        state: &Vector<T>,
    ) -> Option<Impact<T>> {
        let row = &solver.modes[impacts.mode].rows[impacts.until];
        let (guard, mut gained) = ((impacts.mode, impacts.until), self.nothing_gained());
        if impacts.after == impacts.mode {
            let elapsed = next_impact(solver, impacts, state)?;
            return Some(self.land(solver, impacts, state, elapsed, &mut gained));
        }
        let rate = solver.rate_row(impacts.after, row);
        let elapsed = time_to_turn(solver, impacts.after, row, state)?;
        let of_rate = |it: &CoefficientRates<T>, z: &Vector<T>| {
            it.guard_rate(solver, guard, impacts.after, z)
        };
        self.turn(solver, impacts, (&rate, &of_rate), state, elapsed, &mut gained);
        let own = gained.state;
        let (gap, here) = (dot(row, &own, solver.system.dimension()), sum(state, &own, T::one()));
        let elapsed = landing(solver, impacts.mode, row, gap, &here)?;
        Some(self.land(solver, impacts, &here, elapsed, &mut gained))
    }
}

/// The time from an impact to the next one in the same mode.
fn next_impact<T: Number>(
    solver: &Solver<T>,
    impacts: RepeatedImpact,
    state: &Vector<T>,
) -> Option<T> {
    let row = &solver.modes[impacts.mode].rows[impacts.until];
    let along = |it: &Vector<T>| dot(row, it, solver.system.dimension());
    let rates = solver.rates_of(impacts.mode, state);
    let bend = along(&solver.rates_of(impacts.mode, &rates));
    let guess = T::exact(-2.0) * along(&rates) / bend;
    short_root(solver, impacts.mode, state, guess, |gained, rates| [along(gained), along(rates)])
}

/// The time from an impact to the zero of the gap's rate in the mode that follows.
fn time_to_turn<T: Number>(
    solver: &Solver<T>,
    mode: usize,
    row: &Vector<T>,
    state: &Vector<T>,
) -> Option<T> {
    let along = |it: &Vector<T>| dot(row, it, solver.system.dimension());
    let rates = solver.rates_of(mode, state);
    let guess = -along(&rates) / along(&solver.rates_of(mode, &rates));
    short_root(solver, mode, state, guess, |_, rates| {
        [along(rates), along(&solver.rates_of(mode, rates))]
    })
}
