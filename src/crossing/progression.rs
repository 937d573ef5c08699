//! The guard of a progression: the drift velocity w falls to zero when the slider's bottom stops.

use crate::crossing::certificate::{Corridor, Ends, Piece, Verdict};
use crate::crossing::guarded::{Guarded, Outlook, slack};
use crate::crossing::trend::Trend;
use crate::flow::progression::Progression;
use crate::flow::{Flow, Point};

/// Up to this many decay times the exponential stays in the interpolant: its eighth derivative then
/// costs 0.02 of its own size.
const DECAY_TIMES: f64 = 4.0;

impl Progression<f64> {
    /// The trend of -w, which rises to zero.
    fn trend(&self) -> Trend {
        let constants = &self.constants;
        Trend {
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

    /// Just after a switch from contact w = w1 d + w2 d^2/2 + w3 d^3/6.
    fn short_slip(&self, entry: &Point<f64>) -> Option<f64> {
        let [_, w1, w2, w3] = entry.guard.orders;
        let discriminant = 9.0 * w2 * w2 - 24.0 * w1 * w3;
        let slip = -12.0 * w1 / (3.0 * w2 - discriminant.sqrt());
        (self.drift_rate == 0.0 && slip > 0.0 && slip * self.fastest_rate() < 0.7).then_some(slip)
    }
}

impl Guarded for Progression<f64> {
    fn corridor(&self) -> Corridor {
        Corridor { low: 0.0, high: f64::INFINITY }
    }

    fn entry(&self) -> Point<f64> {
        self.at(0.0)
    }

    fn imposed(&self) -> Ends {
        Ends { left: self.drift_rate == 0.0, left_double: false, right: false }
    }

    fn outlook(&self, left: &Point<f64>, limit: f64) -> Outlook {
        if left.elapsed == 0.0
            && let Some(slip) = self.short_slip(left)
        {
            return Outlook::Root(slip);
        }
        self.trend().outlook(left.elapsed, true, limit)
    }

    fn certify(&self, left: &Point<f64>, right: &Point<f64>, ends: Ends) -> Verdict {
        let corridor = self.corridor();
        let slack = slack(left, right);
        let length = right.elapsed - left.elapsed;
        let constants = &self.constants;
        let swing = constants.a * constants.omega.powi(7);
        let whole = if length * constants.rate <= DECAY_TIMES {
            let drop = left.slider_velocity.max(0.0) * constants.rate.powi(8);
            let piece = Piece {
                left: left.guard.orders,
                right: right.guard.orders,
                length,
                eighth: (-swing - drop, f64::INFINITY),
            };
            piece.verdict(&corridor, ends, slack)
        } else {
            self.flattened(left, right, swing).verdict(&corridor, ends, slack)
        };
        if whole != Verdict::Open || length * constants.omega < 4.0 {
            return whole;
        }
        self.slow(left, right).verdict(&corridor, Ends::FREE, slack)
    }

    fn divide(&self, left: &Point<f64>, right: &Point<f64>) -> f64 {
        let (from, to) = (left.elapsed, right.elapsed);
        self.trend().division(from, to, DECAY_TIMES).unwrap_or_else(|| {
            let piece = Piece {
                left: left.guard.orders,
                right: right.guard.orders,
                length: to - from,
                eighth: (0.0, 0.0),
            };
            piece.worst_place(from, &self.corridor())
        })
    }

    fn fastest_rate(&self) -> f64 {
        1.0_f64.max(self.constants.omega).max(self.constants.rate)
    }
}

impl Progression<f64> {
    /// w = y - q' with q' replaced by a straight line above it: its chord where it is convex
    /// (q <= 1), else its tangent at the right end.
    fn flattened(&self, left: &Point<f64>, right: &Point<f64>, swing: f64) -> Piece {
        let length = right.elapsed - left.elapsed;
        let (lag_left, lag_right) = (left.slider_velocity, right.slider_velocity);
        let slope = if lag_left >= 0.0 {
            (lag_right - lag_left) / length
        } else {
            -lag_right * self.constants.rate
        };
        let with_line = |at: &Point<f64>, line: f64| {
            [at.state.y - line, at.force[0] - 1.0 - slope, at.force[1], at.force[2]]
        };
        let mut piece = Piece {
            left: with_line(left, lag_right - slope * length),
            right: with_line(right, lag_right),
            length,
            eighth: (-swing, f64::INFINITY),
        };
        // The chord meets the guard at both ends: keep the better of the two roundings.
        piece.right[0] = right.guard.orders[0];
        if lag_left >= 0.0 {
            piece.left[0] = left.guard.orders[0];
        }
        piece
    }

    /// The harmonic replaced by its amplitude, the exponential as above: a straight line, exactly.
    fn slow(&self, left: &Point<f64>, right: &Point<f64>) -> Piece {
        let mut piece = self.flattened(left, right, 0.0);
        let constants = &self.constants;
        let omega2 = constants.omega * constants.omega;
        for (orders, at) in [(&mut piece.left, left), (&mut piece.right, right)] {
            orders[0] += at.force[1] / omega2 - constants.a_over_omega;
            orders[1] -= at.force[0] - constants.b;
            orders[2] = 0.0;
            orders[3] = 0.0;
        }
        piece
    }
}
