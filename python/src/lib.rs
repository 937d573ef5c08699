//! The native part of the Python package `percuss`: systems and their runs, the oscillator and its
//! dynamics, the judgement of answers, and the command.
//!
//! Users meet the package in `python/percuss/`, which gives these classes their faces.
//! Nothing is computed here that the libraries do not compute, so every number is the command's.

mod arrays;
mod asked;
mod between_returns;
mod branches;
mod collect;
mod command;
mod derivatives;
mod diagram;
mod dynamics;
mod failure;
mod gradient;
mod gradient_scores;
mod long_work;
mod motion;
mod oscillator;
mod return_diagram;
mod return_survey;
mod returns;
mod rows;
mod scores;
mod section;
mod solvers;
mod stream;
mod survey;
mod system;
mod threads;

use pyo3::prelude::pymodule;

/// The native part of the package `percuss`.
#[pymodule]
mod _percuss {
    use pyo3::prelude::{Bound, PyModule, PyResult};

    #[pymodule_init]
    fn init(_module: &Bound<'_, PyModule>) -> PyResult<()> {
        super::threads::remember_process();
        Ok(())
    }

    #[pymodule_export]
    use super::branches::{follow, system_follow};
    #[pymodule_export]
    use super::command::command;
    #[pymodule_export]
    use super::diagram::bifurcation;
    #[pymodule_export]
    use super::dynamics::{lyapunov, orbits, poincare};
    #[pymodule_export]
    use super::gradient_scores::{GradientCases, gradient_case_names};
    #[pymodule_export]
    use super::oscillator::Oscillator;
    #[pymodule_export]
    use super::return_diagram::system_bifurcation;
    #[pymodule_export]
    use super::return_survey::{system_basins, system_orbits};
    #[pymodule_export]
    use super::returns::{system_lyapunov, system_orbit, system_poincare};
    #[pymodule_export]
    use super::rows::Rows;
    #[pymodule_export]
    use super::scores::{Cases, case_names, ending_names};
    #[pymodule_export]
    use super::section::Section;
    #[pymodule_export]
    use super::stream::{Row, Stream};
    #[pymodule_export]
    use super::survey::basins;
    #[pymodule_export]
    use super::system::{System, system_names};
}
