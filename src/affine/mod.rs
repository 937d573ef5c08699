//! The engine for piecewise-affine systems: [`System`] is read from TOML or made by
//! [`System::builder`], [`Solver`] prepares it for runs in one arithmetic, and [`Run`] is an
//! iterator over its events, with bounds of their errors in one of `Solver::run_enclosed`.
//!
//! Users of the crate meet it through [`crate::Solver`], whose events have names; the harness and
//! the tests use it as it is.

// The rooms, each of which uses only those before it: model, zeros, arithmetic, modal, closed_form,
// guards, first_crossing, solver, run, events; gallery is beside them.
mod arithmetic;
mod closed_form;
pub(crate) mod events;
mod first_crossing;
pub mod gallery;
mod guards;
mod modal;
mod model;
mod run;
mod solver;
mod zeros;

pub use crate::numeric::double_double::DoubleDouble;
pub use crate::numeric::wide::{Bits212, Bits424, Bits848, Bits1696, Bits3392};
pub use arithmetic::clock::Time;
pub use guards::track::SearchWork;
pub use model::builder::{Expression, ModeBuilder, SystemBuilder, UntilBuilder};
pub use model::error::SystemError;
pub use model::file::SystemFile;
pub use model::rational::{Rational, RationalError};
pub use model::system::{
    Direction, Forcing, LARGEST_DIMENSION, Mode, Row, StartPoint, Successor, System, TROUBLE,
    Until, Watch,
};
pub use run::Run;
pub use run::arithmetic::{Arithmetic, EnclosedRun};
pub use solver::Solver;
pub use solver::event::{Ending, Errors, Event, What};

/// Implements [`Arithmetic`] for a number of so many bits.
macro_rules! arithmetic {
    ($number:ty, $bits:expr $(, #[$inline:meta])?) => {
        impl Arithmetic for $number {
            const BITS: u32 = $bits;

            $(#[$inline])?
            fn solver(system: &System, backward: bool) -> Result<Solver<Self>, SystemError> {
                if backward { Solver::backward(system) } else { Solver::new(system) }
            }

            $(#[$inline])?
            fn enclosed<'a>(
                solver: &'a Solver<Self>,
                start: &StartPoint,
                until: Self,
            ) -> Result<Box<dyn EnclosedRun<Self> + 'a>, SystemError> {
                Ok(Box::new(solver.run_enclosed(start, until)?))
            }
        }
    };
}

// Inlined, so that only programs which use it compile the solver for it.
arithmetic!(f64, 53, #[inline]);
arithmetic!(DoubleDouble, 106);
arithmetic!(Bits212, 212);
arithmetic!(Bits424, 424);
arithmetic!(Bits848, 848);
arithmetic!(Bits1696, 1696);
arithmetic!(Bits3392, 3392);
