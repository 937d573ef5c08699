//! What an attractor that is no orbit occupies: small cells of (p, y, q) that a long run has
//! visited.

use super::thresholds::PER_EXTENT;
use crate::dynamics::strobe::StrobePoint;
use std::collections::HashSet;

/// A set of cells.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct CellSet {
    width: f64,
    #[cfg_attr(feature = "serde", serde(serialize_with = "in_order"))]
    visited: HashSet<[i64; 3]>,
}

/// Writes cells in order, so that equal sets are written alike.
#[cfg(feature = "serde")]
fn in_order<S: serde::Serializer>(
    cells: &HashSet<[i64; 3]>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(cells.iter().collect::<std::collections::BTreeSet<_>>())
}

impl CellSet {
    /// The cells in which these points lie.
    pub fn of(points: &[StrobePoint]) -> Self {
        let extent = |i: usize| {
            let (low, high) =
                points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), it| {
                    (a.min(it[i]), b.max(it[i]))
                });
            high - low
        };
        let largest = (0..3).map(extent).fold(f64::MIN_POSITIVE, f64::max);
        let mut cells = Self { width: largest / PER_EXTENT, visited: HashSet::new() };
        cells.add(points);
        cells
    }

    /// Adds the cells of more points.
    pub fn add(&mut self, points: &[StrobePoint]) {
        for point in points {
            self.visited.insert(self.cell(point));
        }
    }

    /// Whether a point lies in one of the cells.
    pub fn hold(&self, point: &StrobePoint) -> bool {
        self.visited.contains(&self.cell(point))
    }

    /// The share of some points that lies in the cells.
    pub fn share(&self, points: &[StrobePoint]) -> f64 {
        points.iter().filter(|point| self.hold(point)).count() as f64 / points.len() as f64
    }

    fn cell(&self, point: &StrobePoint) -> [i64; 3] {
        point.map(|x| (x / self.width).floor() as i64)
    }
}
