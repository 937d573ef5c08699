//! Branches of periodic orbits of any system's return maps, followed in a parameter, stable or not.
//!
//! The theory is that of [`crate::dynamics::continuation`], over the return map of a section:
//! pseudo-arclength continuation of all points of the orbit, each solved to its last digits. The
//! map is smooth as long as each return has the same events; where these change the curve has a
//! corner, which is found by halving, and at which it is taken up again with the derivative of the
//! other side. [`words`] says what has happened there. [`passing`] takes the curve past a corner
//! that only the section makes, [`touch`] finds the one where an impact becomes a touch, and
//! [`impact`] the orbit that strikes beyond a touch. [`strobe`] chooses another
//! angle where an event comes near the strobe.
//!
//! [`family`] has the maps at the parameter's values, [`point`] the points of the curve,
//! [`refusal`] the end that was not passed, [`curve`] the tangent, [`corrector`] the next point,
//! [`corner`] the ends of pieces, [`halving`] those of a doubled branch, and [`mod@follow`] what
//! step control asks for. Read them in this order. In two parameters, [`plane`] has the lines on
//! which one varies, [`again`] a bifurcation on one of them, [`traced`] the steps from line to
//! line, [`beside`] those past an event at the strobe, [`before_touch`] those along touches that
//! orbits do not reach, and [`bifurcation_curve`] whole curves.

mod again;
mod before_touch;
mod beside;
mod bifurcation_curve;
mod corner;
mod corrector;
mod curve;
mod family;
mod follow;
mod halving;
mod impact;
mod passing;
mod plane;
mod point;
mod refusal;
mod strobe;
mod touch;
mod traced;
mod words;

use super::returns::orbit::{NoOrbit, Orbit};
use super::returns::section::Guard;
use super::run::place::Place;
use crate::dynamics::continuation::steps::{FollowedCurve, follow};
use crate::dynamics::continuation::{BifurcationKind, BranchEnding};
pub use bifurcation_curve::{BifurcationCurve, BifurcationPoint};
use curve::Curve;
pub use family::ReturnFamily;
pub use plane::ReturnPlane;
use point::CurvePoint;
pub use traced::CurveEnding;

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

/// A special point of a branch.
#[derive(Clone, Debug)]
pub struct ReturnBifurcation {
    /// The kind of the bifurcation.
    pub kind: BifurcationKind,
    /// The parameter's value.
    pub value: f64,
    /// Bound on the error of the value: what the search left, and rounding.
    pub error: f64,
    /// The event that is touched, gained, lost, or at once with another.
    pub event: Option<Guard>,
    /// Whether the branch turns back in the parameter: at every fold, and at a corner that is one.
    pub turns: bool,
    /// The orbit there; at a corner as the branch comes to it.
    pub orbit: Orbit,
    /// The number of the branch's points that come before it.
    pub points_before: usize,
    /// The bifurcation's orbit as a point of the curve that the branch is.
    point: CurvePoint,
    /// The time of the event since the strobe before it, in forcing periods.
    phase: Option<f64>,
    /// Whether no orbit was found beyond a corner.
    is_lost: bool,
}

impl ReturnBranch {
    /// Follows the orbit that is found from a place at the value `from`, of `period` returns or a
    /// divisor of it, until the parameter is `to`. `progress` is told how far it has come, 0 to 1.
    ///
    /// # Errors
    /// [`NoOrbit`] where there is none to begin with.
    pub fn follow(
        family: &ReturnFamily<'_>,
        guess: &Place<f64>,
        period: u32,
        [from, to]: [f64; 2],
        progress: &mut dyn FnMut(f64),
    ) -> Result<Self, NoOrbit> {
        let found = family.at(from, |map| Some(map.orbit_with_places(guess, period)));
        let (_, places) = found.ok_or(NoOrbit::Stalled(f64::NAN))??;
        let none = NoOrbit::NoDerivative(f64::NAN);
        let curve = Curve::new(family, [from, to]).ok_or(none.clone())?;
        let way = (to - from).signum();
        let first = curve.first(from, places, way).ok_or(none)?;
        let branch = Self::of_curve(&curve, [from, to], first.clone(), progress);
        let phases: Vec<f64> = branch.bifurcations.iter().filter_map(|it| it.phase).collect();
        let beside = strobe::angle_beside(&phases).and_then(|angle| {
            let family = family.turned(angle)?;
            let beside = Curve::new(&family, [from, to])?;
            let first = curve.seen_on(&beside, &first)?;
            Some(Self::of_curve(&beside.shown_by(&curve), [from, to], first, progress))
        });
        Ok(beside.unwrap_or(branch))
    }

    /// The branch that a curve has from a point on.
    fn of_curve(
        curve: &Curve<'_>,
        ends: [f64; 2],
        first: CurvePoint,
        progress: &mut dyn FnMut(f64),
    ) -> Self {
        let followed = follow(curve, ends, first, progress);
        let FollowedCurve { points, mut bifurcations, before, mut ending } = followed;
        bifurcations.iter_mut().zip(before).for_each(|(it, before)| it.points_before = before);
        if let (BranchEnding::Lost { value }, Some(last)) = (&mut ending, bifurcations.last())
            && last.is_lost
        {
            *value = last.value;
        }
        Self { points, bifurcations, ending }
    }

    /// The pairs of neighbouring points between which the stability changes and no bifurcation is,
    /// each by the place of its first: a multiplier passes 1 there and the branch does not turn, as
    /// where a symmetric orbit gives way to two that are not.
    #[must_use]
    pub fn unnamed_changes(&self) -> Vec<usize> {
        // A corner is a point of the branch: what it changes is seen on either side of it.
        let is_at = |it: &ReturnBifurcation, place: usize| {
            let before = it.points_before;
            before == place + 1 || before == place && self.points[place].0 == it.value
        };
        let beyond_one = |orbit: &Orbit| {
            orbit.multipliers.iter().filter(|[re, im]| *im == 0.0 && *re > 1.0).count()
        };
        let pairs = self.points.windows(2).enumerate().filter(|(place, pair)| {
            let [from, to] = [&pair[0].1, &pair[1].1];
            from.is_stable() != to.is_stable()
                && beyond_one(from) != beyond_one(to)
                && !self.bifurcations.iter().any(|it| is_at(it, *place))
        });
        pairs.map(|(place, _)| place).collect()
    }

    /// Whether the branch was followed to the value that was asked for.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.ending == BranchEnding::Reached
    }
}
