//! The guard of a flight: h rises to zero at the impact.

use crate::crossing::allowances::MAX_WHOLE_PHASE_RADIANS;
use crate::crossing::certificate::Piece;
use crate::crossing::piecewise::{FreeParts, FreeShape, PieceEnd, PiecewiseCertificate};
use crate::crossing::slow_envelope::{EnvelopePlace, SlowEnvelope};
use crate::crossing::tangents::stays_below;
use crate::crossing::{Corridor, Guarded, Proof, SearchHint, ThresholdEnds, slack};
use crate::flow::constants::Constants;
use crate::flow::forcing::{EntryAngle, Push};
use crate::flow::no_contact::{NoContact, PushedOrders};
use crate::flow::steps::{MAX_PULLING_DECAY_TIMES, Steps, Turning};
use crate::flow::{Jet, Point};
use crate::numeric::remainders::short_decay;
use crate::numeric::roots::first_root;
use crate::numeric::series::Series;
use crate::state::State;
use std::borrow::Borrow;

impl<C: Borrow<Constants<f64>>> NoContact<f64, C> {
    /// An upper bound of the eighth derivative of h from `at` on. Its lower bound is of no use,
    /// because the corridor has no lower threshold.
    #[inline(always)]
    pub(super) fn eighth_most(&self, at: &Point<f64>) -> f64 {
        let Constants { a, omega6, rate8, .. } = *self.constants.borrow();
        a * omega6 + (-at.state.q).max(0.0) * rate8
    }

    fn separates(&self) -> bool {
        self.surface == Some(0.0)
    }

    fn slow_envelope(&self) -> SlowEnvelope {
        let constants = self.constants.borrow();
        SlowEnvelope {
            offset: self.height() + constants.a_over_omega2 * self.angle.cos,
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

    /// Until where h is concave after a separation: as long as the force is negative.
    fn clear_of_the_surface(&self, envelope: &SlowEnvelope, turning: &Turning) -> EnvelopePlace {
        match turning.negative_until(self.angle.radians) {
            Some(angle) => {
                let elapsed = (angle - self.angle.radians) / self.constants.borrow().omega;
                envelope.place(elapsed, (-turning.sin, turning.cos))
            }
            None => envelope.start(),
        }
    }

    /// The guessed time of the next impact just after separation, by h = h2 d^2/2 + h3 d^3/6 + h4
    /// d^4/24.
    #[inline(always)]
    fn short_hop(&self, entry: &Point<f64>) -> Option<f64> {
        let [.., h2, h3] = entry.guard.orders;
        let spring = self.entry.q * self.constants.borrow().rate.powi(4);
        let h4 = entry.force[2] - spring;
        let discriminant = 16.0 * h3 * h3 - 48.0 * h4 * h2;
        let hop = -24.0 * h2 / (4.0 * h3 + discriminant.sqrt());
        (h3 > 0.0 && hop > 0.0 && hop * self.fastest_rate() < 0.7).then_some(hop)
    }

    /// The time at which the gap that a run begins with closes, if it does soon, by its value and
    /// three derivatives. Steps might pass over a short contact, and to find that out costs more
    /// than all of the search.
    pub fn first_closing(&self) -> Option<f64> {
        /// The longest time to a closing, in the shortest time of the harmonic and of the spring.
        const CUBIC_REACH: f64 = 0.7;
        /// The largest last step of Newton's method, beside the time.
        const STEP_TOLERANCE: f64 = 0.1;
        if self.surface.is_some() {
            return None;
        }
        let Constants { omega, rate, .. } = *self.constants.borrow();
        let fastest = if self.entry.q == 0.0 { omega } else { omega.max(rate) };
        let [h, h1, h2, h3] = self.entry().guard.orders;
        let mut time = first_root(h, h1, h2).filter(|it| it * fastest < CUBIC_REACH)?;
        let mut change = 0.0;
        for _ in 0..3 {
            let value = h + time * (h1 + time * (0.5 * h2 + time * (h3 * (1.0 / 6.0))));
            change = value / (h1 + time * (h2 + time * (0.5 * h3)));
            time -= change;
        }
        let closes =
            time > 0.0 && time * fastest < CUBIC_REACH && change.abs() < STEP_TOLERANCE * time;
        closes.then_some(time)
    }
}

impl<C: Borrow<Constants<f64>>> Guarded for NoContact<f64, C> {
    fn corridor(&self) -> Corridor {
        Corridor { low: f64::NEG_INFINITY, high: 0.0 }
    }

    fn entry(&self) -> Point<f64> {
        let Constants { a, b, g, omega, omega2, rate, .. } = *self.constants.borrow();
        let EntryAngle { sin, cos, .. } = self.angle;
        let [u, v, w] = [a * cos, -(a * omega * sin), -(a * omega2 * cos)];
        let State { p, y, q } = self.entry;
        let spring = q * rate;
        let (h, h_rate, largest_term) = match self.surface {
            Some(h_rate) => (0.0, h_rate, 0.0),
            None => ((p - g) - q, y + spring, (p - g).abs() + q.abs()),
        };
        let mut orders = [h, h_rate, (b + u) - spring * rate, v + spring * rate * rate];
        if self.separates() {
            // A separation was decided from derivatives: a positive h'' can only be rounding.
            orders[2] = orders[2].min(0.0);
        }
        Point {
            elapsed: 0.0,
            state: self.entry,
            slider_velocity: -spring,
            drift: 0.0,
            force: [u, v, w],
            guard: Jet { orders, largest_term },
        }
    }

    fn imposed(&self) -> ThresholdEnds {
        ThresholdEnds { left: self.surface.is_some(), left_double: self.separates(), right: false }
    }

    #[inline(always)]
    fn hint(&self, steps: &Steps, left: &Point<f64>, limit: f64) -> SearchHint {
        let first = left.elapsed == 0.0;
        if first
            && self.separates()
            && let Some(hop) = self.short_hop(left)
        {
            return SearchHint::Root(hop);
        }
        let envelope = self.slow_envelope();
        let place = match first {
            true if self.separates() => self.clear_of_the_surface(&envelope, &steps.turning),
            true => envelope.start(),
            false => envelope.place_at(left.elapsed),
        };
        let inside = !first || self.surface.is_some();
        envelope.hint(steps, left.elapsed, (place, inside), limit)
    }

    fn certify(
        &self,
        steps: &Steps,
        left: &Point<f64>,
        right: &Point<f64>,
        ends: ThresholdEnds,
    ) -> Proof {
        let whole = left.elapsed == 0.0 && ends.left_double && ends.right;
        if whole && stays_below(self, steps, right) {
            return Proof::Inside;
        }
        let slack = slack(self, left, right);
        let length = right.elapsed - left.elapsed;
        let Constants { omega, rate, .. } = *self.constants.borrow();
        if length * rate <= MAX_PULLING_DECAY_TIMES && length * omega <= MAX_WHOLE_PHASE_RADIANS {
            let piece = Piece::between(left, right, (0.0, self.eighth_most(left)));
            let verdict = piece.verdict(&self.corridor(), ends, slack);
            if verdict != Proof::Open || length * omega < 0.5 * MAX_WHOLE_PHASE_RADIANS {
                return verdict;
            }
        }
        let end = |at: &Point<f64>| PieceEnd { orders: at.guard.orders, parts: self.parts(at) };
        PiecewiseCertificate::new(&self.shape(), steps).proof(end(left), end(right), ends, slack)
    }

    fn underflow(&self) -> f64 {
        self.constants.borrow().underflow
    }

    fn divide(&self, left: &Point<f64>, right: &Point<f64>) -> f64 {
        let (from, to) = (left.elapsed, right.elapsed);
        self.slow_envelope().division(from, to, MAX_PULLING_DECAY_TIMES).unwrap_or_else(|| {
            Piece::between(left, right, (0.0, 0.0)).worst_place(from, &self.corridor())
        })
    }

    fn series<const N: usize>(&self, at: &Point<f64>) -> Series<f64, N> {
        let Constants { rate, omega2, .. } = *self.constants.borrow();
        let mut higher = PushedOrders::new([omega2, rate], at.state.q, [at.force[0], at.force[1]]);
        Series::new(&at.guard.orders, || higher.step())
    }

    #[inline(always)]
    fn continued<const N: usize>(
        &self,
        at: &Point<f64>,
        step: f64,
        _: &Series<f64, N>,
        (value, slope): (f64, f64),
    ) -> Point<f64> {
        let Constants { b, g, omega, rate, .. } = *self.constants.borrow();
        let Push { force, impulse } = Push::new(omega, [at.force[0], at.force[1]], step);
        let y = at.state.y + (b * step + impulse);
        let q = at.state.q + at.state.q * short_decay(rate * step);
        let spring = q * rate;
        let pull = (b + force[0]) - spring * rate;
        let orders = [value, slope, pull, force[1] + spring * rate * rate];
        Point {
            elapsed: at.elapsed + step,
            state: State { p: (q + g) + value, y, q },
            slider_velocity: -spring,
            drift: 0.0,
            force,
            guard: Jet { orders, ..at.guard },
        }
    }

    fn fastest_rate(&self) -> f64 {
        1.0_f64.max(self.constants.borrow().omega).max(self.constants.borrow().rate)
    }
}

impl<C: Borrow<Constants<f64>>> NoContact<f64, C> {
    fn shape(&self) -> FreeShape {
        let Constants { a, b, omega, omega6, per_omega2, rate, rate8, .. } =
            *self.constants.borrow();
        FreeShape { curvature: b, grain: 0.0, strength: a, omega, omega6, per_omega2, rate, rate8 }
    }

    /// h = (p - g) - q, where p'' = F.
    fn parts(&self, at: &Point<f64>) -> FreeParts {
        let Constants { omega, .. } = *self.constants.borrow();
        FreeParts {
            elapsed: at.elapsed,
            value: at.guard.orders[0] + at.state.q,
            slope: at.state.y,
            bow: at.force[0],
            quarter: at.force[1] / omega,
            lasting: -at.state.q,
            room: slack(self, at, at),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::Flow;
    use crate::parameters::Parameters;

    #[test]
    fn a_gap_that_closes_soon_is_guessed_where_it_closes() {
        let constants =
            Constants::new(&Parameters { xi: 0.25, omega: 0.15, ..Parameters::default() });
        let angle = EntryAngle { radians: 1.0, sin: 1.0_f64.sin(), cos: 1.0_f64.cos() };
        for (p, y, q) in [(0.0, 0.0, 0.0), (-0.5, 1.0, 0.0), (0.1, 0.2, 0.1), (-1.0, 2.0, -0.9)] {
            let flight = NoContact { constants, entry: State { p, y, q }, angle, surface: None };
            let time = flight.first_closing().unwrap_or(f64::NAN);
            // The fourth derivative is left out.
            let [h, slope, ..] = flight.at(time).guard.orders;
            let fourth = constants.a * constants.omega2 + q.abs() * constants.rate.powi(4);
            let room = fourth * time.powi(4) / 24.0 + 1e-3 * slope * time;
            assert!(h.abs() <= room && slope > 0.0, "{p} {y} {q}: {time} {h} {slope}");
        }
        let far = State { p: -100.0, y: 1.0, q: 0.0 };
        let flight = NoContact { constants, entry: far, angle, surface: None };
        assert_eq!(flight.first_closing(), None);
    }
}
