//! Integrators that are programs of any language, run as engines like those of Rust.
//!
//! A program is started, is asked what it can do, and answers one request after another in lines of
//! JSON; `docs/PROTOCOL.md` says how. Whatever a program does wrong costs the row that asked it,
//! with a reason that names what happened: no other row, no memory beyond a bound, and no process.
//!
//! ```no_run
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! use percuss_engines::engine::Engine;
//! use percuss_engines::integrators::add;
//!
//! let mut engines: Vec<&'static dyn Engine> = Vec::new();
//! for program in percuss_programs::read("programs.toml".as_ref())? {
//!     // What cannot be started has one engine by its name, whose rows say why.
//!     for engine in program.start().unwrap_or_else(|why| vec![why.stand_in()]) {
//!         engines.push(Box::leak(Box::new(engine)));
//!     }
//! }
//! add(&engines)?;
//! // Before this process ends, and where it is interrupted.
//! percuss_programs::end_all();
//! # Ok(())
//! # }
//! ```

mod answer;
mod engine;
pub mod files;
mod pool;
mod process;
mod programs_file;
mod start;
mod text;
mod wire;

pub use engine::{NotStarted, ProgramEngine};
pub use process::end_all;
pub use programs_file::{ACCEPTED_NAMES, Program, is_name, read, shortcomings};
pub use wire::{Capabilities, EventsBy, PROTOCOL, SetUp};
