//! The roots of polynomials with exact coefficients.

use crate::affine::arithmetic::real::{BigComplex, BigReal};
use crate::affine::model::rational::Rational;

/// The roots of a polynomial that has each once. A root at zero is exactly zero: an iteration would
/// only come near it, and what stands still would then seem to grow or decay.
pub fn simple_roots(polynomial: &[Rational], bits: usize) -> Option<Vec<BigComplex>> {
    match polynomial.split_first() {
        Some((lowest, [])) if !lowest.is_zero() => Some(Vec::new()),
        Some((lowest, rest)) if lowest.is_zero() => {
            let others = simple_roots(rest, bits)?;
            Some([BigComplex::real(BigReal::zero())].into_iter().chain(others).collect())
        }
        Some((constant, [linear, leading])) => {
            Some(of_quadratic(&(constant / leading), &(linear / leading), bits))
        }
        _ => roots_away_from_zero(polynomial, bits),
    }
}

/// The roots of z^2 + linear z + constant, which has none twice and none at zero. The sign of the
/// discriminant is exact, and so is the zero of a real part.
fn of_quadratic(constant: &Rational, linear: &Rational, bits: usize) -> Vec<BigComplex> {
    let middle = -linear / Rational::from(2);
    let discriminant = &middle * &middle - constant;
    let root = BigReal::new(&discriminant, bits).abs().sqrt();
    let middle = BigReal::new(&middle, bits);
    if discriminant < Rational::ZERO {
        return vec![BigComplex::new(middle, root)];
    }
    // The larger root is a sum without cancellation, and the product of both is the constant.
    let larger = if middle < BigReal::zero() { &middle - &root } else { &middle + &root };
    let smaller = &BigReal::new(constant, bits) / &larger;
    [smaller, larger].map(BigComplex::real).to_vec()
}

/// The roots of a polynomial that has each once, and none at zero: Aberth's iteration, all of them
/// at a time.
fn roots_away_from_zero(polynomial: &[Rational], bits: usize) -> Option<Vec<BigComplex>> {
    /// The number of steps of all roots after which the iteration is given up.
    const MAX_ROUNDS: usize = 2000;
    let coefficients: Vec<_> = polynomial.iter().map(|it| BigReal::new(it, bits)).collect();
    let degree = coefficients.len() - 1;
    if degree == 1 {
        return Some(vec![BigComplex::real(&-&coefficients[0] / &coefficients[1])]);
    }
    let mut roots = beginnings(&coefficients);
    for _ in 0..MAX_ROUNDS {
        let mut settled = true;
        for n in 0..degree {
            let step = step(&coefficients, &roots, n);
            settled &= is_small(&step, &roots[n]);
            roots[n] = &roots[n] - &step;
        }
        if settled {
            return Some(above_the_axis(roots));
        }
    }
    None
}

/// Whether a step moves a root by less than the last quarter of its bits.
fn is_small(step: &BigComplex, root: &BigComplex) -> bool {
    let last = 3 * step.re.bits() as isize / 4;
    step.norm_square() <= root.norm_square().scaled(-2 * last)
}

/// Starts on circles whose radii follow the coefficients (Bini's choice, by the upper hull of their
/// logarithms).
fn beginnings(coefficients: &[BigReal]) -> Vec<BigComplex> {
    let logarithm = |it: &BigReal| {
        let (mut size, mut shift) = (it.abs(), 0.0);
        if size.is_zero() {
            return f64::NEG_INFINITY;
        }
        // Into the range of f64.
        while size > BigReal::exact(1e300) {
            (size, shift) = (size.scaled(-900), shift + 900.0);
        }
        while size < BigReal::exact(1e-300) {
            (size, shift) = (size.scaled(900), shift - 900.0);
        }
        libm::log2(size.to_f64()) + shift
    };
    let heights: Vec<f64> = coefficients.iter().map(logarithm).collect();
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

fn step(coefficients: &[BigReal], roots: &[BigComplex], n: usize) -> BigComplex {
    let at = &roots[n];
    let mut value = BigComplex::real(BigReal::zero());
    let mut slope = value.clone();
    for coefficient in coefficients.iter().rev() {
        slope = &(&slope * at) + &value;
        value = &(&value * at) + &BigComplex::real(coefficient.clone());
    }
    if value.norm_square().is_zero() {
        return value;
    }
    // 1/(p'/p - sum 1/(z - z_k))
    let mut sum = &slope * &value.inverse();
    for (_, other) in roots.iter().enumerate().filter(|(k, _)| *k != n) {
        let gap = at - other;
        if !gap.norm_square().is_zero() {
            sum = &sum - &gap.inverse();
        }
    }
    if sum.norm_square().is_zero() { value } else { sum.inverse() }
}

/// Real roots, and of each pair the one above the real axis.
fn above_the_axis(roots: Vec<BigComplex>) -> Vec<BigComplex> {
    let mut kept = Vec::new();
    for root in roots {
        let nothing = root.norm().scaled(-(root.re.bits() as isize) / 2);
        if root.im.abs() <= nothing {
            kept.push(BigComplex::real(root.re));
        } else if root.im > BigReal::zero() && root.re.abs() <= nothing {
            // An oscillation that neither grows nor decays is known to do so for ever.
            kept.push(BigComplex::new(BigReal::zero(), root.im));
        } else if root.im > BigReal::zero() {
            kept.push(root);
        }
    }
    kept
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a panic is a failed test")]
mod tests {
    use super::*;

    const BITS: usize = 640;

    fn rational(above: i32, below: i32) -> Rational {
        Rational::from(above) / Rational::from(below)
    }

    /// Constant and linear coefficient: two real roots of either sign, far apart and close, pairs
    /// that decay, grow and do neither, and one that hardly turns.
    #[test]
    fn roots_of_quadratics_are_those_of_the_iteration() {
        let apart = (rational(1, 1_000_000_000), rational(7, 1));
        let close = (rational(999_999, 1_000_000), rational(2, 1));
        let slow = (rational(1_000_001, 1_000_000), rational(-2, 1));
        let others = [(-3, 1, 2, 1), (-4, 1, 0, 1), (1, 1, 1, 10), (1, 1, -1, 10), (2, 3, 0, 1)];
        let others = others.map(|(a, b, c, d)| (rational(a, b), rational(c, d)));
        for (constant, linear) in [apart, close, slow].iter().chain(&others) {
            let whole = [constant.clone(), linear.clone(), Rational::ONE];
            let expected = roots_away_from_zero(&whole, BITS).unwrap();
            let found = simple_roots(&whole, BITS).unwrap();
            assert_eq!(found.len(), expected.len());
            for root in &found {
                // The iteration stops where a step is below three quarters of the bits.
                let near = |it: &&BigComplex| {
                    (root - *it).norm() <= root.norm().scaled(-(BITS as isize) / 2)
                };
                assert!(expected.iter().any(|it| near(&it)), "{root:?}");
            }
        }
    }
}
