//! The events and the samples of a run, as iterators.

use super::answer::{Answer, Running};
use super::cause::Cause;
use super::event::{Ending, Event, Kind};
use std::iter::FusedIterator;

/// The events of a run, as an iterator; the last is the ending, of a run that ends.
pub struct Events<'a, A: Answer> {
    pub(super) run: Box<dyn Running<'a, A::Value> + Send + 'a>,
    /// The number of events that are still wanted, where it is limited.
    pub(super) left: Option<usize>,
}

impl<'a, A: Answer> Events<'a, A> {
    /// The start, as an event.
    ///
    /// ```
    /// use percuss::{Proved, System, gallery};
    ///
    /// let ball = System::from_toml(gallery::BOUNCING_BALL)?;
    /// let solver = ball.solver::<Proved>()?;
    /// let events = solver.run().until(1.0)?;
    /// assert!(events.start().value("v").is_some_and(Proved::is_zero));
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    #[must_use]
    pub fn start(&self) -> Event<'a, A::Value> {
        self.run.start()
    }

    /// The cause of the ending, of a run that has ended as [`Ending::Undecided`] or as
    /// [`Ending::BeyondGuard`].
    #[must_use]
    pub fn cause(&self) -> Option<Cause> {
        self.run.cause()
    }

    /// The number of ties, touches and entries so far that the rounding of this arithmetic does not
    /// decide: the run takes one side of each. A run in [`Proved`](crate::Proved) numbers has
    /// none: it goes on in more bits instead, and ends where these do not suffice.
    ///
    /// ```
    /// use percuss::{Proved, System, gallery};
    ///
    /// // 0.1 and 0.3 are no tenths: in truth the second guard is the first to cross, by 1e-17.
    /// let system = System::from_toml(r#"
    ///     schema = 1
    ///     name = "near-tie"
    ///     states = ["x", "y"]
    ///     [parameters]
    ///     a = 0.1
    ///     b = 0.3
    ///     [[mode]]
    ///     name = "on"
    ///     equations = ["x' = 1", "y' = 3"]
    ///     watch = [{ name = "one", guard = "x > a" }, { name = "two", guard = "y > b" }]
    ///     [start]
    ///     mode = "on"
    ///     x = 0
    ///     y = 0
    /// "#)?;
    /// let solver = system.solver::<f64>()?;
    /// let mut events = solver.run().until(1.0)?;
    /// assert_eq!(events.by_ref().count(), 3);
    /// assert!(events.undecidable() > 0);
    /// let solver = system.solver::<Proved>()?;
    /// let first = solver.run().until(1.0)?.next().expect("an event");
    /// assert_eq!(first.name(), "two");
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    #[must_use]
    pub fn undecidable(&self) -> u64 {
        self.run.undecidable()
    }

    /// The bits of the arithmetic that the run has come to.
    ///
    /// ```
    /// use percuss::{Proved, System, gallery};
    ///
    /// let ball = System::from_toml(gallery::BOUNCING_BALL)?;
    /// let solver = ball.solver::<Proved>()?;
    /// assert_eq!(solver.run().events(3)?.bits(), 106);
    /// assert_eq!(solver.run().digits(50).events(3)?.bits(), 212);
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    #[must_use]
    pub fn bits(&self) -> u32 {
        self.run.bits()
    }
}

impl Events<'_, f64> {
    /// Lets a run that has ended at its horizon go on to a later time, and says whether it does: a
    /// run with samples does not. So a caller has the state at times of its own, and the events
    /// between them.
    ///
    /// ```
    /// use percuss::{Ending, System, gallery};
    ///
    /// let ball = System::from_toml(gallery::BOUNCING_BALL)?;
    /// let solver = ball.solver::<f64>()?;
    /// let mut events = solver.run().until(1.0)?;
    /// let there = events.next().expect("the horizon, before the first impact");
    /// assert_eq!((there.ending(), there.state()), (Some(Ending::Horizon), &[0.5, -1.0][..]));
    /// assert!(events.next().is_none() && events.go_on(2.0));
    /// assert_eq!(events.next().map(|it| it.name()), Some("impact"));
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    pub fn go_on(&mut self, until: f64) -> bool {
        self.run.go_on(until)
    }
}

impl<'a, A: Answer> Iterator for Events<'a, A> {
    type Item = Event<'a, A::Value>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.left == Some(0) {
            return None;
        }
        let event = self.run.next()?;
        self.left = self.left.map(|it| it - 1);
        Some(event)
    }
}

impl<A: Answer> FusedIterator for Events<'_, A> {}

/// The samples of a run, as an iterator.
///
/// ```
/// use percuss::{Ending, System, gallery};
///
/// let ball = System::from_toml(gallery::BOUNCING_BALL)?;
/// let solver = ball.solver::<f64>()?;
/// let mut samples = solver.run().samples(10)?;
/// // The impacts accumulate at 4.24: there the samples end.
/// assert_eq!(samples.by_ref().count(), 43);
/// assert_eq!(samples.ending(), Some(Ending::Accumulation));
/// # Ok::<(), percuss::SystemError>(())
/// ```
pub struct Samples<'a, A: Answer> {
    pub(super) events: Events<'a, A>,
    pub(super) ending: Option<Ending>,
}

impl<'a, A: Answer> Samples<'a, A> {
    /// The ending of the run, once the samples have come to it.
    #[must_use]
    pub fn ending(&self) -> Option<Ending> {
        self.ending
    }

    /// The events between which the samples lie, from the last sample on: they have the
    /// [cause](Events::cause) of the ending.
    #[must_use]
    pub fn events(&self) -> &Events<'a, A> {
        &self.events
    }
}

impl<'a, A: Answer> Iterator for Samples<'a, A> {
    type Item = Event<'a, A::Value>;

    fn next(&mut self) -> Option<Self::Item> {
        self.events.find(|it| match it.kind() {
            Kind::Sample => true,
            Kind::End(ending) => {
                self.ending = Some(ending);
                false
            }
            _ => false,
        })
    }
}

impl<A: Answer> FusedIterator for Samples<'_, A> {}
