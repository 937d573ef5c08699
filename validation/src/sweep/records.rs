//! Arrays of one point as the bytes of a tile, every number with all its bits.

use super::{Array, Tiles};
use anyhow::{Context, Result};

/// The bytes of a value.
///
/// # Errors
/// A value that has no such form.
pub fn bytes(value: &impl serde::Serialize) -> Result<Vec<u8>> {
    Ok(postcard::to_stdvec(value)?)
}

/// A value from its bytes.
///
/// # Errors
/// Bytes that are of no such value.
pub fn value<T: serde::de::DeserializeOwned>(bytes: &[u8]) -> Result<T> {
    postcard::from_bytes(bytes).context("a tile cannot be read")
}

/// The arrays that the only tile of a point holds.
///
/// # Errors
/// A tile that cannot be read.
pub fn of_single(tiles: Tiles<'_>) -> Result<Vec<Array>> {
    let tile = tiles.next().context("a point has no tile")??;
    value(&tile)
}
