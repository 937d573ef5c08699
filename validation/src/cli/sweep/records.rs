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
