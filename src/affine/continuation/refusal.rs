//! The end of a piece that was not passed, remembered: shorter steps come to it again.

use super::point::CurvePoint;

/// A search for the end of a piece, after which the follower was sent to a shorter step.
pub(super) struct Refusal {
    /// The parameter's value and rate at the point from which the piece was followed.
    from: [f64; 2],
    /// The step within which the end was searched.
    distance: f64,
    /// The length of the first step that stayed on the piece; zero where none did.
    first_step: f64,
    /// The end, unless the way to it was too long.
    pub end: Option<CurvePoint>,
    /// Whether no orbit was found beyond the end, and none would be from nearer to it.
    pub is_lost: bool,
}

impl Refusal {
    /// The refusal of what was found within a step from a base, from its first step to its end.
    pub fn new(base: &CurvePoint, distance: f64, first_step: f64, end: Option<CurvePoint>) -> Self {
        let from = [base.value, base.tangent.rate];
        Self { from, distance, first_step, end, is_lost: false }
    }

    /// Whether the search within a step from a base would be this one: a step halved leaves out
    /// what was too long.
    pub fn is_of(&self, base: &CurvePoint, distance: f64) -> bool {
        let halvings = libm::log2(self.distance / distance);
        self.from == [base.value, base.tangent.rate]
            && halvings >= 0.0
            && halvings.fract() == 0.0
            && self.first_step <= 0.5 * distance
    }
}
