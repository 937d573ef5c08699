//! What the external force a cos(omega tau + phi) + b does: its integrals over elapsed time, and
//! the oscillation R that it drives in contact.
//!
//! R'' + 2 xi R' + R = exp(i omega d) from rest, R(0) = R'(0) = 0. Away from resonance
//! R = (exp(i omega d) - C - i omega S)/P with P = 1 - omega^2 + 2 i xi omega, which is Eqs. (15)
//! to (17) with the free part collected. Near resonance P is small and the three terms are each
//! 1/|P| larger than their sum; there R is written as a divided difference,
//! R = (D+ - D-)/(2 i nu) with D+- = (exp(i omega d) - exp(lambda+- d))/(i omega - lambda+-) and
//! lambda+- = -xi +- i nu, and D+ in the difference of frequencies delta = omega - nu alone.
//!
//! In short times R is d^2/2 although each of its parts is of the order of d, and the guard may
//! hold nothing larger than R: there both forms take the parts less their linear terms, which
//! cancel.
//!
//! What is left of the trial force when the free oscillation has died out is [`Steady`]: by Eq.
//! (12) f = 2 xi y + q obeys f'' + 2 xi f' + f = F + 2 xi F'; so the forced part of f less b is
//! Re((F - b) H) with H = (1 + 2 i xi omega)/(1 - omega^2 + 2 i xi omega).

use crate::flow::damped::{Free, Rotation};
use crate::numeric::complex::Complex;
use crate::numeric::number::Number;
use crate::numeric::real::{Real, polynomial};
use crate::numeric::remainders::{Circular, circular, circular_of};

/// The forcing angle `omega tau + phi` when the phase begins.
#[derive(Clone, Copy, Debug)]
pub struct EntryAngle<T> {
    /// omega tau0 + phi within `[0, 2 pi)`, rounded: certificates find the force's changes of sign
    /// by it. The motion itself is computed from its sine and cosine.
    pub radians: T,
    /// sin(omega tau0 + phi)
    pub sin: T,
    /// cos(omega tau0 + phi)
    pub cos: T,
}

/// The harmonic force over an elapsed time d, by its remainders.
#[derive(Clone, Copy, Debug)]
pub struct Harmonic<T> {
    /// a cos(omega tau + phi) and its first two derivatives.
    pub force: [T; 3],
    /// The forcing's integral from 0 to d: (a/omega) (sin(omega tau + phi) - sin(omega tau0 +
    /// phi)).
    pub impulse: T,
    /// The forcing's second integral: -(a/omega^2) (cos(omega tau + phi) - cos(omega tau0 + phi) +
    /// omega d sin(omega tau0 + phi)).
    pub displacement: T,
    /// An upper bound of the terms that made `displacement`.
    pub displacement_terms: T,
    /// An upper bound of the terms that made `impulse`.
    pub impulse_terms: T,
    /// The remainders themselves.
    pub turn: Circular<T>,
}

impl<T: Number> EntryAngle<T> {
    /// The harmonic force and its integrals after `d` (Eqs. 14, 18, 20, without cancellation).
    #[inline(always)]
    pub fn harmonic(&self, drive: &Drive<T>, d: T) -> Harmonic<T> {
        let turn = circular_of(drive.omega * d, drive.omega.product_error(d));
        self.turned(drive, turn)
    }
}

/// What the harmonic force needs of the parameters.
pub struct Drive<T> {
    /// a
    pub a: T,
    /// omega
    pub omega: T,
    /// a/omega
    pub a_over_omega: T,
    /// a/omega^2
    pub a_over_omega2: T,
}

impl<T: Real> EntryAngle<T> {
    /// The harmonic force and its integrals when the forcing has turned so far.
    #[inline(always)]
    pub fn turned(&self, drive: &Drive<T>, turn: Circular<T>) -> Harmonic<T> {
        let Drive { a, omega, a_over_omega, a_over_omega2 } = *drive;
        let Circular { sin, cos_minus_1, sin_minus_x } = turn;
        let fallen = self.sin.times_from(sin, self.cos * cos_minus_1);
        let risen = self.cos.times_plus(sin, self.sin * cos_minus_1);
        let (cosine, sine) = (self.cos + fallen, self.sin + risen);
        let sunk = self.sin.times_from(sin_minus_x, self.cos * cos_minus_1);
        Harmonic {
            force: [a * cosine, -(a * omega * sine), -(a * omega * omega * cosine)],
            impulse: a_over_omega * risen,
            displacement: -(a_over_omega2 * sunk),
            displacement_terms: a_over_omega2 * (sin_minus_x.magnitude() - cos_minus_1),
            impulse_terms: a_over_omega * (sin.magnitude() - cos_minus_1),
            turn,
        }
    }
}

/// The harmonic force after a short step, and what it has done to the velocity.
#[derive(Clone, Copy, Debug)]
pub struct Push<T> {
    /// The harmonic force with its first two derivatives.
    pub force: [T; 3],
    /// The integral of the harmonic force over the step.
    pub impulse: T,
}

impl<T: Real> Push<T> {
    /// The push over a `step` from an evaluation with this harmonic force and its rate.
    #[inline(always)]
    pub fn new(omega: T, [u, v]: [T; 2], step: T) -> Self {
        let x = omega * step;
        let square = x * x;
        let sin_over_x = polynomial(square, [1.0, -1.0 / 6.0, 1.0 / 120.0, -1.0 / 5040.0]);
        let one_less_cos = polynomial(square, [0.5, -1.0 / 24.0, 1.0 / 720.0, -1.0 / 40320.0]);
        let (time, area) = (step * sin_over_x, step * step * one_less_cos);
        // u'' = -omega^2 u for the harmonic force u.
        let omega2 = omega * omega;
        let harmonic = time.times_plus(v, (omega2 * area).times_from(u, u));
        let rate = (omega2 * time).times_from(u, (omega2 * area).times_from(v, v));
        Self {
            force: [harmonic, rate, -(omega2 * harmonic)],
            impulse: time.times_plus(u, area * v),
        }
    }
}

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
        near_pole: Complex<T>,
        /// |1/(i omega - lambda+)|: how long forced and free oscillation stay in step.
        in_step: T,
        /// 1/(i omega - lambda-)
        far_pole: Complex<T>,
    },
}

/// The complex response R to exp(i omega d) from rest. A contact scales it by a and turns it by the
/// forcing angle at entry ([`crate::flow::contact`]).
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
const MAX_RESONANT_SQUARE: f64 = 0.25;

impl<T: Number> Forced<T> {
    /// Picks the form for this damping and frequency.
    #[must_use]
    pub fn new(xi: T, omega: T) -> Self {
        let one = T::one();
        let two_xi = xi + xi;
        let stiffness = (one - omega) * (one + omega);
        let damping = two_xi * omega;
        let square = stiffness * stiffness + damping * damping;
        if square < T::exact(MAX_RESONANT_SQUARE) {
            let nu = ((one - xi) * (one + xi)).sqrt();
            let delta = (omega - one) + xi * xi / (one + nu);
            return Self::Resonant {
                xi,
                half_over_nu: T::exact(0.5) / nu,
                delta,
                near_pole: Complex::new(xi, delta).inverse(),
                in_step: one / (xi * xi + delta * delta).sqrt(),
                far_pole: Complex::new(xi, omega + nu).inverse(),
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
    #[inline(always)]
    pub fn at(&self, d: T, turn: &Circular<T>, free: &Free<T>) -> Response<T> {
        match *self {
            Self::Plain { two_xi, omega, inverse } => {
                let sines = if d < T::one() {
                    turn.sin_minus_x - omega * free.s_minus_d
                } else {
                    turn.sin - omega * free.s
                };
                Response::plain_quotients(two_xi, omega, inverse, sines, turn, free)
            }
            Self::Resonant { xi, half_over_nu, delta, near_pole, in_step, far_pole } => {
                let together =
                    Together { turn, rotation: &free.rotation, inverses: [near_pole, far_pole] };
                let parts = if d < T::one() {
                    together.in_short_times(d, &circular(delta * d))
                } else if d < in_step {
                    together.in_long_times(together.lag_by_beat(&circular(delta * d)))
                } else {
                    together.in_long_times(together.lag())
                };
                parts.response(xi, half_over_nu)
            }
        }
    }
}

impl<T: Real> Response<T> {
    /// Divides by P: `inverse` is 1/P, `sines` what is left of exp(i omega d) - C - i omega S in
    /// its imaginary part.
    #[inline(always)]
    pub fn plain_quotients(
        two_xi: T,
        omega: T,
        inverse: Complex<T>,
        sines: T,
        turn: &Circular<T>,
        free: &Free<T>,
    ) -> Self {
        let displacement = Complex::new(turn.cos_minus_1 - free.c_minus_1, sines);
        let bent = turn.cos_minus_1 - free.s_rate_minus_1;
        let rate = Complex::new(omega.times_from(turn.sin, free.s), omega * bent);
        let force = Complex::new(
            (two_xi * omega).times_from(turn.sin, bent),
            two_xi.times_plus(rate.im, displacement.im),
        );
        Self { rate: rate * inverse, force: force * inverse, displacement: displacement * inverse }
    }
}

/// Forced and free oscillation near resonance.
pub struct Together<'a, T> {
    /// Sine and cosine of the forcing.
    pub turn: &'a Circular<T>,
    /// Exponential, sine and cosine of the free oscillation.
    pub rotation: &'a Rotation<T>,
    /// 1/(i omega - lambda+) and 1/(i omega - lambda-).
    pub inverses: [Complex<T>; 2],
}

/// D+ and D- of the divided difference.
pub struct Differences<T> {
    /// D+ + D-
    pub sum: Complex<T>,
    /// D+ - D-
    pub difference: Complex<T>,
}

impl<T: Real> Together<'_, T> {
    /// exp(i omega d) - exp(lambda+ d) by the beat, which does not cancel as long as the two
    /// oscillations are in step.
    #[inline(always)]
    pub fn lag_by_beat(&self, beat: &Circular<T>) -> Complex<T> {
        let shrink = &self.rotation.shrink;
        self.damped() * Complex::new(beat.cos_minus_1 - shrink.minus_1, beat.sin)
    }

    /// exp(i omega d) - exp(lambda+ d) where they are out of step: their difference no longer
    /// cancels, and the beat would carry the rounding of delta.
    #[inline(always)]
    pub fn lag(&self) -> Complex<T> {
        self.forcing() - self.damped().scale(self.rotation.shrink.exp)
    }

    /// D+ and D- in long times, from exp(i omega d) - exp(lambda+ d).
    #[inline(always)]
    pub fn in_long_times(&self, lag: Complex<T>) -> Differences<T> {
        let [inverse_near, inverse_far] = self.inverses;
        let near = lag * inverse_near;
        let conjugate = self.damped().conjugate().scale(self.rotation.shrink.exp);
        let far = (self.forcing() - conjugate) * inverse_far;
        Differences { sum: near + far, difference: near - far }
    }

    /// D+ and D- in short times, by D+ - d and D- - d, which are both of the order of d^2.
    #[inline(always)]
    pub fn in_short_times(&self, d: T, beat: &Circular<T>) -> Differences<T> {
        let (turn, Rotation { shrink, turn: free }) = (self.turn, self.rotation);
        let [inverse_near, inverse_far] = self.inverses;
        let beating = Complex::new(beat.cos_minus_1 - shrink.remainder, beat.sin_minus_x);
        let lag = beating * inverse_near;
        let turned = Complex::new(free.cos_minus_1, free.sin);
        let near = lag + turned * Complex::new(d + lag.re, lag.im);
        let cosines = turn.cos_minus_1 - shrink.exp.times_plus(free.cos_minus_1, shrink.remainder);
        let sines = turn.sin_minus_x + shrink.minus_1.times_plus(free.sin, free.sin_minus_x);
        let far = Complex::new(cosines, sines) * inverse_far;
        let sum = near + far;
        Differences { sum: Complex::new(sum.re + (d + d), sum.im), difference: near - far }
    }

    /// exp(i nu d)
    #[inline(always)]
    fn damped(&self) -> Complex<T> {
        let free = &self.rotation.turn;
        Complex::new(free.cos_minus_1.broadcast(1.0) + free.cos_minus_1, free.sin)
    }

    /// exp(i omega d)
    #[inline(always)]
    fn forcing(&self) -> Complex<T> {
        Complex::new(self.turn.cos_minus_1.broadcast(1.0) + self.turn.cos_minus_1, self.turn.sin)
    }
}

impl<T: Real> Differences<T> {
    /// The response that D+ and D- make.
    #[inline(always)]
    pub fn response(&self, xi: T, half_over_nu: T) -> Response<T> {
        let Self { sum, difference } = self;
        // 1/(2 i nu) = -i/(2 nu)
        let displacement = Complex::new(difference.im, -difference.re).scale(half_over_nu);
        let rate = sum.scale(xi.broadcast(0.5)) - displacement.scale(xi);
        let two_xi = xi + xi;
        let force = Complex::new(
            two_xi.times_plus(rate.re, displacement.re),
            two_xi.times_plus(rate.im, displacement.im),
        );
        Response { rate, force, displacement }
    }
}

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
