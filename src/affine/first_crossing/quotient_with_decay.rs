//! Proofs by a guard's Taylor polynomial plus a decaying exponential, which no polynomial follows.
//!
//! Where a guard's fastest block is one decay E exp(-r s), no polynomial follows it beyond some of
//! its decay times, but the rest of the guard may be slow. The polynomial of that rest is the one
//! of `quotient.rs`, and the decay is bounded by itself:
//! - The Bernstein polynomial of a convex function lies above it. So where E > 0 the coefficients
//!   of the guard are raised by E exp(-r t k/n), the values of the decay at the places of the
//!   coefficients.
//! - A concave function lies below its tangents. So where E < 0 they are raised by the tangent at
//!   the end of the time.
//! - All derivatives of a decay are largest, in size, at the beginning of a window.

use super::quotient::{AddedTerm, Quotient, WINDOW, powers, root_by, sum, weighted};
use crate::numeric::exponential::exp;

/// The relative error of a decaying exponential by the rounding of its rate and its exponent:
/// beyond the exponent 745 the exponential is zero.
const DECAY_ERROR: f64 = 1e-9;

/// The decaying term of a guard, with the sign that makes the guard positive outside its mode.
#[derive(Clone, Copy, Debug)]
pub(super) struct DecayTerm {
    /// The term's value at the point.
    pub value: f64,
    /// The rate at which the term decays.
    pub rate: f64,
}

/// A guard that begins with no zero, as the Taylor polynomial of its `rest` plus a decaying term.
/// The rounding error of the guard's value, which `rest` holds, includes that of the decay.
pub(super) struct QuotientWithDecay<const N: usize> {
    pub rest: Quotient<N>,
    pub decay: DecayTerm,
}

impl DecayTerm {
    /// The term's value at a time.
    #[inline]
    fn at(&self, time: f64) -> f64 {
        self.value * decaying_exponential(self.rate * time)
    }

    /// Adds an upper bound of the term up to a time to Bernstein coefficients.
    #[inline]
    fn raise<const N: usize>(&self, hull: &mut [f64; N], time: f64) {
        let degree = (N - 1) as f64;
        let step = self.rate * time / degree;
        let share = decaying_exponential(step);
        let falls = powers::<N>(share);
        if self.value > 0.0 {
            let value = self.value * (1.0 + DECAY_ERROR);
            hull.iter_mut().zip(falls).for_each(|(entry, fallen)| *entry += value * fallen);
        } else {
            let end = self.value * (1.0 - DECAY_ERROR) * falls[N - 1];
            for (n, entry) in hull.iter_mut().enumerate() {
                *entry += end * (1.0 + step * (N - 1 - n) as f64);
            }
        }
    }
}

/// exp(-x) for an x that is not negative; what is no number stays so.
#[inline]
fn decaying_exponential(x: f64) -> f64 {
    /// An exponent from which on the exponential is below half of the smallest number.
    const MAX_EXPONENT: f64 = 746.0;
    if x >= MAX_EXPONENT { 0.0 } else { exp(-x) }
}

impl<const N: usize> QuotientWithDecay<N> {
    /// The root of the polynomial and the decay, from a rough one, by Halley's method; none where
    /// the sum does not rise from there.
    #[inline]
    pub fn root(&self, rough: f64) -> Option<f64> {
        root_by(rough, |root| self.step(root))
    }

    /// A step of Halley's method, as a share of the root, and the slope there times the root.
    #[inline]
    pub fn step(&self, root: f64) -> (f64, f64) {
        let terms = self.rest.terms(&powers(root));
        let (decay, turn) = (self.decay.at(root), self.decay.rate * root);
        let value = sum(&terms) + decay;
        let slope = sum(&weighted(&terms, &Quotient::<N>::SLOPE_FACTORS)) - turn * decay;
        let bend =
            0.5 * (sum(&weighted(&terms, &Quotient::<N>::BEND_FACTORS)) + turn * turn * decay);
        (value * slope / (slope * slope - value * bend), slope)
    }

    /// The distance from a root, as a share of the root, within which the guard crosses zero once
    /// and before which it is negative: [`Quotient::crosses`], with the decay added.
    #[inline]
    pub fn crosses(&self, root: f64, last: f64) -> Option<f64> {
        let (decay, turn) = (self.decay.at(root), self.decay.rate * root);
        let most = self.decay.at((1.0 - WINDOW) * root).abs() * (1.0 + DECAY_ERROR);
        let error = DECAY_ERROR * decay.abs();
        let added = AddedTerm {
            value: decay,
            slope: -turn * decay,
            bend: turn * turn * most,
            errors: [error, turn * error],
        };
        let (room, before) = self.rest.rises(root, last, &added)?;
        self.is_negative(before, last).then_some(room)
    }

    /// Whether the guard stays negative up to a time, by a bound of the last derivative of its
    /// rest.
    #[inline]
    pub fn is_negative(&self, time: f64, last: f64) -> bool {
        let powers = powers(time);
        let mut hull = self.rest.hull(&powers, last);
        self.decay.raise(&mut hull, time);
        let highest = -self.rest.rounding(&powers);
        // Comparisons with NaN are false.
        hull.iter().all(|it| *it < highest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// 8!
    const FACTORIAL: f64 = 40_320.0;

    /// A polynomial of degree eight and a decay.
    #[derive(Clone, Debug)]
    struct Guard {
        powers: [f64; 9],
        decay: DecayTerm,
    }

    impl Guard {
        fn value(&self, time: f64) -> f64 {
            let polynomial = self.powers.iter().rev().fold(0.0, |sum, it| sum * time + it);
            polynomial + self.decay.value * (-self.decay.rate * time).exp()
        }

        /// The guard as all but the last power and its bound tell it.
        fn quotient(&self) -> (QuotientWithDecay<9>, f64) {
            let (mut orders, mut factorial) = ([0.0; 9], 1.0);
            for (k, (order, power)) in orders.iter_mut().zip(self.powers).take(8).enumerate() {
                *order = power * factorial;
                factorial *= (k + 1) as f64;
            }
            let slack = 4.0 * f64::EPSILON * (self.decay.value.abs() + orders[0].abs());
            let sizes = orders.map(f64::abs);
            let rest = Quotient::new([&orders, &sizes], 0, f64::EPSILON, [slack, 0.0]);
            (QuotientWithDecay { rest, decay: self.decay }, self.powers[8].abs() * FACTORIAL)
        }
    }

    /// Guards that are negative at the beginning, with the time up to which a root is looked for. A
    /// negative decaying term delays the crossing; a positive one is added to a remainder that is
    /// lower by as much, so that the sum is negative at the beginning.
    fn guard() -> impl Strategy<Value = (Guard, f64)> {
        let size = prop_oneof![Just(1e-3), Just(0.1), Just(1.0)];
        let coefficient = (size, -1.0..1.0_f64).prop_map(|(size, it)| size * it);
        let coefficients = prop::collection::vec(coefficient, 9);
        let value = prop_oneof![-0.01..0.01_f64, -1.0..1.0_f64, -20.0..20.0_f64];
        let rate = prop_oneof![0.3..3.0_f64, 3.0..30.0_f64, 30.0..1000.0_f64];
        let begin = prop_oneof![1e-6..1e-3_f64, 1e-3..2.0_f64];
        let slope = prop_oneof![Just(0.0), 0.1..3.0_f64];
        (coefficients, (value, rate), begin, slope, 0.01..3.0_f64).prop_map(
            |(coefficients, (value, rate), begin, slope, rough)| {
                let mut powers = [0.0; 9];
                powers.copy_from_slice(&coefficients);
                powers[0] = -begin - value.max(0.0);
                powers[1] += slope;
                (Guard { powers, decay: DecayTerm { value, rate } }, rough)
            },
        )
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(40_000))]

        /// A crossing that is proved is the only one up to it, and is between its ends.
        #[test]
        fn a_proved_crossing_is_the_first((guard, rough) in guard()) {
            let (quotient, last) = guard.quotient();
            let Some(root) = quotient.root(rough) else { return Ok(()) };
            let Some(room) = quotient.crosses(root, last) else { return Ok(()) };
            let (low, high) = ((1.0 - room) * root, (1.0 + room) * root);
            prop_assert!(guard.value(high) > 0.0);
            for n in 1..=1000 {
                let time = low * f64::from(n) / 1000.0;
                let early = low * 10.0_f64.powf(f64::from(n - 1000) / 100.0);
                prop_assert!(guard.value(time) < 0.0, "{time} of {root}");
                prop_assert!(guard.value(early) < 0.0, "{early} of {root}");
            }
        }

        /// A guard that is proved to stay negative does, wherever the decay makes a crest with the
        /// rest.
        #[test]
        fn what_is_proved_negative_is_so((guard, time) in guard()) {
            let (quotient, last) = guard.quotient();
            if quotient.is_negative(time, last) {
                for n in 0..=1000 {
                    let even = time * f64::from(n) / 1000.0;
                    let early = time * 10.0_f64.powf(f64::from(n - 1000) / 100.0);
                    prop_assert!(guard.value(even) < 0.0, "{even}");
                    prop_assert!(guard.value(early) < 0.0, "{early}");
                }
            }
        }

        /// A guard whose crest comes just above zero is not proved to stay negative, whether it is
        /// a decay below a motion that falls or above one that rises.
        #[test]
        fn a_crest_above_zero_is_not_told_negative(
            (guard, time) in guard(), above in prop_oneof![1e-12..1e-9_f64, 1e-9..1e-3_f64],
        ) {
            let mut guard = guard;
            let values = (0..=1000).map(|n| guard.value(time * f64::from(n) / 1000.0));
            let crest = values.fold(f64::NEG_INFINITY, f64::max);
            let size = guard.powers[0].abs() + crest.abs() + guard.decay.value.abs();
            guard.powers[0] += above * size - crest;
            let (quotient, last) = guard.quotient();
            prop_assert!(!quotient.is_negative(time, last));
        }
    }

    /// The decay makes the guard rise at 1, but no longer soon after; what the polynomial leaves
    /// open, 0.035 s^8, holds it below zero for ever. So no crossing is proved near 1.
    #[test]
    fn a_rise_that_the_decay_ends_is_no_crossing() {
        let rate = 16.0_f64;
        let decay = DecayTerm { value: -rate.exp(), rate };
        let guard = Guard { powers: [13.0, -12.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -0.035], decay };
        assert!((1..4000).all(|n| guard.value(f64::from(n) * 0.001) < 0.0));
        let (quotient, last) = guard.quotient();
        assert!(quotient.is_negative(0.94, last) && quotient.crosses(1.0, last).is_none());
        assert!(quotient.crosses(1.0, 0.0).is_some());
    }

    /// A decay that holds a guard down and one that lifts it: the crossing of the sum is proved to
    /// some digits, and the guard to stay negative only up to a time before that.
    #[test]
    fn a_decay_with_a_drift_is_proved() {
        let drift = |begin: f64, slope: f64, value: f64| Guard {
            powers: [begin, slope, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            decay: DecayTerm { value, rate: 8.0 },
        };
        for guard in [drift(-3.0, 4.0, -2.0), drift(-1.5, 1.5, 1.0)] {
            let (quotient, last) = guard.quotient();
            let root = quotient.root(0.7).unwrap_or(f64::NAN);
            let room = quotient.crosses(root, last).unwrap_or(f64::NAN);
            let [low, high] = [(1.0 - room) * root, (1.0 + room) * root];
            assert!(room < 1e-5 && guard.value(low) < 0.0 && guard.value(high) > 0.0);
            assert!(quotient.is_negative(0.9 * root, last));
            assert!(!quotient.is_negative(high, last));
        }
        // The guard begins above zero.
        let (quotient, last) = drift(-0.999, 1.0, 1.0).quotient();
        assert!(!quotient.is_negative(0.5, last));
    }

    /// Without a bound of the rest, or of the decay, nothing is proved.
    #[test]
    fn what_overflows_tells_nothing() {
        let powers = [-1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        let guard = |value, rate| Guard { powers, decay: DecayTerm { value, rate } }.quotient().0;
        let known = guard(0.1, 20.0);
        assert!(known.crosses(1.0, 0.0).is_some() && known.is_negative(0.8, 0.0));
        for last in [f64::INFINITY, f64::NAN] {
            assert!(known.crosses(1.0, last).is_none() && !known.is_negative(0.8, last));
        }
        for (value, rate) in [(f64::NAN, 20.0), (0.1, f64::NAN), (f64::INFINITY, 20.0)] {
            let unknown = guard(value, rate);
            assert!(unknown.crosses(1.0, 0.0).is_none() && !unknown.is_negative(0.8, 0.0));
        }
    }
}
