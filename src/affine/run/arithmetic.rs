//! Runs that follow their errors, in the arithmetics whose generic code is compiled here.
//!
//! Whoever asks for such a run through [`Arithmetic`] does not compile the solver once more.

use super::Run;
use crate::affine::arithmetic::clock::Time;
use crate::affine::model::system::{StartPoint, System};
use crate::affine::solver::event::{Ending, Event, What};
use crate::affine::solver::{Solver, Unprepared};
use crate::numeric::number::Number;
use crate::numeric::wide::{Bits212, Bits424, Bits848, Bits1696, Bits3392};

/// A run that follows its errors, as an object: [`Run`] has the same methods.
pub trait EnclosedRun<T: Number>: Iterator<Item = Event<T>> {
    /// [`Run::start`].
    fn start(&self) -> Event<T>;
    /// [`Run::searched`].
    fn searched(&self) -> Time<T>;
    /// [`Run::ending`].
    fn ending(&self) -> Option<&Ending<T>>;
    /// [`Run::doubtful`].
    fn doubtful(&self) -> Option<What<T>>;
    /// [`Run::resolution`].
    fn resolution(&self) -> Option<T::Bound>;
    /// [`Run::tie`].
    fn tie(&self) -> Vec<What<T>>;
    /// [`Run::beyond`].
    fn beyond(&self) -> Option<What<T>>;
    /// [`Run::overflows`].
    fn overflows(&self) -> bool;
    /// [`Run::is_exhausted`].
    fn is_exhausted(&self) -> bool;
    /// [`Run::go_on`].
    fn go_on(&mut self, until: T) -> bool;
}

/// An arithmetic in which systems are run with enclosed errors.
pub trait Arithmetic: Number {
    /// The number of its bits.
    const BITS: u32;

    /// A solver of a system, forward or [backward](Solver::backward).
    ///
    /// # Errors
    /// A system whose structural zeros cannot be decided.
    fn solver(system: &System, backward: bool) -> Result<Solver<Self>, Unprepared>;

    /// A run of a solver that follows its errors, by [`Solver::run_enclosed`].
    fn enclosed<'a>(
        solver: &'a Solver<Self>,
        start: &StartPoint,
        until: Self,
    ) -> Option<Box<dyn EnclosedRun<Self> + 'a>>;
}

/// Implements [`Arithmetic`] for a number of so many bits, in the crate that names it.
#[macro_export]
macro_rules! affine_arithmetic {
    ($number:ty, $bits:expr) => {
        impl $crate::affine::Arithmetic for $number {
            const BITS: u32 = $bits;

            fn solver(
                system: &$crate::affine::System,
                backward: bool,
            ) -> Result<$crate::affine::Solver<Self>, $crate::affine::Unprepared> {
                if backward {
                    $crate::affine::Solver::backward(system)
                } else {
                    $crate::affine::Solver::new(system)
                }
            }

            fn enclosed<'a>(
                solver: &'a $crate::affine::Solver<Self>,
                start: &$crate::affine::StartPoint,
                until: Self,
            ) -> Option<Box<dyn $crate::affine::EnclosedRun<Self> + 'a>> {
                Some(Box::new(solver.run_enclosed(start, until)?))
            }
        }
    };
}

affine_arithmetic!(Bits212, 212);
affine_arithmetic!(Bits424, 424);
affine_arithmetic!(Bits848, 848);
affine_arithmetic!(Bits1696, 1696);
affine_arithmetic!(Bits3392, 3392);

impl<T: Number> EnclosedRun<T> for Run<'_, T> {
    fn start(&self) -> Event<T> {
        self.start()
    }

    fn searched(&self) -> Time<T> {
        self.searched()
    }

    fn ending(&self) -> Option<&Ending<T>> {
        self.ending()
    }

    fn doubtful(&self) -> Option<What<T>> {
        self.doubtful()
    }

    fn resolution(&self) -> Option<T::Bound> {
        self.resolution()
    }

    fn tie(&self) -> Vec<What<T>> {
        self.tie()
    }

    fn beyond(&self) -> Option<What<T>> {
        self.beyond()
    }

    fn overflows(&self) -> bool {
        self.overflows()
    }

    fn is_exhausted(&self) -> bool {
        self.is_exhausted()
    }

    fn go_on(&mut self, until: T) -> bool {
        self.go_on(until)
    }
}
