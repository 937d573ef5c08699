//! A grid of starts in blocks of whole rows, which know nothing of each other.
//!
//! What a block finds depends on its own starts only, so that blocks can be labelled in any order,
//! by any number of programs, and joined to the same [`Basins`].

use super::Attractor;
use super::catalog::place_of;
use super::grid::{Basins, Grid};
use super::known::Label;
use super::limits::SearchLimits;
use super::strobe_catalog::AttractorCatalog;
use super::strobes::{Known, StrobeCoordinates};
use super::thresholds::LATTICE_SIDE;
use crate::dynamics::strobe::StrobeMap;
use std::ops::Range;

/// A block has as many whole rows as hold this number of starts: enough to make the search for
/// attractors that precedes each block a small part of the work, which is 256 starts.
const MIN_BLOCK_STARTS: u32 = 1 << 16;

/// Labels the starts of a grid, block by block.
#[derive(Clone, Debug)]
pub struct BlockLabeller {
    grid: Grid,
    /// The attractors that are known before any block is begun.
    shared: AttractorCatalog,
}

/// The labels of some rows of a grid, with the attractors that were met on the way.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LabelledBlock {
    /// The attractors that all blocks of the grid know: told by the first block alone.
    shared: Vec<Attractor>,
    /// How many attractors all blocks know.
    shared_count: usize,
    /// The attractors that only starts of this block have led to.
    found: Vec<Known>,
    /// The numbers of the labels ([`Label::number`]): places among the shared attractors, then
    /// among those found.
    labels: Vec<i32>,
}

impl Grid {
    /// How many blocks the grid is labelled in; it depends on nothing but the grid's sides.
    #[must_use]
    pub fn blocks(&self) -> u32 {
        self.rows.div_ceil(self.rows_of_block())
    }

    /// The rows of a block.
    #[must_use]
    pub fn rows_of(&self, block: u32) -> Range<u32> {
        let from = block.saturating_mul(self.rows_of_block()).min(self.rows);
        from..from.saturating_add(self.rows_of_block()).min(self.rows)
    }

    fn rows_of_block(&self) -> u32 {
        MIN_BLOCK_STARTS.div_ceil(self.columns.max(1))
    }
}

impl BlockLabeller {
    /// Looks for attractors from a coarse lattice of the grid's window, as [`Basins::new`] does.
    #[must_use]
    pub fn new(map: &StrobeMap, grid: &Grid, limits: impl Into<SearchLimits>) -> Self {
        let mut shared = AttractorCatalog::new(*map, limits);
        let lattice = Grid { columns: LATTICE_SIDE, rows: LATTICE_SIDE, ..*grid };
        shared.label_all(&lattice.starts(), &|_| {});
        Self { grid: *grid, shared }
    }

    /// Labels the starts of one block; `seen` is told of how many starts more the label is known.
    #[must_use]
    pub fn label(&self, block: u32, seen: &(dyn Fn(u64) + Sync)) -> LabelledBlock {
        let mut catalog = self.shared.clone();
        let labels = catalog.label_all(&self.grid.starts_of(self.grid.rows_of(block)), seen);
        let shared_count = self.shared.known().len();
        let shared = if block == 0 { self.shared.attractors().cloned().collect() } else { vec![] };
        LabelledBlock {
            shared,
            shared_count,
            found: catalog.known()[shared_count..].to_vec(),
            labels: labels.into_iter().map(Label::number).collect(),
        }
    }
}

impl Basins {
    /// Labels every start of a grid.
    ///
    /// `limits` say how many forcing periods a start is followed at first (a number alone is that),
    /// and how long orbits may be; `seen` is told of how many starts more the label is known.
    #[must_use]
    pub fn new(
        map: &StrobeMap,
        grid: &Grid,
        limits: impl Into<SearchLimits>,
        seen: &(dyn Fn(u64) + Sync),
    ) -> Self {
        let labeller = BlockLabeller::new(map, grid, limits);
        Self::joined(*grid, (0..grid.blocks()).map(|block| labeller.label(block, seen)))
    }

    /// Joins all blocks of a grid, given in their order. An attractor that several blocks found
    /// is one.
    #[must_use]
    pub fn joined(grid: Grid, blocks: impl IntoIterator<Item = LabelledBlock>) -> Self {
        let mut shared = Vec::new();
        let mut found: Vec<Known> = Vec::new();
        let mut labels = Vec::with_capacity(grid.len());
        for block in blocks {
            shared.extend(block.shared);
            let places: Vec<usize> = block
                .found
                .into_iter()
                .map(|new| place_of(&StrobeCoordinates, &mut found, new))
                .collect();
            let joined = |number: i32| match usize::try_from(number) {
                Ok(place) if place < block.shared_count => Label::Attractor(place),
                Ok(place) => match places.get(place - block.shared_count) {
                    Some(late) => Label::Attractor(block.shared_count + late),
                    None => Label::Unresolved,
                },
                Err(_) if number == Label::Escaping.number() => Label::Escaping,
                Err(_) => Label::Unresolved,
            };
            labels.extend(block.labels.into_iter().map(joined));
        }
        shared.extend(found.into_iter().map(|known| known.attractor));
        Self::sorted(grid, &shared, labels)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::attractor::Window;
    use crate::dynamics::attractor::strobes::known_point;

    /// An attractor of period 1 at a place on the p axis.
    fn at(p: f64) -> Known {
        known_point([p, 0.0, 0.0], 1e-3)
    }

    fn grid(columns: u32, rows: u32) -> Grid {
        Grid { window: Window { p: [0.0, 1.0], y: [0.0, 1.0] }, columns, rows, q: 0.0 }
    }

    #[test]
    fn blocks_have_whole_rows_and_leave_none_out() {
        for (columns, rows) in [(1, 1), (4000, 4000), (700, 100), (1, 1 << 24), (1 << 24, 1)] {
            let grid = grid(columns, rows);
            let mut next = 0;
            for block in 0..grid.blocks() {
                let of = grid.rows_of(block);
                assert!(of.start == next && of.end > of.start, "{columns} x {rows}: {of:?}");
                next = of.end;
            }
            assert_eq!(next, rows);
        }
        assert_eq!(grid(256, 256).blocks(), 1);
        assert_eq!(grid(256, 257).blocks(), 2);
    }

    #[test]
    fn what_two_blocks_have_found_is_one_attractor() {
        let first = LabelledBlock {
            shared: vec![at(0.5).attractor],
            shared_count: 1,
            found: vec![at(0.9)],
            labels: vec![0, 1, -1],
        };
        let second = LabelledBlock {
            shared: vec![],
            shared_count: 1,
            found: vec![at(0.1), at(0.9)],
            labels: vec![2, 1, -2],
        };
        let basins = Basins::joined(grid(3, 2), [first, second]);
        let places: Vec<f64> = basins.attractors.iter().map(Attractor::smallest_p).collect();
        assert_eq!(places, [0.1, 0.5, 0.9]);
        let numbers: Vec<i32> = basins.labels.iter().map(|it| it.number()).collect();
        assert_eq!(numbers, [1, 2, -1, 2, 0, -2]);
    }
}
