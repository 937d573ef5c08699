//! The guards of a contact: the trial force rises to 1 (progression) or falls to 0 (separation).

use crate::constants::Constants;
use crate::crossing::certificate::{Corridor, Ends, Piece, Verdict};
use crate::crossing::guarded::{Guarded, Outlook, slack};
use crate::flow::contact::Contact;
use crate::flow::damped::Damping;
use crate::flow::{Flow, Point};
use crate::remainders::decay;

/// Contact's trial force split into what is forced for ever and what dies out.
#[derive(Clone, Copy, Debug)]
pub struct Split {
    /// Free part and its first three derivatives.
    free: [f64; 4],
    /// Amplitude of the forced part.
    amplitude: f64,
}

impl Contact<f64> {
    fn split(&self, at: &Point<f64>) -> Split {
        let constants = &self.constants;
        let forced = constants.steady.orders([at.force[0] - constants.b, at.force[1], at.force[2]]);
        let [f, f1, f2, f3] = at.guard.orders;
        let level = f + (self.reference - constants.b);
        let free = [level - forced[0], f1 - forced[1], f2 - forced[2], f3 - forced[3]];
        Split { free, amplitude: constants.steady.amplitude }
    }

    /// A bound of the eighth derivative of the free part from `at` on.
    ///
    /// x'' + 2 xi x' + x = 0 holds for every derivative of x as well, and x^2 + x'^2 never grows.
    fn free_eighth(&self, at: &Point<f64>, split: &Split) -> f64 {
        let two_xi = self.constants.two_xi;
        let (mut x, mut rate) = (split.free[0], split.free[1]);
        for _ in 0..8 {
            (x, rate) = (rate, -(two_xi * rate + x));
        }
        let by_energy = x.hypot(rate);
        if let Damping::Over { fast, slow, .. } = self.constants.damping {
            // Eight derivatives of a stiff oscillation are rounding once its fast part has died out.
            let quick = self.fast_amplitude(split) * decay(fast * at.elapsed).exp;
            let lasting = split.free[0].abs() + quick;
            return by_energy.min(quick * fast.powi(8) + lasting * slow.powi(8));
        }
        by_energy
    }

    /// A bound of the fast exponential's size at entry, over-damped: |x' + slow x|/spread, where
    /// |x| <= |f| + |b| + A and |x'| <= 2 xi (a + |b| + |f|) + |y| + omega A with A the forced
    /// amplitude, 2 xi/spread < 2 and slow < 1 < spread (from xi^2 - 1 > 1/2).
    fn fast_amplitude(&self, split: &Split) -> f64 {
        let constants = &self.constants;
        let force = constants.a + constants.b.abs() + self.offset.abs() + self.reference;
        4.0 * force + self.entry.y.abs() + (1.0 + constants.omega) * split.amplitude
    }

    /// A bound of |f''| from `at` on: the free part's by its energy, the forced part's amplitude.
    pub(crate) fn second_derivative_bound(&self, at: &Point<f64>) -> f64 {
        let split = self.split(at);
        let [.., x2, x3] = split.free;
        x2.hypot(x3) + split.amplitude * self.constants.omega * self.constants.omega
    }

    /// Whether f can never again leave [0, 1] by more than rounding: amplitude and energy norm of the
    /// free part fit inside. At rest on a threshold, with no force, they fit exactly.
    fn rests(&self, split: &Split) -> bool {
        let b = self.constants.b;
        let reach = split.amplitude + split.free[0].hypot(split.free[1]);
        let room = 4.0 * f64::EPSILON * (b.abs() + reach);
        b + reach <= 1.0 + room && b - reach >= -room
    }

    /// A time for which f certainly stays inside, by one of two slow changes.
    ///
    /// With x = f - b the equation x'' + 2 xi x' + x = a cos(..) - 2 xi a omega sin(..) lets the
    /// energy norm of (x, x') grow no faster than the amplitude of its right-hand side: that
    /// carries over many oscillations where the forcing is weak, resonant or not. And the steady
    /// part moves no faster than its amplitude times omega, around which the free part keeps
    /// within its own energy norm: that carries where the forcing is slow.
    fn calm(&self, left: &Point<f64>, split: &Split) -> f64 {
        const ROOM: f64 = 1e-12;
        let Constants { a, b, two_xi, omega, .. } = self.constants;
        let f = left.guard.orders[0] + self.reference;
        let push = a * 1.0_f64.hypot(two_xi * omega);
        let weak = (b.min(1.0 - b) - (f - b).hypot(left.guard.orders[1]) - ROOM) / push;
        let free = split.free[0].hypot(split.free[1]);
        let steady = f - split.free[0];
        let slow = (steady.min(1.0 - steady) - free - ROOM) / (split.amplitude * omega);
        weak.max(slow)
    }

    /// The first place where a cubic from `left` leaves the corridor, if that is soon.
    fn soon(&self, left: &Point<f64>) -> Option<f64> {
        const SOON: f64 = 0.4;
        let [f, f1, f2, f3] = left.guard.orders;
        let horizon = SOON / self.fastest_rate();
        let cubic = |d: f64| f + d * (f1 + d * (0.5 * f2 + d * f3 / 6.0));
        let corridor = self.corridor();
        let outside = |d: &f64| corridor.excess(cubic(*d)) >= 0.0;
        let mut right = (1..=4).map(|k| horizon * f64::from(k) / 4.0).find(outside)?;
        let mut left_end = (right - 0.25 * horizon).max(0.0);
        for _ in 0..8 {
            let middle = 0.5 * (left_end + right);
            if outside(&middle) { right = middle } else { left_end = middle }
        }
        // Where the interval is short the last step is a secant's, to the threshold passed at its right.
        let beyond = |value: f64| {
            if cubic(right) >= corridor.high { value - corridor.high } else { corridor.low - value }
        };
        let (near, far) = (beyond(cubic(left_end)), beyond(cubic(right)));
        let weight = if far > near { (-near / (far - near)).clamp(0.0, 1.0) } else { 1.0 };
        Some(left.elapsed + left_end + weight * (right - left_end))
    }

    /// Steps through the free and the forced part by rotation, cheaply, until f leaves the corridor.
    fn swing(&self, left: &Point<f64>, split: &Split) -> Result<f64, f64> {
        const STEPS: usize = 24;
        let Constants { b, two_xi, omega, damping, steady, .. } = self.constants;
        let corridor = self.corridor();
        let step = std::f64::consts::PI / 16.0 / self.pace(left);
        let free = damping.at(step);
        let (s, c) = (free.s, 1.0 + free.c_minus_1);
        let (sin, cos) = libm::sincos(step * omega);
        let (mut x, mut rate) = (split.free[0], split.free[1]);
        let (mut harmonic, mut quadrature) = (left.force[0] - b, left.force[1] / omega);
        let level = b - self.reference;
        let mut last = left.guard.orders[0];
        for k in 1..=STEPS {
            (x, rate) = (x * c + rate * s, rate * (c - two_xi * s) - x * s);
            (harmonic, quadrature) =
                (harmonic * cos + quadrature * sin, quadrature * cos - harmonic * sin);
            let [forced, forced_rate, ..] =
                steady.orders([harmonic, omega * quadrature, -(omega * omega * harmonic)]);
            let f = level + x + forced;
            if corridor.excess(f) >= 0.0 {
                let threshold = if f >= corridor.high { corridor.high } else { corridor.low };
                let rise = (rate + forced_rate) * step;
                return Ok(left.elapsed + step * (k as f64 - back(last, f, rise, threshold)));
            }
            last = f;
        }
        Err(left.elapsed + step * STEPS as f64)
    }

    /// How fast the trial force changes from `left` on: at most as the free oscillation, about which a
    /// fast forcing only ripples; slower for strong damping once its fast part has died out.
    fn pace(&self, left: &Point<f64>) -> f64 {
        const DEAD: f64 = 40.0; // exp(-40) is below the rounding of what it is added to
        match self.constants.damping {
            Damping::Over { fast, slow, .. } if fast * left.elapsed > DEAD => {
                slow.max(self.constants.omega).min(1.0)
            }
            _ => 1.0,
        }
    }
}

/// How far before its right end, in steps, a parabola through both values with the right slope
/// meets the threshold.
fn back(left: f64, right: f64, slope: f64, threshold: f64) -> f64 {
    let over = right - threshold;
    let bend = left - right + slope;
    let mut t = over / (right - left);
    for _ in 0..3 {
        t -= (over - slope * t + bend * t * t) / (2.0 * bend * t - slope);
    }
    if t.is_finite() { t.clamp(0.0, 1.0) } else { 0.5 }
}

impl Guarded for Contact<f64> {
    fn corridor(&self) -> Corridor {
        Corridor { low: -self.reference, high: 1.0 - self.reference }
    }

    fn entry(&self) -> Point<f64> {
        self.at(0.0)
    }

    fn imposed(&self) -> Ends {
        Ends { left: self.offset == 0.0, left_double: false, right: false }
    }

    fn outlook(&self, left: &Point<f64>, limit: f64) -> Outlook {
        if let Some(time) = self.soon(left) {
            return Outlook::Root(time);
        }
        let split = self.split(left);
        if self.rests(&split) {
            return Outlook::ClearFrom(left.elapsed);
        }
        let calm = self.calm(left, &split);
        if calm > 8.0 {
            return Outlook::ClearUntil(left.elapsed + calm);
        }
        match self.swing(left, &split) {
            Ok(time) => Outlook::Root(time),
            Err(time) => Outlook::Onward(time.min(limit)),
        }
    }

    fn certify(&self, left: &Point<f64>, right: &Point<f64>, ends: Ends) -> Verdict {
        let corridor = self.corridor();
        let slack = slack(left, right);
        let length = right.elapsed - left.elapsed;
        let split = self.split(left);
        let free = self.free_eighth(left, &split);
        let eighth = free + split.amplitude * self.constants.omega.powi(8);
        let whole = Piece {
            left: left.guard.orders,
            right: right.guard.orders,
            length,
            eighth: (-eighth, eighth),
        };
        let verdict = whole.verdict(&corridor, ends, slack);
        if verdict != Verdict::Open || length * self.constants.omega < 2.0 {
            return verdict;
        }
        // Fast forcing: the free part alone, in a corridor narrowed by the forced amplitude.
        let b = self.constants.b - self.reference;
        let slow = |split: &Split| {
            let [x, x1, x2, x3] = split.free;
            [x + b, x1, x2, x3]
        };
        let slow = Piece {
            left: slow(&split),
            right: slow(&self.split(right)),
            length,
            eighth: (-free, free),
        };
        slow.verdict(&corridor.narrowed(split.amplitude), Ends::FREE, slack)
    }

    fn divide(&self, left: &Point<f64>, right: &Point<f64>) -> f64 {
        let piece = Piece {
            left: left.guard.orders,
            right: right.guard.orders,
            length: right.elapsed - left.elapsed,
            eighth: (0.0, 0.0),
        };
        if piece.length * self.fastest_rate() > 4.0 {
            return left.elapsed + 0.5 * piece.length;
        }
        piece.worst_place(left.elapsed, &self.corridor())
    }

    fn fastest_rate(&self) -> f64 {
        1.0_f64.max(self.constants.omega).max(self.constants.two_xi)
    }
}
