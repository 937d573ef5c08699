//! The first crossing by plain one-sided steps: the judge.
//!
//! If a guard's excess e is negative and M bounds e'' from above from here on, no crossing lies
//! closer than the smallest r > 0 with e + e' r + M r^2/2 = 0. Stepping by r never passes a crossing,
//! needs no grid and no guess, and converges quadratically on a transversal crossing. It takes about
//! nine evaluations a switch where [`crate::crossing::search`] takes two or three, and shares with it
//! nothing but the closed forms.

use crate::constants::Constants;
use crate::crossing::certificate::Corridor;
use crate::crossing::guarded::{Guarded, slack};
use crate::crossing::root::evaluate;
use crate::crossing::{Counters, Crossing, Root, Side};
use crate::flow::Point;
use crate::flow::contact::Contact;
use crate::flow::no_contact::NoContact;
use crate::flow::progression::Progression;
use crate::two_word::TwoWord;
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
        let [value, slope, ..] = point.guard.orders;
        let arrived =
            |excess: f64, outward: f64| excess > -room && outward > 0.0 && point.elapsed > 0.0;
        let (above, below) = (value - corridor.high, corridor.low - value);
        if arrived(above, slope) || arrived(below, -slope) {
            return Some(Crossing::At(arrival(&point, &corridor)));
        }
        let step = safe_step(above, slope, bend).min(safe_step(below, -slope, bend));
        // Within the rounding of a touch the step vanishes: go over it by what rounding hides.
        let blind = (room / bend).sqrt();
        if step < blind && above.max(below) > -room {
            counters.undecidable += 1;
        }
        let next = point.elapsed + step.max(blind).max(f64::EPSILON * point.elapsed);
        if next > horizon {
            return Some(Crossing::Horizon);
        }
        point = evaluate(phase, next, counters);
    }
    None
}

/// The smallest r > 0 with excess + slope r + bend r^2/2 = 0, for excess <= 0.
pub(crate) fn safe_step(excess: f64, slope: f64, bend: f64) -> f64 {
    if excess == f64::NEG_INFINITY {
        return f64::INFINITY;
    }
    let excess = excess.min(0.0);
    // The squares of forces of 1e-200 are no numbers.
    let root = slope.hypot((2.0 * bend).sqrt() * (-excess).sqrt());
    if slope > 0.0 { -2.0 * excess / (slope + root) } else { (root - slope) / bend }
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
