//! The rows of a run as an iterator: a thread makes them, a few ahead, and none is kept.

use crate::asked::{Asked, Shared};
use crate::collect::{End, Kept};
use crate::failure::value;
use crate::threads::on_this_thread;
use numpy::PyArray1;
use percuss::{Proved, SystemError};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::{Bound, PyResult, Python, pyclass, pymethods};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// The number of rows that are made ahead at most.
const MAX_ROWS_AHEAD: usize = 256;

/// The time between two looks at Python's signals.
const SIGNAL_INTERVAL: Duration = Duration::from_millis(50);

enum Message {
    Row(Kept<Proved>),
    End(End),
    Failed(String),
}

/// The rows of a run, one after the other.
#[pyclass(frozen, module = "percuss._percuss")]
pub(crate) struct Stream {
    rows: Mutex<Receiver<Message>>,
    end: Mutex<Option<End>>,
    shared: Arc<Shared>,
    digits: usize,
}

/// A row of a run.
#[pyclass(frozen, module = "percuss._percuss")]
pub(crate) struct Row {
    row: Kept<Proved>,
    shared: Arc<Shared>,
    digits: usize,
}

/// Why the thread makes no more rows.
enum Over {
    System(SystemError),
    /// No one waits for the rest.
    Left,
}

impl From<SystemError> for Over {
    fn from(error: SystemError) -> Self {
        Self::System(error)
    }
}

fn run(shared: &Shared, asked: &Asked, rows: &SyncSender<Message>) {
    let end =
        shared.proved(asked, &[], &mut |row| rows.send(Message::Row(row)).map_err(|_| Over::Left));
    let last = match end {
        Ok(end) => Message::End(end),
        Err(Over::System(error)) => Message::Failed(error.to_string()),
        Err(Over::Left) => return,
    };
    // Where no one waits no one misses it.
    drop(rows.send(last));
}

impl Stream {
    pub(crate) fn start(shared: Arc<Shared>, asked: Asked, digits: usize) -> PyResult<Self> {
        let (sender, receiver) = sync_channel(MAX_ROWS_AHEAD);
        let own = Arc::clone(&shared);
        let thread = std::thread::Builder::new().name("percuss-run".to_owned());
        thread.spawn(move || on_this_thread(|| run(&own, &asked, &sender)))?;
        let (rows, end) = (Mutex::new(receiver), Mutex::new(None));
        Ok(Self { rows, end, shared, digits })
    }

    /// The next message; none where the run is over.
    fn message(&self) -> PyResult<Option<Message>> {
        loop {
            let rows = self.rows.lock();
            let rows = rows.map_err(|_| PyRuntimeError::new_err("the run was given up"))?;
            match rows.recv_timeout(SIGNAL_INTERVAL) {
                Ok(message) => return Ok(Some(message)),
                Err(RecvTimeoutError::Disconnected) => return Ok(None),
                Err(RecvTimeoutError::Timeout) => {}
            }
            drop(rows);
            Python::attach(|py| py.check_signals())?;
        }
    }

    fn ended(&self) -> Option<End> {
        self.end.lock().ok().and_then(|it| it.clone())
    }
}

#[pymethods]
impl Stream {
    fn __iter__(slf: pyo3::PyRef<'_, Self>) -> pyo3::PyRef<'_, Self> {
        slf
    }

    fn __next__(&self, py: Python<'_>) -> PyResult<Option<Row>> {
        match py.detach(|| self.message())? {
            Some(Message::Row(row)) => {
                Ok(Some(Row { row, shared: Arc::clone(&self.shared), digits: self.digits }))
            }
            Some(Message::End(end)) => {
                if let Ok(mut own) = self.end.lock() {
                    *own = Some(end);
                }
                Ok(None)
            }
            Some(Message::Failed(error)) => Err(value(error)),
            None => Ok(None),
        }
    }

    /// The name of the ending, once the run has come to it.
    #[getter]
    fn ending(&self) -> Option<String> {
        self.ended()?.name
    }

    #[getter]
    fn cause(&self) -> Option<String> {
        self.ended()?.cause
    }
}

#[pymethods]
impl Row {
    #[getter]
    fn time(&self) -> f64 {
        self.row.time.midpoint()
    }

    #[getter]
    fn state<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_vec(py, self.row.state.iter().map(Proved::midpoint).collect())
    }

    #[getter]
    fn mode(&self) -> &str {
        &self.shared.system.modes[self.row.mode].name
    }

    #[getter]
    fn name(&self) -> &str {
        &self.row.name
    }

    /// The proved digits of the time, then those of each state.
    #[getter]
    fn digits(&self) -> (String, Vec<String>) {
        let digits = |it: &Proved| it.to_digits(self.digits);
        (digits(&self.row.time), self.row.state.iter().map(digits).collect())
    }

    fn __repr__(&self) -> String {
        let name = if self.row.name.is_empty() { "start" } else { &self.row.name };
        format!("Event({name:?}, time={})", self.row.time.to_digits(self.digits))
    }
}
