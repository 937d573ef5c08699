//! Counts and limits: a library that hangs, diverges or panics yields a row with its reason.
//!
//! A hung thread cannot be killed, so the limits are enforced where the library calls back, in the
//! right-hand side and in the guards: they unwind to [`contain`].

use super::script::ToldCrossings;
use super::trace::{GuardSample, Recorder, Watched};
use super::{Outcome, Work};
use percuss::Phase;
use std::cell::{Cell, OnceCell};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::time::{Duration, Instant};

/// Why a run has no result.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{reason}")]
pub struct Failure {
    /// The reason, in one line.
    pub reason: String,
    /// Whether the run was given up because it took more calls or time than it was allowed.
    pub is_beyond_limits: bool,
}

impl Failure {
    /// A failure for this reason.
    pub fn new(reason: impl std::fmt::Display) -> Self {
        let reason = reason.to_string().split_whitespace().collect::<Vec<_>>().join(" ");
        Self { reason, is_beyond_limits: false }
    }

    /// A run that took, or would take, more than it was allowed.
    pub fn beyond_limits(reason: impl std::fmt::Display) -> Self {
        Self { is_beyond_limits: true, ..Self::new(reason) }
    }
}

/// How much a run may cost.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Right-hand sides, Jacobian products and guards together.
    pub calls: u64,
    /// The events found so far.
    pub events: usize,
    /// The last resort: results must not depend on it.
    pub wall: Duration,
}

impl Default for Limits {
    fn default() -> Self {
        Self { calls: 20_000_000, events: 100_000, wall: Duration::from_secs(120) }
    }
}

/// Counts what a run calls and unwinds when a limit is passed.
pub(super) struct Meter<M = Phase> {
    limits: Limits,
    began: Instant,
    calls: Cell<u64>,
    rhs: Cell<u64>,
    jacobians: Cell<u64>,
    solves: Cell<u64>,
    steps: Cell<u64>,
    recorder: OnceCell<Recorder<M>>,
    /// The times of this run's events, if it is made without the harness's own part.
    told: Option<ToldCrossings>,
}

/// How often the clock is looked at, in calls.
const CLOCK_EVERY: u64 = 4096;

impl<M: Copy> Meter<M> {
    pub(super) fn new(limits: &Limits) -> Self {
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
            told: ToldCrossings::here(),
        }
    }

    /// The times of this run's events, if it is made without the harness's own part
    /// ([`super::script`]).
    pub(super) fn told(&self) -> Option<&ToldCrossings> {
        self.told.as_ref()
    }

    /// Counts a right-hand side whose value is `derivatives`.
    pub(super) fn rhs(&self, derivatives: &[f64]) {
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
    pub(super) fn jacobian(&self) {
        if self.told.is_some() {
            return;
        }
        self.jacobians.set(self.jacobians.get() + 1);
        self.call();
    }

    /// Counts any call.
    pub(super) fn call(&self) {
        if self.told.is_some() {
            return;
        }
        let calls = self.calls.get() + 1;
        self.calls.set(calls);
        if calls > self.limits.calls {
            stop(Failure::beyond_limits(format!("gave up after {} calls", self.limits.calls)));
        }
        if calls.is_multiple_of(CLOCK_EVERY) && self.began.elapsed() > self.limits.wall {
            stop(Failure::beyond_limits(format!("gave up after {} s", self.limits.wall.as_secs())));
        }
    }

    /// Refuses beforehand what would pass the limit, before memory is taken for it.
    pub(super) fn affords(&self, calls: f64) -> Result<(), Failure> {
        if self.calls.get() as f64 + calls <= self.limits.calls as f64 {
            Ok(())
        } else {
            Err(Failure::beyond_limits(format!(
                "gave up after {} right-hand sides: {calls:.0} more would pass the limit of {}",
                self.calls.get(),
                self.limits.calls
            )))
        }
    }

    /// Refuses more events than allowed.
    pub(super) fn events(&self, count: usize) -> Result<(), Failure> {
        if count < self.limits.events {
            Ok(())
        } else {
            Err(Failure::new(format!("gave up after {count} events")))
        }
    }

    /// Counts linear systems that were solved, as the library's statistics tell.
    pub(super) fn solves(&self, count: usize) {
        self.solves.set(self.solves.get() + count as u64);
    }

    /// Counts steps that were accepted.
    pub(super) fn steps(&self, count: u64) {
        self.steps.set(self.steps.get() + count);
    }

    /// Records from now on what a task wants to be seen.
    pub(super) fn watch(&self, watched: &Watched) {
        self.recorder.get_or_init(|| Recorder::new(watched));
    }

    /// Counts an evaluation of a mode's guards, and records it where that is wanted.
    pub(super) fn guards(&self, t: f64, mode: M, guards: &[f64]) {
        self.call();
        if let Some(recorder) = self.recorder.get() {
            for (guard, value) in guards.iter().copied().enumerate() {
                recorder.look(GuardSample { t, mode, guard, value });
            }
        }
    }

    /// Counts an evaluation of one guard, and records it where that is wanted.
    pub(super) fn guard(&self, look: GuardSample<M>) {
        self.call();
        if let Some(recorder) = self.recorder.get() {
            recorder.look(look);
        }
    }

    /// Records the end of an accepted step where that is wanted; [`Self::steps`] counts it.
    pub(super) fn stepped(&self, end: f64) {
        if let Some(recorder) = self.recorder.get() {
            recorder.step(end);
        }
    }

    /// Records that a mode has ended at `t`, inside the last step.
    pub(super) fn phase_ended(&self, t: f64) {
        if let Some(recorder) = self.recorder.get() {
            recorder.back_to(t);
        }
    }

    /// Whether a run that is only watched has come far enough.
    pub(super) fn has_seen_enough(&self, t: f64) -> bool {
        self.recorder.get().is_some_and(|recorder| recorder.is_over(t))
    }

    /// Hands over what was recorded.
    pub(super) fn hand_over<S>(&self, outcome: &mut Outcome<M, S>) {
        if let Some(recorder) = self.recorder.get() {
            recorder.hand_over(outcome);
        }
    }

    /// What was counted.
    pub(super) fn work(&self) -> Work {
        Work {
            rhs_evaluations: self.rhs.get(),
            jacobian_evaluations: self.jacobians.get(),
            linear_solves: self.solves.get(),
            steps: self.steps.get(),
        }
    }
}

/// Unwinds without the panic hook: this is no fault of the program.
fn stop(failure: Failure) -> ! {
    resume_unwind(Box::new(failure))
}

thread_local! {
    static CONTAINED: Cell<bool> = const { Cell::new(false) };
}

/// Keeps the standard panic message quiet for panics that [`contain`] turns into rows.
pub fn hush_contained_panics() {
    let usual = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        if !CONTAINED.get() {
            usual(info);
        }
    }));
}

/// Runs a library's code; its panics and the meter's stops become failures.
///
/// # Errors
/// The run's own failure, the limit it passed, or the panic's message.
pub fn contain<T>(run: impl FnOnce() -> Result<T, Failure>) -> Result<T, Failure> {
    CONTAINED.set(true);
    let result = catch_unwind(AssertUnwindSafe(run));
    CONTAINED.set(false);
    result.unwrap_or_else(|payload| {
        Err(match payload.downcast::<Failure>() {
            Ok(failure) => *failure,
            Err(payload) => {
                let text = payload.downcast_ref::<String>().map(String::as_str);
                let text = text.or_else(|| payload.downcast_ref::<&str>().copied());
                Failure::new(format!("panicked: {}", text.unwrap_or("without a message")))
            }
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_unwind_to_a_failure() {
        let limits = Limits { calls: 10, ..Limits::default() };
        let endless = || -> Result<(), Failure> {
            let meter = Meter::<Phase>::new(&limits);
            loop {
                meter.rhs(&[0.0]);
            }
        };
        assert_eq!(contain(endless), Err(Failure::beyond_limits("gave up after 10 calls")));
    }

    #[test]
    fn a_nan_and_a_panic_are_failures() {
        let limits = Limits::default();
        let not_finite = contain(|| -> Result<(), Failure> {
            Meter::<Phase>::new(&limits).rhs(&[f64::NAN]);
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
