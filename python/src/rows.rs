//! The rows of a run, as arrays and as digits.

use crate::arrays::{Nearest, table};
use crate::asked::{Asked, Shared, all};
use crate::collect::{End, Kept};
use crate::derivatives::{DerivativeDigits, Derivatives, derivatives, digits};
use crate::failure::value;
use crate::long_work::Patience;
use crate::motion::{Motion, beginning};
use crate::threads::without_lock;
use numpy::{PyArray1, PyArray2, PyReadonlyArray1};
use percuss::Proved;
use pyo3::prelude::{Bound, PyResult, Python, pyclass, pymethods};
use std::sync::{Arc, OnceLock};

/// The rows of a run: the start, each event, and the ending.
#[pyclass(frozen, module = "percuss._percuss")]
pub(crate) struct Rows {
    shared: Arc<Shared>,
    numbers: Numbers,
    end: End,
    asked: Asked,
    motion: OnceLock<Motion>,
}

/// Rows of one kind of numbers.
pub(crate) enum Numbers {
    Proved(Vec<Kept<Proved>>),
    Plain(Vec<Kept<f64>>),
}

/// A value of each row.
macro_rules! each {
    ($numbers:expr, $row:ident => $value:expr) => {
        match $numbers {
            Numbers::Proved(rows) => rows.iter().map(|$row| $value).collect(),
            Numbers::Plain(rows) => rows.iter().map(|$row| $value).collect(),
        }
    };
}

impl Rows {
    pub(crate) fn new(shared: Arc<Shared>, numbers: Numbers, end: End, asked: Asked) -> Self {
        Self { shared, numbers, end, asked, motion: OnceLock::new() }
    }

    fn columns(&self) -> usize {
        self.shared.system.states.len()
    }

    /// The motion between the events, made ready once.
    fn motion(&self) -> PyResult<&Motion> {
        if let Some(made) = self.motion.get() {
            return Ok(made);
        }
        let (system, backward) = (&self.shared.system, self.asked.backward);
        let forms = self.shared.solvers(backward).closed_forms(system, backward).map_err(value)?;
        let events = each!(&self.numbers, row => beginning(row));
        Ok(self.motion.get_or_init(|| Motion { forms, events }))
    }
}

#[pymethods]
impl Rows {
    fn __len__(&self) -> usize {
        match &self.numbers {
            Numbers::Proved(rows) => rows.len(),
            Numbers::Plain(rows) => rows.len(),
        }
    }

    /// The times, in the system's unit.
    fn times<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_vec(py, each!(&self.numbers, row => row.time.nearest()))
    }

    /// The states just after the events, a row an event.
    fn states<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let numbers: Vec<Vec<f64>> = each!(
            &self.numbers, row => row.state.iter().map(Nearest::nearest).collect()
        );
        table(py, numbers.concat(), self.columns())
    }

    /// The indices of the modes that the events begin.
    fn modes<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        PyArray1::from_vec(py, each!(&self.numbers, row => row.mode as i64))
    }

    /// The names of the events; the start has none, and the last row may have that of the ending.
    fn names(&self) -> Vec<String> {
        each!(&self.numbers, row => row.name.clone())
    }

    /// The proved digits of times and states, at most so many; none of a run in f64.
    fn digits(&self, most: usize) -> Option<(Vec<String>, Vec<Vec<String>>)> {
        let Numbers::Proved(rows) = &self.numbers else { return None };
        let times = rows.iter().map(|row| row.time.to_digits(most)).collect();
        let state = |row: &Kept<Proved>| row.state.iter().map(|it| it.to_digits(most)).collect();
        Some((times, rows.iter().map(state).collect()))
    }

    /// Bounds of the errors of the middles of times and states; none of a run in f64.
    #[expect(clippy::type_complexity, reason = "the face in Python names the two")]
    fn errors<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<Option<(Bound<'py, PyArray1<f64>>, Bound<'py, PyArray2<f64>>)>> {
        let Numbers::Proved(rows) = &self.numbers else { return Ok(None) };
        let times = PyArray1::from_vec(py, rows.iter().map(|row| row.time.error()).collect());
        let states = rows.iter().flat_map(|row| row.state.iter().map(Proved::error)).collect();
        Ok(Some((times, table(py, states, self.columns())?)))
    }

    /// This run made again with its derivatives by these names.
    fn differentiated(&self, py: Python<'_>, names: Vec<String>) -> PyResult<Self> {
        let (shared, asked) = (&self.shared, &self.asked);
        let (numbers, end) = without_lock(py, || match &self.numbers {
            Numbers::Proved(_) => all(|keep| shared.proved(asked, &names, keep))
                .map(|(rows, end)| (Numbers::Proved(rows), end)),
            Numbers::Plain(_) => all(|keep| shared.plain(asked, &names, keep))
                .map(|(rows, end)| (Numbers::Plain(rows), end)),
        })?;
        Ok(Self::new(Arc::clone(shared), numbers, end, asked.clone()))
    }

    /// The derivatives by so many names on a side, 0 below and 1 above their values, or on both.
    fn derivatives<'py>(
        &self,
        py: Python<'py>,
        names: usize,
        side: Option<usize>,
    ) -> PyResult<Derivatives<'py>> {
        let shape = [names, self.columns()];
        match &self.numbers {
            Numbers::Proved(rows) => derivatives(py, rows, side, shape),
            Numbers::Plain(rows) => derivatives(py, rows, side, shape),
        }
    }

    /// The proved digits of the derivatives, at most so many; none of a run in f64.
    fn derivative_digits(&self, side: Option<usize>, most: usize) -> Option<DerivativeDigits> {
        let Numbers::Proved(rows) = &self.numbers else { return None };
        Some(digits(rows, side, self.columns(), most))
    }

    /// The states at times of the run, a row a time.
    fn at<'py>(
        &self,
        py: Python<'py>,
        times: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let (motion, times) = (self.motion()?, times.as_array().to_vec());
        let columns = self.columns();
        let outside = |time: f64| {
            let (first, last) = motion.range().unwrap_or((f64::NAN, f64::NAN));
            value(format!("t = {time} is not accepted: the run goes from {first} to {last}"))
        };
        let states: PyResult<_> = without_lock(py, || {
            let mut patience = Patience::new();
            let mut states = Vec::with_capacity(times.len() * columns);
            for time in times {
                states.extend(motion.at(time).ok_or_else(|| outside(time))?);
                patience.step()?;
            }
            Ok(states)
        });
        table(py, states?, columns)
    }

    /// The name of the ending; none where the run has the number of events that was asked for.
    #[getter]
    fn ending(&self) -> Option<String> {
        self.end.name.clone()
    }

    #[getter]
    fn is_decided(&self) -> bool {
        self.end.is_decided
    }

    #[getter]
    fn cause(&self) -> Option<String> {
        self.end.cause.clone()
    }

    /// The earliest and the latest time at which impacts accumulate.
    #[getter]
    fn accumulation(&self) -> Option<(String, String)> {
        self.end.accumulation.clone().map(|[earliest, latest]| (earliest, latest))
    }

    /// The bits of the arithmetic that the run came to.
    #[getter]
    fn bits(&self) -> u32 {
        self.end.bits
    }

    /// The number of choices that rounding leaves open; 0 of a run with proved digits.
    #[getter]
    fn undecidable(&self) -> u64 {
        self.end.undecidable
    }
}
