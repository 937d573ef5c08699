//! What the closed forms need of the parameters, computed once.

use crate::flow::damped::Damping;
use crate::flow::forced::Forced;
use crate::flow::steady::Steady;
use crate::number::Number;
use crate::parameters::Parameters;

/// The parameters and the constants derived from them, in one arithmetic.
#[derive(Clone, Copy, Debug)]
pub struct Constants<T> {
    /// Amplitude of the harmonic force.
    pub a: T,
    /// Static force.
    pub b: T,
    /// Damping ratio.
    pub xi: T,
    /// Forcing frequency.
    pub omega: T,
    /// Gap.
    pub g: T,
    /// 2 xi
    pub two_xi: T,
    /// 1/(2 xi), the rate at which the free slider returns.
    pub rate: T,
    /// a/omega
    pub a_over_omega: T,
    /// a/omega^2
    pub a_over_omega2: T,
    /// Free oscillation in contact.
    pub damping: Damping<T>,
    /// Forced oscillation in contact.
    pub forced: Forced<T>,
    /// The forced part of the trial force in contact.
    pub steady: Steady<T>,
}

impl<T: Number> Constants<T> {
    /// The constants of parameters that are known to be in range; f64 values are taken exactly.
    #[must_use]
    pub fn new(parameters: &Parameters) -> Self {
        let [a, b, xi, omega, g] =
            [parameters.a, parameters.b, parameters.xi, parameters.omega, parameters.g]
                .map(T::exact);
        let two_xi = xi + xi;
        let damping = Damping::new(xi);
        Self {
            a,
            b,
            xi,
            omega,
            g,
            two_xi,
            rate: T::one() / two_xi,
            a_over_omega: a / omega,
            a_over_omega2: a / (omega * omega),
            damping,
            forced: Forced::new(xi, omega),
            steady: Steady::new(a, xi, omega),
        }
    }
}
