//! Counts of what a run calls, held to its limits.
//!
//! A hung thread cannot be killed, so the limits are enforced where the library calls back, in the
//! right-hand side and in the guards: they unwind to [`contain`].
//!
//! [`contain`]: crate::engine::contain

use super::recorder::Recorder;
use super::script::ToldCrossings;
use crate::engine::{GuardSample, Limits, Outcome, Watched, Work, stop};
use crate::failure::Failure;
use std::cell::{Cell, OnceCell};
use std::time::Instant;

/// Counts what a run calls and unwinds when a limit is passed.
pub(crate) struct Meter {
    limits: Limits,
    began: Instant,
    calls: Cell<u64>,
    rhs: Cell<u64>,
    jacobians: Cell<u64>,
    solves: Cell<u64>,
    steps: Cell<u64>,
    recorder: OnceCell<Recorder>,
    /// The times of this run's events, if it is made without the harness's own part.
    told: Option<ToldCrossings>,
}

/// The number of calls between two readings of the clock.
const CALLS_PER_CLOCK_READING: u64 = 4096;

impl Meter {
    pub(crate) fn new(limits: &Limits) -> Self {
        let zero = || Cell::new(0);
        Self {
            limits: *limits,
            began: Instant::now(),
            calls: zero(),
            rhs: zero(),
            jacobians: zero(),
            solves: zero(),
            steps: zero(),
            recorder: OnceCell::new(),
            told: ToldCrossings::of_this_thread(),
        }
    }

    /// The times of this run's events, if it is made without the harness's own part
    /// ([`super::script`]).
    pub(crate) fn scripted_crossings(&self) -> Option<&ToldCrossings> {
        self.told.as_ref()
    }

    /// Counts a right-hand side whose value is `derivatives`.
    pub(crate) fn rhs(&self, derivatives: &[f64]) {
        if self.told.is_some() {
            return;
        }
        self.rhs.set(self.rhs.get() + 1);
        // Some libraries loop for ever on a NaN.
        if derivatives.iter().any(|derivative| !derivative.is_finite()) {
            stop(Failure::new("a right-hand side is not finite"));
        }
        self.call();
    }

    /// Counts a Jacobian product.
    pub(crate) fn jacobian(&self) {
        if self.told.is_some() {
            return;
        }
        self.jacobians.set(self.jacobians.get() + 1);
        self.call();
    }

    /// Counts any call.
    pub(crate) fn call(&self) {
        if self.told.is_some() {
            return;
        }
        let calls = self.calls.get() + 1;
        self.calls.set(calls);
        if calls > self.limits.calls {
            stop(Failure::new(format!("gave up after {} calls", self.limits.calls)));
        }
        if calls.is_multiple_of(CALLS_PER_CLOCK_READING) && self.began.elapsed() > self.limits.wall
        {
            stop(Failure::new(format!("gave up after {} s", self.limits.wall.as_secs())));
        }
    }

    /// Refuses beforehand what would pass the limit, before memory is taken for it.
    pub(crate) fn affords(&self, calls: f64) -> Result<(), Failure> {
        if self.calls.get() as f64 + calls <= self.limits.calls as f64 {
            Ok(())
        } else {
            Err(Failure::new(format!(
                "gave up after {} right-hand sides: {calls:.0} more would pass the limit of {}",
                self.calls.get(),
                self.limits.calls
            )))
        }
    }

    /// Refuses more events than allowed.
    pub(crate) fn events(&self, count: usize) -> Result<(), Failure> {
        if count < self.limits.events {
            Ok(())
        } else {
            Err(Failure::new(format!("gave up after {count} events")))
        }
    }

    /// Counts linear systems that were solved, as the library's statistics tell.
    pub(crate) fn solves(&self, count: usize) {
        self.solves.set(self.solves.get() + count as u64);
    }

    /// Counts steps that were accepted.
    pub(crate) fn steps(&self, count: u64) {
        self.steps.set(self.steps.get() + count);
    }

    /// Records from now on what a task wants to be seen.
    pub(crate) fn watch(&self, watched: &Watched) {
        self.recorder.get_or_init(|| Recorder::new(watched));
    }

    /// Counts an evaluation of a mode's guards, and records it where that is wanted.
    pub(crate) fn guards(&self, t: f64, mode: usize, guards: &[f64]) {
        self.call();
        if let Some(recorder) = self.recorder.get() {
            for (guard, value) in guards.iter().copied().enumerate() {
                recorder.record_evaluation(GuardSample { t, mode, guard, value });
            }
        }
    }

    /// Counts an evaluation of one guard, and records it where that is wanted.
    pub(crate) fn guard(&self, look: GuardSample) {
        self.call();
        if let Some(recorder) = self.recorder.get() {
            recorder.record_evaluation(look);
        }
    }

    /// Records the end of an accepted step where that is wanted; [`Self::steps`] counts it.
    pub(crate) fn record_step(&self, end: f64) {
        if let Some(recorder) = self.recorder.get() {
            recorder.step(end);
        }
    }

    /// Records that a mode has ended at `t`, inside the last step.
    pub(crate) fn phase_ended(&self, t: f64) {
        if let Some(recorder) = self.recorder.get() {
            recorder.back_to(t);
        }
    }

    /// Whether a run that is only watched has come far enough.
    pub(crate) fn has_seen_enough(&self, t: f64) -> bool {
        self.recorder.get().is_some_and(|recorder| recorder.is_over(t))
    }

    /// Moves the recording into the outcome.
    pub(crate) fn hand_over(&self, outcome: &mut Outcome) {
        if let Some(recorder) = self.recorder.get() {
            recorder.hand_over(outcome);
        }
    }

    /// The counted work so far.
    pub(crate) fn work(&self) -> Work {
        Work {
            rhs_evaluations: self.rhs.get(),
            jacobian_evaluations: self.jacobians.get(),
            linear_solves: self.solves.get(),
            steps: self.steps.get(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::contain;

    #[test]
    fn limits_unwind_to_a_failure() {
        let limits = Limits { calls: 10, ..Limits::default() };
        let endless = || -> Result<(), Failure> {
            let meter = Meter::new(&limits);
            loop {
                meter.rhs(&[0.0]);
            }
        };
        assert_eq!(contain(endless), Err(Failure::new("gave up after 10 calls")));
    }

    #[test]
    fn a_nan_and_a_panic_are_failures() {
        let limits = Limits::default();
        let not_finite = contain(|| -> Result<(), Failure> {
            Meter::new(&limits).rhs(&[f64::NAN]);
            Ok(())
        });
        assert_eq!(not_finite, Err(Failure::new("a right-hand side is not finite")));
        let empty: Vec<f64> = Vec::new();
        let panicked = contain(|| Ok(empty[0]));
        assert!(
            panicked
                .is_err_and(|failure| failure.reason.starts_with("panicked: index out of bounds"))
        );
    }
}
