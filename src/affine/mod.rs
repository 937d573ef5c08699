//! The engine for piecewise-affine systems: [`System`] is read from TOML or made by
//! [`System::builder`], [`Solver`] prepares it for runs in one arithmetic, and [`Run`] is an
//! iterator over its events, with bounds of their errors in one of `Solver::run_enclosed`.
//!
//! Users of the crate meet it through [`crate::Solver`], whose events have names; the harness and
//! the tests use it as it is.

// The rooms, each of which uses only those before it: model, zeros, arithmetic, modal, closed_form,
// guards, first_crossing, solver, run, gradient, events, returns, continuation, attractors; gallery
// is beside them.
mod arithmetic;
mod attractors;
mod closed_form;
mod continuation;
pub(crate) mod events;
mod first_crossing;
pub mod gallery;
mod gradient;
mod guards;
mod modal;
mod model;
mod returns;
mod run;
mod solver;
mod zeros;

pub use crate::numeric::double_double::DoubleDouble;
pub use crate::numeric::wide::{Bits212, Bits424, Bits848, Bits1696, Bits3392};
pub use arithmetic::clock::Time;
pub use attractors::{Plane, ReturnAttractor, ReturnBasins, UnresolvedReturn};
pub use continuation::{
    BifurcationCurve, BifurcationPoint, CurveEnding, ReturnBifurcation, ReturnBranch, ReturnFamily,
    ReturnPlane,
};
pub use events::{MAX_HORIZON, PRECISION_BITS};
pub use gradient::derivative::{Gradient, NoGradient};
pub use gradient::walk::Walk;
pub use guards::track::SearchWork;
pub use model::builder::{Expression, LimitBuilder, ModeBuilder, SystemBuilder, UntilBuilder};
pub use model::error::SystemError;
pub use model::file::SystemFile;
pub use model::observable::Observable;
pub use model::rational::{Rational, RationalError};
pub use model::system::{
    Direction, Forcing, LARGEST_DIMENSION, Limit, Mode, Row, StartPoint, Successor, System,
    TROUBLE, Until, Watch, is_multiple, is_unit,
};
pub use model::tangent::{Name, Tangent};
pub use returns::diagram::{LeftOut, ReturnDiagram, ReturnDiagramStep, ValueError};
pub use returns::exponents::Exponents;
pub use returns::map::{DEFAULT_MAX_RETURN_TIME, SectionMap};
pub use returns::orbit::{NoOrbit, Orbit};
pub use returns::passage::Passage;
pub use returns::section::{Guard, Section};
pub use returns::walk::{NoReturn, Return, Returns};
pub use run::Run;
pub use run::follow::{Followed, Follower, Imposed};
pub use run::place::Place;
pub use solver::Solver;
pub use solver::event::{Ending, Errors, Event, What};
