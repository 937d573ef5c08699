//! The small cells that a long run on an attractor which is no orbit has visited.

use super::coordinates::Coordinates;
use super::thresholds::CELLS_PER_EXTENT;
use std::borrow::Borrow;
use std::collections::HashSet;
use std::hash::{BuildHasherDefault, Hasher};

/// A set of cells.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "C::Cell: serde::Serialize",
        deserialize = "C::Cell: serde::Deserialize<'de>"
    ))
)]
pub(crate) struct CellSet<C: Coordinates> {
    width: f64,
    #[cfg_attr(feature = "serde", serde(serialize_with = "in_order"))]
    visited: HashSet<C::Cell, BuildHasherDefault<CellHasher>>,
}

/// A hasher of whole numbers, each folded in by one wide multiplication. Motions choose the cells,
/// so that none are chosen to collide.
#[derive(Clone, Copy, Debug, Default)]
struct CellHasher(u64);

impl Hasher for CellHasher {
    fn write(&mut self, bytes: &[u8]) {
        for part in bytes.chunks(8) {
            let mut word = [0; 8];
            word[..part.len()].copy_from_slice(part);
            self.write_u64(u64::from_le_bytes(word));
        }
    }

    fn write_u64(&mut self, word: u64) {
        // The fractions of the golden and of the plastic ratio, in 64 bits, have no pattern.
        let folded = u128::from(self.0 ^ word ^ 0x9e37_79b9_7f4a_7c15) * 0xd1b5_4a32_d192_ed03;
        self.0 = (folded as u64) ^ ((folded >> 64) as u64);
    }

    fn finish(&self) -> u64 {
        self.0
    }
}

/// Writes cells in order, so that equal sets are written alike.
#[cfg(feature = "serde")]
fn in_order<T: serde::Serialize + Ord, S: serde::Serializer>(
    cells: &HashSet<T, BuildHasherDefault<CellHasher>>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(cells.iter().collect::<std::collections::BTreeSet<_>>())
}

impl<C: Coordinates> CellSet<C> {
    /// The cells in which these spots lie.
    pub fn new(coordinates: &C, spots: &[C::Spot]) -> Self {
        let dimension = spots.first().map_or(0, |it| coordinates.at(it).len());
        let extent = |n: usize| {
            let ends = (f64::INFINITY, f64::NEG_INFINITY);
            let at = spots.iter().map(|it| coordinates.at(it)[n]);
            let (low, high) = at.fold(ends, |(low, high), it| (low.min(it), high.max(it)));
            high - low
        };
        let largest = (0..dimension).map(extent).fold(f64::MIN_POSITIVE, f64::max);
        let width = largest / CELLS_PER_EXTENT;
        Self { width, visited: spots.iter().map(|it| coordinates.cell(it, width)).collect() }
    }

    /// Whether a spot lies in one of the cells.
    pub fn hold(&self, coordinates: &C, spot: &C::Spot) -> bool {
        self.visited.contains(&coordinates.cell(spot, self.width))
    }

    /// The share of some spots that lies in the cells.
    pub fn share<S: Borrow<C::Spot>>(
        &self,
        coordinates: &C,
        spots: impl Iterator<Item = S>,
    ) -> f64 {
        let (mut held, mut all) = (0_u32, 0_u32);
        for spot in spots {
            held += u32::from(self.hold(coordinates, spot.borrow()));
            all += 1;
        }
        f64::from(held) / f64::from(all)
    }
}
