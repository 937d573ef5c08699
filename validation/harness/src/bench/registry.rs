//! All contestants.

use super::contestant::{Contestant, EnteredEngine};
use super::lanes::ExactLanes;
use crate::engine;

/// Every contestant, the exact solver first.
#[must_use]
pub fn all() -> Vec<Box<dyn Contestant>> {
    let engines = engine::all().iter();
    let entered = engines.map(|engine| Box::new(EnteredEngine(*engine)) as Box<dyn Contestant>);
    let mut all: Vec<_> = entered.collect();
    all.insert(1, Box::new(ExactLanes));
    all
}
