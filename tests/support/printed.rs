//! Equations (14) to (20) of the paper exactly as printed, in their own symbols.

use percuss::{Parameters, State};

/// A phase that begins at tau0 in (p0, y0, q0).
#[derive(Clone, Copy, Debug)]
pub struct Begun {
    pub parameters: Parameters,
    pub tau0: f64,
    pub state: State,
}

/// The constants of Eq. (15): C1 by Eq. (16), C2 by Eq. (17), and alpha to delta, which follow
/// them, with what they are taken from.
#[derive(Clone, Copy, Debug)]
pub struct Phases {
    pub c1: f64,
    pub c2: f64,
    pub alpha: f64,
    /// Numerator and denominator of tan beta and tan delta.
    pub beta: (f64, f64),
    pub delta: (f64, f64),
}

impl Begun {
    fn angles(&self, tau: f64) -> (f64, f64) {
        let Parameters { omega, phi, .. } = self.parameters;
        (omega * tau + phi, omega * self.tau0 + phi)
    }

    /// (cos(omega tau + phi) - cos(omega tau0 + phi) + omega (tau - tau0) sin(omega tau0 + phi))
    fn bracket(&self, tau: f64) -> f64 {
        let (now, then) = self.angles(tau);
        now.cos() - then.cos() + self.parameters.omega * (tau - self.tau0) * then.sin()
    }

    fn impulse(&self, tau: f64) -> f64 {
        let (now, then) = self.angles(tau);
        self.parameters.a / self.parameters.omega * (now.sin() - then.sin())
    }

    pub fn equation_14(&self, tau: f64) -> State {
        let Self { parameters: Parameters { a, b, xi, omega, .. }, tau0, state } = *self;
        let d = tau - tau0;
        State {
            p: state.p + state.y * d + b / 2.0 * d * d - a / (omega * omega) * self.bracket(tau),
            y: state.y + b * d + self.impulse(tau),
            q: state.q * (-d / (2.0 * xi)).exp(),
        }
    }

    fn resonance(&self) -> f64 {
        let Parameters { xi, omega, .. } = self.parameters;
        ((1.0 - omega * omega).powi(2) + 4.0 * xi * xi * omega * omega).sqrt()
    }

    pub fn phases(&self) -> Phases {
        let Self { parameters, state: State { p: p0, y: y0, .. }, tau0 } = *self;
        let Parameters { a, b, xi, omega, g, .. } = parameters;
        let (_, then) = self.angles(tau0);
        let alpha = ((1.0 - omega * omega) / (2.0 * xi * omega)).atan();
        let gamma = (omega / xi).atan();
        let nu = (1.0 - xi * xi).sqrt();
        let c1 = p0 - b - g - a / self.resonance() * (then + alpha).sin();
        let c2 = (y0 + xi * (p0 - b - g)
            - a * (xi * xi + omega * omega).sqrt() / self.resonance()
                * (then + alpha + gamma).sin())
            / nu;
        Phases { c1, c2, alpha, beta: (c1, c2), delta: (-xi * c1 + nu * c2, -nu * c1 - xi * c2) }
    }

    /// Eq. (15) with beta and delta taken from their fractions by `angle`.
    pub fn equation_15(&self, tau: f64, angle: fn((f64, f64)) -> f64) -> State {
        let Parameters { a, b, xi, omega, g, .. } = self.parameters;
        let Phases { c1, c2, alpha, beta, delta } = self.phases();
        let (now, _) = self.angles(tau);
        let d = tau - self.tau0;
        let free = (-xi * d).exp() * (c1 * c1 + c2 * c2).sqrt();
        let turned = (1.0 - xi * xi).sqrt() * d;
        let steady = a / self.resonance();
        let q = b + free * (turned + angle(beta)).sin() + steady * (now + alpha).sin();
        let y = free * (turned + angle(delta)).sin() + steady * omega * (now + alpha).cos();
        State { p: q + g, y, q }
    }

    pub fn equation_18(&self, tau: f64) -> State {
        let Self { parameters: Parameters { b, xi, g, .. }, tau0, state } = *self;
        let d = tau - tau0;
        let decay = (-d / (2.0 * xi)).exp();
        State {
            p: g + 1.0 + (state.p - g - 1.0) * decay,
            y: state.y + (b - 1.0) * d + self.impulse(tau),
            q: (state.q - 1.0) * decay + 1.0,
        }
    }

    /// Eq. (20) less v0; `sign` is the one before the exponential, printed as +.
    pub fn equation_20(&self, tau: f64, sign: f64) -> f64 {
        let Self { parameters: Parameters { a, b, xi, omega, g, .. }, tau0, state } = *self;
        let d = tau - tau0;
        let lag = state.p - g - 1.0;
        lag + sign * lag * (-d / (2.0 * xi)).exp() + state.y * d + (b - 1.0) / 2.0 * d * d
            - a / (omega * omega) * self.bracket(tau)
    }
}

/// As printed: the arctangent of the fraction.
pub fn arctan((numerator, denominator): (f64, f64)) -> f64 {
    (numerator / denominator).atan()
}

/// As it should be: with the quadrant of numerator and denominator.
pub fn arctan2((numerator, denominator): (f64, f64)) -> f64 {
    numerator.atan2(denominator)
}
