//! What was answered to a case.

/// The answer to a case: one for each of its names, in their order.
#[derive(Clone, Debug, Default)]
pub struct GradientAnswer {
    /// The answers by the names; nothing by a name without a row.
    pub by: Vec<Option<NameAnswer>>,
    /// The largest error of an event's time in the same run, where that was answered too.
    pub event_error: Option<f64>,
    /// Whether the derivatives are differences of runs.
    pub are_differences: bool,
}

/// The derivatives by one name: for each row of the table those of time and states, where given.
#[derive(Clone, Debug, Default)]
pub struct NameAnswer(pub Vec<Vec<Option<f64>>>);

impl NameAnswer {
    /// An answer that gives every cell.
    #[must_use]
    pub fn whole(rows: &[Vec<f64>]) -> Self {
        Self(rows.iter().map(|row| row.iter().map(|it| Some(*it)).collect()).collect())
    }

    /// The value of a cell.
    pub(super) fn cell(&self, n: usize, k: usize) -> Option<f64> {
        self.0.get(n)?.get(k).copied().flatten()
    }
}
