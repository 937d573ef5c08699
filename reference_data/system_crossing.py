"""The crossings of a segment's guards, proved and in order of time.

Of the two ways the first serves everywhere: the elapsed time is swept in steps, and on each step
each guard is shown to keep its sign, or to have a slope of one sign, so that the signs at both ends
tell whether there is a root. Where a segment is a polynomial with rational coefficients its roots
are found exactly, with their multiplicities: then touches and roots in common are decided, too.
"""

from dataclasses import dataclass
from typing import NamedTuple

from flint import arb, ctx, fmpq, fmpq_mat, fmpq_poly

from crossing import Undecided, derivatives, refine
from harmonic import Harmonic, meet
from structural import Space
from system_file import Event


TINY = arb(2) ** -30  # of the first step
MOST_TINY = 4000  # steps so small in one segment: a guard too vague to pass shortens all of them


class Time(NamedTuple):
    """A time: a ball, and the rational number itself where it is known."""

    ball: arb
    exact: fmpq | None

    @classmethod
    def of(cls, exact: fmpq):
        return cls(arb(exact), exact)

    def plus(self, other: "Time") -> "Time":
        if self.exact is None or other.exact is None:
            return Time(self.ball + other.ball, None)
        return Time.of(self.exact + other.exact)


@dataclass
class Guard:
    """A guard in a segment. `zeros` of its derivatives vanish structurally at entry.

    `value` is a function of the elapsed time, `exact` its polynomial where that is rational,
    `harmonic` its sine with a rational level where it is one.
    """

    event: Event
    zeros: int
    value: object
    exact: fmpq_poly | None
    harmonic: Harmonic | None = None

    def wanted(self, rising: bool) -> bool:
        """Whether a crossing in this direction is an event."""
        return self.event.direction in ("both", "rising" if rising else "falling")


class Crossing(NamedTuple):
    """Everything that happens at one instant of a segment, in the order of the file."""

    time: Time
    watches: list
    untils: list


def crossings(guards: list, space: Space, span: Time, first_step: arb):
    """The crossings of a segment up to the first `until`, or to the end of the span.

    `space` holds what stays zero along the segment.
    """
    exact = all(guard.exact is not None for guard in guards)
    found = rational(guards, span) if exact else swept(guards, span, first_step)
    for batch in found:
        for crossing in joined(batch, guards, space):
            yield crossing
            if crossing.untils:
                return


def joined(batch: list, guards: list, space: Space):
    """Roots, pairs (time, guard), sorted, with those in common as one crossing."""
    rest = sorted(batch, key=lambda pair: pair[0].ball.mid())
    while rest:
        first, same = rest[0], [pair for pair in rest if together(pair, rest[0], space)]
        rest = [pair for pair in rest if not together(pair, first, space)]
        if any(not pair[0].ball > first[0].ball and not later(pair[0], first[0]) for pair in rest):
            raise Undecided("order of two crossings")
        happening = [pair[1] for pair in same]
        ordered = [guard for guard in guards if any(guard is other for other in happening)]
        watches = [guard for guard in ordered if guard.event.watched]
        yield Crossing(first[0], watches, [guard for guard in ordered if not guard.event.watched])


def later(a: Time, b: Time) -> bool:
    return a.exact is not None and b.exact is not None and a.exact > b.exact


def together(a: tuple, b: tuple, space: Space) -> bool:
    """Are two roots one? By rational times, or because one guard is a multiple of the other."""
    if a[0].exact is not None and b[0].exact is not None:
        return a[0].exact == b[0].exact
    if not a[0].ball.overlaps(b[0].ball):
        return False
    if a[1] is b[1] or space.with_rows([b[1].event.guard]).holds(a[1].event.guard):
        return True
    return meet(a[1].harmonic, b[1].harmonic, a[0].ball, b[0].ball)


def swept(guards: list, span: Time, first_step: arb):
    """Batches of roots (time, guard), one a step, each batch after the one before."""
    smallest = first_step * arb(2) ** -(ctx.prec // 2)
    tiny, patience = first_step * TINY, MOST_TINY
    left, end, step, entering = arb(0), span.ball.upper(), first_step, True
    while left < end:
        right = (left + step).mid()
        right = right if right < end else end
        patience -= bool(step < tiny)
        if patience == 0:
            raise Undecided("crossing")
        try:
            look = entry_roots if entering else step_roots
            found = [root for guard in guards for root in look(guard, left, right)]
        except Unclear:
            step = (right - left) / 2
            if step < smallest:
                raise Undecided("crossing") from None
            continue
        yield [(Time(root, None), guard) for root, guard in found]
        left, step, entering = right, 2 * step, False


class Unclear(Exception):
    """A step that is too long to decide."""


def entry_roots(guard: Guard, left: arb, right: arb) -> list:
    """None, if the first derivative that is not structurally zero keeps its sign on the step."""
    derivative = derivatives(guard.value, left, right, guard.zeros + 1)[guard.zeros]
    if not (derivative < 0 or derivative > 0):
        raise Unclear
    return []


def step_roots(guard: Guard, left: arb, right: arb) -> list:
    """The root of `guard` on a step after entry: at most one, and simple."""
    plain = guard.value(left.union(right))
    if plain < 0 or plain > 0:
        return []
    value, slope = derivatives(guard.value, left, right, 2)
    if value < 0 or value > 0:
        return []
    if not (slope < 0 or slope > 0):
        raise Unclear
    rising = bool(slope > 0)
    if not guard.wanted(rising):
        return []
    signs = [guard.value(d) * (1 if rising else -1) for d in (left, right)]
    if signs[1] < 0 or signs[0] > 0:
        return []
    if not (signs[0] < 0 and signs[1] > 0):
        raise Unclear
    return [(refine(guard, left, right), guard)]


def rational(guards: list, span: Time):
    """All roots of odd order of rational polynomials within the span, as one batch."""
    found = []
    for guard in guards:
        for root, order in polynomial_roots(guard.exact):
            if order % 2 and within(root, span) and guard.wanted(rises(guard.exact, root, order)):
                found.append((root, guard))
    yield found


def within(root: Time, span: Time) -> bool:
    """Does a root lie after the entry and not beyond the span?"""
    if root.exact is not None and span.exact is not None:
        return root.exact > 0 and root.exact <= span.exact
    after, beyond = root.ball > 0, root.ball > span.ball
    if not (after or root.ball <= 0) or not (beyond or root.ball <= span.ball):
        raise Undecided("root at an end of the span")
    return after and not beyond


def polynomial_roots(polynomial: fmpq_poly):
    """(root, multiplicity) of each real root, rational ones exactly."""
    if polynomial.degree() < 1:
        return
    for factor, multiplicity in polynomial.factor()[1]:
        if factor.degree() == 1:
            yield Time.of(-factor[0] / factor[1]), multiplicity
            continue
        for root, _ in factor.numer().complex_roots():
            if root.imag == 0:
                yield Time(root.real, None), multiplicity


def rises(polynomial: fmpq_poly, root: Time, order: int) -> bool:
    for _ in range(order):
        polynomial = polynomial.derivative()
    value = evaluated(polynomial, root.ball if root.exact is None else root.exact)
    if not (value > 0 or value < 0):
        raise Undecided("slope")
    return bool(value > 0)


def evaluated(polynomial: fmpq_poly, x):
    value = type(x)(0)
    for k in range(polynomial.degree(), -1, -1):
        value = value * x + polynomial[k]
    return value


def exact_polynomial(row: fmpq_mat, matrix: fmpq_mat, state: fmpq_mat) -> fmpq_poly:
    """`row` exp(`matrix` t) `state` for a nilpotent matrix."""
    coefficients, factor = [], fmpq(1)
    for k in range(matrix.nrows()):
        coefficients.append((row * state)[0, 0] / factor)
        row, factor = row * matrix, factor * (k + 1)
    return fmpq_poly(coefficients)


def nilpotent(matrix: fmpq_mat) -> bool:
    polynomial = matrix.minpoly()
    return all(polynomial[k] == 0 for k in range(polynomial.degree()))
