//! The rows of a run, made one by one: a long run costs no memory.

use super::plan::PlannedRun;
use super::sink::{Row, RunEnd, Sink};
use crate::cli::shared::no_progress::LastTurns;
use crate::cli::shared::run_ending::RunEnding;
use crate::cli::shared::section::no_return;
use crate::number::shortest;
use anyhow::Result;
use percuss::affine::NoReturn;
use percuss::{Ending, Event, Events};

/// The number of events or samples between two updates of the progress bar.
const STEPS_PER_UPDATE: u64 = 256;

/// A run under way.
pub(super) struct Underway<'a, 'p> {
    pub(super) plan: &'p PlannedRun<'a>,
    pub(super) run: Events<'a, f64>,
    /// The last `until` events.
    last: LastTurns,
    steps: u64,
    /// The reason for which the run has not returned as often as was asked, and how often it has.
    pub(super) no_return: Option<(NoReturn, u64)>,
}

impl<'a> PlannedRun<'a> {
    /// Makes the run and hands its rows to a sink.
    pub(super) fn rows(&self, sink: &mut dyn Sink) -> Result<RunEnd> {
        let mut underway = Underway::begin(self)?;
        let ending = match underway.transient() {
            Err(early) => {
                sink.stop(&row(0, &early, false))?;
                sink.row(self, &row(0, &early, true))?;
                Some(early)
            }
            Ok(first) if self.samples.is_some() => underway.samples(first, sink)?,
            Ok(first) => underway.events(&first, sink)?,
        };
        Ok(underway.end(ending.as_ref()))
    }
}

impl<'a, 'p> Underway<'a, 'p> {
    /// A run at its start.
    pub(super) fn begin(plan: &'p PlannedRun<'a>) -> Result<Self> {
        let run = plan.solver.run().until(plan.first_stop())?;
        Ok(Self { plan, run, last: LastTurns::default(), steps: 0, no_return: None })
    }

    /// The next event of the run, or its ending.
    ///
    /// `share` of the run is done, if not more.
    pub(super) fn next(&mut self, share: f64) -> Option<Event<'a, f64>> {
        let event = self.run.next()?;
        if self.steps.is_multiple_of(STEPS_PER_UPDATE) {
            self.plan.show_progress(*event.time(), share);
        }
        self.steps += 1;
        self.last.add(event.kind(), event.mode_index());
        Some(event)
    }

    /// Goes through the transient: the state after it, or how the run ended within.
    fn transient(&mut self) -> Result<Event<'a, f64>, Event<'a, f64>> {
        let start = self.run.start();
        if self.plan.transient.is_none() {
            return Ok(start);
        }
        while let Some(event) = self.next(0.0) {
            match event.ending() {
                Some(Ending::Horizon) => return Ok(event),
                Some(_) => return Err(event),
                None => {}
            }
        }
        Ok(start)
    }

    /// Row 0 and a row for each event after it, the ending among them; how the run ended.
    fn events(
        &mut self,
        first: &Event<'a, f64>,
        sink: &mut dyn Sink,
    ) -> Result<Option<Event<'a, f64>>> {
        let plan = self.plan;
        sink.stop(&row(0, first, false))?;
        sink.row(plan, &row(0, first, false))?;
        if plan.transient.is_some() {
            self.run.go_on(plan.horizon);
        }
        let mut n = 0;
        while plan.events.is_none_or(|wanted| n < wanted) {
            let Some(event) = self.next(plan.share_of_events(n)) else { break };
            n += 1;
            sink.stop(&row(n, &event, false))?;
            sink.row(plan, &row(n, &event, true))?;
            if event.ending().is_some() {
                return Ok(Some(event));
            }
        }
        Ok(None)
    }

    /// A row for each sample from the first on, which is at the end of the transient; how the run
    /// ended, if it did before its horizon.
    fn samples(
        &mut self,
        first: Event<'a, f64>,
        sink: &mut dyn Sink,
    ) -> Result<Option<Event<'a, f64>>> {
        let plan = self.plan;
        let (mut n, mut passed) = (0, 0);
        let mut next = plan.transient.map(|_| first);
        while plan.events.is_none_or(|wanted| passed < wanted) {
            let share = plan.share_of_events(passed);
            let Some(event) = next.take().or_else(|| self.next(share)) else { break };
            sink.stop(&row(n, &event, false))?;
            match event.ending() {
                Some(Ending::Horizon) => {
                    // The start itself has no rounding of modal co-ordinates.
                    let is_start = n == 0 && passed == 0 && plan.transient.is_none();
                    let event = if is_start { self.run.start() } else { event };
                    sink.row(plan, &row(n, &event, false))?;
                    n += 1;
                    let samples = plan.samples.as_ref();
                    let stop = samples.and_then(|it| it.time(n, plan.horizon));
                    if !stop.is_some_and(|stop| self.run.go_on(stop)) {
                        break;
                    }
                }
                Some(_) => return Ok(Some(event)),
                None => passed += 1,
            }
        }
        Ok(None)
    }

    /// The ending of a run that ended so, or as it was asked to.
    pub(super) fn end(&self, last: Option<&Event<'a, f64>>) -> RunEnd {
        let undecidable = self.run.undecidable();
        let mut end = RunEnd { undecidable, ..RunEnd::default() };
        let choices = match undecidable {
            0 => None,
            1 => Some("1 choice lies within rounding: one side of it was taken".to_owned()),
            n => Some(format!("{n} choices lie within rounding: one side of each was taken")),
        };
        let decided = "percuss events takes more bits, which may decide";
        end.notes.extend(choices.map(|it| format!("{it}; {decided}")));
        end.notes.extend(self.no_return.map(|(why, returns)| no_return(why, returns)));
        if let Some((event, ending)) = last.and_then(|it| Some((it, it.ending()?))) {
            self.tell(event, ending, &mut end);
        }
        end
    }

    /// Says how a run ended before its horizon.
    fn tell(&self, event: &Event<'a, f64>, ending: Ending, end: &mut RunEnd) {
        end.accumulation = event.accumulation().copied();
        let ends = end.accumulation.map(|it| it.map(shortest));
        let ended = RunEnding {
            ending,
            time: shortest(*event.time()),
            accumulation: ends.as_ref().map(|[from, to]| [from.as_str(), to]),
            bits: self.run.bits(),
        };
        end.notes.extend(ended.notes(self.plan.system(), &self.last));
        end.notes.extend(self.run.cause().map(|it| it.to_string()));
        end.undecided = !ending.is_decided();
    }
}

/// The row of an event, named or not.
pub(super) fn row<'e>(n: u64, event: &'e Event<'_, f64>, named: bool) -> Row<'e> {
    Row {
        n,
        time: *event.time(),
        event: named.then(|| event.name()),
        mode: event.mode_index(),
        state: event.state(),
    }
}
