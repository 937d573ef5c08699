//! What is left of the trial force in contact when the free oscillation has died out.
//!
//! By Eq. (12) f = 2 xi y + q obeys f'' + 2 xi f' + f = F + 2 xi F'; so the forced part of f less b
//! is Re((F - b) H) with H = (1 + 2 i xi omega)/(1 - omega^2 + 2 i xi omega).

use crate::flow::forced::Forced;
use crate::numeric::number::Number;

/// The complex H in parts that apply to F - b and to F', and the amplitude of the forced part.
#[derive(Clone, Copy, Debug)]
pub struct Steady<T> {
    re: T,
    im_over_omega: T,
    omega2: T,
    /// a |H|
    pub amplitude: T,
}

impl<T: Number> Steady<T> {
    /// The steady state of a contact with these parameters.
    #[must_use]
    pub fn new(a: T, xi: T, omega: T) -> Self {
        let one = T::one();
        let stiffness = (one - omega) * (one + omega);
        let damping = (xi + xi) * omega;
        let inverse = Forced::<T>::amplitude(xi, omega);
        let square = inverse * inverse;
        Self {
            re: (stiffness + damping * damping) * square,
            im_over_omega: damping * (stiffness - one) * square / omega,
            omega2: omega * omega,
            amplitude: a * (one + damping * damping).sqrt() * inverse,
        }
    }

    /// The forced part and its first three derivatives; `force` is F - b, F', F''.
    #[inline]
    pub fn orders(&self, force: [T; 3]) -> [T; 4] {
        let value = self.re * force[0] + self.im_over_omega * force[1];
        let rate = self.re * force[1] + self.im_over_omega * force[2];
        [value, rate, -(self.omega2 * value), -(self.omega2 * rate)]
    }
}
