"""z(t) = exp(M t) z in closed form, from the exact minimal polynomial of M and its multiplicities.

The roots of the minimal polynomial, each with its exact multiplicity, give

    exp(M t) = sum over roots r and j below their multiplicity of  t^j/j! exp(r t) Z_rj,

where the Z_rj follow from the powers of M by inverting a confluent Vandermonde matrix: a defective
matrix and a stiff one are treated alike. Roots and Z_rj are balls; nothing else is approximate.
"""

from itertools import product
from math import comb, factorial
from typing import NamedTuple

from flint import acb, acb_mat, arb, arb_mat, arb_series, fmpq_mat, fmpq_poly

from crossing import Undecided


class Root(NamedTuple):
    """A root of the minimal polynomial; of a complex pair the one above the real axis.

    `factor` is the irreducible factor of which it is a root.
    """

    value: acb
    multiplicity: int
    real: bool
    factor: fmpq_poly


def roots(matrix: fmpq_mat) -> list:
    """The roots of the minimal polynomial, all of a pair's multiplicities exact."""
    found = []
    for factor, multiplicity in matrix.minpoly().factor()[1]:
        if factor.degree() == 1:
            found.append(Root(acb(-factor[0] / factor[1]), multiplicity, True, factor))
        elif factor.degree() == 2:
            found += [Root(r, multiplicity, r.imag == 0, factor) for r in quadratic(factor)]
        else:
            upper = [r for r, _ in factor.numer().complex_roots() if not r.imag < 0]
            if any(not (r.imag == 0 or r.imag > 0) for r in upper):
                raise Undecided("roots")
            found += [Root(r, multiplicity, r.imag == 0, factor) for r in upper]
    return found


def projection(matrix: fmpq_mat, factor: fmpq_poly, multiplicity: int) -> fmpq_mat:
    """The exact projection onto the states that the factor's roots move, along all others."""
    power = factor**multiplicity
    rest = matrix.minpoly() // power
    _, inverse, _ = rest.xgcd(power)
    polynomial, result = inverse * rest, fmpq_mat(matrix.nrows(), matrix.nrows())
    for k in range(polynomial.degree(), -1, -1):
        result = result * matrix + identity(matrix.nrows()) * polynomial[k]
    return result


def quadratic(factor) -> list:
    """Both roots of an irreducible quadratic, or the upper one of a pair, its real part exact."""
    middle, square = -factor[1] / (2 * factor[2]), factor[0] / factor[2]
    discriminant = middle * middle - square
    if discriminant < 0:
        return [acb(arb(middle), arb(-discriminant).sqrt())]
    return [acb(arb(middle) + sign * arb(discriminant).sqrt()) for sign in (1, -1)]


def vandermonde(found: list) -> acb_mat:
    """Row k: the k-th derivatives at 0 of t^j/j! exp(r t), over all roots, conjugates included."""
    columns = []
    for root in found:
        values = [root.value] if root.real else [root.value, root.value.conjugate()]
        columns += [(value, j) for value in values for j in range(root.multiplicity)]
    size = len(columns)
    return acb_mat(
        [[comb(k, j) * v ** (k - j) if k >= j else 0 for v, j in columns] for k in range(size)]
    )


class Flow:
    """exp(M t) for one mode, at the precision of its making."""

    def __init__(self, matrix: fmpq_mat):
        self.matrix, self.size = matrix, matrix.nrows()
        self.roots = roots(matrix)
        self.components = self.split()
        self.rates = max([abs(r.value).upper() for r in self.roots], default=arb(0))
        self.rows = {}

    def split(self) -> list:
        """For each root the list of its Z_rj, those of a pair doubled: only real parts are used."""
        weights, powers = vandermonde(self.roots), [identity(self.size)]
        try:
            weights = weights.inv()
        except ZeroDivisionError:
            raise Undecided("roots too close") from None
        for _ in range(weights.nrows() - 1):
            powers.append(powers[-1] * self.matrix)
        powers = [acb_mat(p) for p in powers]
        components, row = [], 0
        for root in self.roots:
            block = []
            for j in range(root.multiplicity):
                total = acb_mat(self.size, self.size)
                for k, power in enumerate(powers):
                    total += power * weights[row + j, k]
                block.append(total if root.real else total * 2)
            components.append(self.sharpened(block, root))
            row += root.multiplicity * (1 if root.real else 2)
        return components

    def sharpened(self, block: list, root: Root) -> list:
        """The Z_rj of a root, exact where the root is rational, else with their zeros exact."""
        exact = projection(self.matrix, root.factor, root.multiplicity)
        if root.factor.degree() == 1:
            shift = self.matrix + identity(self.size) * (root.factor[0] / root.factor[1])
            powers = [exact]
            for _ in block[1:]:
                powers.append(powers[-1] * shift)
            return [acb_mat(power) for power in powers]
        rows, columns = exact.tolist(), exact.transpose().tolist()
        for i, j in product(range(self.size), repeat=2):
            if not any(rows[i]) or not any(columns[j]):
                for part in block:
                    part[i, j] = 0
        return block

    def matrix_at(self, d: arb) -> arb_mat:
        """exp(M d). States that stay constant in the mode do so exactly."""
        total = acb_mat(self.size, self.size)
        for root, block in zip(self.roots, self.components, strict=True):
            exponential = (root.value * d).exp()
            for j, component in enumerate(block):
                total += component * (exponential * d**j / factorial(j))
        result = total.real
        entries = [[result[i, j] for j in range(self.size)] for i in range(self.size)]
        for i in range(self.size):
            if all(self.matrix[i, j] == 0 for j in range(self.size)):
                entries[i] = [arb(i == j) for j in range(self.size)]
        return arb_mat(entries)

    def curve(self, row: fmpq_mat, state: arb_mat) -> "Curve":
        """The function `row` exp(M t) `state` of t."""
        key = tuple(map(str, row.entries()))
        if key not in self.rows:
            real = acb_mat(row)
            self.rows[key] = [[real * part for part in block] for block in self.components]
        state, terms = acb_mat(state), []
        for root, block in zip(self.roots, self.rows[key], strict=True):
            values = [(part * state)[0, 0] / factorial(j) for j, part in enumerate(block)]
            terms.append(Term(root.value.real, None if root.real else root.value.imag, values))
        return Curve(terms)


def identity(size: int) -> fmpq_mat:
    return fmpq_mat([[int(i == j) for j in range(size)] for i in range(size)])


class Term(NamedTuple):
    """exp(growth t) times a polynomial, or times its real part after turning by exp(i turn t)."""

    growth: arb
    turn: arb | None
    coefficients: list

    def value(self, d):
        real = polynomial([c.real for c in self.coefficients], d)
        if self.turn is not None:
            sine, cosine = (self.turn * d).sin_cos()
            real = real * cosine - polynomial([c.imag for c in self.coefficients], d) * sine
        return real if self.growth == 0 else (self.growth * d).exp() * real


def polynomial(coefficients: list, d):
    value = coefficients[-1] if not isinstance(d, arb_series) else arb_series([coefficients[-1]])
    for coefficient in reversed(coefficients[:-1]):
        value = value * d + coefficient
    return value


class Curve(NamedTuple):
    """A sum of terms; it is evaluated alike on numbers, on intervals and on Taylor series."""

    terms: list

    def __call__(self, d):
        return sum((term.value(d) for term in self.terms[1:]), self.terms[0].value(d))
