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
