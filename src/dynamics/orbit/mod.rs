//! Periodic orbits of the strobe map, stable or not, by Newton's method.
//!
//! The unknowns are all strobes of the orbit, not the first one alone (multiple shooting): of an
//! unstable orbit each strobe is then found to the last digits, where one that is shot through the
//! whole period carries its rounding times the largest multiplier.

mod multipliers;
pub(crate) mod newton;
pub(crate) mod scan;
mod shooting;

use super::strobe::{StrobeMap, StrobePoint};
use crate::error::InputError;
use crate::phase::Phase;
use newton::{Unsolved, minimal_orbit, solve};
pub use scan::scan;
pub(crate) use shooting::{Around, ShootingIterate, size};
use std::fmt;

/// The largest period that is looked for, in forcing periods.
pub const LARGEST_PERIOD: u32 = 10_000;

/// A periodic orbit of the strobe map.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Orbit {
    /// The orbit's strobes (p, y, q), one per forcing period, as many as the least period.
    pub points: Vec<StrobePoint>,
    /// The phases met in one whole period of the orbit, in order, from that of the first strobe.
    pub phases: Vec<Phase>,
    /// The orbit's multipliers (real and imaginary part), largest modulus first. With any contact
    /// the last is zero: the surface annihilates a direction.
    pub multipliers: [[f64; 2]; 3],
    /// How well it closes: the largest |image - next strobe| over (1 + |strobe|), per forcing
    /// period.
    pub residual: f64,
    /// Drift a forcing period.
    pub drift_per_period: f64,
}

impl Orbit {
    /// The orbit that Newton's method reaches from the motion that begins at `guess`, of `period`
    /// forcing periods (1 to [`LARGEST_PERIOD`]) or, if it closes sooner, of a divisor of it.
    ///
    /// # Errors
    /// [`NoOrbit`] says why none was reached and how close it came.
    pub fn find(map: &StrobeMap, guess: StrobePoint, period: u32) -> Result<Self, NoOrbit> {
        let iterate = ShootingIterate::shot(map, guess, period)?;
        Ok(Self::new(&minimal_orbit(map, solve(map, iterate)?)))
    }

    /// The orbit of a converged iterate.
    pub(crate) fn new(iterate: &ShootingIterate) -> Self {
        Self {
            points: iterate.points.clone(),
            phases: iterate.phases(),
            multipliers: multipliers::multipliers(iterate),
            residual: iterate.residual,
            drift_per_period: iterate.drift() / iterate.points.len() as f64,
        }
    }

    /// How many forcing periods it takes: the least number after which it closes.
    #[must_use]
    pub fn period(&self) -> u32 {
        self.points.len() as u32
    }

    /// Whether all multipliers are inside the unit circle.
    #[must_use]
    pub fn is_stable(&self) -> bool {
        self.multipliers.iter().all(|it| super::linear::modulus(*it) < 1.0)
    }
}

/// Why no orbit was reached.
#[derive(Clone, Debug, PartialEq)]
pub struct NoOrbit {
    /// The least residual that was met; infinite where none was.
    pub residual: f64,
    /// Why the residual did not fall further.
    pub reason: Reason,
}

/// The reasons for which Newton's method does not reach an orbit.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Reason {
    /// The guess is not accepted.
    Guess(InputError),
    /// The period is zero or beyond [`LARGEST_PERIOD`].
    Period(u32),
    /// Neither a shorter step nor a step beyond a corner of the map comes closer.
    Stalled,
    /// The residual still fell, but too slowly.
    Slow,
    /// The motion escapes, or its growth over the period exceeds what an f64 holds.
    Escaped,
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Guess(error) => error.fmt(f),
            Self::Period(period) => {
                write!(f, "period = {period} is not accepted: 1 to {LARGEST_PERIOD}")
            }
            Self::Stalled => f.write_str("no step comes closer"),
            Self::Slow => f.write_str("the steps come closer too slowly"),
            Self::Escaped => f.write_str("the motion escapes"),
        }
    }
}

impl fmt::Display for NoOrbit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.reason {
            Reason::Guess(_) | Reason::Period(_) => self.reason.fmt(f),
            _ => write!(f, "no orbit: {}, residual {:.3e}", self.reason, self.residual),
        }
    }
}

impl std::error::Error for NoOrbit {}

impl From<Unsolved> for NoOrbit {
    fn from(Unsolved { residual, still_falls }: Unsolved) -> Self {
        let reason = if still_falls { Reason::Slow } else { Reason::Stalled };
        Self { residual, reason }
    }
}

impl From<Reason> for NoOrbit {
    fn from(reason: Reason) -> Self {
        Self { residual: f64::INFINITY, reason }
    }
}
