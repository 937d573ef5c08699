//! The guards of the three phases written down from the equations of motion.

use crate::ball::Ball;
use crate::damping::Damping;
use crate::functions::sin_cos;
use crate::guard::{Free, Guard, energy};
use percuss::insides::{Motion, angle};
use percuss::{Instant, Parameters, TwoWord};

/// The constants that the guards of a model share.
pub struct Frame {
    a: Ball,
    b: Ball,
    g: Ball,
    xi: Ball,
    omega: Ball,
    phi: Ball,
    /// Forced oscillation of the trial force: its parts with cosine and sine of the forcing angle.
    steady: [Ball; 2],
    damping: Damping,
}

impl Frame {
    /// Encloses the model's constants for these parameters, which are taken exactly.
    #[must_use]
    pub fn new(parameters: &Parameters) -> Self {
        let Parameters { a, b, xi, omega, g, phi } = *parameters;
        let (_, phi) = angle::reduce(TwoWord::new(phi));
        let damping = Damping::new(xi);
        let [a, b, xi, omega, g] = [a, b, xi, omega, g].map(Ball::exact);
        // (1 + i m)/(s + i m) with s = 1 - omega^2 and m = 2 xi omega
        let s = (Ball::ONE - omega) * (Ball::ONE + omega);
        let m = xi.scaled(2.0) * omega;
        let per_square = a / (s.square() + m.square());
        let steady = [(s + m.square()) * per_square, -(m * (s - Ball::ONE) * per_square)];
        Self { a, b, g, xi, omega, phi: Ball::words(phi), steady, damping }
    }
}

impl Frame {
    /// Encloses the guard of a phase that begins at this instant.
    #[must_use]
    pub fn guard(&self, motion: &Motion<'_>, entry: &Instant) -> Guard {
        let angle = Ball::words(entry.angle_two_word()) + self.phi;
        let (sin, cos) = sin_cos(angle);
        match motion {
            Motion::NoContact(flight) => {
                let [p, y, q] = [flight.entry.p, flight.entry.y, flight.entry.q].map(Ball::exact);
                self.flight([p, y, q], flight.surface.map(Ball::exact), angle, (sin, cos))
            }
            Motion::Contact(contact) => {
                let (offset, y) = (Ball::exact(contact.offset), Ball::exact(contact.entry.y));
                self.contact([offset, y], Ball::exact(contact.reference), angle, (sin, cos))
            }
            Motion::Progression(slip) => {
                let (w, closing) = (Ball::exact(slip.drift_rate), Ball::exact(slip.closing));
                self.slip([w, closing], angle, sin)
            }
        }
    }

    /// h = p - g - q, with p'' = F and q' = -q/(2 xi).
    fn flight(
        &self,
        [p, y, q]: [Ball; 3],
        surface: Option<Ball>,
        angle: Ball,
        (sin, cos): (Ball, Ball),
    ) -> Guard {
        let rate = Ball::ONE / self.xi.scaled(2.0);
        let speed = self.a / self.omega;
        let reach = speed / self.omega;
        // On the surface p = q + g and the rate of h is known, which is y + q/(2 xi).
        let (height, y, start) = match surface {
            Some(h_rate) => (q, h_rate - q * rate, [Some(Ball::ZERO), Some(h_rate)]),
            None => (p - self.g, y, [Some(p - self.g - q), None]),
        };
        Guard {
            parabola: [height + reach * cos, y - speed * sin, self.b],
            harmonic: [-reach, Ball::ZERO],
            amplitude: reach.size(),
            omega: self.omega,
            angle,
            free: Free::None,
            quick: -q,
            rate,
            start,
            pace: self.omega.size(),
        }
    }

    /// w = y - q' with y' = F - 1, where the slider's velocity q' decays from `closing`.
    fn slip(&self, [w, closing]: [Ball; 2], angle: Ball, sin: Ball) -> Guard {
        let speed = self.a / self.omega;
        Guard {
            parabola: [w + closing - speed * sin, self.b - Ball::ONE, Ball::ZERO],
            harmonic: [Ball::ZERO, speed],
            amplitude: speed.size(),
            omega: self.omega,
            angle,
            free: Free::None,
            quick: -closing,
            rate: Ball::ONE / self.xi.scaled(2.0),
            start: [Some(w), None],
            pace: self.omega.size(),
        }
    }

    /// f less its reference: b, a forced oscillation, and a free one from f and f' = 2 xi (F - f) +
    /// y.
    fn contact(
        &self,
        [offset, y]: [Ball; 2],
        reference: Ball,
        angle: Ball,
        (sin, cos): (Ball, Ball),
    ) -> Guard {
        let [c, s] = self.steady;
        let level = self.b - reference;
        let pull = self.a * cos + level - offset;
        let f_rate = self.xi.scaled(2.0) * pull + y;
        let x = offset - level - (c * cos + s * sin);
        let rate = f_rate - self.omega * (s * cos - c * sin);
        let (free, quick, quick_rate) = match self.damping {
            Damping::Far { slow, fast } => {
                // x' + slow x = -(fast - slow) (fast part)
                let quick = -((rate + slow * x) / (fast - slow));
                (Free::Slow { start: x - quick, rate: slow }, quick, fast)
            }
            damping => {
                let free = Free::Oscillation { start: [x, rate], damping, xi: self.xi };
                (free, Ball::ZERO, Ball::ZERO)
            }
        };
        Guard {
            parabola: [level, Ball::ZERO, Ball::ZERO],
            harmonic: [c, s],
            amplitude: energy(c, s),
            omega: self.omega,
            angle,
            free,
            quick,
            rate: quick_rate,
            start: [Some(offset), Some(f_rate)],
            pace: self.omega.size().max(1.0).max(
                // Near critical damping both exponentials are in the oscillation.
                if matches!(self.damping, Damping::Above { .. }) { 2.0 } else { 0.0 },
            ),
        }
    }
}
