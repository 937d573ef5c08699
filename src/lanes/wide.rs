//! One f64 a lane, with the arithmetic of a number.
//!
//! A product and a sum are fused only where [`Real::times_plus`] says so, and no operation looks at
//! a neighbouring lane: every instruction set gives the same bits, whatever its width.

use crate::numeric::real::Real;
use pulp::Simd;
use pulp::bytemuck::cast_slice_mut;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// The number of lanes of the widest instruction set.
pub const MAX_LANES: usize = 8;

/// A value of each lane in memory.
pub type LaneValues = [f64; MAX_LANES];

/// One f64 per lane.
#[derive(Clone, Copy, Debug)]
pub struct Wide<S: Simd> {
    simd: S,
    value: S::f64s,
}

/// One truth value per lane.
#[derive(Clone, Copy, Debug)]
pub struct Mask<S: Simd> {
    simd: S,
    value: S::m64s,
}

impl<S: Simd> Wide<S> {
    /// One number in all lanes.
    #[inline(always)]
    pub fn splat(simd: S, value: f64) -> Self {
        Self { simd, value: simd.splat_f64s(value) }
    }

    /// The first lanes of a column.
    #[inline(always)]
    pub fn load(simd: S, column: &LaneValues) -> Self {
        Self { simd, value: S::as_simd_f64s(column).0[0] }
    }

    /// Writes the lanes to the first places of a column.
    #[inline(always)]
    pub fn store(self, column: &mut LaneValues) {
        S::as_mut_simd_f64s(column).0[0] = self.value;
    }

    /// The square root.
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        Self { value: self.simd.sqrt_f64s(self.value), ..self }
    }

    /// The lanes in which it is less than a number.
    #[inline(always)]
    pub fn below(self, other: f64) -> Mask<S> {
        self.less(self.broadcast(other))
    }

    /// The lanes in which it is greater than a number.
    #[inline(always)]
    pub fn above(self, other: f64) -> Mask<S> {
        self.broadcast(other).less(self)
    }

    /// The lanes in which it is this number.
    #[inline(always)]
    pub fn is(self, other: f64) -> Mask<S> {
        let other = self.simd.splat_f64s(other);
        Mask { simd: self.simd, value: self.simd.equal_f64s(self.value, other) }
    }

    /// The lanes in which a bit of a whole number is set; the number stands in the lowest bits of
    /// its sum with [`ROUNDER`](crate::numeric::two_word::ROUNDER).
    #[inline(always)]
    pub fn has_bit(self, bit: u64) -> Mask<S> {
        let simd = self.simd;
        let bits = simd.transmute_u64s_f64s(self.value);
        let found = simd.and_u64s(bits, simd.splat_u64s(bit));
        Mask { simd, value: simd.greater_than_u64s(found, simd.splat_u64s(0)) }
    }

    /// 2^n of a sum n + [`crate::numeric::two_word::ROUNDER`], for the exponents of normal numbers.
    #[inline(always)]
    pub fn power_of_two(self) -> Self {
        const EXPONENT_BIAS: u64 = 1023;
        let mut value = [self.value];
        for word in cast_slice_mut::<S::f64s, u64>(&mut value) {
            *word = word.wrapping_add(EXPONENT_BIAS) << 52;
        }
        Self { value: value[0], ..self }
    }
}

impl<S: Simd> Real for Wide<S> {
    type Mask = Mask<S>;

    #[inline(always)]
    fn broadcast(self, value: f64) -> Self {
        Self::splat(self.simd, value)
    }

    #[inline(always)]
    fn times_plus(self, factor: Self, term: Self) -> Self {
        Self { value: self.simd.mul_add_f64s(self.value, factor.value, term.value), ..self }
    }

    #[inline(always)]
    fn times_from(self, factor: Self, term: Self) -> Self {
        (-self).times_plus(factor, term)
    }

    #[inline(always)]
    fn magnitude(self) -> Self {
        Self { value: self.simd.abs_f64s(self.value), ..self }
    }

    #[inline(always)]
    fn less(self, other: Self) -> Mask<S> {
        Mask { simd: self.simd, value: self.simd.less_than_f64s(self.value, other.value) }
    }

    #[inline(always)]
    fn choose(mask: Mask<S>, yes: Self, no: Self) -> Self {
        mask.choose(yes, no)
    }
}

impl<S: Simd> Mask<S> {
    /// Takes one value where the mask holds, the other elsewhere.
    #[inline(always)]
    pub fn choose(self, yes: Wide<S>, no: Wide<S>) -> Wide<S> {
        Wide { simd: self.simd, value: self.simd.select_f64s(self.value, yes.value, no.value) }
    }

    /// Whether it holds in some lane.
    #[inline(always)]
    pub fn any(self) -> bool {
        self.simd.first_true_m64s(self.value) < S::F64_LANES
    }

    /// One where the mask holds, zero elsewhere.
    #[inline(always)]
    pub fn number(self) -> Wide<S> {
        self.choose(Wide::splat(self.simd, 1.0), Wide::splat(self.simd, 0.0))
    }
}

macro_rules! operator {
    ($operator:ident, $method:ident, $simd:ident) => {
        impl<S: Simd> $operator for Wide<S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self { value: self.simd.$simd(self.value, other.value), ..self }
            }
        }

        impl<S: Simd> $operator<f64> for Wide<S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                self.$method(self.broadcast(other))
            }
        }
    };
}

operator!(Add, add, add_f64s);
operator!(Sub, sub, sub_f64s);
operator!(Mul, mul, mul_f64s);
operator!(Div, div, div_f64s);

impl<S: Simd> Neg for Wide<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        // pulp's own negation is inlined only if the compiler likes, and a call without vectors
        // otherwise.
        let sign = self.simd.splat_f64s(-0.0);
        Self { value: self.simd.xor_f64s(self.value, sign), ..self }
    }
}

impl<S: Simd> BitAnd for Mask<S> {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self { value: self.simd.and_m64s(self.value, other.value), ..self }
    }
}

impl<S: Simd> BitOr for Mask<S> {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self { value: self.simd.or_m64s(self.value, other.value), ..self }
    }
}

impl<S: Simd> Not for Mask<S> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self { value: self.simd.not_m64s(self.value), ..self }
    }
}
