//! Short motions by the series of the flow less what it begins with: what changes little keeps all
//! of its digits.

use crate::affine::arithmetic::vector::{Vector, dot};
use crate::affine::model::system::LARGEST_DIMENSION;
use crate::affine::solver::Solver;
use crate::numeric::number::{Bound, Number};

/// The longest time of a motion, times the fastest rate, for the series.
pub(super) const MAX_SERIES_ARGUMENT: f64 = 0.25;

/// Newton's steps for a root: each doubles the digits, and the first guess has some.
const NEWTON_STEPS: usize = 8;

/// The time from a turn, where a row has this value and no rate, to the row's next zero in a mode.
pub(super) fn landing<T: Number>(
    solver: &Solver<T>,
    mode: usize,
    row: &Vector<T>,
    value: T,
    state: &Vector<T>,
) -> Option<T> {
    let along = |it: &Vector<T>| dot(row, it, solver.system.dimension());
    let bend = along(&solver.rates_of(mode, &solver.rates_of(mode, state)));
    let guess = (T::exact(-2.0) * value / bend).sqrt();
    short_root(solver, mode, state, guess, |gained, rates| [value + along(gained), along(rates)])
}

/// The root near a first guess, by Newton's method, of a function with its derivative: of what the
/// state has gained since its beginning, and of its rates. None where that is no short time.
pub(super) fn short_root<T: Number>(
    solver: &Solver<T>,
    mode: usize,
    state: &Vector<T>,
    guess: T,
    function: impl Fn(&Vector<T>, &Vector<T>) -> [T; 2],
) -> Option<T> {
    let mut elapsed = guess;
    for _ in 0..NEWTON_STEPS {
        let is_short = solver.modes[mode].flow.speed * elapsed.to_f64() <= MAX_SERIES_ARGUMENT;
        if !(is_short && elapsed > T::zero()) {
            return None;
        }
        let gained = gain(solver, mode, state, elapsed);
        let rates = solver.rates_of(mode, &sum(state, &gained, T::one()));
        let [value, slope] = function(&gained, &rates);
        let step = value / slope;
        elapsed = elapsed - step;
        if step.bound().abs() <= T::unit() * 4.0 * elapsed.bound().abs() {
            break;
        }
    }
    Some(elapsed)
}

/// exp(M t) z - z, by its series.
pub(super) fn gain<T: Number>(
    solver: &Solver<T>,
    mode: usize,
    z: &Vector<T>,
    elapsed: T,
) -> Vector<T> {
    let mut term = *z;
    let mut all = [T::zero(); LARGEST_DIMENSION];
    for n in 1..=2 * T::TERMS {
        let factor = elapsed / T::exact(n as f64);
        term = solver.rates_of(mode, &term).map(|it| it * factor);
        all = sum(&all, &term, T::one());
        let is_rounding =
            |(term, all): (&T, &T)| term.bound().abs() <= all.bound().abs() * T::unit();
        if term.iter().zip(&all).all(is_rounding) {
            break;
        }
    }
    all
}

/// One vector and a share of another one.
pub(super) fn sum<T: Number>(one: &Vector<T>, other: &Vector<T>, share: T) -> Vector<T> {
    std::array::from_fn(|n| one[n] + share * other[n])
}
