use super::*;
use proptest::prelude::*;

fn sorted(mut values: Vec<ReIm>) -> Vec<ReIm> {
    values.sort_by(|a, b| modulus(*b).total_cmp(&modulus(*a)).then(b[1].total_cmp(&a[1])));
    values
}

/// A matrix with these eigenvalues: `base * diagonal block * base^-1`.
fn similar(base: &Jacobian, inside: &Jacobian) -> Jacobian {
    let scale = determinant(base);
    let inverse = adjugate(base).map(|row| row.map(|x| x / scale));
    product(&product(base, inside), &inverse)
}

const BASIS: Jacobian = [[1.0, 0.5, -0.25], [0.25, 2.0, 0.5], [-0.5, 0.75, 1.5]];

proptest! {
    #[test]
    fn what_was_planted_is_found(
        real in prop::array::uniform3(-3.0..3.0_f64),
        re in -2.0..2.0_f64, im in 0.01..2.0_f64, is_pair: bool
    ) {
        let [a, b, c] = real;
        let (inside, planted) = if is_pair {
            ([[a, 0.0, 0.0], [0.0, re, im], [0.0, -im, re]], vec![[a, 0.0], [re, im], [re, -im]])
        } else {
            ([[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]], vec![[a, 0.0], [b, 0.0], [c, 0.0]])
        };
        let matrix = similar(&BASIS, &inside);
        // Sum, sum of pairs and product are continuous in the matrix also where eigenvalues meet.
        let found = eigenvalues(&matrix);
        for at in [[1.0, 0.0], [-1.0, 0.0], [0.5, 1.0]] {
            let poly = |values: &[ReIm]| values.iter().fold([1.0, 0.0], |p: ReIm, v| {
                let d = [at[0] - v[0], at[1] - v[1]];
                [p[0] * d[0] - p[1] * d[1], p[0] * d[1] + p[1] * d[0]]
            });
            let (f, p) = (poly(&found), poly(&planted));
            let apart = modulus([f[0] - p[0], f[1] - p[1]]);
            prop_assert!(apart <= 1e-12, "{apart:e} {found:?} {planted:?}");
        }
        prop_assert_eq!(sorted(found.to_vec()), found.to_vec());
        let total: f64 = found.iter().map(|v| v[0]).sum();
        prop_assert!((total - trace(&matrix)).abs() <= 1e-13);
    }

    #[test]
    fn a_solution_solves(matrix in prop::array::uniform4(prop::array::uniform4(-1.0..1.0_f64)), x in prop::array::uniform4(-1.0..1.0_f64)) {
        let right = matrix.map(|row| dot(&row, &x));
        let found = solve(matrix, right);
        let back = matrix.map(|row| dot(&row, &found));
        let size = found.iter().fold(1.0_f64, |size, x| size.max(x.abs()));
        for (a, b) in back.iter().zip(right) {
            prop_assert!((a - b).abs() <= 64.0 * f64::EPSILON * size, "{a} {b}");
        }
    }
}

#[test]
fn a_zero_beside_large_and_small_ones() {
    for values in [[7.0, -0.3, 0.0], [1e8, 1e-3, 0.0], [2.0, 0.0, 0.0], [0.0; 3]] {
        let [a, b, c] = values;
        let found = eigenvalues(&similar(&BASIS, &[[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]]));
        for (found, planted) in found.iter().zip(values) {
            // A few eps of the largest entry.
            assert!((found[0] - planted).abs() <= 32.0 * f64::EPSILON * a, "{found:?} {planted}");
            assert!(found[1].abs() <= 32.0 * f64::EPSILON * a);
        }
    }
}

#[test]
fn nothing_is_lost_to_underflow_or_overflow() {
    for scale in [1e-320, 1e-300, 1e-160, 1e160, 1e300] {
        let matrix =
            [[2.0, 1.0, 0.0], [0.0, 3.0, 1.0], [0.0, 0.0, -5.0]].map(|r| r.map(|x| x * scale));
        let found = eigenvalues(&matrix);
        for (found, planted) in found.iter().zip([-5.0, 3.0, 2.0]) {
            let near = 1e-14 * 5.0 * scale + 4.0 * f64::from_bits(1);
            assert!((found[0] - planted * scale).abs() <= near, "{scale:e}: {found:?}");
        }
        let product = 4.0 * scale * scale;
        let [a, b] = roots(5.0 * scale, product);
        // Where the product underflows the smaller root is lost with it, and nothing else.
        if product.is_finite() {
            assert!((a[0] - 4.0 * scale).abs() <= 1.01 * scale && !b[0].is_nan(), "{a:?} {b:?}");
        }
        if product.is_normal() {
            let apart = (a[0] - 4.0 * scale).abs() + (b[0] - scale).abs();
            assert!(apart <= 4.0 * f64::EPSILON * scale, "{a:?} {b:?}");
        }
    }
    assert!(eigenvalues(&[[f64::NAN; 3]; 3]).iter().all(|it| it[0].is_nan()));
    assert!(eigenvalues(&[[f64::INFINITY; 3]; 3]).iter().all(|it| it[0].is_nan()));
}

#[test]
fn a_cyclic_permutation_has_the_roots_of_one() {
    let found = eigenvalues(&[[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    for value in found {
        assert!((modulus(value) - 1.0).abs() <= 1e-14, "{found:?}");
    }
}

#[test]
fn of_a_singular_system_some_solution() {
    let matrix = [[0.0, 2.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]];
    assert_eq!(solve(matrix, [4.0, 2.0, 3.0]), [0.0, 2.0, -3.0]);
    assert_eq!(solve([[0.0; 3]; 3], [1.0; 3]), [0.0; 3]);
    assert_eq!(solve([[f64::NAN; 3]; 3], [1.0; 3]), [0.0; 3]);
}
