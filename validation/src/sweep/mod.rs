//! Sweeps: a verb of the dynamics over one or two parameters, in shards that one machine or many
//! compute.
//!
//! A [`Plan`] spans *points*, one for each combination of its axes' values. They are cut into
//! *tiles*, some points each or blocks of a large one (`tiling.rs`), and what a [`SweepVerb`]
//! gives depends on the point and block alone. Tiles are dealt evenly to shards (`deal.rs`). A
//! shard is computed by [`Sweep`] and is one file (`shard.rs`) in the sweep's folder ([`Folder`]).
//! When all are there, [`Merge`] joins them into one archive of arrays, which tells nothing of
//! shards, threads or machines.

mod array;
mod axis;
mod deal;
mod folder;
mod merge;
mod plan;
pub mod records;
mod run;
mod shard;
mod spool;
mod status;
mod tiling;
mod verb;

pub use array::{Array, ArrayValues};
pub use axis::{SweepAxis, SweepPoint};
pub use folder::{ComputedBy, Folder};
pub use merge::{Merge, NotMerged};
pub use plan::{Plan, PlanFile};
pub use run::{Sweep, SweepObserver};
pub use shard::Damage;
pub use status::{ShardState, SweepStatus};
pub use verb::{SweepVerb, Tiles};
