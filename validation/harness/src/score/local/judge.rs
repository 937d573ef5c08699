//! The judge of one case's runs.

use super::continuation::Place;
use super::judgement::{Allowance, LocalJudgement};
use super::run::JudgedRun;
use super::samples::Sampled;
use super::units::Units;
use super::walk::{Samples, Walk};
use crate::engine::{Outcome, Task};
use crate::system::SystemProblem;
use percuss::affine::SystemError;
use std::sync::Arc;

/// Judges the answers of engines on one case.
pub struct LocalJudge(JudgedRun);

impl LocalJudge {
    /// A judge of the answers to a task, which is that of a problem, up to its horizon.
    #[must_use]
    pub fn new(problem: &Arc<SystemProblem>, task: &Task) -> Self {
        Self(JudgedRun::new(problem, task))
    }

    /// Judges a run whose impacts accumulate up to a time, and as far as the times between them are
    /// longer than `shortest`: an engine's own impacts accumulate at another time, so that no time
    /// alone says where to end.
    #[must_use]
    pub fn down_to(self, judged_until: f64, shortest: f64) -> Self {
        Self(JudgedRun { judged_until, shortest, ..self.0 })
    }

    /// Judges an answer to the task.
    ///
    /// # Errors
    /// A start that the exact solver does not take.
    pub fn judge(
        &self,
        task: &Task,
        outcome: &Outcome,
        allowance: Allowance,
    ) -> Result<LocalJudgement, SystemError> {
        let mut walk = self.walk(task, outcome, allowance)?;
        let mut accumulates = false;
        for (n, event) in outcome.events.iter().enumerate() {
            let duration = event.elapsed - walk.place.elapsed;
            accumulates = duration < self.0.shortest && walk.has_next_within(self.0.shortest);
            if accumulates || event.elapsed > self.0.judged_until {
                break;
            }
            walk.record(n, event);
        }
        if !accumulates {
            walk.end(outcome);
        }
        let to_its_end = !accumulates && outcome.ended_at <= self.0.judged_until;
        let sampled = Sampled { task, outcome, to_its_end };
        super::samples::judge(&walk.units, &self.0.problem, &sampled, &mut walk.found);
        Ok(walk.found)
    }

    /// The number of an answer's events that are judged: of impacts that accumulate, those that are
    /// far enough apart.
    #[must_use]
    pub fn judged(&self, outcome: &Outcome) -> usize {
        let JudgedRun { judged_until, shortest, .. } = self.0;
        let mut before = 0.0;
        let mut is_judged = |elapsed: f64| {
            let duration = elapsed - std::mem::replace(&mut before, elapsed);
            elapsed <= judged_until && duration >= shortest
        };
        outcome.events.iter().take_while(|it| is_judged(it.elapsed)).count()
    }

    /// The states at instants since the start, by the exact flow from the last record of an answer
    /// before each, in f64. The instant of a record has the state before it, as samples have.
    #[must_use]
    pub fn continued_states(
        &self,
        task: &Task,
        outcome: &Outcome,
        instants: &[f64],
    ) -> Vec<Vec<f64>> {
        let state = |t: &f64| {
            let records = outcome.events.partition_point(|event| event.elapsed < *t);
            let last = records.checked_sub(1).map(|n| &outcome.events[n]);
            let (mode, elapsed, state) = last.map_or((task.mode, 0.0, &task.state[..]), |event| {
                (event.mode, event.elapsed, &event.state[..])
            });
            self.0.motion.flow(mode, elapsed, state, t - elapsed)
        };
        instants.iter().map(state).collect()
    }

    /// A walk at the start.
    fn walk<'a>(
        &'a self,
        task: &'a Task,
        outcome: &'a Outcome,
        allowance: Allowance,
    ) -> Result<Walk<'a>, SystemError> {
        let mut coarse = self.0.problem.solver.follow(&self.0.problem.start)?;
        let mut place = Place {
            elapsed: 0.0,
            mode: task.mode,
            state: task.state.to_vec(),
            late: 0,
            begins: true,
        };
        // A guard that is zero to rounding at the start is zero there.
        coarse.impose(self.0.guards_at_rounding(&place));
        place.state = self.0.projected(&mut coarse, &place);
        Ok(Walk {
            judge: &self.0,
            units: Units { motion: &self.0.motion, allowance },
            coarse,
            fine: None,
            place,
            told_until: 0.0,
            answer: Samples { times: &task.samples, states: &outcome.samples },
            pending: Vec::new(),
            stays: false,
            at_once: 0,
            found: LocalJudgement::default(),
        })
    }
}
