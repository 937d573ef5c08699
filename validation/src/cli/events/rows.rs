//! The rows of `events`, made one by one: a long run costs no memory.

use super::digits::{has_digits, proved, significant};
use super::left_open::{LastRow, LeftOpen};
use super::progress::{Passed, RunEnd};
use super::row::EventRow;
use super::sizes::Sizes;
use crate::cli::shared::long_work::Bar;
use crate::truth::DoubleDouble;
use anyhow::{Result, bail};
use percuss::affine::{Arithmetic, EnclosedRun, Ending, Event, Solver, System, Time, What};
use percuss::number::{Bound, Number};

/// The number of rows between two updates of the progress bar.
const RARELY: usize = 64;

/// The event of a last row at which what comes next is not decided.
pub(super) const UNDECIDED: &str = "undecided";

/// A time of fewer digits is said to have few.
const FEW: usize = 6;

/// The system, limits and digits of a run.
pub(super) struct Rows<'a, T: Number> {
    pub(super) system: &'a System,
    pub(super) solver: &'a Solver<T>,
    pub(super) is_backward: bool,
    pub(super) digits: usize,
    pub(super) limits: Limits,
    /// The progress of the run, where it is shown.
    pub(super) bar: Option<&'a Bar>,
    /// What fewer bits have decided, and what they knew of the rest.
    pub(super) left: &'a LeftOpen,
    /// Whether more bits may go on where these do not decide, or have too few digits.
    pub(super) may_go_on: bool,
}

/// The outcome of a run in one arithmetic.
pub(super) enum Outcome {
    /// The run has ended.
    Ended(RunEnd),
    /// More bits are needed, for what is left.
    MoreBits(LeftOpen),
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

/// Takes a row, and the event that it is of, which is made in 106 bits if it is asked for.
pub(super) type Taker<'a> =
    &'a mut dyn FnMut(EventRow, &dyn Fn() -> Event<DoubleDouble>) -> Result<()>;

impl<T: Arithmetic> Rows<'_, T> {
    /// Runs the system from its start, which is row 0.
    pub(super) fn each(&self, take: Taker<'_>) -> Result<Outcome> {
        let mut run = self.run(T::exact(self.limits.until))?;
        let (mut end, mut passed) = (RunEnd::default(), Passed::default());
        let mut last = run.start();
        let mut sizes = Sizes::of(&last);
        if self.needs_more_bits(&*run, &last, &mut sizes) && self.left.rows == 0 {
            return Ok(Outcome::MoreBits(self.leave(&*run, 0, None)));
        }
        self.give(0, &last, |_| String::new(), take)?;
        while self.limits.events.is_none_or(|wanted| passed.count < wanted) {
            let Some(event) = run.next() else { break };
            if self.is_stopped(&event, passed.count) {
                let ending = Event { what: What::End(Ending::Horizon), ..last.clone() };
                self.give(passed.count + 1, &ending, |_| self.stopped(&last, &mut end), take)?;
                break;
            }
            let row = passed.count + 1;
            let own = self.last_row(row, &event)?;
            let needs_more_bits = self.needs_more_bits(&*run, &event, &mut sizes);
            if needs_more_bits && (row >= self.left.rows || own.is_some()) {
                return Ok(Outcome::MoreBits(self.leave(&*run, row, own)));
            }
            if !self.passes(&event, &mut passed, &mut end) {
                break;
            }
            if let Some(LastRow { row, event }) = own.map(|it| self.latest(it)) {
                self.is_undecided(&row.time, &mut end);
                take(row, &|| event.clone())?;
                break;
            }
            self.give(row, &event, |_| self.name(&event, &passed, &mut end), take)?;
            last = event;
        }
        end.notes.extend(self.cause(&*run));
        Ok(Outcome::Ended(end))
    }

    /// Gives out a row, unless fewer bits have given it out.
    fn give(
        &self,
        n: usize,
        event: &Event<T>,
        name: impl FnOnce(&Event<T>) -> String,
        take: Taker<'_>,
    ) -> Result<()> {
        if n < self.left.rows {
            return Ok(());
        }
        let row = self.row(n, event, name(event))?;
        take(row, &|| narrowed(event))
    }

    /// The last row of a run that ends undecided with this event.
    fn last_row(&self, n: usize, event: &Event<T>) -> Result<Option<LastRow>> {
        if event.what != What::End(Ending::Undecided) {
            return Ok(None);
        }
        let row = self.row(n, event, UNDECIDED.to_owned())?;
        Ok(Some(LastRow { row, event: narrowed(event) }))
    }

    /// The last row of this run, or that of fewer bits where it is later: more bits may know less.
    fn latest(&self, own: LastRow) -> LastRow {
        LastRow::latest(own, self.left.last.clone(), self.is_backward)
    }

    /// What this run leaves to more bits after so many rows, with the last one of a run that is
    /// undecided.
    pub(super) fn leave(
        &self,
        run: &dyn EnclosedRun<T>,
        rows: usize,
        own: Option<LastRow>,
    ) -> LeftOpen {
        LeftOpen {
            rows: rows.max(self.left.rows),
            last: own.map(|it| self.latest(it)).or_else(|| self.left.last.clone()),
            open: self.open(run).or_else(|| self.left.open.clone()),
        }
    }

    /// Whether more bits are to go on from an event: they may, and these do not decide it, or have
    /// not all of the digits.
    pub(super) fn needs_more_bits(
        &self,
        run: &dyn EnclosedRun<T>,
        event: &Event<T>,
        sizes: &mut Sizes<T::Bound>,
    ) -> bool {
        if !self.may_go_on {
            return false;
        }
        match event.what {
            What::End(Ending::Undecided) => !run.is_exhausted(),
            _ => sizes.have_too_few_digits(event, self.digits),
        }
    }

    /// A run from the system's start.
    pub(super) fn run(&self, until: T) -> Result<Box<dyn EnclosedRun<T> + '_>> {
        let start = self.system.start.as_ref();
        let run = start.and_then(|it| T::enclosed(self.solver, it, until));
        let Some(run) = run else { bail!("{}: its start is not decided", self.system.name) };
        Ok(run)
    }

    /// Whether an event is one more than a run may have.
    pub(super) fn is_stopped(&self, event: &Event<T>, passed: usize) -> bool {
        let is_event = !matches!(event.what, What::End(_));
        is_event && self.limits.most.is_some_and(|most| passed >= most)
    }

    /// Counts an event and says where the digits of its time become few. A run whose time has none
    /// left does not pass it.
    pub(super) fn passes(
        &self,
        event: &Event<T>,
        passed: &mut Passed<T>,
        end: &mut RunEnd,
    ) -> bool {
        passed.add(event.what, event.mode);
        self.show_progress(event, passed.count);
        if !self.has_large_error(event) {
            return true;
        }
        let count = passed.count;
        let time = self.time(event);
        if !has_digits(&time) {
            end.notes.push(format!(
                "after {} events no digit of the time is left: the run ends there",
                count - 1
            ));
            return false;
        }
        if !passed.few_digits && significant(&time).is_some_and(|it| it < FEW) {
            passed.few_digits = true;
            end.notes.push(format!(
                "from event {count} on, at {time}, the time has fewer than {FEW} digits"
            ));
        }
        true
    }

    /// Whether the error of an event's time is more than a rounding of the system's unit of time: a
    /// time next to zero has few digits without that.
    fn has_large_error(&self, event: &Event<T>) -> bool {
        let small = f64::EPSILON * self.system.time_scale;
        event.errors.as_ref().is_none_or(|it| it.time > small || !it.time.is_finite())
    }

    /// Shows the share of the run that is done: of its time, or of its events where that is more.
    fn show_progress(&self, event: &Event<T>, count: usize) {
        let Some(bar) = self.bar.filter(|_| count.is_multiple_of(RARELY)) else { return };
        let start = self.system.start.as_ref().map_or(0.0, |it| it.time.to_f64().value());
        let Limits { until, events, most } = self.limits;
        let of_time = (event.time.value().to_f64() - start) / (until - start);
        let of = |limit: Option<usize>| limit.map_or(0.0, |limit| count as f64 / limit as f64);
        bar.show_share(of_time.max(of(events)).max(of(most)).clamp(0.0, 1.0));
    }

    /// The time of an event, with the digits that are proved.
    pub(super) fn time(&self, event: &Event<T>) -> String {
        let error = event.errors.as_ref().map_or(T::Bound::ZERO, |it| it.time);
        proved(event.time.value(), error, self.digits)
    }

    fn row(&self, n: usize, event: &Event<T>, name: String) -> Result<EventRow> {
        let mode = self.system.modes[event.mode].name.clone();
        Ok(EventRow { n, time: self.time(event), event: name, mode, state: self.state(event)? })
    }

    /// The states of an event by their names, with the digits that are proved.
    pub(super) fn state(&self, event: &Event<T>) -> Result<Vec<(String, String)>> {
        let Some(errors) = &event.errors else { bail!("a row has no enclosed errors") };
        let cells = event.state.iter().zip(&errors.state);
        let cells = cells.map(|(value, error)| proved(*value, *error, self.digits));
        Ok(self.system.states.iter().cloned().zip(cells).collect())
    }
}

/// An event in 106 bits, without the bounds of its errors.
fn narrowed<T: Number>(event: &Event<T>) -> Event<DoubleDouble> {
    let number = |it: T| {
        let high = it.to_f64();
        DoubleDouble::new(high, (it - T::exact(high)).to_f64())
    };
    let what = match event.what {
        What::Start => What::Start,
        What::Until(mode, index) => What::Until(mode, index),
        What::Watch(mode, index) => What::Watch(mode, index),
        What::End(ending) => What::End(match ending {
            Ending::Accumulation(from, to) => Ending::Accumulation(number(from), number(to)),
            Ending::Horizon => Ending::Horizon,
            Ending::LeavesDomain => Ending::LeavesDomain,
            Ending::NoProgress => Ending::NoProgress,
            Ending::BeyondGuard => Ending::BeyondGuard,
            Ending::Undecided => Ending::Undecided,
        }),
    };
    let time = Time { high: number(event.time.value()), low: DoubleDouble::exact(0.0) };
    let state = event.state.iter().map(|it| number(*it)).collect();
    Event { what, time, state, mode: event.mode, errors: None }
}

#[cfg(test)]
#[allow(clippy::expect_used, reason = "a panic is a failed test")]
mod tests {
    use super::*;
    use percuss::affine::Errors;

    #[test]
    fn few_digits_of_the_time_are_said_once_and_none_ends_the_run() {
        let text = crate::systems::named("bouncing-ball").expect("a system");
        let system = System::parse("bouncing-ball", text).expect("accepted");
        let solver = Solver::<DoubleDouble>::new(&system).expect("prepared");
        let limits = Limits { until: 1e9, events: None, most: None };
        let (left, may_go_on) = (&LeftOpen::default(), false);
        let (system, solver, is_backward) = (&system, &solver, false);
        let rows =
            Rows { system, solver, is_backward, digits: 17, limits, bar: None, left, may_go_on };
        let event = |time: f64, error: f64| Event {
            what: What::Watch(0, 0),
            time: Time::<DoubleDouble> {
                high: DoubleDouble::exact(time),
                low: DoubleDouble::exact(0.0),
            },
            state: vec![DoubleDouble::exact(0.0); 2],
            mode: 0,
            errors: Some(Errors { time: error, state: vec![0.0; 2] }),
        };
        let (mut end, mut passed) = (RunEnd::default(), Passed::default());
        // A time next to zero has few digits and is known all the same.
        for known in [event(1e-18, 1e-19), event(12.5, 1e-6), event(12.5, 0.0)] {
            assert!(rows.passes(&known, &mut passed, &mut end) && end.notes.is_empty());
        }
        for known in [event(12.625, 1e-4), event(12.75, 1e-3)] {
            assert!(rows.passes(&known, &mut passed, &mut end));
        }
        let said = "from event 4 on, at 12.625, the time has fewer than 6 digits";
        assert_eq!(end.notes, [said]);
        assert!(!rows.passes(&event(12.75, 100.0), &mut passed, &mut end));
        assert_eq!(
            end.notes[1..],
            ["after 5 events no digit of the time is left: the run ends there"]
        );
    }
}
