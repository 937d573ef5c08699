//! Orbits of Figs. 7 to 10 continued in the forcing frequency.

use super::paper::attractors_model;
use crate::engine::Failure;
use percuss::dynamics::attractor::Attractor;
use percuss::dynamics::continuation::{Bifurcation, BifurcationKind, Branch, Family};
use percuss::dynamics::strobe::StrobePoint;
use percuss::{Instant, Parameter};

/// The strobe maps at omega tau = 0, one for each frequency.
pub(super) fn family() -> Family {
    // The frequency is what varies: of any that is put here nothing is left.
    const ANY_OMEGA: f64 = 1.0;
    Family::new(attractors_model(ANY_OMEGA), Parameter::Omega, Instant::at(ANY_OMEGA, 0.0, 0))
}

/// The branch of the orbit of a period that is found near a point, from one frequency to another.
pub(super) fn branch(
    guess: StrobePoint,
    period: u32,
    from: f64,
    to: f64,
) -> Result<Branch, Failure> {
    Branch::follow(&family(), guess, period, from, to, &mut |_| {}).map_err(Failure::new)
}

/// The first bifurcation of a kind that an orbit meets from one frequency to another.
pub(super) fn first(
    kind: BifurcationKind,
    orbit: &Attractor,
    from: f64,
    to: f64,
) -> Result<Bifurcation, Failure> {
    let period = orbit.period().ok_or_else(|| Failure::new("it is no orbit"))?;
    let met = branch(orbit.points[0], period, from, to)?.bifurcations;
    let missing =
        || Failure::new(format!("period {period} meets no {} from {from} to {to}", kind.as_str()));
    met.into_iter().find(|it| it.kind == kind).ok_or_else(missing)
}
