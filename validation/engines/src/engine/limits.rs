//! The limits of a run: a library that hangs, diverges or panics yields a row with its reason.

use crate::failure::Failure;
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::time::Duration;

/// The limits beyond which a run is given up.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Right-hand sides, Jacobian products and guards together.
    pub calls: u64,
    /// The largest number of events.
    pub events: usize,
    /// The last resort: results must not depend on it.
    pub wall: Duration,
}

impl Default for Limits {
    fn default() -> Self {
        Self { calls: 20_000_000, events: 100_000, wall: Duration::from_secs(120) }
    }
}

/// Unwinds without the panic hook: this is no fault of the program.
pub(crate) fn stop(failure: Failure) -> ! {
    resume_unwind(Box::new(failure))
}

thread_local! {
    /// Whether a panic on this thread is turned into a failure, and so is not printed.
    static IS_CONTAINED: Cell<bool> = const { Cell::new(false) };
}

/// Keeps the standard panic message quiet for panics that [`contain`] turns into rows.
pub fn hush_contained_panics() {
    let usual = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        if !IS_CONTAINED.get() {
            usual(info);
        }
    }));
}

/// Runs a library's code; its panics and the meter's stops become failures.
///
/// # Errors
/// The run's own failure, the limit it passed, or the panic's message.
pub fn contain<T>(run: impl FnOnce() -> Result<T, Failure>) -> Result<T, Failure> {
    IS_CONTAINED.set(true);
    let result = catch_unwind(AssertUnwindSafe(run));
    IS_CONTAINED.set(false);
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
