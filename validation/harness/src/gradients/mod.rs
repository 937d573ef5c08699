//! Derivatives through events, as answers have them, judged against proved tables.
//!
//! A [case](GradientCase) has the proved derivatives of each event's time and state by some names.
//! What a wrong rule at events would give instead is computed too (`walk`), along the events of
//! the exact run (`path`): an answer that agrees with one of these and not with the truth has its
//! missing term named ([`Mechanism`]). How far a right answer may be off is the tolerance times the
//! growth of errors in states and derivatives (`unit`). [`judge()`] gives the verdicts; [`run()`]
//! asks engines for their answers.

mod answer;
mod case;
mod differences;
mod judge;
mod library;
mod linear;
mod mechanism;
mod path;
#[cfg(test)]
mod power_tests;
mod reference;
mod run;
#[cfg(test)]
mod run_tests;
#[cfg(test)]
mod stepped_tests;
mod unit;
mod verdict;
mod walk;

pub use answer::{GradientAnswer, NameAnswer};
pub use case::{GradientCase, GradientRow};
pub use judge::{ALLOWED_UNITS, judge};
pub use library::{embedded, names};
pub use mechanism::Mechanism;
pub use reference::Reference;
pub use run::{GradientJudgement, TOLERANCES, one, run};
pub use verdict::{Judged, Verdict};
