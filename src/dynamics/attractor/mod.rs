//! Attractors of the strobe map, and the recognition of a motion that approaches one.
//!
//! - **Periodic**: strobes repeat, Newton's method confirms the orbit ([`Orbit::find`]), its
//!   multipliers are inside the unit circle, and there is a neighbourhood from which all sampled
//!   points return closer: evidence, not proof (`trap_search.rs`).
//! - **Chaotic**: the largest exponent is above zero by more than [`MIN_STANDARD_ERRORS`] standard
//!   errors over a run of 2^17 strobes that met no orbit. Another motion is on the same attractor
//!   when 48 strobes in a row lie in the cells of that run (`cells.rs`); so its bands are one
//!   attractor.
//! - **Quasi-periodic**: neither, with a largest exponent and a contraction below 1e-3.
//! - **Escaping**: a phase that provably never ends: the mass never returns or the slider never
//!   stops.
//! - Whatever is none of these after the last extension of its transient stays **unresolved**, and
//!   is described ([`UnresolvedStart`]): above all an orbit next to a bifurcation, which attracts
//!   too slowly for a trap to be found, and one of a longer period than is looked for.
//!
//! A chaotic set of which a motion leaves after some 10^5 periods on average cannot be told from an
//! attractor by any run of that length.
//!
//! The search is written for the returns to any section: `coordinates.rs` has its points and
//! `motions.rs` what happens between them, `known.rs` what a motion is recognised by
//! (`recognition.rs`), `search.rs` what it settles on, and `catalog.rs` labels starts. The
//! oscillator's strobes are one such section (`strobes.rs`).

mod block;
pub(crate) mod catalog;
mod cells;
pub(crate) mod coordinates;
mod fractal;
pub(crate) mod grid;
pub(crate) mod known;
mod limits;
pub(crate) mod motions;
mod recognition;
pub(crate) mod search;
mod strobe_catalog;
mod strobes;
pub(crate) mod thresholds;
mod trap;
pub(crate) mod trap_search;
pub(crate) mod unresolved;

pub use block::{BlockLabeller, LabelledBlock};
pub use fractal::{
    Entropy, Scale, Uncertainty, entropy, entropy_of_labels, uncertainty, uncertainty_of,
    uncertainty_of_labels,
};
pub use grid::{Basins, Grid, Window};
pub use known::Label;
pub use limits::{DEFAULT_MAX_PERIOD, SearchLimits};
pub use strobe_catalog::{AttractorCatalog, UnresolvedStart};

use super::orbit::Orbit;
use super::strobe::{StrobeMap, StrobePoint};
use crate::model::instant::Instant;
use crate::unknown_name::UnknownName;
use motions::RunMeans;
use std::cmp::Ordering;
use std::fmt;
use std::str::FromStr;

/// Standard errors by which a positive exponent must differ from zero.
pub const MIN_STANDARD_ERRORS: f64 = 4.0;

/// The kinds of attractors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum AttractorKind {
    /// A stable periodic orbit.
    Periodic,
    /// A set with a positive Lyapunov exponent.
    Chaotic,
    /// No periodic orbit, a largest exponent of zero, and no contraction that is measured. Every
    /// contact contracts areas, so that there is no invariant curve; at very light damping a run
    /// cannot tell.
    QuasiPeriodic,
    /// A set to which motions return and of which no more is known: its starts are unresolved.
    Unidentified,
    /// A state of rest, or a motion that does not return to the section for long.
    Equilibrium,
}

impl AttractorKind {
    /// All kinds of attractors.
    pub const ALL: [Self; 5] =
        [Self::Periodic, Self::Chaotic, Self::QuasiPeriodic, Self::Unidentified, Self::Equilibrium];

    /// The name used in files.
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Periodic => "periodic",
            Self::Chaotic => "chaotic",
            Self::QuasiPeriodic => "quasi-periodic",
            Self::Unidentified => "unidentified",
            Self::Equilibrium => "equilibrium",
        }
    }
}

impl fmt::Display for AttractorKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

impl FromStr for AttractorKind {
    type Err = UnknownName;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        UnknownName::find("kind of attractor", &Self::ALL, Self::as_str, name)
    }
}

/// An attractor.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Attractor {
    /// The kind of the attractor.
    pub kind: AttractorKind,
    /// The orbit, where it is one; its strobes begin at the smallest p.
    pub orbit: Option<Orbit>,
    /// Successive strobes: all of an orbit, the last [`MAX_POINTS`] of the reference run otherwise.
    pub points: Vec<StrobePoint>,
    /// Mean drift per forcing period.
    pub drift_per_period: f64,
    /// The standard error of the mean drift; zero for an orbit.
    pub drift_standard_error: f64,
    /// The largest exponent per forcing period; of an orbit from its multipliers.
    pub lyapunov_per_period: f64,
    /// The standard error of the exponent; zero for an orbit.
    pub lyapunov_error: f64,
}

/// Forcing periods that a motion is solved ahead, at least, so that an escape shows early: it is
/// proved where the drift away exceeds the oscillation, which a slow drift takes so long to do.
const MIN_PERIODS_AHEAD: u64 = 1 << 14;

/// The instant up to which a motion is solved of which so many strobes after `from` are looked at.
///
/// Without it a contact of millions of periods would be solved whole for every start.
fn horizon(from: &Instant, strobes: u64) -> Instant {
    from.after_periods(strobes.max(MIN_PERIODS_AHEAD), 1)
}

/// Strobes that are kept of an attractor that is no orbit.
pub const MAX_POINTS: usize = 4096;

impl Attractor {
    /// An attractor that is a stable orbit, told from its smallest p on.
    fn periodic(map: &StrobeMap, orbit: Orbit) -> Self {
        let first = orbit.points.iter().copied().min_by(|a, b| a[0].total_cmp(&b[0]));
        let found = first.and_then(|first| Orbit::find(map, first, orbit.period()).ok());
        let orbit = found.filter(|found| found.period() == orbit.period()).unwrap_or(orbit);
        let [re, im] = orbit.multipliers[0];
        Self {
            kind: AttractorKind::Periodic,
            points: orbit.points.clone(),
            drift_per_period: orbit.drift_per_period,
            drift_standard_error: 0.0,
            lyapunov_per_period: libm::log(libm::hypot(re, im)) / f64::from(orbit.period()),
            lyapunov_error: 0.0,
            orbit: Some(orbit),
        }
    }

    /// An attractor that is no orbit, with the means over its run.
    fn of_run(kind: AttractorKind, run: &[StrobePoint], means: &RunMeans) -> Self {
        let [lyapunov_per_period, lyapunov_error] = means.largest_exponent;
        let first = |of: &[f64]| of.first().copied().unwrap_or(f64::NAN);
        Self {
            kind,
            orbit: None,
            points: run[run.len().saturating_sub(MAX_POINTS)..].to_vec(),
            drift_per_period: first(&means.drift),
            drift_standard_error: first(&means.drift_error),
            lyapunov_per_period,
            lyapunov_error,
        }
    }

    /// The attractor's period in forcing periods, where it has one.
    #[must_use]
    pub fn period(&self) -> Option<u32> {
        self.orbit.as_ref().map(Orbit::period)
    }

    /// Orbits first, by period, then by smallest p; then the others by kind and smallest p.
    fn order(&self, other: &Self) -> Ordering {
        let (mine, its) = ((self.kind, self.period()), (other.kind, other.period()));
        mine.cmp(&its).then_with(|| self.smallest_p().total_cmp(&other.smallest_p()))
    }

    /// The smallest p among the attractor's strobes.
    #[must_use]
    pub fn smallest_p(&self) -> f64 {
        self.points.iter().map(|point| point[0]).fold(f64::INFINITY, f64::min)
    }
}
