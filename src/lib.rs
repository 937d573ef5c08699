//! Exact solver for the visco-elastic impact oscillator with drift of Pavlovskaia and Wiercigroch,
//! *Chaos, Solitons and Fractals* 19 (2004) 151-161.
//!
//! A mass driven by a cos(omega tau + phi) + b strikes a weightless visco-elastic slider that
//! sticks by dry friction. In each of three phases the motion is known in closed form; this crate
//! joins the phases at their switches, every one of which it proves to be the first, within the
//! rounding model of the repository's docs/ROUNDING.md.
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

pub mod angle;
mod circle;
mod constants;
pub mod crossing;
pub mod dynamics;
mod entry;
mod error;
mod exponential;
pub mod flow;
mod growth;
mod instant;
mod judgement;
#[cfg(feature = "lanes")]
pub mod lanes;
mod model;
pub mod number;
mod parameters;
mod phase;
pub mod remainders;
mod segment;
mod stages;
mod start;
mod state;
mod surface;
mod switch;
mod trajectory;
pub mod two_word;
pub mod variation;

pub use constants::Constants;
pub use crossing::Counters;
pub use entry::Entry;
pub use error::InputError;
pub use growth::{Growth, GrowthRecorder};
pub use instant::Instant;
pub use judgement::{Effort, Judgement};
pub use model::{Model, Motion};
pub use parameters::{Parameter, Parameters};
pub use phase::{Phase, UnknownPhase};
pub use segment::{Endless, Exit, Sample, Segment};
pub use start::Start;
pub use state::State;
pub use trajectory::{Step, Trajectory};
