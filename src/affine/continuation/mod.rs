//! Branches of periodic orbits of any system's return maps, followed in a parameter, stable or not.
//!
//! The theory is that of [`crate::dynamics::continuation`], over the return map of a section:
//! pseudo-arclength continuation of all points of the orbit, each solved to its last digits. The
//! map is smooth as long as each return has the same events; where these change the curve has a
//! corner, which is found by halving, and at which it is taken up again with the derivative of the
//! other side. [`words`] says what has happened there.
//!
//! [`family`] has the maps at the parameter's values, [`point`] the points of the curve, [`curve`]
//! its tangent and the corrector, [`locate`] and [`corner`] the bifurcations, [`halving`] the end
//! of a doubled branch, and [`follow`] the steps. Read them in this order.

mod corner;
mod curve;
mod family;
mod follow;
mod halving;
mod locate;
mod point;
mod words;

use super::returns::orbit::{NoOrbit, Orbit};
use super::returns::section::Guard;
use super::run::place::Place;
use crate::dynamics::continuation::BranchEnding;
use curve::Curve;
pub use family::ReturnFamily;
use follow::Follower;
use std::fmt;

/// A branch of orbits of a return map.
#[derive(Clone, Debug)]
pub struct ReturnBranch {
    /// The branch's orbits in order, each with the parameter's value.
    pub points: Vec<(f64, Orbit)>,
    /// The bifurcations on the way, in order.
    pub bifurcations: Vec<ReturnBifurcation>,
    /// How and where the branch ends.
    pub ending: BranchEnding,
}

/// The kinds of bifurcations of an orbit of a return map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ReturnBifurcationKind {
    /// A multiplier passes one: the branch turns in the parameter.
    Fold,
    /// A multiplier passes minus one: an orbit of twice the period branches off.
    Flip,
    /// A complex pair passes the unit circle.
    NeimarkSacker,
    /// A guard is touched: it is crossed on one side, with a rate that vanishes.
    Grazing,
    /// Two guards are crossed at once, or one takes the place of another.
    Corner,
    /// The orbit has an event more beyond, and no guard is touched.
    EventGained,
    /// The orbit has an event less beyond, and no guard is touched.
    EventLost,
}

impl ReturnBifurcationKind {
    /// The name used in files.
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Fold => "fold",
            Self::Flip => "flip",
            Self::NeimarkSacker => "neimark-sacker",
            Self::Grazing => "grazing",
            Self::Corner => "corner",
            Self::EventGained => "event-gained",
            Self::EventLost => "event-lost",
        }
    }
}

impl fmt::Display for ReturnBifurcationKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

/// A special point of a branch.
#[derive(Clone, Debug)]
pub struct ReturnBifurcation {
    /// The kind of the bifurcation.
    pub kind: ReturnBifurcationKind,
    /// The parameter's value.
    pub value: f64,
    /// How far that may be off: what the search left, and rounding.
    pub error: f64,
    /// The event that is touched, gained, lost, or at once with another.
    pub event: Option<Guard>,
    /// Whether the branch turns back in the parameter: at every fold, and at a corner that is one.
    pub turns: bool,
    /// The orbit there; at a corner as the branch comes to it.
    pub orbit: Orbit,
}

impl ReturnBranch {
    /// Follows the orbit that is found from a place at the value `from`, of `period` returns or a
    /// divisor of it, until the parameter is `to`. `told` hears how far it has come, 0 to 1.
    ///
    /// # Errors
    /// [`NoOrbit`] where there is none to begin with.
    pub fn follow(
        family: &ReturnFamily<'_>,
        guess: &Place<f64>,
        period: u32,
        [from, to]: [f64; 2],
        told: &mut dyn FnMut(f64),
    ) -> Result<Self, NoOrbit> {
        let found = family.at(from, |map| Some(map.orbit_with_places(guess, period)));
        let (_, places) = found.ok_or(NoOrbit::Stalled(f64::NAN))??;
        let none = NoOrbit::NoDerivative(f64::NAN);
        let curve = Curve::new(family, [from, to]).ok_or(none.clone())?;
        let first = curve.first(from, places, (to - from).signum()).ok_or(none)?;
        Ok(Follower::new(curve, [from, to], told).branch(first))
    }

    /// Whether the branch was followed to the value that was asked for.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.ending == BranchEnding::Reached
    }
}
