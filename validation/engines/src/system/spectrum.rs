//! How fast a linear system changes: the largest eigenvalue of its matrix, the largest frequency at
//! which it turns, and the fastest rate at which it decays.
//!
//! Only the size of steps depends on these: a few digits are enough.

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

/// More rounds than the simultaneous search for roots takes to a few digits, multiple roots too.
const ROUNDS: usize = 400;
/// Imaginary parts below this share of the modulus may be what rounding makes of a multiple root.
const REAL: f64 = 1e-3;
/// Roots below this share of the matrix may be zero.
const ZERO: f64 = 1e-9;

/// The spectrum of a square matrix.
pub(super) fn spectrum(matrix: &[Vec<f64>]) -> Rates {
    let size = matrix.iter().flatten().fold(0.0, |size: f64, entry| size.max(entry.abs()));
    if size == 0.0 || !size.is_finite() {
        return Rates::default();
    }
    let scaled: Vec<Vec<f64>> =
        matrix.iter().map(|row| row.iter().map(|entry| entry / size).collect()).collect();
    let roots = roots(&characteristic(&scaled));
    let mut found = Rates::default();
    for (real, imaginary) in roots {
        let modulus = real.hypot(imaginary);
        found.fastest = found.fastest.max(size * modulus);
        found.decay = found.decay.max(-size * real);
        if imaginary.abs() > REAL * modulus && modulus > ZERO {
            found.turning = found.turning.max(size * imaginary.abs());
        }
    }
    found
}

/// The coefficients of the characteristic polynomial below the leading one, highest first, by
/// Faddeev's and Le Verrier's recurrence.
fn characteristic(matrix: &[Vec<f64>]) -> Vec<f64> {
    let n = matrix.len();
    let mut auxiliary = vec![vec![0.0; n]; n];
    let mut last = 1.0;
    let mut coefficients = Vec::with_capacity(n);
    for k in 1..=n {
        for (i, row) in auxiliary.iter_mut().enumerate() {
            row[i] += last;
        }
        let entry = |i: usize, j: usize| (0..n).map(|l| matrix[i][l] * auxiliary[l][j]).sum();
        let product: Vec<Vec<f64>> =
            (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect();
        last = -(0..n).map(|i| product[i][i]).sum::<f64>() / k as f64;
        coefficients.push(last);
        auxiliary = product;
    }
    coefficients
}

type Complex = (f64, f64);

fn times((a, b): Complex, (c, d): Complex) -> Complex {
    (a * c - b * d, a * d + b * c)
}

fn over((a, b): Complex, (c, d): Complex) -> Complex {
    let square = (c * c + d * d).max(f64::MIN_POSITIVE);
    ((a * c + b * d) / square, (b * c - a * d) / square)
}

/// All roots of a monic polynomial at once, by Weierstrass's corrections.
fn roots(coefficients: &[f64]) -> Vec<Complex> {
    let n = coefficients.len();
    let bound = 1.0 + coefficients.iter().fold(0.0, |most: f64, it| most.max(it.abs()));
    let angle = |k: usize| 0.4 + 6.0 * k as f64 / n as f64;
    let mut roots: Vec<Complex> =
        (0..n).map(|k| (0.5 * bound * angle(k).cos(), 0.5 * bound * angle(k).sin())).collect();
    for _ in 0..ROUNDS {
        for k in 0..n {
            let here = roots[k];
            let value = coefficients.iter().fold((1.0, 0.0), |sum, coefficient| {
                let (real, imaginary) = times(sum, here);
                (real + coefficient, imaginary)
            });
            let others = roots.iter().enumerate().filter(|(other, _)| *other != k);
            let product = others.fold((1.0, 0.0), |product, (_, root)| {
                times(product, (here.0 - root.0, here.1 - root.1))
            });
            let step = over(value, product);
            roots[k] = (here.0 - step.0, here.1 - step.1);
        }
    }
    roots
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(found: f64, expected: f64) -> bool {
        (found - expected).abs() <= 0.01 * expected
    }

    #[test]
    fn an_oscillator_beside_a_fast_decay() {
        let matrix = vec![vec![0.0, 1.0, 0.0], vec![-4.0, -0.1, 0.0], vec![0.0, 0.0, -2.7e6]];
        let found = spectrum(&matrix);
        assert!(near(found.fastest, 2.7e6) && near(found.decay, 2.7e6), "{found:?}");
        let slow = spectrum(&[vec![0.0, 1.0], vec![-4.0, -0.1]]);
        assert!(near(slow.turning, 2.0) && near(slow.fastest, 2.0), "{slow:?}");
        assert!(near(slow.decay, 0.05), "{slow:?}");
    }

    #[test]
    fn a_triple_eigenvalue_does_not_turn() {
        let found = spectrum(&[vec![-1.0, 1.0, 0.0], vec![0.0, -1.0, 1.0], vec![0.0, 0.0, -1.0]]);
        assert!(near(found.fastest, 1.0) && found.turning == 0.0, "{found:?}");
        assert_eq!(spectrum(&[vec![0.0, 1.0], vec![0.0, 0.0]]).turning, 0.0);
    }
}
