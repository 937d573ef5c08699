//! The state of a sweep.

use super::plan::Plan;
use super::run::Sweep;
use super::shard::Damage;

/// The state of a shard.
#[derive(Clone, Debug, PartialEq)]
pub enum ShardState {
    /// The shard is finished, and its file is whole.
    Done,
    /// Some process computes the shard.
    Running,
    /// No one has begun it, or whoever did is gone.
    Missing,
    /// The shard's file cannot be used, for the given reason.
    Damaged(String),
}

/// The states of all shards of a sweep.
#[derive(Clone, Debug)]
pub struct SweepStatus {
    /// The state of each shard, in order.
    pub shards: Vec<ShardState>,
    /// Expected seconds to the end, as long as so many run as do now, or one where none does; none
    /// before the first shard is done.
    pub seconds_to_end: Option<f64>,
}

impl SweepStatus {
    /// The status of a sweep of which nothing was begun.
    #[must_use]
    pub fn not_begun(plan: &Plan) -> Self {
        let shards = vec![ShardState::Missing; plan.shards as usize];
        Self { shards, seconds_to_end: None }
    }

    /// Looks at all shards of a sweep.
    #[must_use]
    pub fn new(sweep: &Sweep<'_>) -> Self {
        let (mut seconds, mut done, mut left) = (0.0, 0, 0);
        let mut shards = Vec::new();
        for shard in 0..sweep.plan.shards {
            let tiles = sweep.deal.tiles_of(shard).len();
            let state = match sweep.shard(shard) {
                Ok(shard) => {
                    seconds += shard.head.seconds;
                    done += tiles;
                    ShardState::Done
                }
                Err(_) if sweep.folder.is_locked(shard) => ShardState::Running,
                Err(Damage::Missing) => ShardState::Missing,
                Err(Damage::Damaged(why)) => ShardState::Damaged(why),
            };
            if state != ShardState::Done {
                left += tiles;
            }
            shards.push(state);
        }
        let running = shards.iter().filter(|it| **it == ShardState::Running).count().max(1);
        let seconds_to_end =
            (done > 0).then(|| left as f64 * seconds / done as f64 / running as f64);
        Self { shards, seconds_to_end }
    }

    /// The numbers of the shards that are in some state.
    pub fn numbers(&self, state: impl Fn(&ShardState) -> bool) -> Vec<u32> {
        (0..).zip(&self.shards).filter(|(_, it)| state(it)).map(|(shard, _)| shard).collect()
    }

    /// Whether every shard is done.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.shards.iter().all(|it| *it == ShardState::Done)
    }
}
