//! A sign change of a test along a smooth piece of the curve, found and held against rounding.

use super::curve::Curve;
use super::point::CurvePoint;
use crate::dynamics::continuation::locate::{LocatedPoint, zero_along};

/// The orbit at which a test function vanishes.
pub(super) type Located = LocatedPoint<CurvePoint>;

impl Curve<'_> {
    /// The zero of `test` on the curve between `base` and a distance along its tangent.
    pub fn located(
        &self,
        base: &CurvePoint,
        distance: f64,
        test: &dyn Fn(&CurvePoint) -> f64,
    ) -> Option<Located> {
        zero_along(base, distance, &|at| self.corrected(base, at), test)
    }

    /// How far the parameter's value there may be off.
    pub fn error(&self, located: &Located) -> f64 {
        located.bracket * located.point.tangent.rate.abs() + self.uncertainty(&located.point)
    }
}
