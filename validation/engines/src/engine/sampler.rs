//! States on the grid, taken as a run passes their times, and crossings that are only counted.

/// A crossing that ends nothing.
#[derive(Clone, Copy, Debug)]
pub(super) struct CountedCrossing<S> {
    pub(super) t: f64,
    pub(super) guard: usize,
    pub(super) state: S,
}

/// Collects what a run passes on its way.
pub(super) struct Sampler<S> {
    times: Vec<f64>,
    taken: Vec<S>,
    /// Crossings in the stretch that is being run, in the order of their times.
    pub(super) counted: Vec<CountedCrossing<S>>,
}

impl<S: Clone> Sampler<S> {
    pub(super) fn new(times: Vec<f64>) -> Self {
        Self { taken: Vec::with_capacity(times.len()), times, counted: Vec::new() }
    }

    /// Takes the samples at times up to `until` from `state_at`.
    pub(super) fn take<E>(
        &mut self,
        until: f64,
        mut state_at: impl FnMut(f64) -> Result<S, E>,
    ) -> Result<(), E> {
        while let Some(time) =
            self.times.get(self.taken.len()).copied().filter(|time| *time <= until)
        {
            self.taken.push(state_at(time)?);
        }
        Ok(())
    }

    /// All samples; those past the end of the run are its last state.
    pub(super) fn finish(mut self, end: S) -> Vec<S> {
        self.taken.resize(self.times.len(), end);
        self.taken
    }
}
