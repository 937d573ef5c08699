//! What the closed forms need of the parameters, computed once.

use crate::flow::damped::Damping;
use crate::flow::forcing::{Drive, Forced, Steady};
use crate::numeric::number::Number;
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
    /// 1/a; zero without harmonic force.
    pub per_a: T,
    /// a/omega
    pub a_over_omega: T,
    /// a/omega^2
    pub a_over_omega2: T,
    /// omega^2
    pub omega2: T,
    /// The eighth power of 1/(2 xi).
    pub rate8: T,
    /// What products that underflow may take from a guard. Each loses at most the last digit of the
    /// smallest normal number, 5e-324, and is multiplied after that by a, or by a/omega^2, at the
    /// most; by a state of up to 1e9, or near resonance by up to 5e13, which the 4e15 between that
    /// digit and that number leave room for.
    pub underflow: T,
    /// 1/omega
    pub per_omega: T,
    /// 1/omega^2
    pub per_omega2: T,
    /// omega^6
    pub omega6: T,
    /// Free oscillation in contact.
    pub damping: Damping<T>,
    /// What makes the eighth derivative of a free oscillation and the ninth of it and its rate.
    pub free_eighth: [[T; 2]; 2],
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
            per_a: if a > T::zero() { T::one() / a } else { T::zero() },
            a_over_omega: a / omega,
            a_over_omega2: a / omega2,
            omega2,
            rate8: rate4 * rate4,
            underflow: T::exact(f64::MIN_POSITIVE) * (T::one() + a + a / omega2),
            per_omega: T::one() / omega,
            per_omega2: T::one() / omega2,
            omega6: omega2 * omega4,
            damping,
            free_eighth: free_eighth(two_xi),
            forced: Forced::new(xi, omega),
            forced_eighth: steady.amplitude * (omega4 * omega4),
            steady,
        }
    }

    /// What the harmonic force needs.
    #[inline(always)]
    pub fn drive(&self) -> Drive<T> {
        let Self { a, omega, a_over_omega, a_over_omega2, .. } = *self;
        Drive { a, omega, a_over_omega, a_over_omega2 }
    }
}

impl Constants<f64> {
    /// The rates at which the two parts of a free oscillation in contact die out, where it does not
    /// turn: the slower one, and the faster one. Both are xi below critical damping.
    #[must_use]
    pub fn decays(&self) -> (f64, f64) {
        let xi = self.xi;
        if xi < 1.0 {
            return (xi, xi);
        }
        let fast = xi + ((xi - 1.0) * (xi + 1.0)).sqrt();
        (1.0 / fast, fast)
    }
}

/// The coefficients of x and x' in the eighth derivative of x, and in the ninth, by x'' + 2 xi x' +
/// x = 0.
fn free_eighth<T: Number>(two_xi: T) -> [[T; 2]; 2] {
    let of = |mut x: T, mut rate: T| {
        for _ in 0..8 {
            (x, rate) = (rate, -(two_xi * rate + x));
        }
        [x, rate]
    };
    let ([a, c], [b, d]) = (of(T::one(), T::zero()), of(T::zero(), T::one()));
    [[a, b], [c, d]]
}
