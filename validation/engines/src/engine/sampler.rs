//! States on the grid, taken as a run passes their times.

/// Collects the grid's samples.
pub(super) struct Sampler {
    times: Vec<f64>,
    taken: Vec<[f64; 4]>,
}

impl Sampler {
    pub(super) fn new(times: Vec<f64>) -> Self {
        Self { taken: Vec::with_capacity(times.len()), times }
    }

    /// Takes the samples at times up to `until` from `state_at`.
    pub(super) fn take<E>(
        &mut self,
        until: f64,
        mut state_at: impl FnMut(f64) -> Result<[f64; 4], E>,
    ) -> Result<(), E> {
        while let Some(time) =
            self.times.get(self.taken.len()).copied().filter(|time| *time <= until)
        {
            self.taken.push(state_at(time)?);
        }
        Ok(())
    }

    /// All samples; those past the end of the run are its last state.
    pub(super) fn finish(mut self, end: [f64; 4]) -> Vec<[f64; 4]> {
        self.taken.resize(self.times.len(), end);
        self.taken
    }
}
