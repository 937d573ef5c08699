//! diffsol with its own root finding, as an expert user sets it up.
//!
//! - The mode is a `Cell` that the closures read; the problem is built once, the solver anew from
//!   the state at each event, because its limit of 50 failed Newton iterations is cumulative.
//! - On restart the derivative is written afresh and the step chosen anew: a stale derivative makes
//!   the first steps collapse.
//! - Root functions know no direction. A root at which the guard falls, such as the double zero
//!   that begins every separation, is passed over by touching the state; the root finder otherwise
//!   keeps its old bracket. If another guard has risen by the end of that step, the step is taken
//!   back to just after the root.
//! - At a root the library leaves the state at the end of the step: the event's state is its
//!   interpolant there.
//! - Linear solves are from the library's statistics: Newton's iterations, and in the diagonally
//!   implicit methods one more for each estimate of a step's error.
//! - There is no maximum step. In one-step methods each step is shortened to an eighth of a forcing
//!   period, so that none hides a whole phase. A multistep method would begin anew; none is forced
//!   on it. What a root finder that looks only at the ends of steps still misses is what this
//!   harness wants to know.

mod fields;
mod method;
mod mode;

use crate::accuracy::Accuracy;
use crate::engine::{Colours, Declaration, Engine, Limits, Location, Outcome, Task};
use crate::failure::Failure;
use crate::integration::{Integration, Meter, Oscillator, join, longest_of_period};
use crate::integrators::pins;
use diffsol::{NalgebraLU, NalgebraMat, NalgebraVec};
use fields::{DiffsolEquations, ProblemSettings, problem};
use method::{Bdf, DiffsolMethod, Esdirk34, TrBdf2, Tsit45};
use mode::DiffsolRun;
use std::cell::Cell;
use std::marker::PhantomData;

type DenseMatrix = NalgebraMat<f64>;
type Vect = NalgebraVec<f64>;
type Lu = NalgebraLU<f64>;

/// The library with one of its methods.
pub(super) struct Diffsol<M>(PhantomData<M>);

pub(super) static BDF: Diffsol<Bdf> = Diffsol(PhantomData);
pub(super) static TR_BDF2: Diffsol<TrBdf2> = Diffsol(PhantomData);
pub(super) static ESDIRK34: Diffsol<Esdirk34> = Diffsol(PhantomData);
pub(super) static TSIT45: Diffsol<Tsit45> = Diffsol(PhantomData);

/// Blue.
const COLOURS: Colours = Colours::Hues(196.0, 250.0);
/// The first step tried, in forcing periods; the library then chooses by its own rule.
const FIRST_STEP: f64 = 1e-3;

impl<M: DiffsolMethod> Engine for Diffsol<M> {
    fn declaration(&self) -> Declaration {
        Declaration {
            name: M::NAME,
            library: "diffsol",
            version: pins::version("diffsol"),
            method: M::DESCRIPTION,
            class: Some(M::CLASS),
            order: M::ORDER,
            events: Location::Library,
            dense_output: true,
            stepping: M::STEPPING,
            role: M::ROLE,
            colours: COLOURS,
        }
    }

    fn longest_step_on(&self, task: &Task) -> Option<f64> {
        M::IS_ONE_STEP.then(|| longest_of_period(task.system.period()))
    }

    fn run(&self, task: &Task, accuracy: Accuracy, limits: &Limits) -> Result<Outcome, Failure> {
        if let Some(own) = &task.oscillator {
            let integration = Integration::<Oscillator>::new(task, own);
            return run::<M, _>(&integration, accuracy, limits);
        }
        run::<M, _>(&Integration::of_system(task), accuracy, limits)
    }
}

/// Runs an integration with one of the library's methods.
fn run<M: DiffsolMethod, E: DiffsolEquations>(
    integration: &Integration<'_, E>,
    accuracy: Accuracy,
    limits: &Limits,
) -> Result<Outcome, Failure> {
    let tolerance = accuracy.wanted_tolerance()?;
    let meter = Meter::new(limits);
    let Integration { equations, span, times, .. } = *integration;
    let mode = Cell::new(integration.mode);
    let given = ProblemSettings {
        state: integration.state.as_ref(),
        guards: equations.most_guards(),
        period: times.period,
        tolerance,
    };
    let problem = problem(equations.field(&mode, &meter), &given)?;
    let longest = longest_of_period(times.period);
    let run = DiffsolRun { span, longest, meter: &meter, equations };
    join(integration, &meter, |from, sampler| {
        mode.set(from.mode);
        run.one_mode::<M, _>(&problem, from, sampler)
    })
}
