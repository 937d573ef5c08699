//! Orbits of a SYSTEM: the guess from which Newton's method goes, and points as JSON.

use crate::cli::shared::section::tell_undecidable;
use crate::returns::{self, Guess};
use anyhow::Result;
use percuss::affine::{Orbit, SectionMap, System};
use serde::Serialize;

/// A point of an orbit.
#[derive(Serialize)]
pub(super) struct PointJson<'a> {
    mode: &'a str,
    state: &'a [f64],
}

/// The points of an orbit.
pub(super) fn points<'a>(system: &'a System, orbit: &'a Orbit) -> Vec<PointJson<'a>> {
    let point = |it: &'a percuss::affine::Return<f64>| PointJson {
        mode: &system.modes[it.mode].name,
        state: &it.state,
    };
    orbit.points.iter().map(point).collect()
}

/// The return after the transient, from the system's start.
pub(super) fn guess(map: &SectionMap<'_, f64>, transient: Option<u64>) -> Result<Guess> {
    let (guess, undecidable) = returns::guess(map, transient.unwrap_or(0), || ())?;
    tell_undecidable(undecidable);
    Ok(guess)
}
