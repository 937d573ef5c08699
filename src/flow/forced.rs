//! Forced oscillation in contact: R'' + 2 xi R' + R = exp(i omega d) from rest, R(0) = R'(0) = 0.
//!
//! Away from resonance R = (exp(i omega d) - C - i omega S)/P with P = 1 - omega^2 + 2 i xi omega,
//! which is Eqs. (15)-(17) with the free part collected. Near resonance P is small and the three
//! terms are each 1/|P| larger than their sum; there R is written as a divided difference,
//! R = (D+ - D-)/(2 i nu) with D+- = (exp(i omega d) - exp(lambda+- d))/(i omega - lambda+-) and
//! lambda+- = -xi +- i nu, and D+ in the difference of frequencies delta = omega - nu alone.

use crate::flow::complex::Complex;
use crate::flow::damped::{Free, Rotation};
use crate::number::Number;
use crate::remainders::{Circular, circular};

/// How the forced oscillation is computed at this frequency and damping.
#[derive(Clone, Copy, Debug)]
pub enum Forced<T> {
    /// Divide by P.
    Plain {
        /// 2 xi
        two_xi: T,
        /// omega
        omega: T,
        /// 1/P
        inverse: Complex<T>,
    },
    /// The divided difference.
    Resonant {
        /// xi
        xi: T,
        /// 1/(2 nu)
        half_over_nu: T,
        /// omega - nu without cancellation
        delta: T,
        /// 1/(i omega - lambda+)
        slow: Complex<T>,
        /// 1/(i omega - lambda-)
        quick: Complex<T>,
    },
}

/// The response to a cos(omega d + theta0) from rest.
#[derive(Clone, Copy, Debug)]
pub struct Response<T> {
    /// Velocity R'.
    pub rate: Complex<T>,
    /// Trial force 2 xi R' + R.
    pub force: Complex<T>,
    /// Displacement R.
    pub displacement: Complex<T>,
}

/// |P|^2 below which the divided difference is the better form: there it is good to 5 eps, and at
/// omega = 10 it would lose 35, where the plain one loses nothing.
const RESONANCE: f64 = 0.02;

impl<T: Number> Forced<T> {
    /// Picks the form for this damping and frequency.
    #[must_use]
    pub fn new(xi: T, omega: T) -> Self {
        let one = T::one();
        let two_xi = xi + xi;
        let stiffness = (one - omega) * (one + omega);
        let damping = two_xi * omega;
        let square = stiffness * stiffness + damping * damping;
        if square < T::exact(RESONANCE) {
            let nu = ((one - xi) * (one + xi)).sqrt();
            let delta = (omega - one) + xi * xi / (one + nu);
            return Self::Resonant {
                xi,
                half_over_nu: T::exact(0.5) / nu,
                delta,
                slow: Complex::new(xi, delta).inverse(),
                quick: Complex::new(xi, omega + nu).inverse(),
            };
        }
        let inverse = Complex::new(stiffness / square, -(damping / square));
        Self::Plain { two_xi, omega, inverse }
    }

    /// |1/P|, the amplitude of the steady displacement under unit forcing.
    pub fn amplitude(xi: T, omega: T) -> T {
        let one = T::one();
        let stiffness = (one - omega) * (one + omega);
        let damping = (xi + xi) * omega;
        one / (stiffness * stiffness + damping * damping).sqrt()
    }

    /// The response after `d`; `turn` belongs to `omega d`, `free` to `d`.
    #[inline]
    pub fn at(&self, d: T, turn: &Circular<T>, free: &Free<T>) -> Response<T> {
        match *self {
            Self::Plain { two_xi, omega, inverse } => plain(two_xi, omega, inverse, turn, free),
            Self::Resonant { xi, half_over_nu, delta, slow, quick } => {
                let beat = circular(delta * d);
                resonant(xi, half_over_nu, (slow, quick), &beat, turn, &free.rotation)
            }
        }
    }
}

#[inline]
fn plain<T: Number>(
    two_xi: T,
    omega: T,
    inverse: Complex<T>,
    turn: &Circular<T>,
    free: &Free<T>,
) -> Response<T> {
    let displacement = Complex::new(turn.cos_minus_1 - free.c_minus_1, turn.sin - omega * free.s);
    let rate =
        Complex::new(free.s - omega * turn.sin, omega * (turn.cos_minus_1 - free.s_rate_minus_1));
    let force = Complex::new(
        turn.cos_minus_1 - free.s_rate_minus_1 - two_xi * omega * turn.sin,
        displacement.im + two_xi * rate.im,
    );
    Response { rate: rate * inverse, force: force * inverse, displacement: displacement * inverse }
}

#[inline]
fn resonant<T: Number>(
    xi: T,
    half_over_nu: T,
    (inverse_slow, inverse_quick): (Complex<T>, Complex<T>),
    beat: &Circular<T>,
    turn: &Circular<T>,
    rotation: &Rotation<T>,
) -> Response<T> {
    let one = T::one();
    let damped = Complex::new(one + rotation.cos_minus_1, rotation.sin);
    let forcing = Complex::new(one + turn.cos_minus_1, turn.sin);
    let beating = Complex::new(beat.cos_minus_1 - rotation.decay_minus_1, beat.sin);
    let slow = damped * beating * inverse_slow;
    let shrink = one + rotation.decay_minus_1;
    let quick = (forcing - damped.conjugate().scale(shrink)) * inverse_quick;
    let difference = slow - quick;
    // 1/(2 i nu) = -i/(2 nu)
    let displacement = Complex::new(difference.im, -difference.re).scale(half_over_nu);
    let rate = (slow + quick).scale(T::exact(0.5)) - displacement.scale(xi);
    Response { rate, force: displacement + rate.scale(xi + xi), displacement }
}
