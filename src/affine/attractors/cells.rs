//! The small cells that a long run on an attractor which is no orbit has visited.

use super::space::Spot;
use crate::affine::returns::shooting::MOST;
use crate::dynamics::attractor::thresholds::PER_EXTENT;
use std::collections::HashSet;

/// A set of cells, each by its mode and its place along each co-ordinate.
#[derive(Clone, Debug)]
pub struct CellSet {
    width: f64,
    dimension: usize,
    visited: HashSet<Box<[i64]>>,
}

impl CellSet {
    /// The cells in which these spots of so many co-ordinates lie.
    pub fn of(spots: &[Spot], dimension: usize) -> Self {
        let extent = |n: usize| {
            let ends = (f64::INFINITY, f64::NEG_INFINITY);
            let (low, high) =
                spots.iter().fold(ends, |(a, b), it| (a.min(it.at[n]), b.max(it.at[n])));
            high - low
        };
        let largest = (0..dimension).map(extent).fold(f64::MIN_POSITIVE, f64::max);
        let mut cells = Self { width: largest / PER_EXTENT, dimension, visited: HashSet::new() };
        for spot in spots {
            let cell = cells.cell(spot);
            if !cells.visited.contains(&cell[..=dimension]) {
                cells.visited.insert(cell[..=dimension].into());
            }
        }
        cells
    }

    /// Whether a spot lies in one of the cells.
    pub fn hold(&self, spot: &Spot) -> bool {
        self.visited.contains(&self.cell(spot)[..=self.dimension])
    }

    /// The share of some spots that lies in the cells.
    pub fn share(&self, spots: &[Spot]) -> f64 {
        spots.iter().filter(|it| self.hold(it)).count() as f64 / spots.len() as f64
    }

    fn cell(&self, spot: &Spot) -> [i64; MOST + 1] {
        let place = |n: usize| libm::floor(spot.at[n] / self.width) as i64;
        std::array::from_fn(|n| if n == 0 { spot.mode as i64 } else { place(n - 1) })
    }
}
