//! As many strobes as the period, each with its image one forcing period later.

use super::super::linear::{IDENTITY, apply, norm, product, solve};
use super::super::strobe::{Jacobian, Passage, StrobeMap, StrobePoint};
use super::newton::Shooting;
use super::{LARGEST_PERIOD, NoOrbit, Reason};
use crate::phase::Phase;

/// Roundings of a phase's closed form and of the state it hands on, in units of eps.
const ROUNDINGS: f64 = 8.0;

/// Strobes that are to be an orbit.
#[derive(Clone, Debug)]
pub(crate) struct ShootingIterate {
    /// p, y, q of each strobe.
    pub(crate) points: Vec<StrobePoint>,
    /// The passages over one forcing period, one from each strobe.
    pub(crate) passages: Vec<Passage>,
    /// The derivative of the strobe map at each of these strobes.
    pub(crate) jacobians: Vec<Jacobian>,
    /// Image of each strobe less the next one.
    pub(crate) defects: Vec<StrobePoint>,
    /// The largest defect over 1 + |strobe|.
    pub(crate) residual: f64,
}

/// The iterate's linear recurrence from the first strobe once around: d -> `matrix` d + `offset`.
pub(crate) struct Around {
    pub(crate) matrix: Jacobian,
    pub(crate) offset: StrobePoint,
}

impl ShootingIterate {
    /// The motion that begins at a point, for `period` forcing periods.
    pub(crate) fn shot(map: &StrobeMap, guess: StrobePoint, period: u32) -> Result<Self, NoOrbit> {
        if !(1..=LARGEST_PERIOD).contains(&period) {
            return Err(Reason::Period(period).into());
        }
        let first = map.entry(guess).map_err(Reason::Guess)?;
        let strobes = map.strobes(first, u64::from(period) - 1);
        let points: Vec<_> = strobes.map(|strobe| strobe.point()).collect();
        Self::new(map, &points).ok_or_else(|| Reason::Escaped.into())
    }

    /// These strobes, each with its own forcing period; none where one is out of range.
    pub(crate) fn new(map: &StrobeMap, points: &[StrobePoint]) -> Option<Self> {
        let count = points.len();
        let mut iterate = Self {
            points: Vec::with_capacity(count),
            passages: Vec::with_capacity(count),
            jacobians: Vec::with_capacity(count),
            defects: Vec::with_capacity(count),
            residual: 0.0,
        };
        for point in points {
            let entry = map.entry(*point).ok()?;
            let passage = map.passage(&entry, 1);
            iterate.points.push(entry.point());
            iterate.jacobians.push(passage.free_jacobian());
            iterate.passages.push(passage);
        }
        for (k, passage) in iterate.passages.iter().enumerate() {
            let next = iterate.points[(k + 1) % count];
            let image = passage.point();
            let defect: StrobePoint = std::array::from_fn(|i| image[i] - next[i]);
            let residual = size(&defect) / (1.0 + size(&next));
            if residual > iterate.residual || residual.is_nan() {
                iterate.residual = residual;
            }
            iterate.defects.push(defect);
        }
        iterate.residual.is_finite().then_some(iterate)
    }

    /// What rounding leaves of the residual: a phase's roundings, carried to the period's end.
    pub(crate) fn rounding(&self) -> f64 {
        let carried = self
            .passages
            .iter()
            .zip(&self.jacobians)
            .map(|(passage, jacobian)| passage.phases.len() as f64 * norm(jacobian).max(1.0));
        ROUNDINGS * f64::EPSILON * carried.fold(1.0, f64::max)
    }

    /// Once around for changes of the first strobe, each strobe's defect (or whatever stands in its
    /// place) being added on the way.
    pub(crate) fn recurrence(&self, defects: &[StrobePoint]) -> Around {
        let mut around = Around { matrix: IDENTITY, offset: [0.0; 3] };
        for (jacobian, defect) in self.jacobians.iter().zip(defects) {
            around.matrix = product(jacobian, &around.matrix);
            let carried = apply(jacobian, &around.offset);
            around.offset = std::array::from_fn(|i| carried[i] + defect[i]);
        }
        around
    }

    /// The changes of all strobes that follow from that of the first.
    pub(crate) fn spread_changes(
        &self,
        first: StrobePoint,
        defects: &[StrobePoint],
    ) -> Vec<StrobePoint> {
        let mut changes = vec![first];
        for (jacobian, defect) in self.jacobians.iter().zip(defects).take(self.points.len() - 1) {
            let carried = apply(jacobian, &changes[changes.len() - 1]);
            changes.push(std::array::from_fn(|i| carried[i] + defect[i]));
        }
        changes
    }

    /// Newton's step for all strobes.
    pub(crate) fn newton_step(&self) -> Vec<StrobePoint> {
        let Around { matrix, offset } = self.recurrence(&self.defects);
        let less_identity = std::array::from_fn(|row| {
            std::array::from_fn(|column| matrix[row][column] - IDENTITY[row][column])
        });
        let first = solve(less_identity, offset.map(|x| -x));
        self.spread_changes(first, &self.defects)
    }

    /// The phases of the whole orbit: one that goes on over a strobe, the first one's too, is one.
    pub(crate) fn phases(&self) -> Vec<Phase> {
        let mut phases: Vec<Phase> =
            self.passages.iter().flat_map(|it| it.phases.iter().copied()).collect();
        phases.dedup();
        while phases.len() > 1 && phases.first() == phases.last() {
            phases.pop();
        }
        phases
    }

    /// Drift over the whole orbit.
    pub(crate) fn drift(&self) -> f64 {
        self.passages.iter().map(|passage| passage.image.v()).sum()
    }

    /// Whether both meet the same phases strobe by strobe: then they lie on one smooth piece of the
    /// map.
    pub(crate) fn is_on_piece_of(&self, other: &Self) -> bool {
        let pairs = self.passages.iter().zip(&other.passages);
        self.passages.len() == other.passages.len()
            && pairs.into_iter().all(|(a, b)| a.phases == b.phases)
    }

    /// The largest distance of its two halves; of an odd number of strobes infinite.
    pub(crate) fn width(&self) -> f64 {
        let mut turned = self.clone();
        turned.points.rotate_left(self.points.len() / 2);
        if self.points.len().is_multiple_of(2) { self.distance(&turned) } else { f64::INFINITY }
    }

    /// The largest distance to another iterate's strobes, over 1 + |strobe|; the other one may
    /// close sooner.
    pub(crate) fn distance(&self, other: &Self) -> f64 {
        let others = other.points.iter().cycle();
        let apart = self.points.iter().zip(others).map(|(a, b)| {
            let apart: StrobePoint = std::array::from_fn(|i| a[i] - b[i]);
            size(&apart) / (1.0 + size(a))
        });
        apart.fold(0.0, f64::max)
    }
}

impl Shooting<StrobeMap> for ShootingIterate {
    fn period(&self) -> usize {
        self.points.len()
    }

    fn residual(&self) -> f64 {
        self.residual
    }

    fn closes_to(&self, units: f64) -> bool {
        self.residual <= units * self.rounding()
    }

    fn stepped(&self, map: &StrobeMap, share: f64) -> Option<Self> {
        let moved = self.points.iter().zip(self.newton_step());
        let points: Vec<StrobePoint> = moved
            .map(|(point, change)| std::array::from_fn(|i| point[i] + share * change[i]))
            .collect();
        Self::new(map, &points)
    }

    fn first(&self, map: &StrobeMap, count: usize) -> Option<Self> {
        Self::new(map, &self.points[..count])
    }

    fn orbit_distance(&self, _: &StrobeMap, other: &Self) -> f64 {
        self.distance(other)
    }

    fn half_way(&self, map: &StrobeMap, other: &Self) -> Option<Self> {
        let pairs = self.points.iter().zip(other.points.iter().cycle());
        let between: Vec<StrobePoint> =
            pairs.map(|(a, b)| std::array::from_fn(|i| 0.5 * (a[i] + b[i]))).collect();
        Self::new(map, &between)
    }
}

/// The largest modulus.
pub(crate) fn size(point: &StrobePoint) -> f64 {
    point.iter().fold(0.0, |size: f64, x| if size >= x.abs() { size } else { x.abs() })
}
