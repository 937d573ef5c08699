//! The multipliers of a closed iterate.

use super::shooting::ShootingIterate;
use crate::dynamics::linear::{
    IDENTITY, Jacobian, ReIm, adjugate, eigenvalues, product, roots, trace,
};
use crate::phase::Phase;

/// Sum, and sum of the products of two, of an orbit's multipliers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Invariants {
    pub(crate) sum: f64,
    pub(crate) pairs: f64,
}

impl Invariants {
    pub(crate) fn new(iterate: &ShootingIterate) -> Self {
        let around = derivative_around(iterate);
        let reversed = iterate
            .jacobians
            .iter()
            .fold(IDENTITY, |before, jacobian| product(&before, &adjugate(jacobian)));
        Self { sum: trace(&around), pairs: trace(&reversed) }
    }
}

/// The multipliers of an orbit. With any contact one multiplier is zero and the others follow from
/// two invariants; without, all three are computed.
pub(super) fn multipliers(iterate: &ShootingIterate) -> [ReIm; 3] {
    if touches(iterate) {
        let Invariants { sum, pairs } = Invariants::new(iterate);
        let [first, second] = roots(sum, pairs);
        [first, second, [0.0; 2]]
    } else {
        eigenvalues(&derivative_around(iterate))
    }
}

fn derivative_around(iterate: &ShootingIterate) -> Jacobian {
    iterate.jacobians.iter().fold(IDENTITY, |before, jacobian| product(jacobian, &before))
}

fn touches(iterate: &ShootingIterate) -> bool {
    iterate.passages.iter().flat_map(|it| &it.phases).any(|phase| *phase != Phase::NoContact)
}
