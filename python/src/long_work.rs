//! Long work: done without Python's lock, ended by Ctrl-C, and told as it goes on.

use crate::threads::{on_all_threads, without_lock};
use pyo3::PyErr;
use pyo3::prelude::{Py, PyAny, PyResult, Python};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The time between two looks at Python's signals.
const SIGNAL_INTERVAL: Duration = Duration::from_millis(50);

/// The number of steps between two looks at the clock.
const STEPS_PER_CLOCK_READING: u32 = 16;

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
        if self.steps < STEPS_PER_CLOCK_READING {
            return Ok(());
        }
        self.steps = 0;
        if self.last.elapsed() < SIGNAL_INTERVAL {
            return Ok(());
        }
        self.last = Instant::now();
        Python::attach(|py| py.check_signals())
    }
}

/// The payload that unwinds the threads of work that is to end.
struct Interrupted;

/// Work that is told of each of its parts, and ends there where Ctrl-C was pressed.
pub(crate) struct Stop<'a> {
    is_asked: &'a AtomicBool,
    done: &'a AtomicU64,
    /// A watch on Python's signals, where the work is done by the thread that may look at them.
    here: Option<&'a Here<'a>>,
}

/// Looks at Python's signals from within the work, and keeps what they raise.
struct Here<'a> {
    progress: &'a Progress,
    last: Mutex<Instant>,
    raised: Mutex<Option<PyErr>>,
}

impl Here<'_> {
    /// Whether the work is to go on, of which so many parts are done.
    fn goes_on(&self, done: u64) -> bool {
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        if last.elapsed() < SIGNAL_INTERVAL {
            return true;
        }
        let told = Python::attach(|py| {
            py.check_signals()?;
            self.progress.tell(py, done)
        });
        *last = Instant::now();
        let raised = told.err();
        let goes_on = raised.is_none();
        *self.raised.lock().unwrap_or_else(PoisonError::into_inner) = raised;
        goes_on
    }
}

impl Stop<'_> {
    /// A part of the work is done that is none of those that are counted.
    pub(crate) fn look(&self) {
        if let Some(here) = self.here
            && !here.goes_on(self.done.load(Ordering::Relaxed))
        {
            self.is_asked.store(true, Ordering::Relaxed);
        }
        if self.is_asked.load(Ordering::Relaxed) {
            // Without the message of a panic: this is no fault of the program.
            resume_unwind(Box::new(Interrupted));
        }
    }

    /// So many more of the counted parts are done.
    pub(crate) fn passed(&self, count: u64) {
        self.done.fetch_add(count, Ordering::Relaxed);
        self.look();
    }

    /// So many of the counted parts are done by now.
    pub(crate) fn reached(&self, count: u64) {
        self.done.store(count, Ordering::Relaxed);
        self.look();
    }

    /// This share of work in [`WORK_PARTS`] parts is done by now.
    pub(crate) fn share(&self, share: f64) {
        self.reached((share * WORK_PARTS as f64) as u64);
    }
}

/// The number of parts of work that has no parts of its own.
pub(crate) const WORK_PARTS: u64 = 1000;

/// A function of Python that is told how many of all parts are done, if there is one.
#[derive(Default)]
pub(crate) struct Progress {
    pub(crate) told: Option<Py<PyAny>>,
    pub(crate) all: u64,
}

impl Progress {
    fn tell(&self, py: Python<'_>, done: u64) -> PyResult<()> {
        match &self.told {
            Some(told) => told.call1(py, (done.min(self.all), self.all)).map(drop),
            None => Ok(()),
        }
    }
}

/// Does work on threads of its own while this one, which alone hears of signals, waits for it.
pub(crate) fn interruptible<T: Send>(
    py: Python<'_>,
    progress: &Progress,
    work: impl FnOnce(&Stop<'_>) -> T + Send,
) -> PyResult<T> {
    let (stop, parts) = (AtomicBool::new(false), AtomicU64::new(0));
    let done = py.detach(|| {
        let (sender, receiver) = channel();
        std::thread::scope(|scope| {
            scope.spawn(|| {
                let result = catch_unwind(AssertUnwindSafe(|| {
                    on_all_threads(|| work(&Stop { is_asked: &stop, done: &parts, here: None }))
                }));
                // The receiver is there until the scope ends.
                drop(sender.send(result));
            });
            loop {
                match receiver.recv_timeout(SIGNAL_INTERVAL) {
                    Ok(result) => return Ok(result),
                    Err(RecvTimeoutError::Disconnected) => {
                        return Ok(Err(Box::new(Interrupted) as _));
                    }
                    Err(RecvTimeoutError::Timeout) => {}
                }
                let told = Python::attach(|py| {
                    py.check_signals()?;
                    progress.tell(py, parts.load(Ordering::Relaxed))
                });
                if let Err(interrupt) = told {
                    stop.store(true, Ordering::Relaxed);
                    return Err(interrupt);
                }
            }
        })
    })?;
    finished(py, progress, done)
}

/// Does work that has no threads of its own on this one, which looks at the signals after each part
/// of it: a thread that waited would take longer to start than a short call takes.
pub(crate) fn attended<T: Send>(
    py: Python<'_>,
    progress: &Progress,
    work: impl FnOnce(&Stop<'_>) -> T + Send,
) -> PyResult<T> {
    let (stop, parts) = (AtomicBool::new(false), AtomicU64::new(0));
    let (last, raised) = (Mutex::new(Instant::now()), Mutex::new(None));
    let here = Here { progress, last, raised };
    let done = without_lock(py, || {
        let told = Stop { is_asked: &stop, done: &parts, here: Some(&here) };
        catch_unwind(AssertUnwindSafe(|| work(&told)))
    });
    match here.raised.into_inner().unwrap_or_else(PoisonError::into_inner) {
        Some(raised) => Err(raised),
        None => finished(py, progress, done),
    }
}

/// The result of work, or the exception for what has unwound it.
fn finished<T>(
    py: Python<'_>,
    progress: &Progress,
    done: Result<T, Box<dyn Any + Send>>,
) -> PyResult<T> {
    if done.is_ok() {
        progress.tell(py, progress.all)?;
    }
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
