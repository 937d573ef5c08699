//! Short motions by the series of the flow less what it begins with: what changes little keeps all
//! of its digits.

use crate::affine::arithmetic::vector::{Vector, dot, row_size};
use crate::affine::model::system::LARGEST_DIMENSION;
use crate::affine::solver::Solver;
use crate::numeric::number::{Bound, Number};

/// The longest time of a motion, times the fastest rate, for the series.
pub(super) const MAX_SERIES_ARGUMENT: f64 = 0.25;

/// Newton's steps for a root: each doubles the digits, and the first guess has some.
const NEWTON_STEPS: usize = 16;
/// The largest last step, as a share of the root: beside a guard that moves, roundings of the state
/// leave no more of a short time.
const LAST_STEP: f64 = 1.0 / 64.0;
/// The largest number of times that a reach is widened until it holds the motion.
const MAX_WIDENINGS: u32 = 8;

/// The time from a turn, where a row is negative with this value and has no rate, to the row's
/// first zero in a mode: its second derivative is proved to be positive up to there. None
/// otherwise.
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
    let root = short_root(solver, mode, state, guess, |gained, rates| {
        [value + along(gained), along(rates)]
    });
    root.filter(|elapsed| keeps_bend(solver, mode, row, state, *elapsed))
}

/// Whether the second derivative of a row keeps more than half of what it is, up to a time after a
/// state.
///
/// The state goes no farther than R if a time of rates M (z + R) leads no farther; so far the third
/// derivative r z of the row is at most |r z| + |r| R.
fn keeps_bend<T: Number>(
    solver: &Solver<T>,
    mode: usize,
    row: &Vector<T>,
    state: &Vector<T>,
    elapsed: T,
) -> bool {
    let dimension = solver.system.dimension();
    let (matrix, time) = (&solver.modes[mode].matrix, elapsed.bound() * 2.0);
    let rates = solver.rates_of(mode, state).map(|it| it.bound().abs());
    let moved = |reach: &Vector<T::Bound>| -> Vector<T::Bound> {
        std::array::from_fn(|n| {
            matrix.get(n).map_or(T::Bound::ZERO, |own| (rates[n] + row_size(own, reach)) * time)
        })
    };
    let mut reach = rates.map(|it| it * time);
    let mut is_held = false;
    for _ in 0..MAX_WIDENINGS {
        reach = moved(&reach).map(|it| it * 2.0);
        is_held = moved(&reach).iter().zip(&reach).all(|(moved, reach)| *moved <= *reach);
        if is_held {
            break;
        }
    }
    let second = solver.rate_row(mode, &solver.rate_row(mode, row));
    let third = solver.rate_row(mode, &second);
    let bend = dot(&second, state, dimension).bound();
    let change = dot(&third, state, dimension).bound().abs() + row_size(&third, &reach);
    is_held && change * time < bend * 0.5
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
    let (mut elapsed, mut last) = (guess, guess.bound().abs());
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
        last = step.bound().abs();
        if last <= T::unit() * 4.0 * elapsed.bound().abs() {
            break;
        }
    }
    // A comparison with NaN is false.
    (last <= elapsed.bound().abs() * LAST_STEP).then_some(elapsed)
}

/// exp(M t) z - z, by its series.
pub(super) fn gain<T: Number>(
    solver: &Solver<T>,
    mode: usize,
    z: &Vector<T>,
    elapsed: T,
) -> Vector<T> {
    let mut term = *z;
    series(elapsed, 1, |factor| {
        term = solver.rates_of(mode, &term).map(|it| it * factor);
        term
    })
}

/// The sum of terms, at least so many, each of which follows from the one before and the time over
/// its number.
pub(super) fn series<T: Number>(
    elapsed: T,
    at_least: usize,
    mut next: impl FnMut(T) -> Vector<T>,
) -> Vector<T> {
    let mut all = [T::zero(); LARGEST_DIMENSION];
    for n in 1..=2 * T::TERMS {
        let term = next(elapsed / T::exact(n as f64));
        all = sum(&all, &term, T::one());
        let is_rounding =
            |(term, all): (&T, &T)| term.bound().abs() <= all.bound().abs() * T::unit();
        if n >= at_least && term.iter().zip(&all).all(is_rounding) {
            break;
        }
    }
    all
}

/// One vector and a share of another one.
pub(super) fn sum<T: Number>(one: &Vector<T>, other: &Vector<T>, share: T) -> Vector<T> {
    std::array::from_fn(|n| one[n] + share * other[n])
}
