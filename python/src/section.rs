//! Sections of a system's motions, as they are written.

use crate::failure::value;
use percuss::Solver;
use percuss::affine::{self, SectionMap};
use percuss_validation::returns::WantedReturns;
use percuss_validation::typed::WrittenSection;
use pyo3::prelude::{PyResult, pyclass, pymethods};

/// A section of a system's motions, and the longest time to wait for a return to it.
#[pyclass(frozen, module = "percuss._percuss")]
pub(crate) struct Section {
    /// The section as it is written, if it is, and what that means.
    written: Option<(String, WrittenSection)>,
    every: u32,
    pub(crate) longest: Option<f64>,
}

#[pymethods]
impl Section {
    /// The section that is written as `strobe`, `strobe:ANGLE`, `EVENT` or `EVENT@MODE`, or the
    /// usual one.
    #[new]
    #[pyo3(signature = (text, every, max_time))]
    fn new(text: Option<&str>, every: u32, max_time: Option<f64>) -> PyResult<Self> {
        let read = |text: &str| {
            let meant = WrittenSection::read(text).ok_or_else(|| {
                value(format!(
                    "section = {text:?} is not accepted: strobe, strobe:ANGLE, EVENT and \
                     EVENT@MODE are"
                ))
            })?;
            PyResult::Ok((text.to_owned(), meant))
        };
        let written = text.map(read).transpose()?;
        if let Some(longest) = max_time.filter(|it| !(*it > 0.0 && it.is_finite())) {
            return Err(value(format!(
                "max_time = {longest} is not accepted: a positive number is"
            )));
        }
        Ok(Self { written, every, longest: max_time })
    }

    /// The arguments that make it again, with which it is pickled.
    fn __getnewargs__(&self) -> (Option<&str>, u32, Option<f64>) {
        (self.written.as_ref().map(|(text, _)| text.as_str()), self.every, self.longest)
    }
}

impl Section {
    /// The section, the default one where none is written.
    pub(crate) fn section(&self) -> affine::Section {
        let written = self.written.as_ref().map(|(_, meant)| meant.section());
        written.unwrap_or_default().every(self.every)
    }

    /// The return map of the section.
    pub(crate) fn map<'a>(&self, solver: &'a Solver<f64>) -> PyResult<SectionMap<'a, f64>> {
        let map = SectionMap::new(solver.for_sections(), &self.section()).map_err(value)?;
        Ok(match self.longest {
            Some(longest) => map.within(longest),
            None => map,
        })
    }

    /// Returns that a run is to be measured in.
    pub(crate) fn returns(&self, left_out: u64, wanted: Option<u64>) -> WantedReturns<'_> {
        let section = self.written.as_ref().map(|(_, meant)| meant);
        WantedReturns { left_out, wanted, section, every: self.every, longest: self.longest }
    }

    /// Whether the section is written, and not the usual one.
    pub(crate) fn is_written(&self) -> bool {
        self.written.is_some()
    }
}
