//! The solvers of a system, each prepared when a run first needs it.

use crate::threads::on_this_thread;
use percuss::affine;
use percuss::{DoubleDouble, Proved, Solver, System, SystemError};
use std::sync::{Arc, OnceLock};

/// A solver that is prepared once.
type Once<T> = OnceLock<Arc<T>>;

/// The closed forms of a system's modes, in 106 bits.
pub(crate) type ClosedForms = affine::Solver<DoubleDouble>;

/// The solvers of one direction of time.
#[derive(Default)]
pub(crate) struct Solvers {
    proved: Once<Solver<Proved>>,
    plain: Once<Solver<f64>>,
    closed_forms: Once<ClosedForms>,
}

impl Solvers {
    pub(crate) fn proved(
        &self,
        system: &System,
        backward: bool,
    ) -> Result<Arc<Solver<Proved>>, SystemError> {
        once(&self.proved, || if backward { system.backward_solver() } else { system.solver() })
    }

    pub(crate) fn plain(
        &self,
        system: &System,
        backward: bool,
    ) -> Result<Arc<Solver<f64>>, SystemError> {
        once(&self.plain, || if backward { system.backward_solver() } else { system.solver() })
    }

    pub(crate) fn closed_forms(
        &self,
        system: &System,
        backward: bool,
    ) -> Result<Arc<ClosedForms>, SystemError> {
        once(&self.closed_forms, || ClosedForms::prepare(system, backward))
    }
}

fn once<T>(
    cell: &Once<T>,
    make: impl FnOnce() -> Result<T, SystemError>,
) -> Result<Arc<T>, SystemError> {
    if let Some(made) = cell.get() {
        return Ok(Arc::clone(made));
    }
    let made = Arc::new(on_this_thread(make)?);
    Ok(Arc::clone(cell.get_or_init(|| made)))
}
