//! The first crossing by plain one-sided steps, as a reference for tests.
//!
//! If a guard's excess e is negative and M bounds e'' from above from here on, no crossing lies
//! closer than the smallest r > 0 with e + e' r + M r^2/2 = 0. Stepping by r never passes a
//! crossing, needs no grid and no guess, and converges quadratically on a transversal crossing. It
//! takes about nine evaluations a switch where [`crate::crossing::search`] mostly takes one. It
//! shares with that search the closed forms, the corridor and the rounding slack, but no guess, no
//! root finder and no certificate.

use crate::crossing::candidate::evaluate;
use crate::crossing::{Corridor, Counters, Crossing, Guarded, Root, Side, slack};
use crate::flow::Point;
use crate::flow::constants::Constants;
use crate::flow::contact::Contact;
use crate::flow::no_contact::NoContact;
use crate::flow::progression::Progression;
use crate::numeric::roots::safe_step;
use crate::numeric::two_word::TwoWord;
use std::borrow::Borrow;

/// A guard with one-sided bounds of its curvature.
pub trait Bending: Guarded {
    /// An upper bound of the excess's second derivative from `at` on.
    fn bend(&self, at: &Point<f64>) -> f64;

    /// A time after the start in which nothing can happen although the guard starts with a double
    /// zero; zero where it does not.
    fn head_start(&self, entry: &Point<f64>) -> f64;
}

impl<C: Borrow<Constants<f64>>> Bending for NoContact<f64, C> {
    fn bend(&self, at: &Point<f64>) -> f64 {
        let constants = self.constants.borrow();
        let spring = (-at.state.q).max(0.0) * constants.rate * constants.rate;
        (constants.a + constants.b + spring).max(f64::MIN_POSITIVE)
    }

    fn head_start(&self, entry: &Point<f64>) -> f64 {
        if self.surface != Some(0.0) {
            return 0.0;
        }
        let constants = self.constants.borrow();
        let third = constants.a * constants.omega + self.entry.q.max(0.0) * constants.rate.powi(3);
        -3.0 * entry.guard.orders[2] / third
    }
}

impl<C: Borrow<Constants<f64>>> Bending for Progression<f64, C> {
    fn bend(&self, at: &Point<f64>) -> f64 {
        let constants = self.constants.borrow();
        let lag = at.slider_velocity.max(0.0) * constants.rate * constants.rate;
        (constants.a * constants.omega + lag).max(f64::MIN_POSITIVE)
    }

    fn head_start(&self, _: &Point<f64>) -> f64 {
        0.0
    }
}

impl<C: Borrow<Constants<f64>>> Bending for Contact<f64, C> {
    fn bend(&self, at: &Point<f64>) -> f64 {
        self.second_derivative_bound(at).max(f64::MIN_POSITIVE)
    }

    fn head_start(&self, _: &Point<f64>) -> f64 {
        0.0
    }
}

/// The first crossing not after `horizon`, without guesses; gives up after `limit` evaluations.
pub fn first_crossing<G: Bending>(
    phase: &G,
    horizon: f64,
    limit: u64,
    counters: &mut Counters,
) -> Option<Crossing> {
    let entry = phase.entry();
    let corridor = phase.corridor();
    let mut point = match phase.head_start(&entry) {
        head_start if head_start > 0.0 => evaluate(phase, head_start, counters),
        _ => entry,
    };
    let first = counters.evaluations;
    while counters.evaluations - first < limit {
        let room = slack(phase, &entry, &point);
        let bend = phase.bend(&point);
        let [value, slope, curvature, _] = point.guard.orders;
        // A guard whose top is within the rounding of its threshold touches it.
        let passes = |excess: f64| 0.5 * slope * slope > (room - excess) * curvature.abs();
        let arrived = |excess: f64, outward: f64| {
            excess > -room && outward > 0.0 && point.elapsed > 0.0 && passes(excess)
        };
        let (above, below) = (value - corridor.high, corridor.low - value);
        if arrived(above, slope) || arrived(below, -slope) {
            return Some(Crossing::At(arrival(&point, &corridor)));
        }
        let mut step = safe_step(above, slope, bend).min(safe_step(below, -slope, bend));
        if above.max(below) > -room {
            // Within the rounding of a touch the step vanishes: go over it by what rounding hides.
            let blind = (room / bend.max(curvature.abs())).sqrt();
            counters.undecidable += u64::from(step < blind);
            step = step.max(blind);
        }
        let next = point.elapsed + step.max(f64::EPSILON * point.elapsed);
        if next > horizon {
            return Some(Crossing::Horizon);
        }
        point = evaluate(phase, next, counters);
    }
    None
}

fn arrival(point: &Point<f64>, corridor: &Corridor) -> Root {
    let [value, slope, bend, third] = point.guard.orders;
    let rises = slope > 0.0;
    let over = value - if rises { corridor.high } else { corridor.low };
    // The last step may have gone over the crossing by what rounding hides in the bound: up to
    // sqrt(room/bend), over which the guard is no straight line.
    let mut step = -over / slope;
    for _ in 0..3 {
        let residual = over + step * (slope + step * (0.5 * bend + step * third / 6.0));
        step -= residual / (slope + step * (bend + step * 0.5 * third));
    }
    // A crossing follows the start, also where its slope is that of a threefold zero there.
    let TwoWord { high: elapsed, low } = TwoWord::sum(point.elapsed, step.max(-point.elapsed));
    Root { point: Point { elapsed, ..*point }, low, side: Side::high(rises) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::Flow;
    use crate::flow::forcing::EntryAngle;
    use crate::parameters::Parameters;
    use crate::state::State;

    /// Under the static force alone h is the parabola most - (d - 1)^2/2. What the steps find
    /// before d = 3, and how many touches they count.
    fn parabola(most: f64) -> (Option<f64>, u64) {
        let parameters = Parameters { a: 0.0, b: -1.0, g: 0.0, ..Parameters::default() };
        let constants = Constants::new(&parameters);
        let angle = EntryAngle { radians: 0.0, sin: 0.0, cos: 1.0 };
        let entry = State { p: most - 0.5, y: 1.0, q: 0.0 };
        let flight = NoContact { constants, entry, angle, surface: None };
        let mut counters = Counters::default();
        let found = first_crossing(&flight, 3.0, 10_000, &mut counters);
        if let Some(Crossing::At(root)) = found {
            return (Some(root.point.elapsed + root.low), counters.undecidable);
        }
        assert!(matches!(found, Some(Crossing::Horizon)), "{found:?}");
        (None, counters.undecidable)
    }

    #[test]
    fn a_parabola_is_crossed_touched_or_passed() {
        for most in [0.4, 1e-3, 1e-9, 1e-14] {
            let (crossing, touches) = parabola(most);
            let expected = 1.0 - (2.0 * most).sqrt();
            // The parabola's top is rounded by eps, which its slope at the root divides.
            let room = 4.0 * f64::EPSILON / (2.0 * most).sqrt();
            let error = (crossing.unwrap_or(f64::NAN) - expected).abs();
            assert!(error <= room && touches == 0, "{most}: {crossing:?} {expected} {touches}");
        }
        for most in [-1e-3, -1e-9, -1e-13] {
            assert_eq!(parabola(most), (None, 0), "{most}");
        }
        // The top is the threshold itself: rounding decides, and it is counted once.
        assert_eq!(parabola(0.0), (None, 1));
    }

    /// The second derivative of h is negative until the third one, at most a omega + q0/(2 xi)^3,
    /// may have brought it to zero; h stays negative three times as long. From a separation, where
    /// h and its slope are zero, no step leads on: the steps begin at the head start.
    #[test]
    fn a_separation_has_a_head_start() {
        let parameters = Parameters { b: -0.5, xi: 0.5, omega: 2.0, ..Parameters::default() };
        let constants = Constants::new(&parameters);
        let angle = EntryAngle { radians: 0.0, sin: 0.0, cos: 1.0 };
        let entry = State { p: 0.27, y: -0.25, q: 0.25 };
        let at = |surface| {
            let flight = NoContact { constants, entry, angle, surface };
            let mut counters = Counters::default();
            assert!(first_crossing(&flight, 3.0, 0, &mut counters).is_none());
            (flight.head_start(&flight.entry()), counters.evaluations)
        };
        let (head_start, evaluations) = at(Some(0.0));
        // a + b - q0/(2 xi)^2 = 0.3 - 0.5 - 0.25, and a omega + q0/(2 xi)^3 = 0.6 + 0.25.
        assert!((head_start - 3.0 * 0.45 / 0.85).abs() <= 1e-14, "{head_start}");
        assert_eq!(evaluations, 1);
        assert_eq!(at(Some(-0.1)), (0.0, 0));
        assert_eq!(at(None), (0.0, 0));
    }

    /// A crossing not after the horizon is one at the horizon itself, too. Without any force h is
    /// the straight line d - 1, of which the first step finds the zero exactly.
    #[test]
    fn a_crossing_at_the_horizon_itself_is_found() {
        let parameters = Parameters { a: 0.0, b: 0.0, g: 0.0, ..Parameters::default() };
        let constants = Constants::new(&parameters);
        let angle = EntryAngle { radians: 0.0, sin: 0.0, cos: 1.0 };
        let entry = State { p: -1.0, y: 1.0, q: 0.0 };
        let flight = NoContact { constants, entry, angle, surface: None };
        let until = |horizon| {
            let found = first_crossing(&flight, horizon, 100, &mut Counters::default());
            match found {
                Some(Crossing::At(root)) => Some(root.point.elapsed),
                _ => None,
            }
        };
        assert_eq!(until(1.0), Some(1.0));
        assert_eq!(until(1.0 - f64::EPSILON), None);
    }

    /// Newton's method squares the error of the straight line's zero, here 1e-4, three times; any
    /// other slope would leave more than rounding of it.
    #[test]
    fn an_arrival_is_the_zero_of_its_cubic() {
        let parameters = Parameters::default();
        let constants = Constants::new(&parameters);
        let angle = EntryAngle { radians: 0.0, sin: 0.0, cos: 1.0 };
        let flight = NoContact { constants, entry: State::default(), angle, surface: None };
        let corridor = Corridor { low: f64::NEG_INFINITY, high: 0.0 };
        for (root, bend, third) in [(0.01_f64, 2.0, 0.0), (-0.01, 2.0, 0.0), (0.01, 0.0, 90.0)] {
            // over + d + bend d^2/2 + third d^3/6 is zero at d = root.
            let over = -root * (1.0 + root * (0.5 * bend + root * third / 6.0));
            let mut point = flight.at(1.0);
            point.guard.orders = [over, 1.0, bend, third];
            let Root { point: end, low, .. } = arrival(&point, &corridor);
            let off = ((end.elapsed - 1.0) + low - root).abs();
            assert!(off <= 4.0 * f64::EPSILON * root.abs(), "{root} {bend} {third}: {off:e}");
        }
    }
}
