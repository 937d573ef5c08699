//! A recording of a run in a time window: its steps, its guards and its states.
//!
//! Nothing is recorded unless a task asks for it, so that a run which is scored costs nothing more.

/// The window and the instants that a task wants recorded, in times since its start.
#[derive(Clone, Debug)]
pub struct Watched {
    /// The window of time, from and to: steps and guards outside are not recorded.
    pub window: [f64; 2],
    /// Instants at which the state is taken instead of those of the grid, in ascending order.
    pub instants: Vec<f64>,
}

/// One evaluation of a guard by a search for events.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GuardSample {
    /// Time of the evaluation, since the start.
    pub t: f64,
    /// The mode to which the guard belongs.
    pub mode: usize,
    /// The number of the guard in its mode.
    pub guard: usize,
    /// The guard's value, which is negative inside the mode.
    pub value: f64,
}

/// The recording of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trace {
    /// Ends of accepted steps, since the start, in ascending order; a step in which a mode ends
    /// has none.
    pub steps: Vec<f64>,
    /// Evaluations of guards, in the order in which they were made.
    pub looks: Vec<GuardSample>,
}
