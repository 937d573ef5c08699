//! The run that is judged: its system in both forms, and how far it is followed.

use super::motion::Motion;
use crate::engine::Task;
use crate::system::SystemProblem;
use percuss::affine::{DoubleDouble, Solver, SystemError};
use std::sync::{Arc, OnceLock};

/// A run that answers are asked of.
pub(super) struct JudgedRun {
    pub(super) problem: Arc<SystemProblem>,
    pub(super) motion: Motion,
    pub(super) wide: OnceLock<Result<Solver<DoubleDouble>, SystemError>>,
    /// The time since the start up to which events are judged.
    pub(super) judged_until: f64,
    /// Of a run whose impacts accumulate: the time between impacts below which it is not followed.
    pub(super) shortest: f64,
}

impl JudgedRun {
    pub(super) fn new(problem: &Arc<SystemProblem>, task: &Task) -> Self {
        Self {
            problem: Arc::clone(problem),
            motion: Motion::new(&task.system),
            wide: OnceLock::new(),
            judged_until: task.span,
            shortest: 0.0,
        }
    }

    /// The solver in 106 bits, if the system is one for it.
    pub(super) fn fine(&self) -> Option<&Solver<DoubleDouble>> {
        let solver = || Solver::prepare(&self.problem.exact, self.problem.backward);
        self.wide.get_or_init(solver).as_ref().ok()
    }

    pub(super) fn name(&self, mode: usize, event: usize) -> String {
        self.motion.system().event_name(mode, event).unwrap_or_default().to_owned()
    }

    pub(super) fn mode_name(&self, mode: usize) -> String {
        self.motion.system().modes.get(mode).map(|it| it.name.clone()).unwrap_or_default()
    }
}
