//! Small changes of a run's state from event to event, across impacts that accumulate and across
//! their limit.
//!
//! The time between two impacts is proportional to the speed u of the first, and so is the change
//! of a guard between them: what rounding leaves of its change divided by u is lost as u falls.
//! From one impact to the next the changes are therefore carried at the moved times, at which the
//! guard stays zero, by the series of the flow less what it begins with.
//!
//! Towards the limit u/b becomes small beside the unit of time, where b is the bend of the guard.
//! Of first order, with the coefficient of restitution e, the limit comes 2 u/(b (1 - e)) after an
//! impact, and the speeds of all arrivals from there on sum up to u/(1 - e). So a change du of the
//! speed alone delays the limit by 2 du/(b (1 - e)), and the state there changes by its rate times
//! that delay, and by the jump of an impact of unit speed times du/(1 - e). What is left out is of
//! the order of the time to the limit, beside the unit of time: impacts go on until that is a
//! rounding.

use super::variation::{Variation, is_at_once};
use crate::affine::arithmetic::vector::{Vector, dot};
use crate::affine::model::system::LARGEST_DIMENSION;
use crate::affine::solver::Solver;
use crate::affine::solver::event::{Event, What};
use crate::numeric::number::{Bound, Number};

/// The longest time from an impact to the next, times the fastest rate, for the series.
const MAX_SERIES_ARGUMENT: f64 = 0.25;
/// The time to a limit at which the first order is taken, in roundings of the unit of time.
const ROUNDINGS_LEFT: f64 = 256.0;
/// Newton's steps for the time of an impact: each doubles the digits, and the first guess has some.
const NEWTON_STEPS: usize = 8;
/// The most impacts that are followed to a limit.
const MAX_IMPACTS: usize = 1_000_000;

/// A guard of a mode whose impacts follow one another.
#[derive(Clone, Copy)]
struct Impacts {
    mode: usize,
    until: usize,
}

impl Impacts {
    /// Those of which an event is one, if they go on in its mode, may accumulate and leave their
    /// guard at zero.
    fn of<T: Number>(solver: &Solver<T>, event: &Event<T>) -> Option<Self> {
        match event.what {
            What::Until(mode, until) if mode == event.mode => {
                solver.modes[mode].stays_zero[until].then_some(Self { mode, until })
            }
            _ => None,
        }
    }

    /// Whether an event is the next one of these.
    fn goes_on<T: Number>(self, to: &Event<T>) -> bool {
        to.what == What::Until(self.mode, self.until)
    }
}

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
            return self.reset(solver, to);
        }
        if matches!(to.what, What::Limit(..)) {
            return self.pass_limit(solver, from, to);
        }
        let state = solver.complete(&from.state, &from.time);
        let elapsed = to.time.since(&from.time).value();
        let impacts = Impacts::of(solver, from).filter(|it| it.goes_on(to));
        if impacts.is_some_and(|it| self.hop(solver, it, &state, elapsed)) {
            return;
        }
        self.settle_at(solver, from, &state);
        let motion = solver.modes[from.mode].flow.propagator(elapsed);
        self.flow(&motion);
        self.arrive(solver, to, || motion.after(&state));
    }

    /// Carries changes that are at an impact to the next one, and across it, where that is near.
    /// Says whether it is.
    fn hop(&mut self, solver: &Solver<T>, impacts: Impacts, state: &Vector<T>, elapsed: T) -> bool {
        let speed = solver.modes[impacts.mode].flow.speed;
        let is_near = self.delays.is_some() && speed * elapsed.to_f64() <= MAX_SERIES_ARGUMENT;
        if is_near {
            self.hop_near(solver, impacts, state, elapsed);
        }
        is_near
    }

    /// Carries changes to the next impact by series, and across it.
    fn hop_near(
        &mut self,
        solver: &Solver<T>,
        impacts: Impacts,
        state: &Vector<T>,
        elapsed: T,
    ) -> Impact<T> {
        let own = &solver.modes[impacts.mode];
        let (row, dimension) = (&own.rows[impacts.until], own.flow.dimension);
        let before = sum(state, &gain(solver, impacts.mode, state, elapsed), T::one());
        let rates = solver.rates_of(impacts.mode, &before);
        let arrival = dot(row, &rates, dimension);
        let delays = self.delays.iter_mut().flatten();
        for (column, delay) in self.columns.iter_mut().zip(delays) {
            let gained = gain(solver, impacts.mode, column, elapsed);
            let later = -dot(row, &gained, dimension) / arrival;
            *column = sum(&sum(column, &gained, T::one()), &rates, later);
            *delay = *delay + later;
        }
        self.reset_by(solver, impacts.mode, impacts.until);
        let mut after = before;
        solver.reset(impacts.mode, impacts.until, &mut after);
        Impact { state: after, jump: sum(&after, &before, -T::one()), arrival }
    }

    /// Carries changes from the last impact of a run before a limit to that, and across it. Where
    /// they cannot be they are NaN.
    fn pass_limit(&mut self, solver: &Solver<T>, from: &Event<T>, to: &Event<T>) {
        let What::Limit(mode, until) = to.what else { return };
        let exit = solver.system.modes[mode].until.len() + until;
        let is_at_once = to.time.since(&from.time).value() == T::zero();
        let impacts = Impacts::of(solver, from).filter(|it| (it.mode, it.until) == (mode, until));
        let state = solver.complete(&from.state, &from.time);
        let is_carried = impacts.is_some_and(|it| {
            self.delays.is_some() && (is_at_once || self.approach(solver, it, state).is_some())
        });
        if !is_carried {
            let none = T::zero() / T::zero();
            self.columns.iter_mut().for_each(|it| *it = [none; LARGEST_DIMENSION]);
            self.delays = Some(vec![none; self.columns.len()]);
        }
        self.reset_by(solver, mode, exit);
    }

    /// Carries changes from an impact to the limit.
    fn approach(
        &mut self,
        solver: &Solver<T>,
        impacts: Impacts,
        mut state: Vector<T>,
    ) -> Option<()> {
        let own = &solver.modes[impacts.mode];
        let (row, dimension) = (&own.rows[impacts.until], own.flow.dimension);
        let (one, two) = (T::one(), T::exact(2.0));
        let scale = T::Bound::from_f64(solver.system.time_scale);
        let enough = T::unit() * ROUNDINGS_LEFT * scale.to_f64();
        for _ in 0..MAX_IMPACTS {
            let elapsed = next_impact(solver, impacts, &state)?;
            let Impact { state: after, jump, arrival } =
                self.hop_near(solver, impacts, &state, elapsed);
            state = after;
            let rates = solver.rates_of(impacts.mode, &state);
            let speed = -dot(row, &rates, dimension);
            let bend = dot(row, &solver.rates_of(impacts.mode, &rates), dimension);
            let restitution = speed / arrival;
            let is_sensible = speed > T::zero() && bend > T::zero() && restitution < one;
            if !is_sensible {
                return None;
            }
            let share = one / (one - restitution);
            if (two * speed * share / bend).bound() > enough {
                continue;
            }
            let delays = self.delays.iter_mut().flatten();
            for (column, delay) in self.columns.iter_mut().zip(delays) {
                let faster = -dot(row, &solver.rates_of(impacts.mode, column), dimension);
                let later = two * faster * share / bend;
                *column = sum(column, &rates, later);
                *column = sum(column, &jump, faster * share / arrival);
                *delay = *delay + later;
            }
            return Some(());
        }
        None
    }
}

/// The time from an impact to the next one.
fn next_impact<T: Number>(solver: &Solver<T>, impacts: Impacts, state: &Vector<T>) -> Option<T> {
    let own = &solver.modes[impacts.mode];
    let (row, dimension) = (&own.rows[impacts.until], own.flow.dimension);
    let along = |it: &Vector<T>| dot(row, it, dimension);
    let rates = solver.rates_of(impacts.mode, state);
    let bend = along(&solver.rates_of(impacts.mode, &rates));
    let mut elapsed = T::exact(-2.0) * along(&rates) / bend;
    for _ in 0..NEWTON_STEPS {
        let is_near =
            elapsed > T::zero() && own.flow.speed * elapsed.to_f64() <= MAX_SERIES_ARGUMENT;
        if !is_near {
            return None;
        }
        let gained = gain(solver, impacts.mode, state, elapsed);
        let rate = along(&solver.rates_of(impacts.mode, &sum(state, &gained, T::one())));
        let step = along(&gained) / rate;
        elapsed = elapsed - step;
        if step.bound().abs() <= T::unit() * 4.0 * elapsed.bound().abs() {
            break;
        }
    }
    Some(elapsed)
}

/// exp(M t) z - z, by its series.
fn gain<T: Number>(solver: &Solver<T>, mode: usize, z: &Vector<T>, elapsed: T) -> Vector<T> {
    let mut term = *z;
    let mut all = [T::zero(); LARGEST_DIMENSION];
    for n in 1..=2 * T::TERMS {
        let factor = elapsed / T::exact(n as f64);
        term = solver.rates_of(mode, &term).map(|it| it * factor);
        all = sum(&all, &term, T::one());
        let is_rounding =
            |(term, all): (&T, &T)| term.bound().abs() <= all.bound().abs() * T::unit();
        if term.iter().zip(&all).all(is_rounding) {
            break;
        }
    }
    all
}

fn sum<T: Number>(one: &Vector<T>, other: &Vector<T>, share: T) -> Vector<T> {
    std::array::from_fn(|n| one[n] + share * other[n])
}
