//! A run between two returns to an event, whose times are known only when it is there.

use super::plan::PlannedRun;
use super::rows::{Underway, row};
use super::sink::{RunEnd, Sink};
use crate::returns::{EventReturns, ReturnCount};
use anyhow::Result;
use percuss::{Ending, Event};

/// Makes the run and hands its rows to a sink.
pub(super) fn rows(
    plan: &PlannedRun<'_>,
    returning: &EventReturns,
    sink: &mut dyn Sink,
) -> Result<RunEnd> {
    let mut run = Underway::begin(plan)?;
    let ending = BetweenReturns::new(&mut run, returning).rows(sink)?;
    Ok(run.end(ending.as_ref()))
}

/// A run that is measured in returns to an event.
struct BetweenReturns<'r, 'a, 'p> {
    run: &'r mut Underway<'a, 'p>,
    count: ReturnCount<'p>,
    /// The events that are shown.
    events: u64,
    /// The samples that are passed, shown or not.
    samples: u64,
}

impl<'r, 'a, 'p> BetweenReturns<'r, 'a, 'p> {
    fn new(run: &'r mut Underway<'a, 'p>, returning: &'p EventReturns) -> Self {
        let count = ReturnCount::begin(returning, *run.run.start().time());
        Self { run, count, events: 0, samples: 0 }
    }

    /// Hands on the rows from the return that ends the transient on; how the run ended, where that
    /// is not as it was asked for.
    fn rows(&mut self, sink: &mut dyn Sink) -> Result<Option<Event<'a, f64>>> {
        // The first sample is the start.
        if self.count.is_past_transient() && self.run.plan.samples.is_none() {
            let start = self.run.run.start();
            self.begin_rows(&start, sink)?;
        }
        while self.is_wanted() {
            let Some(event) = self.run.next(self.share()) else { break };
            match event.ending() {
                Some(Ending::Horizon) => {
                    self.sample(&event, sink)?;
                    if self.goes_on(*event.time()) {
                        continue;
                    }
                    self.end(&event, sink)?;
                    return Ok(Some(event));
                }
                Some(_) => {
                    self.end(&event, sink)?;
                    return Ok(Some(event));
                }
                None => self.pass(&event, sink)?,
            }
        }
        Ok(None)
    }

    /// Whether the run has not come to the return or the event that ends it.
    fn is_wanted(&self) -> bool {
        self.count.goes_on() && self.run.plan.events.is_none_or(|wanted| self.events < wanted)
    }

    /// The share of the run that is done.
    fn share(&self) -> f64 {
        self.count.share().unwrap_or_else(|| self.run.plan.share_of_events(self.events))
    }

    /// Hands on the place at which rows begin, which has a row where rows are those of events.
    fn begin_rows(&self, first: &Event<'_, f64>, sink: &mut dyn Sink) -> Result<()> {
        let plan = self.run.plan;
        sink.stop(&row(0, first, false))?;
        if plan.samples.is_some() { Ok(()) } else { sink.row(plan, &row(0, first, false)) }
    }

    /// Takes an event of the system.
    fn pass(&mut self, event: &Event<'_, f64>, sink: &mut dyn Sink) -> Result<()> {
        let was_shown = self.count.is_past_transient();
        self.count.take(event.kind(), *event.time());
        match (was_shown, self.count.is_past_transient()) {
            (true, _) => {
                self.events += 1;
                self.show(event, sink)
            }
            (false, true) => self.begin_rows(event, sink),
            (false, false) => Ok(()),
        }
    }

    /// Hands on an event, or the ending, by its name.
    fn show(&self, event: &Event<'_, f64>, sink: &mut dyn Sink) -> Result<()> {
        let (plan, n) = (self.run.plan, self.events);
        sink.stop(&row(n, event, false))?;
        if plan.samples.is_some() { Ok(()) } else { sink.row(plan, &row(n, event, true)) }
    }

    /// Takes the state at a horizon, if that is the time of a sample.
    fn sample(&mut self, at: &Event<'_, f64>, sink: &mut dyn Sink) -> Result<()> {
        let plan = self.run.plan;
        let Some(samples) = &plan.samples else { return Ok(()) };
        if samples.at(self.samples) > *at.time() {
            return Ok(());
        }
        // The start itself has no rounding of modal co-ordinates.
        let start = (self.samples == 0).then(|| self.run.run.start());
        let at = start.as_ref().unwrap_or(at);
        self.samples += 1;
        if !self.count.is_past_transient() {
            return Ok(());
        }
        sink.stop(&row(0, at, false))?;
        sink.row(plan, &row(0, at, false))
    }

    /// Lets the run go on from a horizon, unless it ends there.
    fn goes_on(&mut self, time: f64) -> bool {
        let plan = self.run.plan;
        let sample = plan.samples.as_ref().map(|it| it.at(self.samples));
        let horizon = self.count.horizon(plan.is_timed, plan.horizon);
        let stop = sample.unwrap_or(f64::INFINITY).min(horizon);
        stop > time && self.run.run.go_on(stop)
    }

    /// Hands on the ending of a run, and keeps why it has not returned as often as was asked.
    fn end(&mut self, event: &Event<'_, f64>, sink: &mut dyn Sink) -> Result<()> {
        let plan = self.run.plan;
        if event.ending() == Some(Ending::Horizon) {
            let why = self.count.no_return(plan.is_timed);
            self.run.no_return = why.map(|why| (why, self.count.returns()));
        }
        if self.count.is_past_transient() {
            self.events += 1;
            return self.show(event, sink);
        }
        sink.stop(&row(0, event, false))?;
        sink.row(plan, &row(0, event, true))
    }
}
