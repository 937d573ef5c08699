//! The returns by which a run is measured: to a forcing angle, whose times are known before the
//! run, or to an event.

use crate::typed::WrittenSection;
use percuss::affine::{DEFAULT_MAX_RETURN_TIME, NoReturn};
use percuss::{Ending, Kind, System, SystemError};
use std::f64::consts::TAU;

/// The most returns that a run may have.
pub const MAX_RETURNS: u64 = 1_000_000_000;

/// The distance from a strobe within which a time is taken for it, relative to the time and in
/// forcing periods.
const STROBE_TOLERANCE: f64 = 1e-9;

/// The returns that a run is to be measured in.
#[derive(Clone, Copy, Debug)]
pub struct WantedReturns<'a> {
    /// The returns that are left out.
    pub left_out: u64,
    /// The returns with which the run ends, where its length is so many.
    pub wanted: Option<u64>,
    /// The section; none is the forcing's angle at the start.
    pub section: Option<&'a WrittenSection>,
    /// The number of instants of the section that make one return.
    pub every: u32,
    /// The longest time to wait for a return to an event, if it is not the usual one.
    pub longest: Option<f64>,
}

/// The reason for which returns cannot be counted.
#[derive(Debug)]
pub enum Uncounted {
    /// More returns than a run may have: so many.
    TooMany(u64),
    /// A forcing angle in a system without forcing.
    NotForced,
    /// A system that does not start.
    NoStart(SystemError),
}

/// The returns that a run counts.
#[derive(Clone, Debug)]
pub enum CountedReturns {
    /// Returns to a forcing angle.
    Strobes(Strobes),
    /// Returns to an event.
    Events(EventReturns),
}

/// Returns to a forcing angle: those that are left out, and those that are wanted where the run's
/// length is so many.
#[derive(Clone, Debug)]
pub struct Strobes {
    /// The time from which returns are counted.
    pub zeroth: f64,
    period: f64,
    /// The number of forcing periods that make one return.
    pub every: u64,
    /// The returns that are left out.
    pub left_out: u64,
    /// The returns after these with which the run ends, where its length is so many.
    pub wanted: Option<u64>,
}

/// Returns to an event.
#[derive(Clone, Debug)]
pub struct EventReturns {
    kinds: Vec<Kind>,
    /// Events of the section that are left out.
    pub left_out: u64,
    /// Events of the section with which the run ends, where its length is so many returns.
    pub last: Option<u64>,
    /// The number of events that make one return.
    pub every: u64,
    /// The longest time to wait for an event of the section.
    pub longest: f64,
}

impl Strobes {
    /// The time of a return, the first being number 1.
    fn at(&self, number: u64) -> f64 {
        self.zeroth + (number * self.every) as f64 * self.period
    }

    /// The time at which the transient ends.
    #[must_use]
    pub fn first(&self) -> f64 {
        self.at(self.left_out)
    }

    /// The time at which the run ends, where its length is a number of returns.
    #[must_use]
    pub fn last(&self) -> Option<f64> {
        self.wanted.map(|wanted| self.at(self.left_out + wanted))
    }
}

impl EventReturns {
    /// Whether an event of this kind is one of the section.
    fn counts(&self, kind: Kind) -> bool {
        self.kinds.contains(&kind)
    }
}

/// The returns to an event that a run under way has made.
#[derive(Clone, Copy, Debug)]
pub struct ReturnCount<'r> {
    returning: &'r EventReturns,
    /// Events of the section.
    events: u64,
    /// The time of the last of these, or of the start.
    since: f64,
}

impl<'r> ReturnCount<'r> {
    /// The count of a run that starts at this time.
    #[must_use]
    pub const fn begin(returning: &'r EventReturns, start: f64) -> Self {
        Self { returning, events: 0, since: start }
    }

    /// Takes an event of the system.
    pub fn take(&mut self, kind: Kind, time: f64) {
        if self.returning.counts(kind) {
            self.events += 1;
            self.since = time;
        }
    }

    /// The whole returns that have been made.
    #[must_use]
    pub const fn returns(&self) -> u64 {
        self.events / self.returning.every
    }

    /// The share of the returns with which the run ends that have been made; none of a run of
    /// another length.
    #[must_use]
    pub fn share(&self) -> Option<f64> {
        self.returning.last.map(|last| self.events as f64 / last as f64)
    }

    /// Whether the returns that are left out have been made.
    #[must_use]
    pub const fn is_past_transient(&self) -> bool {
        self.events >= self.returning.left_out
    }

    /// Whether the run has not come to the return that ends it.
    #[must_use]
    pub fn goes_on(&self) -> bool {
        self.returning.last.is_none_or(|last| self.events < last)
    }

    /// The time up to which the run goes from here: that to which a return is waited for, or
    /// `last`, where that time is asked for or no return is wanted.
    #[must_use]
    pub fn horizon(&self, is_timed: bool, last: f64) -> f64 {
        let waits = !self.is_past_transient() || self.returning.last.is_some();
        if waits && !is_timed { self.since + self.returning.longest } else { last }
    }

    /// The reason for which a run that ends at its horizon has not returned as often as was asked,
    /// if it has not.
    #[must_use]
    pub fn no_return(&self, is_timed: bool) -> Option<NoReturn> {
        match is_timed {
            false => Some(NoReturn::Equilibrium),
            true if self.is_past_transient() => None,
            true => Some(NoReturn::Ended(Ending::Horizon)),
        }
    }
}

impl WantedReturns<'_> {
    /// The returns to be counted, of a section that the system has.
    ///
    /// # Errors
    /// Too many returns, a forcing angle where there is no forcing, and a system that does not
    /// start.
    pub fn counted(&self, system: &System) -> Result<CountedReturns, Uncounted> {
        self.check_count()?;
        match self.section {
            Some(WrittenSection::Event { event, mode }) => {
                Ok(CountedReturns::Events(self.of_event(system, event, mode.as_deref())))
            }
            Some(WrittenSection::Strobe(angle)) => self.of_angle(system, Some(*angle)),
            None => self.of_angle(system, None),
        }
    }

    /// Refuses more returns than a run may have.
    fn check_count(&self) -> Result<(), Uncounted> {
        let returns = self.left_out.saturating_add(self.wanted.unwrap_or(0));
        let whole = returns.saturating_mul(u64::from(self.every));
        if whole > MAX_RETURNS { Err(Uncounted::TooMany(whole)) } else { Ok(()) }
    }

    fn of_event(&self, system: &System, event: &str, mode: Option<&str>) -> EventReturns {
        let every = u64::from(self.every);
        EventReturns {
            kinds: kinds(system, event, mode),
            left_out: self.left_out * every,
            last: self.wanted.map(|wanted| (self.left_out + wanted) * every),
            every,
            longest: self.longest.unwrap_or(DEFAULT_MAX_RETURN_TIME * system.time_scale),
        }
    }

    /// Returns to an angle, or to that of the start.
    fn of_angle(&self, system: &System, angle: Option<f64>) -> Result<CountedReturns, Uncounted> {
        let forcing = system.forcing.as_ref().ok_or(Uncounted::NotForced)?;
        let omega = forcing.omega.to_f64();
        let start = system.start().map_err(Uncounted::NoStart)?.time.to_f64();
        let period = TAU / omega;
        let zeroth = angle.map_or(start, |angle| strobe_at_or_before(start, angle / omega, period));
        let (every, left_out, wanted) = (u64::from(self.every), self.left_out, self.wanted);
        Ok(CountedReturns::Strobes(Strobes { zeroth, period, every, left_out, wanted }))
    }
}

/// The last strobe that is not after a time.
fn strobe_at_or_before(time: f64, first: f64, period: f64) -> f64 {
    let turns = (time - first) / period;
    let nearest = turns.round();
    let is_at_it = (turns - nearest).abs() <= STROBE_TOLERANCE * turns.abs().max(1.0);
    first + if is_at_it { nearest } else { turns.floor() } * period
}

/// The kinds of the events of a name, in any mode or in one alone.
fn kinds(system: &System, event: &str, mode: Option<&str>) -> Vec<Kind> {
    let modes = system.modes.iter().enumerate();
    let own = modes.filter(|(_, it)| mode.is_none_or(|name| it.name == name));
    let of_mode = own.flat_map(|(n, it)| {
        let until = it.until.iter().enumerate().map(move |(k, it)| (Kind::Until(n, k), &it.name));
        let watch = it.watch.iter().enumerate().map(move |(k, it)| (Kind::Watch(n, k), &it.name));
        until.chain(watch)
    });
    of_mode.filter(|(_, name)| *name == event).map(|(kind, _)| kind).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_strobe_at_the_start_is_the_last_one() {
        assert_eq!(strobe_at_or_before(0.0, 0.0, 2.0), 0.0);
        assert_eq!(strobe_at_or_before(0.0, 0.5, 2.0), -1.5);
        assert_eq!(strobe_at_or_before(7.0, 0.5, 2.0), 6.5);
        assert_eq!(strobe_at_or_before(6.5 - 1e-12, 0.5, 2.0), 6.5);
    }
}
