//! The distribution of tiles over shards.
//!
//! The costliest tile goes first, each to the shard that has least so far (Graham 1969: the longest
//! shard then takes at most 4/3 of the shortest possible, if costs are known). Ties go by number,
//! so that every program deals alike.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// The shard of each tile.
#[derive(Clone, Debug)]
pub struct Deal {
    /// The tiles of all shards, one shard after the other, each in order.
    tiles: Vec<u64>,
    /// The end of each shard's tiles.
    ends: Vec<usize>,
    cost_of: Vec<u64>,
}

impl Deal {
    /// Deals tiles of the given costs to a number of shards.
    pub fn new(costs: &[u64], shards: u32) -> Self {
        let mut order: Vec<usize> = (0..costs.len()).collect();
        order.sort_by_key(|tile| (Reverse(costs[*tile]), *tile));
        let mut loads: BinaryHeap<_> = (0..shards).map(|shard| Reverse((0_u64, shard))).collect();
        let mut shard_of = vec![0; costs.len()];
        let mut cost_of = vec![0; shards as usize];
        for tile in order {
            let Some(Reverse((load, shard))) = loads.pop() else { break };
            // A tile without events is work as well.
            let load = load.saturating_add(costs[tile].max(1));
            shard_of[tile] = shard;
            cost_of[shard as usize] = load;
            loads.push(Reverse((load, shard)));
        }
        let mut tiles: Vec<u64> = (0..costs.len() as u64).collect();
        tiles.sort_by_key(|tile| shard_of[*tile as usize]);
        let end = |shard| tiles.partition_point(|tile| shard_of[*tile as usize] <= shard);
        let ends = (0..shards).map(end).collect();
        Self { tiles, ends, cost_of }
    }

    /// The tiles of a shard, in order.
    pub fn tiles_of(&self, shard: u32) -> &[u64] {
        let shard = shard as usize;
        let from = shard.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.tiles[from..self.ends[shard]]
    }

    /// The cost of a shard.
    pub fn cost_of(&self, shard: u32) -> u64 {
        self.cost_of[shard as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_tile_belongs_to_one_shard_and_loads_are_even() {
        let costs: Vec<u64> = (0..1000).map(|k| 1 + (k * 7919) % 97).collect();
        let deal = Deal::new(&costs, 16);
        let mut tiles: Vec<u64> = (0..16).flat_map(|shard| deal.tiles_of(shard).to_vec()).collect();
        tiles.sort_unstable();
        assert_eq!(tiles, (0..1000).collect::<Vec<_>>());
        let loads: Vec<u64> = (0..16).map(|shard| deal.cost_of(shard)).collect();
        let mean = costs.iter().sum::<u64>() / 16;
        let longest = *loads.iter().max().unwrap_or(&0);
        // No tile was added to a shard that had more than the mean, and the last ones cost 1.
        assert!(longest <= mean + 2, "{longest} of {mean}");
    }

    #[test]
    fn no_shard_is_empty_where_there_are_as_many_tiles() {
        let deal = Deal::new(&[0, 0, 0, 1_000_000], 4);
        assert!((0..4).all(|shard| deal.tiles_of(shard).len() == 1));
    }
}
