//! The work of a verb at the points of a sweep.

use super::{Array, SweepPoint, records};
use anyhow::Result;

/// The tiles, one after the other, of a point; each may fail to be read.
pub type Tiles<'a> = &'a mut dyn Iterator<Item = Result<Vec<u8>>>;

/// A verb with its fixed flags.
///
/// Results depend on the point and the tile alone: not on the other tiles, on threads or on the
/// machine.
pub trait SweepVerb: Sync {
    /// Refuses a point at which the verb has nothing to work on, and says what is accepted.
    ///
    /// # Errors
    /// What the verb says of the point's model and start.
    fn check(&self, point: &SweepPoint) -> Result<()>;

    /// The number of tiles of each point.
    fn tiles(&self) -> u32 {
        1
    }

    /// Computes one tile of a point.
    ///
    /// # Errors
    /// What the verb objects to.
    fn tile(&self, point: &SweepPoint, tile: u32) -> Result<Vec<u8>>;

    /// Joins the tiles of a point, given in order, into the arrays of that point: those that the
    /// only tile holds, unless a verb cuts its points. Points give the same names, types and
    /// numbers of dimensions.
    ///
    /// # Errors
    /// A tile that cannot be read.
    fn join(&self, _point: &SweepPoint, tiles: Tiles<'_>) -> Result<Vec<Array>> {
        records::of_single(tiles)
    }

    /// Arrays that are the same at every point: the axes that the verb has itself.
    fn coordinates(&self) -> Vec<Array> {
        Vec::new()
    }

    /// Lists of names to which numbers in the arrays refer, each under the list's own name.
    fn names(&self) -> Vec<(&'static str, Vec<String>)> {
        Vec::new()
    }
}
