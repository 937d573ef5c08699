//! Exact solver for the visco-elastic impact oscillator with drift of Pavlovskaia and Wiercigroch,
//! *Chaos, Solitons and Fractals* 19 (2004) 151-161.
//!
//! A mass driven by a cos(omega tau + phi) + b strikes a weightless visco-elastic slider that
//! sticks by dry friction. In each of three phases the motion is known in closed form; this crate
//! joins the phases at their events, and proves of every event that no earlier crossing was passed,
//! within the rounding model of the repository's docs/ROUNDING.md.
//!
//! ```
//! use percuss::{Model, Parameters, Start};
//!
//! let model = Model::new(Parameters { omega: 0.1, ..Parameters::default() })?;
//! let from_rest = model.start(&Start::default())?;
//! for segment in model.trajectory(from_rest).take(5) {
//!     println!("{} for {}", segment.phase(), segment.duration());
//! }
//! # Ok::<(), percuss::InputError>(())
//! ```
//!
//! # Features
//!
//! - `parallel`: diagrams, attractors and basins on all threads; results are the same without.
//! - `lanes`: ensembles in the processor's vectors.
//! - `affine` (on by default): any piecewise-affine system, solved in closed form between its
//!   events.
//! - `serde`: parameters, starts, states, samples, growths, counters and names are read and
//!   written. With `serde_json` enable its `float_roundtrip`: its usual parser may be a unit off.

#[cfg(feature = "affine")]
pub mod affine;
mod crossing;
pub mod dynamics;
mod error;
mod flow;
#[cfg(feature = "lanes")]
pub mod lanes;
mod model;
mod numeric;
mod parameters;
mod phase;
mod run;
mod state;
mod unknown_name;

#[cfg(feature = "affine")]
pub use affine::events::{
    Answer, Cause, Ending, Event, Events, Kind, Proved, Run, Samples, Solver,
};
#[cfg(feature = "affine")]
pub use affine::gallery;
#[cfg(feature = "affine")]
pub use affine::{
    Bits212, Bits424, Bits848, Bits1696, Bits3392, DoubleDouble, Rational, System, SystemError,
};
pub use crossing::Counters;
pub use error::InputError;
pub use model::Model;
pub use model::entry::Entry;
pub use model::instant::Instant;
pub use model::start::Start;
pub use numeric::number;
pub use numeric::two_word::TwoWord;
pub use parameters::{Parameter, Parameters};
pub use phase::Phase;
pub use run::exit::{Endless, Exit};
pub use run::growth::{Growth, GrowthRecorder};
pub use run::sample::Sample;
pub use run::trajectory::{Segment, Step, Trajectory};
pub use run::variation;
pub use state::State;
pub use unknown_name::UnknownName;

/// The solver's insides, for the harness and the tests. Semantic versioning does not cover them.
#[doc(hidden)]
pub mod insides {
    pub use crate::flow::constants::Constants;
    pub use crate::model::entry::Motion;
    pub use crate::numeric::{angle, remainders, series, two_word};
    pub use crate::run::one_sided::{Effort, OneSidedEnd};

    pub mod crossing {
        pub use crate::crossing::*;
    }
    pub mod flow {
        pub use crate::flow::*;
    }
}

/// The code of the README is compiled and run as the documentation's is.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
