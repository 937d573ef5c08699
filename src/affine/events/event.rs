//! Events with their names, and the endings of runs.

use super::gradient::{ByName, Gradient};
use crate::affine::gradient::derivative::NoGradient;
pub use crate::affine::model::ending::Ending;
use crate::affine::model::system::System;
use crate::affine::solver::event as engine;
use std::fmt;

/// An event of a run: the start, an event of the system, a sample at a given time, or the ending.
///
/// Time and state are numbers of the solver's kind: f64 in a run of a `Solver<f64>`,
/// [`Proved`](crate::Proved) in one of a `Solver<Proved>`.
///
/// ```
/// use percuss::{System, gallery};
///
/// let ball = System::from_toml(gallery::BOUNCING_BALL)?;
/// let solver = ball.solver::<f64>()?;
/// let events: Vec<_> = solver.run().until(2.0)?.collect();
/// let [impact, end] = &events[..] else { panic!("one impact, and the ending") };
/// assert_eq!((impact.name(), impact.mode()), ("impact", "flight"));
/// // The state is that just after the event: the ball flies up again.
/// assert!(impact.state()[1] > 0.0);
/// assert_eq!((end.name(), *end.time()), ("end", 2.0));
/// # Ok::<(), percuss::SystemError>(())
/// ```
#[derive(Clone)]
pub struct Event<'a, V> {
    pub(super) system: &'a System,
    pub(super) kind: Kind,
    pub(super) mode: usize,
    pub(super) time: V,
    pub(super) state: Vec<V>,
    pub(super) accumulation: Option<Box<[V; 2]>>,
    pub(super) gradients: Vec<ByName<V>>,
}

/// The kind of an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Kind {
    /// The start of the run.
    Start,
    /// A mode ends: by the `until` of the second index of the mode of the first.
    Until(usize, usize),
    /// A watched guard is crossed: the `watch` of the second index of the mode of the first.
    Watch(usize, usize),
    /// The event of the mode of the first index that its `until` of the second makes has
    /// accumulated, and the run goes on by [`Until::accumulates_to`](crate::system::Until).
    Limit(usize, usize),
    /// A time at which the state was asked for.
    Sample,
    /// The run ends.
    End(Ending),
}

impl<T> From<&engine::Ending<T>> for Ending {
    fn from(ending: &engine::Ending<T>) -> Self {
        match ending {
            engine::Ending::Horizon => Self::Horizon,
            engine::Ending::Accumulation(..) => Self::Accumulation,
            engine::Ending::LeavesDomain => Self::LeavesDomain,
            engine::Ending::NoProgress => Self::NoProgress,
            engine::Ending::BeyondGuard => Self::BeyondGuard,
            engine::Ending::Undecided => Self::Undecided,
        }
    }
}

impl Kind {
    pub(super) fn new<T>(what: &engine::What<T>) -> Self {
        match what {
            engine::What::Start => Self::Start,
            engine::What::Until(mode, index) => Self::Until(*mode, *index),
            engine::What::Watch(mode, index) => Self::Watch(*mode, *index),
            engine::What::Limit(mode, index) => Self::Limit(*mode, *index),
            engine::What::End(ending) => Self::End(Ending::from(ending)),
        }
    }

    /// The name of an event of this kind: that of the system's file, `start`, `sample`, or that of
    /// the [ending](Ending::as_str).
    pub(super) fn name(self, system: &System) -> &str {
        match self {
            Self::Start => "start",
            Self::Sample => "sample",
            Self::Until(mode, index) => &system.modes[mode].until[index].name,
            Self::Watch(mode, index) => &system.modes[mode].watch[index].name,
            Self::Limit(..) => Ending::Accumulation.as_str(),
            Self::End(ending) => ending.as_str(),
        }
    }
}

impl<V: fmt::Debug> fmt::Debug for Event<'_, V> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut shown = f.debug_struct("Event");
        shown.field("name", &self.name()).field("mode", &self.mode()).field("time", &self.time);
        shown.field("state", &self.state).finish()
    }
}

impl<'a, V> Event<'a, V> {
    /// The kind of event.
    #[must_use]
    pub fn kind(&self) -> Kind {
        self.kind
    }

    /// The name: that of the system's file, `start`, `sample`, or that of the
    /// [ending](Ending::as_str). An event of a system may be called `start` or `sample`, too:
    /// [`kind`](Self::kind) tells them apart.
    #[must_use]
    pub fn name(&self) -> &'a str {
        self.kind.name(self.system)
    }

    /// The name of the mode that begins with the event, or goes on after it.
    #[must_use]
    pub fn mode(&self) -> &'a str {
        &self.system.modes[self.mode].name
    }

    /// The index of that mode among those of the system.
    #[must_use]
    pub fn mode_index(&self) -> usize {
        self.mode
    }

    /// The time of the event, in the system's unit.
    #[must_use]
    pub fn time(&self) -> &V {
        &self.time
    }

    /// The state just after the event, in the order of [`System::states`].
    #[must_use]
    pub fn state(&self) -> &[V] {
        &self.state
    }

    /// The value of the state of this name just after the event; none if the system has no such
    /// state.
    ///
    /// ```
    /// use percuss::{System, gallery};
    ///
    /// let ball = System::from_toml(gallery::BOUNCING_BALL)?;
    /// let solver = ball.solver::<f64>()?;
    /// let impact = solver.run().events(1)?.next().expect("an impact");
    /// assert_eq!(impact.value("x"), Some(&0.0));
    /// assert_eq!(impact.value("y"), None);
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    #[must_use]
    pub fn value(&self, state: &str) -> Option<&V> {
        let index = self.system.states.iter().position(|it| it == state)?;
        self.state.get(index)
    }

    /// The ending, of the last event of a run that ends.
    #[must_use]
    pub fn ending(&self) -> Option<Ending> {
        match self.kind {
            Kind::End(ending) => Some(ending),
            _ => None,
        }
    }

    /// The times between which infinitely many impacts accumulate, of an ending by an
    /// [accumulation](Ending::Accumulation).
    ///
    /// ```
    /// use percuss::{Ending, Proved, System, gallery};
    ///
    /// let ball = System::from_toml(gallery::BOUNCING_BALL)?;
    /// let solver = ball.solver::<Proved>()?;
    /// let end = solver.run().until(10.0)?.last().expect("an ending");
    /// assert_eq!(end.ending(), Some(Ending::Accumulation));
    /// // With e = 1/2 from the height 1 it is 3 times the time of the first fall.
    /// let [from, to] = end.accumulation().expect("the times");
    /// let limit = 3.0 * 2_f64.sqrt();
    /// assert!((from.midpoint() - limit).abs() < 1e-14 && from.midpoint() <= to.midpoint());
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    #[must_use]
    pub fn accumulation(&self) -> Option<&[V; 2]> {
        self.accumulation.as_deref()
    }

    /// The derivatives of the event by a name for which the run was [asked](crate::Run::gradients),
    /// or the reason why it has none; nothing for a name that was not asked for.
    ///
    /// ```
    /// use percuss::{System, gallery};
    ///
    /// let ball = System::from_toml(gallery::BOUNCING_BALL)?;
    /// let solver = ball.solver::<f64>()?;
    /// let mut events = solver.run().gradients(["start.x"])?.until(1.5)?;
    /// let fall = events.next().expect("an impact");
    /// // The time of a fall from the height x is the root of 2 x/g.
    /// let by_height = fall.gradient("start.x").expect("it was asked for").expect("it has one");
    /// assert!((by_height.time() - 0.5_f64.sqrt()).abs() < 1e-15);
    /// assert!(fall.gradient("g").is_none());
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    #[must_use]
    pub fn gradient(&self, name: &str) -> Option<Result<&Gradient<V>, NoGradient>> {
        let found = self.gradients.iter().find(|it| it.name == name)?;
        Some(found.both.as_ref().map_err(|reason| *reason))
    }

    /// The derivatives of the event below and above the name's value, where they differ: each, or
    /// the reason why it has none. Nothing where [`gradient`](Self::gradient) is that of both sides
    /// or has another reason, and for a name that was not asked for.
    ///
    /// ```
    /// use percuss::{NoGradient, System, gallery};
    ///
    /// // From the ground at the speed 1 with g = 1: it is back after 2.
    /// let ball = System::from_toml(gallery::BOUNCING_BALL)?;
    /// let solver = ball.solver::<f64>()?;
    /// let thrown = ball.start_at("flight", 0.0, &[0.0, 1.0])?;
    /// let run = solver.run_from(&thrown).gradients(["start.x"])?;
    /// let back = run.events(1)?.next().expect("an impact");
    /// assert_eq!(back.gradient("start.x").and_then(Result::err), Some(NoGradient::OneSided));
    /// let [below, above] = back.one_sided("start.x").expect("they differ");
    /// // Moved up it falls 1 per height longer; moved down it is below the ground.
    /// assert_eq!(above.map(|it| *it.time()), Ok(1.0));
    /// assert_eq!(below.err(), Some(NoGradient::OtherEvents));
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    #[must_use]
    pub fn one_sided(&self, name: &str) -> Option<[Result<&Gradient<V>, NoGradient>; 2]> {
        let found = self.gradients.iter().find(|it| it.name == name)?;
        let sides = found.sides.as_deref()?;
        Some(sides.each_ref().map(|it| it.as_ref().map_err(|reason| *reason)))
    }
}
