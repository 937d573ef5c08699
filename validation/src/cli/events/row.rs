//! A row of `events` as it is written.

use serde::Serialize;

/// An event. Numbers are texts, because a reader's f64 would not hold their digits.
#[derive(Clone, Serialize)]
pub(super) struct EventRow {
    pub(super) n: usize,
    pub(super) time: String,
    pub(super) event: String,
    pub(super) mode: String,
    #[serde(serialize_with = "in_order")]
    pub(super) state: Vec<(String, String)>,
}

/// Writes the states in the order of the file.
pub(super) fn in_order<S: serde::Serializer>(
    state: &[(String, String)],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_map(state.iter().map(|(name, cell)| (name, cell)))
}
