//! The steps of a run in one arithmetic: its events, and between them the samples at given times
//! where these are asked for.

use super::request::{Horizon, Request};
use crate::affine::arithmetic::clock::Time;
use crate::affine::model::rational::Rational;
use crate::affine::model::system::System;
use crate::affine::run::Run;
use crate::affine::solver::event::{Ending, Event, What};
use crate::numeric::number::Number;

/// The horizon of a run that ends with a number of events, in the system's units of time.
const LONGEST: f64 = 1e9;

/// A run with the samples that are asked for.
pub(super) struct Steps<'a, T: Number> {
    pub run: Run<'a, T>,
    /// The last event, or the start.
    last: Event<T>,
    has_begun: bool,
    sampling: Option<Sampling<T>>,
    is_over: bool,
}

/// A step of a run.
pub(super) struct Step<T: Number> {
    pub event: Event<T>,
    pub is_sample: bool,
}

impl<'a, T: Number> Steps<'a, T> {
    /// The steps of a run that was begun up to [`first_horizon`].
    pub fn of(run: Run<'a, T>, sampling: Option<Sampling<T>>) -> Self {
        let last = run.start();
        Self { run, last, has_begun: false, sampling, is_over: false }
    }

    /// Whether the run has samples.
    pub fn has_samples(&self) -> bool {
        self.sampling.is_some()
    }

    pub fn next(&mut self) -> Option<Step<T>> {
        if self.is_over {
            return None;
        }
        let event = self.run.next()?;
        let is_horizon = event.what == What::End(Ending::Horizon);
        if let Some(sampling) = self.sampling.as_mut().filter(|_| is_horizon) {
            // The start itself has no rounding of modal co-ordinates.
            let is_start = !self.has_begun && event.time.value() == self.last.time.value();
            let event = if is_start { self.last.clone() } else { event };
            self.is_over = !sampling.next().is_some_and(|next| self.run.go_on(next));
            return Some(Step { event, is_sample: true });
        }
        if !matches!(event.what, What::End(_)) {
            self.has_begun = true;
            self.last.clone_from(&event);
        }
        Some(Step { event, is_sample: false })
    }
}

/// The time up to which a run is begun: its own horizon, or the first sample.
pub(super) fn first_horizon<T: Number>(request: &Request, system: &System, backward: bool) -> T {
    match request.samples {
        Some(_) => number(&request.start.time),
        None => end(request, system, backward),
    }
}

/// The time at which a run ends.
fn end<T: Number>(request: &Request, system: &System, backward: bool) -> T {
    let start: T = number(&request.start.time);
    let direction = if backward { -1.0 } else { 1.0 };
    match request.horizon {
        Horizon::At(time) => T::exact(time),
        Horizon::Far => T::exact(start.to_f64() + direction * LONGEST * system.time_scale),
        Horizon::Units(count) => start + T::exact(direction * count) * unit::<T>(system),
    }
}

/// The unit of time of which samples take parts: a forcing period, or the system's scale of time.
fn unit<T: Number>(system: &System) -> T {
    match &system.forcing {
        Some(forcing) => full_turn::<T>() / number::<T>(&forcing.omega).abs(),
        None => T::exact(system.time_scale),
    }
}

fn number<T: Number>(exact: &Rational) -> T {
    Time::<T>::of(exact).value()
}

/// The times of samples, so many in a unit of time.
pub(super) struct Sampling<T> {
    start: T,
    unit: T,
    parts: T,
    end: T,
    is_backward: bool,
    /// The number of the next sample.
    number: u64,
}

impl<T: Number> Sampling<T> {
    /// The samples that are asked for, if there are any.
    pub fn of(request: &Request, system: &System, is_backward: bool) -> Option<Self> {
        let parts = T::exact(f64::from(request.samples?));
        let start = number(&request.start.time);
        let unit = if is_backward { -unit::<T>(system) } else { unit(system) };
        let end = end(request, system, is_backward);
        Some(Self { start, unit, parts, end, is_backward, number: 1 })
    }

    /// The time of the next sample, unless it is beyond the end.
    fn next(&mut self) -> Option<T> {
        let time = self.start + T::exact(self.number as f64) * self.unit / self.parts;
        self.number += 1;
        let is_within = if self.is_backward { time >= self.end } else { time <= self.end };
        is_within.then_some(time)
    }
}

/// 2 pi, by Newton's method for the zero of the sine, which triples the digits each time.
fn full_turn<T: Number>() -> T {
    /// From an f64 to more than 1,400 digits.
    const STEPS: usize = 4;
    let half = (0..STEPS).fold(T::exact(std::f64::consts::PI), |half, _| half + half.sin_cos().0);
    half + half
}
