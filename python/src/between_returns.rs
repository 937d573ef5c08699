//! The events of a run that is measured in returns, ended as the command `simulate` ends them.

use crate::collect::{End, Kept, Limits, STOPPED, row};
use percuss::affine::NoReturn;
use percuss::{Ending, Event, Events};
use percuss_validation::returns::{CountedReturns, EventReturns};

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

    /// Whether a run is past the returns that are left out, where so many events of the section
    /// have come.
    fn is_shown(&self, returns: u64) -> bool {
        match &self.counted {
            CountedReturns::Strobes(strobes) => strobes.left_out == 0,
            CountedReturns::Events(returning) => returns >= returning.left_out,
        }
    }

    /// The events of a section of events.
    fn events(&self) -> Option<&EventReturns> {
        match &self.counted {
            CountedReturns::Events(returning) => Some(returning),
            CountedReturns::Strobes(_) => None,
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
    /// Whether the returns that are left out are over.
    is_shown: bool,
    /// The events of the section, and the time of the last of them or of the start.
    returns: u64,
    since: f64,
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
    let (start, is_shown) = (events.start(), returning.is_shown(0));
    let end = End { is_decided: true, ..End::default() };
    let (returns, since, passed, last) = (0, *start.time(), 0, None);
    let mut walk = Walk {
        events,
        returning,
        limits,
        names,
        keep,
        end,
        is_shown,
        returns,
        since,
        passed,
        last,
    };
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
        let last = self.returning.events().and_then(|it| it.last);
        let by_returns = last.is_none_or(|last| self.returns < last);
        by_returns && self.limits.count.is_none_or(|wanted| self.passed < wanted)
    }

    /// Hands on a row.
    fn show(&mut self, event: &Event<'_, f64>, name: &str) -> Result<(), E> {
        let shown = row(event, name.to_owned(), self.names);
        self.last = Some(shown.clone());
        (self.keep)(Some(shown))
    }

    /// Takes an event of the system.
    fn pass(&mut self, event: &Event<'_, f64>) -> Result<(), E> {
        if self.returning.events().is_some_and(|it| it.counts(event.kind())) {
            self.returns += 1;
            self.since = *event.time();
        }
        if self.is_shown {
            self.passed += 1;
            return self.show(event, event.name());
        }
        self.is_shown = self.returning.is_shown(self.returns);
        if self.is_shown { self.show(event, "") } else { (self.keep)(None) }
    }

    /// Lets the run go on from a horizon, which may be the last return that is left out; whether it
    /// does.
    fn goes_on(&mut self, at: &Event<'_, f64>) -> Result<bool, E> {
        let Some(returning) = self.returning.events() else {
            if self.is_shown {
                return Ok(false);
            }
            self.is_shown = true;
            self.show(at, "")?;
            return Ok(self.events.go_on(self.returning.horizon));
        };
        let waits = !self.is_shown || returning.last.is_some();
        let stop = match waits && !self.returning.is_timed {
            true => self.since + returning.longest,
            false => self.returning.horizon,
        };
        Ok(stop > *at.time() && self.events.go_on(stop))
    }

    /// Keeps the ending, and why the run has not returned as often as was asked.
    fn end(&mut self, event: &Event<'_, f64>, ending: Ending) {
        self.end.comes_with(event, ending);
        let is_timed = self.returning.is_timed;
        let is_short = self.returning.events().is_some() && (!is_timed || !self.is_shown);
        if ending == Ending::Horizon && is_short {
            let why = match is_timed {
                true => NoReturn::Ended(Ending::Horizon),
                false => NoReturn::Equilibrium,
            };
            self.end.cause = Some(why.to_string());
        }
    }

    fn is_stopped(&self) -> bool {
        self.is_shown && self.limits.most.is_some_and(|most| self.passed >= most)
    }

    /// Ends a run that has as many events as it may have.
    fn stop(&mut self) -> Result<(), E> {
        self.end.name = Some(STOPPED.to_owned());
        let last = self.last.take();
        (self.keep)(last.map(|last| Kept { name: STOPPED.to_owned(), ..last }))
    }
}
