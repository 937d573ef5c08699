//! Small changes of a run's state, carried along it: the derivative of the motion.
//!
//! Between events a change moves by exp(M t). An event of `until` with the guard w and the reset R
//! comes later by dT = -(w dz)/(w M z), with the change dz and the state z just before it; just
//! after it, at the moved time, the state has changed by R (dz + M z dT). At a fixed time that is
//! less M' z' dT, with the state z' and the matrix M' that follow. An event that fires at the
//! instant at which its mode is entered does so for every state that the model allows there: it
//! comes later by the same dT, and has its reset alone.
//!
//! The forcing angle has no change of its own at a fixed time, and so the entries of cos theta, sin
//! theta and 1 stay zero there.

use super::parameter::CoefficientRates;
use super::repeated::SinceImpact;
use super::series::sum;
use crate::affine::arithmetic::clock::Time;
use crate::affine::arithmetic::vector::{Vector, add_product, dot};
use crate::affine::closed_form::propagator::Propagator;
use crate::affine::model::system::LARGEST_DIMENSION;
use crate::affine::solver::Solver;
use crate::affine::solver::event::{Event, What};
use crate::numeric::number::Number;
use std::sync::Arc;

/// Changes of the state along a run, as columns.
#[derive(Clone, Debug)]
pub struct Variation<T> {
    /// The changes of z: at a fixed time, or where there are delays at the delayed one.
    pub columns: Vec<Vector<T>>,
    /// The delays of the event at which the columns are; none where they are at a fixed time.
    pub delays: Option<Vec<T>>,
    /// What the changes have gained since an impact, where they are at a turn after it.
    pub(super) since_impact: Option<SinceImpact<T>>,
    /// The parameter by which the last column is a change, if one is: that of a unit of it.
    pub(super) parameter: Option<Arc<CoefficientRates<T>>>,
}

/// A column of changes, with the derivatives of the coefficients if it is that of a parameter.
pub(super) type Varied<'a, T> = (&'a mut Vector<T>, Option<&'a CoefficientRates<T>>);

impl<T: Number> Variation<T> {
    /// Changes at a fixed time.
    #[must_use]
    pub fn at_fixed_time(columns: Vec<Vector<T>>) -> Self {
        Self { columns, delays: None, since_impact: None, parameter: None }
    }

    /// The change by a parameter of a motion that begins with a state z at a fixed angle of the
    /// forcing, at this time.
    #[must_use]
    pub fn by_parameter(
        solver: &Solver<T>,
        rates: Arc<CoefficientRates<T>>,
        time: &Time<T>,
    ) -> Self {
        let (mut column, mut delay) = ([T::zero(); LARGEST_DIMENSION], T::zero());
        if let Some(clock) = solver.phase() {
            let (sin, cos) = solver.sin_cos(time);
            (column[clock], column[clock + 1]) = (-sin * rates.phi, cos * rates.phi);
            delay = solver.delay_at_fixed_angle(&rates, time.value());
        }
        let parameter = Some(rates);
        Self { columns: vec![column], delays: Some(vec![delay]), since_impact: None, parameter }
    }

    /// Each column, with the derivatives of the coefficients where it is that of a parameter.
    pub(super) fn varied(&mut self) -> impl Iterator<Item = Varied<'_, T>> {
        let (last, rates) = (self.columns.len().checked_sub(1), self.parameter.as_deref());
        let own = move |n| rates.filter(|_| Some(n) == last);
        self.columns.iter_mut().enumerate().map(move |(n, it)| (it, own(n)))
    }

    /// A change of each state alone.
    #[must_use]
    pub fn of_each_state(solver: &Solver<T>) -> Self {
        let unit = |n: usize| std::array::from_fn(|k| if k == n { T::one() } else { T::zero() });
        Self::at_fixed_time((0..solver.system().states.len()).map(unit).collect())
    }

    /// Takes the changes to the fixed time of the event at which they are.
    pub fn settle(&mut self, solver: &Solver<T>, at: &Event<T>) {
        if self.delays.is_some() {
            self.settle_at(solver, at, &solver.complete(&at.state, &at.time));
        }
    }

    /// Takes the changes to the fixed time of the event at which they are, whose state z is given.
    pub fn settle_at(&mut self, solver: &Solver<T>, at: &Event<T>, z: &Vector<T>) {
        let Some(delays) = self.delays.take() else { return };
        let rates = solver.rates_of(at.mode, z);
        let states = at.state.len();
        for ((column, parameter), delay) in self.varied().zip(delays) {
            column.iter_mut().zip(&rates).for_each(|(it, rate)| *it = *it - *rate * delay);
            if parameter.is_none() {
                // The angle is that of the time, which is fixed.
                column[states..].fill(T::zero());
            }
        }
    }

    /// Carries changes at a fixed time along a mode.
    pub fn flow(&mut self, motion: &Propagator<'_, T>) {
        self.columns.iter_mut().for_each(|column| *column = motion.after(column));
    }

    /// Carries changes that have come to the time of an event across it; `before` gives the state z
    /// just before. At a horizon, whose time is fixed, nothing happens.
    pub fn arrive(
        &mut self,
        solver: &Solver<T>,
        to: &Event<T>,
        before: impl FnOnce() -> Vector<T>,
    ) {
        let (mode, guard) = match to.what {
            What::Until(mode, index) => (mode, index),
            What::Watch(mode, index) => (mode, solver.system.modes[mode].until.len() + index),
            What::Start | What::Limit(..) | What::End(_) => return,
        };
        let z = before();
        self.delay(solver, mode, guard, &z);
        if let What::Until(mode, until) = to.what {
            self.reset_by(solver, mode, until, &z);
        }
    }

    /// Delays changes to the crossing of a guard, at which the state z is given.
    fn delay(&mut self, solver: &Solver<T>, mode: usize, guard: usize, z: &Vector<T>) {
        let own = &solver.modes[mode];
        let row = &own.rows[guard];
        let dimension = own.flow.dimension;
        let rates = solver.rates_of(mode, z);
        let slope = dot(row, &rates, dimension);
        let delayed = |(column, parameter): Varied<'_, T>| {
            let own = parameter.map_or_else(T::zero, |it| it.guard(mode, guard, z));
            let delay = -(dot(row, column, dimension) + own) / slope;
            column.iter_mut().zip(&rates).for_each(|(it, rate)| *it = *it + *rate * delay);
            delay
        };
        self.delays = Some(self.varied().map(delayed).collect());
    }

    /// Resets changes as an event that fires at once resets the state of the one before.
    pub fn reset_at_once(&mut self, solver: &Solver<T>, from: &Event<T>, to: &Event<T>) {
        if let What::Until(mode, until) = to.what {
            self.reset_by(solver, mode, until, &solver.complete(&from.state, &from.time));
        }
    }

    /// Resets changes as the reset of this number of a mode resets a state z.
    pub(super) fn reset_by(
        &mut self,
        solver: &Solver<T>,
        mode: usize,
        number: usize,
        z: &Vector<T>,
    ) {
        for (column, parameter) in self.varied() {
            solver.reset(mode, number, column);
            if let Some(rates) = parameter {
                *column = sum(column, &rates.reset(mode, number, z), T::one());
            }
        }
    }
}

/// Whether an event fires at the instant at which its mode is entered.
pub fn is_at_once<T: Number>(from: &Event<T>, to: &Event<T>) -> bool {
    let is_until = matches!(to.what, What::Until(..));
    is_until && to.time.since(&from.time).value() == T::zero()
}

impl<T: Number> Solver<T> {
    /// The delay by a parameter of the instant, at this time, of a fixed angle of the forcing's
    /// omega t.
    pub(in crate::affine) fn delay_at_fixed_angle(
        &self,
        rates: &CoefficientRates<T>,
        time: T,
    ) -> T {
        let omega = self.system.forcing.as_ref().map(|it| T::exact(it.omega.to_f64()));
        omega.map_or_else(T::zero, |omega| -time * rates.omega / omega)
    }

    /// The rates M z of a state in a mode.
    pub(in crate::affine) fn rates(&self, mode: usize, time: &Time<T>, state: &[T]) -> Vector<T> {
        self.rates_of(mode, &self.complete(state, time))
    }

    /// The value of a mode's guard at a state, its rate, and the largest value that entries as
    /// large as the state's could give it; guards of `watch` follow those of `until`.
    pub(in crate::affine) fn guard_and_rate(
        &self,
        (mode, guard): (usize, usize),
        time: &Time<T>,
        state: &[T],
    ) -> [T; 3] {
        let (own, z) = (&self.modes[mode], self.complete(state, time));
        let along = |entries: &Vector<T>| dot(&own.rows[guard], entries, own.flow.dimension);
        let largest =
            z.iter().fold(T::zero(), |most, it| if it.abs() > most { it.abs() } else { most });
        let size = own.rows[guard].iter().fold(T::zero(), |sum, it| sum + it.abs() * largest);
        [along(&z), along(&self.rates_of(mode, &z)), size]
    }

    /// The row of the rate of a row's value in a mode.
    pub(super) fn rate_row(&self, mode: usize, row: &Vector<T>) -> Vector<T> {
        let mut product = [T::zero(); LARGEST_DIMENSION];
        for (factor, own) in row.iter().zip(&self.modes[mode].matrix) {
            add_product(&mut product, own, *factor);
        }
        product
    }

    /// The rates M z.
    pub(super) fn rates_of(&self, mode: usize, z: &Vector<T>) -> Vector<T> {
        let own = &self.modes[mode];
        let mut rates = [T::zero(); LARGEST_DIMENSION];
        for (rate, row) in rates.iter_mut().zip(&own.matrix) {
            *rate = dot(row, z, own.flow.dimension);
        }
        rates
    }
}
