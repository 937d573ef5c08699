//! The vectors' functions against the library's.

use super::super::instructions::{Instructions, Permit};
use super::super::wide::{LaneValues, MAX_LANES};
use super::*;
use crate::numeric::real::Real;
use crate::numeric::remainders::{Circular, circular, circular_of, decay};
use proptest::prelude::*;
use pulp::WithSimd;

/// Sine and cosine, then the turn of `rate * x`, the decay of |x| and the short turn of x.
struct All<'a> {
    x: &'a LaneValues,
    rate: f64,
    out: &'a mut [LaneValues; 11],
}

impl WithSimd for All<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let x = Wide::load(simd, self.x);
        let (sin, cos) = sin_cos(x);
        let turn = turn_of(x.broadcast(self.rate), None, x);
        let shrink = shrink(x.magnitude());
        let beat = short_turn(x);
        let values = [
            sin,
            cos,
            turn.sin,
            turn.cos_minus_1,
            turn.sin_minus_x,
            shrink.exp,
            shrink.minus_1,
            shrink.remainder,
            beat.sin,
            beat.cos_minus_1,
            beat.sin_minus_x,
        ];
        for (value, column) in values.into_iter().zip(self.out) {
            value.store(column);
        }
    }
}

fn computed(permit: Permit, x: &LaneValues, rate: f64) -> [LaneValues; 11] {
    let mut out = [[0.0; MAX_LANES]; 11];
    let all = All { x, rate, out: &mut out };
    match permit {
        #[cfg(target_arch = "x86_64")]
        Permit::Avx2(simd) => Simd::vectorize(simd, all),
        #[cfg(target_arch = "x86_64")]
        Permit::Avx512(simd) => Simd::vectorize(simd, all),
        #[cfg(target_arch = "aarch64")]
        Permit::Neon(simd) => Simd::vectorize(simd, all),
    }
    out
}

fn close(a: f64, b: f64, ulps: f64, size: f64) -> Result<(), TestCaseError> {
    prop_assert!((a - b).abs() <= ulps * f64::EPSILON * size, "{a:e} {b:e}");
    Ok(())
}

fn agree(x: [f64; MAX_LANES], rate: f64) -> Result<(), TestCaseError> {
    let mut before: Option<[LaneValues; 11]> = None;
    for permit in Instructions::available().into_iter().filter_map(Instructions::permit) {
        let lanes = permit.width();
        let out = computed(permit, &x, rate);
        for (lane, x) in x.iter().enumerate().take(lanes) {
            let [sin, cos, turned, cos_minus_1, sin_minus_x, exp, minus_1, remainder, beat @ ..] =
                out.map(|column| column[lane]);
            let (s, c) = libm::sincos(*x);
            // Half a unit of libm's, and one of ours.
            close(sin, s, 1.0, s.abs())?;
            close(cos, c, 1.0, c.abs())?;
            let product = rate * x;
            let turn = circular_of(product, rate.mul_add(*x, -product));
            // A doubled angle has three roundings, a series alike.
            let size = |value: f64| if product.abs() < 1.0 { value.abs() } else { 1.0 };
            close(turned, turn.sin, 4.0, size(turn.sin))?;
            close(cos_minus_1, turn.cos_minus_1, 4.0, size(turn.cos_minus_1))?;
            close(
                sin_minus_x,
                turn.sin_minus_x,
                4.0,
                turn.sin_minus_x.abs().max(size(turn.sin_minus_x)),
            )?;
            let shrink = decay(x.abs());
            if x.abs() < 700.0 {
                close(exp, shrink.exp, 1.5, shrink.exp)?;
            } else {
                prop_assert!(exp <= 1e-303);
            }
            // The series' remainder has four roundings of half a unit on either side, and up to 1/2
            // it is 0.27 of what it is taken from, which rounds once more; beyond 1/2 it is a sum
            // of larger numbers.
            close(minus_1, shrink.minus_1, 2.0 * (0.27 * 2.0 + 0.5), shrink.minus_1.abs())?;
            let size = if x.abs() < 0.5 { shrink.remainder } else { x.abs() };
            close(remainder, shrink.remainder, 2.0 * 2.0, size)?;
            if x.abs() <= 1.0 {
                let Circular { sin, cos_minus_1, sin_minus_x } = circular(*x);
                for (found, expected) in beat.into_iter().zip([sin, cos_minus_1, sin_minus_x]) {
                    close(found, expected, 4.0, expected.abs())?;
                }
            }
            if let Some(before) = &before
                && lane < 2
            {
                for (a, b) in before.iter().zip(&out) {
                    prop_assert_eq!(a[lane].to_bits(), b[lane].to_bits());
                }
            }
        }
        before = Some(out);
    }
    Ok(())
}

proptest! {
    #[test]
    fn functions_are_those_of_the_library(
        x in prop::array::uniform8(-40.0..40.0_f64), rate in 0.1..10.0_f64,
    ) {
        agree(x, rate)?;
    }

    #[test]
    fn and_for_small_and_large_arguments(
        (x, e) in (prop::array::uniform8(-1.0..1.0_f64), -12..5_i32), rate in 0.1..1.0_f64,
    ) {
        agree(x.map(|x| x * 10.0_f64.powi(e)), rate)?;
    }
}

/// Two sides that round in opposite directions.
#[test]
fn a_remainder_at_the_edge_of_its_roundings() -> Result<(), TestCaseError> {
    agree([-0.054_616_129_814_834_87; MAX_LANES], 0.1)
}

#[test]
fn sines_next_to_multiples_of_a_quarter_turn() -> Result<(), TestCaseError> {
    for k in [1, 2, 3, 7, 100, 62_831] {
        let x = f64::from(k) * FRAC_PI_2;
        agree([x; MAX_LANES], 1.0)?;
        agree([x.next_up(); MAX_LANES], 1.0)?;
    }
    Ok(())
}
