//! Speed: every engine against the exact solver in interleaved rounds, each answer checked against
//! the truth; what an event costs against the floor; versions against each other.
//!
//! A time means something only beside another that was taken in the same rounds ([`rounds`]), of an
//! answer that was right ([`timed_case`]). Who is timed is a [`contestant`]; what versions are
//! compared by, a [`workload`].

// Modules here name those of the packages below as if they were their own.
use percuss_engines::{case, engine, integration, integrators, number, system};
use percuss_harness::{provenance, score, truth};
use percuss_pictures as picture;

pub mod cases;
pub mod clock;
pub mod compare;
pub mod competitor;
pub mod contest;
pub mod contestant;
pub mod damping;
pub mod equal_accuracy;
pub mod floor;
pub mod history;
pub mod instructions;
pub mod lanes;
pub mod length;
pub mod library_part;
mod pictures;
pub mod report;
pub mod rounds;
mod summary;
pub mod table;
pub mod timed;
pub mod timed_case;
pub mod workload;

pub use pictures::{history as history_picture, pictures};
pub use report::Bench;
pub use summary::summary;
pub use table::table;

use contestant::{Contestant, EnteredEngine};
use lanes::ExactLanes;

/// Every contestant, the exact solver first.
#[must_use]
pub fn contestants() -> Vec<Box<dyn Contestant>> {
    let engines = integrators::all().iter();
    let entered = engines.map(|engine| Box::new(EnteredEngine(*engine)) as Box<dyn Contestant>);
    let mut all: Vec<_> = entered.collect();
    all.insert(1, Box::new(ExactLanes));
    all
}
