//! All engines.

use super::exact::Exact;
use super::{differential_equations, diffsol, ode_solvers};
use crate::engine::{Engine, REFERENCE};
use crate::failure::Failure;
use regex::Regex;
use std::sync::OnceLock;

/// The engines that are compiled in.
static BUILT_IN_ENGINES: &[&dyn Engine] = &[
    &Exact,
    &diffsol::BDF,
    &diffsol::TR_BDF2,
    &diffsol::ESDIRK34,
    &diffsol::TSIT45,
    &ode_solvers::DOPRI5,
    &ode_solvers::DOPRI5_ORIGINAL,
    &ode_solvers::DOP853,
    &ode_solvers::DOP853_TIME,
    &ode_solvers::Rk4,
    &differential_equations::RKV655E,
    &differential_equations::RKV655E_ORIGINAL,
    &differential_equations::BuiltIn,
    &differential_equations::RKV767E,
    &differential_equations::DOP853,
    &differential_equations::RADAU5,
    &differential_equations::KVAERNO745,
    &differential_equations::BDF,
];

/// The engines of this program, with those that were added.
static ALL_ENGINES: OnceLock<Vec<&'static dyn Engine>> = OnceLock::new();

/// Every engine, the exact solver first.
#[must_use]
pub fn all() -> &'static [&'static dyn Engine] {
    ALL_ENGINES.get_or_init(|| BUILT_IN_ENGINES.to_vec())
}

/// Adds engines of another crate to those of this program, until it ends.
///
/// # Errors
/// A name that is taken or begins with [`REFERENCE`]; or engines that are
/// added after any was asked for.
pub fn add(own: &[&'static dyn Engine]) -> Result<(), Failure> {
    let mut every = BUILT_IN_ENGINES.to_vec();
    for engine in own {
        let name = engine.declaration().name;
        if name.starts_with(REFERENCE) || every.iter().any(|it| it.declaration().name == name) {
            return Err(Failure::new(format!(
                "an engine cannot be called {name:?}: accepted is a name of its own that does not begin with {REFERENCE}"
            )));
        }
        every.push(*engine);
    }
    ALL_ENGINES
        .set(every)
        .map_err(|_| Failure::new("engines can be added once, before any engine is asked for"))
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
