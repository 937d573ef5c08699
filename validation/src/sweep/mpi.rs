//! A sweep by the ranks of an MPI job: rank 0 hands out tiles, one after the other, to whoever is
//! free, and writes a shard when all its tiles are back.

use super::folder::Lock;
use super::run::{Sweep, SweepObserver};
use anyhow::{Context, Result, anyhow};
use mpi::collective::SystemOperation;
use mpi::environment::Universe;
use mpi::traits::{Communicator, CommunicatorCollectives, Destination, Source};
use rayon::ThreadPool;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::time::Instant;

/// Variables that the launchers of MPI jobs set.
const LAUNCHED: [&str; 4] = ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK", "MPI_LOCALNRANKS"];

/// The tile that tells a rank that there are no more.
const NO_MORE: u64 = u64::MAX;

/// The ranks of the job that this process is one of.
pub struct Ranks {
    universe: Universe,
}

/// What a rank sends: nothing at first, then what it has computed.
#[derive(Serialize, Deserialize)]
struct Computed {
    tile: u64,
    outcome: Result<Vec<u8>, String>,
}

/// A shard of which tiles are still under way.
struct OpenShard {
    begun: Instant,
    /// The tiles that are back, by number.
    tiles: BTreeMap<u64, Vec<u8>>,
    /// The lock that marks the shard as being computed.
    _lock: Lock,
}

impl Ranks {
    /// The ranks of an MPI job, if a launcher has started this process.
    #[must_use]
    pub fn of_job() -> Option<Self> {
        let launched = LAUNCHED.iter().any(|name| std::env::var_os(name).is_some());
        let universe = if launched { mpi::initialize() } else { None };
        universe.filter(|it| it.world().size() > 1).map(|universe| Self { universe })
    }

    /// Whether this is the rank that hands out tiles.
    #[must_use]
    pub fn is_first(&self) -> bool {
        self.universe.world().rank() == 0
    }

    /// Waits until all ranks have come here; whether all of them are well.
    #[must_use]
    pub fn are_well(&self, this_is: bool) -> bool {
        let mut all = 0;
        let least = SystemOperation::min();
        self.universe.world().all_reduce_into(&u8::from(this_is), &mut all, least);
        all == 1
    }

    /// Takes part in the computation of all shards that are not finished. Rank 0 returns when they
    /// are; the others when there is nothing left to begin.
    ///
    /// # Errors
    /// On rank 0, what the verb objects to, and a folder that cannot be written.
    pub fn run(
        &self,
        sweep: &Sweep<'_>,
        pool: &ThreadPool,
        observer: &dyn SweepObserver,
    ) -> Result<()> {
        if self.is_first() { self.hand_out(sweep, observer) } else { self.work(sweep, pool) }
    }

    // MPI is called by the main thread only, as it demands of who has asked for no more.
    fn work(&self, sweep: &Sweep<'_>, pool: &ThreadPool) -> Result<()> {
        let world = self.universe.world();
        let first = world.process_at_rank(0);
        first.send(&[0_u8; 0][..]);
        loop {
            let (tile, _) = first.receive::<u64>();
            if tile == NO_MORE {
                return Ok(());
            }
            let outcome = pool.install(|| sweep.tile(tile)).map_err(|error| format!("{error:#}"));
            first.send(&postcard::to_stdvec(&Computed { tile, outcome })?[..]);
        }
    }

    fn hand_out(&self, sweep: &Sweep<'_>, observer: &dyn SweepObserver) -> Result<()> {
        let world = self.universe.world();
        let mut queue = Queue::new(sweep, observer);
        let mut failed = None;
        let mut left = world.size() - 1;
        while left > 0 {
            let (message, status) = world.any_process().receive_vec::<u8>();
            if let Err(error) = queue.take(sweep, &message, observer) {
                failed.get_or_insert(error);
            }
            // After a failure the ranks are sent home one by one: none waits for ever.
            let next = if failed.is_none() { queue.next(sweep) } else { Ok(None) };
            let next = next.unwrap_or_else(|error| {
                failed.get_or_insert(error);
                None
            });
            if next.is_none() {
                left -= 1;
            }
            world.process_at_rank(status.source_rank()).send(&next.unwrap_or(NO_MORE));
        }
        failed.map_or(Ok(()), Err)
    }
}

/// The tiles that are to be handed out, and those that are back.
struct Queue {
    /// Tiles not yet handed out, last first.
    tiles: Vec<(u32, u64)>,
    /// The shard of each tile that is under way.
    under_way: BTreeMap<u64, u32>,
    open: BTreeMap<u32, OpenShard>,
}

impl Queue {
    fn new(sweep: &Sweep<'_>, observer: &dyn SweepObserver) -> Self {
        let shards = sweep.open_shards(observer).into_iter().rev();
        let of = |shard: u32| sweep.deal.tiles_of(shard).into_iter().rev();
        let tiles: Vec<_> =
            shards.flat_map(|shard| of(shard).map(move |tile| (shard, tile))).collect();
        observer.begun(tiles.len() as u64);
        Self { tiles, under_way: BTreeMap::new(), open: BTreeMap::new() }
    }

    /// The next tile, if there is one.
    fn next(&mut self, sweep: &Sweep<'_>) -> Result<Option<u64>> {
        let Some((shard, tile)) = self.tiles.pop() else { return Ok(None) };
        if !self.open.contains_key(&shard) {
            let lock = sweep.folder.lock(shard)?;
            let open = OpenShard { begun: Instant::now(), tiles: BTreeMap::new(), _lock: lock };
            self.open.insert(shard, open);
        }
        self.under_way.insert(tile, shard);
        Ok(Some(tile))
    }

    /// Takes what a rank has sent; writes a shard that is complete by that.
    fn take(
        &mut self,
        sweep: &Sweep<'_>,
        message: &[u8],
        observer: &dyn SweepObserver,
    ) -> Result<()> {
        if message.is_empty() {
            return Ok(());
        }
        let Computed { tile, outcome } = postcard::from_bytes(message)?;
        let shard = self.under_way.remove(&tile).context("a tile that was not handed out")?;
        let open = self.open.get_mut(&shard).context("a shard that is not open")?;
        open.tiles.insert(tile, outcome.map_err(|why| anyhow!(why))?);
        observer.tile();
        if open.tiles.len() == sweep.deal.tiles_of(shard).len() {
            let Some(done) = self.open.remove(&shard) else { return Ok(()) };
            let tiles: Vec<Vec<u8>> = done.tiles.into_values().collect();
            sweep.keep(shard, done.begun.elapsed(), &tiles)?;
        }
        Ok(())
    }
}
