//! The distribution of tiles over shards.
//!
//! Every round of as many tiles as there are shards gives one tile to each, so that shards differ
//! by one tile at most. Neighbours cost about the same, which makes rounds even; and each round
//! begins at a shard that a hash of its number names, so that no period in the costs of tiles, as
//! of the blocks of a point, falls on the same shards again and again. Shards that are dealt by a
//! count of events are no more even, as the measurements in docs/SWEEPS.md tell.

/// The shard of each tile.
#[derive(Clone, Copy, Debug)]
pub struct Deal {
    tiles: u64,
    shards: u32,
}

/// The fractional part of the golden ratio, in units of 2^-64.
const GOLDEN_FRACTION: u64 = 0x9E37_79B9_7F4A_7C15;

impl Deal {
    /// Deals a number of tiles to at most as many shards.
    pub const fn new(tiles: u64, shards: u32) -> Self {
        Self { tiles, shards }
    }

    /// The tiles of a shard, in order.
    pub fn tiles_of(self, shard: u32) -> Vec<u64> {
        let shards = u64::from(self.shards);
        let tile_of = |round: u64| {
            let first = mixed(round) % shards;
            round * shards + (u64::from(shard) + shards - first) % shards
        };
        let rounds = 0..self.tiles.div_ceil(shards);
        rounds.map(tile_of).filter(|tile| *tile < self.tiles).collect()
    }
}

/// A number that has nothing of the order of its argument: 0 of 0 (the last step of SplitMix64,
/// Steele, Lea and Flood 2014).
const fn mixed(number: u64) -> u64 {
    let number = (number ^ (number >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let number = (number ^ (number >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    number ^ (number >> 31)
}

/// The place of a number among some places, over which any numbers in a row are spread evenly: by
/// the multiples of the golden ratio, without their integer parts.
pub fn spread(number: u64, places: u32) -> u32 {
    let share = number.wrapping_mul(GOLDEN_FRACTION);
    ((u128::from(share) * u128::from(places)) >> 64) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_tile_belongs_to_one_shard_and_shards_have_as_many() {
        for (tiles, shards) in [(1, 1), (7, 7), (8, 7), (1000, 16), (1001, 64), (100, 99)] {
            let deal = Deal::new(tiles, shards);
            let of_shards: Vec<_> = (0..shards).map(|shard| deal.tiles_of(shard)).collect();
            let (least, rest) = (tiles / u64::from(shards), tiles % u64::from(shards));
            let larger = of_shards.iter().filter(|it| it.len() as u64 == least + 1).count();
            assert_eq!(larger as u64, rest);
            assert!(of_shards.iter().all(|it| it.is_sorted() && it.len() as u64 >= least));
            let mut all = of_shards.concat();
            all.sort_unstable();
            assert_eq!(all, (0..tiles).collect::<Vec<_>>());
        }
    }

    /// Every fourth tile costs all, as a block that holds the long motions of each point.
    #[test]
    fn no_period_in_the_costs_falls_on_one_shard() {
        for shards in [4, 16, 64, 220] {
            let deal = Deal::new(100 * u64::from(shards), shards);
            let is_costly = |tile: &&u64| tile.is_multiple_of(4);
            let cost_of = |shard| deal.tiles_of(shard).iter().filter(is_costly).count();
            let costs: Vec<usize> = (0..shards).map(cost_of).collect();
            // Each shard has 100 tiles, of which chance makes 25 costly, with a deviation of 4.3:
            // three of these on each side. The same tiles of each round would be 0 or 100.
            assert!(costs.iter().all(|cost| (12..=38).contains(cost)), "{shards}: {costs:?}");
        }
    }

    #[test]
    fn any_numbers_in_a_row_are_spread() {
        for from in [0, 1000, u64::MAX / 3] {
            let mut places: Vec<u32> = (from..from + 100).map(|it| spread(it, 100_000)).collect();
            places.sort_unstable();
            // The gaps of such a sequence are at most 1 + 1.618 times the mean one.
            let widest = places.windows(2).map(|it| it[1] - it[0]).max();
            assert!(widest < Some(2618), "{widest:?}");
        }
    }
}
