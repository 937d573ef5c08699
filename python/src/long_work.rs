//! Long work: done without Python's lock, and ended by Ctrl-C.

use pyo3::prelude::{PyResult, Python};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant};

/// The time between two looks at Python's signals.
const BETWEEN_LOOKS: Duration = Duration::from_millis(50);

/// The number of steps between two looks at the clock.
const STEPS: u32 = 16;

/// Looks at Python's signals now and then, from the thread that was called from Python.
pub(crate) struct Patience {
    last: Instant,
    steps: u32,
}

impl Patience {
    pub(crate) fn new() -> Self {
        Self { last: Instant::now(), steps: 0 }
    }

    /// A step of the work is done.
    pub(crate) fn step(&mut self) -> PyResult<()> {
        self.steps += 1;
        if self.steps < STEPS {
            return Ok(());
        }
        self.steps = 0;
        if self.last.elapsed() < BETWEEN_LOOKS {
            return Ok(());
        }
        self.last = Instant::now();
        Python::attach(|py| py.check_signals())
    }
}

/// The payload that unwinds the threads of work that is to end.
struct Interrupted;

/// Work that is told of each of its parts, and ends there where Ctrl-C was pressed.
pub(crate) struct Stop<'a>(&'a AtomicBool);

impl Stop<'_> {
    /// A part of the work is done.
    pub(crate) fn look(&self) {
        if self.0.load(Ordering::Relaxed) {
            // Without the message of a panic: this is no fault of the program.
            resume_unwind(Box::new(Interrupted));
        }
    }
}

/// Does work on threads of its own while this one, which alone hears of signals, waits for it.
pub(crate) fn interruptible<T: Send>(
    py: Python<'_>,
    work: impl FnOnce(&Stop<'_>) -> T + Send,
) -> PyResult<T> {
    let stop = AtomicBool::new(false);
    let done = py.detach(|| {
        let (sender, receiver) = channel();
        std::thread::scope(|scope| {
            scope.spawn(|| {
                let result = catch_unwind(AssertUnwindSafe(|| work(&Stop(&stop))));
                // The receiver is there until the scope ends.
                drop(sender.send(result));
            });
            loop {
                match receiver.recv_timeout(BETWEEN_LOOKS) {
                    Ok(result) => return Ok(result),
                    Err(RecvTimeoutError::Disconnected) => {
                        return Ok(Err(Box::new(Interrupted) as _));
                    }
                    Err(RecvTimeoutError::Timeout) => {}
                }
                if let Err(interrupt) = Python::attach(|py| py.check_signals()) {
                    stop.store(true, Ordering::Relaxed);
                    return Err(interrupt);
                }
            }
        })
    })?;
    done.map_err(|payload| {
        if payload.is::<Interrupted>() {
            pyo3::exceptions::PyKeyboardInterrupt::new_err(())
        } else {
            let text = payload.downcast_ref::<String>().map(String::as_str);
            let text = text.or_else(|| payload.downcast_ref::<&str>().copied());
            let text = text.unwrap_or("without a message").to_owned();
            pyo3::exceptions::PyRuntimeError::new_err(format!("a fault of percuss: {text}"))
        }
    })
}
