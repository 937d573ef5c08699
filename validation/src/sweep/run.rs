//! Computes the shards of a sweep.

use super::deal::{self, Deal};
use super::folder::{ComputedBy, Folder, Lock};
use super::plan::Plan;
use super::shard::{self, Damage, Identity, Shard, ShardHead};
use super::tiling::{self, Tiling};
use super::verb::SweepVerb;
use anyhow::{Result, bail};
use rayon::prelude::*;
use std::time::{Duration, Instant};

/// The most tiles of a plan: every task and every merge holds what is known of each in memory.
const MAX_TILES: u64 = 1 << 24;
/// The time between two looks at a shard that another process computes.
const POLL_INTERVAL: Duration = Duration::from_millis(20);

/// A sweep that is ready to be computed, looked at or merged.
pub struct Sweep<'a> {
    pub(super) plan: &'a Plan,
    pub(super) work: &'a dyn SweepVerb,
    pub(super) folder: &'a Folder,
    pub(super) tiling: Tiling,
    pub(super) deal: Deal,
    pub(super) identity: Identity,
}

/// Hears how the computation of a sweep goes on.
pub trait SweepObserver: Sync {
    /// A shard's file is there, but cannot be used: why.
    fn on_damage(&self, shard: u32, why: &Damage);
    /// Another process computes this shard as well.
    fn on_duplicate(&self, shard: u32);
    /// Says how many tiles are to be done.
    fn begun(&self, tiles: u64);
    /// One more tile is computed.
    fn tile(&self);
}

impl<'a> Sweep<'a> {
    /// Refuses a plan that has more shards than tiles or too many tiles, or a point that the verb
    /// refuses.
    ///
    /// # Errors
    /// Names what is refused, and says what is accepted.
    pub fn check(plan: &Plan, work: &dyn SweepVerb) -> Result<()> {
        let tiles = Tiling::new(plan, work).count();
        if u64::from(plan.shards) > tiles {
            bail!(
                "shards = {} is not accepted: there are {tiles} tiles, accepted are 1 to {tiles}",
                plan.shards
            );
        }
        if tiles > MAX_TILES {
            bail!(
                "the plan has {tiles} blocks of starts: accepted are at most {MAX_TILES}, by \
                 fewer points or smaller grids"
            );
        }
        (0..plan.points()).try_for_each(|number| {
            let point = plan.point(number);
            work.check(&point).map_err(|error| error.context(format!("at {point}")))
        })
    }

    /// Deals the tiles of a plan that was checked, in a folder that was begun.
    #[must_use]
    pub fn new(plan: &'a Plan, work: &'a dyn SweepVerb, folder: &'a Folder) -> Self {
        let tiling = Tiling::new(plan, work);
        let deal = Deal::new(tiling.count(), plan.shards);
        let identity = Identity { schema: 2, plan: plan.hash.clone(), program: ComputedBy::this() };
        Self { plan, work, folder, tiling, deal, identity }
    }

    /// A shard whose file is there and whole.
    ///
    /// # Errors
    /// Says why there is none.
    pub fn shard(&self, shard: u32) -> Result<Shard, Damage> {
        Shard::open(self.folder, &self.identity, shard, &self.deal.tiles_of(shard))
    }

    /// Computes one shard, unless it is finished.
    ///
    /// # Errors
    /// What the verb objects to, and a folder that cannot be written.
    pub fn run(&self, shard: u32, observer: &dyn SweepObserver) -> Result<()> {
        if self.is_open(shard, observer) {
            observer.begun(self.deal.tiles_of(shard).len() as u64);
            let lock = self.folder.lock(shard)?;
            if !lock.is_ours() && self.folder.is_locked(shard) {
                observer.on_duplicate(shard);
            }
            self.compute(shard, observer)?;
        }
        Ok(())
    }

    /// Computes all shards that are not finished. Processes of other ranks begin at other shards,
    /// far from each other. The shards that another process computes are left to the end, and
    /// waited for as long as the longest of this process took; then they are computed as well.
    ///
    /// # Errors
    /// What the verb objects to, and a folder that cannot be written.
    pub fn run_all(&self, rank: u64, observer: &dyn SweepObserver) -> Result<()> {
        let first = deal::spread(rank, self.plan.shards);
        let shards = (first..self.plan.shards).chain(0..first);
        let open: Vec<u32> = shards.filter(|shard| self.is_open(*shard, observer)).collect();
        let tiles = |shard: &u32| self.deal.tiles_of(*shard).len() as u64;
        observer.begun(open.iter().map(tiles).sum());
        let (mut left, mut longest) = (Vec::new(), Duration::ZERO);
        for shard in open {
            let lock = self.folder.lock(shard)?;
            if !lock.is_ours() && self.folder.is_locked(shard) {
                left.push(shard);
            } else if self.shard(shard).is_err() {
                let begun = Instant::now();
                self.compute(shard, observer)?;
                longest = longest.max(begun.elapsed());
            } else {
                (0..tiles(&shard)).for_each(|_| observer.tile());
            }
        }
        for shard in left {
            let _lock = self.wait_for_lock(shard, longest)?;
            if self.shard(shard).is_err() {
                self.compute(shard, observer)?;
            } else {
                (0..tiles(&shard)).for_each(|_| observer.tile());
            }
        }
        Ok(())
    }

    /// The lock of a shard that another process computes, once that is free, or held by the other
    /// for longer than is waited: the lock of a machine that is lost may stay.
    fn wait_for_lock(&self, shard: u32, patience: Duration) -> Result<Lock> {
        let begun = Instant::now();
        loop {
            let lock = self.folder.lock(shard)?;
            if lock.is_ours() || begun.elapsed() >= patience {
                return Ok(lock);
            }
            std::thread::sleep(POLL_INTERVAL);
        }
    }

    fn is_open(&self, shard: u32, observer: &dyn SweepObserver) -> bool {
        match self.shard(shard) {
            Ok(_) => false,
            Err(Damage::Missing) => true,
            Err(why) => {
                observer.on_damage(shard, &why);
                true
            }
        }
    }

    fn compute(&self, shard: u32, observer: &dyn SweepObserver) -> Result<()> {
        let begun = Instant::now();
        let numbers = self.deal.tiles_of(shard);
        let compute = |tile: &u64| {
            let done = self.tile(*tile);
            observer.tile();
            done
        };
        // A block of a point is large, and takes all threads itself.
        let tiles: Result<Vec<Vec<u8>>> = if self.tiling.cuts_points() {
            numbers.iter().map(compute).collect()
        } else {
            numbers.par_iter().map(compute).collect()
        };
        self.keep(shard, begun.elapsed(), &tiles?)
    }

    /// Computes one tile.
    fn tile(&self, tile: u64) -> Result<Vec<u8>> {
        let block = self.tiling.block_of(tile);
        let piece = |number: u64| {
            let point = self.plan.point(number);
            let done = self.work.tile(&point, block);
            done.map_err(|error| error.context(format!("at {point}")))
        };
        let pieces: Result<Vec<Vec<u8>>> = self.tiling.points_of(tile).map(piece).collect();
        Ok(tiling::pack(&pieces?))
    }

    /// Writes a shard's tiles, which took so long.
    fn keep(&self, shard: u32, took: Duration, tiles: &[Vec<u8>]) -> Result<()> {
        // Another worker may have finished it, and a merge may be reading that.
        if self.shard(shard).is_ok() {
            return Ok(());
        }
        let numbers = self.deal.tiles_of(shard);
        let lengths = tiles.iter().map(|it| it.len() as u64);
        let head = ShardHead {
            identity: self.identity.clone(),
            shard,
            seconds: took.as_secs_f64(),
            tiles: numbers.iter().copied().zip(lengths).collect(),
        };
        shard::write(self.folder, &head, tiles)
    }
}
