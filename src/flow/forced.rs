//! Forced oscillation in contact: R'' + 2 xi R' + R = exp(i omega d) from rest, R(0) = R'(0) = 0.
//!
//! Away from resonance R = (exp(i omega d) - C - i omega S)/P with P = 1 - omega^2 + 2 i xi omega,
//! which is Eqs. (15)-(17) with the free part collected. Near resonance P is small and the three
//! terms are each 1/|P| larger than their sum; there R is written as a divided difference,
//! R = (D+ - D-)/(2 i nu) with D+- = (exp(i omega d) - exp(lambda+- d))/(i omega - lambda+-) and
//! lambda+- = -xi +- i nu, and D+ in the difference of frequencies delta = omega - nu alone.
//!
//! In short times R is d^2/2 although each of its parts is of the order of d, and the guard may
//! hold nothing larger than R: there both forms take the parts less their linear terms, which
//! cancel.

use crate::flow::complex::Complex;
use crate::flow::damped::{Free, Rotation};
use crate::numeric::number::Number;
use crate::numeric::remainders::{Circular, circular};

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
        /// Its size: the time after which forced and free oscillation are out of step.
        in_step: T,
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

/// |P|^2 below which the divided difference is the better form. The plain one loses 1/|P|, twice at
/// this border; the divided difference loses nothing near omega = 1, and 35 eps at omega = 10.
const RESONANCE: f64 = 0.25;

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
                in_step: one / (xi * xi + delta * delta).sqrt(),
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
            Self::Plain { two_xi, omega, inverse } => {
                let sines = if d < T::one() {
                    turn.sin_minus_x - omega * free.s_minus_d
                } else {
                    turn.sin - omega * free.s
                };
                plain(two_xi, omega, inverse, sines, turn, free)
            }
            Self::Resonant { xi, half_over_nu, delta, slow, in_step, quick } => {
                let parts = if d < T::one() {
                    Parts::short(d, (slow, quick), &circular(delta * d), turn, &free.rotation)
                } else {
                    let beat = (d < in_step).then(|| circular(delta * d));
                    Parts::long((slow, quick), beat, turn, &free.rotation)
                };
                parts.response(xi, half_over_nu)
            }
        }
    }
}

#[inline]
fn plain<T: Number>(
    two_xi: T,
    omega: T,
    inverse: Complex<T>,
    sines: T,
    turn: &Circular<T>,
    free: &Free<T>,
) -> Response<T> {
    let displacement = Complex::new(turn.cos_minus_1 - free.c_minus_1, sines);
    let rate =
        Complex::new(free.s - omega * turn.sin, omega * (turn.cos_minus_1 - free.s_rate_minus_1));
    let force = Complex::new(
        turn.cos_minus_1 - free.s_rate_minus_1 - two_xi * omega * turn.sin,
        displacement.im + two_xi * rate.im,
    );
    Response { rate: rate * inverse, force: force * inverse, displacement: displacement * inverse }
}

/// D+ and D- of the divided difference.
struct Parts<T> {
    sum: Complex<T>,
    difference: Complex<T>,
}

impl<T: Number> Parts<T> {
    /// With the beat as long as the two oscillations are in step, and without where they are not:
    /// then their difference no longer cancels, and delta d would carry the rounding of delta.
    #[inline]
    fn long(
        (inverse_slow, inverse_quick): (Complex<T>, Complex<T>),
        beat: Option<Circular<T>>,
        turn: &Circular<T>,
        Rotation { shrink, turn: free }: &Rotation<T>,
    ) -> Self {
        let one = T::one();
        let damped = Complex::new(one + free.cos_minus_1, free.sin);
        let forcing = Complex::new(one + turn.cos_minus_1, turn.sin);
        let lag = match beat {
            Some(beat) => damped * Complex::new(beat.cos_minus_1 - shrink.minus_1, beat.sin),
            None => forcing - damped.scale(shrink.exp),
        };
        let slow = lag * inverse_slow;
        let quick = (forcing - damped.conjugate().scale(shrink.exp)) * inverse_quick;
        Self { sum: slow + quick, difference: slow - quick }
    }

    /// D+ - d and D- - d, both of the order of d^2.
    #[inline]
    fn short(
        d: T,
        (inverse_slow, inverse_quick): (Complex<T>, Complex<T>),
        beat: &Circular<T>,
        turn: &Circular<T>,
        Rotation { shrink, turn: free }: &Rotation<T>,
    ) -> Self {
        let beating = Complex::new(beat.cos_minus_1 - shrink.remainder, beat.sin_minus_x);
        let lag = beating * inverse_slow;
        let turned = Complex::new(free.cos_minus_1, free.sin);
        let slow = lag + turned * Complex::new(d + lag.re, lag.im);
        let cosines = turn.cos_minus_1 - (shrink.remainder + shrink.exp * free.cos_minus_1);
        let sines = turn.sin_minus_x + (free.sin_minus_x + shrink.minus_1 * free.sin);
        let quick = Complex::new(cosines, sines) * inverse_quick;
        let sum = slow + quick;
        Self { sum: Complex::new(sum.re + (d + d), sum.im), difference: slow - quick }
    }

    #[inline]
    fn response(&self, xi: T, half_over_nu: T) -> Response<T> {
        let Self { sum, difference } = self;
        // 1/(2 i nu) = -i/(2 nu)
        let displacement = Complex::new(difference.im, -difference.re).scale(half_over_nu);
        let rate = sum.scale(T::exact(0.5)) - displacement.scale(xi);
        Response { rate, force: displacement + rate.scale(xi + xi), displacement }
    }
}
