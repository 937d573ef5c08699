//! All contestants.

use super::contestant::{Contestant, Entered};
use super::lanes::Lanes;
use crate::engine;

/// Every contestant, the exact solver first.
#[must_use]
pub fn all() -> Vec<Box<dyn Contestant>> {
    let engines = engine::all().iter();
    let entered = engines.map(|engine| Box::new(Entered(*engine)) as Box<dyn Contestant>);
    let mut all: Vec<_> = entered.collect();
    all.insert(1, Box::new(Lanes));
    all
}
