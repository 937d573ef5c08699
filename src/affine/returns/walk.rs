//! A motion from one return to its section to the next.

use super::map::SectionMap;
use super::section::{Guard, Returning};
use crate::affine::model::ending::Ending;
use crate::affine::run::Run;
use crate::affine::run::place::Place;
use crate::affine::solver::event::{self as engine, Event, What};
use crate::numeric::number::Number;
use std::fmt;

/// The reason for which a motion does not return to its section.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum NoReturn {
    /// Nothing happens there within the longest time of a return: the motion comes to rest, or goes
    /// elsewhere.
    Equilibrium,
    /// The run ends.
    Ended(Ending),
    /// The return is one of several events of one instant, between which no run begins.
    AmidEvents,
    /// The return lies between the last impact that is an event and the limit of those that follow,
    /// where no derivative is taken.
    AmidImpacts,
}

impl fmt::Display for NoReturn {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Equilibrium => f.write_str("the motion does not return to the section"),
            Self::Ended(ending) => write!(f, "the run ends: {ending}"),
            Self::AmidImpacts => f.write_str(
                "the return lies among impacts that accumulate, where no derivative is taken",
            ),
            Self::AmidEvents => f.write_str("the section's event is one of several at once"),
        }
    }
}

impl std::error::Error for NoReturn {}

/// The bits of a mode's `until` among those that tell the ways of two motions apart.
const UNTIL_BITS: usize = 5;

/// A motion that is followed from return to return.
pub(super) struct Walk<'a, T: Number> {
    map: &'a SectionMap<'a, T>,
    run: Run<'a, T>,
    last: Event<T>,
    /// The number of the next strobe from the angle's first after time zero.
    strobe: f64,
    /// The place where the motion begins, if it only approximates a point of the section.
    beside: Option<Place<T>>,
    /// The event by which it came onto the section from there, if it lay short of that.
    onto_section: Option<Guard>,
    /// The `until` that have fired since the last return, as bits, of which several may share one.
    fired: u64,
}

impl<'a, T: Number> Walk<'a, T> {
    /// The motion from a place on. A strobe at that place is the first return where `counts_first`
    /// says so.
    pub fn begin(map: &'a SectionMap<'a, T>, place: &Place<T>, counts_first: bool) -> Self {
        let strobe = map.strobe_after(&place.time, counts_first);
        let until = map.horizon(&place.time, strobe);
        let run = map.solver().run_at(place, until);
        let last = run.start();
        Self { map, run, last, strobe, beside: None, onto_section: None, fired: 0 }
    }

    /// The motion from a place that approximates a point of the section. Where it lies short of an
    /// event's guard, the motion first comes onto the section, which is no return.
    pub fn beside(map: &'a SectionMap<'a, T>, place: &Place<T>) -> Self {
        let beside = matches!(map.section().returns, Returning::Events(_)).then(|| place.clone());
        Self { beside, ..Self::begin(map, place, false) }
    }

    /// Lets a motion of which many returns are asked for search its events beyond strobes.
    pub fn for_many(mut self) -> Self {
        if let Some(reach) = self.map.search_ahead() {
            self.run.search_ahead(reach);
        }
        self
    }

    /// The next return; `see` is shown each event on the way, with the one before it.
    pub fn next(
        &mut self,
        see: &mut dyn FnMut(&Event<T>, &Event<T>),
    ) -> Result<Event<T>, NoReturn> {
        let mut left = self.map.section().every.max(1);
        self.fired = 0;
        self.run.go_on_to(self.map.horizon(&self.last.time, self.strobe));
        loop {
            let event = self.run.next().ok_or(NoReturn::Ended(Ending::Horizon))?;
            see(&self.last, &event);
            self.last.clone_from(&event);
            if let What::Until(mode, until) = event.what {
                self.fired |= 1 << ((mode * UNTIL_BITS + until) % u64::BITS as usize);
            }
            if !self.returns()? || self.comes_onto_section(&event) {
                continue;
            }
            self.strobe += 1.0;
            left -= 1;
            if left == 0 {
                return Ok(event);
            }
            self.run.go_on_to(self.map.horizon(&event.time, self.strobe));
        }
    }

    /// The next return, at which a derivative is taken.
    pub fn next_with_derivative(
        &mut self,
        see: &mut dyn FnMut(&Event<T>, &Event<T>),
    ) -> Result<Event<T>, NoReturn> {
        let event = self.next(see)?;
        if self.run.is_silent() { Err(NoReturn::AmidImpacts) } else { Ok(event) }
    }

    /// The place among the events of the way of that by which the motion came onto the section.
    pub fn place_of_onto_section(&self, events: impl Iterator<Item = Guard>) -> Option<usize> {
        let onto = self.onto_section?;
        events.into_iter().position(|it| it == onto)
    }

    /// Whether an event, the first of the section's, is the crossing of the guard beside which the
    /// motion began: the guard has gone as far as it was short there, to rounding.
    ///
    /// From a point of the section the guard goes on and has to come back, which takes longer.
    fn comes_onto_section(&mut self, event: &Event<T>) -> bool {
        /// The largest distance that the guard goes, in that by which it was short: its rate may
        /// change on the way.
        const MAX_DISTANCE_RATIO: f64 = 2.0;
        /// The rounding of the guard, in eps of its size: a place on the section may lie short of
        /// it by what the modal co-ordinates round off.
        const ROUNDINGS: f64 = 1024.0;
        let (Some(place), Some(guard)) = (self.beside.take(), Guard::new(&event.what)) else {
            return false;
        };
        let (solver, system) = (self.map.solver(), self.map.system());
        if [place.mode, event.mode] != [guard.mode; 2] {
            return false;
        }
        let row = (guard.mode, guard.place_among_all(system));
        let at = |time, state: &[T]| solver.guard_and_rate(row, time, state).map(T::to_f64);
        let [value, rate, size] = at(&place.time, &place.state);
        let [_, rate_there, _] = at(&event.time, &event.state);
        let gone = rate.abs() * event.time.since(&place.time).value().to_f64();
        let short = (-value * rate.signum()).max(0.0);
        let comes_onto = guard.fires_at_rate(system, rate)
            && rate * rate_there > 0.0
            && gone <= MAX_DISTANCE_RATIO * short + ROUNDINGS * f64::EPSILON * size
            && guard.is_kept_by_its_event(system);
        self.onto_section = comes_onto.then_some(guard);
        comes_onto
    }

    /// Whether the last event is a return.
    fn returns(&self) -> Result<bool, NoReturn> {
        match (&self.last.what, &self.map.section().returns) {
            (What::End(engine::Ending::Horizon), Returning::Strobe(_)) => Ok(true),
            (What::End(engine::Ending::Horizon), Returning::Events(_)) => {
                Err(NoReturn::Equilibrium)
            }
            (What::End(ending), _) => Err(NoReturn::Ended(Ending::from(ending))),
            (what, Returning::Events(guards)) => {
                Ok(Guard::new(what).is_some_and(|it| guards.contains(&it)))
            }
            (_, Returning::Strobe(_)) => Ok(false),
        }
    }

    /// Goes on to the first strobe of the forcing from the last event on, if there is one and the
    /// run does not end before.
    fn go_on_to_strobe(&mut self) {
        let next = self.map.strobe_after(&self.last.time, true);
        if let Some(strobe) = self.map.strobe(next) {
            self.run.go_on_to(strobe);
            if let Some(event) = self.run.by_ref().last() {
                self.last = event;
            }
        }
    }

    /// The place of the last return.
    pub fn place(&mut self) -> Result<Place<T>, NoReturn> {
        self.run.place().ok_or(NoReturn::AmidEvents)
    }

    /// The number of choices so far that rounding left open.
    pub fn undecidable(&self) -> u64 {
        self.run.work().undecidable
    }
}

/// A point of a section: the state just after the event there, or at the strobe.
#[derive(Clone, Debug, PartialEq)]
pub struct Return<T> {
    /// The index of the mode that goes on.
    pub mode: usize,
    /// The time.
    pub time: T,
    /// The states, in the order of [`System::states`](crate::System::states).
    pub state: Vec<T>,
}

impl<T: Number> Return<T> {
    /// The mode, time and state of an event.
    fn new(event: Event<T>) -> Self {
        Self { mode: event.mode, time: event.time.value(), state: event.state }
    }
}

/// The returns of a motion to its section, as an iterator; the first error is the last item.
pub struct Returns<'a, T: Number> {
    walk: Walk<'a, T>,
    is_over: bool,
}

impl<'a, T: Number> Returns<'a, T> {
    pub(super) fn begin(map: &'a SectionMap<'a, T>, place: &Place<T>) -> Self {
        Self { walk: Walk::begin(map, place, true).for_many(), is_over: false }
    }

    /// Without a return at the place itself.
    pub(super) fn after(map: &'a SectionMap<'a, T>, place: &Place<T>) -> Self {
        Self { walk: Walk::begin(map, place, false).for_many(), is_over: false }
    }

    /// The place of the last return, from which a motion may go on.
    ///
    /// # Errors
    /// A return that is one of several events of one instant.
    pub fn place(&mut self) -> Result<Place<T>, NoReturn> {
        self.walk.place()
    }

    /// Where a motion is that has not returned for the longest time: of a forced system, at the
    /// next strobe, so that motions which go to one orbit are found at one state.
    pub(in crate::affine) fn given_up(&mut self) -> Return<T> {
        self.walk.go_on_to_strobe();
        self.last_event()
    }

    /// The last event of the motion, whether it is a return or not: the state in which a motion
    /// ends that does not return.
    #[must_use]
    pub fn last_event(&self) -> Return<T> {
        Return::new(self.walk.last.clone())
    }

    /// The `until` that have fired between the last two returns, as bits, of which several may
    /// share one: motions of different bits lie on different pieces of the map.
    pub(in crate::affine) fn fired(&self) -> u64 {
        self.walk.fired
    }

    /// The number of ties, touches, entries and conditions that rounding leaves undecided.
    #[must_use]
    pub fn undecidable(&self) -> u64 {
        self.walk.undecidable()
    }
}

impl<T: Number> Iterator for Returns<'_, T> {
    type Item = Result<Return<T>, NoReturn>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.is_over {
            return None;
        }
        let next = self.walk.next(&mut |_, _| ()).map(Return::new);
        self.is_over = next.is_err();
        Some(next)
    }
}

impl<T: Number> std::iter::FusedIterator for Returns<'_, T> {}
