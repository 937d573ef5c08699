//! Aberth's iteration for the roots of a polynomial, all of them at a time: in f64 as far as that
//! goes, because its steps cost a hundredth, and from there in wide numbers.

use crate::affine::arithmetic::real::{BigComplex, BigReal};
use crate::affine::model::rational::Rational;
use crate::numeric::complex::Complex;

/// The number of steps of all roots after which the iteration is given up.
const MAX_ROUNDS: usize = 2000;

/// The number of steps of all roots in f64 after which wide numbers begin where f64 began.
const MAX_ROUNDS_IN_F64: usize = 100;

/// A step in f64 that moves a root by a smaller share of it is the last one.
const LAST_STEP_IN_F64: f64 = 1e-10;

/// Roots in f64 that differ by a smaller share of them may be rounding's: wide numbers begin where
/// f64 began.
const MIN_GAP_IN_F64: f64 = 1e-5;

/// Coefficients in f64 may be smaller than the largest one by this power of two, so that products
/// of them and of roots do not underflow.
const MAX_SPREAD_IN_F64: f64 = 400.0;

/// The roots of a polynomial that has each once, and none at zero: a conjugate pair has both there.
/// None if the iteration does not converge.
pub fn roots_away_from_zero(polynomial: &[Rational], bits: usize) -> Option<Vec<BigComplex>> {
    let coefficients: Vec<_> = polynomial.iter().map(|it| BigReal::new(it, bits)).collect();
    if let [constant, linear] = &coefficients[..] {
        return Some(vec![BigComplex::real(&-constant / linear)]);
    }
    let heights: Vec<f64> = coefficients.iter().map(logarithm).collect();
    let starts = beginnings(&heights);
    let starts = in_f64(&coefficients, &heights, &starts).unwrap_or(starts);
    let small = |step: &BigComplex, root: &BigComplex| {
        // A step that moves a root by less than the last quarter of its bits.
        let last = 3 * step.re.bits() as isize / 4;
        step.norm_square() <= root.norm_square().scaled(-2 * last)
    };
    let coefficients: Vec<_> = coefficients.into_iter().map(BigComplex::real).collect();
    iterated(&coefficients, starts, MAX_ROUNDS, &small)
}

/// A complex number of the iteration.
trait Scalar: Clone {
    fn zero() -> Self;
    fn is_zero(&self) -> bool;
    fn plus(&self, other: &Self) -> Self;
    fn less(&self, other: &Self) -> Self;
    fn times(&self, other: &Self) -> Self;
    fn inverse(&self) -> Self;
}

impl Scalar for BigComplex {
    fn zero() -> Self {
        Self::real(BigReal::zero())
    }

    fn is_zero(&self) -> bool {
        self.re.is_zero() && self.im.is_zero()
    }

    fn plus(&self, other: &Self) -> Self {
        self + other
    }

    fn less(&self, other: &Self) -> Self {
        self - other
    }

    fn times(&self, other: &Self) -> Self {
        self * other
    }

    fn inverse(&self) -> Self {
        Self::inverse(self)
    }
}

impl Scalar for Complex<f64> {
    fn zero() -> Self {
        Self::new(0.0, 0.0)
    }

    fn is_zero(&self) -> bool {
        self.re == 0.0 && self.im == 0.0
    }

    fn plus(&self, other: &Self) -> Self {
        *self + *other
    }

    fn less(&self, other: &Self) -> Self {
        *self - *other
    }

    fn times(&self, other: &Self) -> Self {
        *self * *other
    }

    fn inverse(&self) -> Self {
        Self::inverse(*self)
    }
}

/// The roots from these starts, when all steps are small.
fn iterated<C: Scalar>(
    coefficients: &[C],
    mut roots: Vec<C>,
    rounds: usize,
    is_small: &dyn Fn(&C, &C) -> bool,
) -> Option<Vec<C>> {
    for _ in 0..rounds {
        let mut settled = true;
        for n in 0..roots.len() {
            let step = step(coefficients, &roots, n);
            settled &= is_small(&step, &roots[n]);
            roots[n] = roots[n].less(&step);
        }
        if settled {
            return Some(roots);
        }
    }
    None
}

fn step<C: Scalar>(coefficients: &[C], roots: &[C], n: usize) -> C {
    let at = &roots[n];
    let (mut value, mut slope) = (C::zero(), C::zero());
    for coefficient in coefficients.iter().rev() {
        slope = slope.times(at).plus(&value);
        value = value.times(at).plus(coefficient);
    }
    if value.is_zero() {
        return value;
    }
    // 1/(p'/p - sum 1/(z - z_k))
    let mut sum = slope.times(&value.inverse());
    for (_, other) in roots.iter().enumerate().filter(|(k, _)| *k != n) {
        let gap = at.less(other);
        if !gap.is_zero() {
            sum = sum.less(&gap.inverse());
        }
    }
    if sum.is_zero() { value } else { sum.inverse() }
}

/// The roots to the digits of f64, from these starts; none where these are too few to tell the
/// roots apart, or the coefficients too far apart.
fn in_f64(
    coefficients: &[BigReal],
    heights: &[f64],
    starts: &[BigComplex],
) -> Option<Vec<BigComplex>> {
    let degree = coefficients.len() - 1;
    // In the unit of the roots' geometric mean, the first and the last coefficient are alike.
    let unit = libm::round((heights[0] - heights[degree]) / degree as f64);
    let heights: Vec<f64> =
        heights.iter().zip(0..).map(|(it, n)| it + f64::from(n) * unit).collect();
    let top = libm::round(heights.iter().copied().fold(f64::NEG_INFINITY, f64::max));
    if heights.iter().any(|it| it.is_finite() && top - it > MAX_SPREAD_IN_F64) {
        return None;
    }
    let scaled = |(it, n): (&BigReal, isize)| {
        Complex::new(it.scaled(n * unit as isize - top as isize).to_f64(), 0.0)
    };
    let coefficients: Vec<Complex<f64>> = coefficients.iter().zip(0..).map(scaled).collect();
    let plain = |it: &BigReal| it.scaled(-(unit as isize)).to_f64();
    let starts = starts.iter().map(|it| Complex::new(plain(&it.re), plain(&it.im))).collect();
    let size = |it: &Complex<f64>| libm::hypot(it.re, it.im);
    let small =
        |step: &Complex<f64>, root: &Complex<f64>| size(step) <= LAST_STEP_IN_F64 * size(root);
    let roots = iterated(&coefficients, starts, MAX_ROUNDS_IN_F64, &small)?;
    let are_apart = |(n, root): (usize, &Complex<f64>)| {
        roots[..n].iter().all(|it| size(&root.less(it)) > MIN_GAP_IN_F64 * size(root))
    };
    if !roots.iter().enumerate().all(are_apart) {
        return None;
    }
    let wide = |it: f64| BigReal::exact(it).scaled(unit as isize);
    Some(roots.iter().map(|it| BigComplex::new(wide(it.re), wide(it.im))).collect())
}

/// The logarithm of a number's size, to base 2.
fn logarithm(number: &BigReal) -> f64 {
    if number.is_zero() {
        return f64::NEG_INFINITY;
    }
    let exponent = number.exponent();
    libm::log2(number.abs().scaled(-exponent).to_f64()) + exponent as f64
}

/// Starts on circles whose radii follow the logarithms of the coefficients (Bini's choice, by their
/// upper hull).
fn beginnings(heights: &[f64]) -> Vec<BigComplex> {
    let degree = heights.len() - 1;
    let mut roots = Vec::with_capacity(degree);
    let mut from = 0;
    while from < degree {
        let slope = |to: usize| (heights[to] - heights[from]) / (to - from) as f64;
        let to = (from + 1..=degree).max_by(|a, b| slope(*a).total_cmp(&slope(*b)));
        let to = to.unwrap_or(degree);
        let (radius, count) = (-slope(to), to - from);
        for k in 0..count {
            let angle = std::f64::consts::TAU * (k as f64 / count as f64) + 0.7 + from as f64;
            let (sin, cos) = libm::sincos(angle);
            let whole = libm::floor(radius);
            let rest = libm::exp2(radius - whole);
            let scaled = |it: f64| BigReal::exact(it * rest).scaled(whole as isize);
            roots.push(BigComplex::new(scaled(cos), scaled(sin)));
        }
        from = to;
    }
    roots
}
