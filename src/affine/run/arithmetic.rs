//! Runs that follow their errors as objects: whoever asks for one through [`Arithmetic`] does not
//! compile the solver once more.

use super::Run;
use crate::affine::arithmetic::clock::Time;
use crate::affine::model::error::SystemError;
use crate::affine::model::system::{StartPoint, System};
use crate::affine::solver::Solver;
use crate::affine::solver::event::{Ending, Event, What};
use crate::numeric::number::Number;

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
    /// Those of [`Solver::new`].
    fn solver(system: &System, backward: bool) -> Result<Solver<Self>, SystemError>;

    /// A run of a solver that follows its errors, by [`Solver::run_enclosed`].
    ///
    /// # Errors
    /// Those of [`Solver::run_enclosed`].
    fn enclosed<'a>(
        solver: &'a Solver<Self>,
        start: &StartPoint,
        until: Self,
    ) -> Result<Box<dyn EnclosedRun<Self> + 'a>, SystemError>;
}

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
