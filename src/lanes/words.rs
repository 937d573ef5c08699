//! Numbers in two words, all lanes at once ([`crate::numeric::two_word`]).

use super::wide::Wide;
use crate::numeric::real::Real;
use crate::numeric::two_word::{ROUNDER, TWO_PI};
use pulp::Simd;

/// An unevaluated sum.
#[derive(Clone, Copy)]
pub struct Words<S: Simd> {
    /// The sum rounded to one word.
    pub high: Wide<S>,
    /// The remainder of that rounding: the number is `high + low`.
    pub low: Wide<S>,
}

impl<S: Simd> Words<S> {
    /// The exact sum of two words.
    #[inline(always)]
    pub fn sum(a: Wide<S>, b: Wide<S>) -> Self {
        let high = a + b;
        let seen = high - a;
        Self { high, low: (a - (high - seen)) + (b - seen) }
    }

    /// The exact sum where |a| >= |b|.
    #[inline(always)]
    fn quick_sum(a: Wide<S>, b: Wide<S>) -> Self {
        let high = a + b;
        Self { high, low: b - (high - a) }
    }

    /// `self + other`.
    #[inline(always)]
    pub fn plus(self, other: Self) -> Self {
        let high = Self::sum(self.high, other.high);
        let low = Self::sum(self.low, other.low);
        let carried = Self::quick_sum(high.high, high.low + low.high);
        Self::quick_sum(carried.high, carried.low + low.low)
    }

    /// `self * factor`.
    #[inline(always)]
    pub fn times(self, factor: Wide<S>) -> Self {
        let high = self.high * factor;
        let error = self.high.times_plus(factor, -high);
        Self::quick_sum(high, self.low.times_plus(factor, error))
    }

    /// `self / divisor`.
    #[inline(always)]
    pub fn over(self, divisor: Wide<S>) -> Self {
        let first = self.high / divisor;
        let rest = first.times_from(divisor, self.high) + self.low;
        Self::quick_sum(first, rest / divisor)
    }

    /// 2 pi times whole numbers.
    #[inline(always)]
    pub fn turns(whole: Wide<S>) -> Self {
        let two_pi = Self { high: whole.broadcast(TWO_PI.high), low: whole.broadcast(TWO_PI.low) };
        two_pi.times(whole)
    }

    /// Whole turns and the rest in `[0, 2 pi)`.
    #[inline(always)]
    pub fn wrapped(self) -> (Wide<S>, Self) {
        const TURNS_PER_RADIAN: f64 = 1.0 / std::f64::consts::TAU;
        let rounder = self.high.broadcast(ROUNDER);
        let nearest =
            self.high.times_plus(self.high.broadcast(TURNS_PER_RADIAN), rounder) - ROUNDER;
        let zero = self.high.broadcast(0.0);
        let rest = self.plus(Self::turns(-nearest));
        let negative = rest.high.less(zero);
        let one = self.high.broadcast(1.0);
        let whole = negative.choose(nearest - one, nearest);
        let back = rest.plus(Self::turns(one));
        let high = negative.choose(back.high, rest.high);
        let low = negative.choose(back.low, rest.low);
        (whole, Self { high, low })
    }
}
