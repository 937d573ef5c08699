//! A system: read, changed, and run.

use crate::asked::{Asked, Shared, all};
use crate::between_returns::Returning;
use crate::collect::Limits;
use crate::failure::{arguments, value};
use crate::rows::{Numbers, Rows};
use crate::section::Section;
use crate::stream::Stream;
use crate::threads::without_lock;
use percuss::SystemError;
use percuss::affine::{MAX_HORIZON, PRECISION_BITS, SystemFile};
use percuss_validation::returns::{CountedReturns, MAX_RETURNS, Strobes, Uncounted};
use percuss_validation::systems::{SYSTEMS, named};
use pyo3::prelude::{PyRef, PyResult, Python, pyclass, pyfunction, pymethods};
use std::collections::BTreeMap;
use std::sync::Arc;

/// The most bits that a run may take.
const MAX_BITS: u32 = PRECISION_BITS[PRECISION_BITS.len() - 1];

/// The most significant digits that may be asked for.
const MAX_DIGITS: usize = 300;

/// A piecewise-affine system.
#[pyclass(frozen, module = "percuss._percuss")]
pub(crate) struct System {
    pub(crate) file: SystemFile,
    pub(crate) shared: Arc<Shared>,
    origin: Origin,
}

/// The texts and values of which a system is made.
#[derive(Clone, Default)]
struct Origin {
    /// The text of its file.
    text: Arc<str>,
    /// The parameters that have other values than in the file.
    set: BTreeMap<String, f64>,
    /// The text with the table `[start]` that replaces the file's.
    start: Option<Arc<str>>,
}

impl System {
    fn new(file: SystemFile, origin: Origin) -> Result<Self, SystemError> {
        let system = file.system()?;
        let shared = Arc::new(Shared { system, directions: Default::default() });
        Ok(Self { file, shared, origin })
    }

    fn read(place: &str, text: &str) -> Result<Self, SystemError> {
        let origin = Origin { text: Arc::from(text), ..Origin::default() };
        Self::new(SystemFile::read(place, text)?, origin)
    }

    /// The run that is asked for, whose numbers are checked.
    fn asked(
        &self,
        (until, count, max_events): (Option<f64>, Option<usize>, Option<usize>),
        (digits, max_bits): (usize, Option<u32>),
        backward: bool,
    ) -> PyResult<Asked> {
        let system = &self.shared.system;
        let start = system.start().map_err(value)?.time.to_f64();
        for (name, number) in [("count", count), ("max_events", max_events)] {
            if number == Some(0) {
                return Err(value(format!("{name} = 0 is not accepted: 1 or more is")));
            }
        }
        if !(1..=MAX_DIGITS).contains(&digits) {
            return Err(value(format!("digits = {digits} is not accepted: 1 to {MAX_DIGITS} are")));
        }
        let bits = max_bits.unwrap_or(MAX_BITS);
        if !(PRECISION_BITS[0]..=MAX_BITS).contains(&bits) {
            let [least, most] = [PRECISION_BITS[0], MAX_BITS];
            return Err(value(format!("max_bits = {bits} is not accepted: {least} to {most} are")));
        }
        let direction = if backward { -1.0 } else { 1.0 };
        let ahead = |until: f64| direction * (until - start);
        let until = match until {
            None => start + direction * MAX_HORIZON * system.time_scale,
            Some(until) if until.is_finite() && ahead(until) >= 0.0 => until,
            Some(until) => {
                let side = if backward { "before" } else { "after" };
                return Err(value(format!(
                    "until = {until} is not accepted: a finite time at or {side} the start at \
                     {start} is"
                )));
            }
        };
        let limits = Limits { count, most: max_events, time_scale: system.time_scale };
        Ok(Asked { until, limits, digits, max_bits: bits, backward, returning: None })
    }

    /// The returns in which a run is measured that ends at a time, if it does, at the latest.
    fn returning(
        &self,
        until: Option<f64>,
        (wanted, left_out): (Option<u64>, u64),
        section: &Section,
    ) -> PyResult<Returning> {
        let shared = &self.shared;
        let system = &shared.system;
        let start = system.start().map_err(value)?.time.to_f64();
        if section.is_written() {
            section.map(&*shared.solvers(false).plain(system, false).map_err(value)?)?;
        }
        let counted = section.returns(left_out, wanted).counted(system).map_err(|why| {
            value(match why {
                Uncounted::TooMany(whole) => format!(
                    "transient = {left_out} and returns make {whole} returns: at most \
                     {MAX_RETURNS} are accepted"
                ),
                Uncounted::NotForced => format!(
                    "returns without a section are not accepted: {} is not forced, so that no \
                     forcing period makes one; an event as section is",
                    system.name
                ),
                Uncounted::NoStart(error) => error.to_string(),
            })
        })?;
        let strobes = match &counted {
            CountedReturns::Strobes(strobes) => Some(strobes),
            CountedReturns::Events(_) => None,
        };
        let transient = strobes.filter(|it| it.left_out > 0).map(Strobes::first);
        let first_row = transient.unwrap_or(start);
        if let Some(until) = until.filter(|until| *until < first_row) {
            return Err(value(format!(
                "until = {until} is not accepted: a finite time at or after the end of transient \
                 = {left_out} at {first_row} is"
            )));
        }
        let last = until.or_else(|| strobes.and_then(Strobes::last));
        let horizon = last.unwrap_or(first_row + MAX_HORIZON * system.time_scale);
        Ok(Returning { counted, horizon, is_timed: until.is_some() })
    }
}

#[pymethods]
impl System {
    /// Reads the text of a system's file; errors say `place` and the line.
    #[staticmethod]
    fn parse(place: &str, text: &str) -> PyResult<Self> {
        Self::read(place, text).map_err(value)
    }

    /// The system of the program that has this name, if there is one.
    #[staticmethod]
    fn named(name: &str) -> PyResult<Option<Self>> {
        named(name).map(|text| Self::read(name, text).map_err(value)).transpose()
    }

    /// The system with other values of some parameters.
    fn with_parameters(&self, values: BTreeMap<String, f64>) -> PyResult<Self> {
        let (mut file, mut origin) = (self.file.clone(), self.origin.clone());
        for (name, number) in values {
            if !number.is_finite() {
                return Err(value(format!(
                    "{name} = {number} is not accepted: a finite number is"
                )));
            }
            file.set(&name, number, &format!("{name} = {number}")).map_err(value)?;
            origin.set.insert(name, number);
        }
        Self::new(file, origin).map_err(value)
    }

    /// The system with the start of a text that holds the table `[start]`.
    fn with_start(&self, text: &str) -> PyResult<Self> {
        let mut file = self.file.clone();
        file.replace_from("start", text, false).map_err(value)?;
        let origin = Origin { start: Some(Arc::from(text)), ..self.origin.clone() };
        Self::new(file, origin).map_err(value)
    }

    /// The text of the file, the parameters that have other values than there, and the text of the
    /// start that replaces the file's.
    #[getter]
    fn origin(&self) -> (&str, BTreeMap<String, f64>, Option<&str>) {
        let Origin { text, set, start } = &self.origin;
        (text, set.clone(), start.as_deref())
    }

    #[getter]
    fn name(&self) -> &str {
        &self.shared.system.name
    }

    #[getter]
    fn why(&self) -> &str {
        &self.shared.system.why
    }

    #[getter]
    fn source(&self) -> &str {
        &self.shared.system.source
    }

    #[getter]
    fn trouble(&self) -> Vec<String> {
        self.shared.system.trouble.clone()
    }

    #[getter]
    fn states(&self) -> Vec<String> {
        self.shared.system.states.clone()
    }

    #[getter]
    fn modes(&self) -> Vec<String> {
        self.shared.system.modes.iter().map(|it| it.name.clone()).collect()
    }

    #[getter]
    fn parameters(&self) -> BTreeMap<String, f64> {
        self.shared.system.parameters.clone()
    }

    #[getter]
    fn time_scale(&self) -> f64 {
        self.shared.system.time_scale
    }

    /// The angular frequency of the forcing, if there is one.
    #[getter]
    fn omega(&self) -> Option<f64> {
        self.shared.system.forcing.as_ref().map(|it| it.omega.to_f64())
    }

    /// The names of all events, each once.
    #[getter]
    fn event_names(&self) -> Vec<String> {
        let mut names: Vec<String> = Vec::new();
        for mode in &self.shared.system.modes {
            let until = mode.until.iter().map(|it| &it.name);
            for name in until.chain(mode.watch.iter().map(|it| &it.name)) {
                if !names.contains(name) {
                    names.push(name.clone());
                }
            }
        }
        names
    }

    /// The time at which runs start, if the system has a start.
    #[getter]
    fn start_time(&self) -> Option<f64> {
        self.shared.system.start.as_ref().map(|it| it.time.to_f64())
    }

    /// A run with proved digits.
    #[pyo3(signature = (until, count, digits, max_bits, max_events, backward))]
    #[expect(clippy::too_many_arguments, reason = "the face in Python gives them names")]
    fn events(
        &self,
        py: Python<'_>,
        until: Option<f64>,
        count: Option<usize>,
        digits: usize,
        max_bits: Option<u32>,
        max_events: Option<usize>,
        backward: bool,
    ) -> PyResult<Rows> {
        let asked = self.asked((until, count, max_events), (digits, max_bits), backward)?;
        one_length(&[until.is_some(), count.is_some()], "until and count")?;
        let shared = &self.shared;
        let (rows, end) = without_lock(py, || all(|keep| shared.proved(&asked, &[], keep)))?;
        Ok(Rows::new(Arc::clone(shared), Numbers::Proved(rows), end, asked))
    }

    /// A run in f64, measured in returns: in so many, if its length is a number of them, and after
    /// so many that are left out.
    #[pyo3(signature = (until, count, max_events, backward, returns))]
    fn simulate(
        &self,
        py: Python<'_>,
        until: Option<f64>,
        count: Option<usize>,
        max_events: Option<usize>,
        backward: bool,
        returns: Option<(Option<u64>, u64, PyRef<'_, Section>)>,
    ) -> PyResult<Rows> {
        let mut asked = self.asked((until, count, max_events), (MAX_DIGITS, None), backward)?;
        let wanted = returns.as_ref().and_then(|it| it.0);
        let given = [until.is_some(), count.is_some(), wanted.is_some()];
        one_length(&given, "until, count and returns")?;
        if let Some((wanted, left_out, section)) = returns {
            let returning = self.returning(until, (wanted, left_out), &section)?;
            asked.returning = Some(Arc::new(returning));
        }
        let (shared, asked) = (&self.shared, asked);
        let (rows, end) = without_lock(py, || all(|keep| shared.plain(&asked, &[], keep)))?;
        Ok(Rows::new(Arc::clone(shared), Numbers::Plain(rows), end, asked))
    }

    /// The rows of a run with proved digits, one after the other, none of which is kept.
    #[pyo3(signature = (until, count, digits, max_bits, backward))]
    fn stream(
        &self,
        until: Option<f64>,
        count: Option<usize>,
        digits: usize,
        max_bits: Option<u32>,
        backward: bool,
    ) -> PyResult<Stream> {
        let asked = self.asked((until, count, None), (digits, max_bits), backward)?;
        if until.is_some() && count.is_some() {
            return Err(arguments("until and count exclude each other: accepted is one of them"));
        }
        Stream::start(Arc::clone(&self.shared), asked, digits)
    }
}

/// Refuses a run of no length, or of several.
fn one_length(given: &[bool], accepted: &str) -> PyResult<()> {
    if given.iter().filter(|it| **it).count() == 1 {
        return Ok(());
    }
    Err(arguments(&format!("a run needs its length: accepted is one of {accepted}")))
}

/// The names of the systems inside the program.
#[pyfunction]
pub(crate) fn system_names() -> Vec<&'static str> {
    SYSTEMS.iter().map(|(name, _)| *name).collect()
}
