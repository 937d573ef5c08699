//! Arrays of one point as the bytes of a tile, every number with all its bits.

use crate::sweep::Array;
use anyhow::{Context, Result};

/// The bytes of a value.
pub(super) fn bytes(value: &impl serde::Serialize) -> Result<Vec<u8>> {
    Ok(postcard::to_stdvec(value)?)
}

/// A value from its bytes.
pub(super) fn value<T: serde::de::DeserializeOwned>(bytes: &[u8]) -> Result<T> {
    postcard::from_bytes(bytes).context("a tile cannot be read")
}

/// The arrays that the only tile of a point holds.
pub(super) fn of_single(tiles: crate::sweep::Tiles<'_>) -> Result<Vec<Array>> {
    let tile = tiles.next().context("a point has no tile")??;
    value(&tile)
}

/// About how many events a motion meets in a forcing period, times [`SCALE`].
pub(super) fn events(model: &percuss::Model, entry: percuss::Entry, periods: u64) -> u64 {
    let looked_at = periods.clamp(1, LOOKED_AT);
    let end = entry.instant.after_periods(looked_at, 1);
    let events = model.trajectory(entry).until(end).count() as u64;
    events * SCALE / looked_at
}

/// Forcing periods over which events are counted, at most.
const LOOKED_AT: u64 = 64;
/// Costs are integers, so that all programs deal alike.
pub(super) const SCALE: u64 = 1024;
