//! The steps of a run in one arithmetic: its events, and between them the samples at given times
//! where these are asked for.

use super::event::Kind;
use super::gradient::Walks;
use super::request::{Horizon, Request};
use crate::affine::arithmetic::clock::{Time, full_turn};
use crate::affine::model::error::SystemError;
use crate::affine::model::rational::Rational;
use crate::affine::model::system::System;
use crate::affine::run::Run;
use crate::affine::solver::Solver;
use crate::affine::solver::event::{Ending, Event, What};
use crate::numeric::number::Number;

/// The horizon of a run that ends with a number of events, in the system's units of time.
pub const MAX_HORIZON: f64 = 1e9;

/// A run with the samples that are asked for.
pub(super) struct Steps<'a, T: Number> {
    pub run: Run<'a, T>,
    pub walks: Walks<'a, T>,
    /// Whether an event has come.
    has_begun: bool,
    sampling: Option<Sampling<T>>,
    is_over: bool,
}

/// A step of a run.
pub(super) struct Step<T: Number> {
    pub event: Event<T>,
    pub is_sample: bool,
}

impl<T: Number> Step<T> {
    pub fn kind(&self) -> Kind {
        if self.is_sample { Kind::Sample } else { Kind::new(&self.event.what) }
    }
}

impl<'a, T: Number> Steps<'a, T> {
    /// The steps of a run that follows its errors, or of one that does not.
    pub fn begin(
        solver: &'a Solver<T>,
        request: &Request,
        is_enclosed: bool,
    ) -> Result<Self, SystemError> {
        let (system, start) = (solver.system(), &request.start);
        let end = end(request, system, solver.is_backward());
        // Samples begin at the start.
        let horizon = if request.samples.is_some() { number(&start.time) } else { end };
        let run = match is_enclosed {
            true => solver.run_enclosed(start, horizon)?,
            false => solver.run(start, horizon)?,
        };
        let sampling = Sampling::new(request, system, end, solver.is_backward());
        let walks = Walks::begin(solver, request, &run.start())?;
        Ok(Self { run, walks, has_begun: false, sampling, is_over: false })
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
        self.walks.step(&event, &self.run);
        let is_horizon = event.what == What::End(Ending::Horizon);
        if let Some(sampling) = self.sampling.as_mut().filter(|it| is_horizon && !it.is_over) {
            // The start itself has no rounding of modal co-ordinates.
            let start = self.run.start();
            let is_start = !self.has_begun && event.time.value() == start.time.value();
            let event = if is_start { start } else { event };
            let next = sampling.next();
            self.is_over = !self.run.go_on(next);
            return Some(Step { event, is_sample: true });
        }
        self.has_begun = true;
        Some(Step { event, is_sample: false })
    }
}

/// The time at which a run ends.
fn end<T: Number>(request: &Request, system: &System, backward: bool) -> T {
    let start: T = number(&request.start.time);
    let direction = if backward { -1.0 } else { 1.0 };
    match request.horizon {
        Horizon::At(time) => T::exact(time),
        Horizon::Far => T::exact(start.to_f64() + direction * MAX_HORIZON * system.time_scale),
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
    Time::<T>::new(exact).value()
}

/// The times of samples, so many in a unit of time.
struct Sampling<T> {
    start: T,
    unit: T,
    parts: T,
    end: T,
    is_backward: bool,
    /// The number of the next sample.
    number: u64,
    /// Whether the last sample has been taken: events may follow it, and the ending does.
    is_over: bool,
}

impl<T: Number> Sampling<T> {
    /// The samples that are asked for, if there are any.
    fn new(request: &Request, system: &System, end: T, is_backward: bool) -> Option<Self> {
        let parts = T::exact(f64::from(request.samples?));
        let start = number(&request.start.time);
        let unit = if is_backward { -unit::<T>(system) } else { unit(system) };
        Some(Self { start, unit, parts, end, is_backward, number: 1, is_over: false })
    }

    /// The time of the next sample, or after the last one the end.
    fn next(&mut self) -> T {
        let time = self.start + T::exact(self.number as f64) * self.unit / self.parts;
        self.number += 1;
        let is_within = if self.is_backward { time >= self.end } else { time <= self.end };
        self.is_over = !is_within;
        if is_within { time } else { self.end }
    }
}
