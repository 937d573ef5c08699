//! Where a branch ends because its orbits close after half their period.

use super::point::{BranchTangent, ContinuationPoint, FamilyCurve};
use crate::dynamics::linear::dot;
use crate::dynamics::orbit::ShootingIterate;
use crate::dynamics::orbit::newton::solve;
use crate::dynamics::strobe::StrobePoint;

impl FamilyCurve {
    /// An orbit of half the period midway between the halves of a point's, if the curve runs into
    /// its flip before the next point. It goes on beyond: as the same orbits, half a period later,
    /// so that the difference of their halves changes sign.
    pub(super) fn half(
        &self,
        point: &ContinuationPoint,
        next: &ContinuationPoint,
    ) -> Option<ContinuationPoint> {
        let (here, there) = (differences(&point.iterate)?, differences(&next.iterate)?);
        let along: f64 = here.iter().zip(&there).map(|(a, b)| dot(a, b)).sum();
        if along >= 0.0 {
            return None;
        }
        let map = self.family.map(point.value).ok()?;
        let half = here.len();
        let (first, second) = point.iterate.points.split_at(half);
        let middle: Vec<StrobePoint> = first
            .iter()
            .zip(second)
            .map(|(a, b)| std::array::from_fn(|i| 0.5 * (a[i] + b[i])))
            .collect();
        let iterate = solve(&map, ShootingIterate::new(&map, &middle)?).ok()?;
        let along = BranchTangent { points: vec![[0.0; 3]; half], rate: self.unit };
        Some(self.point(point.value, iterate, &along))
    }
}

/// The differences of strobes half a period apart; `None` for an odd number of strobes.
fn differences(iterate: &ShootingIterate) -> Option<Vec<StrobePoint>> {
    let count = iterate.points.len();
    let (first, second) = iterate.points.split_at(count / 2);
    let pairs = first.iter().zip(second);
    let differences = pairs.map(|(a, b)| std::array::from_fn(|i| a[i] - b[i])).collect();
    count.is_multiple_of(2).then_some(differences)
}
