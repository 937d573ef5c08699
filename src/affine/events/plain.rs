//! Runs in one arithmetic, without bounds of their errors.

use super::answer::{Answer, Running, sealed};
use super::cause::Cause;
use super::event::{Event, Kind};
use super::request::Request;
use super::steps::{Sampling, Step, Steps, first_horizon};
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
        let (system, backward) = (solver.system(), solver.is_backward());
        let until = first_horizon(request, system, backward);
        let run = solver.run(&request.start, until)?;
        Ok(Self { solver, steps: Steps::of(run, Sampling::of(request, system, backward)) })
    }

    fn event(&self, event: &engine::Event<T>, is_sample: bool) -> Event<'a, T> {
        let kind = if is_sample { Kind::Sample } else { Kind::of(&event.what) };
        let accumulation = match event.what {
            engine::What::End(engine::Ending::Accumulation(from, to)) => {
                Some(Box::new([from, to].map(|it| event.time.value() + it)))
            }
            _ => None,
        };
        let engine::Event { time, mode, ref state, .. } = *event;
        Event {
            system: self.solver.system(),
            kind,
            mode,
            time: time.value(),
            state: state.clone(),
            accumulation,
        }
    }
}

impl<'a, T: Number> Running<'a, T> for Plain<'a, T> {
    fn start(&self) -> Event<'a, T> {
        self.event(&self.steps.run.start(), false)
    }

    fn next(&mut self) -> Option<Event<'a, T>> {
        let Step { event, is_sample } = self.steps.next()?;
        Some(self.event(&event, is_sample))
    }

    fn undecidable(&self) -> u64 {
        self.steps.run.work().undecidable
    }

    fn cause(&self) -> Option<Cause> {
        Cause::of(&self.steps.run, self.solver.system())
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
                    prepared(system, backward)
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
                ) -> Result<Box<dyn Running<'a, Self> + 'a>, SystemError> {
                    Ok(Box::new(Plain::begin(prepared, request)?))
                }
            }
        )*
    };
}

// The run of each is compiled here once, and not in every crate that asks for it.
answers!(f64, DoubleDouble, Bits212, Bits424, Bits848, Bits1696, Bits3392);

/// A solver of a system, forward or backward.
pub(super) fn prepared<T: Number>(
    system: &System,
    backward: bool,
) -> Result<Solver<T>, SystemError> {
    if backward { Solver::backward(system) } else { Solver::new(system) }
}
