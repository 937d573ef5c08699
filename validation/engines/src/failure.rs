//! Why a run has no result: what a library said, or the limit that was passed.

/// Why a run has no result.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{reason}")]
pub struct Failure {
    /// The reason, as one line of text.
    pub reason: String,
}

impl Failure {
    /// A failure with the given reason.
    pub fn new(reason: impl std::fmt::Display) -> Self {
        let reason = reason.to_string().split_whitespace().collect::<Vec<_>>().join(" ");
        Self { reason }
    }
}
