//! The end of a piece that was not passed, remembered: shorter steps come to it again.

use super::point::CurvePoint;

/// A search for the end of a piece, after which the follower was sent to a shorter step.
pub(super) struct Refusal {
    /// The parameter's value and rate at the point from which the piece was followed.
    from: [f64; 2],
    /// The length of the first step that stayed on the piece; zero where none did.
    first_step: f64,
    /// The end, unless the way to it was too long.
    pub end: Option<CurvePoint>,
    /// Whether no orbit was found beyond the end, and none would be from nearer to it.
    pub is_lost: bool,
}

impl Refusal {
    /// The refusal of the end of a piece that was followed from a base.
    pub fn new(base: &CurvePoint, first_step: f64, end: Option<CurvePoint>) -> Self {
        Self { from: [base.value, base.tangent.rate], first_step, end, is_lost: false }
    }

    /// Whether a search from a base at this distance takes the same steps: those that were too long
    /// are left out.
    pub fn is_of_longer_step(&self, base: &CurvePoint, distance: f64) -> bool {
        let halvings = libm::log2(0.5 * distance / self.first_step);
        self.from == [base.value, base.tangent.rate] && halvings >= 0.0 && halvings.fract() == 0.0
    }
}
