//! A run of a system, as engines are asked for it.

use super::{OscillatorTask, Watched};
use crate::accuracy::shortest_time;
use crate::equations::Numbers;
use crate::failure::Failure;
use crate::system::{CheckedSystem, CoefficientDerivatives, SystemProblem, Values};
use std::sync::Arc;

/// A run of a system that is to be made.
#[derive(Clone, Debug)]
pub struct Task {
    /// The system, checked; its forcing angle is that at the start.
    pub system: Arc<CheckedSystem>,
    /// The mode at the start.
    pub mode: usize,
    /// The state at the start.
    pub state: Values,
    /// Time from the start to the horizon.
    pub span: f64,
    /// The instants at which the state is compared, since the start, in ascending order.
    pub samples: Vec<f64>,
    /// The recording that is wanted beside the result; such a run ends when the recording is
    /// complete.
    pub watched: Option<Watched>,
    /// The system with exact coefficients, which the exact solver wants to have.
    pub exact: Option<Arc<SystemProblem>>,
    /// The run in the words of the oscillator, where that is the system: an engine that has the
    /// oscillator's equations written by hand may take them instead of the system's matrices.
    pub oscillator: Option<Arc<OscillatorTask>>,
    /// The names by which derivatives are asked for, with those of the coefficients.
    pub gradients: Option<Arc<Vec<CoefficientDerivatives>>>,
}

impl Task {
    /// A run from a state in a mode over a time, with the state taken at `samples`.
    ///
    /// # Errors
    /// What the system does not have, or cannot begin with.
    pub fn new(
        system: Arc<CheckedSystem>,
        mode: usize,
        state: &[f64],
        span: f64,
        samples: Vec<f64>,
    ) -> Result<Self, Failure> {
        let (size, modes) = (system.system().states.len(), system.system().modes.len());
        if mode >= modes {
            return Err(Failure::new(format!(
                "there are {modes} modes, and none is number {mode}"
            )));
        }
        if state.len() != size || state.iter().any(|value| !value.is_finite()) {
            return Err(Failure::new(format!("a start has {size} states, all of them finite")));
        }
        if !(span.is_finite() && span > 0.0 && samples.is_sorted()) {
            return Err(Failure::new("a run takes a positive time, with samples in order"));
        }
        let state = Values::from_slice(state);
        Ok(Self {
            system,
            mode,
            state,
            span,
            samples,
            watched: None,
            exact: None,
            oscillator: None,
            gradients: None,
        })
    }

    /// The run of a problem over a time.
    ///
    /// # Errors
    /// Fails as [`Task::new`] does.
    pub fn from_problem(
        problem: &Arc<SystemProblem>,
        span: f64,
        samples: Vec<f64>,
    ) -> Result<Self, Failure> {
        let system = Arc::clone(&problem.checked);
        let task = Self::new(system, problem.start.mode, &problem.state(), span, samples)?;
        Ok(Self { exact: Some(Arc::clone(problem)), ..task })
    }

    /// The instants at which the state is taken: those that are watched, or those of the task.
    #[must_use]
    pub fn instants(&self) -> &[f64] {
        self.watched.as_ref().map_or(&self.samples, |watched| &watched.instants)
    }

    /// The run in the words of the oscillator, for engines that run nothing else.
    ///
    /// # Errors
    /// The system is another one.
    pub fn of_the_oscillator(&self) -> Result<&OscillatorTask, Failure> {
        let own = self.oscillator.as_deref();
        own.ok_or_else(|| Failure::new("runs the oscillator alone"))
    }

    /// The unit of an engine's fixed steps: the shortest of the times in which the system changes.
    #[must_use]
    pub fn shortest_time(&self) -> f64 {
        let own = self.oscillator.as_ref().map(|task| shortest_time(&task.parameters));
        own.unwrap_or_else(|| self.system.shortest_time())
    }
}
