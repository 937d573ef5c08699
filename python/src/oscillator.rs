//! The oscillator that is built in: its model, its start, and its run in f64.

use crate::arrays::table;
use crate::failure::value;
use crate::long_work::Patience;
use crate::threads::without_lock;
use numpy::{PyArray1, PyArray2};
use percuss::{Endless, Entry, Exit, Instant, Model, Parameters, Phase, Segment, Start};
use pyo3::IntoPyObject;
use pyo3::prelude::{Bound, PyResult, Python, pyclass, pymethods};

/// Forcing periods after which a run that counts events stops.
const DEFAULT_MAX_PERIODS: u64 = 1_000_000;

/// The most forcing periods of a run.
pub(crate) const MAX_PERIODS: u64 = 1_000_000_000;

/// The largest forcing angle of a time that is still reduced exactly.
const MAX_ANGLE_RADIANS: f64 = 4e21;

/// The phase of the row at which a run ends.
const END_PHASE: &str = "end";

/// The phase of the row from which on a run is not decided.
const UNDECIDABLE_PHASE: &str = "undecidable";

/// The oscillator at a start.
#[pyclass(frozen, module = "percuss._percuss")]
pub(crate) struct Oscillator {
    pub(crate) model: Model,
    pub(crate) start: Start,
    pub(crate) entry: Entry,
}

/// A run in f64, as arrays.
#[derive(IntoPyObject)]
pub(crate) struct Simulated<'py> {
    phases: Vec<&'static str>,
    times: Bound<'py, PyArray1<f64>>,
    states: Bound<'py, PyArray2<f64>>,
    undecidable: u64,
    endless: Option<&'static str>,
}

#[derive(Default)]
struct Table {
    phases: Vec<&'static str>,
    times: Vec<f64>,
    states: Vec<f64>,
    undecidable: u64,
    endless: Option<Endless>,
}

impl Table {
    fn add(&mut self, phase: &'static str, time: f64, state: [f64; 4]) {
        self.phases.push(phase);
        self.times.push(time);
        self.states.extend(state);
    }
}

impl Oscillator {
    fn omega(&self) -> f64 {
        self.model.parameters().omega
    }

    /// The instant of a time at or after the start.
    fn horizon(&self, tau: f64) -> PyResult<Instant> {
        let (omega, start) = (self.omega(), self.entry.instant);
        // Written so that a NaN is refused.
        let representable = (omega * tau).abs() <= MAX_ANGLE_RADIANS;
        let horizon = if representable { Instant::at(omega, tau, 0) } else { start };
        let span = horizon.since(&start, omega).value();
        if representable && horizon >= start && span <= MAX_PERIODS as f64 * self.model.period() {
            return Ok(horizon);
        }
        let begins = start.tau(omega);
        Err(value(format!(
            "until = {tau} is not accepted: at or after the start, {begins:?}, and at most \
             {MAX_PERIODS} forcing periods later"
        )))
    }

    /// The rows of a run to a horizon or with a number of events, as `simulate` prints them.
    fn rows(&self, horizon: Instant, wanted: Option<u64>) -> PyResult<Table> {
        let (omega, mut table) = (self.omega(), Table::default());
        let begins = |table: &mut Table, entry: &Entry| {
            let [p, y, q] = entry.point();
            table.add(entry.phase().as_str(), entry.instant.tau(omega), [p, y, q, entry.v()]);
        };
        begins(&mut table, &self.entry);
        let (mut events, mut patience) = (0, Patience::new());
        let mut run = self.model.trajectory(self.entry).until(horizon);
        while wanted != Some(events) {
            let Some(segment) = run.next() else { break };
            patience.step()?;
            if let Exit::Switch(next) = segment.exit() {
                events += 1;
                begins(&mut table, next);
                continue;
            }
            self.end(&mut table, &segment, (horizon, wanted.is_none()));
            break;
        }
        table.undecidable = run.counters().undecidable;
        Ok(table)
    }

    /// The last row, of a run with a horizon or of one that is no longer decided.
    fn end(&self, table: &mut Table, last: &Segment, (horizon, has_end): (Instant, bool)) {
        let omega = self.omega();
        let undecided = *last.exit() == Exit::Undecidable;
        if let Exit::Endless(endless) = last.exit() {
            table.endless = Some(*endless);
        }
        if !(has_end || undecided) {
            return;
        }
        let instant = if undecided {
            last.entry().instant.after(last.duration_two_word(), omega)
        } else {
            horizon
        };
        let sample = last.at_instant(&instant);
        let state = [sample.state.p, sample.state.y, sample.state.q, sample.v];
        let phase = if undecided { UNDECIDABLE_PHASE } else { END_PHASE };
        table.add(phase, instant.tau(omega), state);
    }
}

#[pymethods]
impl Oscillator {
    #[new]
    #[expect(clippy::too_many_arguments, reason = "the face in Python gives them names")]
    #[pyo3(signature = (parameters, tau, cycle, p, y, q, v, phase))]
    fn new(
        parameters: [f64; 6],
        tau: f64,
        cycle: i64,
        p: f64,
        y: f64,
        q: Option<f64>,
        v: f64,
        phase: Option<&str>,
    ) -> PyResult<Self> {
        let phase = phase.map(str::parse::<Phase>).transpose().map_err(value)?;
        let [a, b, xi, omega, g, phi] = parameters;
        let model = Model::new(Parameters { a, b, xi, omega, g, phi }).map_err(value)?;
        let start = Start { tau, cycle, p, y, q, v, phase };
        let entry = model.start(&start).map_err(value)?;
        Ok(Self { model, start, entry })
    }

    /// The forcing period.
    #[getter]
    fn period(&self) -> f64 {
        self.model.period()
    }

    /// The phase, the time and the state (p, y, q, v) of the start.
    #[getter]
    fn started(&self) -> (&'static str, f64, Vec<f64>) {
        let [p, y, q] = self.entry.point();
        let time = self.entry.instant.tau(self.omega());
        (self.entry.phase().as_str(), time, vec![p, y, q, self.entry.v()])
    }

    /// A run in f64.
    #[pyo3(signature = (until, count, periods, max_periods))]
    fn simulate<'py>(
        &self,
        py: Python<'py>,
        until: Option<f64>,
        count: Option<u64>,
        periods: Option<u64>,
        max_periods: Option<u64>,
    ) -> PyResult<Simulated<'py>> {
        let after = |count| self.entry.instant.after_periods(count, 1);
        for (name, number) in [("periods", periods), ("max_periods", max_periods)] {
            if let Some(number) = number.filter(|it| *it > MAX_PERIODS) {
                return Err(value(format!(
                    "{name} = {number} is not accepted: at most {MAX_PERIODS} are"
                )));
            }
        }
        let horizon = match (until, count, periods) {
            (Some(tau), None, None) => self.horizon(tau)?,
            (None, None, Some(periods)) => after(periods),
            (None, Some(_), None) => after(max_periods.unwrap_or(DEFAULT_MAX_PERIODS)),
            _ => {
                return Err(crate::failure::arguments(
                    "a run needs its length: accepted is one of until, count and periods",
                ));
            }
        };
        let rows = without_lock(py, || self.rows(horizon, count))?;
        Ok(Simulated {
            phases: rows.phases,
            times: PyArray1::from_vec(py, rows.times),
            states: table(py, rows.states, 4)?,
            undecidable: rows.undecidable,
            endless: rows.endless.map(Endless::as_str),
        })
    }
}
