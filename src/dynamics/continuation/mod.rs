//! Branches of periodic orbits followed in a parameter, through folds and corners, stable or not.
//!
//! Pseudo-arclength continuation: the curve of orbits in (strobes, parameter) is followed along its
//! tangent, each orbit solved to its last digits. Between corners of the strobe map the curve is
//! smooth and three tests are watched: the parameter turns (fold), (1 + mu1)(1 + mu2)(1 + mu3)
//! changes sign (flip), the modulus of a complex pair passes one (Neimark-Sacker).
//!
//! # Corners
//!
//! The map is smooth as long as the phases stay the same, strobe by strobe. Where they change, the
//! curve has a kink: at a graze of an impact (the derivative of the map jumps there), and where an
//! impact passes the strobe itself (the map is what it was; its strobes turn off). Corners are
//! found by halving, and the curve is taken up again with the derivative of the other side: of the
//! two directions of the new tangent the one that leaves the old piece. So a branch goes through a
//! corner, with multipliers that jump, or turns back there, a non-smooth fold, in the same way. A
//! corner at which the phases of the whole orbit change is a `grazing`; an event that only passes
//! the strobe changes their cyclic order alone, and is none.
//!
//! # What is not to be expected
//!
//! A Neimark-Sacker point needs a pair of multipliers with product one. Where the slider comes to
//! rest between contacts that product is what a period leaves of an area of neighbouring (p, y):
//! flights keep it, contact contracts it by exp(-2 xi d), progression by exp(-d/(2 xi)), an impact
//! keeps it or, straight into progression, divides it by f > 1. So it is less than one. A slider
//! that is still moving when it is hit adds 2 xi dp dq, which settles nothing; the test is there
//! for that, and none was met.
//!
//! # Flips
//!
//! [`Doubling`] takes the doubled branch from next to a flip and says on which side it lies. A
//! branch that runs into the flip of an orbit of half its period ends there: beyond, it would be
//! the same orbits again.

pub(crate) mod corner;
mod doubling;
mod family;
mod follow;
mod halving;
pub(crate) mod locate;
mod point;
pub(crate) mod steps;

use super::orbit::{NoOrbit, Orbit, ShootingIterate};
use super::strobe::StrobePoint;
use crate::unknown_name::UnknownName;
pub use doubling::{Criticality, Doubling};
pub use family::Family;
use point::{BranchTangent, ContinuationPoint, FamilyCurve};
use std::fmt;
use std::str::FromStr;
use steps::FollowedCurve;

/// A branch of orbits.
#[derive(Clone, Debug)]
pub struct Branch {
    /// The branch's orbits in order.
    pub points: Vec<BranchPoint>,
    /// The bifurcations on the way, in order.
    pub bifurcations: Vec<Bifurcation>,
    /// How and where the branch ends.
    pub ending: BranchEnding,
}

/// An orbit of a branch.
#[derive(Clone, Debug)]
pub struct BranchPoint {
    /// The parameter's value.
    pub value: f64,
    /// The orbit.
    pub orbit: Orbit,
}

/// The kinds of bifurcations of an orbit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum BifurcationKind {
    /// A multiplier passes one: the branch turns in the parameter.
    Fold,
    /// A multiplier passes minus one: an orbit of twice the period branches off.
    Flip,
    /// A complex pair passes the unit circle.
    NeimarkSacker,
    /// A guard is touched; of the impact oscillator, a phase appears or vanishes.
    Grazing,
    /// Two guards are crossed at once, or one takes the place of another.
    Corner,
    /// The orbit has an event more beyond, and no guard is touched.
    EventGained,
    /// The orbit has an event less beyond, and no guard is touched.
    EventLost,
}

impl BifurcationKind {
    /// All kinds of bifurcations.
    pub const ALL: [Self; 7] = [
        Self::Fold,
        Self::Flip,
        Self::NeimarkSacker,
        Self::Grazing,
        Self::Corner,
        Self::EventGained,
        Self::EventLost,
    ];

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

impl fmt::Display for BifurcationKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

impl FromStr for BifurcationKind {
    type Err = UnknownName;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        UnknownName::find("kind of bifurcation", &Self::ALL, Self::as_str, name)
    }
}

/// A special point of a branch.
#[derive(Clone, Debug)]
pub struct Bifurcation {
    /// The kind of the bifurcation.
    pub kind: BifurcationKind,
    /// The parameter's value.
    pub value: f64,
    /// Bound on the error of the value: what the search left, and rounding.
    pub error: f64,
    /// Whether the branch turns back in the parameter: at every fold, and at a corner that is one.
    pub turns: bool,
    /// The orbit there; at a corner as the branch comes to it.
    pub orbit: Orbit,
    /// The first orbit beyond a corner; `None` where this is no corner.
    pub beyond: Option<Orbit>,
}

/// How a branch ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BranchEnding {
    /// The branch ends at the value that was asked for.
    Reached,
    /// The branch leaves its interval at the end where it began.
    Left,
    /// The branch closes: it comes back to the orbit at which it began.
    Closed,
    /// The branch ends in a flip of an orbit of half its period, which is the last of the branch's
    /// bifurcations.
    Halved {
        /// The parameter value at which the branch ends.
        value: f64,
    },
    /// The branch is lost: no orbit was found beyond its last one.
    Lost {
        /// The parameter value at which the branch ends.
        value: f64,
    },
    /// The branch has more orbits than are kept.
    Long {
        /// The parameter value at which the branch ends.
        value: f64,
    },
}

impl fmt::Display for BranchEnding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Reached => f.write_str("the branch reaches the end of its interval"),
            Self::Left => f.write_str("the branch turns and leaves the interval where it began"),
            Self::Closed => f.write_str("the branch is closed within the interval"),
            Self::Halved { value } => {
                write!(f, "the branch ends at {value:?} in a flip of an orbit of half its period")
            }
            Self::Lost { value } => write!(f, "the branch was lost at {value:?}"),
            Self::Long { value } => {
                write!(f, "the branch has too many turns; given up at {value:?}")
            }
        }
    }
}

impl Branch {
    /// Follows the orbit that is found from `guess` at the value `from`, of `period` forcing
    /// periods or a divisor of it, until the parameter is `to`. `progress` is told how far it has
    /// come, 0 to 1.
    ///
    /// # Errors
    /// [`NoOrbit`] where there is none to begin with.
    pub fn follow(
        family: &Family,
        guess: StrobePoint,
        period: u32,
        from: f64,
        to: f64,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Self, NoOrbit> {
        let map = family.map(from).map_err(|it| NoOrbit::from(super::orbit::Reason::Guess(it)))?;
        let orbit = Orbit::find(&map, guess, period)?;
        let iterate = ShootingIterate::new(&map, &orbit.points)
            .ok_or(NoOrbit::from(super::orbit::Reason::Escaped))?;
        let curve = FamilyCurve::new(family, from, to);
        let towards = BranchTangent {
            points: vec![[0.0; 3]; iterate.points.len()],
            rate: curve.unit * (to - from).signum(),
        };
        let first = curve.point(from, iterate, &towards);
        Ok(Self::follow_from(&curve, [from, to], first, progress))
    }

    /// The branch from a point of a curve on.
    fn follow_from(
        curve: &FamilyCurve,
        ends: [f64; 2],
        first: ContinuationPoint,
        progress: &mut dyn FnMut(f64),
    ) -> Self {
        let FollowedCurve { points, bifurcations, ending, .. } =
            steps::follow(curve, ends, first, progress);
        Self { points, bifurcations, ending }
    }

    /// Whether the branch was followed to the value that was asked for.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.ending == BranchEnding::Reached
    }
}
