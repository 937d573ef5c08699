//! The orbit of twice the period that branches off at a flip.

use super::point::{BranchTangent, ContinuationPoint, FamilyCurve};
use super::{Bifurcation, Branch, Family};
use crate::dynamics::linear::{IDENTITY, adjugate, norm};
use crate::dynamics::orbit::newton::solve;
use crate::dynamics::orbit::{Around, Orbit, ShootingIterate, size};
use crate::dynamics::strobe::StrobePoint;

/// The side of a flip on which the doubled orbit exists.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Criticality {
    /// The doubled orbit exists where the orbit that doubles has one more multiplier below -1: it
    /// hands its stability on.
    Supercritical,
    /// The doubled orbit exists where the orbit that doubles has one multiplier less below -1: an
    /// orbit that was stable loses its stability to nothing near.
    Subcritical,
}

/// What branches off at a flip.
#[derive(Clone, Debug)]
pub struct Doubling {
    /// Sub- or supercritical.
    pub criticality: Criticality,
    /// The doubled orbits from next to the flip up to where the parameter's interval, or the
    /// branch, ends.
    pub branch: Branch,
}

/// Amplitudes at which the doubled branch is looked for. The parameter moves with the square of the
/// first, well above rounding; the smaller are for flips close to a corner.
const AMPLITUDES: [f64; 6] = [1e-4, 3e-5, 3e-4, 1e-3, 3e-3, 1e-5];

impl Doubling {
    /// The doubled branch at a flip, followed until the parameter leaves the interval from `from`
    /// to `to`; none if no doubled orbit is found. `progress` is told where the parameter is in it,
    /// 0 to 1.
    pub fn new(
        family: &Family,
        flip: &Bifurcation,
        from: f64,
        to: f64,
        progress: &mut dyn FnMut(f64),
    ) -> Option<Self> {
        let curve = FamilyCurve::new(family, from, to);
        let doubled = curve.doubled_orbit(flip)?;
        let criticality = curve.criticality(flip, &doubled)?;
        let branch = Branch::follow_from(&curve, [from, to], doubled, progress);
        Some(Self { criticality, branch })
    }
}

impl FamilyCurve {
    fn doubled_orbit(&self, flip: &Bifurcation) -> Option<ContinuationPoint> {
        let map = self.family.map(flip.value).ok()?;
        let single = ShootingIterate::new(&map, &flip.orbit.points)?;
        let first = flipped(&single)?;
        let none = vec![[0.0; 3]; single.points.len()];
        let there = single.spread_changes(first, &none);
        let back = there.iter().map(|it| it.map(|x| -x));
        let scale = (1.0 + size(&single.points[0])) / size(&first);
        let points: Vec<StrobePoint> =
            there.iter().copied().chain(back).map(|it| it.map(|x| x * scale)).collect();
        let iterate =
            ShootingIterate::new(&map, &[&flip.orbit.points[..], &flip.orbit.points].concat())?;
        let orbit = Orbit::new(&iterate);
        let base = ContinuationPoint {
            value: flip.value,
            iterate,
            tangent: BranchTangent { points, rate: 0.0 },
            orbit,
        };
        AMPLITUDES.iter().find_map(|amplitude| {
            let point = self.corrected_point(&base, *amplitude)?;
            (point.iterate.width() > 0.1 * amplitude).then_some(point)
        })
    }

    fn criticality(&self, flip: &Bifurcation, doubled: &ContinuationPoint) -> Option<Criticality> {
        let offset = doubled.value - flip.value;
        let below = |value: f64| {
            let map = self.family.map(value).ok()?;
            let iterate = solve(&map, ShootingIterate::new(&map, &flip.orbit.points)?).ok()?;
            let multipliers = Orbit::new(&iterate).multipliers;
            Some(multipliers.iter().filter(|it| it[1] == 0.0 && it[0] < -1.0).count())
        };
        match below(flip.value + offset)?.cmp(&below(flip.value - offset)?) {
            std::cmp::Ordering::Greater => Some(Criticality::Supercritical),
            std::cmp::Ordering::Less => Some(Criticality::Subcritical),
            std::cmp::Ordering::Equal => None,
        }
    }
}

/// The direction that once around turns into its opposite: any column of the adjugate of M + 1, of
/// which the largest has lost least.
fn flipped(iterate: &ShootingIterate) -> Option<StrobePoint> {
    let Around { matrix, .. } = iterate.recurrence(&iterate.defects);
    let plus: [StrobePoint; 3] =
        std::array::from_fn(|i| std::array::from_fn(|j| matrix[i][j] + IDENTITY[i][j]));
    let adjugate = adjugate(&plus);
    let columns = (0..3).map(|j| adjugate.map(|row| row[j]));
    let largest = columns.max_by(|a, b| size(a).total_cmp(&size(b)))?;
    (norm(&adjugate) > 0.0 && size(&largest).is_finite()).then_some(largest)
}
