//! Sine, cosine and exponential of all lanes at once, with their remainders
//! ([`crate::numeric::remainders`]).
//!
//! The argument is reduced by Cody and Waite's method with fused products and a tail of its own
//! (two words of pi/2: up to [`MAX_ARGUMENT`] the third would be 1e-28); the kernels are those
//! of fdlibm. Errors are below one unit in the last place.

use super::wide::{Mask, Wide};
use crate::numeric::exponential;
use crate::numeric::real::{Real, polynomial};
use crate::numeric::remainders::{Circular, Decay};
use crate::numeric::two_word::ROUNDER;
use pulp::Simd;
use std::f64::consts::{FRAC_2_PI, FRAC_PI_2, LN_2, LOG2_E};

/// Arguments of sine and cosine up to this size are accepted.
pub const MAX_ARGUMENT: f64 = 1e5;

/// The rest of pi/2 after its first word.
const FRAC_PI_2_LOW: f64 = 6.123_233_995_736_766e-17;
/// The rest of ln 2 after its first word.
const LN_2_LOW: f64 = exponential::LN_2.low;

/// Sine and cosine, radians.
#[inline(always)]
pub fn sin_cos<S: Simd>(x: Wide<S>) -> (Wide<S>, Wide<S>) {
    let rounded = x.times_plus(x.broadcast(FRAC_2_PI), x.broadcast(ROUNDER));
    let quarters = rounded - ROUNDER;
    let low = x.broadcast(FRAC_PI_2_LOW);
    let near = quarters.times_from(x.broadcast(FRAC_PI_2), x);
    let r = quarters.times_from(low, near);
    let tail = quarters.times_from(low, near - r);
    let s = r * r;
    let half = s * 0.5;
    let bent = polynomial(
        s,
        [
            -1.666_666_666_666_663_2e-1,
            8.333_333_333_322_489e-3,
            -1.984_126_982_985_795e-4,
            2.755_731_370_707_006_8e-6,
            -2.505_076_025_340_686_3e-8,
            1.589_690_995_211_55e-10,
        ],
    );
    let sine = r + (r * s).times_plus(bent, half.times_from(tail, tail));
    let sunk = polynomial(
        s,
        [
            4.166_666_666_666_66e-2,
            -1.388_888_888_887_411e-3,
            2.480_158_728_947_673e-5,
            -2.755_731_435_139_066_3e-7,
            2.087_572_321_298_175e-9,
            -1.135_964_755_778_819_5e-11,
        ],
    );
    let flat = -half + 1.0;
    let rest = (-flat + 1.0) - half;
    let cosine = flat + (rest + (s * s).times_plus(sunk, -(r * tail)));
    let odd = rounded.has_bit(1);
    let (sin, cos) = (odd.choose(cosine, sine), odd.choose(sine, cosine));
    let sin = rounded.has_bit(2).choose(-sin, sin);
    let cos = (rounded + 1.0).has_bit(2).choose(-cos, cos);
    (sin, cos)
}

/// exp(-z) for z >= 0; zero below the normal numbers.
#[inline(always)]
fn exp_of_minus<S: Simd>(z: Wide<S>) -> Wide<S> {
    /// The largest z at which exp(-z) is a normal number.
    const MAX_EXPONENT: f64 = 708.0;
    let normal = z.below(MAX_EXPONENT);
    let z = normal.choose(z, z.broadcast(0.0));
    let rounded = z.times_plus(z.broadcast(-LOG2_E), z.broadcast(ROUNDER));
    let power = rounded - ROUNDER;
    let r = power.times_from(z.broadcast(LN_2_LOW), power.times_from(z.broadcast(LN_2), -z));
    let s = r * r;
    let even = polynomial(s, EVEN_COEFFICIENTS);
    let odd = polynomial(s, ODD_COEFFICIENTS);
    let exp = (r + s * r.times_plus(odd, even)) + 1.0;
    normal.choose(exp * rounded.power_of_two(), z.broadcast(0.0))
}

/// 1/2!, 1/4!, ..
const EVEN_COEFFICIENTS: [f64; 7] = [
    0.5,
    4.166_666_666_666_666_4e-2,
    1.388_888_888_888_888_9e-3,
    2.480_158_730_158_730_2e-5,
    2.755_731_922_398_589e-7,
    2.087_675_698_786_809_8e-9,
    1.147_074_559_772_972_5e-11,
];

/// 1/3!, 1/5!, ..
const ODD_COEFFICIENTS: [f64; 7] = [
    1.666_666_666_666_666_6e-1,
    8.333_333_333_333_333e-3,
    1.984_126_984_126_984_1e-4,
    2.755_731_922_398_589_3e-6,
    2.505_210_838_544_172e-8,
    1.605_904_383_682_161_3e-10,
    7.647_163_731_819_816e-13,
];

/// sin x - x over x^3, in powers of x^2.
const SINE_COEFFICIENTS: [f64; 9] = [
    -1.666_666_666_666_666_6e-1,
    8.333_333_333_333_333e-3,
    -1.984_126_984_126_984_1e-4,
    2.755_731_922_398_589_3e-6,
    -2.505_210_838_544_172e-8,
    1.605_904_383_682_161_3e-10,
    -7.647_163_731_819_816e-13,
    2.811_457_254_345_520_6e-15,
    -8.220_635_246_624_329e-18,
];

/// cos x - 1 over x^2, in powers of x^2.
const COSINE_COEFFICIENTS: [f64; 9] = [
    -0.5,
    4.166_666_666_666_666_4e-2,
    -1.388_888_888_888_888_9e-3,
    2.480_158_730_158_730_2e-5,
    -2.755_731_922_398_589e-7,
    2.087_675_698_786_809_8e-9,
    -1.147_074_559_772_972_5e-11,
    4.779_477_332_387_385e-14,
    -1.561_920_696_858_622_6e-16,
];

/// cos x - 1 and (sin x)/x - 1 of x^2 up to 1, of either sign; beyond nothing is promised.
#[inline(always)]
pub fn cosines<S: Simd>(square: Wide<S>) -> (Wide<S>, Wide<S>) {
    (
        square * polynomial(square, COSINE_COEFFICIENTS),
        square * polynomial(square, SINE_COEFFICIENTS),
    )
}

/// Circular functions of `x` up to 1; beyond nothing is promised.
#[inline(always)]
pub fn short_turn<S: Simd>(x: Wide<S>) -> Circular<Wide<S>> {
    let (cos_minus_1, sine) = cosines(x * x);
    let sin_minus_x = x * sine;
    Circular { sin: x + sin_minus_x, cos_minus_1, sin_minus_x }
}

/// Circular functions of `rate * time` (`x`), where `correction` is what rounding took from it.
#[inline(always)]
pub fn turn<S: Simd>(x: Wide<S>, correction: Wide<S>) -> Circular<Wide<S>> {
    let (s, c) = sin_cos(x * 0.5);
    let sin = (s + s) * c;
    let cos_minus_1 = -((s + s) * s);
    let short = x.magnitude().below(1.0);
    let mut sin_minus_x = sin - x;
    if short.any() {
        let square = x * x;
        sin_minus_x = short.choose(x * square * polynomial(square, SINE_COEFFICIENTS), sin_minus_x);
    }
    Circular { sin, cos_minus_1, sin_minus_x }.corrected(correction)
}

/// Circular functions of `rate * time`, the product taken exactly and `rate` with a second word.
#[inline(always)]
pub fn turn_of<S: Simd>(
    rate: Wide<S>,
    rate_low: Option<Wide<S>>,
    time: Wide<S>,
) -> Circular<Wide<S>> {
    let x = rate * time;
    let error = rate.times_plus(time, -x);
    turn(x, rate_low.map_or(error, |low| low.times_plus(time, error)))
}

/// exp(-z) and its remainders, z >= 0.
#[inline(always)]
pub fn shrink<S: Simd>(z: Wide<S>) -> Decay<Wide<S>> {
    let short: Mask<S> = z.below(0.5);
    let mut all = Decay { exp: z, minus_1: z, remainder: z };
    if (!short).any() {
        let exp = exp_of_minus(z);
        let minus_1 = exp - 1.0;
        all = Decay { exp, minus_1, remainder: minus_1 + z };
    }
    if short.any() {
        let square = z * z;
        let even = polynomial(square, EVEN_COEFFICIENTS);
        let odd = polynomial(square, ODD_COEFFICIENTS);
        let remainder = square * z.times_from(odd, even);
        let minus_1 = remainder - z;
        all.exp = short.choose(minus_1 + 1.0, all.exp);
        all.minus_1 = short.choose(minus_1, all.minus_1);
        all.remainder = short.choose(remainder, all.remainder);
    }
    all
}

#[cfg(test)]
#[path = "functions_tests.rs"]
mod tests;
