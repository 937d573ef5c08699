//! A run as it is asked for, and what all runs of a system share.

use crate::between_returns::{self, Returning};
use crate::collect::{End, Kept, Limits, walk};
use crate::failure::value;
use crate::long_work::Patience;
use crate::solvers::Solvers;
use percuss::{Proved, SystemError};
use std::sync::Arc;

/// The part of a system that its runs share.
pub(crate) struct Shared {
    pub(crate) system: percuss::System,
    pub(crate) directions: [Solvers; 2],
}

impl Shared {
    pub(crate) fn solvers(&self, backward: bool) -> &Solvers {
        &self.directions[usize::from(backward)]
    }
}

/// The length of a run, and how it is made.
#[derive(Clone)]
pub(crate) struct Asked {
    pub(crate) until: f64,
    pub(crate) limits: Limits,
    pub(crate) digits: usize,
    pub(crate) max_bits: u32,
    pub(crate) backward: bool,
    /// The returns in which a run in f64 is measured, if it is in any.
    pub(crate) returning: Option<Arc<Returning>>,
}

impl Shared {
    /// A run in numbers with proved digits, differentiated by these names, whose rows are given to
    /// `keep`.
    pub(crate) fn proved<E: From<SystemError>>(
        &self,
        asked: &Asked,
        names: &[String],
        keep: &mut dyn FnMut(Kept<Proved>) -> Result<(), E>,
    ) -> Result<End, E> {
        let solver = self.solvers(asked.backward).proved(&self.system, asked.backward)?;
        let run = solver.run().digits(asked.digits).max_bits(asked.max_bits);
        walk(run.gradients(names)?.until(asked.until)?, asked.limits, names, keep)
    }

    /// A run in f64, differentiated by these names, whose rows are given to `keep`, and nothing for
    /// each event that is left out.
    pub(crate) fn plain<E: From<SystemError>>(
        &self,
        asked: &Asked,
        names: &[String],
        keep: &mut dyn FnMut(Option<Kept<f64>>) -> Result<(), E>,
    ) -> Result<End, E> {
        let solver = self.solvers(asked.backward).plain(&self.system, asked.backward)?;
        let run = solver.run().gradients(names)?;
        let Some(returning) = &asked.returning else {
            let events = run.until(asked.until)?;
            return walk(events, asked.limits, names, &mut |row| keep(Some(row)));
        };
        let stop = returning.first_stop(self.system.start()?.time.to_f64());
        between_returns::walk(run.until(stop)?, returning, asked.limits, names, keep)
    }
}

/// The failure of a run: of the system, or an exception of Python.
pub(crate) enum Failure {
    System(SystemError),
    Python(pyo3::PyErr),
}

impl From<SystemError> for Failure {
    fn from(error: SystemError) -> Self {
        Self::System(error)
    }
}

impl From<Failure> for pyo3::PyErr {
    fn from(failure: Failure) -> Self {
        match failure {
            Failure::System(error) => value(error),
            Failure::Python(error) => error,
        }
    }
}

/// All rows of a run, which gives nothing for what is left out.
pub(crate) fn all<V, R: Into<Option<Kept<V>>>>(
    run: impl FnOnce(&mut dyn FnMut(R) -> Result<(), Failure>) -> Result<End, Failure>,
) -> Result<(Vec<Kept<V>>, End), Failure> {
    let (mut rows, mut patience) = (Vec::new(), Patience::new());
    let end = run(&mut |row| {
        rows.extend(row.into());
        patience.step().map_err(Failure::Python)
    })?;
    Ok((rows, end))
}
