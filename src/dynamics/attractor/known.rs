//! What is known of an attractor that has been met: what a motion near it is recognised by.

use super::Attractor;
use super::cells::CellSet;
use super::thresholds::SAME;
use super::trap::Trap;
use crate::dynamics::orbit::Orbit;
use crate::dynamics::strobe::StrobePoint;

/// The place to which a start leads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Label {
    /// The start leads to the attractor at this place: in the catalog or, among the labels of
    /// [`super::Basins`], in its attractors.
    Attractor(usize),
    /// The start leads to a phase that never ends: the mass never returns or the slider never
    /// stops.
    Escaping,
    /// It is not known where the start leads.
    Unresolved,
    /// No motion begins there: a guard of its mode is positive.
    Inadmissible,
    /// The motion ends.
    Ended,
}

impl Label {
    /// The number used in files: an attractor's place, -1 of what is not known, -2 of what escapes,
    /// -3 of what is no start, -4 of what ends.
    #[must_use]
    pub fn number(self) -> i32 {
        match self {
            Self::Attractor(place) => i32::try_from(place).unwrap_or(i32::MAX),
            Self::Unresolved => -1,
            Self::Escaping => -2,
            Self::Inadmissible => -3,
            Self::Ended => -4,
        }
    }
}

/// An attractor and what a motion near it is recognised by.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct KnownAttractor {
    pub attractor: Attractor,
    pub evidence: Evidence,
    /// What the motion that led to an orbit had visited before, where that took long: chaos there
    /// ends, and is no attractor.
    pub transient: Option<CellSet>,
}

/// The evidence by which a motion is recognised.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) enum Evidence {
    Traps(Vec<Trap>),
    Cells(CellSet),
}

impl KnownAttractor {
    /// Whether both are the same attractor.
    pub fn is(&self, other: &Self) -> bool {
        match (&self.evidence, &other.evidence) {
            (Evidence::Traps(traps), Evidence::Traps(_)) => {
                self.attractor.period() == other.attractor.period()
                    && traps.iter().any(|trap| trap.is_at_rest_at(&other.attractor.points))
            }
            (Evidence::Cells(cells), Evidence::Cells(others)) => {
                cells.share(&other.attractor.points) > SAME
                    || others.share(&self.attractor.points) > SAME
            }
            _ => false,
        }
    }

    /// Whether a long run has gone where the motion that led here was before it settled.
    pub fn is_led_to_by(&self, run: &[StrobePoint]) -> bool {
        self.transient.as_ref().is_some_and(|cells| cells.share(run) > SAME)
    }

    /// Whether the attractor is this orbit.
    pub fn is_orbit(&self, orbit: &Orbit) -> bool {
        let Evidence::Traps(traps) = &self.evidence else { return false };
        self.attractor.period() == Some(orbit.period())
            && traps.iter().any(|trap| trap.is_at_rest_at(&orbit.points))
    }

    /// The orbit's period in forcing periods; one where the attractor is no orbit.
    pub fn period(&self) -> u64 {
        u64::from(self.attractor.period().unwrap_or(1))
    }
}
