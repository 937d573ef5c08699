//! Orbits of a SYSTEM: the guess from which Newton's method goes, and points as JSON.

use crate::cli::shared::section::tell_undecidable;
use anyhow::Result;
use percuss::affine::{NoOrbit, Orbit, Place, SectionMap, System};
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
pub(super) fn guess(
    map: &SectionMap<'_, f64>,
    transient: Option<u64>,
) -> Result<Result<Place<f64>, NoOrbit>> {
    let mut returns = map.returns(map.system().start()?)?;
    let wanted = returns.by_ref().take(transient.unwrap_or(0) as usize + 1);
    if let Some(why) = wanted.filter_map(Result::err).last() {
        return Ok(Err(NoOrbit::NoReturn(why)));
    }
    let guess = returns.place();
    tell_undecidable(returns.undecidable());
    Ok(guess.map_err(NoOrbit::NoReturn))
}
