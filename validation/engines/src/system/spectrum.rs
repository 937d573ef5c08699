//! How fast a linear system changes: the largest eigenvalue of its matrix, the largest frequency at
//! which it turns, and the fastest rate at which it decays.
//!
//! Only the size of steps depends on these: a few digits are enough.

use nalgebra::DMatrix;

/// The rates and frequencies that follow from a matrix's eigenvalues.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Rates {
    /// The largest modulus.
    pub(super) fastest: f64,
    /// The largest imaginary part.
    pub(super) turning: f64,
    /// The fastest decay: the smallest real part, its sign changed, or zero.
    pub(super) decay: f64,
}

/// The imaginary part, as a share of the modulus, that rounding may make of a multiple real root.
const IMAGINARY_TOLERANCE: f64 = 1e-3;
/// The modulus of a root, as a share of the matrix, that rounding may make of zero.
const ZERO_TOLERANCE: f64 = 1e-9;

/// The spectrum of a square matrix.
pub(super) fn spectrum(matrix: &[Vec<f64>]) -> Rates {
    let size = matrix.iter().flatten().fold(0.0, |size: f64, entry| size.max(entry.abs()));
    if size == 0.0 || !size.is_finite() {
        return Rates::default();
    }
    let scaled =
        DMatrix::from_fn(matrix.len(), matrix.len(), |row, column| matrix[row][column] / size);
    let mut found = Rates::default();
    for root in scaled.complex_eigenvalues().iter() {
        let modulus = root.norm();
        found.fastest = found.fastest.max(size * modulus);
        found.decay = found.decay.max(-size * root.re);
        if root.im.abs() > IMAGINARY_TOLERANCE * modulus && modulus > ZERO_TOLERANCE {
            found.turning = found.turning.max(size * root.im.abs());
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_near(found: f64, expected: f64) -> bool {
        (found - expected).abs() <= 0.01 * expected
    }

    #[test]
    fn an_oscillator_beside_a_fast_decay() {
        let matrix = vec![vec![0.0, 1.0, 0.0], vec![-4.0, -0.1, 0.0], vec![0.0, 0.0, -2.7e6]];
        let found = spectrum(&matrix);
        assert!(is_near(found.fastest, 2.7e6) && is_near(found.decay, 2.7e6), "{found:?}");
        let slow = spectrum(&[vec![0.0, 1.0], vec![-4.0, -0.1]]);
        assert!(is_near(slow.turning, 2.0) && is_near(slow.fastest, 2.0), "{slow:?}");
        assert!(is_near(slow.decay, 0.05), "{slow:?}");
    }

    #[test]
    fn a_triple_eigenvalue_does_not_turn() {
        let found = spectrum(&[vec![-1.0, 1.0, 0.0], vec![0.0, -1.0, 1.0], vec![0.0, 0.0, -1.0]]);
        assert!(is_near(found.fastest, 1.0) && found.turning == 0.0, "{found:?}");
        assert_eq!(spectrum(&[vec![0.0, 1.0], vec![0.0, 0.0]]).turning, 0.0);
    }
}
