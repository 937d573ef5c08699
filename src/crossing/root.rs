//! From a guess or a bracket to a root, with a closed-form evaluation a step.

use crate::crossing::guarded::Guarded;
use crate::crossing::{Counters, Root};
use crate::flow::Point;

/// A Taylor step of second order from the last evaluation is exact to 1e-18 where it is shorter
/// than this against the fastest rate of the motion: (3e-6)^3/6 = 5e-18.
const TAYLOR: f64 = 3e-6;

/// Evaluates with counting.
pub fn evaluate<G: Guarded>(phase: &G, elapsed: f64, counters: &mut Counters) -> Point<f64> {
    counters.evaluations += 1;
    phase.at(elapsed)
}

/// The step from a point to where its cubic meets the nearer threshold, and that threshold's side.
fn cubic_step<G: Guarded>(phase: &G, point: &Point<f64>) -> CubicStep {
    let corridor = phase.corridor();
    let [value, slope, bend, third] = point.guard.orders;
    let (above, below) = (value - corridor.high, value - corridor.low);
    let rises = above.abs() <= below.abs();
    let over = if rises { above } else { below };
    let residual = |step: f64| over + step * (slope + step * (0.5 * bend + step * third / 6.0));
    let mut step = -over / slope;
    // Three steps do on a transversal crossing; next to a graze Newton only halves at first.
    for _ in 0..40 {
        let change = residual(step) / (slope + step * (bend + step * 0.5 * third));
        step -= change;
        if change.abs() <= 1e-12 * step.abs() || change.is_nan() {
            break;
        }
    }
    let room = 4.0 * f64::EPSILON * (point.guard.largest_term + over.abs());
    CubicStep { step, rises, settled: residual(step).abs() <= room }
}

/// Where a point's cubic meets a threshold.
struct CubicStep {
    step: f64,
    /// Whether that is the upper threshold.
    rises: bool,
    /// Whether it does meet it there. Next to a crest that misses, Newton wanders.
    settled: bool,
}

/// Whether a Taylor step reaches the root with all its digits and ends at a point that is next to the
/// root as seen from `left` too: in a very short phase a certificate cannot use one far beyond it.
fn reaches(step: f64, root: f64, left: f64, reach: f64) -> bool {
    const NEAR: f64 = 1e-3;
    step.abs() <= reach && step.abs() <= NEAR * (root - left)
}

fn leaves(point: &Point<f64>, rises: bool) -> bool {
    let slope = point.guard.orders[1];
    if rises { slope > 0.0 } else { slope < 0.0 }
}

/// Follows a guess to a root beyond `left`, where the guard leaves its corridor; or gives the last
/// evaluation back.
pub fn follow<G: Guarded>(
    phase: &G,
    left: f64,
    guess: f64,
    limit: f64,
    counters: &mut Counters,
) -> Result<Root, Point<f64>> {
    const ATTEMPTS: usize = 5;
    let reach = TAYLOR / phase.fastest_rate();
    let mut point = evaluate(phase, guess, counters);
    let mut last_step = f64::INFINITY;
    for _ in 0..ATTEMPTS {
        let CubicStep { step, rises, settled } = cubic_step(phase, &point);
        let next = point.elapsed + step;
        // Written so that a NaN gives up.
        if !(next > left && next <= limit && step.abs() < 0.5 * last_step) {
            return Err(point);
        }
        if reaches(step, next, left, reach) {
            return if settled && leaves(&point, rises) {
                Ok(Root { point, step, rises })
            } else {
                Err(point)
            };
        }
        last_step = step.abs();
        point = evaluate(phase, next, counters);
    }
    Err(point)
}

/// The root between `left` (inside) and `right` (outside): safeguarded, ends always.
pub fn bracketed<G: Guarded>(
    phase: &G,
    left: &Point<f64>,
    right: &Point<f64>,
    counters: &mut Counters,
) -> Root {
    let corridor = phase.corridor();
    let reach = TAYLOR / phase.fastest_rate();
    let mut rises = right.guard.orders[0] >= corridor.high;
    let (mut inside, mut outside) = (left.elapsed, right.elapsed);
    let mut point = *right;
    let mut halvings = 0_usize;
    loop {
        let CubicStep { step, rises: side, settled } = cubic_step(phase, &point);
        let root = point.elapsed + step;
        let within = root >= inside && root <= outside && side == rises && leaves(&point, rises);
        if within && settled && reaches(step, root, left.elapsed, reach) {
            return Root { point, step, rises };
        }
        halvings += 1;
        let middle = middle(inside, outside, halvings);
        if middle <= inside || middle >= outside {
            return Root { point, step: 0.0, rises };
        }
        let interior = root > inside && root < outside;
        let next = if within && interior { root } else { middle };
        point = evaluate(phase, next, counters);
        if corridor.excess(point.guard.orders[0]) >= 0.0 {
            outside = next;
            // An earlier excursion may be through the other threshold.
            rises = point.guard.orders[0] >= corridor.high;
        } else {
            inside = next;
        }
    }
}

/// Where to look between two times. A root that some halvings have not found may be smaller by orders
/// of magnitude: then it is the exponent that is halved, so that 1e-300 is no further than 1e-3.
pub fn middle(inside: f64, outside: f64, halvings: usize) -> f64 {
    const PLAIN: usize = 8;
    let smallest = inside.max(f64::MIN_POSITIVE);
    if halvings > PLAIN && outside > 4.0 * smallest {
        (smallest.sqrt() * outside.sqrt()).max(inside)
    } else {
        0.5 * (inside + outside)
    }
}
