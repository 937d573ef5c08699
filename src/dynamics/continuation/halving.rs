//! Where a branch ends because its orbits close after half their period.

use super::locate::Located;
use super::point::{BranchTangent, ContinuationPoint, FamilyCurve};
use super::{Bifurcation, BifurcationKind};
use crate::dynamics::linear::dot;
use crate::dynamics::orbit::{ShootingIterate, solved};
use crate::dynamics::strobe::StrobePoint;

/// Distances about the branch's end in which the half's flip is looked for.
const AROUND: [f64; 8] = [1e-6, 1e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2];

impl FamilyCurve {
    /// The flip of an orbit of half the period that the curve runs into between two points. It goes
    /// on beyond: as the same orbits, half a period later, so that the difference of their halves
    /// changes sign.
    pub(super) fn halving(
        &self,
        point: &ContinuationPoint,
        next: &ContinuationPoint,
    ) -> Option<Bifurcation> {
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
        let iterate = solved(&map, ShootingIterate::of(&map, &middle)?).ok()?;
        let along = BranchTangent { points: vec![[0.0; 3]; half], rate: self.unit };
        let single = self.point(point.value, iterate, &along);
        let located = AROUND.iter().find_map(|distance| {
            let start = self.corrected(&single, -distance)?;
            self.located(&start, 2.0 * distance, ContinuationPoint::flip)
        })?;
        let error = self.error(&located);
        let Located { point: ContinuationPoint { value, orbit, .. }, .. } = located;
        Some(Bifurcation {
            kind: BifurcationKind::Flip,
            value,
            error,
            turns: true,
            orbit,
            beyond: None,
        })
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
