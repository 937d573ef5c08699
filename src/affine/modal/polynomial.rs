//! The characteristic polynomial with exact coefficients, and its factors: of equal multiplicity,
//! and of entries of z that act on each other. The forcing's is one, so that the roots of most
//! factors are known in closed form.

use super::components::irreducible;
use super::roots::simple_roots;
use crate::affine::arithmetic::real::BigComplex;
use crate::affine::model::rational::Rational;
use crate::affine::model::system::Row;
use std::cmp::Ordering;

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

/// The eigenvalues of a matrix, of each multiplicity the smallest first; none if the iteration does
/// not converge.
pub fn eigenvalues(matrix: &[Row], bits: usize) -> Option<Vec<Eigenvalue>> {
    let own = |part: &Vec<usize>| {
        let row = |i: &usize| part.iter().map(|j| matrix[*i][*j].clone()).collect();
        characteristic(&part.iter().map(row).collect::<Vec<Row>>())
    };
    let parts: Vec<Polynomial> = irreducible(matrix).iter().map(own).collect();
    let whole = parts.iter().fold(vec![Rational::ONE], |all, part| times(&all, part));
    let mut roots = Vec::new();
    for (n, factor) in squarefree(&whole).into_iter().enumerate() {
        let mut values = Vec::new();
        for part in common_factors(factor, &parts) {
            values.extend(simple_roots(&part, bits)?);
        }
        let size = |it: &BigComplex| it.norm_square();
        values.sort_by(|a, b| size(a).partial_cmp(&size(b)).unwrap_or(Ordering::Equal));
        roots.extend(values.into_iter().map(|value| Eigenvalue { value, multiplicity: n + 1 }));
    }
    Some(roots)
}

/// The factors that a polynomial, which has each root once, has in common with others, of which
/// every root is one.
fn common_factors(mut polynomial: Polynomial, others: &[Polynomial]) -> Vec<Polynomial> {
    let mut factors = Vec::new();
    for other in others {
        let common = greatest_common_divisor(&polynomial, other);
        if common.len() > 1 {
            polynomial = divided(&polynomial, &common).0;
            factors.push(common);
        }
    }
    factors
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

fn times(a: &Polynomial, b: &Polynomial) -> Polynomial {
    let mut product = vec![Rational::ZERO; a.len() + b.len() - 1];
    for (n, entry) in a.iter().enumerate() {
        product[n..].iter_mut().zip(b).for_each(|(sum, other)| *sum += entry * other);
    }
    product
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
