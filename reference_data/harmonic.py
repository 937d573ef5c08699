"""Guards that are a sine about a rational level: their touches and common roots are decided.

Such a guard is c + a p + b q with rational c, a, b, where p = cos(angle) and q = sin(angle)/r with
a rational r^2, so that p^2 + r^2 q^2 = 1. It touches zero where c^2 = a^2 + b^2/r^2, and two of
them vanish together only at the point (p, q) that both equations give, if it lies on that curve.
"""

from dataclasses import dataclass

from flint import arb, fmpq, fmpq_mat

from structural import Space


@dataclass
class Harmonic:
    """c + a cos(angle) + b sin(angle)/r, where angle = `phase` + `turn` times the elapsed time."""

    c: fmpq
    a: fmpq
    b: fmpq
    r_squared: fmpq
    turn: arb
    phase: arb

    def excess(self) -> fmpq:
        """The square of the amplitude less that of the level."""
        return self.a**2 + self.b**2 / self.r_squared - self.c**2

    def keeps_its_sign(self) -> bool:
        """Are all roots touches, or are there none?"""
        return self.excess() <= 0

    def separation(self) -> arb:
        """The least time between two of its roots."""
        half = arb.atan2(arb(self.excess()).sqrt(), arb(-self.c))
        return (2 * half).min(2 * (arb.pi() - half)) / self.turn

    def nearest(self, p: fmpq, q: fmpq, time: arb) -> arb:
        """The instant of the point (p, q) that lies nearest to `time`."""
        angle = arb.atan2(arb(q) * arb(self.r_squared).sqrt(), arb(p)) - self.phase
        turns = ((time * self.turn - angle) / (2 * arb.pi())).mid()
        whole = round(float(turns))
        return (angle + 2 * arb.pi() * whole) / self.turn


def since_entry(row: fmpq_mat, matrix: fmpq_mat, known, kept: Space) -> Harmonic | None:
    """The sine of `row` exp(`matrix` t) z, if it is one from a rational start.

    `known(row)` is the rational value of a row at entry, or None; `kept` stays zero.
    """
    rate = row * matrix
    first, third = kept.rest(rate), kept.rest(rate * matrix * matrix)
    pivot = next((j for j in range(first.ncols()) if first[0, j] != 0), None)
    if pivot is None:
        return None
    square = -third[0, pivot] / first[0, pivot]
    if not square > 0 or third != first * -square:
        return None
    value, slope, bend = (known(r) for r in (row, rate, rate * matrix))
    if value is None or slope is None or bend is None:
        return None
    a = -bend / square
    return Harmonic(value - a, a, slope, square, arb(square).sqrt(), arb(0))


def structural_value(row: fmpq_mat, space: Space) -> fmpq | None:
    """The rational number that a row is by what is structurally zero, if it is one."""
    rest, last = space.rest(row), row.ncols() - 1
    return rest[0, last] if all(rest[0, j] == 0 for j in range(last)) else None


def of_forcing(row: fmpq_mat, space: Space, omega: fmpq, theta: arb) -> Harmonic | None:
    """The sine of a row that holds no state but for what stays zero; `theta` is that at entry."""
    rest, size = space.rest(row), row.ncols()
    if any(rest[0, j] != 0 for j in range(size - 3)):
        return None
    a, b, c = (rest[0, j] for j in range(size - 3, size))
    return Harmonic(c, a, b, fmpq(1), arb(omega), theta) if a != 0 or b != 0 else None


def meet(one: Harmonic | None, other: Harmonic | None, time: arb, also: arb) -> bool:
    """Are the root of `one` in the ball `time` and the root of `other` in `also` provably one?"""
    if one is None or other is None or one.r_squared != other.r_squared:
        return False
    determinant = one.a * other.b - other.a * one.b
    if determinant == 0:
        return False
    p = (one.b * other.c - other.b * one.c) / determinant
    q = (other.a * one.c - one.a * other.c) / determinant
    if p * p + one.r_squared * q * q != 1:
        return False
    instant = one.nearest(p, q, time)
    near = abs(time - instant) < one.separation() and abs(also - instant) < other.separation()
    return bool(near)
