//! An attractor that has been met, with the evidence by which a motion near it is recognised.

use super::ReturnAttractor;
use super::cells::CellSet;
use super::space::{Space, Spot};
use super::trap::Trap;
use crate::affine::returns::walk::Return;
use crate::dynamics::attractor::thresholds::SAME;

/// An attractor and what a motion near it is recognised by.
#[derive(Clone, Debug)]
pub struct KnownAttractor {
    pub attractor: ReturnAttractor,
    /// The attractor's points.
    pub spots: Vec<Spot>,
    pub evidence: Evidence,
    /// What the motion that led to an orbit had visited before, where that took long: chaos there
    /// ends, and is no attractor.
    pub transient: Option<CellSet>,
}

/// The evidence by which a motion is recognised.
#[derive(Clone, Debug)]
pub enum Evidence {
    Traps(Vec<Trap>),
    Cells(CellSet),
    /// The state at which a motion has come to rest.
    Rest,
}

/// States of rest that differ by less, beside 1 and their size, are one: so much is left of what
/// decays while a return is waited for.
const AT_REST: f64 = 1e-3;

impl KnownAttractor {
    pub fn new(space: &Space<'_>, attractor: ReturnAttractor, evidence: Evidence) -> Self {
        let spots = attractor.points.iter().map(|it| space.spot(it)).collect();
        Self { attractor, spots, evidence, transient: None }
    }

    /// Whether both are the same attractor.
    pub fn is(&self, space: &Space<'_>, other: &Self) -> bool {
        match (&self.evidence, &other.evidence) {
            (Evidence::Traps(_), Evidence::Traps(_)) => {
                self.is_orbit(space, other.period(), &other.spots)
            }
            (Evidence::Cells(cells), Evidence::Cells(others)) => {
                cells.share(&other.spots) > SAME || others.share(&self.spots) > SAME
            }
            (Evidence::Rest, Evidence::Rest) => {
                other.attractor.points.iter().any(|it| self.rests_at(space, it))
            }
            _ => false,
        }
    }

    /// Whether a long run has gone where the motion that led here was before it settled.
    pub fn is_led_to_by(&self, run: &[Spot]) -> bool {
        self.transient.as_ref().is_some_and(|cells| cells.share(run) > SAME)
    }

    /// Whether the attractor is an orbit of this period through these spots.
    pub fn is_orbit(&self, space: &Space<'_>, period: u64, spots: &[Spot]) -> bool {
        let Evidence::Traps(traps) = &self.evidence else { return false };
        let is_there = |trap: &Trap| spots.iter().any(|it| trap.is_at_rest(trap.size(space, it)));
        self.period() == period && traps.iter().any(is_there)
    }

    /// Whether the attractor is the state of rest at which a motion has arrived.
    pub fn rests_at(&self, space: &Space<'_>, point: &Return<f64>) -> bool {
        let spot = space.spot(point);
        let is_here = |own: &Spot| {
            let step = space.step(own, &spot);
            let near = |(by, at): (&f64, &f64)| by.abs() <= AT_REST * (1.0 + at.abs());
            own.mode == spot.mode && step.iter().zip(&own.at).all(near)
        };
        matches!(self.evidence, Evidence::Rest) && self.spots.iter().any(is_here)
    }

    /// The orbit's period in returns; one where the attractor is no orbit.
    pub fn period(&self) -> u64 {
        self.attractor.period().map_or(1, |it| it as u64)
    }
}
