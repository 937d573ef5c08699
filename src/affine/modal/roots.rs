//! The roots of polynomials with exact coefficients.

use super::aberth::roots_away_from_zero;
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
        _ => roots_away_from_zero(polynomial, bits).map(above_the_axis),
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
            let expected = above_the_axis(roots_away_from_zero(&whole, BITS).unwrap());
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
