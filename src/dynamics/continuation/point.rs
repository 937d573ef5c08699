//! Points of the curve of orbits in (strobes, parameter), its tangent, and the corrector.

use super::family::Family;
use crate::dynamics::linear::{IDENTITY, dot, solve};
use crate::dynamics::orbit::newton::Shooting;
use crate::dynamics::orbit::{Around, Orbit, ShootingIterate, size};
use crate::dynamics::strobe::StrobePoint;
use crate::phase::Phase;

/// An orbit on the curve, and the curve's direction there.
#[derive(Clone, Debug)]
pub(super) struct ContinuationPoint {
    pub(super) value: f64,
    pub(super) iterate: ShootingIterate,
    pub(super) tangent: BranchTangent,
    pub(super) orbit: Orbit,
}

/// Rates of all strobes and of the parameter with the arc length.
#[derive(Clone, Debug)]
pub(super) struct BranchTangent {
    pub(super) points: Vec<StrobePoint>,
    pub(super) rate: f64,
}

/// The family, and the parameter's unit of arc length.
#[derive(Clone, Copy, Debug)]
pub(super) struct FamilyCurve {
    pub(super) family: Family,
    pub(super) unit: f64,
}

/// Newton's iterations of a corrector: more, and the step was too long.
const ITERATIONS: usize = 10;

/// The bordered system: orbits next to an iterate, and a direction.
struct Bordered {
    matrix: [[f64; 4]; 4],
    offset: StrobePoint,
    slopes: Vec<StrobePoint>,
}

impl FamilyCurve {
    /// The curve of a family whose parameter is followed between two values.
    pub(super) fn new(family: &Family, from: f64, to: f64) -> Self {
        Self { family: *family, unit: if from == to { 1.0 } else { (to - from).abs() } }
    }

    /// The orbit at a distance along the tangent of `base`.
    pub(super) fn corrected_point(
        &self,
        base: &ContinuationPoint,
        distance: f64,
    ) -> Option<ContinuationPoint> {
        let BranchTangent { points, rate } = &base.tangent;
        let mut value = base.value + distance * rate;
        let mut strobes = shifted(&base.iterate.points, points, distance);
        let mut best: Option<(f64, ShootingIterate)> = None;
        for _ in 0..ITERATIONS {
            let iterate = ShootingIterate::new(&self.family.map(value).ok()?, &strobes)?;
            let left = self.distance_along(base, &iterate, value) - distance;
            let in_place = left.abs() <= 0.01 * distance.abs() + f64::EPSILON;
            let closed = in_place && iterate.is_closed();
            match &best {
                Some((_, before)) if !closed || iterate.residual >= before.residual => break,
                None if !closed => {}
                _ => best = Some((value, iterate.clone())),
            }
            let bordered = self.bordered_system(&iterate, value, &base.tangent, &base.iterate);
            let [p, y, q] = bordered.offset.map(|x| -x);
            let [dp, dy, dq, step] = solve(bordered.matrix, [p, y, q, -left]);
            let step = step * self.unit;
            let offsets = offsets(&iterate.defects, &bordered.slopes, step);
            strobes =
                shifted(&iterate.points, &iterate.spread_changes([dp, dy, dq], &offsets), 1.0);
            value += step;
        }
        let (value, iterate) = best?;
        Some(self.point(value, iterate, &base.tangent))
    }

    /// A closed iterate with the curve's direction, which is that of `along` as far as there is a
    /// choice.
    pub(super) fn point(
        &self,
        value: f64,
        iterate: ShootingIterate,
        along: &BranchTangent,
    ) -> ContinuationPoint {
        let tangent = self.tangent(&iterate, value, along);
        let orbit = Orbit::new(&iterate);
        ContinuationPoint { value, iterate, tangent, orbit }
    }

    /// The curve's direction at an iterate.
    pub(super) fn tangent(
        &self,
        iterate: &ShootingIterate,
        value: f64,
        along: &BranchTangent,
    ) -> BranchTangent {
        let bordered = self.bordered_system(iterate, value, along, iterate);
        let [p, y, q, rate] = solve(bordered.matrix, [0.0, 0.0, 0.0, 1.0]);
        let rate = rate * self.unit;
        let none = vec![[0.0; 3]; iterate.points.len()];
        let points = iterate.spread_changes([p, y, q], &offsets(&none, &bordered.slopes, rate));
        let mut tangent = BranchTangent { points, rate };
        let length = self.product(&tangent, &tangent, iterate).sqrt();
        if length > 0.0 && length.is_finite() {
            tangent.rate /= length;
            tangent.points.iter_mut().flatten().for_each(|x| *x /= length);
        }
        tangent
    }

    /// The distance along the tangent of `base` at which an iterate lies.
    pub(super) fn distance_along(
        &self,
        base: &ContinuationPoint,
        iterate: &ShootingIterate,
        value: f64,
    ) -> f64 {
        let moved: StrobePoint =
            std::array::from_fn(|i| iterate.points[0][i] - base.iterate.points[0][i]);
        let weight = weight(&base.iterate);
        let BranchTangent { points, rate } = &base.tangent;
        weight * dot(&points[0], &moved) + rate / self.unit * ((value - base.value) / self.unit)
    }

    /// The arc's inner product of two directions.
    pub(super) fn product(
        &self,
        a: &BranchTangent,
        b: &BranchTangent,
        at: &ShootingIterate,
    ) -> f64 {
        weight(at) * dot(&a.points[0], &b.points[0]) + a.rate / self.unit * (b.rate / self.unit)
    }

    fn bordered_system(
        &self,
        iterate: &ShootingIterate,
        value: f64,
        along: &BranchTangent,
        weighed: &ShootingIterate,
    ) -> Bordered {
        let slopes = self.family.slopes(value, iterate, self.unit.min(1.0));
        let Around { matrix: around, offset } = iterate.recurrence(&iterate.defects);
        let Around { offset: by_value, .. } = iterate.recurrence(&slopes);
        let mut matrix = [[0.0; 4]; 4];
        for i in 0..3 {
            for j in 0..3 {
                matrix[i][j] = around[i][j] - IDENTITY[i][j];
            }
            matrix[i][3] = by_value[i] * self.unit;
            matrix[3][i] = weight(weighed) * along.points[0][i];
        }
        matrix[3][3] = along.rate / self.unit;
        Bordered { matrix, offset, slopes }
    }

    /// What rounding of the map leaves uncertain of the parameter's value at a place of the curve.
    pub(super) fn uncertainty(&self, point: &ContinuationPoint) -> f64 {
        let Bordered { matrix, .. } =
            self.bordered_system(&point.iterate, point.value, &point.tangent, &point.iterate);
        let by_row = (0..3).map(|row| {
            let mut right = [0.0; 4];
            right[row] = 1.0;
            solve(matrix, right)[3].abs()
        });
        let largest = point.iterate.points.iter().fold(1.0, |largest, it| size(it).max(largest));
        let rounding = f64::EPSILON * largest * point.iterate.passages.len() as f64;
        by_row.sum::<f64>() * self.unit * rounding + f64::EPSILON * point.value.abs()
    }
}

/// Points and parameter weigh alike when they change by their own size.
fn weight(iterate: &ShootingIterate) -> f64 {
    (1.0 + size(&iterate.points[0])).powi(-2)
}

pub(super) fn shifted(
    points: &[StrobePoint],
    changes: &[StrobePoint],
    share: f64,
) -> Vec<StrobePoint> {
    let pairs = points.iter().zip(changes);
    pairs.map(|(point, change)| std::array::from_fn(|i| point[i] + share * change[i])).collect()
}

fn offsets(defects: &[StrobePoint], slopes: &[StrobePoint], step: f64) -> Vec<StrobePoint> {
    shifted(defects, slopes, step)
}

impl BranchTangent {
    /// The tangent in the opposite direction.
    pub(super) fn turned(&self) -> Self {
        let points = self.points.iter().map(|it| it.map(|x| -x)).collect();
        Self { points, rate: -self.rate }
    }
}

impl ContinuationPoint {
    /// The phases of the whole orbit from wherever they are least: a switch that passes a strobe
    /// does not change them.
    pub(super) fn phase_sequence(&self) -> Vec<Phase> {
        let phases = &self.orbit.phases;
        let turned = (0..phases.len()).map(|k| [&phases[k..], &phases[..k]].concat());
        turned.min().unwrap_or_default()
    }
}
