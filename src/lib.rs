//! Solver of piecewise-affine hybrid systems, in closed form between their events: impacts,
//! friction, relays and switches, with proved events, and with proved digits on request.
//!
//! A system has modes with affine equations; a guard ends a mode, may reset the state, and says
//! which mode follows. In a mode the motion is a sum of exponentials, sines and powers of time, so
//! that nothing is integrated step by step: the crate finds where the next guard crosses, and
//! proves that no earlier crossing was passed, within the rounding of its numbers.
//!
//! # A first run
//!
//! A system is a text, a file ([`System::from_file`]), or made in Rust ([`System::builder`]).
//!
//! ```
//! use percuss::System;
//!
//! let ball = System::from_toml(r#"
//!     schema = 1
//!     name = "ball"
//!     states = ["x", "v"]
//!     [[mode]]
//!     name = "flight"
//!     equations = ["x' = v", "v' = -10"]
//!     [[mode.until]]
//!     name = "impact"
//!     guard = "x < 0"
//!     reset = ["x = 0", "v = -v/2"]
//!     [start]
//!     mode = "flight"
//!     x = 5
//!     v = 0
//! "#)?;
//! let solver = ball.solver::<f64>()?;
//! for event in solver.run().until(2.2)? {
//!     println!("{} {} {:?}", event.time(), event.name(), event.state());
//! }
//! let times: Vec<f64> = solver.run().events(3)?.map(|event| *event.time()).collect();
//! assert_eq!(times, [1.0, 2.0, 2.5]);
//! # Ok::<(), percuss::SystemError>(())
//! ```
//!
//! [The book](https://percuss.github.io/percuss/) says what a system's file may hold and what a
//! score of an integrator means, and has the dynamics of the oscillator.
//!
//! # Digits that are proved
//!
//! The same run in [`Proved`] numbers: each has a bound of its error, and prints the digits that
//! are certain. Where 106 bits do not decide what comes next, the run goes on in more.
//!
//! ```
//! use percuss::{Proved, System, gallery};
//!
//! let room = System::from_toml(gallery::THERMOSTAT)?;
//! let solver = room.solver::<Proved>()?;
//! let switch = solver.run().digits(40).events(1)?.next().expect("a switch");
//! assert_eq!(switch.name(), "switch-off");
//! assert_eq!(format!("{:.40}", switch.state()[0]), "21.00000000000000000000000000000000000000");
//! assert!(switch.time().error() < 1e-38);
//! # Ok::<(), percuss::SystemError>(())
//! ```
//!
//! # The motion between events
//!
//! [`Run::samples`] has the state at equal steps of the time, as for a picture or a stroboscopic
//! section; [`Run::until_with_samples`] has it between the events.
//!
//! ```
//! use percuss::{System, gallery};
//!
//! let oscillator = System::from_toml(gallery::IMPACT_OSCILLATOR)?;
//! let solver = oscillator.solver::<f64>()?;
//! // Once in each forcing period, when the first 500 have passed.
//! let section = solver.run().samples(1)?.skip(500).take(100);
//! let points: Vec<(f64, f64)> = section.map(|it| (it.state()[0], it.state()[1])).collect();
//! assert_eq!(points.len(), 100);
//! # Ok::<(), percuss::SystemError>(())
//! ```
//!
//! # Many starts
//!
//! A [`Solver`] is prepared once and shared by threads, as its example shows.
//! [`Solver::run_from`] takes a start of [`System::start_at`].
//!
//! # Endings
//!
//! The last event of a run says how it [ends](Ending): at its horizon, where impacts accumulate,
//! or where it cannot go on, with the [cause](Events::cause). A run in [`Proved`] numbers never
//! guesses: it goes on in more bits, and ends as [`Ending::Undecided`] where these do not suffice.
//! One in `f64` takes one side where two events are closer than its rounding, and counts that in
//! [`Events::undecidable`].
//!
//! # The oscillator that is built in
//!
//! The visco-elastic impact oscillator with drift of Pavlovskaia and Wiercigroch, *Chaos, Solitons
//! and Fractals* 19 (2004) 151-161, has a solver of its own, several times as fast: [`Model`],
//! [`Trajectory`], and the nonlinear dynamics of [`dynamics`].
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
//! # What is promised
//!
//! In `f64` an event's error is a few roundings, multiplied by what the motion itself does to
//! errors; the order of events is proved within the rounding model of the repository's
//! `docs/ROUNDING.md`. [`Proved`] runs bound every error.
//!
//! # Features
//!
//! - `affine` (on by default): systems of any kind; without it the crate is the oscillator alone
//!   and depends on `libm` only.
//! - `parallel`: diagrams, attractors and basins on all threads; results are the same without.
//! - `lanes`: ensembles in the processor's vectors.
//! - `serde`: parameters, starts, states, samples, growths, counters and names are read and
//!   written. With `serde_json` enable its `float_roundtrip`: its usual parser may be a unit off.

/// The engine behind [`Solver`], for the harness and the tests. Semantic versioning does not cover
/// it.
#[cfg(feature = "affine")]
#[doc(hidden)]
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
#[cfg(feature = "affine")]
pub mod system;
mod unknown_name;

#[cfg(feature = "affine")]
pub use affine::events::{
    Answer, Cause, Ending, Event, Events, Gradient, Kind, Proved, Run, Samples, Solver,
};
#[cfg(feature = "affine")]
pub use affine::gallery;
#[cfg(feature = "affine")]
pub use affine::{
    Bits212, Bits424, Bits848, Bits1696, Bits3392, DoubleDouble, NoGradient, Rational, System,
    SystemError,
};
pub use crossing::Counters;
pub use error::InputError;
pub use model::Model;
pub use model::entry::Entry;
pub use model::instant::Instant;
pub use model::start::Start;
#[doc(hidden)]
pub use numeric::number;
pub use numeric::two_word::TwoWord;
pub use parameters::{Parameter, Parameters};
pub use phase::Phase;
pub use run::exit::{Endless, Exit};
pub use run::growth::{Growth, GrowthRecorder};
pub use run::sample::Sample;
pub use run::trajectory::{Segment, Step, Trajectory};
#[doc(hidden)]
pub use run::variation;
pub use state::State;
pub use unknown_name::UnknownName;

/// The solver's insides, for the harness and the tests. Semantic versioning does not cover them.
#[doc(hidden)]
pub mod insides {
    pub use crate::flow::constants::Constants;
    pub use crate::model::entry::Motion;
    pub use crate::numeric::{angle, remainders, roots, series, two_word};

    pub mod crossing {
        pub use crate::crossing::*;
    }
    pub mod flow {
        pub use crate::flow::*;
    }
}

/// The code of the README is compiled and run as the documentation's is.
#[cfg(all(doctest, feature = "affine"))]
#[doc = include_str!("../README.md")]
struct Readme;

/// The code of the library's page, too.
#[cfg(all(doctest, feature = "affine"))]
#[doc = include_str!("../docs/LIBRARY.md")]
struct LibraryPage;

/// The code of the page on derivatives, too.
#[cfg(all(doctest, feature = "affine"))]
#[doc = include_str!("../docs/GRADIENTS.md")]
struct GradientsPage;
