//! An event of an instant that is only counted and that other records of the instant come before.

use super::continuation::Exact;

/// An event that is only counted and has to come within its instant.
pub(super) struct Pending {
    pub(super) name: String,
    pub(super) exact: Exact,
    pub(super) deadline: f64,
    /// The errors of its state that are allowed.
    pub(super) allowed: Vec<f64>,
}
