//! A system's equations in any numbers that differential-equations takes: f64, or dual numbers,
//! which carry the derivatives by all names through whatever is computed from the coefficients.

use crate::percuss_program::derivatives::Rates;
use crate::percuss_program::{Mode, Row};
use differential_equations::ode::ODE;
use differential_equations::traits::Real;
use num_dual::{Derivative, DualSVec64};
use std::rc::Rc;

/// Dual numbers of the library's example have so many derivatives; more than any case asks for.
pub const MAX_NAMES: usize = 12;

/// A number with its derivatives by names.
pub type Dual = DualSVec64<MAX_NAMES>;

/// A number that a run is made in.
pub trait Number: Real {
    /// A coefficient, from its value and its derivative by each name.
    fn of(value: f64, by: impl Iterator<Item = f64>) -> Self;

    fn value(&self) -> f64;

    /// A number that depends on no name.
    fn constant(value: f64) -> Self {
        Self::from_subset(&value)
    }
}

impl Number for f64 {
    fn of(value: f64, _: impl Iterator<Item = f64>) -> Self {
        value
    }

    fn value(&self) -> f64 {
        *self
    }
}

impl Number for Dual {
    fn of(value: f64, by: impl Iterator<Item = f64>) -> Self {
        let mut all = [0.0; MAX_NAMES];
        all.iter_mut().zip(by).for_each(|(all, by)| *all = by);
        let depends = all.iter().any(|by| *by != 0.0);
        Self::new(value, Derivative::new(depends.then(|| all.into())))
    }

    fn value(&self) -> f64 {
        self.re
    }
}

/// The derivatives of a dual number.
pub fn derivatives(number: &Dual) -> [f64; MAX_NAMES] {
    number.eps.0.map_or([0.0; MAX_NAMES], Into::into)
}

/// The number without its derivatives, as the library's example has it for step sizes.
pub fn without_derivatives(number: Dual) -> Dual {
    Dual::constant(number.re)
}

/// A mode's equations; rows are over (z, cos theta, sin theta, 1).
pub struct Equations<T> {
    pub mode: Rc<Mode>,
    field: Vec<Vec<T>>,
    guards: Vec<Vec<T>>,
    resets: Vec<Option<Vec<Vec<T>>>>,
    omega: T,
    phi: T,
}

/// A row of numbers from its values and, for each name, their derivatives.
fn row<T: Number>(values: &[f64], by: &[Row]) -> Vec<T> {
    let number = |(n, value): (usize, &f64)| T::of(*value, by.iter().map(|by| by[n]));
    values.iter().enumerate().map(number).collect()
}

fn dot<T: Number>(row: &[T], w: &[T]) -> T {
    row.iter().zip(w).fold(T::zero(), |sum, (a, b)| sum + *a * *b)
}

impl<T: Number> Equations<T> {
    pub fn new(mode: Rc<Mode>, by: &[Rates]) -> Self {
        let each = |of: &dyn Fn(&Rates) -> Row| by.iter().map(of).collect::<Vec<_>>();
        let field = |n| row(&mode.row(n), &each(&|it| it.row(&mode, n)));
        let guard = |n: usize| row(mode.events()[n].guard(), &each(&|it| it.guard_row(&mode, n)));
        let reset = |n: usize| {
            let rows = mode.events()[n].reset.as_ref()?.iter().enumerate();
            let lifted =
                |(i, values): (usize, &Row)| row(values, &each(&|it| it.reset_row(&mode, n, i)));
            Some(rows.map(lifted).collect())
        };
        let events = 0..mode.events().len();
        let (omega, phi) = mode.forcing();
        Self {
            field: (0..mode.wire.c.len()).map(field).collect(),
            guards: events.clone().map(guard).collect(),
            resets: events.map(reset).collect(),
            omega: T::of(omega, by.iter().map(|it| it.omega)),
            phi: T::of(phi, by.iter().map(|it| it.phi)),
            mode,
        }
    }

    fn wide(&self, t: T, z: &[T]) -> Vec<T> {
        let (sin, cos) = (self.omega * t + self.phi).sin_cos();
        z.iter().copied().chain([cos, sin, T::one()]).collect()
    }

    /// The right-hand side.
    pub fn rates(&self, t: T, z: &[T]) -> Vec<T> {
        self.mode.count_call();
        let wide = self.wide(t, z);
        self.field.iter().map(|row| dot(row, &wide)).collect()
    }

    /// The value of a guard.
    pub fn guard(&self, event: usize, t: T, z: &[T]) -> T {
        dot(&self.guards[event], &self.wide(t, z))
    }

    /// The state after an event.
    pub fn reset(&self, event: usize, t: T, z: &[T]) -> Vec<T> {
        let wide = self.wide(t, z);
        let rows = |rows: &Vec<Vec<T>>| rows.iter().map(|row| dot(row, &wide)).collect();
        self.resets[event].as_ref().map_or_else(|| z.to_vec(), rows)
    }
}

impl<T: Number> ODE<T, Vec<T>> for Equations<T> {
    fn diff(&self, t: T, z: &Vec<T>, out: &mut Vec<T>) {
        *out = self.rates(t, z);
    }
}
