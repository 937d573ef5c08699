//! All engines.

use super::diffsol_bdf::DiffsolBdf;
use super::dopri5::Dopri5;
use super::exact::Exact;
use super::{Engine, Failure};
use regex::Regex;

static ENGINES: [&dyn Engine; 3] = [&Exact, &DiffsolBdf, &Dopri5];

/// Every engine, the exact solver first.
#[must_use]
pub fn all() -> &'static [&'static dyn Engine] {
    &ENGINES
}

/// The exact solver.
#[must_use]
pub fn exact() -> &'static dyn Engine {
    &Exact
}

/// The engines whose name matches one of the patterns; all where there are none.
///
/// # Errors
/// An engine without a pinned version is refused.
pub fn select(patterns: &[Regex]) -> Result<Vec<&'static dyn Engine>, Failure> {
    let chosen = all().iter().copied().filter(|engine| {
        let name = engine.declaration().name;
        patterns.is_empty() || patterns.iter().any(|pattern| pattern.is_match(name))
    });
    let chosen: Vec<_> = chosen.collect();
    match chosen.iter().find(|engine| engine.declaration().version.is_empty()) {
        Some(engine) => {
            Err(Failure::new(format!("{} has no pinned version", engine.declaration().name)))
        }
        None => Ok(chosen),
    }
}
