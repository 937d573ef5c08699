//! Linear algebra of a few rows: solving, invariants and eigenvalues of real 3 x 3 matrices.

/// A point of the section, or a step between two: p, y, q.
pub type StrobePoint = [f64; 3];

/// A derivative with respect to (p, y, q), row by row.
pub type Jacobian = [[f64; 3]; 3];

/// The identity matrix.
pub const IDENTITY: Jacobian = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// A complex number: real and imaginary part.
pub type ReIm = [f64; 2];

/// `after * before`.
#[must_use]
pub fn product<const N: usize>(after: &[[f64; N]; N], before: &[[f64; N]; N]) -> [[f64; N]; N] {
    after.map(|row| {
        std::array::from_fn(|column| row.iter().zip(before).map(|(r, b)| r * b[column]).sum())
    })
}

/// `matrix * vector`.
#[must_use]
pub fn apply<const N: usize>(matrix: &[[f64; N]; N], vector: &[f64; N]) -> [f64; N] {
    matrix.map(|row| dot(&row, vector))
}

/// The sum of products.
#[must_use]
pub fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The infinity norm: the largest sum of moduli along a row.
#[must_use]
pub fn norm<const N: usize>(matrix: &[[f64; N]; N]) -> f64 {
    matrix.iter().map(|row| row.iter().map(|x| x.abs()).sum()).fold(0.0, f64::max)
}

/// The trace: the sum of the diagonal, which is the sum of the eigenvalues.
#[must_use]
pub fn trace(matrix: &Jacobian) -> f64 {
    matrix[0][0] + matrix[1][1] + matrix[2][2]
}

/// The product of the eigenvalues.
#[must_use]
pub fn determinant(matrix: &Jacobian) -> f64 {
    let adjugate = adjugate(matrix);
    (0..3).map(|k| matrix[0][k] * adjugate[k][0]).sum()
}

/// The transposed cofactors: `matrix * adjugate = determinant * identity`. The adjugate of a
/// product is the product of the adjugates in reverse, and its trace is the sum of the products of
/// two eigenvalues: so that sum need not be computed from a product in which it has cancelled.
#[must_use]
pub fn adjugate(m: &Jacobian) -> Jacobian {
    let minor = |row: usize, column: usize| {
        let [r, s] = [(row + 1) % 3, (row + 2) % 3];
        let [c, d] = [(column + 1) % 3, (column + 2) % 3];
        m[r][c] * m[s][d] - m[r][d] * m[s][c]
    };
    std::array::from_fn(|row| std::array::from_fn(|column| minor(column, row)))
}

/// Solves `matrix * x = right` by elimination with full pivoting. Directions in which the matrix is
/// zero to within rounding are left alone: of a consistent singular system some solution is found.
#[must_use]
pub fn solve<const N: usize>(mut matrix: [[f64; N]; N], mut right: [f64; N]) -> [f64; N] {
    let lost = N as f64 * f64::EPSILON * norm(&matrix);
    let mut order: [usize; N] = std::array::from_fn(|k| k);
    let mut rank = 0;
    while rank < N {
        let (row, column) = largest(&matrix, rank);
        let found = matrix[row][column].abs();
        if found <= lost || found.is_nan() {
            break;
        }
        matrix.swap(rank, row);
        right.swap(rank, row);
        matrix.iter_mut().for_each(|row| row.swap(rank, column));
        order.swap(rank, column);
        let pivot = matrix[rank];
        for k in rank + 1..N {
            let factor = matrix[k][rank] / pivot[rank];
            matrix[k].iter_mut().zip(pivot).for_each(|(x, p)| *x -= factor * p);
            right[k] -= factor * right[rank];
        }
        rank += 1;
    }
    let mut solution = [0.0; N];
    for k in (0..rank).rev() {
        let known: f64 = (k + 1..rank).map(|j| matrix[k][j] * solution[order[j]]).sum();
        solution[order[k]] = (right[k] - known) / matrix[k][k];
    }
    solution
}

fn largest<const N: usize>(matrix: &[[f64; N]; N], from: usize) -> (usize, usize) {
    let mut best = (from, from);
    for row in from..N {
        for column in from..N {
            if matrix[row][column].abs() > matrix[best.0][best.1].abs() {
                best = (row, column);
            }
        }
    }
    best
}

/// The eigenvalues, largest modulus first; of a complex pair the upper one first. Backward stable:
/// each is that of a matrix that differs by a few eps of the largest entry. NaN where the matrix is
/// not finite.
#[must_use]
pub fn eigenvalues(matrix: &Jacobian) -> [ReIm; 3] {
    let size = matrix.iter().flatten().fold(0.0_f64, |size, x| size.max(x.abs()));
    if !matrix.iter().flatten().all(|x| x.is_finite()) {
        return [[f64::NAN, 0.0]; 3];
    }
    if size == 0.0 {
        return [[0.0; 2]; 3];
    }
    let scaled = matrix.map(|row| row.map(|x| x / size));
    let mut values = quasi_triangular(scaled).map(|value| value.map(|x| x * size));
    values.sort_by(|a, b| modulus(*b).total_cmp(&modulus(*a)).then(b[1].total_cmp(&a[1])));
    values
}

/// |z|
#[must_use]
pub fn modulus([re, im]: ReIm) -> f64 {
    libm::hypot(re, im)
}

/// The roots of x^2 - sum x + product, larger modulus first, of a complex pair the upper one first.
#[must_use]
pub fn roots(sum: f64, product: f64) -> [ReIm; 2] {
    let half = 0.5 * sum;
    let size = half.abs().max(product.abs().sqrt());
    if size == 0.0 {
        return [[0.0; 2]; 2];
    }
    let (h, rest) = (half / size, product / size / size);
    let discriminant = h * h - rest;
    if discriminant < 0.0 {
        let im = size * (-discriminant).sqrt();
        return [[half, im], [half, -im]];
    }
    let first = h + discriminant.sqrt().copysign(h);
    // A zero without a sign.
    [[size * first, 0.0], [size * (rest / first) + 0.0, 0.0]]
}

/// The double-shift QR iteration of Francis.
fn quasi_triangular(mut m: Jacobian) -> [ReIm; 3] {
    reflect(&mut m, hessenberg);
    // Convergence is quadratic; three or four steps do. One in ten is of an odd shift, which breaks
    // cycles.
    const MAX_STEPS: usize = 60;
    for step in 1..=MAX_STEPS {
        let small = |k: usize| {
            let near = m[k][k].abs() + m[k - 1][k - 1].abs();
            m[k][k - 1].abs() <= f64::EPSILON * if near == 0.0 { 1.0 } else { near }
        };
        if small(2) || step == MAX_STEPS {
            let [a, b] = block(&m, 0);
            return [a, b, [m[2][2], 0.0]];
        }
        if small(1) {
            let [a, b] = block(&m, 1);
            return [[m[0][0], 0.0], a, b];
        }
        let (sum, product) = if step % 10 == 0 {
            let odd = m[2][1].abs() + m[1][0].abs();
            (1.5 * odd, odd * odd)
        } else {
            (m[1][1] + m[2][2], m[1][1] * m[2][2] - m[1][2] * m[2][1])
        };
        reflect(&mut m, |m| {
            let x = m[0][0] * m[0][0] + m[0][1] * m[1][0] - sum * m[0][0] + product;
            [x, m[1][0] * (m[0][0] + m[1][1] - sum), m[1][0] * m[2][1]]
        });
        reflect(&mut m, hessenberg);
    }
    [[f64::NAN, 0.0]; 3]
}

/// The vector of the reflection that makes the lower left entry zero.
fn hessenberg(m: &Jacobian) -> StrobePoint {
    [0.0, m[1][0], m[2][0]]
}

/// The eigenvalues of the 2 x 2 block that begins at `k`.
fn block(m: &Jacobian, k: usize) -> [ReIm; 2] {
    let (a, b, c, d) = (m[k][k], m[k][k + 1], m[k + 1][k], m[k + 1][k + 1]);
    let (mean, half) = (0.5 * (a + d), 0.5 * (a - d));
    let discriminant = half * half + b * c;
    if discriminant < 0.0 {
        let im = (-discriminant).sqrt();
        return [[mean, im], [mean, -im]];
    }
    let far = half + discriminant.sqrt().copysign(half);
    let near = if far == 0.0 { 0.0 } else { -(b * c) / far };
    [[d + far, 0.0], [d + near, 0.0]]
}

/// A similarity by the mirror that takes a vector to the axis of its first entry that is not left
/// out; the vector is read off the matrix.
fn reflect(m: &mut Jacobian, vector: impl Fn(&Jacobian) -> StrobePoint) {
    let mut v = vector(m);
    let Some(first) = v.iter().position(|x| *x != 0.0) else { return };
    // The mirror of the Hessenberg form leaves the first axis alone.
    let first = if first == 2 { 1 } else { first };
    v[first] += dot(&v, &v).sqrt().copysign(v[first]);
    let square = dot(&v, &v);
    if square == 0.0 {
        return;
    }
    let along: StrobePoint =
        std::array::from_fn(|column| m.iter().zip(v).map(|(row, v)| v * row[column]).sum());
    for (row, v) in m.iter_mut().zip(v) {
        row.iter_mut().zip(along).for_each(|(x, along)| *x -= 2.0 * along / square * v);
    }
    for row in m {
        let along = dot(row, &v);
        row.iter_mut().zip(v).for_each(|(x, v)| *x -= 2.0 * along / square * v);
    }
}

#[cfg(test)]
#[path = "linear_tests.rs"]
mod tests;
