//! The co-ordinates in which distances between points of a section are taken.

use super::ReturnAttractor;
use crate::affine::returns::map::SectionMap;
use crate::affine::returns::shooting::{Change, Derivative, MAX_COORDINATES};
use crate::affine::returns::walk::Return;
use crate::affine::run::place::Place;
use crate::dynamics::attractor::coordinates::Coordinates;

/// A point of a section: its mode, and each state over its scale. A drift is zero; the time of an
/// event in a forced system follows the states, within the forcing period.
#[derive(Clone, Debug, PartialEq)]
pub struct Spot {
    pub mode: usize,
    pub at: Change,
    /// The `until` that have fired on the way from the last return, as bits; zero at a start.
    pub way: u64,
}

/// The co-ordinates of a section's points.
#[derive(Clone, Copy, Debug)]
pub struct SectionCoordinates {
    /// The number of co-ordinates.
    pub dimension: usize,
    /// The size of each, zero for a drift.
    sizes: Change,
    /// The time of a forcing period, where points have times.
    turn: Option<f64>,
}

impl SectionCoordinates {
    pub fn new(map: &SectionMap<'_, f64>) -> Self {
        let system = map.system();
        let states = system.states.len();
        let mut sizes = [0.0; MAX_COORDINATES];
        for (n, (size, scale)) in sizes.iter_mut().zip(&system.scales).enumerate() {
            *size = if map.is_drift(n) { 0.0 } else { *scale };
        }
        let turn = map.forcing_period().filter(|_| map.has_times());
        if turn.is_some() {
            sizes[states] = system.time_scale;
        }
        Self { dimension: states + usize::from(turn.is_some()), sizes, turn }
    }

    pub fn spot_of(&self, place: &Place<f64>) -> Spot {
        self.spot_at(place.mode, place.time.value(), &place.state)
    }

    fn spot_at(&self, mode: usize, time: f64, state: &[f64]) -> Spot {
        let mut at = [0.0; MAX_COORDINATES];
        at.iter_mut().zip(state).for_each(|(it, state)| *it = *state);
        if let Some(turn) = self.turn {
            at[state.len()] = time - turn * libm::floor(time / turn);
        }
        for (it, size) in at.iter_mut().zip(&self.sizes) {
            *it = if *size == 0.0 { 0.0 } else { *it / size };
        }
        Spot { mode, at, way: 0 }
    }

    /// A derivative of the map in these co-ordinates.
    pub fn scaled(&self, derivative: &Derivative) -> Derivative {
        let scaled = |i: usize, j: usize| match self.sizes[i] {
            0.0 => 0.0,
            size => derivative[i][j] * self.sizes[j] / size,
        };
        std::array::from_fn(|i| std::array::from_fn(|j| scaled(i, j)))
    }

    /// A place with a change in these co-ordinates.
    pub fn moved(&self, place: &Place<f64>, step: &[f64]) -> Place<f64> {
        let by = |n: usize| step[n] * self.sizes[n];
        let state: Vec<f64> = place.state.iter().enumerate().map(|(n, it)| it + by(n)).collect();
        let delay = if self.turn.is_some() { by(self.dimension - 1) } else { 0.0 };
        place.moved_to(place.time.after(delay), state)
    }
}

impl Coordinates for SectionCoordinates {
    type Point = Return<f64>;
    type Spot = Spot;
    /// The mode.
    type Piece = usize;
    type Step = Change;
    /// The mode, and the place along each co-ordinate.
    type Cell = [i64; MAX_COORDINATES + 1];
    type Attractor = ReturnAttractor;

    fn spot(&self, point: &Return<f64>) -> Spot {
        self.spot_at(point.mode, point.time, &point.state)
    }

    fn at<'s>(&self, spot: &'s Spot) -> &'s [f64] {
        &spot.at[..self.dimension]
    }

    fn counts(&self, coordinate: usize) -> bool {
        self.sizes[coordinate] != 0.0
    }

    /// The change from one spot to another, the shorter way round the forcing angle.
    fn step(&self, from: &Spot, to: &Spot) -> Change {
        let mut step: Change = std::array::from_fn(|n| to.at[n] - from.at[n]);
        if let Some(turn) = self.turn {
            let last = self.dimension - 1;
            let turn = turn / self.sizes[last];
            step[last] -= turn * libm::round(step[last] / turn);
        }
        step
    }

    fn lies_on(&self, mode: &usize, spot: &Spot) -> bool {
        spot.mode == *mode
    }

    fn are_on_one_piece(&self, one: &Spot, other: &Spot) -> bool {
        one.mode == other.mode
    }

    fn cell(&self, spot: &Spot, width: f64) -> Self::Cell {
        let mut cell = [0; MAX_COORDINATES + 1];
        cell[0] = spot.mode as i64;
        for (place, at) in cell[1..].iter_mut().zip(self.at(spot)) {
            *place = libm::floor(at / width) as i64;
        }
        cell
    }

    fn way(&self, spot: &Spot) -> Option<u64> {
        Some(spot.way)
    }

    fn period(attractor: &ReturnAttractor) -> Option<u64> {
        attractor.period().map(|it| it as u64)
    }

    fn points(attractor: &ReturnAttractor) -> &[Return<f64>] {
        &attractor.points
    }
}
