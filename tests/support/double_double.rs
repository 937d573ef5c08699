//! Arithmetic of 106 bits for the truth: the same closed forms, evaluated in double-double.
//!
//! Sums, products, quotients, square root and exponential are those of `xprec` (Joldes, Muller and
//! Popescu 2017: a few units of 2^-106 each). Its sine reduces the argument by two words of pi/2 and
//! is used inside one quadrant only; the reduction is done here, in three words.
#![allow(dead_code)] // every test uses its own part

use percuss::number::Number;
use percuss::two_word::TwoWord;
use std::fmt;
use std::ops::{Add, Div, Mul, Neg, Sub};
use xprec::Df64;
use xprec::arith::mul_dd;

/// An unevaluated sum of two f64.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
pub struct DoubleDouble(Df64);

/// 2^-106, half the distance from one to the next number: the unit of this arithmetic.
pub const UNIT: f64 = f64::EPSILON * f64::EPSILON / 4.0;

/// The largest argument of sine and cosine: beyond it the turns that are taken off no longer leave
/// 106 bits, and the argument itself carries fewer than 79 bits behind the point.
pub const LARGEST_ANGLE: f64 = 134_217_728.0; // 2^27

impl DoubleDouble {
    /// The sum of two words in any order.
    pub fn new(high: f64, low: f64) -> Self {
        let TwoWord { high, low } = TwoWord::sum(high, low);
        Self(Df64::new_full(high, low))
    }

    /// The number rounded to f64, and what that leaves.
    pub fn words(self) -> (f64, f64) {
        (self.0.hi(), self.0.lo())
    }

    /// A small whole number of times.
    pub fn times(self, factor: f64) -> Self {
        Self(self.0 * factor)
    }
}

impl From<TwoWord> for DoubleDouble {
    fn from(value: TwoWord) -> Self {
        Self::new(value.high, value.low)
    }
}

impl fmt::Debug for DoubleDouble {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:e} + {:e}", self.0.hi(), self.0.lo())
    }
}

impl Add for DoubleDouble {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl Sub for DoubleDouble {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0)
    }
}

impl Mul for DoubleDouble {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self(self.0 * other.0)
    }
}

impl Div for DoubleDouble {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        Self(self.0 / other.0)
    }
}

impl Neg for DoubleDouble {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Number for DoubleDouble {
    const TERMS: usize = 14;

    fn exact(value: f64) -> Self {
        Self(Df64::new(value))
    }

    fn to_f64(self) -> f64 {
        self.0.hi()
    }

    fn sin_cos(self) -> (Self, Self) {
        let (quadrant, rest) = first_quadrant(self.0);
        let (sin, cos) = rest.sin_cos();
        let (sin, cos) = match quadrant {
            0 => (sin, cos),
            1 => (cos, -sin),
            2 => (-sin, -cos),
            _ => (-cos, sin),
        };
        (Self(sin), Self(cos))
    }

    fn exp(self) -> Self {
        Self(self.0.exp())
    }

    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }

    fn product_error(self, _: Self) -> Self {
        Self::zero()
    }

    fn damped_frequency(xi: Self) -> (Self, Self) {
        (((Self::one() - xi) * (Self::one() + xi)).sqrt(), Self::zero())
    }

    fn inverse_factorial(n: usize) -> Self {
        let (high, low) = INVERSE_FACTORIALS[n];
        Self(Df64::new_full(high, low))
    }
}

/// pi/2 in three words: 2^-162 of it is missing.
const HALF_PI: [f64; 3] =
    [std::f64::consts::FRAC_PI_2, 6.123_233_995_736_766e-17, -1.497_384_904_859_169_8e-33];

/// Takes whole quarter turns off: how many of them modulo four, and a rest of at most an eighth turn.
fn first_quadrant(x: Df64) -> (i64, Df64) {
    assert!(x.hi().abs() <= LARGEST_ANGLE, "angle {x:?} is too large for three words of pi");
    let turns = (x.hi() / HALF_PI[0]).round();
    // Each product is exact in two words, and each difference is good to 3 units of itself.
    let rest = HALF_PI.iter().fold(x, |rest, word| rest - mul_dd(turns, *word));
    ((turns as i64).rem_euclid(4), rest)
}

/// 1/n! to 106 bits; computed with mpmath 1.3.0 at 400 bits.
const INVERSE_FACTORIALS: [(f64, f64); 31] = [
    (1.0, 0.0),
    (1.0, 0.0),
    (0.5, 0.0),
    (0.166_666_666_666_666_66, 9.251_858_538_542_97e-18),
    (0.041_666_666_666_666_664, 2.312_964_634_635_742_7e-18),
    (0.008_333_333_333_333_333, 1.156_482_317_317_871_4e-19),
    (0.001_388_888_888_888_889, -5.300_543_954_373_577e-20),
    (0.000_198_412_698_412_698_4, 1.720_955_829_342_070_5e-22),
    (2.480_158_730_158_73e-5, 2.151_194_786_677_588_2e-23),
    (2.755_731_922_398_589_3e-6, -1.858_393_274_046_472e-22),
    (2.755_731_922_398_589e-7, 2.376_771_462_225_029_7e-23),
    (2.505_210_838_544_172e-8, -1.448_814_070_935_912e-24),
    (2.087_675_698_786_81e-9, -1.207_345_059_113_26e-25),
    (1.605_904_383_682_161_3e-10, 1.258_529_458_875_209_8e-26),
    (1.147_074_559_772_972_5e-11, 2.065_551_275_283_074_5e-28),
    (7.647_163_731_819_816e-13, 7.038_728_777_334_53e-30),
    (4.779_477_332_387_385e-14, 4.399_205_485_834_081e-31),
    (2.811_457_254_345_520_6e-15, 1.650_884_273_086_143_3e-31),
    (1.561_920_696_858_622_5e-16, 1.191_067_966_027_375_4e-32),
    (8.220_635_246_624_33e-18, 2.214_189_411_960_426_5e-34),
    (4.110_317_623_312_165e-19, 1.441_297_337_865_952_7e-36),
    (1.957_294_106_339_126_3e-20, -1.364_350_383_008_790_8e-36),
    (8.896_791_392_450_574e-22, -7.911_402_614_872_376e-38),
    (3.868_170_170_630_684e-23, -8.843_177_655_482_344e-40),
    (1.611_737_571_096_118_4e-24, -3.684_657_356_450_976_6e-41),
    (6.446_950_284_384_474e-26, -1.933_040_423_370_346_5e-42),
    (2.479_596_263_224_797_6e-27, -1.295_373_096_476_522_9e-43),
    (9.183_689_863_795_546e-29, 1.430_315_039_678_732_2e-45),
    (3.279_889_237_069_838e-30, 1.511_754_274_402_987_9e-46),
    (1.130_996_288_644_771_6e-31, 1.049_801_541_295_950_6e-47),
    (3.769_987_628_815_905_4e-33, 2.587_034_783_275_032_4e-49),
];

#[cfg(test)]
#[allow(clippy::approx_constant)] // they are the words that were computed
mod tests {
    use super::*;

    /// Words of the result, computed with mpmath 1.3.0 at 400 bits.
    type Words = (f64, f64);

    #[rustfmt::skip] // one angle a line
    const SINES: [(f64, Words, Words); 9] = [
        (0.5, (0.479_425_538_604_203, -5.103_969_860_556_013e-18), (0.877_582_561_890_372_8, -4.262_314_986_427_999_7e-17)),
        (-7.25, (-0.823_080_879_011_505_5, 4.782_695_371_371_335e-17), (0.567_924_173_288_694_8, 4.202_033_681_904_503e-17)),
        (22.0, (-0.008_851_309_290_403_876, 2.848_530_308_922_005_7e-19), (-0.999_960_826_394_637_1, -8.516_033_800_174_13e-19)),
        (0.785_398_163_397_448_3, (0.707_106_781_186_547_5, 4.103_693_448_936_375_5e-17), (0.707_106_781_186_547_6, -2.668_756_516_137_723_2e-17)),
        (1.570_796_326_794_896_6, (1.0, -1.874_699_728_327_322e-33), (6.123_233_995_736_766e-17, -1.497_384_904_859_169_8e-33)),
        (102_889_496.75, (6.341_790_129_909_192e-10, -3.247_170_419_738_065e-26), (1.0, -2.010_915_102_590_681_8e-19)),
        (100_000_000.0, (0.931_639_027_109_726, -6.480_822_977_380_808e-18), (-0.363_385_089_355_690_5, -2.682_587_018_538_354e-17)),
        (99_999_999.25, (0.929_367_267_664_003_8, -2.194_848_162_211_211_4e-17), (0.369_156_446_232_141_5, -1.079_279_329_713_338_4e-17)),
        (134_217_728.0, (-0.763_403_228_801_980_7, -6.465_334_934_223_495_5e-18), (0.645_922_216_876_545_2, -1.916_914_392_999_246_6e-17)),
    ];

    const EXPONENTIALS: [(f64, Words); 8] = [
        (-600.0, (2.650_396_553_004_310_8e-261, 6.377_342_817_491_395e-278)),
        (-40.0, (4.248_354_255_291_589e-18, 1.243_747_080_264_577_3e-34)),
        (-7.3, (0.000_675_538_775_193_844_4, -2.907_750_493_846_276_6e-20)),
        (-0.346_573_590_279_972_64, (0.707_106_781_186_547_6, -4.013_739_792_746_569e-17)),
        (-0.1, (0.904_837_418_035_959_5, 5.055_984_668_733_208e-17)),
        (-1.0e-9, (0.999_999_999, -2.778_193_152_587_354e-17)),
        (1.0, (2.718_281_828_459_045, 1.445_646_891_729_250_2e-16)),
        (10.5, (36_315.502_674_246_636, 1.577_797_006_387_782e-12)),
    ];

    const DAMPED_FREQUENCIES: [(f64, Words); 5] = [
        (1.0e-8, (1.0, -5.000_000_000_000_000_5e-17)),
        (0.01, (0.999_949_998_749_937_5, -1.145_586_374_975_205e-17)),
        (0.1, (0.994_987_437_106_62, -1.102_260_062_457_697_6e-17)),
        (0.9, (0.435_889_894_354_067_33, -2.159_544_370_813_405_4e-17)),
        (0.999_999, (0.001_414_213_208_839_993_6, -6.094_815_512_858_041e-21)),
    ];

    /// 2^26 + 1/3 in two words, and its sine.
    const TWO_WORD_SINE: (Words, Words) = (
        (67_108_864.333_333_33, 4.967_053_731_282_552e-9),
        (0.100_778_107_857_897_34, 2.026_987_514_197_314e-18),
    );

    /// Relative difference in units of 2^-106.
    fn units(found: DoubleDouble, expected: Words) -> f64 {
        let expected = DoubleDouble::new(expected.0, expected.1);
        ((found - expected) / expected).to_f64().abs() / UNIT
    }

    /// The library's own bounds: 3 a sum, 4 a product, 6 a quotient; a series adds a handful of them.
    const ELEMENTARY: f64 = 8.0;

    #[test]
    fn exponential_is_good_to_the_last_digits() {
        for (x, expected) in EXPONENTIALS {
            let error = units(DoubleDouble::exact(x).exp(), expected);
            assert!(error <= ELEMENTARY, "exp({x}): {error} units");
        }
    }

    #[test]
    fn sine_and_cosine_are_good_to_the_last_digits_up_to_1e8() {
        for (x, sine, cosine) in SINES {
            let (sin, cos) = DoubleDouble::exact(x).sin_cos();
            let errors = [units(sin, sine), units(cos, cosine)];
            assert!(errors.iter().all(|e| *e <= ELEMENTARY), "angle {x}: {errors:?} units");
        }
    }

    #[test]
    fn the_second_word_of_a_large_angle_counts() {
        let ((high, low), sine) = TWO_WORD_SINE;
        let error = units(DoubleDouble::new(high, low).sin_cos().0, sine);
        assert!(error <= ELEMENTARY, "{error} units");
    }

    #[test]
    fn square_root_is_good_to_the_last_digits() {
        for (xi, expected) in DAMPED_FREQUENCIES {
            let (nu, lost) = DoubleDouble::damped_frequency(DoubleDouble::exact(xi));
            assert_eq!(lost.to_f64(), 0.0);
            let error = units(nu, expected);
            assert!(error <= ELEMENTARY, "xi = {xi}: {error} units");
        }
    }

    #[test]
    fn factorials_undo_their_inverses() {
        let mut factorial = DoubleDouble::one();
        for n in 1..=2 * DoubleDouble::TERMS + 2 {
            factorial = factorial.times(n as f64); // exact: 30! has 82 bits before its zeros
            let error = units(factorial * DoubleDouble::inverse_factorial(n), (1.0, 0.0));
            assert!(error <= 4.0, "1/{n}!: {error} units");
        }
    }

    #[test]
    #[should_panic(expected = "too large")]
    fn an_angle_beyond_the_reduction_is_refused() {
        let _ = DoubleDouble::exact(1e9).sin_cos();
    }
}
