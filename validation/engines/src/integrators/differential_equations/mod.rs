//! differential-equations, whose methods give an interpolant of each step to a `Solout`.
//!
//! - Events are located by the harness on that interpolant ([`StepWatch`]); the library's own event
//!   location is an engine of its own ([`builtin`]).
//! - Each mode is begun by a fresh method, because limits of steps and of rejections count over a
//!   method's life.
//! - Tolerances are vectors, one for each co-ordinate.
//! - Steps are at most an eighth of a forcing period, so that no step hides a whole mode, and,
//!   where states inside a step are integrated anew, an eighth of a turn of the elastic contact.
//!   Limits of steps and rejections are raised: the meter's limit is the one that counts.
//! - Newton iterations are held to what rounding of the displacements allows where the library's
//!   default is a constant, and to its own rule where it has one.
//! - The interpolants of the Verner methods are as good as their steps and are used. The one of
//!   `dop853` has the factors of its higher terms in the wrong order, the one of `bdf` uses
//!   differences that were rescaled to the next step already, and those of `radau5` and
//!   `kvaerno745` are cubic. For these three Runge-Kutta methods the harness integrates again from
//!   the beginning of a step to get a state inside it; for `bdf` it takes Hermite's cubic
//!   ([`method::Inside`]).
//! - Events are located from step ends (`integration/step_ends.rs`), like those of ode_solvers:
//!   guards are evaluated at the ends of steps, and inside only where the ends show a crossing, or
//!   come so near to one that it may lie between them. Evaluating them at eight instants of every
//!   step found no further event, and took more than half of the time of a run; where the method
//!   has to integrate again inside a step it took five times the right-hand sides.
//! - `radau5` chooses its steps from fixed ratios ([`method`]): the library reuses a factorisation
//!   that belongs to another step, which otherwise spoils a step here and there by thousands of
//!   tolerances.
//! - Linear solves are the library's own count: Radau IIA solves a real and a complex system in
//!   each iteration. `bdf` counts none; there each right-hand side but the first is one of Newton's
//!   iterations, which solves one system.
//! - `bdf` chooses a first step below rounding at tight tolerances, and gives up: it is given one.
//!   Its longest step is left open: where that shortens a step the differences are rescaled as if
//!   it had not.

mod builtin;
mod method;
mod state;
mod watch;

use crate::accuracy::Accuracy;
use crate::engine::{Colours, Declaration, Engine, Limits, Location, Outcome, Role, Task};
use crate::equations::Equations;
use crate::failure::Failure;
use crate::integration::{
    Coordinates, Integration, Meter, OriginalOscillator, Oscillator, join, longest_of_period,
};
use crate::integrators::pins;
use differential_equations::error::Error;
use differential_equations::linalg::Matrix;
use differential_equations::ode::{ODE, solve_ode};
use differential_equations::traits::State;
use method::{Bdf, Dop853, Kvaerno745, LibraryMethod, Radau5, Rkv655e, Rkv767e};
use state::of_size;
use std::marker::PhantomData;
use watch::StepWatch;

pub(super) use builtin::BuiltIn;

const LIBRARY: &str = "differential-equations";
/// Green.
const COLOURS: Colours = Colours::Hues(128.0, 172.0);

/// The library with one of its methods, on some equations.
pub(super) struct SteppedLibrary<M, E> {
    name: &'static str,
    role: Role,
    kind: PhantomData<fn() -> (M, E)>,
}

const fn stepped<M, E>(name: &'static str, role: Role) -> SteppedLibrary<M, E> {
    SteppedLibrary { name, role, kind: PhantomData }
}

pub(super) static RKV655E: SteppedLibrary<Rkv655e, Oscillator> =
    stepped("differential-equations-rkv655e", Role::Representative);
pub(super) static RKV655E_ORIGINAL: SteppedLibrary<Rkv655e, OriginalOscillator> =
    stepped("differential-equations-rkv655e-original", Role::Rows);
pub(super) static RKV767E: SteppedLibrary<Rkv767e, Oscillator> =
    stepped("differential-equations-rkv767e", Role::Damping);
pub(super) static DOP853: SteppedLibrary<Dop853, Oscillator> =
    stepped("differential-equations-dop853", Role::Rows);
pub(super) static RADAU5: SteppedLibrary<Radau5, Oscillator> =
    stepped("differential-equations-radau5", Role::Damping);
pub(super) static KVAERNO745: SteppedLibrary<Kvaerno745, Oscillator> =
    stepped("differential-equations-kvaerno745", Role::Rows);
pub(super) static BDF: SteppedLibrary<Bdf, Oscillator> =
    stepped("differential-equations-bdf", Role::Damping);

impl<M: LibraryMethod, E: Coordinates> Engine for SteppedLibrary<M, E> {
    fn declaration(&self) -> Declaration {
        Declaration {
            name: self.name,
            library: LIBRARY,
            version: pins::version(LIBRARY),
            method: M::DESCRIPTION,
            class: Some(M::CLASS),
            order: M::ORDER,
            events: Location::Harness,
            dense_output: true,
            stepping: M::STEPPING,
            role: self.role,
            colours: COLOURS,
        }
    }

    fn longest_step_on(&self, task: &Task) -> Option<f64> {
        (!M::IS_MULTISTEP).then(|| longest_of_period(task.system.period()))
    }

    fn takes(&self, task: &Task) -> Result<(), &'static str> {
        E::describe(task)
    }

    fn run(&self, task: &Task, accuracy: Accuracy, limits: &Limits) -> Result<Outcome, Failure> {
        E::describe(task).map_err(Failure::new)?;
        if let Some(own) = &task.oscillator {
            let integration = Integration::<E>::new(task, own);
            return run::<M, _>(&integration, accuracy, limits);
        }
        let integration = Integration::of_system(task);
        of_size(integration.state.as_ref().len(), || run::<M, _>(&integration, accuracy, limits))
    }
}

/// Runs an integration with one of the library's methods.
fn run<M: LibraryMethod, E: Equations<State: State<f64>>>(
    integration: &Integration<'_, E>,
    accuracy: Accuracy,
    limits: &Limits,
) -> Result<Outcome, Failure> {
    let tolerance = accuracy.wanted_tolerance()?;
    let meter = Meter::new(limits);
    let Integration { equations, span, times, .. } = *integration;
    let longest = M::longest_step(&times);
    // The library begins its multistep method, at order 1, with steps below rounding.
    let first = if M::IS_MULTISTEP { tolerance.sqrt() * times.shortest } else { 0.0 };
    join(integration, &meter, |from, sampler| {
        let field = ModeField { equations, mode: from.mode, meter: &meter };
        let mut watch = StepWatch::<M, E>::new(field, from, (tolerance, span), sampler);
        let mut method = M::method(equations.dimension(), tolerance, longest, first);
        let solved = solve_ode(&mut method, &field, from.t, span, &from.state, &mut watch);
        let solved = solved.map_err(|error| reason(&error));
        watch.ended(solved.map(|it| meter.solves(M::solves(&it.evals))))
    })
}

/// The right-hand side of one mode.
#[derive(Clone, Copy)]
pub(super) struct ModeField<'a, E: Equations> {
    equations: E,
    mode: usize,
    meter: &'a Meter,
}

impl<E: Equations<State: State<f64>>> ODE<f64, E::State> for ModeField<'_, E> {
    fn diff(&self, t: f64, u: &E::State, du: &mut E::State) {
        self.equations.derivatives(self.mode, t, u.as_ref(), du.as_mut());
        self.meter.rhs(du.as_ref());
    }

    fn jacobian(&self, _: f64, u: &E::State, matrix: &mut Matrix<f64>) {
        for column in 0..self.equations.dimension() {
            let [mut direction, mut product] = [u.zeros_like(), u.zeros_like()];
            direction.as_mut()[column] = 1.0;
            self.equations.jacobian_product(self.mode, direction.as_ref(), product.as_mut());
            for (row, entry) in product.as_ref().iter().enumerate() {
                matrix[(row, column)] = *entry;
            }
        }
        self.meter.jacobian();
    }
}

/// The library's error, which it can print only for states that print themselves.
fn reason<S: State<f64>>(error: &Error<f64, S>) -> Failure {
    let text = match error {
        Error::BadInput { msg } => msg.clone(),
        Error::MaxSteps { t, .. } => format!("passed its number of steps at {t}"),
        Error::StepSize { t, .. } => format!("its step became too small at {t}"),
        Error::Stiffness { t, .. } => format!("found the problem stiff at {t}"),
        Error::OutOfBounds { t_interp, .. } => format!("its interpolant has a hole at {t_interp}"),
        Error::LinearAlgebra { t, msg, .. } => format!("{msg} at {t}"),
        _ => "failed".to_owned(),
    };
    Failure::new(text)
}
