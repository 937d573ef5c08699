//! Points that are to be a periodic orbit of a return map, each with its image: multiple shooting,
//! so that every point of an unstable orbit is found to its last digits.

use super::multipliers::orthonormal;
use super::walk::NoReturn;
use crate::affine::model::system::LARGEST_DIMENSION;
use crate::dynamics::linear::{apply, product, solve};
use crate::dynamics::orbit::newton::Shooting;

/// The most co-ordinates of a point: the states, and the time.
pub const MAX_COORDINATES: usize = LARGEST_DIMENSION;

/// A change of a point; entries beyond its co-ordinates are zero.
pub type Change = [f64; MAX_COORDINATES];

/// The derivative of an image; rows and columns beyond the co-ordinates are zero.
pub type Derivative = [[f64; MAX_COORDINATES]; MAX_COORDINATES];

/// Roundings of a segment's closed form and of the state it hands on, in units of eps.
const ROUNDINGS: f64 = 8.0;

/// The smallest change beside the largest one that is not a rounding of it.
const MIN_RELATIVE_CHANGE: f64 = 1e-12;

/// A return map, as Newton's method sees it.
pub trait ReturnMap {
    /// A point of the section, with the label of the piece on which it lies: its mode.
    type Point: Clone;
    /// The part of an image that is no derivative.
    type Way: Clone;

    /// The image of a point.
    ///
    /// # Errors
    /// A motion that does not return.
    fn image(&self, point: &Self::Point) -> Result<Image<Self::Point, Self::Way>, NoReturn>;

    /// The change from one point to another.
    fn change_between(&self, from: &Self::Point, to: &Self::Point) -> Change;

    /// A point with a change, on the piece of another point.
    fn moved(&self, point: &Self::Point, change: &Change, piece: &Self::Point) -> Self::Point;

    /// The units in which changes are of size one, powers of two: what is small beside others is
    /// judged in these.
    fn units(&self) -> Change;

    /// Whether two points lie on one piece.
    fn are_on_one_piece(&self, one: &Self::Point, other: &Self::Point) -> bool;

    /// The size of a change of this point, beside 1 and the point.
    fn size(&self, point: &Self::Point, change: &Change) -> f64;
}

/// The image of a point.
#[derive(Clone, Debug)]
pub struct Image<P, W> {
    /// The next point of the motion.
    pub point: P,
    /// The derivative of its co-ordinates by those of the point.
    pub derivative: Derivative,
    /// The number of segments on the way, each with its roundings.
    pub segments: usize,
    /// The way to the image.
    pub way: W,
}

/// Points that are to be an orbit.
#[derive(Clone, Debug)]
pub struct Shots<P, W> {
    pub points: Vec<P>,
    pub images: Vec<Image<P, W>>,
    /// Image of each point less the next point.
    pub(in crate::affine) defects: Vec<Change>,
    /// The largest defect beside 1 and the point.
    pub residual: f64,
    /// Whether each image lies on the piece of the next point.
    is_joined: bool,
    units: Change,
}

impl<P: Clone, W: Clone> Shots<P, W> {
    /// The motion that begins at a point, for so many returns.
    pub fn follow<M>(map: &M, first: &P, returns: u32) -> Result<Self, NoReturn>
    where
        M: ReturnMap<Point = P, Way = W>,
    {
        let (mut points, mut images) = (vec![first.clone()], Vec::new());
        for _ in 0..returns {
            let image = map.image(&points[points.len() - 1])?;
            points.push(image.point.clone());
            images.push(image);
        }
        points.truncate(returns as usize);
        Ok(Self::join(map, points, images))
    }

    /// These points, each with its image; none where a motion does not return.
    pub fn new<M>(map: &M, points: Vec<P>) -> Option<Self>
    where
        M: ReturnMap<Point = P, Way = W>,
    {
        let images = points.iter().map(|it| map.image(it).ok()).collect::<Option<Vec<_>>>()?;
        Some(Self::join(map, points, images)).filter(|it| it.residual.is_finite())
    }

    fn join<M>(map: &M, points: Vec<P>, images: Vec<Image<P, W>>) -> Self
    where
        M: ReturnMap<Point = P, Way = W>,
    {
        let (defects, units) = (Vec::new(), map.units());
        let mut shots = Self { points, images, defects, residual: 0.0, is_joined: true, units };
        for (k, image) in shots.images.iter().enumerate() {
            let next = &shots.points[(k + 1) % shots.points.len()];
            let defect = map.change_between(next, &image.point);
            let size = map.size(next, &defect);
            if size > shots.residual || size.is_nan() {
                shots.residual = size;
            }
            shots.is_joined &= map.are_on_one_piece(next, &image.point);
            shots.defects.push(defect);
        }
        shots
    }

    /// Whether the points close to the last digits.
    pub fn is_closed(&self) -> bool {
        self.is_closed_to(1.0)
    }

    /// Whether the points close to so many units of the last digits.
    fn is_closed_to(&self, units: f64) -> bool {
        let count = self.images.len();
        let carried = self.images.iter().enumerate().map(|(k, it)| {
            // The roundings of a point lie along the changes that the return to it leaves.
            let before = &self.images[(k + count - 1) % count].derivative;
            let changes = columns(&self.in_units(before));
            let derivative = self.in_units(&it.derivative);
            let largest = changes.iter().map(|it| length(it)).fold(0.0, f64::max);
            let axes = orthonormal(changes, MIN_RELATIVE_CHANGE * largest);
            let grown = axes.iter().map(|axis| {
                let axis: Change = std::array::from_fn(|n| axis[n]);
                length(&apply(&derivative, &axis))
            });
            it.segments as f64 * grown.fold(1.0, f64::max)
        });
        let rounding = ROUNDINGS * f64::EPSILON * carried.fold(1.0, f64::max);
        self.is_joined && self.residual <= units * rounding
    }

    /// The largest entry of the derivatives of the images, in their units.
    pub fn largest_derivative(&self) -> f64 {
        let entries = self.images.iter().flat_map(|it| self.in_units(&it.derivative));
        entries.flatten().fold(0.0, |largest, it| largest.max(it.abs()))
    }

    /// Newton's step for all points: that of the first follows from once around, those of the
    /// others from it.
    fn newton_step(&self) -> Vec<Change> {
        let mut around = identity();
        let mut offset = [0.0; MAX_COORDINATES];
        for (image, defect) in self.images.iter().zip(&self.defects) {
            around = product(&image.derivative, &around);
            offset = sum(&apply(&image.derivative, &offset), defect);
        }
        for (n, row) in around.iter_mut().enumerate() {
            row[n] -= 1.0;
        }
        let right = std::array::from_fn(|n| -offset[n] / self.units[n]);
        let first = solve(self.in_units(&around), right);
        let mut changes = vec![std::array::from_fn(|n| first[n] * self.units[n])];
        let ways = self.images.iter().zip(&self.defects).take(self.points.len() - 1);
        for (image, defect) in ways {
            let carried = apply(&image.derivative, &changes[changes.len() - 1]);
            changes.push(sum(&carried, defect));
        }
        changes
    }

    /// A derivative that acts on changes in their units, and gives them so.
    fn in_units(&self, derivative: &Derivative) -> Derivative {
        let entry = |i: usize, j: usize| derivative[i][j] * self.units[j] / self.units[i];
        std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)))
    }

    /// The largest distance to another orbit's points, which may close sooner.
    pub fn distance<M>(&self, map: &M, other: &[P]) -> f64
    where
        M: ReturnMap<Point = P, Way = W>,
    {
        let pairs = self.points.iter().zip(other.iter().cycle());
        let apart = pairs.map(|(one, other)| match map.are_on_one_piece(one, other) {
            true => map.size(one, &map.change_between(one, other)),
            false => f64::INFINITY,
        });
        apart.fold(0.0, f64::max)
    }
}

impl<M: ReturnMap> Shooting<M> for Shots<M::Point, M::Way> {
    fn period(&self) -> usize {
        self.points.len()
    }

    fn residual(&self) -> f64 {
        self.residual
    }

    fn closes_to(&self, units: f64) -> bool {
        self.is_closed_to(units)
    }

    /// The points with a share of Newton's step made, each on the piece of the image before it.
    fn stepped(&self, map: &M, share: f64) -> Option<Self> {
        let changes = self.newton_step();
        let count = self.points.len();
        let moved = self.points.iter().zip(changes).enumerate().map(|(k, (point, change))| {
            let piece = &self.images[(k + count - 1) % count].point;
            map.moved(point, &change.map(|it| it * share), piece)
        });
        Self::new(map, moved.collect())
    }

    fn first(&self, map: &M, count: usize) -> Option<Self> {
        Self::new(map, self.points[..count].to_vec())
    }

    fn orbit_distance(&self, map: &M, other: &Self) -> f64 {
        self.distance(map, &other.points)
    }

    fn half_way(&self, map: &M, other: &Self) -> Option<Self> {
        let pairs = self.points.iter().zip(other.points.iter().cycle());
        let between = pairs.map(|(one, other)| {
            let half = map.change_between(one, other).map(|it| 0.5 * it);
            map.moved(one, &half, one)
        });
        Self::new(map, between.collect())
    }
}

/// The columns of a derivative.
fn columns(derivative: &Derivative) -> Vec<Vec<f64>> {
    (0..MAX_COORDINATES).map(|n| derivative.iter().map(|row| row[n]).collect()).collect()
}

fn length(change: &[f64]) -> f64 {
    change.iter().map(|it| it * it).sum::<f64>().sqrt()
}

/// The derivative of a map that changes nothing.
pub(in crate::affine) fn identity() -> Derivative {
    std::array::from_fn(|n| std::array::from_fn(|k| if n == k { 1.0 } else { 0.0 }))
}

fn sum(one: &Change, other: &Change) -> Change {
    std::array::from_fn(|n| one[n] + other[n])
}
