//! States on the grid, taken as a run passes their times, and crossings that are only counted.

/// A crossing of a guard that does not end its mode.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CountedCrossing<S> {
    pub(crate) t: f64,
    pub(crate) guard: usize,
    pub(crate) state: S,
}

/// Collects the samples and the counted crossings of a run.
pub(crate) struct Sampler<S> {
    times: Vec<f64>,
    taken: Vec<S>,
    /// Crossings in the stretch that is being run, in the order of their times.
    pub(crate) counted: Vec<CountedCrossing<S>>,
}

impl<S: Clone> Sampler<S> {
    pub(crate) fn new(times: Vec<f64>) -> Self {
        Self { taken: Vec::with_capacity(times.len()), times, counted: Vec::new() }
    }

    /// Takes the samples at times up to `until` from `state_at`.
    pub(crate) fn take<E>(
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
    pub(crate) fn finish(mut self, end: S) -> Vec<S> {
        self.taken.resize(self.times.len(), end);
        self.taken
    }
}
