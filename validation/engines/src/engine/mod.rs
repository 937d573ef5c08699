//! Engines: anything that can run a problem and say when its phases begin.
//!
//! Add one by implementing [`Engine`] in a file of its own and naming it in `registry.rs`. An
//! engine takes plain f64 slices, because the libraries disagree about their linear algebra, and is
//! set up the way an expert user of its library would; what that took stands in its module.

mod accuracy;
mod alone;
mod answer;
mod cubic;
mod declaration;
mod differential_equations;
mod diffsol;
mod exact;
mod field;
mod in_lanes;
mod joining;
mod location;
mod meter;
#[cfg(test)]
mod odd_input;
mod ode_solvers;
mod original;
mod pins;
mod registry;
mod sampler;
mod trace;
mod walk;
#[cfg(test)]
mod watching;
mod wrong;

pub use accuracy::{Accuracy, Stepping, shortest_time};
pub use alone::Script;
pub use answer::answer;
pub use declaration::{Colours, Declaration, Location, REFERENCE, Role};
pub use field::{Equations, GUARDS, Oscillator};
pub use in_lanes::run_in_lanes;
pub use meter::{Failure, Limits, contain, hush_contained_panics};
pub use registry::{add, all, exact, select};
pub use trace::{GuardSample, Trace, Watched};
pub use wrong::{CONTROL, Closed, FAULTY_CONTROL, SOUND, Wrong, faulty, wrong};

use crate::case::{Case, Horizon, Problem};
use percuss::TwoWord;
use percuss::insides::angle;
use percuss::{Instant, Parameters, Phase};

/// Instants at which the state is compared: `k / per_period` forcing periods after the start.
#[derive(Clone, Copy, Debug)]
pub struct SampleGrid {
    /// Instants a forcing period.
    pub per_period: u32,
    /// How many, the start included.
    pub count: usize,
}

/// A run to be made.
#[derive(Clone, Debug)]
pub struct Task {
    /// The model's parameters.
    pub parameters: Parameters,
    /// The checked model and start.
    pub problem: Problem,
    /// The phase the start is in.
    pub phase: Phase,
    /// p, y, q and v at the start.
    pub state: [f64; 4],
    /// omega tau + phi at the start, reduced to a few turns: integrators run in the time elapsed
    /// since the start, so that a late start costs them no digits.
    pub forcing_angle: f64,
    /// The instant at which the run ends.
    pub horizon: Instant,
    /// Time from start to horizon.
    pub span: f64,
    /// When the state is compared.
    pub grid: SampleGrid,
    /// Events in the engine's life before this run: a fault may strike every hundredth.
    pub events_before: u64,
    /// What is recorded beside the result; such a run ends when that is done.
    pub watched: Option<Watched>,
}

/// An event as an engine found it: the phase that begins, and the state at that instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// The phase that begins.
    pub phase: Phase,
    /// Time since the start.
    pub elapsed: f64,
    /// p, y, q and v.
    pub state: [f64; 4],
}

/// What a run costs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Right-hand sides; for the exact solver closed-form evaluations.
    pub rhs_evaluations: u64,
    /// Jacobians, or products with one.
    pub jacobian_evaluations: u64,
    /// Linear systems solved, each a forward and a back substitution; none in explicit methods.
    pub linear_solves: u64,
    /// Steps; for the exact solver phases.
    pub steps: u64,
}

/// A run that was made.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// The events in the order in which they were found.
    pub events: Vec<Event>,
    /// The states on the grid.
    pub samples: Vec<[f64; 4]>,
    /// The state at the horizon.
    pub end: [f64; 4],
    /// What it cost.
    pub work: Work,
    /// What was recorded of it, where the task asks for that and the engine can.
    pub trace: Option<Trace>,
}

/// Something that can run a task.
pub trait Engine: Sync {
    /// What it is.
    fn declaration(&self) -> Declaration;

    /// Whether it can run here; the reason if not.
    ///
    /// # Errors
    /// Why it cannot.
    fn available(&self) -> Result<(), String> {
        Ok(())
    }

    /// Right-hand sides that a run takes at the least, as far as that is known beforehand.
    fn least_work(&self, _task: &Task, _accuracy: Accuracy) -> f64 {
        0.0
    }

    /// Runs a task as accurately as asked; what can be asked is its [`Stepping`].
    ///
    /// # Errors
    /// [`Failure`] with the library's reason, or the limit that was passed.
    fn run(&self, task: &Task, accuracy: Accuracy, limits: &Limits) -> Result<Outcome, Failure>;
}

impl Task {
    /// The run that a case asks for.
    #[must_use]
    pub fn of(case: &Case, problem: Problem, grid: SampleGrid) -> Self {
        let horizon = match case.horizon {
            Horizon::Periods(periods) => problem.entry.instant.after_periods(u64::from(periods), 1),
            Horizon::Until(tau) => Instant::at(case.parameters.omega, tau, 0),
        };
        Self::until(case.parameters, problem, horizon, grid)
    }

    /// A run from a start to a horizon.
    #[must_use]
    pub fn until(
        parameters: Parameters,
        problem: Problem,
        horizon: Instant,
        grid: SampleGrid,
    ) -> Self {
        let entry = problem.entry;
        let (_, phi) = angle::reduce(TwoWord::new(parameters.phi));
        Self {
            parameters,
            problem,
            phase: entry.phase(),
            state: [entry.state.p, entry.state.y, entry.state.q, entry.v()],
            forcing_angle: entry.instant.angle_two_word().plus(phi).value(),
            horizon,
            span: horizon.since(&entry.instant, parameters.omega).value(),
            grid,
            events_before: 0,
            watched: None,
        }
    }

    /// The grid's instants, or those that are watched, as times since the start.
    #[must_use]
    pub fn sample_times(&self) -> Vec<f64> {
        if let Some(watched) = &self.watched {
            return watched.instants.iter().map(|time| time.min(self.span)).collect();
        }
        let start = self.problem.entry.instant;
        let instant = |k: usize| start.after_periods(k as u64, u64::from(self.grid.per_period));
        let since = |k: usize| instant(k).since(&start, self.parameters.omega).value();
        (0..self.grid.count).map(since).map(|time| time.min(self.span)).collect()
    }
}
