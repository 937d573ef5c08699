//! The guard of a flight: h rises to zero at the impact.

use crate::crossing::certificate::{Corridor, Ends, Piece, Verdict};
use crate::crossing::guarded::{Guarded, Outlook, slack};
use crate::crossing::trend::Trend;
use crate::flow::no_contact::NoContact;
use crate::flow::{Flow, Point};

/// Up to this many decay times the exponential stays in the interpolant: for q >= 0 its eighth
/// derivative helps, and at twelve its third derivative begins to lift the coefficients.
const DECAY_TIMES: f64 = 10.0;

impl NoContact<f64> {
    fn separates(&self) -> bool {
        self.surface == Some(0.0)
    }

    fn trend(&self) -> Trend {
        let constants = &self.constants;
        Trend {
            offset: self.entry.p - constants.g + constants.a_over_omega2 * self.angle.cos,
            slope: self.entry.y - constants.a_over_omega * self.angle.sin,
            curvature: constants.b,
            amplitude: constants.a_over_omega2,
            sin: self.angle.sin,
            cos: self.angle.cos,
            exponential: self.entry.q,
            rate: constants.rate,
            omega: constants.omega,
        }
    }

    /// Just after separation h = h2 d^2/2 + h3 d^3/6 + h4 d^4/24.
    fn short_hop(&self, entry: &Point<f64>) -> Option<f64> {
        let [.., h2, h3] = entry.guard.orders;
        let spring = self.entry.q * self.constants.rate.powi(4);
        let h4 = entry.force[2] - spring;
        let discriminant = 16.0 * h3 * h3 - 48.0 * h4 * h2;
        let hop = -24.0 * h2 / (4.0 * h3 + discriminant.sqrt());
        (h3 > 0.0 && hop > 0.0 && hop * self.fastest_rate() < 0.7).then_some(hop)
    }

    /// Value and derivatives of p - g, as h + q: the guard has digits that a large p has not.
    fn height(&self, at: &Point<f64>) -> [f64; 4] {
        [at.guard.orders[0] + at.state.q, at.state.y, at.force[0], at.force[1]]
    }
}

impl Guarded for NoContact<f64> {
    fn corridor(&self) -> Corridor {
        Corridor { low: f64::NEG_INFINITY, high: 0.0 }
    }

    fn entry(&self) -> Point<f64> {
        let mut point = self.at(0.0);
        if let Some(h_rate) = self.surface {
            point.guard.orders[0] = 0.0;
            point.guard.orders[1] = h_rate;
        }
        if self.separates() {
            // A separation was decided from derivatives: a positive h'' can only be rounding.
            point.guard.orders[2] = point.guard.orders[2].min(0.0);
        }
        point
    }

    fn imposed(&self) -> Ends {
        Ends { left: self.surface.is_some(), left_double: self.separates(), right: false }
    }

    fn outlook(&self, left: &Point<f64>, limit: f64) -> Outlook {
        let first = left.elapsed == 0.0;
        if first
            && self.separates()
            && let Some(hop) = self.short_hop(left)
        {
            return Outlook::Root(hop);
        }
        self.trend().outlook(left.elapsed, !first || self.surface.is_some(), limit)
    }

    fn certify(&self, left: &Point<f64>, right: &Point<f64>, ends: Ends) -> Verdict {
        let corridor = self.corridor();
        let slack = slack(left, right);
        let length = right.elapsed - left.elapsed;
        let constants = &self.constants;
        let swing = constants.a * constants.omega.powi(6);
        let decay_times = length * constants.rate;
        let whole = if decay_times <= DECAY_TIMES {
            let lift = (-left.state.q).max(0.0) * constants.rate.powi(8);
            let piece = Piece {
                left: left.guard.orders,
                right: right.guard.orders,
                length,
                eighth: (f64::NEG_INFINITY, swing + lift),
            };
            piece.verdict(&corridor, ends, slack)
        } else {
            self.flattened(left, right, swing).verdict(&corridor, ends.loose_left(), slack)
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

impl NoContact<f64> {
    /// -q replaced by a straight line above it: its tangent at the right end where it is concave
    /// (q >= 0), else its chord.
    fn flattened(&self, left: &Point<f64>, right: &Point<f64>, swing: f64) -> Piece {
        let length = right.elapsed - left.elapsed;
        let (q_left, q_right) = (left.state.q, right.state.q);
        let slope =
            if q_left >= 0.0 { q_right * self.constants.rate } else { (q_left - q_right) / length };
        let with_line = |at: &Point<f64>, value: f64| {
            let [p, y, force, force_rate] = self.height(at);
            [p + value, y + slope, force, force_rate]
        };
        Piece {
            left: with_line(left, -q_right - slope * length),
            right: with_line(right, -q_right),
            length,
            eighth: (f64::NEG_INFINITY, swing),
        }
    }

    /// The harmonic replaced by its amplitude, the exponential as above: a parabola, exactly.
    fn slow(&self, left: &Point<f64>, right: &Point<f64>) -> Piece {
        let mut piece = self.flattened(left, right, 0.0);
        let constants = &self.constants;
        let omega2 = constants.omega * constants.omega;
        for (orders, at) in [(&mut piece.left, left), (&mut piece.right, right)] {
            orders[0] += (at.force[0] - constants.b) / omega2 + constants.a_over_omega2;
            orders[1] += at.force[1] / omega2;
            orders[2] = constants.b;
            orders[3] = 0.0;
        }
        piece
    }
}
