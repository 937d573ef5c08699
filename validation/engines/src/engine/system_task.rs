//! A run of any system, and what comes of it.

use super::joining::{Course, Times};
use super::{Event, Outcome, Watched};
use crate::system::{Affine, CheckedSystem, Values};
use std::sync::Arc;

/// An event of a system; its mode is the place of the mode in the system.
pub type SystemEvent = Event<usize, Values>;

/// A run of a system that was made.
pub type SystemOutcome = Outcome<usize, Values>;

/// A run of a system that is to be made.
#[derive(Clone, Debug)]
pub struct SystemTask {
    /// The system, checked; its forcing angle is that at the start.
    pub system: Arc<CheckedSystem>,
    /// The mode at the start.
    pub mode: usize,
    /// The state at the start.
    pub state: Values,
    /// Time from the start to the horizon.
    pub span: f64,
    /// When the state is compared, in times since the start and in ascending order.
    pub samples: Vec<f64>,
    /// What is recorded beside the result; such a run ends when that is done.
    pub watched: Option<Watched>,
}

impl<'a> Course<'a, Affine<'a>> {
    /// The course of the system that a task asks for.
    pub(super) fn of_system(task: &'a SystemTask) -> Self {
        let system = &*task.system;
        let instants = task.watched.as_ref().map_or(&task.samples, |watched| &watched.instants);
        Self {
            equations: Affine::of(system),
            mode: task.mode,
            state: task.state,
            span: task.span,
            samples: instants.iter().map(|time| time.min(task.span)).collect(),
            times: Times {
                period: system.period(),
                turn: system.turn(),
                shortest: system.shortest_time(),
            },
            watched: task.watched.as_ref(),
        }
    }
}
