//! The accuracy that an engine is asked for.

use crate::failure::Failure;
use percuss::Parameters;

/// The way in which an engine's accuracy is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stepping {
    /// Closed forms are exact: no accuracy is chosen.
    Exact,
    /// A tolerance sets the accuracy.
    Adaptive,
    /// A tolerance sets the accuracy, and a method of this order holds the error of the solution it
    /// continues with, step by step: what adds up over steps as long as that goes as
    /// tolerance^(p/(p + 1)).
    PerStep {
        /// The order.
        order: i32,
    },
    /// A step sets the accuracy of a method of this order.
    Fixed {
        /// The order.
        order: i32,
    },
}

/// The way in which an accuracy is chosen, without the order that it may need.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SteppingKind {
    /// A tolerance sets the accuracy.
    Adaptive,
    /// A tolerance sets the accuracy, and a method of a stated order holds the error step by step.
    PerStep,
    /// A step sets the accuracy of a method of a stated order.
    Fixed,
}

impl SteppingKind {
    /// The way with the order of the method, or nothing where it needs one and there is none.
    #[must_use]
    pub fn of_order(self, order: Option<u32>) -> Option<Stepping> {
        let order = order.and_then(|order| i32::try_from(order).ok());
        match self {
            Self::Adaptive => Some(Stepping::Adaptive),
            Self::PerStep => order.map(|order| Stepping::PerStep { order }),
            Self::Fixed => order.map(|order| Stepping::Fixed { order }),
        }
    }
}

/// The tolerance or the step that is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Accuracy {
    /// The run is as accurate as rounding allows.
    Exact,
    /// A tolerance, relative and absolute.
    Tolerance(f64),
    /// A step in units of the model's [`shortest_time`].
    Step(f64),
}

impl Accuracy {
    /// The tolerance, for engines whose accuracy is chosen by a tolerance.
    #[must_use]
    pub fn tolerance(self) -> Option<f64> {
        match self {
            Self::Tolerance(tolerance) => Some(tolerance),
            Self::Exact | Self::Step(_) => None,
        }
    }

    /// The step, for engines with fixed steps.
    #[must_use]
    pub fn step(self) -> Option<f64> {
        match self {
            Self::Step(step) => Some(step),
            Self::Exact | Self::Tolerance(_) => None,
        }
    }

    /// The tolerance that a library is given. One that is not positive makes some of them loop for
    /// ever without a call that could be counted.
    pub(crate) fn wanted_tolerance(self) -> Result<f64, Failure> {
        positive(self.tolerance(), "a positive tolerance")
    }

    /// The step that a library is given, in units of the [`shortest_time`].
    pub(crate) fn wanted_step(self) -> Result<f64, Failure> {
        positive(self.step(), "a positive step")
    }
}

fn positive(value: Option<f64>, what: &str) -> Result<f64, Failure> {
    let value = value.filter(|value| value.is_finite() && *value > 0.0);
    value.ok_or_else(|| Failure::new(format!("needs {what}")))
}

impl Stepping {
    /// The way without its order, or nothing where no accuracy is chosen.
    #[must_use]
    pub fn kind(self) -> Option<SteppingKind> {
        match self {
            Self::Exact => None,
            Self::Adaptive => Some(SteppingKind::Adaptive),
            Self::PerStep { .. } => Some(SteppingKind::PerStep),
            Self::Fixed { .. } => Some(SteppingKind::Fixed),
        }
    }

    /// The unit in which an engine's errors are counted, fixed by theory: eps, the tolerance or
    /// what its steps make of it, or with fixed steps what one unit of time costs a method of this
    /// order in y' = -y, step^order/(order + 1)!.
    #[must_use]
    pub fn unit(self, accuracy: Accuracy) -> f64 {
        match (self, accuracy) {
            (Self::PerStep { order }, Accuracy::Tolerance(tolerance)) => {
                tolerance.powf(f64::from(order) / f64::from(order + 1))
            }
            (_, Accuracy::Tolerance(tolerance)) => tolerance,
            (Self::Fixed { order }, Accuracy::Step(step)) => {
                step.powi(order) / (1..=order + 1).map(f64::from).product::<f64>()
            }
            (_, Accuracy::Exact | Accuracy::Step(_)) => f64::EPSILON,
        }
    }
}

/// The shortest of the times in which the model's equations change: 1/omega of the forcing, 1 of
/// the elastic contact, and 2 xi or 1/(2 xi) of relaxation. A fixed step in this unit is as stable
/// in one case as in another.
#[must_use]
pub fn shortest_time(parameters: &Parameters) -> f64 {
    let relaxation = 2.0 * parameters.xi;
    (1.0 / parameters.omega).min(1.0).min(relaxation).min(1.0 / relaxation)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units() {
        assert_eq!(Stepping::Exact.unit(Accuracy::Exact), f64::EPSILON);
        assert_eq!(Stepping::Adaptive.unit(Accuracy::Tolerance(1e-6)), 1e-6);
        let unit = Stepping::PerStep { order: 2 }.unit(Accuracy::Tolerance(1e-6));
        assert!((unit / 1e-4 - 1.0).abs() < 1e-12);
        let unit = Stepping::Fixed { order: 4 }.unit(Accuracy::Step(0.5));
        assert_eq!(unit, 0.0625 / 120.0);
    }

    #[test]
    fn odd_choices_are_refused() {
        for odd in [0.0, -1e-6, f64::NAN, f64::INFINITY] {
            assert!(Accuracy::Tolerance(odd).wanted_tolerance().is_err());
            assert!(Accuracy::Step(odd).wanted_step().is_err());
        }
        assert!(Accuracy::Exact.wanted_tolerance().is_err());
    }

    #[test]
    fn relaxation_sets_the_step_of_light_and_of_strong_damping() {
        let time = |xi| shortest_time(&Parameters { xi, omega: 0.5, ..Parameters::default() });
        assert_eq!((time(0.01), time(20.0), time(0.5)), (0.02, 0.025, 1.0));
    }
}
