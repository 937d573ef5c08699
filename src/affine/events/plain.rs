//! Runs in one arithmetic, without bounds of their errors.

use super::answer::{Answer, Running, sealed};
use super::cause::Cause;
use super::event::{Event, Kind};
use super::gradient::ByName;
use super::request::Request;
use super::steps::Steps;
use crate::affine::model::error::SystemError;
use crate::affine::model::system::System;
use crate::affine::solver::Solver;
use crate::affine::solver::event as engine;
use crate::numeric::double_double::DoubleDouble;
use crate::numeric::number::Number;
use crate::numeric::wide::{Bits212, Bits424, Bits848, Bits1696, Bits3392};

struct Plain<'a, T: Number> {
    solver: &'a Solver<T>,
    steps: Steps<'a, T>,
}

impl<'a, T: Number> Plain<'a, T> {
    fn begin(solver: &'a Solver<T>, request: &Request) -> Result<Self, SystemError> {
        Ok(Self { solver, steps: Steps::begin(solver, request, false)? })
    }

    fn event(
        &self,
        kind: Kind,
        event: engine::Event<T>,
        gradients: Vec<ByName<T>>,
    ) -> Event<'a, T> {
        let engine::Event { what, time, state, mode, .. } = event;
        let time = time.value();
        let accumulation = match what {
            engine::What::End(engine::Ending::Accumulation(from, to)) => {
                Some(Box::new([from, to].map(|it| time + it)))
            }
            _ => None,
        };
        let system = self.solver.system();
        Event { system, kind, mode, time, state, accumulation, gradients }
    }
}

impl<'a, T: Number> Running<'a, T> for Plain<'a, T> {
    fn start(&self) -> Event<'a, T> {
        let gradients = self.steps.walks.of_start(|it| it.0);
        self.event(Kind::Start, self.steps.run.start(), gradients)
    }

    fn next(&mut self) -> Option<Event<'a, T>> {
        let step = self.steps.next()?;
        let gradients = self.steps.walks.of_last(|it| it.0);
        Some(self.event(step.kind(), step.event, gradients))
    }

    fn go_on(&mut self, until: f64) -> bool {
        !self.steps.has_samples() && self.steps.run.go_on(T::exact(until))
    }

    fn undecidable(&self) -> u64 {
        self.steps.run.work().undecidable
    }

    fn cause(&self) -> Option<Cause> {
        Cause::new(&self.steps.run, self.solver.system())
    }

    fn bits(&self) -> u32 {
        T::WORDS as u32 * f64::MANTISSA_DIGITS
    }
}

macro_rules! answers {
    ($($number:ty),*) => {
        $(
            impl sealed::Sealed for $number {}

            impl Answer for $number {
                type Value = Self;
                type Prepared = Solver<Self>;

                fn prepare(system: &System, backward: bool) -> Result<Solver<Self>, SystemError> {
                    Solver::prepare(system, backward)
                }

                fn system(prepared: &Solver<Self>) -> &System {
                    prepared.system()
                }

                fn is_backward(prepared: &Solver<Self>) -> bool {
                    prepared.is_backward()
                }

                fn begin<'a>(
                    prepared: &'a Solver<Self>,
                    request: &Request,
                ) -> Result<Box<dyn Running<'a, Self> + Send + 'a>, SystemError> {
                    Ok(Box::new(Plain::begin(prepared, request)?))
                }
            }
        )*
    };
}

// The run of each is compiled here once, and not in every crate that asks for it.
answers!(f64, DoubleDouble, Bits212, Bits424, Bits848, Bits1696, Bits3392);
