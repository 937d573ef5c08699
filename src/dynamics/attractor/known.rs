//! What is known of an attractor that has been met: what a motion near it is recognised by.

use super::cells::CellSet;
use super::coordinates::Coordinates;
use super::thresholds::MIN_COMMON_SHARE;
use super::trap::Trap;
use std::borrow::Borrow;

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
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "C::Attractor: serde::Serialize, Trap<C>: serde::Serialize,
            CellSet<C>: serde::Serialize",
        deserialize = "C::Attractor: serde::Deserialize<'de>, Trap<C>: serde::Deserialize<'de>,
            CellSet<C>: serde::Deserialize<'de>"
    ))
)]
pub(crate) struct KnownAttractor<C: Coordinates> {
    pub attractor: C::Attractor,
    pub evidence: Evidence<C>,
    /// What the motion that led to an orbit had visited before, where that took long: chaos there
    /// ends, and is no attractor.
    pub transient: Option<CellSet<C>>,
}

/// The evidence by which a motion is recognised.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "Trap<C>: serde::Serialize, CellSet<C>: serde::Serialize",
        deserialize = "Trap<C>: serde::Deserialize<'de>, CellSet<C>: serde::Deserialize<'de>"
    ))
)]
pub(crate) enum Evidence<C: Coordinates> {
    Traps(Vec<Trap<C>>),
    Cells(CellSet<C>),
    /// The state at which a motion has come to rest.
    Rest,
}

/// States of rest that differ by less, beside 1 and their size, are one: so much is left of what
/// decays while a return is waited for.
const EQUILIBRIUM_TOLERANCE: f64 = 1e-3;

impl<C: Coordinates> KnownAttractor<C> {
    pub fn new(attractor: C::Attractor, evidence: Evidence<C>) -> Self {
        Self { attractor, evidence, transient: None }
    }

    /// Whether both are the same attractor.
    pub fn is(&self, coordinates: &C, other: &Self) -> bool {
        let mine = || coordinates.spots(&self.attractor);
        let its = || coordinates.spots(&other.attractor);
        match (&self.evidence, &other.evidence) {
            (Evidence::Traps(_), Evidence::Traps(_)) => {
                self.is_orbit(coordinates, other.period(), its())
            }
            (Evidence::Cells(cells), Evidence::Cells(others)) => {
                cells.share(coordinates, its()) > MIN_COMMON_SHARE
                    || others.share(coordinates, mine()) > MIN_COMMON_SHARE
            }
            (Evidence::Rest, Evidence::Rest) => {
                C::points(&other.attractor).iter().any(|it| self.rests_at(coordinates, it))
            }
            _ => false,
        }
    }

    /// Whether a long run has gone where the motion that led here was before it settled.
    pub fn is_led_to_by(&self, coordinates: &C, run: &[C::Spot]) -> bool {
        self.transient
            .as_ref()
            .is_some_and(|cells| cells.share(coordinates, run.iter()) > MIN_COMMON_SHARE)
    }

    /// Whether the attractor is an orbit of this period through these spots.
    pub fn is_orbit<S: Borrow<C::Spot>>(
        &self,
        coordinates: &C,
        period: u64,
        mut spots: impl Iterator<Item = S>,
    ) -> bool {
        let Evidence::Traps(traps) = &self.evidence else { return false };
        let rests =
            |spot: &C::Spot| traps.iter().any(|trap| trap.is_at_rest(trap.size(coordinates, spot)));
        self.period() == period && spots.any(|it| rests(it.borrow()))
    }

    /// Whether the attractor is the state of rest at which a motion has arrived.
    pub fn rests_at(&self, coordinates: &C, point: &C::Point) -> bool {
        let spot = coordinates.spot(point);
        let mut own = coordinates.spots(&self.attractor);
        matches!(self.evidence, Evidence::Rest)
            && own.any(|it| coordinates.are_near(&it, &spot, EQUILIBRIUM_TOLERANCE))
    }

    /// The orbit's period in returns; one where the attractor is no orbit.
    pub fn period(&self) -> u64 {
        C::period(&self.attractor).unwrap_or(1)
    }
}
