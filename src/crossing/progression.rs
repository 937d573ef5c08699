//! The guard of a progression: the drift velocity w falls to zero when the slider's bottom stops.

use crate::crossing::allowances::MAX_WHOLE_PHASE_RADIANS;
use crate::crossing::certificate::Piece;
use crate::crossing::piecewise::{FreeParts, FreeShape, PieceEnd, PiecewiseCertificate};
use crate::crossing::slow_envelope::SlowEnvelope;
use crate::crossing::{Corridor, Guarded, Proof, SearchHint, ThresholdEnds, slack};
use crate::flow::constants::Constants;
use crate::flow::forcing::{EntryAngle, Push};
use crate::flow::progression::Progression;
use crate::flow::steps::{MAX_PUSHING_DECAY_TIMES, Steps};
use crate::flow::{Jet, Point};
use crate::numeric::real::Real;
use crate::numeric::remainders::short_decay;
use crate::numeric::series::Series;
use crate::state::State;
use std::borrow::Borrow;

impl<C: Borrow<Constants<f64>>> Progression<f64, C> {
    /// The envelope of -w, which rises to zero.
    fn slow_envelope(&self) -> SlowEnvelope {
        let constants = self.constants.borrow();
        SlowEnvelope {
            offset: constants.a_over_omega * self.angle.sin - self.entry.y,
            slope: 1.0 - constants.b,
            curvature: 0.0,
            amplitude: constants.a_over_omega,
            // -(a/omega) sin(x) = -(a/omega) cos(x - pi/2)
            sin: -self.angle.cos,
            cos: self.angle.sin,
            exponential: -self.closing,
            rate: constants.rate,
            omega: constants.omega,
        }
    }

    /// The guessed time at which a progression ends that has just begun, by its drift velocity w =
    /// w1 d + w2 d^2/2 + w3 d^3/6.
    #[inline(always)]
    fn short_slip(&self, entry: &Point<f64>) -> Option<f64> {
        let [_, w1, w2, w3] = entry.guard.orders;
        let discriminant = 9.0 * w2 * w2 - 24.0 * w1 * w3;
        let slip = -12.0 * w1 / (3.0 * w2 - discriminant.sqrt());
        (self.drift_rate == 0.0 && slip > 0.0 && slip * self.fastest_rate() < 0.7).then_some(slip)
    }
}

impl<C: Borrow<Constants<f64>>> Guarded for Progression<f64, C> {
    fn corridor(&self) -> Corridor {
        Corridor { low: 0.0, high: f64::INFINITY }
    }

    fn entry(&self) -> Point<f64> {
        let Constants { a, b, omega, omega2, rate, .. } = *self.constants.borrow();
        let EntryAngle { sin, cos, .. } = self.angle;
        let [u, v, w] = [a * cos, -(a * omega * sin), -(a * omega2 * cos)];
        let lag_rate = self.closing * rate;
        let orders = [
            self.drift_rate,
            (u + (b - 1.0)) + lag_rate,
            v - lag_rate * rate,
            w + lag_rate * rate * rate,
        ];
        Point {
            elapsed: 0.0,
            state: self.entry,
            slider_velocity: self.closing,
            drift: 0.0,
            force: [u, v, w],
            guard: Jet { orders, largest_term: self.drift_rate.abs() },
        }
    }

    fn imposed(&self) -> ThresholdEnds {
        ThresholdEnds { left: self.drift_rate == 0.0, left_double: false, right: false }
    }

    #[inline(always)]
    fn hint(&self, steps: &Steps, left: &Point<f64>, limit: f64) -> SearchHint {
        if left.elapsed == 0.0
            && let Some(slip) = self.short_slip(left)
        {
            return SearchHint::Root(slip);
        }
        let envelope = self.slow_envelope();
        let first = left.elapsed == 0.0;
        let place = if first { envelope.start() } else { envelope.place_at(left.elapsed) };
        envelope.hint(steps, left.elapsed, (place, true), limit)
    }

    fn certify(
        &self,
        steps: &Steps,
        left: &Point<f64>,
        right: &Point<f64>,
        ends: ThresholdEnds,
    ) -> Proof {
        if left.elapsed == 0.0 && ends.right && self.stops_once(right) {
            return Proof::Inside;
        }
        let slack = slack(self, left, right);
        let length = right.elapsed - left.elapsed;
        let Constants { omega, rate, .. } = *self.constants.borrow();
        if length * rate <= MAX_PUSHING_DECAY_TIMES && length * omega <= MAX_WHOLE_PHASE_RADIANS {
            let piece = Piece::between(left, right, (self.eighth_least(left), 0.0));
            let verdict = piece.verdict(&self.corridor(), ends, slack);
            if verdict != Proof::Open || length * omega < 0.5 * MAX_WHOLE_PHASE_RADIANS {
                return verdict;
            }
        }
        let end = |at: &Point<f64>| PieceEnd {
            orders: at.guard.orders.map(|order| -order),
            parts: self.parts(at),
        };
        PiecewiseCertificate::new(&self.shape(), steps).proof(end(left), end(right), ends, slack)
    }

    fn underflow(&self) -> f64 {
        self.constants.borrow().underflow
    }

    fn divide(&self, left: &Point<f64>, right: &Point<f64>) -> f64 {
        let (from, to) = (left.elapsed, right.elapsed);
        self.slow_envelope().division(from, to, MAX_PUSHING_DECAY_TIMES).unwrap_or_else(|| {
            Piece::between(left, right, (0.0, 0.0)).worst_place(from, &self.corridor())
        })
    }

    fn series<const N: usize>(&self, at: &Point<f64>) -> Series<f64, N> {
        // By `PushedOrders`, as in lanes, an event takes 0.9 % more instructions.
        let Constants { rate, omega, .. } = *self.constants.borrow();
        let mut lag = at.slider_velocity * (rate * rate * rate);
        let [_, mut force, mut next] = at.force;
        Series::new(&at.guard.orders, || {
            lag *= -rate;
            (force, next) = (next, -(omega * omega * force));
            next + lag
        })
    }

    #[inline(always)]
    fn continued<const N: usize>(
        &self,
        at: &Point<f64>,
        step: f64,
        series: &Series<f64, N>,
        (value, slope): (f64, f64),
    ) -> Point<f64> {
        let Constants { g, omega, rate, two_xi, .. } = *self.constants.borrow();
        let lag = at.slider_velocity + at.slider_velocity * short_decay(rate * step);
        let q = 1.0 - two_xi * lag;
        let force = Push::new(omega, [at.force[0], at.force[1]], step).force;
        let turn = lag * rate * rate;
        let orders = [value, slope, force[1] - turn, force[2] + turn * rate];
        Point {
            elapsed: at.elapsed + step,
            state: State { p: q + g, y: lag + value, q },
            slider_velocity: lag,
            drift: at.drift + series.integral(step),
            force,
            guard: Jet { orders, ..at.guard },
        }
    }

    fn fastest_rate(&self) -> f64 {
        1.0_f64.max(self.constants.borrow().omega).max(self.constants.borrow().rate)
    }
}

/// Tries to prove that the drift velocity w, not negative at the start, has no root before the one
/// given; false means that nothing is proved. The arguments are a, b, omega and 1/(2 xi); the
/// velocity of the slider's top and w at the start; and that velocity at the root.
///
/// w' = F - 1 + lag rate, w'' = F' - lag rate^2, and the slider's lag only decays. With c = 1 - a -
/// b and a omega < c rate, w is concave as long as lag rate >= c and falls from then on; it falls
/// all the time if lag rate < c at the start; and it is concave up to a root at which a omega < lag
/// rate^2.
#[inline(always)]
pub fn stops_once<T: Real>([a, b, omega, rate]: [T; 4], [closing, w]: [T; 2], lag: T) -> T::Mask {
    /// The inequalities round a few times.
    const ROUNDING_FACTOR: f64 = 1.0 + 64.0 * f64::EPSILON;
    let room = a.broadcast(ROUNDING_FACTOR);
    let zero = a.broadcast(0.0);
    let steepest = a * omega * room;
    let fall = (a.broadcast(1.0) - b) - a * room;
    let rises_once = steepest.less(fall * rate);
    let falls = (closing.larger(zero) * rate * room).less(fall);
    let bends = steepest.less(lag * rate * rate);
    !w.less(zero) & (rises_once | falls | bends)
}

impl<C: Borrow<Constants<f64>>> Progression<f64, C> {
    /// A lower bound of the eighth derivative of w from `at` on. Its upper bound is of no use,
    /// because the corridor has no upper threshold.
    #[inline(always)]
    pub(super) fn eighth_least(&self, at: &Point<f64>) -> f64 {
        let Constants { a, omega, omega6, rate8, .. } = *self.constants.borrow();
        -a * omega * omega6 - at.slider_velocity.max(0.0) * rate8
    }

    fn stops_once(&self, root: &Point<f64>) -> bool {
        let Constants { a, b, omega, rate, .. } = *self.constants.borrow();
        let begin = [self.closing, self.drift_rate];
        stops_once([a, b, omega, rate], begin, root.slider_velocity)
    }

    fn shape(&self) -> FreeShape {
        let Constants { a, b, omega, omega6, per_omega2, rate, rate8, .. } =
            *self.constants.borrow();
        // The slope is 1 - b less the harmonic force.
        let (grain, strength) = ((1.0 - b).abs() + a, a * omega);
        FreeShape { curvature: 0.0, grain, strength, omega, omega6, per_omega2, rate, rate8 }
    }

    /// -w = -y + q', where y' = F - 1.
    fn parts(&self, at: &Point<f64>) -> FreeParts {
        let Constants { b, omega, .. } = *self.constants.borrow();
        FreeParts {
            elapsed: at.elapsed,
            value: -at.state.y,
            slope: (1.0 - b) - at.force[0],
            bow: -at.force[1],
            quarter: omega * at.force[0],
            lasting: at.slider_velocity,
            room: slack(self, at, at),
        }
    }
}
