//! Runs as their users ask for them: events with names, in f64, in more bits, or with proved
//! digits.
//!
//! [`answer`] has the kinds of numbers; [`plain`] runs in one arithmetic, and [`escalation`] in one
//! after the other until the digits are proved. [`steps`] puts samples between the events of a run,
//! and [`gradient`] has their derivatives.
//! [`length`] says how long a run is, and [`iterators`] go through it. [`event`] and [`proved`] are
//! what is given out, and [`interval`] prints it. Read this file first, then `length`, `event` and
//! `escalation`.

mod answer;
mod cause;
mod escalation;
mod event;
mod gradient;
mod interval;
mod iterators;
mod length;
mod plain;
mod proved;
mod request;
mod sizes;
mod steps;

pub use answer::Answer;
pub use cause::Cause;
pub use escalation::PRECISION_BITS;
pub use event::{Ending, Event, Kind};
pub use gradient::Gradient;
pub use iterators::{Events, Samples};
pub use length::Run;
pub use proved::Proved;
pub use steps::MAX_HORIZON;

use crate::affine::model::error::SystemError;
use crate::affine::model::system::{StartPoint, System};
use crate::affine::solver;
use std::borrow::Cow;

/// A system prepared for runs that answer in numbers of one kind.
///
/// It is prepared once and serves any number of runs, on several threads at the same time.
///
/// ```
/// use percuss::{System, gallery};
///
/// let ball = System::from_toml(gallery::BOUNCING_BALL)?;
/// let solver = ball.solver::<f64>()?;
/// // The same ball from ten heights, on as many threads.
/// let first_impact = |height: f64| {
///     let start = ball.start_at("flight", 0.0, &[height, 0.0])?;
///     Ok(solver.run_from(&start).events(1)?.next().map(|impact| *impact.time()))
/// };
/// let times = std::thread::scope(|scope| {
///     let runs: Vec<_> = (1..=10)
///         .map(|height| scope.spawn(move || first_impact(f64::from(height))))
///         .collect();
///     runs.into_iter().map(|run| run.join().expect("no panic")).collect::<Result<Vec<_>, _>>()
/// })?;
/// assert_eq!(times[7], Some(4.0)); // From 8 with g = 1: the root of 2 * 8.
/// # Ok::<(), percuss::SystemError>(())
/// ```
pub struct Solver<A: Answer> {
    prepared: A::Prepared,
}

impl System {
    /// Prepares the system for runs that answer in `f64`, in more bits, or in
    /// [`Proved`](crate::Proved) numbers.
    ///
    /// # Errors
    /// A system that [`System::check`] refuses, or whose structural zeros cannot be decided.
    pub fn solver<A: Answer>(&self) -> Result<Solver<A>, SystemError> {
        Ok(Solver { prepared: A::prepare(self, false)? })
    }

    /// Prepares the system for runs back in time, which have watched events alone and end at the
    /// boundary of their mode.
    ///
    /// # Errors
    /// A system that [`System::check`] refuses, or whose structural zeros cannot be decided.
    pub fn backward_solver<A: Answer>(&self) -> Result<Solver<A>, SystemError> {
        Ok(Solver { prepared: A::prepare(self, true)? })
    }
}

impl Solver<f64> {
    /// The prepared system, as the return maps of its sections and their orbits take it.
    ///
    /// ```
    /// use percuss::system::{Section, SectionMap};
    /// use percuss::{System, gallery};
    ///
    /// let room = System::from_toml(gallery::THERMOSTAT)?;
    /// let solver = room.solver::<f64>()?;
    /// let map = SectionMap::new(solver.for_sections(), &Section::event("switch-off"))?;
    /// let first = map.returns(room.start()?)?.next();
    /// let event = solver.run().events(1)?.next();
    /// assert_eq!(first.and_then(Result::ok).map(|it| it.time), event.map(|it| *it.time()));
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    #[must_use]
    pub fn for_sections(&self) -> &solver::Solver<f64> {
        &self.prepared
    }
}

impl<A: Answer> Solver<A> {
    /// The system that is solved; of runs back in time it is the [reversed](System::reversed) one.
    #[must_use]
    pub fn system(&self) -> &System {
        A::system(&self.prepared)
    }

    /// The system, prepared.
    pub(in crate::affine) fn prepared(&self) -> &A::Prepared {
        &self.prepared
    }

    /// A run from the system's own start, whose length is said next.
    pub fn run(&self) -> Run<'_, A> {
        Run::new(&self.prepared, self.system().start.as_ref().map(Cow::Borrowed))
    }

    /// A run from another start, such as one of [`System::start_at`], whose length is said next.
    pub fn run_from(&self, start: &StartPoint) -> Run<'_, A> {
        Run::new(&self.prepared, Some(Cow::Owned(start.clone())))
    }
}
