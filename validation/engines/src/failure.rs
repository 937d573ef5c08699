//! Why a run has no result: what a library said, or the limit that was passed.

/// Why a run has no result.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{reason}")]
pub struct Failure {
    /// The reason, as one line of text.
    pub reason: String,
    /// Whether the run was given up because it took more calls or time than it was allowed.
    pub is_beyond_limits: bool,
}

impl Failure {
    /// A failure with the given reason.
    pub fn new(reason: impl std::fmt::Display) -> Self {
        let reason = reason.to_string().split_whitespace().collect::<Vec<_>>().join(" ");
        Self { reason, is_beyond_limits: false }
    }

    /// A run that took, or would take, more than it was allowed.
    pub fn beyond_limits(reason: impl std::fmt::Display) -> Self {
        Self { is_beyond_limits: true, ..Self::new(reason) }
    }
}
