//! Arithmetic of 106 bits, in double-double: for proved runs, and for the truths of tests.
//!
//! Sums, products, quotients, square root and exponential are those of `xprec` (Joldes, Muller and
//! Popescu 2017: a few units of 2^-106 each). Its sine reduces the argument by two words of pi/2
//! and is used inside one quadrant only; the reduction is done here, in three words.

use super::number::{self, Number};
use super::two_word::TwoWord;
use std::fmt;
use std::ops::{Add, Div, Mul, Neg, Sub};
use xprec::Df64;
use xprec::arith::mul_dd;

/// A number of 106 bits, about 32 decimal digits: an unevaluated sum of two `f64`.
///
/// ```
/// use percuss::DoubleDouble;
///
/// let [one, three] = [1.0, 3.0].map(|it| DoubleDouble::new(it, 0.0));
/// let third = one / three;
/// assert_eq!(third.to_f64(), 1.0 / 3.0);
/// assert_eq!(format!("{third:.30}"), "0.333333333333333333333333333333");
/// assert!((third * three - one).to_f64().abs() <= 8.0 * DoubleDouble::UNIT);
/// ```
#[derive(Clone, Copy, PartialEq, PartialOrd)]
pub struct DoubleDouble(Df64);

impl DoubleDouble {
    /// 2^-106, half the distance from one to the next number: the unit of this arithmetic.
    pub const UNIT: f64 = f64::EPSILON * f64::EPSILON / 4.0;

    /// The largest argument of sine and cosine, 2^50: up to it a quotient by a quarter turn is good
    /// to an eighth of one. Beyond it both are NaN.
    pub const MAX_ANGLE: f64 = 1_125_899_906_842_624.0;

    /// The sum of two words in any order.
    #[must_use]
    pub fn new(high: f64, low: f64) -> Self {
        let TwoWord { high, low } = TwoWord::sum(high, low);
        Self(Df64::new_full(high, low))
    }

    /// The number rounded to f64, and what that leaves.
    #[must_use]
    pub fn words(self) -> (f64, f64) {
        (self.0.hi(), self.0.lo())
    }

    /// The number rounded to f64.
    #[must_use]
    pub fn to_f64(self) -> f64 {
        self.0.hi()
    }

    /// A small whole number of times.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        Self(self.0 * factor)
    }
}

impl From<DoubleDouble> for TwoWord {
    fn from(value: DoubleDouble) -> Self {
        let (high, low) = value.words();
        Self { high, low }
    }
}

impl From<TwoWord> for DoubleDouble {
    fn from(value: TwoWord) -> Self {
        Self::new(value.high, value.low)
    }
}

impl Default for DoubleDouble {
    fn default() -> Self {
        Self::exact(0.0)
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

    const WORDS: usize = 2;

    type Bound = f64;

    /// Four units of 2^-106, because each operation is good to a few of them.
    #[inline]
    fn unit() -> f64 {
        4.0 * Self::UNIT
    }

    #[inline]
    fn bound(self) -> f64 {
        self.0.hi()
    }

    #[inline]
    fn of_bound(bound: f64) -> Self {
        Self::exact(bound)
    }

    fn scaled(self, exponent: i64) -> Self {
        let (high, low) = self.words();
        let [high, low] = [high, low].map(|it| number::Bound::scaled(it, exponent));
        Self::new(high, low)
    }

    fn exact(value: f64) -> Self {
        Self(Df64::new(value))
    }

    fn to_f64(self) -> f64 {
        self.0.hi()
    }

    fn sin_cos(self) -> (Self, Self) {
        // Written so that a NaN stays one.
        if self.0.hi().abs() <= Self::MAX_ANGLE {
            return sin_cos(self);
        }
        (Self::exact(f64::NAN), Self::exact(f64::NAN))
    }

    fn exp(self) -> Self {
        /// The parts of a logarithm of two by multiples of which `xprec` reduces an argument, and
        /// the distance from a tie of two multiples within which it refuses one.
        const PARTS: f64 = 128.0 / std::f64::consts::LN_2;
        const TIE_DISTANCE: f64 = 1e-6;
        /// 0.36 of such a part.
        const STEP: f64 = 1.0 / 512.0;
        let share = (self.0.hi() * PARTS).fract().abs();
        if (share - 0.5).abs() > TIE_DISTANCE {
            return Self(self.0.exp());
        }
        let step = Self::exact(STEP);
        Self((self - step).0.exp()) * Self(step.0.exp())
    }

    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }

    fn product_error(self, other: Self) -> Self {
        let (rounded, whole) = (self * other, TwoWord::product(self.0.hi(), other.0.hi()));
        let crossed = [(self.0.hi(), other.0.lo()), (self.0.lo(), other.0.hi())];
        let [crossed, counter] = crossed.map(|(a, b)| Self::from(TwoWord::product(a, b)));
        let last = Self::exact(self.0.lo() * other.0.lo());
        // The parts of a unit that are left are summed when the large ones have cancelled.
        (Self::from(whole) - rounded) + crossed + counter + last
    }

    /// The second word of each is worth having for light damping, where phases are long.
    fn damped_frequency(xi: Self) -> (Self, Self) {
        let (one, xi_square) = (Self::one(), xi * xi);
        let square = one - xi_square;
        let lost = ((one - square) - xi_square) - xi.product_error(xi);
        let nu = square.sqrt();
        let rest = (square - nu * nu) - nu.product_error(nu) + lost;
        (nu, rest / (nu + nu))
    }

    fn inverse_factorial(n: usize) -> Self {
        let (high, low) = INVERSE_FACTORIALS[n];
        Self(Df64::new_full(high, low))
    }
}

/// pi/2 in four words: 2^-217 of it is missing.
const HALF_PI: [f64; 4] = [
    std::f64::consts::FRAC_PI_2,
    6.123_233_995_736_766e-17,
    -1.497_384_904_859_169_8e-33,
    5.562_271_104_316_826e-50,
];

fn sin_cos(x: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
    let (quadrant, rest) = first_quadrant(x.0);
    let (sin, cos) = rest.sin_cos();
    let (sin, cos) = match quadrant {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    };
    (DoubleDouble(sin), DoubleDouble(cos))
}

/// Takes whole quarter turns off: how many of them modulo four, and a rest of at most an eighth
/// turn.
fn first_quadrant(x: Df64) -> (i64, Df64) {
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
#[path = "double_double_tests.rs"]
#[allow(clippy::approx_constant)] // they are the words that were computed
mod tests;
