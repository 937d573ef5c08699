//! The functions of the oscillator, or of another system, that diffsol calls.
//!
//! The library is compiled for one type that is either: its solvers are large, and a second copy of
//! them for the sake of one branch a call would take a third longer to compile.

use super::method::DiffsolProblem;
use super::{DenseMatrix, FIRST_STEP};
use crate::equations::Equations;
use crate::failure::Failure;
use crate::integration::{Meter, Oscillator};
use crate::system::AffineEquations;
use diffsol::{OdeBuilder, OdeSolverProblem};
use std::cell::Cell;

/// The equations of the mode that is run, with who counts the calls.
#[derive(Clone, Copy)]
pub(super) struct DiffsolField<'a, E> {
    equations: E,
    mode: &'a Cell<usize>,
    meter: &'a Meter,
}

impl<E: Equations> DiffsolField<'_, E> {
    fn rhs(&self, t: f64, u: &[f64], du: &mut [f64]) {
        self.equations.derivatives(self.mode.get(), t, u, du);
        self.meter.rhs(du);
    }

    fn jacobian_product(&self, w: &[f64], dw: &mut [f64]) {
        self.equations.jacobian_product(self.mode.get(), w, dw);
        self.meter.jacobian();
    }

    fn guards(&self, t: f64, u: &[f64], guards: &mut [f64]) {
        let mode = self.mode.get();
        let values = self.equations.guards(mode, t, u);
        self.meter.guards(t, mode, &values.as_ref()[..self.equations.count(mode)]);
        guards.copy_from_slice(values.as_ref());
    }
}

/// The oscillator, or any other system.
#[derive(Clone, Copy)]
pub(super) enum Field<'a> {
    Oscillator(DiffsolField<'a, Oscillator>),
    System(DiffsolField<'a, AffineEquations<'a>>),
}

/// The equations for which diffsol is compiled.
pub(super) trait DiffsolEquations: Equations {
    /// These equations, with the mode that is run and who counts the calls.
    fn field<'a>(&self, mode: &'a Cell<usize>, meter: &'a Meter) -> Field<'a>
    where
        Self: 'a;
}

impl DiffsolEquations for Oscillator {
    fn field<'a>(&self, mode: &'a Cell<usize>, meter: &'a Meter) -> Field<'a>
    where
        Self: 'a,
    {
        Field::Oscillator(DiffsolField { equations: *self, mode, meter })
    }
}

impl DiffsolEquations for AffineEquations<'_> {
    fn field<'a>(&self, mode: &'a Cell<usize>, meter: &'a Meter) -> Field<'a>
    where
        Self: 'a,
    {
        Field::System(DiffsolField { equations: *self, mode, meter })
    }
}

/// The settings of a diffsol problem.
pub(super) struct ProblemSettings<'a> {
    pub(super) state: &'a [f64],
    pub(super) guards: usize,
    pub(super) period: f64,
    pub(super) tolerance: f64,
}

/// The library's problem.
pub(super) fn problem<'a>(
    field: Field<'a>,
    given: &ProblemSettings<'a>,
) -> Result<OdeSolverProblem<impl DiffsolProblem + 'a>, Failure> {
    let state = given.state;
    OdeBuilder::<DenseMatrix>::new()
        .rtol(given.tolerance)
        .atol([given.tolerance])
        .h0(given.period * FIRST_STEP)
        .rhs_implicit(
            move |u: &[f64], _: &[f64], t, du: &mut [f64]| match field {
                Field::Oscillator(field) => field.rhs(t, u, du),
                Field::System(field) => field.rhs(t, u, du),
            },
            move |_: &[f64], _: &[f64], _, w: &[f64], dw: &mut [f64]| match field {
                Field::Oscillator(field) => field.jacobian_product(w, dw),
                Field::System(field) => field.jacobian_product(w, dw),
            },
        )
        .init(move |_: &[f64], _, u: &mut [f64]| u.copy_from_slice(state), state.len())
        .root(
            move |u: &[f64], _: &[f64], t, guards: &mut [f64]| match field {
                Field::Oscillator(field) => field.guards(t, u, guards),
                Field::System(field) => field.guards(t, u, guards),
            },
            given.guards,
        )
        .build()
        .map_err(Failure::new)
}
