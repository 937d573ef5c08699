//! The root of a guard that is inside its corridor at one time and outside at another.

use crate::crossing::candidate::{cubic_step, evaluate_again, leaves, polish};
use crate::crossing::{Counters, Guarded, Root, Side};
use crate::flow::Point;

/// The root between `left` (inside) and `right` (outside), by Newton's method with bisection as a
/// safeguard, so that it always terminates.
#[cold]
pub fn bracketed<G: Guarded>(
    phase: &G,
    left: &Point<f64>,
    right: &Point<f64>,
    counters: &mut Counters,
) -> Root {
    let corridor = phase.corridor();
    let [_, reach] = phase.reaches();
    let mut rises = right.guard.orders[0] >= corridor.high;
    let (mut inside, mut outside) = (left.elapsed, right.elapsed);
    let mut point = *right;
    let mut halvings = 0_usize;
    loop {
        let cubic = cubic_step(phase, &point);
        let root = point.elapsed + cubic.step;
        let within =
            root >= inside && root <= outside && cubic.rises == rises && leaves(&point, rises);
        if within
            && cubic.is_short(&point, left.elapsed, reach)
            && let Some(root) = polish(phase, &point, &cubic)
        {
            return root;
        }
        halvings += 1;
        let middle = middle(inside, outside, halvings);
        if middle <= inside || middle >= outside {
            return Root { point, low: 0.0, side: Side::high(rises) };
        }
        let interior = root > inside && root < outside;
        // Newton's steps may creep, where a bracket holds many oscillations.
        let creeps = halvings > MAX_PLAIN_STEPS && halvings.is_multiple_of(2);
        let next = if within && interior && !creeps { root } else { middle };
        point = evaluate_again(phase, next, counters);
        let excess = corridor.excess(point.guard.orders[0]);
        let high = point.guard.orders[0] >= corridor.high;
        // Next to an imposed zero the guard may underflow to a zero that it does not leave through.
        if excess > 0.0 || excess == 0.0 && leaves(&point, high) {
            outside = next;
            // An earlier excursion may be through the other threshold.
            rises = high;
        } else {
            inside = next;
        }
    }
}

/// Steps towards a root after which it counts as hidden: Newton's method, or halving, has not found
/// it.
const MAX_PLAIN_STEPS: usize = 8;

/// The time between two times at which the search looks next. A root that some halvings have not
/// found may be smaller by orders of magnitude: then it is the exponent that is halved, so that
/// 1e-300 is no further than 1e-3.
pub fn middle(inside: f64, outside: f64, halvings: usize) -> f64 {
    let smallest = inside.max(f64::MIN_POSITIVE);
    if halvings > MAX_PLAIN_STEPS && outside > 4.0 * smallest {
        (smallest.sqrt() * outside.sqrt()).max(inside)
    } else {
        0.5 * (inside + outside)
    }
}
