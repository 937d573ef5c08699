//! Any piecewise-affine hybrid system, solved in closed form between its events.

// The rooms, each of which uses only those before it: model, zeros, arithmetic, modal, closed_form,
// guards, first_crossing, solver, run.
mod arithmetic;
mod closed_form;
mod first_crossing;
mod guards;
mod modal;
mod model;
mod run;
mod solver;
mod zeros;

pub use crate::numeric::wide::{Bits212, Bits424, Bits848, Bits1696, Bits3392};
pub use arithmetic::clock::Time;
pub use dashu_ratio::RBig as Rational;
pub use guards::track::SearchWork;
pub use model::error::SystemError;
pub use model::file::SystemFile;
pub use model::system::{
    Direction, Forcing, LARGEST_DIMENSION, Mode, Row, StartPoint, Successor, System, TROUBLE,
    Until, Watch,
};
pub use run::Run;
pub use run::arithmetic::{Arithmetic, EnclosedRun};
pub use solver::event::{Ending, Errors, Event, What};
pub use solver::{Solver, Unprepared};

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
