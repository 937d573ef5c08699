//! Time as forcing cycle and forcing angle, so that nothing is lost late in a run.
//!
//! One unit in the last place of tau = 1e8 is 1.5e-8, and a forcing angle that is computed from
//! that tau would be wrong by omega times as much. The motion depends on tau through `omega tau mod
//! 2 pi` alone, so that is what is carried, in two words: one word would lose half a unit at every
//! switch, always in the same direction.

use crate::flow::forcing::EntryAngle;
use crate::numeric::angle;
use crate::numeric::circle;
use crate::numeric::two_word::{TWO_PI, TwoWord};

/// An instant: `omega tau = cycle 2 pi + angle` with `0 <= angle < 2 pi` (phi is not included).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instant {
    cycle: Cycle,
    angle: TwoWord,
}

/// Whole cycles, aligned as the other words are: the tag of an option is as wide as its alignment,
/// and one of sixteen bytes would be read across the words in which it was written, for which a
/// processor has to wait.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(Rust, packed(8))]
struct Cycle(i128);

impl Instant {
    /// The instant `cycle` forcing periods after `tau`.
    ///
    /// Exact for `omega |tau| <= 1e21`: both are taken as the f64 values they are. Nothing is
    /// checked: beyond that, or for numbers that are not finite, the instant means nothing
    /// ([`Model::start`] checks).
    ///
    /// [`Model::start`]: crate::Model::start
    #[must_use]
    pub fn at(omega: f64, tau: f64, cycle: i64) -> Self {
        let (turns, angle) = angle::reduce(TwoWord::product(omega, tau));
        Self { cycle: Cycle(turns + i128::from(cycle)), angle }
    }

    /// An instant that is known to be one: `0 <= angle < 2 pi`.
    #[cfg(feature = "lanes")]
    pub(crate) const fn from_parts(cycle: i128, angle: TwoWord) -> Self {
        Self { cycle: Cycle(cycle), angle }
    }

    /// The instant at an angle that may have left `[0, 2 pi)`.
    #[inline(always)]
    fn wrapped(cycle: i128, angle: TwoWord) -> Self {
        let (cycle, angle) = angle::wrap(cycle, angle);
        Self { cycle: Cycle(cycle), angle }
    }

    /// The instant one forcing period later.
    pub(crate) const fn next_cycle(self) -> Self {
        Self { cycle: Cycle(self.cycle.0 + 1), ..self }
    }

    /// Whole forcing cycles since `tau = 0`.
    #[must_use]
    pub const fn cycle(&self) -> i128 {
        self.cycle.0
    }

    /// `omega tau mod 2 pi`, radians, rounded to one word.
    #[must_use]
    pub fn angle(&self) -> f64 {
        self.angle.value()
    }

    /// `omega tau mod 2 pi`, radians.
    #[must_use]
    pub const fn angle_two_word(&self) -> TwoWord {
        self.angle
    }

    /// The time tau of this instant, rounded to one word.
    #[must_use]
    pub fn tau(&self, omega: f64) -> f64 {
        radians(self.cycle.0, self.angle).over(omega).value()
    }

    /// The time from `earlier` to this instant (negative if `earlier` is later).
    #[must_use]
    pub fn since(&self, earlier: &Self, omega: f64) -> TwoWord {
        radians(self.cycle.0 - earlier.cycle.0, self.angle.minus(earlier.angle)).over(omega)
    }

    /// Bounds of [`Self::since`] that cost little.
    #[inline]
    pub(crate) fn since_roughly(&self, earlier: &Self, omega: f64) -> (f64, f64) {
        /// The whole and the angles round a few times.
        const ROUNDING_TOLERANCE: f64 = 16.0 * f64::EPSILON;
        let cycles = to_f64(self.cycle.0 - earlier.cycle.0) * TWO_PI.high;
        let radians = cycles + (self.angle.high - earlier.angle.high);
        let room = ROUNDING_TOLERANCE * (cycles.abs() + TWO_PI.high);
        ((radians - room) / omega, (radians + room) / omega)
    }

    /// The instant a time `elapsed >= 0` later.
    #[inline(always)]
    #[must_use]
    pub fn after(&self, elapsed: TwoWord, omega: f64) -> Self {
        Self::wrapped(self.cycle.0, self.angle.plus_product(elapsed, omega))
    }

    /// The instant later, with the forcing angle there, whose sine does not wait until whole turns
    /// have come off.
    #[inline(always)]
    pub(crate) fn after_with_forcing(
        &self,
        elapsed: TwoWord,
        omega: f64,
        phi: TwoWord,
    ) -> (Self, EntryAngle<f64>) {
        /// The largest angle whose second word is a first-order correction of its sine.
        const MAX_CORRECTED_RADIANS: f64 = 1e3;
        let angle = self.angle.plus_product(elapsed, omega);
        let instant = Self::wrapped(self.cycle.0, angle);
        let near = if angle.high < MAX_CORRECTED_RADIANS { angle } else { instant.angle };
        let (sin, cos) = sin_cos(with_phase(near, phi));
        (instant, EntryAngle { radians: instant.radians(phi), sin, cos })
    }

    /// The instant `numerator / denominator` forcing periods later.
    ///
    /// # Panics
    /// If `denominator` is zero.
    #[must_use]
    pub fn after_periods(&self, numerator: u64, denominator: u64) -> Self {
        let (whole, rest) = (numerator / denominator, numerator % denominator);
        let step = TWO_PI.times(rest as f64).over(denominator as f64);
        Self::wrapped(self.cycle.0 + i128::from(whole), self.angle.plus(step))
    }

    /// The first instant not before this one at which `omega tau mod 2 pi` is `angle` (radians, any
    /// turn of it, up to 1e15 in size).
    #[must_use]
    pub fn first_at_angle(&self, angle: f64) -> Self {
        let (_, angle) = angle::reduce(TwoWord::new(angle));
        let here = Self { cycle: self.cycle, angle };
        if here >= *self { here } else { Self { cycle: Cycle(self.cycle.0 + 1), angle } }
    }

    /// The forcing angle with its phase, `omega tau + phi`.
    #[must_use]
    pub(crate) fn forcing(&self, phi: TwoWord) -> EntryAngle<f64> {
        let (sin, cos) = sin_cos(with_phase(self.angle, phi));
        EntryAngle { radians: self.radians(phi), sin, cos }
    }

    /// The forcing angle within `[0, 2 pi)`, rounded.
    #[inline(always)]
    fn radians(&self, phi: TwoWord) -> f64 {
        let high = with_phase(self.angle, phi).high;
        high - if high < TWO_PI.high { 0.0 } else { TWO_PI.high }
    }
}

#[inline(always)]
fn with_phase(angle: TwoWord, phi: TwoWord) -> TwoWord {
    if phi == TwoWord::ZERO { angle } else { angle.plus_positive(phi) }
}

/// Sine and cosine of an angle whose second word is small.
#[inline(always)]
fn sin_cos(angle: TwoWord) -> (f64, f64) {
    let (sine, cosine) = circle::sin_cos(angle.high);
    (sine + angle.low * cosine, cosine - angle.low * sine)
}

impl PartialOrd for Instant {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        let angle = |instant: &Self| (instant.angle.high, instant.angle.low);
        match self.cycle().cmp(&other.cycle()) {
            std::cmp::Ordering::Equal => angle(self).partial_cmp(&angle(other)),
            order => Some(order),
        }
    }
}

fn radians(cycles: i128, angle: TwoWord) -> TwoWord {
    TWO_PI.times(to_f64(cycles)).plus(angle)
}

/// Converts without a call of the library for any count that a run meets.
#[inline]
fn to_f64(cycles: i128) -> f64 {
    #[cold]
    #[inline(never)] // else it is merged with the short way
    fn many(cycles: i128) -> f64 {
        cycles as f64
    }
    i64::try_from(cycles).map_or_else(|_| many(cycles), |few| few as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn tau_comes_back(omega in 0.01..50.0_f64, tau in -1e9..1e9_f64) {
            prop_assert_eq!(Instant::at(omega, tau, 0).tau(omega), tau);
        }

        #[test]
        fn a_step_is_what_lies_between(omega in 0.01..50.0_f64, tau in -1e3..1e3_f64, step in 0.0..1e4_f64) {
            let start = Instant::at(omega, tau, 100_000_000);
            let end = start.after(TwoWord::new(step), omega);
            prop_assert_eq!(end.since(&start, omega).value(), step);
        }
    }

    proptest! {
        #[test]
        fn an_angle_comes_within_a_period(tau in -1e3..1e3_f64, angle in -20.0..20.0_f64) {
            let start = Instant::at(1.4, tau, 7);
            let first = start.first_at_angle(angle);
            prop_assert!(first >= start && first < start.after_periods(1, 1));
            let turns = (first.angle() - angle) / std::f64::consts::TAU;
            // The angle's rounding, a few units of 20.
            prop_assert!((turns - turns.round()).abs() <= 1e-14);
            prop_assert_eq!(first.first_at_angle(angle), first);
        }
    }

    #[test]
    fn eighths_of_a_period_add_up() {
        let start = Instant::at(1.4, 0.3, 0);
        let end = start.after_periods(8, 8);
        assert_eq!(end.cycle(), start.cycle() + 1);
        assert_eq!(end.angle(), start.angle());
    }
}
