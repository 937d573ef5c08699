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
    /// The section as it is written, if it is.
    written: Option<WrittenSection>,
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
            WrittenSection::read(text).ok_or_else(|| {
                value(format!(
                    "section = {text:?} is not accepted: strobe, strobe:ANGLE, EVENT and \
                     EVENT@MODE are"
                ))
            })
        };
        let written = text.map(read).transpose()?;
        if let Some(longest) = max_time.filter(|it| !(*it > 0.0 && it.is_finite())) {
            return Err(value(format!(
                "max_time = {longest} is not accepted: a positive number is"
            )));
        }
        Ok(Self { written, every, longest: max_time })
    }
}

impl Section {
    /// The section, the default one where none is written.
    pub(crate) fn section(&self) -> affine::Section {
        let written = self.written.as_ref().map(WrittenSection::section);
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
        let (section, every, longest) = (self.written.as_ref(), self.every, self.longest);
        WantedReturns { left_out, wanted, section, every, longest }
    }

    /// Whether the section is written, and not the usual one.
    pub(crate) fn is_written(&self) -> bool {
        self.written.is_some()
    }
}
