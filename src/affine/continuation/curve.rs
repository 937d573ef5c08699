//! The curve of orbits in (points, parameter): its measure, its tangent, and the bordered system.

use super::super::returns::shooting::{
    Change, Derivative, MAX_COORDINATES, ReturnMap, Shots, identity,
};
use super::super::run::place::Place;
use super::family::{OrbitShots, ReturnFamily};
use super::point::{CurvePoint, Direction};
use super::refusal::Refusal;
use crate::affine::arithmetic::vector::sum_rounding;
use crate::dynamics::linear::{apply, product, solve};
use core::cell::RefCell;

/// The family, the parameter's unit of arc length, and those of the states.
pub(super) struct Curve<'a> {
    pub family: &'a ReturnFamily<'a>,
    pub unit: f64,
    /// The curve by whose points those of this one are shown, if not by their own.
    pub shown: Option<&'a Curve<'a>>,
    /// The end of a piece that was refused last.
    pub refusal: RefCell<Option<Refusal>>,
    scales: Change,
    /// The number of entries of z.
    dimension: usize,
}

/// A change of one image that an event makes in proportion to its rate, of which the square is a
/// smooth function of the point and of the parameter.
pub(super) struct Jump {
    /// The number of the image.
    pub number: usize,
    /// The change, in units of the rate.
    pub change: Change,
    /// The derivative of the rate's square by the point.
    pub by_place: Change,
    /// Its derivative by the parameter.
    pub by_value: f64,
}

/// The dimension of the bordered system: the co-ordinates of a point, and the parameter.
pub(super) const BORDERED_DIMENSION: usize = MAX_COORDINATES + 1;

/// The bordered system: orbits next to shots, and a direction.
pub(super) struct Bordered {
    pub matrix: [[f64; BORDERED_DIMENSION]; BORDERED_DIMENSION],
    pub offset: Change,
}

/// The recurrence from the first point once around: d -> `matrix` d + `offset`.
struct Around {
    matrix: Derivative,
    offset: Change,
}

fn recurrence(shots: &OrbitShots, added: &[Change]) -> Around {
    let mut all = Around { matrix: identity(), offset: [0.0; MAX_COORDINATES] };
    for (image, added) in shots.images.iter().zip(added) {
        all.matrix = product(&image.derivative, &all.matrix);
        all.offset = sum(&apply(&image.derivative, &all.offset), added, 1.0);
    }
    all
}

/// The changes of all points that follow from that of the first.
pub(super) fn spread_changes(shots: &OrbitShots, first: Change, added: &[Change]) -> Vec<Change> {
    let mut changes = vec![first];
    for (image, added) in shots.images.iter().zip(added).take(shots.points.len() - 1) {
        let carried = apply(&image.derivative, &changes[changes.len() - 1]);
        changes.push(sum(&carried, added, 1.0));
    }
    changes
}

pub(super) fn sum(one: &Change, other: &Change, share: f64) -> Change {
    std::array::from_fn(|n| one[n] + share * other[n])
}

impl<'a> Curve<'a> {
    /// The curve of a family whose parameter is followed between two values.
    pub fn new(family: &'a ReturnFamily<'a>, [from, to]: [f64; 2]) -> Option<Self> {
        Self::about(family, from, if from == to { 1.0 } else { (to - from).abs() })
    }

    /// The curve of a family about a value of its parameter, which is measured in this unit.
    pub fn about(family: &'a ReturnFamily<'a>, value: f64, unit: f64) -> Option<Self> {
        let (scales, dimension) = family.at(value, |map| {
            let system = map.system();
            let mut scales = [1.0; MAX_COORDINATES];
            let own = system.scales.iter().chain([&system.time_scale]);
            scales.iter_mut().zip(own).for_each(|(it, own)| *it = *own);
            Some((scales, system.dimension()))
        })?;
        let refusal = RefCell::new(None);
        Some(Self { family, unit, shown: None, refusal, scales, dimension })
    }

    /// The curve, whose points are shown by those of another one.
    pub fn shown_by(self, shown: &'a Curve<'a>) -> Self {
        Self { shown: Some(shown), ..self }
    }

    /// The first point of a branch, from an orbit's places, with the parameter's way.
    pub fn first(&self, value: f64, places: Vec<Place<f64>>, way: f64) -> Option<CurvePoint> {
        let points = vec![[0.0; MAX_COORDINATES]; places.len()];
        let along = Direction { points, rate: self.unit * way };
        let shots = self.family.at(value, |map| Shots::new(map, places))?;
        self.point(value, shots, &along)
    }

    /// The shots of a base's points at a distance along a direction.
    pub fn shifted(
        &self,
        base: &CurvePoint,
        along: &Direction,
        distance: f64,
    ) -> Option<OrbitShots> {
        self.family.at(base.value + distance * along.rate, |map| {
            let moved = base.carried.iter().zip(&along.points).map(|(point, change)| {
                let place = map.take_up(point);
                map.moved(&place, &change.map(|it| it * distance), &place)
            });
            Shots::new(map, moved.collect())
        })
    }

    /// A closed iterate with the curve's direction, which is that of `along` as far as there is a
    /// choice.
    pub fn point(&self, value: f64, shots: OrbitShots, along: &Direction) -> Option<CurvePoint> {
        let slopes = self.family.slopes(value, &shots);
        let tangent = self.tangent(&shots, &slopes, along);
        let orbit = self.family.at(value, |map| map.of_shots(&shots))?;
        let carried = self.family.carry(value, &shots.points)?;
        Some(CurvePoint { value, shots, carried, slopes, tangent, orbit })
    }

    /// The curve's direction at shots.
    pub fn tangent(&self, shots: &OrbitShots, slopes: &[Change], along: &Direction) -> Direction {
        let bordered = self.bordered_system(shots, slopes, along, shots);
        let mut right = [0.0; BORDERED_DIMENSION];
        right[MAX_COORDINATES] = 1.0;
        let (first, rate) = self.unscaled(&solve(bordered.matrix, right));
        let added: Vec<Change> = slopes.iter().map(|it| it.map(|by| by * rate)).collect();
        let mut tangent = Direction { points: spread_changes(shots, first, &added), rate };
        self.normalise(&mut tangent, shots);
        tangent
    }

    /// Makes a direction one of length 1, and gives the length that it had, if it had one.
    fn normalise(&self, along: &mut Direction, at: &OrbitShots) -> Option<f64> {
        let length = self.product(along, along, at).sqrt();
        if !(length > 0.0 && length.is_finite()) {
            return None;
        }
        along.rate /= length;
        along.points.iter_mut().flatten().for_each(|x| *x /= length);
        Some(length)
    }

    /// The direction of the curve on which an event's rate grows from zero, and that growth.
    pub fn direction_with_jump(
        &self,
        shots: &OrbitShots,
        slopes: &[Change],
        jump: &Jump,
    ) -> Option<(Direction, f64)> {
        let mut jumps = vec![[0.0; MAX_COORDINATES]; shots.images.len()];
        jumps[jump.number] = jump.change;
        let Around { matrix: own, offset: by_jump } = recurrence(shots, &jumps);
        let Around { offset: by_value, .. } = recurrence(shots, slopes);
        // The changes of the place that has the event, by those of the first and of the parameter.
        let mut to_place = Around { matrix: identity(), offset: [0.0; MAX_COORDINATES] };
        for (image, slope) in shots.images.iter().zip(slopes).take(jump.number) {
            to_place.matrix = product(&image.derivative, &to_place.matrix);
            to_place.offset = sum(&apply(&image.derivative, &to_place.offset), slope, 1.0);
        }
        let scales = &self.scales;
        let mut matrix = [[0.0; BORDERED_DIMENSION]; BORDERED_DIMENSION];
        let mut right = [0.0; BORDERED_DIMENSION];
        for (i, row) in self.less_identity(&own).iter().enumerate() {
            matrix[i][..MAX_COORDINATES].copy_from_slice(row);
            matrix[i][MAX_COORDINATES] = by_value[i] * self.unit / scales[i];
            right[i] = -by_jump[i] / scales[i];
            let by_first = (0..MAX_COORDINATES).map(|k| jump.by_place[k] * to_place.matrix[k][i]);
            matrix[MAX_COORDINATES][i] = by_first.sum::<f64>() * scales[i];
        }
        let by_value: f64 =
            jump.by_place.iter().zip(&to_place.offset).map(|(a, b)| a * b).sum::<f64>();
        matrix[MAX_COORDINATES][MAX_COORDINATES] = (jump.by_value + by_value) * self.unit;
        let (first, rate) = self.unscaled(&solve(matrix, right));
        let added: Vec<Change> =
            slopes.iter().zip(&jumps).map(|(slope, jump)| sum(jump, slope, rate)).collect();
        let mut along = Direction { points: spread_changes(shots, first, &added), rate };
        let length = self.normalise(&mut along, shots)?;
        Some((along, 1.0 / length))
    }

    /// The units of a point's co-ordinates.
    pub fn scales(&self) -> &Change {
        &self.scales
    }

    /// A solution of the bordered system as a change of the first point and of the parameter.
    pub(super) fn unscaled(&self, solution: &[f64; BORDERED_DIMENSION]) -> (Change, f64) {
        let first = std::array::from_fn(|n| solution[n] * self.scales[n]);
        (first, solution[MAX_COORDINATES] * self.unit)
    }

    /// The arc's inner product of two directions.
    pub fn product(&self, a: &Direction, b: &Direction, at: &OrbitShots) -> f64 {
        let pairs = a.points[0].iter().zip(&b.points[0]).zip(&self.scales);
        let points: f64 = pairs.map(|((a, b), scale)| a / scale * (b / scale)).sum();
        self.weight(at) * points + a.rate / self.unit * (b.rate / self.unit)
    }

    /// Points and parameter weigh alike when they change by their own size.
    fn weight(&self, shots: &OrbitShots) -> f64 {
        (1.0 + self.size(&shots.points[0])).powi(-2)
    }

    fn size(&self, point: &Place<f64>) -> f64 {
        let sizes = point.state.iter().zip(&self.scales).map(|(it, by)| (it / by).abs());
        sizes.fold(0.0, f64::max)
    }

    pub(super) fn bordered_system(
        &self,
        shots: &OrbitShots,
        slopes: &[Change],
        along: &Direction,
        weighed: &OrbitShots,
    ) -> Bordered {
        let Around { matrix: own, offset } = recurrence(shots, &shots.defects);
        let Around { offset: by_value, .. } = recurrence(shots, slopes);
        let (scales, weight) = (&self.scales, self.weight(weighed));
        let mut matrix = [[0.0; BORDERED_DIMENSION]; BORDERED_DIMENSION];
        for (i, row) in self.less_identity(&own).iter().enumerate() {
            matrix[i][..MAX_COORDINATES].copy_from_slice(row);
            matrix[i][MAX_COORDINATES] = by_value[i] * self.unit / scales[i];
            matrix[MAX_COORDINATES][i] = weight * along.points[0][i] / scales[i];
        }
        matrix[MAX_COORDINATES][MAX_COORDINATES] = along.rate / self.unit;
        Bordered { matrix, offset }
    }

    /// A derivative less the identity, in units of the states.
    fn less_identity(&self, derivative: &Derivative) -> Derivative {
        let one = identity();
        std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                (derivative[i][j] - one[i][j]) * self.scales[j] / self.scales[i]
            })
        })
    }

    /// The uncertainty of the parameter's value at a place of the curve that rounding of the map
    /// leaves.
    pub fn uncertainty(&self, point: &CurvePoint) -> f64 {
        let Bordered { matrix, .. } =
            self.bordered_system(&point.shots, &point.slopes, &point.tangent, &point.shots);
        let by_row = (0..MAX_COORDINATES).map(|row| {
            let mut right = [0.0; BORDERED_DIMENSION];
            right[row] = 1.0;
            solve(matrix, right)[MAX_COORDINATES].abs()
        });
        by_row.sum::<f64>() * self.unit * self.rounding(&point.shots)
            + f64::EPSILON * point.value.abs()
    }

    /// The distance in the parameter along a direction of the curve that is as long as what
    /// rounding of the map leaves uncertain of an orbit at one value.
    ///
    /// A corner is where the orbit touches another piece of the map, so that the corner is found
    /// where an uncertain orbit touches it. The orbit is uncertain where a multiplier is near 1,
    /// and so is the curve's direction there: it is taken from where it is known better.
    pub fn blur(&self, point: &CurvePoint, along: &Direction) -> f64 {
        let Around { matrix, .. } = recurrence(&point.shots, &point.shots.defects);
        let apart = self.less_identity(&matrix);
        let by_row = (0..MAX_COORDINATES).map(|row| {
            let mut right = [0.0; MAX_COORDINATES];
            right[row] = 1.0;
            solve(apart, right).iter().map(|it| it * it).sum::<f64>().sqrt()
        });
        let Direction { points, rate } = along;
        let by_state = points[0].iter().zip(&self.scales).map(|(it, scale)| (it / scale).powi(2));
        let length = (by_state.sum::<f64>() + (rate / self.unit).powi(2)).sqrt();
        by_row.sum::<f64>() * self.rounding(&point.shots) * rate.abs() / length
    }

    /// The rounding of the points' images, in units of the states: each segment rounds as many
    /// products as the system has entries.
    fn rounding(&self, shots: &OrbitShots) -> f64 {
        let largest = shots.points.iter().fold(1.0, |most, it| self.size(it).max(most));
        let segments: usize = shots.images.iter().map(|it| it.segments).sum();
        sum_rounding::<f64>(self.dimension) * largest * segments as f64
    }
}
