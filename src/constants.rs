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
    /// omega^2
    pub omega2: T,
    /// The eighth power of 1/(2 xi).
    pub rate8: T,
    /// 1/omega^2
    pub per_omega2: T,
    /// omega^6
    pub omega6: T,
    /// Free oscillation in contact.
    pub damping: Damping<T>,
    /// Forced oscillation in contact.
    pub forced: Forced<T>,
    /// A bound of the eighth derivative of the forced part of the trial force.
    pub forced_eighth: T,
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
        let rate = T::one() / two_xi;
        let rate4 = rate * rate * (rate * rate);
        let omega2 = omega * omega;
        let omega4 = omega2 * omega2;
        let steady = Steady::new(a, xi, omega);
        Self {
            a,
            b,
            xi,
            omega,
            g,
            two_xi,
            rate,
            a_over_omega: a / omega,
            a_over_omega2: a / omega2,
            omega2,
            rate8: rate4 * rate4,
            per_omega2: T::one() / omega2,
            omega6: omega2 * omega4,
            damping,
            forced: Forced::new(xi, omega),
            forced_eighth: steady.amplitude * (omega4 * omega4),
            steady,
        }
    }
}
