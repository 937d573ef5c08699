//! Runs as their users ask for them: events with names, in f64, in more bits, or with proved
//! digits.
//!
//! [`answer`] has the kinds of numbers; [`plain`] runs in one arithmetic, and [`escalation`] in one
//! after the other until the digits are proved. [`steps`] puts samples between the events of a run.
//! [`event`] and [`proved`] are what is given out, and [`interval`] prints it. Read this file
//! first, then `event` and `escalation`.

mod answer;
mod cause;
mod escalation;
mod event;
mod interval;
mod plain;
mod proved;
mod request;
mod sizes;
mod steps;

pub use answer::Answer;
pub use cause::Cause;
pub use event::{Ending, Event, Kind};
pub use proved::Proved;

use crate::affine::model::error::SystemError;
use crate::affine::model::rational::Rational;
use crate::affine::model::system::{StartPoint, System};
use answer::Running;
use request::{Horizon, Request};
use std::borrow::Cow;
use std::iter::FusedIterator;

/// The significant digits that are wanted of proved numbers, unless a run is told otherwise.
const USUAL_DIGITS: usize = 17;

/// The largest number of digits that may be wanted: bounds of errors are printed from f64.
const MOST_DIGITS: usize = 300;

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
    /// The start in a mode at a time, with the value of each state in the order of
    /// [`System::states`].
    ///
    /// ```
    /// use percuss::{System, gallery};
    ///
    /// let ball = System::from_toml(gallery::BOUNCING_BALL)?;
    /// let thrown = ball.start_at("flight", 2.0, &[0.5, 1.0])?;
    /// assert_eq!(thrown.time.to_f64(), 2.0);
    /// let error = ball.start_at("flight", 0.0, &[0.5]).unwrap_err();
    /// assert!(error.to_string().contains("2"), "{error}");
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    ///
    /// # Errors
    /// An unknown mode, a number that is not finite, and another number of states.
    pub fn start_at(
        &self,
        mode: &str,
        time: f64,
        states: &[f64],
    ) -> Result<StartPoint, SystemError> {
        let exact = |item: &str, number: f64| {
            Rational::try_from(number).map_err(|_| SystemError::Number {
                item: format!("start, {item}"),
                what: format!("{number} is not accepted: a finite number is"),
            })
        };
        if states.len() != self.states.len() {
            let (found, accepted) = (states.len(), self.states.len());
            return Err(SystemError::Length { item: "start, states".to_owned(), found, accepted });
        }
        let Some(index) = self.mode(mode) else {
            let names: Vec<_> = self.modes.iter().map(|it| it.name.as_str()).collect();
            let accepted = names.join(", ");
            let what = format!("there is no mode {mode:?}: accepted is one of {accepted}");
            return Err(SystemError::Name { item: "start".to_owned(), what });
        };
        let state = self
            .states
            .iter()
            .zip(states)
            .map(|(name, value)| Ok([Rational::ZERO, Rational::ZERO, exact(name, *value)?]));
        let state = state.collect::<Result<_, SystemError>>()?;
        Ok(StartPoint { mode: index, time: exact("time", time)?, state })
    }

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

impl<A: Answer> Solver<A> {
    /// The system that is solved; of runs back in time it is the [reversed](System::reversed) one.
    #[must_use]
    pub fn system(&self) -> &System {
        A::system(&self.prepared)
    }

    /// Refuses a time at which no run from a start can end.
    fn check_time(&self, time: f64, start: &StartPoint) -> Result<(), SystemError> {
        let ahead = Rational::try_from(time).ok().map(|time| {
            let elapsed = time - &start.time;
            if A::is_backward(&self.prepared) { -elapsed } else { elapsed }
        });
        if ahead.is_some_and(|it| it >= Rational::ZERO) {
            return Ok(());
        }
        let side = if A::is_backward(&self.prepared) { "before" } else { "after" };
        let start = start.time.to_f64();
        let what =
            format!("{time} is not accepted: a finite time at or {side} the start at {start} is");
        Err(SystemError::Number { item: "the end of a run".to_owned(), what })
    }

    /// A run from the system's own start, whose length is said next.
    pub fn run(&self) -> Run<'_, A> {
        let start = self.system().start.as_ref().map(Cow::Borrowed);
        Run { solver: self, start, digits: USUAL_DIGITS, most_bits: escalation::MOST_BITS }
    }

    /// A run from another start, such as one of [`System::start_at`], whose length is said next.
    pub fn run_from(&self, start: &StartPoint) -> Run<'_, A> {
        Run { start: Some(Cow::Owned(start.clone())), ..self.run() }
    }
}

/// A run that has a start, and is told its length by one of its methods.
#[must_use = "a run begins when it is told its length"]
pub struct Run<'a, A: Answer> {
    solver: &'a Solver<A>,
    start: Option<Cow<'a, StartPoint>>,
    digits: usize,
    most_bits: u32,
}

impl Run<'_, Proved> {
    /// Goes on in more bits where the proved numbers have fewer significant digits than so many:
    /// at most 300, to which larger numbers are cut, and 17 without it.
    ///
    /// ```
    /// use percuss::{Proved, System, gallery};
    ///
    /// let room = System::from_toml(gallery::THERMOSTAT)?;
    /// let solver = room.solver::<Proved>()?;
    /// let last = solver.run().digits(60).events(20)?.last().expect("20 events");
    /// assert!(last.state().iter().all(|it| it.digits(60).is_none_or(|count| count >= 59)));
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    pub fn digits(self, digits: usize) -> Self {
        Self { digits: digits.min(MOST_DIGITS), ..self }
    }

    /// Takes at most so many bits: 106, which every run takes, to 3392, which it may take without
    /// this.
    pub fn max_bits(self, bits: u32) -> Self {
        Self { most_bits: bits, ..self }
    }
}

impl<'a, A: Answer> Run<'a, A> {
    /// The events up to a time, then the ending.
    ///
    /// ```
    /// use percuss::{Ending, System, gallery};
    ///
    /// let room = System::from_toml(gallery::THERMOSTAT)?;
    /// let solver = room.solver::<f64>()?;
    /// let mut switches = 0;
    /// for event in solver.run().until(50.0)? {
    ///     match event.ending() {
    ///         None => switches += 1,
    ///         Some(ending) => assert_eq!(ending, Ending::Horizon),
    ///     }
    /// }
    /// assert!(switches > 10);
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    ///
    /// # Errors
    /// A system without a start, a start that [`System::check`] refuses, and a time that is not
    /// finite or lies before the start (after it, in a run back in time).
    pub fn until(self, time: f64) -> Result<Events<'a, A>, SystemError> {
        self.begin(Horizon::At(time), None, None)
    }

    /// The first `count` events. A run that ends earlier, or comes to 10^9 of the system's
    /// [`time_scale`](System::time_scale), has its ending last, which is one of the `count`.
    ///
    /// ```
    /// use percuss::{System, gallery};
    ///
    /// let ball = System::from_toml(gallery::BOUNCING_BALL)?;
    /// let solver = ball.solver::<f64>()?;
    /// let times: Vec<f64> = solver.run().events(4)?.map(|impact| *impact.time()).collect();
    /// // Each flight takes half the time of the one before.
    /// assert!(times.windows(3).all(|t| ((t[2] - t[1]) / (t[1] - t[0]) - 0.5).abs() < 1e-12));
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    ///
    /// # Errors
    /// A system without a start, and a start that [`System::check`] refuses.
    pub fn events(self, count: usize) -> Result<Events<'a, A>, SystemError> {
        self.begin(Horizon::Far, Some(count), None)
    }

    /// The events of so many forcing periods from the start on, then the ending.
    ///
    /// ```
    /// use percuss::{System, gallery};
    ///
    /// let oscillator = System::from_toml(gallery::IMPACT_OSCILLATOR)?;
    /// let solver = oscillator.solver::<f64>()?;
    /// let impacts = |periods: u32| Ok(solver.run().periods(periods)?.count());
    /// // Later periods have as many events as earlier ones, once the motion is periodic.
    /// assert_eq!(impacts(400)? - impacts(300)?, impacts(300)? - impacts(200)?);
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    ///
    /// # Errors
    /// A system without forcing, without a start, and a start that [`System::check`] refuses.
    pub fn periods(self, count: u32) -> Result<Events<'a, A>, SystemError> {
        if self.solver.system().forcing.is_none() {
            let system = self.solver.system().name.clone();
            return Err(SystemError::NoForcing { system });
        }
        self.begin(Horizon::Units(f64::from(count)), None, None)
    }

    /// The state at equal steps of the time from the start on: `parts` times in each forcing
    /// period, or in each [`System::time_scale`] of a system without forcing. The iterator ends
    /// where the run does, and else has as many samples as are taken.
    ///
    /// ```
    /// use percuss::{System, gallery};
    ///
    /// // A stroboscopic section: once in each forcing period.
    /// let oscillator = System::from_toml(gallery::IMPACT_OSCILLATOR)?;
    /// let solver = oscillator.solver::<f64>()?;
    /// let section: Vec<Vec<f64>> =
    ///     solver.run().samples(1)?.skip(300).take(4).map(|it| it.state().to_vec()).collect();
    /// assert_eq!(section.len(), 4);
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    ///
    /// # Errors
    /// No parts, a system without a start, and a start that [`System::check`] refuses.
    pub fn samples(self, parts: u32) -> Result<Samples<'a, A>, SystemError> {
        let events = self.begin(Horizon::Far, None, Some(parts))?;
        Ok(Samples { events, ending: None })
    }

    /// The events up to a time, with samples between them as [`samples`](Self::samples) has them:
    /// the motion as it is drawn.
    ///
    /// ```
    /// use percuss::{Kind, System, gallery};
    ///
    /// let ball = System::from_toml(gallery::BOUNCING_BALL)?;
    /// let solver = ball.solver::<f64>()?;
    /// let mut points = Vec::new();
    /// for event in solver.run().until_with_samples(3.0, 50)? {
    ///     points.push((*event.time(), event.state()[0]));
    /// }
    /// assert!(points.len() > 150 && points.iter().all(|(_, x)| *x >= 0.0));
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    ///
    /// # Errors
    /// As [`until`](Self::until), and no parts.
    pub fn until_with_samples(self, time: f64, parts: u32) -> Result<Events<'a, A>, SystemError> {
        self.begin(Horizon::At(time), None, Some(parts))
    }

    fn begin(
        self,
        horizon: Horizon,
        count: Option<usize>,
        samples: Option<u32>,
    ) -> Result<Events<'a, A>, SystemError> {
        let system = self.solver.system();
        let Some(start) = self.start else {
            return Err(SystemError::NoStart { system: system.name.clone() });
        };
        if let Horizon::At(time) = horizon {
            self.solver.check_time(time, &start)?;
        }
        if samples == Some(0) {
            let what = "0 samples are not accepted: 1 in a unit of time, or more, are".to_owned();
            return Err(SystemError::Number { item: system.name.clone(), what });
        }
        let request = Request {
            start: start.into_owned(),
            horizon,
            samples,
            digits: self.digits,
            most_bits: self.most_bits,
        };
        Ok(Events { run: A::begin(&self.solver.prepared, &request)?, left: count })
    }
}

/// The events of a run, as an iterator; the last is the ending, of a run that ends.
pub struct Events<'a, A: Answer> {
    run: Box<dyn Running<'a, A::Value> + 'a>,
    /// The number of events that are still wanted, where it is limited.
    left: Option<usize>,
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
    /// decide: the run takes one side of each. A run in [`Proved`] numbers has none: it goes on in
    /// more bits instead, and ends where these do not suffice.
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
    events: Events<'a, A>,
    ending: Option<Ending>,
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
