//! Points of the curve of orbits.

use super::super::returns::map::Carried;
use super::super::returns::orbit::Orbit;
use super::super::returns::shooting::Change;
use super::family::OrbitShots;

/// An orbit on the curve, and the curve's direction there.
#[derive(Clone, Debug)]
pub(super) struct CurvePoint {
    pub value: f64,
    pub shots: OrbitShots,
    /// The orbit's points as places of any value's map.
    pub carried: Vec<Carried>,
    /// The derivatives of the points' images by the parameter.
    pub slopes: Vec<Change>,
    pub tangent: Direction,
    pub orbit: Orbit,
}

/// Rates of all points and of the parameter with the arc length.
#[derive(Clone, Debug)]
pub(super) struct Direction {
    pub points: Vec<Change>,
    pub rate: f64,
}

/// Whether the shots have the same events and modes, return by return: then they lie on one smooth
/// piece of the map.
pub(super) fn are_on_one_piece(one: &OrbitShots, other: &OrbitShots) -> bool {
    let images = one.images.iter().zip(&other.images);
    let points = one.points.iter().zip(&other.points);
    one.points.len() == other.points.len()
        && images.into_iter().all(|(a, b)| a.way.events == b.way.events)
        && points.into_iter().all(|(a, b)| a.mode == b.mode)
}

impl CurvePoint {
    /// The point with the curve's direction turned round.
    pub fn turned(&self) -> Self {
        let mut turned = self.clone();
        turned.tangent = self.tangent.turned();
        turned
    }
}

impl Direction {
    pub fn turned(&self) -> Self {
        let points = self.points.iter().map(|it| it.map(|x| -x)).collect();
        Self { points, rate: -self.rate }
    }
}
