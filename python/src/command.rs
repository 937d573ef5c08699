//! The command `percuss`.

use crate::threads::without_lock;
use pyo3::prelude::{Python, pyfunction};
use std::ffi::OsString;
use std::io::Write;
use std::process::ExitCode;

/// The exit code of a run that was refused.
const REFUSED_EXIT_CODE: u8 = 2;

/// Runs the command with these words, of which the first is its name, and gives its exit code.
#[pyfunction]
pub(crate) fn command(py: Python<'_>, words: Vec<OsString>) -> u8 {
    without_lock(py, || {
        let code = percuss_validation::cli::run(words);
        // Python does not write out what a library's own stdout holds.
        let written = std::io::stdout().flush();
        let number = (0..REFUSED_EXIT_CODE).find(|it| ExitCode::from(*it) == code);
        if written.is_err() { REFUSED_EXIT_CODE } else { number.unwrap_or(REFUSED_EXIT_CODE) }
    })
}
