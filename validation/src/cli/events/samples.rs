//! The rows of `events --samples K`: the state at equal steps of the time, not at events.

use super::progress::{Passed, RunEnd};
use super::rows::{Rows, SampleRow, Sink};
use anyhow::Result;
use percuss::{Event, Kind, Proved};

impl Rows<'_> {
    /// Runs the system from its start, with a row `samples` times in each unit of its time; where
    /// it is forced, in each period.
    pub(super) fn each_sample(&self, samples: u32, sink: &mut dyn Sink) -> Result<RunEnd> {
        let mut events = self.run().until_with_samples(self.limits.until, samples)?;
        let (mut end, mut passed) = (RunEnd::default(), Passed::default());
        let mut last = events.start();
        sink.passed(&last)?;
        while let Some(event) = events.next() {
            if event.kind() == Kind::Sample {
                sink.sample(&self.sample(&event))?;
                continue;
            }
            if self.is_stopped(&event, passed.count) {
                self.stopped(&last, &mut end);
                sink.passed(&last)?;
                break;
            }
            if !self.passes(&event, &mut passed, &mut end) {
                break;
            }
            sink.passed(&event)?;
            if event.ending().is_some() {
                self.name(&event, &events, &passed, &mut end);
                break;
            }
            if self.limits.events.is_some_and(|wanted| passed.count >= wanted) {
                break;
            }
            last = event;
        }
        end.notes.extend(events.cause().map(|it| it.to_string()));
        Ok(end)
    }

    fn sample(&self, event: &Event<'_, Proved>) -> SampleRow {
        let (time, mode) = (self.time(event), event.mode().to_owned());
        SampleRow { time, mode, state: self.state(event) }
    }
}
