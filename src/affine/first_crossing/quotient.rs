//! Proofs by a guard's Taylor polynomial: that the guard stays negative, or crosses zero once.
//!
//! A guard that begins with z zeros is s^z q, and q has its sign for s > 0. With the polynomial of
//! q, a bound of what is left of its series, and a bound of what rounding does:
//! - q is negative up to a time if all Bernstein coefficients of the polynomial, raised by the two
//!   bounds, are.
//! - q crosses zero once in a window about the root of the polynomial if it rises there by at least
//!   half of the polynomial's slope at the root, and by more than twice what the bounds leave open.

use crate::affine::closed_form::bound::ORDERS;
use crate::numeric::number::Number;
use crate::numeric::real::Real;

/// On both sides of a root, as a share of its time, a quotient has to rise steadily, at most.
pub(super) const WINDOW: f64 = 1.0 / 16.0;

/// The rounding error in f64 of a sum of powers, or of a Bernstein coefficient, relative to the sum
/// of its terms' sizes: 2N additions and products, twice.
const ROUNDING_TOLERANCE: f64 = 4.0 * ORDERS as f64 * f64::EPSILON;

/// The factor by which a remainder is raised against its rounding.
const OUTWARD_FACTOR: f64 = 1.0 + 1e-12;

/// A guard after a point, divided by the power of the time with which it begins; N is the number of
/// derivatives that are used, the value and the one that is bounded included.
pub(super) struct Quotient<const N: usize> {
    /// The number of zeros with which the guard begins: the exponent of the power, at most two.
    zeros: usize,
    /// The coefficients of the quotient's Taylor polynomial. The last is zero: its place is that of
    /// the remainder.
    coefficients: [f64; N],
    /// The sums of the sizes of the coefficients' terms.
    sizes: [f64; N],
    /// A bound of the rounding error of a coefficient, relative to the coefficient's size.
    margin: f64,
    /// A bound of the rounding error of the guard's value, if the guard begins with no zero.
    slack: f64,
    /// A bound of the error that underflow makes in a coefficient.
    lost: f64,
}

/// A function that is added to a quotient's polynomial, near a root of the sum.
#[derive(Clone, Copy, Debug)]
pub(super) struct AddedTerm {
    /// The function's value at the root.
    pub value: f64,
    /// The function's slope at the root, times the root.
    pub slope: f64,
    /// A bound of the function's second derivative in the largest window, times the square of the
    /// root.
    pub bend: f64,
    /// Bounds of the rounding errors of the function's value and slope.
    pub errors: [f64; 2],
}

impl AddedTerm {
    /// The function that is zero everywhere.
    pub const ZERO: Self = Self { value: 0.0, slope: 0.0, bend: 0.0, errors: [0.0; 2] };
}

impl<const N: usize> Quotient<N> {
    /// An upper bound of a sum of powers at the end of the largest window, relative to its value at
    /// the root.
    const WINDOW_GROWTH: f64 = power(1.0 + WINDOW, N - 1);

    /// The factors of the terms in the slope, times the time.
    pub const SLOPE_FACTORS: [f64; N] = falling(1);

    /// The factors of the terms in the second derivative, times the square of the time.
    pub const BEND_FACTORS: [f64; N] = falling(2);

    /// The factors of the terms in the third derivative, times the cube of the time.
    const THIRD_FACTORS: [f64; N] = falling(3);

    /// The inverses of the binomial coefficients.
    const INVERSE_BINOMIALS: [f64; N] = inverse_binomials();

    /// The quotient of a guard with these orders, positive outside, and the sizes of what they are
    /// summed from; `margin` is what rounding does to them relative to these sizes, `slack` what it
    /// did to the value, and `lost` what underflow takes from them.
    #[inline]
    pub fn new(
        [orders, sizes]: [&[f64; N]; 2],
        zeros: usize,
        margin: f64,
        [slack, lost]: [f64; 2],
    ) -> Self {
        let [mut coefficients, mut divided] = [[0.0; N]; 2];
        for k in zeros..N - 1 {
            let factor = f64::inverse_factorial(k);
            coefficients[k - zeros] = orders[k] * factor;
            divided[k - zeros] = sizes[k] * factor;
        }
        let slack = if zeros == 0 { slack } else { 0.0 };
        let margin = margin + ROUNDING_TOLERANCE;
        Self { zeros, coefficients, sizes: divided, margin, slack, lost }
    }

    /// The root of the polynomial, from a rough one, by Halley's method, which about triples the
    /// digits; none where the polynomial does not rise from there.
    #[inline]
    pub fn root(&self, rough: f64) -> Option<f64> {
        root_by(rough, |root| self.step(root))
    }

    /// A step of Halley's method, as a share of the root, and the slope there times the root.
    #[inline]
    pub fn step(&self, root: f64) -> (f64, f64) {
        let terms = self.terms(&powers(root));
        let (value, slope) = (sum(&terms), sum(&weighted(&terms, &Self::SLOPE_FACTORS)));
        let bend = 0.5 * sum(&weighted(&terms, &Self::BEND_FACTORS));
        (value * slope / (slope * slope - value * bend), slope)
    }

    /// The distance from the root of the polynomial, as a share of the root, within which the
    /// quotient crosses zero once and before which it is negative; none if that is not proved.
    #[inline]
    pub fn crosses(&self, root: f64, last: f64) -> Option<f64> {
        let (room, before) = self.rises(root, last, &AddedTerm::ZERO)?;
        self.is_negative(before, last).then_some(room)
    }

    /// The distance from a root, as a share of it, within which the sum of the quotient and a
    /// function has one zero at most, because the sum rises; and the time before which the sum has
    /// to be negative to cross there. None if that is not proved.
    #[inline]
    pub fn rises(&self, root: f64, last: f64, added: &AddedTerm) -> Option<(f64, f64)> {
        let powers = powers(root);
        let terms = self.terms(&powers);
        let value = sum(&terms) + added.value;
        let slope = sum(&weighted(&terms, &Self::SLOPE_FACTORS)) + added.slope;
        let bend = sum(&weighted(&terms, &Self::BEND_FACTORS));
        let third = sum(&weighted(&terms.map(f64::abs), &Self::THIRD_FACTORS));
        let remainder = Self::WINDOW_GROWTH * self.remainder(last, &powers);
        let rounding = Self::WINDOW_GROWTH * self.rounding(&powers);
        let open = value.abs() + remainder + rounding + added.errors[0];
        let room = 2.0 * open / slope + 8.0 * f64::EPSILON;
        let window = 2.0 * room;
        // The remainder is r/s^z with |r'| <= (N - 1) |r|/s, and each power has at most N - 2 times
        // its error in its slope.
        let change = window
            * (bend.abs() + 0.5 * window * Self::WINDOW_GROWTH * third + added.bend)
            + added.errors[1]
            + (N + self.zeros) as f64 * remainder
            + N as f64 * rounding;
        let is_proved = slope > 0.0 && change < 0.5 * slope && window < WINDOW;
        is_proved.then_some((room, (1.0 - window) * root))
    }

    /// Whether the quotient stays negative up to a time, by a bound of the guard's last derivative.
    #[inline]
    pub fn is_negative(&self, time: f64, last: f64) -> bool {
        let powers = powers(time);
        let hull = self.hull(&powers, last);
        let highest = -self.rounding(&powers);
        // Comparisons with NaN are false.
        hull.iter().all(|it| *it < highest)
    }

    /// The Bernstein coefficients of a polynomial that lies above the quotient up to a time, but
    /// for what rounding does to it.
    #[inline(always)]
    pub fn hull(&self, powers: &[f64; N], last: f64) -> [f64; N] {
        let mut hull = self.terms(powers);
        hull[N - 1 - self.zeros] += self.remainder(last, powers);
        hull = weighted(&hull, &Self::INVERSE_BINOMIALS);
        // Sums of powers with binomial weights are Bernstein coefficients.
        for order in (1..N).rev() {
            for n in order..N {
                hull[n] += hull[n - 1];
            }
        }
        hull
    }

    /// The terms of the polynomial at a time, whose powers are given.
    #[inline]
    pub fn terms(&self, powers: &[f64; N]) -> [f64; N] {
        weighted(&self.coefficients, powers)
    }

    /// The rest of the quotient's Taylor series at a time, by a bound of the guard's last
    /// derivative.
    #[inline]
    fn remainder(&self, last: f64, powers: &[f64; N]) -> f64 {
        let factor = OUTWARD_FACTOR * f64::inverse_factorial(N - 1);
        factor * last * powers[N - 1 - self.zeros]
    }

    /// A bound of the rounding error of the polynomial up to a time.
    #[inline]
    pub fn rounding(&self, powers: &[f64; N]) -> f64 {
        let lost = self.lost * N as f64 * powers[N - 1].larger(1.0);
        self.slack + self.margin * sum(&weighted(&self.sizes, powers)) + lost
    }
}

/// A root from a rough one, by steps that are shares of it, each with the slope there; none where
/// the slope is not positive.
#[inline(always)]
pub(super) fn root_by(rough: f64, step: impl Fn(f64) -> (f64, f64)) -> Option<f64> {
    const MAX_STEPS: usize = 8;
    /// The longest last step, as a share of the root.
    const STEP_TOLERANCE: f64 = 1e-3;
    let mut root = rough;
    for _ in 0..MAX_STEPS {
        let (step, slope) = step(root);
        let rises = slope > 0.0 && step < 0.5;
        if !rises {
            return None;
        }
        root *= 1.0 - step.larger(-0.5);
        if step.abs() <= STEP_TOLERANCE {
            return Some(root);
        }
    }
    None
}

/// The powers of a number, in four chains that do not wait for one another.
#[inline]
pub(super) fn powers<const N: usize>(base: f64) -> [f64; N] {
    let square = base * base;
    let (first, fourth) = ([1.0, base, square, square * base], square * square);
    let mut powers = [1.0; N];
    powers[..4].copy_from_slice(&first);
    for n in 4..N {
        powers[n] = powers[n - 4] * fourth;
    }
    powers
}

#[inline]
pub(super) fn weighted<const N: usize>(terms: &[f64; N], weights: &[f64; N]) -> [f64; N] {
    std::array::from_fn(|n| terms[n] * weights[n])
}

/// A sum as four that do not wait for one another.
#[inline]
pub(super) fn sum<const N: usize>(terms: &[f64; N]) -> f64 {
    let mut sums = [0.0; 4];
    for (n, term) in terms.iter().enumerate() {
        sums[n % 4] += term;
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

/// The factors k, k (k - 1), ... of the powers' derivatives of this order.
const fn falling<const N: usize>(order: usize) -> [f64; N] {
    let mut factors = [1.0; N];
    let mut n = 0;
    while n < N {
        let mut less = 0;
        while less < order {
            factors[n] *= n as f64 - less as f64;
            less += 1;
        }
        n += 1;
    }
    factors
}

const fn power(base: f64, exponent: usize) -> f64 {
    if exponent == 0 { 1.0 } else { base * power(base, exponent - 1) }
}

/// The inverses of the binomial coefficients of the highest order.
const fn inverse_binomials<const N: usize>() -> [f64; N] {
    let mut shares = [1.0; N];
    let mut n = 1;
    while n < N {
        shares[n] = shares[n - 1] * n as f64 / (N - n) as f64;
        n += 1;
    }
    shares
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// 8!
    const FACTORIAL: f64 = 40_320.0;

    /// The value of a polynomial in powers.
    fn value(powers: &[f64], time: f64) -> f64 {
        powers.iter().rev().fold(0.0, |sum, it| sum * time + it)
    }

    /// A guard that is a polynomial of degree eight, of which the quotient has all but the last.
    fn quotient(powers: &[f64; 9], zeros: usize) -> Quotient<9> {
        let mut orders = [0.0; 9];
        let mut factorial = 1.0;
        for k in 0..8 {
            orders[k] = powers[k] * factorial;
            factorial *= (k + 1) as f64;
        }
        Quotient::new([&orders, &orders.map(f64::abs)], zeros, f64::EPSILON, [0.0; 2])
    }

    /// Coefficients of guards that begin with some zeros, below zero, and how far the root of the
    /// polynomial is looked for.
    fn guard() -> impl Strategy<Value = ([f64; 9], usize, f64)> {
        let size = prop_oneof![Just(1e-3), Just(0.1), Just(1.0), Just(5.0)];
        let coefficient = (size, -1.0..1.0_f64).prop_map(|(size, it)| size * it);
        let coefficients = prop::collection::vec(coefficient, 9);
        (coefficients, 0..3_usize, 1e-6..1.0_f64, 0.01..3.0_f64).prop_map(
            |(coefficients, zeros, begin, rough)| {
                let mut powers = [0.0; 9];
                powers.copy_from_slice(&coefficients);
                powers[..zeros].fill(0.0);
                powers[zeros] = -begin;
                (powers, zeros, rough)
            },
        )
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        /// Whatever the last coefficient's sign, a proved crossing is the only one up to it.
        #[test]
        fn a_proved_crossing_is_the_first((powers, zeros, rough) in guard()) {
            let quotient = quotient(&powers, zeros);
            let Some(root) = quotient.root(rough) else { return Ok(()) };
            let last = powers[8].abs() * FACTORIAL;
            let Some(room) = quotient.crosses(root, last) else { return Ok(()) };
            let (low, high) = ((1.0 - room) * root, (1.0 + room) * root);
            prop_assert!(value(&powers[zeros..], high) > 0.0);
            for n in 1..=1000 {
                let time = low * f64::from(n) / 1000.0;
                prop_assert!(value(&powers[zeros..], time) < 0.0, "{time} of {root}");
            }
        }

        /// A quotient that is proved to stay negative does.
        #[test]
        fn what_is_proved_negative_is_so((powers, zeros, time) in guard()) {
            if quotient(&powers, zeros).is_negative(time, powers[8].abs() * FACTORIAL) {
                for n in 0..=1000 {
                    let time = time * f64::from(n) / 1000.0;
                    prop_assert!(value(&powers[zeros..], time) < 0.0, "{time}");
                }
            }
        }
    }

    /// Without a bound of the rest nothing is proved.
    #[test]
    fn what_overflows_tells_nothing() {
        let quotient = quotient(&[-1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], 0);
        assert!(quotient.crosses(1.0, 0.0).is_some() && quotient.is_negative(0.9, 0.0));
        for last in [f64::INFINITY, f64::NAN] {
            assert!(quotient.crosses(1.0, last).is_none());
            assert!(!quotient.is_negative(0.9, last));
        }
    }
}
