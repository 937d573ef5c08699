//! A model and a start as given, before and after they are checked.

use super::Origins;
use percuss::{Entry, Model, Parameters, Start};

/// Parameters and start as given by file and flags, with where each came from.
#[derive(Clone, Debug, Default)]
pub struct Given {
    /// The model's parameters.
    pub parameters: Parameters,
    /// The start.
    pub start: Start,
    /// The place from which each value came.
    pub origins: Origins,
}

/// A checked model at a checked start.
#[derive(Clone, Copy, Debug)]
pub struct Problem {
    /// The model.
    pub model: Model,
    /// The start as given.
    pub start: Start,
    /// The first phase's entry.
    pub entry: Entry,
}

impl Given {
    /// Checks model and start.
    ///
    /// # Errors
    /// One line that names the flag or the file's field, its value and what is accepted.
    pub fn check(&self) -> Result<Problem, String> {
        let explain = |error| self.origins.explain(&error);
        let model = Model::new(self.parameters).map_err(explain)?;
        let entry = model.start(&self.start).map_err(explain)?;
        Ok(Problem { model, start: self.start, entry })
    }
}
