//! The local judgement: each record of an engine's run against the exact continuation of the record
//! before it.
//!
//! An engine is asked what the model does next from where the engine itself was. Errors that grow
//! along a run, chaos included, are no part of it: whatever is found wrong at a record, the next is
//! judged from that record.

mod continuation;
mod ending;
mod instant;
mod judge;
mod judgement;
mod motion;
mod open;
mod parts;
mod pending;
mod record;
mod run;
mod samples;
mod units;
mod walk;
mod zeros;

pub use judge::LocalJudge;
pub use judgement::{Allowance, Defects, FirstWrong, LocalJudgement, WrongKind};
