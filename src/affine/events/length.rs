//! Runs that are told their length: a time, a number of events or of forcing periods.

use super::answer::Answer;
use super::escalation::MAX_BITS;
use super::iterators::{Events, Samples};
use super::proved::Proved;
use super::request::{Horizon, Request};
use crate::affine::model::error::SystemError;
use crate::affine::model::rational::Rational;
use crate::affine::model::system::StartPoint;
use crate::affine::model::tangent::{Name, Tangent};
use std::borrow::Cow;
use std::sync::Arc;

/// The significant digits that are wanted of proved numbers, unless a run is told otherwise.
const DEFAULT_DIGITS: usize = 17;

/// The largest number of digits that may be wanted: bounds of errors are printed from f64.
const MAX_DIGITS: usize = 300;

/// A run that has a start, and is told its length by one of its methods.
#[must_use = "a run begins when it is told its length"]
pub struct Run<'a, A: Answer> {
    prepared: &'a A::Prepared,
    /// The start: borrowed, it is the system's own.
    start: Option<Cow<'a, StartPoint>>,
    digits: usize,
    most_bits: u32,
    tangents: Vec<Arc<Tangent>>,
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
        Self { digits: digits.min(MAX_DIGITS), ..self }
    }

    /// Takes at most so many bits: 106, which every run takes, to 3392, which it may take without
    /// this.
    pub fn max_bits(self, bits: u32) -> Self {
        Self { most_bits: bits, ..self }
    }
}

impl<'a, A: Answer> Run<'a, A> {
    /// A run of a system that is prepared, from a start if it has one.
    pub(super) fn new(prepared: &'a A::Prepared, start: Option<Cow<'a, StartPoint>>) -> Self {
        let tangents = Vec::new();
        Self { prepared, start, digits: DEFAULT_DIGITS, most_bits: MAX_BITS, tangents }
    }

    /// Differentiates the run by names: parameters of the system, or `start.STATE` for a state at
    /// the start. Each [`Event`](crate::Event::gradient) then has the derivatives of its time and
    /// its state by each of them; in a [`Proved`] run with so many digits as those have.
    ///
    /// A start that is not the system's own does not depend on its parameters.
    ///
    /// ```
    /// use percuss::{Proved, System, gallery};
    ///
    /// let ball = System::from_toml(gallery::BOUNCING_BALL)?;
    /// let solver = ball.solver::<Proved>()?;
    /// let impact = solver.run().gradients(["g"])?.events(1)?.next().expect("an impact");
    /// let by_gravity = impact.gradient("g").expect("it was asked for").expect("it has one");
    /// assert_eq!(by_gravity.time().to_string(), "-0.70710678118654752");
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    ///
    /// # Errors
    /// A name that is neither a parameter nor a state at the start, a system that was changed after
    /// it was read or built, one without a start, and a run back in time.
    pub fn gradients(
        mut self,
        names: impl IntoIterator<Item = impl AsRef<str>>,
    ) -> Result<Self, SystemError> {
        let system = A::system(self.prepared);
        let Some(start) = &self.start else {
            return Err(SystemError::NoStart { system: system.name.clone() });
        };
        for name in names {
            let name = Name::read(name.as_ref());
            if A::is_backward(self.prepared) {
                let what = "a run back in time has none: accepted is a run forward".to_owned();
                return Err(SystemError::Name { item: format!("a derivative by {name}"), what });
            }
            let is_own = matches!(start, Cow::Borrowed(_));
            self.tangents.push(Arc::new(system.tangent(&name, start, is_own)?));
        }
        Ok(self)
    }

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
    /// A system without a start, a start that [`System::check`](crate::System::check) refuses, and
    /// a time that is not finite or lies before the start (after it, in a run back in time).
    pub fn until(self, time: f64) -> Result<Events<'a, A>, SystemError> {
        self.begin(Horizon::At(time), None, None)
    }

    /// The first `count` events. A run that ends earlier, or comes to 10^9 of the system's
    /// [`time_scale`](crate::System::time_scale), has its ending last, which is one of the `count`.
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
    /// A system without a start, and a start that [`System::check`](crate::System::check) refuses.
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
    /// A system without forcing, without a start, and a start that
    /// [`System::check`](crate::System::check) refuses.
    pub fn periods(self, count: u32) -> Result<Events<'a, A>, SystemError> {
        let system = A::system(self.prepared);
        if system.forcing.is_none() {
            return Err(SystemError::NoForcing { system: system.name.clone() });
        }
        self.begin(Horizon::Units(f64::from(count)), None, None)
    }

    /// The state at equal steps of the time from the start on: `parts` times in each forcing
    /// period, or in each [`time_scale`](crate::System::time_scale) of a system without forcing.
    /// The iterator ends where the run does, and else has as many samples as are taken.
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
    /// No parts, a system without a start, and a start that
    /// [`System::check`](crate::System::check) refuses.
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
    /// Those of [`until`](Self::until), and a number of parts that is 0.
    pub fn until_with_samples(self, time: f64, parts: u32) -> Result<Events<'a, A>, SystemError> {
        self.begin(Horizon::At(time), None, Some(parts))
    }

    /// Refuses a time at which no run from a start can end.
    fn check_time(&self, time: f64, start: &StartPoint) -> Result<(), SystemError> {
        let ahead = Rational::try_from(time).ok().map(|time| {
            let elapsed = time - &start.time;
            if A::is_backward(self.prepared) { -elapsed } else { elapsed }
        });
        if ahead.is_some_and(|it| it >= Rational::ZERO) {
            return Ok(());
        }
        let side = if A::is_backward(self.prepared) { "before" } else { "after" };
        let start = start.time.to_f64();
        let what =
            format!("{time} is not accepted: a finite time at or {side} the start at {start} is");
        Err(SystemError::Number { item: "the end of a run".to_owned(), what })
    }

    fn begin(
        self,
        horizon: Horizon,
        count: Option<usize>,
        samples: Option<u32>,
    ) -> Result<Events<'a, A>, SystemError> {
        let system = A::system(self.prepared);
        let Some(start) = &self.start else {
            return Err(SystemError::NoStart { system: system.name.clone() });
        };
        if let Horizon::At(time) = horizon {
            self.check_time(time, start)?;
        }
        if samples == Some(0) {
            let what = "0 samples are not accepted: 1 in a unit of time, or more, are".to_owned();
            return Err(SystemError::Number { item: system.name.clone(), what });
        }
        let request = Request {
            start: start.as_ref().clone(),
            horizon,
            samples,
            digits: self.digits,
            most_bits: self.most_bits,
            tangents: self.tangents,
        };
        Ok(Events { run: A::begin(self.prepared, &request)?, left: count })
    }
}
