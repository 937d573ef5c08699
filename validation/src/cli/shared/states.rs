//! The states of a row of JSON.

use serde::{Serialize, Serializer};

/// Writes the states by their names, in the order of the file.
pub(in crate::cli) fn in_order<N: Serialize, C: Serialize, S: Serializer>(
    state: &[(N, C)],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_map(state.iter().map(|(name, cell)| (name, cell)))
}
