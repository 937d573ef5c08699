//! The rows of `events`, made one by one: a long run costs no memory.

use super::progress::{Passed, RunEnd};
use crate::cli::shared::long_work::Bar;
use crate::cli::shared::states::in_order;
use anyhow::Result;
use percuss::{Event, Proved, Run, Solver, System};
use serde::Serialize;

/// The number of rows between two updates of the progress bar.
const ROWS_PER_UPDATE: usize = 64;

/// The number of digits below which a time is said to have few.
const FEW_DIGITS: usize = 6;

/// The system, limits and digits of a run.
pub(super) struct Rows<'a> {
    pub(super) system: &'a System,
    pub(super) solver: &'a Solver<Proved>,
    pub(super) digits: usize,
    pub(super) limits: Limits,
    /// The most bits that are used.
    pub(super) most_bits: u32,
    /// The number of rows in a unit of time, where they are no events.
    pub(super) samples: Option<u32>,
    /// The progress of the run, where it is shown.
    pub(super) bar: Option<&'a Bar>,
}

/// The limits of a run.
#[derive(Clone, Copy)]
pub(super) struct Limits {
    /// The time at which it ends.
    pub(super) until: f64,
    /// The number of events that are wanted.
    pub(super) events: Option<usize>,
    /// The number of events after which a run that wants more is stopped.
    pub(super) most: Option<usize>,
}

/// Numbers are texts, because a reader's f64 would not hold their digits.
#[derive(Serialize)]
pub(super) struct EventRow {
    pub(super) n: usize,
    pub(super) time: String,
    pub(super) event: String,
    pub(super) mode: String,
    #[serde(serialize_with = "in_order")]
    pub(super) state: Vec<(String, String)>,
}

/// The state at a time. Numbers are texts, because a reader's f64 would not hold their digits.
#[derive(Serialize)]
pub(super) struct SampleRow {
    pub(super) time: String,
    pub(super) mode: String,
    #[serde(serialize_with = "in_order")]
    pub(super) state: Vec<(String, String)>,
}

/// An output of a run.
pub(super) trait Sink {
    /// Begins with what is known before the run.
    fn begin(&mut self, _: &Rows<'_>) -> Result<()> {
        Ok(())
    }

    /// Takes the start, an event or the ending, with a row of its own or not.
    fn passed(&mut self, _: &Event<'_, Proved>) -> Result<()> {
        Ok(())
    }

    fn event(&mut self, _: &EventRow) -> Result<()> {
        Ok(())
    }

    fn sample(&mut self, _: &SampleRow) -> Result<()> {
        Ok(())
    }

    fn finish(&mut self, rows: &Rows<'_>, end: &RunEnd) -> Result<()>;
}

impl<'a> Rows<'a> {
    /// Makes the run and hands its rows to a sink.
    pub(super) fn write(&self, sink: &mut dyn Sink) -> Result<RunEnd> {
        sink.begin(self)?;
        let end = match self.samples {
            Some(samples) => self.each_sample(samples, sink)?,
            None => self.each(sink)?,
        };
        sink.finish(self, &end)?;
        Ok(end)
    }

    /// Runs the system from its start, which is row 0.
    fn each(&self, sink: &mut dyn Sink) -> Result<RunEnd> {
        let mut take = |row: EventRow, event: &Event<'_, Proved>| {
            sink.passed(event)?;
            sink.event(&row)
        };
        let mut events = self.run().until(self.limits.until)?;
        let (mut end, mut passed) = (RunEnd::default(), Passed::default());
        let mut last = events.start();
        take(self.row(0, &last, String::new()), &last)?;
        while self.limits.events.is_none_or(|wanted| passed.count < wanted) {
            let Some(event) = events.next() else { break };
            let row = passed.count + 1;
            if self.is_stopped(&event, passed.count) {
                let name = self.stopped(&last, &mut end);
                take(self.row(row, &last, name), &last)?;
                break;
            }
            if !self.passes(&event, &mut passed, &mut end) {
                break;
            }
            let name = self.name(&event, &events, &passed, &mut end);
            take(self.row(row, &event, name), &event)?;
            last = event;
        }
        end.notes.extend(events.cause().map(|it| it.to_string()));
        Ok(end)
    }

    /// A run from the system's start, which is told its length next.
    pub(super) fn run(&self) -> Run<'a, Proved> {
        self.solver.run().digits(self.digits).max_bits(self.most_bits)
    }

    /// Whether an event is one more than a run may have.
    pub(super) fn is_stopped(&self, event: &Event<'_, Proved>, passed: usize) -> bool {
        event.ending().is_none() && self.limits.most.is_some_and(|most| passed >= most)
    }

    /// Counts an event and says where the digits of its time become few. A run whose time has none
    /// left does not pass it.
    pub(super) fn passes(
        &self,
        event: &Event<'_, Proved>,
        passed: &mut Passed,
        end: &mut RunEnd,
    ) -> bool {
        passed.add(event.kind(), event.mode_index());
        self.show_progress(event, passed.count);
        // A time next to zero has few digits though it is known well.
        if event.time().error() <= f64::EPSILON * self.system.time_scale {
            return true;
        }
        let count = passed.count;
        let Some(digits) = event.time().digits(FEW_DIGITS) else { return true };
        if digits == 0 {
            end.notes.push(format!(
                "after {} events no digit of the time is left: the run ends there",
                count - 1
            ));
            return false;
        }
        if !passed.few_digits && digits < FEW_DIGITS {
            passed.few_digits = true;
            let time = self.time(event);
            end.notes.push(format!(
                "from event {count} on, at {time}, the time has fewer than {FEW_DIGITS} digits"
            ));
        }
        true
    }

    /// Shows the share of the run that is done: of its time, or of its events where that is more.
    fn show_progress(&self, event: &Event<'_, Proved>, count: usize) {
        let Some(bar) = self.bar.filter(|_| count.is_multiple_of(ROWS_PER_UPDATE)) else { return };
        let start = self.system.start.as_ref().map_or(0.0, |it| it.time.to_f64());
        let Limits { until, events, most } = self.limits;
        let of_time = (event.time().midpoint() - start) / (until - start);
        let of = |limit: Option<usize>| limit.map_or(0.0, |limit| count as f64 / limit as f64);
        bar.show_share(of_time.max(of(events)).max(of(most)).clamp(0.0, 1.0));
    }

    /// The time of an event, with the digits that are proved.
    pub(super) fn time(&self, event: &Event<'_, Proved>) -> String {
        event.time().to_digits(self.digits)
    }

    fn row(&self, n: usize, event: &Event<'_, Proved>, name: String) -> EventRow {
        let (time, mode) = (self.time(event), event.mode().to_owned());
        EventRow { n, time, event: name, mode, state: self.state(event) }
    }

    /// The states of an event by their names, with the digits that are proved.
    pub(super) fn state(&self, event: &Event<'_, Proved>) -> Vec<(String, String)> {
        let cells = event.state().iter().map(|it| it.to_digits(self.digits));
        self.system.states.iter().cloned().zip(cells).collect()
    }
}
