//! The derivatives of a system's coefficients by a name, in plain numbers.

use super::given::{mode, rounded};
use super::{Mode, SystemProblem, Values};
use crate::equations::Numbers;
use percuss::affine::{Name, Rational, StartPoint, Tangent};

/// The derivatives of a system's coefficients and of its start by a name, each in the place of the
/// coefficient.
#[derive(Clone, Debug, PartialEq)]
pub struct CoefficientDerivatives {
    /// The name: a parameter, or `start.STATE`.
    pub name: String,
    /// The value of the parameter, or of the state at the start.
    pub value: f64,
    /// The derivative of the forcing's angular frequency.
    pub omega: f64,
    /// The derivative of the forcing's angle at the start.
    pub phi: f64,
    /// The derivatives of the states at the start.
    pub state: Values,
    /// The modes with derivatives for coefficients; no condition of a successor has any.
    pub modes: Vec<Mode>,
}

impl CoefficientDerivatives {
    /// The derivatives of a problem's coefficients, each rounded once; its start is the file's own.
    #[must_use]
    pub fn new(problem: &SystemProblem, tangent: &Tangent) -> Self {
        let states = problem.exact.states.len();
        let phi = turn(problem, tangent);
        let state = Values::from_slice(&start(problem, tangent.start.as_ref(), phi));
        let modes = tangent.modes.iter().map(|it| mode(it, states)).collect();
        let omega = tangent.forcing.as_ref().map_or(0.0, |it| rounded(&it.omega));
        let name = tangent.name.to_string();
        Self { value: value(problem, &tangent.name), name, omega, phi, state, modes }
    }
}

/// The value of a name.
fn value(problem: &SystemProblem, name: &Name) -> f64 {
    let found = match name {
        Name::Parameter(own) => problem.exact.parameters.get(own).copied(),
        Name::Start(own) => {
            let place = problem.exact.states.iter().position(|it| it == own);
            place.and_then(|it| problem.state().get(it).copied())
        }
    };
    // A tangent has names of its system alone.
    found.unwrap_or(0.0)
}

/// The derivative of the forcing's angle at the start.
fn turn(problem: &SystemProblem, tangent: &Tangent) -> f64 {
    let (Some(own), Some(rate)) = (&problem.exact.forcing, &tangent.forcing) else { return 0.0 };
    let begin = tangent.start.as_ref().map(|it| &own.omega * &it.time).unwrap_or_default();
    rounded(&(&rate.omega * &problem.start.time + begin + &rate.phi))
}

/// The derivatives of the states at the start, whose forcing turns by `phi`.
fn start(problem: &SystemProblem, rate: Option<&StartPoint>, phi: f64) -> Vec<f64> {
    let (sin, cos) = problem.checked.system().phi.sin_cos();
    let turned = |[c, s, _]: &[Rational; 3]| phi * (rounded(s) * cos - rounded(c) * sin);
    let factors = |[c, s, one]: &[Rational; 3]| rounded(c) * cos + rounded(s) * sin + rounded(one);
    let own = problem.start.state.iter().map(turned);
    let rates = |n: usize| rate.and_then(|it| it.state.get(n)).map_or(0.0, factors);
    own.enumerate().map(|(n, own)| own + rates(n)).collect()
}
