//! Cuts a plan's points into tiles, the pieces that are dealt to shards.
//!
//! A tile is one of the blocks of a large point, or some small points in a row: as many as keep the
//! number of tiles, and with it the memory of a merge, within bounds. What a point gives does not
//! depend on it.

use super::plan::Plan;
use super::verb::SweepVerb;
use anyhow::{Context, Result, bail};
use std::ops::Range;

/// The most tiles of points that are not cut.
const MAX_WHOLE_TILES: u64 = 1 << 16;

/// The tiles of a plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tiling {
    points: u64,
    /// Tiles of each point; 1 where a tile has whole points.
    blocks: u32,
    /// Points of each tile but the last.
    together: u64,
}

impl Tiling {
    /// The tiles of a plan with this work.
    pub fn new(plan: &Plan, work: &dyn SweepVerb) -> Self {
        Self::from_counts(plan.points(), work.tiles(), plan.shards)
    }

    fn from_counts(points: u64, blocks: u32, shards: u32) -> Self {
        let fit = points.div_ceil(MAX_WHOLE_TILES).min(points / u64::from(shards));
        let together = if blocks == 1 { fit.max(1) } else { 1 };
        Self { points, blocks, together }
    }

    /// The number of tiles.
    pub const fn count(&self) -> u64 {
        self.points.div_ceil(self.together) * self.blocks as u64
    }

    /// Whether points are cut.
    pub const fn cuts_points(&self) -> bool {
        self.blocks > 1
    }

    /// The points of a tile.
    pub fn points_of(&self, tile: u64) -> Range<u64> {
        let from = tile / u64::from(self.blocks) * self.together;
        from..(from + self.together).min(self.points)
    }

    /// Which block of its point a tile is; 0 where points are not cut.
    pub const fn block_of(&self, tile: u64) -> u32 {
        (tile % self.blocks as u64) as u32
    }

    /// The tiles that hold the point or points that a tile belongs to.
    pub fn tiles_beside(&self, tile: u64) -> Range<u64> {
        let blocks = u64::from(self.blocks);
        let from = tile / blocks * blocks;
        from..from + blocks
    }
}

/// Puts the pieces of a tile's points one after the other, each after its length.
pub fn pack(pieces: &[Vec<u8>]) -> Vec<u8> {
    let mut packed = Vec::with_capacity(pieces.iter().map(|it| it.len() + 8).sum());
    for piece in pieces {
        packed.extend_from_slice(&(piece.len() as u64).to_le_bytes());
        packed.extend_from_slice(piece);
    }
    packed
}

/// The pieces of a tile's points.
///
/// # Errors
/// The bytes were not packed so.
pub fn unpack(mut bytes: &[u8]) -> Result<Vec<Vec<u8>>> {
    let mut pieces = Vec::new();
    while !bytes.is_empty() {
        let (length, rest) = bytes.split_first_chunk::<8>().context("a tile is cut")?;
        let length = usize::try_from(u64::from_le_bytes(*length))?;
        if length > rest.len() {
            bail!("a tile is cut");
        }
        let (piece, rest) = rest.split_at(length);
        pieces.push(piece.to_vec());
        bytes = rest;
    }
    Ok(pieces)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a panic is a failed test")]
mod tests {
    use super::*;

    #[test]
    fn tiles_hold_every_point_once_and_are_never_too_many() {
        for (points, blocks, shards) in
            [(1, 1, 1), (65_537, 1, 1), (200_000, 1, 100_000), (1 << 24, 1, 7), (100, 200, 1000)]
        {
            let tiling = Tiling::from_counts(points, blocks, shards);
            let most = MAX_WHOLE_TILES
                .max(2 * u64::from(shards))
                .max(points.min(MAX_WHOLE_TILES) * u64::from(blocks));
            assert!(tiling.count() <= most && tiling.count() >= u64::from(shards), "{tiling:?}");
            let mut next = 0;
            for tile in (0..tiling.count()).step_by(blocks as usize) {
                let of = tiling.points_of(tile);
                assert!(of.start == next && of.end > of.start, "{tiling:?}");
                assert_eq!(tiling.tiles_beside(tile + u64::from(blocks) - 1).start, tile);
                next = of.end;
            }
            assert_eq!(next, points);
        }
    }

    #[test]
    fn what_is_packed_is_unpacked() {
        let pieces = vec![vec![1, 2, 3], vec![], vec![4]];
        assert_eq!(unpack(&pack(&pieces)).unwrap(), pieces);
        assert!(unpack(&pack(&pieces)[..10]).is_err());
    }
}
