//! The curve of the impact oscillator's orbits, as step control sees it.

use super::point::{ContinuationPoint, FamilyCurve};
use super::steps::{Accepts, Corner, Noted, OrbitCurve, OrbitPoint};
use super::{Bifurcation, BifurcationKind, BranchPoint};
use crate::dynamics::linear::ReIm;
use crate::dynamics::orbit::ShootingIterate;
use crate::dynamics::orbit::newton::{Shooting, polish};

impl OrbitPoint for ContinuationPoint {
    fn value(&self) -> f64 {
        self.value
    }

    fn rate(&self) -> f64 {
        self.tangent.rate
    }

    fn multipliers(&self) -> &[ReIm] {
        &self.orbit.multipliers
    }

    /// The phases strobe by strobe: where they are the same, the map is smooth in between.
    fn is_on_piece_of(&self, other: &Self) -> bool {
        self.iterate.is_on_piece_of(&other.iterate)
    }

    /// The change of the sum and of the pairwise products of the multipliers.
    fn change_of_multipliers(&self, other: &Self) -> f64 {
        let invariants = |point: &Self| {
            let [a, b, c] = point.orbit.multipliers;
            let pair = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] - a[1] * b[1];
            [a[0] + b[0] + c[0], pair(a, b) + pair(b, c) + pair(c, a)]
        };
        let changes = invariants(self).into_iter().zip(invariants(other));
        changes.map(|(a, b)| (a - b).abs() / (1.0 + a.abs().min(b.abs()))).fold(0.0, f64::max)
    }
}

impl OrbitCurve for FamilyCurve {
    type Point = ContinuationPoint;
    type Bifurcation = Bifurcation;
    type Kept = BranchPoint;

    fn corrected_point(
        &self,
        base: &ContinuationPoint,
        distance: f64,
    ) -> Option<ContinuationPoint> {
        Self::corrected_point(self, base, distance)
    }

    fn cosine(&self, point: &ContinuationPoint, next: &ContinuationPoint) -> f64 {
        self.product(&point.tangent, &next.tangent, &point.iterate)
    }

    fn between(
        &self,
        [point, next]: [&ContinuationPoint; 2],
        value: f64,
        share: f64,
    ) -> Option<ContinuationPoint> {
        let pairs = point.iterate.points.iter().zip(&next.iterate.points);
        let between: Vec<_> =
            pairs.map(|(a, b)| std::array::from_fn(|i| a[i] + share * (b[i] - a[i]))).collect();
        let map = self.family.map(value).ok()?;
        let iterate = polish(&map, ShootingIterate::new(&map, &between)?);
        iterate.is_closed().then(|| self.point(value, iterate, &next.tangent))
    }

    fn uncertainty(&self, point: &ContinuationPoint) -> f64 {
        Self::uncertainty(self, point)
    }

    fn half(
        &self,
        point: &ContinuationPoint,
        next: &ContinuationPoint,
    ) -> Option<ContinuationPoint> {
        Self::half(self, point, next)
    }

    fn corner(
        &self,
        base: &ContinuationPoint,
        distance: f64,
        accepts: Option<Accepts<'_, ContinuationPoint>>,
    ) -> Option<Corner<ContinuationPoint>> {
        Self::corner(self, base, distance, accepts)
    }

    fn distance_along(&self, base: &ContinuationPoint, other: &ContinuationPoint) -> f64 {
        Self::distance_along(self, base, &other.iterate, other.value)
    }

    fn of_corner(
        &self,
        _: &ContinuationPoint,
        corner: &Corner<ContinuationPoint>,
    ) -> Option<Bifurcation> {
        let Corner { before, beyond, error, .. } = corner;
        let beyond = beyond.as_ref()?;
        let is_graze = before.phase_sequence() != beyond.phase_sequence();
        is_graze.then(|| Bifurcation {
            kind: BifurcationKind::Grazing,
            value: before.value,
            error: *error,
            turns: corner.turns(),
            orbit: before.orbit.clone(),
            beyond: Some(beyond.orbit.clone()),
        })
    }

    fn bifurcation(&self, noted: Noted<ContinuationPoint>) -> Bifurcation {
        let Noted { kind, point: ContinuationPoint { value, orbit, .. }, error, turns } = noted;
        Bifurcation { kind, value, error, turns, orbit, beyond: None }
    }

    fn kept_point(&self, point: &ContinuationPoint) -> BranchPoint {
        BranchPoint { value: point.value, orbit: point.orbit.clone() }
    }

    fn is_back(&self, [point, next]: [&ContinuationPoint; 2], start: &ContinuationPoint) -> bool {
        let span = (next.value - point.value).abs().max(1e-12 * self.unit);
        let near = |it: &ContinuationPoint| it.iterate.distance(&start.iterate);
        let length = point.iterate.distance(&next.iterate);
        (point.value - start.value).abs() <= 2.0 * span
            && near(point).min(near(next)) <= length
            && self.product(&next.tangent, &start.tangent, &start.iterate) > 0.0
    }
}
