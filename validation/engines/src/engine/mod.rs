//! The interface of an engine: anything that can run a piecewise-affine system and report its
//! events.
//!
//! The module holds the trait, the task of an engine ([`Task`]), its answer ([`Outcome`]), and
//! its declaration ([`Declaration`]).
//!
//! Add one by implementing [`Engine`] in a file of its own in the room `integrators` and naming it
//! in that room's `registry.rs`. An engine takes plain f64 slices, because the libraries disagree
//! about their linear algebra, and is set up the way an expert user of its library would; what that
//! took stands in its module.

mod answer;
mod declaration;
mod derivatives;
mod limits;
mod oscillator_task;
mod percussive;
mod task;
mod trace;

pub use crate::accuracy::{Accuracy, Stepping, SteppingKind, shortest_time};
pub use crate::case::place;
pub use crate::equations::{Entered, Equations, Numbers};
pub use crate::failure::Failure;
pub use answer::{answer, least_work};
pub use declaration::{Class, Colours, Declaration, Location, REFERENCE, Role};
pub use derivatives::{EventDerivatives, RunDerivatives};
pub(crate) use limits::stop;
pub use limits::{Limits, contain, hush_contained_panics};
pub use oscillator_task::{OscillatorTask, SampleGrid};
pub use percussive::percussive;
pub use task::Task;
pub use trace::{GuardSample, Trace, Watched};

use crate::system::Values;
pub use percuss::Ending;
use std::time::Duration;

/// An event as an engine found it. A mode is a place among the system's modes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// The place of the event among those of its mode: those that end the mode come first, then
    /// those that are only counted, in the order in which the system names them.
    pub event: usize,
    /// The mode that begins; for an event that ends no mode, the mode that goes on.
    pub mode: usize,
    /// Time since the start.
    pub elapsed: f64,
    /// The state as the mode begins.
    pub state: Values,
    /// The state just before the event, which no reset has touched: the guard's value there says
    /// how well the event was located. None where the engine does not tell it.
    pub before: Option<Values>,
}

/// The counted work of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Right-hand sides; for the exact solver closed-form evaluations.
    pub rhs_evaluations: u64,
    /// Evaluations of the Jacobian, or of products with the Jacobian.
    pub jacobian_evaluations: u64,
    /// Linear systems solved, each a forward and a back substitution; none in explicit methods.
    pub linear_solves: u64,
    /// Steps; for the exact solver phases.
    pub steps: u64,
}

/// The result of a run.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// The events in the order of their times.
    pub events: Vec<Event>,
    /// The states on the grid; none where the engine gives events only, whose row is never wholly
    /// right.
    pub samples: Vec<Values>,
    /// The state at the run's end.
    pub end: Values,
    /// The ending of the run.
    pub ended: Ending,
    /// The time at which the run ended, since the start.
    pub ended_at: f64,
    /// The counted work of the run.
    pub work: Work,
    /// The time that the integrator itself reports, where it runs in a program of its own: the rest
    /// of the run's time went into starting that program and speaking with it.
    pub own_time: Option<Duration>,
    /// The recording of the run, where the task asks for one and the engine can record.
    pub trace: Option<Trace>,
    /// The derivatives by each name that the task asks for, in its order, where the engine has
    /// them; none at all where it has none.
    pub gradients: Vec<Option<RunDerivatives>>,
}

/// Something that can run a system with modes from a start to a horizon.
pub trait Engine: Sync {
    /// The engine's declaration.
    fn declaration(&self) -> Declaration;

    /// The language that its library is written in, with its version where it is not Rust.
    fn language(&self) -> &str {
        "Rust"
    }

    /// Whether the engine can run on this machine; the reason if not.
    ///
    /// # Errors
    /// Why it cannot.
    fn available(&self) -> Result<(), String> {
        Ok(())
    }

    /// Whether the engine can run the system of a task.
    ///
    /// # Errors
    /// Why it does not, as a row without a result says it.
    fn takes(&self, _task: &Task) -> Result<(), &'static str> {
        Ok(())
    }

    /// Whether the engine answers derivatives through events where a task asks for them.
    fn differentiates(&self) -> bool {
        false
    }

    /// Whether its derivatives are differences of whole runs, over a step that may be too large.
    fn takes_differences(&self) -> bool {
        false
    }

    /// The longest step of a run, where the engine does not leave that to its library.
    fn longest_step_on(&self, _task: &Task) -> Option<f64> {
        None
    }

    /// Right-hand sides that a run takes at the least, as far as that is known beforehand and does
    /// not follow from [`Declaration::is_slowed_by_stiffness`] and [`Engine::longest_step_on`].
    fn least_work(&self, _task: &Task, _accuracy: Accuracy) -> f64 {
        0.0
    }

    /// Runs a task as accurately as asked; what can be asked is its [`Stepping`].
    ///
    /// # Errors
    /// [`Failure`] with the library's reason, the limit that was passed, or why the engine cannot.
    fn run(&self, task: &Task, accuracy: Accuracy, limits: &Limits) -> Result<Outcome, Failure>;
}
