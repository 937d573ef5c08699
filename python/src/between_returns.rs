//! The events of a run that is measured in returns, ended as the command `simulate` ends them.

use crate::collect::{End, Kept, Limits, STOPPED_ENDING, row};
use percuss::{Ending, Event, Events};
use percuss_validation::returns::{CountedReturns, ReturnCount};

/// The returns in which a run is measured, and its end.
pub(crate) struct Returning {
    pub(crate) counted: CountedReturns,
    /// The time at which the run ends at the latest.
    pub(crate) horizon: f64,
    /// Whether that time is asked for.
    pub(crate) is_timed: bool,
}

impl Returning {
    /// The time up to which a run from this start goes first.
    pub(crate) fn first_stop(&self, start: f64) -> f64 {
        match &self.counted {
            CountedReturns::Strobes(strobes) if strobes.left_out > 0 => strobes.first(),
            CountedReturns::Events(returning) if !self.is_timed => start + returning.longest,
            _ => self.horizon,
        }
    }

    /// The count of returns of a run from this start, if they are returns to an event, and whether
    /// none are left out.
    fn begin(&self, start: f64) -> (Option<ReturnCount<'_>>, bool) {
        match &self.counted {
            CountedReturns::Strobes(strobes) => (None, strobes.left_out == 0),
            CountedReturns::Events(returning) => {
                let count = ReturnCount::begin(returning, start);
                (Some(count), count.is_past_transient())
            }
        }
    }
}

/// A receiver of the rows of a run, and of nothing for each event that is left out; it may end the
/// run by an error.
type Keep<'k, E> = &'k mut dyn FnMut(Option<Kept<f64>>) -> Result<(), E>;

/// A run under way from return to return.
struct Walk<'a, 'k, E> {
    events: Events<'a, f64>,
    returning: &'k Returning,
    limits: Limits,
    names: &'k [String],
    keep: Keep<'k, E>,
    end: End,
    /// The returns that have been made, if they are returns to an event.
    count: Option<ReturnCount<'k>>,
    /// Whether the returns that are left out are over.
    is_shown: bool,
    /// The events that are shown.
    passed: usize,
    last: Option<Kept<f64>>,
}

/// Goes through a run up to [`Returning::first_stop`], and on from there, differentiated by these
/// names.
pub(crate) fn walk<E>(
    events: Events<'_, f64>,
    returning: &Returning,
    limits: Limits,
    names: &[String],
    keep: Keep<'_, E>,
) -> Result<End, E> {
    let start = events.start();
    let (count, is_shown) = returning.begin(*start.time());
    let end = End { is_decided: true, ..End::default() };
    let (passed, last) = (0, None);
    let mut walk =
        Walk { events, returning, limits, names, keep, end, count, is_shown, passed, last };
    if is_shown {
        walk.show(&start, "")?;
    }
    walk.go()?;
    let Walk { events, mut end, .. } = walk;
    end.cause = end.cause.or_else(|| events.cause().map(|it| it.to_string()));
    (end.bits, end.undecidable) = (events.bits(), events.undecidable());
    Ok(end)
}

impl<E> Walk<'_, '_, E> {
    fn go(&mut self) -> Result<(), E> {
        while self.is_wanted() {
            let Some(event) = self.events.next() else { break };
            match event.ending() {
                Some(Ending::Horizon) if self.goes_on(&event)? => {}
                Some(ending) => {
                    self.end(&event, ending);
                    return self.show(&event, event.name());
                }
                None if self.is_stopped() => return self.stop(),
                None => self.pass(&event)?,
            }
        }
        Ok(())
    }

    /// Whether the run has not come to the return or the event that ends it.
    fn is_wanted(&self) -> bool {
        self.count.is_none_or(|it| it.goes_on())
            && self.limits.count.is_none_or(|wanted| self.passed < wanted)
    }

    /// Hands on a row.
    fn show(&mut self, event: &Event<'_, f64>, name: &str) -> Result<(), E> {
        let shown = row(event, name.to_owned(), self.names);
        self.last = Some(shown.clone());
        (self.keep)(Some(shown))
    }

    /// Takes an event of the system.
    fn pass(&mut self, event: &Event<'_, f64>) -> Result<(), E> {
        if let Some(count) = &mut self.count {
            count.take(event.kind(), *event.time());
        }
        if self.is_shown {
            self.passed += 1;
            return self.show(event, event.name());
        }
        self.is_shown = self.count.is_some_and(|it| it.is_past_transient());
        if self.is_shown { self.show(event, "") } else { (self.keep)(None) }
    }

    /// Lets the run go on from a horizon, which may be the last return that is left out; whether it
    /// does.
    fn goes_on(&mut self, at: &Event<'_, f64>) -> Result<bool, E> {
        let Some(count) = &self.count else {
            if self.is_shown {
                return Ok(false);
            }
            self.is_shown = true;
            self.show(at, "")?;
            return Ok(self.events.go_on(self.returning.horizon));
        };
        let stop = count.horizon(self.returning.is_timed, self.returning.horizon);
        Ok(stop > *at.time() && self.events.go_on(stop))
    }

    /// Keeps the ending, and why the run has not returned as often as was asked.
    fn end(&mut self, event: &Event<'_, f64>, ending: Ending) {
        self.end.comes_with(event, ending);
        let why = self.count.and_then(|it| it.no_return(self.returning.is_timed));
        if ending == Ending::Horizon
            && let Some(why) = why
        {
            self.end.cause = Some(why.to_string());
        }
    }

    fn is_stopped(&self) -> bool {
        self.is_shown && self.limits.most.is_some_and(|most| self.passed >= most)
    }

    /// Ends a run that has as many events as it may have.
    fn stop(&mut self) -> Result<(), E> {
        self.end.name = Some(STOPPED_ENDING.to_owned());
        let last = self.last.take();
        (self.keep)(last.map(|last| Kept { name: STOPPED_ENDING.to_owned(), ..last }))
    }
}
