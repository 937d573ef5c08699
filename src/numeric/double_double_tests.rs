//! Digits of the arithmetic of 106 bits.

use super::*;

/// Words of the result, computed with mpmath 1.3.0 at 400 bits.
type Words = (f64, f64);

#[rustfmt::skip] // one angle a line
const SINES: [(f64, Words, Words); 12] = [
    (0.5, (0.479_425_538_604_203, -5.103_969_860_556_013e-18), (0.877_582_561_890_372_8, -4.262_314_986_427_999_7e-17)),
    (-7.25, (-0.823_080_879_011_505_5, 4.782_695_371_371_335e-17), (0.567_924_173_288_694_8, 4.202_033_681_904_503e-17)),
    (22.0, (-0.008_851_309_290_403_876, 2.848_530_308_922_005_7e-19), (-0.999_960_826_394_637_1, -8.516_033_800_174_13e-19)),
    (0.785_398_163_397_448_3, (0.707_106_781_186_547_5, 4.103_693_448_936_375_5e-17), (0.707_106_781_186_547_6, -2.668_756_516_137_723_2e-17)),
    (1.570_796_326_794_896_6, (1.0, -1.874_699_728_327_322e-33), (6.123_233_995_736_766e-17, -1.497_384_904_859_169_8e-33)),
    (102_889_496.75, (6.341_790_129_909_192e-10, -3.247_170_419_738_065e-26), (1.0, -2.010_915_102_590_681_8e-19)),
    (100_000_000.0, (0.931_639_027_109_726, -6.480_822_977_380_808e-18), (-0.363_385_089_355_690_5, -2.682_587_018_538_354e-17)),
    (99_999_999.25, (0.929_367_267_664_003_8, -2.194_848_162_211_211_4e-17), (0.369_156_446_232_141_5, -1.079_279_329_713_338_4e-17)),
    (134_217_728.0, (-0.763_403_228_801_980_7, -6.465_334_934_223_495_5e-18), (0.645_922_216_876_545_2, -1.916_914_392_999_246_6e-17)),
    (1_000_000_000.0, (0.545_843_449_448_699_6, 6.175_733_356_664_077_5e-18), (0.837_887_181_363_902_4, -5.471_871_328_928_243_7e-17)),
    (987_654_321_012_345.0, (0.958_119_058_342_507_3, -3.654_471_010_477_976e-17), (-0.286_370_162_623_250_8, 1.010_247_504_935_961_8e-17)),
    (1_125_899_906_842_624.0, (0.496_396_515_208_940_85, -6.364_514_909_136_962e-18), (0.868_095_904_660_550_6, -3.917_110_841_640_398e-17)),
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
    ((found - expected) / expected).to_f64().abs() / DoubleDouble::UNIT
}

/// The library's own bounds: 3 a sum, 4 a product, 6 a quotient; a series adds a handful of them.
const ELEMENTARY_UNITS: f64 = 8.0;

#[test]
fn exponential_is_good_to_the_last_digits() {
    for (x, expected) in EXPONENTIALS {
        let error = units(DoubleDouble::exact(x).exp(), expected);
        assert!(error <= ELEMENTARY_UNITS, "exp({x}): {error} units");
    }
}

#[test]
fn sine_and_cosine_are_good_to_the_last_digits_up_to_2_to_the_50() {
    for (x, sine, cosine) in SINES {
        let (sin, cos) = DoubleDouble::exact(x).sin_cos();
        let errors = [units(sin, sine), units(cos, cosine)];
        assert!(errors.iter().all(|e| *e <= ELEMENTARY_UNITS), "angle {x}: {errors:?} units");
    }
}

#[test]
fn the_second_word_of_a_large_angle_counts() {
    let ((high, low), sine) = TWO_WORD_SINE;
    let error = units(DoubleDouble::new(high, low).sin_cos().0, sine);
    assert!(error <= ELEMENTARY_UNITS, "{error} units");
}

#[test]
fn square_root_is_good_to_the_last_digits() {
    for (xi, expected) in DAMPED_FREQUENCIES {
        let (nu, lost) = DoubleDouble::damped_frequency(DoubleDouble::exact(xi));
        assert!(
            lost.to_f64().abs() <= ELEMENTARY_UNITS * DoubleDouble::UNIT * expected.0,
            "xi = {xi}: {lost:?}"
        );
        let error = units(nu, expected);
        assert!(error <= ELEMENTARY_UNITS, "xi = {xi}: {error} units");
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

/// Products of integers of up to 70 bits, whose last bits 106 do not hold.
#[test]
fn what_a_product_loses_is_known() {
    let integer = |n: i128| {
        let high = n as f64;
        DoubleDouble::new(high, (n - high as i128) as f64)
    };
    for (a, b) in [(0x2f_3a91_c44e_9d17_5b61_i128, 0x31_7d05_93ab_77e9_10c3_i128), (12_345, 7)] {
        let product = integer(a) * integer(b);
        let lost = integer(a).product_error(integer(b));
        // Modulo 2^64 no bit of any of them is lost.
        let low_bits = |x: DoubleDouble| {
            let (high, low) = x.words();
            wrapped(high).wrapping_add(wrapped(low))
        };
        let sum = low_bits(product).wrapping_add(low_bits(lost));
        assert_eq!(sum, (a as u64).wrapping_mul(b as u64), "{product:?} {lost:?}");
    }
}

/// A whole number modulo 2^64.
fn wrapped(x: f64) -> u64 {
    let bits = x.abs().to_bits();
    let (mantissa, exponent) = (bits & ((1 << 52) - 1) | 1 << 52, (bits >> 52) as i64 - 1075);
    let size = match exponent {
        _ if x == 0.0 => 0,
        64.. => 0,
        0..64 => mantissa << exponent,
        -52..0 => mantissa >> -exponent,
        _ => 0,
    };
    if x < 0.0 { size.wrapping_neg() } else { size }
}

#[test]
fn an_angle_beyond_the_reduction_is_no_number() {
    for angle in [1.01 * DoubleDouble::MAX_ANGLE, f64::NAN, f64::NEG_INFINITY] {
        let (sin, cos) = DoubleDouble::exact(angle).sin_cos();
        assert!(sin.to_f64().is_nan() && cos.to_f64().is_nan());
    }
    assert_eq!(DoubleDouble::exact(-1e6).exp().to_f64(), 0.0);
}

/// The argument is half-way between two multiples of log(2)/128, at which `xprec` would panic.
#[test]
fn the_exponential_is_good_at_a_tie_of_its_reduction() {
    let part = std::f64::consts::LN_2 / 128.0;
    for n in 0..2000 {
        let half = DoubleDouble::new(-(f64::from(n) + 0.5) * part, 1e-19);
        let (whole, parts) = (half.exp(), (half * DoubleDouble::exact(0.5)).exp());
        let off = (whole - parts * parts).to_f64().abs();
        assert!(off <= 64.0 * DoubleDouble::UNIT * whole.to_f64(), "{n}: {off:e}");
    }
}
