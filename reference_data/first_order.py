"""Zeros that hold to first order in a name, and derivatives that are zero by the model.

s is the derivative of z by the name, dT that of the time of the last event. Rows over (s, z, z dT)
whose value is zero form a space, which goes with the run as that of z does in `structural.py`. At
an event s is the derivative at the event's moving time; at a given time it is less by M z dT, which
is linear in the third part, whose last entry is dT itself.
"""

from flint import fmpq, fmpq_mat

from affine_expression import Refused
from coefficient_derivatives import Matrix
from modal import identity
from structural import Space, left_kernel


class FirstOrder:
    """What is zero at the present event: rows over (s, z, z dT)."""

    def __init__(self, space: Space):
        self.space, self.size = space, space.size // 3

    @classmethod
    def at_start(cls, coefficients: Matrix, turn: fmpq, is_at_zero: bool, slowness: fmpq):
        """The zeros of z = C u and s = dC u + C du, with u = (cos, sin, 1), or (1) unforced.

        The derivative of u is `turn` (-sin, cos, 0), that of the time is `slowness`. Where the
        angle is 0 itself u is (1, 0, 1).
        """
        value, rate = coefficients
        if value.ncols() == 3:
            rate = rate + value * fmpq_mat([[0, -turn, 0], [turn, 0, 0], [0, 0, 0]])
        if is_at_zero:
            value, rate = (part * fmpq_mat([[1], [0], [1]]) for part in (value, rate))
        moving = value * slowness
        rows = [*rate.tolist(), *value.tolist(), *moving.tolist()]
        return cls(Space(left_kernel(fmpq_mat(rows))))

    @classmethod
    def at_given_time(cls, lasting: Space) -> "FirstOrder":
        """The zeros at a time that does not move, in a segment along which these are zero."""
        size = lasting.size // 3
        return cls(with_motion(without_motion(lasting)).with_rows(by_rate(size, fmpq(0))))

    def still(self) -> bool:
        """Is the derivative of the event's time zero by the model?"""
        return self.space.holds(unit(3 * self.size, 3 * self.size - 1))

    def lasting(self, matrix: Matrix) -> Space:
        """The rows that are zero all along the segment that begins here, for s at a given time.

        Their third part is z times the dT at which the segment begins.
        """
        at_given_time = self.space.before(to_moving_time(matrix.value * -1))
        none, value = fmpq_mat(self.size, self.size), matrix.value
        flow = blocks([[value, matrix.rate, none], [none, value, none], [none, none, value]])
        return at_given_time.carried(flow)

    @classmethod
    def crossed(cls, lasting: Space, guard: Matrix, matrix: Matrix) -> "FirstOrder":
        """The zeros at an instant of a segment at which a guard is zero, at its moving time."""
        size = matrix.value.nrows()
        here = lasting.with_rows([longer(guard.of_value())])
        speed = longer(guard.of_value() * matrix.doubled())
        shift = longer(guard.of_derivative())
        known = with_motion(without_motion(here))
        later = ratio(here, shift + moving(guard, matrix), speed)
        if later is not None:
            one, none = identity(size), fmpq_mat(size, size)
            rows = [[one, none, none], [none, one, none], [none, one * later, one]]
            known = known.with_rows(rows_of(here.before(blocks(rows))))
        rate = ratio(here, shift, speed)
        if rate is not None:
            known = known.with_rows(by_rate(size, rate))
        return cls(known.before(to_moving_time(matrix.value)).with_rows([shift]))

    def after(self, reset: Matrix) -> "FirstOrder":
        none = fmpq_mat(self.size, self.size)
        value, rate = reset
        rows = [[value, rate, none], [none, value, none], [none, none, value]]
        return FirstOrder(self.space.before(blocks(rows)))

    def holds(self, row: Matrix) -> bool:
        """Is a row of z zero to first order?"""
        return all(self.space.holds(longer(r)) for r in (row.of_value(), row.of_derivative()))

    def order(self, row: Matrix, matrix: Matrix) -> int | None:
        """The least order of a row's derivatives whose value is not zero; None if there is none.

        Refuses one whose value is zero and whose derivative by the name is not.
        """
        doubled = matrix.doubled()
        value, slope = row.of_value(), row.of_derivative()
        for order in range(doubled.nrows()):
            if not self.space.holds(longer(value)):
                return order
            if not self.space.holds(longer(slope)):
                raise Refused("one-sided: a zero at an entry does not hold to first order")
            value, slope = value * doubled, slope * doubled
        return None

    def is_zero(self, state: int) -> bool:
        """Is the derivative of a state zero by the model?"""
        return self.space.holds(unit(3 * self.size, state))


def ratio(space: Space, row: fmpq_mat, other: fmpq_mat) -> fmpq | None:
    """The rational number t for which `row` + t `other` is zero, where the zeros tell it."""
    row, other = space.rest(row).entries(), space.rest(other).entries()
    pivot = next((k for k, entry in enumerate(other) if entry != 0), None)
    if pivot is None:
        return None
    found = -row[pivot] / other[pivot]
    is_zero = all(a + found * b == 0 for a, b in zip(row, other, strict=True))
    return found if is_zero else None


def moving(guard: Matrix, matrix: Matrix) -> fmpq_mat:
    """The rate of a guard as a row of the third part."""
    speed = guard.value * matrix.value
    return fmpq_mat([[fmpq(0)] * (2 * speed.ncols()) + speed.entries()])


def to_moving_time(matrix: fmpq_mat) -> fmpq_mat:
    """Turns rows of s + M z dT into rows of s."""
    one, none = identity(matrix.nrows()), fmpq_mat(matrix.nrows(), matrix.nrows())
    return blocks([[one, none, matrix], [none, one, none], [none, none, one]])


def rows_of(space: Space) -> list:
    return [fmpq_mat([row]) for row in space.basis.tolist()]


def by_rate(size: int, rate: fmpq) -> list:
    """The rows that say that the third part is the second times a number."""
    return [unit(3 * size, 2 * size + k) - unit(3 * size, size + k) * rate for k in range(size)]


def without_motion(space: Space) -> Space:
    """Rows over (s, z, z dT) in which the third part is not, as rows over (s, z)."""
    one, none = identity(space.size // 3), fmpq_mat(space.size // 3, space.size // 3)
    return space.before(blocks([[one, none, none], [none, one, none]]))


def with_motion(space: Space) -> Space:
    """Rows over (s, z) as rows over (s, z, z dT): a zero of z is one of z dT, too."""
    size = space.size // 2
    of_state = space.before(blocks([[fmpq_mat(size, size), identity(size)]]))
    none = [fmpq(0)] * size
    rows = [[*row, *none] for row in space.basis.tolist()]
    rows += [[*none, *none, *row] for row in of_state.basis.tolist()]
    return Space(fmpq_mat(len(rows), 3 * size, [entry for row in rows for entry in row]))


def blocks(rows: list) -> fmpq_mat:
    """The matrix that is made of these."""
    joined = []
    for row in rows:
        joined += [sum(parts, []) for parts in zip(*(m.tolist() for m in row), strict=True)]
    return fmpq_mat(joined)


def longer(row: fmpq_mat) -> fmpq_mat:
    """A row over (s, z) as one over (s, z, z dT)."""
    return fmpq_mat([row.entries() + [fmpq(0)] * (row.ncols() // 2)])


def unit(size: int, index: int) -> fmpq_mat:
    return fmpq_mat([[int(k == index) for k in range(size)]])
