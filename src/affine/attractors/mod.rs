//! Attractors of a system's return maps, and which start of a grid leads to which.
//!
//! The theory is that of [`crate::dynamics::attractor`], over a section of any system; a point of
//! it is a mode and a state, and of an event of a forced system the forcing angle too.
//!
//! - **Periodic**: returns repeat, Newton's method confirms the orbit, its multipliers are inside
//!   the unit circle, and there is a neighbourhood from which all sampled points return closer
//!   (`trap_search.rs`): evidence, not proof.
//! - **Chaotic**: the largest exponent is above zero by more than
//!   [`MIN_STANDARD_ERRORS`](crate::dynamics::attractor::MIN_STANDARD_ERRORS) standard errors over
//!   a long run that met no orbit. Another motion is on the same attractor when 48 returns in a row
//!   lie in the cells of that run (`cells.rs`).
//! - **Quasi-periodic**: neither, with a largest exponent below 1e-3. In the oscillator every
//!   contact contracts areas; in other systems there may be such motions.
//! - **Equilibrium**: the motion does not return to the section within the longest time.
//!
//! What is none of these stays unresolved, as does a start at which an orbit attracts too slowly.
//! The search is that of [`crate::dynamics::attractor`] over the [`motions`] between returns, whose
//! distances are taken in [`coordinates`]; [`basins`] labels the starts of a grid. [`scan`] finds
//! orbits, unstable ones too, from such a grid.

pub mod basins;
mod coordinates;
mod motions;
mod scan;

pub use basins::{Plane, ReturnBasins, UnresolvedReturn};

use crate::affine::returns::map::SectionMap;
use crate::affine::returns::orbit::Orbit;
use crate::affine::returns::walk::Return;
use crate::affine::run::place::Place;
use crate::dynamics::attractor::AttractorKind;
use crate::dynamics::attractor::motions::RunMeans;
use std::cmp::Ordering;

/// An attractor of a section's return map.
#[derive(Clone, Debug, PartialEq)]
pub struct ReturnAttractor {
    /// The kind of the attractor.
    pub kind: AttractorKind,
    /// The orbit, where it is one; its points begin at the smallest first state.
    pub orbit: Option<Orbit>,
    /// Successive returns: all of an orbit, the state at which an equilibrium was given up, the
    /// last 4096 of the run otherwise.
    pub points: Vec<Return<f64>>,
    /// The largest exponent per return, without those of motions along the flow and along drifts;
    /// of an orbit from its multipliers, NaN of an equilibrium.
    pub lyapunov_per_return: f64,
    /// The standard error of the exponent; zero for an orbit.
    pub lyapunov_error: f64,
    /// The mean change per return of each of the [drifts](crate::System::drifts), in their order;
    /// none of an equilibrium.
    pub drift_per_return: Vec<f64>,
    /// The standard errors of these means; none of an orbit, whose drift is no mean over a run.
    pub drift_standard_error: Vec<f64>,
}

/// Returns that are kept of an attractor that is no orbit.
pub const MAX_POINTS: usize = crate::dynamics::attractor::MAX_POINTS;

impl ReturnAttractor {
    /// An attractor that is a stable orbit, told from its smallest first state on.
    fn periodic(map: &SectionMap<'_, f64>, orbit: Orbit, places: &[Place<f64>]) -> Self {
        let orbit = from_smallest(map, orbit, places);
        let [re, im] = orbit.multipliers.first().copied().unwrap_or_default();
        Self {
            kind: AttractorKind::Periodic,
            points: orbit.points.clone(),
            lyapunov_per_return: libm::log(libm::hypot(re, im)) / orbit.period() as f64,
            lyapunov_error: 0.0,
            drift_per_return: orbit.drift_per_return.clone(),
            drift_standard_error: Vec::new(),
            orbit: Some(orbit),
        }
    }

    /// An attractor that is no orbit, with the largest exponent and its error, and the drifts.
    fn of_run(kind: AttractorKind, run: &[Return<f64>], means: &RunMeans) -> Self {
        let [exponent, error] = means.largest_exponent;
        Self {
            kind,
            orbit: None,
            points: run[run.len().saturating_sub(MAX_POINTS)..].to_vec(),
            lyapunov_per_return: exponent,
            lyapunov_error: error,
            drift_per_return: means.drift.clone(),
            drift_standard_error: means.drift_error.clone(),
        }
    }

    /// The attractor's period in returns, where it has one.
    #[must_use]
    pub fn period(&self) -> Option<usize> {
        self.orbit.as_ref().map(Orbit::period)
    }

    /// Orbits first, by period, then by smallest first state; then the others by kind.
    fn order(&self, other: &Self) -> Ordering {
        let (mine, its) = ((self.kind, self.period()), (other.kind, other.period()));
        mine.cmp(&its).then_with(|| self.smallest().total_cmp(&other.smallest()))
    }

    fn smallest(&self) -> f64 {
        self.points.iter().map(|it| first(&it.state)).fold(f64::INFINITY, f64::min)
    }
}

/// An orbit, whose points have these places, from its smallest first state on.
fn from_smallest(map: &SectionMap<'_, f64>, orbit: Orbit, places: &[Place<f64>]) -> Orbit {
    let smallest = |a: &&Place<f64>, b: &&Place<f64>| first(&a.state).total_cmp(&first(&b.state));
    let found = places
        .iter()
        .min_by(smallest)
        .and_then(|it| map.orbit(it, u32::try_from(orbit.period()).ok()?).ok());
    found.filter(|found| found.period() == orbit.period()).unwrap_or(orbit)
}

fn first(state: &[f64]) -> f64 {
    state.first().copied().unwrap_or(0.0)
}
