//! The strobe maps of one parameter's values, and how they change with it.

use crate::dynamics::orbit::ShootingIterate;
use crate::dynamics::strobe::{StrobeMap, StrobePoint};
use crate::error::InputError;
use crate::model::Model;
use crate::model::instant::Instant;
use crate::parameters::{Parameter, Parameters};

/// The strobe maps at one forcing angle, one for each value of a parameter.
#[derive(Clone, Copy, Debug)]
pub struct Family {
    parameters: Parameters,
    parameter: Parameter,
    instant: Instant,
}

/// Relative steps of the differences, longest first: the first balances truncation and rounding,
/// the others are for neighbourhoods of a corner.
const DIFFERENCE_STEPS: [f64; 4] = [6e-6, 6e-8, 6e-9, 6e-11];

impl Family {
    /// The family of `parameter`, the others being fixed, on the section through `instant` (of
    /// which the forcing angle alone matters).
    #[must_use]
    pub const fn new(parameters: Parameters, parameter: Parameter, instant: Instant) -> Self {
        Self { parameters, parameter, instant }
    }

    /// The parameter that varies.
    #[must_use]
    pub const fn parameter(&self) -> Parameter {
        self.parameter
    }

    /// The strobe map at a value.
    ///
    /// # Errors
    /// [`InputError::OutOfRange`] for a value that the model does not accept.
    pub fn map(&self, value: f64) -> Result<StrobeMap, InputError> {
        let model = Model::new(self.parameter.set(self.parameters, value))?;
        Ok(StrobeMap::new(model, self.instant))
    }

    /// Derivatives of the images of an iterate's strobes with respect to the parameter, per strobe.
    ///
    /// By differences: they steer the corrector and give the tangent, nothing else. A point that is
    /// accepted satisfies the map itself, and its multipliers are those of the exact derivative.
    /// Where a corner is near, the difference is taken on the iterate's own side of it.
    pub(super) fn slopes(
        &self,
        value: f64,
        iterate: &ShootingIterate,
        scale: f64,
    ) -> Vec<StrobePoint> {
        (0..iterate.points.len()).map(|k| self.slope(value, iterate, k, scale)).collect()
    }

    fn slope(&self, value: f64, iterate: &ShootingIterate, k: usize, scale: f64) -> StrobePoint {
        let here = &iterate.passages[k];
        let beside = |step: f64| {
            let map = self.map(value + step).ok()?;
            let passage = map.passage(&map.entry(iterate.points[k]).ok()?, 1);
            Some((passage.point(), passage.phases == here.phases))
        };
        let mut fallback = [0.0; 3];
        for step in DIFFERENCE_STEPS.map(|relative| relative * value.abs().max(scale)) {
            // What is representable.
            let (up, down) = ((value + step) - value, value - (value - step));
            let quotient = |a: StrobePoint, b: StrobePoint, span: f64| -> StrobePoint {
                std::array::from_fn(|i| (a[i] - b[i]) / span)
            };
            match (beside(up), beside(-down)) {
                (Some((plus, true)), Some((minus, true))) => {
                    return quotient(plus, minus, up + down);
                }
                (Some((plus, true)), _) if step <= one_sided(value, scale) => {
                    return quotient(plus, here.point(), up);
                }
                (_, Some((minus, true))) if step <= one_sided(value, scale) => {
                    return quotient(here.point(), minus, down);
                }
                (Some((plus, _)), Some((minus, _))) => fallback = quotient(plus, minus, up + down),
                _ => {}
            }
        }
        fallback
    }
}

/// A one-sided difference is of first order, and next to a graze of order one half.
fn one_sided(value: f64, scale: f64) -> f64 {
    1.01 * DIFFERENCE_STEPS[2] * value.abs().max(scale)
}
