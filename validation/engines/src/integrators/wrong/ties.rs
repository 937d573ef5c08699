//! The exact solver with the events of one instant in the wrong order: the file's last comes first.

use crate::accuracy::Accuracy;
use crate::engine::{Declaration, Engine, Limits, Outcome, Role, Task};
use crate::failure::Failure;
use crate::integrators::exact::Exact;
use crate::system::SystemProblem;
use std::sync::Arc;

pub(super) struct LastFirst {
    pub(super) name: &'static str,
}

impl Engine for LastFirst {
    fn declaration(&self) -> Declaration {
        let method = "wrong on purpose";
        Declaration { name: self.name, method, role: Role::Rows, ..Exact.declaration() }
    }

    fn run(&self, task: &Task, accuracy: Accuracy, limits: &Limits) -> Result<Outcome, Failure> {
        let lacking = || Failure::new("the system's exact coefficients are not there");
        let problem = task.exact.as_ref().ok_or_else(lacking)?;
        let mut turned = problem.exact.clone();
        turned.modes.iter_mut().for_each(|mode| mode.until.reverse());
        let turned = Arc::new(SystemProblem::new(turned, problem.backward)?);
        let task = Task { exact: Some(turned), ..task.clone() };
        let mut outcome = Exact.run(&task, accuracy, limits)?;
        let mut mode = task.mode;
        for event in &mut outcome.events {
            let ends = problem.exact.modes[mode].until.len();
            if event.event < ends {
                event.event = ends - 1 - event.event;
            }
            mode = event.mode;
        }
        Ok(outcome)
    }
}
