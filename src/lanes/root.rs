//! From a guess to the root of a guard: one evaluation mostly, and the guard's series from there.

use super::series::LATER_ORDERS;
use super::wide::{Mask, Wide};
use crate::crossing::allowances::{GUESS_EVALUATIONS, MAX_ROOT_STEP, RESIDUAL_TOLERANCE};
use crate::numeric::real::Real;
use crate::numeric::series::{Series, TERMS};
use pulp::Simd;

/// A phase whose guard can be evaluated.
pub trait LanePhase<S: Simd> {
    /// The result of an evaluation.
    type At: Copy;

    /// The motion after `d`.
    fn at(&self, d: Wide<S>) -> Self::At;

    /// The guard less its threshold, with three derivatives.
    fn excess(&self, at: &Self::At) -> [Wide<S>; 4];

    /// The guard's derivatives of orders four and on.
    fn later_orders(&self, at: &Self::At) -> [Wide<S>; LATER_ORDERS];

    /// The lanes in which a step from an evaluation at `d` is so short that the guard's series
    /// loses nothing.
    fn is_short(&self, d: Wide<S>, step: Wide<S>) -> Mask<S>;
}

/// How fine the pieces of a certificate are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fineness {
    /// The pieces that are enough nearly always.
    Usual,
    /// Finer pieces, for what the usual ones have left open.
    Finer,
}

/// A root next to an evaluation.
#[derive(Clone, Copy)]
pub struct LaneRoot<S: Simd, A> {
    /// The evaluation.
    pub at: A,
    /// The elapsed time of the evaluation.
    pub elapsed: Wide<S>,
    /// The guard's excess as a series from the evaluation.
    pub series: Series<Wide<S>, TERMS>,
    /// The step from the evaluation to the root.
    pub step: Wide<S>,
    /// The guard's slope at the root.
    pub slope: Wide<S>,
    /// The lanes in which there is a root.
    pub found: Mask<S>,
}

/// The largest excess that may be left where an excess is zero itself.
const ABSOLUTE_TOLERANCE: f64 = 1e-300;

/// Follows guesses.
#[inline(always)]
pub fn find<S: Simd, P: LanePhase<S>>(
    phase: &P,
    guess: Wide<S>,
    guessed: Mask<S>,
) -> LaneRoot<S, P::At> {
    let zero = guess.broadcast(0.0);
    let mut elapsed = guess;
    let mut alive = guessed;
    let mut attempt = 1;
    loop {
        let at = phase.at(elapsed);
        let excess = phase.excess(&at);
        let step = cubic_step(excess);
        let next = elapsed + step;
        alive = alive & zero.less(next);
        // Next to a crest that misses, Newton's method may stop anywhere.
        let settled = cubic(excess, step)
            .magnitude()
            .less(excess[0].magnitude() * RESIDUAL_TOLERANCE + ABSOLUTE_TOLERANCE);
        // A step that is long against the root's own time would show the evaluation's rounding.
        let near = step.magnitude().less(next * MAX_ROOT_STEP);
        let short = phase.is_short(elapsed, step) & settled & near;
        if attempt == GUESS_EVALUATIONS || !(alive & !short).any() {
            let series = Series::of_orders(excess, phase.later_orders(&at));
            let (step, slope, polished) = series.polish(step);
            return LaneRoot { at, elapsed, series, step, slope, found: alive & short & polished };
        }
        elapsed = (alive & !short).choose(next, elapsed);
        attempt += 1;
    }
}

/// The step to where the cubic through a guard's excess is zero, by Newton's method: of a step that
/// is short against the guard's bending nothing is left after three.
#[inline(always)]
fn cubic_step<S: Simd>(excess: [Wide<S>; 4]) -> Wide<S> {
    let [over, slope, bend, third] = excess;
    let mut step = -(over / slope);
    for _ in 0..2 {
        let rise = step.times_plus(step.times_plus(third * 0.5, bend), slope);
        step = step - cubic(excess, step) / rise;
    }
    step
}

#[inline(always)]
fn cubic<S: Simd>([over, slope, bend, third]: [Wide<S>; 4], step: Wide<S>) -> Wide<S> {
    let curve = step.times_plus(third * (1.0 / 6.0), bend * 0.5);
    step.times_plus(step.times_plus(curve, slope), over)
}
