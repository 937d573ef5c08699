//! Points of the curve of orbits, and what is watched along it.

use super::super::returns::map::Carried;
use super::super::returns::orbit::Orbit;
use super::super::returns::shooting::Change;
use super::family::OrbitShots;

/// An orbit on the curve, and the curve's direction there.
#[derive(Clone)]
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
#[derive(Clone)]
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
    /// Whether both lie on one smooth piece of the map.
    pub fn is_on_piece_of(&self, other: &Self) -> bool {
        are_on_one_piece(&self.shots, &other.shots)
    }

    /// The point with the curve's direction turned round.
    pub fn turned(&self) -> Self {
        let mut turned = self.clone();
        turned.tangent = self.tangent.turned();
        turned
    }

    /// The product of all 1 + mu: zero at a flip.
    pub fn flip(&self) -> f64 {
        // The imaginary part of a pair's product vanishes.
        let [re, _] = self.orbit.multipliers.iter().fold([1.0, 0.0], |[re, im], [a, b]| {
            [re * (1.0 + a) - im * b, re * b + im * (1.0 + a)]
        });
        re
    }

    /// The product of what the moduli of complex pairs are more than one, and their number: the
    /// product is zero at a Neimark-Sacker point.
    pub fn torus(&self) -> (f64, usize) {
        let pairs = self.orbit.multipliers.iter().filter(|it| it[1] > 0.0);
        pairs.fold((1.0, 0), |(all, count), [re, im]| {
            (all * (libm::hypot(*re, *im) - 1.0), count + 1)
        })
    }

    /// How much the multipliers' sums of powers differ, relative to their size.
    pub fn change_of_multipliers(&self, other: &Self) -> f64 {
        let sums = |point: &Self| {
            let multipliers = &point.orbit.multipliers;
            let first: f64 = multipliers.iter().map(|it| it[0]).sum();
            [first, multipliers.iter().map(|[re, im]| re * re - im * im).sum()]
        };
        let changes = sums(self).into_iter().zip(sums(other));
        changes.map(|(a, b)| (a - b).abs() / (1.0 + a.abs().min(b.abs()))).fold(0.0, f64::max)
    }
}

impl Direction {
    pub fn turned(&self) -> Self {
        let points = self.points.iter().map(|it| it.map(|x| -x)).collect();
        Self { points, rate: -self.rate }
    }
}
