//! The characteristic polynomial with exact coefficients, its factors of equal multiplicity, and
//! their roots.

use crate::affine::arithmetic::real::{BigComplex, BigReal};
use crate::affine::model::rational::Rational;
use crate::affine::model::system::Row;

/// Coefficients, lowest first; the last is not zero.
type Polynomial = Vec<Rational>;

/// A root with its multiplicity. Of a pair of complex roots the one above the real axis is there.
#[derive(Clone, Debug)]
pub struct Eigenvalue {
    pub value: BigComplex,
    pub multiplicity: usize,
}

impl Eigenvalue {
    pub fn is_real(&self) -> bool {
        self.value.im.is_zero()
    }

    /// The number of dimensions of the eigenvalue's space, with that of its conjugate.
    pub fn dimensions(&self) -> usize {
        self.multiplicity * if self.is_real() { 1 } else { 2 }
    }
}

/// The eigenvalues of a matrix; none if the iteration does not converge.
pub fn eigenvalues(matrix: &[Row], bits: usize) -> Option<Vec<Eigenvalue>> {
    let mut roots = Vec::new();
    for (n, factor) in squarefree(&characteristic(matrix)).into_iter().enumerate() {
        for value in simple_roots(&factor, bits)? {
            roots.push(Eigenvalue { value, multiplicity: n + 1 });
        }
    }
    Some(roots)
}

/// Faddeev and Le Verrier's method, which is exact here.
fn characteristic(matrix: &[Row]) -> Polynomial {
    let size = matrix.len();
    let mut coefficients = vec![Rational::ONE];
    let mut power: Vec<Row> = vec![vec![Rational::ZERO; size]; size];
    for k in 1..=size {
        for (n, row) in power.iter_mut().enumerate() {
            row[n] += &coefficients[k - 1];
        }
        power = product(matrix, &power);
        let trace = (0..size).fold(Rational::ZERO, |sum, n| sum + &power[n][n]);
        coefficients.push(-trace / Rational::from(k));
    }
    coefficients.reverse();
    coefficients
}

fn product(a: &[Row], b: &[Row]) -> Vec<Row> {
    let entry = |row: &Row, j: usize| {
        let terms = row.iter().zip(b).filter(|(factor, _)| !factor.is_zero());
        terms.fold(Rational::ZERO, |sum, (factor, other)| sum + factor * &other[j])
    };
    a.iter().map(|row| (0..b.len()).map(|j| entry(row, j)).collect()).collect()
}

/// Yun's factors: the n-th holds the roots of multiplicity n + 1, each once.
fn squarefree(polynomial: &Polynomial) -> Vec<Polynomial> {
    let derived = derivative(polynomial);
    let common = greatest_common_divisor(polynomial, &derived);
    let mut rest = divided(polynomial, &common).0;
    let mut slope = divided(&derived, &common).0;
    let mut factors = Vec::new();
    while rest.len() > 1 {
        let next = difference(&slope, &derivative(&rest));
        let factor = greatest_common_divisor(&rest, &next);
        rest = divided(&rest, &factor).0;
        slope = divided(&next, &factor).0;
        factors.push(factor);
    }
    factors
}

fn derivative(polynomial: &Polynomial) -> Polynomial {
    let terms = polynomial.iter().enumerate().skip(1);
    terms.map(|(power, coefficient)| coefficient * Rational::from(power)).collect()
}

fn difference(a: &Polynomial, b: &Polynomial) -> Polynomial {
    let at = |it: &Polynomial, n| it.get(n).cloned().unwrap_or_default();
    trimmed((0..a.len().max(b.len())).map(|n| at(a, n) - at(b, n)).collect())
}

fn trimmed(mut polynomial: Polynomial) -> Polynomial {
    while polynomial.last().is_some_and(Rational::is_zero) {
        polynomial.pop();
    }
    polynomial
}

/// The quotient and the remainder of a division of polynomials.
fn divided(polynomial: &Polynomial, divisor: &Polynomial) -> (Polynomial, Polynomial) {
    let mut rest = polynomial.clone();
    let Some(leading) = divisor.last() else { return (Vec::new(), rest) };
    let steps = (rest.len() + 1).saturating_sub(divisor.len());
    let mut quotient = vec![Rational::ZERO; steps];
    for step in (0..steps).rev() {
        let factor = &rest[step + divisor.len() - 1] / leading;
        for (entry, other) in rest[step..].iter_mut().zip(divisor) {
            *entry -= &factor * other;
        }
        quotient[step] = factor;
    }
    (trimmed(quotient), trimmed(rest))
}

/// The greatest common divisor, with the leading coefficient 1.
fn greatest_common_divisor(a: &Polynomial, b: &Polynomial) -> Polynomial {
    let (mut a, mut b) = (a.clone(), trimmed(b.clone()));
    while !b.is_empty() {
        let rest = divided(&a, &b).1;
        a = std::mem::replace(&mut b, rest);
        // Monic remainders keep the coefficients short.
        if let Some(leading) = b.last().cloned() {
            b.iter_mut().for_each(|it| *it /= &leading);
        }
    }
    match a.last().cloned() {
        Some(leading) => a.into_iter().map(|it| it / &leading).collect(),
        None => a,
    }
}

/// The roots of a polynomial that has each once. A root at zero is exactly zero: an iteration would
/// only come near it, and what stands still would then seem to grow or decay.
fn simple_roots(polynomial: &[Rational], bits: usize) -> Option<Vec<BigComplex>> {
    match polynomial.split_first() {
        Some((lowest, [])) if !lowest.is_zero() => Some(Vec::new()),
        Some((lowest, rest)) if lowest.is_zero() => {
            let others = simple_roots(rest, bits)?;
            Some([BigComplex::real(BigReal::zero())].into_iter().chain(others).collect())
        }
        _ => roots_away_from_zero(polynomial, bits),
    }
}

/// The roots of a polynomial that has each once, and none at zero: Aberth's iteration, all of them
/// at a time.
fn roots_away_from_zero(polynomial: &[Rational], bits: usize) -> Option<Vec<BigComplex>> {
    const ROUNDS: usize = 2000;
    let coefficients: Vec<_> = polynomial.iter().map(|it| BigReal::of(it, bits)).collect();
    let degree = coefficients.len() - 1;
    if degree == 1 {
        return Some(vec![BigComplex::real(&-&coefficients[0] / &coefficients[1])]);
    }
    let mut roots = beginnings(&coefficients);
    for _ in 0..ROUNDS {
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
